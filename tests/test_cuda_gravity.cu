/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Gravity of the CUDA backend against lib/gravity: the walk with a closed angle and the direct sum
 * are the host's direct sum, in double precision to rounding, in single to 1e-5; at theta 0.7 the
 * median error is below 1e-3; no piece of the curve costs what it should not; momentum. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <algorithm>
#include "solver/cuda/gravity.cu"
#include "gravity_lab.cuh"
extern "C" {
#include <cmocka.h>
}
#include "small.h"

static const int PRECISIONS[] = {PARAM_MIXED, PARAM_DOUBLE};

/* The softening by each pair's h, a spline of one length, Plummer's. */
enum { SOFTENINGS = 3 };
static void soften(GravityLab *l, int k, double epsilon)
{
  l->sim.par.softening = k == 2 ? SOFTENING_PLUMMER : SOFTENING_SPLINE;
  l->sim.par.epsilon = k ? epsilon : 0;
}

/* G m over this is the depth of a particle's own potential [m]. */
static double depth(const GravityLab *l, long i)
{
  return l->sim.par.epsilon > 0 ? l->sim.par.epsilon : l->c.h[i] / 3;
}

static double size3(const double *a) { return sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]); }

typedef struct {
  double median, p99, max, phi; /* phi: the largest, relative to the largest |phi| or G m/h */
} Errors;

/* |a - b|/|b|, where |b| is below its mean relative to that. */
static Errors compare(const Cloud *c, const double *a, const double *b, const double *pa,
                      const double *pb)
{
  const long n = c->n;
  std::vector<double> r((size_t)n);
  Errors e = {};
  double mean = 0, top = 0;
  for (long i = 0; i < n; i++) {
    mean += size3(b + 3 * i) / (double)n;
    top = fmax(top, fmax(fabs(pb[i]), LAB_G * c->m[i] / c->h[i]));
  }
  for (long i = 0; i < n; i++) {
    const double d[3] = {a[3 * i] - b[3 * i], a[3 * i + 1] - b[3 * i + 1],
                         a[3 * i + 2] - b[3 * i + 2]};
    r[(size_t)i] = size3(d) > 0 ? size3(d) / fmax(size3(b + 3 * i), mean) : 0;
    if (pa[i] != pb[i]) e.phi = fmax(e.phi, fabs(pa[i] - pb[i]) / top);
    if (std::isnan(r[(size_t)i]) || std::isnan(pa[i])) r[(size_t)i] = 1e300;
  }
  std::sort(r.begin(), r.end());
  e.median = r[(size_t)n / 2], e.p99 = r[(size_t)(n - 1) * 99 / 100], e.max = r[(size_t)n - 1];
  return e;
}

/* The device against direct sums of the host. */
static Errors against_direct(GravityLab *l, double theta, int gravity, int precision)
{
  const size_t n = (size_t)l->c.n;
  std::vector<double> a(3 * n), phi(n);
  GravityOptions o = {};
  Err err;
  o.G = LAB_G, o.softening = l->sim.par.softening, o.epsilon = l->sim.par.epsilon;
  if (gravity_direct(l->c.n, l->c.x, l->c.m, l->c.h, &o, a.data(), phi.data(), &err))
    fail_msg("%s", err.text);
  lab_run(l, theta, gravity, precision);
  return compare(&l->c, l->a, a.data(), l->phi, phi.data());
}

static Cloud shape(int k, long n, int seed, double spread)
{
  return cloud_new((CloudShape)k, n, seed, spread);
}

