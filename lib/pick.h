/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What of a snapshot a picture or grid is made of: only the fields that are asked for, only the
 * particles selected, and the point that it is about. */
#ifndef PICK_H
#define PICK_H

#include "part.h"

/* PICK_FIELDS: what pick_read always reads and wants. */
#define PICK_FIELDS "id x m rho h mat body"

/* pick_read: a snapshot, checked (part_check), with what n expressions and the condition `select`
 * (NULL: all particles) need; then only those for which it holds. `more`: further members that are
 * read when they are there. Texts that are no expression are left out: those who evaluate them say
 * so. */
Parts *pick_read(const char *file, const char *const *text, int n, const char *select,
                 const char *more, Err *err);

/* pick_centre: com, body:K, fragment:K, clump:K (their centres of mass) or X,Y,Z with units, m. */
int pick_centre(double x[3], const Parts *p, const char *text, const char *file, Err *err);

#endif
