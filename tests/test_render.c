/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parts of render that draw: colours, letters, PNG, camera, projection. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <string.h>
#include <unistd.h>
#include "lib/pick.h"
#include "lib/rng.h"
#include "tools/render/camera.c"
#include "tools/render/colour.c"
#include "tools/render/font.c"
#include "tools/render/image.c"
#include "tools/render/project.c"

static void close_to(Rgb c, int r, int g, int b, int within)
{
  assert_in_range(abs(c.r - r), 0, within);
  assert_in_range(abs(c.g - g), 0, within);
  assert_in_range(abs(c.b - b), 0, within);
}

/* CIE lightness from sRGB (IEC 61966-2-1). */
static double lightness(Rgb c)
{
  double v[3] = {c.r / 255., c.g / 255., c.b / 255.}, y;
  for (int a = 0; a < 3; a++)
    v[a] = v[a] <= 0.04045 ? v[a] / 12.92 : pow((v[a] + 0.055) / 1.055, 2.4);
  y = 0.2126 * v[0] + 0.7152 * v[1] + 0.0722 * v[2];
  return y > 0.008856 ? 116 * cbrt(y) - 16 : 903.3 * y;
}

/* Ends and middle of viridis as in matplotlib (#440154, #21918c, #fde725); lightness grows evenly.
 */
static void uniform_maps(void **state)
{
  (void)state;
  const char *const maps[] = {"viridis", "magma", "inferno"};
  close_to(colour_map("viridis", 0), 0x44, 0x01, 0x54, 5);
  close_to(colour_map("viridis", 0.5), 0x21, 0x91, 0x8c, 5);
  close_to(colour_map("viridis", 1), 0xfd, 0xe7, 0x25, 5);
  for (int m = 0; m < 3; m++) {
    double whole = lightness(colour_map(maps[m], 1)) - lightness(colour_map(maps[m], 0));
    for (int k = 0; k < 20; k++) {
      double step =
          lightness(colour_map(maps[m], (k + 1) / 20.)) - lightness(colour_map(maps[m], k / 20.));
      assert_true(step > 0.02 * whole && step < 0.09 * whole);
    }
  }
  close_to(colour_map("polar", 0.5), 247, 247, 247, 1);
  Rgb low = colour_map("polar", 0), high = colour_map("polar", 1), out = colour_map("polar", NAN);
  assert_true(low.b > low.r && high.r > high.b);
  close_to(out, low.r, low.g, low.b, 0);
}

static void materials_have_their_colours(void **state)
{
  (void)state;
  Rgb basalt = colour_of_material("basalt", 0), ice = colour_of_material("porous_ice", 1);
  assert_true(basalt.r > 2 * basalt.b && ice.b > 2 * ice.r); /* 001 fig. 10: red and blue */
  Rgb other = colour_of_material("cheese", 3), kind = colour_kind(3);
  close_to(other, kind.r, kind.g, kind.b, 0);
}

static void png_round_trip(void **state)
{
  (void)state;
  Image *im = image_new(37, 21, (Rgb){1, 2, 3});
  char name[] = "test_render_XXXXXX";
  Err err;
  close(mkstemp(name));
  for (int y = 0; y < 21; y++)
    for (int x = 0; x < 37; x++)
      image_blend(im, x, y, (Rgb){255, (unsigned char)(9 * y), 0}, x / 36.);
  image_blend(im, -1, 0, (Rgb){9, 9, 9}, 1), image_blend(im, 37, 5, (Rgb){9, 9, 9}, 1);
  image_fill(im, 30, 15, 100, 100, (Rgb){7, 8, 9});
  assert_int_equal(image_write(im, name, &err), 0);
  png_image png = {.version = PNG_IMAGE_VERSION};
  unsigned char back[37 * 21 * 3];
  assert_true(png_image_begin_read_from_file(&png, name));
  png.format = PNG_FORMAT_RGB;
  assert_true(png.width == 37 && png.height == 21);
  assert_true(png_image_finish_read(&png, NULL, back, 0, NULL));
  assert_memory_equal(back, im->px, sizeof back);
  assert_true(im->px[20 * 37 + 36].r == 7 && im->px[36].r == 255);
  unlink(name);
  assert_int_equal(image_write(im, "no/such/folder/a.png", &err), -1);
  assert_non_null(strstr(err.text, "no/such/folder"));
  image_free(im);
}

