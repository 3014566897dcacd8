/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include "lib/unit.h"
#include "spin.h"

static const double PI = 3.14159265358979323846;

/* Whether a part of the list has the unit of an angular speed. */
static int has_rate(const char *text)
{
  char part[64];
  const char *suffix;
  double x;
  for (const char *at = text; *at; at += strcspn(at, ","), at += *at == ',') {
    snprintf(part, sizeof part, "%.*s", (int)strcspn(at, ","), at);
    if (!unit_suffix(part, &x, &suffix, NULL) && *suffix && !unit_parse(part, "rad/s", &x, NULL))
      return 1;
  }
  return 0;
}

static int parse_vector(Spin *s, const char *text, Err *err)
{
  s->vector = s->turned = 1;
  if (unit_list(text, "rad/s", 3, s->omega, err)) return -1;
  for (int k = 0; k < 3; k++) s->rate = hypot(s->rate, s->omega[k]);
  return s->rate > 0 ? 0 : err_set(err, "'%s' has no direction (none: no rotation)", text);
}

static int parse_angles(Spin *s, const char *text, Err *err)
{
  double angle[3] = {0};
  int n = 1;
  for (const char *at = text; *at; at++) n += *at == ',';
  if (n > 3) return err_set(err, "more than obliquity, node and meridian: '%s'", text);
  if (unit_list(text, "rad", n, angle, err)) return -1;
  if (!(angle[0] >= 0 && angle[0] <= PI * (1 + 1e-15)))
    return err_set(err, "obliquity %g deg is not in 0..180 (write degrees as 45deg)",
                   angle[0] / PI * 180);
  s->obliquity = angle[0], s->node = angle[1], s->meridian = angle[2];
  return 0;
}

int spin_parse(Spin *s, const char *text, Err *err)
{
  char first[64];
  size_t length = strcspn(text, ",");
  double period;
  *s = (Spin){.given = 1};
  if (has_rate(text)) return parse_vector(s, text, err);
  snprintf(first, sizeof first, "%.*s", (int)length, text);
  if (strcmp(first, "none")) {
    if (unit_parse(first, "s", &period, err)) return -1;
    if (period == 0) return err_set(err, "a period of 0 s is infinitely fast (none: no rotation)");
    s->rate = 2 * PI / period, s->turned = 1;
  }
  if (!text[length]) return 0;
  s->turned = 1;
  return parse_angles(s, text + length + 1, err);
}

static void multiply(double a[3][3], double b[3][3], double c[3][3])
{
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) c[i][j] = a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j];
}

static void apply(double m[3][3], double x[3])
{
  double y[3] = {x[0], x[1], x[2]};
  for (int i = 0; i < 3; i++) x[i] = m[i][0] * y[0] + m[i][1] * y[1] + m[i][2] * y[2];
}

/* T' = M T M^T of a symmetric tensor xx xy xz yy yz zz. */
static void apply_tensor(double m[3][3], double t[6])
{
  double full[3][3] = {{t[0], t[1], t[2]}, {t[1], t[3], t[4]}, {t[2], t[4], t[5]}};
  double left[3][3], turned[3][3], mt[3][3];
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) mt[i][j] = m[j][i];
  multiply(m, full, left), multiply(left, mt, turned);
  for (int i = 0, k = 0; i < 3; i++)
    for (int j = i; j < 3; j++) t[k++] = turned[i][j];
}

/* Rotation about z by a, and about x by a. */
static void about_z(double a, double m[3][3])
{
  double r[3][3] = {{cos(a), -sin(a), 0}, {sin(a), cos(a), 0}, {0, 0, 1}};
  memcpy(m, r, sizeof r);
}

static void about_x(double a, double m[3][3])
{
  double r[3][3] = {{1, 0, 0}, {0, cos(a), -sin(a)}, {0, sin(a), cos(a)}};
  memcpy(m, r, sizeof r);
}

/* The shortest turn of the unit vector u to the z axis. */
static void to_z(const double u[3], double m[3][3])
{
  double k = 1 / (1 + u[2]);
  double r[3][3] = {{1 - u[0] * u[0] * k, -u[0] * u[1] * k, -u[0]},
                    {-u[0] * u[1] * k, 1 - u[1] * u[1] * k, -u[1]},
                    {u[0], u[1], u[2]}};
  memcpy(m, r, sizeof r);
  if (u[2] < -1 + 1e-9) about_x(PI, m);
}

