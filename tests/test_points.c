/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Point masses: a Kepler orbit has the order of its integrator; particles and point masses pull on
 * each other with equal forces, momentum is kept to rounding, energy as well as the scheme does; a
 * restart goes on with the same bits; the softened pull is the slope of its potential. */
#include <omp.h>
#include <unistd.h>
#include "lab.h"
#include "../lib/snap.h"

static const char GAS[] = "name = \"gas\"; eos = { form = \"ideal\"; gamma = 1.4; };";

static void put_point(Parts *p, double m, double x, double vy)
{
  p->point = realloc(p->point, (size_t)(p->points + 1) * sizeof *p->point);
  assert_non_null(p->point);
  p->point[p->points++] = (PointMass){.m = m, .x = {x, 0, 0}, .v = {0, vy, 0}};
}

/* A particle that weighs nothing, far away: a run needs one. */
static Parts *speck(void)
{
  Parts *p = lab_parts(1, 3, GAS);
  p->x[2] = 1e4, p->m[0] = 1e-30, p->rho[0] = 1, p->u[0] = 1e-6, p->h[0] = 1e3;
  return p;
}

static const char *tolerance = "step.error=1";

/* Masses of 3/4 and 1/4, a = 1, e = 1/2, G = 1, from the apocentre: error of the distance vector
 * after a whole period with steps of that length; energy and momentum of the sums. */
static double kepler(int integrator, double dt, double *energy)
{
  const double q[2] = {.25, -.75}, r = 1.5, v = sqrt(.5 / 1.5);
  Parts *p = speck();
  Param par = lab_param("gravity.G=1", "gravity.method=none", "precision=double",
                        "smoothing.mode=fixed", "step.points=1", tolerance, NULL);
  Sim sim;
  Sums a, b;
  double error = 0;
  par.integrator = integrator, par.step_max = dt;
  for (int k = 0; k < 2; k++) put_point(p, 1 - fabs(q[k]), q[k] * r, q[k] * v);
  lab_open(&sim, &par, p);
  lab_sums(&sim, &a);
  assert_true(fabs(a.kinetic + a.potential + .75 * .25 / 2) < 1e-14);
  lab_run(&sim, 2 * LAB_PI);
  lab_sums(&sim, &b);
  lab_store(&sim, p);
  assert_int_equal(p->points, 2);
  for (int d = 0; d < 3; d++) {
    const double want = d == 0 ? r : 0, x = p->point[0].x[d] - p->point[1].x[d];
    error += (x - want) * (x - want);
    assert_true(fabs(b.momentum[d]) < 1e-13);
  }
  assert_true(fabs(b.angular[2] / a.angular[2] - 1) < (integrator == 0 ? 1e-12 : .1));
  *energy = fabs((b.kinetic + b.potential) / (a.kinetic + a.potential) - 1);
  sim_close(&sim);
  part_free(p);
  return sqrt(error);
}

static void orbits_have_the_order(void **state)
{
  (void)state;
#define SCHEME(...) +1
  for (int k = 0; k < INTEGRATORS(SCHEME); k++) {
    const struct integrator *in = integrator_of(k);
    const int steps = in->order == 1 ? 12800 : 800; /* Euler's first order is far away */
    double energy[2], coarse = kepler(k, 2 * LAB_PI / steps, &energy[0]);
    double fine = kepler(k, LAB_PI / steps, &energy[1]), order = log2(coarse / fine);
    print_message("%s: error %.2e, %.2e: order %.2f; energy %.1e\n", in->name, coarse, fine, order,
                  energy[1]);
    assert_true(fabs(order - (in->substeps ? 4 : in->order)) < .25);
  }
}

/* Three bodies, G = 1: 3/4 and 1/4 around each other as above, and one of mass m around both. */
typedef struct {
  double m[3], x[3][3], v[3][3];
} Three;

