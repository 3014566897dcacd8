/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the command line says; times that are not given are NAN. */
#ifndef OPTIONS_H
#define OPTIONS_H

#include "../../lib/opt.h"

typedef struct {
  const char *output, *profile, *method, *device, *freeze, *checkpoint;
  double damping, max_time, proof; /* s */
  int only, radial, fluid, rigid, again;
  long nodes;
  OptList set;
} Options;

#endif
