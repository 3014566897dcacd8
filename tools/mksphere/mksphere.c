/* SPDX-License-Identifier: GPL-3.0-or-later */
/* mksphere: an uncompressed body of one or more layers as particles on a lattice
 * (docs/theory.md 6.1). Every particle has the same volume; layers end at whole shells
 * of the lattice and get their exact masses. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "lib/lattice.h"
#include "lib/material.h"
#include "lib/opt.h"
#include "lib/rng.h"
#include "lib/snap.h"
#include "lib/structure.h"
#include "lib/unit.h"

typedef struct {
  char name[64], *text;
  double fraction, rho, mass; /* of the body's mass, kg/m^3, kg */
  long end;                   /* particles in this layer and all inside it */
  int mat;
} Layer;

static const double PI = 3.14159265358979323846;

static struct {
  long n, dimension, rotate;
  double mass, radius, energy, neighbours, spin;
  const char *lattice, *out;
  OptList layers;
} o = {.mass = NAN, .radius = NAN, .neighbours = NAN, .spin = NAN, .rotate = -1};

/* clang-format off */
static const Opt OPTS[] = {
  {"number",     'n', OPT_INT,    "20000", "N",         "particles wanted; the nearest number of whole shells is made", &o.n},
  {"mass",       'm', OPT_REAL,   NULL,    "kg",        "mass (in 2D per metre, in 1D per square metre)", &o.mass},
  {"radius",     'r', OPT_REAL,   NULL,    "m",         "radius instead of mass, uncompressed (1D: half the length)", &o.radius},
  {"layer",      'l', OPT_LIST,   NULL,    "MATERIAL:MASSFRACTION", "a layer; the first is the innermost", &o.layers},
  {"lattice",    0,   OPT_CHOICE, "hcp",   "hcp|cubic", "close packing (2D: hexagonal) or cubic", &o.lattice},
  {"neighbours", 0,   OPT_REAL,   NULL,    "1",         "in the kernel's support, itself included (57; 2D: 19; 1D: 5)", &o.neighbours},
  {"rotate",     0,   OPT_INT,    NULL,    "SEED",      "turn the lattice at random by this seed", &o.rotate},
  {"spin",       0,   OPT_REAL,   NULL,    "s",         "period of rotation about z; negative: clockwise", &o.spin},
  {"energy",     'u', OPT_REAL,   "0",     "J/kg",      "specific internal energy at zero pressure", &o.energy},
  {"dimension",  'd', OPT_INT,    "3",     "1|2|3",     "sphere, disc or segment", &o.dimension},
  {"output",     'o', OPT_TEXT,   "-",     "FILE",      "where the body goes", &o.out},
  {NULL, 0, OPT_FLAG, NULL, NULL, NULL, NULL}};

static const OptProgram PROGRAM = {
  "mksphere", "build a body of particles on a lattice", "[options] > body.h5",
  "The body is uncompressed: each layer has the density at which its pressure is zero. relax gives it its pressure.",
  "mksphere -n 20000 --mass 9.43e20 --layer basalt:0.7 --layer ice:0.3 --rotate 1 > body.h5", OPTS, 0, 0};
/* clang-format on */

static double ball_volume(int dimension, double r)
{
  return dimension == 3 ? 4 * PI / 3 * r * r * r : dimension == 2 ? PI * r * r : 2 * r;
}

static double ball_radius(int dimension, double volume)
{
  return dimension == 3   ? cbrt(volume / (4 * PI / 3))
         : dimension == 2 ? sqrt(volume / PI)
                          : volume / 2;
}

static void check_options(void)
{
  if (isnan(o.mass) == isnan(o.radius)) err_usage("give either --mass or --radius");
  if (!isnan(o.mass) && o.mass <= 0) err_usage("mass %g kg is not positive", o.mass);
  if (!isnan(o.radius) && o.radius <= 0) err_usage("radius %g m is not positive", o.radius);
  if (o.dimension < 1 || o.dimension > 3) err_usage("dimension %ld is not 1, 2 or 3", o.dimension);
  if (o.n < 1 || o.n > 2000000000) err_usage("number of particles %ld is not in 1..2e9", o.n);
  if (!isnan(o.neighbours) && o.neighbours <= 1) err_usage("--neighbours must be greater than 1");
  if (o.energy < 0) err_usage("energy %g J/kg is negative", o.energy);
  if (o.spin == 0) err_usage("a spin period of 0 s is infinitely fast");
  if (opt_given(&PROGRAM, "rotate") && o.rotate < 0) err_usage("seed %ld is negative", o.rotate);
  if (o.dimension == 1 && (!isnan(o.spin) || o.rotate >= 0))
    err_usage("a segment (1D) cannot be turned");
  if (!o.layers.n) err_usage("which material? give --layer MATERIAL:MASSFRACTION");
  if (o.layers.n > STRUCTURE_LAYERS) err_usage("more than %d layers", STRUCTURE_LAYERS);
}

