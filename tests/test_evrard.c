/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Evrard's collapse as a 1-D Lagrangian calculation: the reference of pipelines/evrard.mk. The rows
 * of tests/data/evrard.tsv must come out again, and the energies that another such code has.
 *
 * Shells of equal mass, radii and velocities at their borders, the scheme of von Neumann and
 * Richtmyer (1950, J. Appl. Phys. 21, 232): leapfrog, an artificial pressure rho (2 dv^2 + 0.5 c
 * |dv|) under compression, the energy by an implicit trapezium. M = R = G = 1, u = 0.05 and
 * rho = 1/(2 pi r). */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <cmocka.h>

#define SHELLS 1500
#define GAMMA  (5.0 / 3.0)
#define PI     3.14159265358979323846

/* Borders 0..SHELLS: r, v; shells: u, rho, p, artificial pressure q. dt: the last step. */
typedef struct {
  double t, dt;
  double r[SHELLS + 1], v[SHELLS + 1], u[SHELLS], rho[SHELLS], p[SHELLS], q[SHELLS];
} Star;

static const double M = 1.0 / SHELLS;

static double density(const Star *s, int i)
{
  return M / (4 * PI / 3 * (pow(s->r[i + 1], 3) - pow(s->r[i], 3)));
}

static void start(Star *s)
{
  *s = (Star){0};
  for (int i = 0; i <= SHELLS; i++) s->r[i] = sqrt(i * M);
  for (int i = 0; i < SHELLS; i++) {
    s->u[i] = 0.05, s->rho[i] = density(s, i);
    s->p[i] = (GAMMA - 1) * s->rho[i] * s->u[i];
  }
}

static double step_of(const Star *s)
{
  double dt = s->dt > 0 ? 1.05 * s->dt : 1e-5;
  for (int i = 0; i < SHELLS; i++) {
    double c = sqrt(GAMMA * s->p[i] / s->rho[i]), dv = fabs(s->v[i + 1] - s->v[i]);
    dt = fmin(dt, 0.3 * (s->r[i + 1] - s->r[i]) / (c + 4 * dv));
  }
  return dt;
}

static void compress(Star *s, int i)
{
  double old = s->rho[i], now = density(s, i), dv = s->v[i + 1] - s->v[i], dV = 1 / now - 1 / old;
  double c = sqrt(GAMMA * s->p[i] / old);
  s->q[i] = dv < 0 && dV < 0 ? now * dv * (2 * dv - 0.5 * c) : 0;
  s->u[i] = (s->u[i] - (0.5 * s->p[i] + s->q[i]) * dV) / (1 + 0.5 * (GAMMA - 1) * now * dV);
  s->rho[i] = now, s->p[i] = (GAMMA - 1) * now * s->u[i];
}

static void step(Star *s)
{
  double dt = step_of(s), kick = 0.5 * (s->dt + dt);
  for (int i = 1; i <= SHELLS; i++) {
    double r2 = s->r[i] * s->r[i], inside = s->p[i - 1] + s->q[i - 1];
    double outside = i < SHELLS ? s->p[i] + s->q[i] : 0, mass = i < SHELLS ? M : 0.5 * M;
    s->v[i] += kick * (4 * PI * r2 * (inside - outside) / mass - i * M / r2);
  }
  for (int i = 1; i <= SHELLS; i++) s->r[i] += dt * s->v[i];
  for (int i = 0; i < SHELLS; i++) compress(s, i);
  s->dt = dt, s->t += dt;
}

static void until(Star *s, double t)
{
  while (s->t < t) step(s);
}

static double internal(const Star *s)
{
  double sum = 0;
  for (int i = 0; i < SHELLS; i++) sum += M * s->u[i];
  return sum;
}

static double kinetic(const Star *s)
{
  double sum = 0;
  for (int i = 1; i <= SHELLS; i++) sum += 0.5 * (i < SHELLS ? M : 0.5 * M) * s->v[i] * s->v[i];
  return sum;
}

/* Density, pressure, radial velocity at radius r, between the middles of shells. */
static void at(const Star *s, double r, double value[3])
{
  int i = 0;
  while (i < SHELLS - 2 && 0.5 * (s->r[i + 1] + s->r[i + 2]) < r) i++;
  double a = 0.5 * (s->r[i] + s->r[i + 1]), b = 0.5 * (s->r[i + 1] + s->r[i + 2]);
  double f = (r - a) / (b - a);
  value[0] = (1 - f) * s->rho[i] + f * s->rho[i + 1];
  value[1] = (1 - f) * s->p[i] + f * s->p[i + 1];
  value[2] = 0.5 * ((1 - f) * (s->v[i] + s->v[i + 1]) + f * (s->v[i + 1] + s->v[i + 2]));
}

static void profile(void **state)
{
  (void)state;
  static Star s;
  FILE *data = fopen("tests/data/evrard.tsv", "r");
  assert_non_null(data);
  char line[400];
  double r, want[3], ours[3];
  int rows = 0;
  start(&s), until(&s, 0.8);
  while (fgets(line, sizeof line, data)) {
    if (sscanf(line, "%lf %lf %lf %lf", &r, &want[0], &want[1], &want[2]) != 4) continue;
    at(&s, r, ours);
    for (int k = 0; k < 3; k++)
      if (fabs(ours[k] - want[k]) > 2e-3 * fabs(want[k]))
        fail_msg("column %d at r = %g: %g, not %g", k + 2, r, ours[k], want[k]);
    rows++;
  }
  fclose(data);
  assert_int_equal(rows, 66);
}

/* A code of 1500 shells: 0.411 and 0.467 at t = 0.8, 0.443 and 0.912 at 0.9, 0.270 and 1.576 at 1;
 * at most 1.756 at 1.065. */
static void energies(void **state)
{
  (void)state;
  static Star s;
  static const double want[3][3] = {{0.8, 0.411, 0.467}, {0.9, 0.443, 0.912}, {1, 0.270, 1.576}};
  double most = 0, when = 0;
  start(&s);
  for (int k = 0; k < 3; k++) {
    until(&s, want[k][0]);
    assert_true(fabs(kinetic(&s) - want[k][1]) < 2e-3);
    assert_true(fabs(internal(&s) - want[k][2]) < 2e-3);
  }
  while (s.t < 1.1) {
    step(&s);
    double now = internal(&s);
    if (now > most) most = now, when = s.t;
  }
  assert_true(fabs(most - 1.756) < 4e-3);
  assert_true(fabs(when - 1.065) < 2e-3);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(profile), cmocka_unit_test(energies)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
