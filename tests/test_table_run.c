/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Runs and bodies with tables against the same with the law that a table was made from: a shock
 * tube of gas and one of rock, and hydrostatic bodies. Particles outside are counted. */
#include "lab.h"
#include "../lib/lagrange.h"
#include "../lib/material.h"
#include "folder.h"
#include "tabulated.h"

#define GAS "name = \"gas\"; eos = { form = \"ideal\"; gamma = 1.4; heat_capacity = 0.7; };"
#define ROCK                                                                                       \
  "name = \"rock\"; eos = { form = \"tillotson\"; rho0 = 2700.; A = 26.7e9; B = 26.7e9; "          \
  "E0 = 487e6; a = 0.5; b = 1.5; alpha = 5.; beta = 5.; Eiv = 4.72e6; Ecv = 18.2e6; "              \
  "heat_capacity = 1000.; };"
#define IRON                                                                                       \
  "name = \"iron\"; eos = { form = \"tillotson\"; rho0 = 7800.; A = 128e9; B = 105e9; "            \
  "E0 = 9.5e6; a = 0.5; b = 1.5; alpha = 5.; beta = 5.; Eiv = 2.4e6; Ecv = 8.67e6; "               \
  "heat_capacity = 449.; };"
#define TABLE(NAME) "name = \"table\"; eos = { form = \"table\"; file = \"" NAME "\"; };"

static Material parse(const char *text)
{
  Material m;
  Err err;
  if (material_parse(&m, text, "m", &err)) fail_msg("%s", err.text);
  return m;
}

/* A table of the law into the file `name`. */
static void make(const char *name, const char *law, const double rho[2], int nrho,
                 const double y[2], int ny, int heat)
{
  Material m = parse(law);
  Table t = tabulated_law(&m, rho, nrho, y, ny, heat);
  Err err;
  if (tabfile_write(&t, name, TABFILE_HDF5, &err)) fail_msg("%s", err.text);
  table_free(&t);
}

/* 2 n particles on a line of spacing d, one state left of 0, another right of it. */
static Parts *tube(long n, double d, const double left[2], const double right[2], const char *text)
{
  Parts *p = lab_parts(2 * n, 1, text);
  for (long i = 0; i < p->n; i++) {
    const double *state = i < n ? left : right;
    p->x[3 * i] = ((double)(i - n) + 0.5) * d, p->rho[i] = state[0], p->u[i] = state[1];
    p->m[i] = p->rho[i] * d, p->h[i] = 4 * d;
  }
  return p;
}

/* Runs both for `time`; the rms difference of rho, u and v over the size of the first's, and how
 * many particles of the second are outside their table then. */
static double difference(Parts *a, Parts *b, double time, double outside[3])
{
  Param par = lab_param("gravity.method=none", NULL);
  Parts *of[] = {a, b};
  double off[3] = {0}, size[3] = {0};
  for (int k = 0; k < 2; k++) {
    Sim sim;
    Sums sums;
    lab_open(&sim, &par, of[k]);
    lab_run(&sim, time);
    lab_sums(&sim, &sums);
    lab_store(&sim, of[k]);
    memcpy(outside, sums.outside, sizeof sums.outside);
    sim_close(&sim);
  }
  for (long i = a->n / 4; i < 3 * a->n / 4; i++) { /* not where it expands into the void */
    const double x[] = {a->rho[i], a->u[i], a->v[3 * i]}, y[] = {b->rho[i], b->u[i], b->v[3 * i]};
    for (int d = 0; d < 3; d++) off[d] += pow(x[d] - y[d], 2), size[d] += x[d] * x[d];
  }
  return sqrt(fmax(fmax(off[0] / size[0], off[1] / size[1]), off[2] / size[2]));
}

