/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The unknowns are the logarithms of the layers' masses, the equations what is given, each as a
 * logarithm that vanishes; GSL's hybrid Newton method. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_multiroots.h>
#include "recipe.h"
#include "unit.h"

static const double PI = 3.14159265358979323846;

double recipe_volume(int dimension, double r)
{
  return dimension == 3 ? 4 * PI / 3 * r * r * r : dimension == 2 ? PI * r * r : 2 * r;
}

double recipe_radius(int dimension, double volume)
{
  return dimension == 3   ? cbrt(volume / (4 * PI / 3))
         : dimension == 2 ? sqrt(volume / PI)
                          : volume / 2;
}

/* One word of a layer's state. */
static int state(StructureLayer *l, const char *word, Err *err)
{
#define UNIT(CAPITAL, NAME, UNIT_OF, ...) UNIT_OF,
#define NAME(CAPITAL, NAME_OF, ...)       #NAME_OF,
  static const char *const units[] = {STRUCTURE_ANCHORS(UNIT)};
  static const char *const names[] = {STRUCTURE_ANCHORS(NAME)};
  const char *equals = strchr(word, '=');
  if (!strcmp(word, "isentropic")) return l->power = 0;
  if (!strcmp(word, "isothermal")) return l->power = 1, l->exponent = 0, 0;
  if (!strcmp(word, "T=continuous")) return l->anchor = STRUCTURE_CONTINUOUS, 0;
  if (!strncmp(word, "power=", 6)) {
    l->power = 1;
    if (unit_parse(word + 6, "1", &l->exponent, err)) return -1;
    return fabs(l->exponent) <= 10 ? 0 : err_set(err, "%s is not in -10 to 10", word);
  }
  if (!strncmp(word, "pores=", 6)) {
    if (unit_parse(word + 6, "1", &l->pores, err)) return -1;
    return l->pores >= 0 && l->pores < 1 ? 0 : err_set(err, "%s is not in 0 to 1", word);
  }
  for (int k = 0; equals && k < STRUCTURE_CONTINUOUS; k++)
    if (strlen(names[k]) == (size_t)(equals - word) &&
        !strncmp(word, names[k], (size_t)(equals - word))) {
      if (unit_parse(equals + 1, units[k], &l->at, err)) return -1;
      l->anchor = k;
      if (l->at >= 0 || k == STRUCTURE_ENTROPY) return 0;
      return err_set(err, "%s is negative", word);
    }
  return err_set(
      err, "'%s' is not u=, s=, T=, T=continuous, isentropic, isothermal, power= or pores=", word);
}

static int share(Recipe *r, int k, const char *text, Err *err)
{
  Err mass, fraction;
  double *to = &r->share[k];
  if (!*text) return 0;
  if (unit_parse(text, "1", to, &fraction)) {
    *to = NAN;
    if (unit_parse(text, "kg", to = &r->layer_mass[k], &mass)) {
      *to = NAN;
      if (unit_parse(text, "m", to = &r->end[k], err))
        return err_set(err, "'%s' is not a mass fraction, a mass or a radius", text);
    }
  }
  if (*to > 0) return 0;
  return err_set(err, "the %s is not positive",
                 to == &r->share[k] ? "mass fraction"
                 : to == &r->end[k] ? "radius"
                                    : "mass");
}

int recipe_layer(Recipe *r, const char *text, const StructureLayer *standard, char *material,
                 Err *err)
{
  char part[3][256] = {"", "", ""}, *word, *rest;
  int k = r->body.layers, n = 0;
  StructureLayer *l = &r->body.layer[k];
  Err why;
  if (k == STRUCTURE_LAYERS) return err_set(err, "more than %d layers", STRUCTURE_LAYERS);
  for (const char *at = text; at; n++) {
    size_t length = strcspn(at, ":");
    if (n == 3 || length > 255)
      return err_set(err, "layer '%s' is not MATERIAL[:SHARE][:STATE]", text);
    memcpy(part[n], at, length);
    at = at[length] ? at + length + 1 : NULL;
  }
  *l = *standard;
  r->share[k] = r->layer_mass[k] = r->end[k] = NAN;
  strcpy(material, part[0]);
  if (share(r, k, part[1], &why)) return err_set(err, "layer '%s': %s", text, why.text);
  for (word = strtok_r(part[2], ",", &rest); word; word = strtok_r(NULL, ",", &rest))
    if (state(l, word, &why)) return err_set(err, "layer '%s': %s", text, why.text);
  r->body.layers++;
  return 0;
}

