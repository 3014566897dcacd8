/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Shapes that particles fill: bodies that are no balls, targets with a flat top, pieces for the
 * laboratory, surfaces of triangles. In 2D the vertical is y, in 3D z. */
#ifndef SHAPE_H
#define SHAPE_H

#include "mesh.h"

/* X(CAPITAL, name, sizes in 3D, in 2D, in 1D (0: not there), what they are). Those with a flat top
 * have it at 0 and reach down; the others have their centre at 0. */
/* clang-format off */
#define SHAPES(X) \
  X(ELLIPSOID,  ellipsoid,  3, 2, 0, "semi-axes") \
  X(BOX,        box,        3, 2, 0, "width, (depth in y,) height; top at 0") \
  X(CYLINDER,   cylinder,   2, 0, 0, "radius, height; upright, top at 0") \
  X(HEMISPHERE, hemisphere, 1, 1, 0, "radius; flat side at the top, at 0") \
  X(ROD,        rod,        2, 2, 1, "length, radius (2D: width; 1D: none); along x") \
  X(RING,       ring,       3, 2, 0, "inner and outer radius, (height;) about the vertical") \
  X(TANK,       tank,       4, 3, 0, "inner width, (depth in y,) height, thickness of walls and bottom; open top at 0") \
  X(MESH,       mesh,       0, 0, 0, "a closed surface of triangles")
/* clang-format on */

typedef enum {
#define SHAPE_ENUM(CAPITAL, ...) SHAPE_##CAPITAL,
  SHAPES(SHAPE_ENUM)
#undef SHAPE_ENUM
      SHAPE_COUNT
} ShapeKind;

#define SHAPE_WORD(CAPITAL, NAME, ...) "|" #NAME
#define SHAPE_WORDS                    (&SHAPES(SHAPE_WORD)[1])

enum { SHAPE_PARTS = 16 };

typedef struct {
  ShapeKind kind;
  int dimension;  /* 1, 2 or 3 */
  double size[4]; /* m */
  const Mesh *mesh;
  int parts;               /* layers of a flat top, or content and wall of a tank; else 1 */
  double end[SHAPE_PARTS]; /* depth at which each layer but the last ends [m], rising */
} Shape;

/* shape_sizes: how many sizes a kind has; 0: not in this dimension. shape_layered: whether it has a
 * flat top. shape_check: sizes and depths that make sense. */
int shape_sizes(ShapeKind kind, int dimension);
int shape_layered(ShapeKind kind);
int shape_check(const Shape *s, Err *err);

/* shape_part: the part that holds x, or -1. shape_volume: of a part [m^3; 2D: m^2; 1D: m]. */
int shape_part(const Shape *s, const double x[3]);
double shape_volume(const Shape *s, int part);

/* shape_ball: centre and radius of a ball that holds it all. shape_box: the smallest upright box
 * around it, of a tank around its content. */
double shape_ball(const Shape *s, double centre[3]);
void shape_box(const Shape *s, double low[3], double high[3]);

#endif
