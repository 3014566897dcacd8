/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sums over particles go by blocks of fixed size, added in order, so that they do not depend on the
 * number of threads. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "disk.h"
#include "group.h"
#include "pointmass.h"
#include "potential.h"
#include "sort.h"
#include "unit.h"

#define PI 3.14159265358979323846
/* Rounds until the equator must rest; from FREE on a planet may only grow, so that no set
 * alternates. */
enum { BLOCK = 8192, ROUNDS = 1000, FREE = 50 };
/* Fraction of an object's particles that are its surface (004 sect. 2.4.7). */
#define SURFACE 0.01

const char *const disk_names[DISK_CLASSES] = {"none",      "body",   "disk",
                                              "re-impact", "fly-by", "escape"};

/* Of the particles inside: mass, volume, first moments, spin; relative to the centre before. */
typedef struct {
  double mass, volume, x[3], v[3], l[3], i[6];
  long n;
} Sum;

static void add(Sum *s, double m, double rho, const double r[3], const double v[3])
{
  s->n++, s->mass += m, s->volume += m / rho;
  for (int a = 0; a < 3; a++) {
    const int b = (a + 1) % 3, c = (a + 2) % 3;
    s->x[a] += m * r[a], s->v[a] += m * v[a], s->l[a] += m * (r[b] * v[c] - r[c] * v[b]);
  }
  s->i[0] += m * r[0] * r[0], s->i[1] += m * r[0] * r[1], s->i[2] += m * r[0] * r[2];
  s->i[3] += m * r[1] * r[1], s->i[4] += m * r[1] * r[2], s->i[5] += m * r[2] * r[2];
}

static void join(Sum *s, const Sum *t)
{
  s->n += t->n, s->mass += t->mass, s->volume += t->volume;
  for (int a = 0; a < 3; a++) s->x[a] += t->x[a], s->v[a] += t->v[a], s->l[a] += t->l[a];
  for (int k = 0; k < 6; k++) s->i[k] += t->i[k];
}

double disk_flattening(double omega, double mass, double radius)
{
  const double K = 0.335, c = 2.5 - 3.75 * K;
  return 2.5 * omega * omega * radius * radius * radius / (UNIT_G * mass) / (1 + c * c);
}

DiskClass disk_classify(int canup, double radius, double mu, const double r[3], const double v[3],
                        Orbit *o)
{
  const double r2 = r[0] * r[0] + r[1] * r[1] + r[2] * r[2];
  if (r2 <= radius * radius) return DISK_BODY;
  *o = orbit_of_state(mu, r, v);
  const double out = r[0] * v[0] + r[1] * v[1] + r[2] * v[2];
  const int bound = o->beta > 0; /* e = 1 does not say: a fall from rest has it too */
  if (!bound && out >= 0) return DISK_ESCAPE;
  if (!bound && o->rp >= radius) return DISK_FLYBY;
  if (bound && canup && o->p <= radius) return DISK_BODY;
  return bound && o->rp >= radius ? DISK_DISK : DISK_REIMPACT;
}

double disk_mu(const Parts *p, long i, const DiskBody *b, const double *within)
{
  return UNIT_G * (p->m[i] + (within ? fmax(within[i], b->mass) : b->mass));
}

static void relative(const Parts *p, long i, const DiskBody *b, double r[3], double v[3])
{
  for (int a = 0; a < 3; a++) r[a] = p->x[3 * i + a] - b->x[a], v[a] = p->v[3 * i + a] - b->v[a];
}

Orbit disk_orbit(const Parts *p, long i, const DiskBody *b, const double *within)
{
  double r[3], v[3];
  relative(p, i, b, r, v);
  return orbit_of_state(disk_mu(p, i, b, within), r, v);
}

double *disk_enclosed(const Parts *p, const double x[3], Err *err)
{
  double *r = malloc((size_t)p->n * sizeof *r), *within = malloc((size_t)p->n * sizeof *within),
         sum = 0;
  long *order = malloc(2 * (size_t)p->n * sizeof *order), *by = order + p->n;
  int failed = !r || !within || !order || group_order(p, order, err); /* equal distances: by id */
  for (long k = 0; k < p->n && !failed; k++) r[k] = group_apart(p->x + 3 * order[k], x);
  failed = failed || sort_reals(p->n, r, by);
  for (long k = 0; k < p->n && !failed; k++) within[order[by[k]]] = sum, sum += p->m[order[by[k]]];
  free(r), free(order);
  if (!failed) return within;
  free(within);
  return err_null(err, "out of memory for %ld particles", p->n);
}

