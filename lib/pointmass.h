/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Point masses (fields.h) in a file: /PointMasses holds one dataset a field, one row each. */
#ifndef POINTMASS_H
#define POINTMASS_H

#include <hdf5.h>
#include "part.h"

/* pointmass_append: more[count] behind the *n of *list, which grows. */
int pointmass_append(PointMass **list, int *n, const PointMass *more, int count, Err *err);

/* pointmass_put: the group, when there are any. pointmass_get: reads it, if it is there; a dataset
 * that is not stays zero, but masses, positions and velocities must be there. */
int pointmass_put(hid_t file, const Parts *p, Err *err);
int pointmass_get(hid_t file, Parts *p, Err *err);

/* pointmass_check: finite numbers, masses > 0, lengths >= 0, still when fixed, nothing in held
 * dimensions. The message names point mass (1, 2, ...) and field. */
int pointmass_check(const PointMass *p, int n, int dimension, Err *err);

/* pointmass_rows: each point mass as one more row at the end, for an analysis that counts them:
 * fields that are there are zero but for id (beyond all others), x, v, m, h (its softening), rho
 * (that of its sphere of accretion; INFINITY without one), clump, disk. Neither flaws nor unknown
 * fields go with them. pointmass_row: whether row i is one of these. pointmass_without: p without
 * them, for writing (arrays stay p's), their clump and disk stored with the point masses. */
int pointmass_rows(Parts *p, Err *err);
static inline int pointmass_row(const Parts *p, long i) { return i >= p->n - p->point_rows; }
Parts pointmass_without(const Parts *p);

#endif
