/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What each setting of a run promises, with both integrators: damping in the frame of each body,
 * frozen entropy, the smoothing modes, the density modes and their interfaces (docs/theory.md
 * 2.2), yield. */
#include <omp.h>
#include "lab.h"
#include "../lib/rng.h"

static const char GAS[] = "name = \"gas\"; eos = { form = \"ideal\"; gamma = 1.4; };";
static const char METAL[] =
    "name = \"m\"; eos = { form = \"murnaghan\"; rho0 = 1.; K = 1.; n = 2.; };"
    "strength = { shear_modulus = 1.; form = \"von_mises\"; Y = 0.02; };";
static const char *const integrators[] = {"integrator=leapfrog", "integrator=rk2-adaptive"};

static double noise(long i, int k) { return 2 * rng_uniform(17, (uint64_t)i, (uint32_t)k) - 1; }

static int in_ball(const double *x, void *data)
{
  (void)data;
  return x[0] * x[0] + x[1] * x[1] + x[2] * x[2] < 1;
}

/* `bodies` balls of unit radius and mass, 8 apart. */
static Parts *balls(int bodies, const char *material)
{
  double dx = .31;
  long n = lab_lattice(dx, 5, 3, in_ball, NULL, NULL);
  Parts *p = lab_parts(bodies * n, 3, material);
  for (int b = 0; b < bodies; b++) lab_lattice(dx, 5, 3, in_ball, NULL, p->x + 3 * n * b);
  for (long i = 0; i < p->n; i++) {
    p->x[3 * i] += 8. * (double)(i / n), p->body[i] = (int32_t)(i / n);
    p->m[i] = 1. / (double)n, p->rho[i] = .24, p->h[i] = 2.2 * dx;
  }
  return p;
}

/* Velocity of a body's centre, and the rms velocity against rigid rotation with omega about z. */
static double stir(const Parts *p, int body, double omega, double v[3])
{
  double c[3] = {0}, n = 0, sum = 0;
  memset(v, 0, 3 * sizeof *v);
  for (long i = 0; i < p->n; i++)
    for (int d = 0; d < 3 && p->body[i] == body; d++)
      c[d] += p->x[3 * i + d], v[d] += p->v[3 * i + d], n += 1. / 3;
  for (int d = 0; d < 3; d++) c[d] /= n, v[d] /= n;
  for (long i = 0; i < p->n; i++) {
    const double *x = &p->x[3 * i], *w = &p->v[3 * i];
    if (p->body[i] != body) continue;
    sum += pow(w[0] - v[0] + omega * (x[1] - c[1]), 2);
    sum += pow(w[1] - v[1] - omega * (x[0] - c[0]), 2) + pow(w[2] - v[2], 2);
  }
  return sqrt(sum / n);
}

static Sums sums_of(Sim *sim)
{
  Sums s;
  lab_sums(sim, &s);
  return s;
}

/* One ball of dust, turning and stirred: the stir dies as exp(-rate t); momentum and spin stay
 * to rounding. */
static void damping(void **state)
{
  (void)state;
  for (int k = 0; k < 2; k++) {
    Parts *p = balls(1, GAS);
    Param par = lab_param("gravity.method=none", "viscosity.alpha=0", "viscosity.beta=0",
                          "damping.rate=2", "step.max=0.02", integrators[k], NULL);
    Sim sim;
    Sums a, b;
    double v[3], omega, inertia = 0, before;
    for (long i = 0; i < p->n; i++) {
      double *x = &p->x[3 * i], *w = &p->v[3 * i];
      w[0] = .5 - 1e-3 * x[1], w[1] = 1e-3 * x[0];
      for (int d = 0; d < 3; d++) w[d] += .1 * noise(i, 0) * x[d]; /* no spin in that */
      inertia += p->m[i] * (x[0] * x[0] + x[1] * x[1]);
    }
    lab_open(&sim, &par, p);
    a = sums_of(&sim), omega = a.angular[2] / inertia, before = stir(p, 0, omega, v);
    lab_run(&sim, 1);
    b = sums_of(&sim);
    lab_store(&sim, p);
    print_message("%s: stir %.4f -> %.4f (%.4f), L %.1e, p %.1e\n", integrators[k], before,
                  stir(p, 0, omega, v), before * exp(-2), b.angular[2] / a.angular[2] - 1,
                  b.momentum[0] / a.momentum[0] - 1);
    for (int d = 0; d < 3; d++) {
      assert_true(fabs(b.momentum[d] - a.momentum[d]) < 1e-13);
      assert_true(fabs(b.angular[d] - a.angular[d]) < (k ? 1e-7 : 1e-13));
    }
    assert_true(fabs(stir(p, 0, omega, v) / (before * exp(-2)) - 1) < .02);
    sim_close(&sim);
    part_free(p);
  }
}

