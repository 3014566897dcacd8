/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One-dimensional structures in files: tab-separated text, or HDF5 when the name ends in .h5. Both
 * hold the layers as texts of recipe.h, so that the laws and materials are known again. */
#ifndef PROFILE_H
#define PROFILE_H

#include <stdio.h>
#include "material.h"
#include "structure.h"

typedef struct {
  Structure s;
  StructureBody body;                  /* layers that the file says, masses as in s */
  Material material[STRUCTURE_LAYERS]; /* of each layer */
  MaterialName name[STRUCTURE_LAYERS];
  char *text[STRUCTURE_LAYERS];
} Profile;

/* profile_write: to a file, or stdout ("-": text). names [layers]: of the materials; texts: their
 * .cfg, needed for HDF5. */
int profile_write(const char *path, const Structure *s, const StructureBody *body,
                  const char *const *names, const char *const *texts, Err *err);

/* profile_read: checks that radius and mass rise and pressure does not, within a layer and from one
 * to the next. *out must not be moved: body refers to its materials. */
int profile_read(Profile *out, const char *path, Err *err);
void profile_free(Profile *p);

#endif
