/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is written on a picture: time stamp, scale bar, legend, colour bar. */
#ifndef DECOR_H
#define DECOR_H

#include "font.h"

typedef struct {
  int x, y, w, h; /* px */
} Box;

typedef struct {
  char label[80];
  Rgb colour;
} Kind;

typedef struct {
  const char *map, *name, *unit;
  double lo, hi; /* SI; positive when log */
  int log;
} Scale;

/* decor_scale_bar: a round length at the lower left of a panel that is `extent` metres wide. */
void decor_scale_bar(Image *im, Box panel, const Font *font, double extent);

/* decor_legend: at the lower right. decor_stamp: at the upper right. decor_title: at the upper
 * left. */
void decor_legend(Image *im, Box panel, const Font *font, const Kind *kind, int kinds);
void decor_stamp(Image *im, Box panel, const Font *font, const char *text);
void decor_title(Image *im, Box panel, const Font *font, const char *text);

/* decor_bar_width: px that decor_bar needs beside the panels. decor_bar: with ticks and the name of
 * the quantity. */
int decor_bar_width(double size);
void decor_bar(Image *im, Box box, const Font *font, const Scale *scale);

/* decor_scale: where a value lies on the scale, 0..1 and beyond. */
double decor_scale(const Scale *scale, double value);

#endif
