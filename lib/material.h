/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Materials from libconfig text: a name, the group `eos`, and for solids `strength` and `damage`,
 * and `porosity`, each with the `form` of its law (a word of EOS_WORDS, YIELD_WORDS ...), the law's
 * parameters and, if one likes, their `source`; `strength` also holds shear_modulus and
 * melt_energy. Without strength it is a fluid, without damage it does not break. The laws and their
 * rows are in physics/.
 *
 * eos.form = "table" has the key `file`, a table in one of the formats of tabfile.h: beside the
 * .cfg, in the folders where materials are looked for, or from the working folder. The text that a
 * snapshot keeps gets a group `table` with the file's checksum, so that no other table passes for
 * it later. */
#ifndef LIB_MATERIAL_H
#define LIB_MATERIAL_H

#include "../physics/material.h"
#include "part.h"

typedef char MaterialName[64];

/* material_find: the text of a material given by name (`basalt`) or by a path to a .cfg. Looked for
 * in $BRECCIA_MATERIALS, ./materials, and beside the program (../materials,
 * ../share/breccia/materials). Unknown names get the nearest known one. malloc'ed text, or NULL.
 * `name` receives the material's own name. */
char *material_find(const char *name_or_path, MaterialName name, Err *err);

/* material_names: the names that material_find knows, sorted; malloc'ed, NULL without memory. */
MaterialName *material_names(int *n);

/* material_parse: text into laws and parameters, tables read; every error is `label:line: ...`.
 * material_clear gives the memory of a table back. */
int material_parse(Material *m, const char *text, const char *label, Err *err);
void material_clear(Material *m);

/* material_load: all materials of a snapshot, parsed, [p->materials]. material_free: these and
 * their tables. */
Material *material_load(const Parts *p, Err *err);
void material_free(Material *m, int n);

#endif