/* "basalt:0.7"; a single layer may come without its fraction of 1. */
static void read_layer(Layer *l, const char *text, int only)
{
  char *name = strdup(text), *colon;
  Material material;
  Err err;
  if (!name) err_die("out of memory");
  colon = strrchr(name, ':');
  l->fraction = 1;
  if (colon) {
    *colon = 0;
    if (unit_parse(colon + 1, "1", &l->fraction, &err)) err_usage("layer '%s': %s", text, err.text);
  } else if (!only)
    err_usage("layer '%s' has no mass fraction (MATERIAL:MASSFRACTION)", text);
  if (!(l->fraction > 0)) err_usage("layer '%s': the mass fraction is not positive", text);
  if (!(l->text = material_find(name, l->name, &err))) err_die("%s", err.text);
  if (material_parse(&material, l->text, l->name, &err)) err_die("%s", err.text);
  if (structure_density(&material.eos, o.energy, &l->rho, &err))
    err_die("layer '%s': %s", l->name, err.text);
  free(name);
}

/* Materials, masses and densities; returns the volume of the body and sets o.mass and o.radius. */
static double read_layers(Layer *layer)
{
  double sum = 0, specific = 0;
  int n = o.layers.n;
  for (int k = 0; k < n; k++) {
    read_layer(layer + k, o.layers.text[k], n == 1);
    sum += layer[k].fraction, specific += layer[k].fraction / layer[k].rho;
  }
  if (!(fabs(sum - 1) <= 1e-9))
    err_usage("the mass fractions of the layers sum to %.10g, not to 1", sum);
  specific /= sum;
  if (isnan(o.mass))
    o.mass = ball_volume((int)o.dimension, o.radius) / specific;
  else
    o.radius = ball_radius((int)o.dimension, o.mass * specific);
  for (int k = 0; k < n; k++) layer[k].mass = o.mass * layer[k].fraction / sum;
  return o.mass * specific;
}

/* Where each layer ends: the whole shells whose volume comes closest to the layers' volume. */
static void cut_layers(Layer *layer, const LatticeBall *ball, double volume)
{
  double inside = 0;
  for (int k = 0; k < o.layers.n; k++) {
    long before = k ? layer[k - 1].end : 0, shells;
    inside += layer[k].mass / layer[k].rho / volume;
    shells = k == o.layers.n - 1 ? ball->shells : lattice_cut(ball, inside * (double)ball->n);
    layer[k].end = shells ? ball->within[shells - 1] : 0;
    if (layer[k].end <= before)
      err_die("layer '%s' is too thin for a particle: more are needed (-n)", layer[k].name);
  }
}

static void turn(Parts *p)
{
  double m[3][3], angle = 2 * PI * rng_uniform((uint64_t)o.rotate, 0, 0), c = cos(angle),
                  s = sin(angle);
  if (p->dimension == 3)
    rng_rotation((uint64_t)o.rotate, m);
  else
    memcpy(m, (double[3][3]){{c, -s, 0}, {s, c, 0}, {0, 0, 1}}, sizeof m);
  for (long i = 0; i < p->n; i++) {
    double *x = p->x + 3 * i, old[3] = {x[0], x[1], x[2]};
    for (int a = 0; a < 3; a++) x[a] = m[a][0] * old[0] + m[a][1] * old[1] + m[a][2] * old[2];
  }
}

static void recentre(Parts *p)
{
  double com[3] = {0};
  for (long i = 0; i < p->n; i++)
    for (int a = 0; a < 3; a++) com[a] += p->m[i] * p->x[3 * i + a] / o.mass;
  for (long i = 0; i < p->n; i++)
    for (int a = 0; a < 3; a++) p->x[3 * i + a] -= com[a];
}