static double det(const double a[3], const double b[3], const double c[3])
{
  return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
         a[2] * (b[0] * c[1] - b[1] * c[0]);
}

/* omega = I^-1 L about the centre of the sum; particles on a line do not spin. */
static void spin(const Sum *s, double omega[3])
{
  const double *q = s->i, m = s->mass;
  const double full[3][3] = {{q[0], q[1], q[2]}, {q[1], q[3], q[4]}, {q[2], q[4], q[5]}};
  double c[3], u[3], l[3], d[3][3], trace = 0;
  for (int a = 0; a < 3; a++) c[a] = s->x[a] / m, u[a] = s->v[a] / m;
  for (int a = 0; a < 3; a++) {
    const int b = (a + 1) % 3, e = (a + 2) % 3;
    l[a] = s->l[a] - m * (c[b] * u[e] - c[e] * u[b]);
    trace += full[a][a] - m * c[a] * c[a];
  }
  for (int a = 0; a < 3; a++)
    for (int b = 0; b < 3; b++) d[a][b] = (a == b ? trace : 0) - (full[a][b] - m * c[a] * c[b]);
  const double all = det(d[0], d[1], d[2]), few = 1e-12 * trace * trace * trace;
  omega[0] = all > few ? det(l, d[1], d[2]) / all : 0; /* Cramer; I is symmetric */
  omega[1] = all > few ? det(d[0], l, d[2]) / all : 0;
  omega[2] = all > few ? det(d[0], d[1], l) / all : 0;
}

/* The body that the sum makes, and its equator for the present flattening. */
static int settle(DiskBody *b, const Sum *s, Err *err)
{
  if (s->n < 1) return err_set(err, "no particle is inside the body");
  for (int a = 0; a < 3; a++) b->x[a] += s->x[a] / s->mass, b->v[a] += s->v[a] / s->mass;
  b->mass = s->mass, b->rho = s->mass / s->volume;
  spin(s, b->omega);
  const double mean = cbrt(3 * s->volume / (4 * PI)),
               omega = sqrt(b->omega[0] * b->omega[0] + b->omega[1] * b->omega[1] +
                            b->omega[2] * b->omega[2]);
  b->equator = mean;
  for (int k = 0; k < 200; k++) { /* R = mean (1 - f(R))^(-1/3) */
    b->flattening = disk_flattening(omega, b->mass, b->equator);
    if (b->flattening >= 1)
      return err_set(err, "the body spins with %g rad/s, faster than it can hold together", omega);
    const double next = mean / cbrt(1 - b->flattening);
    if (fabs(next - b->equator) < 1e-14 * mean) break;
    b->equator = next;
  }
  return 0;
}

typedef struct {
  const Parts *p;
  const DiskOptions *o;
  const long *list;
  long n;
  const double *within;
  unsigned char *in; /* [n] inside the body */
  Sum *block;
} Work;

/* Sums over what is inside b; keep: what was inside before stays. *changed: the set did. */
static Sum inside(Work *w, const DiskBody *b, int keep, int *changed)
{
  const long blocks = (w->n + BLOCK - 1) / BLOCK;
  int change = 0;
#pragma omp parallel for reduction(| : change)
  for (long k = 0; k < blocks; k++) {
    Sum s = {0};
    for (long j = k * BLOCK; j < w->n && j < (k + 1) * BLOCK; j++) {
      const long i = w->list[j];
      double r[3], v[3];
      Orbit orbit;
      relative(w->p, i, b, r, v);
      const double mu = disk_mu(w->p, i, b, w->within);
      const int in = (keep && w->in[j]) ||
                     disk_classify(w->o->canup, b->radius, mu, r, v, &orbit) == DISK_BODY;
      change |= in != w->in[j], w->in[j] = (unsigned char)in;
      if (in) add(&s, w->p->m[i], w->p->rho[i], r, v);
    }
    w->block[k] = s;
  }
  Sum all = {0};
  for (long k = 0; k < blocks; k++) join(&all, &w->block[k]);
  *changed = change;
  return all;
}

/* Centre, mass and mean density (of mass, which vapour hardly moves) of all; a point mass without a
 * size has no part in the latter. */
