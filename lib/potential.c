/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pairs are summed in single precision, which is far below the error of the tree; direct sums in
 * double. Particles that do not act have no mass: the walk does not open nodes of none. */
#include <stdlib.h>
#include <string.h>
#include "gravity.h"
#include "potential.h"
#include "unit.h"

/* Up to here n^2 sums are faster than a tree. */
enum { DIRECT = 512 };

static int sorted(Potential *s, Err *err)
{
  int64_t *id = malloc((size_t)s->n * sizeof *id);
  if (!id) return err_set(err, "out of memory for %ld particles", s->n);
  for (long k = 0; k < s->n; k++) {
    id[k] = s->p->id[s->list[k]];
    memcpy(s->x + 3 * k, s->p->x + 3 * s->list[k], 3 * sizeof *s->x);
  }
  int failed = tree_order(s->n, s->x, id, 0, s->order, err);
  free(id);
  return failed;
}

int potential_open(Potential *s, const Parts *p, const long *list, long n, Err *err)
{
  const size_t room = (size_t)n + 1;
  *s = (Potential){.n = n, .p = p, .list = list, .order = malloc(room * sizeof *s->order)};
  s->x = malloc(6 * room * sizeof *s->x);
  if (!s->order || !s->x) {
    potential_close(s);
    return err_set(err, "out of memory for %ld particles", n);
  }
  s->m = s->x + 3 * n, s->h = s->m + n, s->phi = s->h + n;
  for (long k = 0; k < n; k++) s->order[k] = k;
  if (n > DIRECT && sorted(s, err)) return potential_close(s), -1;
#pragma omp parallel for if (n > DIRECT)
  for (long k = 0; k < n; k++) {
    const long i = list[s->order[k]];
    memcpy(s->x + 3 * k, p->x + 3 * i, 3 * sizeof *s->x);
    s->h[k] = p->h[i];
  }
  return 0;
}

static int by_tree(Potential *s, const unsigned char *at, const GravityOptions *o, Err *err)
{
  unsigned char *only = NULL;
  if (s->tree.nodes)
    tree_refit(&s->tree, s->x, s->m, s->h);
  else if (tree_build(&s->tree, s->n, s->x, s->m, s->h, err))
    return -1;
  if (at && !(only = malloc((size_t)s->n)))
    return err_set(err, "out of memory for %ld particles", s->n);
  for (long k = 0; k < s->n && at; k++) only[k] = at[s->order[k]];
  int failed = gravity_potential(&s->tree, s->x, s->m, s->h, o, only, s->phi, err);
  free(only);
  return failed;
}

int potential_sum(Potential *s, const unsigned char *in, const unsigned char *at, double theta,
                  double *phi, Err *err)
{
  const GravityOptions o = {.theta = theta, .G = UNIT_G, .single = 1};
  int failed = 0;
#pragma omp parallel for if (s->n > DIRECT)
  for (long k = 0; k < s->n; k++)
    s->m[k] = !in || in[s->order[k]] ? s->p->m[s->list[s->order[k]]] : 0;
  if (s->n > DIRECT)
    failed = by_tree(s, at, &o, err);
  else if (s->n > 0)
    failed = gravity_direct(s->n, s->x, s->m, s->h, &o, NULL, s->phi, err);
#pragma omp parallel for if (s->n > DIRECT)
  for (long k = 0; k < s->n; k++)
    if (!failed && (!at || at[s->order[k]])) phi[s->order[k]] = s->phi[k];
  return failed ? -1 : 0;
}

void potential_close(Potential *s)
{
  tree_free(&s->tree), free(s->order), free(s->x);
  s->order = NULL, s->x = NULL;
}

int potential_own(const Parts *p, const long *list, long n, double theta, double *phi, Err *err)
{
  Potential s;
  if (potential_open(&s, p, list, n, err)) return -1;
  int failed = potential_sum(&s, NULL, NULL, theta, phi, err);
  potential_close(&s);
  return failed;
}
