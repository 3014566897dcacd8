/* SPDX-License-Identifier: GPL-3.0-or-later */
/* collide: puts two bodies on the orbit that brings them into contact at t = 0 with a given angle
 * and speed (docs/theory.md 7; lib/orbit.h). */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "lib/opt.h"
#include "lib/orbit.h"
#include "lib/snap.h"
#include "lib/unit.h"

static struct {
  double angle, radius[2];
  const char *speed, *distance, *out;
  int no_gravity, dry;
} o = {.angle = NAN, .radius = {NAN, NAN}};

/* clang-format off */
static const Opt OPTS[] = {
  {"angle",           'a', OPT_REAL, NULL, "rad",   "between -velocity and centre line at contact: 0deg head-on", &o.angle},
  {"speed",           's', OPT_TEXT, NULL, "SPEED", "at contact: 3km/s or 1.7vesc; 700vinf: m/s at infinity", &o.speed},
  {"distance",        'd', OPT_TEXT, "5",  "DIST",  "of the centres at the start, in r1 + r2 or as a length", &o.distance},
  {"radius-target",   0,   OPT_REAL, NULL, "m",     "instead of the radius in the file (/Body)", &o.radius[0]},
  {"radius-impactor", 0,   OPT_REAL, NULL, "m",     "the same of the second body", &o.radius[1]},
  {"no-gravity",      0,   OPT_FLAG, NULL, NULL,    "approach on a straight line", &o.no_gravity},
  {"dry-run",         'n', OPT_FLAG, NULL, NULL,    "print the geometry, write no file", &o.dry},
  {"output",          'o', OPT_TEXT, "-",  "FILE",  "where the system goes", &o.out},
  {NULL, 0, OPT_FLAG, NULL, NULL, NULL, NULL}};

static const OptProgram PROGRAM = {
  "collide", "put two bodies on a collision orbit", "[options] target.h5 impactor.h5 > impact.h5",
  "Contact is at t = 0 on the y axis; the file's time is negative. The frame is that of the common centre of mass, the angular "
  "momentum points along +z. Bodies become 0 and 1; the ids of the second are shifted past those of the first.",
  "collide --angle 48deg --speed 1.7vesc --distance 12 target.h5 impactor.h5 > impact.h5", OPTS, 2, 2};
/* clang-format on */

typedef struct {
  const char *file;
  Parts *p;
  double mass, x[3], v[3]; /* kg, centre of mass [m], its velocity [m/s] */
  double reach;            /* of the outermost particle from it [m] */
  double radius;           /* m */
  const char *source;      /* where the radius is from */
} Body;

static void measure(Body *b)
{
  const Parts *p = b->p;
  for (long i = 0; i < p->n; i++) {
    b->mass += p->m[i];
    for (int a = 0; a < 3; a++)
      b->x[a] += p->m[i] * p->x[3 * i + a], b->v[a] += p->m[i] * p->v[3 * i + a];
  }
  for (int a = 0; a < 3; a++) b->x[a] /= b->mass, b->v[a] /= b->mass;
  for (long i = 0; i < p->n; i++) {
    double r2 = 0;
    for (int a = 0; a < 3; a++) r2 += pow(p->x[3 * i + a] - b->x[a], 2);
    b->reach = fmax(b->reach, sqrt(r2));
  }
}

/* Half the distance of neighbours in a close packing of the body's mean particle volume. */
static double half_spacing(const Parts *p)
{
  double volume = 0;
  for (long i = 0; i < p->n; i++) volume += p->m[i] / p->rho[i] / (double)p->n;
  return p->dimension == 3 ? cbrt(sqrt(2) * volume) / 2 : sqrt(2 / sqrt(3) * volume) / 2;
}

/* Given, or as the body was made, or from the outermost particle. */
static void find_radius(Body *b, double given)
{
  b->radius = given, b->source = "given";
  if (!isnan(given)) return;
  b->radius = part_number(b->p, "body", "Radius0"), b->source = "/Body";
  if (!isnan(b->radius)) return;
  b->radius = b->reach + half_spacing(b->p), b->source = "outermost particle";
  err_warn("'%s' does not tell its radius: %g m is taken, from the outermost particle", b->file,
           b->radius);
}

static void read_body(Body *b, const char *file, double radius)
{
  Err err;
  *b = (Body){.file = file, .p = snap_read(file, &err)};
  if (!b->p || part_need(b->p, "id x v m rho mat body", file, &err) || part_check(b->p, file, &err))
    err_die("%s", err.text);
  if (b->p->n == 0) err_die("'%s' has no particles", file);
  if (b->p->dimension == 1 || (b->p->dimension == 2 && !o.no_gravity))
    err_die("'%s' is of dimension %d: %s", file, b->p->dimension,
            b->p->dimension == 1 ? "an approach needs a plane" : "only --no-gravity knows planes");
  measure(b);
  find_radius(b, radius);
}

