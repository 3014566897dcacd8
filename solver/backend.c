/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What all backends share: the clock of each pass. */
#include "../lib/progress.h"
#include "backend.h"

void backend_begin(Sim *sim, int timer) { sim->timer[timer].start = progress_clock(); }

void backend_end(Sim *sim, int timer)
{
  BackendTimer *t = &sim->timer[timer];
  t->spent += progress_clock() - t->start;
  t->calls++;
}
