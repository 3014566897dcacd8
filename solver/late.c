/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The materials are changed where they are; a law that is exchanged is never changed back. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "../lib/material.h"
#include "late.h"

enum { CHUNK = 1 << 20 }; /* particles whose stress is changed at a time */

double late_until(const Sim *sim, double until)
{
  const Param *p = &sim->par;
  return p->late_bulk > 0 && !sim->late && sim->time < p->late_time ? fmin(until, p->late_time)
                                                                    : until;
}

int late_due(const Sim *sim)
{
  return sim->par.late_bulk > 0 && !sim->late && sim->time >= sim->par.late_time;
}

/* Returns what is left of the shear modulus: that of K and Poisson's ratio nu, 3 K (1 - 2 nu)/(2 (1
 * + nu)), no more than it was. */
static double soften(Material *m, const Param *p)
{
  const double K = p->late_bulk, nu = p->late_poisson, bulk = eos_bulk(&m->eos),
               rho0 = eos_rho0(&m->eos), mu = m->mu;
  Eos linear;
  if (!(bulk > K)) return 1;
  memset(&linear, 0, sizeof linear);
  linear.form = EOS_MURNAGHAN;
  linear.murnaghan.rho0 = rho0, linear.murnaghan.K = K, linear.murnaghan.n = 1;
  linear.murnaghan.rho_min = p->late_rho_min;
  m->eos = linear;
  m->mu = fmin(mu, 1.5 * K * (1 - 2 * nu) / (1 + nu));
  m->porosity.c *= sqrt(K / bulk);
  m->porosity.start = porosity_start(&m->porosity, &m->eos);
  return mu > 0 ? m->mu / mu : 1;
}

/* All of them; left[materials] of each shear modulus when it is asked for. */
static int soften_all(Sim *sim, double *left, Err *err)
{
  const size_t bytes = (size_t)sim->materials * sizeof(Material);
  Material *m = malloc(bytes ? bytes : 1), *to = (Material *)sim->s.material;
  int bad = !m ? err_set(err, "not enough memory") : sim->b->copy(sim, m, to, bytes, err);
  for (int k = 0; k < sim->materials && !bad; k++) {
    const double rho0 = eos_rho0(&m[k].eos), is = soften(&m[k], &sim->par);
    if (left) left[k] = is;
    if (m[k].eos.form == EOS_MURNAGHAN && m[k].eos.murnaghan.K == sim->par.late_bulk)
      sim->late_speed = fmax(sim->late_speed, sqrt(sim->par.late_bulk / rho0));
    if (to == sim->material && m[k].eos.form != to[k].eos.form) material_clear(&to[k]);
  }
  bad = bad || sim->b->copy(sim, to, m, bytes, err);
  free(m);
  sim->late = 1;
  return bad ? -1 : 0;
}

int late_soften(Sim *sim, Err *err) { return soften_all(sim, NULL, err); }

/* S of `n` particles from `first` on. */
static int scale(Sim *sim, const double *left, long first, long n, double *s, int32_t *mat,
                 Err *err)
{
  const size_t bytes = 6 * (size_t)n * sizeof *s;
  if (sim->b->copy(sim, s, sim->s.s + 6 * first, bytes, err) ||
      sim->b->copy(sim, mat, sim->s.mat + first, (size_t)n * sizeof *mat, err))
    return -1;
  for (long i = 0; i < 6 * n; i++) s[i] *= left[mat[i / 6]];
  return sim->b->copy(sim, sim->s.s + 6 * first, s, bytes, err);
}

int late_enter(Sim *sim, Err *err)
{
  const long chunk = sim->s.n < CHUNK ? sim->s.n : CHUNK;
  double *left = calloc((size_t)sim->materials + 1, sizeof *left),
         *s = malloc((size_t)chunk * 6 * sizeof *s);
  int32_t *mat = malloc((size_t)chunk * sizeof *mat);
  int bad = left && s && mat ? soften_all(sim, left, err) : err_set(err, "not enough memory");
  for (long i = 0; i < sim->s.n && sim->s.s && !bad; i += chunk)
    bad = scale(sim, left, i, sim->s.n - i < chunk ? sim->s.n - i : chunk, s, mat, err);
  free(left), free(s), free(mat);
  sim->dt_before = 0; /* no rates of these laws are known yet */
  return bad ? -1 : 0;
}