/* Outer radii of the layers: without gravity from their volumes, else by solving the structure. */
static int radii(const StructureBody *body, int dimension, double *r, Err *err)
{
  StructureState anchor[STRUCTURE_LAYERS], at;
  Structure s;
  double volume = 0;
  if (!body->weightless) {
    if (structure_solve(&s, body, 16, err)) return -1;
    for (int k = 0; k < body->layers; k++) r[k] = s.node[s.first[k + 1] - 1].r;
    structure_free(&s);
    return 0;
  }
  if (structure_anchors(body, anchor, err)) return -1;
  for (int k = 0; k < body->layers; k++) {
    if (structure_move(&body->layer[k], &anchor[k], body->outer, &at))
      return err_set(err, "layer %d has no state at %g Pa", k + 1, body->outer);
    volume += body->layer[k].mass / at.rho / (1 - body->layer[k].pores),
        r[k] = recipe_radius(dimension, volume);
  }
  return 0;
}

typedef struct {
  Recipe *r;
  int dimension, shares; /* how many of the given shares are equations */
  Err err;
} Task;

/* The equations, f[k] = 0; returns how many, or -1. */
static int equations(Task *t, double *f)
{
  const Recipe *r = t->r;
  double sum = 0, at[STRUCTURE_LAYERS];
  int n = 0, any = !isnan(r->radius), shares = 0;
  for (int k = 0; k < r->body.layers; k++) sum += r->body.layer[k].mass, any |= !isnan(r->end[k]);
  if (any && radii(&r->body, t->dimension, at, &t->err)) return -1;
  for (int k = 0; k < r->body.layers; k++) {
    double m = r->body.layer[k].mass;
    if (!isnan(r->share[k]) && shares++ < t->shares) f[n++] = log(m / sum / r->share[k]);
    if (!isnan(r->layer_mass[k])) f[n++] = log(m / r->layer_mass[k]);
    if (!isnan(r->end[k])) f[n++] = log(at[k] / r->end[k]);
  }
  if (!isnan(r->mass)) f[n++] = log(sum / r->mass);
  if (!isnan(r->radius)) f[n++] = log(at[r->body.layers - 1] / r->radius);
  return n;
}

static int residual(const gsl_vector *x, void *task, gsl_vector *f)
{
  Task *t = task;
  double out[3 * STRUCTURE_LAYERS + 2];
  for (size_t k = 0; k < x->size; k++) {
    double m = exp(gsl_vector_get(x, k));
    if (!(m > 0 && m < 1e60)) return GSL_EBADFUNC;
    t->r->body.layer[k].mass = m;
  }
  if (equations(t, out) < 0) return GSL_EBADFUNC;
  for (size_t k = 0; k < x->size; k++) gsl_vector_set(f, k, out[k]);
  return GSL_SUCCESS;
}

