/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Yield laws: where the stress ends up, softening, and what the printed formula does instead; for
 * rock and soil the stresses at which a specimen fails, in closed form or by looking at all planes;
 * for metals published values. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>
#include "physics/material.h"

#define PI 3.14159265358979323846

static const double Y = 3.5e9; /* Pa, basalt */

static Yield law(int form)
{
  Yield y;
  memset(&y, 0, sizeof y);
  y.form = form;
  if (form == YIELD_VON_MISES) y.von_mises.Y = Y;
  if (form == YIELD_BENZ_ASPHAUG) y.benz_asphaug.Y = Y;
  if (form == YIELD_DRUCKER_PRAGER) y.drucker_prager = (struct yield_drucker_prager){5e6, 0.6};
  if (form == YIELD_MOHR_COULOMB) y.mohr_coulomb = (struct yield_mohr_coulomb){5e6, 0.6, 1e300};
  if (form == YIELD_LUNDBORG) y.lundborg = (struct yield_lundborg){90e6, 2, 1.5e9};
  if (form == YIELD_COLLINS) y.collins = (struct yield_collins){90e6, 2, 1.5e9, 1e5, 0.8};
  if (form == YIELD_JOHNSON_COOK)
    y.johnson_cook = (struct yield_johnson_cook){792e6, 510e6, .26, .014, 1, 1.03, 298, 1793, .9};
  if (form == YIELD_POROUS) y.porous.factor = 1;
  if (form == YIELD_REGOLITH) y.regolith = (struct yield_regolith){5e6, 0.6, 0};
  if (form == YIELD_VISCOUS_REGOLITH) y.viscous_regolith.viscosity = 1;
  return y;
}

/* A whole stress, tension positive: sqrt(J2) after its return over sqrt(J2) before. */
static double returned(const Yield *y, Sym stress, double damage)
{
  double p = -(stress.xx + stress.yy + stress.zz) / 3;
  Sym s = {stress.xx + p, stress.xy, stress.xz, stress.yy + p, stress.yz, stress.zz + p};
  YieldPoint at = {s, tensor_j2(s), p, damage, 1, 1, 0, 0, 298, 1e6};
  double f = yield_factor(y, &at);
  assert_true(f >= 0 && f <= 1);
  return f;
}

/* That a stress a little below `stress` stays, and one with x times its deviator returns to it.
 * (Mohr-Coulomb's Lode angle is known to 1e-8 only at the edges of the hexagon.) */
static void at_limit(const Yield *y, Sym stress, double damage)
{
  double p = -(stress.xx + stress.yy + stress.zz) / 3;
  Sym s = {stress.xx + p, stress.xy, stress.xz, stress.yy + p, stress.yz, stress.zz + p};
  Sym mean = {-p, 0, 0, -p, 0, -p};
  assert_true(returned(y, tensor_axpy(mean, 1 - 1e-7, s), damage) == 1);
  for (double x = 1.1; x < 1e3; x *= 3)
    assert_true(fabs(returned(y, tensor_axpy(mean, x, s), damage) * x - 1) <
                (y->form == YIELD_MOHR_COULOMB ? 1e-7 : 1e-12));
}

/* A deviatoric stress with all components, and a given sqrt(3 J2). */
static Sym stress(double equivalent)
{
  Sym s = {2, -0.7, 0.4, -0.5, 1.1, -1.5};
  return tensor_scale(s, equivalent / sqrt(3 * tensor_j2(s)));
}

static double after(const Yield *y, double equivalent, double u, double melt)
{
  Sym s = stress(equivalent);
  YieldPoint at = {s, tensor_j2(s), 1e9, 0, yield_soft(u, melt), 1, 0, 0, 298, 1e6};
  double f = yield_factor(y, &at);
  assert_true(f >= 0 && f <= 1);
  return sqrt(3 * tensor_j2(tensor_scale(s, f)));
}

/* In uniaxial tension s sqrt(3 J2) = s. */
static void equivalent_of_uniaxial(void **state)
{
  Sym s = {2. / 3, 0, 0, -1. / 3, 0, -1. / 3};
  (void)state;
  assert_true(fabs(sqrt(3 * tensor_j2(s)) - 1) < 1e-15);
}

