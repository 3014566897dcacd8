/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "campaign.h"
#include "lib/spool.h"

typedef struct {
  const Parts *p;
  const Group *lr, *slr, *system; /* lr, slr: NULL where there is none */
  double bound;                   /* kg in all remnants */
} Outcome;

/* Mass from body b (-1: all) of material c (-1: all) [kg]. */
static double share(const Parts *p, const Group *g, int c, int b)
{
  double sum = 0;
  if (!g) return 0;
  for (int k = 0; k < p->materials; k++)
    for (int a = 0; a < g->bodies; a++)
      if ((c < 0 || c == k) && (b < 0 || b == a)) sum += g->part[k * g->bodies + a];
  return sum;
}

static double efficiency(const Outcome *o, int c)
{
  const double target = share(o->p, o->system, c, 0), impactor = share(o->p, o->system, c, 1);
  return o->lr && impactor > 0 ? (share(o->p, o->lr, c, -1) - target) / impactor : NAN;
}

static double stripped(const Outcome *o, int b)
{
  const double whole = share(o->p, o->system, -1, b);
  const double kept = fmax(share(o->p, o->lr, -1, b), share(o->p, o->slr, -1, b));
  return whole > 0 ? 1 - kept / whole : NAN;
}

static void put(FILE *f, int head, const char *name, const char *detail, const char *unit,
                double value)
{
  if (head)
    fprintf(f, "\t%s%s [%s]", name, detail, unit);
  else if (isnan(value))
    fputs("\tnan", f);
  else
    fprintf(f, "\t%.9g", value);
}

/* One line: the names, or the values. */
static void line(FILE *f, const Outcome *o, int head)
{
  const double all = o->system->mass, lr = o->lr ? o->lr->mass : 0, slr = o->slr ? o->slr->mass : 0;
  GroupPair pair = {.r = NAN, .v = NAN, .v_esc = NAN, .orbit = {.e = NAN, .vinf = NAN}};
  if (o->slr)
    pair = group_pair(o->lr->x, o->lr->v, o->lr->mass, o->slr->x, o->slr->v, o->slr->mass);
  const int apart = o->slr && pair.orbit.beta < 0;
  char name[32];
  put(f, head, "time", "", "s", o->p->time), put(f, head, "M", "", "kg", all);
  put(f, head, "M_target", "", "kg", share(o->p, o->system, -1, 0));
  put(f, head, "M_impactor", "", "kg", share(o->p, o->system, -1, 1));
  put(f, head, "M_LR", "", "kg", lr), put(f, head, "M_SLR", "", "kg", slr);
  put(f, head, "M_LR/M", "", "1", lr / all), put(f, head, "M_SLR/M", "", "1", slr / all);
  put(f, head, "M_unbound", "", "kg", all - o->bound);
  put(f, head, "xi", "", "1", efficiency(o, -1));
  for (int c = 0; c < o->p->materials; c++)
    put(f, head, "xi_", o->p->material[c].name, "1", efficiency(o, c));
  for (int b = 0; b < o->system->bodies; b++) {
    snprintf(name, sizeof name, "%d", b);
    put(f, head, "stripped_", name, "1", stripped(o, b));
  }
  put(f, head, "distance", "", "m", pair.r), put(f, head, "v_rel", "", "m/s", pair.v);
  put(f, head, "v_rel/v_esc", "", "1", pair.v / pair.v_esc);
  put(f, head, "e", "", "1", pair.orbit.e), put(f, head, "v_inf", "", "m/s", pair.orbit.vinf);
  put(f, head, "deflection", "", "deg", apart ? 360 / acos(-1) * asin(1 / pair.orbit.e) : NAN);
  fputc('\n', f);
}

int campaign_write(const char *path, const char *file, const Parts *p, const Group *g, long n,
                   double bound, const Group *system, Err *err)
{
  Outcome o = {p, n > 0 ? &g[0] : NULL, n > 1 ? &g[1] : NULL, system, bound};
  char *text = NULL;
  size_t size;
  FILE *f = open_memstream(&text, &size);
  if (!f) return err_set(err, "cannot write '%s': out of memory", path);
  fputs("# file", f), line(f, &o, 1), fputs(file, f), line(f, &o, 0);
  int failed = fclose(f) ? err_set(err, "cannot write '%s': out of memory", path)
                         : spool_text(path, text, err);
  free(text);
  return failed;
}
