/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Squared distances between sites are multiples of 1/3 (HCP: odd layers are off by l/(2 sqrt 3));
 * as integers they tell shells apart exactly, and a histogram of them counts the sites inside any
 * radius. In 1D, where the centre is a site or midway between two, twice the distance does. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "lattice.h"

typedef struct {
  double row, layer; /* spacing of rows and layers, in l */
  double x, y;       /* shift of odd layers */
  double odd_row;    /* shift of odd rows along x */
  double volume[4];  /* of a site in 1, 2, 3 dimensions */
} Cell;

/* docs/theory.md 6.1 (004 eq. 2.80 corrected) */
static Cell cell(Lattice lattice)
{
  if (lattice == LATTICE_CUBIC) return (Cell){1, 1, 0, 0, 0, {0, 1, 1, 1}};
  return (Cell){sqrt(3) / 2,       sqrt(2. / 3), 0.5,
                1 / (2 * sqrt(3)), 0.5,          {0, 1, sqrt(3) / 2, 1 / sqrt(2)}};
}

static long shell_key(int dimension, double r2)
{
  return lround(dimension == 1 ? 2 * sqrt(r2) : 3 * r2);
}

typedef void Visit(void *to, const double x[3], long key);

/* Every site within radius r of the origin, which is a site, or (1D, even numbers) midway between
 * two. */
static void sites(const Cell *c, int dimension, double shift, double r, Visit *visit, void *to)
{
  long layers = dimension > 2 ? (long)(r / c->layer) + 1 : 0;
  long rows = dimension > 1 ? (long)(r / c->row) + 2 : 0, n = (long)r + 2;
  for (long k = -layers; k <= layers; k++) {
    int odd = k & 1;
    for (long j = -rows; j <= rows; j++)
      for (long i = -n; i <= n; i++) {
        double x[3] = {i + shift + (j & 1) * c->odd_row + odd * c->x, j * c->row + odd * c->y,
                       k * c->layer};
        double r2 = x[0] * x[0] + x[1] * x[1] + x[2] * x[2];
        if (r2 <= r * r) visit(to, x, shell_key(dimension, r2));
      }
  }
}

static void count(void *to, const double x[3], long key)
{
  (void)x;
  ((long *)to)[key]++;
}

typedef struct {
  LatticeBall *ball;
  const long *shell; /* by key */
  long last;         /* the outermost key that is taken */
} Taker;

static void take(void *to, const double x[3], long key)
{
  Taker *t = to;
  LatticeBall *b = t->ball;
  if (key > t->last) return;
  memcpy(b->x + 3 * b->n, x, 3 * sizeof *x);
  b->shell[b->n++] = t->shell[key];
}

/* Turns the numbers by key into shells, up to the one that comes closest to `want`; returns the
 * last key taken. */
static long cut(LatticeBall *b, long *number, long keys, long want)
{
  long inside = 0, last = 0;
  for (long key = 0; key < keys; key++) {
    long here = number[key];
    if (!here) continue;
    if (inside && labs(inside + here - want) >= labs(inside - want)) break;
    inside += here, last = key;
    number[key] = b->shells;
    b->within[b->shells++] = inside;
  }
  return last;
}

typedef struct {
  LatticeVisit *visit;
  void *to;
} Pass;

static void pass(void *to, const double x[3], long key)
{
  const Pass *p = to;
  (void)key;
  p->visit(p->to, x);
}

void lattice_sites(Lattice lattice, int dimension, double r, LatticeVisit *visit, void *to)
{
  Cell c = cell(lattice);
  Pass p = {visit, to};
  sites(&c, dimension, 0, r, pass, &p);
}

double lattice_volume(Lattice lattice, int dimension) { return cell(lattice).volume[dimension]; }

int lattice_ball(LatticeBall *b, Lattice lattice, int dimension, long want, Err *err)
{
  const double pi = acos(-1), ball[4] = {0, 2, pi, 4 * pi / 3};
  Cell c = cell(lattice);
  double shift = dimension == 1 && want % 2 == 0 ? 0.5 : 0;
  double r = pow(want * c.volume[dimension] / ball[dimension], 1. / dimension) + 2;
  long keys = shell_key(dimension, r * r) + 1, *number = calloc((size_t)keys, sizeof *number);
  Taker taker = {b, number, 0};
  *b = (LatticeBall){.volume = c.volume[dimension]};
  b->within = malloc((size_t)keys * sizeof *b->within);
  if (!number || !b->within) goto memory;
  sites(&c, dimension, shift, r, count, number);
  taker.last = cut(b, number, keys, want);
  b->x = malloc((size_t)b->within[b->shells - 1] * 3 * sizeof *b->x);
  b->shell = malloc((size_t)b->within[b->shells - 1] * sizeof *b->shell);
  if (!b->x || !b->shell) goto memory;
  sites(&c, dimension, shift, r, take, &taker);
  free(number);
  return 0;
memory:
  free(number);
  lattice_free(b);
  return err_set(err, "no memory for a lattice of %ld sites", want);
}

void lattice_free(LatticeBall *b)
{
  free(b->x), free(b->shell), free(b->within);
  *b = (LatticeBall){0};
}

long lattice_cut(const LatticeBall *b, double want)
{
  long s = 0;
  while (s < b->shells && b->within[s] < want) s++;
  if (s == b->shells) return s;
  return b->within[s] - want < want - (s ? b->within[s - 1] : 0) ? s + 1 : s;
}