/* The body's own pole: of its rotation when that is most of its motion, else z. */
static void own_pole(const Group *g, double pole[3])
{
  double omega = sqrt(pow(g->omega[0], 2) + pow(g->omega[1], 2) + pow(g->omega[2], 2));
  int rotates = g->e_rot > 0.5 * g->e_kin && omega > 0;
  for (int k = 0; k < 3; k++) pole[k] = rotates ? g->omega[k] / omega : k == 2;
}

/* Turns everything that has a direction. Unknown fields keep theirs, which is worth a word. */
static void turn(Body *b, double m[3][3])
{
  Parts *p = b->p;
  for (const PartField *f = part_fields; f < part_fields + part_field_count; f++) {
    double *a = f->kind == 'd' ? part_array(p, f) : NULL;
    if (!a || f->width == 1) continue;
    for (long i = 0; i < p->n; i++) {
      double *row = a + i * f->width;
      const double *origin = a == p->x ? b->g.x : a == p->v ? b->g.v : (double[3]){0, 0, 0};
      if (f->width == 6) apply_tensor(m, row);
      if (f->width != 3) continue;
      for (int k = 0; k < 3; k++) row[k] -= origin[k];
      apply(m, row);
      for (int k = 0; k < 3; k++) row[k] += origin[k];
    }
  }
  for (int k = 0; k < p->extras; k++)
    if (p->extra[k].width > 1)
      err_warn("'%s' is turned, its unknown field '%s' is not", b->file, p->extra[k].name);
}

/* From the frame of the file to that of the orbit, in space. */
static void orientation(const Spin *s, const Body *b, const Geometry *g, double m[3][3])
{
  double pole[3], own[3][3], z[3][3], x[3][3], t[3][3], w[3] = {0}, node = s->node;
  double obliquity = s->obliquity, space[3][3];
  for (int k = 0; k < 3; k++) /* columns: contact, across, pole of the orbit */
    space[k][0] = g->e[1][k], space[k][1] = -g->e[0][k], space[k][2] = g->e[2][k];
  if (s->vector) {
    for (int i = 0; i < 3; i++)
      for (int k = 0; k < 3; k++) w[i] += space[k][i] * s->omega[k];
    obliquity = atan2(hypot(w[0], w[1]), w[2]), node = atan2(w[0], -w[1]);
  }
  own_pole(&b->g, pole);
  to_z(pole, own);
  about_z(s->meridian, z), multiply(z, own, m);
  about_x(obliquity, x), multiply(x, m, t);
  about_z(node, z), multiply(z, t, m);
  multiply(space, m, t), memcpy(m, t, sizeof t);
}

/* Rigid rotation that is missing to omega. */
static void rotate(Body *b, const double omega[3])
{
  double w[3];
  for (int k = 0; k < 3; k++) w[k] = omega[k] - b->g.omega[k];
  for (long i = 0; i < b->p->n; i++) {
    double r[3], *v = b->p->v + 3 * i;
    for (int k = 0; k < 3; k++) r[k] = b->p->x[3 * i + k] - b->g.x[k];
    for (int k = 0; k < 3; k++)
      v[k] += w[(k + 1) % 3] * r[(k + 2) % 3] - w[(k + 2) % 3] * r[(k + 1) % 3];
  }
}

static void flatten(Parts *p)
{
  for (long i = 0; i < p->n && p->dimension == 2; i++) p->x[3 * i + 2] = p->v[3 * i + 2] = 0;
}

int spin_apply(const Spin *s, Body *b, const Geometry *g, Err *err)
{
  double m[3][3], omega[3], sine = sin(s->obliquity);
  if (!s->given) return 0;
  if (b->p->dimension == 2 &&
      (s->vector ? s->omega[0] != 0 || s->omega[1] != 0 : fabs(sine) > 1e-15))
    return err_set(err, "'%s' is a disc: it rotates about z only", b->file);
  if (s->turned) {
    orientation(s, b, g, m);
    turn(b, m);
    flatten(b->p);
    if (body_measure(b, err)) return -1;
  }
  for (int k = 0; k < 3; k++) {
    double pole = sine * sin(s->node) * g->e[1][k] + sine * cos(s->node) * g->e[0][k] +
                  cos(s->obliquity) * g->e[2][k];
    omega[k] = s->vector ? s->omega[k] : s->rate * pole;
  }
  rotate(b, omega);
  flatten(b->p);
  if (g->a.orbit.mu > 0 && s->rate * s->rate * pow(b->radius, 3) > UNIT_G * b->g.mass)
    err_warn("'%s' spins faster than its surface can orbit it", b->file);
  return body_measure(b, err);
}
