/* SPDX-License-Identifier: GPL-3.0-or-later */
/* physics/hd.h: the inverse and the roots of double precision are within the ulps that it states,
 * over the whole range: on a GPU, and as steps from estimates as coarse as the hardware's. */
#include <cfloat>
#include <cmath>
#include <cstring>
#include "physics/hd.h"
#include "gpu.h"

enum { ARGUMENTS = 20000 };

/* Arguments from 1e-300 to 1e300, evenly in the exponent; every third is next to a power of two. */
static std::vector<double> arguments(void)
{
  std::vector<double> x;
  for (int k = 0; k < ARGUMENTS; k++) {
    const double raw = pow(10, -300 + 600. * k / (ARGUMENTS - 1)), near = exp2(floor(log2(raw)));
    x.push_back(k % 3 ? raw : k % 2 ? nextafter(near, 0) : nextafter(near, INFINITY));
  }
  x.front() = 1e-300, x.back() = 1e300;
  return x;
}

/* |got - good| in units in the last place of good. */
static double ulps(double got, long double good)
{
  const double g = (double)good;
  return (double)(fabsl(got - good) / (nextafter(fabs(g), INFINITY) - fabs(g)));
}

/* y, cut to the upper half of a double, off by a relative amount. */
static double estimate(long double y, double off)
{
  double d = (double)(y * (1 + (long double)off));
  uint64_t bits;
  memcpy(&bits, &d, sizeof d);
  bits &= ~0xffffffffull;
  memcpy(&d, &bits, sizeof d);
  return d;
}

/* The cut takes up to 2^-20 more, so that these span -2^-19 .. 2^-19. */
static void steps_from_estimates(void **)
{
  double worst = 0;
  for (double x : arguments())
    for (double off : {-0x1p-20, -0x1p-23, 0., 0x1p-22, 0x1p-19}) {
      const long double inverse = 1 / (long double)x, root = 1 / sqrtl(x);
      worst = fmax(worst, ulps(hd_refine_inverse(x, estimate(inverse, off)), inverse));
      worst = fmax(worst, ulps(hd_refine_inverse(-x, estimate(-inverse, off)), -inverse));
      worst = fmax(worst, ulps(hd_refine_inverse_root(x, estimate(root, off)), root));
    }
  assert_true(worst < 1);
}

static __global__ void evaluate(const double *x, double *out, int n)
{
  const int i = (int)(blockIdx.x * blockDim.x + threadIdx.x);
  if (i >= n) return;
  double *o = out + 5 * i;
  o[0] = hd_inverse(x[i]), o[1] = hd_inverse(-x[i]), o[2] = hd_inverse_root(x[i]);
  o[3] = hd_root(x[i], o + 4);
}

static void device(void **)
{
  std::vector<double> x = arguments();
  x.push_back(0);
  const size_t n = x.size();
  double *at = up(x), *to = room<double>(5 * n);
  LAUNCH(evaluate, launch_blocks(n, 128), 128, 0, 0, at, to, (int)n);
  CHECK(cudaDeviceSynchronize());
  expect_success();
  std::vector<double> o = down(to, 5 * n);
  down(at, n);
  double worst = 0, root = 0;
  for (size_t i = 0; i + 1 < n; i++) {
    const long double y = x[i];
    worst = fmax(worst, fmax(ulps(o[5 * i], 1 / y), ulps(o[5 * i + 1], -1 / y)));
    worst = fmax(worst, ulps(o[5 * i + 2], 1 / sqrtl(y)));
    if (x[i] < 1e-280) continue; /* below, hd_root does not promise anything */
    root = fmax(root, fmax(ulps(o[5 * i + 3], sqrtl(y)), ulps(o[5 * i + 4], 1 / sqrtl(y))));
  }
  print_message("inverse and inverse root within %.2f ulp, root %.2f\n", worst, root);
  assert_true(worst < 2 && root < 2);
  assert_true(o[5 * n - 2] == 0 && o[5 * n - 1] > 1e100);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(steps_from_estimates),
      cmocka_unit_test(device),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
