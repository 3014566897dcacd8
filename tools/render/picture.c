/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Samples are FINE x FINE a pixel (one for projections, which are smooth); painting averages their
 * colours. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_sort_float.h>
#include "colour.h"
#include "lib/pick.h"
#include "lib/unit.h"
#include "picture.h"
#include "sample.h"

enum { FINE = 2, GAP = 3, LEGEND = 7 };

Picture *picture_new(const Look *look, int files, Err *err)
{
  size_t room = (size_t)look->w * FINE * (size_t)look->h * FINE;
  Picture *pic = calloc(1, sizeof *pic);
  if (!pic) return err_null(err, "out of memory");
  pic->look = look, pic->panels = files * look->fields;
  pic->panel = calloc((size_t)pic->panels, sizeof *pic->panel);
  pic->value = malloc(room * sizeof *pic->value), pic->shade = calloc(room, sizeof *pic->shade);
  if (!pic->panel || !pic->value || !pic->shade) {
    picture_free(pic);
    return err_null(err, "out of memory for %d x %d pixels", look->w, look->h);
  }
  for (size_t k = 0; k < room; k++) pic->value[k] = NAN;
  return pic;
}

void picture_free(Picture *pic)
{
  if (pic) free(pic->panel), free(pic->value), free(pic->shade);
  free(pic);
}

/* Where the panels and the colour bars go: one for all, or with several fields one a panel. */
static int layout(Picture *pic, Err *err)
{
  const Look *l = pic->look;
  double least = fmin((double)l->w / l->columns, (double)l->h / l->rows);
  int numbers = 0, common, own;
  for (int k = 0; k < l->fields; k++) numbers |= !pic->layer[k].kinds;
  pic->size = fmax(7, fmin(least / 42, 22));
  common = numbers && l->fields == 1 ? decor_bar_width(pic->size) : 0;
  own = numbers && l->fields > 1 ? decor_bar_width(pic->size) : 0;
  int w = (l->w - common - GAP * (l->columns - 1)) / l->columns,
      h = (l->h - GAP * (l->rows - 1)) / l->rows;
  if (w - own < 32 || h < 32)
    return err_set(err, "--size: %d x %d is too small for %d x %d panels", l->w, l->h, l->columns,
                   l->rows);
  for (int k = 0; k < pic->panels; k++) {
    Panel *panel = &pic->panel[k];
    int x = k % l->columns * (w + GAP), y = k / l->columns * (h + GAP);
    panel->layer = k % l->fields;
    panel->box = (Box){x, y, w - own, h}, panel->whole = (Box){x, y, w, h};
    if (own) panel->bar = (Box){x + w - own, y, own, h};
  }
  if (common) pic->panel[0].bar = (Box){l->columns * (w + GAP) - GAP, 0, common, l->h};
  return 0;
}

/* MaterialID of this file to the picture's own numbers, by name. */
static int name_materials(Picture *pic, const Parts *p, Field *f, Err *err)
{
  int number[PICTURE_KINDS];
  for (int c = 0; c < p->materials; c++) {
    int k = 0;
    while (k < pic->materials && strcmp(pic->material[k], p->material[c].name)) k++;
    if (k == PICTURE_KINDS || c == PICTURE_KINDS)
      return err_set(err, "more than %d materials", PICTURE_KINDS);
    if (k == pic->materials)
      snprintf(pic->material[pic->materials++], 64, "%s", p->material[c].name);
    number[c] = k;
  }
  for (long i = 0; i < p->n; i++) f->value[i] = (float)number[(int)f->value[i]];
  return 0;
}

static int sample(Window *win, const Parts *p, const Field *f, const Camera *c, const Look *l,
                  Err *err)
{
  static const Cut nothing = {.planes = 0};
  if (!strcmp(l->view, "slice")) return slice_sample(win, p, f, c, err);
  if (!strcmp(l->view, "projection")) return project_sample(win, p, f, c, err);
  return cut_sample(win, p, f, c,
                    !strcmp(l->view, "surface") ? &nothing
                    : l->cut.planes             ? &l->cut
                                                : NULL,
                    err);
}

/* Into the window of the picture's samples; coarse samples are repeated FINE x FINE times, from the
 * last to the first. */
