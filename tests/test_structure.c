/* SPDX-License-Identifier: GPL-3.0-or-later */
/* lib/structure and lib/lagrange: bodies of one and two layers (docs/theory.md 6.2), the
 * proto-Earth of 004 fig. 2.1, the closed form of weak compression, agreement of the two
 * methods, and what laying on particles keeps. */
#include <math.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <setjmp.h>
#include <cmocka.h>
#include "../lib/lagrange.h"
#include "../lib/lattice.h"
#include "../lib/lay.h"
#include "../lib/structure.h"
#include "../lib/thermal.h"
#include "../lib/unit.h"
#include "tabulated.h"

static const double PI = 3.14159265358979323846;

/* Murnaghan bodies (n = 4) and Tillotson materials as in materials/. */
/* clang-format off */
static const Material ROCK = {.eos = {.form = EOS_MURNAGHAN, .murnaghan = {.rho0 = 2700, .K = 5.0e10, .n = 4}}, .heat = 840};
static const Material METAL = {.eos = {.form = EOS_MURNAGHAN, .murnaghan = {.rho0 = 7800, .K = 1.28e11, .n = 4}}};
static const Material GRANITE = {.eos = {.form = EOS_TILLOTSON, .tillotson = {.rho0 = 2680, .A = 18e9, .B = 18e9, .E0 = 16e6,
  .Eiv = 3.5e6, .Ecv = 18e6, .a = 0.5, .b = 1.3, .alpha = 5, .beta = 5}}, .heat = 790};
static const Material IRON = {.eos = {.form = EOS_TILLOTSON, .tillotson = {.rho0 = 7800, .A = 128e9, .B = 105e9, .E0 = 9.5e6,
  .Eiv = 2.4e6, .Ecv = 8.67e6, .a = 0.5, .b = 1.5, .alpha = 5, .beta = 5}}, .heat = 449};
static const Material ICE = {.eos = {.form = EOS_TILLOTSON, .tillotson = {.rho0 = 917, .A = 9.47e9, .B = 9.47e9, .E0 = 10e6,
  .Eiv = 0.773e6, .Ecv = 3.04e6, .a = 0.3, .b = 0.1, .alpha = 10, .beta = 5}}, .heat = 2100};
/* clang-format on */
static const StructureBody SMALL = {.layer = {{&ROCK, 1e23}}, .layers = 1};
static const StructureBody EARTH = {
    .layer = {{&METAL, 0.3 * 5.9722e24, .mat = 0}, {&ROCK, 0.7 * 5.9722e24, .mat = 1}},
    .layers = 2};
static const StructureBody PROTO = {
    .layer = {{&IRON, 0.3 * 5.375e24, .mat = 0}, {&GRANITE, 0.7 * 5.375e24, .mat = 1}},
    .layers = 2};

static void near(double got, double want, double tolerance)
{
  if (!(fabs(got - want) <= tolerance * fabs(want)))
    fail_msg("%.12g, want %.12g: off by %.3g of it (allowed %g)", got, want, fabs(got / want - 1),
             tolerance);
}

static const StructureNode *surface(const Structure *s) { return s->node + s->n - 1; }

static Structure solve(const StructureBody *body, long nodes)
{
  Structure s;
  Err err;
  if (structure_solve(&s, body, nodes, &err)) fail_msg("%s", err.text);
  return s;
}

static Structure relax(const StructureBody *body, long cells)
{
  Structure s;
  Err err;
  if (lagrange_relax(&s, body, cells, &err)) fail_msg("%s", err.text);
  return s;
}

/* 2.2: central pressure and radius. The printed p_c are 4e-5 and 6e-5 low: for (a) an RK4
 * integration over r with p as the unknown gives 4.704787e9, and so do the shells in the limit of
 * many. */
