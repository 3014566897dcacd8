/* SPDX-License-Identifier: GPL-3.0-or-later */
/* mksphere: a ball of one or more layers as particles, uncompressed, in hydrostatic equilibrium, or
 * on a profile from a file (docs/theory.md 6.1). Layers have their exact masses. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "errors.h"
#include "lib/figure.h"
#include "lib/material.h"
#include "lib/opt.h"
#include "lib/place.h"
#include "lib/profile.h"
#include "lib/recipe.h"
#include "lib/snap.h"
#include "lib/unit.h"

static const double PI = 3.14159265358979323846;

static struct {
  long n, dimension, rotate;
  double mass, radius, outer, energy, entropy, temperature, neighbours, spin;
  const char *lattice, *equal, *profile, *out;
  int hydrostatic;
  OptList layers;
} o = {.mass = NAN,
       .radius = NAN,
       .neighbours = NAN,
       .spin = NAN,
       .rotate = -1,
       .entropy = NAN,
       .temperature = NAN};

/* clang-format off */
static const Opt OPTS[] = {
  {"number",     'n', OPT_INT,    "20000", "N",         "particles; lattices make whole shells", &o.n},
  {"mass",       'm', OPT_REAL,   NULL,    "kg",        "mass (in 2D per metre, in 1D per square metre)", &o.mass},
  {"radius",     'r', OPT_REAL,   NULL,    "m",         "radius (1D: half the length)", &o.radius},
  {"layer",      'l', OPT_LIST,   NULL,    "MATERIAL[:SHARE][:STATE]", "a layer, the innermost first", &o.layers},
  {"hydrostatic", 0,  OPT_FLAG,   NULL,    NULL,        "place the body compressed by its own gravity", &o.hydrostatic},
  {"profile",    'p', OPT_TEXT,   NULL,    "FILE",      "place it on a profile as relax writes it", &o.profile},
  {"outer-pressure", 0, OPT_REAL, "0",     "Pa",        "pressure outside", &o.outer},
  {"energy",     'u', OPT_REAL,   "0",     "J/kg",      "specific internal energy at zero pressure", &o.energy},
  {"entropy",    0,   OPT_REAL,   NULL,    "J/K/kg",    "specific entropy, instead of energy", &o.entropy},
  {"temperature", 'T', OPT_REAL,  NULL,    "K",         "temperature of the surface, continuous below", &o.temperature},
  {"lattice",    0,   OPT_CHOICE, "hcp",   "hcp|cubic|stretched|shells", "shells: of equal areas (SEA)", &o.lattice},
  {"equal",      0,   OPT_CHOICE, NULL,    "volume|mass", "of all particles, at rest (stretched, shells: mass)", &o.equal},
  {"neighbours", 0,   OPT_REAL,   NULL,    "1",         "in the kernel's support, itself included (57; 2D: 19; 1D: 5)", &o.neighbours},
  {"rotate",     0,   OPT_INT,    NULL,    "SEED",      "turn the lattice at random by this seed", &o.rotate},
  {"spin",       0,   OPT_REAL,   NULL,    "s",         "period of rotation about z; negative: clockwise", &o.spin},
  {"dimension",  'd', OPT_INT,    "3",     "1|2|3",     "sphere, disc or segment", &o.dimension},
  {"output",     'o', OPT_TEXT,   "-",     "FILE",      "where the body goes", &o.out},
  {NULL, 0, OPT_FLAG, NULL, NULL, NULL, NULL}};

static const OptProgram PROGRAM = {
  "mksphere", "build a body of particles on a lattice", "[options] > body.h5",
  "SHARE: mass fraction (0.3), mass (4e22kg) or outer radius (1200km) of the layer; empty: to be found. As many of mass, "
  "radius and shares as there are layers. STATE: u=, s=, T=1500K or T=continuous; isentropic, isothermal or power=A (T ~ rho^A); pores=P. "
  "Without --hydrostatic the body is uncompressed: relax gives it its pressure.",
  "mksphere -n 20000 --mass 9.43e20 --layer basalt:0.7 --layer ice:0.3 --rotate 1 > body.h5\n"
  "mksphere -m 1Mearth -r 6371km -l iron -l granite -T 300K --hydrostatic > earth.h5", OPTS, 0, 0};