/* Two balls of dust that turn are brought to another rotation: omega relaxes to it as exp(-rate t);
 * neither gets a push. */
static void spin_up(void **state)
{
  const double target = 2 * LAB_PI / 100, rate = 2;
  (void)state;
  for (int k = 0; k < 2; k++) {
    Parts *p = balls(2, GAS);
    Param par =
        lab_param("gravity.method=none", "viscosity.alpha=0", "viscosity.beta=0", "spin.rate=2",
                  "spin.period=100", "spin.axis=2,0,0", "step.max=0.02", integrators[k], NULL);
    Sim sim;
    Sums s;
    for (long i = 0; i < p->n; i++)
      p->v[3 * i] = .1, p->v[3 * i + 1] = -.01 * p->x[3 * i + 2],
               p->v[3 * i + 2] = .01 * p->x[3 * i + 1];
    lab_open(&sim, &par, p);
    lab_run(&sim, 1);
    lab_sums(&sim, &s), lab_store(&sim, p);
    assert_true(fabs(s.momentum[0] / .2 - 1) < 1e-12 && fabs(s.momentum[1]) < 1e-13);
    for (int b = 0; b < 2; b++) {
      double l = 0, inertia = 0, want = target + (.01 - target) * exp(-rate);
      for (long i = 0; i < p->n; i++) {
        const double *x = &p->x[3 * i], *v = &p->v[3 * i];
        if (p->body[i] == b) l += x[1] * v[2] - x[2] * v[1], inertia += x[1] * x[1] + x[2] * x[2];
      }
      print_message("%s: omega %.6f (%.6f)\n", integrators[k], l / inertia, want);
      assert_true(fabs(l / inertia / want - 1) < 5e-3);
    }
    sim_close(&sim), part_free(p);
  }
}

/* Two bodies fall towards each other as if they were not damped. */
static void fall(void **state)
{
  (void)state;
  for (int k = 0; k < 2; k++) {
    double v[2][3];
    for (int damped = 0; damped < 2; damped++) {
      Parts *p = balls(2, GAS);
      Param par = lab_param("gravity.G=0.1", "gravity.method=direct", "viscosity.alpha=0",
                            "viscosity.beta=0", damped ? "damping.rate=2" : "damping.rate=0",
                            "step.max=0.1", integrators[k], NULL);
      Sim sim;
      lab_open(&sim, &par, p);
      lab_run(&sim, 1.5);
      lab_store(&sim, p);
      stir(p, 0, 0, v[damped]);
      sim_close(&sim);
      part_free(p);
    }
    assert_true(v[0][0] > .002);
    assert_true(fabs(v[1][0] / v[0][0] - 1) < 1e-4); /* 1e-2 and more when the half kick counts */
  }
}

/* Only eight bodies have frames. */
static void too_many_bodies(void **state)
{
  Parts *p = balls(1, GAS);
  Param par = lab_param("damping.rate=1", NULL);
  Sim sim;
  Err err;
  (void)state;
  p->body[3] = 8;
  assert_int_equal(sim_open(&sim, &par, p, lab_device(), &err), -1);
  assert_non_null(strstr(err.text, "of body 8"));
  part_free(p);
}

/* A segment of gas that pulsates and shocks; the largest change of the entropy function
 * p/rho^gamma. */
static double entropy(const char *integrator, const char *energy)
{
  long n = 100;
  Parts *p = lab_parts(n, 1, GAS);
  Param par = lab_param("gravity.method=none", "step.cfl=0.2", "density=continuity", integrator,
                        energy, NULL);
  Sim sim;
  double worst = 0;
  for (long i = 0; i < n; i++) {
    double x = (i + .5) / n;
    p->x[3 * i] = x, p->v[3 * i] = .5 * sin(2 * LAB_PI * x), p->m[i] = 1. / n, p->rho[i] = 1;
    p->u[i] = 1, p->h[i] = 4. / n;
  }
  lab_open(&sim, &par, p);
  lab_run(&sim, .4);
  lab_store(&sim, p);
  for (long i = 0; i < n; i++) worst = fmax(worst, fabs(p->u[i] / pow(p->rho[i], .4) - 1));
  sim_close(&sim);
  part_free(p);
  return worst;
}

