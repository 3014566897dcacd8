/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The outward integration runs over s = m^(1/3), in which r and p are smooth at the centre, with r,
 * p, rho and u as unknowns (drho = dp/c^2, du = p/(rho c)^2 dp: the isentrope). Where a trial
 * pressure has become negative the density is held, so that the pressure at the surface is a
 * monotonic function of the central one. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>
#include <gsl/gsl_roots.h>
#include <gsl/gsl_sort.h>
#include "structure.h"
#include "unit.h"

static const double PI = 3.14159265358979323846, EXACT = 1e-12;

typedef struct {
  const Eos *eos;
  double u;
} Cold;

static double pressure(double rho, void *cold)
{
  const Cold *c = cold;
  return eos_eval(c->eos, rho, c->u, 0).p;
}

static double root(double f(double, void *), void *parameters, double low, double high)
{
  gsl_function function = {f, parameters};
  gsl_root_fsolver *solver = gsl_root_fsolver_alloc(gsl_root_fsolver_brent);
  double x = NAN;
  if (!solver) return x;
  gsl_root_fsolver_set(solver, &function, low, high);
  for (int k = 0; k < 200; k++) {
    if (gsl_root_fsolver_iterate(solver)) break;
    x = gsl_root_fsolver_root(solver);
    low = gsl_root_fsolver_x_lower(solver), high = gsl_root_fsolver_x_upper(solver);
    if (gsl_root_test_interval(low, high, 0, 4e-15) == GSL_SUCCESS) break;
  }
  gsl_root_fsolver_free(solver);
  return x;
}

int structure_density(const Eos *eos, double u, double *rho, Err *err)
{
  Cold cold = {eos, u};
  double high = eos_rho0(eos), low = high, p;
  *rho = high;
  if (!(high > 0)) return err_set(err, "a gas has no density at zero pressure");
  p = pressure(high, &cold);
  if (u == 0 || p == 0 || !eos_uses_energy(eos)) return 0;
  while (p > 0 && low > high / 3) low *= 0.99, p = pressure(low, &cold);
  if (p > 0) return err_set(err, "at %g J/kg it is not condensed: its pressure is never zero", u);
  *rho = root(pressure, &cold, low, low / 0.99);
  return isnan(*rho) ? err_set(err, "out of memory") : 0;
}

/* y = rho, u against p. */
static int isentrope(double p, const double y[], double f[], void *eos)
{
  double c = eos_eval(eos, y[0], y[1], 0).cs;
  f[0] = 1 / (c * c), f[1] = p / (y[0] * y[0] * c * c);
  return GSL_SUCCESS;
}

/* y = r, p, rho, u against s = m^(1/3). */
static int hydrostatic(double s, const double y[], double f[], void *eos)
{
  double r2 = y[0] * y[0];
  f[0] = 3 * s * s / (4 * PI * r2 * y[2]);
  f[1] = -3 * UNIT_G * pow(s, 5) / (4 * PI * r2 * r2);
  f[2] = f[3] = 0;
  if (y[1] <= 0) return GSL_SUCCESS;
  isentrope(y[1], y + 2, f + 2, eos);
  f[2] *= f[1], f[3] *= f[1];
  return GSL_SUCCESS;
}

/* Integrates y from t0 to t1 to EXACT relative to y and to `scale`. */
static int integrate(int f(double, const double *, double *, void *), const Eos *eos, size_t n,
                     const double *scale, double t0, double t1, double *y)
{
  gsl_odeiv2_system system = {f, NULL, n, (void *)eos};
  gsl_odeiv2_driver *driver = gsl_odeiv2_driver_alloc_scaled_new(
      &system, gsl_odeiv2_step_rk8pd, (t1 - t0) / 16, EXACT, EXACT, 1, 0, scale);
  int status = driver ? gsl_odeiv2_driver_apply(driver, &t0, t1, y) : GSL_ENOMEM;
  if (driver) gsl_odeiv2_driver_free(driver);
  return status;
}

typedef struct {
  const StructureLayer *layer;
  int layers;
  double rho[STRUCTURE_LAYERS];  /* at zero pressure */
  double mass, radius, pressure; /* scales: total, uncompressed, uncompressed at the centre */
  Structure *out;                /* NULL: nothing is recorded */
} Body;

/* Density and energy of a layer at pressure p. */
static int on_isentrope(const Body *b, int k, double p, double y[2])
{
  double scale[2] = {b->rho[k], p / b->rho[k]};
  y[0] = b->rho[k], y[1] = b->layer[k].u0;
  return p > 0 ? integrate(isentrope, b->layer[k].eos, 2, scale, 0, p, y) : GSL_SUCCESS;
}

static void record(const Body *b, int layer, double third, const double y[4])
{
  double m = third * third * third, g = y[0] > 0 ? UNIT_G * m / (y[0] * y[0]) : 0;
  double c = eos_eval(b->layer[layer].eos, y[2], y[3], 0).cs;
  b->out->node[b->out->n++] = (StructureNode){y[0], m, y[2], fmax(y[1], 0), y[3], g, c, layer};
}