/* 2 Y comes back to Y, not to Y/2 (001 eq. 17); below Y nothing happens. */
static void radial_return(void **state)
{
  Yield y = law(YIELD_VON_MISES);
  (void)state;
  for (double x = 1.001; x < 1e6; x *= 1.7)
    assert_true(fabs(after(&y, x * Y, 0, 0) - Y) < 1e-12 * Y);
  for (double x = 1e-9; x < 1; x *= 1.7)
    assert_true(fabs(after(&y, x * Y, 0, 0) - x * Y) < 1e-12 * x * Y);
  assert_true(after(&y, 0, 0, 0) == 0);
}

/* As printed: x Y goes to Y/x; the two agree in the limit of small excess. */
static void benz_asphaug(void **state)
{
  Yield y = law(YIELD_BENZ_ASPHAUG);
  (void)state;
  for (double x = 1.001; x < 1e3; x *= 1.7)
    assert_true(fabs(after(&y, x * Y, 0, 0) - Y / x) < 1e-12 * Y);
  assert_true(fabs(after(&y, 0.999 * Y, 0, 0) - 0.999 * Y) < 1e-12 * Y);
  assert_true(fabs(after(&y, (1 + 1e-6) * Y, 0, 0) - Y) < 1.1e-6 * Y);
}

/* Y (1 - u/melt) below the melt energy, no stress at all above, no hardening for u < 0. */
static void melting(void **state)
{
  const double melt = 3.4e6, far = 1e12; /* J/kg, Pa */
  (void)state;
  for (int form = YIELD_NONE + 1; form < YIELD_COUNT; form++) {
    Yield y = law(form);
    double cold = after(&y, far, 0, 0);
    if (form == YIELD_VISCOUS_REGOLITH) continue; /* its stress is not returned but made */
    assert_true(cold > 0 && cold < far);
    for (double x = 0; x < 1; x += 0.1) {
      double got = after(&y, far, x * melt, melt), part = 1 - x;
      assert_true(fabs(got - cold * (form == YIELD_BENZ_ASPHAUG ? part * part : part)) <
                  1e-12 * cold);
    }
    assert_true(after(&y, 1e-3 * Y, melt, melt) == 0 && after(&y, Y, 2 * melt, melt) == 0);
    assert_true(after(&y, far, -melt, melt) == cold);
    assert_true(after(&y, far, 1e9, 0) == cold); /* no melt energy known */
  }
}

static void elastic(void **state)
{
  Yield y = law(YIELD_NONE);
  Sym s = stress(1e20);
  YieldPoint at = {s, tensor_j2(s), 0, 0.5, 0, 1, 0, 0, 0, 1e6};
  (void)state;
  assert_true(yield_factor(&y, &at) == 1);
}

/* In plane strain the third normal stress counts: diag(1, -0.5, -0.5), not diag(1, -0.5). */
static void plane_strain(void **state)
{
  Yield y = law(YIELD_VON_MISES);
  Sym s = {Y, 0, 0, -0.5 * Y, 0, -0.5 * Y};
  (void)state;
  assert_true(fabs(returned(&y, s, 0) - 1 / 1.5) < 1e-14);
}

/* A cylinder under the pressure q around it fails when the stress along it is q N + 2 c sqrt(N), N
 * = (1 + sin phi)/(1 - sin phi) (Coulomb); Drucker-Prager is matched to that. */
static void triaxial_compression(void **state)
{
  (void)state;
  for (double phi = 0.01; phi < 1.3; phi += 0.2)
    for (double q = 0; q < 1e9; q = 3 * q + 1e5) {
      double c = 5e6, n = (1 + sin(phi)) / (1 - sin(phi)), along = q * n + 2 * c * sqrt(n);
      Yield dp = {.form = YIELD_DRUCKER_PRAGER, .drucker_prager = {c, phi}};
      Yield mc = {.form = YIELD_MOHR_COULOMB, .mohr_coulomb = {c, phi, 1e300}};
      at_limit(&dp, (Sym){-q, 0, 0, -along, 0, -q}, 0);
      at_limit(&mc, (Sym){-q, 0, 0, -along, 0, -q}, 0);
      at_limit(&mc, (Sym){-along, 0, 0, -q, 0, -along}, 0); /* extension: pulled along y */
    }
}

