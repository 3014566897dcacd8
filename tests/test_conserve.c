/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a run conserves: momentum to rounding with direct gravity, angular
 * momentum of fluids, energy; a boosted and a mirrored system do the same; a free oscillation
 * keeps its energy; a planar run stays in its plane. And a bar that is pulled breaks where it
 * has flaws, and only then. */
#include <omp.h>
#include "lab.h"
#include "../lib/rng.h"

static const char WATER[] =
    "name = \"w\"; eos = { form = \"murnaghan\"; rho0 = 1.; K = 1.; n = 2.; };";
static const char ROCK[] =
    "name = \"rock\"; eos = { form = \"murnaghan\"; rho0 = 1.; K = 1.; n = 1.; };"
    "strength = { shear_modulus = 0.6; form = \"none\"; };"
    "damage = { form = \"grady_kipp\"; k = 1e10; m = 5.; };";

static int in_ball(const double *x, void *data)
{
  (void)data;
  return x[0] * x[0] + x[1] * x[1] + x[2] * x[2] < 1;
}

/* Two drops of water (discs in 2D) that collide off-centre, all in motion with `boost`, x times
 * `mirror`. */
static Parts *drops(int dimension, double boost, int mirror)
{
  double dx = .31;
  long n = lab_lattice(dx, 5, dimension, in_ball, NULL, NULL);
  Parts *p = lab_parts(2 * n, dimension, WATER);
  lab_lattice(dx, 5, dimension, in_ball, NULL, p->x);
  lab_lattice(dx, 5, dimension, in_ball, NULL, p->x + 3 * n);
  for (long i = 0; i < p->n; i++) {
    int b = i >= n;
    p->body[i] = b, p->m[i] = dimension == 3 ? dx * dx * dx : dx * dx;
    p->rho[i] = 1, p->h[i] = 2.2 * dx;
    p->x[3 * i] = mirror * (p->x[3 * i] + (b ? 1.2 : -1.2)), p->x[3 * i + 1] += b ? .4 : -.4;
    p->v[3 * i] = mirror * (boost + (b ? -.4 : .4));
  }
  return p;
}

static void run(Parts *p, const Param *par, double t, int *steps, Sums *a, Sums *b)
{
  Sim sim;
  lab_open(&sim, par, p);
  lab_sums(&sim, a);
  *steps = (int)lab_run(&sim, t);
  lab_sums(&sim, b);
  lab_store(&sim, p);
  sim_close(&sim);
}

/* With h that varies the potential energy changes with the softening, for which the forces have no
 * term: energy is kept to 1 % there, to 5e-4 with h fixed. */
static double energy(const Sums *s) { return s->kinetic + s->internal + s->potential; }

static void collision(void **state)
{
  static const char *const integrators[] = {"integrator=leapfrog", "integrator=rk2-adaptive"};
  static const char *const densities[] = {"density=continuity", "density=miscible",
                                          "density=miscible_continuity"};
  static const char *const modes[] = {"smoothing.mode=fixed", "smoothing.mode=density"};
  (void)state;
  for (int k = 0; k < 12; k++) {
    Parts *p = drops(3, 0, 1);
    Param par = lab_param("gravity.G=0.05", "gravity.method=direct", integrators[k % 2],
                          densities[k / 2 % 3], k % 2 ? "step.max=0" : "step.max=0.006",
                          modes[k / 6], "precision=double", NULL);
    Sums a, b;
    int steps;
    double l = 0, m = 0;
    run(p, &par, 6, &steps, &a, &b);
    for (int d = 0; d < 3; d++)
      m = fmax(m, fabs(b.momentum[d])), l = fmax(l, fabs(b.angular[d] - a.angular[d]));
    print_message("%s %s: %d steps, p %.1e, L %.1e, E %.1e, kinetic %.3f -> %.3f\n",
                  integrators[k % 2], densities[k / 2 % 3], steps, m / b.scale_momentum,
                  l / fabs(a.angular[2]), (energy(&b) - energy(&a)) / a.kinetic, a.kinetic,
                  b.kinetic);
    assert_true(k % 2 || steps >= 1000);
    assert_true(m < 1e-13 * b.scale_momentum);
    assert_true(l < (k % 2 ? 1e-5 : 1e-12) * fabs(a.angular[2]));
    assert_true(fabs(energy(&b) - energy(&a)) < (k < 6 ? 5e-4 : 1e-2) * a.kinetic);
    assert_true(b.mass == a.mass);
    part_free(p);
  }
}

