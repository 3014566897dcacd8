/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The particle schema: one row a field. From it come the arrays of Parts, reading and writing, the
 * device copies, the messages about missing fields, docs/schema.md and the tests. Units are SI;
 * arrays are [n] or [n][width].
 * F(type, member, width, dataset, unit, made by, meaning); `made by`: the program that makes it. */
#ifndef FIELDS_H
#define FIELDS_H

#include <stdint.h>

/* clang-format off */
#define FIELDS(F) \
  F(int64_t, id,     1, "ParticleIDs",      "1",        "mksphere", "unique, never renumbered") \
  F(double,  x,      3, "Coordinates",      "m",        "mksphere", "position") \
  F(double,  v,      3, "Velocities",       "m/s",      "mksphere", "velocity") \
  F(double,  m,      1, "Masses",           "kg",       "mksphere", "mass") \
  F(double,  rho,    1, "Density",          "kg/m^3",   "mksphere", "bulk density") \
  F(double,  u,      1, "InternalEnergy",   "J/kg",     "mksphere", "specific internal energy") \
  F(double,  h,      1, "SmoothingLength",  "m",        "mksphere", "radius at which the kernel vanishes") \
  F(int32_t, mat,    1, "MaterialID",       "1",        "mksphere", "index into /Materials") \
  F(int32_t, body,   1, "BodyID",           "1",        "mksphere", "body of origin: target 0, impactor 1") \
  F(double,  p,      1, "Pressure",         "Pa",       "relax",    "pressure, negative in tension, before damage") \
  F(double,  cs,     1, "SoundSpeed",       "m/s",      "relax",    "adiabatic bulk sound speed") \
  F(double,  s,      6, "DeviatoricStress", "Pa",       "relax",    "deviatoric stress xx xy xz yy yz zz, before damage") \
  F(double,  damage, 1, "Damage",           "1",        "weibull",  "0 intact, 1 fully damaged") \
  F(double,  alpha,  1, "Distention",       "1",        "mksphere", "density of the solid over that of porous matter, without load") \
  F(int32_t, nact,   1, "ActiveFlaws",      "1",        "solver",   "flaws activated so far") \
  F(double,  phi,    1, "Potential",        "J/kg",     "solver",   "specific gravitational potential") \
  F(double,  pmax,   1, "PeakPressure",     "Pa",       "solver",   "largest pressure so far") \
  F(double,  Tmax,   1, "PeakTemperature",  "K",        "solver",   "largest temperature so far, of materials that have one") \
  F(double,  shock,  1, "ViscousWork",      "J/kg",     "solver",   "heat made by viscosity so far (watch.viscous_work)") \
  F(double,  lifted, 1, "FloorEnergy",      "J/kg",     "solver",   "energy that energy_floor has added so far") \
  F(double,  strain, 1, "PlasticStrain",    "1",        "solver",   "accumulated equivalent plastic strain") \
  F(double,  T,      1, "Temperature",      "K",        "solver",   "temperature, of materials whose strength depends on it") \
  F(int32_t, nngb,   1, "NeighbourNumber",  "1",        "solver",   "interacting particles, without itself") \
  F(int32_t, frag,   1, "FragmentID",       "1",        "fof",      "fragment, 1 = most massive, 0 = none") \
  F(int32_t, clump,  1, "ClumpID",          "1",        "clumps",   "bound body, 1 = most massive, 0 = none") \
  F(int32_t, disk,   1, "DiskClass",        "1",        "disk",     "1 body, 2 disk, 3 re-impact, 4 fly-by, 5 escape")

