/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where the time went. */
#ifndef PROFILE_H
#define PROFILE_H

#include <stdio.h>
#include "sim.h"

/* The passes by their timers. */
extern const char *const profile_names[TIMERS];

/* profile_print: the table of passes: name, calls, seconds, per particle and step microseconds x
 * core (cpu) or ns (a card, of its own clock). */
void profile_print(const Sim *sim, long steps, FILE *to);

#endif