/* Simple shear tau under the pressure p: Mohr's circle touches at tau = c cos phi + p sin phi; the
 * cone of Drucker-Prager is wider there. Without friction Mohr-Coulomb is Tresca's law. */
static void shear(void **state)
{
  double c = 5e6, phi = 0.6, p = 2e7, tau = c * cos(phi) + p * sin(phi);
  Yield dp = {.form = YIELD_DRUCKER_PRAGER, .drucker_prager = {c, phi}};
  Yield mc = {.form = YIELD_MOHR_COULOMB, .mohr_coulomb = {c, phi, 1e300}};
  Yield tresca = {.form = YIELD_MOHR_COULOMB, .mohr_coulomb = {c, 0, 1e300}};
  Yield capped = {.form = YIELD_MOHR_COULOMB, .mohr_coulomb = {c, phi, 3e6}};
  (void)state;
  at_limit(&mc, (Sym){-p, 0, tau, -p, 0, -p}, 0);
  at_limit(&dp, (Sym){-p, 0, tau * 2 * sqrt(3) / (3 - sin(phi)), -p, 0, -p}, 0);
  at_limit(&tresca, (Sym){c - p, 0, 0, -c - p, 0, -p}, 0);
  at_limit(&tresca, (Sym){2 * c - p, 0, 0, -p, 0, -p}, 0);
  at_limit(&capped, (Sym){-p, 3e6, 0, -p, 0, -p}, 0);
}

/* The largest |tau| - sigma_n tan(phi) (sigma_n a pressure) over all planes, of a stress. */
static double worst_plane(Sym s, double phi)
{
  double worst = -INFINITY;
  for (double t = 0; t <= PI / 2; t += PI / 600)
    for (double f = 0; f < 2 * PI; f += PI / 300) {
      double n[3] = {sin(t) * cos(f), sin(t) * sin(f), cos(t)};
      double v[3] = {s.xx * n[0] + s.xy * n[1] + s.xz * n[2],
                     s.xy * n[0] + s.yy * n[1] + s.yz * n[2],
                     s.xz * n[0] + s.yz * n[1] + s.zz * n[2]};
      double normal = v[0] * n[0] + v[1] * n[1] + v[2] * n[2];
      double shear2 = v[0] * v[0] + v[1] * v[1] + v[2] * v[2] - normal * normal;
      worst = fmax(worst, sqrt(fmax(shear2, 0)) + normal * tan(phi));
    }
  return worst;
}

/* Any stress that Mohr-Coulomb has returned has c on its worst plane. */
static void all_planes(void **state)
{
  Yield y = law(YIELD_MOHR_COULOMB);
  static const Sym T[] = {{-90, 40, -20, -60, 55, -150}, {-40, 0, 70, -80, 0, -60}};
  (void)state;
  for (int k = 0; k < 2; k++) {
    double p = -1e6 * (T[k].xx + T[k].yy + T[k].zz) / 3,
           f = returned(&y, tensor_scale(T[k], 1e6), 0);
    Sym back = tensor_scale(T[k], 1e6 * f);
    back.xx -= (1 - f) * p, back.yy -= (1 - f) * p, back.zz -= (1 - f) * p;
    assert_true(f < 1);
    assert_true(fabs(worst_plane(back, 0.6) - 5e6) < 2e-3 * 5e6);
  }
}

/* The limit of sqrt(J2) of a law at p. */
static double strength(const Yield *y, double p, double damage, double soft, double weak)
{
  Sym s = {0, 1e15, 0, 0, 0, 0};
  YieldPoint at = {s, tensor_j2(s), p, damage, soft, weak, 0, 0, 0, 1e6};
  return 1e15 * yield_factor(y, &at);
}

