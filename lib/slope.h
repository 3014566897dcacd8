/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Slopes of a tabulated function at its nodes, for Hermite interpolation: of the quartic through
 * five nodes, limited so that the cubic between two nodes rises where the numbers do, without
 * losing accuracy at smooth extrema (M3 of Huynh 1993, SIAM J. Numer. Anal. 30, 57). */
#ifndef SLOPE_H
#define SLOPE_H

#include "err.h"

typedef struct Slope Slope;

/* slope_new: for an axis of n >= 2 ascending nodes. A node may stand twice: the function on either
 * side is then a function of its own. NULL without memory. */
Slope *slope_new(const double *x, int n, Err *err);
void slope_free(Slope *s);

/* slope_line: of f[k * stride], k < n, into out[k * stride]. */
void slope_line(const Slope *s, const double *f, double *out, long stride);

#endif