/* clang-format on */

/* The body, what it is made of, and its structure where there is one. */
typedef struct {
  Recipe r;
  Profile profile;
  const Structure *s;
  Material material[STRUCTURE_LAYERS];
  const Material *by_mat[STRUCTURE_LAYERS];
  MaterialName name[STRUCTURE_LAYERS];
  char *text[STRUCTURE_LAYERS];
} Body;

static void check_state(void)
{
  if (o.energy < 0) err_usage("energy %g J/kg is negative", o.energy);
  if (o.temperature < 0) err_usage("temperature %g K is negative", o.temperature);
  if (o.outer < 0) err_usage("pressure outside %g Pa is negative", o.outer);
  if (opt_given(&PROGRAM, "energy") + !isnan(o.entropy) + !isnan(o.temperature) > 1)
    err_usage("give one of --energy, --entropy and --temperature");
}

static void check_options(void)
{
  int rigid = !strcmp(o.lattice, "hcp") || !strcmp(o.lattice, "cubic");
  int given = opt_given(&PROGRAM, "energy") || !isnan(o.entropy) || !isnan(o.temperature);
  if (!isnan(o.mass) && o.mass <= 0) err_usage("mass %g kg is not positive", o.mass);
  if (!isnan(o.radius) && o.radius <= 0) err_usage("radius %g m is not positive", o.radius);
  if (o.dimension < 1 || o.dimension > 3) err_usage("dimension %ld is not 1, 2 or 3", o.dimension);
  if (o.n < 1 || o.n > 2000000000) err_usage("number of particles %ld is not in 1..2e9", o.n);
  if (!isnan(o.neighbours) && o.neighbours <= 1) err_usage("--neighbours must be greater than 1");
  if (o.neighbours > (double)o.n) err_usage("--neighbours %g of %ld particles", o.neighbours, o.n);
  if (o.spin == 0) err_usage("a spin period of 0 s is infinitely fast");
  if (opt_given(&PROGRAM, "rotate") && o.rotate < 0) err_usage("seed %ld is negative", o.rotate);
  if (o.dimension == 1 && (!isnan(o.spin) || o.rotate >= 0))
    err_usage("a segment (1D) cannot be turned");
  if (o.dimension < 3 && (o.hydrostatic || o.profile))
    err_usage("a hydrostatic body has 3 dimensions");
  if (o.dimension < 3 && !strcmp(o.lattice, "shells")) err_usage("shells need 3 dimensions");
  if (rigid && o.equal && !strcmp(o.equal, "mass"))
    err_usage("--equal mass needs --lattice stretched or shells: those of %s have equal volumes",
              o.lattice);
  check_state();
  if (o.profile && (!isnan(o.mass) || !isnan(o.radius) || o.hydrostatic || given || o.outer > 0))
    err_usage("--profile says mass, radius, pressure and state: give it alone");
  if (o.profile) return;
  if (isnan(o.mass) && isnan(o.radius) && o.layers.n < 2)
    err_usage("give either --mass or --radius");
  if (!o.layers.n) err_usage("which material? give --layer MATERIAL:MASSFRACTION");
}

/* The state of layer k where its text has none. */
static StructureLayer standard(int k)
{
  StructureLayer l = {.anchor = STRUCTURE_ENERGY, .at = o.energy};
  if (!isnan(o.entropy)) l.anchor = STRUCTURE_ENTROPY, l.at = o.entropy;
  if (!isnan(o.temperature)) {
    l.anchor = k == o.layers.n - 1 ? STRUCTURE_TEMPERATURE : STRUCTURE_CONTINUOUS;
    l.at = o.temperature;
  }
  return l;
}

static void read_layers(Body *b)
{
  Err err;
  b->r = (Recipe){.mass = o.mass, .radius = o.radius};
  b->r.body.outer = o.outer, b->r.body.weightless = !o.hydrostatic;
  for (int k = 0; k < o.layers.n; k++) {
    char material[256];
    StructureLayer usual = standard(k);
    if (recipe_layer(&b->r, o.layers.text[k], &usual, material, &err)) err_usage("%s", err.text);
    if (!(b->text[k] = material_find(material, b->name[k], &err))) err_die("%s", err.text);
    if (material_parse(&b->material[k], b->text[k], b->name[k], &err)) err_die("%s", err.text);
    b->r.body.layer[k].material = &b->material[k];
    if (!(b->r.body.layer[k].pores > 0)) /* a porous material's own */
      b->r.body.layer[k].pores = 1 - 1 / material_distention(&b->material[k]);
  }
}

