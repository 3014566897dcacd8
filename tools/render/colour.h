/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Colours for numbers and for kinds. */
#ifndef COLOUR_H
#define COLOUR_H

#include "image.h"

#define COLOUR_MAPS "viridis|magma|inferno|polar"

/* colour_map: t in 0..1 (clipped) in a map of COLOUR_MAPS. viridis, magma, inferno: perceptually
 * uniform (van der Walt & Smith 2015, matplotlib, CC0); polar: blue, white, red, for signed
 * quantities. */
Rgb colour_map(const char *map, double t);

/* colour_of_material: by the first known word in the name (basalt red, water ice blue as in 001
 * fig. 10), else the k-th of colour_kind. colour_kind: seven distinct colours, then
 * the same darker, k >= 0 (Okabe &
 * Ito 2008). */
Rgb colour_of_material(const char *name, int k);
Rgb colour_kind(long k);

/* colour_shade: scaled towards black, f in 0..1. */
Rgb colour_shade(Rgb c, double f);

#endif
