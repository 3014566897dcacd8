/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Samples are FINE x FINE a pixel (one for projections, which are smooth); painting averages their
 * colours. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_sort_float.h>
#include "colour.h"
#include "lib/unit.h"
#include "picture.h"
#include "sample.h"

enum { FINE = 2, GAP = 3, LEGEND = 7 };

Picture *picture_new(const Look *look, int panels, Err *err)
{
  size_t room = (size_t)look->w * FINE * (size_t)look->h * FINE;
  Picture *pic = calloc(1, sizeof *pic);
  if (!pic) return err_null(err, "out of memory");
  pic->look = look, pic->panels = panels;
  pic->panel = calloc((size_t)panels, sizeof *pic->panel);
  pic->value = malloc(room * sizeof *pic->value), pic->shade = calloc(room, sizeof *pic->shade);
  if (!pic->panel || !pic->value || !pic->shade) {
    picture_free(pic);
    return err_null(err, "out of memory for %d x %d pixels", look->w, look->h);
  }
  for (size_t k = 0; k < room; k++) pic->value[k] = NAN;
  return pic;
}

void picture_free(Picture *pic) { free(pic->panel), free(pic->value), free(pic->shade), free(pic); }

/* Where the panels and the colour bar go. */
static int layout(Picture *pic, Err *err)
{
  const Look *l = pic->look;
  double least = fmin((double)l->w / l->columns, (double)l->h / l->rows);
  pic->size = fmax(7, fmin(least / 42, 22));
  if (!pic->kinds) pic->bar.w = decor_bar_width(pic->size);
  int w = (l->w - pic->bar.w - GAP * (l->columns - 1)) / l->columns,
      h = (l->h - GAP * (l->rows - 1)) / l->rows;
  if (w < 32 || h < 32)
    return err_set(err, "--size: %d x %d is too small for %d x %d panels", l->w, l->h, l->columns,
                   l->rows);
  for (int k = 0; k < pic->panels; k++)
    pic->panel[k].box = (Box){k % l->columns * (w + GAP), k / l->columns * (h + GAP), w, h};
  pic->bar = (Box){l->columns * (w + GAP) - GAP, 0, pic->bar.w, l->h};
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
  for (long i = 0; i < p->n; i++) f->value[i] = (float)number[p->mat[i]];
  return 0;
}

static int sample(Window *win, const Parts *p, const Field *f, const Camera *c, const char *view,
                  Err *err)
{
  if (!strcmp(view, "slice")) return slice_sample(win, p, f, c, err);
  if (!strcmp(view, "projection")) return project_sample(win, p, f, c, err);
  return cut_sample(win, p, f, c, !strcmp(view, "surface"), err);
}

/* Into the window of the picture's samples; coarse samples are repeated FINE x FINE times, from the
 * last to the first. */
static int sample_panel(Picture *pic, const Panel *panel, const Parts *p, const Field *f, Camera *c,
                        Err *err)
{
  int fine = strcmp(pic->look->view, "projection") ? FINE : 1, stride = pic->look->w * FINE;
  long at = (long)panel->box.y * FINE * stride + (long)panel->box.x * FINE;
  Window win = {panel->box.w * fine, panel->box.h * fine, stride, pic->value + at, pic->shade + at};
  c->w = win.w, c->h = win.h, c->scale = win.w / panel->extent;
  if (sample(&win, p, f, c, pic->look->view, err)) return -1;
  for (int j = win.h - 1; fine < FINE && j >= 0; j--)
    for (int i = win.w - 1; i >= 0; i--)
      for (int k = FINE * FINE - 1; k >= 0; k--) {
        long from = (long)j * stride + i,
             to = (long)(FINE * j + k / FINE) * stride + FINE * i + k % FINE;
        win.value[to] = win.value[from], win.shade[to] = win.shade[from];
      }
  return 0;
}

/* The first snapshot decides on the kind of quantity, and so on the layout. */
static int agree(Picture *pic, const Field *f, const char *file, Err *err)
{
  if (pic->filled == 0) {
    pic->kinds = f->kinds;
    snprintf(pic->name, sizeof pic->name, "%s", f->name),
        snprintf(pic->unit, sizeof pic->unit, "%s", f->unit);
    return layout(pic, err);
  }
  if (pic->kinds == f->kinds && !strcmp(pic->unit, f->unit)) return 0;
  return err_set(err, "'%s': field '%s' has another type or unit than in the first file", file,
                 f->name);
}

