/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the command line says. */
#ifndef OPTIONS_H
#define OPTIONS_H

#include "../../lib/opt.h"

/* A time, in seconds or in free-fall times of the body (0.3tff); the other is 0. */
typedef struct {
  double s, falls;
} Span;

typedef struct {
  const char *output, *profile, *method, *device, *freeze, *checkpoint, *report;
  const char *damping_text, *max_time_text, *proof_text;
  Span damping, max_time, proof;
  int only, radial, fluid, rigid, again;
  long nodes;
  OptList set;
} Options;

#endif
