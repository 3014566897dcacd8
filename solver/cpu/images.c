/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Images of particles near periodic and mirror faces, found anew before each search: first by the
 * old order of their owners, for the tree's order, then by the new one. */
#include <stdlib.h>
#include "../image.h"
#include "cpu.h"

static int more(void *array, size_t rows, size_t size)
{
  void **a = array, *grown = realloc(*a, rows * size);
  if (!grown) return -1;
  *a = grown;
  return 0;
}

/* Room for `all` rows of what images have, and of what the search and the loops keep of a row. */
static int reserve(Sim *sim, long all, Err *err)
{
  State *s = &sim->s;
  Cpu *c = sim->own;
  const size_t room = (size_t)(all + all / 8);
  if (all <= s->room) return 0;
  if (more(&s->x, room, 3 * sizeof *s->x) || more(&s->y, room, 3 * sizeof *s->y) ||
      more(&s->h, room, sizeof *s->h) || more(&s->ha, room, sizeof *s->ha) ||
      more(&s->m, room, sizeof *s->m) || more(&s->id, room, sizeof *s->id) ||
      more(&s->image, room, sizeof *s->image) || more(&c->order, room + 1, sizeof *c->order) ||
      more(&c->record, room + 1, CPU_RECORD * sizeof *c->record))
    return err_set(err, "not enough memory for %ld images of particles", all - s->n);
  s->room = (long)room;
  return 0;
}

int cpu_images_find(Sim *sim, Err *err)
{
  State *s = &sim->s;
  BoundsReach reach = {0, 0};
  long all = s->n;
  s->all = s->n;
  if (!s->bounds.on) return 0;
  for (long i = 0; i < s->n; i++) image_reach(s, i, &reach);
  if (image_check(s, &reach, err)) return -1;
  for (long i = 0; i < s->n; i++) all += bounds_count(image_faces(s, i, &reach));
  if (reserve(sim, all, err)) return -1;
  for (long i = 0; i < s->n; i++) {
    const int faces = image_faces(s, i, &reach);
    for (int code = 1; code < BOUNDS_CODES; code++) {
      if (!bounds_seen(faces, code)) continue;
      s->image[s->all - s->n] = (Image){(uint32_t)i, (uint32_t)code};
      image_fill(s, s->all++);
    }
  }
  return 0;
}

int cpu_images_order(Sim *sim, Err *err)
{
  State *s = &sim->s;
  const Cpu *c = sim->own;
  const size_t images = (size_t)(s->all - s->n);
  uint32_t *now = images ? malloc((size_t)s->n * sizeof *now) : NULL;
  Image *old = images ? malloc(images * sizeof *old) : NULL;
  int bad = images && (!now || !old) ? err_set(err, "not enough memory for images") : 0;
  for (long i = 0; i < s->n && images && !bad; i++) now[c->order[i]] = (uint32_t)i;
  for (size_t k = 0; k < images && !bad; k++) old[k] = s->image[k];
  for (long i = s->n; i < s->all && !bad; i++) {
    const Image *from = &old[c->order[i] - s->n];
    s->image[i - s->n] = (Image){now[from->owner], from->code};
    image_fill(s, i);
  }
  free(now), free(old);
  return bad;
}