/* Speed at contact [m/s] from "3km/s", "1.7vesc" or "700vinf". */
static double contact_speed(const char *text, double mu, double rc)
{
  size_t n = strlen(text);
  int infinity = n > 4 && !strcmp(text + n - 4, "vinf");
  const char *suffix;
  char number[64];
  double v;
  Err err;
  if (unit_suffix(text, &v, &suffix, &err)) err_usage("speed: %s", err.text);
  if (!strcmp(suffix, "vesc")) return v * sqrt(2 * mu / rc);
  snprintf(number, sizeof number, "%.*s", (int)(infinity ? n - 4 : n), text);
  if (unit_parse(number, "m/s", &v, &err)) err_usage("speed: %s", err.text);
  return infinity ? orbit_speed_at_contact(o.no_gravity ? 0 : mu, rc, v) : v;
}

static double start_distance(const char *text, double rc)
{
  const char *suffix;
  double d;
  Err err;
  if (unit_suffix(text, &d, &suffix, &err)) err_usage("distance: %s", err.text);
  if (!*suffix) return d * rc;
  if (unit_parse(text, "m", &d, &err)) err_usage("distance: %s", err.text);
  return d;
}

static OrbitApproach geometry(const Body *b)
{
  double mu = b->p->dimension == 3 ? UNIT_G * (b[0].mass + b[1].mass) : 0;
  double rc = b[0].radius + b[1].radius, speed = contact_speed(o.speed, mu, rc);
  double distance = start_distance(o.distance, rc);
  OrbitApproach a;
  Err err;
  if (orbit_approach(&a, o.no_gravity ? 0 : mu, rc, speed, o.angle, distance, &err))
    err_die("%s", err.text);
  a.vesc = sqrt(2 * mu / rc);
  if (b[0].reach + b[1].reach > distance)
    err_die("the bodies overlap: their particles reach %g and %g m, the distance is %g m",
            b[0].reach, b[1].reach, distance);
  return a;
}

/* What --dry-run prints (angles in degrees) and /Collision holds (SI). */
typedef struct {
  const char *name, *unit, *meaning;
  double value;
} Row;

enum { ROWS = 24 };

static int rows(const OrbitApproach *a, const Body *b, Row row[ROWS])
{
  const double mass = b[0].mass + b[1].mass;
  const double reduced = b[0].mass * b[1].mass / mass;
  const Row all[ROWS] = {
      {"MassTarget", "kg", "particles of body 0", b[0].mass},
      {"MassImpactor", "kg", "particles of body 1", b[1].mass},
      {"RadiusTarget", "m", b[0].source, b[0].radius},
      {"RadiusImpactor", "m", b[1].source, b[1].radius},
      {"ContactDistance", "m", "r1 + r2", a->rc},
      {"EscapeSpeed", "m/s", "mutual, at contact", a->vesc},
      {"ContactSpeed", "m/s", "at contact", a->vc},
      {"ContactAngle", "rad", "0 is head-on", a->angle},
      {"ContactTime", "s", "by definition", 0},
      {"SpeedAtInfinity", "m/s", "nan when bound", a->orbit.vinf},
      {"Eccentricity", "1", "inf without gravity", a->orbit.e},
      {"Periapsis", "m", "of the points' orbit", a->orbit.rp},
      {"Apoapsis", "m", "inf when unbound", a->orbit.ra},
      {"AnomalyAtContact", "rad", "true anomaly, inbound < 0", a->anomaly_c},
      {"AnomalyAtStart", "rad", "true anomaly, inbound < 0", a->anomaly},
      {"InitialDistance", "m", "of the centres", a->r0},
      {"InitialTime", "s", "contact is at 0", a->t0},
      {"InitialSpeed", "m/s", "relative", a->v0},
      {"InitialX", "m", "of body 1 relative to body 0", a->x[0]},
      {"InitialY", "m", "of body 1 relative to body 0", a->x[1]},
      {"InitialVx", "m/s", "of body 1 relative to body 0", a->v[0]},
      {"InitialVy", "m/s", "of body 1 relative to body 0", a->v[1]},
      {"AngularMomentum", "kg m^2/s", "orbital, about the centre of mass", reduced * a->orbit.h},
      {"SpecificImpactEnergy", "J/kg", "m_red v_c^2/(2 M)", reduced * a->vc * a->vc / (2 * mass)}};
  memcpy(row, all, sizeof all);
  return ROWS;
}

