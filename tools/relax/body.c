/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "../../lib/figure.h"
#include "../../lib/lagrange.h"
#include "../../lib/lay.h"
#include "../../lib/material.h"
#include "../../lib/profile.h"
#include "../../lib/recipe.h"
#include "../../lib/snap.h"
#include "../../lib/unit.h"
#include "../../solver/sim.h"
#include "body.h"

static const double PI = 3.14159265358979323846;

static int write_profile(const Body *b, const char *path, Err *err)
{
  const char *names[STRUCTURE_LAYERS], *texts[STRUCTURE_LAYERS];
  for (int k = 0; k < b->recipe.layers; k++) {
    names[k] = b->p->material[b->recipe.layer[k].mat].name;
    texts[k] = b->p->material[b->recipe.layer[k].mat].text;
  }
  return profile_write(path, &b->s, &b->recipe, names, texts, err);
}

/* The recipe in the file, else the layers that the particles show. Uncompressed bodies show theirs;
 * of others each particle gets its layer. */
static int layers(Body *b, Err *err)
{
  StructureBody seen;
  Err why;
  int known = recipe_load(b->p, b->material, &b->recipe, err);
  int uniform = lay_layers(b->p, b->material, &seen, b->layer, &why);
  if (known < 0) return -1;
  if (!known && uniform < 0) return err_set(err, "%s, and /Body does not say its layers", why.text);
  b->laid = uniform > 0 && (!known || uniform == known);
  if (!known) b->recipe = seen;
  return b->laid ? 0 : lay_assign(b->p, &b->recipe, b->layer, err);
}

static int solve(Body *b, const Options *o, Err *err)
{
  double period = part_number(b->p, "body", "SpinPeriod0");
  b->omega = isnan(period) ? NAN : 2 * PI / period;
  if (!strcmp(o->method, "shells") ? lagrange_relax(&b->s, &b->recipe, o->nodes, err)
                                   : structure_solve(&b->s, &b->recipe, o->nodes, err))
    return -1;
  return isnan(b->omega) ? 0 : figure_spin(&b->s, &b->recipe, b->omega, err);
}

static void turn(Parts *p, double omega)
{
  for (long i = 0; i < p->n; i++)
    p->v[3 * i] = -omega * p->x[3 * i + 1], p->v[3 * i + 1] = omega * p->x[3 * i],
             p->v[3 * i + 2] = 0;
}

int body_read(Body *b, const char *path, const Options *o, Err *err)
{
  const char *label = path ? path : "stdin";
  const StructureNode *top;
  if (!(b->p = snap_read(path, err))) return -1;
  if (part_need(b->p, SIM_FIELDS, label, err) || part_check(b->p, label, err)) return -1;
  if (b->p->points) return err_set(err, "'%s' has point masses: a body is relaxed alone", label);
  if (!(b->material = material_load(b->p, err))) return -1;
  if (!(b->layer = malloc(sizeof *b->layer * (size_t)(b->p->n ? b->p->n : 1))))
    return err_set(err, "not enough memory");
  if (layers(b, err) || solve(b, o, err)) return -1;
  top = &b->s.node[b->s.n - 1];
  b->free_fall = sqrt(PI * PI * pow(top->r, 3) / (8 * UNIT_G * top->m));
  b->sound = top->r / b->s.node[0].cs;
  b->spacing = cbrt(4. / 3 * PI * pow(top->r, 3) / (double)b->p->n * sqrt(2));
  if (o->profile && write_profile(b, o->profile, err)) return -1;
  if (o->only) return write_profile(b, "-", err);
  if (b->laid && lay_body(b->p, b->material, &b->s, err)) return -1;
  if (b->laid && !isnan(b->omega)) turn(b->p, b->omega);
  return recipe_store(b->p, &b->recipe, err);
}

int body_keep(Body *b, const unsigned char *keep, Err *err)
{
  Parts *left = part_select(b->p, keep, err);
  long n = 0;
  if (!left) return -1;
  for (long i = 0; i < b->p->n; i++) {
    if (!keep[i]) b->recipe.layer[b->layer[i]].mass -= b->p->m[i];
    if (keep[i]) b->layer[n++] = b->layer[i];
  }
  part_free(b->p), b->p = left;
  return recipe_store(b->p, &b->recipe, err);
}

void body_free(Body *b)
{
  if (b->material) material_free(b->material, b->p->materials);
  part_free(b->p), structure_free(&b->s), free(b->layer);
}
