/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The weights of the quartic's slope depend on the axis alone and are made once. */
#include <math.h>
#include <stdlib.h>
#include "slope.h"

enum { WIDTH = 5 };

typedef struct {
  int low, high;   /* ends of the piece that the node belongs to */
  int first, n;    /* nodes of its quartic */
  double w[WIDTH]; /* weights of these */
} Node;

struct Slope {
  const double *x;
  int n;
  Node node[];
};

/* Slope at x[i] of the polynomial through the nodes first .. first + n - 1 (Lagrange). */
static void weigh(Node *node, const double *x, int i)
{
  for (int k = 0; k < node->n; k++) {
    double w = 1, sum = 0, xk = x[node->first + k];
    for (int l = node->first; l < node->first + node->n; l++) {
      if (l == node->first + k) continue;
      w /= xk - x[l];
      if (l != i) w *= x[i] - x[l], sum += 1 / (x[i] - x[l]);
    }
    node->w[k] = node->first + k == i ? sum : w;
  }
}

Slope *slope_new(const double *x, int n, Err *err)
{
  Slope *s = malloc(sizeof *s + (size_t)n * sizeof s->node[0]);
  if (!s) return err_null(err, "no memory for %d nodes", n);
  s->x = x, s->n = n;
  for (int low = 0, high; low < n; low = high + 1) {
    for (high = low; high + 1 < n && x[high + 1] > x[high];) high++;
    for (int i = low; i <= high; i++) {
      Node *node = &s->node[i];
      node->low = low, node->high = high;
      node->n = high - low + 1 < WIDTH ? high - low + 1 : WIDTH;
      node->first = i - WIDTH / 2 < low ? low : i - WIDTH / 2;
      if (node->first + node->n - 1 > high) node->first = high - node->n + 1;
      weigh(node, x, i);
    }
  }
  return s;
}

void slope_free(Slope *s) { free(s); }

static double minmod(double a, double b)
{
  return a > 0 && b > 0 ? fmin(a, b) : a < 0 && b < 0 ? fmax(a, b) : 0;
}

/* A line of the function, its secants and second divided differences. */
typedef struct {
  const double *x, *f;
  long stride;
} Line;

static double secant(const Line *l, int i)
{
  return (l->f[(i + 1) * l->stride] - l->f[i * l->stride]) / (l->x[i + 1] - l->x[i]);
}

static double bend(const Line *l, const Node *node, int i)
{
  i = i <= node->low ? node->low + 1 : i >= node->high ? node->high - 1 : i;
  return (secant(l, i) - secant(l, i - 1)) / (l->x[i + 1] - l->x[i - 1]);
}

/* The slope brought into what keeps the curve monotone (s) or, at an extremum, parabolic (t). */
static double limit(const Line *l, const Node *node, int i, double slope)
{
  double left, right, s, t, most;
  if (node->high - node->low < 2) return slope;
  if (i == node->low || i == node->high) {
    s = secant(l, i == node->low ? i : i - 1);
    return s * slope <= 0 ? 0 : fabs(slope) > 3 * fabs(s) ? 3 * s : slope;
  }
  left = secant(l, i - 1), right = secant(l, i), s = minmod(left, right);
  left += minmod(bend(l, node, i - 1), bend(l, node, i)) * (l->x[i] - l->x[i - 1]);
  right -= minmod(bend(l, node, i), bend(l, node, i + 1)) * (l->x[i + 1] - l->x[i]);
  t = minmod(left, right);
  most = fmax(3 * fabs(s), 1.5 * fabs(t));
  return minmod(slope, t < 0 || (t == 0 && s < 0) ? -most : most);
}

void slope_line(const Slope *s, const double *f, double *out, long stride)
{
  Line l = {s->x, f, stride};
  for (int i = 0; i < s->n; i++) {
    const Node *node = &s->node[i];
    double slope = 0;
    for (int k = 0; k < node->n; k++) slope += node->w[k] * f[(node->first + k) * stride];
    out[i * stride] = node->n < 2 ? 0 : limit(&l, node, i, slope);
  }
}