/* One layer from s0 to s1; with a record in equal steps of s. */
static int cross(const Body *b, int k, double s0, double s1, double y[4])
{
  double scale[4] = {b->radius, b->pressure, b->rho[k], b->pressure / b->rho[k]}, from = s0,
         inner = k ? s0 : 0;
  long n = b->out ? b->out->first[k + 1] - b->out->first[k] : 2;
  for (long i = 1; i < n; i++) {
    double to = i == n - 1 ? s1 : inner + (s1 - inner) * (double)i / (double)(n - 1);
    int status = integrate(hydrostatic, b->layer[k].eos, 4, scale, from, to, y);
    if (status) return status;
    if (b->out) record(b, k, to, y);
    from = to;
  }
  return GSL_SUCCESS;
}

/* Pressure at the surface for a central one, in units of the central one; NAN when the integration
 * fails. */
static double shoot(double centre, void *body)
{
  const Body *b = body;
  double y[4] = {0, centre, 0, 0}, inside = 0, s = 0;
  for (int k = 0; k < b->layers; k++) {
    double end = cbrt(inside += b->layer[k].mass);
    if (on_isentrope(b, k, y[1], y + 2)) return NAN;
    if (b->out) record(b, k, s, y);
    if (k == 0) { /* p = p_c - 2 pi/3 G rho^2 r^2 near the centre; the next order is (r/R)^4 = 1e-16
                     of it */
      s = 1e-4 * end;
      y[0] = s * cbrt(3 / (4 * PI * y[2]));
      y[1] -= 2 * PI / 3 * UNIT_G * y[2] * y[2] * y[0] * y[0];
    }
    if (cross(b, k, s, end, y)) return NAN;
    s = end;
  }
  return y[1] / centre;
}

/* Masses, zero-pressure densities and the scales of the uncompressed body. */
static int prepare(Body *b, Err *err)
{
  double volume = 0, inside = 0, r = 0;
  for (int k = 0; k < b->layers; k++) {
    const StructureLayer *l = b->layer + k;
    if (!(l->mass > 0)) return err_set(err, "layer %d has no mass", k + 1);
    if (structure_density(l->eos, l->u0, &b->rho[k], err)) return -1;
    b->mass += l->mass, volume += l->mass / b->rho[k];
  }
  b->radius = cbrt(volume / (4 * PI / 3));
  for (int k = 0; k < b->layers;
       k++) { /* p_c = integral of G m rho/r^2 over layers of constant density */
    double rho = b->rho[k], hole = inside - 4 * PI / 3 * rho * r * r * r, r1;
    inside += b->layer[k].mass;
    r1 = cbrt(r * r * r + b->layer[k].mass / rho / (4 * PI / 3));
    b->pressure += UNIT_G * rho *
                   (2 * PI / 3 * rho * (r1 * r1 - r * r) + (r > 0 ? hole * (1 / r - 1 / r1) : 0));
    r = r1;
  }
  return 0;
}

/* Nodes of each layer: equal steps of s over the whole body, at least 16. */
static int allocate(Structure *s, const Body *b, long nodes, Err *err)
{
  double inside = 0, before = 0;
  *s = (Structure){.layers = b->layers};
  for (int k = 0; k < b->layers; k++) {
    double third = cbrt((inside += b->layer[k].mass) / b->mass);
    s->first[k + 1] = s->first[k] + (long)fmax(16, (double)nodes * (third - before));
    before = third;
  }
  s->node = malloc((size_t)s->first[s->layers] * sizeof *s->node);
  return s->node ? 0 : err_set(err, "out of memory");
}

int structure_solve(Structure *s, const StructureLayer *layer, int layers, long nodes, Err *err)
{
  Body b = {.layer = layer, .layers = layers};
  double low, high, end, centre;
  if (layers < 1 || layers > STRUCTURE_LAYERS)
    return err_set(err, "%d layers, not 1..%d", layers, STRUCTURE_LAYERS);
  if (nodes < 16 || nodes > 5000) return err_set(err, "%ld nodes, not 16..5000", nodes);
  if (prepare(&b, err)) return -1;
  low = 0.5 * b.pressure, high = b.pressure;
  while ((end = shoot(high, &b)) < 0 && high < 1e6 * b.pressure) low = high, high *= 1.5;
  if (!(end >= 0 && shoot(low, &b) < 0))
    return err_set(err, "no hydrostatic body of %g kg was found", b.mass);
  centre = root(shoot, &b, low, high);
  if (allocate(s, &b, nodes, err)) return -1;
  b.out = s;
  end = shoot(centre, &b);
  if (fabs(end) < 1e-9) return 0;
  structure_free(s);
  return err_set(
      err, "the hydrostatic structure did not converge: %g of the central pressure at the surface",
      end);
}