static void close_to(double got, double want)
{
  if (!(fabs(got - want) <= 1e-12 * fabs(want))) fail_msg("%.15g, want %.15g", got, want);
}

/* 1/(Y - c) = 1/(mu p) + 1/(Y_M - c): half way up where mu p = Y_M - c, slope mu at 0. */
static void lundborg(void **state)
{
  Yield y = law(YIELD_LUNDBORG);
  (void)state;
  for (double p = 1e5; p < 1e11; p *= 3)
    close_to(1 / (strength(&y, p, 0, 1, 1) - 90e6), 1 / (2 * p) + 1 / (1.5e9 - 90e6));
  close_to(strength(&y, 0.705e9, 0, 1, 1), 90e6 + 0.705e9);
  assert_true(fabs((strength(&y, 1e3, 0, 1, 1) - 90e6) / 1e3 - 2) < 1e-3);
  assert_true(fabs(strength(&y, 1e15, 0, 1, 1) - 1.5e9) < 2e3);
  close_to(strength(&y, -30e6, 0, 1, 1), 60e6);
  assert_true(strength(&y, -90e6, 0, 1, 1) == 0 && strength(&y, -2e8, 0, 1, 1) == 0);
  close_to(strength(&y, -30e6, 0, 1, .5), 15e6);
  y.lundborg.limit = 1e300; /* linear friction */
  close_to(strength(&y, 1e9, 0, 1, 1), 90e6 + 2e9);
}

/* Granite of Collins et al. (2004): intact, shattered, half of each; the shattered branch meets the
 * intact one at high pressure and never passes it. */
static void collins(void **state)
{
  Yield y = law(YIELD_COLLINS), rock = law(YIELD_LUNDBORG);
  (void)state;
  for (double p = 1e4; p < 1e11; p *= 2) {
    double intact = strength(&rock, p, 0, 1, 1), loose = fmin(1e5 + .8 * p, intact);
    close_to(strength(&y, p, 0, 1, 1), intact);
    close_to(strength(&y, p, 1, 1, 1), loose);
    close_to(strength(&y, p, .3, 1, 1), .7 * intact + .3 * loose);
    close_to(strength(&y, p, .3, .25, 1), .25 * (.7 * intact + .3 * loose));
    close_to(strength(&y, p, 1, 1, .5), fmin(.5e5 + .8 * p, intact));
  }
  assert_true(strength(&y, 1.2e9, 1, 1, 1) < strength(&y, 1.2e9, 0, 1, 1)); /* they meet at 1.234 */
  assert_true(strength(&y, 1.3e9, 1, 1, 1) == strength(&y, 1.3e9, 0, 1, 1));
  close_to(strength(&y, -1e8, 0, 1, 1), 90e6);
  close_to(strength(&y, -4e4, 1, 1, 1), 6e4);
  assert_true(strength(&y, -2e5, 1, 1, 1) == 0);
  close_to(strength(&y, -2e5, .25, 1, 1), .75 * 90e6);
}

/* Where the envelopes of rock and soil close under tension; metals have no such point. */
static void tension(void **state)
{
  Yield y = law(YIELD_COLLINS);
  (void)state;
  close_to(yield_tension(&y, 0, 1, 1), 90e6);
  close_to(yield_tension(&y, 1, 1, 1), 1e5);
  close_to(yield_tension(&y, .5, .5, .1), .5 * (45e6 + .5e4));
  for (int form = YIELD_DRUCKER_PRAGER; form <= YIELD_LUNDBORG; form++) {
    y = law(form);
    double most = yield_tension(&y, 0, 1, .5);
    assert_true(strength(&y, -most * (1 + 1e-9), 0, 1, .5) == 0);
    assert_true(strength(&y, -most * (1 - 1e-9), 0, 1, .5) > 0);
    close_to(yield_tension(&y, 0, .25, .5), .25 * most);
  }
  y = law(YIELD_DRUCKER_PRAGER);
  close_to(yield_tension(&y, 0, 1, 1), 5e6 / tan(.6));
  for (int form = 0; form < YIELD_COUNT; form++) {
    y = law(form);
    assert_true(isinf(yield_tension(&y, 0, 1, 1)) == !yield_knows_pressure(&y));
  }
}

