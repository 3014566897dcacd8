/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reductions: sums are taken in blocks of fixed size, then over the blocks in order, so that the
 * result does not depend on the number of threads; minima break ties by id. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "cpu.h"

enum { BLOCK = 1024 };

static void sums_of(const State *s, long from, long to, double *o)
{
  for (long i = from; i < to; i++) {
    const double *x = &s->x[3 * i], *v = &s->v[3 * i];
    double m = s->m[i], v2 = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    double l[3] = {x[1] * v[2] - x[2] * v[1], x[2] * v[0] - x[0] * v[2], x[0] * v[1] - x[1] * v[0]};
    o[0] += m, o[1] += 0.5 * m * v2, o[2] += m * s->u[i], o[3] += 0.5 * m * s->phi[i];
    for (int d = 0; d < 3; d++) o[4 + d] += m * v[d], o[7 + d] += m * l[d], o[10 + d] += m * x[d];
    o[13] += m * sqrt(v2), o[14] += m * sqrt(l[0] * l[0] + l[1] * l[1] + l[2] * l[2]);
  }
}

void cpu_sums(Sim *sim, Sums *out)
{
  const State *s = &sim->s;
  long blocks = (s->n + BLOCK - 1) / BLOCK;
  double(*part)[15] = calloc((size_t)(blocks ? blocks : 1), sizeof *part), t[15] = {0};
  if (!part) abort(); /* 120 bytes per 1024 particles */
#pragma omp parallel for schedule(static)
  for (long b = 0; b < blocks; b++)
    sums_of(s, b * BLOCK, b * BLOCK + BLOCK < s->n ? b * BLOCK + BLOCK : s->n, part[b]);
  for (long b = 0; b < blocks; b++)
    for (int k = 0; k < 15; k++) t[k] += part[b][k];
  free(part);
  out->mass = t[0], out->kinetic = t[1], out->internal = t[2], out->potential = t[3];
  for (int d = 0; d < 3; d++) {
    out->momentum[d] = t[4 + d], out->angular[d] = t[7 + d];
    out->centre[d] = t[0] > 0 ? t[10 + d] / t[0] : 0;
  }
  out->scale_momentum = t[13], out->scale_angular = t[14];
}

static void keep_smaller(Limits *a, int k, double dt, int64_t id)
{
  if (dt < a->dt[k] || (dt == a->dt[k] && id < a->id[k])) a->dt[k] = dt, a->id[k] = id;
}

void cpu_limits(Sim *sim, const Step *step, Limits *out)
{
  const State *s = &sim->s;
  backend_begin(sim, TIMER_REDUCE);
  out->bad = -1, out->bad_reason = BAD_NONE;
  for (int k = 0; k < LIMITS; k++) out->dt[k] = INFINITY, out->id[k] = INT64_MAX;
#pragma omp parallel
  {
    Limits mine = *out;
    double dt[LIMITS];
#pragma omp for schedule(static) nowait
    for (long i = 0; i < s->n; i++) {
      int bad = pass_bad(s, i);
      if (bad && (mine.bad < 0 || s->id[i] < mine.bad)) mine.bad = s->id[i], mine.bad_reason = bad;
      pass_limits(s, step, i, dt);
      for (int k = 0; k < LIMITS; k++) keep_smaller(&mine, k, dt[k], s->id[i]);
    }
#pragma omp critical
    {
      if (mine.bad >= 0 && (out->bad < 0 || mine.bad < out->bad))
        out->bad = mine.bad, out->bad_reason = mine.bad_reason;
      for (int k = 0; k < LIMITS; k++) keep_smaller(out, k, mine.dt[k], mine.id[k]);
    }
  }
  backend_end(sim, TIMER_REDUCE);
}

/* omega = I^-1 L about the body's own centre. */
static void spin_of(Sym inertia, const double l[3], double omega[3])
{
  double det = tensor_det(inertia);
  memset(omega, 0, 3 * sizeof *omega);
  if (det == 0) return;
  inertia = tensor_invert(inertia, det);
  omega[0] = inertia.xx * l[0] + inertia.xy * l[1] + inertia.xz * l[2];
  omega[1] = inertia.xy * l[0] + inertia.yy * l[1] + inertia.yz * l[2];
  omega[2] = inertia.xz * l[0] + inertia.yz * l[1] + inertia.zz * l[2];
}

