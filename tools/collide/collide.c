/* SPDX-License-Identifier: GPL-3.0-or-later */
/* collide: puts two bodies on the orbit that brings them into contact at t = 0
 * (docs/theory.md 7; lib/orbit.h). */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "lib/opt.h"
#include "lib/snap.h"
#include "report.h"
#include "spin.h"
#include "verify.h"

static struct {
  GeometryInput in;
  const char *select[2], *radius[2], *spin[2], *out;
  int verify, dry;
} o = {.in = {.angle = NAN, .momentum = NAN, .time = NAN}};

/* clang-format off */
static const Opt OPTS[] = {
  {"angle",            'a', OPT_REAL, NULL, "rad",   "between -velocity and line of centres; 0: head-on", &o.in.angle},
  {"impact-parameter", 'b', OPT_TEXT, NULL, "B",     "or its sine, or r1 + r2 times that as a length", &o.in.b},
  {"angular-momentum", 'L', OPT_REAL, NULL, "kg m^2/s", "or this, of the orbit", &o.in.momentum},
  {"speed",            's', OPT_TEXT, NULL, "SPEED", "at contact 3km/s, 1.7vesc; far away 700vinf", &o.in.speed},
  {"distance",         'd', OPT_TEXT, NULL, "DIST",  "at the start, in r1 + r2 or as a length; not given: 5", &o.in.distance},
  {"time",             't', OPT_REAL, NULL, "s",     "or this, from the start to contact", &o.in.time},
  {"state",            0,   OPT_TEXT, NULL, "STATE", "or all of it: X,Y,Z,VX,VY,VZ of body 2; or: files", &o.in.state},
  {"contact",          0,   OPT_TEXT, NULL, "AXIS",  "to body 2 at contact: x, -z or X,Y,Z; not given: y", &o.in.contact},
  {"pole",             0,   OPT_TEXT, NULL, "AXIS",  "of the orbit, where its momentum points: z", &o.in.pole},
  {"spin-target",      0,   OPT_TEXT, NULL, "SPIN",  "PERIOD[,OBLIQUITY[,NODE[,MERIDIAN]]] or a vector", &o.spin[0]},
  {"spin-impactor",    0,   OPT_TEXT, NULL, "SPIN",  "the same of the second body; not given: as it is", &o.spin[1]},
  {"select-target",    0,   OPT_TEXT, NULL, "WHAT",  "only body:N, fragment:N or clump:N of the file", &o.select[0]},
  {"select-impactor",  0,   OPT_TEXT, NULL, "WHAT",  "the same of the second file", &o.select[1]},
  {"radius-target",    0,   OPT_TEXT, NULL, "R",     "a length; or: body (as made), reach, volume", &o.radius[0]},
  {"radius-impactor",  0,   OPT_TEXT, NULL, "R",     "the same of the second body", &o.radius[1]},
  {"no-gravity",       0,   OPT_FLAG, NULL, NULL,    "approach on a straight line", &o.in.no_gravity},
  {"verify",           'V', OPT_FLAG, NULL, NULL,    "integrate the two points to contact, and compare", &o.verify},
  {"dry-run",          'n', OPT_FLAG, NULL, NULL,    "print all numbers, write no file", &o.dry},
  {"output",           'o', OPT_TEXT, "-",  "FILE",  "where the system goes", &o.out},
  {NULL, 0, OPT_FLAG, NULL, NULL, NULL, NULL}};

static const OptProgram PROGRAM = {
  "collide", "put two bodies on a collision orbit", "[options] target.h5 impactor.h5 > impact.h5",
  "Contact, of two spheres of these radii, is at t = 0; the file's time is negative. The frame is that of the common centre of "
  "mass. A spin turns its body: obliquity of its pole to the orbit's, node of its equator from the line of contact.",
  "collide --angle 48deg --speed 1.7vesc --distance 12 target.h5 impactor.h5 > impact.h5", OPTS, 2, 2};
/* clang-format on */

