/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Faces of the box: a uniform periodic box stays at rest; a wave goes through a periodic face as in
 * a box twice as long; momentum is kept; one half before a mirror does what both halves do. */
#include <omp.h>
#include "lab.h"
#include "../lib/rng.h"

static const char GAS[] = "name = \"gas\"; eos = { form = \"ideal\"; gamma = 1.4; };";
static const char ROCK[] =
    "name = \"rock\"; eos = { form = \"murnaghan\"; rho0 = 1.; K = 1.; n = 1.; };"
    "strength = { shear_modulus = 0.6; form = \"none\"; };";

/* Everything that pairs may exchange (docs/theory.md 2.9 to 2.14, 3.7). */
static const char *const forms[] = {
    "pressure_form=product stress_form=squares form.xsph=0.5 form.diffusion=0.1 "
    "viscosity.switch=cullen_dehnen stress.artificial=0.3",
    "density=miscible viscosity.switch=morris_monaghan viscosity.balsara=true "
    "stress.artificial=0.2 stress_form=squares",
    "density=miscible_continuity form.xsph=0.3 viscosity.balsara=true",
    "viscosity.kinematic=0.02 viscosity.bulk=0.01 viscosity.compression=0.5",
    "form.shepard=true form.xsph=0.5 stress.artificial=0.3",
    "form.gradient=raw density=sum",
    "form.grad_h=true density=sum smoothing.max=2",
};
enum { FORMS = sizeof forms / sizeof *forms };

/* nx by ny by nz cells of size dx from the origin on, a particle in the middle of each. */
static Parts *block(int nx, int ny, int nz, double dx, const char *material)
{
  const int dimension = nz > 1 ? 3 : ny > 1 ? 2 : 1;
  Parts *p = lab_parts((long)nx * ny * nz, dimension, material);
  for (long i = 0; i < p->n; i++) {
    p->x[3 * i] = ((double)(i % nx) + .5) * dx;
    p->x[3 * i + 1] = dimension > 1 ? ((double)(i / nx % ny) + .5) * dx : 0;
    p->x[3 * i + 2] = dimension > 2 ? ((double)(i / nx / ny) + .5) * dx : 0;
    p->m[i] = pow(dx, dimension), p->rho[i] = 1, p->u[i] = 1, p->h[i] = 2.2 * dx;
  }
  return p;
}

static Param box_param(const char *density, const char *integrator)
{
  return lab_param("gravity.method=none", "boundary.x=periodic", "boundary.high=1,0,0", density,
                   integrator, "precision=double", NULL);
}

static void uniform(void **state)
{
  static const char *const densities[] = {"density=continuity", "density=sum", "density=miscible"};
  static const char *const integrators[] = {"integrator=leapfrog", "integrator=rk2-adaptive"};
  (void)state;
  for (int k = 0; k < 18; k++) {
    const int dimension = k / 6 + 1, n = dimension == 3 ? 6 : 10;
    Parts *p = block(n, dimension > 1 ? n : 1, dimension > 2 ? n : 1, 1. / n, GAS);
    Param par = box_param(densities[k % 3], integrators[k / 3 % 2]);
    Sim sim;
    double worst = 0, rho[2] = {1e9, 0};
    for (int d = 1; d < dimension; d++) par.faces[d] = PARAM_PERIODIC, par.high[d] = 1;
    for (long i = 0; i < p->n; i++) p->v[3 * i] = .7, p->v[3 * i + 1] = dimension > 1 ? -.4 : 0;
    lab_open(&sim, &par, p);
    lab_run(&sim, .9);
    lab_store(&sim, p);
    for (long i = 0; i < p->n; i++) {
      rho[0] = fmin(rho[0], p->rho[i]), rho[1] = fmax(rho[1], p->rho[i]);
      worst = fmax(worst, fabs(p->v[3 * i] - .7) + fabs(p->u[i] - 1));
      for (int d = 0; d < dimension; d++) assert_true(p->x[3 * i + d] >= 0 && p->x[3 * i + d] < 1);
    }
    print_message("%dD %s %s: v, u %.1e, rho %.1e\n", dimension, densities[k % 3],
                  integrators[k / 3 % 2], worst, rho[1] / rho[0] - 1);
    assert_true(worst < 1e-11 && rho[1] / rho[0] - 1 < 1e-11);
    sim_close(&sim);
    part_free(p);
  }
}