/* A mistake in the numbers given is one of usage; that no such body exists is not. */
static void solve(Body *b)
{
  Recipe counted = b->r;
  Err err;
  if (recipe_count(&counted, &err)) err_usage("%s", err.text);
  if (recipe_solve(&b->r, (int)o.dimension, &err)) err_die("%s", err.text);
  if (o.dimension < 3) return;
  if (structure_solve(&b->profile.s, &b->r.body, 4000, &err)) err_die("%s", err.text);
  b->s = &b->profile.s;
}

/* What a profile's file says; layers on the command line name its materials when it does not. */
static void read_profile(Body *b)
{
  Profile *p = &b->profile;
  Err err;
  if (o.layers.n) read_layers(b);
  if (profile_read(p, o.profile, &err)) err_die("%s", err.text);
  if (!p->body.layers && o.layers.n != p->s.layers)
    err_usage("'%s' does not name the materials of its %d layers: give each by --layer", o.profile,
              p->s.layers);
  if (p->body.layers && o.layers.n) err_usage("'%s' names its own layers", o.profile);
  for (int k = 0; k < p->s.layers; k++) {
    double mass = p->body.layer[k].mass;
    if (p->body.layers) {
      b->r.body.layer[k] = p->body.layer[k];
      b->material[k] = p->material[k], b->text[k] = p->text[k], p->text[k] = NULL;
      memcpy(b->name[k], p->name[k], sizeof b->name[k]);
    }
    b->r.body.layer[k].mass = mass, b->r.body.layer[k].material = &b->material[k];
  }
  b->r.body.layers = p->s.layers, b->r.body.outer = p->body.outer, b->r.body.weightless = 0;
  b->r.mass = p->s.node[p->s.n - 1].m, b->r.radius = p->s.node[p->s.n - 1].r;
  for (long i = 0; i < p->s.n; i++) {
    StructureNode *n = &p->s.node[i];
    n->cs = eos_eval(&b->material[n->layer].eos, n->rho, n->u, 0).cs;
  }
  b->s = &p->s;
}

/* An uncompressed body keeps the shape it is given: cohesion may hold what gravity does not. */
static void check_spin(const Body *b)
{
  const double shed = 2 * PI * sqrt(pow(b->r.radius, 3) / (UNIT_G * b->r.mass));
  if (o.dimension == 3 && b->r.body.weightless && fabs(o.spin) < shed)
    err_warn("gravity alone does not hold a body of this density that spins in less than %g s "
             "(period %g s)",
             shed, fabs(o.spin));
}

/* The figure of a body that spins. */
static void flatten(Body *b)
{
  Structure *s = &b->profile.s;
  Err err;
  if (!isnan(o.spin)) check_spin(b);
  if (isnan(o.spin) || !b->s || b->r.body.weightless || s->node[s->n - 1].f != 0) return;
  if (figure_spin(s, &b->r.body, 2 * PI / o.spin, &err)) err_die("%s", err.text);
  b->r.radius = s->node[s->n - 1].r;
}

/* Numbers of the materials among the particles', equal ones only once. */
static void number_materials(Body *b, Parts *names)
{
  Err err;
  for (int k = 0; k < b->r.body.layers; k++) {
    int mat = part_add_material(names, b->name[k], b->text[k], &err);
    if (mat < 0) err_die("%s", err.text);
    b->r.body.layer[k].mat = mat, b->by_mat[mat] = &b->material[k];
  }
}

/* Rigid rotation about z. */
static void spin(Parts *p)
{
  double omega = 2 * PI / o.spin;
  for (long i = 0; i < p->n; i++)
    p->v[3 * i] = -omega * p->x[3 * i + 1], p->v[3 * i + 1] = omega * p->x[3 * i];
}

