/* SPDX-License-Identifier: GPL-3.0-or-later */
/* lib/place, lib/shells, lib/profile: layers with their exact masses whatever the lattice, equal
 * masses or volumes as asked, particles where the structure has their mass, points spread evenly
 * over a sphere, and a structure in a file that is the same when it comes back. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <cmocka.h>
#include "../lib/place.h"
#include "../lib/profile.h"
#include "../lib/shells.h"
#include "folder.h"

static const double PI = 3.14159265358979323846;

/* clang-format off */
static const Material IRON = {.eos = {.form = EOS_TILLOTSON, .tillotson = {.rho0 = 7800, .A = 128e9, .B = 105e9, .E0 = 9.5e6,
  .Eiv = 2.4e6, .Ecv = 8.67e6, .a = 0.5, .b = 1.5, .alpha = 5, .beta = 5}}, .heat = 449};
static const Material ROCK = {.eos = {.form = EOS_MURNAGHAN, .murnaghan = {.rho0 = 2700, .K = 5.0e10, .n = 4}}, .heat = 840};
/* clang-format on */

static const StructureBody EARTH = {
    .layer = {{&IRON, 2e24, .mat = 0, .at = 2000, .anchor = STRUCTURE_TEMPERATURE},
              {&ROCK, 4e24, .mat = 1}},
    .layers = 2};

static double radius(const Parts *p, long i)
{
  const double *x = p->x + 3 * i;
  return sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
}

static void near(double got, double want, double tolerance)
{
  if (!(fabs(got - want) <= tolerance * fabs(want)))
    fail_msg("%.12g, want %.12g: off by %.3g", got, want, got / want - 1);
}

/* Of all particles within r of the centre: mass. */
static double within(const Parts *p, double r)
{
  double m = 0;
  for (long i = 0; i < p->n; i++)
    if (radius(p, i) < r) m += p->m[i];
  return m;
}

static void check(const Placed *out, const Place *how, const StructureBody *body,
                  const Structure *s)
{
  const Parts *p = out->p;
  int rigid = how->placing == PLACE_HCP || how->placing == PLACE_CUBIC;
  double mass[2] = {0}, com[3] = {0}, low[2] = {INFINITY, INFINITY}, high[2] = {0}, edge, far = 0;
  assert_true(labs(p->n - how->n) <= (how->placing == PLACE_SHELLS ? 0 : how->n / 50));
  for (long i = 0; i < p->n; i++) {
    int k = p->mat[i];
    double rest = eos_rho0(&body->layer[k].material->eos);
    double volume = p->m[i] / (body->weightless ? p->rho[i] : rest);
    mass[k] += p->m[i];
    low[k] = fmin(low[k], how->equal_mass || rigid ? p->m[i] : volume);
    high[k] = fmax(high[k], how->equal_mass || rigid ? p->m[i] : volume);
    for (int a = 0; a < 3; a++) com[a] += p->m[i] * p->x[3 * i + a];
    far = fmax(far, radius(p, i));
    if (rigid) continue;
    near(pow(p->h[i], 3) * 4 * PI / 3 * p->rho[i] / p->m[i], how->neighbours, 1e-10);
  }
  edge = s->node[s->n - 1].r;
  for (int k = 0; k < 2; k++) near(mass[k], body->layer[k].mass, 1e-13);
  for (int a = 0; a < 3; a++) assert_true(fabs(com[a]) < 1e-9 * edge * 6e24);
  if (!rigid)
    near(low[0], high[0], 1e-12), near(low[1], high[1], 1e-12), near(low[0], low[1], 0.02);
  assert_true(far < edge * 1.01 && far > edge * (1 - 1.2 * out->spacing / edge));
  for (double part = 0.35; part < 1; part += 0.15) {
    double m = within(p, part * edge) / 6e24, want = structure_at_radius(s, part * edge).m / 6e24;
    if (fabs(m - want) > (how->placing == PLACE_SHELLS ? 0.15 : 0.05))
      fail_msg("%g of the mass inside %g R, not %g", m, part, want);
  }
}