/* The same positions in a moving frame and in a mirror. */
static void frames(void **state)
{
  (void)state;
  for (int k = 0; k < 4; k++) {
    Parts *p = drops(3, 0, 1), *q = drops(3, k % 2 ? 10 : 0, k % 2 ? 1 : -1);
    Param par = lab_param("gravity.G=0.05", "gravity.method=direct", "step.max=0.02", "step.cfl=2",
                          "step.acceleration=2", "step.density=10",
                          k / 2 ? "integrator=rk2-adaptive" : "integrator=leapfrog", "step.error=1",
                          "precision=double", NULL);
    Sums a, b;
    int steps;
    double worst = 0;
    run(p, &par, 2, &steps, &a, &b), run(q, &par, 2, &steps, &a, &b);
    for (long i = 0; i < p->n; i++)
      for (int d = 0; d < 3; d++) {
        double x = q->x[3 * i + d];
        if (d == 0) x = k % 2 ? x - 20 : -x;
        worst = fmax(worst, fabs(x - p->x[3 * i + d]));
      }
    print_message("%s: %.1e\n", k % 2 ? "boosted" : "mirrored", worst);
    assert_true(worst < 1e-10);
    part_free(p), part_free(q);
  }
}

/* A drop that breathes without viscosity: after some 1800 steps the energy is where it was. */
static void oscillation(void **state)
{
  Parts *p = drops(3, 0, 1);
  Param par = lab_param("gravity.method=none", "viscosity.alpha=0", "viscosity.beta=0",
                        "step.cfl=0.05", NULL);
  Sums a, b;
  int steps;
  (void)state;
  for (long i = 0; i < p->n; i++) {
    double c = p->body[i] ? 1.2 : -1.2, e = p->body[i] ? .4 : -.4;
    p->x[3 * i] += 10 * c;
    p->v[3 * i] = .01 * (p->x[3 * i] - 11 * c), p->v[3 * i + 1] = .01 * (p->x[3 * i + 1] - e);
    p->v[3 * i + 2] = .01 * p->x[3 * i + 2];
  }
  run(p, &par, 30, &steps, &a, &b);
  print_message("%d steps: E %.1e of what swings\n", steps, (energy(&b) - energy(&a)) / a.kinetic);
  assert_true(steps > 1500 && fabs(energy(&b) - energy(&a)) < .01 * a.kinetic);
  part_free(p);
}

static void planar(void **state)
{
  Parts *p = drops(2, 0, 1);
  Param par = lab_param("gravity.G=0.05", "gravity.method=tree", NULL);
  Sums a, b;
  int steps;
  double far = 0;
  (void)state;
  run(p, &par, 6, &steps, &a, &b);
  for (long i = 0; i < p->n; i++) {
    assert_true(p->x[3 * i + 2] == 0 && p->v[3 * i + 2] == 0);
    far = fmax(far, fabs(p->x[3 * i + 1]));
  }
  print_message("2D: L %.1e, E %.1e\n", b.angular[2] / a.angular[2] - 1,
                (energy(&b) - energy(&a)) / a.kinetic);
  assert_true(far > 1.5); /* it spread sideways */
  assert_true(fabs(b.angular[2] / a.angular[2] - 1) < 1e-3);
  assert_true(fabs(energy(&b) / energy(&a) - 1) < 2e-2);
  part_free(p);
}