static void isentropic(void **state)
{
  (void)state;
  for (int k = 0; k < 2; k++) {
    double frozen = entropy(integrators[k], "energy=isentropic"),
           full = entropy(integrators[k], "energy=full");
    print_message("%s: entropy changes by %.1e, full %.2f\n", integrators[k], frozen, full);
    assert_true(frozen < 1e-4 && full > .02);
  }
}

/* Smoothing: fixed keeps h; density keeps h rho^(1/D); neighbours brings 26 to the 60 asked for,
 * overcorrected lets h grow while they are too few. */
static void smoothing(void **state)
{
  static const char *const modes[] = {"smoothing.mode=fixed", "smoothing.mode=density",
                                      "smoothing.mode=neighbours", "smoothing.mode=overcorrected"};
  (void)state;
  for (int k = 0; k < 8; k++) {
    Parts *p = balls(1, GAS);
    Param par = lab_param("gravity.method=none", "smoothing.neighbours=60", modes[k / 2],
                          integrators[k % 2], "step.max=0.005", NULL);
    Sim sim;
    double h = 1.8 * .31, worst = 0, mean = 0, least = 1;
    long inner = 0;
    for (long i = 0; i < p->n; i++) p->u[i] = .3, p->h[i] = h;
    lab_open(&sim, &par, p);
    lab_run(&sim, .5);
    lab_store(&sim, p);
    for (long i = 0; i < p->n; i++) {
      double *x = &p->x[3 * i], r2 = x[0] * x[0] + x[1] * x[1] + x[2] * x[2];
      worst = fmax(worst, fabs(p->h[i] / h * (k / 2 ? cbrt(p->rho[i] / .24) : 1) - 1));
      least = fmin(least, p->rho[i]);
      if (r2 < .04) mean += p->nngb[i], inner++;
    }
    mean /= (double)inner;
    print_message("%s %s: %.1e, %.1f neighbours inside, density down to %.3f\n", modes[k / 2],
                  integrators[k % 2], worst, mean, least);
    if (k / 2 == 0) assert_true(worst == 0);
    if (k / 2 == 1) assert_true(worst < 1e-4 && least < .21);
    if (k / 2 == 2) assert_true(fabs(mean / 60 - 1) < .1);
    if (k / 2 == 3) assert_true(mean > 30 && worst > .1 && worst < .3);
    sim_close(&sim);
    part_free(p);
  }
}

/* A cubic block of heavy (x < 0) and light particles, equal volumes, ratio of densities as
 * given. */
static Parts *interface_block(double ratio, int half, int across)
{
  long wide = 2 * across + 1, n = 2 * half * wide * wide, i = 0;
  Parts *p = lab_parts(n, 3, GAS);
  Err err;
  assert_int_equal(
      part_add_material(p, "b", "name = \"b\"; eos = { form = \"ideal\"; gamma = 2.; };", &err), 1);
  for (long a = -half; a < half; a++)
    for (long b = -across; b <= across; b++)
      for (long c = -across; c <= across; c++, i++) {
        double rho = a < 0 ? ratio : 1;
        p->x[3 * i] = (double)a + .5, p->x[3 * i + 1] = (double)b, p->x[3 * i + 2] = (double)c;
        p->m[i] = p->rho[i] = rho, p->h[i] = 2.5, p->mat[i] = a < 0;
        p->u[i] = 1 / ((a < 0 ? 1 : .4) * rho); /* p = 1 on both sides */
      }
  return p;
}

/* A kernel sum smears a jump of density (with ratio 1.768 the heavy layer has 0.905, the
 * light one 1.169 of its own), the number-density form does not; so the pressure jumps there or
 * not. */