static int look_at(Picture *pic, Panel *panel, const Parts *p, Field *f, const char *file, Err *err)
{
  const Look *l = pic->look;
  Camera c = {.offset = l->offset, .w = panel->box.w, .h = panel->box.h};
  camera_plane(&c, l->plane);
  if (camera_centre(&c, p, l->centre, file, err)) return -1;
  panel->extent = isnan(l->extent) ? camera_extent(&c, p) : l->extent;
  if (!(panel->extent > 0)) return err_set(err, "'%s': nothing to see", file);
  unit_time_text(p->time, panel->stamp, sizeof panel->stamp);
  if (!strcmp(f->name, "MaterialID") && name_materials(pic, p, f, err)) return -1;
  return sample_panel(pic, panel, p, f, &c, err);
}

int picture_add(Picture *pic, const Parts *p, const char *file, Err *err)
{
  Field f;
  if (field_get(&f, p, pic->look->field, file, err)) return -1;
  int column = !f.value && strcmp(pic->look->view, "projection");
  int failed = column ? err_set(err, "field '" FIELD_COLUMN "' needs --view projection")
                      : agree(pic, &f, file, err);
  if (!failed) failed = look_at(pic, &pic->panel[pic->filled], p, &f, file, err);
  if (!failed) pic->filled++;
  field_free(&f);
  return failed;
}

/* What is the same everywhere but for rounding shall not look structured: 1 % to both sides. */
static void widen(const Look *l, Scale *s)
{
  double size = fmax(fabs(s->lo), fabs(s->hi)), more = size > 0 ? 0.01 * size : 1;
  if (s->hi - s->lo > 1e-4 * size || s->hi < s->lo) return;
  if (isnan(l->lo)) s->lo -= more;
  if (isnan(l->hi)) s->hi += more;
}

/* Limits from what is seen, without the outermost 0.1 % (of at most some 1e6 samples); given ones
 * stay. */
static int limits(const Picture *pic, Scale *s, Err *err)
{
  long all = (long)pic->look->w * FINE * pic->look->h * FINE, step = all / 1000000 + 1, n = 0;
  float *v = malloc((size_t)(all / step + 1) * sizeof *v);
  if (!v) return err_set(err, "out of memory");
  for (long k = 0; k < all; k += step)
    if (isfinite(pic->value[k]) && (!s->log || pic->value[k] > 0)) v[n++] = pic->value[k];
  gsl_sort_float(v, 1, (size_t)n);
  if (isnan(s->lo)) s->lo = n ? v[(long)(0.001 * (double)(n - 1))] : s->log ? 1 : 0;
  if (isnan(s->hi)) s->hi = n ? v[(long)(0.999 * (double)(n - 1) + 0.5)] : s->lo + 1;
  free(v);
  widen(pic->look, s);
  if (s->hi < s->lo) return err_set(err, "--range: %g is above %g", s->lo, s->hi);
  return s->log && s->lo <= 0
             ? err_set(err, "--range: a logarithmic scale starts above 0, not at %g", s->lo)
             : 0;
}

/* Fragments and clumps: 0 is none. */
static int numbered_from_one(const char *name)
{
  return !strcmp(name, "FragmentID") || !strcmp(name, "ClumpID");
}

static Rgb kind_colour(const Picture *pic, float value)
{
  long k = (long)value;
  if (!strcmp(pic->name, "MaterialID")) return colour_of_material(pic->material[k], (int)k);
  if (numbered_from_one(pic->name)) return k <= 0 ? (Rgb){120, 120, 126} : colour_kind(k - 1);
  return k < 0 ? (Rgb){120, 120, 126} : colour_kind(k);
}

static Rgb background(const Look *l)
{
  return !strcmp(l->background, "white") ? (Rgb){255, 255, 255} : (Rgb){9, 10, 15};
}

