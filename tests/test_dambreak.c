/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Dams of water that break, as potential flow: the reference of pipelines/dambreak.mk. Its rows of
 * tests/data/dambreak.tsv must come out again, and volume and energy stay.
 *
 * Boundary elements: the potential phi and the nodes on the free surface move with the water,
 * D(phi)/Dt = v^2/2 - g y (Longuet-Higgins & Cokelet 1976, Proc. R. Soc. A 350, 1), and the normal
 * velocity follows from Green's third identity with G = -ln(r)/(2 pi). Images in the wall x = 0 and
 * the floor y = 0 make these streamlines, so that only the free surface has elements: straight,
 * phi and its normal derivative linear on each, the integrals exact. Classical Runge-Kutta; after
 * each step the nodes are laid anew along splines, densest at the tip. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>
#include <gsl/gsl_linalg.h>
#include <gsl/gsl_spline.h>

#define NODES   600
#define IMAGES  6    /* nodes beyond the wall that splines see */
#define GRAVITY 9.81 /* m/s^2 */
#define SCALE   20.0 /* m; any, but larger than the water: ln(r/SCALE) never vanishes on it */
#define DEEP    0.05 /* m; the front is where the water is so deep */
#define PI      3.14159265358979323846

enum { X, Y, PHI, ALL };

/* Nodes from the wall, the highest, to the tip on the floor. */
typedef struct {
  int n;
  double of[ALL][NODES]; /* m, m, m^2/s */
} Surface;

/* Largest and smallest spacing of nodes [m], growth of the spacing from the tip on. */
typedef struct {
  double largest, smallest, growth;
} Grid;

/* Adds the integrals over element j of ln(r/SCALE), in w[0..1], and of its normal derivative, in
 * w[2..3], with the weights of its two ends, seen from (x, y). */
static void element(double w[4], double x, double y, const Surface *f, int j)
{
  double tx = f->of[X][j + 1] - f->of[X][j], ty = f->of[Y][j + 1] - f->of[Y][j];
  double length = hypot(tx, ty);
  tx /= length, ty /= length;
  double dx = f->of[X][j] - x, dy = f->of[Y][j] - y;
  double a = dx * tx + dy * ty, b = a + length, h = dy * tx - dx * ty;
  double ra = hypot(a, h), rb = hypot(b, h);
  double la = ra > 0 ? log(ra / SCALE) : 0, lb = rb > 0 ? log(rb / SCALE) : 0;
  int off = fabs(h) > 1e-12 * length;
  double angle = off ? atan(b / h) - atan(a / h) : 0, moment = off ? h * (lb - la) : 0;
  double whole = b * lb - a * la - length + h * angle;
  double first = 0.5 * (rb * rb * (lb - 0.5) - ra * ra * (la - 0.5));
  w[0] += (b * whole - first) / length, w[1] += (first - a * whole) / length;
  w[2] += (b * angle - moment) / length, w[3] += (moment - a * angle) / length;
}

/* The normal derivative of phi at each node, outwards. */
static void normal(double *q, const Surface *f)
{
  size_t n = (size_t)f->n;
  gsl_matrix *matrix = gsl_matrix_calloc(n, n);
  gsl_permutation *order = gsl_permutation_alloc(n);
  gsl_vector *right = gsl_vector_calloc(n);
  gsl_vector_view solution = gsl_vector_view_array(q, n);
  int sign;
  for (size_t i = 0; i < n; i++)
    for (int image = 0; image < 4; image++)
      for (size_t j = 0; j + 1 < n; j++) {
        double w[4] = {0}, *a = gsl_matrix_ptr(matrix, i, j);
        element(w, image & 1 ? -f->of[X][i] : f->of[X][i], image & 2 ? -f->of[Y][i] : f->of[Y][i],
                f, (int)j);
        a[0] -= w[0], a[1] -= w[1];
        *gsl_vector_ptr(right, i) +=
            w[2] * (f->of[PHI][i] - f->of[PHI][j]) + w[3] * (f->of[PHI][i] - f->of[PHI][j + 1]);
      }
  gsl_linalg_LU_decomp(matrix, order, &sign);
  gsl_linalg_LU_solve(matrix, order, right, &solution.vector);
  gsl_matrix_free(matrix), gsl_permutation_free(order), gsl_vector_free(right);
}

