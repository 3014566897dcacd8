/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The potential of some particles at some, against plain sums: below and above the number for
 * direct sums, from one set of members to the next. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include "lib/gravity.h"
#include "lib/potential.h"
#include "lib/rng.h"
#include "lib/unit.h"

enum { N = 4000 };
static const long sizes[] = {1, 2, 300, N};

static Parts *cloud(void)
{
  Parts *p = part_new(N);
  assert_int_equal(part_add(p, "id x m h", NULL), 0);
  for (long i = 0; i < N; i++) {
    const uint64_t k = (uint64_t)i;
    p->id[i] = i + 1, p->m[i] = 1e15 * (1 + rng_uniform(1, k, 3));
    p->h[i] = 1e4 * (1 + rng_uniform(1, k, 4));
    for (int a = 0; a < 3; a++) p->x[3 * i + a] = 3e5 * rng_uniform(1, k, (uint32_t)a);
  }
  return p;
}

static double plain(const Parts *p, const long *list, const unsigned char *in, long n, long k)
{
  double sum = 0;
  for (long j = 0; j < n; j++) {
    const long a = list[k], b = list[j];
    double r2 = 0, h = 0.5 * (p->h[a] + p->h[b]);
    if (j == k || !in[j]) continue;
    for (int d = 0; d < 3; d++) r2 += pow(p->x[3 * a + d] - p->x[3 * b + d], 2);
    const double r = sqrt(r2), s = fmax(r, h);
    sum -= UNIT_G * p->m[b] / s * softening_potential(fmin(r / h, 1));
  }
  return sum;
}

static void some_at_some(void **state)
{
  (void)state;
  Parts *p = cloud();
  static long list[N];
  static unsigned char in[N], at[N];
  static double phi[N];
  for (long k = 0; k < N; k++) list[k] = N - 1 - k;
  for (int s = 0; s < 4; s++) {
    const long n = sizes[s];
    Potential pot;
    assert_int_equal(potential_open(&pot, p, list, n, NULL), 0);
    for (int set = 0; set < 3; set++) { /* a third; a corner, most nodes without mass; all */
      for (long k = 0; k < n; k++) {
        const double *x = p->x + 3 * list[k];
        in[k] = set == 0 ? k % 3 == 1 : set == 2 || x[0] + x[1] + x[2] < 2.5e5;
        at[k] = k % 5 == set, phi[k] = 1;
      }
      assert_int_equal(potential_sum(&pot, in, set < 2 ? at : NULL, 0.3, phi, NULL), 0);
      for (long k = 0; k < n; k += 1 + n / 97) {
        const double sum = plain(p, list, in, n, k);
        if (set < 2 && !at[k])
          assert_true(phi[k] == 1);
        else
          assert_true(fabs(phi[k] - sum) <= (n < 512 ? 1e-10 : 1e-3) * fabs(sum));
      }
    }
    potential_close(&pot);
  }
  part_free(p);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(some_at_some)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