/* A strip of 30 x 10 whose ends are pulled apart: damage only grows, keeps to the active
 * flaws, and with flaws in the middle half the strip parts; without flaws it has sprung back by
 * then. */
static void tensile(int flaws, double *apart, double *worst)
{
  long nx = 45, ny = 15;
  double dx = 1. / 15;
  Parts *p = lab_parts(nx * ny, 2, ROCK);
  Param par = lab_param("gravity.method=none", NULL);
  Sim sim;
  Err err;
  p->nflaw = calloc((size_t)p->n, sizeof *p->nflaw);
  p->flaw = malloc(sizeof(double) * 8 * (size_t)p->n);
  for (long i = 0; i < p->n; i++) {
    double *x = &p->x[3 * i];
    x[0] = ((double)(i % nx) - 22) * dx, x[1] = ((double)(i / nx) - 7) * dx;
    p->v[3 * i] = fabs(x[0]) > 1.3 ? copysign(.01, x[0]) : 0;
    p->m[i] = dx * dx, p->rho[i] = 1, p->h[i] = 2.6 * dx;
    p->nflaw[i] = flaws && fabs(x[0]) < .8 ? 8 : 0;
    for (int f = 0; f < p->nflaw[i]; f++)
      p->flaw[p->flaws++] = 2e-3 * (1 + .3 * rng_uniform(9, (uint64_t)i, 0)) + 2e-4 * f;
  }
  assert_return_code(part_add(p, "damage nact", &err), 0);
  lab_open(&sim, &par, p);
  double *before = calloc((size_t)p->n, sizeof *before);
  for (int k = 1; k <= 7; k++) {
    lab_run(&sim, .5 * k);
    lab_store(&sim, p);
    for (long i = 0; i < p->n; i++) {
      assert_true(p->damage[i] >= before[i] && p->damage[i] <= 1);
      assert_true(p->damage[i] * p->nflaw[i] <= p->nact[i] + 1e-12);
      assert_true(p->nact[i] <= p->nflaw[i]);
      before[i] = p->damage[i];
    }
  }
  long ends = 0;
  *worst = *apart = 0;
  for (long i = 0; i < p->n; i++) {
    *worst = fmax(*worst, p->damage[i]);
    if (fabs(p->x[3 * i]) > .8) *apart += copysign(1, p->x[3 * i]) * p->v[3 * i], ends++;
  }
  *apart /= (double)ends;
  free(before);
  sim_close(&sim);
  part_free(p);
}

static void bar(void **state)
{
  double intact, broken, d[2];
  (void)state;
  tensile(0, &intact, &d[0]), tensile(1, &broken, &d[1]);
  print_message("the ends part at %.5f, with flaws %.5f, damage %.2f\n", intact, broken, d[1]);
  assert_true(d[0] == 0 && d[1] > .9);
  assert_true(intact < 0 && broken > 1e-3);
}

#define PORES(MORE)                                                                                \
  "name = \"rock\"; eos = { form = \"murnaghan\"; rho0 = 1.5; K = 1.; n = 1.; };"                  \
  "strength = { shear_modulus = 0.6; form = \"lundborg\"; cohesion = 0.02; friction = 1.; };" MORE

/* Two balls of rock that collide: with a porosity law and alpha_0 = 1 the same bits as without;
 * with pores, energy and momentum are kept while they crush. */