/* Rigid rotation about z. */
static void spin(Parts *p)
{
  double omega = 2 * PI / o.spin;
  for (long i = 0; i < p->n; i++)
    p->v[3 * i] = -omega * p->x[3 * i + 1], p->v[3 * i + 1] = omega * p->x[3 * i];
}

static void name_materials(Parts *p, Layer *layer)
{
  Err err;
  for (int k = 0; k < o.layers.n; k++)
    if ((layer[k].mat = part_add_material(p, layer[k].name, layer[k].text, &err)) < 0)
      err_die("%s", err.text);
}

static Parts *particles(Layer *layer, const LatticeBall *ball, double spacing, double h)
{
  Err err;
  Parts *p = part_new(ball->n);
  if (!p || part_add(p, "id x v m rho u h mat body", &err))
    err_die("no memory for %ld particles", ball->n);
  p->dimension = (int)o.dimension;
  name_materials(p, layer);
  for (long i = 0; i < p->n; i++) {
    int k = 0;
    while (ball->within[ball->shell[i]] > layer[k].end) k++;
    p->id[i] = i, p->mat[i] = layer[k].mat;
    for (int a = 0; a < 3; a++) p->x[3 * i + a] = spacing * ball->x[3 * i + a];
    p->m[i] = layer[k].mass / (double)(layer[k].end - (k ? layer[k - 1].end : 0));
    p->rho[i] = layer[k].rho, p->u[i] = o.energy, p->h[i] = h;
  }
  return p;
}

static void summary(const Layer *layer, const Parts *p, double spacing, double h)
{
  const char *unit = p->dimension == 3 ? "kg" : p->dimension == 2 ? "kg/m" : "kg/m^2";
  char radius[64], step[64], support[64];
  fprintf(stderr, "mksphere: %ld particles, mass %.6g %s, radius %s, spacing %s, support %s\n",
          p->n, o.mass, unit, unit_length_text(o.radius, radius, sizeof radius),
          unit_length_text(spacing, step, sizeof step),
          unit_length_text(h, support, sizeof support));
  for (int k = 0; k < o.layers.n; k++)
    fprintf(stderr, "mksphere: layer %d, %s: %ld particles, mass %.6g %s, density %.6g kg/m^3\n",
            k + 1, layer[k].name, layer[k].end - (k ? layer[k - 1].end : 0), layer[k].mass, unit,
            layer[k].rho);
}

static Parts *body(Layer *layer, double *spacing, double *h)
{
  const double neighbours[] = {0, 5, 19, 57};
  double volume = read_layers(layer);
  LatticeBall ball;
  Parts *p;
  Err err;
  if (lattice_ball(&ball, strcmp(o.lattice, "cubic") ? LATTICE_HCP : LATTICE_CUBIC,
                   (int)o.dimension, o.n, &err))
    err_die("%s", err.text);
  cut_layers(layer, &ball, volume);
  if (isnan(o.neighbours)) o.neighbours = neighbours[o.dimension];
  *spacing = pow(volume / (double)ball.n / ball.volume, 1. / (double)o.dimension);
  *h = ball_radius((int)o.dimension, o.neighbours * volume / (double)ball.n);
  p = particles(layer, &ball, *spacing, *h);
  lattice_free(&ball);
  if (o.rotate >= 0) turn(p);
  recentre(p);
  if (!isnan(o.spin)) spin(p);
  if (part_set_number(p, "body", "Radius0", o.radius, &err) ||
      part_set_number(p, "body", "Spacing0", *spacing, &err))
    err_die("%s", err.text);
  return p;
}

int main(int argc, char **argv)
{
  Layer layer[STRUCTURE_LAYERS];
  Parts *p;
  Err err;
  double spacing, h;
  char *line = opt_command_line(argc, argv);
  int n;
  opt_parse(&PROGRAM, argc, argv, &n);
  check_options();
  p = body(layer, &spacing, &h);
  if (part_history(p, line, &err) || snap_write(p, o.out, 0, &err)) err_die("%s", err.text);
  summary(layer, p, spacing, h);
  for (int k = 0; k < o.layers.n; k++) free(layer[k].text);
  part_free(p), free(line), free(o.layers.text);
  return 0;
}