/* Without shear there is nothing to take back, but what is pulled beyond the envelope; a law that
 * has its limit without pressure stays there. */
static void unloaded(void **state)
{
  Yield y = law(YIELD_LUNDBORG);
  (void)state;
  y.lundborg.limit = y.lundborg.cohesion;
  for (double p = 0; p < 1e10; p = 3 * p + 1e5) close_to(strength(&y, p, 0, 1, 1), 90e6);
  for (int form = 0; form < YIELD_COUNT; form++)
    for (double p = -1e9; p <= 1e9; p += 2.5e8) {
      Sym none = {-p, 0, 0, -p, 0, -p};
      y = law(form);
      double f = returned(&y, none, 0.5);
      assert_true(p < 0 ? f == 0 || f == 1 : f == 1);
    }
}

/* Half the cohesion is half the strength without pressure, of each law (of Collins the broken
 * rock), and half the tension. */
static void weak_laws(void **state)
{
  (void)state;
  for (int form = YIELD_NONE + 1; form < YIELD_COUNT; form++) {
    Yield y = law(form);
    double whole = strength(&y, 0, 1, 1, 1), half = strength(&y, 0, 1, 1, .5);
    if (form == YIELD_VISCOUS_REGOLITH) continue; /* its stress is made */
    close_to(half, whole * (form == YIELD_BENZ_ASPHAUG ? .25 : .5));
    if (yield_knows_pressure(&y))
      close_to(yield_tension(&y, 1, 1, .5), .5 * yield_tension(&y, 1, 1, 1));
  }
}

static double flow(const Yield *y, double strain, double rate, double T)
{
  Sym s = {0, 1e15, 0, 0, 0, 0};
  YieldPoint at = {s, tensor_j2(s), 0, 0, 1, 1, strain, rate, T, 1e6};
  return sqrt(3) * 1e15 * yield_factor(y, &at);
}

/* Johnson & Cook (1983), table 1: 4340 steel and OFHC copper, evaluated by hand. */
static void johnson_cook(void **state)
{
  Yield steel = law(YIELD_JOHNSON_COOK);
  Yield copper = {.form = YIELD_JOHNSON_COOK,
                  .johnson_cook = {90e6, 292e6, .31, .025, 1, 1.09, 298, 1356, .9}};
  (void)state;
  close_to(flow(&steel, 0, 0, 298), 792e6);
  assert_true(fabs(flow(&steel, .1, 1, 298) - 1072.266e6) < 1e3);
  assert_true(fabs(flow(&steel, .1, 1e3, 298) - 1175.963e6) < 1e3);
  assert_true(fabs(flow(&steel, .1, 1e3, 500) - 1026.331e6) < 1e3);
  assert_true(fabs(flow(&copper, .3, 4000, 600) - 261.792e6) < 1e3);
  close_to(flow(&steel, .1, 1e-3, 298), flow(&steel, .1, 1, 298)); /* slower than rate0 */
  close_to(flow(&steel, .1, 1, 100), flow(&steel, .1, 1, 298));    /* colder than T0 */
  steel.johnson_cook.rate0 = 50;
  close_to(flow(&steel, .1, 1e3, 298), flow(&steel, .1, 1, 298) * (1 + .014 * log(20)));
  steel.johnson_cook.rate0 = 1, steel.johnson_cook.n = 0; /* B counts from the start */
  close_to(flow(&steel, 0, 1, 298), 792e6 + 510e6);
  close_to(flow(&steel, .3, 1, 298), 792e6 + 510e6);
  assert_true(flow(&steel, .1, 1, 1793) == 0 && flow(&steel, 1, 1e6, 1e4) == 0);
}

/* Luther et al. (2022) for regolith: half the cohesion is left at eta = 0.85. Continuous,
 * monotonous. */
