/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Particles and the one-dimensional structure of their body: which layer each belongs to, and a
 * lattice laid on a structure. */
#ifndef LAY_H
#define LAY_H

#include "part.h"
#include "structure.h"

/* lay_layers: the layers of an uncompressed 3D body as mksphere makes it (each of one material,
 * density and energy), by distance from the centre of mass. of [p->n] receives the layer of each
 * particle. Returns their number, or -1. */
int lay_layers(const Parts *p, const Material *material, StructureBody *body, int *of, Err *err);

/* lay_body: moves the particles of such a body radially so that each keeps its mass coordinate, and
 * sets rho, u, p, cs and h from the profile; the centre of mass goes to the origin. Masses are not
 * touched: each layer has its exact mass. */
int lay_body(Parts *p, const Material *material, const Structure *s, Err *err);

/* lay_assign: the layer of each particle of a body that is compressed already, of [p->n], by
 * material and, where layers share one, by mass from the centre. Errors: masses that are not those
 * of body. */
int lay_assign(const Parts *p, const StructureBody *body, int *of, Err *err);

#endif
