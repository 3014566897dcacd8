/* SPDX-License-Identifier: GPL-3.0-or-later */
/* lib/shape, lib/mesh, lib/pack: volumes against counting, the inside of a surface against solid
 * angles and at its very edges, files that are no closed surface, spheres that do not overlap. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>
#include "../lib/pack.h"
#include "../lib/rng.h"
#include "folder.h"

static const double PI = 3.14159265358979323846;

/* Points of a grid that lie in each part, times the volume of a cell. */
static void test_volumes(void **state)
{
  (void)state;
  for (int d = 1; d <= 3; d++)
    for (int kind = 0, N = d < 3 ? 1500 : 120; kind < SHAPE_MESH; kind++) {
      Shape s = {.kind = (ShapeKind)kind, .dimension = d, .size = {1, 1.3, 0.9, 0.2}, .parts = 1};
      double c[3], r, count[2] = {0}, cell;
      int n = shape_sizes(s.kind, d);
      Err err;
      if (!n) continue;
      if (d == 2) s.size[2] = 0.2;
      if (shape_layered(s.kind)) s.parts = 2, s.end[0] = 0.37;
      if (s.kind == SHAPE_TANK) s.parts = 2;
      if (shape_check(&s, &err)) fail_msg("%s", err.text);
      r = shape_ball(&s, c), cell = pow(2 * r / N, d);
      for (int i = 0; i < N; i++)
        for (int j = 0; j < (d > 1 ? N : 1); j++)
          for (int k = 0; k < (d == 3 ? N : 1); k++) {
            double at[3] = {i, j, k}, x[3] = {0};
            int part;
            for (int a = 0; a < d; a++) x[a] = c[a] + r * (2 * (at[a] + 0.5) / N - 1);
            if ((part = shape_part(&s, x)) >= 0) count[part] += cell;
          }
      for (int k = 0; k < s.parts; k++)
        if (!(fabs(count[k] / shape_volume(&s, k) - 1) < 0.04))
          fail_msg("%dD shape %d, part %d: %g counted, %g", d, kind, k, count[k],
                   shape_volume(&s, k));
    }
}

/* A bumpy closed surface from a subdivided octahedron: vertices in x, faces [8 4^levels]. */
static const double OCTA[6][3] = {{1, 0, 0},  {-1, 0, 0}, {0, 1, 0},
                                  {0, -1, 0}, {0, 0, 1},  {0, 0, -1}};

static double bumps(const double n[3])
{
  return 1 + 0.25 * sin(3 * n[0] + 1) * cos(4 * n[1]) + 0.2 * n[2] * n[0];
}

static void face(FILE *f, const double a[3], const double b[3], const double c[3], int levels,
                 int smooth)
{
  double m[3][3];
  const double *v[3] = {a, b, c};
  if (!levels) {
    fprintf(f, "facet normal 0 0 0\n outer loop\n");
    for (int k = 0; k < 3; k++) {
      double s = smooth ? bumps(v[k]) : 1;
      fprintf(f, "  vertex %.9g %.9g %.9g\n", s * v[k][0], s * v[k][1], s * v[k][2]);
    }
    fprintf(f, " endloop\nendfacet\n");
    return;
  }
  for (int k = 0; k < 3; k++) {
    double r = 0;
    for (int d = 0; d < 3; d++) m[k][d] = v[k][d] + v[(k + 1) % 3][d], r += m[k][d] * m[k][d];
    for (int d = 0; d < 3; d++) m[k][d] /= sqrt(r);
  }
  face(f, a, m[0], m[2], levels - 1, smooth), face(f, m[0], b, m[1], levels - 1, smooth);
  face(f, m[2], m[1], c, levels - 1, smooth), face(f, m[0], m[1], m[2], levels - 1, smooth);
}

static void stl(const char *path, int levels, int smooth, int faces)
{
  FILE *f = fopen(path, "w");
  assert_non_null(f);
  fprintf(f, "solid test\n");
  for (int k = 0; k < faces; k++) {
    const double *x = OCTA[k & 1], *y = OCTA[2 + (k >> 1 & 1)], *z = OCTA[4 + (k >> 2)];
    int odd = (k & 1) ^ (k >> 1 & 1) ^ (k >> 2);
    face(f, x, odd ? z : y, odd ? y : z, levels, smooth);
  }
  fprintf(f, "endsolid\n");
  fclose(f);
}

/* Winding number: solid angles of all triangles (van Oosterom & Strackee 1983) over 4 pi. */
static double winding(const Mesh *m, const double p[3])
{
  double sum = 0;
  for (long k = 0; k < m->triangles; k++) {
    double v[3][3], r[3], det, dot;
    for (int c = 0; c < 3; c++) {
      for (int d = 0; d < 3; d++) v[c][d] = m->x[3 * m->corner[k][c] + d] - p[d];
      r[c] = sqrt(v[c][0] * v[c][0] + v[c][1] * v[c][1] + v[c][2] * v[c][2]);
    }
    det = v[0][0] * (v[1][1] * v[2][2] - v[1][2] * v[2][1]) +
          v[0][1] * (v[1][2] * v[2][0] - v[1][0] * v[2][2]) +
          v[0][2] * (v[1][0] * v[2][1] - v[1][1] * v[2][0]);
    dot = r[0] * r[1] * r[2];
    for (int c = 0; c < 3; c++) {
      const double *a = v[c], *b = v[(c + 1) % 3];
      dot += (a[0] * b[0] + a[1] * b[1] + a[2] * b[2]) * r[(c + 2) % 3];
    }
    sum += 2 * atan2(det, dot);
  }
  return sum / (4 * PI);
}