static void start(DiskBody *b, const Parts *p, const long *list, long n)
{
  double dense = 0, wide = 0;
  memset(b, 0, sizeof *b);
  for (long k = 0; k < n; k++) {
    const long i = list[k];
    for (int a = 0; a < 3; a++)
      b->x[a] += p->m[i] * p->x[3 * i + a], b->v[a] += p->m[i] * p->v[3 * i + a];
    b->mass += p->m[i];
    if (p->rho[i] < INFINITY) dense += p->m[i] * p->rho[i], wide += p->m[i];
  }
  for (int a = 0; a < 3; a++) b->x[a] /= b->mass, b->v[a] /= b->mass;
  b->radius = wide > 0 ? cbrt(3 * wide * wide / (4 * PI * dense)) : 0;
}

static int canup(Work *w, DiskBody *b, Err *err)
{
  start(b, w->p, w->list, w->n);
  for (int round = 0; round < ROUNDS; round++) {
    int changed;
    const Sum s = inside(w, b, round >= FREE, &changed);
    const double before = b->radius;
    if (settle(b, &s, err)) return -1;
    b->radius = b->equator;
    if (!changed && fabs(b->radius - before) < 1e-8 * before) return 0;
  }
  return err_set(err, "the body's equator does not come to rest");
}

/* Whether a particle is surface. */
static int is_light(const Work *w, long i)
{
  return w->p->rho[i] < w->o->floor[w->p->mat[i]] && !pointmass_row(w->p, i);
}

/* The deepest particles until enough of them are light: their centre, and the mean distance of the
 * light ones from it. */
static int surface(Work *w, DiskBody *b, Err *err)
{
  const Parts *p = w->p;
  double *phi = malloc((size_t)w->n * sizeof *phi), mass = 0, sum = 0;
  long *order = malloc((size_t)w->n * sizeof *order), light = 0, end = 0;
  int failed = !phi || !order ? err_set(err, "out of memory for %ld particles", w->n) : 0;
  failed = failed || potential_own(p, w->list, w->n, w->o->theta, phi, err);
  if (!failed && sort_reals(w->n, phi, order))
    failed = err_set(err, "out of memory for %ld particles", w->n);
  memset(b, 0, sizeof *b);
  for (; end < w->n && !failed && (double)light <= SURFACE * (double)w->n; end++) {
    const long i = w->list[order[end]];
    light += is_light(w, i);
    for (int a = 0; a < 3; a++)
      b->x[a] += p->m[i] * p->x[3 * i + a], b->v[a] += p->m[i] * p->v[3 * i + a];
    mass += p->m[i];
  }
  if (!failed && !light)
    failed = err_set(err, "no particle is lighter than --min-density: the surface is not found "
                          "(give a larger one, or --method canup)");
  for (int a = 0; a < 3; a++) b->x[a] /= mass, b->v[a] /= mass;
  b->mass = mass;
  for (long k = 0; k < end && !failed; k++) {
    const long i = w->list[order[k]];
    if (is_light(w, i)) sum += group_apart(p->x + 3 * i, b->x);
  }
  b->radius = light ? sum / (double)light : 0;
  free(phi), free(order);
  return failed;
}

/* The sphere stays; mass and velocity are those of what it holds. */
static int reufer(Work *w, DiskBody *b, Err *err)
{
  int changed;
  if (surface(w, b, err)) return -1;
  const Sum s = inside(w, b, 0, &changed);
  const double centre[3] = {b->x[0], b->x[1], b->x[2]};
  if (settle(b, &s, err)) return -1;
  memcpy(b->x, centre, sizeof centre);
  b->equator = b->radius / cbrt(1 - b->flattening);
  return 0;
}

int disk_find(const Parts *p, const long *list, long n, const DiskOptions *o, int32_t *class,
              DiskBody *b, Err *err)
{
  Work w = {.p = p, .o = o, .list = list, .n = n, .in = calloc((size_t)n + 1, 1)};
  w.block = malloc((size_t)(n / BLOCK + 1) * sizeof *w.block);
  double *within = NULL;
  int failed = !w.in || !w.block ? err_set(err, "out of memory for %ld particles", n) : 0;
  if (!failed && n < 1) failed = err_set(err, "there are no particles to look at");
  if (!failed) failed = o->canup ? canup(&w, b, err) : reufer(&w, b, err);
  if (!failed && o->enclosed && !(within = disk_enclosed(p, b->x, err))) failed = -1;
#pragma omp parallel for
  for (long i = 0; i < p->n; i++) {
    double r[3], v[3];
    Orbit orbit;
    if (failed) continue;
    relative(p, i, b, r, v);
    class[i] = disk_classify(o->canup, b->radius, disk_mu(p, i, b, within), r, v, &orbit);
  }
  free(w.in), free(w.block), free(within);
  return failed ? -1 : 0;
}
