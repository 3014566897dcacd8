/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Edges of a target: a rod whose ends are moved strains at the rate of the ends and pulls back by
 * Hooke's law; water in a tank of held particles stays at rest under its own weight; a layer
 * swallows a wave that a free end sends back. */
#include <omp.h>
#include "lab.h"

static const char ROCK[] =
    "name = \"rock\"; eos = { form = \"murnaghan\"; rho0 = 1.; K = 1.; n = 1.; };"
    "strength = { shear_modulus = 0.6; form = \"none\"; };";
static const char WATER[] =
    "name = \"water\"; eos = { form = \"murnaghan\"; rho0 = 1.; K = 100.; n = 7.; };";

/* A rod along x, 3 by 0.6; the last four rows at either end are bodies 1 and 2. */
static void rod(void **state)
{
  static const char *const integrators[] = {"integrator=leapfrog", "integrator=rk2-adaptive"};
  enum { NX = 60, NY = 12 };
  const double dx = .05, v = 5e-4, t = 12, gauge = (NX - 4) * dx;
  (void)state;
  for (int k = 0; k < 2; k++) {
    Parts *p = lab_parts(NX * NY, 2, ROCK);
    Param par = lab_param("gravity.method=none", integrators[k], "walls.body1=-0.0005,0,0",
                          "walls.body2=0.5mm/s,0,0", NULL);
    Sim sim;
    double stress = 0, rate = 0, n = 0;
    long in = 0;
    for (long i = 0; i < p->n; i++) {
      const long a = i % NX;
      p->x[3 * i] = (double)a * dx, p->x[3 * i + 1] = (double)(i / NX) * dx;
      p->m[i] = dx * dx, p->rho[i] = 1, p->h[i] = 2.6 * dx;
      p->body[i] = a < 4 ? 1 : a >= NX - 4 ? 2 : 0;
    }
    lab_open(&sim, &par, p), lab_run(&sim, t), lab_store(&sim, p);
    const double strain = 2 * v * t / gauge, nu = (3 - 2 * .6) / (2 * (3 + .6));
    const double young = 9 * .6 / (3 + .6), hooke = young / (1 - nu * nu) * strain;
    for (long i = 0; i < p->n; i++) {
      const long a = i % NX, b = i / NX;
      const double x0 = (double)a * dx, mid = .5 * (NX - 1) * dx;
      if (p->body[i]) {
        const double end = p->body[i] == 1 ? -v : v;
        assert_true(p->v[3 * i] == end && p->v[3 * i + 1] == 0);
        assert_true(fabs(p->x[3 * i] - x0 - end * t) < 1e-12);
      } else if (fabs(x0 - mid) < .5 && b > 2 && b < NY - 3) {
        stress += p->s[6 * i] - p->p[i], n += (x0 - mid) * (x0 - mid), in++;
        rate += (p->x[3 * i] - x0) / t * (x0 - mid);
      }
    }
    stress /= (double)in, rate /= n;
    print_message("strain %.5f: rate %.4e of %.4e, stress %.3e, Hooke %.3e\n", strain, rate,
                  2 * v / gauge, stress, hooke);
    assert_true(fabs(rate / (2 * v / gauge) - 1) < .02);
    assert_true(fabs(stress / hooke - 1) < .05);
    sim_close(&sim);
    part_free(p);
  }
}

