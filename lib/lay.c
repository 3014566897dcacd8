/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The lattice knows no pressure: what is kept of it is the order in radius, and how much volume
 * lies inside of a particle within its layer. */
#include <math.h>
#include <stdlib.h>
#include <gsl/gsl_sort.h>
#include "figure.h"
#include "lay.h"

static const double PI = 3.14159265358979323846;

/* Distances from the centre of mass, which is returned too. */
static double *distances(const Parts *p, double com[3])
{
  double mass = 0, *r = malloc((size_t)p->n * sizeof *r);
  if (!r) return NULL;
  com[0] = com[1] = com[2] = 0;
  for (long i = 0; i < p->n; i++) {
    mass += p->m[i];
    for (int a = 0; a < 3; a++) com[a] += p->m[i] * p->x[3 * i + a];
  }
  for (int a = 0; a < 3; a++) com[a] /= mass;
  for (long i = 0; i < p->n; i++) {
    double d[3] = {p->x[3 * i] - com[0], p->x[3 * i + 1] - com[1], p->x[3 * i + 2] - com[2]};
    r[i] = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
  }
  return r;
}

static int differ(double a, double b) { return fabs(a - b) > 1e-9 * (fabs(a) + fabs(b)); }

/* Runs of one material by distance; order[k] is the k-th particle from the centre. */
static int runs(const Parts *p, const Material *material, const size_t *order,
                StructureLayer *layer, int *of, Err *err)
{
  int n = 0;
  double rho = 0;
  for (long k = 0; k < p->n; k++) {
    size_t i = order[k];
    StructureLayer *l = layer + n - 1;
    if (!n || p->mat[i] != l->mat) {
      if (n++ == STRUCTURE_LAYERS)
        return err_set(err, "the body is not made of concentric layers, %d at most", n - 1);
      *++l = (StructureLayer){.material = &material[p->mat[i]], .at = p->u[i], .mat = p->mat[i]};
      rho = p->rho[i];
    }
    if (differ(p->rho[i], rho) || differ(p->u[i], l->at))
      return err_set(
          err, "layer %d is not uniform at particle %lld: the body is not as mksphere makes it", n,
          (long long)p->id[i]);
    l->mass += p->m[i], of[i] = n - 1;
  }
  return n;
}

static int layers_of(const Parts *p, const Material *material, const double *r,
                     StructureLayer *layer, int *of, Err *err)
{
  size_t *order = malloc((size_t)p->n * sizeof *order);
  int n;
  if (!order) return err_set(err, "out of memory");
  gsl_sort_index(order, r, 1, (size_t)p->n);
  n = runs(p, material, order, layer, of, err);
  free(order);
  return n;
}

/* A ball of whole shells does not reach beyond the radius of its volume. */
static int is_ball(const Parts *p, const double *r, Err *err)
{
  double far = 0, volume = 0;
  for (long i = 0; i < p->n; i++) far = fmax(far, r[i]), volume += p->m[i] / p->rho[i];
  if (far <= 1.1 * cbrt(volume / (4 * PI / 3))) return 0;
  return err_set(err,
                 "the body is not a ball: it reaches %g m out, and has the volume of one of %g m",
                 far, cbrt(volume / (4 * PI / 3)));
}

int lay_layers(const Parts *p, const Material *material, StructureBody *body, int *of, Err *err)
{
  double com[3], *r;
  if (p->dimension != 3)
    return err_set(err, "a hydrostatic structure has 3 dimensions, the body %d", p->dimension);
  if (!(r = distances(p, com))) return err_set(err, "out of memory");
  *body = (StructureBody){0};
  body->layers = is_ball(p, r, err) ? -1 : layers_of(p, material, r, body->layer, of, err);
  free(r);
  return body->layers;
}