/* What only a checkpoint holds: the derivatives that the next step starts from. */
#define CHECKPOINT_FIELDS(F) \
  F(double,  a,      3, "Acceleration",     "m/s^2",    "solver",   "acceleration") \
  F(double,  pull,   3, "GravityAcceleration", "m/s^2", "solver", "gravity as last evaluated, part of it (gravity.every > 1)") \
  F(double,  dudt,   1, "EnergyRate",       "W/kg",     "solver",   "du/dt of the last force loop") \
  F(double,  dqdt,   1, "ViscousHeating",   "W/kg",     "solver",   "du/dt without the local work: viscosity, mostly") \
  F(double,  divv,   1, "VelocityDivergence", "1/s",    "solver",   "divergence of the velocity, uncorrected sum") \
  F(double,  delta,  1, "NumberDensity",    "1/m^3",    "solver",   "kernel sum over neighbours (miscible density)") \
  F(double,  signal, 1, "SignalSpeed",      "m/s",      "solver",   "largest signal velocity to a neighbour") \
  F(double,  dcrack, 1, "CrackRate",        "1/s",      "solver",   "rate of the cube root of damage") \
  F(double,  dalpha, 1, "DistentionRate",   "1/s",      "solver",   "change of the distention in the last step, over its length") \
  F(double,  viscosity, 1, "ViscosityShare", "1",       "solver",   "share of the artificial viscosity that acts (viscosity.switch)") \
  F(double,  div0,   1, "DivergenceBefore", "1/s",      "solver",   "divergence of the step before (viscosity.switch)") \
  F(double,  sense,  1, "DivergenceSense",  "1",        "solver",   "mean sign of the divergence around (viscosity.switch)") \
  F(double,  wander, 3, "SmoothedVelocity", "m/s",      "solver",   "smoothed velocity minus velocity (form.xsph)") \
  F(double,  drho,   1, "DensityDiffusion", "kg/m^3/s", "solver",   "rate of the density by diffusion (form.diffusion)") \
  F(double,  old_x,   3, "OldVelocity",     "m/s",      "solver",   "at the start of the last step (ab2)") \
  F(double,  old_v,   3, "OldAcceleration", "m/s^2",    "solver",   "at the start of the last step (ab2)") \
  F(double,  old_rho, 1, "OldDensityRate",  "kg/m^3/s", "solver",   "at the start of the last step (ab2)") \
  F(double,  old_u,   1, "OldEnergyRate",   "W/kg",     "solver",   "at the start of the last step (ab2)") \
  F(double,  old_s,   6, "OldStressRate",   "Pa/s",     "solver",   "at the start of the last step (ab2)") \
  F(double,  old_crack, 1, "OldCrackRate",  "1/s",      "solver",   "at the start of the last step (ab2)") \
  F(double,  old_h,   1, "OldSmoothingRate", "m/s",     "solver",   "at the start of the last step (ab2)")

#define ALL_FIELDS(F) FIELDS(F) CHECKPOINT_FIELDS(F)

/* Point masses, in /PointMasses: stars, planets and sinks that pull on the particles and are pulled
 * by them. P(type, member, dimensions, width, dataset, unit, meaning). */
#define POINTMASS_FIELDS(P) \
  P(double,  m,         , 1, "Masses",          "kg",       "mass") \
  P(double,  x,      [3], 3, "Coordinates",     "m",        "position") \
  P(double,  v,      [3], 3, "Velocities",      "m/s",      "velocity") \
  P(double,  a,      [3], 3, "Acceleration",    "m/s^2",    "acceleration") \
  P(double,  old_x,  [3], 3, "PositionRateBefore", "m/s",   "velocity at the step before (integrator ab2)") \
  P(double,  old_v,  [3], 3, "VelocityRateBefore", "m/s^2", "acceleration at the step before (integrator ab2)") \
  P(double,  h,         , 1, "SofteningLength", "m",        "distance below which its pull is softened; 0: nowhere") \
  P(double,  radius,    , 1, "AccretionRadius", "m",        "radius of the sink; 0: it takes nothing") \
  P(double,  spin,   [3], 3, "Spin",            "kg*m^2/s", "angular momentum of what it has taken, about its own centre") \
  P(double,  taken,     , 1, "AccretedMass",    "kg",       "mass that it has taken") \
  P(int64_t, count,     , 1, "AccretedNumber",  "1",        "particles that it has taken") \
  P(int32_t, fixed,     , 1, "Fixed",           "1",        "1: it stays where it is") \
  P(int32_t, deaf,      , 1, "FeelsNoParticles", "1",       "1: only other point masses pull on it") \
  P(int32_t, clump,     , 1, "ClumpID",         "1",        "bound body that it belongs to (clumps); 0: none") \
  P(int32_t, disk,      , 1, "DiskClass",       "1",        "what it is to the body of disk, as of a particle; 0: unknown")
/* clang-format on */

typedef struct {
#define POINTMASS_MEMBER(TYPE, MEMBER, DIM, ...) TYPE MEMBER DIM;
  POINTMASS_FIELDS(POINTMASS_MEMBER)
#undef POINTMASS_MEMBER
} PointMass;

#endif