void structure_free(Structure *s)
{
  free(s->node);
  *s = (Structure){0};
}

/* q = m^(1/3), r, rho, p, u of a node and their slopes d against m^(1/3): mass, hydrostatics,
 * isentrope. */
enum { THIRD, RADIUS, RHO, PRESSURE, ENERGY, QUANTITIES };

static void slopes(const StructureNode *a, double q[QUANTITIES], double d[QUANTITIES])
{
  double s = cbrt(a->m), c2 = a->cs * a->cs;
  q[THIRD] = s, q[RADIUS] = a->r, q[RHO] = a->rho, q[PRESSURE] = a->p, q[ENERGY] = a->u;
  d[THIRD] = 1;
  d[RADIUS] = a->r > 0 ? 3 * s * s / (4 * PI * a->r * a->r * a->rho) : cbrt(3 / (4 * PI * a->rho));
  d[PRESSURE] = -a->rho * a->g * d[RADIUS];
  d[RHO] = d[PRESSURE] / c2;
  d[ENERGY] = d[PRESSURE] * a->p / (a->rho * a->rho * c2);
}

/* Cubic Hermite interpolation over the quantity `over` (THIRD or RADIUS). */
static StructureNode between(const StructureNode *a, const StructureNode *b, int over, double want)
{
  double qa[QUANTITIES], qb[QUANTITIES], da[QUANTITIES], db[QUANTITIES], q[QUANTITIES], step, t, e;
  slopes(a, qa, da), slopes(b, qb, db);
  step = qb[over] - qa[over];
  t = fmin(fmax((want - qa[over]) / step, 0), 1), e = 1 - t;
  for (int k = 0; k < QUANTITIES; k++)
    q[k] = e * e * (1 + 2 * t) * qa[k] + t * t * (1 + 2 * e) * qb[k] +
           e * t * step * (e * da[k] / da[over] - t * db[k] / db[over]);
  return (StructureNode){q[RADIUS],
                         pow(q[THIRD], 3),
                         q[RHO],
                         q[PRESSURE],
                         q[ENERGY],
                         q[RADIUS] > 0 ? UNIT_G * pow(q[THIRD], 3) / (q[RADIUS] * q[RADIUS]) : 0,
                         e * a->cs + t * b->cs,
                         a->layer};
}

static StructureNode look(const Structure *s, int layer, int over, double want)
{
  long low = s->first[layer], high = s->first[layer + 1] - 1;
  while (high - low > 1) {
    long mid = (low + high) / 2;
    if ((over == RADIUS ? s->node[mid].r : cbrt(s->node[mid].m)) <= want)
      low = mid;
    else
      high = mid;
  }
  return between(s->node + low, s->node + high, over, want);
}

StructureNode structure_at_mass(const Structure *s, int layer, double m)
{
  return look(s, layer, THIRD, cbrt(m));
}

StructureNode structure_at_radius(const Structure *s, double r)
{
  int k = 0;
  while (k < s->layers - 1 && s->node[s->first[k + 1]].r < r) k++;
  return look(s, k, RADIUS, r);
}

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
      *++l = (StructureLayer){&material[p->mat[i]].eos, 0, p->u[i], p->mat[i]};
      rho = p->rho[i];
    }
    if (differ(p->rho[i], rho) || differ(p->u[i], l->u0))
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

int structure_layers(const Parts *p, const Material *material,
                     StructureLayer layer[STRUCTURE_LAYERS], int *of, Err *err)
{
  double com[3], *r;
  int n;
  if (p->dimension != 3)
    return err_set(err, "a hydrostatic structure has 3 dimensions, the body %d", p->dimension);
  if (!(r = distances(p, com))) return err_set(err, "out of memory");
  n = layers_of(p, material, r, layer, of, err);
  free(r);
  return n;
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

int structure_lay(Parts *p, const Material *material, const Structure *s, Err *err)
{
  StructureLayer layer[STRUCTURE_LAYERS];
  double com[3], inside[STRUCTURE_LAYERS + 1] = {0}, cube[STRUCTURE_LAYERS + 1] = {0},
                                           *r = distances(p, com);
  int *of = malloc((size_t)p->n * sizeof *of), n = -1;
  if (!r || !of)
    err_set(err, "out of memory");
  else if (!part_add(p, "p cs", err))
    n = structure_layers(p, material, layer, of, err);
  if (n >= 0 && n != s->layers)
    n = err_set(err, "the body has %d layers, its profile %d", n, s->layers);
  if (n >= 0) n = below(p, of, s, inside, cube, err);
  for (long i = 0; n >= 0 && i < p->n; i++)
    lay(p, i, material + p->mat[i], s, of[i], inside[of[i]], cbrt(cube[of[i]]), com, r[i]);
  free(r), free(of);
  return n;
}
