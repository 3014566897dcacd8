/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One particle under a given velocity gradient, through the passes that move it in a run: where
 * strength ends, plastic strain, heat and temperature against quadratures; tension. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>
#include "../lib/material.h"
#include "../solver/passes.h"
#include "tabulated.h"

/* A particle of a material; arrays of one row. */
typedef struct {
  State s;
  Material m;
  Step k;
} One;

static One *one_new(const char *text, double rho, double u)
{
  One *o = calloc(1, sizeof *o);
  Err err;
  if (!o || material_parse(&o->m, text, "x.cfg", &err)) fail_msg("%s", err.text);
#define ONE_NEW(TYPE, MEMBER, WIDTH, ...) o->s.MEMBER = calloc(WIDTH, sizeof(TYPE));
  ALL_FIELDS(ONE_NEW)
  MOVED_FIELDS(ONE_NEW)
  WORK_FIELDS(ONE_NEW)
#undef ONE_NEW
  o->s.n = 1, o->s.dimension = 3, o->s.material = &o->m;
  o->s.rho[0] = rho, o->s.u[0] = u, o->s.h[0] = o->s.m[0] = 1, o->s.T[0] = 298;
  o->k.strength = o->k.damage = o->s.rare = 1, o->s.alpha[0] = material_distention(&o->m);
  pass_local(&o->s, &o->k, 0);
  return o;
}

static void one_free(One *o)
{
#define ONE_FREE(TYPE, MEMBER, ...) free(o->s.MEMBER);
  ALL_FIELDS(ONE_FREE)
  MOVED_FIELDS(ONE_FREE)
  WORK_FIELDS(ONE_FREE)
#undef ONE_FREE
  free(o);
}

/* Strained at the gradient g for t in n steps; the energy is that of the work. */
static void strain(One *o, const double g[9], double t, int n)
{
  memcpy(o->s.g, g, 9 * sizeof *g);
  o->s.divv[0] = g[0] + g[4] + g[8];
  for (int k = 0; k < n; k++) {
    o->k.dt = t / n;
    o->s.rhoa[0] = o->s.rho[0] * exp(-o->s.divv[0] * o->k.dt / 2);
    pass_advance(&o->s, &o->k, 0);
    o->s.u[0] = o->s.ue[0];
  }
}

static double root_j2(const One *o) { return sqrt(tensor_j2(passes_stress(o->s.s))); }

static void near(double got, double want, double tolerance)
{
  if (!(fabs(got - want) <= tolerance * fabs(want))) fail_msg("%.12g, want %.12g", got, want);
}

#define ROCK(FORM)                                                                                 \
  "name = \"x\"; eos = { form = \"murnaghan\"; rho0 = 2700.; K = 30e9; n = 1.; };"                 \
  "strength = { shear_modulus = 20e9; form = " FORM "};"

/* Squeezed along x without giving way to the sides: the stress runs up to the envelope and along
 * it, at the pressure that the volume alone sets. */
static void confined(void **state)
{
  static const struct {
    const char *text;
    double c, slope, limit; /* sqrt(J2) at p: c + slope p, capped as Lundborg has it */
  } T[] = {
      {ROCK("\"drucker_prager\"; cohesion = 1e6; friction = 0.5;"), 1.2060882e6, .65888900,
       INFINITY},
      {ROCK("\"mohr_coulomb\"; cohesion = 1e6; friction = 0.5;"), 1.2060882e6, .65888900, INFINITY},
      {ROCK("\"lundborg\"; cohesion = 1e6; friction = 0.7; limit = 1e300;"), 1e6, .7, INFINITY},
      {ROCK("\"lundborg\"; cohesion = 1e6; friction = 0.7; limit = 1e8;"), 1e6, .7, 1e8},
      {ROCK("\"collins\"; cohesion = 1e6; friction = 0.7; limit = 1e8; friction_damaged = 0.3;"),
       1e6, .7, 1e8}};
  const double g[9] = {-1, 0, 0, 0, 0, 0, 0, 0, 0};
  (void)state;
  for (int k = 0; k < 5; k++) {
    One *o = one_new(T[k].text, 2700, 0);
    for (int n = 0; n < 10; n++) {
      strain(o, g, 2e-3, 20);
      double p = 30e9 * (o->s.rho[0] / 2700 - 1), x = T[k].slope * p, room = T[k].limit - T[k].c;
      near(o->s.p[0], p, 1e-9);
      near(root_j2(o), T[k].c + (isinf(room) ? x : x / (1 + x / room)), 1e-6);
    }
    assert_true(o->s.strain[0] > 1e-3);
    one_free(o);
  }
}

