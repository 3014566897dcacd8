/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Particles spread with their kernels over the cells of a regular grid: slices, projections,
 * volumes. A cell gets sum_j a_j W(r_j, h_j) at its centre, and the same times each value; what the
 * amounts a_j are (volume to interpolate, mass to keep mass) is the caller's. The kernel is
 * Wendland C2. Deterministic for any number of threads. */
#ifndef DEPOSIT_H
#define DEPOSIT_H

#include "err.h"

typedef enum {
  DEPOSIT_3D,
  DEPOSIT_2D,
  DEPOSIT_COLUMN
} DepositShape; /* W, or its integral along z */

typedef struct {
  float x[3];   /* from the lower corner of the grid, in the units of `cell` */
  float h;      /* radius of the kernel */
  float amount; /* a_j */
  float size;   /* within this distance a cell is marked as inside; 0: never */
} DepositSpot;

typedef struct {
  int n[3];      /* cells, x fastest; of DEPOSIT_2D and _COLUMN n[2] = 1 */
  float cell[3]; /* edges */
  DepositShape shape;
  double exact; /* amounts are kept to rounding where h < exact cells (their weights are summed over
                     the lattice, which ends nowhere); further out the integral of W is 1 */
  int fields;   /* values */
  float *sum;   /* [cells] sum a W */
  float **mean; /* [fields][cells] sum a W value */
  float *best;  /* [cells] largest a W, or NULL when nobody asks */
  float *kind;  /* [cells] its value of field 0, with best */
  unsigned char *inside; /* [cells] or NULL */
} Deposit;

/* deposit_new: zeroed arrays; kinds: with best, kind and inside. -1: no memory. */
int deposit_new(Deposit *d, const int n[3], const float cell[3], DepositShape shape, int fields,
                int kinds, Err *err);
void deposit_free(Deposit *d);

/* deposit_add: n particles with values [fields][n]; spots that cover no cell do no harm, though h
 * should be 1.5 cells at least where amounts are kept. */
int deposit_add(Deposit *d, const DepositSpot *spot, const float *const *value, long n, Err *err);

/* deposit_kernel: sigma w(q) of a shape, q = r/h in 0..1; times h^-3 or (2D, column) h^-2 it is W.
 * The column is a fit, within 1e-3 of its value at 0. */
float deposit_kernel(DepositShape shape, float q);

#endif