static void spins(const State *s, Step *step)
{
  Sym inertia[BODIES];
  double l[BODIES][3] = {{0}};
  memset(inertia, 0, sizeof inertia);
  for (long i = 0; i < s->n; i++) {
    int b = s->body[i] >= 0 && s->body[i] < BODIES ? s->body[i] : 0;
    double r[3], v[3], r2 = 0;
    for (int d = 0; d < 3; d++) {
      r[d] = s->x[3 * i + d] - step->centre[b][d], v[d] = s->vp[3 * i + d] - step->velocity[b][d];
      r2 += r[d] * r[d];
    }
    for (int d = 0; d < 3; d++) {
      int e = (d + 1) % 3, f = (d + 2) % 3;
      l[b][d] += s->m[i] * (r[e] * v[f] - r[f] * v[e]);
    }
    Sym part = {r2 - r[0] * r[0], -r[0] * r[1], -r[0] * r[2],
                r2 - r[1] * r[1], -r[1] * r[2], r2 - r[2] * r[2]};
    inertia[b] = tensor_axpy(inertia[b], s->m[i], part);
  }
  for (int b = 0; b < BODIES; b++) spin_of(inertia[b], l[b], step->omega[b]);
}

/* Of the predicted velocities, which are what is damped. */
void cpu_bodies(Sim *sim, Step *step)
{
  const State *s = &sim->s;
  double mass[BODIES] = {0};
  memset(step->centre, 0, sizeof step->centre);
  memset(step->velocity, 0, sizeof step->velocity);
  for (long i = 0; i < s->n; i++) {
    int b = s->body[i] >= 0 && s->body[i] < BODIES ? s->body[i] : 0;
    mass[b] += s->m[i];
    for (int d = 0; d < 3; d++)
      step->centre[b][d] += s->m[i] * s->x[3 * i + d],
          step->velocity[b][d] += s->m[i] * s->vp[3 * i + d];
  }
  for (int b = 0; b < BODIES; b++)
    for (int d = 0; d < 3 && mass[b] > 0; d++)
      step->centre[b][d] /= mass[b], step->velocity[b][d] /= mass[b];
  spins(s, step);
}

/* The error of the midpoint rule against the third-order step, over what a tolerance of 1 would
 * allow: lengths by h, speeds by the signal speed (or, in cold matter, h/1000 a step), the rest by
 * its own size (001 eq. 63). */
static double error_of(const State *s, double dt, long i)
{
  const Saved *a = &s->saved[1], *b = &s->saved[2], *c = &s->saved[3];
  double scale = fmax(s->cl[i], 1e-3 * s->h[i] / dt), worst = 0, e;
#define CPU_ERROR(MEMBER, J, SIZE)                                                                 \
  e = fabs(dt * (b->MEMBER[J] - (a->MEMBER[J] + 4 * b->MEMBER[J] + c->MEMBER[J]) / 6)) / (SIZE);   \
  worst = e > worst ? e : worst;
  for (int d = 0; d < 3; d++) {
    CPU_ERROR(x, 3 * i + d, s->h[i])
    CPU_ERROR(v, 3 * i + d, scale)
  }
  for (int d = 0; d < 6; d++) { CPU_ERROR(s, 6 * i + d, s->rho[i] * scale * scale) }
  CPU_ERROR(rho, i, s->rho[i])
  CPU_ERROR(u, i, fabs(s->u[i]) + scale * scale)
  CPU_ERROR(crack, i, 1)
#undef CPU_ERROR
  return worst;
}

double cpu_error(Sim *sim, const Step *step)
{
  const State *s = &sim->s;
  double worst = 0;
#pragma omp parallel for reduction(max : worst)
  for (long i = 0; i < s->n; i++) {
    double e = error_of(s, step->dt, i);
    if (!(e <= worst)) worst = isfinite(e) ? e : 1e300;
  }
  return worst;
}
