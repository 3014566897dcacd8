/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Two bodies as points: conics of every kind, head-on ones included, by formulas that have one
 * branch, and the approach to a contact given by angle and speed or by a state. Without gravity
 * (mu = 0) the same on straight lines. Sources: docs/theory.md 7 (corrects 004 eq. 2.85-2.104);
 * universal variables with Stumpff's functions (Danby, Fundamentals of Celestial Mechanics,
 * sect. 6.9). */
#ifndef ORBIT_H
#define ORBIT_H

#include "err.h"

/* The relative orbit. beta = 2 mu/r - v^2 = mu/a = -v_inf^2: > 0 bound, 0 parabola, < 0 hyperbola.
 */
typedef struct {
  double mu;     /* G (m1 + m2) [m^3/s^2] */
  double beta;   /* [m^2/s^2] */
  double h;      /* specific angular momentum [m^2/s] */
  double e;      /* eccentricity; INFINITY without gravity */
  double p;      /* semi-latus rectum h^2/mu [m]; INFINITY without gravity */
  double rp;     /* periapsis [m] */
  double ra;     /* apoapsis [m]; INFINITY when unbound */
  double vinf;   /* speed at infinity [m/s]; NAN when bound */
  double period; /* [s]; INFINITY when unbound */
} Orbit;

/* An approach from the distance r0 to contact, which happens at t = 0. In the plane of the orbit
 * contact is on +y and L_z > 0. */
typedef struct {
  Orbit orbit;
  double rc, vc,
      angle;   /* contact: distance [m], speed [m/s], angle between -v and r [rad], 0 is head-on */
  double vesc; /* sqrt(2 mu/rc) [m/s] */
  double r0, v0, vr0, vt0; /* start: distance [m], speed, radial (< 0) and tangential speed [m/s] */
  double anomaly_c, anomaly; /* true anomalies at contact and at the start, inbound < 0 [rad] */
  double x[2], v[2];         /* second body relative to the first at the start [m, m/s] */
  double t0;                 /* time of the start, <= 0 [s] */
} OrbitApproach;

/* orbit_of_state: the orbit through relative position r [m] and velocity v [m/s]; mu >= 0, |r| > 0.
 */
Orbit orbit_of_state(double mu, const double r[3], const double v[3]);

/* orbit_speed_at_contact: contact speed [m/s] for a speed at infinity [m/s] >= 0 (mu = 0: the
 * same). */
double orbit_speed_at_contact(double mu, double rc, double vinf);

/* orbit_time: time from periapsis to the distance r, rp <= r <= ra [s]; e > 0. */
double orbit_time(const Orbit *o, double r);

/* orbit_anomaly: true anomaly at distance r with radial speed vr, in -pi..pi, negative inbound
 * [rad]; mu > 0. */
double orbit_anomaly(const Orbit *o, double r, double vr);

/* orbit_approach: fills *a for contact distance rc > 0, speed vc > 0, angle in 0..pi/2 and start
 * distance r0. mu = 0: a straight line. Errors: r0 < rc (the bodies overlap), r0 beyond the
 * apoapsis, an orbit too round to approach on. */
int orbit_approach(OrbitApproach *a, double mu, double rc, double vc, double angle, double r0,
                   Err *err);

/* orbit_approach_time: the same with the time from start to contact [s] >= 0; when the orbit is
 * bound, at most what it takes from the apoapsis. */
int orbit_approach_time(OrbitApproach *a, double mu, double rc, double vc, double angle,
                        double time, Err *err);

/* orbit_approach_state: the approach that starts with relative position r [m] and velocity v [m/s],
 * and where in space it ends: unit vectors to the point of contact and along the angular momentum
 * (head-on: some direction across). The start may be outbound when the orbit is bound. Errors: as
 * above; the points pass each other or move apart. */
int orbit_approach_state(OrbitApproach *a, double mu, double rc, const double r[3],
                         const double v[3], double contact[3], double pole[3], Err *err);

#endif
