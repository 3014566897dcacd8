/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A point of an orbit is known by its universal variable s, ds = dt/r from periapsis, inbound < 0
 * (without gravity: the path along the line). Start and contact are both made from their s, so that
 * they agree with each other to rounding even near an apsis, where r hardly depends on time. */
#include <math.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_roots.h>
#include "orbit.h"

/* Below this e an orbit has no direction to approach from: r0 - rc < 2e-6 rc anyway. */
static const double ROUND = 1e-6;

static double dot(const double a[3], const double b[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double c[3])
{
  for (int k = 0; k < 3; k++) {
    int i = (k + 1) % 3, j = (k + 2) % 3;
    c[k] = a[i] * b[j] - a[j] * b[i];
  }
}

static Orbit conic(double mu, double beta, double h, double e)
{
  Orbit o = {.mu = mu, .beta = beta, .h = h, .e = e, .p = h * h / mu, .rp = h * h / mu / (1 + e)};
  if (mu == 0) o.e = o.p = INFINITY, o.rp = beta < 0 ? h / sqrt(-beta) : NAN;
  o.ra = beta > 0 ? (1 + e) * mu / beta : INFINITY;
  o.vinf = beta > 0 ? NAN : sqrt(-beta);
  o.period = beta > 0 ? 4 * acos(0) * mu / (beta * sqrt(beta)) : INFINITY;
  return o;
}

Orbit orbit_of_state(double mu, const double r[3], const double v[3])
{
  double d = sqrt(dot(r, r)), l[3], h;
  cross(r, v, l);
  h = sqrt(dot(l, l));
  /* e cos and e sin of the true anomaly */
  return conic(mu, 2 * mu / d - dot(v, v), h,
               hypot(h * h / (d * mu) - 1, h * dot(r, v) / (d * mu)));
}

double orbit_speed_at_contact(double mu, double rc, double vinf)
{
  return sqrt(vinf * vinf + 2 * mu / rc);
}

/* Stumpff's c_0..c_3, c_k(z) = 1/k! - z/(k+2)! + z^2/(k+4)! ..., z = q^2 (or -q^2). */
static void stumpff(double z, double c[4])
{
  double q = sqrt(fabs(z));
  double sine = z < 0 ? sinh(q) : sin(q), half = z < 0 ? sinh(q / 2) : sin(q / 2);
  c[3] = 1. / 6;
  if (fabs(z) > 1)
    c[3] = (q - sine) / (q * z);
  else
    for (double term = c[3], k = 4; fabs(term) > 1e-17; k += 2)
      term *= -z / (k * (k + 1)), c[3] += term;
  c[2] = z == 0 ? 0.5 : 2 * half * half / fabs(z);
  c[1] = z == 0 ? 1 : sine / q;
  c[0] = 1 - z * c[2];
}

/* A point of the orbit; x, v in its plane with periapsis on +x and the motion towards +y. */
typedef struct {
  double t, r, vr, vt, x[2], v[2];
} Point;

static Point point(const Orbit *o, double s)
{
  double c[4], k = o->e * o->mu, ss = s * s;
  Point q;
  if (o->mu == 0) {
    q = (Point){.t = s / o->vinf, .r = hypot(s, o->rp), .x = {o->rp, s}, .v = {0, o->vinf}};
    q.vr = o->vinf * s / q.r, q.vt = o->h / q.r;
    return q;
  }
  stumpff(o->beta * ss, c);
  q.r = o->rp + k * ss * c[2];
  q.t = s * (o->rp + k * ss * c[3]);
  q.vr = k * s * c[1] / q.r, q.vt = o->h / q.r;
  q.x[0] = o->rp - o->mu * ss * c[2], q.x[1] = o->h * s * c[1];
  q.v[0] = -o->mu * s * c[1] / q.r, q.v[1] = o->h * c[0] / q.r;
  return q;
}

/* s >= 0 at the distance r: the half-angle form of the conic's equation. */
static double at_distance(const Orbit *o, double r)
{
  double g = fmax(r - o->rp, 0) / (o->e * o->mu), q = sqrt(fabs(o->beta));
  if (o->mu == 0) return sqrt(fmax(r * r - o->rp * o->rp, 0));
  if (o->beta == 0) return sqrt(2 * g);
  return 2 / q * (o->beta > 0 ? asin(fmin(q * sqrt(g / 2), 1)) : asinh(q * sqrt(g / 2)));
}

/* s where distance and radial speed are these: well defined at an apsis too. */
static double at_state(const Orbit *o, double r, double vr)
{
  double q = sqrt(fabs(o->beta));
  if (o->mu == 0) return r * vr / o->vinf;
  if (o->beta == 0) return r * vr / o->mu;
  return o->beta > 0 ? atan2(q * r * vr / o->mu, 1 - r * o->beta / o->mu) / q
                     : asinh(q * r * vr / (o->e * o->mu)) / q;
}

typedef struct {
  const Orbit *orbit;
  double t;
} Wanted;

static double lateness(double s, void *wanted)
{
  const Wanted *w = wanted;
  return point(w->orbit, s).t - w->t;
}

/* s at the time t before sc, where r = rc is least. The bracket grows from there to earlier times,
 * to the apoapsis at most. */
static double at_time(const Orbit *o, double t, double sc, double rc)
{
  Wanted wanted = {o, t};
  double tc = point(o, sc).t, least = o->beta > 0 ? -2 * acos(0) / sqrt(o->beta) : -INFINITY;
  double step = 1e-3 * (tc - t) / rc, low = sc, high, s;
  if (o->mu == 0) return t * o->vinf;
  if (!(t < tc)) return sc;
  do high = low, low = fmax(low - step, least), step *= 2;
  while (low > least && lateness(low, &wanted) > 0);
  if (lateness(low, &wanted) >= 0) return low;
  gsl_function f = {lateness, &wanted};
  gsl_root_fsolver *solver = gsl_root_fsolver_alloc(gsl_root_fsolver_brent);
  if (!solver) return NAN;
  gsl_root_fsolver_set(solver, &f, low, high);
  for (int k = 0; k < 200 && high - low > 1e-15 * fabs(low); k++) {
    if (gsl_root_fsolver_iterate(solver)) break;
    low = gsl_root_fsolver_x_lower(solver), high = gsl_root_fsolver_x_upper(solver);
  }
  s = gsl_root_fsolver_root(solver);
  gsl_root_fsolver_free(solver);
  return s;
}

double orbit_time(const Orbit *o, double r) { return point(o, at_distance(o, r)).t; }

double orbit_anomaly(const Orbit *o, double r, double vr)
{
  return atan2(o->h * vr / o->mu, o->p / r - 1);
}

/* The start at s, turned such that contact, at sc, is on +y. */
static void start(OrbitApproach *a, double s, double sc)
{
  Point c = point(&a->orbit, sc), q = point(&a->orbit, s);
  double x = c.x[0] / c.r, y = c.x[1] / c.r;
  a->r0 = q.r, a->vr0 = q.vr, a->vt0 = q.vt, a->v0 = hypot(q.vr, q.vt);
  a->anomaly_c = atan2(c.x[1], c.x[0]), a->anomaly = atan2(q.x[1], q.x[0]);
  a->x[0] = q.x[0] * y - q.x[1] * x, a->x[1] = q.x[0] * x + q.x[1] * y;
  a->v[0] = q.v[0] * y - q.v[1] * x, a->v[1] = q.v[0] * x + q.v[1] * y;
  a->t0 = q.t - c.t;
  if (s > sc) a->t0 -= a->orbit.period; /* outbound: round by the apoapsis */
}

/* The orbit through a contact; s of it, or NAN. */
static double contact(OrbitApproach *a, double mu, double rc, double vc, double angle, Err *err)
{
  const double right = acos(0), sine = sin(angle), cosine = cos(angle), k = rc * vc * vc / mu;
  *a = (OrbitApproach){.rc = rc, .vc = vc, .angle = angle, .vesc = sqrt(2 * mu / rc)};
  if (!(rc > 0 && isfinite(rc)))
    return err_set(err, "contact distance %g m is not positive", rc), NAN;
  if (!(vc > 0 && isfinite(vc)))
    return err_set(err, "speed at contact %g m/s is not positive", vc), NAN;
  if (!(mu >= 0 && isfinite(mu))) return err_set(err, "G (m1 + m2) = %g is negative", mu), NAN;
  if (!(angle >= 0 && angle <= right * (1 + 1e-15)))
    return err_set(err, "contact angle %g deg is not in 0..90", angle / right * 90), NAN;
  a->orbit = conic(mu, 2 * mu / rc - vc * vc, rc * vc * sine, hypot((k - 1) * sine, cosine));
  if (a->orbit.e < ROUND)
    return err_set(err, "the orbit is circular (e = %.3g): there is no approach", a->orbit.e), NAN;
  return fmin(at_state(&a->orbit, rc, -vc * cosine), 0);
}

int orbit_approach(OrbitApproach *a, double mu, double rc, double vc, double angle, double r0,
                   Err *err)
{
  double sc = contact(a, mu, rc, vc, angle, err);
  if (isnan(sc)) return -1;
  if (!(r0 >= rc && isfinite(r0)))
    return err_set(err,
                   "distance %.6g m is less than the contact distance %.6g m: the bodies overlap",
                   r0, rc);
  if (r0 > a->orbit.ra * (1 + 1e-12))
    return err_set(err, "distance %.6g m is beyond the apoapsis of the bound orbit, %.6g m", r0,
                   a->orbit.ra);
  start(a, fmin(-at_distance(&a->orbit, r0), sc), sc);
  return 0;
}

int orbit_approach_time(OrbitApproach *a, double mu, double rc, double vc, double angle,
                        double time, Err *err)
{
  double sc = contact(a, mu, rc, vc, angle, err), tc = point(&a->orbit, sc).t;
  if (isnan(sc)) return -1;
  if (!(time >= 0 && isfinite(time)))
    return err_set(err, "time before contact %g s is negative", time);
  if (tc - time < -a->orbit.period / 2 * (1 + 1e-12))
    return err_set(err,
                   "%.6g s before contact: the bound orbit is at its apoapsis %.6g s before it",
                   time, tc + a->orbit.period / 2);
  start(a, at_time(&a->orbit, tc - time, sc, rc), sc);
  return 0;
}

/* From the position at angle `from` of the orbit's plane to that at angle `to`. */
static void turn(const double r[3], double d, const double pole[3], double from, double to,
                 double out[3])
{
  double across[3], c = cos(to - from), s = sin(to - from);
  cross(pole, r, across);
  for (int k = 0; k < 3; k++) out[k] = (c * r[k] + s * across[k]) / d;
}

/* A unit vector across r. */
static void some_pole(const double r[3], double pole[3])
{
  double axis[3] = {0, 0, 0}, length;
  int least = 2; /* z, when r is in the plane of x and y */
  for (int k = 1; k >= 0; k--)
    if (fabs(r[k]) < fabs(r[least])) least = k;
  axis[least] = 1;
  for (int k = 0; k < 3; k++) pole[k] = axis[k] - r[k] * r[least] / dot(r, r);
  length = sqrt(dot(pole, pole));
  for (int k = 0; k < 3; k++) pole[k] /= length;
}

int orbit_approach_state(OrbitApproach *a, double mu, double rc, const double r[3],
                         const double v[3], double to[3], double pole[3], Err *err)
{
  Orbit o = orbit_of_state(mu, r, v);
  double d = sqrt(dot(r, r)), vr = dot(r, v) / d, v2 = 2 * mu / rc - o.beta, vt = o.h / rc, sc;
  if (!(mu >= 0 && rc > 0 && isfinite(d) && isfinite(dot(v, v))))
    return err_set(err, "the state is no orbit");
  if (!(d >= rc))
    return err_set(
        err, "distance %.6g m is less than the contact distance %.6g m: the bodies overlap", d, rc);
  if (vr >= 0 && !(o.beta > 0)) return err_set(err, "the bodies move apart and do not come back");
  if (v2 < vt * vt || o.ra < rc)
    return err_set(err, "the points pass each other at %.6g m, r1 + r2 is %.6g m: no contact", o.rp,
                   rc);
  sc = contact(a, mu, rc, sqrt(v2), atan2(vt, sqrt(v2 - vt * vt)), err);
  if (isnan(sc)) return -1;
  cross(r, v, pole);
  for (int k = 0; k < 3; k++) pole[k] /= o.h;
  if (o.h <= 1e-15 * d * sqrt(dot(v, v))) some_pole(r, pole);
  start(a, at_state(&a->orbit, d, vr), sc);
  turn(r, d, pole, a->anomaly, a->anomaly_c, to);
  return 0;
}