/* How many numbers are given, and whether they make sense together. */
static int count(Task *t, Err *err)
{
  Recipe *r = t->r;
  int n = !isnan(r->mass) + !isnan(r->radius), shares = 0, layers = r->body.layers;
  double sum = 0, before = 0;
  for (int k = 0; k < layers; k++) {
    shares += !isnan(r->share[k]), n += !isnan(r->layer_mass[k]) + !isnan(r->end[k]);
    if (!isnan(r->share[k])) sum += r->share[k];
    if (!isnan(r->end[k]) && r->end[k] <= before)
      return err_set(err, "the outer radius of layer %d is not above that of the layer below",
                     k + 1);
    if (!isnan(r->end[k])) before = r->end[k];
  }
  if (shares == layers && !(fabs(sum - 1) <= 1e-9))
    return err_set(err, "the mass fractions of the layers sum to %.10g, not to 1", sum);
  for (int k = 0; k < layers && shares == layers; k++) r->share[k] /= sum;
  if (shares < layers && !(sum < 1))
    return err_set(err, "the mass fractions of the layers sum to %.10g: nothing is left for others",
                   sum);
  t->shares = shares == layers ? shares - 1 : shares;
  n += t->shares;
  if (n == layers) return 0;
  return err_set(err, "%d of mass, radius and layers' shares given for %d layer%s: %s", n, layers,
                 layers > 1 ? "s" : "", n < layers ? "give more of them" : "give fewer of them");
}

/* A guess: densities at rest, what is unknown in equal parts. */
static void guess(Recipe *r, int dimension)
{
  int n = r->body.layers, open = 0;
  double rho[STRUCTURE_LAYERS], mass = r->mass, mean = 0, below = 0, known = 0, radius = r->radius;
  for (int k = 0; k < n; k++) {
    double rest = eos_rho0(&r->body.layer[k].material->eos);
    rho[k] = rest > 0 ? rest : 1, mean += rho[k] / n;
    if (isnan(mass) && !isnan(r->layer_mass[k]) && !isnan(r->share[k]))
      mass = r->layer_mass[k] / r->share[k];
    if (isnan(radius) && !isnan(r->end[k])) radius = r->end[k] * pow(n / (k + 1.), 1. / dimension);
  }
  if (isnan(mass) && !isnan(radius)) mass = mean * recipe_volume(dimension, radius);
  for (int k = 0; k < n && isnan(mass); k++)
    if (!isnan(r->layer_mass[k])) mass = n * r->layer_mass[k];
  for (int k = 0; k < n; k++) {
    double *m = &r->body.layer[k].mass;
    *m = !isnan(r->layer_mass[k]) ? r->layer_mass[k]
         : !isnan(r->share[k])    ? r->share[k] * mass
         : !isnan(r->end[k])
             ? rho[k] * (recipe_volume(dimension, r->end[k]) - recipe_volume(dimension, below))
             : NAN;
    if (!isnan(r->end[k])) below = r->end[k];
    if (isnan(*m))
      open++;
    else
      known += *m;
  }
  for (int k = 0; k < n; k++)
    if (isnan(r->body.layer[k].mass)) r->body.layer[k].mass = fmax(mass - known, 0.1 * mass) / open;
}

/* Newton's method from the guess; only with radii among the equations. */
static int iterate(Task *t, Err *err)
{
  StructureBody *body = &t->r->body;
  size_t n = (size_t)body->layers;
  gsl_multiroot_function system = {residual, n, t};
  gsl_multiroot_fsolver *solver = gsl_multiroot_fsolver_alloc(gsl_multiroot_fsolver_hybrids, n);
  gsl_vector *x = gsl_vector_alloc(n);
  int status = solver && x ? GSL_SUCCESS : GSL_ENOMEM;
  double worst = INFINITY;
  gsl_set_error_handler_off();
  for (size_t k = 0; k < n && !status; k++) gsl_vector_set(x, k, log(body->layer[k].mass));
  if (!status) status = gsl_multiroot_fsolver_set(solver, &system, x);
  for (int k = 0; k < 200 && !status && worst > 1e-13; k++) {
    status = gsl_multiroot_fsolver_iterate(solver);
    worst = 0;
    for (size_t j = 0; j < n; j++) worst = fmax(worst, fabs(gsl_vector_get(solver->f, j)));
  }
  for (size_t k = 0; k < n && worst < 1e-8; k++)
    body->layer[k].mass = exp(gsl_vector_get(solver->x, k));
  if (x) gsl_vector_free(x);
  if (solver) gsl_multiroot_fsolver_free(solver);
  if (worst < 1e-8) return 0; /* what stops short of 1e-13 has no better */
  return err_set(err, "no body of these layers has the mass and the radii that are given%s%s",
                 t->err.text[0] ? ": " : "", t->err.text);
}

