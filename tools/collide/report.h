/* SPDX-License-Identifier: GPL-3.0-or-later */
/* All numbers of a collision in one list: what --dry-run prints (angles in degrees) and /Collision
 * holds (SI, those that are finite). */
#ifndef COLLIDE_REPORT_H
#define COLLIDE_REPORT_H

#include "geometry.h"

typedef struct {
  char name[64];
  const char *unit, *meaning;
  double value;
} ReportRow;

typedef struct {
  ReportRow row[128];
  int n;
} Report;

/* report_add: one more number. */
void report_add(Report *r, const char *name, const char *unit, const char *meaning, double value);

/* report_collision: orbit, contact, start, masses, energies, spins. Bodies in their places. */
void report_collision(Report *r, const Geometry *g, const Body b[2]);

void report_print(const Report *r);
int report_store(const Report *r, Parts *p, Err *err);

#endif