/* All shapes, sizes around those of warps, chunks and tiles. */
static void closed_angle_is_direct(void **state)
{
  (void)state;
  const long sizes[] = {1, 2, 33, 130};
  for (int k = 0; k < SHAPES * SOFTENINGS; k++)
    for (long n : sizes)
      for (int precision : PRECISIONS) {
        const double good = precision == PARAM_DOUBLE ? 1e-12 : 1e-5;
        GravityLab *l = lab_new(shape(k % SHAPES, n, 3, 5));
        soften(l, k / SHAPES, 1e5);
        for (int gravity : {PARAM_DIRECT, PARAM_TREE}) {
          const Errors e = against_direct(l, 0, gravity, precision);
          if (n == 1) { /* its own potential is taken off again */
            assert_true(fabs(l->phi[0]) < good * LAB_G * l->c.m[0] / depth(l, 0));
            assert_true(size3(l->a) == 0);
          }
          if (!(e.max < good && e.phi < good))
            fail_msg("shape %d, %ld, method %d, precision %d: %g %g", k, n, gravity, precision,
                     e.max, e.phi);
        }
        lab_free(l);
      }
}

/* At theta 0.7: spheres in contact, a sphere in debris, clouds. */
static void errors_of_the_tree(void **state)
{
  (void)state;
  for (int k = 0; k < 5 * SOFTENINGS; k++) {
    const int of[] = {0, 0, SPHERE, TWO_BODIES, CLUSTERS}, cloud = k % 5;
    GravityLab *l = lab_new(cloud < 2 ? lab_spheres(2000, cloud) : shape(of[cloud], 2000, 5, 2));
    soften(l, k / 5, cloud < 2 ? 2e4 : 1e5);
    const Errors e = against_direct(l, 0.7, PARAM_TREE, PARAM_MIXED);
    if (!(e.median < 8e-4 && e.p99 < 8e-3 && e.phi < 2e-3))
      fail_msg("cloud and softening %d: median %g, 99 %% %g, phi %g", k, e.median, e.p99, e.phi);
    lab_free(l);
  }
}

/* With quadrupoles the error goes as theta^4: slope of ln median 3.4 .. 4.8. */
static void error_falls_as_theta_to_the_fourth(void **state)
{
  (void)state;
  GravityLab *l = lab_new(shape(SPHERE, 2500, 6, 1));
  const Errors low = against_direct(l, 0.4, PARAM_TREE, PARAM_DOUBLE),
               high = against_direct(l, 0.8, PARAM_TREE, PARAM_DOUBLE);
  const double slope = log(high.median / low.median) / log(2);
  if (!(slope > 3.4 && slope < 4.8)) fail_msg("slope %g", slope);
  lab_free(l);
}

/* A node that reaches into the softening is opened: beside a dense clump of small h, a target of
 * large h feels each of its particles softened. */
static void soft_targets_open_dense_nodes(void **state)
{
  (void)state;
  Cloud c = shape(CLUSTERS, 2000, 7, 1);
  for (long i = 0; i < c.n; i++) c.h[i] = c.id[i] % 5 ? 1e4 : 1e6;
  GravityLab *l = lab_new(c);
  const Errors e = against_direct(l, 0.9, PARAM_TREE, PARAM_MIXED);
  if (!(e.p99 < 1e-2 && e.phi < 1e-3)) fail_msg("99 %% %g, phi %g", e.p99, e.phi);
  lab_free(l);
}

/* Single against double precision at any angle of opening, SI values from a pebble to a galaxy, a
 * thousand radii off the origin. */
static void single_precision_of_any_size(void **state)
{
  (void)state;
  const double length[] = {1e-9, 1, 1e15}, mass[] = {1e-30, 1, 1e25}, shift[] = {0, 1e9, 0};
  for (int k : {SPHERE, TWO_BODIES, CLUSTERS, LINE, OUTLIER})
    for (int of = 0; of < 3 * SOFTENINGS; of++) {
      const int unit = of % 3;
      Cloud c = shape(k, 300, 8, 3);
      for (long i = 0; i < c.n; i++) {
        c.m[i] *= mass[unit], c.h[i] *= length[unit];
        for (int d = 0; d < 3; d++) c.x[3 * i + d] = c.x[3 * i + d] * length[unit] + shift[unit];
      }
      GravityLab *l = lab_new(c);
      soften(l, of / 3, 1e5 * length[unit]), lab_run(l, 0.7, PARAM_TREE, PARAM_DOUBLE);
      std::vector<double> a(l->a, l->a + 3 * c.n), phi(l->phi, l->phi + c.n);
      lab_run(l, 0.7, PARAM_TREE, PARAM_MIXED);
      const Errors e = compare(&l->c, l->a, a.data(), l->phi, phi.data());
      if (!(e.max < 1e-5 && e.phi < 1e-5))
        fail_msg("shape %d, unit and softening %d: %g %g", k, of, e.max, e.phi);
      lab_free(l);
    }
}

