/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Elastic solids: wave speeds, a rotating sphere that keeps its angular
 * momentum, which it loses without the corrected gradient and its adjoint; stress carried by
 * rotation and by simple shear (docs/theory.md 2.3, 2.4, 3.2); clumps that stay as they are. */
#include "lab.h"

static const char BASALT[] =
    "name = \"b\"; eos = { form = \"murnaghan\"; rho0 = 2700.; K = 26.7e9; n = 1.; };"
    "strength = { shear_modulus = 22.7e9; form = \"none\"; };";
static const char RUBBER[] =
    "name = \"r\"; eos = { form = \"murnaghan\"; rho0 = 1.; K = 1.; n = 1.; };"
    "strength = { shear_modulus = 1.; form = \"none\"; };";

/* A bump of longitudinal (axis 0) or transverse (axis 1) velocity in a bar of n particles splits
 * into two halves that run apart at the wave speed: the way of the right one's centroid between
 * two times. */
static double bar_speed(int axis, int n, double guess)
{
  double dx = 1. / n, at[2] = {0, 0};
  Parts *p = lab_parts(n, 1, BASALT);
  Param par = lab_param("gravity.method=none", "viscosity.alpha=0", "viscosity.beta=0",
                        "kernel=cubic_spline", NULL);
  Sim sim;
  for (long i = 0; i < n; i++) {
    double x = (i + .5) * dx;
    p->x[3 * i] = x, p->v[3 * i + axis] = .1 * exp(-pow((x - .5) / .05, 2));
    p->m[i] = 2700 * dx, p->rho[i] = 2700, p->h[i] = 4 * dx;
  }
  lab_open(&sim, &par, p);
  for (int k = 0; k < 2; k++) {
    double sum = 0, way = 0;
    lab_run(&sim, (k ? .3 : .15) / guess);
    lab_store(&sim, p);
    for (long i = n / 2; i < n; i++)
      sum += p->v[3 * i + axis], way += p->v[3 * i + axis] * p->x[3 * i];
    at[k] = way / sum;
  }
  sim_close(&sim);
  part_free(p);
  return (at[1] - at[0]) / (.15 / guess);
}

static void waves(void **state)
{
  double cl = bar_speed(0, 200, 4593.3), ct = bar_speed(1, 200, 2899.6);
  (void)state;
  print_message("c_L %.1f (4593.3), c_T %.1f (2899.6)\n", cl, ct);
  assert_true(fabs(cl / 4593.3 - 1) < .01);
  assert_true(fabs(ct / 2899.6 - 1) < .01);
}

static int in_sphere(const double *x, void *data)
{
  (void)data;
  return x[0] * x[0] + x[1] * x[1] + x[2] * x[2] <= 1;
}

/* R = rho0 = c = K = mu = 1, Omega = 2 pi/100; returns L/L0 after `turns`. jitter in units
 * of dx. */
static double rotating(double dx, double turns, double jitter, const char *gradient, double *radius,
                       double *momentum)
{
  double omega = 2 * LAB_PI / 100, far = 0;
  long n = lab_lattice(dx, 20, 3, in_sphere, NULL, NULL);
  Parts *p = lab_parts(n, 3, RUBBER);
  Param par = lab_param("gravity.method=none", "kernel=cubic_spline", gradient, NULL);
  Sim sim;
  Sums a, b;
  lab_lattice(dx, 20, 3, in_sphere, NULL, p->x);
  srand(1);
  for (long i = 0; i < n; i++) {
    for (int d = 0; d < 3; d++) p->x[3 * i + d] += jitter * dx * (rand() / (double)RAND_MAX - .5);
    p->v[3 * i] = -omega * p->x[3 * i + 1], p->v[3 * i + 1] = omega * p->x[3 * i];
    p->m[i] = dx * dx * dx, p->rho[i] = 1, p->h[i] = 2.5 * dx;
  }
  lab_open(&sim, &par, p);
  lab_sums(&sim, &a);
  lab_run(&sim, 100 * turns);
  lab_sums(&sim, &b);
  lab_store(&sim, p);
  for (long i = 0; i < n; i++)
    far = fmax(far, sqrt(p->x[3 * i] * p->x[3 * i] + p->x[3 * i + 1] * p->x[3 * i + 1] +
                         p->x[3 * i + 2] * p->x[3 * i + 2]));
  *radius = far;
  *momentum = fabs(b.momentum[0]) / b.scale_momentum;
  sim_close(&sim);
  part_free(p);
  return b.angular[2] / a.angular[2];
}

static void sphere(void **state)
{
  double r, mom, l = rotating(.2, 1, 0, "form.gradient=corrected", &r, &mom);
  (void)state;
  print_message("L/L0 - 1 = %.2e, radius %.5f, momentum %.1e\n", l - 1, r, mom);
  assert_true(fabs(l - 1) < 1e-8);
  assert_true(r < 1.005 && r > .98);
  assert_true(mom < 1e-12);
  l = rotating(.2, 1, .2, "form.gradient=corrected", &r, &mom);
  print_message("jittered: L/L0 - 1 = %.2e\n", l - 1);
  assert_true(fabs(l - 1) < 1e-7);
  l = rotating(.2, .1, 0, "form.gradient=raw", &r, &mom);
  print_message("raw gradients, a tenth of a turn: L/L0 = %.3f\n", l);
  assert_true(l < .8 && mom < 1e-12);
}

