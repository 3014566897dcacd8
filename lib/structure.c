/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The outward integration runs over s = m^(1/3), in which r and p are smooth at the centre, with r,
 * p, rho and u as unknowns, rho and u along the layer's law. Where a trial pressure has become
 * negative the density is held, so that the pressure at the surface is a monotonic function of the
 * central one. Laws that are anchored below the surface are found by repetition: their anchors
 * follow the pressure and the temperature that the last solution had there. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>
#include <gsl/gsl_roots.h>
#include "structure.h"
#include "thermal.h"
#include "unit.h"

static const double PI = 3.14159265358979323846, EXACT = 1e-12,
                    COLD = 1e-9; /* of c^2: an energy above the cold one that is rounding */

static double root(double f(double, void *), void *parameters, double low, double high)
{
  gsl_function function = {f, parameters};
  gsl_root_fsolver *solver = gsl_root_fsolver_alloc(gsl_root_fsolver_brent);
  double x = NAN;
  if (!solver) return x;
  gsl_set_error_handler_off(); /* statuses are looked at */
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

/* A pressure at an energy (or a temperature). */
typedef struct {
  const Material *material;
  const Eos *eos;
  double u, t, p;
} Search;

static double excess(double rho, void *search)
{
  const Search *s = search;
  return eos_eval(s->eos, rho, s->u, 0).p - s->p;
}

static double excess_at_temperature(double rho, void *search)
{
  const Search *s = search;
  return eos_eval(s->eos, rho, thermal_energy(s->material, rho, s->t), 0).p - s->p;
}

/* The root closest to the density at rest, or any of a gas; NAN when there is none between a third
 * of it and a hundred times. */
static double density(double f(double, void *), Search *s)
{
  double rho0 = eos_rho0(s->eos), start = rho0 > 0 ? rho0 : 1, low = start, high = start, step,
         end = rho0 > 0 ? start / 3 : 1e-15;
  if (f(start, s) == 0) return start;
  step = rho0 > 0 ? 1.01 : 2;
  while (f(low, s) > 0 && low > end) high = low, low /= step;
  while (f(high, s) < 0 && high < 100 * fmax(start, 1e4)) low = high, high *= step;
  return f(low, s) <= 0 && f(high, s) >= 0 ? root(f, s, low, high) : NAN;
}

int structure_density(const Eos *eos, double u, double *rho, Err *err)
{
  Search search = {NULL, eos, u, 0, 0};
  *rho = eos_rho0(eos);
  if (!(*rho > 0)) return err_set(err, "a gas has no density at zero pressure");
  if (u == 0 || !eos_uses_energy(eos)) return 0;
  *rho = density(excess, &search);
  if (*rho > 0) return 0;
  return err_set(err,
                 "at %g J/kg it is not condensed: its pressure is never zero (as in tables "
                 "without tension: give a temperature, and a pressure outside)",
                 u);
}

double structure_stiffness(const StructureLayer *l, const StructureState *anchor, double rho,
                           double u, double *dudrho)
{
  const Eos *eos = &l->material->eos;
  EosPoint at = eos_eval(eos, rho, u, 0);
  double work = at.p / (rho * rho), step, slope;
  *dudrho = work;
  if (!l->power) return at.cs * at.cs;
  step = 1e-5 * (fabs(u) + at.cs * at.cs);
  slope = (eos_eval(eos, rho, u + step, 0).p - eos_eval(eos, rho, u - step, 0).p) / (2 * step);
  *dudrho = thermal_slope(l->material, rho, u, anchor->t * pow(rho / anchor->rho, l->exponent),
                          l->exponent);
  return at.cs * at.cs + slope * (*dudrho - work);
}

typedef struct {
  const StructureLayer *layer;
  const StructureState *anchor;
  double G;
} Law;

/* y = rho, u against p. */
static int along(double p, const double y[], double f[], void *law)
{
  const Law *l = law;
  double du;
  (void)p;
  f[0] = 1 / structure_stiffness(l->layer, l->anchor, y[0], y[1], &du), f[1] = du * f[0];
  return isfinite(f[0]) && isfinite(f[1]) && y[0] > 0 ? GSL_SUCCESS : GSL_EBADFUNC;
}

/* y = r, p, rho, u against s = m^(1/3). */
static int hydrostatic(double s, const double y[], double f[], void *law)
{
  double r2 = y[0] * y[0];
  f[0] = 3 * s * s / (4 * PI * r2 * y[2]);
  f[1] = -3 * ((const Law *)law)->G * pow(s, 5) / (4 * PI * r2 * r2);
  f[2] = f[3] = 0;
  if (y[1] <= 0 || f[1] == 0) return GSL_SUCCESS;
  if (along(y[1], y + 2, f + 2, law)) return GSL_EBADFUNC;
  f[2] *= f[1], f[3] *= f[1];
  return GSL_SUCCESS;
}

/* Integrates y from t0 to t1 to EXACT relative to y and to `scale`. */
static int integrate(int f(double, const double *, double *, void *), Law *law, size_t n,
                     const double *scale, double t0, double t1, double *y)
{
  gsl_odeiv2_system system = {f, NULL, n, law};
  gsl_odeiv2_driver *driver;
  int status;
  gsl_set_error_handler_off();
  driver = gsl_odeiv2_driver_alloc_scaled_new(&system, gsl_odeiv2_step_rk8pd, (t1 - t0) / 16, EXACT,
                                              EXACT, 1, 0, scale);
  status = driver ? gsl_odeiv2_driver_apply(driver, &t0, t1, y) : GSL_ENOMEM;
  if (driver) gsl_odeiv2_driver_free(driver);
  return status;
}

int structure_move(const StructureLayer *l, const StructureState *anchor, double p,
                   StructureState *state)
{
  Law law = {l, anchor, 0};
  double y[2] = {anchor->rho, anchor->u}, c, scale[2];
  *state = *anchor;
  if (p == anchor->p) return 0;
  c = eos_eval(&l->material->eos, anchor->rho, anchor->u, 0).cs;
  scale[0] = anchor->rho, scale[1] = fmin(fabs(p - anchor->p) / anchor->rho, c * c);
  if (integrate(along, &law, 2, scale, anchor->p, p, y)) return -1;
  *state = (StructureState){p, y[0], y[1], NAN};
  if (l->power) state->t = anchor->t * pow(y[0] / anchor->rho, l->exponent);
  return 0;
}

typedef struct {
  const StructureBody *body;
  StructureState anchor[STRUCTURE_LAYERS];
  double top[STRUCTURE_LAYERS];  /* pressure at the top of the layers, as far as known */
  double rho[STRUCTURE_LAYERS];  /* at the pressure outside */
  double mass, radius, pressure; /* scales: total, uncompressed, uncompressed at the centre */
  double G;
  Structure *out; /* NULL: nothing is recorded */
} Task;

static void record(const Task *b, int layer, double third, const double y[4])
{
  double m = third * third * third, g = y[0] > 0 ? b->G * m / (y[0] * y[0]) : 0, du;
  const StructureLayer *l = &b->body->layer[layer];
  double stiff = structure_stiffness(l, &b->anchor[layer], y[2], y[3], &du);
  b->out->node[b->out->n++] = (StructureNode){.r = y[0],
                                              .m = m,
                                              .rho = y[2],
                                              .p = fmax(y[1], 0),
                                              .u = y[3],
                                              .g = g,
                                              .cs = eos_eval(&l->material->eos, y[2], y[3], 0).cs,
                                              .rho_p = 1 / stiff,
                                              .u_p = du / stiff,
                                              .layer = layer};
}

/* One layer from s0 to s1; with a record in equal steps of s. */
static int cross(const Task *b, int k, double s0, double s1, double y[4])
{
  Law law = {&b->body->layer[k], &b->anchor[k], b->G};
  double scale[4] = {b->radius, b->pressure, b->rho[k], b->pressure / b->rho[k]}, from = s0,
         inner = k ? s0 : 0;
  long n = b->out ? b->out->first[k + 1] - b->out->first[k] : 2;
  for (long i = 1; i < n; i++) {
    double to = i == n - 1 ? s1 : inner + (s1 - inner) * (double)i / (double)(n - 1);
    int status = integrate(hydrostatic, &law, 4, scale, from, to, y);
    if (status) return status;
    if (b->out) record(b, k, to, y);
    from = to;
  }
  return GSL_SUCCESS;
}

/* Pressure at the surface for a central one, above what is outside, in units of the central one;
 * NAN when the integration fails. */
static double shoot(double centre, void *task)
{
  const Task *b = task;
  double y[4] = {0, centre, 0, 0}, inside = 0, s = 0;
  for (int k = 0; k < b->body->layers; k++) {
    double end = cbrt(inside += b->body->layer[k].mass);
    StructureState state;
    if (structure_move(&b->body->layer[k], &b->anchor[k], fmax(y[1], 0), &state)) return NAN;
    y[2] = state.rho * (1 - b->body->layer[k].pores), y[3] = state.u;
    if (b->out) record(b, k, s, y);
    if (k == 0) { /* p = p_c - 2 pi/3 G rho^2 r^2 near the centre; the next order is (r/R)^4 = 1e-16
                     of it */
      double du, drho, dp;
      s = 1e-4 * end;
      y[0] = s * cbrt(3 / (4 * PI * y[2]));
      dp = -2 * PI / 3 * b->G * y[2] * y[2] * y[0] * y[0];
      drho = dp / structure_stiffness(&b->body->layer[k], &b->anchor[k], y[2], y[3], &du);
      y[1] += dp, y[2] += drho, y[3] += du * drho;
    }
    if (cross(b, k, s, end, y)) return NAN;
    s = end;
  }
  return centre > 0 ? (y[1] - b->body->outer) / centre : 0;
}

/* The temperature that the structure found last has at the bottom of a layer. */
static double bottom(const Task *b, int k, double t_unknown)
{
  const StructureLayer *l = &b->body->layer[k];
  StructureState at;
  if (structure_move(l, &b->anchor[k], b->top[k - 1], &at)) return t_unknown;
  return l->power ? at.t : thermal_temperature(l->material, at.rho, at.u);
}

/* The state that a layer's law passes through, with what is known of the pressure at its top. */
static int anchor(Task *b, int k, Err *err)
{
  const StructureLayer *l = &b->body->layer[k];
  Search search = {l->material, &l->material->eos, 0, l->at, b->top[k]};
  StructureState *a = &b->anchor[k];
  double rho0 = eos_rho0(search.eos);
  int by_energy = l->anchor == STRUCTURE_ENERGY, by_entropy = l->anchor == STRUCTURE_ENTROPY;
  if ((l->power || !by_energy) && !(l->material->heat > 0))
    return err_set(err, "its material has no heat_capacity, so no temperature");
  if (by_energy && !(rho0 > 0)) {
    search.u = l->at, search.p = b->body->outer;
    *a = (StructureState){search.p, search.p > 0 ? density(excess, &search) : NAN, l->at, NAN};
    if (isnan(a->rho)) return err_set(err, "a gas needs a pressure outside");
  } else if (by_energy) {
    *a = (StructureState){0, 0, l->at, NAN};
    if (structure_density(search.eos, l->at, &a->rho, err)) return -1;
  } else if (by_entropy) {
    double u = thermal_at_entropy(l->material, l->at);
    StructureLayer isentrope = *l;
    StructureState rest = {eos_eval(search.eos, rho0, u, 0).p, rho0, u, NAN};
    isentrope.power = 0;
    if (isnan(u) || structure_move(&isentrope, &rest, b->top[k], a))
      return err_set(err, "%g J/K/kg is not an entropy of the material at %g Pa", l->at, b->top[k]);
  } else {
    if (l->anchor == STRUCTURE_CONTINUOUS) search.t = bottom(b, k + 1, NAN);
    *a = (StructureState){search.p, density(excess_at_temperature, &search), 0, search.t};
    if (isnan(a->rho))
      return err_set(err, "at %g K and %g Pa it is not condensed", search.t, search.p);
    a->u = thermal_energy(l->material, a->rho, a->t);
  }
  if (isnan(a->t) && l->material->heat > 0) a->t = thermal_temperature(l->material, a->rho, a->u);
  return 0;
}

static int anchors(Task *b, Err *err)
{
  for (int k = b->body->layers - 1; k >= 0; k--) {
    Err why;
    if (anchor(b, k, &why)) return err_set(err, "layer %d: %s", k + 1, why.text);
  }
  return 0;
}

/* Densities outside, and the scales of the uncompressed body. */
static int scales(Task *b, Err *err)
{
  const StructureBody *body = b->body;
  double volume = 0, inside = 0, r = 0;
  b->mass = 0, b->pressure = 0;
  for (int k = 0; k < body->layers; k++) {
    StructureState state;
    if (structure_move(&body->layer[k], &b->anchor[k], body->outer, &state))
      return err_set(err, "layer %d has no state at %g Pa", k + 1, body->outer);
    b->rho[k] = state.rho, b->mass += body->layer[k].mass;
    volume += body->layer[k].mass / b->rho[k];
  }
  b->radius = cbrt(volume / (4 * PI / 3));
  for (int k = 0; k < body->layers; k++) { /* integral of G m rho/r^2, densities constant */
    double rho = b->rho[k], hole = inside - 4 * PI / 3 * rho * r * r * r, r1;
    inside += body->layer[k].mass;
    r1 = cbrt(r * r * r + body->layer[k].mass / rho / (4 * PI / 3));
    b->pressure += UNIT_G * rho *
                   (2 * PI / 3 * rho * (r1 * r1 - r * r) + (r > 0 ? hole * (1 / r - 1 / r1) : 0));
    r = r1;
  }
  return 0;
}

/* Nodes of each layer: equal steps of s over the whole body, at least 16. */
static int allocate(Structure *s, const Task *b, long nodes, Err *err)
{
  double inside = 0, before = 0;
  *s = (Structure){.layers = b->body->layers};
  for (int k = 0; k < s->layers; k++) {
    double third = cbrt((inside += b->body->layer[k].mass) / b->mass);
    s->first[k + 1] = s->first[k] + (long)fmax(16, (double)nodes * (third - before));
    before = third;
  }
  s->node = malloc((size_t)s->first[s->layers] * sizeof *s->node);
  return s->node ? 0 : err_set(err, "out of memory");
}

/* The central pressure that the anchors make. */
static double centre(Task *b)
{
  double high = b->pressure + b->body->outer, low = 0.5 * high, most = 1e6 * high, end;
  if (b->body->weightless) return b->body->outer;
  end = shoot(high, b);
  while (end < 0 && high < most) low = high, high *= 1.5, end = shoot(high, b);
  if (!(end >= 0)) return NAN;
  while (!(shoot(low, b) < 0)) {
    if (low < 1e-6 * high) return NAN;
    low *= 0.5;
  }
  return root(shoot, b, low, high);
}

static int record_all(Task *b, double p, long nodes, Structure *s, Err *err)
{
  double end;
  if (!(p >= 0)) return err_set(err, "no hydrostatic body of %g kg was found", b->mass);
  if (allocate(s, b, nodes, err)) return -1;
  b->out = s, end = shoot(p, b), b->out = NULL;
  if (fabs(end) < 1e-9) return 0;
  structure_free(s);
  return err_set(
      err, "the hydrostatic structure did not converge: %g of the central pressure at the surface",
      end);
}

static int check(const StructureBody *body, long nodes, Err *err)
{
  int last = body->layers - 1;
  if (last < 0 || last >= STRUCTURE_LAYERS)
    return err_set(err, "%d layers, not 1..%d", body->layers, STRUCTURE_LAYERS);
  if (nodes < 16 || nodes > 5000) return err_set(err, "%ld nodes, not 16..5000", nodes);
  if (!(body->outer >= 0))
    return err_set(err, "the pressure outside, %g Pa, is negative", body->outer);
  if (body->layer[last].anchor == STRUCTURE_CONTINUOUS)
    return err_set(err, "layer %d: above it there is no temperature to continue", last + 1);
  for (int k = 0; k <= last; k++)
    if (!(body->layer[k].mass > 0)) return err_set(err, "layer %d has no mass", k + 1);
  for (int k = 0; k <= last && !body->weightless; k++)
    if (body->layer[k].pores > 0)
      return err_set(err, "layer %d has pores: how gravity closes them is not known here", k + 1);
  return 0;
}

/* Solves for the anchors, again while they move with the pressures and temperatures between layers.
 * */
static int solve(Task *b, const StructureBody *body, double *p, Err *err)
{
  enum { COARSE = 16, ROUNDS = 100 };
  double moved = 1;
  *b = (Task){.body = body, .G = body->weightless ? 0 : UNIT_G};
  for (int k = 0; k < body->layers; k++) b->top[k] = body->outer;
  for (int round = 0; moved > 1e-11 && round < ROUNDS; round++) {
    Structure s;
    if (anchors(b, err) || scales(b, err)) return -1;
    *p = centre(b), moved = 0;
    if (record_all(b, *p, COARSE, &s, err)) return -1;
    for (int k = 0; k < body->layers - 1; k++) {
      double top = s.node[s.first[k + 1] - 1].p;
      if (body->layer[k].anchor != STRUCTURE_ENERGY)
        moved = fmax(moved, fabs(top - b->top[k]) / (b->pressure + body->outer));
      b->top[k] = top;
    }
    structure_free(&s);
  }
  return moved > 1e-11 ? err_set(err, "the temperatures of the layers did not converge") : 0;
}

int structure_solve(Structure *s, const StructureBody *body, long nodes, Err *err)
{
  Task b;
  double p;
  if (check(body, nodes, err) || solve(&b, body, &p, err) || record_all(&b, p, nodes, s, err))
    return -1;
  structure_heat(s, body);
  return 0;
}

int structure_anchors(const StructureBody *body, StructureState *anchor_of, Err *err)
{
  Task b;
  double p;
  if (check(body, 16, err) || solve(&b, body, &p, err)) return -1;
  memcpy(anchor_of, b.anchor, (size_t)body->layers * sizeof *anchor_of);
  return 0;
}

void structure_free(Structure *s)
{
  free(s->node);
  *s = (Structure){0};
}

/* The cold energy is carried from node to node. */
void structure_heat(Structure *s, const StructureBody *body)
{
  for (int k = 0; k < s->layers; k++) {
    const StructureLayer *l = &body->layer[k];
    const Material *m = l->material;
    double rho = eos_rho0(&m->eos), cold = 0, entropy = NAN;
    for (long i = s->first[k + 1] - 1; i >= s->first[k]; i--) {
      StructureNode *n = s->node + i;
      n->t = n->s = NAN;
      if (!(m->heat > 0)) continue;
      if (rho > 0) cold = thermal_isentrope(&m->eos, rho, cold, n->rho), rho = n->rho;
      n->t =
          m->eos.form == EOS_TABLE ? thermal_temperature(m, n->rho, n->u) : (n->u - cold) / m->heat;
      if (m->eos.form != EOS_TABLE && n->u - cold < COLD * n->cs * n->cs) n->t = 0;
      if (l->power || isnan(entropy))
        entropy = n->t > 0 ? thermal_entropy(m, n->rho, n->u) : -INFINITY;
      n->s = entropy;
    }
  }
}

/* q = m^(1/3), r, rho, p, u of a node and their slopes d against m^(1/3): mass, hydrostatics, law.
 * */
enum { THIRD, RADIUS, RHO, PRESSURE, ENERGY, QUANTITIES };

static void slopes(const StructureNode *a, double q[QUANTITIES], double d[QUANTITIES])
{
  double s = cbrt(a->m);
  q[THIRD] = s, q[RADIUS] = a->r, q[RHO] = a->rho, q[PRESSURE] = a->p, q[ENERGY] = a->u;
  d[THIRD] = 1;
  d[RADIUS] = a->r > 0 ? 3 * s * s / (4 * PI * a->r * a->r * a->rho) : cbrt(3 / (4 * PI * a->rho));
  d[PRESSURE] = -a->rho * a->g * d[RADIUS];
  d[RHO] = d[PRESSURE] * a->rho_p;
  d[ENERGY] = d[PRESSURE] * a->u_p;
}

static double mean(double a, double b, double t) { return a == b ? a : (1 - t) * a + t * b; }

/* Cubic Hermite interpolation over the quantity `over` (THIRD or RADIUS). */
static StructureNode between(const StructureNode *a, const StructureNode *b, int over, double want)
{
  double qa[QUANTITIES], qb[QUANTITIES], da[QUANTITIES], db[QUANTITIES], q[QUANTITIES], step, t, e;
  StructureNode n = *a;
  slopes(a, qa, da), slopes(b, qb, db);
  step = qb[over] - qa[over];
  t = fmin(fmax((want - qa[over]) / step, 0), 1), e = 1 - t;
  for (int k = 0; k < QUANTITIES; k++)
    q[k] = e * e * (1 + 2 * t) * qa[k] + t * t * (1 + 2 * e) * qb[k] +
           e * t * step * (e * da[k] / da[over] - t * db[k] / db[over]);
  n.r = q[RADIUS], n.m = pow(q[THIRD], 3), n.rho = q[RHO], n.p = q[PRESSURE], n.u = q[ENERGY];
  n.g = mean(a->g, b->g, t), n.cs = mean(a->cs, b->cs, t);
  n.f = mean(a->f, b->f, t);
  n.t = mean(a->t, b->t, t), n.s = mean(a->s, b->s, t);
  n.rho_p = mean(a->rho_p, b->rho_p, t), n.u_p = mean(a->u_p, b->u_p, t);
  return n;
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
