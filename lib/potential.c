/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pairs are summed in single precision, which is far below the error of the tree; direct sums in
 * double. Particles that do not act have no mass: the walk does not open nodes of none. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "gravity.h"
#include "pointmass.h"
#include "potential.h"
#include "../physics/softening.h"
#include "unit.h"

/* Up to here n^2 sums are faster than a tree. */
enum { DIRECT = 512 };

/* Particles along the curve; order: as in the list. */
static int sorted(Potential *s, Err *err)
{
  int64_t *id = malloc((size_t)s->n * sizeof *id);
  long *curve = malloc((size_t)s->n * sizeof *curve);
  int failed = !id || !curve ? err_set(err, "out of memory for %ld particles", s->n) : 0;
  for (long k = 0; k < s->n && !failed; k++) {
    const long i = s->list[s->order[k]];
    id[k] = s->p->id[i];
    memcpy(s->x + 3 * k, s->p->x + 3 * i, 3 * sizeof *s->x);
  }
  failed = failed || tree_order(s->n, s->x, id, 0, curve, err);
  for (long k = 0; k < s->n && !failed; k++) curve[k] = s->order[curve[k]];
  if (!failed) memcpy(s->order, curve, (size_t)s->n * sizeof *curve);
  free(id), free(curve);
  return failed;
}

int potential_open(Potential *s, const Parts *p, const long *list, long n, Err *err)
{
  const size_t room = (size_t)n + 1;
  *s = (Potential){.p = p, .list = list, .order = malloc(room * sizeof *s->order)};
  s->x = malloc(6 * room * sizeof *s->x);
  if (!s->order || !s->x) {
    potential_close(s);
    return err_set(err, "out of memory for %ld particles", n);
  }
  for (long k = 0; k < n; k++)
    if (!pointmass_row(p, list[k])) s->order[s->n++] = k;
  for (long k = 0; k < n && p->point_rows; k++)
    if (pointmass_row(p, list[k])) s->order[s->n + s->points++] = k;
  s->m = s->x + 3 * n, s->h = s->m + n, s->phi = s->h + n;
  if (s->n > DIRECT && sorted(s, err)) return potential_close(s), -1;
#pragma omp parallel for if (s->n > DIRECT)
  for (long k = 0; k < s->n; k++) {
    const long i = list[s->order[k]];
    memcpy(s->x + 3 * k, p->x + 3 * i, 3 * sizeof *s->x);
    s->h[k] = p->h[i];
  }
  return 0;
}

static int by_tree(Potential *s, const unsigned char *at, const GravityOptions *o, Err *err)
{
  unsigned char *only = NULL;
  if (s->tree.nodes)
    tree_refit(&s->tree, s->x, s->m, s->h);
  else if (tree_build(&s->tree, s->n, s->x, s->m, s->h, err))
    return -1;
  if (at && !(only = malloc((size_t)s->n)))
    return err_set(err, "out of memory for %ld particles", s->n);
  for (long k = 0; k < s->n && at; k++) only[k] = at[s->order[k]];
  int failed = gravity_potential(&s->tree, s->x, s->m, s->h, o, only, s->phi, err);
  free(only);
  return failed;
}

/* The potential of a mass m, softened within h, at `to` [J/kg]. */
static double pull(const double *from, double m, double h, const double *to)
{
  const double d[3] = {from[0] - to[0], from[1] - to[1], from[2] - to[2]};
  double none[3] = {0, 0, 0};
  return softening_pull(UNIT_G * m, h, d, none);
}

/* What the point mass at place j of the list does to all particles, and what they, and the other
 * point masses, do to it. */
static void by_point(const Potential *s, long j, const unsigned char *in, const unsigned char *at,
                     double *phi)
{
  const Parts *p = s->p;
  const long i = s->list[j];
  double sum = 0;
#pragma omp parallel for if (s->n > DIRECT)
  for (long k = 0; k < s->n; k++)
    if ((!in || in[j]) && (!at || at[s->order[k]]))
      phi[s->order[k]] += pull(p->x + 3 * i, p->m[i], p->h[i], s->x + 3 * k);
  if (at && !at[j]) return;
  for (long k = 0; k < s->n; k++)
    if (s->m[k] > 0) sum += pull(s->x + 3 * k, s->m[k], p->h[i], p->x + 3 * i);
  for (long k = s->n; k < s->n + s->points; k++) {
    const long other = s->list[s->order[k]];
    if (other != i && (!in || in[s->order[k]]))
      sum += pull(p->x + 3 * other, p->m[other], fmax(p->h[i], p->h[other]), p->x + 3 * i);
  }
  phi[j] = sum;
}

int potential_sum(Potential *s, const unsigned char *in, const unsigned char *at, double theta,
                  double *phi, Err *err)
{
  const GravityOptions o = {.theta = theta, .G = UNIT_G, .single = 1};
  int failed = 0;
#pragma omp parallel for if (s->n > DIRECT)
  for (long k = 0; k < s->n; k++)
    s->m[k] = !in || in[s->order[k]] ? s->p->m[s->list[s->order[k]]] : 0;
  if (s->n > DIRECT)
    failed = by_tree(s, at, &o, err);
  else if (s->n > 0)
    failed = gravity_direct(s->n, s->x, s->m, s->h, &o, NULL, s->phi, err);
#pragma omp parallel for if (s->n > DIRECT)
  for (long k = 0; k < s->n; k++)
    if (!failed && (!at || at[s->order[k]])) phi[s->order[k]] = s->phi[k];
  for (long k = s->n; k < s->n + s->points && !failed; k++) by_point(s, s->order[k], in, at, phi);
  return failed ? -1 : 0;
}

void potential_close(Potential *s)
{
  tree_free(&s->tree), free(s->order), free(s->x);
  s->order = NULL, s->x = NULL;
}

int potential_own(const Parts *p, const long *list, long n, double theta, double *phi, Err *err)
{
  Potential s;
  if (potential_open(&s, p, list, n, err)) return -1;
  int failed = potential_sum(&s, NULL, NULL, theta, phi, err);
  potential_close(&s);
  return failed;
}