static void numbers(const Body *b, const Placed *placed)
{
  Parts *p = placed->p;
  Err err;
  if (part_set_number(p, "body", "Radius0", b->r.radius, &err) ||
      part_set_number(p, "body", "Spacing0", placed->spacing, &err) ||
      (p->dimension == 3 && recipe_store(p, &b->r.body, &err)) ||
      (!isnan(o.spin) && part_set_number(p, "body", "SpinPeriod0", o.spin, &err)))
    err_die("%s", err.text);
}

static void summary(const Body *b, const Placed *placed)
{
  const Parts *p = placed->p;
  const char *unit = p->dimension == 3 ? "kg" : p->dimension == 2 ? "kg/m" : "kg/m^2";
  char radius[64], step[64], support[64];
  fprintf(stderr, "mksphere: %ld particles, mass %.6g %s, radius %s, spacing %s, support %s\n",
          p->n, b->r.mass, unit, unit_length_text(b->r.radius, radius, sizeof radius),
          unit_length_text(placed->spacing, step, sizeof step),
          unit_length_text(placed->h, support, sizeof support));
  for (int k = 0; k < b->r.body.layers; k++) {
    const StructureNode *n = b->s ? &b->s->node[b->s->first[k + 1] - 1] : NULL;
    double rho = p->rho[0];
    for (long i = 0; i < p->n && !n; i++)
      if (p->mat[i] == b->r.body.layer[k].mat) rho = p->rho[i];
    fprintf(stderr, "mksphere: layer %d, %s: %ld particles, mass %.6g %s, density %.6g kg/m^3\n",
            k + 1, b->name[k], placed->number[k], b->r.body.layer[k].mass, unit, n ? n->rho : rho);
  }
  if (b->s && !b->r.body.weightless)
    fprintf(stderr, "mksphere: central pressure %.6g Pa, density %.6g kg/m^3\n", b->s->node[0].p,
            b->s->node[0].rho);
  if (b->s && b->s->node[b->s->n - 1].f != 0)
    fprintf(stderr, "mksphere: flattening %.4f at the surface, %.4f in the centre\n",
            b->s->node[b->s->n - 1].f, b->s->node[0].f);
}

static void quality(const Body *b, const Parts *p)
{
  Errors e;
  Err err;
  if (errors_measure(&e, p, b->by_mat, b->s, &err)) err_die("%s", err.text);
  if (e.inside)
    fprintf(
        stderr,
        "mksphere: SPH density off by %.2e rms, its noise %.2e, forces of pressure by %+.1e, in "
        "%ld particles away from surfaces",
        e.density, e.noise, e.push, e.inside);
  else
    fprintf(stderr, "mksphere: no particle is away from all surfaces");
  if (!isnan(e.pressure)) fprintf(stderr, "; pressure %.2e of the central one", e.pressure);
  if (!isnan(e.mass)) fprintf(stderr, "; mass inside r %.2e of the whole", e.mass);
  fprintf(stderr, "\n");
}

int main(int argc, char **argv)
{
  const double neighbours[] = {0, 5, 19, 57};
  static Body b;
  Parts *names = part_new(0);
  Placed placed;
  Place how;
  Err err;
  char *line = opt_command_line(argc, argv);
  int n;
  opt_parse(&PROGRAM, argc, argv, &n);
  check_options();
  if (!names) err_die("out of memory");
  if (o.profile)
    read_profile(&b);
  else
    read_layers(&b), solve(&b);
  flatten(&b);
  number_materials(&b, names);
  how = (Place){(int)o.dimension,
                o.n,
                (Placing)unit_choice(o.lattice, PLACE_WORDS, &err),
                !o.equal || !strcmp(o.equal, "mass"),
                isnan(o.neighbours) ? neighbours[o.dimension] : o.neighbours,
                o.rotate};
  if (place_ball(&placed, &how, &b.r.body, b.s, &err)) err_die("%s", err.text);
  number_materials(&b, placed.p);
  if (!isnan(o.spin)) spin(placed.p);
  numbers(&b, &placed);
  if (part_history(placed.p, line, &err) || snap_write(placed.p, o.out, 0, &err))
    err_die("%s", err.text);
  summary(&b, &placed);
  quality(&b, placed.p);
  for (int k = 0; k < b.r.body.layers; k++) material_clear(&b.material[k]), free(b.text[k]);
  profile_free(&b.profile), part_free(names), part_free(placed.p);
  free(line), free(o.layers.text);
  return 0;
}
