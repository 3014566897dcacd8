/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include "report.h"

void report_add(Report *r, const char *name, const char *unit, const char *meaning, double value)
{
  ReportRow *row = r->row + r->n++;
  if (r->n > (int)(sizeof r->row / sizeof *r->row)) err_die("too many numbers to report");
  *row = (ReportRow){.unit = unit, .meaning = meaning, .value = value + 0.}; /* -0 is 0 */
  snprintf(row->name, sizeof row->name, "%s", name);
}

/* NAMEX, NAMEY, NAMEZ; NAMEVx ... for a name that ends in V. */
static void add_vector(Report *r, const char *name, const char *unit, const char *meaning,
                       const double v[3])
{
  const char *axes = name[strlen(name) - 1] == 'V' ? "xyz" : "XYZ";
  char whole[64];
  for (int k = 0; k < 3; k++) {
    snprintf(whole, sizeof whole, "%s%c", name, axes[k]);
    report_add(r, whole, unit, meaning, v[k]);
  }
}

/* Share of the impactor's mass in the path of the target (Leinhardt & Stewart 2012, eq. 9-11). */
static double interacting_share(const Geometry *g, double r)
{
  double l = g->a.rc * (1 - sin(g->a.angle));
  return l >= 2 * r ? 1 : (3 * r * l * l - l * l * l) / (4 * r * r * r);
}

static void add_bodies(Report *r, const Body b[2])
{
  const double mass = b[0].g.mass + b[1].g.mass;
  report_add(r, "MassTarget", "kg", "particles of the first body", b[0].g.mass);
  report_add(r, "MassImpactor", "kg", "particles of the second body", b[1].g.mass);
  report_add(r, "MassFractionImpactor", "1", "of the total mass", b[1].g.mass / mass);
  report_add(r, "RadiusTarget", "m", b[0].source, b[0].radius);
  report_add(r, "RadiusImpactor", "m", b[1].source, b[1].radius);
  report_add(r, "FirstBodyImpactor", "1", "BodyIDs below are the target's", b[1].first);
}

static void add_contact(Report *r, const Geometry *g, const Body b[2])
{
  const OrbitApproach *a = &g->a;
  const double mass = b[0].g.mass + b[1].g.mass;
  report_add(r, "ContactDistance", "m", "r1 + r2", a->rc);
  report_add(r, "EscapeSpeed", "m/s", "mutual, at contact", a->vesc);
  report_add(r, "ContactSpeed", "m/s", "at contact", a->vc);
  report_add(r, "ContactSpeedRatio", "1", "in escape speeds", a->vc / a->vesc);
  report_add(r, "ContactAngle", "rad", "0 is head-on", a->angle);
  report_add(r, "ImpactParameter", "1", "sine of the angle, in r1 + r2", sin(a->angle));
  report_add(r, "ContactTime", "s", "by definition", 0);
  add_vector(r, "Contact", "1", "direction from body 0 to body 1 at contact", g->e[1]);
  add_vector(r, "Pole", "1", "direction of the orbital angular momentum", g->e[2]);
  report_add(r, "CollisionTime", "s", "2 (r1 + r2)/v_c", 2 * a->rc / a->vc);
  report_add(r, "SpecificImpactEnergy", "J/kg", "m_red v_c^2/(2 M)",
             g->reduced * a->vc * a->vc / (2 * mass));
  if (b->p->dimension == 3)
    report_add(r, "InteractingMass", "kg", "of the impactor, in the path of the target",
               interacting_share(g, b[1].radius) * b[1].g.mass);
}

