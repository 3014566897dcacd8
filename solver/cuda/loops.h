/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pair loops in one precision, as loops.cu chooses them. */
#ifndef LOOPS_H
#define LOOPS_H

#include <stdlib.h>
#include "cuda.h"
extern "C" {
#include "../image.h"
}

typedef struct {
  size_t (*bytes)(const Sim *sim); /* device memory that open takes */
  int (*open)(Sim *sim, Err *err);
  void (*close)(Sim *sim);
  void (*gradient)(Sim *sim);
  void (*density)(Sim *sim);
  void (*force)(Sim *sim);
} LoopsOf;

extern const LoopsOf loops_mixed, loops_double;

#endif