static void paint_pixel(const Picture *pic, const Scale *s, Image *im, int x, int y)
{
  double sum[3] = {0};
  for (int k = 0; k < FINE * FINE; k++) {
    long at = (long)(FINE * y + k / FINE) * pic->look->w * FINE + FINE * x + k % FINE;
    float v = pic->value[at];
    Rgb c = isnan(v)     ? background(pic->look)
            : pic->kinds ? colour_shade(kind_colour(pic, v), pic->shade[at])
                         : colour_shade(colour_map(s->map, decor_scale(s, v)), pic->shade[at]);
    sum[0] += c.r, sum[1] += c.g, sum[2] += c.b;
  }
  double n = FINE * FINE;
  im->px[(long)y * im->w + x] =
      (Rgb){(unsigned char)(sum[0] / n + 0.5), (unsigned char)(sum[1] / n + 0.5),
            (unsigned char)(sum[2] / n + 0.5)};
}

/* The smallest values that are seen, ascending; returns how many. */
static int seen(const Picture *pic, float value[LEGEND])
{
  int n = 0;
  long all = (long)pic->look->w * FINE * pic->look->h * FINE;
  float last = NAN;
  for (long k = 0; k < all; k++) {
    float v = pic->value[k];
    int at = 0;
    if (isnan(v) || v == last) continue;
    last = v;
    while (at < n && value[at] < v) at++;
    if (at == LEGEND || (at < n && value[at] == v)) continue;
    if (n < LEGEND) n++;
    memmove(value + at + 1, value + at, (size_t)(n - at - 1) * sizeof *value);
    value[at] = v;
  }
  return n;
}

static void legend(const Picture *pic, Image *im, const Font *font)
{
  float value[LEGEND];
  Kind kind[LEGEND];
  char word[160];
  int n = seen(pic, value);
  snprintf(word, sizeof word, "%s", pic->name);
  char *id = strstr(word, "ID");
  if (id) *id = 0;
  if (word[0] >= 'A' && word[0] <= 'Z') word[0] = (char)(word[0] - 'A' + 'a');
  for (int k = 0; k < n; k++) {
    long v = (long)value[k];
    kind[k].colour = kind_colour(pic, value[k]);
    if (!strcmp(pic->name, "MaterialID"))
      snprintf(kind[k].label, sizeof kind[k].label, "%s", pic->material[v]);
    else if (numbered_from_one(pic->name) && v == 0)
      snprintf(kind[k].label, sizeof kind[k].label, "none");
    else
      snprintf(kind[k].label, sizeof kind[k].label, "%.60s %ld", word, v);
  }
  decor_legend(im, pic->panel[pic->filled - 1].box, font, kind, n);
}

static void letter(const Picture *pic, Image *im, const Scale *s)
{
  const Look *l = pic->look;
  int white = !strcmp(l->background, "white");
  Font font = {.size = pic->size,
               .ink = white ? (Rgb){20, 20, 24} : (Rgb){238, 238, 240},
               .halo = background(l)};
  for (int k = 0; k < pic->filled; k++) {
    const Panel *panel = &pic->panel[k];
    if (l->stamp) decor_stamp(im, panel->box, &font, panel->stamp);
    decor_scale_bar(im, panel->box, &font, panel->extent);
  }
  if (l->title) decor_title(im, pic->panel[0].box, &font, l->title);
  if (pic->kinds)
    legend(pic, im, &font);
  else
    decor_bar(im, pic->bar, &font, s);
  Rgb line = white ? (Rgb){190, 190, 196} : (Rgb){52, 54, 62};
  for (int k = 1; k < l->columns; k++)
    image_fill(im, pic->panel[0].box.w * k + GAP * (k - 1) + GAP / 2, 0, 1, l->h, line);
  for (int k = 1; k < l->rows; k++)
    image_fill(im, 0, pic->panel[0].box.h * k + GAP * (k - 1) + GAP / 2, l->w - pic->bar.w, 1,
               line);
}

Image *picture_paint(Picture *pic, Err *err)
{
  const Look *l = pic->look;
  Scale s = {l->map, pic->name, pic->unit, l->lo, l->hi, l->log};
  if (!pic->kinds && limits(pic, &s, err)) return NULL;
  Image *im = image_new(l->w, l->h, background(l));
  if (!im) return err_null(err, "out of memory for %d x %d pixels", l->w, l->h);
#pragma omp parallel for schedule(static)
  for (int y = 0; y < l->h; y++)
    for (int x = 0; x < l->w; x++) paint_pixel(pic, &s, im, x, y);
  letter(pic, im, &s);
  return im;
}