/* Direct sums: pairs cancel to the rounding of a double, in single precision as well. The tree: the
 * force and torque that are left over are taken off. The pull is added to acc. */
static void momentum_is_conserved(void **state)
{
  (void)state;
  for (int kind = 0; kind < SHAPES * SOFTENINGS; kind++)
    for (int precision : PRECISIONS)
      for (int gravity : {PARAM_DIRECT, PARAM_TREE}) {
        const int k = kind % SHAPES;
        GravityLab *l = lab_new(shape(k, 300, 2, 5));
        soften(l, kind / SHAPES, 1e5);
        double p[3] = {0, 0, 0}, t[3] = {0, 0, 0}, size = 0, arm = 0;
        lab_run(l, 0.7, gravity, precision);
        for (long i = 0; i < l->c.n; i++) {
          const double *x = l->c.x + 3 * i, *a = l->a + 3 * i, m = l->c.m[i];
          for (int d = 0; d < 3; d++) {
            const int e = (d + 1) % 3, f = (d + 2) % 3;
            p[d] += m * a[d], t[d] += m * (x[e] * a[f] - x[f] * a[e]);
            assert_true(l->acc[3 * i + d] == x[d] + a[d]);
          }
          size += m * size3(a), arm += m * size3(x) * size3(a);
        }
        if (!(size3(p) <= 3e-14 * size))
          fail_msg("shape %d, %d, %d: %g", k, precision, gravity, size3(p) / size);
        if (gravity == PARAM_TREE && k != LINE && k != COINCIDENT && !(size3(t) <= 3e-14 * arm))
          fail_msg("shape %d, %d: torque %g", k, precision, size3(t) / arm);
        lab_free(l);
      }
}

/* A component that is held feels nothing at all. */
static void planes_stay_plane(void **state)
{
  (void)state;
  for (int dimension = 1; dimension < 4; dimension++) {
    GravityLab *l = lab_new(shape(SPHERE, 100, 2, 5));
    l->sim.s.dimension = dimension;
    lab_run(l, 0.7, PARAM_TREE, PARAM_MIXED);
    for (long i = 0; i < l->c.n; i++)
      for (int d = 0; d < 3; d++) assert_true((l->a[3 * i + d] == 0) == (d >= dimension));
    lab_free(l);
  }
}

static void massless_particles_do_not_act(void **state)
{
  (void)state;
  Cloud c = shape(SPHERE, 300, 2, 5);
  for (long i = 0; i < c.n; i++) c.m[i] = 0;
  GravityLab *l = lab_new(c);
  for (int precision : PRECISIONS)
    for (int gravity : {PARAM_DIRECT, PARAM_TREE}) {
      lab_run(l, 0.7, gravity, precision);
      for (long i = 0; i < c.n; i++) assert_true(size3(l->a + 3 * i) == 0 && l->phi[i] == 0);
    }
  lab_free(l);
}

static __global__ void jumps(const __grid_constant__ Walk w, int *cut)
{
  const int i = (int)(blockIdx.x * blockDim.x + threadIdx.x);
  if (i < w.n) cut[i] = walk_jumps(w, i);
}

/* Of a piece of particles: the longest edge of its box. */
static double box_of(const Cloud *c, long from, long end, double lo[3], double hi[3])
{
  double longest = 0;
  for (int d = 0; d < 3; d++) {
    lo[d] = INFINITY, hi[d] = -INFINITY;
    for (long i = from; i < end; i++)
      lo[d] = fmin(lo[d], c->x[3 * i + d]), hi[d] = fmax(hi[d], c->x[3 * i + d]);
    longest = fmax(longest, hi[d] - lo[d]);
  }
  return longest;
}

