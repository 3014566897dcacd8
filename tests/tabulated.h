/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tables of laws for tests. Every failure to make one fails the test. */
#ifndef TABULATED_H
#define TABULATED_H

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "../lib/tabfile.h"
#include "../lib/tabulate.h"

/* tabulated_axis: n nodes from low to high, evenly or (low > 0) by a constant ratio, and what
 * stands in `twice` added as pairs. malloc'ed; returns how many. */
static inline int tabulated_axis(double **x, double low, double high, int n, int log_spaced,
                                 const double *twice, int pairs)
{
  int m = 0;
  *x = malloc((size_t)(n + 2 * pairs) * sizeof **x);
  for (int k = 0, b = 0; k < n; k++) {
    double f = (double)k / (n - 1),
           value = log_spaced ? low * pow(high / low, f) : low + (high - low) * f;
    while (b < pairs && twice[b] < value) {
      if (twice[b] > low && twice[b] < high) (*x)[m++] = twice[b], (*x)[m++] = twice[b];
      b++;
    }
    (*x)[m++] = value;
  }
  return m;
}

/* tabulated_law: of m, densities by a constant ratio, energies (heat: temperatures) too
 * unless they begin at 0. */
static inline Table tabulated_law(const Material *m, const double rho[2], int nrho,
                                  const double y[2], int ny, int heat)
{
  double at[2], *axis[2];
  TabulateGrid grid;
  Table t;
  Err err;
  grid.heat = heat;
  grid.nrho =
      tabulated_axis(&axis[0], rho[0], rho[1], nrho, 1, at, tabulate_breaks(&m->eos, 0, at));
  grid.ny = tabulated_axis(&axis[1], y[0], y[1], ny, y[0] > 0, at,
                           heat ? 0 : tabulate_breaks(&m->eos, 1, at));
  grid.rho = axis[0], grid.y = axis[1];
  if (tabulate_law(&t, m, &grid, &err)) fail_msg("%s", err.text);
  free(axis[0]), free(axis[1]);
  return t;
}

/* tabulated_eos: the law of a table; its memory is the caller's (table_law_free). */
static inline Eos tabulated_eos(const Table *t)
{
  Eos e;
  Err err;
  memset(&e, 0, sizeof e);
  e.form = EOS_TABLE;
  if (table_law(&e.table, t, &err)) fail_msg("%s", err.text);
  return e;
}

#endif