static void interfaces(void **state)
{
  static const char *const modes[] = {"density=sum", "density=miscible"};
  const double ratios[] = {1.768, 3};
  (void)state;
  for (int k = 0; k < 4; k++) {
    double ratio = ratios[k / 2], at[2] = {0}, inner = 0, pressure[2] = {0};
    Parts *p = interface_block(ratio, 7, 3);
    Param par = lab_param("gravity.method=none", "kernel=cubic_spline", modes[k % 2], NULL);
    Sim sim;
    lab_open(&sim, &par, p);
    lab_store(&sim, p);
    for (long i = 0; i < p->n; i++) {
      int light = p->x[3 * i] > 0;
      if (p->x[3 * i + 1] != 0 || p->x[3 * i + 2] != 0) continue;
      if (p->x[3 * i] == 3.5) inner = p->rho[i]; /* what a lattice of the light ones has */
      if (fabs(p->x[3 * i]) < 1)
        at[light] = p->rho[i] / (light ? 1 : ratio), pressure[light] = p->p[i];
    }
    print_message("%s, ratio %.3f: heavy %.3f, light %.3f, p %.3f %.3f\n", modes[k % 2], ratio,
                  at[0] / inner, at[1] / inner, pressure[0] / inner, pressure[1] / inner);
    for (int side = 0; side < 2 && k % 2; side++) {
      assert_true(fabs(at[side] / inner - 1) < 1e-12);
      assert_true(fabs(pressure[side] / inner - 1) < 1e-12);
    }
    if (k == 0) assert_true(fabs(at[0] / inner - .905) < .01 && fabs(at[1] / inner - 1.169) < .01);
    if (k == 2) assert_true(at[0] / inner < .87 && at[1] / inner > 1.3);
    sim_close(&sim);
    part_free(p);
  }
}

/* Shear beyond the yield stress: both integrators end on the yield surface with the same plastic
 * strain, the elastic part of the strain taken off; turned back, the stress changes its sign at
 * once. */
static void yield(void **state)
{
  double strain[2], back[2];
  (void)state;
  for (int k = 0; k < 2; k++) {
    Parts *p = balls(1, METAL);
    Param par = lab_param("gravity.method=none", "step.max=0.01", integrators[k], NULL);
    Sim sim;
    long centre = 0;
    for (long i = 0; i < p->n; i++) {
      double *x = &p->x[3 * i];
      p->rho[i] = 1, p->m[i] = .31 * .31 * .31, p->v[3 * i] = .3 * x[1];
      if (x[0] * x[0] + x[1] * x[1] + x[2] * x[2] < 1e-9) centre = i;
    }
    lab_open(&sim, &par, p);
    lab_run(&sim, .3);
    lab_store(&sim, p);
    strain[k] = p->strain[centre];
    for (long i = 0; i < p->n; i++)
      assert_true(sqrt(3 * tensor_j2(passes_stress(&p->s[6 * i]))) <= .02 * (1 + 1e-12));
    assert_true(p->s[6 * centre + 1] > .99 * .02 / sqrt(3));
    State s = lab_state(&sim);
    for (long i = 0; i < 3 * p->n; i++) s.v[i] *= -1;
    lab_keep(&sim, &s), lab_forget(&s);
    lab_run(&sim, .35); /* .05 * .3 < 2 Y/sqrt(3)/mu: unloading is elastic */
    lab_store(&sim, p);
    back[k] = p->s[6 * centre + 1];
    print_message("%s: plastic strain %.5f, S_xy back to %.5f\n", integrators[k], strain[k],
                  back[k]);
    assert_true(fabs(p->strain[centre] - strain[k]) < 1e-3 * strain[k]);
    sim_close(&sim);
    part_free(p);
  }
  assert_true(fabs(strain[0] - (.09 - .02 / sqrt(3)) / sqrt(3)) <
              .05 * strain[0]); /* gamma/sqrt 3 */
  assert_true(fabs(strain[1] / strain[0] - 1) < .01);
  assert_true(fabs(back[1] - back[0]) < 1e-4 && back[0] < 0);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(damping),         cmocka_unit_test(spin_up),    cmocka_unit_test(fall),
      cmocka_unit_test(too_many_bodies), cmocka_unit_test(isentropic), cmocka_unit_test(smoothing),
      cmocka_unit_test(interfaces),      cmocka_unit_test(yield)};
  omp_set_num_threads(1);
  return cmocka_run_group_tests(tests, NULL, NULL);
}
