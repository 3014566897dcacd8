/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "rng.h"
#include "shells.h"

static const double PI = 3.14159265358979323846;

static void point(double theta, double phi, double x[3])
{
  x[0] = sin(theta) * cos(phi), x[1] = sin(theta) * sin(phi), x[2] = cos(theta);
}

/* SEA eq. 13, a = 0.2, b = 2. */
static double stretch(long n, double theta)
{
  double root = sqrt((double)n), from_pole = PI / 2 - fabs(PI / 2 - theta);
  return theta + 0.2 / root * (PI / 2 - theta) * exp(-root * from_pole / (2 * PI));
}

/* Caps and collars of regions of area 4 pi/n, n > 4 (SEA eq. 3 to 12). The numbers in collars are
 * rounded such that the errors do not add up. */
static void collars(long n, uint64_t seed, double *x)
{
  double cap = 2 * asin(sqrt(1 / (double)n));
  long number = lround(fmax(1, (PI - 2 * cap) / sqrt(4 * PI / (double)n))), done = 1;
  point(0, 0, x), point(PI, 0, x + 3 * (n - 1));
  for (long c = 0; c < number; c++) {
    double edge = cap + (PI - 2 * cap) * (double)(c + 1) / (double)number;
    long end = c == number - 1 ? n - 1 : lround((double)n * pow(sin(edge / 2), 2));
    double low = 2 * asin(sqrt((double)done / (double)n));
    double high = 2 * asin(sqrt((double)end / (double)n));
    double theta = stretch(n, (low + high) / 2), turn = 2 * PI * rng_uniform(seed, (uint64_t)c, 1);
    for (long i = done; i < end; i++)
      point(theta, turn + 2 * PI * (double)(i - done) / (double)(end - done), x + 3 * i);
    done = end;
  }
}

void shells_points(long n, uint64_t seed, double *x)
{
  double m[3][3];
  rng_rotation(seed, m);
  for (long i = 0; i < n && n < 4; i++) point(PI / 2, 2 * PI * (double)i / (double)n, x + 3 * i);
  for (long i = 0; i < n && n == 4; i++)
    for (int a = 0; a < 3; a++) x[3 * i + a] = (i == 0 || i == a + 1 ? 1 : -1) / sqrt(3);
  if (n > 4) collars(n, seed, x);
  for (long i = 0; i < n; i++) {
    double old[3] = {x[3 * i], x[3 * i + 1], x[3 * i + 2]};
    for (int a = 0; a < 3; a++)
      x[3 * i + a] = m[a][0] * old[0] + m[a][1] * old[1] + m[a][2] * old[2];
  }
}