static Three three(double m)
{
  Three t = {.m = {.75, .25, m}, .x = {{.375}, {-1.125}, {0, 4}}};
  t.v[0][1] = .25 * sqrt(.5 / 1.5), t.v[1][1] = -.75 * sqrt(.5 / 1.5), t.v[2][0] = -.45;
  return t;
}

static void three_pull(const Three *t, double a[3][3])
{
  memset(a, 0, 9 * sizeof(double));
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      double d[3], r2 = 0;
      for (int k = 0; k < 3; k++) d[k] = t->x[j][k] - t->x[i][k], r2 += d[k] * d[k];
      for (int k = 0; k < 3 && i != j; k++) a[i][k] += t->m[j] * d[k] / (r2 * sqrt(r2));
    }
}

/* To the time t by the fourth-order scheme of Forest & Ruth (1990, Physica D 43, 105). */
static Three three_run(Three b, double t, int steps)
{
  const double theta = 1 / (2 - cbrt(2)), dt = t / steps;
  const double drift[4] = {theta / 2, (1 - theta) / 2, (1 - theta) / 2, theta / 2};
  const double kick[4] = {theta, 1 - 2 * theta, theta, 0};
  double a[3][3];
  for (int n = 0; n < 4 * steps; n++) {
    for (int i = 0; i < 9; i++) b.x[i / 3][i % 3] += drift[n % 4] * dt * b.v[i / 3][i % 3];
    three_pull(&b, a);
    for (int i = 0; i < 9; i++) b.v[i / 3][i % 3] += kick[n % 4] * dt * a[i / 3][i % 3];
  }
  return b;
}

/* heun-rk4 on them, the third a particle: errors of its place and of the masses'; *drift: of the
 * momentum. */
static void coupled(double m, double dt, double points, double error[2], double *drift)
{
  const Three begin = three(m), want = three_run(begin, 2 * LAB_PI, 20000);
  Parts *p = speck();
  Param par = lab_param("gravity.G=1", "gravity.method=none", "precision=double",
                        "smoothing.mode=fixed", "integrator=heun-rk4", NULL);
  Sim sim;
  Sums a, b;
  par.step_max = dt, par.step_points = points;
  for (int k = 0; k < 2; k++) {
    put_point(p, begin.m[k], 0, 0);
    memcpy(p->point[k].x, begin.x[k], sizeof begin.x[k]);
    memcpy(p->point[k].v, begin.v[k], sizeof begin.v[k]);
  }
  p->m[0] = m;
  memcpy(p->x, begin.x[2], sizeof begin.x[2]), memcpy(p->v, begin.v[2], sizeof begin.v[2]);
  lab_open(&sim, &par, p);
  lab_sums(&sim, &a), lab_run(&sim, 2 * LAB_PI), lab_sums(&sim, &b);
  lab_store(&sim, p);
  error[0] = error[1] = *drift = 0;
  for (int d = 0; d < 3; d++) {
    error[0] = fmax(error[0], fabs(p->x[d] - want.x[2][d]));
    for (int k = 0; k < 2; k++) error[1] = fmax(error[1], fabs(p->point[k].x[d] - want.x[k][d]));
    *drift = fmax(*drift, fabs(b.momentum[d] - a.momentum[d]) / b.scale_momentum);
  }
  sim_close(&sim);
  part_free(p);
}

/* A particle and the two masses it pulls on are of second order together, the masses alone of
 * fourth; momentum is kept to rounding in both. Long steps with substeps end where short ones do.
 */
