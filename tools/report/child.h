/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The sibling programs, run as a person would. */
#ifndef CHILD_H
#define CHILD_H

#include "lib/err.h"

/* child_run: program argv[0], of those beside this one or else on PATH, with stdout to the file
 * `out` (NULL: nowhere). Fails with the last line that it printed on stderr when it does not end
 * with 0. argv ends with NULL. */
int child_run(const char *const *argv, const char *out, Err *err);

/* child_there: whether a program is on PATH. */
int child_there(const char *name);

#endif
