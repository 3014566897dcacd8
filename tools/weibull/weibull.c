/* SPDX-License-Identifier: GPL-3.0-or-later */
/* weibull: gives the brittle particles of a body their flaws (001 eq. 45; lib/weibull.h). */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "lib/material.h"
#include "lib/opt.h"
#include "lib/snap.h"
#include "lib/unit.h"
#include "lib/weibull.h"

static struct {
  OptList seed, k, m;
  long minimum;
  double flaws;
  int verbose;
  const char *out;
} o;

/* clang-format off */
static const Opt OPTS[] = {
  {"seed",      's', OPT_LIST, "1",  "[BODY:]N", "seed of the random numbers, of all bodies or of one", &o.seed},
  {"weibull-k", 'k', OPT_LIST, NULL, "[MATERIAL:]K", "Weibull k [1/m^3] instead of the material's own", &o.k},
  {"weibull-m", 'm', OPT_LIST, NULL, "[MATERIAL:]M", "Weibull m likewise", &o.m},
  {"flaws",     'f', OPT_REAL, "0",  "1",    "throw at least so many a particle on average", &o.flaws},
  {"minimum",   0,   OPT_INT,  "1",  "N",    "and on until each particle has so many; 0: --flaws alone counts", &o.minimum},
  {"verbose",   'v', OPT_FLAG, NULL, NULL,   "a table of each body and material on stderr", &o.verbose},
  {"output",    'o', OPT_TEXT, "-",  "FILE", "where the body goes", &o.out},
  {NULL, 0, OPT_FLAG, NULL, NULL, NULL, NULL}};

static const OptProgram PROGRAM = {
  "weibull", "give brittle particles their flaws", "[options] [body.h5] > body.h5",
  "In each body, the particles of one brittle material share their volume V (without pores), in which k V e^m flaws open below "
  "the strain e. The flaws are thrown at random, the weakest first, until every particle has one; the damage starts at zero. "
  "The result depends on ids and seed only.",
  "mksphere -n 5000 --radius 15km --layer basalt | weibull --seed 2 --verbose > target.h5", OPTS, 0, 1};
/* clang-format on */

static const double MOST_FLAWS = 1e4; /* a particle */

static void table(const Parts *p, const WeibullGroup *group, int groups)
{
  fprintf(
      stderr,
      "# body\tmaterial\tparticles\tvolume [m^3]\tk [1/m^3]\tm\tseed\tflaws\texpected\tscatter\t"
      "per particle\tleast\tmost\tlowest\thighest\tweakest\texpected\tmemory [B]\n");
  for (const WeibullGroup *g = group; g < group + groups; g++)
    fprintf(stderr,
            "%d\t%s\t%ld\t%.9g\t%.9g\t%.9g\t%llu\t%lld\t%.9g\t%.4g\t%.6g\t%d\t%d\t%.9g\t%.9g\t%."
            "6g\t%.6g\t"
            "%lld\n",
            g->body, p->material[g->mat].name, g->n, g->volume, g->k, g->m,
            (unsigned long long)g->seed, (long long)g->flaws, g->expected, g->scatter,
            (double)g->flaws / (double)g->n, g->least, g->most, g->lowest, g->highest, g->weakest,
            g->weakest_expected,
            (long long)(g->flaws * (int64_t)sizeof *p->flaw + g->n * (long)sizeof *p->nflaw));
}

/* All groups in one line, and what is odd about one of them. */
static void summary(const Parts *p, const WeibullGroup *group, int groups)
{
  double expected = 0, variance = 0, lowest = INFINITY;
  long n = 0;
  for (const WeibullGroup *g = group; g < group + groups; g++) {
    expected += g->expected, variance += g->scatter * g->scatter, n += g->n,
        lowest = fmin(lowest, g->lowest);
    if (g->highest > 1)
      err_warn("%s of body %d: thresholds up to %.3g: k V is small for %ld particles",
               p->material[g->mat].name, g->body, g->highest, g->n);
  }
  fprintf(stderr,
          "weibull: %lld flaws (%.0f +- %.0f expected) for %ld particles, %.4g each, lowest "
          "threshold %.4g, "
          "%.3g MB\n",
          (long long)p->flaws, expected, sqrt(variance), n, (double)p->flaws / (double)n, lowest,
          ((double)p->flaws * sizeof *p->flaw + (double)n * sizeof *p->nflaw) / 1e6);
}

/* The number behind NAME: of an entry; *name is NULL without one. Points into a copy of text. */
static const char *split(char *copy, char **name)
{
  char *colon = strrchr(copy, ':');
  *name = colon ? copy : NULL;
  if (!colon) return copy;
  *colon = 0;
  return colon + 1;
}

static char *copy_of(const char *text)
{
  char *copy = strdup(text);
  if (!copy) err_die("out of memory");
  return copy;
}