static void test_acceptance(void **state)
{
  Structure a = solve(&SMALL, 400), b = solve(&EARTH, 400);
  (void)state;
  near(a.node[0].p, 4.70460e9, 1e-4);
  near(a.node[0].p, 4.7047871e9, 2e-8);
  near(surface(&a)->r, 2.044872e6, 3e-7);
  near(b.node[0].p, 4.11549e11, 1e-4);
  near(surface(&b)->r, 6.654223e6, 3e-7);
  structure_free(&a), structure_free(&b);
}

/* 2.2: the shells reach R to 1e-4 and p_c to 1e-3, with an error that falls with their number. */
static void test_acceptance_relaxed(void **state)
{
  Structure a = relax(&SMALL, 100), b = relax(&EARTH, 100), fine = relax(&EARTH, 200);
  (void)state;
  near(a.node[0].p, 4.70460e9, 1e-3);
  near(surface(&a)->r, 2.044872e6, 1e-4);
  near(b.node[0].p, 4.11549e11, 1e-3);
  near(surface(&b)->r, 6.654223e6, 1e-4);
  assert_true(fabs(surface(&fine)->r - 6.654223e6) < 0.5 * fabs(surface(&b)->r - 6.654223e6) + 2);
  structure_free(&a), structure_free(&b), structure_free(&fine);
}

/* 004 fig. 2.1: iron and granite on their cold isentropes. */
static void test_proto_earth(void **state)
{
  Structure s = solve(&PROTO, 400);
  const double at[][3] = {{.2, 381.9, 15063},
                          {.4, 253.9, 13567},
                          {.6, 123.5, 6380},
                          {.8, 50.1, 5006},
                          {.9, 21.3, 4106}};
  const StructureNode *core = s.node + s.first[1] - 1, *mantle = core + 1;
  (void)state;
  near(s.node[0].p, 429.4e9, 2e-4);
  near(s.node[0].rho, 15546, 1e-4);
  near(surface(&s)->r, 5996.5e3, 1e-4);
  near(core->r, 3046.4e3, 1e-4);
  near(core->p, 164.7e9, 5e-4);
  near(core->rho, 12257, 1e-4);
  near(mantle->rho, 6933, 1e-4);
  for (int k = 0; k < 5; k++) {
    StructureNode node = structure_at_radius(&s, at[k][0] * surface(&s)->r);
    near(node.p, at[k][1] * 1e9, 4e-3);
    near(node.rho, at[k][2], 2e-4);
  }
  structure_free(&s);
}

/* Both methods give the same profile everywhere, Tillotson energies included. */
static void test_methods_agree(void **state)
{
  Structure s = solve(&PROTO, 500), t = relax(&PROTO, 200);
  (void)state;
  for (int layer = 0; layer < 2; layer++)
    for (int k = 0; k <= 20; k++) {
      double m0 = layer ? PROTO.layer[0].mass : 0, m = m0 + k / 20. * PROTO.layer[layer].mass;
      StructureNode a = structure_at_mass(&s, layer, m), b = structure_at_mass(&t, layer, m);
      if (k || layer) near(b.r, a.r, 1e-4);
      near(b.rho, a.rho, 1e-3);
      near(b.p + 4e11, a.p + 4e11, 2e-4);
      near(b.u + 1e6, a.u + 1e6, 5e-4);
    }
  structure_free(&s), structure_free(&t);
}

/* Hydrostatic balance, mass and isentrope by finite differences of the nodes; continuity of p,
 * exact interfaces. */
static void test_balance(void **state)
{
  Structure s = solve(&PROTO, 3000);
  (void)state;
  for (long k = 1; k < s.n; k++) {
    const StructureNode *a = s.node + k - 1, *b = s.node + k;
    double r = (a->r + b->r) / 2, rho = (a->rho + b->rho) / 2;
    if (a->layer != b->layer) {
      assert_true(a->r == b->r && a->m == b->m && a->p == b->p);
      near(a->m, PROTO.layer[0].mass, 1e-14);
      continue;
    }
    near((b->m - a->m) / (b->r - a->r), 4 * PI * (r * r + pow(b->r - a->r, 2) / 12) * rho, 1e-5);
    if (k > 2) near((a->p - b->p) / (b->r - a->r), (a->g * a->rho + b->g * b->rho) / 2, 1e-5);
    if (a->u > 1e4)
      near((b->u - a->u) / (b->rho - a->rho), (a->p + b->p) / 2 / (a->rho * b->rho), 1e-3);
  }
  near(surface(&s)->m, 5.375e24, 1e-14);
  assert_true(surface(&s)->p < 1e-9 * s.node[0].p);
  structure_free(&s);
}

