/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Porosity: crush curves against values computed by other means, loading along them and unloading
 * off them, the elastic regime, sound speeds against differences, and what is left when the pores
 * are gone: the solid, to the bit. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>
#include "physics/material.h"
#include "tabulated.h"

static const Eos ROCK = {.form = EOS_MURNAGHAN, .murnaghan = {.rho0 = 2700, .K = 30e9, .n = 4}};
/* clang-format off */
static const Eos BASALT = {.form = EOS_TILLOTSON, .tillotson = {.rho0 = 2700, .A = 26.7e9, .B = 26.7e9, .E0 = 4.87e8,
  .Eiv = 4.72e6, .Ecv = 1.82e7, .a = .5, .b = 1.5, .alpha = 5, .beta = 5}};

/* One of each law; the two powers are those of the pumice of Jutzi et al. (2009). */
static const Porosity LAWS[] = {
  {.form = POROSITY_P_ALPHA, .alpha0 = 1.25, .p_alpha = {2e8, 2e9}},
  {.form = POROSITY_P_ALPHA_TWO_POWER, .alpha0 = 1.72, .p_alpha_two_power = {1e6, 6.8e7, 2.13e8, 4.64, 1.9, 12, 3}},
  {.form = POROSITY_P_ALPHA_BLUM, .alpha0 = 2.5, .p_alpha_blum = {.044e6, 8.915, 7e-10, .875}},
  {.form = POROSITY_P_ALPHA_LOG, .alpha0 = 4, .p_alpha_log = {-.064, .084}},
  {.form = POROSITY_P_ALPHA_POWER, .alpha0 = 3, .p_alpha_power = {.41, .09}},
  {.form = POROSITY_EPSILON_ALPHA, .alpha0 = 1.4, .epsilon_alpha = {.98, -.001, -.2, 0}}};
/* clang-format on */
enum { N = sizeof LAWS / sizeof *LAWS };

static void near(double got, double want, double tolerance)
{
  if (!(fabs(got - want) <= tolerance * fabs(want))) fail_msg("%.15g, want %.15g", got, want);
}

/* Jutzi et al. (2008): p_e 0.2, p_s 2 GPa, alpha_0 1.25 at 0.5, 1, 1.5 GPa; the two powers, the
 * laws of Blum and Malamud by a calculator. */
static void curves(void **state)
{
  (void)state;
  near(porosity_curve(&LAWS[0], 5e8), 1.173611, 5e-7);
  near(porosity_curve(&LAWS[0], 1e9), 1.077160, 5e-7);
  near(porosity_curve(&LAWS[0], 1.5e9), 1.019290, 5e-7);
  near(porosity_curve(&LAWS[1], 1e7), 1.252286931749, 1e-9);
  near(porosity_curve(&LAWS[1], 1e8), 1.026958850471, 1e-9);
  near(porosity_curve(&LAWS[2], 1e5), 2.054874511421, 1e-9);
  near(porosity_curve(&LAWS[2], 1e8), 1.538350342221, 1e-9);
  near(porosity_curve(&LAWS[3], 1e6), 1 / .44, 1e-12);
  near(porosity_curve(&LAWS[4], 1e8), 1 / (.41 * pow(10, .18)), 1e-12);
  for (int k = 0; k < N - 1; k++) {
    double last = LAWS[k].alpha0;
    assert_true(porosity_curve(&LAWS[k], 0) == last && porosity_curve(&LAWS[k], -1e9) == last);
    for (double p = 1; p < 1e13; p *= 1.1) {
      double now = porosity_curve(&LAWS[k], p);
      assert_true(now <= last && now >= 1);
      last = now;
    }
  }
  assert_true(porosity_curve(&LAWS[0], 2e9) == 1 && porosity_curve(&LAWS[1], 3e8) == 1);
}

/* Where pores begin to crush: the curves' own numbers or their inverses, the pressure of elastic
 * matter at epsilon_e; nothing where they do at once, never, or are not. */