static void lengths(double *s, const Surface *f)
{
  s[0] = 0;
  for (int i = 1; i < f->n; i++)
    s[i] = s[i - 1] + hypot(f->of[X][i] - f->of[X][i - 1], f->of[Y][i] - f->of[Y][i - 1]);
}

/* One of x, y, phi over the arc length: x odd beyond the wall, the others even. */
static gsl_spline *spline(const double *s, const Surface *f, int what)
{
  double at[NODES + IMAGES], value[NODES + IMAGES];
  for (int k = -IMAGES; k < f->n; k++) {
    int i = abs(k);
    at[k + IMAGES] = k < 0 ? -s[i] : s[i];
    value[k + IMAGES] = k < 0 && what == X ? -f->of[what][i] : f->of[what][i];
  }
  gsl_spline *c = gsl_spline_alloc(gsl_interp_cspline, (size_t)(f->n + IMAGES));
  gsl_spline_init(c, at, value, (size_t)(f->n + IMAGES));
  return c;
}

/* Velocities and D(phi)/Dt of the nodes. */
static void rates(Surface *rate, const Surface *f)
{
  double s[NODES], q[NODES];
  gsl_spline *c[ALL];
  normal(q, f), lengths(s, f);
  for (int k = 0; k < ALL; k++) c[k] = spline(s, f, k);
  for (int i = 0; i < f->n; i++) {
    double tx = gsl_spline_eval_deriv(c[X], s[i], NULL);
    double ty = gsl_spline_eval_deriv(c[Y], s[i], NULL), norm = hypot(tx, ty);
    double along = gsl_spline_eval_deriv(c[PHI], s[i], NULL) / norm;
    tx /= norm, ty /= norm;
    double vx = i == 0 ? 0 : along * tx - q[i] * ty, vy = along * ty + q[i] * tx;
    if (i == f->n - 1) vy = 0;
    rate->of[X][i] = vx, rate->of[Y][i] = vy;
    rate->of[PHI][i] = 0.5 * (vx * vx + vy * vy) - GRAVITY * f->of[Y][i];
  }
  for (int k = 0; k < ALL; k++) gsl_spline_free(c[k]);
}

static void lay(Surface *f, Grid grid)
{
  double s[NODES], from_tip[NODES], d = 0;
  gsl_spline *c[ALL];
  int n = 0;
  lengths(s, f);
  for (double end = s[f->n - 1]; d < end;
       d += fmin(grid.smallest + grid.growth * d, grid.largest)) {
    assert_true(n < NODES);
    from_tip[n++] = d;
  }
  for (int k = 0; k < ALL; k++) c[k] = spline(s, f, k);
  for (int i = 0; i < n; i++) {
    double at = s[f->n - 1] * fmax(0, 1 - from_tip[n - 1 - i] / from_tip[n - 1]);
    for (int k = 0; k < ALL; k++) f->of[k][i] = gsl_spline_eval(c[k], at, NULL);
  }
  f->n = n, f->of[X][0] = 0, f->of[Y][n - 1] = 0;
  for (int k = 0; k < ALL; k++) gsl_spline_free(c[k]);
}

static void step(Surface *f, Grid grid, double dt)
{
  Surface rate[4], at;
  for (int k = 0; k < 4; k++) {
    at = *f;
    for (int w = 0; w < ALL && k; w++)
      for (int i = 0; i < f->n; i++) at.of[w][i] += (k == 3 ? 1 : 0.5) * dt * rate[k - 1].of[w][i];
    rates(&rate[k], &at);
  }
  for (int w = 0; w < ALL; w++)
    for (int i = 0; i < f->n; i++)
      f->of[w][i] +=
          dt / 6 *
          (rate[0].of[w][i] + 2 * (rate[1].of[w][i] + rate[2].of[w][i]) + rate[3].of[w][i]);
  lay(f, grid);
}