static long inked(const Image *im, int y0, int y1)
{
  long n = 0;
  for (int y = y0; y < y1; y++)
    for (int x = 0; x < im->w; x++) n += im->px[y * im->w + x].r > 128;
  return n;
}

/* All of ASCII has a shape of its own; what is drawn stays within its width; superscripts stand
 * higher. */
static void letters(void **state)
{
  (void)state;
  Font f = {.size = 24, .ink = {255, 255, 255}};
  Image *one = image_new(60, 60, (Rgb){0, 0, 0}), *other = image_new(60, 60, (Rgb){0, 0, 0});
  for (char c = '!'; c <= '~'; c++) {
    char text[2] = {c, 0};
    if (c == '^' || strchr("$`~", c)) continue;
    assert_ptr_not_equal(glyph(c), &unknown);
    image_fill(one, 0, 0, 60, 60, (Rgb){0, 0, 0});
    font_draw(one, &f, 10, 40, text);
    assert_true(inked(one, 0, 60) > 4);
    int end = 10 + (int)ceil(font_width(text, 24)) + 1;
    for (int y = 0; y < 60; y++)
      for (int x = 0; x < 60; x++) assert_true(one->px[y * 60 + x].r < 128 || (x >= 9 && x <= end));
  }
  image_fill(one, 0, 0, 60, 60, (Rgb){0, 0, 0});
  font_draw(one, &f, 10, 40, "^3"), font_draw(other, &f, 10, 40, "3");
  assert_true(inked(one, 33, 60) == 0 && inked(other, 33, 60) > 0 && inked(one, 0, 22) > 0);
  assert_true(font_width("m^2", 24) < font_width("m2", 24));
  font_draw(one, &f, -30, 5, "outside"), font_draw(one, &f, 55, 100, "outside");
  image_free(one), image_free(other);
}

static Parts *cloud(long n)
{
  Parts *p = part_new(n);
  assert_int_equal(part_add(p, "id x m rho h body", NULL), 0);
  for (long i = 0; i < n; i++) {
    p->id[i] = i, p->m[i] = 1 + rng_uniform(1, (uint64_t)i, 5), p->rho[i] = 1, p->body[i] = i % 2;
    p->h[i] = 0.01 + 0.1 * rng_uniform(1, (uint64_t)i, 4);
    for (int a = 0; a < 3; a++)
      p->x[3 * i + a] = (a + 1) * rng_uniform(1, (uint64_t)i, (uint32_t)a);
  }
  return p;
}

/* Columns integrate to the mass, whether a particle covers a fraction of a pixel or hundreds. */
static void projection_keeps_mass(void **state)
{
  (void)state;
  Parts *p = cloud(500);
  double mass = 0;
  for (long i = 0; i < p->n; i++) mass += p->m[i];
  for (int w = 8; w <= 512; w *= 4) {
    Camera c = {.w = w, .h = w, .scale = w / 4., .centre = {0.5, 1, 1.5}};
    Field f = {0};
    float *value = calloc((size_t)w * (size_t)w, sizeof *value),
          *shade = calloc((size_t)w * (size_t)w, sizeof *shade);
    Window win = {w, w, w, value, shade};
    camera_plane(&c, "xy");
    assert_int_equal(project_sample(&win, p, &f, &c, NULL), 0);
    double sum = 0;
    for (long k = 0; k < (long)w * w; k++)
      sum += isnan(value[k]) ? 0 : value[k] / (c.scale * c.scale);
    assert_true(fabs(sum / mass - 1) < 2e-3);
    free(value), free(shade);
  }
  part_free(p);
}

