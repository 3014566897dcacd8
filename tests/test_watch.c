/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is watched: heat made by viscosity is the entropy times the temperature, by another sum;
 * the largest temperature; what the floors add is what the energy gains; counts. */
#include <omp.h>
#include "lab.h"

static const char GAS[] = "name = \"gas\"; eos = { form = \"ideal\"; gamma = 1.4; };";
static const char ROCK[] =
    "name = \"rock\"; eos = { form = \"murnaghan\"; rho0 = 1.; K = 1.; n = 1.; };"
    "strength = { shear_modulus = 0.6; form = \"none\"; };";
static const char METAL[] =
    "name = \"m\"; eos = { form = \"liquid\"; rho0 = 1.; c = 1.; heat_capacity = 1.; };"
    "strength = { shear_modulus = 1.; form = \"johnson_cook\"; A = 0.01; B = 0.1;"
    "n = 0.3; C = 0.1; rate0 = 0.1; T0 = 0.1; Tmelt = 2.; };";
enum { SIDE = 8, N = 2 * SIDE * SIDE };

/* Two squares, one at x > 0, that approach each other or part at speed v each. */
static Parts *squares(const char *material, double u, double v)
{
  Parts *p = lab_parts(N, 2, material);
  const double dx = .1;
  for (int i = 0; i < N; i++) {
    const int right = i >= N / 2, k = i % (N / 2);
    p->x[3 * i] = ((right ? 0 : -SIDE) + k % SIDE + .5) * dx;
    p->x[3 * i + 1] = (k / SIDE + .5) * dx;
    p->v[3 * i] = right ? v : -v;
    p->m[i] = dx * dx, p->rho[i] = 1, p->u[i] = u, p->h[i] = 2.5 * dx;
  }
  return p;
}

static const char *const integrators[] = {"integrator=leapfrog", "integrator=rk2-adaptive"};

static double entropy(const Parts *p, long i) { return p->u[i] / pow(p->rho[i], .4); }

static void shock(void **state)
{
  (void)state;
  for (int k = 0; k < 2; k++) {
    Parts *p = squares(GAS, .5, -.6);
    Param par = lab_param("gravity.method=none", integrators[k], "watch.viscous_work=true",
                          "step.max=0.004", "density_floor=0", NULL);
    Sim sim;
    double a[N], rho[N], other[N] = {0}, sum = 0, said = 0, worst = 0;
    lab_open(&sim, &par, p);
    for (int step = 0; step <= 100; step++) {
      if (step) lab_run(&sim, .004 * step);
      lab_store(&sim, p);
      for (long i = 0; i < N; i++) {
        if (step) other[i] += pow(.5 * (rho[i] + p->rho[i]), .4) * (entropy(p, i) - a[i]);
        a[i] = entropy(p, i), rho[i] = p->rho[i];
      }
    }
    for (long i = 0; i < N; i++) {
      sum += p->m[i] * other[i], said += p->m[i] * p->shock[i];
      worst = fmax(worst, fabs(p->shock[i] - other[i]));
    }
    print_message("%s: viscosity made %.4e, entropy times temperature %.4e, at most %.1e apart\n",
                  integrators[k], said, sum, worst);
    assert_true(said > .02 && fabs(said / sum - 1) < .01 && worst < .01);
    sim_close(&sim);
    part_free(p);
  }
}

static void energy_floor(void **state)
{
  (void)state;
  for (int k = 0; k < 2; k++) {
    Parts *p = squares(GAS, .5, 0);
    Param par = lab_param("gravity.method=none", integrators[k], "energy_floor=0.48",
                          "smoothing.mode=fixed", "step.cfl=0.1", NULL);
    Sim sim;
    Sums a, b;
    lab_open(&sim, &par, p);
    lab_sums(&sim, &a), lab_run(&sim, .8), lab_sums(&sim, &b), lab_store(&sim, p);
    const double gain = b.kinetic + b.internal - a.kinetic - a.internal;
    print_message("%s: the floor added %.5e, the energy grew by %.5e; %g at it\n", integrators[k],
                  b.lifted, gain, b.at_floor[0]);
    assert_true(a.lifted == 0 && a.at_floor[0] == 0 && b.at_floor[0] > 10);
    assert_true(b.lifted > .05 * a.internal && fabs(gain - b.lifted) < 5e-3 * b.lifted);
    for (long i = 0; i < N; i++) assert_true(p->u[i] >= .48);
    sim_close(&sim);
    part_free(p);
  }
}

static void other_floors(void **state)
{
  Parts *p = squares(ROCK, 0, .1), *q = squares(GAS, .5, 0);
  Param par = lab_param("gravity.method=none", "pressure_floor=-0.01", NULL);
  Sim sim;
  Sums sums;
  double least = 0;
  (void)state;
  lab_open(&sim, &par, p), lab_run(&sim, .3), lab_sums(&sim, &sums), lab_store(&sim, p);
  for (long i = 0; i < N; i++) least = fmin(least, p->p[i]);
  print_message("least pressure %g, %g at it\n", least, sums.at_floor[2]);
  assert_true(least == -.01 && sums.at_floor[2] > 5 && sums.at_floor[1] == 0 && sums.lifted == 0);
  sim_close(&sim);
  par.pressure_floor = -1e300;
  for (long i = 0; i < N; i++) q->x[3 * i] *= 100, q->x[3 * i + 1] *= 100, q->rho[i] = 1e-3;
  lab_open(&sim, &par, q), lab_sums(&sim, &sums);
  assert_true(sums.at_floor[1] == N && sums.at_floor[2] == 0);
  sim_close(&sim);
  part_free(p), part_free(q);
}

static void peak(void **state)
{
  (void)state;
  for (int k = 0; k < 2; k++) {
    Parts *p = squares(METAL, 0, -.2);
    Param par = lab_param("gravity.method=none", integrators[k], NULL);
    Sim sim;
    double most[N] = {0}, hot = 0;
    lab_open(&sim, &par, p);
    for (int step = 0; step < 20; step++) {
      SimStep done;
      Err err;
      if (sim_advance(&sim, 1, &done, &err)) fail_msg("%s", err.text);
      lab_store(&sim, p);
      for (long i = 0; i < N; i++) {
        most[i] = fmax(most[i], p->T[i]), hot = fmax(hot, most[i]);
        assert_true(p->Tmax[i] >= p->T[i] && p->Tmax[i] <= fmax(most[i], .1) * (1 + 1e-12));
      }
    }
    print_message("up to %.4f K\n", hot);
    assert_true(hot > .1005);
    sim_close(&sim);
    part_free(p);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(shock), cmocka_unit_test(energy_floor),
                                     cmocka_unit_test(other_floors), cmocka_unit_test(peak)};
  omp_set_num_threads(1);
  return cmocka_run_group_tests(tests, NULL, NULL);
}