static void begin(void **state)
{
  const Eos e = {.form = EOS_MURNAGHAN, .murnaghan = {.rho0 = 2700, .K = 2e10, .n = 4}};
  Porosity dust = {.form = POROSITY_SIRONO,
                   .alpha0 = 1 / .2,
                   .sirono = {.K_0 = 3e5,
                              .power = 4,
                              .p_m = 1300,
                              .width = .58,
                              .phi_min = .12,
                              .phi_max = .58}},
           q = LAWS[5];
  (void)state;
  near(porosity_start(&LAWS[0], &e), 2e8, 1e-12), near(porosity_start(&LAWS[1], &e), 1e6, 1e-12);
  const double p = porosity_start(&LAWS[2], &e);
  near(pow(.044e6 / p, (1 + 7e-10 * p) / 8.915) + 1 / .875, 2.5, 1e-12);
  near(porosity_start(&LAWS[3], &e), pow(10, (.25 + .064) / .084), 1e-12);
  near(porosity_start(&LAWS[4], &e), 1e6 * pow(.41 * 3, -1 / .09), 1e-12);
  near(porosity_start(&q, &e), porosity_eval(&q, &e, 2700 / 1.4 * exp(.001), 0, 0, 1.4).e.p, 5e-3);
  near(porosity_start(&dust, &e), 1300 * pow(.46 / .38 - 1, .58 * log(10)), 1e-12);
  q.epsilon_alpha.epsilon_e = 0;
  assert_true(porosity_start(&q, &e) == 0);
  q = LAWS[2], q.alpha0 = 1.1; /* the curve ends at 1/.875 */
  assert_true(porosity_start(&q, &e) == 0);
  q = LAWS[0], q.alpha0 = 1;
  assert_true(porosity_start(&q, &e) == 0);
  q = LAWS[0], q.p_alpha.p_e = 0;
  assert_true(porosity_start(&q, &e) == 0);
}

/* Wuennemann et al. (2006): d alpha/d e is continuous where the exponential ends; all pores are
 * gone at e_c = 2 (1 - alpha_x)/(kappa alpha_x) + e_x. */
static void strains(void **state)
{
  const struct porosity_epsilon_alpha *q = &LAWS[5].epsilon_alpha;
  double ax = 1.4 * exp(.98 * -.199), ec = 2 * (1 - ax) / (.98 * ax) - .2, d = 1e-6;
  (void)state;
  assert_true(porosity_epsilon_alpha_crush(q, 1.4, -.0005) == 1.4);
  near(porosity_epsilon_alpha_crush(q, 1.4, -.1), 1.4 * exp(-.98 * .099), 1e-14);
  near(porosity_epsilon_alpha_crush(q, 1.4, -.2 - d), ax - .98 * ax * d, 1e-10);
  assert_true(porosity_epsilon_alpha_crush(q, 1.4, ec - d) == 1);
  near(porosity_epsilon_alpha_crush(q, 1.4, ec + d) - 1, (ax - 1) * pow(d / (ec + .2), 2), 1e-3);
}

/* Squeezed in steps of any size: alpha lies on the curve at the pressure it makes, the pressure
 * is that of the solid over alpha; let go, alpha stays; squeezed again, it stays up to where it
 * was. */
static void loading(void **state)
{
  const double range[2] = {1500, 8000}, heat[2] = {0, 1e6};
  Table t = tabulated_law(&(Material){.eos = BASALT, .heat = 1000}, range, 40, heat, 20, 0);
  const Eos table = tabulated_eos(&t), *const of[] = {&ROCK, &BASALT, &table};
  (void)state;
  for (int k = 0; k < 2 * N; k++)
    for (int eos = 0; eos < 3; eos++)
      for (double step = 1.001; step < 1.3; step = 1 + 10 * (step - 1)) {
        Porosity law = LAWS[k / 2], *q = &law;
        const Eos *e = of[eos];
        double rho = 2700 / q->alpha0, alpha = q->alpha0, u = 1e3, bulk = eos_bulk(e), h, full;
        law.c = k % 2 ? 1500 : 0;
        PorousPoint top = porosity_eval(q, e, rho, 0, 0, alpha);
        near(top.alpha, alpha, 1e-15);
        assert_true(fabs(top.e.p) < 1e-12 * 26.7e9);
        while (alpha > 1.02 && rho < 4000) {
          top = porosity_eval(q, e, rho *= step, u, 0, alpha);
          assert_true(top.alpha <= alpha && top.alpha >= 1);
          alpha = top.alpha;
          /* loaded; never denser than the solid */
          h = porosity_speed(q, e, alpha),
          full = fmax(1, alpha + top.e.p * alpha * alpha / bulk * (1 - 1 / (h * h)));
          near(top.e.p, eos_eval(e, full * rho, u, 0).p / full, 1e-8);
          if (alpha < q->alpha0 && k / 2 < N - 1) near(alpha, porosity_curve(q, top.e.p), 1e-8);
        }
        assert_true(alpha < q->alpha0);
        for (double less = rho / step; less > rho / 1.2; less /= step)
          assert_true(porosity_eval(q, e, less, u, 0, alpha).alpha == alpha);
        near(porosity_eval(q, e, rho, u, 0, alpha).alpha, alpha, 1e-12);
      }
  table_law_free((struct eos_table *)&table.table), table_free(&t);
}

