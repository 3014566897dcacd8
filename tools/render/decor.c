/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Everything is placed in multiples of the letter size. */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include "colour.h"
#include "decor.h"
#include "lib/unit.h"

/* The largest of 1, 2, 5 x 10^k that is at most x. */
static double round_below(double x)
{
  double base = pow(10, floor(log10(x))), f = x / base;
  return base * (f >= 5 ? 5 : f >= 2 ? 2 : 1);
}

void decor_scale_bar(Image *im, Box panel, const Font *font, double extent)
{
  char text[64];
  double length = round_below(0.3 * extent), pixels = length / extent * panel.w, s = font->size;
  int x = panel.x + (int)(1.2 * s), y = panel.y + panel.h - (int)(1.4 * s),
      thick = (int)fmax(2, s / 5);
  int end = (int)(s / 2), n = (int)(pixels + 0.5);
  image_fill(im, x, y, n, thick, font->ink);
  image_fill(im, x, y - end + thick, thick / 2 + 1, end, font->ink);
  image_fill(im, x + n - thick / 2 - 1, y - end + thick, thick / 2 + 1, end, font->ink);
  Font f = *font;
  f.align = FONT_LEFT;
  font_draw(im, &f, x, y - 0.8 * s, unit_length_text(length, text, sizeof text));
}

void decor_legend(Image *im, Box panel, const Font *font, const Kind *kind, int kinds)
{
  double s = font->size, widest = 0;
  Font f = *font;
  f.align = FONT_LEFT;
  for (int k = 0; k < kinds; k++) widest = fmax(widest, font_width(kind[k].label, s));
  double x = panel.x + panel.w - widest - 1.2 * s, y = panel.y + panel.h - 1.4 * s;
  for (int k = kinds - 1; k >= 0; k--, y -= 1.8 * s) {
    image_fill(im, (int)(x - 1.8 * s), (int)(y - s), (int)(1.1 * s), (int)(1.1 * s),
               kind[k].colour);
    font_draw(im, &f, x, y, kind[k].label);
  }
}

void decor_stamp(Image *im, Box panel, const Font *font, const char *text)
{
  Font f = *font;
  f.align = FONT_RIGHT;
  font_draw(im, &f, panel.x + panel.w - 1.2 * f.size, panel.y + 2.2 * f.size, text);
}

void decor_title(Image *im, Box panel, const Font *font, const char *text)
{
  Font f = *font;
  f.align = FONT_LEFT;
  font_draw(im, &f, panel.x + 1.2 * f.size, panel.y + 2.2 * f.size, text);
}

double decor_scale(const Scale *s, double value)
{
  if (s->log) return value > 0 ? log(value / s->lo) / log(s->hi / s->lo) : -1;
  return (value - s->lo) / (s->hi - s->lo);
}

/* A factor for the ticks and how the unit is written with it: GPa, or 10^3 kg/m^3 where no prefix
 * fits. */
static double readable(const char *unit, double largest, char *text, int size)
{
  static const char *const prefixable[] = {"Pa", "J/kg", "m/s", "m", "J", "W/kg"}, *const prefix =
                                                                                       "num kMGTPE";
  int e = largest > 0 ? 3 * (int)floor(log10(largest) / 3 + 1e-9) : 0;
  if (largest >= 0.1 && largest < 1e4) e = 0;
  if (!strcmp(unit, "1")) unit = "";
  for (int k = 0; k < 6; k++)
    if (e && e >= -9 && e <= 18 && !strcmp(unit, prefixable[k])) {
      snprintf(text, (size_t)size, "%c%s", prefix[e / 3 + 3], unit);
      return pow(10, e);
    }
  if (e)
    snprintf(text, (size_t)size, "10^%d%s%s", e, *unit ? " " : "", unit);
  else
    snprintf(text, (size_t)size, "%s", unit);
  return pow(10, e);
}

int decor_bar_width(double size) { return (int)(8.5 * size); }

static void tick(Image *im, Box bar, const Font *font, double at, const char *text)
{
  int y = bar.y + (int)((1 - at) * (bar.h - 1));
  Font f = *font;
  f.align = FONT_LEFT;
  image_fill(im, bar.x + bar.w, y, (int)(0.4 * f.size), 1, f.ink);
  if (*text) font_draw(im, &f, bar.x + bar.w + 0.8 * f.size, y + 0.5 * f.size, text);
}

static void linear_ticks(Image *im, Box bar, const Font *font, const Scale *s, double factor)
{
  double lo = s->lo / factor, hi = s->hi / factor, step = round_below((hi - lo) / 4);
  int digits = (int)fmax(0, -floor(log10(step) + 1e-9));
  char text[64];
  for (double k = ceil(lo / step - 1e-6); k * step <= hi + 1e-6 * step; k++) {
    snprintf(text, sizeof text, "%.*f", digits, k == 0 ? 0. : k * step);
    tick(im, bar, font, decor_scale(s, k * step * factor), text);
  }
}

static void log_ticks(Image *im, Box bar, const Font *font, const Scale *s)
{
  char text[64];
  double decades = log10(s->hi / s->lo);
  int every = decades > 8 ? (int)ceil(decades / 8) : 1;
  for (int e = (int)floor(log10(s->lo)); e <= (int)ceil(log10(s->hi)); e++)
    for (int d = 1; d < 10; d++) {
      double at = decor_scale(s, d * pow(10, e));
      int label = d == 1 ? e % every == 0 : decades < 2 && (d == 2 || d == 5);
      if (at < -1e-9 || at > 1 + 1e-9 || (!label && (every > 1 || decades > 5))) continue;
      snprintf(text, sizeof text, d == 1 ? "10^%d" : "%d*10^%d", d == 1 ? e : d, e);
      tick(im, bar, font, at, label ? text : "");
    }
}

void decor_bar(Image *im, Box box, const Font *font, const Scale *s)
{
  char unit[80] = "", label[256];
  double size = font->size, factor = 1;
  Box bar = {box.x + (int)size, box.y + (int)(1.5 * size), (int)(1.2 * size),
             box.h - (int)(3 * size)};
  Font f = *font;
  for (int y = 0; y < bar.h; y++)
    image_fill(im, bar.x, bar.y + y, bar.w, 1, colour_map(s->map, 1 - y / fmax(1, bar.h - 1)));
  if (s->log)
    snprintf(unit, sizeof unit, "%s", strcmp(s->unit, "1") ? s->unit : ""),
        log_ticks(im, bar, font, s);
  else
    factor = readable(s->unit, fmax(fabs(s->lo), fabs(s->hi)), unit, sizeof unit),
    linear_ticks(im, bar, font, s, factor);
  snprintf(label, sizeof label, *unit ? "%s [%s]" : "%s", s->name, unit);
  f.align = FONT_CENTRE, f.up = 1;
  f.size *= fmin(1, 0.94 * box.h / font_width(label, size));
  font_draw(im, &f, box.x + box.w - 0.6 * size, box.y + box.h / 2., label);
}
