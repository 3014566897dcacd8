/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sedov's blast in 3D, gamma 5/3: R = (E t^2/(0.49358 rho))^(1/5) = 0.34747
 * at t = 0.05 for E = 1e0 in a unit box; outer half-maximum of the binned density within 5 % at
 * 32^3, its peak >= 1.9, isotropy, energy and momentum. */
#include "lab.h"

static const char GAS[] =
    "name = \"gas\"; eos = { form = \"ideal\"; gamma = 1.6666666666666667; };";

enum { SIDE = 32, BINS = 50 };

static Parts *box(void)
{
  double dx = 1. / SIDE, sum = 0;
  Parts *p = lab_parts((long)SIDE * SIDE * SIDE, 3, GAS);
  long i = 0;
  for (int a = 0; a < SIDE; a++)
    for (int b = 0; b < SIDE; b++)
      for (int c = 0; c < SIDE; c++, i++) {
        double x = (a + .5) * dx - .5, y = (b + .5) * dx - .5, z = (c + .5) * dx - .5;
        double w = kernel_w(KERNEL_CUBIC_SPLINE, 3, sqrt(x * x + y * y + z * z) / (4 * dx));
        p->x[3 * i] = x, p->x[3 * i + 1] = y, p->x[3 * i + 2] = z;
        p->m[i] = dx * dx * dx, p->rho[i] = 1, p->h[i] = 2.39 * dx, p->u[i] = w, sum += w;
      }
  for (i = 0; i < p->n; i++) p->u[i] = p->u[i] / sum / p->m[i] + 1e-6 / (2. / 3);
  return p;
}

/* Peak of the binned density and the radius outside of it where the excess over 1 falls to half;
 * octant < 0: all. */
static double front(const Parts *p, int octant, double *peak)
{
  double mass[BINS] = {0}, volume[BINS] = {0}, width = .5 / BINS, rho[BINS] = {0};
  int top = 0;
  for (long i = 0; i < p->n; i++) {
    const double *x = &p->x[3 * i];
    int o = (x[0] > 0) + 2 * (x[1] > 0) + 4 * (x[2] > 0),
        k = (int)(sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]) / width);
    if (k < BINS && (octant < 0 || o == octant))
      mass[k] += p->m[i], volume[k] += p->m[i] / p->rho[i];
  }
  for (int k = 0; k < BINS; k++) rho[k] = volume[k] > 0 ? mass[k] / volume[k] : 0;
  for (int k = 0; k < BINS; k++) top = rho[k] > rho[top] ? k : top;
  *peak = rho[top];
  for (int k = top; k < BINS - 1; k++) {
    double half = 1 + .5 * (*peak - 1);
    if (rho[k + 1] < half) return (k + .5 + (rho[k] - half) / (rho[k] - rho[k + 1])) * width;
  }
  return 0;
}

static void blast(void **state)
{
  Parts *p = box();
  Param par = lab_param("gravity.method=none", "kernel=cubic_spline", "step.cfl=0.3", NULL);
  Sim sim;
  Sums a, b;
  double peak, r, mean = 0, square = 0;
  (void)state;
  lab_open(&sim, &par, p);
  lab_sums(&sim, &a);
  print_message("%ld steps\n", lab_run(&sim, .05));
  lab_sums(&sim, &b);
  lab_store(&sim, p);
  r = front(p, -1, &peak);
  print_message("half-maximum at %.4f (0.3475), peak %.3f, dE %.2e, p %.1e\n", r, peak,
                (b.kinetic + b.internal) / (a.kinetic + a.internal) - 1,
                fabs(b.momentum[0]) / b.scale_momentum);
  assert_true(fabs(r / .34747 - 1) < .05);
  assert_true(peak >= 1.9);
  assert_true(fabs((b.kinetic + b.internal) / (a.kinetic + a.internal) - 1) < 1e-3);
  for (int d = 0; d < 3; d++) assert_true(fabs(b.momentum[d]) < 1e-13 * b.scale_momentum);
  for (int o = 0; o < 8; o++) {
    double each = front(p, o, &peak);
    mean += each / 8, square += each * each / 8;
  }
  assert_true(sqrt(fmax(0, square - mean * mean)) / mean < .01);
  sim_close(&sim);
  part_free(p);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(blast)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