/* Without pores it is the solid, to the bit, whatever the state; so it is when they are gone. */
static void solid(void **state)
{
  (void)state;
  for (int k = 0; k < N; k++)
    for (double rho = 1000; rho < 9000; rho *= 1.1)
      for (double u = 0; u < 3e7; u = 3 * u + 1e4) {
        Porosity q = LAWS[k];
        EosPoint e = eos_eval(&BASALT, rho, u, 0);
        q.alpha0 = 1;
        PorousPoint a = porosity_eval(&q, &BASALT, rho, u, 0, 1);
        assert_true(a.e.p == e.p && a.e.cs == e.cs && a.alpha == 1 && a.stiff == 1);
        a = porosity_eval(&LAWS[k], &BASALT, rho, u, 0, 1);
        assert_true(a.e.p == e.p && a.e.cs == e.cs && a.alpha == 1 && a.stiff == 1);
        assert_true(porosity_share(&q, &BASALT, rho, u, e.p, 1, 1) == 1);
      }
}

/* c^2 = dp/drho along du = p/rho^2 drho with the pores as they are; without load it is c_elastic at
 * alpha_0, half way for half the pores (Herrmann 1969). */
static void elastic(void **state)
{
  (void)state;
  for (int k = 0; k < N; k++)
    for (int soft = 0; soft < 2; soft++) {
      Porosity q = LAWS[k];
      double rho = 2700 / q.alpha0, d = 1e-6, c0 = eos_eval(&ROCK, 2700, 0, 0).cs, alpha;
      q.c = soft ? 1500 : 0;
      for (int tension = 0; tension < 2; tension++) {
        double at = rho * (tension ? 1 - 1e-9 : 1 + 1e-9);
        PorousPoint m = porosity_eval(&q, &ROCK, at, 0, 0, q.alpha0);
        PorousPoint a = porosity_eval(&q, &ROCK, at * (1 - d), 0, 0, q.alpha0);
        PorousPoint b = porosity_eval(&q, &ROCK, at * (1 + d), 0, 0, q.alpha0);
        near(m.e.cs, soft ? 1500 : c0, 1e-6);
        if (k != 1 && k != 2 && k != 3 && k != 4) /* not yet crushing at such strains */
          near(sqrt((b.e.p - a.e.p) / (2 * d * at)), m.e.cs, 1e-4);
        near(rho * m.e.cs * m.e.cs / 30e9, m.stiff, 1e-6);
      }
      alpha = (1 + q.alpha0) / 2;
      near(porosity_eval(&q, &ROCK, 2700 / alpha, 0, 0, alpha).e.cs, soft ? (1500 + c0) / 2 : c0,
           1e-3);
    }
}

/* Under load, with heat: to 2 % where p depends on u (the law takes c^2 of the solid for
 * dp/drho). */
static void sound(void **state)
{
  const Porosity q = {.form = POROSITY_P_ALPHA, .alpha0 = 1.25, .c = 1500, .p_alpha = {2e8, 2e9}};
  (void)state;
  for (int k = 0; k < 2; k++)
    for (double u = 0; u < 3e4; u += 1e4) {
      const Eos *e = k ? &BASALT : &ROCK;
      double rho = 2250 * 1.005, d = 1e-5;
      PorousPoint m = porosity_eval(&q, e, rho, u, 0, 1.2), a, b;
      assert_true(m.alpha == 1.2);
      a = porosity_eval(&q, e, rho * (1 - d), u - d * m.e.p / rho, 0, 1.2);
      b = porosity_eval(&q, e, rho * (1 + d), u + d * m.e.p / rho, 0, 1.2);
      near(m.e.cs, sqrt((b.e.p - a.e.p) / (2 * d * rho)), k ? .02 : 1e-4);
    }
}

/* f = 1 + dln(alpha)/dln(rho), by differences along the crush curve and off it. */
static void share(void **state)
{
  (void)state;
  for (int k = 0; k < N; k++) {
    const Porosity *q = &LAWS[k];
    double rho = 2700 / q->alpha0 * 1.1, d = 1e-6;
    PorousPoint m = porosity_eval(q, &ROCK, rho, 0, 0, q->alpha0);
    PorousPoint b = porosity_eval(q, &ROCK, rho * (1 + d), 0, 0, m.alpha);
    double f = 1 + log(b.alpha / m.alpha) / log(1 + d);
    assert_true(m.alpha < q->alpha0 && f < 1);
    assert_true(fabs(porosity_share(q, &ROCK, rho, 0, m.e.p, m.alpha, 1) - f) < 2e-3);
    assert_true(porosity_share(q, &ROCK, rho, 0, m.e.p, m.alpha, 0) == 1);
    b = porosity_eval(q, &ROCK, rho * .98, 0, 0, m.alpha);
    assert_true(porosity_share(q, &ROCK, rho * .98, 0, b.e.p, m.alpha, 1) == 1);
  }
}

