/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The CUDA backend against the CPU's: every pass of every mode and law, the reductions, the pair
 * loops and gravity on random and on real states, whole runs; and that a run repeats itself to the
 * bit. Runs on a device, and on the host (tests/host). */
#include <float.h>
#include "lab.h"
#include "../lib/material.h"
#include "../lib/rng.h"
#include "../lib/weibull.h"
#include "../solver/reduce.h"
#include "folder.h"
#include "laws.h"
#include "loop_cases.h"
#include "small.h"
#include "tabulated.h"

/* The arrays of a State. */
typedef struct {
  const char *name;
  size_t at; /* of the pointer in State */
  int width, size;
} Array;
#define ARRAY(TYPE, MEMBER, WIDTH, ...) {#MEMBER, offsetof(State, MEMBER), WIDTH, sizeof(TYPE)},
#define SAVED_ARRAY(SLOT, MEMBER, WIDTH)                                                           \
  {#MEMBER " saved", offsetof(State, saved[SLOT].MEMBER), WIDTH, sizeof(double)},
#define SAVED_0(MEMBER, WIDTH) SAVED_ARRAY(0, MEMBER, WIDTH)
#define SAVED_1(MEMBER, WIDTH) SAVED_ARRAY(1, MEMBER, WIDTH)
#define SAVED_2(MEMBER, WIDTH) SAVED_ARRAY(2, MEMBER, WIDTH)
#define SAVED_3(MEMBER, WIDTH) SAVED_ARRAY(3, MEMBER, WIDTH)
static const Array arrays[] = {ALL_FIELDS(ARRAY) MOVED_FIELDS(ARRAY) WORK_FIELDS(
    ARRAY) SAVED_FIELDS(SAVED_0) SAVED_FIELDS(SAVED_1) SAVED_FIELDS(SAVED_2) SAVED_FIELDS(SAVED_3)};
enum { ARRAYS = sizeof arrays / sizeof *arrays };

static void *array_of(const Sim *sim, const Array *a)
{
  return *(void *const *)((const char *)&sim->s + a->at);
}

static const Array *named(const char *name)
{
  for (int k = 0; k < ARRAYS; k++)
    if (strcmp(arrays[k].name, name) == 0) return &arrays[k];
  fail_msg("no array '%s'", name);
  return NULL;
}

static void copy(Sim *sim, void *to, const void *from, size_t bytes)
{
  Err err;
  if (sim->b->copy(sim, to, from, bytes, &err)) fail_msg("%s", err.text);
}

/* An array on the host, numbers as doubles; NULL when it is not there. */
static double *get(Sim *sim, const Array *a)
{
  const size_t n = (size_t)sim->s.n * (size_t)a->width;
  void *raw = malloc(n * (size_t)a->size), *from = array_of(sim, a);
  double *out = malloc(n * sizeof *out);
  if (!from) return free(raw), free(out), NULL;
  copy(sim, raw, from, n * (size_t)a->size);
  for (size_t k = 0; k < n; k++)
    out[k] = a->size == 4                    ? ((int32_t *)raw)[k]
             : a->at < offsetof(State, x)    ? (double)((int64_t *)raw)[k]
             : strcmp(a->name, "row") == 0   ? (double)((int64_t *)raw)[k]
             : strcmp(a->name, "flaw0") == 0 ? (double)((int64_t *)raw)[k]
                                             : ((double *)raw)[k];
  free(raw);
  return out;
}

/* With grad-h terms: the CPU's, with all places off by an ulp of the precision. Elsewhere NULL. */
static Sim *shaken;

/* How much rounding grows on its way into element k of a: the corrected gradient is the raw one
 * times the inverse moment matrix (cm, as get has it), which is large where neighbours are on one
 * side; the rate of S in pores has the slope of a crush curve, a difference over 1e-4 of p. */
static double growth(const Sim *sim, const Array *a, const double *cm, long k)
{
  const Material *m = &sim->s.material[sim->s.mat[k / a->width]];
  double largest = strcmp(a->name, "ds") == 0 && material_porous(m) ? 100 : 1;
  for (int d = 0; cm && strcmp(a->name, "g") == 0 && d < 6; d++)
    largest = fmax(largest, fabs(cm[6 * (k / 9) + d]));
  return largest;
}

/* What an ulp of the places makes of element k of a, or of another component of it. */
static double ulp(const Array *a, const double *u, const double *w, long k)
{
  const long first = k - k % a->width;
  double most = 0;
  for (long i = first; w && i < first + a->width; i++) most = fmax(most, fabs(u[i] - w[i]));
  return most;
}

/* Both have the same, in the same order, to tolerance times the mean of the array's sizes or the
 * number's own, or to what an ulp of the places makes of it. */
static void same_array(Sim sim[2], const Array *a, double tolerance, const char *what)
{
  const long n = sim[0].s.n * a->width;
  double *u = get(&sim[0], a), *v = get(&sim[1], a), *cm = get(&sim[0], named("cm")), mean = 0,
         *w = shaken && tolerance > 0 ? get(shaken, a) : NULL;
  for (long k = 0; u && v && k < n; k++) mean += fabs(u[k]) / (double)n;
  for (long k = 0; u && v && k < n; k++)
    if (!(fabs(u[k] - v[k]) <=
          fmax(ulp(a, u, w, k), tolerance * growth(&sim[0], a, cm, k) * fmax(mean, fabs(u[k])))) &&
        !(isnan(u[k]) && isnan(v[k])))
      fail_msg("%s: %s[%ld] is %.17g, on the card %.17g; mean %.3g", what, a->name, k, u[k], v[k],
               mean);
  free(u), free(v), free(w), free(cm);
}

static double noise(uint64_t i, uint32_t k) { return 2 * rng_uniform(11, i, k) - 1; }

/* Coordinate e of place i of a cubic lattice of spacing d over -1..1, displaced at random. */
static double place(long i, int e, int dimension, double d)
{
  const long w = (long)ceil(2 / d - 1e-9), at = e == 0 ? i % w : e == 1 ? i / w % w : i / w / w;
  return e < dimension ? -1 + d * ((double)at + 0.5 + 0.35 * noise((uint64_t)i, (uint32_t)e)) : 0;
}

/* About n particles of all materials. */
static Parts *cloud(long n, int dimension)
{
  const double d = 2 / ceil(pow((double)n, 1. / dimension) - 1e-9);
  Parts *p = lab_parts(n, dimension, materials[0]);
  Material *material;
  WeibullGroup *group;
  int groups;
  Err err;
  for (int k = 1; k < MATERIALS; k++)
    assert_int_equal(part_add_material(p, (const char[]){(char)('a' + k), 0}, materials[k], &err),
                     k);
  assert_return_code(part_add(p, "alpha", &err), 0);
  for (long i = 0; i < n; i++) {
    p->alpha[i] = 1.1;
    for (int e = 0; e < 3; e++) {
      p->x[3 * i + e] = place(i, e, dimension, d);
      p->v[3 * i + e] = e < dimension ? 0.1 * noise((uint64_t)i, 3 + (uint32_t)e) : 0;
    }
    p->id[i] = 1000 + (i * 7919) % n, p->body[i] = (int32_t)(i % 3), p->mat[i] = i % MATERIALS;
    p->rho[i] = 1 + 0.2 * noise((uint64_t)i, 6), p->m[i] = pow(d, dimension) * p->rho[i];
    p->u[i] = 0.5 + 0.4 * noise((uint64_t)i, 7), p->h[i] = d * (1.7 + 0.3 * noise((uint64_t)i, 8));
  }
  if (!(material = material_load(p, &err))) fail_msg("%s", err.text);
  assert_return_code(weibull_assign(p, material, &(WeibullOptions){.seed = 3, .minimum = 1}, &group,
                                    &groups, &err),
                     0);
  free(group), material_free(material, p->materials);
  return p;
}

/* The same particles on the CPU and on the card. */
static void open_both(Sim sim[2], const Param *par, const Parts *p)
{
  Err err;
  if (sim_open(&sim[0], par, p, "cpu", &err)) fail_msg("%s", err.text);
  if (sim_open(&sim[1], par, p, "cuda", &err)) fail_msg("%s", err.text);
}

static void close_both(Sim sim[2]) { sim_close(&sim[0]), sim_close(&sim[1]); }

/* All laws are among the materials. */
static void all_laws(void **state)
{
  int eos[EOS_COUNT] = {0}, yield[YIELD_COUNT] = {0}, damage[DAMAGE_COUNT] = {0},
      pores[POROSITY_COUNT] = {0};
  Parts *p = cloud(8, 3);
  Material *m;
  Err err;
  (void)state;
  if (!(m = material_load(p, &err))) fail_msg("%s", err.text);
  for (int k = 0; k < MATERIALS; k++)
    eos[m[k].eos.form] = yield[m[k].yield.form] = damage[m[k].damage.form] =
        pores[m[k].porosity.form] = 1;
  for (int k = 0; k < EOS_COUNT; k++) assert_true(eos[k]);
  for (int k = 0; k < YIELD_COUNT; k++) assert_true(yield[k]);
  for (int k = 0; k < DAMAGE_COUNT; k++) assert_true(damage[k]);
  for (int k = 0; k < POROSITY_COUNT; k++) assert_true(pores[k]);
  material_free(m, p->materials), part_free(p);
}

/* Every array of the CPU's State anew, within what makes sense; seed draws. */
static void randomise(Sim *sim, uint64_t seed)
{
  State *s = &sim->s;
  for (int k = 0; k < ARRAYS; k++) {
    double *a = array_of(sim, &arrays[k]);
    if (!a || arrays[k].size == 4 || strcmp(arrays[k].name, "id") == 0 ||
        strcmp(arrays[k].name, "row") == 0 || strcmp(arrays[k].name, "flaw0") == 0)
      continue;
    for (long i = 0; i < s->n * arrays[k].width; i++)
      a[i] = noise((uint64_t)i, (uint32_t)(seed + (uint64_t)k));
  }
  for (long i = 0; i < s->n; i++) {
    double *const positive[] = {&s->m[i],  &s->rho[i],    &s->h[i],    &s->cs[i],
                                &s->cl[i], &s->signal[i], &s->rhoa[i], &s->ha[i]};
    for (int k = 0; k < 8; k++) *positive[k] = 1.2 + 0.8 * *positive[k];
    s->u[i] = 0.5 + s->u[i], s->ue[i] = 0.5 + s->ue[i];
    for (int d = 0; d < 6; d++)
      s->s[6 * i + d] *= 0.3, s->cm[6 * i + d] += d == 0 || d == 3 || d == 5;
    if (s->alpha) s->alpha[i] = i % 3 == 0 ? 1 : 1.25 + 0.25 * s->alpha[i];
    s->damage[i] = i % 5 == 0 ? 0 : i % 7 == 0 ? 1 : 0.5 + 0.5 * s->damage[i];
    s->nact[i] = (int32_t)(i % (s->nflaw[i] + 1));
    s->nngb[i] = (int32_t)(i % 100);
  }
  for (int slot = 0; slot < sim->slots; slot++)
    for (long i = 0; i < s->n; i++)
      s->saved[slot].rho[i] += 2, s->saved[slot].h[i] += 2, s->saved[slot].alpha[i] = 1.25;
}

/* The CPU's State to the card. */
static void send(Sim sim[2])
{
  for (int k = 0; k < ARRAYS; k++) {
    void *from = array_of(&sim[0], &arrays[k]), *to = array_of(&sim[1], &arrays[k]);
    if (from && to)
      copy(&sim[1], to, from, (size_t)sim[0].s.n * (size_t)(arrays[k].width * arrays[k].size));
  }
}

/* A step with modes drawn from seed. */
static Step any_step(const Sim *sim, uint64_t seed)
{
  Step k = sim_step(sim, seed % 4 == 3 ? 0 : 0.05);
  k.density = (int)(4 * rng_uniform(1, seed, 0)), k.summed = k.density % 3 > 0,
  k.energy = (int)(3 * rng_uniform(1, seed, 1));
  k.smoothing = (int)(4 * rng_uniform(1, seed, 2)), k.dilation = 3,
  k.damage = rng_uniform(1, seed, 3) < 0.7;
  k.strength = rng_uniform(1, seed, 4) < 0.7, k.rates = rng_uniform(1, seed, 5) < 0.5;
  k.viscous = rng_uniform(1, seed, 11) < 0.3, k.fluid = (Fluid){.1, .2, .3, .1, .5};
  k.rich = k.rich && rng_uniform(1, seed, 12) < 0.8;
  k.more = (Rich){
      (int)(seed / 2 % 2), (int)(3 * rng_uniform(1, seed, 13)), seed % 3 == 0, 0.1, 0.2, 0.5, 0.1};
  k.deposit = (Deposit){seed % 3, {.1, .2, .3}, .7, seed % 2, (int)(seed % 4)};
  k.damping = rng_uniform(1, seed, 6) < 0.5 ? 0.3 : 0, k.damping_radial = seed % 2;
  k.slot = (int)(4 * rng_uniform(1, seed, 7));
  k.spin_rate = seed % 3 ? 0.2 : 0, k.spin[1] = 0.4;
  for (int w = 0; w < 3; w++) k.weight[w] = rng_uniform(1, seed, 8 + (uint32_t)w);
  for (int b = 0; b < BODIES; b++)
    for (int d = 0; d < 3; d++)
      k.centre[b][d] = noise(seed, 20), k.velocity[b][d] = noise(seed, 21),
      k.omega[b][d] = noise(seed, 22);
  return k;
}

static void passes(void **state)
{
  static const char *const names[] = {
#define PASS_WORD(CAPITAL, NAME) #NAME,
      PASSES(PASS_WORD)};
  Parts *p = cloud(500, 3);
  Param par = lab_param("integrator=ab2", "gravity.method=none", NULL);
  Sim sim[2];
  (void)state;
  lab_set(&par, RICH);
  open_both(sim, &par, p);
  for (int pass = 0; pass < PASS_COUNT; pass++)
    for (uint64_t seed = 0; seed < 12; seed++) {
      Step k = any_step(&sim[0], 100 * (uint64_t)pass + seed);
      randomise(&sim[0], 1000 * seed);
      send(sim);
      for (int d = 0; d < 2; d++) sim[d].b->pass(&sim[d], pass, &k);
      for (int a = 0; a < ARRAYS; a++) same_array(sim, &arrays[a], 1e-12, names[pass]);
    }
  close_both(sim);
  part_free(p);
}

static void same_limits(Sim sim[2], const Step *k)
{
  Limits a, b;
  Err err;
  assert_int_equal(sim[0].b->limits(&sim[0], k, &a, &err), 0);
  assert_int_equal(sim[1].b->limits(&sim[1], k, &b, &err), 0);
  assert_int_equal(a.id, b.id);
  assert_int_equal(a.which, b.which);
  assert_true(a.dilation == b.dilation);
  if (a.dt != b.dt && !(fabs(a.dt - b.dt) <= 1e-13 * a.dt))
    fail_msg("%s: %.17g %.17g", sim_limit_name(a.which), a.dt, b.dt);
  assert_int_equal(a.bad, b.bad);
  assert_int_equal(a.bad_reason, b.bad_reason);
}

/* Numbers that are equal but for the order of their sums, of terms whose sizes add up to scale. */
static void same_sum(double a, double b, double scale)
{
  if (!(fabs(a - b) <= 1e-13 * scale)) fail_msg("%.17g %.17g of %.3g", a, b, scale);
}

static void same_sums(Sim sim[2])
{
  Sums a, b;
  lab_sums(&sim[0], &a), lab_sums(&sim[1], &b);
  same_sum(a.mass, b.mass, a.mass), same_sum(a.kinetic, b.kinetic, a.kinetic);
  same_sum(a.internal, b.internal, a.mass), same_sum(a.potential, b.potential, a.mass);
  same_sum(a.scale_momentum, b.scale_momentum, a.scale_momentum);
  same_sum(a.scale_angular, b.scale_angular, a.scale_angular);
  for (int d = 0; d < 3; d++) {
    same_sum(a.momentum[d], b.momentum[d], a.scale_momentum);
    same_sum(a.angular[d], b.angular[d], a.scale_angular), same_sum(a.centre[d], b.centre[d], 2);
  }
}

/* Numbers of particles about those of blocks; ties; what is not finite, and who is first. */
static void reductions(void **state)
{
  static const long sizes[] = {1, 2, 127, 129, 3000};
  (void)state;
  for (int c = 0; c < 5; c++) {
    Parts *p = cloud(sizes[c], 3);
    Param par = lab_param("integrator=ab2", "gravity.method=none", NULL);
    Sim sim[2];
    Step k[2];
    double worst[2];
    Err err;
    open_both(sim, &par, p);
    randomise(&sim[0], 77);
    if (sizes[c] > 100) /* the shortest step is that of two: the smaller id counts */
      sim[0].s.signal[11] = sim[0].s.signal[99] = 50, sim[0].s.h[11] = sim[0].s.h[99] = 1;
    send(sim);
    k[0] = k[1] = sim_step(&sim[0], 0.1);
    same_limits(sim, &k[0]), same_sums(sim);
    k[0].strength = k[0].damage = k[0].limited = 1;
    for (int limit = LIMIT_ENERGY; limit < LIMITS; limit++) {
      for (int l = 0; l < LIMITS; l++) k[0].limit[l] = l == limit ? 1e-9 : 0;
      same_limits(sim, &k[0]);
    }
    k[0] = k[1];
    for (int d = 0; d < 2; d++) {
      assert_int_equal(sim[d].b->bodies(&sim[d], &k[d], &err), 0);
      assert_int_equal(sim[d].b->error(&sim[d], &k[d], &worst[d], &err), 0);
    }
    same_sum(worst[0], worst[1], worst[0]);
    for (int b = 0; b < BODIES; b++)
      for (int d = 0; d < 3; d++) {
        same_sum(k[0].centre[b][d], k[1].centre[b][d], 1),
            same_sum(k[0].velocity[b][d], k[1].velocity[b][d], 1);
        same_sum(k[0].omega[b][d], k[1].omega[b][d], 10);
      }
    for (long i = 0; i < sizes[c]; i += 60)
      sim[0].s.u[i] = NAN, sim[0].s.v[3 * i] = i % 2 ? 0 : INFINITY;
    sim[0].s.saved[2].x[1] = NAN;
    send(sim);
    same_limits(sim, &k[0]);
    for (int d = 0; d < 2; d++) sim[d].b->error(&sim[d], &k[d], &worst[d], &err);
    assert_true(worst[0] == 1e300 && worst[1] == 1e300);
    close_both(sim), part_free(p);
  }
}

/* One evaluation after a search, without gravity: order, neighbours, loops. */
static void evaluate(Sim *s)
{
  Err err;
  Step k = sim_step(s, 0.01);
  s->b->pass(s, PASS_STILL, &k), s->b->pass(s, PASS_DRIFT, &k);
  if (s->b->search(s, &err)) fail_msg("%s", err.text);
  if (k.summed) s->b->density(s);
  s->b->gradient(s);
  s->b->pass(s, PASS_ADVANCE, &k);
  s->b->force(s);
}

static void shake(Sim *sim, const Param *par, const Parts *p, double epsilon)
{
  Err err;
  if (sim_open(sim, par, p, "cpu", &err)) fail_msg("%s", err.text);
  for (long i = 0; i < 3 * sim->s.n; i++) sim->s.x[i] *= 1 + (i % 2 ? epsilon : -epsilon);
  evaluate(sim);
}

/* Both do that on the same state. */
static void loops(Sim sim[2], const char *precision, const char *what)
{
  const double tolerance = strcmp(precision, "precision=double") == 0 ? 1e-12 : 3e-5;
  static const char *const exact[] = {"row", "id", "nngb"}, *const near[] = {"divv",   "g",
                                                                             "cm",     "rho",
                                                                             "rhoa",   "delta",
                                                                             "acc",    "du",
                                                                             "signal", "wander",
                                                                             "sense",  "drho",
                                                                             "theta",  "omega",
                                                                             "h"},
                           *const rates[] = {"viscosity", "extra"};
  send(sim);
  for (int d = 0; d < 2; d++) evaluate(&sim[d]);
  for (int a = 0; a < 3; a++) same_array(sim, named(exact[a]), 0, what);
  for (size_t a = 0; a < sizeof near / sizeof *near; a++)
    same_array(sim, named(near[a]), tolerance, what);
  for (int a = 0; a < 2; a++) same_array(sim, named(rates[a]), 30 * tolerance, what);
}

static void all_loops(void **state)
{
  static const char *const precisions[] = {"precision=double", "precision=mixed"};
  char what[512];
  (void)state;
  for (size_t c = 0; c < sizeof loop_cases / sizeof *loop_cases; c++)
    for (int k = 0; k < 2; k++) {
      const LoopCase *l = &loop_cases[c];
      Parts *p = cloud(l->dimension == 1 ? 40 : 400, l->dimension);
      if (l->dimension > 1 && k == 0) p->h[123] *= 12; /* its list is one for a whole warp */
      Param par = lab_param(l->integrator, l->density, l->strength, l->kernel, precisions[k],
                            "gravity.method=none", NULL);
      lab_set(&par, l->more);
      Sim sim[2], third;
      snprintf(what, sizeof what, "%s %s %s %dD %s", l->density, l->strength, precisions[k],
               l->dimension, l->more ? l->more : "");
      if (par.grad_h) shake(&third, &par, p, k == 0 ? DBL_EPSILON : FLT_EPSILON), shaken = &third;
      open_both(sim, &par, p);
      loops(sim, precisions[k], what);
      close_both(sim), part_free(p);
      if (shaken) sim_close(shaken);
      shaken = NULL;
    }
}

static void gravity(void **state)
{
  static const struct {
    const char *method, *precision;
    double tolerance;
  } T[] = {{"gravity.method=direct", "precision=double", 1e-12},
           {"gravity.method=direct", "precision=mixed", 1e-5},
           {"gravity.method=tree", "precision=double", 1e-2},
           {"gravity.method=tree", "precision=mixed", 1e-2}};
  static const char *const softening[] = {NULL, "gravity.epsilon=0.2",
                                          "gravity.softening=plummer gravity.epsilon=0.2"};
  (void)state;
  for (int k = 0; k < 12; k++) {
    const int c = k % 4;
    Parts *p = cloud(700, 3);
    Param par = lab_param(T[c].method, T[c].precision, "gravity.G=1", NULL);
    Sim sim[2];
    Err err;
    lab_set(&par, softening[k / 4]);
    open_both(sim, &par, p);
    for (int d = 0; d < 2; d++) {
      State *s = &sim[d].s;
      double *zero = calloc((size_t)s->n, 24);
      copy(&sim[d], s->acc, zero, (size_t)s->n * 24);
      if (sim[d].b->gravity(&sim[d], &err)) fail_msg("%s", err.text);
      free(zero);
    }
    same_array(sim, named("acc"), T[c].tolerance, T[c].method);
    same_array(sim, named("phi"), T[c].tolerance, T[c].method);
    close_both(sim), part_free(p);
  }
}

static int in_ball(const double *x, void *data)
{
  (void)data;
  return x[0] * x[0] + x[1] * x[1] + x[2] * x[2] < 1;
}

/* A small ball of rock runs into a larger one. */
static Parts *impact(double dx)
{
  long n = lab_lattice(dx, 9, 3, in_ball, NULL, NULL),
       few = lab_lattice(2 * dx, 9, 3, in_ball, NULL, NULL);
  Parts *p = lab_parts(n + few, 3, materials[1]);
  Material *material;
  WeibullGroup *group;
  int groups;
  Err err;
  lab_lattice(dx, 9, 3, in_ball, NULL, p->x),
      lab_lattice(2 * dx, 9, 3, in_ball, NULL, p->x + 3 * n);
  for (long i = 0; i < p->n; i++) {
    if (i >= n) {
      for (int d = 0; d < 3; d++) p->x[3 * i + d] *= 0.5;
      p->x[3 * i] -= 1.4, p->v[3 * i] = 1, p->body[i] = 1;
    }
    p->m[i] = dx * dx * dx, p->rho[i] = 1, p->h[i] = 2.1 * dx, p->u[i] = 1e-3;
  }
  if (!(material = material_load(p, &err))) fail_msg("%s", err.text);
  assert_return_code(weibull_assign(p, material, &(WeibullOptions){.seed = 3, .minimum = 1}, &group,
                                    &groups, &err),
                     0);
  free(group), material_free(material, p->materials);
  return p;
}

static double sum_of(const double *a, long n)
{
  double sum = 0;
  for (long i = 0; i < n; i++) sum += a[i];
  return sum;
}

/* steps of a solid impact with damage on one device. */
static Parts *run(const char *device, double dx, int steps, const char *precision)
{
  Parts *p = impact(dx);
  Param par = lab_param(precision, "gravity.method=direct", "gravity.G=0.01", NULL);
  Sim sim;
  SimStep done;
  Err err;
  if (sim_open(&sim, &par, p, device, &err)) fail_msg("%s", err.text);
  for (int k = 0; k < steps; k++)
    if (sim_advance(&sim, 1e9, &done, &err)) fail_msg("%s", err.text);
  lab_store(&sim, p);
  sim_close(&sim);
  return p;
}

/* The largest distance of a particle to itself in two runs, and what differs in sum. */
static void compare_runs(const char *precision, double place, double total)
{
  const int steps = (int)small_or(200, 5);
  Parts *a = run("cpu", 0.3, steps, precision), *b = run("cuda", 0.3, steps, precision);
  double worst = 0, da = sum_of(a->damage, a->n), db = sum_of(b->damage, b->n);
  for (long i = 0; i < 3 * a->n; i++) worst = fmax(worst, fabs(a->x[i] - b->x[i]));
  print_message("%s: %d steps, %ld particles, damage %.3f: places differ by %.1e, damage by %.1e\n",
                precision, steps, a->n, da / (double)a->n, worst, fabs(da - db) / da);
  assert_true(da > 0.05 * (double)a->n || steps < 200);
  assert_true(worst < place && fabs(da - db) <= total * da);
  part_free(a), part_free(b);
}

static void impacts(void **state)
{
  (void)state;
  compare_runs("precision=double", 1e-11, 1e-12);
  compare_runs("precision=mixed", 1e-3, 1e-6);
}

/* Ten runs, one result. */
static void bits(void **state)
{
  Parts *first = run("cuda", 0.4, 10, "precision=mixed");
  (void)state;
  for (long k = small_or(9, 1); k > 0; k--) {
    Parts *p = run("cuda", 0.4, 10, "precision=mixed");
    for (int f = 0; f < part_field_count; f++) {
      const void *u = part_array(first, &part_fields[f]), *v = part_array(p, &part_fields[f]);
      assert_true(!u == !v);
      if (u && memcmp(u, v, (size_t)p->n * (size_t)part_fields[f].size))
        fail_msg("run %ld: %s differs", k, part_fields[f].name);
    }
    part_free(p);
  }
  part_free(first);
}

/* The tables of the materials, of temperatures and of energies, smaller than where states lie. */
static int tables(void **state)
{
  static const double rho[] = {0.6, 1.8}, y[] = {0.2, 1.1};
  static const Material gas = {.heat = 1, .eos = {.form = EOS_IDEAL, .ideal = {1.4, 0}}};
  Err err;
  if (folder_setup(state)) return -1;
  for (int heat = 0; heat < 2; heat++) {
    Table t = tabulated_law(&gas, rho, 12, y, 9, heat);
    for (int k = 0; k < t.nrho * t.ny; k++) t.field[TABLE_PHASE][k] = k % 3; /* vapour: 2 */
    if (tabfile_write(&t, heat ? "heat.h5" : "energy.h5", TABFILE_HDF5, &err))
      fail_msg("%s", err.text);
    table_free(&t);
  }
  return 0;
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(all_laws),   cmocka_unit_test(passes),
                                     cmocka_unit_test(reductions), cmocka_unit_test(all_loops),
                                     cmocka_unit_test(gravity),    cmocka_unit_test(impacts),
                                     cmocka_unit_test(bits)};
  return cmocka_run_group_tests(tests, tables, folder_teardown);
}
