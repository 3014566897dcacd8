/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What all backends share: their choice, a look at a particle, the clock of each pass. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "../lib/progress.h"
#include "backend.h"

const struct backend *backend_find(const char *device, int *card, Err *err)
{
  const int cards = backend_cuda.cards();
  char *rest;
  long k = 0;
  *card = 0;
  if (strcmp(device, "cpu") == 0) return &backend_cpu;
  if (strcmp(device, "auto") == 0) return cards > 0 ? &backend_cuda : &backend_cpu;
  if (strncmp(device, "cuda:", 5) == 0) {
    k = strtol(device + 5, &rest, 10);
    if (rest == device + 5 || *rest || k < 0) return err_null(err, "'%s' is no card", device);
  } else if (strcmp(device, "cuda") != 0) {
    return err_null(err, "unknown device '%s': auto, cpu, cuda or cuda:K", device);
  }
  if (cards < 0)
    return err_null(err, "cannot use device '%s': this build has no CUDA (nvcc was not there)",
                    device);
  if (cards == 0) return err_null(err, "cannot use device '%s': no card or no driver", device);
  if (k >= cards)
    return err_null(err, "cannot use device '%s': cards 0 to %d are there", device, cards - 1);
  *card = (int)k;
  return &backend_cuda;
}

/* The index of a particle, or -1. */
static long find(Sim *sim, int64_t id)
{
  const long n = sim->s.n;
  int64_t *ids = malloc((size_t)n * sizeof *ids);
  long i = n;
  if (ids && !sim->b->copy(sim, ids, sim->s.id, (size_t)n * sizeof *ids, NULL))
    for (i = 0; i < n && ids[i] != id;) i++;
  free(ids);
  return i < n ? i : -1;
}

int backend_idle(const Sim *sim, const char *member)
{
  return (strcmp(member, "T") == 0 && !sim->heated) ||
         (strcmp(member, "Tmax") == 0 && !sim->heated) ||
         (strcmp(member, "shock") == 0 && !sim->par.viscous_work) ||
         (strcmp(member, "lifted") == 0 && !(sim->par.energy_floor > -1e300)) ||
         (strcmp(member, "omega") == 0 && !sim->par.grad_h) ||
         (strcmp(member, "theta") == 0 && !sim->par.shepard) ||
         (strcmp(member, "pull0") == 0 && !(sim->par.gravity_tolerance > 0)) ||
         (strncmp(member, "old_", 4) == 0 && !sim->memory) ||
         (strcmp(member, "active") == 0 && !(sim->solid && sim->par.damage)) ||
         ((strcmp(member, "alpha") == 0 || strcmp(member, "dalpha") == 0) && !sim->porous) ||
         rich_idle(sim, member);
}

void backend_range(Sim *sim)
{
  const int fixed = sim->par.smoothing == PARAM_FIXED;
  sim->s.h_min = fixed ? 0 : sim->par.h_min, sim->s.h_max = fixed ? INFINITY : sim->par.h_max;
}

PairRun backend_pair(const Sim *sim, int dimension)
{
  const Param *p = &sim->par;
  return (PairRun){.sigma = kernel_sigma(p->kernel, dimension),
                   .alpha = p->alpha,
                   .beta = p->beta,
                   .dimension = dimension,
                   .volumes = p->pressure == PARAM_PRODUCT,
                   .integrated = p->density == PARAM_MISCIBLE_CONTINUITY};
}

Grad backend_grad(const Sim *sim) { return (Grad){sim->par.eta, sim->miscible}; }

void backend_look(Sim *sim, int64_t id, char *text, size_t size)
{
  const State *s = &sim->s;
  const long i = find(sim, id);
  double x[3], v[3], rho, u, p, h, damage = 0; /* 0: a run without has no such array */
  int32_t body, near;
#define BACKEND_GET(TO, MEMBER, WIDTH)                                                             \
  (s->MEMBER && sim->b->copy(sim, TO, s->MEMBER + (WIDTH)*i, (WIDTH) * sizeof *s->MEMBER, NULL))
  snprintf(text, size, "particle %lld", (long long)id);
  if (i < 0 || BACKEND_GET(x, x, 3) || BACKEND_GET(v, v, 3) || BACKEND_GET(&rho, rho, 1) ||
      BACKEND_GET(&u, u, 1) || BACKEND_GET(&p, p, 1) || BACKEND_GET(&h, h, 1) ||
      BACKEND_GET(&damage, damage, 1) || BACKEND_GET(&body, body, 1) || BACKEND_GET(&near, nngb, 1))
    return;
#undef BACKEND_GET
  snprintf(text, size,
           "particle %lld of body %d at (%.6g %.6g %.6g) m, v (%.6g %.6g %.6g) m/s, rho %.6g "
           "kg/m^3, u %.6g J/kg, p %.6g Pa, h %.6g m, damage %.3g, %d neighbours",
           (long long)id, (int)body, x[0], x[1], x[2], v[0], v[1], v[2], rho, u, p, h, damage,
           (int)near);
}

void backend_begin(Sim *sim, int timer) { sim->timer[timer].start = progress_clock(); }

void backend_end(Sim *sim, int timer)
{
  BackendTimer *t = &sim->timer[timer];
  t->spent += progress_clock() - t->start;
  t->calls++;
}