/* A travelling wave in a box of length 1, and twice in a box of length 2, through the faces. */
static void wave(void **state)
{
  enum { N = 40 };
  double x[2][2 * N], v[2][2 * N];
  (void)state;
  for (int k = 0; k < 2; k++) {
    Parts *p = block(N * (k + 1), 1, 1, 1. / N, GAS);
    Param par = box_param("density=sum", "integrator=leapfrog");
    Sim sim;
    par.high[0] = k + 1;
    for (long i = 0; i < p->n; i++) {
      const double phase = 2 * LAB_PI * p->x[3 * i], c = sqrt(1.4 * .4);
      p->v[3 * i] = .01 * c * sin(phase), p->u[i] += .004 * sin(phase);
      p->x[3 * i] += .01 / (2 * LAB_PI) * cos(phase);
    }
    lab_open(&sim, &par, p);
    lab_run(&sim, 2);
    lab_store(&sim, p);
    for (long i = 0; i < p->n; i++) x[k][i] = p->x[3 * i], v[k][i] = p->v[3 * i];
    sim_close(&sim);
    part_free(p);
  }
  double worst = 0, swing = 0;
  for (int i = 0; i < 2 * N; i++) {
    const double far = fabs(fmod(x[1][i] - x[0][i % N] + 2.5, 1) - .5);
    worst = fmax(worst, fmax(far, fabs(v[1][i] - v[0][i % N]))), swing = fmax(swing, fabs(v[1][i]));
  }
  print_message("wave of %.4f: %.1e\n", swing, worst);
  assert_true(swing > .002 && worst < 1e-12);
}

/* Matter in disorder in a periodic box, and the same twice over in a box twice as long: each does
 * what its copies do, in every form. */
static void repeated(void **state)
{
  enum { N = 8 };
  (void)state;
  for (int k = 0; k < 2 * FORMS; k++) {
    const char *material = k % 2 ? GAS : ROCK;
    Parts *p[2];
    double worst = 0, swing = 0;
    for (int copies = 1; copies <= 2; copies++) {
      Parts *q = p[copies - 1] = block(copies * N, N, 1, 1. / N, material);
      Param par = box_param("density=continuity", "integrator=leapfrog");
      Sim sim;
      lab_set(&par, forms[k / 2]);
      par.faces[1] = PARAM_PERIODIC, par.high[0] = copies, par.high[1] = 1, par.step_max = .005;
      for (long i = 0; i < q->n; i++) {
        const long same = i / (copies * N) * N + i % N;
        for (int d = 0; d < 2; d++) {
          q->x[3 * i + d] += .03 * (rng_uniform(7, (uint64_t)same, (uint32_t)d) - .5);
          q->v[3 * i + d] = .5 * (rng_uniform(7, (uint64_t)same, 2 + (uint32_t)d) - .5);
        }
      }
      lab_open(&sim, &par, q), lab_run(&sim, .3), lab_store(&sim, q), sim_close(&sim);
    }
    for (long i = 0; i < p[1]->n; i++) {
      const long same = i / (2 * N) * N + i % N;
      for (int d = 0; d < 2; d++) {
        const double far = p[1]->x[3 * i + d] - p[0]->x[3 * same + d];
        worst = fmax(worst, fabs(far - round(far)));
        worst = fmax(worst, fabs(p[1]->v[3 * i + d] - p[0]->v[3 * same + d]));
        swing = fmax(swing, fabs(p[1]->v[3 * i + d]));
      }
      worst = fmax(worst, fabs(p[1]->rho[i] - p[0]->rho[same]) + fabs(p[1]->u[i] - p[0]->u[same]));
      for (int c = 0; c < 6; c++)
        worst = fmax(worst, fabs(p[1]->s[6 * i + c] - p[0]->s[6 * same + c]));
    }
    print_message("repeated, %s %s: %.1e of %.2f\n", k % 2 ? "gas" : "rock", forms[k / 2], worst,
                  swing);
    assert_true(worst < 1e-11 && swing > .05);
    part_free(p[0]), part_free(p[1]);
  }
}

/* Rock in disorder in a box that is periodic in two directions and has mirrors in the third: what
 * the faces exchange adds up to nothing along the first two. */
static void momentum(void **state)
{
  (void)state;
  for (int rk = 0; rk < 2; rk++) {
    Parts *p = block(7, 7, 7, 1. / 7, ROCK);
    Param par =
        box_param("density=continuity", rk ? "integrator=rk2-adaptive" : "integrator=leapfrog");
    Sim sim;
    Sums a, b;
    par.faces[1] = PARAM_PERIODIC, par.faces[2] = PARAM_MIRROR, par.high[1] = par.high[2] = 1;
    for (long i = 0; i < p->n; i++)
      for (int d = 0; d < 3; d++) p->v[3 * i + d] = .3 * rng_uniform(3, (uint64_t)i, (uint32_t)d);
    lab_open(&sim, &par, p);
    lab_sums(&sim, &a), lab_run(&sim, 1.5), lab_sums(&sim, &b);
    print_message("momentum %.1e %.1e, across the mirrors %.1e\n",
                  (b.momentum[0] - a.momentum[0]) / b.scale_momentum,
                  (b.momentum[1] - a.momentum[1]) / b.scale_momentum,
                  (b.momentum[2] - a.momentum[2]) / b.scale_momentum);
    for (int d = 0; d < 2; d++)
      assert_true(fabs(b.momentum[d] - a.momentum[d]) < 1e-13 * b.scale_momentum);
    assert_true(fabs(b.momentum[2] - a.momentum[2]) > .1 * b.scale_momentum);
    sim_close(&sim);
    part_free(p);
  }
}