static void particle_around_two(void **state)
{
  static const double orders[2][2] = {{2, 4}, {2, 2}};
  double coarse[2], fine[2], drift;
  (void)state;
  for (int heavy = 0; heavy < 2; heavy++) {
    const double m = heavy ? .5 : 1e-12, dt = LAB_PI / (heavy ? 400 : 100);
    coupled(m, dt, 1, coarse, &drift), assert_true(drift < 1e-14);
    coupled(m, dt / 2, 1, fine, &drift), assert_true(drift < 1e-14);
    for (int k = 0; k < 2; k++) {
      const double order = log2(coarse[k] / fine[k]);
      print_message("%s %s: error %.2e, %.2e: order %.2f\n", heavy ? "heavy," : "light,",
                    k ? "masses" : "particle", coarse[k], fine[k], order);
      assert_true(fabs(order - orders[heavy][k]) < .3);
    }
  }
  coupled(1e-12, LAB_PI / 20, .01, coarse, &drift); /* up to eight substeps, or steps are shorter */
  print_message("substeps: masses %.2e\n", coarse[1]);
  assert_true(coarse[1] < 1e-6);
}

/* rk2-adaptive by its error alone: without a particle that moves, that of the masses. */
static void error_control(void **state)
{
  double energy, coarse, fine;
  (void)state;
  tolerance = "step.error=1e-4", coarse = kepler(1, 0, &energy);
  tolerance = "step.error=1e-6", fine = kepler(1, 0, &energy);
  tolerance = "step.error=1";
  print_message("tolerance 1e-4: %.2e, 1e-6: %.2e\n", coarse, fine);
  assert_true(coarse < .1 && fine < .1 * coarse);
}

static int in_ball(const double *x, void *data)
{
  (void)data;
  return x[0] * x[0] + x[1] * x[1] + x[2] * x[2] < 1;
}

/* A ball of gas on its way around a planet, a moon further out. */
static Parts *tide(void)
{
  const double dx = .31;
  Parts *p = lab_parts(lab_lattice(dx, 4, 3, in_ball, NULL, NULL), 3, GAS);
  lab_lattice(dx, 4, 3, in_ball, NULL, p->x);
  for (long i = 0; i < p->n; i++) {
    p->m[i] = dx * dx * dx, p->rho[i] = 1, p->h[i] = 2.2 * dx, p->u[i] = .5;
    p->x[3 * i] += 4, p->v[3 * i + 1] = 1.2;
  }
  put_point(p, 50, 0, 0), put_point(p, 5, -9, -.7);
  p->point[0].h = .5;
  return p;
}

static Param tidal(const char *integrator)
{
  return lab_param("gravity.G=0.1", "precision=double", "gravity.method=direct",
                   "smoothing.mode=fixed", integrator, "step.max=0.01", "step.error=1e-4", NULL);
}

static const char *const integrators[] = {
#define INTEGRATOR(WORD, NAME) "integrator=" WORD,
    INTEGRATORS(INTEGRATOR)};
enum { ALL = sizeof integrators / sizeof *integrators };

static void momentum_is_kept(void **state)
{
  (void)state;
  for (int k = 0; k < 2; k++) {
    Parts *p = tide();
    Param par = tidal(integrators[k]);
    Sim sim;
    Sums a, b;
    double drift = 0, turn = 0, first, last;
    lab_open(&sim, &par, p);
    lab_sums(&sim, &a);
    long steps = lab_run(&sim, 2);
    lab_sums(&sim, &b);
    for (int d = 0; d < 3; d++)
      drift = fmax(drift, fabs(b.momentum[d] - a.momentum[d]) / b.scale_momentum),
      turn = fmax(turn, fabs(b.angular[d] - a.angular[d]) / b.scale_angular);
    first = a.kinetic + a.internal + a.potential, last = b.kinetic + b.internal + b.potential;
    print_message("%s: %ld steps, p %.1e, L %.1e, E %.1e of the kinetic energy\n", integrators[k],
                  steps, drift, turn, (last - first) / b.kinetic);
    assert_true(drift < 1e-14 && turn < (k ? 1e-6 : 1e-13));
    assert_true(fabs(last - first) < 1e-5 * b.kinetic);
    sim_close(&sim);
    part_free(p);
  }
}

