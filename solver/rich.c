/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which of the pair terms of pair_rich.h a run has, and with which numbers. */
#include <math.h>
#include <string.h>
#include "sim.h"

/* Fields that only such runs have, and which: */
static const struct {
  const char *name;
  int stored; /* in a checkpoint */
} fields[] = {{"extra", 0}, {"viscosity", 1}, {"div0", 1},
              {"sense", 1}, {"wander", 1},    {"drho", 1}};
enum { EXTRA, VISCOSITY, DIV0, SENSE, WANDER, DRHO, FIELDS };

static int has(const Sim *sim, int field)
{
  const Param *p = &sim->par;
  switch (field) {
  case EXTRA: return sim->rich;
  case VISCOSITY:
  case DIV0: return p->viscosity_switch != RICH_NONE;
  case SENSE: return p->viscosity_switch == RICH_CULLEN_DEHNEN;
  case WANDER: return p->xsph > 0;
  default: return p->diffusion > 0;
  }
}

int rich_idle(const Sim *sim, const char *member)
{
  for (int k = 0; k < FIELDS; k++)
    if (strcmp(member, fields[k].name) == 0) return !has(sim, k);
  return 0;
}

const char *rich_fields(const Sim *sim, char names[RICH_NAMES])
{
  names[0] = 0;
  for (int k = 0; k < FIELDS; k++)
    if (fields[k].stored && has(sim, k)) strcat(strcat(names, " "), fields[k].name);
  return names;
}

/* The mean distance of particles over h. */
static double spacing(const Parts *p)
{
  double sum = 0;
  for (long i = 0; i < p->n; i++) sum += pow(p->m[i] / p->rho[i], 1. / p->dimension) / p->h[i];
  return p->n ? sum / (double)p->n : 1;
}

/* h over (m/rho)^(1/D): with the wanted number of neighbours in a support; or as it is in the
 * mean. */
static double eta(const Param *par, const Parts *p)
{
  static const double ball[] = {2, 3.14159265358979323846, 4 * 3.14159265358979323846 / 3};
  if (par->smoothing == PARAM_NEIGHBOURS)
    return pow(par->neighbours / ball[p->dimension - 1], 1. / p->dimension);
  return 1 / spacing(p);
}

void rich_open(Sim *sim, const Parts *p)
{
  Param *par = &sim->par;
  PairMore *m = &sim->more;
  double w;
  if (par->grad_h && par->eta == 0) par->eta = eta(par, p);
  sim->rich = par->grad_h || par->stress_form != PARAM_PRODUCT || par->viscosity_switch ||
              par->balsara || par->artificial > 0 || par->xsph > 0 || par->diffusion > 0;
  if (!sim->rich) return;
  if (par->spacing == 0) par->spacing = spacing(p);
  w = par->spacing < 1 ? kernel_w(par->kernel, p->dimension, par->spacing) : 0;
  m->over = w > 0 ? 1 / w : 0;
  m->miscible = sim->miscible, m->grad = par->grad_h;
  m->own = m->miscible || m->grad;
  m->squares = par->stress_form == PARAM_SQUARES;
  m->exponent = par->stress_exponent;
  memcpy(m->g, par->force, sizeof m->g);
}

Rich rich_step(const Sim *sim)
{
  const Param *p = &sim->par;
  return (Rich){sim->more.squares,  p->viscosity_switch, p->balsara,
                p->viscosity_least, p->artificial,       p->xsph,
                p->diffusion};
}