static int sample_panel(Picture *pic, const Panel *panel, const Parts *p, const Field *f, Camera *c,
                        Err *err)
{
  const Look *l = pic->look;
  int fine = strcmp(l->view, "projection") ? FINE : 1, stride = l->w * FINE;
  long at = (long)panel->box.y * FINE * stride + (long)panel->box.x * FINE;
  Window win = {panel->box.w * fine, panel->box.h * fine, stride, pic->value + at, pic->shade + at};
  c->w = win.w, c->h = win.h, c->scale = win.w / panel->extent;
  if (!isnan(l->perspective)) c->distance = panel->extent / 2 / tan(l->perspective / 2);
  if (sample(&win, p, f, c, l, err)) return -1;
  for (int j = win.h - 1; fine < FINE && j >= 0; j--)
    for (int i = win.w - 1; i >= 0; i--)
      for (int k = FINE * FINE - 1; k >= 0; k--) {
        long from = (long)j * stride + i,
             to = (long)(FINE * j + k / FINE) * stride + FINE * i + k % FINE;
        win.value[to] = win.value[from], win.shade[to] = win.shade[from];
      }
  return 0;
}

/* The first snapshot decides on the kinds of quantities, and so on the layout. */
static int agree(Picture *pic, Layer *layer, const Field *f, const char *file, Err *err)
{
  if (!f->value && strcmp(pic->look->view, "projection"))
    return err_set(err, "field '" FIELD_COLUMN "' needs --view projection");
  if (pic->filled == 0) {
    layer->kinds = f->kinds;
    snprintf(layer->name, sizeof layer->name, "%s", f->name);
    snprintf(layer->unit, sizeof layer->unit, "%s", f->unit);
    return 0;
  }
  if (layer->kinds == f->kinds && !strcmp(layer->unit, f->unit)) return 0;
  return err_set(err, "'%s': field '%s' has another type or unit than in the first file", file,
                 f->name);
}

static int look_at(Picture *pic, Panel *panel, const Parts *p, const Field *f, const char *file,
                   Err *err)
{
  const Look *l = pic->look;
  Camera c = {.offset = l->offset, .w = panel->box.w, .h = panel->box.h};
  camera_turn(&c, l->turn[0], l->turn[1], l->turn[2]);
  if (pick_centre(c.centre, p, l->centre, file, err)) return -1;
  double slope = isnan(l->perspective) ? 0 : tan(l->perspective / 2);
  panel->extent = isnan(l->extent) ? camera_extent(&c, p, slope) : l->extent;
  if (!(panel->extent > 0)) return err_set(err, "'%s': nothing to see", file);
  unit_time_text(p->time, panel->stamp, sizeof panel->stamp);
  return sample_panel(pic, panel, p, f, &c, err);
}

int picture_add(Picture *pic, const Parts *p, const char *file, Err *err)
{
  Field f[PICTURE_FIELDS] = {{0}};
  const Look *l = pic->look;
  int failed = 0, first = pic->filled;
  for (int k = 0; k < l->fields && !failed; k++)
    failed = field_get(&f[k], p, l->field[k], file, err) ||
             agree(pic, &pic->layer[k], &f[k], file, err) ||
             (!strcmp(f[k].name, "MaterialID") && name_materials(pic, p, &f[k], err));
  if (!failed && first == 0) failed = layout(pic, err);
  for (int k = 0; k < l->fields && !failed; k++)
    if (!(failed = look_at(pic, &pic->panel[first + k], p, &f[k], file, err))) pic->filled++;
  for (int k = 0; k < l->fields; k++) field_free(&f[k]);
  return failed ? -1 : 0;
}

/* What is the same everywhere but for rounding shall not look structured: 1 % to both sides. */
static void widen(double asked_lo, double asked_hi, Scale *s)
{
  double size = fmax(fabs(s->lo), fabs(s->hi)), more = size > 0 ? 0.01 * size : 1;
  if (s->hi - s->lo > 1e-4 * size || s->hi < s->lo) return;
  if (isnan(asked_lo)) s->lo -= more;
  if (isnan(asked_hi)) s->hi += more;
}

/* The values of a layer that can be shown, of at most some 1e6 samples, ascending; NULL without
 * memory. */