/* The planet's acceleration against a sum made here, from the positions alone. */
static void forces_are_newtons(void **state)
{
  Parts *p = tide();
  Param par = tidal("integrator=leapfrog");
  Sim sim;
  double a[3] = {0}, energy = 0;
  (void)state;
  par.gravity = PARAM_NONE;
  lab_open(&sim, &par, p);
  lab_store(&sim, p);
  for (long i = 0; i <= p->n; i++) {
    const double *x = i < p->n ? &p->x[3 * i] : p->point[1].x, m = i < p->n ? p->m[i] : 5;
    const double r = sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
    for (int d = 0; d < 3; d++) a[d] += .1 * m * x[d] / (r * r * r);
    energy -= .1 * 50 * m / r;
    double far[3] = {x[0] + 9, x[1], x[2]};
    if (i < p->n) energy -= .1 * 5 * m / sqrt(far[0] * far[0] + far[1] * far[1] + far[2] * far[2]);
  }
  for (int d = 0; d < 3; d++) assert_true(fabs(p->point[0].a[d] - a[d]) < 1e-14);
  assert_true(fabs(sim.points.energy / energy - 1) < 1e-14);
  sim_close(&sim);
  part_free(p);
}

static void fixed_and_deaf(void **state)
{
  Parts *p = tide();
  Param par = tidal("integrator=leapfrog");
  Sim sim;
  (void)state;
  p->point[0].fixed = 1, p->point[1].deaf = 1;
  lab_open(&sim, &par, p);
  lab_run(&sim, .5);
  lab_store(&sim, p);
  for (int d = 0; d < 3; d++) assert_true(p->point[0].x[d] == 0 && p->point[0].v[d] == 0);
  double x = p->point[1].x[0], y = p->point[1].x[1], r = hypot(x, y);
  /* only the planet pulls on the moon */
  assert_true(fabs(p->point[1].a[0] + .1 * 50 * x / (r * r * r)) < 1e-15);
  assert_true(fabs(p->point[1].a[1] + .1 * 50 * y / (r * r * r)) < 1e-15);
  sim_close(&sim);
  part_free(p);
}

/* Through a file, for all integrators. */
static void restart(void **state)
{
  (void)state;
  for (int k = 0; k < ALL; k++) {
    char path[] = "/tmp/test_points_XXXXXX"; /* lint: made by mkstemp */
    Parts *p = tide(), *q;
    Param par = tidal(integrators[k]);
    Sim sim, again;
    Err err;
    SimStep done;
    close(mkstemp(path));
    lab_open(&sim, &par, p);
    for (int n = 0; n < 5; n++) assert_return_code(sim_advance(&sim, 1e9, &done, &err), 0);
    lab_store(&sim, p);
    if (snap_write(p, path, 1, &err)) fail_msg("%s", err.text);
    if (!(q = snap_read(path, &err))) fail_msg("%s", err.text);
    if (sim_restart(&again, &par, q, lab_device(), &err)) fail_msg("%s", err.text);
    for (int n = 0; n < 5; n++) {
      assert_return_code(sim_advance(&sim, 1e9, &done, &err), 0);
      assert_return_code(sim_advance(&again, 1e9, &done, &err), 0);
    }
    lab_store(&sim, p), lab_store(&again, q);
    assert_true(sim.time == again.time);
    assert_int_equal(q->points, 2);
    assert_memory_equal(p->point, q->point, 2 * sizeof *p->point);
    assert_memory_equal(p->x, q->x, 3 * (size_t)p->n * sizeof *p->x);
    sim_close(&sim), sim_close(&again);
    part_free(p), part_free(q);
    unlink(path);
  }
}

