/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include "geometry.h"
#include "lib/unit.h"

static const double NOT_GIVEN_DISTANCE = 5; /* r1 + r2 */

static double dot(const double a[3], const double b[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static double length(const double a[3]) { return sqrt(dot(a, a)); }

static void cross(const double a[3], const double b[3], double c[3])
{
  for (int k = 0; k < 3; k++) {
    int i = (k + 1) % 3, j = (k + 2) % 3;
    c[k] = a[i] * b[j] - a[j] * b[i];
  }
}

static void check_state(const GeometryInput *in)
{
  if (!isnan(in->angle) || in->b || !isnan(in->momentum) || in->speed)
    err_usage("--state is angle and speed already: leave those out");
  if (in->contact || in->pole) err_usage("--state has its own directions: no --contact, no --pole");
}

void geometry_check(const GeometryInput *in)
{
  int angles = !isnan(in->angle) + (in->b != NULL) + !isnan(in->momentum);
  if (in->distance && !isnan(in->time)) err_usage("give either --distance or --time");
  if (!isnan(in->time) && !(in->time > 0))
    err_usage("time before contact %g s is not positive", in->time);
  if (in->state) {
    check_state(in);
    return;
  }
  if (!angles) err_usage("which impact angle? give --angle, as in 45deg (or -b, or -L)");
  if (angles > 1) err_usage("give one of --angle, --impact-parameter, --angular-momentum");
  if (!in->speed) err_usage("which speed? give --speed, as in 1.7vesc or 3km/s");
  if (!isnan(in->angle) && !(in->angle >= 0 && in->angle <= acos(0) * (1 + 1e-15)))
    err_usage("impact angle %g rad is not in 0..90 deg (write degrees as 45deg)", in->angle);
  if (!isnan(in->momentum) && !(in->momentum >= 0))
    err_usage("angular momentum %g kg m^2/s is negative (--pole turns the orbit)", in->momentum);
}

/* A speed in m/s or in escape speeds. */
static double speed_of(const char *text, double vesc)
{
  const char *suffix;
  double v;
  Err err;
  if (unit_suffix(text, &v, &suffix, &err)) err_usage("speed: %s", err.text);
  if (!strcmp(suffix, "vesc")) return v * vesc;
  if (unit_parse(text, "m/s", &v, &err))
    err_usage("speed: %s (or 1.7vesc, 700vinf, 0.5vescvinf)", err.text);
  return v;
}

static double contact_speed(const GeometryInput *in, double mu, double rc)
{
  size_t n = strlen(in->speed);
  char number[64];
  double v;
  if (n <= 4 || strcmp(in->speed + n - 4, "vinf")) return speed_of(in->speed, sqrt(2 * mu / rc));
  snprintf(number, sizeof number, "%.*s", (int)(n - 4), in->speed);
  v = speed_of(number, sqrt(2 * mu / rc));
  if (v < 0) err_usage("speed at infinity %g m/s is negative", v);
  return orbit_speed_at_contact(in->no_gravity ? 0 : mu, rc, v);
}

/* A number of r1 + r2, or a length. */
static double in_contacts(const char *text, double rc, const char *what)
{
  const char *suffix;
  double d;
  Err err;
  if (unit_suffix(text, &d, &suffix, &err)) err_usage("%s: %s", what, err.text);
  if (!*suffix) return d * rc;
  if (unit_parse(text, "m", &d, &err)) err_usage("%s: %s", what, err.text);
  return d;
}

static int contact_angle(const GeometryInput *in, double rc, double vc, double reduced,
                         double *angle, Err *err)
{
  double sine, most = reduced * rc * vc;
  *angle = in->angle;
  if (!isnan(in->angle)) return 0;
  sine = in->b ? in_contacts(in->b, rc, "impact parameter") / rc : in->momentum / most;
  if (in->b && !(sine >= 0 && sine <= 1))
    return err_set(err, "impact parameter %g r1 + r2 is not in 0..1", sine);
  if (!(sine <= 1))
    return err_set(err, "angular momentum %g kg m^2/s is more than that of a grazing contact, %g",
                   in->momentum, most);
  *angle = asin(sine);
  return 0;
}

/* Unit vector from "x", "-y" or "X,Y,Z". */
static void direction(const char *text, const char *option, double axis[3])
{
  Err err;
  const char *letter = text + (*text == '-' || *text == '+');
  if (letter[0] >= 'x' && letter[0] <= 'z' && !letter[1])
    for (int k = 0; k < 3; k++) axis[k] = (k == letter[0] - 'x') * (*text == '-' ? -1 : 1);
  else if (unit_list(text, "1", 3, axis, &err))
    err_usage("--%s: %s (or x, -x, y ...)", option, err.text);
  double size = length(axis);
  if (!(size > 0)) err_usage("--%s: '%s' has no direction", option, text);
  for (int k = 0; k < 3; k++) axis[k] /= size;
}

/* Contact and pole; without a pole given: z, or what of it is across the contact, or x. */
static int frame(const GeometryInput *in, double e[3][3], Err *err)
{
  double along;
  direction(in->contact ? in->contact : "y", "contact", e[1]);
  direction(in->pole ? in->pole : "z", "pole", e[2]);
  if (!in->pole && fabs(e[1][2]) > 1 - 1e-9) direction("x", "pole", e[2]);
  along = dot(e[1], e[2]);
  if (in->pole && fabs(along) > 1e-6)
    return err_set(err, "pole and direction of contact are not at right angles: %g deg",
                   acos(along) * 90 / acos(0));
  for (int k = 0; k < 3; k++) e[2][k] -= along * e[1][k];
  along = length(e[2]);
  for (int k = 0; k < 3; k++) e[2][k] /= along;
  return 0;
}

static int read_state(const GeometryInput *in, const Body b[2], double x[3], double v[3], Err *err)
{
  if (!strcmp(in->state, "files")) {
    if (b[0].p->time != b[1].p->time)
      return err_set(err, "'%s' and '%s' are not of the same time: %g and %g s", b[0].file,
                     b[1].file, b[0].p->time, b[1].p->time);
    for (int k = 0; k < 3; k++) x[k] = b[1].g.x[k] - b[0].g.x[k], v[k] = b[1].g.v[k] - b[0].g.v[k];
    return 0;
  }
  const char *comma = in->state;
  char place[192];
  Err why;
  for (int k = 0; k < 3 && comma; k++) comma = strchr(comma + (k > 0), ',');
  snprintf(place, sizeof place, "%.*s", comma ? (int)(comma - in->state) : 0, in->state);
  if (!comma || unit_list(place, "m", 3, x, &why) || unit_list(comma + 1, "m/s", 3, v, &why))
    err_usage("--state: %s", comma ? why.text : "'files' or X,Y,Z,VX,VY,VZ is wanted");
  return 0;
}

static int from_state(Geometry *g, const GeometryInput *in, const Body b[2], double mu, double rc,
                      Err *err)
{
  double x[3], v[3];
  if (read_state(in, b, x, v, err)) return -1;
  if (b->p->dimension == 2 && (x[2] != 0 || v[2] != 0))
    return err_set(err, "discs move in the plane of x and y: Z and VZ are to be 0");
  if (orbit_approach_state(&g->a, mu, rc, x, v, g->e[1], g->e[2], err)) return -1;
  return 0;
}

/* Puts the start where --distance or --time says; a state is a start already. */
static int place(Geometry *g, const GeometryInput *in, double mu, double vc, double angle, Err *err)
{
  double rc = g->a.rc, d = NOT_GIVEN_DISTANCE * rc;
  if (!isnan(in->time)) return orbit_approach_time(&g->a, mu, rc, vc, angle, in->time, err);
  if (in->distance) d = in_contacts(in->distance, rc, "distance");
  return in->distance || !in->state ? orbit_approach(&g->a, mu, rc, vc, angle, d, err) : 0;
}

int geometry_find(Geometry *g, const GeometryInput *in, const Body b[2], Err *err)
{
  double mass = b[0].g.mass + b[1].g.mass, rc = b[0].radius + b[1].radius, vc, angle;
  double mu = b->p->dimension == 3 ? UNIT_G * mass : 0, pull = in->no_gravity ? 0 : mu;
  memset(g, 0, sizeof *g);
  g->a.rc = rc, g->reduced = b[0].g.mass / mass * b[1].g.mass;
  if (in->state) {
    if (from_state(g, in, b, pull, rc, err)) return -1;
    vc = g->a.vc, angle = g->a.angle;
  } else {
    vc = contact_speed(in, mu, rc);
    if (!(vc > 0)) return err_set(err, "speed at contact %g m/s is not positive", vc);
    if (frame(in, g->e, err) || contact_angle(in, rc, vc, g->reduced, &angle, err)) return -1;
    if (b->p->dimension == 2 && (g->e[1][2] != 0 || fabs(g->e[2][2]) != 1))
      return err_set(err, "discs meet in the plane of x and y, with the pole along z or -z");
  }
  if (place(g, in, pull, vc, angle, err)) return -1;
  g->a.vesc = sqrt(2 * mu / rc);
  cross(g->e[1], g->e[2], g->e[0]);
  for (int k = 0; k < 3; k++) {
    g->x[k] = g->a.x[0] * g->e[0][k] + g->a.x[1] * g->e[1][k];
    g->v[k] = g->a.v[0] * g->e[0][k] + g->a.v[1] * g->e[1][k];
  }
  return 0;
}

int geometry_apart(const Geometry *g, const Body b[2], Err *err)
{
  double line[3], ahead[2], back[2], distance = length(g->x);
  for (int k = 0; k < 3; k++) line[k] = g->x[k] / distance;
  if (b[0].reach + b[1].reach <= distance) return 0;
  body_extent(&b[0], g->e[1], ahead), body_extent(&b[1], g->e[1], back);
  if (ahead[1] + back[0] <= dot(g->x, g->e[1])) return 0;
  body_extent(&b[0], line, ahead), body_extent(&b[1], line, back);
  if (ahead[1] + back[0] <= distance) return 0;
  return err_set(err,
                 "the bodies overlap: their particles reach %g and %g m towards each other, "
                 "the distance is %g m",
                 ahead[1], back[0], distance);
}
