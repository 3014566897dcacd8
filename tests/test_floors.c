/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What bounds the state of a particle, and what remembers it: the smallest energy and density, the
 * smallest and largest h, the peak pressure. A ball of gas that expands, or falls together and
 * bounces, with each integrator. */
#include "lab.h"

static const char GAS[] = "name = \"g\"; eos = { form = \"ideal\"; gamma = 1.4; };";
static const double DX = 0.1;

#define WORD(WORD, NAME) "integrator=" WORD,
static const char *const integrators[] = {INTEGRATORS(WORD)};
enum { SCHEMES = sizeof integrators / sizeof *integrators };

static int in_disc(const double *x, void *data)
{
  (void)data;
  return x[0] * x[0] + x[1] * x[1] < 0.5;
}

/* rho = 1, u = 1, v = rate x. */
static Parts *disc(double rate)
{
  const long n = lab_lattice(DX, 10, 2, in_disc, NULL, NULL);
  Parts *p = lab_parts(n, 2, GAS);
  lab_lattice(DX, 10, 2, in_disc, NULL, p->x);
  for (long i = 0; i < n; i++) {
    for (int d = 0; d < 2; d++) p->v[3 * i + d] = rate * p->x[3 * i + d];
    p->m[i] = DX * DX, p->rho[i] = 1, p->u[i] = 1, p->h[i] = 2.6 * DX;
  }
  return p;
}

/* The disc after a while under these settings. */
static Parts *after(double rate, double time, const char *integrator, const char *setting)
{
  Param par = lab_param("gravity.method=none", "precision=double", integrator, setting, NULL);
  Parts *p = disc(rate);
  Sim sim;
  lab_open(&sim, &par, p);
  lab_run(&sim, time);
  lab_store(&sim, p);
  sim_close(&sim);
  return p;
}

/* least and greatest of a field */
static void range(const double *x, long n, double out[2])
{
  out[0] = INFINITY, out[1] = -INFINITY;
  for (long i = 0; i < n; i++) out[0] = fmin(out[0], x[i]), out[1] = fmax(out[1], x[i]);
}

/* A bound holds, is reached, and is passed without it. */
static void bounds(void **state)
{
  static const struct {
    const char *free, *bound;
    size_t field;
    double rate, time, limit;
    int upper;
  } T[] = {
      {"energy_floor=-1e300", "energy_floor=0.8", offsetof(Parts, u), 2, 0.3, 0.8, 0},
      {"smoothing.max=5", "smoothing.max=1.2", offsetof(Parts, h), 2, 0.3, 1.2 * 0.26, 1},
      {"smoothing.min=0.2", "smoothing.min=0.9", offsetof(Parts, h), -2, 0.2, 0.9 * 0.26, 0},
  };
  (void)state;
  for (size_t k = 0; k < sizeof T / sizeof *T; k++)
    for (int s = 0; s < SCHEMES; s++) {
      double with[2], without[2];
      Parts *a = after(T[k].rate, T[k].time, integrators[s], T[k].bound),
            *b = after(T[k].rate, T[k].time, integrators[s], T[k].free);
      double *const *xa = (void *)((char *)a + T[k].field), *const *xb =
                                                                (void *)((char *)b + T[k].field);
      range(*xa, a->n, with), range(*xb, b->n, without);
      double at = with[T[k].upper], passed = without[T[k].upper], sign = T[k].upper ? 1 : -1;
      if (fabs(at - T[k].limit) > 1e-12 || sign * (passed - T[k].limit) < 0.01 * T[k].limit)
        fail_msg("%s, %s: %.9g, without %.9g", T[k].bound, integrators[s], at, passed);
      part_free(a), part_free(b);
    }
}

/* The largest pressure is that of all the steps. */
static void peak(void **state)
{
  const double dt = 2e-3;
  (void)state;
  for (int s = 0; s < SCHEMES; s++) {
    Param par =
        lab_param("gravity.method=none", "precision=double", "step.max=2e-3", integrators[s], NULL);
    Parts *p = disc(-2);
    double *most = calloc((size_t)p->n, sizeof *most);
    Sim sim;
    long fell = 0;
    lab_open(&sim, &par, p);
    for (int step = 1; step <= 300; step++) {
      lab_run(&sim, step * dt);
      lab_store(&sim, p);
      for (long i = 0; i < p->n; i++) most[i] = fmax(most[i], p->p[i]);
    }
    for (long i = 0; i < p->n; i++) {
      fell += p->p[i] < 0.8 * p->pmax[i];
      if (p->pmax[i] < most[i] * (1 - 1e-12) || p->pmax[i] > most[i] * 1.02)
        fail_msg("%s: particle %ld: %.9g, seen %.9g", integrators[s], i, p->pmax[i], most[i]);
    }
    assert_true(fell > p->n / 2); /* it has bounced */
    sim_close(&sim);
    free(most), part_free(p);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(bounds), cmocka_unit_test(peak)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