/* Bodies of one, two and three layers, laws of every kind, in vacuum and under pressure: the two of
 * 2.2 (Murnaghan), four of Tillotson materials; tables have their test below. */
static const StructureBody VARIOUS[] = {
    {.layer = {{&ROCK, 1e23}}, .layers = 1},
    {.layer = {{&METAL, 0.3 * 5.9722e24}, {&ROCK, 0.7 * 5.9722e24}}, .layers = 2},
    {.layer = {{&GRANITE, 6e24, .at = 2000, .anchor = STRUCTURE_TEMPERATURE}},
     .layers = 1,
     .outer = 2e9},
    {.layer = {{&IRON, 1.6e24, .anchor = STRUCTURE_CONTINUOUS},
               {&GRANITE, 3.7e24, .at = 1500, .anchor = STRUCTURE_TEMPERATURE}},
     .layers = 2},
    {.layer = {{&IRON, 1.6e24, .at = 5000, .anchor = STRUCTURE_TEMPERATURE, .power = 1},
               {&GRANITE, 3.7e24, .at = 5800, .anchor = STRUCTURE_ENTROPY},
               {&ICE, 2e23, .at = 250, .anchor = STRUCTURE_TEMPERATURE, .power = 1}},
     .layers = 3,
     .outer = 1e8},
    {.layer = {{&IRON, 2e22, .anchor = STRUCTURE_CONTINUOUS, .power = 1, .exponent = 0.6},
               {&ROCK, 6e22, .at = 800, .anchor = STRUCTURE_TEMPERATURE, .power = 1,
                .exponent = 1}},
     .layers = 2}};
enum { BODIES = sizeof VARIOUS / sizeof *VARIOUS };

/* Both methods to 1e-4 in radius and central pressure. The error falls with the square of the
 * number of shells. */
static void both(const char *name, const StructureBody *body, long cells)
{
  Structure s = solve(body, 200), t = relax(body, cells);
  print_message("%s: R %.7g km, off by %.2g; p_c %.6g GPa, off by %.2g\n", name,
                surface(&s)->r / 1e3, surface(&t)->r / surface(&s)->r - 1, s.node[0].p / 1e9,
                t.node[0].p / s.node[0].p - 1);
  near(surface(&t)->r, surface(&s)->r, 1e-4);
  near(t.node[0].p, s.node[0].p, 1e-4);
  structure_free(&s), structure_free(&t);
}

static void test_both(void **state)
{
  const long cells[BODIES] = {220, 360, 240, 300, 320, 300};
  char name[16];
  (void)state;
  for (int k = 0; k < BODIES; k++) {
    snprintf(name, sizeof name, "body %d", k + 1);
    both(name, &VARIOUS[k], cells[k]);
  }
}

/* The same of tables, a core and a mantle under pressure; with the laws that the tables were made
 * from, R and p_c are those of the laws. */
