/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A picture in memory: sRGB bytes, row 0 at the top; and PNG. */
#ifndef IMAGE_H
#define IMAGE_H

#include "lib/err.h"

typedef struct {
  unsigned char r, g, b;
} Rgb;

typedef struct {
  int w, h;
  Rgb *px; /* [h][w] */
} Image;

/* image_new: filled with one colour; NULL when out of memory. */
Image *image_new(int w, int h, Rgb fill);
void image_free(Image *im);

/* image_blend: mixes c into a pixel with weight 0..1; outside the picture nothing happens.
 * image_fill: a rectangle, clipped. */
void image_blend(Image *im, int x, int y, Rgb c, double weight);
void image_fill(Image *im, int x, int y, int w, int h, Rgb c);

/* image_write: PNG to a file, or stdout for "-" or NULL (refused when it is a terminal); appears
 * whole or not at all. The same picture gives the same bytes. */
int image_write(const Image *im, const char *path, Err *err);

#endif