static void add_orbit(Report *r, const Geometry *g)
{
  const OrbitApproach *a = &g->a;
  report_add(r, "SpeedAtInfinity", "m/s", "nan when bound", a->orbit.vinf);
  report_add(r, "Eccentricity", "1", "inf without gravity", a->orbit.e);
  report_add(r, "Periapsis", "m", "of the points' orbit", a->orbit.rp);
  report_add(r, "Apoapsis", "m", "inf when unbound", a->orbit.ra);
  report_add(r, "SemiMajorAxis", "m", "negative when unbound",
             a->orbit.mu > 0 ? a->orbit.mu / a->orbit.beta : NAN);
  report_add(r, "OrbitalPeriod", "s", "inf when unbound", a->orbit.period);
  report_add(r, "AnomalyAtContact", "rad", "true anomaly, inbound < 0", a->anomaly_c);
  report_add(r, "AnomalyAtStart", "rad", "true anomaly, inbound < 0", a->anomaly);
  report_add(r, "InitialDistance", "m", "of the centres", a->r0);
  report_add(r, "InitialTime", "s", "contact is at 0", a->t0);
  report_add(r, "InitialSpeed", "m/s", "relative", a->v0);
  add_vector(r, "Initial", "m", "of body 1 relative to body 0", g->x);
  add_vector(r, "InitialV", "m/s", "of body 1 relative to body 0", g->v);
}

static double angle_between(const double a[3], const double b[3])
{
  double c[3], dot = 0, cross2 = 0;
  for (int k = 0; k < 3; k++) {
    int i = (k + 1) % 3, j = (k + 2) % 3;
    c[k] = a[i] * b[j] - a[j] * b[i], dot += a[k] * b[k], cross2 += c[k] * c[k];
  }
  return atan2(sqrt(cross2), dot);
}

static void add_spins(Report *r, const Geometry *g, const Body b[2])
{
  static const char *const who[] = {"Target", "Impactor"};
  double orbital = g->reduced * g->a.orbit.h, total[3], size = 0;
  char name[64];
  for (int k = 0; k < 3; k++) total[k] = orbital * g->e[2][k] + b[0].g.l[k] + b[1].g.l[k];
  for (int k = 0; k < 3; k++) size += total[k] * total[k];
  report_add(r, "AngularMomentum", "kg m^2/s", "orbital, about the centre of mass", orbital);
  for (int k = 0; k < 2; k++) {
    const Group *o = &b[k].g;
    snprintf(name, sizeof name, "SpinPeriod%s", who[k]);
    report_add(r, name, "s", "2 pi/omega, omega = I^-1 L", o->period);
    snprintf(name, sizeof name, "Obliquity%s", who[k]);
    report_add(r, name, "rad", "of the spin to the orbit's pole",
               isfinite(o->period) ? angle_between(o->omega, g->e[2]) : NAN);
    snprintf(name, sizeof name, "Spin%s", who[k]);
    add_vector(r, name, "rad/s", "rotation", o->omega);
    snprintf(name, sizeof name, "AngularMomentum%s", who[k]);
    add_vector(r, name, "kg m^2/s", "about its own centre", o->l);
  }
  report_add(r, "TotalAngularMomentum", "kg m^2/s", "of orbit and spins", sqrt(size));
  add_vector(r, "TotalAngularMomentum", "kg m^2/s", "of orbit and spins", total);
}

void report_collision(Report *r, const Geometry *g, const Body b[2])
{
  r->n = 0;
  add_bodies(r, b), add_contact(r, g, b), add_orbit(r, g), add_spins(r, g, b);
}

void report_print(const Report *r)
{
  printf("# quantity\tvalue\tunit\tmeaning\n");
  for (const ReportRow *row = r->row; row < r->row + r->n; row++) {
    int angle = !strcmp(row->unit, "rad");
    printf("%s\t%.12g\t%s\t%s\n", row->name, angle ? row->value * 90 / acos(0) : row->value,
           angle ? "deg" : row->unit, row->meaning);
  }
  err_close_stdout();
}

int report_store(const Report *r, Parts *p, Err *err)
{
  for (const ReportRow *row = r->row; row < r->row + r->n; row++)
    if (isfinite(row->value) && part_set_number(p, "collision", row->name, row->value, err))
      return -1;
  return 0;
}