static void test_both_tables(void **state)
{
  static const double rho[2][2] = {{5000, 25000}, {1500, 9000}}, T[] = {10, 2e4};
  Table of[2] = {tabulated_law(&IRON, rho[0], 200, T, 100, 1),
                 tabulated_law(&GRANITE, rho[1], 200, T, 100, 1)};
  Material table[2];
  StructureBody body = {.layer = {{&table[0], 1.6e24, .anchor = STRUCTURE_CONTINUOUS},
                                  {&table[1], 3.7e24, .at = 1500, .anchor = STRUCTURE_TEMPERATURE}},
                        .layers = 2,
                        .outer = 1e9},
                law = body;
  Structure a, b;
  (void)state;
  for (int k = 0; k < 2; k++) {
    table[k] = (Material){.eos = tabulated_eos(&of[k])};
    table[k].heat = table_heat(&table[k].eos.table);
  }
  law.layer[0].material = &IRON, law.layer[1].material = &GRANITE;
  a = solve(&body, 200), b = solve(&law, 200);
  near(surface(&a)->r, surface(&b)->r, 1e-5);
  near(a.node[0].p, b.node[0].p, 1e-5);
  both("tables", &body, 300);
  structure_free(&a), structure_free(&b);
  for (int k = 0; k < 2; k++) table_law_free(&table[k].eos.table), table_free(&of[k]);
}

/* What a layer was asked for holds along it: pressure outside, temperature at its top, T ~ rho^a or
 * an isentrope, and everywhere hydrostatic balance. */
static void test_laws(void **state)
{
  (void)state;
  for (int b = 0; b < BODIES; b++) {
    Structure s = solve(&VARIOUS[b], 1000);
    near(surface(&s)->p + 1, VARIOUS[b].outer + 1, 1e-9);
    for (int k = 0; k < s.layers; k++) {
      const StructureLayer *l = &VARIOUS[b].layer[k];
      const StructureNode *top = &s.node[s.first[k + 1] - 1];
      if (l->anchor == STRUCTURE_TEMPERATURE) near(top->t, l->at, 1e-8);
      if (l->anchor == STRUCTURE_ENTROPY) near(top->s, l->at, 1e-8);
      if (l->anchor == STRUCTURE_CONTINUOUS) near(top->t, top[1].t, 1e-8);
      if (k + 1 < s.layers) assert_true(top->p == top[1].p);
      for (const StructureNode *n = &s.node[s.first[k]]; n < top; n++) {
        double r = (n->r + n[1].r) / 2;
        if (l->power) near(n->t, top->t * pow(n->rho / top->rho, l->exponent), 1e-6);
        if (!l->power && l->material->heat > 0 && n->t > 1) {
          near(thermal_temperature(l->material, n->rho, n->u), n->t, 1e-7);
          near(thermal_entropy(l->material, n->rho, n->u), top->s, 1e-7);
        }
        if (r > 0.1 * surface(&s)->r)
          near((n->p - n[1].p) / (n[1].r - n->r), (n->g * n->rho + n[1].g * n[1].rho) / 2, 3e-4);
      }
    }
    structure_free(&s);
  }
}

/* Without gravity every layer is at the pressure outside. */
static void test_weightless(void **state)
{
  StructureBody body = VARIOUS[4];
  Structure s;
  double volume = 0;
  (void)state;
  body.weightless = 1;
  s = solve(&body, 100);
  for (long k = 0; k < s.n; k++) assert_true(s.node[k].p == 1e8);
  for (int k = 0; k < 3; k++) {
    const StructureNode *n = &s.node[s.first[k]];
    near(eos_eval(&body.layer[k].material->eos, n->rho, n->u, 0).p, 1e8, 1e-6);
    assert_true(n->rho == s.node[s.first[k + 1] - 1].rho);
    volume += body.layer[k].mass / n->rho;
  }
  near(surface(&s)->r, cbrt(volume / (4 * PI / 3)), 1e-10);
  structure_free(&s);
}

/* A gas under a pressure outside: the isothermal sphere's p = p_out + G M rho (1/r - 1/R) where its
 * own weight is small. */
static void test_gas(void **state)
{
  static const Material air = {.eos = {.form = EOS_IDEAL, .ideal = {.gamma = 1.4}}, .heat = 717};
  StructureBody body = {
      .layer = {{&air, 1e12, .at = 300, .anchor = STRUCTURE_TEMPERATURE, .power = 1}},
      .layers = 1,
      .outer = 1e5};
  Structure s = solve(&body, 100);
  double rho = 1e5 / (0.4 * 717 * 300), r = cbrt(1e12 / rho / (4 * PI / 3));
  (void)state;
  near(surface(&s)->r, r, 1e-6);
  near(s.node[0].p - 1e5, 2 * PI / 3 * UNIT_G * rho * rho * r * r, 1e-4);
  structure_free(&s);
  body.outer = 0;
  {
    Err err;
    assert_int_equal(structure_solve(&s, &body, 100, &err), -1);
  }
}

