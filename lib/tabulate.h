/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tables made from laws, and from other tables.
 *
 * T and s of a law are those of thermal.h, so that the material needs a heat_capacity; a gas has
 * its s on the line of 1 kg/m^3. Below the cold curve T is 0; below the isentrope of 1 K s is 0. */
#ifndef TABULATE_H
#define TABULATE_H

#include "table.h"
#include "thermal.h"

typedef struct {
  const double *rho, *y; /* [nrho], [ny] nodes as in a Table */
  int nrho, ny, heat;
} TabulateGrid;

/* tabulate_law: p and c are the law's own at the nodes; where a density or energy stands twice, at
 * either side of it. Errors: no heat capacity, a law that needs more than rho and u. */
int tabulate_law(Table *t, const Material *m, const TabulateGrid *grid, Err *err);

/* tabulate_table: another grid of the same table. Errors: temperatures that the table does not
 * have. */
int tabulate_table(Table *t, const struct eos_table *from, const TabulateGrid *grid, Err *err);

/* tabulate_breaks: densities or energies at which a law's slopes jump, ascending; how many. */
int tabulate_breaks(const Eos *eos, int energies, double at[2]);

/* tabulate_error: the largest deviation of p (over |p| + 1e-4 K, K the larger of rho c^2 and the
 * bulk modulus at rest) and of c from a law, in the middle of the cells; returns the share of cells
 * in which both are below 1e-4. Cells at the floor of c are left out. */
double tabulate_error(const struct eos_table *e, const Eos *eos, double *p, double *c);

#endif