/* In pure shear at the rate r, s_xy rises with 2 mu (r/2) and stays at Y/sqrt(3); the plastic
 * strain is what is over, its work and the elastic energy are the heat. */
static void von_mises(void **state)
{
  const double r = 1e3, g[9] = {0, .5 * r, 0, .5 * r, 0, 0, 0, 0, 0}, y = 1e8, t = 2e-5;
  One *o = one_new(ROCK("\"von_mises\"; Y = 1e8;"), 2700, 0);
  double elastic = y / sqrt(3) / 20e9; /* r t at the yield point */
  (void)state;
  strain(o, g, t, 5000);
  near(o->s.s[1], y / sqrt(3), 1e-12);
  near(o->s.strain[0], (r * t - elastic) / sqrt(3), 1e-9);
  near(o->s.u[0], y / sqrt(3) * (r * t - elastic / 2) / 2700, 1e-3);
  o->m.melt = 4 * o->s.u[0]; /* heat takes a quarter off, then all */
  strain(o, g, 1e-3 * t, 1);
  near(o->s.s[1], .75 * y / sqrt(3), 1e-3);
  o->m.melt = o->s.u[0], strain(o, g, 1e-3 * t, 1);
  assert_true(root_j2(o) == 0);
  one_free(o);
}

/* Steel in adiabatic shear: hardening, then softening by its own heat, dT/de = heating Y/(rho C)
 * (Johnson & Cook 1983), by quadrature over the plastic strain. */
static void johnson_cook(void **state)
{
  const double r = 1e4, g[9] = {0, r, 0, 0, 0, 0, 0, 0, 0}, heat = 477, rho = 7830, end = 0.5;
  One *o = one_new("name = \"x\"; eos = { form = \"murnaghan\"; rho0 = 7830.; K = 159e9; n = 1.;"
                   "heat_capacity = 477.; }; strength = { shear_modulus = 77e9;"
                   "form = \"johnson_cook\"; A = 792e6; B = 510e6; n = .26; C = .014; m = 1.03;"
                   "T0 = 298.; Tmelt = 1793.; };",
                   rho, 0);
  double T = 298, de = 1e-5, rate = 1 + .014 * log(r / sqrt(3)), flow = 0;
  (void)state;
  strain(o, g, end / r, 20000);
  for (double e = de / 2; e < o->s.strain[0]; e += de) {
    flow = (792e6 + 510e6 * pow(e, .26)) * rate * (1 - pow((T - 298) / 1495, 1.03));
    T += .9 * flow * de / (rho * heat);
  }
  near(o->s.strain[0], end / sqrt(3), .03);
  near(sqrt(3) * root_j2(o), flow, 2e-4);
  near(o->s.T[0], T, 1e-3);
  assert_true(T > 350);
  /* what viscosity makes is heat, too; the melt has no strength */
  o->s.dqdt[0] = 1e10;
  strain(o, g, 477e3 / 1e10, 1000);
  assert_true(o->s.T[0] > T + 1000 && o->s.T[0] < T + 1100);
  strain(o, g, 477e3 / 1e10, 1000);
  assert_true(root_j2(o) == 0);
  one_free(o);
}

/* Stages within a step limit the stress and book nothing: no plastic strain, no heat. */
static void stages(void **state)
{
  static const char *const T[] = {
      ROCK("\"von_mises\"; Y = 1e6;"), ROCK("\"viscous_regolith\"; cohesion = 1e6; friction = 0.;"),
      "name = \"x\"; eos = { form = \"murnaghan\"; rho0 = 2700.; K = 3e10; n = 1.; heat_capacity = "
      "1e3; }; strength = { shear_modulus = 2e10; form = \"johnson_cook\"; A = 1e6; };"};
  (void)state;
  for (int k = 0; k < 3; k++) {
    One *o = one_new(T[k], 2700, 0);
    o->s.s[1] = 1e8, o->s.g[1] = 1e4, o->s.dqdt[0] = 1e6, o->k.dt = 1;
    pass_local(&o->s, &o->k, 0);
    assert_true(root_j2(o) > 0 && root_j2(o) < 1.1e6);
    assert_true(o->s.strain[0] == 0 && o->s.T[0] == 298);
    one_free(o);
  }
}

