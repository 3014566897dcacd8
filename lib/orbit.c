/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "orbit.h"

/* Below this e an orbit has no direction to approach from: r0 - rc < 2e-6 rc anyway. */
static const double ROUND = 1e-6;

static Orbit conic(double mu, double beta, double h, double e)
{
  Orbit o = {.mu = mu, .beta = beta, .h = h, .e = e, .p = h * h / mu};
  o.rp = o.p / (1 + e);
  o.ra = beta > 0 ? (1 + e) * mu / beta : INFINITY;
  o.vinf = beta > 0 ? NAN : sqrt(-beta);
  return o;
}

Orbit orbit_of_state(double mu, const double r[3], const double v[3])
{
  double d = sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2]);
  double v2 = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
  double vr = (r[0] * v[0] + r[1] * v[1] + r[2] * v[2]) / d;
  double l[3] = {r[1] * v[2] - r[2] * v[1], r[2] * v[0] - r[0] * v[2], r[0] * v[1] - r[1] * v[0]};
  double h = sqrt(l[0] * l[0] + l[1] * l[1] + l[2] * l[2]), vt = h / d;
  /* e cos and e sin of the true anomaly */
  return conic(mu, 2 * mu / d - v2, h, hypot(d * vt * vt / mu - 1, h * vr / mu));
}

double orbit_speed_at_contact(double mu, double rc, double vinf)
{
  return sqrt(vinf * vinf + 2 * mu / rc);
}

/* c3(z) = (sqrt z - sin sqrt z)/z^(3/2), its hyperbolic form for z < 0, and the series between. */
static double stumpff3(double z)
{
  double q = sqrt(fabs(z));
  if (z > 1e-2) return (q - sin(q)) / (q * z);
  if (z < -1e-2) return (sinh(q) - q) / (-q * z);
  return (1 - z / 20 * (1 - z / 42 * (1 - z / 72 * (1 - z / 110)))) / 6;
}

double orbit_time(const Orbit *o, double r)
{
  double g = fmax(r - o->rp, 0) / (o->e * o->mu), b = o->beta * g, q = sqrt(fabs(o->beta)), s;
  if (b > 1e-12)
    s = 2 * asin(sqrt(fmin(b / 2, 1))) / q;
  else if (b < -1e-12)
    s = 2 * asinh(sqrt(-b / 2)) / q;
  else
    s = sqrt(2 * g); /* to b/12 < 1e-13 */
  return o->rp * s + o->e * o->mu * s * s * s * stumpff3(o->beta * s * s);
}

double orbit_anomaly(const Orbit *o, double r, double vr)
{
  return atan2(o->h * vr / o->mu, o->p / r - 1);
}

/* Position on the circle r0 for an anomaly difference d from contact, which is on +y. */
static void place(OrbitApproach *a, double d)
{
  a->x[0] = a->r0 * sin(d), a->x[1] = a->r0 * cos(d);
  a->v[0] = a->vr0 * sin(d) - a->vt0 * cos(d);
  a->v[1] = a->vr0 * cos(d) + a->vt0 * sin(d);
}

static void straight(OrbitApproach *a)
{
  double b = a->rc * sin(a->angle), along = sqrt(a->r0 * a->r0 - b * b);
  a->orbit = (Orbit){.beta = -a->vc * a->vc, .h = b * a->vc, .e = INFINITY, .p = INFINITY, .rp = b};
  a->orbit.ra = INFINITY, a->orbit.vinf = a->vc;
  a->v0 = a->vc, a->vr0 = -a->vc * along / a->r0, a->vt0 = a->orbit.h / a->r0;
  a->anomaly_c = -acos(sin(a->angle)), a->anomaly = -acos(b / a->r0);
  a->t0 = -(along - a->rc * cos(a->angle)) / a->vc;
  place(a, a->anomaly_c - a->anomaly);
}

static int curved(OrbitApproach *a, double mu, Err *err)
{
  double sine = sin(a->angle), cosine = cos(a->angle), k = a->rc * a->vc * a->vc / mu;
  double beta = 2 * mu / a->rc - a->vc * a->vc, e = hypot((k - 1) * sine, cosine);
  Orbit o = a->orbit = conic(mu, beta, a->rc * a->vc * sine, e);
  if (e < ROUND) return err_set(err, "the orbit is circular (e = %.3g): there is no approach", e);
  if (a->r0 > o.ra * (1 + 1e-12))
    return err_set(err, "distance %.6g m is beyond the apoapsis of the bound orbit, %.6g m", a->r0,
                   o.ra);
  a->v0 = sqrt(fmax(a->vc * a->vc + 2 * mu * (1 / a->r0 - 1 / a->rc), 0));
  a->vt0 = o.h / a->r0;
  a->vr0 = -sqrt(fmax(a->v0 * a->v0 - a->vt0 * a->vt0, 0));
  a->anomaly_c = orbit_anomaly(&o, a->rc, -a->vc * cosine);
  a->anomaly = orbit_anomaly(&o, a->r0, a->vr0);
  a->t0 = -(orbit_time(&o, a->r0) - orbit_time(&o, a->rc));
  place(a, a->anomaly_c - a->anomaly);
  return 0;
}

int orbit_approach(OrbitApproach *a, double mu, double rc, double vc, double angle, double r0,
                   Err *err)
{
  const double right = acos(0);
  *a = (OrbitApproach){.rc = rc, .vc = vc, .angle = angle, .r0 = r0, .vesc = sqrt(2 * mu / rc)};
  if (!(rc > 0 && isfinite(rc))) return err_set(err, "contact distance %g m is not positive", rc);
  if (!(vc > 0 && isfinite(vc))) return err_set(err, "speed at contact %g m/s is not positive", vc);
  if (!(mu >= 0 && isfinite(mu))) return err_set(err, "G (m1 + m2) = %g is negative", mu);
  if (!(angle >= 0 && angle <= right * (1 + 1e-15)))
    return err_set(err, "contact angle %g deg is not in 0..90", angle / right * 90);
  if (!(r0 >= rc && isfinite(r0)))
    return err_set(err,
                   "distance %.6g m is less than the contact distance %.6g m: the bodies overlap",
                   r0, rc);
  if (mu > 0) return curved(a, mu, err);
  straight(a);
  return 0;
}