/* Two blocks that collide with each other's mirror image, or the one at x > 0 with a mirror. */
static Parts *halves(int both, const char *material)
{
  const int nx = 12, ny = 9;
  const double dx = .1;
  Parts *half = block(nx, ny, 1, dx, material), *p = half;
  if (both) {
    p = lab_parts(2 * half->n, 2, material);
    for (long i = 0; i < p->n; i++) {
      const long j = i % half->n;
      memcpy(p->x + 3 * i, half->x + 3 * j, 24);
      p->m[i] = half->m[j], p->rho[i] = 1, p->u[i] = 1, p->h[i] = half->h[j];
    }
  }
  for (long i = 0; i < p->n; i++) {
    double *x = &p->x[3 * i], *v = &p->v[3 * i];
    v[0] = -.6, v[1] = .2 * x[1] * x[0];
    if (i >= half->n || !both) continue; /* rows of the second copy are the block at x > 0 */
    x[0] = -x[0], v[0] = -v[0];
  }
  if (both) part_free(half);
  return p;
}

static void mirror(void **state)
{
  (void)state;
  for (int k = 0; k < 6; k++) {
    const char *material = k % 3 ? GAS : ROCK;
    Parts *p = halves(0, material), *q = halves(1, material);
    Param par = lab_param("gravity.method=none", "precision=double", "step.max=0.004", NULL);
    Sim sim;
    double worst = 0;
    long passed = 0;
    if (k % 3 == 2) { /* cold and without viscosity: they pass through each other */
      par.alpha = par.beta = 0;
      for (long i = 0; i < q->n; i++) q->u[i] = p->u[i % p->n] = 1e-3;
    }
    if (k > 2 && param_set(&par, "integrator=rk2-adaptive", NULL)) fail();
    par.step_error = 1;
    lab_open(&sim, &par, q), lab_run(&sim, .8), lab_store(&sim, q), sim_close(&sim);
    par.faces[0] = PARAM_MIRROR_LOW;
    lab_open(&sim, &par, p), lab_run(&sim, .8), lab_store(&sim, p), sim_close(&sim);
    for (long i = 0; i < p->n; i++) {
      const long j = i + p->n, side = q->x[3 * j] < 0 ? -1 : 1;
      passed += side < 0;
      worst = fmax(worst, fabs(p->x[3 * i] - fabs(q->x[3 * j])));
      worst = fmax(worst, fabs(p->v[3 * i] - (double)side * q->v[3 * j]));
      worst = fmax(worst, fabs(p->x[3 * i + 1] - q->x[3 * j + 1]) + fabs(p->u[i] - q->u[j]));
      worst = fmax(worst, fabs(p->s[6 * i + 1] - (double)side * q->s[6 * j + 1]));
    }
    print_message("mirror %s: %.1e, %ld particles have passed it\n", k > 2 ? "rk2" : "leapfrog",
                  worst, passed);
    assert_true(worst < 1e-10 && (k % 3 < 2 || passed > 20));
    part_free(p), part_free(q);
  }
}

/* The same in every form, a block that shears before a mirror and comes to it. */
static void mirrored(void **state)
{
  (void)state;
  for (int k = 0; k < 2 * FORMS; k++) {
    const char *material = k % 2 ? GAS : ROCK;
    Parts *p = halves(0, material), *q = halves(1, material);
    Param par = lab_param("gravity.method=none", "precision=double", "step.max=0.004", NULL);
    Sim sim;
    double worst = 0, torn = 0;
    lab_set(&par, forms[k / 2]);
    lab_open(&sim, &par, q), lab_run(&sim, .25), lab_store(&sim, q), sim_close(&sim);
    par.faces[0] = PARAM_MIRROR_LOW;
    lab_open(&sim, &par, p), lab_run(&sim, .25), lab_store(&sim, p), sim_close(&sim);
    for (long i = 0; i < p->n; i++) {
      const long j = i + p->n, side = q->x[3 * j] < 0 ? -1 : 1;
      worst = fmax(worst, fabs(p->x[3 * i] - fabs(q->x[3 * j])));
      worst = fmax(worst, fabs(p->v[3 * i] - (double)side * q->v[3 * j]));
      worst = fmax(worst, fabs(p->v[3 * i + 1] - q->v[3 * j + 1]));
      worst = fmax(worst, fabs(p->rho[i] - q->rho[j]) + fabs(p->u[i] - q->u[j]));
      worst = fmax(worst, fabs(p->s[6 * i + 1] - (double)side * q->s[6 * j + 1]));
      torn = fmax(torn, fabs(p->s[6 * i + 1]));
    }
    print_message("mirrored, %s %s: %.1e\n", k % 2 ? "gas" : "rock", forms[k / 2], worst);
    assert_true(worst < 1e-10 && (k % 2 || torn > 1e-3));
    part_free(p), part_free(q);
  }
}

