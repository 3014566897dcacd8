/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A layered body as one asks for it: what is given of the whole and of its layers, as texts and
 * numbers, and the masses of the layers that follow. A body file keeps the recipe among its numbers
 * (/Body), from which any program finds the structure again. */
#ifndef RECIPE_H
#define RECIPE_H

#include "part.h"
#include "structure.h"

typedef struct {
  StructureBody body;                  /* the masses are found by recipe_solve */
  double mass, radius;                 /* of the whole; NAN: to be found */
  double share[STRUCTURE_LAYERS];      /* mass fraction; NAN: not given */
  double layer_mass[STRUCTURE_LAYERS]; /* kg; NAN: not given */
  double end[STRUCTURE_LAYERS];        /* outer radius of the layer [m]; NAN: not given */
} Recipe;

/* recipe_layer: adds a layer from "MATERIAL[:SHARE][:STATE[,STATE]]": SHARE a mass fraction
 * ("0.3"), a mass ("4e22kg") or the layer's outer radius ("1200km"), empty when it is to be found;
 * STATE u=200kJ/kg, s=3000, T=1500K or T=continuous, isentropic, isothermal, or power=0.6 (T ~
 * rho^0.6). `standard` is the state where the text has none. The material itself is left to the
 * caller, who gets its name or path in `material` [256]. */
int recipe_layer(Recipe *r, const char *text, const StructureLayer *standard, char *material,
                 Err *err);

/* recipe_count: whether as many numbers are given as recipe_solve needs. */
int recipe_count(Recipe *r, Err *err);

/* recipe_solve: masses of all layers (and mass and radius) from as many given numbers as there are
 * layers: total mass or radius, shares, masses or radii of layers. dimension: 3, or, without
 * gravity, 1 and 2. Errors: too few or too many numbers, or no such body. */
int recipe_solve(Recipe *r, int dimension, Err *err);

/* recipe_volume: of a ball of that radius in 1, 2 or 3 dimensions; recipe_radius: its inverse. */
double recipe_volume(int dimension, double radius);
double recipe_radius(int dimension, double volume);

/* recipe_store: the body into /Body, its materials as numbered in p. recipe_load: from there;
 * returns the number of layers, 0 when there is no recipe, -1 when it makes no sense. */
int recipe_store(Parts *p, const StructureBody *body, Err *err);
int recipe_load(const Parts *p, const Material *material, StructureBody *body, Err *err);

#endif