static void test_mesh(void **state)
{
  Mesh m;
  Err err;
  (void)state;
  stl("bumpy.stl", 3, 1, 8);
  if (mesh_read(&m, "bumpy.stl", 100, &err)) fail_msg("%s", err.text);
  assert_int_equal(m.triangles, 512);
  assert_int_equal(m.vertices, 258);
  for (uint64_t i = 0; i < 4000; i++) {
    double p[3];
    for (uint32_t d = 0; d < 3; d++) p[d] = 130 * (2 * rng_uniform(1, i, d) - 1);
    if ((fabs(winding(&m, p)) > 0.5) != mesh_inside(&m, p))
      fail_msg("(%g, %g, %g) is on the wrong side", p[0], p[1], p[2]);
  }
  mesh_free(&m);
}

/* A grid that hits vertices, edges and vertical faces of the octahedron and of a box exactly: all
 * points strictly inside are inside, all outside are not. */
static void test_edges(void **state)
{
  static const char box[] =
      "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nv 0 0 2\nv 2 0 2\nv 2 2 2\nv 0 2 2\n"
      "f 4 3 2 1\nf 5/1 6/2 7/3 8/4\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf -4 -1 -5 -8\n";
  Mesh o, b;
  FILE *f = fopen("box.obj", "w");
  Err err;
  (void)state;
  stl("octa.stl", 2, 0, 8);
  assert_non_null(f);
  fputs(box, f), fclose(f);
  if (mesh_read(&o, "octa.stl", 1, &err) || mesh_read(&b, "box.obj", 1, &err))
    fail_msg("%s", err.text);
  assert_true(fabs(b.volume - 8) < 1e-14);
  for (int i = -8; i <= 8; i++)
    for (int j = -8; j <= 8; j++)
      for (int k = -8; k <= 8; k++) {
        double p[3] = {i / 8., j / 8., k / 8.},
               q[3] = {1 + p[0] * 1.5, 1 + p[1] * 1.5, 1 + p[2] * 1.5};
        double r = sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
        double e = fmax(fabs(q[0] - 1), fmax(fabs(q[1] - 1), fabs(q[2] - 1)));
        if (r < 0.9) assert_true(mesh_inside(&o, p));
        if (r > 1.0000001) assert_false(mesh_inside(&o, p));
        if (e < 1) assert_true(mesh_inside(&b, q));
        if (e > 1) assert_false(mesh_inside(&b, q));
      }
  mesh_free(&o), mesh_free(&b);
}

static void refuse(const char *path, const char *content, const char *why)
{
  Mesh m;
  Err err;
  if (content) {
    FILE *f = fopen(path, "w");
    assert_non_null(f);
    fputs(content, f), fclose(f);
  }
  assert_int_equal(mesh_read(&m, path, 1, &err), -1);
  if (!strstr(err.text, why)) fail_msg("'%s' does not say '%s'", err.text, why);
}

static void test_bad(void **state)
{
  (void)state;
  stl("open.stl", 1, 0, 7);
  refuse("open.stl", NULL, "not closed: 6 edges");
  refuse("no.stl", NULL, "cannot open 'no.stl'");
  refuse("a.obj", "v 0 0 0\nv 1 0\n", "line 2: a vertex without");
  refuse("b.obj", "v 0 0 0\nf 1 2 3\n", "line 2: a face of a vertex that is not there");
  refuse("c.stl", "hello\n", "0 triangles");
}

static void test_pack(void **state)
{
  Shape s = {.kind = SHAPE_ELLIPSOID, .dimension = 3, .size = {10, 8, 6}, .parts = 1};
  PackOptions o = {1, 3, 2.5, 0.45, 1000, 3};
  double *x, *r, *y, *q, volume = 0;
  Err err;
  long n = pack_spheres(&s, &o, &x, &r, &err);
  (void)state;
  assert_true(n > 20);
  for (long i = 0; i < n; i++) {
    assert_true(r[i] >= 1 && r[i] <= 3 && (!i || r[i] <= r[i - 1]));
    volume += 4 * PI / 3 * pow(r[i], 3);
    for (long j = 0; j < i; j++)
      assert_true(pow(x[3 * i] - x[3 * j], 2) + pow(x[3 * i + 1] - x[3 * j + 1], 2) +
                      pow(x[3 * i + 2] - x[3 * j + 2], 2) >=
                  pow(r[i] + r[j], 2));
    for (int k = 0; k < 200; k++) { /* not far out of the ellipsoid */
      double t = acos(1 - 2 * (k + 0.5) / 200), p = 2.399963 * k,
             d[3] = {sin(t) * cos(p), sin(t) * sin(p), cos(t)};
      double e = 0;
      for (int a = 0; a < 3; a++) e += pow((x[3 * i + a] + r[i] * d[a]) / s.size[a], 2);
      assert_true(e < 1.06);
    }
  }
  assert_true(volume / shape_volume(&s, 0) > 0.3 && volume / shape_volume(&s, 0) < 0.5);
  assert_int_equal(pack_spheres(&s, &o, &y, &q, &err), n);
  assert_memory_equal(x, y, (size_t)n * 3 * sizeof *x);
  free(x), free(r), free(y), free(q);
  o.low = o.high = 7;
  assert_int_equal(pack_spheres(&s, &o, &x, &r, &err), -1);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_volumes), cmocka_unit_test(test_mesh), cmocka_unit_test(test_edges),
      cmocka_unit_test(test_bad),     cmocka_unit_test(test_pack),
  };
  return cmocka_run_group_tests(tests, folder_setup, folder_teardown);
}