/* Selections keep the masses, joined bodies have those of both. */
static void carried(void **state)
{
  Parts *p = tide(), *q = tide(), *some, *both;
  unsigned char *keep = calloc((size_t)p->n, 1);
  Err err;
  (void)state;
  keep[3] = 1;
  for (long i = 0; i < q->n; i++) q->id[i] += 1000;
  q->point[1].m = 7;
  if (!(some = part_select(p, keep, &err)) || !(both = part_join(p, q, &err)))
    fail_msg("%s", err.text);
  assert_int_equal(some->points, 2);
  assert_memory_equal(some->point, p->point, 2 * sizeof *p->point);
  assert_int_equal(both->points, 4);
  assert_memory_equal(both->point + 2, q->point, 2 * sizeof *p->point);
  free(keep);
  part_free(some), part_free(both), part_free(p), part_free(q);
}

/* A shearing disk of local_isothermal gas about two masses, all of it at `at`. */
static Parts *disk(double at)
{
  static const char law[] = "name = \"g\"; eos = { form = \"local_isothermal\"; aspect = 0.1;"
                            "mass = 1e12; r_min = 0.1; };";
  Parts *p = tide();
  free(p->material[0].text), p->material[0].text = strdup(law);
  for (long i = 0; i < p->n; i++) p->v[3 * i] = .3 * p->x[3 * i + 1], p->x[3 * i] += at;
  for (int k = 0; k < 2; k++) p->point[k].x[0] += at;
  return p;
}

/* The sound speed goes with the distance from the mass of disk.point as it moves, the first one by
 * default, without any the origin; with Shakura & Sunyaev's viscosity nothing depends on where all
 * is. */
static void centre_of_the_disk(void **state)
{
  (void)state;
  for (int masses = 0; masses <= 2; masses += 2)
    for (int which = 0; which <= 2; which++) {
      Parts *p = disk(0);
      Param par = tidal(integrators[which]);
      Sim sim;
      Err err;
      p->points = masses, par.disk_point = which;
      if (!masses && which == 2) {
        assert_int_equal(sim_open(&sim, &par, p, lab_device(), &err), -1);
        assert_string_equal(err.text, "disk.point = 2: there are 0 point masses");
        part_free(p);
        continue;
      }
      lab_open(&sim, &par, p), lab_run(&sim, .2), lab_store(&sim, p);
      for (long i = 0; i < p->n; i++) {
        double r2 = 0;
        for (int d = 0; d < 3; d++)
          r2 += pow(p->x[3 * i + d] - (masses && which ? p->point[which - 1].x[d] : 0), 2);
        assert_true(fabs(p->cs[i] / (.1 * sqrt(6.6743e-11 * 1e12 / sqrt(r2))) - 1) < 1e-12);
      }
      sim_close(&sim), part_free(p);
    }
  Parts *p[2] = {disk(0), disk(64)};
  for (int k = 0; k < 2; k++) {
    Param par = tidal("integrator=leapfrog");
    Sim sim;
    lab_set(&par, "viscosity.shakura_sunyaev=1");
    lab_open(&sim, &par, p[k]), lab_run(&sim, .2), lab_store(&sim, p[k]), sim_close(&sim);
  }
  for (long i = 0; i < 3 * p[0]->n; i++)
    assert_true(fabs(p[0]->v[i] - p[1]->v[i]) < 1e-11 && (i >= p[0]->n || p[0]->cs[i] > 0));
  part_free(p[0]), part_free(p[1]);
}

static void pull_is_the_slope(void **state)
{
  (void)state;
  for (int h = 0; h < 2; h++)
    for (int k = 1; k < 40; k++) {
      const double r = .05 * k, e = 1e-4, gm = 3;
      double d[3] = {.6 * r, 0, .8 * r}, a[3] = {0}, none[3] = {0};
      double out[3] = {.6 * (r + e), 0, .8 * (r + e)}, in[3] = {.6 * (r - e), 0, .8 * (r - e)};
      double phi = softening_pull(gm, h, d, a);
      double slope = (softening_pull(gm, h, out, none) - softening_pull(gm, h, in, none)) / (2 * e);
      assert_true(fabs(slope - (.6 * a[0] + .8 * a[2])) < 1e-5 * (1 + slope));
      assert_true(a[1] == 0 && phi < 0);
      if (r >= h) assert_true(fabs(phi + gm / r) < 1e-15 * gm / r);
    }
  double zero[3] = {0}, a[3] = {0};
  assert_true(softening_pull(1, 0, zero, a) == 0 && a[0] == 0);
  assert_true(fabs(softening_pull(1, 2, zero, a) + 1.5) < 1e-15 && a[0] == 0);
}

