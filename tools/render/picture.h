/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The whole picture: panels, one a snapshot and field, with a colour scale for each field. Samples
 * of all panels are collected first, so that the scales can follow from what is seen, then painted.
 */
#ifndef PICTURE_H
#define PICTURE_H

#include "decor.h"
#include "field.h"
#include "sample.h"

enum { PICTURE_KINDS = 64, PICTURE_FIELDS = 16 };

/* What the user asked for. */
typedef struct {
  const char *view, *map, *centre, *title, *background;
  const char *field[PICTURE_FIELDS], *label[PICTURE_FIELDS]; /* label NULL: the field itself */
  int fields;
  double lo[PICTURE_FIELDS], hi[PICTURE_FIELDS]; /* SI, NAN: from what is seen */
  double turn[3];                                /* azimuth, elevation, roll of the camera, rad */
  double perspective;                            /* its field of view across, rad; NAN: parallel */
  double extent, offset;                         /* m; extent NAN: 99 % of the mass */
  Cut cut;                                       /* no planes: the one towards the viewer */
  int log, stamp, w, h, columns, rows;
} Look;

typedef struct {
  char name[160], unit[96];
  int kinds; /* the values name kinds */
} Layer;

typedef struct {
  char stamp[64];
  double extent; /* m */
  int layer;
  Box box, whole, bar; /* of the particles; with what stands beside them; of colours, w = 0: none */
} Panel;

typedef struct {
  const Look *look;
  Panel *panel; /* [panels] */
  int panels, filled;
  Layer layer[PICTURE_FIELDS];
  double size;                      /* of letters, px */
  char material[PICTURE_KINDS][64]; /* names met so far: the kinds of MaterialID */
  int materials;
  float *value, *shade; /* samples, [FINE look->h][FINE look->w] */
} Picture;

/* picture_new: room for the panels of so many snapshots. NULL when out of memory. */
Picture *picture_new(const Look *look, int files, Err *err);
void picture_free(Picture *pic);

/* picture_add: samples the next snapshot, one panel a field. All must agree on which fields name
 * kinds. */
int picture_add(Picture *pic, const Parts *p, const char *file, Err *err);

/* picture_limits: of the colours of a layer: as asked for, else from what is seen without the
 * outermost 0.1 %; errors: a range without extent. */
int picture_limits(const Picture *pic, int layer, double *lo, double *hi, Err *err);

/* picture_paint: the image; errors as above. */
Image *picture_paint(const Picture *pic, Err *err);

#endif
