/* SPDX-License-Identifier: GPL-3.0-or-later */
/* miluphcuda's HDF5 files: datasets in the root group, no attributes; SI assumed. Its `sml` is the
 * radius at which the kernel vanishes, as is h here. */
#ifndef MILUPH_H
#define MILUPH_H

#include <hdf5.h>
#include "lib/part.h"

/* miluph_is: whether an open file looks like one. miluph_read: its particles; mat are its numbers.
 */
int miluph_is(hid_t file);
Parts *miluph_read(hid_t file, Err *err);

/* miluph_write: what miluphcuda reads with any of its switches, and beside it, under the schema's
 * names, the fields that it does not have, materials too: read back, nothing of them is lost. */
int miluph_write(const Parts *p, const char *path, Err *err);

/* miluph_flaws: sets nflaw and flaw from rows of `most` thresholds, those that are not positive
 * being none. */
int miluph_flaws(Parts *p, const double *threshold, int most, Err *err);

/* miluph_damage: the dimension-th root of the damage, and back. */
double miluph_root(double damage, int dimension);
double miluph_damage(double root, int dimension);

#endif
