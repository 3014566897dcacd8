/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A body and what goes around it: every particle by its two-body orbit about the body. Two ways to
 * say where the body ends. reufer (004 sect. 2.4.7): a sphere through its surface, the light
 * particles among the deepest of its potential. canup (after Canup, Ward & Cameron 2001): a
 * rotating planet of the same mean density, flattened, that keeps what cannot stay outside its
 * equator; equator, mass and orbits are found together. Classes: docs/theory.md 8.3. */
#ifndef DISK_H
#define DISK_H

#include "orbit.h"
#include "part.h"

typedef enum {
  DISK_NONE,
  DISK_BODY,
  DISK_DISK,
  DISK_REIMPACT,
  DISK_FLYBY,
  DISK_ESCAPE,
  DISK_CLASSES
} DiskClass;

typedef struct {
  int canup;           /* method: 0 reufer, 1 canup */
  int enclosed;        /* orbits feel all mass nearer than the particle, not the body's alone */
  const double *floor; /* reufer: [materials] kg/m^3, lighter particles are surface */
  double theta;        /* reufer: opening angle of the tree */
} DiskOptions;

typedef struct {
  double x[3], v[3], mass; /* of what is inside: m, m/s, kg */
  double radius;           /* where it ends: of the sphere, or of the equator [m] */
  double equator;          /* equatorial radius [m] */
  double flattening;       /* 1 - polar/equatorial radius, from its spin */
  double omega[3];         /* rad/s */
  double rho;              /* mass over the sum of m/rho [kg/m^3] */
} DiskBody;

/* disk_classify: the class of a particle at r [m], v [m/s] relative to the body, mu = G (M + m)
 * [m^3/s^2]; canup: circularised inside the equator (h^2/mu <= radius) is body too. *o: its orbit
 * (not set in the body). */
DiskClass disk_classify(int canup, double radius, double mu, const double r[3], const double v[3],
                        Orbit *o);

/* disk_find: the body that the particles list [n] (ascending ids) hold, and the class [p->n] of all
 * particles. Needs id x v m rho h mat. -1: no memory, no surface (no light particles: canup needs
 * none), spin beyond break-up. */
int disk_find(const Parts *p, const long *list, long n, const DiskOptions *o, int32_t *class,
              DiskBody *b, Err *err);

/* disk_mu: G (M + m) for particle i about the body; within [p->n] or NULL: mass inside its distance
 * [kg], which then counts instead of M if it is more. disk_enclosed makes it; malloc'ed. */
double disk_mu(const Parts *p, long i, const DiskBody *b, const double *within);
double *disk_enclosed(const Parts *p, const double x[3], Err *err);

/* disk_orbit: the orbit of particle i about the body. */
Orbit disk_orbit(const Parts *p, long i, const DiskBody *b, const double *within);

/* disk_flattening: of a planet in hydrostatic equilibrium that spins with omega [rad/s], with mass
 * [kg] and equatorial radius [m]: f = 5/2 q/(1 + (5/2 - 15/4 K)^2), q = omega^2 R^3/(G M), K =
 * C/(M R^2) = 0.335 (Radau-Darwin). */
double disk_flattening(double omega, double mass, double radius);

extern const char *const disk_names[DISK_CLASSES];

#endif
