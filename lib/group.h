/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is known of a set of particles, a fragment, a bound body, a whole system: mass, centre,
 * motion, size, spin, energies, damage, composition by material and by body of origin. Shared by
 * fof, clumps and disk: one table of columns. All sums run in the order of the list given, and
 * group_lists gives ascending particle ids, so results do not depend on the file's order. */
#ifndef GROUP_H
#define GROUP_H

#include <stdio.h>
#include "orbit.h"
#include "part.h"

enum { GROUP_BODIES = 1024, GROUP_PHASES = 8 };

typedef struct {
  long n, points;                        /* rows; how many of these are point masses */
  double pointed;                        /* and what they weigh, kg */
  double mass, x[3], v[3];               /* kg; centre of mass m, m/s */
  double volume, rho, rho_mean, rho_max; /* sum m/rho m^3; mass/volume, mean over mass, largest
                                            kg/m^3 */
  double peak_mean,
      peak_max;         /* largest pressure so far: mean over mass, largest Pa; NAN without the
                                 field */
  double T_mean, T_max; /* mean over mass, largest K; NAN without the field */
  double phase[GROUP_PHASES]; /* kg with PhaseID 0, 1 ..., as eos fill has it */
  double radius, r50, r90,
      r99; /* of the sphere of this volume; around the centre with 50, 90, 99 % of the mass, m */
  double l[3];                  /* angular momentum about the own centre, kg m^2/s */
  double inertia[6];            /* sum m (r^2 delta_ab - r_a r_b), xx xy xz yy yz zz, kg m^2 */
  double moment[3], axis[3][3]; /* principal moments, ascending, and their directions (rows) */
  double omega[3], period;      /* I^-1 L rad/s; 2 pi/omega s, infinite without spin */
  double e_kin, e_th, e_pot;    /* in the own frame; sum m u; own gravity, pairs counted once, J */
  double e_rot;                 /* 1/2 L . omega, J */
  double damage,
      damaged;  /* mass-weighted mean; mass fraction with damage 1; NAN without the field */
  double water; /* mass fraction of materials named ice, water or h2o (group_is_water) */
  int bodies;
  double *part; /* [materials][bodies] mass, kg */
} Group;

/* Two bodies, seen as points: distance m, speed, radial speed (negative when they approach), mutual
 * escape speed m/s, and the conic; they are bound when orbit.beta > 0. */
typedef struct {
  double r, v, v_r, v_esc;
  Orbit orbit;
} GroupPair;

/* What a group moves about, as a point: m, m/s, kg; the direction that inclinations refer to. */
typedef struct {
  double x[3], v[3], mass, axis[3];
} GroupCentre;

/* GROUP_FIELDS: what group_measure needs; GROUP_MORE: what it shows when it is there. */
#define GROUP_FIELDS "id x v m rho u h mat body"
#define GROUP_MORE   " damage pmax T PhaseID"

/* group_named: the particles that "body:0", "fragment:2" or "clump:1" means: those with
 * (*id)[i] == *which. Errors: another word, no number, the field is missing in `file`, none of them
 * there. */
int group_named(const Parts *p, const char *text, const char *file, const int32_t **id,
                int32_t *which, Err *err);

/* group_order: all particles by ascending id, order [n]. */
int group_order(const Parts *p, long *order, Err *err);

/* group_rank: renumbers the groups id [p->n] = 1..groups (0: none) by descending mass, equal masses
 * by their lowest particle id; those with fewer than `least` particles and no point mass become 0.
 * Returns how many are left, or -1. */
long group_rank(const Parts *p, int32_t *id, long groups, long least, Err *err);

/* group_heavy: drops those lighter than mass [kg] of groups ranked as group_rank does (id becomes
 * 0); returns how many are left, or -1. */
long group_heavy(const Parts *p, int32_t *id, long groups, double mass, Err *err);

/* group_lists: particles with id[i] = k in 1..groups are list[start[k] .. start[k+1]-1], by
 * ascending particle id; malloc'ed. */
int group_lists(const Parts *p, const int32_t *id, long groups, long **start, long **list,
                Err *err);

/* group_measure: all of the above for list [n]; *g need not be set before and is released by
 * group_free. phi [p->n] J/kg, of the particles: the potential that the set makes itself; NULL:
 * found with the tree's opening angle theta, unless that is < 0: e_pot is left NAN. */
int group_measure(Group *g, const Parts *p, const long *list, long n, int bodies, double theta,
                  const double *phi, Err *err);
void group_free(Group *g);

/* group_all: the same for the groups id [p->n] = 1..groups, malloc'ed [groups]. group_all_free
 * releases them. */
Group *group_all(const Parts *p, const int32_t *id, long groups, int bodies, double theta,
                 const double *phi, Err *err);
void group_all_free(Group *g, long groups);

/* group_system: the same for all particles, by ascending id. */
int group_system(Group *g, const Parts *p, double theta, Err *err);

/* group_apart: |a - b|. */
double group_apart(const double a[3], const double b[3]);

/* group_pair: the two-body orbit of b about a. */
GroupPair group_pair(const double xa[3], const double va[3], double ma, const double xb[3],
                     const double vb[3], double mb);

/* group_centre: a group, and its own spin. group_rest: the whole system without the group, and the
 * system's angular momentum. */
GroupCentre group_centre(const Group *g);
GroupCentre group_rest(const Group *system, const Group *g);

/* group_roche: Roche limit 2.4554 (3 M/(4 pi rho))^(1/3) [m] of a fluid satellite of density rho
 * [kg/m^3] about a mass [kg]: 2.4554 R (rho_M/rho)^(1/3). Source: Chandrasekhar (1969), Ellipsoidal
 * Figures of Equilibrium. */
double group_roche(double mass, double rho);

/* group_bodies: 1 + the largest BodyID, which must lie in 0..GROUP_BODIES-1; else -1. */
int group_bodies(const Parts *p, Err *err);

/* group_is_water: whether a part of the name (between _ - or .) is ice, water or h2o. */
int group_is_water(const char *material);

/* group_header, group_row: tab-separated columns, each with a tab in front, no newline; positions
 * and velocities relative to `system`. `name [unit]` is the name of a column. */
void group_header(FILE *f, const Parts *p, int bodies);
void group_row(FILE *f, const Group *g, const Group *system, const Parts *p);

/* group_orbit_header, group_orbit_row: the same for the two-body orbit of g about c, `about` at the
 * end of the names: e, a (< 0 unbound), peri, apo, incl deg, v_inf, roche; nan where c has no mass,
 * as of a group without a rest. */
void group_orbit_header(FILE *f, const char *about);
void group_orbit_row(FILE *f, const Group *g, const GroupCentre *c);

#endif
