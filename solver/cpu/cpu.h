/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The CPU backend's own data, shared by its files. OpenMP everywhere; no result depends on the
 * number of threads. */
#ifndef CPU_H
#define CPU_H

#include "../backend.h"
#include "../../lib/gravity.h"
#include "../../lib/ngb.h"
#include "../../lib/tree.h"

enum { CPU_RECORD = 30 }; /* doubles of the longest record of a pair loop */

typedef struct {
  Tree tree;
  Ngb ngb;
  PairRun run;
  long *order;    /* [room] */
  double *record; /* [room][CPU_RECORD] packed records of the loop at hand */
  void *scratch;  /* [threads][share] bytes, for reordering */
  size_t share;
  double *flaw; /* all thresholds */
  Parts *parts; /* what files hold besides the arrays (not owned) */
} Cpu;

/* cpu_images_find: the images of this search, behind the particles in their present order.
 * cpu_images_order: once the particles are in the tree's order, the images, too. */
int cpu_images_find(Sim *sim, Err *err);
int cpu_images_order(Sim *sim, Err *err);
void cpu_gradient(Sim *sim);
void cpu_force(Sim *sim);
void cpu_density(Sim *sim);
int cpu_points(Sim *sim, const PointField *field, PointReaction *reaction, Err *err);
int cpu_limits(Sim *sim, const Step *step, Limits *out, Err *err);
int cpu_sums(Sim *sim, Sums *out, Err *err);
int cpu_bodies(Sim *sim, Step *step, Err *err);
int cpu_change(Sim *sim, double *relative, Err *err);
int cpu_error(Sim *sim, const Step *step, double *worst, Err *err);

#endif