/* Collins et al. (2011): heat expands the solid, so that the same strain leaves fewer pores. */
static void thermal(void **state)
{
  Porosity q = LAWS[5];
  double rho = 2700 / 1.4 * 1.1, u = 1e6, e = -log(1.1) - .8 * u * 2700 / 26.7e9;
  (void)state;
  q.epsilon_alpha.gamma = .8;
  near(porosity_eval(&q, &BASALT, rho, u, 0, 1.4).alpha, 1.4 * exp(.98 * (e + .001)), 1e-12);
}

/* Sirono's dust with the strengths of Guettler et al. (2009): compressed along C, stretched along
 * T, elastic with K between. */
static void dust(void **state)
{
  const Porosity q = {.form = POROSITY_SIRONO,
                      .alpha0 = 1 / .2,
                      .sirono = {4.5e3, 4, 1.3e3, .58, .12, .58, 2.8, 1.48}};
  const Eos silica = {.form = EOS_LIQUID, .liquid = {.rho0 = 2000, .c = 3000}};
  double alpha = 5, c = 1.3e3 * pow(.46 / (.58 - .3) - 1, .58 * log(10));
  (void)state;
  PorousPoint m = porosity_eval(&q, &silica, 400, 0, 0, 5);
  near(m.e.cs, sqrt(4.5e3 / 400), 1e-12);
  assert_true(m.e.p == 0 && m.alpha == 5 && m.stiff == 1);
  near(porosity_eval(&q, &silica, 400.1, 0, 0, 5).e.p, 4.5e3 * .1 / 400, 1e-9);
  for (double rho = 400; rho <= 600.0001; rho += 1) {
    m = porosity_eval(&q, &silica, rho, 0, 0, alpha);
    assert_true(m.alpha <= alpha);
    alpha = m.alpha;
  }
  near(m.e.p, c, 1e-6);
  near(m.e.p, 4.5e3 * pow(5 / alpha, 4) * (.3 * alpha - 1), 1e-6); /* from the new zero of p */
  near(m.stiff, pow(5 / alpha, 4), 1e-12);
  for (double rho = 600; rho >= 399.999; rho -= 1)
    alpha = porosity_eval(&q, &silica, rho, 0, 0, alpha).alpha;
  near(porosity_eval(&q, &silica, 400, 0, 0, alpha).e.p, -pow(10, 2.8 + 1.48 * .2), 1e-9);
  near(porosity_shear_strength(&q, &silica, 600), sqrt(c * pow(10, 2.8 + 1.48 * .3)), 1e-12);
  /* looser than the loosest nothing is borne; the densest does not crush any more */
  m = porosity_eval(&q, &silica, 200.1, 0, 0, 10);
  assert_true(m.e.p == 0), near(m.alpha, 2000 / 200.1, 1e-12);
  m = porosity_eval(&q, &silica, 1300, 0, 0, 1 / .6);
  assert_true(m.alpha == 1 / .6), near(m.e.p, 4.5e3 * pow(3, 4) * (.65 / .6 - 1), 1e-12);
}

/* The integral of Jutzi et al. (2008), d D^(1/3) = -1/3 (1 - x + delta)^(-2/3)/((1 + delta)^(1/3) -
 * delta^(1/3)) dx with x = (alpha - 1)/(alpha_0 - 1). */
static void broken(void **state)
{
  double sum = 0, d = 1e-5, norm = cbrt(1.01) - cbrt(.01);
  (void)state;
  for (double x = 1 - d / 2; x > 0; x -= d) {
    sum += d / 3 * pow(1 - x + .01, -2. / 3) / norm;
    if (fabs(x - .5) < d / 2 || fabs(x - .1) < d / 2)
      near(porosity_broken(&LAWS[0], 1 + .25 * (x - d / 2)), sum, 1e-4);
  }
  assert_true(porosity_broken(&LAWS[0], 1.25) == 0 && porosity_broken(&LAWS[0], 1.5) == 0);
  assert_true(porosity_broken(&(Porosity){.form = POROSITY_P_ALPHA, .alpha0 = 1}, 1) == 0);
  near(porosity_broken(&LAWS[0], 1), 1, 1e-14);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(curves),  cmocka_unit_test(begin),  cmocka_unit_test(strains),
      cmocka_unit_test(loading), cmocka_unit_test(solid),  cmocka_unit_test(elastic),
      cmocka_unit_test(sound),   cmocka_unit_test(share),  cmocka_unit_test(thermal),
      cmocka_unit_test(dust),    cmocka_unit_test(broken),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
