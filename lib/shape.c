/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "shape.h"

static const double PI = 3.14159265358979323846;

int shape_sizes(ShapeKind kind, int dimension)
{
#define SHAPE_SIZES(CAPITAL, NAME, IN3, IN2, IN1, ...) {IN1, IN2, IN3},
  static const int sizes[][3] = {SHAPES(SHAPE_SIZES)};
  return sizes[kind][dimension - 1];
}

int shape_layered(ShapeKind kind)
{
  return kind == SHAPE_BOX || kind == SHAPE_CYLINDER || kind == SHAPE_HEMISPHERE;
}

/* Size k of 3D: in 2D there is none for y, which is taken as endless. */
static double across(const Shape *s) { return s->dimension == 3 ? s->size[1] : INFINITY; }
static double tall(const Shape *s) { return s->dimension == 3 ? s->size[2] : s->size[1]; }

static double depth_of(const Shape *s)
{
  if (s->kind == SHAPE_BOX || s->kind == SHAPE_TANK) return tall(s);
  return s->kind == SHAPE_CYLINDER ? s->size[1] : s->size[0];
}

int shape_check(const Shape *s, Err *err)
{
  double above = 0;
  for (int k = 0; k < shape_sizes(s->kind, s->dimension); k++)
    if (!(s->size[k] > 0) && !(s->kind == SHAPE_RING && k == 0 && s->size[0] == 0))
      return err_set(err, "size %d of the shape, %g m, is not positive", k + 1, s->size[k]);
  if (s->kind == SHAPE_RING && s->size[1] <= s->size[0])
    return err_set(err, "the outer radius of the ring is not above the inner one");
  for (int k = 0; k + 1 < s->parts && shape_layered(s->kind); above = s->end[k++])
    if (!(s->end[k] > above && s->end[k] < depth_of(s)))
      return err_set(err, "layer %d ends %g m deep, not between %g and %g m", k + 1, s->end[k],
                     above, depth_of(s));
  return 0;
}

static int within(const Shape *s, const double x[3])
{
  const double *a = s->size;
  int flat = s->dimension == 2;
  double up = x[flat ? 1 : 2], side = flat ? 0 : x[1], r; /* up: not for a line */
  switch (s->kind) {
  case SHAPE_ELLIPSOID:
    return pow(x[0] / a[0], 2) + pow(x[1] / a[1], 2) + (flat ? 0 : pow(x[2] / a[2], 2)) <= 1;
  case SHAPE_BOX:
    return fabs(x[0]) <= a[0] / 2 && fabs(side) <= across(s) / 2 && up <= 0 && up >= -tall(s);
  case SHAPE_CYLINDER: return hypot(x[0], x[1]) <= a[0] && up <= 0 && up >= -a[1];
  case SHAPE_HEMISPHERE: return up <= 0 && sqrt(x[0] * x[0] + side * side + up * up) <= a[0];
  case SHAPE_ROD:
    r = s->dimension == 1 ? 0 : flat ? 2 * fabs(x[1]) : hypot(x[1], x[2]);
    return fabs(x[0]) <= a[0] / 2 && r <= a[1];
  case SHAPE_RING:
    r = hypot(x[0], x[1]);
    return r >= a[0] && r <= a[1] && (flat || fabs(x[2]) <= a[2] / 2);
  case SHAPE_MESH: return mesh_inside(s->mesh, x);
  default: return 0;
  }
}

/* 0 in the content, 1 in walls and bottom. */
static int tank(const Shape *s, const double x[3])
{
  double wall = s->size[s->dimension], side = s->dimension == 3 ? x[1] : 0;
  double up = x[s->dimension - 1];
  if (up > 0) return -1;
  if (fabs(x[0]) <= s->size[0] / 2 && fabs(side) <= across(s) / 2 && up >= -tall(s)) return 0;
  if (fabs(x[0]) <= s->size[0] / 2 + wall && fabs(side) <= across(s) / 2 + wall &&
      up >= -tall(s) - wall)
    return 1;
  return -1;
}

int shape_part(const Shape *s, const double x[3])
{
  int k = 0;
  if (s->kind == SHAPE_TANK) return tank(s, x);
  if (!within(s, x)) return -1;
  while (k + 1 < s->parts && -x[s->dimension - 1] > s->end[k]) k++;
  return k;
}