/* The energy after 50 time units over that before, of 2^D particles `spacing` dx apart that have h
 * of a lattice of dx and small velocities. Their masses make a density of 1 at most. */
static double clump(int dimension, double spacing, int kern, const char *kernel)
{
  const double h = (double[]){4, 3, 2.5}[dimension - 1];
  const long n = 1L << dimension;
  const double most = pow(h, dimension) / kernel_sigma(kern, dimension) / kernel_w(kern, 3, 0);
  Parts *p = lab_parts(n, dimension, RUBBER);
  Param par = lab_param("gravity.method=none", "smoothing.mode=fixed", kernel, NULL);
  Sim sim;
  Sums a, b;
  for (long i = 0; i < n; i++) {
    for (int d = 0; d < dimension; d++) {
      p->x[3 * i + d] = (double)(i >> d & 1) * spacing;
      p->v[3 * i + d] = 1e-3 * sin(1 + 78 * (double)(dimension * i + d));
    }
    p->m[i] = fmin(1, most / (double)n), p->rho[i] = 1, p->h[i] = h;
  }
  lab_open(&sim, &par, p);
  lab_sums(&sim, &a);
  lab_run(&sim, 50);
  lab_sums(&sim, &b);
  sim_close(&sim);
  part_free(p);
  return (b.kinetic + b.internal) / a.kinetic;
}

/* Particles much closer together than h: corrected gradients grow as 1/spacing there, the step does
 * not know it, and the energy would grow by 10^7 and more. */
static void clumps(void **state)
{
  double worst = 0;
  (void)state;
  for (int dimension = 1; dimension <= 3; dimension++)
    for (double spacing = .4; spacing > .01; spacing *= .6) {
      worst = fmax(worst, clump(dimension, spacing, KERNEL_CUBIC_SPLINE, "kernel=cubic_spline"));
      worst = fmax(worst, clump(dimension, spacing, KERNEL_WENDLAND_C2, "kernel=wendland_c2"));
      worst = fmax(worst, clump(dimension, spacing, KERNEL_WENDLAND_C6, "kernel=wendland_c6"));
    }
  print_message("clumps: energy grows by a factor of %.3f at most\n", worst);
  assert_true(worst < 1.1);
}

/* S of a rigidly rotating element is Q S0 Q^T; a literal 001 eq. 9 gives S_xy of the other
 * sign. */
static void objectivity(void **state)
{
  double g[9] = {0, -1, 0, 1, 0, 0, 0, 0, 0}, dt = 2 * LAB_PI / 1000, s0 = 1e6;
  Sym s = {s0, 0, 0, -s0, 0, 0}, rate = passes_jaumann(s, g, 1e9),
      next = passes_elastic(s, g, 1e9, 1e-6);
  (void)state;
  assert_true(fabs(rate.xy - 2 * s0) < 1e-9 * s0 && fabs(rate.xx) < 1e-9 * s0);
  assert_true(fabs((next.xy - s.xy) / 1e-6 - rate.xy) < 1e-5 * s0);
  for (int k = 1; k <= 1000; k++) {
    s = passes_elastic(s, g, 1e9, dt);
    if (k == 125)
      assert_true(fabs(s.xy - s0) < 1e-6 * s0 && fabs(s.xx) < 1e-6 * s0); /* 45 degrees */
  }
  assert_true(fabs(s.xx - s0) < 1e-6 * s0 && fabs(s.xy) < 1e-6 * s0);
}

/* The rate form that rk2 uses and the step form that leapfrog uses agree for any velocity
 * gradient and stress. */
static void rate_and_step(void **state)
{
  double g[9] = {.3, -1.2, .7, .4, -.2, .9, -.5, .1, .6}, dt = 1e-6;
  Sym s = {1, .4, -.3, -.6, .2, -.4}, r = passes_jaumann(s, g, 2.5),
      t = passes_elastic(s, g, 2.5, dt);
  double d[6] = {t.xx - s.xx, t.xy - s.xy, t.xz - s.xz, t.yy - s.yy, t.yz - s.yz, t.zz - s.zz};
  double e[6] = {r.xx, r.xy, r.xz, r.yy, r.yz, r.zz};
  (void)state;
  for (int k = 0; k < 6; k++) assert_true(fabs(d[k] / dt - e[k]) < 1e-4);
}

static void simple_shear(void **state)
{
  double g[9] = {0, 1, 0, 0, 0, 0, 0, 0, 0}, mu = 3;
  Sym s = {0, 0, 0, 0, 0, 0};
  (void)state;
  for (int k = 0; k < 1000; k++) s = passes_elastic(s, g, mu, 1e-3);
  assert_true(fabs(s.xy - mu * sin(1)) < 1e-4 * mu);
  assert_true(fabs(s.xx - s.yy - 2 * mu * (1 - cos(1))) < 1e-4 * mu);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(waves),         cmocka_unit_test(sphere),
      cmocka_unit_test(clumps),        cmocka_unit_test(objectivity),
      cmocka_unit_test(rate_and_step), cmocka_unit_test(simple_shear)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
