/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include "../../lib/figure.h"
#include "report.h"

/* X(name, unit, format, value) */
/* clang-format off */
#define COLUMNS(X) \
  X(n,         "1",   "%.0f", (double)b->p->n) \
  X(time,      "s",   "%.6g", time) \
  X(falls,     "tff", "%.4f", time / b->free_fall) \
  X(v_rms,     "vesc", "%.3e", m->rms) \
  X(v_999,     "vesc", "%.3e", m->high) \
  X(v_max,     "vesc", "%.3e", m->max) \
  X(balance,   "1",   "%.3e", m->balance) \
  X(rho_off,   "1",   "%.3e", m->density) \
  X(rho_off_inside, "1", "%.3e", m->inside) \
  X(p_c,       "1",   "%.4f", m->pressure) \
  X(radius,    "m",   "%.8g", top->r) \
  X(equator,   "m",   "%.8g", equator[0]) \
  X(reach,     "m",   "%.8g", m->radius) \
  X(r_volume,  "m",   "%.8g", m->volume) \
  X(spacing,   "m",   "%.6g", b->spacing)
/* clang-format on */

static void say(const char *what, const Body *b, const Measure *m, double time)
{
  fprintf(stderr,
          "relax: %s: %.3g s (%.2f free-fall times): rms v %.2e, 99.9 %% %.2e, max %.2e v_esc; "
          "K/|W| %.1e; density off the profile by %.2e rms",
          what, time, time / b->free_fall, m->rms, m->high, m->max, m->balance, m->density);
  if (!isnan(m->inside)) fprintf(stderr, " (%.2e away from surfaces)", m->inside);
  fprintf(stderr, "; central pressure %.3f of it\n", m->pressure);
}

void report_run(Report *r, const char *name, const char *what, const Body *b, const Measure *m,
                double time)
{
  const StructureNode *top = &b->s.node[b->s.n - 1];
  double equator[3] = {top->r, 0, 0};
  size_t size = sizeof r->text, at = strlen(r->text);
  figure_flatten(top, equator);
#define HEAD(NAME, UNIT, ...)                                                                      \
  at += (size_t)snprintf(r->text + at, size - at, "\t" #NAME "[" UNIT "]");
#define CELL(NAME, UNIT, FORMAT, VALUE)                                                            \
  at += (size_t)snprintf(r->text + at, size - at, "\t" FORMAT, VALUE);
  if (!at) {
    at = (size_t)snprintf(r->text, size, "# run");
    COLUMNS(HEAD)
    at += (size_t)snprintf(r->text + at, size - at, "\n");
  }
  at += (size_t)snprintf(r->text + at, size - at, "%s", name);
  COLUMNS(CELL)
  snprintf(r->text + at, size - at, "\n");
  say(what, b, m, time);
}
