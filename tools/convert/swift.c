/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Names: SWIFT, src/hydro/Planetary/hydro_io.h and the docs' "Initial Conditions"; numbers of
 * materials: src/equation_of_state/planetary. */
#include <stdlib.h>
#include <string.h>
#include "foreign.h"
#include "lib/hdf.h"
#include "notes.h"
#include "swift.h"

/* clang-format off */
static const ForeignRow TABLE[] = {
  {"ParticleIDs", "id", NULL, 0, 0, 0, 0}, {"Coordinates", "x", NULL, 1, 0, 0, 0},
  {"Velocities", "v", NULL, 1, 0, -1, 0}, {"Masses", "m", NULL, 0, 1, 0, 0},
  {"SmoothingLength", "h", NULL, 1, 0, 0, 0}, {"SmoothingLengths", "h", NULL, 1, 0, 0, 0},
  {"Density", "rho", NULL, -3, 1, 0, 0}, {"Densities", "rho", NULL, -3, 1, 0, 0},
  {"InternalEnergy", "u", NULL, 2, 0, -2, 0}, {"InternalEnergies", "u", NULL, 2, 0, -2, 0},
  {"MaterialID", "mat", NULL, 0, 0, 0, 0}, {"MaterialIDs", "mat", NULL, 0, 0, 0, 0},
  {"Pressure", "p", NULL, -1, 1, -2, 0}, {"Pressures", "p", NULL, -1, 1, -2, 0},
  {"Potential", "phi", NULL, 2, 0, -2, 0}, {"Potentials", "phi", NULL, 2, 0, -2, 0},
  {"Entropy", "+Entropy", "J/K/kg", 2, 0, -2, -1}, {"Entropies", "+Entropy", "J/K/kg", 2, 0, -2, -1}};
/* clang-format on */

static const struct {
  long number;
  const char *name;
} TILLOTSON[] = {{100, "iron"}, {101, "granite"}, {102, "water"}, {103, "basalt"}, {104, "ice"}};

enum { ROWS = sizeof TABLE / sizeof *TABLE };

const char *swift_material(long number)
{
  for (size_t k = 0; k < sizeof TILLOTSON / sizeof *TILLOTSON; k++)
    if (TILLOTSON[k].number == number) return TILLOTSON[k].name;
  return NULL;
}

int swift_is(hid_t file)
{
  return hdf_has(file, "PartType0") > 0 && hdf_has(file, "PartType0/Coordinates") > 0;
}

/* One unit in cgs by its name in SWIFT or GADGET; 0 without either. */
static int unit(hid_t g, const char *swift, const char *gadget, double *cgs, Err *err)
{
  const char *name = H5Aexists(g, swift) > 0 ? swift : gadget;
  *cgs = 0;
  if (!name || H5Aexists(g, name) <= 0) return 0;
  if (hdf_get(g, name, H5T_NATIVE_DOUBLE, 1, cgs, err) < 0) return -1;
  return *cgs > 0 ? 0 : err_set(err, "'Units': '%s' is %g", name, *cgs);
}

static int read_units(hid_t file, ForeignUnits *u, Err *err)
{
  double speed;
  if (hdf_has(file, "Units") <= 0)
    return err_set(err, "has no group 'Units', so its numbers mean nothing");
  hid_t g = H5Gopen2(file, "Units", H5P_DEFAULT);
  if (g < 0) return hdf_fail(err, "'Units'");
  int rc = unit(g, "Unit length in cgs (U_L)", "UnitLength_in_cm", &u->length, err) ||
           unit(g, "Unit mass in cgs (U_M)", "UnitMass_in_g", &u->mass, err) ||
           unit(g, "Unit time in cgs (U_t)", "UnitTime_in_s", &u->time, err) ||
           unit(g, "Unit temperature in cgs (U_T)", NULL, &u->temperature, err) ||
           unit(g, "UnitVelocity_in_cm_per_s", NULL, &speed, err);
  H5Gclose(g);
  if (rc) return -1;
  if (!u->time && speed > 0) u->time = u->length / speed;
  if (!(u->length > 0 && u->mass > 0 && u->time > 0))
    return err_set(err, "'Units' lacks one of length, mass and time");
  if (!u->temperature) u->temperature = 1;
  u->length *= 1e-2, u->mass *= 1e-3;
  return 0;
}

static int read_header(hid_t file, const ForeignUnits *u, Parts *p, Err *err)
{
  double box[3] = {0}, time[8] = {0};
  int dimension[3] = {3}, types = 0;
  int64_t count[64] = {0};
  if (hdf_has(file, "Header") <= 0) return err_set(err, "has no group 'Header'");
  hid_t g = H5Gopen2(file, "Header", H5P_DEFAULT);
  if (g < 0) return hdf_fail(err, "'Header'");
  int rc = 0;
  if (H5Aexists(g, "Time") > 0) rc = hdf_get(g, "Time", H5T_NATIVE_DOUBLE, 8, time, err) < 0;
  if (!rc && H5Aexists(g, "Dimension") > 0)
    rc = hdf_get(g, "Dimension", H5T_NATIVE_INT, 3, dimension, err) < 0;
  if (!rc && H5Aexists(g, "BoxSize") > 0)
    rc = hdf_get(g, "BoxSize", H5T_NATIVE_DOUBLE, 3, box, err) < 0;
  if (!rc && H5Aexists(g, "NumPart_ThisFile") > 0)
    rc = (types = hdf_get(g, "NumPart_ThisFile", H5T_NATIVE_INT64, 64, count, err)) < 0;
  H5Gclose(g);
  if (rc) return -1;
  if (dimension[0] < 1 || dimension[0] > 3)
    return err_set(err, "'Header': Dimension is %d", dimension[0]);
  p->dimension = dimension[0], p->time = *time * u->time;
  if (*box > 0) notes_say("not carried over: BoxSize, %g m", *box * u->length);
  for (int k = 1; k < types; k++)
    if (count[k]) notes_say("not carried over: %lld particles of type %d", (long long)count[k], k);
  return 0;
}

Parts *swift_read(hid_t file, Err *err)
{
  ForeignUnits units;
  int width;
  if (read_units(file, &units, err)) return NULL;
  long n = foreign_rows(file, "PartType0/Coordinates", &width, err);
  if (n < 1) return n < 0 ? NULL : err_null(err, "holds no particles of type 0");
  Parts *p = part_new(n);
  if (!p) return err_null(err, "out of memory");
  hid_t g = H5Gopen2(file, "PartType0", H5P_DEFAULT);
  int rc = read_header(file, &units, p, err) || foreign_read(g, TABLE, ROWS, &units, p, err);
  H5Gclose(g);
  if (!rc) return p;
  part_free(p);
  return NULL;
}