/* The column of a homogeneous ball is its chord, also off the axis and seen from anywhere. */
static void columns_of_a_ball(void **state)
{
  (void)state;
  enum { M = 40, W = 64 };
  Parts *p = part_new(M * M * M);
  float value[W * W], shade[W * W];
  long n = 0;
  assert_int_equal(part_add(p, "id x m rho h body", NULL), 0);
  for (long i = 0; i < p->n; i++) {
    double x[3] = {(double)(i % M), (double)(i / M % M), (double)(i / M / M)}, r2 = 0;
    for (int a = 0; a < 3; a++) x[a] = 2 * (x[a] + 0.5) / M - 1, r2 += x[a] * x[a];
    if (r2 > 1) continue;
    memcpy(p->x + 3 * n, x, sizeof x);
    p->id[n] = n, p->m[n] = 3 * pow(2. / M, 3), p->rho[n] = 3, p->h[n] = 2.3 * 2 / M, n++;
  }
  p->n = n;
  Camera c = {.w = W, .h = W, .scale = W / 2.4};
  Window win = {W, W, W, value, shade};
  camera_turn(&c, 0.4, 0.7, 0.2);
  assert_int_equal(project_sample(&win, p, &(Field){0}, &c, NULL), 0);
  for (int k = 0; k < W * W; k++) {
    double x = (k % W + 0.5 - W / 2.) / c.scale, y = (k / W + 0.5 - W / 2.) / c.scale,
           r2 = x * x + y * y;
    if (r2 < 0.6 && fabs(value[k] / (6 * sqrt(1 - r2)) - 1) > 0.035)
      fail_msg("%g: %g", r2, value[k] / (6 * sqrt(1 - r2)));
    if (r2 > 1.3) assert_true(isnan(value[k]));
  }
  part_free(p);
}

/* What a camera shows of a point at r from the centre, along axes that are built otherwise: towards
 * the viewer; z less its part along that; and their cross product. */
static void view_of(double azimuth, double elevation, const double r[3], double seen[3])
{
  double out[3] = {cos(elevation) * cos(azimuth), cos(elevation) * sin(azimuth), sin(elevation)},
         up[3], right[3], size = 0;
  for (int a = 0; a < 3; a++) up[a] = (a == 2) - out[2] * out[a], size += up[a] * up[a];
  for (int a = 0; a < 3; a++) up[a] /= sqrt(size);
  for (int a = 0; a < 3; a++)
    right[a] = up[(a + 1) % 3] * out[(a + 2) % 3] - up[(a + 2) % 3] * out[(a + 1) % 3];
  memset(seen, 0, 3 * sizeof *seen);
  for (int a = 0; a < 3; a++)
    seen[0] += right[a] * r[a], seen[1] += up[a] * r[a], seen[2] += out[a] * r[a];
}

