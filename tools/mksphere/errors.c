/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <gsl/gsl_sort.h>
#include "errors.h"
#include "lib/figure.h"
#include "lib/ngb.h"
#include "physics/kernel.h"

typedef struct {
  const Parts *p;
  const long *order;
  double h;         /* support of the particle in the middle */
  double sum, push; /* sum of m W, and of -V x.grad W, without the kernel's norm */
  double low[3], high[3], x[3];
  int mat, mixed;
} Visit;

static void visit(long j, double r2, void *data)
{
  Visit *v = data;
  long i = v->order[j];
  const real q = (real)(sqrt(r2) / v->h);
  v->sum += v->p->m[i] * kernel_w(KERNEL_WENDLAND_C2, v->p->dimension, q);
  v->push -= v->p->m[i] / v->p->rho[i] * q * kernel_dw(KERNEL_WENDLAND_C2, v->p->dimension, q);
  if (v->p->mat[i] != v->mat) v->mixed = 1;
  for (int a = 0; a < 3; a++) {
    double d = v->p->x[3 * i + a] - v->x[a];
    v->low[a] = fmin(v->low[a], d), v->high[a] = fmax(v->high[a], d);
  }
}

/* Distance from the centre; of a body that spins, the mean radius of the level surface. */
static double radius(const Parts *p, const Structure *s, long i)
{
  const double *x = p->x + 3 * i;
  return s ? figure_level(s, hypot(x[0], x[1]), x[2])
           : sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
}

/* SPH density of particle i over that of the structure; *push: how strong pressure acts over how
 * strong it should; *inside: whether there is no edge near. */
static double density(const Tree *t, const double *x, const Parts *p, const long *order, long i,
                      double depth, double *push, int *inside)
{
  Visit v = {.p = p, .order = order, .h = p->h[i], .mat = p->mat[i]};
  for (int a = 0; a < 3; a++) v.x[a] = p->x[3 * i + a];
  ngb_point(t, x, NULL, v.x, v.h, visit, &v);
  *inside = !v.mixed && v.h < depth;
  const double norm = kernel_sigma(KERNEL_WENDLAND_C2, p->dimension) / pow(v.h, p->dimension);
  *push = norm * v.push / p->dimension;
  return norm * v.sum / p->rho[i];
}

/* M(<r), half of the particle's own mass included, against the structure's. */
static double mass_error(const Parts *p, const Structure *s, const double *r)
{
  size_t *order = malloc((size_t)p->n * sizeof *order);
  double sum = 0, all = s->node[s->n - 1].m, inside = 0;
  if (!order) return NAN;
  gsl_sort_index(order, r, 1, (size_t)p->n);
  for (long k = 0; k < p->n; k++) {
    size_t i = order[k];
    inside += 0.5 * p->m[i];
    sum += pow((inside - structure_at_radius(s, r[i]).m) / all, 2);
    inside += 0.5 * p->m[i];
  }
  free(order);
  return sqrt(sum / (double)p->n);
}

int errors_measure(Errors *out, const Parts *p, const Material *const *material, const Structure *s,
                   Err *err)
{
  Tree t = {0};
  long *order = malloc((size_t)p->n * sizeof *order);
  double *x = malloc((size_t)p->n * 3 * sizeof *x), *r = malloc((size_t)p->n * sizeof *r);
  double edge = 0, off = 0, mean = 0, push = 0, wrong = 0, centre = s ? s->node[0].p : 0;
  int rc = order && x && r ? 0 : err_set(err, "out of memory");
  *out = (Errors){0, NAN, NAN, NAN, NAN, NAN};
  if (!rc) rc = tree_order(p->n, p->x, p->id, 0, order, err);
  for (long k = 0; !rc && k < p->n; k++)
    for (int a = 0; a < 3; a++) x[3 * k + a] = p->x[3 * order[k] + a];
  if (!rc) rc = tree_build(&t, p->n, x, NULL, NULL, err);
  for (long i = 0; !rc && i < p->n; i++) edge = fmax(edge, r[i] = radius(p, s, i));
#pragma omp parallel for schedule(dynamic, 256) reduction(+ : off, mean, push, wrong)
  for (long i = 0; i < (rc ? 0 : p->n); i++) {
    int inside;
    double acts, ratio = density(&t, x, p, order, i, edge - r[i], &acts, &inside);
    if (!inside) continue;
#pragma omp atomic
    out->inside++;
    off += pow(ratio - 1, 2), mean += ratio - 1, push += acts - 1;
    wrong += pow(eos_eval(&material[p->mat[i]]->eos, ratio * p->rho[i], p->u[i], 0).p -
                     (p->p ? p->p[i] : 0),
                 2);
  }
  if (!rc && out->inside) {
    double n = (double)out->inside;
    out->density = sqrt(off / n), out->noise = sqrt(fmax(0, off / n - pow(mean / n, 2)));
    out->push = push / n;
    if (centre > 0) out->pressure = sqrt(wrong / n) / centre;
  }
  if (!rc && s) out->mass = mass_error(p, s, r);
  tree_free(&t), free(order), free(x), free(r);
  return rc;
}