/* What is wrong with a mass is said; a list in the settings and one in the file are too many. */
static void refused(void **state)
{
  Parts *p = tide();
  Param par = tidal("integrator=leapfrog");
  Sim sim;
  Err err;
  (void)state;
  p->point[1].m = 0;
  assert_int_equal(sim_open(&sim, &par, p, lab_device(), &err), -1);
  assert_string_equal(err.text, "point mass 2: mass is 0, must be positive");
  p->point[1].m = 1, p->point[1].fixed = 1;
  assert_int_equal(sim_open(&sim, &par, p, lab_device(), &err), -1);
  assert_string_equal(err.text, "point mass 2 is fixed, so its velocity must be 0");
  p->point[1].fixed = 0, par.points = 1;
  assert_int_equal(sim_open(&sim, &par, p, lab_device(), &err), -1);
  assert_string_equal(err.text, "the input has 2 point mass(es) already, and the settings list 1");
  part_free(p);
}

static void settings(void **state)
{
  char path[] = "/tmp/test_points_XXXXXX"; /* lint: made by mkstemp */
  static const char text[] =
      "gravity = { theta = 0.5; };\n"
      "point_masses = ( { mass = \"1Msun\"; position = (\"1au\", 0, 0); fixed = true; },\n"
      "  { mass = 5; velocity = \"0,3km/s,0\"; softening = \"2km\"; } );\n";
  static const char *const wrong[][2] = {
      {"point_masses = { mass = 1; };", "'point_masses' must be a list"},
      {"point_masses = ( 1, 2 );", "'point_masses' must hold groups"},
      {"point_masses = ( {\n fixed = true; } );", "missing key 'mass'"},
      {"point_masses = ( {\n mass = 1;\n mas = 2; } );", ":3: unknown key 'mas'"}};
  Param par;
  Err err;
  FILE *f;
  (void)state;
  close(mkstemp(path));
  f = fopen(path, "w"), fputs(text, f), fclose(f);
  if (param_read(&par, path, &err)) fail_msg("%s", err.text);
  assert_int_equal(par.points, 2);
  assert_true(par.point[0].m == 1.9884e30 && par.point[0].x[0] == 149597870700. &&
              par.point[0].fixed && !par.point[1].fixed);
  assert_true(par.point[1].m == 5 && par.point[1].v[1] == 3000 && par.point[1].h == 2000);
  for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
    f = fopen(path, "w"), fputs(wrong[k][0], f), fclose(f);
    assert_int_equal(param_read(&par, path, &err), -1);
    if (!strstr(err.text, wrong[k][1])) fail_msg("%s", err.text);
  }
  assert_int_equal(param_set(&par, "point_masses.mass=1", &err), -1);
  assert_string_equal(err.text, "'point_masses' is a list and can only be given in a file");
  unlink(path);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(orbits_have_the_order),
                                     cmocka_unit_test(particle_around_two),
                                     cmocka_unit_test(error_control),
                                     cmocka_unit_test(momentum_is_kept),
                                     cmocka_unit_test(forces_are_newtons),
                                     cmocka_unit_test(fixed_and_deaf),
                                     cmocka_unit_test(restart),
                                     cmocka_unit_test(carried),
                                     cmocka_unit_test(centre_of_the_disk),
                                     cmocka_unit_test(pull_is_the_slope),
                                     cmocka_unit_test(refused),
                                     cmocka_unit_test(settings)};
  omp_set_num_threads(1);
  return cmocka_run_group_tests(tests, NULL, NULL);
}
