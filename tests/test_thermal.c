/* SPDX-License-Identifier: GPL-3.0-or-later */
/* lib/thermal: isentropes against closed forms and against their own definition, temperature and
 * energy as inverses, entropy as what du = T ds says. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include "../lib/thermal.h"

/* clang-format off */
static const Material ROCK = {.eos = {.form = EOS_MURNAGHAN, .murnaghan = {.rho0 = 2700, .K = 5e10, .n = 4}}, .heat = 840};
static const Material GAS = {.eos = {.form = EOS_IDEAL, .ideal = {.gamma = 1.4}}, .heat = 717};
static const Material IRON = {.eos = {.form = EOS_TILLOTSON, .tillotson = {.rho0 = 7800, .A = 128e9, .B = 105e9, .E0 = 9.5e6,
  .Eiv = 2.4e6, .Ecv = 8.67e6, .a = 0.5, .b = 1.5, .alpha = 5, .beta = 5}}, .heat = 449};
/* clang-format on */

static void near(double got, double want, double tolerance)
{
  if (!(fabs(got - want) <= tolerance * fabs(want))) fail_msg("%.14g, want %.14g", got, want);
}

/* Murnaghan: u = K/(n rho0) (x^(n-1)/(n-1) + 1/x - n/(n-1)), x = rho/rho0; ideal gas: u ~
 * rho^(gamma-1). */
static void test_closed(void **state)
{
  (void)state;
  for (double x = 0.8; x < 2; x += 0.15)
    near(thermal_cold(&ROCK.eos, 2700 * x) + 1e6,
         5e10 / 4 / 2700 * (x * x * x / 3 + 1 / x - 4. / 3) + 1e6, 1e-10);
  near(thermal_isentrope(&GAS.eos, 1.2, 2e5, 30), 2e5 * pow(25, 0.4), 1e-10);
  near(thermal_isentrope(&GAS.eos, 30, 2e5, 1.2), 2e5 * pow(25, -0.4), 1e-10);
  assert_true(thermal_cold(&GAS.eos, 3) == 0);
}

/* Tillotson: du/drho = p/rho^2 by central differences; there and back again. */
static void test_tillotson(void **state)
{
  double u = thermal_isentrope(&IRON.eos, 7800, 3e5, 11000);
  (void)state;
  for (double rho = 8000; rho < 14000; rho += 1500) {
    double up = thermal_isentrope(&IRON.eos, 7800, 3e5, rho + 1);
    double down = thermal_isentrope(&IRON.eos, 7800, 3e5, rho - 1);
    double mid = thermal_isentrope(&IRON.eos, 7800, 3e5, rho);
    near((up - down) / 2, eos_eval(&IRON.eos, rho, mid, 0).p / (rho * rho), 1e-6);
  }
  near(thermal_isentrope(&IRON.eos, 11000, u, 7800), 3e5, 1e-9);
}

static void test_temperature(void **state)
{
  Material bare = IRON;
  (void)state;
  bare.heat = 0;
  near(thermal_temperature(&IRON, 7800, 449e3), 1000, 1e-12);
  near(thermal_temperature(&IRON, 11000, thermal_energy(&IRON, 11000, 4321)), 4321, 1e-12);
  near(thermal_temperature(&GAS, 5, 717 * 300.), 300, 1e-12);
  assert_true(isnan(thermal_temperature(&bare, 8000, 1e5)) && isnan(thermal_energy(&bare, 1, 1)));
}

/* ds = du/T at rho0; the same along an isentrope; the inverse. */
static void test_entropy(void **state)
{
  double s = thermal_entropy(&IRON, 7800, 5e5), more = thermal_entropy(&IRON, 7800, 5e5 + 10);
  (void)state;
  near(more - s, 10 / (5e5 / 449), 1e-4);
  near(thermal_entropy(&IRON, 10500, thermal_isentrope(&IRON.eos, 7800, 5e5, 10500)), s, 1e-9);
  near(thermal_at_entropy(&IRON, s), 5e5, 1e-10);
  assert_true(isnan(thermal_entropy(&GAS, 1, 1e5)));
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_closed),
      cmocka_unit_test(test_tillotson),
      cmocka_unit_test(test_temperature),
      cmocka_unit_test(test_entropy),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