static void pores(void **state)
{
  static const char *const T[] = {
      PORES(""), PORES("porosity = { form = \"p_alpha\"; alpha_0 = 1.; p_e = 0.01; p_s = 0.2; };"),
      PORES("porosity = { form = \"p_alpha\"; alpha_0 = 1.5; p_e = 1e-3; p_s = 0.2; };"),
      PORES("porosity = { form = \"p_alpha\"; alpha_0 = 1.5; c_elastic = .4; p_e = 1e-3; p_s = "
            "0.2; };"),
      PORES(
          "porosity = { form = \"epsilon_alpha\"; alpha_0 = 1.5; kappa = .9; epsilon_x = -.2; };")};
  Parts *p[5];
  (void)state;
  for (int k = 0; k < 5; k++)
    for (int rk = 0; rk < 2; rk++) {
      Param par = lab_param("gravity.method=none", "precision=double", "smoothing.mode=fixed",
                            rk ? "integrator=rk2-adaptive" : "step.cfl=0.1", NULL);
      Sums a, b;
      int steps;
      double least = INFINITY;
      Err err;
      if (rk) part_free(p[k]);
      p[k] = drops(3, 0, 1);
      free(p[k]->material[0].text), p[k]->material[0].text = strdup(T[k]);
      assert_return_code(part_add(p[k], "alpha", &err), 0);
      for (long i = 0; i < p[k]->n && k < 2; i++) p[k]->rho[i] = 1.5, p[k]->m[i] *= 1.5;
      run(p[k], &par, 2, &steps, &a, &b);
      for (long i = 0; i < p[k]->n; i++) least = fmin(least, p[k]->alpha[i]);
      print_message("%s: %d steps, alpha down to %.3f, p %.1e, E %.1e\n", rk ? "rk2" : "leapfrog",
                    steps, least, fabs(b.momentum[0]) / b.scale_momentum,
                    (energy(&b) - energy(&a)) / a.kinetic);
      assert_true(k < 2 || (least >= 1 && least < 1.3));
      assert_true(fabs(b.momentum[0]) < 1e-13 * b.scale_momentum);
      assert_true(fabs(energy(&b) - energy(&a)) < 2e-3 * a.kinetic);
    }
  assert_memory_equal(p[0]->x, p[1]->x, sizeof(double) * 3 * (size_t)p[0]->n);
  assert_memory_equal(p[0]->u, p[1]->u, sizeof(double) * (size_t)p[0]->n);
  assert_memory_equal(p[0]->s, p[1]->s, sizeof(double) * 6 * (size_t)p[0]->n);
  for (int k = 0; k < 5; k++) part_free(p[k]);
}

/* The tree's forces have neither resultant nor torque, one body or two far apart (with 1 of them
 * and theta 1 their errors are 1e-4 of the forces). No viscosity: in single precision a force
 * between two particles is along the line between them to 6e-8 of it only. */
static void recoil(void **state)
{
  (void)state;
  for (int apart = 0; apart < 2; apart++) {
    Parts *p = drops(3, 0, 1);
    Param par = lab_param("gravity.G=1", "gravity.method=tree", "gravity.theta=1",
                          "viscosity.alpha=0", "viscosity.beta=0", NULL);
    double f[3] = {0}, t[3] = {0}, force = 0, torque = 0;
    Sim sim;
    for (long i = 0; i < p->n; i++)
      p->x[3 * i] += apart * (p->body[i] ? 30 : -20), p->x[3 * i + 1] += apart * 7.;
    lab_open(&sim, &par, p);
    lab_store(&sim, p);
    for (long i = 0; i < p->n; i++) {
      const double *x = &p->x[3 * i], *a = &p->a[3 * i], m = p->m[i];
      for (int d = 0; d < 3; d++) {
        int e = (d + 1) % 3, g = (d + 2) % 3;
        f[d] += m * a[d], t[d] += m * (x[e] * a[g] - x[g] * a[e]);
        force += m * fabs(a[d]), torque += m * (fabs(x[e] * a[g]) + fabs(x[g] * a[e]));
      }
    }
    for (int d = 0; d < 3; d++)
      assert_true(fabs(f[d]) < 1e-14 * force && fabs(t[d]) < 1e-14 * torque);
    sim_close(&sim);
    part_free(p);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(collision),   cmocka_unit_test(frames),
                                     cmocka_unit_test(oscillation), cmocka_unit_test(planar),
                                     cmocka_unit_test(recoil),      cmocka_unit_test(bar),
                                     cmocka_unit_test(pores)};
  omp_set_num_threads(1);
  return cmocka_run_group_tests(tests, NULL, NULL);
}
