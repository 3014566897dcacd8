/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tables of equations of state in memory. Nodes lie on a grid of density and, second, either
 * specific energy or temperature; SI throughout. Files: tabfile.h; the law made from a table:
 * physics/eos/table.h. */
#ifndef TABLE_H
#define TABLE_H

#include "../physics/eos.h"
#include "err.h"

/* The quantities: X(CAPITAL, name, unit, meaning); name is the dataset of the hdf5 format. */
/* clang-format off */
#define TABLE_FIELDS(X) \
  X(P,     Pressure,       "Pa",     "pressure, negative in tension") \
  X(U,     InternalEnergy, "J/kg",   "specific internal energy") \
  X(C,     SoundSpeed,     "m/s",    "adiabatic sound speed") \
  X(T,     Temperature,    "K",      "temperature") \
  X(S,     Entropy,        "J/kg/K", "specific entropy") \
  X(PHASE, Phase,          "1",      "number of the phase, as the maker of the table has them")
/* clang-format on */
enum {
#define TABLE_ENUM(CAPITAL, ...) TABLE_##CAPITAL,
  TABLE_FIELDS(TABLE_ENUM)
#undef TABLE_ENUM
      TABLE_FIELD_COUNT
};

extern const char *const table_names[]; /* [TABLE_FIELD_COUNT] */

typedef struct {
  int nrho, ny; /* nodes */
  int heat;     /* the second axis is T; else u */
  double *rho;  /* [nrho] ascending; a value may stand twice where slopes jump */
  double *y;    /* [ny] likewise */
  double *field[TABLE_FIELD_COUNT]; /* [nrho][ny]; NULL: absent, as is that of the axis */
  long *row;                        /* [nrho][ny] line of each node in a text file, or NULL */
  int repaired;    /* u or T that fell along y by less than 1e-3 of itself and were raised */
  char about[256]; /* first line of the header: where it is from */
} Table;

/* table_new: room for a grid, all fields but the axis' own; the values are the caller's to set.
 * table_free: an empty (zeroed) one too. */
int table_new(Table *t, int nrho, int ny, int heat, Err *err);
void table_free(Table *t);

/* table_check: ascending axes, finite numbers, c and T not below 0, u or T rising along y. label
 * names it in messages. */
int table_check(Table *t, const char *label, Err *err);

/* table_law: the law made from a table: slopes at the nodes and, where e has 0, rho0 and c_min. s
 * and T that are absent become NAN. table_law_free gives its memory back. */
int table_law(struct eos_table *e, const Table *t, Err *err);
void table_law_free(struct eos_table *e);

/* table_heat: heat capacity du/dT [J/K/kg] at rest and 300 K (a gas: in the middle of the
 * densities), or at the T of the table next to that; 0 when it has no T. */
double table_heat(const struct eos_table *e);

#endif