static long particles_in(const Cloud *c, const double lo[3], const double hi[3])
{
  long inside = 0;
  for (long i = 0; i < c->n; i++) {
    int in = 1;
    for (int d = 0; d < 3; d++) in &= lo[d] <= c->x[3 * i + d] && c->x[3 * i + d] <= hi[d];
    inside += in;
  }
  return inside;
}

/* The pieces of a curve through spheres are compact: their boxes are a few h long, and few are cut
 * in more than there must be. Those of debris are large, but hold hardly anybody else: a box with a
 * body in it would be summed with all of its particles. */
static void pieces_are_compact(void **state)
{
  (void)state;
  for (int debris = 0; debris < 2; debris++) {
    GravityLab *l = lab_new(lab_spheres(20000, debris));
    CudaError *error = &l->cuda.error;
    const Walk w = walk_of(&l->sim);
    const long n = l->c.n;
    std::vector<int> cut((size_t)n);
    int *device = lab_up(l, cut.data(), (size_t)n);
    LAUNCH(jumps, launch_blocks((size_t)n, 128), 128, 0, 0, w, device);
    lab_down(l, cut.data(), device, (size_t)n);
    cudaFree(device);
    long pieces = 0, wide = 0, others = 0;
    for (long from = 0, end; from < n; from = end) {
      double lo[3], hi[3];
      for (end = from + 1; end < n && end % 32 && !cut[(size_t)end - 1];) end++;
      pieces++;
      if (!(box_of(&l->c, from, end, lo, hi) > 4 * l->c.h[0])) continue;
      wide++, others += particles_in(&l->c, lo, hi) - (end - from);
    }
    if (!(wide <= (debris ? n / 2 : 0) && 4 * others <= wide &&
          pieces < (debris ? 6 : 1.25) * (double)n / 32))
      fail_msg("debris %d: %ld wide with %ld others, %ld pieces of %ld", debris, wide, others,
               pieces, n);
    lab_free(l);
  }
}

/* Every particle is in one piece, whatever the number and size of pieces. */
static void pieces_are_whole(void **state)
{
  (void)state;
  for (long n : {1L, 31L, 33L, 129L, 4000L}) {
    GravityLab *l = lab_new(shape(SPHERE, n, 9, 2));
    CudaError *error = &l->cuda.error;
    for (int chunk : {8, 16, 32}) {
      Walk w = walk_of(&l->sim);
      std::vector<int2> piece((size_t)n);
      std::vector<int> seen((size_t)n);
      int pieces;
      w.chunk = chunk;
      CHECK(cudaMemset(w.queue.pieces, 0, sizeof pieces));
      LAUNCH(walk_cut, launch_blocks((size_t)n, 128), 128, 0, 0, w);
      lab_down(l, &pieces, w.queue.pieces, 1);
      assert_in_range(pieces, (n + chunk - 1) / chunk, n);
      lab_down(l, piece.data(), w.queue.piece, (size_t)pieces);
      for (int k = 0; k < pieces; k++) {
        assert_in_range(piece[(size_t)k].y, 1, chunk);
        for (int i = 0; i < piece[(size_t)k].y; i++) seen[(size_t)(piece[(size_t)k].x + i)]++;
      }
      for (int times : seen) assert_int_equal(times, 1);
    }
    lab_free(l);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(closed_angle_is_direct),
      cmocka_unit_test(errors_of_the_tree),
      cmocka_unit_test(error_falls_as_theta_to_the_fourth),
      cmocka_unit_test(soft_targets_open_dense_nodes),
      cmocka_unit_test(single_precision_of_any_size),
      cmocka_unit_test(momentum_is_conserved),
      cmocka_unit_test(planes_stay_plane),
      cmocka_unit_test(massless_particles_do_not_act),
      cmocka_unit_test(pieces_are_compact),
      cmocka_unit_test(pieces_are_whole),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
