/* SPDX-License-Identifier: GPL-3.0-or-later */
/* miluphcuda's ASCII rows. Which columns there are depends on how it was compiled: `switches` are
 * words of its parameter.h separated by commas, SOLID,FRAGMENTATION,PALPHA_POROSITY ...;
 * INTEGRATE_DENSITY, INTEGRATE_ENERGY and READ_INITIAL_SML_FROM_PARTICLE_FILE are on unless given
 * as NAME=0. Its input rows differ from its output rows. */
#ifndef COLUMNS_H
#define COLUMNS_H

#include "lib/part.h"

enum { COLUMNS_INPUT, COLUMNS_OUTPUT };

/* columns_read: a whole text file; mat are its numbers. Errors name the line, how many columns it
 * has and which it should have. */
Parts *columns_read(const char *path, int kind, int dimension, const char *switches, Err *err);

/* columns_write: input rows. Without switches (NULL) those that the fields need, which are said. */
int columns_write(const Parts *p, const char *path, const char *switches, Err *err);

#endif