/* Particle i, in a layer with `inside` kg and the radius `start` below it. */
static void lay(Parts *p, long i, const Material *material, const Structure *s, int layer,
                double inside, double start, const double com[3], double r)
{
  double m = inside + 4 * PI / 3 * p->rho[i] * (r * r * r - start * start * start);
  StructureNode node = structure_at_mass(s, layer, m);
  double stretch = r > 0 ? node.r / r : 1;
  EosPoint point = eos_eval(&material->eos, node.rho, node.u, 0);
  for (int a = 0; a < 3; a++)
    p->x[3 * i + a] = (p->x[3 * i + a] - com[a]) * stretch, p->v[3 * i + a] *= stretch;
  figure_flatten(&node, p->x + 3 * i);
  p->h[i] *= cbrt(p->rho[i] / node.rho);
  p->rho[i] = node.rho, p->u[i] = node.u, p->p[i] = point.p, p->cs[i] = point.cs;
}

/* Mass and volume inside each layer of the body, checked against the profile. */
static int below(const Parts *p, const int *of, const Structure *s, double *inside, double *cube,
                 Err *err)
{
  for (long i = 0; i < p->n; i++) {
    inside[of[i] + 1] += p->m[i];
    cube[of[i] + 1] += p->m[i] / p->rho[i] / (4 * PI / 3);
  }
  for (int k = 0; k < s->layers; k++) {
    inside[k + 1] += inside[k], cube[k + 1] += cube[k];
    if (differ(inside[k + 1], s->node[s->first[k + 1] - 1].m))
      return err_set(err, "layer %d of the body has not the mass it has in its profile", k + 1);
  }
  return 0;
}

int lay_body(Parts *p, const Material *material, const Structure *s, Err *err)
{
  StructureBody body;
  double com[3], inside[STRUCTURE_LAYERS + 1] = {0}, cube[STRUCTURE_LAYERS + 1] = {0},
                                           *r = distances(p, com);
  int *of = malloc((size_t)p->n * sizeof *of), n = -1;
  if (!r || !of)
    err_set(err, "out of memory");
  else if (!part_add(p, "p cs", err))
    n = lay_layers(p, material, &body, of, err);
  if (n >= 0 && n != s->layers)
    n = err_set(err, "the body has %d layers, its profile %d", n, s->layers);
  if (n >= 0) n = below(p, of, s, inside, cube, err);
  for (long i = 0; n >= 0 && i < p->n; i++)
    lay(p, i, material + p->mat[i], s, of[i], inside[of[i]], cbrt(cube[of[i]]), com, r[i]);
  free(r), free(of);
  return n;
}

/* Particles of one material, from the centre: each layer of it takes them until it has its mass. */
static void share(const Parts *p, const StructureBody *body, int mat, const size_t *order, int *of)
{
  int k = 0;
  double left;
  while (k < body->layers && body->layer[k].mat != mat) k++;
  if (k == body->layers) return;
  left = body->layer[k].mass;
  for (long n = 0; n < p->n; n++) {
    size_t i = order[n];
    int next = k + 1;
    if (p->mat[i] != mat) continue;
    while (next < body->layers && body->layer[next].mat != mat) next++;
    if (left < 0.5 * p->m[i] && next < body->layers) k = next, left += body->layer[k].mass;
    of[i] = k, left -= p->m[i];
  }
}

int lay_assign(const Parts *p, const StructureBody *body, int *of, Err *err)
{
  double com[3], *r = distances(p, com), mass[STRUCTURE_LAYERS] = {0};
  size_t *order = malloc((size_t)p->n * sizeof *order);
  int rc = r && order ? 0 : err_set(err, "out of memory");
  for (long i = 0; i < p->n; i++) of[i] = -1;
  if (!rc) gsl_sort_index(order, r, 1, (size_t)p->n);
  for (int k = 0; !rc && k < p->materials; k++) share(p, body, k, order, of);
  for (long i = 0; !rc && i < p->n; i++) {
    if (of[i] < 0)
      rc = err_set(err, "no layer of the body is of '%s'", p->material[p->mat[i]].name);
    else
      mass[of[i]] += p->m[i];
  }
  for (int k = 0; !rc && k < body->layers; k++)
    if (!(fabs(mass[k] / body->layer[k].mass - 1) < 0.02))
      rc = err_set(err, "layer %d has %g kg, and %g kg in /Body", k + 1, mass[k],
                   body->layer[k].mass);
  free(r), free(order);
  return rc;
}