/* No tension beyond the envelope's end; vapour bears no shear, elastic matter neither. */
static void tension_and_vapour(void **state)
{
  const double pull[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, shear[9] = {0, 1, 0, 1, 0, 0, 0, 0, 0};
  One *o = one_new(ROCK("\"drucker_prager\"; cohesion = 1e6; friction = 0.5;"), 2700, 0);
  (void)state;
  strain(o, pull, 1e-2, 100);
  near(o->s.p[0], -1e6 / tan(.5), 1e-12);
  strain(o, shear, 1e-2, 10);
  assert_true(root_j2(o) < 1e-3);
  one_free(o);
  o = one_new("name = \"x\"; eos = { form = \"tillotson\"; rho0 = 2700.; A = 27e9; B = 27e9; E0 ="
              "4.87e8; Eiv = 4.72e6; Ecv = 1.82e7; a = .5; b = 1.5; alpha = 5.; beta = 5.; };"
              "strength = { shear_modulus = 2e10; form = \"none\"; };",
              2000, 4.7e6);
  strain(o, shear, 1e-6, 10);
  assert_true(root_j2(o) > 1e4);
  o->s.u[0] = 4.8e6;
  strain(o, shear, 1e-6, 10);
  assert_true(root_j2(o) == 0);
  o->m.yield.form = YIELD_REGOLITH, o->s.alpha[0] = 1.5; /* its solid is dense */
  o->s.s[1] = 1e5, o->s.p[0] = 1e9, o->m.yield.regolith = (struct yield_regolith){1e9, .5, 0};
  assert_true(matter_factor(&o->s, &o->m, 0) == 1);
  one_free(o);
}

/* A table's vapour bears no shear, its other phases do; a run without rare laws does not look. */
static void table_vapour(void **state)
{
  const double shear[9] = {0, 1, 0, 1, 0, 0, 0, 0, 0}, rho[2] = {1500, 4000}, u[2] = {0, 1e7};
  One *o = one_new("name = \"x\"; eos = { form = \"murnaghan\"; rho0 = 2700.; K = 30e9; n = 1.;"
                   "heat_capacity = 1000.; };"
                   "strength = { shear_modulus = 2e10; form = \"von_mises\"; Y = 1e12; };",
                   2700, 1e6);
  Table t = tabulated_law(&o->m, rho, 11, u, 11, 0);
  (void)state;
  for (int i = 0; i < 11; i++)
    for (int j = 0; j < 11; j++) t.field[TABLE_PHASE][11 * i + j] = j < 5 ? 4 : 2;
  o->m.eos = tabulated_eos(&t);
  o->m.eos.table.vapour = 2;
  for (int hot = 0; hot < 2; hot++)
    for (int rare = 1; rare >= 0; rare--) {
      o->s.rare = rare, o->s.u[0] = hot ? 4.6e6 : 4.4e6, o->s.p[0] = 0;
      strain(o, shear, 1e-6, 1);
      assert_true(hot && rare ? root_j2(o) == 0 : root_j2(o) > 1e4);
    }
  table_law_free(&o->m.eos.table), table_free(&t);
  one_free(o);
}

/* Weak where it is less dense: cohesion alone, below 85 % with (eta/0.85)^4/2. */
static void weak(void **state)
{
  const double pull[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, shear[9] = {0, 1, 0, 1, 0, 0, 0, 0, 0};
  One *o = one_new(ROCK("\"von_mises\"; Y = 1e6; weak_limit = .85; weak_alpha = .2; weak_beta = 4;"
                        "weak_gamma = .5;"),
                   2700, 0);
  (void)state;
  strain(o, shear, 1e-3, 10);
  near(sqrt(3) * root_j2(o), 1e6, 1e-9);
  strain(o, pull, log(1 / .8) / 3, 10);
  strain(o, shear, 1e-3, 10);
  near(sqrt(3) * root_j2(o), .5e6 * pow(.8 / .85, 4), 1e-9);
  one_free(o);
}

/* Weakness looks at the density of the solid: of porous rock at rest neither cohesion nor tension
 * are weak, of the same rock pulled to 80 % both are. Without strength tension is that of the
 * equation of state. */
static void weak_pores(void **state)
{
  const double pull[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, shear[9] = {0, 1, 0, 1, 0, 0, 0, 0, 0};
  for (int pulled = 0; pulled < 2; pulled++) {
    One *o =
        one_new(ROCK("\"lundborg\"; cohesion = 1e6; friction = 0.7; weak_limit = .85; weak_beta "
                     "= 4; weak_gamma = .5;") "porosity = { form = \"p_alpha\"; alpha_0 = 1.5; "
                                              "p_e = 1e6; p_s = 2e8; };",
                1800, 0);
    double left = pulled ? .5 * pow(.8 / .85, 4) : .5 + .5 * (exp(-9e-5) - .85) / .15;
    strain(o, pull, pulled ? log(1 / .8) / 3 : 3e-5, 1);
    near(o->s.p[0], -1e6 * left, 1e-12);
    o->s.floors.pressure = 1; /* p = 0 */
    strain(o, shear, 1e-3, 1);
    near(root_j2(o), 1e6 * left, 1e-12);
    o->s.floors.pressure = 0;
    o->k.strength = 0, strain(o, pull, 1e-3, 1);
    assert_true(o->s.p[0] < -2e7);
    one_free(o);
  }
  (void)state;
}

/* The equivalent strain rate sqrt(2/3 e:e): 2/3 r in uniaxial strain, r/sqrt(3) in simple shear,
 * r in uniaxial tension at constant volume, nothing in compression from all sides. */
static void rate(void **state)
{
  static const double g[][9] = {{3, 0, 0, 0, 0, 0, 0, 0, 0},      {0, 0, 0, 0, 3, 0, 0, 0, 0},
                                {0, 0, 0, 0, 0, 0, 0, 0, 3},      {0, 3, 0, 0, 0, 0, 0, 0, 0},
                                {0, 0, 0, 0, 0, 0, 3, 0, 0},      {0, 0, 0, 0, 0, 3, 0, 0, 0},
                                {3, 0, 0, 0, -1.5, 0, 0, 0, -1.5}};
  static const double want[] = {2, 2, 2, 1.7320508075688772, 1.7320508075688772, 1.7320508075688772,
                                3};
  const double squeeze[9] = {-3, 0, 0, 0, -3, 0, 0, 0, -3}, turn[9] = {0, 3, 0, -3, 0, 0, 0, 0, 0};
  (void)state;
  for (int k = 0; k < 7; k++) near(matter_rate(g[k]), want[k], 1e-15);
  assert_true(matter_rate(squeeze) == 0 && matter_rate(turn) == 0);
}

static const double FLAWS[] = {1e-4, 2e-4, 3e-4, 4e-4};

static One *brittle(const char *shear)
{
  char text[512];
  One *o;
  snprintf(text, sizeof text,
           "%sdamage = { form = \"grady_kipp\"; k = 1e30; m = 8.; shear = %s; };",
           ROCK("\"none\";"), shear);
  o = one_new(text, 2700, 0);
  o->s.nflaw[0] = 4, o->s.flaw = FLAWS;
  return o;
}

/* Pulled along x to a strain e and let go: flaws open at their thresholds, and stay counted; D
 * grows by nact c_g/h to nact/4, in any number of steps. */
static void cracks(void **state)
{
  const double g[9] = {1, 0, 0, 0, 0, 0, 0, 0, 0}, back[9] = {-1}, still[9] = {0};
  const double young = 9 * 30e9 * 20e9 / (3 * 30e9 + 20e9), modulus = 30e9 + 80e9 / 3;
  double few = 0;
  (void)state;
  for (int steps = 1; steps < 200; steps *= 14) {
    One *o = brittle("1.");
    o->k.damage = 0;
    strain(o, g, 2.5e-4 * young / modulus, 1000); /* sigma_xx/E = 2.5e-4 */
    near(passes_strain(&o->s, 0), 2.5e-4, 1e-3);
    o->k.damage = 1;
    strain(o, still, 2e-4, steps);
    assert_int_equal(o->s.nact[0], 2);
    if (steps == 1) few = o->s.damage[0];
    near(o->s.damage[0], few, 4e-2);
    near(cbrt(o->s.damage[0]), 2e-4 * 2 * .4 * sqrt(modulus / 2700), 4e-2); /* slower as D grows */
    near(o->s.push[0], (1 - o->s.damage[0]) * o->s.p[0] / (o->s.rho[0] * o->s.rho[0]), 1e-14);
    strain(o, still, 1, 1);
    near(o->s.damage[0], .5, 1e-14);
    near(passes_strain(&o->s, 0), 2.5e-4, 1e-3); /* the strain that flaws feel does not know D */
    strain(o, back, 5e-4, 10);
    assert_int_equal(o->s.nact[0], 2);
    near(o->s.damage[0], .5, 1e-14);
    one_free(o);
  }
}

/* The rate that other integrators take: active c_g/h below the limit, of solids with flaws only; a
 * particle's flaws begin where it says. */
static void crack_rate(void **state)
{
  const double of[] = {9, 9, 1e-4, 2e-4, 3e-4, 4e-4};
  const double modulus = 30e9 + 80e9 / 3;
  One *o = brittle("1.");
  (void)state;
  o->s.flaw = of, o->s.flaw0[0] = 2, o->s.h[0] = .5, o->s.rho[0] = 2700;
  o->s.s[0] = 2.5e-4 * material_young(&o->m), o->s.p[0] = 0;
  passes_damage(&o->s, 0, 0);
  assert_int_equal(o->s.nact[0], 2);
  near(o->s.dcrack[0], 2 * .4 * sqrt(modulus / 2700) / .5, 1e-12);
  assert_true(o->s.damage[0] == 0);
  assert_true(passes_crack_rate(&o->s, 0, 0) == o->s.dcrack[0]);
  assert_true(passes_crack_rate(&o->s, 0, cbrt(.5)) == 0);
  for (int none = 0; none < 4; none++) { /* no stress, flaws, shear modulus, law */
    One keep = *o;
    o->s.dcrack[0] = 1;
    if (none == 0) o->s.s[0] = 0;
    o->s.nflaw[0] = none == 1 ? 0 : 4;
    if (none == 2) o->m.mu = 0;
    if (none == 3) o->m.damage.form = DAMAGE_NONE;
    passes_damage(&o->s, 0, 1);
    assert_true(o->s.dcrack[0] == 0 && o->s.damage[0] == 0);
    o->m = keep.m, o->s.s[0] = 2.5e-4 * material_young(&o->m);
  }
  o->s.damage[0] = 1; /* nothing is left to strain, but the limit in tension */
  assert_true(passes_strain(&o->s, 0) == 0);
  o->s.p[0] = -1e6;
  near(passes_strain(&o->s, 0), 2.5e-4 + 1e6 / material_young(&o->m), 1e-12);
  one_free(o);
}

/* What the force loop sees of S: (1 - shear D) of it, and of the work; p is not touched by damage
 * where it presses. */
static void acts_on(void **state)
{
  static const char *const T[] = {"1.", "0.25", "0."};
  const double left[] = {.2, .8, 1}, e[9] = {0, .5, 0, .5, 0, 0, 0, 0, 0};
  (void)state;
  for (int k = 0; k < 3; k++) {
    One *o = brittle(T[k]);
    o->s.damage[0] = .8, o->s.nact[0] = 4, o->s.s[1] = 1e7, o->s.rho[0] = 2710;
    o->s.cm[0] = o->s.cm[3] = o->s.cm[5] = 1;
    pass_local(&o->s, &o->k, 0);
    near(o->s.t[1], left[k] * 1e7, 1e-14);
    near(o->s.push[0], o->s.p[0] / 2710 / 2710, 1e-14);
    memcpy(o->s.g, e, sizeof e);
    near(passes_work(&o->s, 0, 0, passes_stress(o->s.s), 2710, 1), left[k] * 1e7 / 2710, 1e-14);
    o->s.p[0] = -1e6;
    near(passes_strain(&o->s, 0) * left[k] * material_young(&o->m), left[k] * 1e7 + .2 * 1e6,
         1e-12);
    one_free(o);
  }
}

#define PUMICE(C)                                                                                  \
  ROCK("\"none\";")                                                                                \
  "damage = { form = \"grady_kipp\"; k = 1e30; m = 8.; };"                                         \
  "porosity = { form = \"p_alpha\"; alpha_0 = 1.5; c_elastic = " C "; p_e = 1e6; p_s = 2e8; };"

/* Squeezed from all sides the pores close along the crush curve, the solid is broken as they close,
 * and the work of crushing is heat. */
static void crushed(void **state)
{
  const double g[9] = {-1, 0, 0, 0, -1, 0, 0, 0, -1};
  One *o = one_new(PUMICE("0."), 1800, 0);
  double work = 0;
  (void)state;
  for (int n = 0; n < 400; n++) {
    double p = o->s.p[0], rho = o->s.rho[0], crush = 1.5, old = o->s.alpha[0];
    strain(o, g, 3e-4, 1);
    work += (p + o->s.p[0]) / 2 * (1 / rho - 1 / o->s.rho[0]);
    p = o->s.p[0];
    if (p > 1e6) crush = p < 2e8 ? 1 + .5 * pow((2e8 - p) / 1.99e8, 2) : 1;
    near(o->s.alpha[0], fmin(crush, old), 1e-8);
    near(cbrt(o->s.damage[0]), porosity_broken(&o->m.porosity, o->s.alpha[0]), 1e-9);
    near(o->s.u[0], work, 1e-3);
  }
  assert_true(o->s.alpha[0] > 1 && o->s.alpha[0] < 1.1);
  one_free(o);
}

/* In elastic shear S grows with mu h^2/alpha, h = c_elastic/c of the solid, as the bulk modulus
 * is K h^2/alpha; when pores crush, S of the bulk grows as alpha falls. The longitudinal wave has
 * both moduli. */
static void soft(void **state)
{
  const double shear[9] = {0, .5, 0, .5, 0, 0, 0, 0, 0},
               squeeze[9] = {-1, 0, 0, 0, -1, 0, 0, 0, -1};
  double h = 1000 / sqrt(30e9 / 2700), s;
  One *o = one_new(PUMICE("1000."), 1800, 0);
  (void)state;
  o->k.damage = 0;
  strain(o, shear, 1e-6, 10);
  near(o->s.s[1], 20e9 * h * h / 1.5 * 1e-6, 1e-4);
  near(o->s.cl[0], sqrt(1e6 + 4. / 3 * 20e9 * h * h / 1.5 / 1800), 1e-6);
  s = o->s.s[1];
  strain(o, squeeze, .03, 300);
  assert_true(o->s.alpha[0] < 1.4);
  near(o->s.s[1], s * 1.5 / o->s.alpha[0], 1e-6);
  one_free(o);
  o = one_new("name = \"d\"; eos = { form = \"liquid\"; rho0 = 2000.; c = 3000.; rho_min = 0.; };"
              "strength = { shear_modulus = 2e3; form = \"porous\"; }; porosity = { form = "
              "\"sirono\"; alpha_0 = 5.; K_0 = 4e3; p_m = 1.3e3; };",
              400, 0);
  strain(o, shear, .01, 10);
  near(o->s.s[1], 2e3 * .01, 1e-9);
  strain(o, shear, 1, 10);
  near(sqrt(3) * root_j2(o), porosity_shear_strength(&o->m.porosity, &o->m.eos, 400), 1e-9);
  one_free(o);
}

/* Strains of porous matter are those of its soft moduli: plastic strain, and what flaws feel. */
static void soft_strains(void **state)
{
  const double shear[9] = {0, .5, 0, .5, 0, 0, 0, 0, 0}, h = 1000 / sqrt(30e9 / 2700);
  One *o = one_new(PUMICE("1000."), 1800, 0);
  double stiff = h * h / 1.5, elastic = 1e5 / sqrt(3) / (20e9 * stiff);
  (void)state;
  o->k.damage = 0, o->m.yield.form = YIELD_VON_MISES, o->m.yield.von_mises.Y = 1e5;
  strain(o, shear, 1e-3, 2000);
  near(o->s.s[1], 1e5 / sqrt(3), 1e-9);
  near(o->s.strain[0], (1e-3 - elastic) / sqrt(3), 1e-6);
  memset(o->s.s, 0, 6 * sizeof *o->s.s), o->s.s[0] = 1e6, o->s.p[0] = 0;
  near(passes_strain(&o->s, 0), 1e6 / (stiff * material_young(&o->m)), 1e-12);
  one_free(o);
}

/* Opening does not break, nor does crushing where damage is off or acts on no flaws; D ends at 1;
 * of a material without pores S does not change with its distention. */
static void compacted(void **state)
{
  One *o = one_new(PUMICE("0."), 1800, 0);
  (void)state;
  o->s.s[1] = 1e6, o->s.damage[0] = .125;
  o->s.alpha[0] = 1.4, matter_compact(&o->s, 0, 1.5, 1, 0);
  assert_true(o->s.damage[0] == .125);
  near(o->s.s[1], 1e6 * 1.5 / 1.4, 1e-14);
  o->s.alpha[0] = 1.5, matter_compact(&o->s, 0, 1.4, 1, 1);
  assert_true(o->s.damage[0] == .125);
  near(o->s.s[1], 1e6, 1e-14);
  o->s.alpha[0] = 1, matter_compact(&o->s, 0, 1.5, 0, 1);
  assert_true(o->s.damage[0] == 1);
  near(o->s.s[1], 1e6, 1e-14); /* no solid */
  o->s.damage[0] = 0, o->m.damage.grady_kipp.pores = .5, matter_compact(&o->s, 0, 1.5, 1, 1);
  near(o->s.damage[0], .125, 1e-12);
  o->m.damage.form = DAMAGE_NONE, o->s.damage[0] = 0, matter_compact(&o->s, 0, 1.5, 1, 1);
  assert_true(o->s.damage[0] == 0);
  one_free(o);
}

/* The shear modulus that S grows with: of dust and its power of the filling, of pores that crush
 * the share that the solid takes, only while they are squeezed; of a viscous soil none. */
static void moduli(void **state)
{
  const double shear[9] = {0, .5, 0, .5, 0, 0, 0, 0, 0};
  One *o = one_new("name = \"d\"; eos = { form = \"liquid\"; rho0 = 2000.; c = 3000.; };"
                   "strength = { shear_modulus = 2e3; form = \"none\"; }; porosity = { form = "
                   "\"sirono\"; alpha_0 = 5.; K_0 = 4e3; p_m = 1.3e3; };",
                   400, 0);
  double f;
  (void)state;
  o->s.alpha[0] = 4, o->s.rho[0] = 500;
  near(matter_shear(&o->s, 0), 2e3 * pow(5. / 4, 4), 1e-12);
  o->s.s[1] = 1, matter_compact(&o->s, 0, 5, 1, 0);
  assert_true(o->s.s[1] == 1); /* of the aggregate, not of its grains */
  one_free(o);
  o = one_new(PUMICE("0."), 1800 * 1.2, 0);
  assert_true(o->s.alpha[0] < 1.4 && o->s.alpha[0] > 1);
  o->s.divv[0] = -1;
  f = porosity_share(&o->m.porosity, &o->m.eos, o->s.rho[0], 0, o->s.p[0], o->s.alpha[0], 1);
  assert_true(f < .5);
  near(matter_shear(&o->s, 0), f * 20e9 / o->s.alpha[0], 1e-12);
  o->s.divv[0] = 1;
  near(matter_shear(&o->s, 0), 20e9 / o->s.alpha[0], 1e-12);
  o->s.divv[0] = 0;
  near(matter_shear(&o->s, 0), 20e9 / o->s.alpha[0], 1e-12);
  one_free(o);
  o = one_new(
      "name = \"s\"; eos = { form = \"liquid\"; rho0 = 1850.; c = 20.; }; strength = { "
      "shear_modulus = 5e5; form = \"viscous_regolith\"; cohesion = 2e3; friction = 0.4; };",
      1850, 0);
  memcpy(o->s.g, shear, sizeof shear), pass_local(&o->s, &o->k, 0);
  for (int d = 0; d < 6; d++) assert_true(o->s.ds[d] == 0);
  o->m.yield.form = YIELD_REGOLITH, o->s.alpha[0] = 1.3; /* soil that has opened is as stiff */
  assert_true(matter_shear(&o->s, 0) == 5e5);
  one_free(o);
}

#define SOIL(MORE)                                                                                 \
  "name = \"s\"; eos = { form = \"liquid\"; rho0 = 1850.; c = 20.; rho_min = 0.; };"               \
  "strength = { shear_modulus = 5e5; cohesion = 2e3; friction = 0.4; " MORE "};"

/* Bui et al. (2008), 0.4 rad, 2 kPa: sheared at constant volume soil with dilatancy gains
 * pressure, by consistency dp = 3 b K dl, dl = G dgamma/(G + 9 a b K), and stays on the cone;
 * without it p stays. Pulled apart it stays at the apex, c/tan(phi), and bears nothing. */
static void regolith(void **state)
{
  const double shear[9] = {0, 1, 0, 0, 0, 0, 0, 0, 0}, pull[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  const double squeeze[9] = {-1, 0, 0, 0, -1, 0, 0, 0, -1}, t = tan(.4),
               root = sqrt(9 + 12 * t * t);
  const double a = t / root, k = 3 * 2e3 / root, bulk = 1850 * 400, g = 5e5;
  (void)state;
  for (int loose = 0; loose < 2; loose++) {
    One *o = one_new(loose ? SOIL("form = \"regolith\"; dilatancy = 0.2;")
                           : SOIL("form = \"regolith\";"),
                     1850, 0);
    double b = loose ? tan(.2) / sqrt(9 + 12 * tan(.2) * tan(.2)) : 0, p, first;
    strain(o, squeeze, 2e-3, 10);
    p = o->s.p[0], first = (k + 3 * a * p) / g; /* strain at which it yields */
    near(p, bulk * 6e-3, 1e-2);
    strain(o, shear, .02, 2000);
    near(o->s.p[0], p + 3 * b * bulk * g * (.02 - first) / (g + 9 * a * b * bulk), 1e-2);
    near(root_j2(o), k + 3 * a * o->s.p[0], 1e-9);
    assert_true(loose ? o->s.alpha[0] > 1.001 : o->s.alpha[0] == 1);
    strain(o, pull, .1, 1000);
    near(o->s.p[0], -2e3 / t, 1e-3);
    assert_true(root_j2(o) < 1 && o->s.alpha[0] > 1.2);
    one_free(o);
  }
}

/* A viscous soil: S = 2 eta e while it creeps, c + p tan(phi) when it slides, nothing under
 * tension; the plastic strain is all of it. */
static void viscous(void **state)
{
  const double sink[9] = {-.2, 0, 0, 0, -.05, 0, 0, 0, -.05};
  const double slow[9] = {0, .1, 0, .1, 0, 0, 0, 0, 0}, fast[9] = {0, 1e3, 0, 1e3, 0, 0, 0, 0, 0};
  One *o = one_new(SOIL("form = \"viscous_regolith\"; viscosity = 2e3;"), 1860, 0);
  double p = o->s.p[0];
  (void)state;
  strain(o, slow, 1e-3, 10);
  near(o->s.s[1], 2 * 2e3 * .1, 1e-12);
  near(o->s.cl[0], o->s.cs[0] + 8 * 2e3 / 1860, 1e-12);
  near(o->s.strain[0], .2 * 1e-3 / sqrt(3), 1e-9);
  strain(o, fast, 1e-6, 10);
  near(root_j2(o), 2e3 + p * tan(.4), 1e-9);
  o->s.rho[0] = 1800;
  strain(o, fast, 1e-6, 1);
  assert_true(root_j2(o) == 0);
  one_free(o);
  /* of a flow that also compresses the deviator; h counts; melt and low density weaken cohesion */
  o = one_new(
      SOIL("form = \"viscous_regolith\"; viscosity = 2e3; melt_energy = 10; weak_limit = .9;"
           "weak_gamma = .5;"),
      1850 * .9, 0);
  o->s.h[0] = .5, o->s.u[0] = 4, o->s.floors.pressure = 1; /* p = 0 */
  memcpy(o->s.g, sink, sizeof sink);
  o->s.p[0] = 0, o->s.ue[0] = 4, matter_yield(&o->s, 0, 1, 0, 1e-3);
  near(o->s.s[0], 2 * 2e3 * (-.2 + .1), 1e-12), near(o->s.s[3], 2 * 2e3 * (-.05 + .1), 1e-12);
  near(o->s.s[5], -o->s.s[0] - o->s.s[3], 1e-12);
  near(o->s.cl[0], o->s.cs[0] + 8 * 2e3 / (1850 * .9 * .5), 1e-12);
  memcpy(o->s.g, fast, sizeof fast), matter_yield(&o->s, 0, 1, 0, 1e-3);
  near(root_j2(o), 2e3 * .6 * .5, 1e-9);
  one_free(o);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(confined),     cmocka_unit_test(von_mises),
      cmocka_unit_test(johnson_cook), cmocka_unit_test(tension_and_vapour),
      cmocka_unit_test(table_vapour), cmocka_unit_test(weak),
      cmocka_unit_test(cracks),       cmocka_unit_test(acts_on),
      cmocka_unit_test(crushed),      cmocka_unit_test(soft),
      cmocka_unit_test(regolith),     cmocka_unit_test(viscous),
      cmocka_unit_test(weak_pores),   cmocka_unit_test(rate),
      cmocka_unit_test(compacted),    cmocka_unit_test(stages),
      cmocka_unit_test(moduli),       cmocka_unit_test(crack_rate),
      cmocka_unit_test(soft_strains)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