/* A shear flow over a no-slip wall feels nothing, as its images go on with it: one evaluation. With
 * a mirror there is a force. What passes the wall is sent back the way it came. */
static void no_slip(void **state)
{
  static const char *const faces[] = {"boundary.y=no_slip_low", "boundary.y=mirror_low"};
  double most[2] = {0, 0};
  (void)state;
  for (int k = 0; k < 2; k++) {
    Parts *p = block(10, 12, 1, .1, GAS);
    Param par = lab_param("gravity.method=none", "boundary.x=periodic", "boundary.high=1,0,0",
                          faces[k], "viscosity.kinematic=0.1", "viscosity.alpha=0",
                          "viscosity.beta=0", "precision=double", NULL);
    Sim sim;
    for (long i = 0; i < p->n; i++) p->v[3 * i] = .3 * p->x[3 * i + 1];
    lab_open(&sim, &par, p), lab_store(&sim, p), sim_close(&sim);
    for (long i = 0; i < p->n; i++)
      for (int d = 0; d < 2 && p->x[3 * i + 1] < .5; d++)
        most[k] = fmax(most[k], fabs(p->a[3 * i + d]));
    part_free(p);
    Parts *one = block(1, 1, 1, .1, GAS);
    one->dimension = 2, one->u[0] = 1e-20, one->x[1] = .05, one->v[0] = .2, one->v[1] = -1;
    par.faces[0] = PARAM_OPEN, par.shear = 0;
    lab_open(&sim, &par, one), lab_run(&sim, .1), lab_store(&sim, one), sim_close(&sim);
    assert_true(fabs(one->x[1] - .05) < 1e-12 && fabs(one->v[1] - 1) < 1e-9);
    assert_true(fabs(one->v[0] - (k ? .2 : -.2)) < 1e-9);
    part_free(one);
  }
  print_message("shear flow: %.1e at a wall, %.1e at a mirror\n", most[0], most[1]);
  assert_true(most[0] < 1e-12 && most[1] > .1);
}

/* Particles come to a face, where none were before: more images than there was room for. */
static void crowd(void **state)
{
  Parts *p = block(4, 400, 1, .01, GAS);
  Param par = box_param("density=continuity", "integrator=leapfrog");
  Sim sim;
  (void)state;
  for (long i = 0; i < p->n; i++) p->x[3 * i] += .5, p->v[3 * i] = 300;
  lab_open(&sim, &par, p);
  const long before = sim.s.all - sim.s.n;
  lab_run(&sim, .0016), lab_run(&sim, .0017);
  print_message("%ld images, then %ld\n", before, sim.s.all - sim.s.n);
  assert_true(before == 0 && sim.s.all - sim.s.n > 1024);
  sim_close(&sim);
  part_free(p);
}

/* Boxes that make no sense. */
static void refused(void **state)
{
  static const struct {
    const char *set[2], *what;
  } wrong[] = {{{"boundary.high=0.3,0,0", "boundary.low=0,0,0"}, "is 0.3 m wide in x"},
               {{"boundary.x=mirror", "boundary.low=0.3,0,0"}, "behind the face at 0.3"},
               {{"boundary.low=2,0,0", "boundary.x=periodic"}, "must be above"},
               {{"boundary.y=mirror_low", "boundary.low=0,-1,0"}, "fewer dimensions"},
               {{"gravity.method=tree", "gravity.G=1"}, "images do not pull"}};
  (void)state;
  for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
    Parts *p = block(10, 1, 1, .1, GAS);
    Param par = box_param("density=continuity", "integrator=leapfrog");
    Sim sim;
    Err err = {""};
    for (int j = 0; j < 2; j++) assert_return_code(param_set(&par, wrong[k].set[j], &err), 0);
    if (k == 0) p->h[3] = .4;
    assert_int_equal(sim_open(&sim, &par, p, lab_device(), &err), -1);
    if (!strstr(err.text, wrong[k].what)) fail_msg("%s", err.text);
    part_free(p);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(uniform), cmocka_unit_test(wave),     cmocka_unit_test(momentum),
      cmocka_unit_test(mirror),  cmocka_unit_test(repeated), cmocka_unit_test(mirrored),
      cmocka_unit_test(no_slip), cmocka_unit_test(crowd),    cmocka_unit_test(refused)};
  omp_set_num_threads(1);
  return cmocka_run_group_tests(tests, NULL, NULL);
}