/* What only one of the bodies has becomes zero in the other: worth a line. */
static void warn_of_gaps(const Body b[2])
{
  char names[512];
  for (int k = 0; k < 2; k++) {
    size_t used = 0;
    names[0] = 0;
    for (const PartField *f = part_fields; f < part_fields + part_field_count; f++)
      if (part_array(b[k].p, f) && !part_array(b[1 - k].p, f) && used < sizeof names)
        used +=
            (size_t)snprintf(names + used, sizeof names - used, "%s%s", used ? ", " : "", f->name);
    if (used) err_warn("'%s' lacks what '%s' has: zeros for %s", b[1 - k].file, b[k].file, names);
    if (b[k].p->nflaw && !b[1 - k].p->nflaw)
      err_warn("'%s' has flaws, '%s' has none (made by weibull)", b[k].file, b[1 - k].file);
  }
}

/* Each body at its place about the common centre of mass, under its number; the ids of the second
 * go past those of the first where some are equal. */
static int64_t place(Body b[2], const Geometry *g, Err *err)
{
  const double mass = b[0].g.mass + b[1].g.mass;
  int64_t shift = body_free_ids(&b[0], &b[1], err);
  if (shift < 0 || body_rename(&b[0], err)) return -1;
  b[1].first = b[0].bodies;
  if (body_rename(&b[1], err)) return -1;
  for (int k = 0; k < 2; k++) {
    double share = k ? b[0].g.mass / mass : -b[1].g.mass / mass, x[3], v[3];
    for (int a = 0; a < 3; a++) x[a] = share * g->x[a], v[a] = share * g->v[a];
    body_move(&b[k], x, v);
  }
  for (long i = 0; i < b[1].p->n; i++) b[1].p->id[i] += shift;
  return shift;
}

static void write(const Body b[2], const Geometry *g, const Report *r, const char *line)
{
  Err err;
  Parts *p;
  warn_of_gaps(b);
  if (!(p = part_join(b[0].p, b[1].p, &err))) err_die("%s", err.text);
  p->time = g->a.t0;
  if (report_store(r, p, &err) || part_history(p, line, &err) || snap_write(p, o.out, 0, &err))
    err_die("%s", err.text);
  part_free(p);
}

static void check_bodies(const Body b[2])
{
  if (b[0].p->dimension != b[1].p->dimension)
    err_die("bodies of %d and %d dimensions", b[0].p->dimension, b[1].p->dimension);
  if (b->p->dimension == 2 && !o.in.no_gravity)
    err_die("'%s' is of dimension 2: only --no-gravity knows planes", b->file);
}

int main(int argc, char **argv)
{
  int n;
  char *line = opt_command_line(argc, argv), **input = opt_parse(&PROGRAM, argc, argv, &n);
  Body body[2];
  Spin spin[2] = {{0}};
  Geometry g;
  Report report;
  int64_t shift;
  Err err;
  geometry_check(&o.in);
  for (int k = 0; k < 2; k++)
    if (o.spin[k] && spin_parse(&spin[k], o.spin[k], &err)) err_usage("spin: %s", err.text);
  for (int k = 0; k < 2; k++)
    if (body_read(&body[k], input[k], o.select[k], o.radius[k], &err)) err_die("%s", err.text);
  check_bodies(body);
  if (geometry_find(&g, &o.in, body, &err)) err_die("%s", err.text);
  for (int k = 0; k < 2; k++)
    if (spin_apply(&spin[k], &body[k], &g, &err)) err_die("%s", err.text);
  if (geometry_apart(&g, body, &err) || (shift = place(body, &g, &err)) < 0)
    err_die("%s", err.text);
  report_collision(&report, &g, body);
  report_add(&report, "IdShift", "1", "added to the ids of the second body", (double)shift);
  if (o.verify && verify_contact(&g, body, &report, &err)) err_die("%s", err.text);
  if (o.dry)
    report_print(&report);
  else
    write(body, &g, &report, line);
  for (int k = 0; k < 2; k++) body_free(&body[k]);
  free(line);
  return 0;
}