/* Every placing, with and without gravity. */
static void test_all(void **state)
{
  Place how = {.dimension = 3, .n = 3000, .neighbours = 60};
  StructureBody body = EARTH;
  (void)state;
  for (body.weightless = 0; body.weightless < 2; body.weightless++) {
    Structure s;
    Err err;
    assert_int_equal(structure_solve(&s, &body, 400, &err), 0);
    for (int placing = PLACE_HCP; placing <= PLACE_SHELLS; placing++)
      for (how.equal_mass = 0; how.equal_mass < 2; how.equal_mass++) {
        Placed out;
        how.placing = (Placing)placing, how.seed = placing == PLACE_CUBIC ? -1 : 5;
        if (place_ball(&out, &how, &body, &s, &err)) fail_msg("%s", err.text);
        check(&out, &how, &body, &s);
        part_free(out.p);
      }
    structure_free(&s);
  }
  how.n = 3, how.placing = PLACE_SHELLS;
  body.weightless = 1, body.layer[0].mass = 1e20;
  {
    Placed out;
    Err err;
    assert_int_equal(place_ball(&out, &how, &body, NULL, &err), -1);
    assert_non_null(strstr(err.text, "layer 1 is too thin"));
  }
}

/* Points of a shell: on the sphere, none closer than 0.5 of sqrt(area), centre near 0, and every
 * point of the sphere has one within a spacing. */
static void test_points(void **state)
{
  (void)state;
  for (long n = 1; n < 3000; n = 1 + n * 5 / 3) {
    double *x = malloc((size_t)n * 3 * sizeof *x), step = sqrt(4 * PI / (double)n), sum[3] = {0};
    assert_non_null(x);
    shells_points(n, 3, x);
    for (long i = 0; i < n; i++) {
      double *a = x + 3 * i, close = INFINITY;
      near(a[0] * a[0] + a[1] * a[1] + a[2] * a[2], 1, 1e-12);
      for (int d = 0; d < 3; d++) sum[d] += a[d] / (double)n;
      for (long j = 0; j < n; j++) {
        double *b = x + 3 * j;
        if (i != j)
          close =
              fmin(close, sqrt(pow(a[0] - b[0], 2) + pow(a[1] - b[1], 2) + pow(a[2] - b[2], 2)));
      }
      if (n > 4 && !(close > 0.6 * step && close < 1.4 * step))
        fail_msg("%ld points: nearest at %g of sqrt(area)", n, close / step);
    }
    if (n > 4 && sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]) > 2 / (double)n + 0.02)
      fail_msg("%ld points: centre at %g %g %g", n, sum[0], sum[1], sum[2]);
    free(x);
  }
}

/* As text and as HDF5. */
static void test_profile(void **state)
{
  const char *const names[] = {"iron", "rock"};
  const char *const texts[] = {
      "name = \"iron\"; eos = { form = \"murnaghan\"; rho0 = 7800; K = 1.28e11; n = 4; };",
      "name = \"rock\"; eos = { form = \"murnaghan\"; rho0 = 2700; K = 5e10; n = 4; };"};
  Structure s;
  Err err;
  (void)state;
  assert_int_equal(structure_solve(&s, &EARTH, 300, &err), 0);
  for (int hdf5 = 0; hdf5 < 2; hdf5++) {
    const char *path = hdf5 ? "test_place.h5" : "test_place.tsv";
    Profile p;
    if (profile_write(path, &s, &EARTH, names, texts, &err)) fail_msg("%s", err.text);
    if (!hdf5) { /* text knows materials by their names only */
      FILE *f = fopen("rock.cfg", "w");
      assert_non_null(f);
      fputs(texts[1], f), fclose(f);
      assert_int_equal(system("sed -i 's/: rock:/: .\\/rock.cfg:/' test_place.tsv"), 0);
    }
    if (profile_read(&p, path, &err)) fail_msg("%s", err.text);
    assert_int_equal(p.s.n, s.n);
    assert_int_equal(p.body.layers, 2);
    for (int k = 0; k < 2; k++) {
      assert_true(p.body.layer[k].anchor == EARTH.layer[k].anchor);
      near(p.body.layer[k].mass, EARTH.layer[k].mass, 1e-14);
      near(p.body.layer[k].at + 1, EARTH.layer[k].at + 1, 1e-14);
      assert_string_equal(p.name[k], names[k]);
    }
    for (double r = 0.01; r < 1; r += 0.07) {
      StructureNode a = structure_at_radius(&s, r * s.node[s.n - 1].r);
      StructureNode b = structure_at_radius(&p.s, r * s.node[s.n - 1].r);
      near(b.rho, a.rho, 1e-6), near(b.p, a.p, 1e-6), near(b.m, a.m, 1e-9), near(b.t, a.t, 1e-9);
    }
    profile_free(&p), unlink(path), unlink("rock.cfg");
  }
  structure_free(&s);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_all),
      cmocka_unit_test(test_points),
      cmocka_unit_test(test_profile),
  };
  return cmocka_run_group_tests(tests, folder_setup, folder_teardown);
}