/* Water 1 deep and 0.8 wide; bottom and sides are four layers of held particles, body 1. */
static void tank(void **state)
{
  enum { NX = 24, NY = 28, DEEP = 20, WALL = 4 };
  const double dx = .05, g = 1;
  Parts *p = lab_parts(NX * NY, 2, WATER);
  Param par = lab_param("gravity.method=none", "force.y=-1", "walls.body1=held",
                        "smoothing.mode=fixed", "viscosity.alpha=0.2", "viscosity.beta=0", NULL);
  Sim sim;
  Sums sums;
  long n = 0, wet = 0;
  double fast = 0, worst = 0, top = 0;
  (void)state;
  for (int a = 0; a < NX; a++)
    for (int b = 0; b < NY; b++) {
      const int wall = a < WALL || a >= NX - WALL || b < WALL;
      if (!wall && b >= WALL + DEEP) continue;
      const double y = (b - WALL + .5) * dx, depth = fmax(0, DEEP * dx - y);
      p->x[3 * n] = a * dx, p->x[3 * n + 1] = y, p->body[n] = wall;
      p->rho[n] = pow(1 + 7 * g * depth / 100, 1. / 7), p->m[n] = dx * dx * p->rho[n];
      p->h[n++] = 2.6 * dx;
    }
  p->n = n;
  lab_open(&sim, &par, p), lab_run(&sim, 3), lab_sums(&sim, &sums), lab_store(&sim, p);
  for (long i = 0; i < n; i++) {
    const double *x = &p->x[3 * i];
    if (p->body[i]) {
      assert_true(p->v[3 * i] == 0 && p->v[3 * i + 1] == 0);
      continue;
    }
    fast = fmax(fast, hypot(p->v[3 * i], p->v[3 * i + 1])), top = fmax(top, x[1]), wet++;
    assert_true(x[0] > (WALL - 1) * dx && x[0] < (NX - WALL) * dx && x[1] > -.5 * dx);
    if (x[1] > .2 && x[1] < .8) worst = fmax(worst, fabs(p->p[i] - g * (1 - x[1])));
  }
  print_message("tank: %ld wet, surface %.3f, v %.4f, pressure off by %.3f, E_k %.2e\n", wet, top,
                fast, worst, sums.kinetic);
  assert_true(fast < .005 && worst < .05 && fabs(top - .975) < .005);
  sim_close(&sim);
  part_free(p);
}

/* A pulse of waves 0.6 long runs to the end of a line of 4; what is left in the first
 * 2.5 when it has come back. */
static double echo(const char *width)
{
  enum { N = 400 };
  Parts *p = lab_parts(N, 1, WATER);
  Param par = lab_param("gravity.method=none", "boundary.high=4,0,0", "viscosity.alpha=0",
                        "viscosity.beta=0", width, NULL);
  Sim sim;
  double energy[2] = {0, 0};
  for (long i = 0; i < N; i++) {
    const double x = ((double)i + .5) * .01, phase = 2 * LAB_PI * (x - 1.2) / .6,
                 wave = .01 * sin(phase) * exp(-pow((x - 1.2) / .4, 2));
    p->x[3 * i] = x, p->v[3 * i] = 10 * wave, p->rho[i] = 1 + wave;
    p->m[i] = .01 * p->rho[i], p->h[i] = .026, p->body[i] = 0;
  }
  lab_open(&sim, &par, p);
  for (int k = 0; k < 2; k++) {
    if (k) lab_run(&sim, .5);
    lab_store(&sim, p);
    for (long i = 0; i < N; i++)
      if (p->x[3 * i] < 2.5) energy[k] += p->m[i] * p->v[3 * i] * p->v[3 * i];
  }
  sim_close(&sim);
  part_free(p);
  return energy[1] / energy[0];
}

static void absorbed(void **state)
{
  const double open = echo("layer.high=0,0,0"), swallowed = echo("layer.high=1,0,0");
  (void)state;
  print_message("a free end sends back %.4f of the energy, a layer %.2e\n", open, swallowed);
  assert_true(open > .9 && swallowed < .005);
}

static void refused(void **state)
{
  static const char *const wrong[][2] = {
      {"walls.body1=held", "no particle is of body 1"},
      {"walls.body0=1,2", "neither free nor held nor a velocity"},
      {"layer.low=0.05,0,0", "less than four smoothing lengths"}};
  (void)state;
  for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
    Parts *p = lab_parts(2, 1, WATER);
    Param par = lab_param("gravity.method=none", wrong[k][0], NULL);
    Sim sim;
    Err err = {""};
    for (long i = 0; i < 2; i++)
      p->x[3 * i] = (double)i * .01, p->m[i] = .01, p->rho[i] = 1, p->h[i] = .02;
    assert_int_equal(sim_open(&sim, &par, p, lab_device(), &err), -1);
    if (!strstr(err.text, wrong[k][1])) fail_msg("%s", err.text);
    part_free(p);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(rod), cmocka_unit_test(tank),
                                     cmocka_unit_test(absorbed), cmocka_unit_test(refused)};
  omp_set_num_threads(1);
  return cmocka_run_group_tests(tests, NULL, NULL);
}