static void print(const Row *row, int n)
{
  printf("# quantity\tvalue\tunit\tmeaning\n");
  for (; n--; row++) {
    int angle = !strcmp(row->unit, "rad");
    printf("%s\t%.12g\t%s\t%s\n", row->name, angle ? row->value * 90 / acos(0) : row->value,
           angle ? "deg" : row->unit, row->meaning);
  }
  err_close_stdout();
}

/* Moves a body, its centre of mass to share x a, share v a of the relative orbit, and renames what
 * is numbered: its particles from `id` on, its body, its entries in /Body. */
static void place(Body *b, const OrbitApproach *a, double share, int number, int64_t id)
{
  Parts *p = b->p;
  for (long i = 0; i < p->n; i++) {
    for (int k = 0; k < 3; k++) {
      p->x[3 * i + k] += (k < 2 ? share * a->x[k] : 0) - b->x[k];
      p->v[3 * i + k] += (k < 2 ? share * a->v[k] : 0) - b->v[k];
    }
    p->id[i] += id, p->body[i] = number;
  }
  for (int k = 0; k < p->body_infos; k++) {
    char *last = p->body_info[k].name + strlen(p->body_info[k].name) - 1;
    if (*last == '0') *last = (char)('0' + number);
  }
}

/* What is to be added to the ids of the second body. */
static int64_t shift(const Parts *a, const Parts *b)
{
  int64_t last = a->id[0], largest = b->id[0];
  for (long i = 0; i < a->n; i++) last = a->id[i] > last ? a->id[i] : last;
  for (long i = 0; i < b->n; i++) largest = b->id[i] > largest ? b->id[i] : largest;
  if (last > INT64_MAX / 2 || largest > INT64_MAX / 2)
    err_die("particle ids are too large to shift");
  return last + 1;
}

/* What only one of the bodies has becomes zero in the other: worth a word. */
static void warn_of_gaps(const Body *b)
{
  for (const PartField *f = part_fields; f < part_fields + part_field_count; f++)
    for (int k = 0; k < 2; k++)
      if (part_array(b[k].p, f) && !part_array(b[1 - k].p, f))
        err_warn("field '%s' of '%s' is missing in '%s': zeros there", f->name, b[k].file,
                 b[1 - k].file);
  for (int k = 0; k < 2; k++)
    if (b[k].p->nflaw && !b[1 - k].p->nflaw)
      err_warn("'%s' has flaws, '%s' has none (made by weibull)", b[k].file, b[1 - k].file);
}

static Parts *join(Body *b, const OrbitApproach *a)
{
  double mass = b[0].mass + b[1].mass;
  Parts *p;
  Err err;
  warn_of_gaps(b);
  place(&b[1], a, b[0].mass / mass, 1, shift(b[0].p, b[1].p));
  place(&b[0], a, -b[1].mass / mass, 0, 0);
  if (!(p = part_join(b[0].p, b[1].p, &err))) err_die("%s", err.text);
  p->time = a->t0;
  return p;
}

static void note(Parts *p, const Row *row, int n, const char *line)
{
  Err err;
  for (int k = 0; k < n; k++)
    if (isfinite(row[k].value) && part_set_number(p, "collision", row[k].name, row[k].value, &err))
      err_die("%s", err.text);
  if (part_history(p, line, &err)) err_die("%s", err.text);
}

static void check_options(void)
{
  if (isnan(o.angle)) err_usage("which impact angle? give --angle, as in 45deg");
  if (!o.speed) err_usage("which speed? give --speed, as in 1.7vesc or 3km/s");
  if (!(o.angle >= 0 && o.angle <= acos(0) * (1 + 1e-15)))
    err_usage("impact angle %g rad is not in 0..90 deg (write degrees as 45deg)", o.angle);
  for (int k = 0; k < 2; k++)
    if (!isnan(o.radius[k]) && !(o.radius[k] > 0))
      err_usage("radius %g m is not positive", o.radius[k]);
}

int main(int argc, char **argv)
{
  int n, k;
  char *line = opt_command_line(argc, argv), **input = opt_parse(&PROGRAM, argc, argv, &n);
  OrbitApproach a;
  Row row[ROWS];
  Body body[2];
  Parts *system;
  Err err;
  check_options();
  for (k = 0; k < 2; k++) read_body(&body[k], input[k], o.radius[k]);
  if (body[0].p->dimension != body[1].p->dimension)
    err_die("bodies of %d and %d dimensions", body[0].p->dimension, body[1].p->dimension);
  a = geometry(body);
  n = rows(&a, body, row);
  if (o.dry)
    print(row, n);
  else {
    system = join(body, &a);
    note(system, row, n, line);
    if (snap_write(system, o.out, 0, &err)) err_die("%s", err.text);
    part_free(system);
  }
  for (k = 0; k < 2; k++) part_free(body[k].p);
  free(line);
  return 0;
}
