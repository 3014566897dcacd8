/* SPDX-License-Identifier: GPL-3.0-or-later */
/* lib/lattice: a true close packing (docs/theory.md 6.1), whole shells, centre of mass,
 * volume. */
#include <math.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <setjmp.h>
#include <cmocka.h>
#include "../lib/lattice.h"

static const double PI = 3.14159265358979323846;

static LatticeBall ball(Lattice lattice, int dimension, long want)
{
  LatticeBall b;
  Err err;
  if (lattice_ball(&b, lattice, dimension, want, &err)) fail_msg("%s", err.text);
  return b;
}

/* The numbers of sites at the squared distances r2, and none at others, up to the last. */
static void check_shells(Lattice lattice, int dimension, int n, const double *r2, const int *number)
{
  LatticeBall b = ball(lattice, dimension, 500);
  for (int s = 0; s < n; s++) {
    int here = 0;
    for (long i = 0; i < b.n; i++) {
      double x2 = b.x[3 * i] * b.x[3 * i] + b.x[3 * i + 1] * b.x[3 * i + 1] +
                  b.x[3 * i + 2] * b.x[3 * i + 2];
      assert_true((b.shell[i] == s) == (fabs(x2 - r2[s]) < 1e-12));
      here += b.shell[i] == s;
    }
    assert_int_equal(here, number[s]);
    assert_int_equal(b.within[s] - (s ? b.within[s - 1] : 0), number[s]);
  }
  lattice_free(&b);
}

/* HCP: 12 at 1, 6 at sqrt 2, 2 at sqrt(8/3), 18, 12, 6 (2.1); so 57 lie within 2.127 spacings,
 * themselves included. */
static void test_shells(void **state)
{
  const double hcp[] = {0, 1, 2, 8. / 3, 3, 11. / 3, 4, 5}, cubic[] = {0, 1, 2, 3, 4, 5};
  const double hex[] = {0, 1, 3, 4, 7}, square[] = {0, 1, 2, 4, 5};
  (void)state;
  check_shells(LATTICE_HCP, 3, 8, hcp, (int[]){1, 12, 6, 2, 18, 12, 6, 12});
  check_shells(LATTICE_CUBIC, 3, 6, cubic, (int[]){1, 6, 12, 8, 6, 24});
  check_shells(LATTICE_HCP, 2, 5, hex, (int[]){1, 6, 6, 6, 12});
  check_shells(LATTICE_CUBIC, 2, 5, square, (int[]){1, 4, 4, 4, 8});
}

/* Every site has the same surroundings: all far from the surface have as many nearest neighbours,
 * at distance 1. */
static void test_neighbours(void **state)
{
  const int want[LATTICE_COUNT][4] = {{0, 2, 6, 12}, {0, 2, 4, 6}};
  (void)state;
  for (int lattice = 0; lattice < LATTICE_COUNT; lattice++)
    for (int d = 1; d <= 3; d++) {
      LatticeBall b = ball((Lattice)lattice, d, 1500);
      double edge = pow(1500 * b.volume / (d == 3 ? 4 * PI / 3 : d == 2 ? PI : 2), 1. / d) - 2;
      for (long i = 0; i < b.n; i++) {
        const double *x = b.x + 3 * i;
        int near = 0;
        if (x[0] * x[0] + x[1] * x[1] + x[2] * x[2] > edge * edge) continue;
        for (long j = 0; j < b.n; j++) {
          const double *y = b.x + 3 * j;
          double r = sqrt(pow(x[0] - y[0], 2) + pow(x[1] - y[1], 2) + pow(x[2] - y[2], 2));
          assert_true(i == j || r > 1 - 1e-12);
          near += fabs(r - 1) < 1e-12;
        }
        assert_int_equal(near, want[lattice][d]);
      }
      lattice_free(&b);
    }
}

/* How close whole shells come to a number; in 1D the centre moves so that every number is whole. */
static long closest(Lattice lattice, int dimension, long want)
{
  LatticeBall b = ball(lattice, dimension, 2 * want + 50);
  long best = want;
  for (long s = 0; s < b.shells; s++)
    if (labs(b.within[s] - want) < best) best = labs(b.within[s] - want);
  lattice_free(&b);
  return dimension == 1 ? 0 : best;
}

/* The number is the closest to the one wanted, the ball as large as its volume says, its centre of
 * mass in its centre. */
static void test_number(void **state)
{
  const long want[] = {1, 2, 13, 57, 300, 5000, 20000, 100000};
  (void)state;
  for (int lattice = 0; lattice < LATTICE_COUNT; lattice++)
    for (int k = 0; k < 8; k++)
      for (int d = 1; d <= 3; d++) {
        LatticeBall b = ball((Lattice)lattice, d, want[k]);
        double x[3] = {0}, r2 = 0,
               r = pow((double)b.n * b.volume /
                           (d == 3   ? 4 * PI / 3
                            : d == 2 ? PI
                                     : 2),
                       1. / d);
        assert_true(labs(b.n - want[k]) == closest((Lattice)lattice, d, want[k]));
        assert_true(b.within[b.shells - 1] == b.n);
        for (long i = 0; i < b.n; i++) {
          double s2 = 0;
          for (int a = 0; a < 3; a++) {
            x[a] += b.x[3 * i + a], s2 += b.x[3 * i + a] * b.x[3 * i + a];
            assert_true(a < d || b.x[3 * i + a] == 0);
          }
          r2 = fmax(r2, s2);
        }
        for (int a = 0; a < 3; a++) assert_true(fabs(x[a]) < 1e-9 * (double)b.n);
        if (want[k] > 200) assert_true(sqrt(r2) < r + 0.3 && sqrt(r2) > r - 0.7);
        lattice_free(&b);
      }
}

static void test_cut(void **state)
{
  LatticeBall b = ball(LATTICE_HCP, 3, 100);
  (void)state;
  assert_int_equal(lattice_cut(&b, 0.4), 0);
  assert_int_equal(lattice_cut(&b, 1), 1);
  assert_int_equal(lattice_cut(&b, 6.9), 1); /* 1 or 13 */
  assert_int_equal(lattice_cut(&b, 7.1), 2);
  assert_int_equal(lattice_cut(&b, 20.1), 4); /* 1, 13, 19, 21 */
  assert_int_equal(lattice_cut(&b, 1e9), b.shells);
  lattice_free(&b);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_shells),
      cmocka_unit_test(test_neighbours),
      cmocka_unit_test(test_number),
      cmocka_unit_test(test_cut),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
