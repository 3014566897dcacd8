/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The numbers of a step that all particles share, and what can be wrong with one of them. */
#ifndef STEP_H
#define STEP_H

#include "hold.h"
#include "rich.h"

/* Why a step is as short as it is; what conserved.tsv and the log name. limits.h has what each is.
 */
/* clang-format off */
#define LIMIT_NAMES(L) \
  L(CFL, "cfl") L(ACCELERATION, "acceleration") L(DENSITY, "density") \
  L(ENERGY, "energy") L(SMOOTHING, "smoothing") L(STRESS, "stress") L(DAMAGE, "damage") \
  L(DISTENTION, "distention") L(PRESSURE, "pressure")
/* clang-format on */
enum {
#define LIMIT_ENUM(CAPITAL, NAME) LIMIT_##CAPITAL,
  LIMIT_NAMES(LIMIT_ENUM)
#undef LIMIT_ENUM
      LIMITS
};

/* Numbers of a step: the same for all particles. */
typedef struct {
  double dt;                                        /* s */
  int density, energy, smoothing, strength, damage; /* modes, see param.h */
  int volumes;                                      /* pressure_form product */
  int summed;                                       /* density is a kernel sum */
  double neighbours, h_min, h_max, density_floor, energy_floor;
  double self;                                     /* sigma w(0): the kernel's centre */
  double cfl, acceleration, step_density;          /* factors of the limits (limits.h) */
  double limit[LIMITS];                            /* of those that are off unless asked for: 0 */
  double energy_least, stress_least, damage_least; /* what counts at least in them */
  int limited;                                     /* any of them is on */
  double few, many, width, dilation; /* overcorrected h: neighbours, largest |div v| [1/s] */
  double outer;                      /* pressure outside [Pa] */
  double damping;                    /* 1/s; 0: none */
  int damping_radial, framed;        /* framed: the frames of the bodies are needed */
  double spin_rate, spin[3];         /* 1/s; rad/s: the rotation that bodies are brought to */
  double centre[BODIES][3], velocity[BODIES][3],
      omega[BODIES][3]; /* frames that are damped towards */
  struct {
    double x, v, rho, u, s, crack;
  } error;           /* weights of the errors of rk2-adaptive, over the tolerance */
  int slot, rates;   /* saved arrays to work on; whether rates are saved instead of the state */
  double weight[3];  /* of the saved rates 1..3 in a combination */
  double pull;       /* weight of gravity in this kick, over that of the other forces, minus 1 */
  int viscous, rich; /* physical viscosity; pair terms of pair_rich.h */
  Rich more;
  Fluid fluid;
  Deposit deposit;
  Hold hold;
} Step;

enum {
  BAD_NONE,
  BAD_POSITION,
  BAD_VELOCITY,
  BAD_DENSITY,
  BAD_ENERGY,
  BAD_SMOOTHING,
  BAD_ACCELERATION,
  BAD_STRESS
};

#endif