static void directions(void **state)
{
  (void)state;
  const double centre[3] = {3, -1, 2};
  for (int k = 0; k < 200; k++) {
    double az = 6 * rng_uniform(7, (uint64_t)k, 0), el = 3 * rng_uniform(7, (uint64_t)k, 1) - 1.5,
           u, v, depth, x[3], r[3], seen[3];
    Camera c = {.w = 200, .h = 100, .scale = 10, .offset = 0.5};
    camera_turn(&c, az, el, 0);
    for (int a = 0; a < 3; a++)
      r[a] = rng_uniform(7, (uint64_t)k, (uint32_t)a + 2) - 0.5,
      x[a] = r[a] + (c.centre[a] = centre[a]);
    view_of(az, el, r, seen);
    assert_true(camera_see(&c, x, &u, &v, &depth) == 1);
    assert_true(fabs(u - 100 - 10 * seen[0]) < 1e-9 && fabs(v - 50 + 10 * seen[1]) < 1e-9);
    assert_true(fabs(depth - 10 * (seen[2] - 0.5)) < 1e-9);
    c.distance = 4; /* nearer is larger: similar triangles */
    double zoom = camera_see(&c, x, &u, &v, &depth);
    assert_true(fabs(zoom - 4 / (4 - seen[2])) < 1e-12 &&
                fabs(u - 100 - 10 * zoom * seen[0]) < 1e-9);
    camera_turn(&c, az, el, acos(0)); /* rolled clockwise by a right angle: what was up is right */
    camera_see(&c, x, &u, &v, &depth);
    assert_true(fabs(u - 100 - 10 * seen[1]) < 1e-9 && fabs(v - 50 - 10 * seen[0]) < 1e-9);
    for (int a = 0; a < 3; a++) x[a] = c.centre[a] + 5 * c.axis[2][a]; /* behind an eye at 4 */
    c.distance = 4;
    assert_true(camera_see(&c, x, &u, &v, &depth) == 0);
  }
}

/* The planes are exact; 99 % are in the picture. */
static void camera(void **state)
{
  (void)state;
  const char *const planes[] = {"xy", "xz", "yz"};
  static const double axes[3][3][3] = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                       {{1, 0, 0}, {0, 0, 1}, {0, -1, 0}},
                                       {{0, 1, 0}, {0, 0, 1}, {1, 0, 0}}};
  Parts *p = cloud(4000);
  Err err;
  for (int k = 0; k < 3; k++) {
    Camera c = {.w = 200, .h = 100, .scale = 10};
    camera_plane(&c, planes[k]);
    double u, v, depth, seen = 0, mass = 0;
    for (int a = 0; a < 3; a++)
      for (int b = 0; b < 3; b++) assert_true(c.axis[a][b] == axes[k][a][b]);
    assert_int_equal(pick_centre(c.centre, p, "com", "a", &err), 0);
    c.scale = c.w / camera_extent(&c, p, 0);
    for (long i = 0; i < p->n; i++) {
      camera_see(&c, p->x + 3 * i, &u, &v, &depth);
      mass += p->m[i], seen += u >= 0 && u < 200 && v >= 0 && v < 100 ? p->m[i] : 0;
    }
    assert_true(seen >= 0.99 * mass);
    double extent = camera_extent(&c, p, 0.5); /* of an eye that sees 53 degrees */
    c.distance = extent, c.scale = c.w / extent, seen = 0;
    for (long i = 0; i < p->n; i++) {
      double zoom = camera_see(&c, p->x + 3 * i, &u, &v, &depth);
      seen += zoom > 0 && u >= 0 && u < 200 && v >= 0 && v < 100 ? p->m[i] : 0;
    }
    assert_true(seen >= 0.99 * mass);
  }
  Camera c = {0};
  assert_int_equal(pick_centre(c.centre, p, "1km,-2m,3e3", "a", &err), 0);
  assert_true(c.centre[0] == 1000 && c.centre[1] == -2 && c.centre[2] == 3000);
  const char *const wrong[] = {
      "1,2", "1,2,3,4", "", "1kg,2,3", "body:", "body:x", "body:2", "clump:1", "con"};
  for (int k = 0; k < 9; k++) {
    *err.text = 0;
    assert_int_equal(pick_centre(c.centre, p, wrong[k], "a.h5", &err), -1);
    assert_true(*err.text);
  }
  part_free(p);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(uniform_maps),
                                     cmocka_unit_test(materials_have_their_colours),
                                     cmocka_unit_test(png_round_trip),
                                     cmocka_unit_test(letters),
                                     cmocka_unit_test(projection_keeps_mass),
                                     cmocka_unit_test(directions),
                                     cmocka_unit_test(camera),
                                     cmocka_unit_test(columns_of_a_ball)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