static void tubes(void **state)
{
  static const double gas_rho[] = {1e-3, 3}, gas_u[] = {0.01, 6}, rho[] = {1000, 8000},
                      u[] = {0, 6e7};
  static const double low[] = {0.125, 2}, high[] = {1, 2.5}, cold[] = {2700, 0},
                      hot[] = {3500, 2e7};
  Parts *a = tube(200, 0.005, high, low, GAS), *b = tube(200, 0.005, high, low, TABLE("gas"));
  double off, outside[3];
  (void)state;
  make("gas", GAS, gas_rho, 20, gas_u, 10, 0);
  off = difference(a, b, 0.2, outside);
  print_message("gas: %.2g\n", off);
  assert_true(off < 1e-9 && outside[0] + outside[1] + outside[2] == 0);
  part_free(a), part_free(b);
  make("rock", ROCK, rho, 200, u, 200, 0);
  a = tube(200, 1, hot, cold, ROCK), b = tube(200, 1, hot, cold, TABLE("rock"));
  off = difference(a, b, 0.01, outside);
  print_message("rock: %.2g\n", off);
  assert_true(off < 1e-4);
  part_free(a), part_free(b);
}

/* A gas that is hotter and thinner than its table goes on as one, and is counted. */
static void outside(void **state)
{
  static const double rho[] = {0.2, 0.9}, u[] = {2.1, 2.4}, low[] = {0.125, 2}, high[] = {1, 2.5};
  Parts *a = tube(200, 0.005, high, low, GAS), *b = tube(200, 0.005, high, low, TABLE("small"));
  double off, count[3];
  (void)state;
  make("small", GAS, rho, 8, u, 8, 0);
  off = difference(a, b, 0.01, count);
  print_message("outside: %.2g; %g, %g, %g particles\n", off, count[0], count[1], count[2]);
  assert_true(off < 0.1); /* of what is colder than the table p is too high */
  assert_true(count[0] > 390 && count[1] > 190 && count[1] <= 200 && count[2] > 190);
  part_free(a), part_free(b);
}

static double radius(const Structure *s) { return s->node[s->n - 1].r; }

/* Iron and rock: R, central pressure and density of the table's body are those of the law's, by
 * both methods; isentropic, and at 800 K throughout. */
static void bodies(void **state)
{
  static const double rho[2][2] = {{6000, 25000}, {2000, 9000}}, T[] = {10, 2e4};
  Material law[2] = {parse(IRON), parse(ROCK)}, table[2];
  (void)state;
  make("iron", IRON, rho[0], 200, T, 100, 1), make("rock", ROCK, rho[1], 200, T, 100, 1);
  table[0] = parse(TABLE("iron")), table[1] = parse(TABLE("rock"));
  for (int power = 0; power < 2; power++) {
    StructureBody of[2] = {{.layers = 2}, {.layers = 2}};
    Structure s[2], shells;
    Err err;
    for (int k = 0; k < 2; k++) {
      for (int l = 0; l < 2; l++)
        of[k].layer[l] = (StructureLayer){.material = k ? &table[l] : &law[l],
                                          .mass = l ? 4e24 : 1.6e24,
                                          .at = 800,
                                          .anchor = STRUCTURE_TEMPERATURE,
                                          .power = power};
      if (structure_solve(&s[k], &of[k], 400, &err)) fail_msg("%s", err.text);
    }
    print_message("R %.8g, %.8g m, p %.8g, %.8g Pa\n", radius(&s[0]), radius(&s[1]), s[0].node[0].p,
                  s[1].node[0].p);
    assert_true(fabs(radius(&s[1]) / radius(&s[0]) - 1) < 1e-6);
    assert_true(fabs(s[1].node[0].p / s[0].node[0].p - 1) < 1e-5);
    assert_true(fabs(s[1].node[0].t / s[0].node[0].t - 1) < 1e-4);
    assert_true(fabs(s[1].node[0].s / s[0].node[0].s - 1) < 1e-4);
    if (lagrange_relax(&shells, &of[1], 200, &err)) fail_msg("%s", err.text);
    assert_true(fabs(radius(&shells) / radius(&s[1]) - 1) < 1e-4);
    structure_free(&s[0]), structure_free(&s[1]), structure_free(&shells);
  }
  material_clear(&table[0]), material_clear(&table[1]);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(tubes),
      cmocka_unit_test(outside),
      cmocka_unit_test(bodies),
  };
  return cmocka_run_group_tests(tests, folder_setup, folder_teardown);
}
