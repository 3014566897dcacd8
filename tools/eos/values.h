/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Numbers from options and from stdin. Every mistake ends the program, naming the option or the
 * line. */
#ifndef VALUES_H
#define VALUES_H

typedef struct {
  double *x; /* [n], to be freed */
  long n, room;
} Values;

/* values_read: a list of numbers with or without unit separated by commas, of LOW:HIGH:N and
 * log:LOW:HIGH:N. kind: the SI unit; where: the option. */
Values values_read(const char *list, const char *kind, const char *where);

/* values_break: a value twice into ascending ones, where it lies between their ends. */
void values_break(Values *v, double x);

/* values_pairs: density and energy of each line of stdin. */
void values_pairs(Values *rho, Values *u);

#endif
