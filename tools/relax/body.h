/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The body that is relaxed, and the one-dimensional structure that it should come to. */
#ifndef BODY_H
#define BODY_H

#include "../../lib/part.h"
#include "../../lib/structure.h"
#include "options.h"

typedef struct {
  Parts *p;
  StructureBody recipe;
  Structure s;
  Material *material;
  int *layer;                       /* [p->n] of each particle */
  int laid;                         /* it came uncompressed and was laid on the structure */
  double omega;                     /* wanted spin about z [rad/s]; 0: none; NAN: as it comes */
  double free_fall, sound, spacing; /* s, s, m */
} Body;

/* body_read: from a file or stdin (NULL): finds its layers (by its recipe, or as mksphere makes
 * them), solves the structure, writes the profile if it is asked for, and lays the particles on it
 * if they are not there yet. body_free: *b may be half made. */
int body_read(Body *b, const char *path, const Options *o, Err *err);
void body_free(Body *b);

/* body_keep: drops the particles with keep[i] == 0; the recipe's masses follow. */
int body_keep(Body *b, const unsigned char *keep, Err *err);

#endif
