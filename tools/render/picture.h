/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The whole picture: panels, one a snapshot, with a common colour scale. Samples of all panels are
 * collected first, so that the scale can follow from what is seen, then painted. */
#ifndef PICTURE_H
#define PICTURE_H

#include "camera.h"
#include "decor.h"
#include "field.h"

enum { PICTURE_KINDS = 64 };

/* What the user asked for. */
typedef struct {
  const char *view, *plane, *field, *map, *centre, *title, *background;
  double extent, offset; /* m; extent NAN: 99 % of the mass */
  double lo, hi;         /* SI, NAN: from what is seen */
  int log, stamp, w, h, columns, rows;
} Look;

typedef struct {
  char stamp[64];
  double extent; /* m */
  Box box;
} Panel;

typedef struct {
  const Look *look;
  Panel *panel; /* [panels] */
  int panels, filled;
  Box bar;     /* w = 0: none */
  double size; /* of letters, px */
  int kinds;   /* the values name kinds */
  char name[160], unit[64];
  char material[PICTURE_KINDS][64]; /* names met so far: the kinds of MaterialID */
  int materials;
  float *value, *shade; /* samples, [FINE look->h][FINE look->w] */
} Picture;

/* picture_new: room for `panels` snapshots. NULL when out of memory. */
Picture *picture_new(const Look *look, int panels, Err *err);
void picture_free(Picture *pic);

/* picture_add: samples the next snapshot. All must agree on whether the field names kinds. */
int picture_add(Picture *pic, const Parts *p, const char *file, Err *err);

/* picture_paint: the image; errors: a range without extent. */
Image *picture_paint(Picture *pic, Err *err);

#endif
