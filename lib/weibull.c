/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The sequence of a group is drawn twice, to count and to fill, so that it need not be kept. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_cdf.h>
#include <gsl/gsl_integration.h>
#include <gsl/gsl_sf_gamma.h>
#include <hdf5.h>
#include "rng.h"
#include "weibull.h"

typedef struct {
  int32_t body, mat;
  int64_t id;
  long i; /* row in Parts */
} Member;

static int order(const void *a, const void *b)
{
  const Member *p = a, *q = b;
  if (p->body != q->body) return p->body < q->body ? -1 : 1;
  if (p->mat != q->mat) return p->mat < q->mat ? -1 : 1;
  return (p->id > q->id) - (p->id < q->id);
}

double weibull_threshold(int64_t j, double k, double m, double volume)
{
  return exp((log((double)j) - log(k) - log(volume)) / m);
}

/* The particles of brittle materials, by body, material and id. */
static Member *members(const Parts *p, const Material *material, long *n)
{
  Member *member = malloc((size_t)(p->n + 1) * sizeof *member);
  *n = 0;
  for (long i = 0; member && i < p->n; i++)
    if (material_brittle(material + p->mat[i]))
      member[(*n)++] = (Member){p->body[i], p->mat[i], p->id[i], i};
  if (member) qsort(member, (size_t)*n, sizeof *member, order);
  return member;
}

typedef struct {
  double n, minimum;
  int moment;
} Wanted;

/* Chance that n particles with t flaws each on average are not all served, times t^moment. */
static double unserved(double t, void *wanted)
{
  const Wanted *w = wanted;
  double few = gsl_cdf_poisson_P((unsigned)w->minimum - 1, t);
  return (w->moment ? t : 1) * -expm1(w->n * log1p(-few));
}

/* With throws at random times, one a unit of time and particle, the last needed has a time of mean
 * and mean square integral Q dt and 2 integral t Q dt, Q the above; their number's variance is that
 * of the time without the times' own. */
double weibull_expected(long n, long minimum, double flaws, double *scatter)
{
  Wanted wanted = {.n = (double)n, .minimum = (double)minimum};
  gsl_function f = {unserved, &wanted};
  gsl_integration_workspace *w = minimum > 0 ? gsl_integration_workspace_alloc(200) : NULL;
  double end = flaws + 1, sum[2] = {0}, error, mean;
  *scatter = 0;
  if (!w) return minimum > 0 ? NAN : flaws * (double)n;
  while (unserved(end, &wanted) > 1e-16) end *= 1.5;
  for (; wanted.moment < 2; wanted.moment++)
    gsl_integration_qag(&f, flaws, end, 0, 1e-10, 200, GSL_INTEG_GAUSS61, w, sum + wanted.moment,
                        &error);
  gsl_integration_workspace_free(w);
  mean = flaws + sum[0];
  *scatter = wanted.n * sqrt(fmax(flaws * flaws + 2 * sum[1] - mean * mean - mean / wanted.n, 0));
  return wanted.n * mean;
}

/* Mean of the weakest flaw's threshold: its number is geometrically distributed with 1/n, nearly
 * exponentially, and not above the number thrown when some particles have none. */
static double expected_weakest(const WeibullGroup *g, long minimum)
{
  double a = 1 + 1 / g->m, t = (double)g->flaws / (double)g->n;
  double share = minimum > 0 ? 1 : gsl_sf_gamma_inc_P(a, t) / -expm1(-t);
  return gsl_sf_gamma(a) * share * weibull_threshold(g->n, g->k, g->m, g->volume);
}

/* Which of the n particles flaw j goes to. */
static long draw(const WeibullGroup *g, const Parts *p, int64_t j)
{
  uint32_t key = (uint32_t)g->body * (uint32_t)p->materials + (uint32_t)g->mat;
  long k = (long)(rng_uniform(g->seed, (uint64_t)j, key) * (double)g->n);
  return k < g->n ? k : g->n - 1;
}

static void count(const Parts *p, WeibullGroup *g, const Member *member, const WeibullOptions *o)
{
  int64_t least = (int64_t)ceil(o->flaws * (double)g->n);
  long wanting = o->minimum > 0 ? g->n : 0, with = 0;
  while (wanting > 0 || g->flaws < least) {
    int32_t *here = p->nflaw + member[draw(g, p, ++g->flaws)].i;
    if (*here == 0) g->weakest += weibull_threshold(g->flaws, g->k, g->m, g->volume), with++;
    if (++*here == o->minimum) wanting--;
  }
  g->weakest /= (double)with, g->least = INT32_MAX;
  for (long k = 0; k < g->n; k++) {
    int32_t here = p->nflaw[member[k].i];
    g->least = here < g->least ? here : g->least, g->most = here > g->most ? here : g->most;
  }
  g->lowest = weibull_threshold(1, g->k, g->m, g->volume);
  g->highest = weibull_threshold(g->flaws, g->k, g->m, g->volume);
  g->expected = weibull_expected(g->n, o->minimum, o->flaws, &g->scatter);
  g->weakest_expected = expected_weakest(g, o->minimum);
}

