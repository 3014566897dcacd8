/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The h that a run with form.grad_h begins with. */
#include <math.h>
#include <stdlib.h>
#include "sim.h"

enum { ROUNDS = 100 };
static const double AGREE = 1e-5; /* single precision has it */

/* The largest deviation of h from eta (m/rho)^(1/D), over it; -1: no memory, or a failure. */
static double deviation(Sim *sim, Err *err)
{
  const State *s = &sim->s;
  const size_t n = (size_t)s->n, bytes = n * sizeof(double);
  double *h = malloc(3 * bytes + 1), *rho = h + n, *m = rho + n, worst = 0;
  if (!h) return err_set(err, "not enough memory for %ld particles", s->n);
  if (sim->b->copy(sim, h, s->h, bytes, err) || sim->b->copy(sim, rho, s->rho, bytes, err) ||
      sim->b->copy(sim, m, s->m, bytes, err))
    worst = -1;
  for (size_t i = 0; i < n && worst >= 0; i++)
    if (h[i] > s->h_min && h[i] < s->h_max)
      worst = fmax(worst, fabs(h[i] / (sim->par.eta * pow(m[i] / rho[i], 1. / s->dimension)) - 1));
  free(h);
  return worst;
}

int grad_open(Sim *sim, Err *err)
{
  const Step k = sim_step(sim, 0);
  double off = INFINITY;
  for (int round = 0; sim->par.grad_h && off > AGREE; round++) {
    if (round == ROUNDS)
      return err_set(err, "form.grad_h: after %d rounds h and density disagree by %.1e", ROUNDS,
                     off);
    sim->b->pass(sim, PASS_STILL, &k);
    if (sim->b->search(sim, err)) return -1;
    sim->b->density(sim);
    if ((off = deviation(sim, err)) < 0) return -1;
  }
  return 0;
}
