/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The sequence of a group is drawn twice, to count and to fill, so that it need not be kept. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
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

/* Which of the n particles flaw j goes to. */
static long draw(const WeibullGroup *g, const Parts *p, uint64_t seed, int64_t j)
{
  uint32_t key = (uint32_t)g->body * (uint32_t)p->materials + (uint32_t)g->mat;
  long k = (long)(rng_uniform(seed, (uint64_t)j, key) * (double)g->n);
  return k < g->n ? k : g->n - 1;
}

static void count(const Parts *p, WeibullGroup *g, const Member *member, uint64_t seed)
{
  for (long empty = g->n; empty > 0;) {
    int32_t *here = p->nflaw + member[draw(g, p, seed, ++g->flaws)].i;
    if ((*here)++ == 0) empty--;
  }
  g->lowest = weibull_threshold(1, g->k, g->m, g->volume);
  g->highest = weibull_threshold(g->flaws, g->k, g->m, g->volume);
}

static void fill(const Parts *p, const WeibullGroup *g, const Member *member, uint64_t seed,
                 int64_t *next)
{
  for (int64_t j = 1; j <= g->flaws; j++)
    p->flaw[next[member[draw(g, p, seed, j)].i]++] = weibull_threshold(j, g->k, g->m, g->volume);
}

/* The group that begins at member[0]; k and m from its material unless given. */
static WeibullGroup begin(const Parts *p, const Material *material, const Member *member, long left,
                          double k, double m)
{
  const struct damage_grady_kipp *d = &material[member->mat].damage.grady_kipp;
  WeibullGroup g = {.body = member->body, .mat = member->mat};
  g.k = isnan(k) ? d->k : k, g.m = isnan(m) ? d->m : m;
  for (; g.n < left && member[g.n].body == g.body && member[g.n].mat == g.mat; g.n++)
    g.volume += p->m[member[g.n].i] / p->rho[member[g.n].i];
  return g;
}

static int throw_flaws(Parts *p, const Material *material, uint64_t seed, double k, double m,
                       const Member *member, long n, WeibullGroup *group, int *groups, Err *err)
{
  int64_t *next;
  for (long at = 0; at < n; at += group[(*groups)++].n) {
    group[*groups] = begin(p, material, member + at, n - at, k, m);
    count(p, group + *groups, member + at, seed);
    p->flaws += group[*groups].flaws;
  }
  p->flaw = malloc((size_t)(p->flaws + 1) * sizeof *p->flaw);
  next = part_flaw_start(p);
  if (p->flaw && next)
    for (long at = 0, g = 0; at < n; at += group[g++].n)
      fill(p, group + g, member + at, seed, next);
  free(next);
  return p->flaw && next ? 0 : err_set(err, "out of memory");
}

/* The number of groups: where body or material changes along the sorted members. */
static size_t count_groups(const Member *member, long n)
{
  size_t groups = n > 0;
  for (long k = 1; k < n; k++)
    groups += member[k].body != member[k - 1].body || member[k].mat != member[k - 1].mat;
  return groups;
}

int weibull_assign(Parts *p, const Material *material, uint64_t seed, double k, double m,
                   WeibullGroup **group, int *groups, Err *err)
{
  long n = 0;
  Member *member = members(p, material, &n);
  int rc = -1;
  *groups = 0, *group = NULL;
  if (!member) return err_set(err, "out of memory");
  if (part_add(p, "damage", err)) goto done;
  free(p->nflaw), free(p->flaw);
  p->flaw = NULL, p->flaws = 0;
  p->nflaw = calloc((size_t)p->n + 1, sizeof *p->nflaw);
  *group = malloc((count_groups(member, n) + 1) * sizeof **group);
  memset(p->damage, 0, (size_t)p->n * sizeof *p->damage);
  if (p->nact) memset(p->nact, 0, (size_t)p->n * sizeof *p->nact);
  if (p->nflaw && *group)
    rc = throw_flaws(p, material, seed, k, m, member, n, *group, groups, err);
  else
    err_set(err, "out of memory");
done:
  free(member);
  return rc;
}
