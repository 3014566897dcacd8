/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which particles a search takes: words of the command line, in terms of the file's materials. */
#ifndef CHOOSE_H
#define CHOOSE_H

#include "opt.h"
#include "part.h"

/* choose_material: index of a material of the file by its name, or -1 and the nearest name. */
int choose_material(const Parts *p, const char *name, Err *err);

/* choose_densities: a density for each material, [materials] kg/m^3, malloc'ed, 0 where none is
 * given. Words: `700`, `0.7g/cc`, `0.75rho0` (times the material's own at zero pressure; 0 for a
 * gas), for all materials, or for one, `ice:500`; later ones win. */
double *choose_densities(const Parts *p, const OptList *words, Err *err);

#endif