static void refuse(StructureBody body, const char *why)
{
  Structure s;
  Err err;
  assert_int_equal(structure_solve(&s, &body, 100, &err), -1);
  if (!strstr(err.text, why)) fail_msg("'%s' says nothing of '%s'", err.text, why);
}

static void test_refuses(void **state)
{
  StructureBody body = VARIOUS[3];
  (void)state;
  body.layer[1].anchor = STRUCTURE_CONTINUOUS;
  refuse(body, "layer 2: above it there is no temperature");
  body = VARIOUS[3], body.layer[1].at = 1e5;
  refuse(body, "layer 2: at 100000 K and 0 Pa it is not condensed");
  body = EARTH, body.layer[0].anchor = STRUCTURE_TEMPERATURE;
  refuse(body, "layer 1: its material has no heat_capacity");
  body = SMALL, body.outer = -1;
  refuse(body, "-1 Pa, is negative");
  body = SMALL, body.layer[0].mass = 0;
  refuse(body, "layer 1 has no mass");
}

/* Weak compression: p_c = 2 pi/3 G rho^2 R^2 and R = R0 (1 - <p>/3K), <p> = 2/5 p_c, up to
 * (p_c/K)^2; a 1 km body too. */
static void test_weak_compression(void **state)
{
  (void)state;
  for (double radius = 1e3; radius < 2e5; radius *= 10) {
    StructureBody ball = {.layer = {{&ROCK, 4 * PI / 3 * 2700 * pow(radius, 3)}}, .layers = 1};
    Structure s = solve(&ball, 100);
    double pc = 2 * PI / 3 * UNIT_G * pow(2700 * radius, 2), x = pc / 5e10;
    near(s.node[0].p, pc, 2 * x + 1e-9);
    near(surface(&s)->r / radius, 1 - 0.4 * x / 3, 10 * x * x + 1e-11);
    structure_free(&s);
  }
}

/* Warm material expands until its pressure is zero; a gas or a vapour has no such density. */
static void test_density(void **state)
{
  Eos gas = {.form = EOS_IDEAL};
  double rho;
  Err err;
  (void)state;
  assert_int_equal(structure_density(&GRANITE.eos, 0, &rho, &err), 0);
  assert_true(rho == 2680);
  assert_int_equal(structure_density(&GRANITE.eos, 5e5, &rho, &err), 0);
  assert_true(rho < 2680 && rho > 2000);
  assert_true(fabs(eos_eval(&GRANITE.eos, rho, 5e5, 0).p) < 1e-9 * 18e9);
  assert_int_equal(structure_density(&GRANITE.eos, 5e7, &rho, &err), -1);
  assert_non_null(strstr(err.text, "not condensed"));
  assert_int_equal(structure_density(&gas, 0, &rho, &err), -1);
  assert_non_null(strstr(err.text, "gas"));
}