static void weakening(void **state)
{
  const YieldWeak w = {.85, .2, 4, .5};
  double last = 0;
  (void)state;
  assert_true(yield_weak(&w, 1) == 1 && yield_weak(&w, 1.3) == 1 && yield_weak(&w, 0) == 0);
  close_to(yield_weak(&w, .925), .5 + .5 * pow(.5, .2));
  close_to(yield_weak(&w, .85), .5);
  close_to(yield_weak(&w, .85 / 2), .5 / 16);
  for (double eta = .01; eta < 1.1; eta += .01) {
    assert_true(yield_weak(&w, eta) >= last);
    last = yield_weak(&w, eta);
  }
  assert_true(fabs(yield_weak(&w, 1 - 1e-12) - 1) < 1e-9);
  assert_true(fabs(yield_weak(&w, .85 * (1 + 1e-15)) - .5) < 2e-3);
}

/* Bui et al. (2008): the trial stress goes back along the flow, sqrt(J2) - G l, p + 3 b K l, to
 * where the cone is (bisection), or to its axis; nothing lies beyond the apex. Melt and low density
 * take their part off the cone. */
static void regolith_return(void **state)
{
  const struct yield_regolith y = {2e3, .6, .3}, dry = {2e3, 0, .3};
  const double t = tan(.6), root = sqrt(9 + 12 * t * t),
               b = tan(.3) / sqrt(9 + 12 * pow(tan(.3), 2));
  const double K = 2e6, G = 7e5;
  (void)state;
  for (double q = 0; q < 1e5; q = 2 * q + 100)
    for (double p = -2e4; p < 2e4; p += 1e3)
      for (double soft = 1; soft > .2; soft -= .5)
        for (double weak = 1; weak > .2; weak -= .5) {
          const double a = soft * t / root, k = soft * weak * 3 * 2e3 / root;
          YieldPoint at = {
              .s = {0, q, 0, 0, 0, 0}, .j2 = q * q, .p = p, .soft = soft, .weak = weak};
          double low = 0, high = q / G;
          if (q <= k + 3 * a * p) high = 0;
          for (int n = 0; n < 200; n++) {
            double l = .5 * (low + high);
            *(q - G * l > k + 3 * a * (p + 3 * b * K * l) ? &low : &high) = l;
          }
          double want = fmax(p + 3 * b * K * high, -k / (3 * a));
          double got = yield_regolith_pressure(&y, &at, K, G);
          if (!(fabs(got - want) <= 1e-9 * (fabs(want) + q)))
            fail_msg("q %g p %g: %.12g, want %.12g", q, p, got, want);
        }
  YieldPoint deep = {.p = -1e9, .soft = 1, .weak = 1};
  assert_true(yield_regolith_pressure(&dry, &deep, K, G) == -1e9); /* no friction, no apex */
}

/* The partly vaporised states of Tillotson, and what is denser or colder than these. */
static void vapour(void **state)
{
  Eos e = {.form = EOS_TILLOTSON, .tillotson = {.rho0 = 2700, .Eiv = 4e6, .Ecv = 2e7}};
  Eos gas = {.form = EOS_IDEAL};
  (void)state;
  assert_true(eos_vapour(&e, 2600, 5e6) && eos_vapour(&e, 10, 3e7));
  assert_true(!eos_vapour(&e, 2800, 5e6) && !eos_vapour(&e, 2600, 3e6) && !eos_vapour(&gas, 1, 1));
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(equivalent_of_uniaxial),
      cmocka_unit_test(radial_return),
      cmocka_unit_test(benz_asphaug),
      cmocka_unit_test(melting),
      cmocka_unit_test(elastic),
      cmocka_unit_test(plane_strain),
      cmocka_unit_test(triaxial_compression),
      cmocka_unit_test(shear),
      cmocka_unit_test(all_planes),
      cmocka_unit_test(lundborg),
      cmocka_unit_test(collins),
      cmocka_unit_test(tension),
      cmocka_unit_test(johnson_cook),
      cmocka_unit_test(weakening),
      cmocka_unit_test(weak_laws),
      cmocka_unit_test(unloaded),
      cmocka_unit_test(vapour),
      cmocka_unit_test(regolith_return),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