/* Of a flat top down to a depth. */
static double down_to(const Shape *s, double depth)
{
  double r = s->size[0];
  if (s->kind == SHAPE_BOX) return r * (s->dimension == 3 ? s->size[1] : 1) * depth;
  if (s->kind == SHAPE_CYLINDER) return PI * r * r * depth;
  if (s->dimension == 3) return PI * (r * r - depth * depth / 3) * depth;
  return depth * sqrt(r * r - depth * depth) + r * r * asin(depth / r);
}

double shape_volume(const Shape *s, int part)
{
  const double *a = s->size;
  int flat = s->dimension == 2;
  double deep = flat ? 1 : a[1], wall = a[s->dimension], inner;
  switch (s->kind) {
  case SHAPE_ELLIPSOID: return flat ? PI * a[0] * a[1] : 4 * PI / 3 * a[0] * a[1] * a[2];
  case SHAPE_ROD: return a[0] * (s->dimension == 1 ? 1 : flat ? a[1] : PI * a[1] * a[1]);
  case SHAPE_RING: return PI * (a[1] * a[1] - a[0] * a[0]) * (flat ? 1 : a[2]);
  case SHAPE_MESH: return s->mesh->volume;
  case SHAPE_TANK:
    inner = a[0] * deep * tall(s);
    if (part == 0) return inner;
    return (a[0] + 2 * wall) * (flat ? 1 : deep + 2 * wall) * (tall(s) + wall) - inner;
  default:
    return down_to(s, part + 1 < s->parts ? s->end[part] : depth_of(s)) -
           (part ? down_to(s, s->end[part - 1]) : 0);
  }
}

double shape_ball(const Shape *s, double c[3])
{
  const double *a = s->size;
  int flat = s->dimension == 2, up = s->dimension - 1;
  double wall = s->kind == SHAPE_TANK ? a[s->dimension] : 0, half = 0;
  c[0] = c[1] = c[2] = 0;
  switch (s->kind) {
  case SHAPE_ELLIPSOID: return fmax(a[0], fmax(a[1], flat ? 0 : a[2]));
  case SHAPE_HEMISPHERE: return a[0];
  case SHAPE_CYLINDER: return c[up] = -a[1] / 2, hypot(a[0], a[1] / 2);
  case SHAPE_ROD: return s->dimension == 1 ? a[0] / 2 : hypot(a[0] / 2, flat ? a[1] / 2 : a[1]);
  case SHAPE_RING: return hypot(a[1], flat ? 0 : a[2] / 2);
  case SHAPE_MESH:
    for (int d = 0; d < 3; d++) {
      c[d] = (s->mesh->low[d] + s->mesh->high[d]) / 2;
      half += pow((s->mesh->high[d] - s->mesh->low[d]) / 2, 2);
    }
    return sqrt(half);
  default: /* box, tank */
    c[up] = -(tall(s) + wall) / 2;
    return sqrt(pow(a[0] / 2 + wall, 2) + pow(flat ? 0 : a[1] / 2 + wall, 2) + c[up] * c[up]);
  }
}

void shape_box(const Shape *s, double low[3], double high[3])
{
  const double *a = s->size;
  const int flat = s->dimension == 2, up = s->dimension - 1;
  double half[3] = {a[0], flat ? a[1] : a[0], a[0]};
  switch (s->kind) {
  case SHAPE_ELLIPSOID: half[1] = a[1], half[2] = a[2]; break;
  case SHAPE_ROD: half[0] = a[0] / 2, half[1] = flat ? a[1] / 2 : a[1], half[2] = a[1]; break;
  case SHAPE_RING: half[0] = half[1] = a[1], half[2] = a[2] / 2; break;
  case SHAPE_BOX:
  case SHAPE_TANK: half[0] = a[0] / 2, half[1] = a[1] / 2; break;
  default: break; /* round about the vertical */
  }
  for (int d = 0; d < 3; d++) {
    low[d] = d < s->dimension ? -half[d] : 0, high[d] = -low[d];
    if (s->kind == SHAPE_MESH) low[d] = s->mesh->low[d], high[d] = s->mesh->high[d];
  }
  if (shape_layered(s->kind) || s->kind == SHAPE_TANK) low[up] = -depth_of(s), high[up] = 0;
}