static float *shown(const Picture *pic, int layer, int log, long *n)
{
  long all = (long)pic->look->w * FINE * pic->look->h * FINE, step = all / 1000000 + 1,
       stride = pic->look->w * FINE, count = 0;
  float *v = malloc((size_t)(all / step + pic->panels + 1) * sizeof *v);
  *n = 0;
  for (int k = 0; k < pic->filled && v; k++) {
    const Box *b = &pic->panel[k].box;
    for (int y = 0; y < b->h * FINE && pic->panel[k].layer == layer; y++) {
      const float *row = pic->value + (b->y * FINE + y) * stride + b->x * FINE;
      for (int x = 0; x < b->w * FINE; x++)
        if (count++ % step == 0 && isfinite(row[x]) && (!log || row[x] > 0)) v[(*n)++] = row[x];
    }
  }
  if (v) gsl_sort_float(v, 1, (size_t)*n);
  return v;
}

int picture_limits(const Picture *pic, int layer, double *lo, double *hi, Err *err)
{
  const Look *l = pic->look;
  Scale s = {.lo = l->lo[layer], .hi = l->hi[layer], .log = l->log};
  long n;
  float *v = shown(pic, layer, s.log, &n);
  if (!v) return err_set(err, "out of memory");
  if (isnan(s.lo)) s.lo = n ? v[(long)(0.001 * (double)(n - 1))] : s.log ? 1 : 0;
  if (isnan(s.hi)) s.hi = n ? v[(long)(0.999 * (double)(n - 1) + 0.5)] : s.lo + 1;
  free(v);
  widen(l->lo[layer], l->hi[layer], &s);
  *lo = s.lo, *hi = s.hi;
  if (s.hi < s.lo) return err_set(err, "--range: %g is above %g", s.lo, s.hi);
  return s.log && s.lo <= 0
             ? err_set(err, "--range: a logarithmic scale starts above 0, not at %g", s.lo)
             : 0;
}

/* Fragments and clumps: 0 is none. */
static int numbered_from_one(const char *name)
{
  return !strcmp(name, "FragmentID") || !strcmp(name, "ClumpID");
}

static Rgb kind_colour(const Picture *pic, const Layer *layer, float value)
{
  long k = (long)value;
  if (!strcmp(layer->name, "MaterialID")) return colour_of_material(pic->material[k], (int)k);
  if (numbered_from_one(layer->name)) return k <= 0 ? (Rgb){120, 120, 126} : colour_kind(k - 1);
  return k < 0 ? (Rgb){120, 120, 126} : colour_kind(k);
}

static Rgb background(const Look *l)
{
  return !strcmp(l->background, "white") ? (Rgb){255, 255, 255} : (Rgb){9, 10, 15};
}

static void paint_pixel(const Picture *pic, const Layer *layer, const Scale *s, Image *im, int x,
                        int y)
{
  double sum[3] = {0};
  for (int k = 0; k < FINE * FINE; k++) {
    long at = (long)(FINE * y + k / FINE) * pic->look->w * FINE + FINE * x + k % FINE;
    float v = pic->value[at];
    Rgb c = isnan(v)       ? background(pic->look)
            : layer->kinds ? colour_shade(kind_colour(pic, layer, v), pic->shade[at])
                           : colour_shade(colour_map(s->map, decor_scale(s, v)), pic->shade[at]);
    sum[0] += c.r, sum[1] += c.g, sum[2] += c.b;
  }
  double n = FINE * FINE;
  im->px[(long)y * im->w + x] =
      (Rgb){(unsigned char)(sum[0] / n + 0.5), (unsigned char)(sum[1] / n + 0.5),
            (unsigned char)(sum[2] / n + 0.5)};
}

/* The smallest values that are seen of a layer, ascending; returns how many. */
static int seen(const Picture *pic, int layer, float value[LEGEND])
{
  int n = 0;
  long stride = pic->look->w * FINE;
  float last = NAN;
  for (int k = 0; k < pic->filled; k++) {
    const Box *b = &pic->panel[k].box;
    for (long s = 0; s < (long)b->h * FINE * b->w * FINE && pic->panel[k].layer == layer; s++) {
      float v =
          pic->value[(b->y * FINE + s / (b->w * FINE)) * stride + b->x * FINE + s % (b->w * FINE)];
      int at = 0;
      if (isnan(v) || v == last) continue;
      last = v;
      while (at < n && value[at] < v) at++;
      if (at == LEGEND || (at < n && value[at] == v)) continue;
      if (n < LEGEND) n++;
      memmove(value + at + 1, value + at, (size_t)(n - at - 1) * sizeof *value);
      value[at] = v;
    }
  }
  return n;
}

