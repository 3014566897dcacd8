/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Hydrostatic structure by letting Lagrangian shells fall to rest under friction (Benz 1991;
 * docs/theory.md 6.2, corrects 004 sect. 2.4.2): independent of structure_solve, and free of
 * its assumption that the pressure determines the density. */
#ifndef LAGRANGE_H
#define LAGRANGE_H

#include "structure.h"

/* lagrange_relax: starts from the uncompressed body with `cells` shells (equal steps of m^(1/3), so
 * that the centre is resolved) and stops when over two free-fall times max |v| < 1e-4 v_esc and the
 * force residual < 1e-3 g everywhere. The laws of layers with a temperature are those that
 * structure_anchors found. The radius is good to about 0.02/cells^2 ... 1e-5 at 50 cells. Takes
 * about 10 t_ff c/R cells steps: for planets; slow for small stiff bodies. */
int lagrange_relax(Structure *s, const StructureBody *body, long cells, Err *err);

#endif