/* A column at rest, its corner rounded. */
static Surface column(double width, double height, Grid grid)
{
  double r = 2.5 * grid.largest;
  int top = (int)((width - r) / grid.largest), side = (int)((height - r) / grid.largest);
  Surface f = {.n = top + 4 + side + 1};
  for (int i = 0; i < f.n; i++) {
    double turned = PI / 8 * fmin(fmax(i - top, 0), 4);
    f.of[X][i] = i < top ? (width - r) * i / top : width - r + r * sin(turned);
    f.of[Y][i] = i <= top + 4 ? height - r + r * cos(turned) : (height - r) * (f.n - 1 - i) / side;
  }
  lay(&f, grid);
  return f;
}

/* Volume [m^2] and energy [m^4/s^2, of density 1]. */
static void sums(double *volume, double *energy, const Surface *f)
{
  double q[NODES];
  normal(q, f);
  *volume = *energy = 0;
  for (int i = 0; i + 1 < f->n; i++) {
    double a = f->of[Y][i], b = f->of[Y][i + 1], dx = f->of[X][i + 1] - f->of[X][i];
    *volume += 0.5 * dx * (a + b);
    *energy += GRAVITY * dx * (a * a + a * b + b * b) / 6 +
               0.25 * hypot(dx, b - a) * (f->of[PHI][i] * q[i] + f->of[PHI][i + 1] * q[i + 1]);
  }
}

static double front(const Surface *f)
{
  int i = f->n - 2;
  while (i > 0 && f->of[Y][i] < DEEP) i--;
  double part = (f->of[Y][i] - DEEP) / (f->of[Y][i] - f->of[Y][i + 1]);
  return f->of[X][i] + part * (f->of[X][i + 1] - f->of[X][i]);
}

static double tip(const Surface *f) { return f->of[X][f->n - 1]; }
static double height(const Surface *f) { return f->of[Y][0]; }

/* A column breaks; the rows `what` of the data, ordered in time, must agree with `measure`. */
static void breaks(double width, double high, const char *what, double (*measure)(const Surface *),
                   int most)
{
  FILE *data = fopen("tests/data/dambreak.tsv", "r");
  assert_non_null(data);
  Grid grid = {0.06, 0.02, 0.1};
  Surface f = column(width, high, grid);
  double volume[2], energy[2], t = 0, dt = 0.01, when, value;
  char line[400], name[400];
  int rows = 0;
  sums(&volume[0], &energy[0], &f);
  while (rows < most && fgets(line, sizeof line, data)) {
    if (sscanf(line, "%s %lf %lf", name, &when, &value) != 3 || strcmp(name, what)) continue;
    for (; t < when - 1e-9; t += fmin(dt, when - t)) step(&f, grid, fmin(dt, when - t));
    if (fabs(measure(&f) - value) > 0.01)
      fail_msg("%s at %g s: %g m, not %g", what, t, measure(&f), value);
    rows++;
  }
  fclose(data);
  assert_int_equal(rows, most);
  sums(&volume[1], &energy[1], &f);
  assert_true(fabs(volume[1] / volume[0] - 1) < 3e-4);
  assert_true(fabs(energy[1] / energy[0] - 1) < 1e-3);
}

static void fronts(void **state) { (void)state, breaks(1, 2, "exact_front", front, 7); }
static void heights(void **state) { (void)state, breaks(2, 1, "exact_height", height, 5); }
static void arrival(void **state) { (void)state, breaks(2, 1, "exact_arrival", tip, 1); }

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(fronts),
      cmocka_unit_test(heights),
      cmocka_unit_test(arrival),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