static void legend(const Picture *pic, Image *im, const Font *font, const Panel *panel)
{
  const Layer *layer = &pic->layer[panel->layer];
  float value[LEGEND];
  Kind kind[LEGEND];
  char word[160];
  int n = seen(pic, panel->layer, value);
  snprintf(word, sizeof word, "%s", layer->name);
  char *id = strstr(word, "ID");
  if (id) *id = 0;
  if (word[0] >= 'A' && word[0] <= 'Z') word[0] = (char)(word[0] - 'A' + 'a');
  for (int k = 0; k < n; k++) {
    long v = (long)value[k];
    kind[k].colour = kind_colour(pic, layer, value[k]);
    if (!strcmp(layer->name, "MaterialID"))
      snprintf(kind[k].label, sizeof kind[k].label, "%s", pic->material[v]);
    else if (numbered_from_one(layer->name) && v == 0)
      snprintf(kind[k].label, sizeof kind[k].label, "none");
    else
      snprintf(kind[k].label, sizeof kind[k].label, "%.60s %ld", word, v);
  }
  decor_legend(im, panel->whole, font, kind, n);
}

/* All that is written: on each panel, and once for all. */
static void letter(const Picture *pic, Image *im, const Scale *scale)
{
  const Look *l = pic->look;
  int white = !strcmp(l->background, "white"), last = pic->filled - l->fields;
  Font font = {.size = pic->size,
               .ink = white ? (Rgb){20, 20, 24} : (Rgb){238, 238, 240},
               .halo = background(l)};
  for (int k = 0; k < pic->filled; k++) {
    const Panel *panel = &pic->panel[k];
    if (l->stamp) decor_stamp(im, panel->box, &font, panel->stamp);
    decor_scale_bar(im, panel->box, &font, panel->extent);
    if (pic->layer[panel->layer].kinds && k >= last) legend(pic, im, &font, panel);
    if (panel->bar.w && !pic->layer[panel->layer].kinds)
      decor_bar(im, panel->bar, &font, &scale[panel->layer]);
  }
  if (l->title) decor_title(im, pic->panel[0].box, &font, l->title);
  const Box *whole = &pic->panel[0].whole;
  Rgb line = white ? (Rgb){190, 190, 196} : (Rgb){52, 54, 62};
  for (int k = 1; k < l->columns; k++)
    image_fill(im, whole->w * k + GAP * (k - 1) + GAP / 2, 0, 1, l->h, line);
  for (int k = 1; k < l->rows; k++)
    image_fill(im, 0, whole->h * k + GAP * (k - 1) + GAP / 2, l->columns * (whole->w + GAP) - GAP,
               1, line);
}

Image *picture_paint(const Picture *pic, Err *err)
{
  const Look *l = pic->look;
  Scale s[PICTURE_FIELDS];
  for (int k = 0; k < l->fields; k++) {
    const Layer *layer = &pic->layer[k];
    s[k] = (Scale){l->map, l->label[k] ? l->label[k] : layer->name, layer->unit, 0, 1, l->log};
    if (!layer->kinds && picture_limits(pic, k, &s[k].lo, &s[k].hi, err)) return NULL;
  }
  Image *im = image_new(l->w, l->h, background(l));
  if (!im) return err_null(err, "out of memory for %d x %d pixels", l->w, l->h);
  for (int k = 0; k < pic->filled; k++) {
    const Panel *panel = &pic->panel[k];
#pragma omp parallel for schedule(static)
    for (int y = panel->box.y; y < panel->box.y + panel->box.h; y++)
      for (int x = panel->box.x; x < panel->box.x + panel->box.w; x++)
        paint_pixel(pic, &pic->layer[panel->layer], &s[panel->layer], im, x, y);
  }
  letter(pic, im, s);
  return im;
}