int recipe_count(Recipe *r, Err *err)
{
  Task t = {r, 3, 0, {""}};
  return count(&t, err);
}

int recipe_solve(Recipe *r, int dimension, Err *err)
{
  Task t = {r, dimension, 0, {""}};
  double at[STRUCTURE_LAYERS], f[3 * STRUCTURE_LAYERS + 2], worst = 0;
  int n;
  if (count(&t, err)) return -1;
  guess(r, dimension);
  if ((n = equations(&t, f)) < 0) return err_set(err, "%s", t.err.text);
  for (int k = 0; k < n; k++) worst = fmax(worst, fabs(f[k]));
  if (worst > 1e-14 && iterate(&t, err)) return -1;
  if (radii(&r->body, dimension, at, err)) return -1;
  r->mass = 0;
  for (int k = 0; k < r->body.layers; k++) r->mass += r->body.layer[k].mass;
  r->radius = at[r->body.layers - 1];
  return 0;
}

/* The numbers of layer k in /Body: kept when it is not NAN. */
static int put(Parts *p, int k, const char *name, double value, Err *err)
{
  char key[64];
  snprintf(key, sizeof key, "Layer%d%s0", k + 1, name);
  return isnan(value) ? 0 : part_set_number(p, "body", key, value, err);
}

static double get(const Parts *p, int k, const char *name)
{
  char key[64];
  snprintf(key, sizeof key, "Layer%d%s0", k + 1, name);
  return part_number(p, "body", key);
}

static const char *const ANCHORS[] = {"Energy", "Entropy", "Temperature", "Continuous"};

int recipe_store(Parts *p, const StructureBody *body, Err *err)
{
  for (int k = 0; k < body->layers; k++) {
    const StructureLayer *l = &body->layer[k];
    if (put(p, k, "Mass", l->mass, err) || put(p, k, "Material", l->mat, err) ||
        put(p, k, ANCHORS[l->anchor], l->at, err) ||
        put(p, k, "Exponent", l->power ? l->exponent : NAN, err) ||
        put(p, k, "Pores", l->pores > 0 ? l->pores : NAN, err))
      return -1;
  }
  return part_set_number(p, "body", "Layers0", body->layers, err) ||
                 part_set_number(p, "body", "OuterPressure0", body->outer, err)
             ? -1
             : 0;
}

int recipe_load(const Parts *p, const Material *material, StructureBody *body, Err *err)
{
  double layers = part_number(p, "body", "Layers0"),
         outer = part_number(p, "body", "OuterPressure0");
  *body = (StructureBody){.outer = isnan(outer) ? 0 : outer};
  if (isnan(layers)) return 0;
  if (!(layers >= 1 && layers <= STRUCTURE_LAYERS))
    return err_set(err, "/Body: Layers0 is %g, not 1..%d", layers, STRUCTURE_LAYERS);
  body->layers = (int)layers;
  for (int k = 0; k < body->layers; k++) {
    StructureLayer *l = &body->layer[k];
    double mat = get(p, k, "Material");
    int found = 0;
    l->pores = fmax(0, get(p, k, "Pores"));
    l->mass = get(p, k, "Mass"), l->exponent = get(p, k, "Exponent");
    l->power = !isnan(l->exponent), l->mat = (int)mat;
    for (int a = 0; a <= STRUCTURE_CONTINUOUS && !found; a++)
      if ((found = !isnan(get(p, k, ANCHORS[a])))) l->anchor = a, l->at = get(p, k, ANCHORS[a]);
    if (!found || !(l->mass > 0) || !(mat >= 0 && mat < p->materials))
      return err_set(err, "/Body: layer %d lacks its mass, material or state", k + 1);
    l->material = &material[l->mat];
  }
  return body->layers;
}
