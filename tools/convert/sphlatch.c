/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Names and units: SPHLATCH, src/io_particle.h and its dumps. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "foreign.h"
#include "lib/hdf.h"
#include "notes.h"
#include "sphlatch.h"

static const char ANEW[] = "computed anew", OTHER[] = "of its own search";
static const double EV = 11604.51812; /* K: e/k_B, CODATA 2018 */

/* clang-format off */
static const ForeignRow TABLE[] = {
  {"id", "id", NULL, 0, 0, 0, 0}, {"pos", "x", NULL, 1, 0, 0, 0}, {"vel", "v", NULL, 1, 0, -1, 0},
  {"m", "m", NULL, 0, 1, 0, 0}, {"h", "h", NULL, 1, 0, 0, 0}, {"rho", "rho", NULL, -3, 1, 0, 0},
  {"u", "u", NULL, 2, 0, -2, 0}, {"p", "p", NULL, -1, 1, -2, 0}, {"cs", "cs", NULL, 1, 0, -1, 0},
  {"mat", "mat", NULL, 0, 0, 0, 0}, {"T", "T", NULL, 0, 0, 0, 1}, {"pot", "phi", NULL, 2, 0, -2, 0},
  {"noneigh", "nngb", NULL, 0, 0, 0, 0}, {"pmax", "pmax", NULL, -1, 1, -2, 0}, {"peakp", "pmax", NULL, -1, 1, -2, 0},
  {"S", NULL, NULL, 0, 0, 0, 0}, {"Tmax", "Tmax", NULL, 0, 0, 0, 1},
  {"phase", "+Phase", "1", 0, 0, 0, 0}, {"uav", "shock", NULL, 2, 0, -2, 0},
  {"delta", NULL, ANEW, 0, 0, 0, 0}, {"acc", NULL, ANEW, 0, 0, 0, 0}, {"accp", NULL, ANEW, 0, 0, 0, 0},
  {"dudt", NULL, ANEW, 0, 0, 0, 0}, {"dhdt", NULL, ANEW, 0, 0, 0, 0}, {"drhodt", NULL, ANEW, 0, 0, 0, 0},
  {"divv", NULL, ANEW, 0, 0, 0, 0}, {"eps", NULL, "softening is by h here", 0, 0, 0, 0},
  {"cost", NULL, "of its tree", 0, 0, 0, 0}, {"clumpid", NULL, OTHER, 0, 0, 0, 0},
  {"friendid", NULL, OTHER, 0, 0, 0, 0}, {"orbit", NULL, OTHER, 0, 0, 0, 0}, {"ecc", NULL, OTHER, 0, 0, 0, 0},
  {"dam", NULL, "ParaSPH keeps D or its cube root there", 0, 0, 0, 0}};
/* clang-format on */

enum { ROWS = sizeof TABLE / sizeof *TABLE };

/* The largest N of the groups Step#N that hold `pos`. */
static herr_t visit(hid_t file, const char *name, const H5L_info_t *info, void *context)
{
  (void)info;
  long *last = context, n;
  char inside[96], end;
  if (sscanf(name, "Step#%ld%c", &n, &end) != 1 || n <= *last) return 0;
  snprintf(inside, sizeof inside, "Step#%ld/pos", n);
  if (hdf_has(file, inside) > 0) *last = n;
  return 0;
}

int sphlatch_is(hid_t file)
{
  long last = -1;
  return H5Literate(file, H5_INDEX_NAME, H5_ITER_INC, NULL, visit, &last) >= 0 && last >= 0;
}

static hid_t open_step(hid_t file, long step, Err *err)
{
  char name[32] = "current";
  long last = -1;
  if (step >= 0 || hdf_has(file, name) <= 0) {
    if (step < 0) H5Literate(file, H5_INDEX_NAME, H5_ITER_INC, NULL, visit, &last), step = last;
    snprintf(name, sizeof name, "Step#%ld", step);
  }
  if (hdf_has(file, name) == 0) return err_set(err, "has no '%s'", name);
  hid_t g = H5Gopen2(file, name, H5P_DEFAULT);
  if (g < 0) hdf_fail(err, "'%s'", name);
  return g;
}

/* S is the specific entropy in erg/g/eV, or xx xy xz yy yz of the stress in its older versions. */
static int read_s(hid_t step, const ForeignUnits *cgs, Parts *p, Err *err)
{
  static const ForeignRow ENTROPY = {"S", "+Entropy", "J/K/kg", 2, 0, -2, -1},
                          STRESS = {"S", "s", NULL, -1, 1, -2, 0};
  int width;
  if (hdf_has(step, "S") <= 0) return 0;
  if (foreign_rows(step, "S", &width, err) < 0) return -1;
  return foreign_one(step, width == 1 ? &ENTROPY : &STRESS, cgs, p, err);
}

Parts *sphlatch_read(hid_t file, long step, Err *err)
{
  static const ForeignUnits CGS = {1e-2, 1e-3, 1, EV};
  int width;
  hid_t g = open_step(file, step, err);
  if (g < 0) return NULL;
  long n = foreign_rows(g, "pos", &width, err);
  Parts *p = n > 0 ? part_new(n) : NULL;
  int rc = p ? 0 : n < 0 ? -1 : err_set(err, n ? "out of memory" : "holds no particles");
  if (!rc) p->dimension = width > 3 ? 3 : width;
  if (!rc && H5Aexists(g, "time") > 0)
    rc = hdf_get(g, "time", H5T_NATIVE_DOUBLE, 1, &p->time, err) < 0;
  rc = rc || foreign_read(g, TABLE, ROWS, &CGS, p, err) || read_s(g, &CGS, p, err);
  H5Gclose(g);
  if (!rc) return p;
  part_free(p);
  return NULL;
}
