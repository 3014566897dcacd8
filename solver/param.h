/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The settings of a run: one table of rows, from which come run.cfg, --set key=value, /Parameters
 * and docs/run.md. */
#ifndef PARAM_H
#define PARAM_H

#include <stdio.h>
#include "../lib/cfg.h"
#include "../lib/part.h"

enum { PARAM_CONTINUITY, PARAM_SUM, PARAM_MISCIBLE, PARAM_MISCIBLE_CONTINUITY };
enum { PARAM_SQUARES, PARAM_PRODUCT };
enum { PARAM_FIXED, PARAM_DENSITY, PARAM_NEIGHBOURS, PARAM_OVERCORRECTED };
enum { PARAM_NONE, PARAM_TREE, PARAM_DIRECT };
enum { PARAM_FULL, PARAM_ISENTROPIC, PARAM_FROZEN };
enum { PARAM_MIXED, PARAM_DOUBLE };
enum {
  PARAM_OPEN,
  PARAM_PERIODIC,
  PARAM_MIRROR,
  PARAM_MIRROR_LOW,
  PARAM_MIRROR_HIGH,
  PARAM_NO_SLIP,
  PARAM_NO_SLIP_LOW,
  PARAM_NO_SLIP_HIGH
};
enum { PARAM_CENTRE, PARAM_ORIGIN, PARAM_POINT, PARAM_DEEPEST };

enum { PARAM_POINTS = 32 };

typedef struct {
  int integrator, kernel, precision, density, pressure, energy, strength, damage;
  double energy_floor, density_floor, pressure_floor, outer_pressure;
  int gravity, gravity_every, softening;
  double theta, G, gravity_tolerance, epsilon;
  double alpha, beta;
  int viscosity_switch, balsara;
  double viscosity_least;
  int stress_form, stress_exponent, gradient_raw, shepard, grad_h;
  double eta; /* of grad_h: h over (m/rho)^(1/D), made from the others */
  double xsph, diffusion, artificial, spacing;
  double shear, bulk, shakura, aspect, compression;
  double force[3];
  int disk_point;
  double deposit, deposit_centre[3], deposit_radius, deposit_begin, deposit_end;
  int deposit_profile, deposit_axis;
  int smoothing;
  double neighbours, h_min, h_max, fewest, most, width;
  double cfl, step_acceleration, step_density, step_error, step_min, step_max, step_first,
      step_growth, step_points;
  double step_energy, step_smoothing, step_stress, step_damage, step_distention, step_pressure,
      energy_least, stress_least, damage_least;
  double late_time, late_bulk, late_poisson, late_rho_min;
  double error_position, error_velocity, error_density, error_energy, error_stress, error_damage;
  double damping;
  double spin_rate, spin_period, spin_axis[3];
  int damping_radial;
  int faces[3];
  double low[3], high[3];
  double layer_low[3], layer_high[3], layer_strength;
  char wall[8][64]; /* each body: free, held, or X,Y,Z */
  int viscous_work;
  double guard_energy, guard_angular, guard_momentum;
  int log_every;
  double checkpoint_every;
  double analysis_every, analysis_link, analysis_theta, analysis_virial, analysis_converged,
      analysis_after;
  int analysis_method, analysis_criterion, analysis_points, analysis_least, analysis_window;
  int sink_bound, sink_every, escape_from, escape_unbound, escape_every;
  double escape_distance;
  PointMass point[PARAM_POINTS]; /* [points] */
  int points;
} Param;

/* param_summed: whether the density is a kernel sum. */
static inline int param_summed(const Param *p)
{
  return p->density == PARAM_SUM || p->density == PARAM_MISCIBLE;
}

/* param_defaults: all settings at their defaults. */
void param_defaults(Param *p);

/* param_read: defaults, then a run.cfg (groups as in the table). Errors are `file:line: ...`. */
int param_read(Param *p, const char *path, Err *err);

/* param_set: one "key=value" of the command line, key with its group: "gravity.theta=0.5". */
int param_set(Param *p, const char *assignment, Err *err);

/* param_text: the value of a key (with its group, "gravity.theta") as text; NULL if there is no
 * such key. */
const char *param_text(const Param *p, const char *key, char *buf, int size);

/* param_record: every setting, its value and whether it was given, into the snapshot's /Parameters.
 */
int param_record(const Param *p, Parts *parts, Err *err);

/* param_markdown: the table for docs/run.md. */
void param_markdown(FILE *to);

#endif