/* An uncompressed two-layer ball as mksphere makes it. */
static Parts *ball(long n, const StructureBody *body, Material *material)
{
  const StructureLayer *layer = body->layer;
  LatticeBall lattice;
  Err err;
  double v0 = layer[0].mass / eos_rho0(&layer[0].material->eos),
         v1 = layer[1].mass / eos_rho0(&layer[1].material->eos), spacing;
  Parts *p;
  assert_int_equal(lattice_ball(&lattice, LATTICE_HCP, 3, n, &err), 0);
  p = part_new(lattice.n);
  assert_non_null(p);
  assert_int_equal(part_add(p, "id x v m rho u h mat body", &err), 0);
  long core = lattice.within[lattice_cut(&lattice, v0 / (v0 + v1) * (double)p->n) - 1];
  spacing = cbrt((v0 + v1) / (double)p->n / lattice.volume);
  for (long i = 0; i < p->n; i++) {
    int k = p->mat[i] = lattice.within[lattice.shell[i]] > core;
    for (int a = 0; a < 3; a++)
      p->x[3 * i + a] = lattice.x[3 * i + a] * spacing + 7e6, p->v[3 * i + a] = 0;
    p->id[i] = i, p->h[i] = 2 * spacing, p->rho[i] = eos_rho0(&layer[k].material->eos);
    p->m[i] = layer[k].mass / (double)(k ? p->n - core : core);
    material[k] = *layer[k].material;
  }
  lattice_free(&lattice);
  return p;
}

/* Laying keeps the masses, the layers and the order in radius; the particles lie on the profile and
 * fill the body. */
static void test_lay(void **state)
{
  Structure s = solve(&PROTO, 400);
  Material material[2];
  Parts *p = ball(5000, &PROTO, material);
  double mass[2] = {0}, com[3] = {0}, out = 0, inner = 0, in = INFINITY;
  Err err;
  (void)state;
  if (lay_body(p, material, &s, &err)) fail_msg("%s", err.text);
  for (long i = 0; i < p->n; i++) {
    double r = sqrt(pow(p->x[3 * i], 2) + pow(p->x[3 * i + 1], 2) + pow(p->x[3 * i + 2], 2));
    StructureNode node = structure_at_radius(&s, r);
    mass[p->mat[i]] += p->m[i];
    for (int a = 0; a < 3; a++) com[a] += p->m[i] * p->x[3 * i + a] / 5.375e24;
    out = fmax(out, r);
    if (p->mat[i])
      in = fmin(in, r);
    else
      inner = fmax(inner, r);
    if (node.layer != p->mat[i]) continue; /* in the wrong layer by rounding */
    near(p->rho[i], node.rho, 1e-5);
    near(p->p[i] + 1e6, node.p + 1e6, 1e-4);
  }
  near(mass[0], PROTO.layer[0].mass, 1e-12);
  near(mass[1], PROTO.layer[1].mass, 1e-12);
  for (int a = 0; a < 3; a++) assert_true(fabs(com[a]) < 1e-6 * out);
  assert_true(out < surface(&s)->r && out > 0.95 * surface(&s)->r);
  assert_true(inner <= 3046.4e3 * 1.0001 && in >= 3046.4e3 * 0.9999);
  part_free(p), structure_free(&s);
}

static void test_lay_refuses(void **state)
{
  Structure s = solve(&PROTO, 100);
  Material material[2];
  Parts *p = ball(500, &PROTO, material);
  StructureBody other = {.layer = {{&IRON, 1e24, .mat = 0}, {&GRANITE, 4.375e24, .mat = 1}},
                         .layers = 2};
  Structure wrong = solve(&other, 100);
  Err err;
  (void)state;
  assert_int_equal(lay_body(p, material, &wrong, &err), -1);
  assert_non_null(strstr(err.text, "mass"));
  p->rho[17] *= 1.01;
  assert_int_equal(lay_body(p, material, &s, &err), -1);
  assert_non_null(strstr(err.text, "not uniform"));
  part_free(p), structure_free(&s), structure_free(&wrong);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_acceptance),  cmocka_unit_test(test_acceptance_relaxed),
      cmocka_unit_test(test_proto_earth), cmocka_unit_test(test_methods_agree),
      cmocka_unit_test(test_balance),     cmocka_unit_test(test_weak_compression),
      cmocka_unit_test(test_both),        cmocka_unit_test(test_both_tables),
      cmocka_unit_test(test_laws),        cmocka_unit_test(test_weightless),
      cmocka_unit_test(test_gas),         cmocka_unit_test(test_refuses),
      cmocka_unit_test(test_density),     cmocka_unit_test(test_lay),
      cmocka_unit_test(test_lay_refuses),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
