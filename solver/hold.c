/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The settings of walls and layers. */
#include <string.h>
#include "../lib/unit.h"
#include "sim.h"

/* One body: free, held, or a velocity. */
static int wall_of(const char *text, int body, Hold *h, Err *err)
{
  Err why;
  if (strcmp(text, "free") == 0) return 0;
  h->on = 1, h->walls |= 1u << body;
  if (strcmp(text, "held") == 0 || !unit_list(text, "m/s", 3, h->wall[body], &why)) return 0;
  return err_set(err, "walls.body%d = '%s' is neither free nor held nor a velocity X,Y,Z: %s", body,
                 text, why.text);
}

int hold_open(Sim *sim, const Parts *p, Err *err)
{
  const Param *par = &sim->par;
  Hold *h = &sim->hold;
  double most = 0;
  unsigned there = 0;
  memset(h, 0, sizeof *h);
  for (int b = 0; b < BODIES; b++)
    if (wall_of(par->wall[b], b, h, err)) return -1;
  for (long i = 0; i < p->n; i++) {
    most = p->h[i] > most ? p->h[i] : most;
    if (p->body[i] >= 0 && p->body[i] < BODIES) there |= 1u << p->body[i];
  }
  for (int b = 0; b < BODIES; b++)
    if ((h->walls & ~there) >> b & 1)
      return err_set(err, "walls.body%d = %s, but no particle is of body %d", b, par->wall[b], b);
  for (int d = 0; d < 3; d++) {
    h->low[d] = par->layer_low[d], h->high[d] = par->layer_high[d];
    h->on |= h->low[d] > 0 || h->high[d] > 0;
    for (int k = 0; k < 2; k++) {
      const double width = k ? h->high[d] : h->low[d];
      if (width > 0 && width < 4 * most)
        return err_set(err, "layer.%s: %g m across %c is less than four smoothing lengths (%g m)",
                       k ? "high" : "low", width, "xyz"[d], most);
    }
  }
  h->strength = par->layer_strength;
  return 0;
}