static void fill(const Parts *p, const WeibullGroup *g, const Member *member, int64_t *next)
{
  for (int64_t j = 1; j <= g->flaws; j++)
    p->flaw[next[member[draw(g, p, j)].i]++] = weibull_threshold(j, g->k, g->m, g->volume);
}

/* The group that begins at member[0]. distention [p->n] or NULL. */
static WeibullGroup begin(const Parts *p, const Material *material, const Member *member, long left,
                          const double *distention, const WeibullOptions *o)
{
  const struct damage_grady_kipp *d = &material[member->mat].damage.grady_kipp;
  WeibullGroup g = {.body = member->body, .mat = member->mat, .seed = o->seed};
  g.k = o->k && !isnan(o->k[g.mat]) ? o->k[g.mat] : d->k;
  g.m = o->m && !isnan(o->m[g.mat]) ? o->m[g.mat] : d->m;
  for (int k = 0; k < o->bodies; k++)
    if (o->seeds[k].body == g.body) g.seed = o->seeds[k].seed;
  for (; g.n < left && member[g.n].body == g.body && member[g.n].mat == g.mat; g.n++) {
    long i = member[g.n].i;
    g.volume += p->m[i] / (p->rho[i] * (distention ? distention[i] : 1));
  }
  return g;
}

static int throw_flaws(Parts *p, const Material *material, const WeibullOptions *o,
                       const double *distention, const Member *member, long n, WeibullGroup *group,
                       int *groups, Err *err)
{
  int64_t *next;
  for (long at = 0; at < n; at += group[(*groups)++].n) {
    group[*groups] = begin(p, material, member + at, n - at, distention, o);
    count(p, group + *groups, member + at, o);
    p->flaws += group[*groups].flaws;
  }
  p->flaw = malloc((size_t)(p->flaws + 1) * sizeof *p->flaw);
  next = part_flaw_start(p);
  if (p->flaw && next)
    for (long at = 0, g = 0; at < n; at += group[g++].n) fill(p, group + g, member + at, next);
  free(next);
  return p->flaw && next ? 0
                         : err_set(err, "no memory for %lld flaws (%.3g GB)", (long long)p->flaws,
                                   (double)p->flaws * sizeof *p->flaw / 1e9);
}

/* The field Distention, known or not, as doubles [p->n]; NULL when there is none, or on failure
 * (*failed). */
static double *pores(const Parts *p, int *failed, Err *err)
{
  static const char NAME[] = "Distention";
  const PartField *f = part_field(NAME);
  const double *known = f ? part_array(p, f) : NULL;
  const PartExtra *x = p->extra;
  double *a = NULL;
  *failed = 0;
  while (x < p->extra + p->extras && strcmp(x->name, NAME)) x++;
  if (x == p->extra + p->extras) x = NULL;
  if (!known && !x) return NULL;
  *failed = 1;
  if (x && x->width != 1) return err_null(err, "field '%s' has %d columns", NAME, x->width);
  if (!(a = malloc(((size_t)p->n + 1) * (x && x->size > 8 ? (size_t)x->size : sizeof *a))))
    return err_null(err, "out of memory");
  memcpy(a, known ? (const void *)known : x->data, (size_t)p->n * (known ? 8 : (size_t)x->size));
  if (!known &&
      H5Tconvert((hid_t)x->type, H5T_NATIVE_DOUBLE, (size_t)p->n, a, NULL, H5P_DEFAULT) < 0)
    return free(a), err_null(err, "field '%s' holds no numbers", NAME);
  for (long i = 0; i < p->n; i++)
    if (!(a[i] >= 1 && isfinite(a[i]))) {
      err_set(err, "particle %lld: %s is %g, must be at least 1", (long long)p->id[i], NAME, a[i]);
      return free(a), NULL;
    }
  *failed = 0;
  return a;
}

/* The number of groups: where body or material changes along the sorted members. */
static size_t count_groups(const Member *member, long n)
{
  size_t groups = n > 0;
  for (long k = 1; k < n; k++)
    groups += member[k].body != member[k - 1].body || member[k].mat != member[k - 1].mat;
  return groups;
}

int weibull_assign(Parts *p, const Material *material, const WeibullOptions *o,
                   WeibullGroup **group, int *groups, Err *err)
{
  long n = 0;
  int failed;
  double *distention = pores(p, &failed, err);
  Member *member = failed ? NULL : members(p, material, &n);
  *groups = 0, *group = NULL;
  if (failed) return -1;
  failed = -1;
  if (!member) {
    err_set(err, "out of memory");
    goto done;
  }
  if (part_add(p, "damage", err)) goto done;
  free(p->nflaw), free(p->flaw);
  p->flaw = NULL, p->flaws = 0;
  p->nflaw = calloc((size_t)p->n + 1, sizeof *p->nflaw);
  *group = calloc(count_groups(member, n) + 1, sizeof **group);
  memset(p->damage, 0, (size_t)p->n * sizeof *p->damage);
  if (p->nact) memset(p->nact, 0, (size_t)p->n * sizeof *p->nact);
  if (p->nflaw && *group)
    failed = throw_flaws(p, material, o, distention, member, n, *group, groups, err);
  else
    err_set(err, "out of memory");
done:
  free(member), free(distention);
  return failed;
}