static void read_seed(const char *text, WeibullOptions *w, WeibullSeed *seeds)
{
  char *copy = copy_of(text), *name;
  const char *number = split(copy, &name);
  long seed, body = 0;
  Err err;
  if (unit_count(number, &seed, &err) || (name && unit_count(name, &body, &err)))
    err_usage("--seed: %s", err.text);
  if (seed < 0) err_usage("seed %ld is negative", seed);
  if (body < 0 || body > INT32_MAX) err_usage("--seed: '%s': there is no body %ld", text, body);
  for (int k = 0; k < w->bodies && name; k++)
    if (seeds[k].body == body) err_usage("--seed: body %ld twice", body);
  if (name)
    seeds[w->bodies++] = (WeibullSeed){(int32_t)body, (uint64_t)seed};
  else
    w->seed = (uint64_t)seed;
  free(copy);
}

static WeibullSeed *read_seeds(WeibullOptions *w)
{
  WeibullSeed *seeds = malloc(((size_t)o.seed.n + 1) * sizeof *seeds);
  if (!seeds) err_die("out of memory");
  w->seed = 1;
  for (int k = 0; k < o.seed.n; k++) read_seed(o.seed.text[k], w, seeds);
  return seeds;
}

static void check_seeds(const WeibullOptions *w, const Parts *p, const char *file)
{
  for (int k = 0; k < w->bodies; k++) {
    long i = 0;
    while (i < p->n && p->body[i] != w->seeds[k].body) i++;
    if (i == p->n) err_die("--seed: '%s' has no body %d", file, w->seeds[k].body);
  }
}

/* Sets value[] of the materials called name, or of all brittle ones without a name. */
static void set(double *value, const char *name, double x, const char *option, const Parts *p,
                const Material *material, const char *file)
{
  const char *names[64], *near;
  int found = 0, n = 0;
  for (int c = 0; c < p->materials; c++) {
    if (n < 64) names[n++] = p->material[c].name;
    if (name && strcmp(p->material[c].name, name)) continue;
    if (name && !material_brittle(material + c))
      err_die("--%s: %s does not break (its file has no damage)", option, name);
    value[c] = x, found = 1;
  }
  if (found || !name) return;
  near = unit_nearest(name, names, n);
  err_die("--%s: no material '%s' in '%s'%s%s%s", option, name, file,
          near ? " (did you mean '" : "", near ? near : "", near ? "'?)" : "");
}

/* Weibull's k or m of each material, NAN where it is the material's own; what is given for one of
 * them wins. */
static double *parameters(const OptList *list, const char *option, const char *unit, double least,
                          const Parts *p, const Material *material, const char *file)
{
  double *value = malloc(((size_t)p->materials + 1) * sizeof *value), x;
  Err err;
  if (!value) err_die("out of memory");
  for (int c = 0; c < p->materials; c++) value[c] = NAN;
  for (int pass = 0; pass < 2; pass++)
    for (int k = 0; k < list->n; k++) {
      char *copy = copy_of(list->text[k]), *name;
      const char *number = split(copy, &name);
      if (unit_parse(number, unit, &x, &err)) err_usage("--%s: %s", option, err.text);
      if (!(least > 0 ? x >= least : x > 0))
        err_usage("--%s: %g is %s", option, x, least > 0 ? "less than 1" : "not positive");
      if (pass == (name != NULL)) set(value, name, x, option, p, material, file);
      free(copy);
    }
  return value;
}

static void check_options(void)
{
  if (!(o.flaws >= 0 && o.flaws <= MOST_FLAWS))
    err_usage("--flaws: %g is not in 0..%g", o.flaws, MOST_FLAWS);
  if (o.minimum < 0 || o.minimum > 1000) err_usage("--minimum: %ld is not in 0..1000", o.minimum);
  if (o.minimum == 0 && o.flaws == 0) err_usage("--minimum 0: then say how many by --flaws");
}

int main(int argc, char **argv)
{
  Err err;
  int n, groups;
  char *line = opt_command_line(argc, argv);
  char **input = opt_parse(&PROGRAM, argc, argv, &n);
  const char *file = n ? input[0] : "-";
  WeibullOptions w = {.flaws = o.flaws, .minimum = o.minimum};
  WeibullGroup *group;
  Material *material;
  Parts *p;
  check_options();
  WeibullSeed *seeds = read_seeds(&w);
  if (!(p = snap_read(file, &err)) || part_need(p, "id m rho mat body", file, &err) ||
      part_check(p, file, &err) || !(material = material_load(p, &err)))
    err_die("%s", err.text);
  w.seeds = seeds;
  check_seeds(&w, p, file);
  double *k = parameters(&o.k, "weibull-k", "1/m^3", 0, p, material, file);
  double *m = parameters(&o.m, "weibull-m", "1", 1, p, material, file);
  w.k = k, w.m = m;
  if (weibull_assign(p, material, &w, &group, &groups, &err)) err_die("'%s': %s", file, err.text);
  if (!groups) err_warn("no particle is of a brittle material: there are no flaws");
  if (part_history(p, line, &err) || snap_write(p, o.out, 0, &err)) err_die("%s", err.text);
  if (o.verbose) table(p, group, groups);
  if (groups) summary(p, group, groups);
  free(group), material_free(material, p->materials), free(line), free(seeds), free(k), free(m),
      part_free(p);
  free(o.seed.text), free(o.k.text), free(o.m.text);
  return 0;
}
