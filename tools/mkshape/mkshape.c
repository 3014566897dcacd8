/* SPDX-License-Identifier: GPL-3.0-or-later */
/* mkshape: a shape filled with particles at rest: bodies that are no balls, shape models, rubble
 * piles, targets in layers, pieces for the laboratory (docs/theory.md 6.1). mksphere makes balls.
 * */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "lib/lattice.h"
#include "lib/material.h"
#include "lib/opt.h"
#include "lib/pack.h"
#include "lib/recipe.h"
#include "lib/rng.h"
#include "lib/shape.h"
#include "lib/snap.h"
#include "lib/structure.h"
#include "lib/unit.h"

static const double PI = 3.14159265358979323846;
enum { BOULDERS = 1024 }; /* as many bodies as programs tell apart */

static struct {
  long n, dimension, rotate, seed;
  double energy, neighbours, spin, scale, fill, spacing;
  const char *shape, *size, *mesh, *lattice, *rubble, *out;
  OptList layers;
} o = {.neighbours = NAN, .spin = NAN, .spacing = NAN, .rotate = -1};

/* clang-format off */
static const Opt OPTS[] = {
  {"shape",      0,   OPT_CHOICE, "ellipsoid", "ellipsoid|box|cylinder|hemisphere|rod|ring|tank|mesh", "what is filled", &o.shape},
  {"size",       0,   OPT_TEXT,   NULL,    "LENGTH,...", "its sizes, see below", &o.size},
  {"mesh",       0,   OPT_TEXT,   NULL,    "FILE",      "closed surface for --shape mesh, STL or OBJ", &o.mesh},
  {"scale",      0,   OPT_REAL,   "1",     "m",         "a unit of that file", &o.scale},
  {"number",     'n', OPT_INT,    "20000", "N",         "particles wanted, about", &o.n},
  {"spacing",    0,   OPT_REAL,   NULL,    "m",         "instead of it: of the lattice", &o.spacing},
  {"layer",      'l', OPT_LIST,   NULL,    "MATERIAL[:THICKNESS][:pores=P][:rho=R]", "from the top; tank: content, walls", &o.layers},
  {"rubble",     0,   OPT_TEXT,   NULL,    "MIN:MAX[:SLOPE]", "boulders of these radii, N(>r) ~ r^-SLOPE (2.5)", &o.rubble},
  {"fill",       0,   OPT_REAL,   "0.5",   "1",         "volume of the boulders that is tried for, over that of the shape", &o.fill},
  {"seed",       0,   OPT_INT,    "1",     "SEED",      "of the boulders", &o.seed},
  {"lattice",    0,   OPT_CHOICE, "hcp",   "hcp|cubic|grid", "close packing, cubic, or cells that tile the box around it", &o.lattice},
  {"neighbours", 0,   OPT_REAL,   NULL,    "1",         "in the kernel's support, itself included (57; 2D: 19; 1D: 6)", &o.neighbours},
  {"rotate",     0,   OPT_INT,    NULL,    "SEED",      "turn the lattice at random by this seed", &o.rotate},
  {"spin",       0,   OPT_REAL,   NULL,    "s",         "period of rotation about z; negative: clockwise", &o.spin},
  {"energy",     'u', OPT_REAL,   "0",     "J/kg",      "specific internal energy; without rho= the pressure is zero", &o.energy},
  {"dimension",  'd', OPT_INT,    "3",     "1|2|3",     "line, plane or space", &o.dimension},
  {"output",     'o', OPT_TEXT,   "-",     "FILE",      "where the body goes", &o.out},
  {NULL, 0, OPT_FLAG, NULL, NULL, NULL, NULL}};

static const OptProgram PROGRAM = {
  "mkshape", "fill a shape with particles", "[options] > body.h5",
  "Sizes: ellipsoid semi-axes; box width, depth, height; cylinder radius, height; hemisphere radius; rod length, radius; ring "
  "radii, height; tank inner width, depth, height, wall. Flat tops lie at 0.",
  "mkshape --shape ellipsoid --size 10km,8km,6km -l basalt --rubble 0.8km:3km > pile.h5\n"
  "mkshape --shape hemisphere --size 2km -l ice:200m -l basalt::pores=0.3 > target.h5", OPTS, 0, 0};
/* clang-format on */

typedef struct {
  char name[64], *text;
  double rho, distention; /* bulk density kg/m^3, solid over bulk */
  int mat;
} Layer;

/* Sites that lie in the shape, or in a boulder. */
typedef struct {
  const Shape *shape;
  double spacing, turn[3][3], centre[3], radius; /* radius 0: the whole shape */
  double *x;                                     /* [room][3] m */
  int *part, *body;
  long n, room, number;
  int failed;
} Fill;

static double length(const char *text)
{
  Err err;
  double x;
  if (unit_parse(text, "m", &x, &err)) err_usage("--size: %s", err.text);
  return x;
}

static void read_sizes(Shape *s)
{
  int want = shape_sizes(s->kind, s->dimension), n = 0;
  char *copy = strdup(o.size ? o.size : ""), *rest = NULL;
  Err err;
  if (!copy) err_die("out of memory");
  if (s->kind == SHAPE_MESH && o.size) err_usage("a mesh has its size from --scale, not --size");
  if (s->kind != SHAPE_MESH && !want) err_usage("no %s in %ldD", o.shape, o.dimension);
  for (char *t = strtok_r(copy, ",", &rest); t; t = strtok_r(NULL, ",", &rest), n++)
    if (n < want) s->size[n] = length(t);
  free(copy);
  if (n != want) err_usage("--shape %s needs --size with %d lengths, not %d", o.shape, want, n);
  s->parts = s->kind == SHAPE_TANK ? 2 : o.layers.n;
  if (s->parts > 1 && !shape_layered(s->kind) && s->kind != SHAPE_TANK)
    err_usage("--shape %s is of one layer", o.shape);
  if (s->kind == SHAPE_TANK && o.layers.n != 2)
    err_usage("a tank has two layers: its content, then its walls");
  if (s->kind != SHAPE_MESH && shape_check(s, &err)) err_usage("%s", err.text);
}

/* "basalt:200m:pores=0.3" */
static void read_layer(Layer *l, Shape *s, int k)
{
  char *copy = strdup(o.layers.text[k]), *rest, *word;
  int last = k == o.layers.n - 1, thick = 0;
  double pores = 0, rho = 0, above = k ? s->end[k - 1] : 0;
  Material m;
  Err err;
  if (!copy) err_die("out of memory");
  word = strtok_r(copy, ":", &rest);
  if (!word) err_usage("a layer needs a material");
  if (!(l->text = material_find(word, l->name, &err))) err_die("%s", err.text);
  if (material_parse(&m, l->text, l->name, &err)) err_die("%s", err.text);
  pores = 1 - 1 / material_distention(&m);
  while ((word = strtok_r(NULL, ":", &rest))) {
    int dense = !strncmp(word, "rho=", 4), open = !strncmp(word, "pores=", 6);
    int bad = dense  ? unit_parse(word + 4, "kg/m^3", &rho, &err)
              : open ? unit_parse(word + 6, "1", &pores, &err)
                     : unit_parse(word, "m", &s->end[k], &err);
    if (bad) err_usage("layer '%s': %s", o.layers.text[k], err.text);
    if (dense && !(rho > 0)) err_usage("layer '%s': density is not positive", o.layers.text[k]);
    if (!dense && !open) thick = 1, s->end[k] += above;
  }
  if (rho > 0)
    l->rho = rho;
  else if (structure_density(&m.eos, o.energy, &l->rho, &err))
    err_die("layer '%s': %s", l->name, err.text);
  material_clear(&m);
  if (!(pores >= 0 && pores < 1)) err_usage("layer '%s': pores are 0 to 1", o.layers.text[k]);
  if (thick && (last || !shape_layered(s->kind)))
    err_usage("layer '%s': no thickness, it takes what is left", o.layers.text[k]);
  if (!thick && !last && shape_layered(s->kind))
    err_usage("layer '%s' needs a thickness", o.layers.text[k]);
  l->distention = 1 / (1 - pores);
  if (rho == 0) l->rho /= l->distention;
  free(copy);
}

static void check_options(void)
{
  int mesh = !strcmp(o.shape, "mesh");
  if (o.dimension < 1 || o.dimension > 3) err_usage("dimension %ld is not 1, 2 or 3", o.dimension);
  if (opt_given(&PROGRAM, "spacing") && opt_given(&PROGRAM, "number"))
    err_usage("either --number or --spacing");
  if (opt_given(&PROGRAM, "spacing") && !(o.spacing > 0))
    err_usage("spacing %g m is not positive", o.spacing);
  if (o.rubble && (!isnan(o.spacing) || !strcmp(o.lattice, "grid")))
    err_usage("boulders take --number and a lattice of their own, hcp or cubic");
  if (!strcmp(o.lattice, "grid") && o.rotate >= 0) err_usage("a grid is not turned");
  if (o.n < 1 || o.n > 2000000000) err_usage("number of particles %ld is not in 1..2e9", o.n);
  if (!isnan(o.neighbours) && o.neighbours <= 1) err_usage("--neighbours must be greater than 1");
  if (o.neighbours > (double)o.n) err_usage("--neighbours %g of %ld particles", o.neighbours, o.n);
  if (o.energy < 0) err_usage("energy %g J/kg is negative", o.energy);
  if (o.spin == 0) err_usage("a spin period of 0 s is infinitely fast");
  if (opt_given(&PROGRAM, "rotate") && o.rotate < 0) err_usage("seed %ld is negative", o.rotate);
  if (o.seed < 0) err_usage("seed %ld is negative", o.seed);
  if (mesh != !!o.mesh)
    err_usage(mesh ? "--shape mesh needs --mesh FILE" : "--mesh needs --shape mesh");
  if (!(o.scale > 0)) err_usage("scale %g m is not positive", o.scale);
  if (mesh && o.dimension < 3) err_usage("no mesh in %ldD", o.dimension);
  if (!(o.fill > 0 && o.fill < 0.74)) err_usage("--fill %g is not between 0 and 0.74", o.fill);
  if (o.rubble && o.dimension < 3) err_usage("rubble needs 3 dimensions");
  if (o.rubble && o.layers.n > 1) err_usage("rubble is of one material");
  if (!o.layers.n) err_usage("which material? give --layer MATERIAL");
  if (o.layers.n > SHAPE_PARTS) err_usage("more than %d layers", SHAPE_PARTS);
}

/* The lattice as far as its volume a site goes. */
static Lattice lattice_of(void) { return strcmp(o.lattice, "hcp") ? LATTICE_CUBIC : LATTICE_HCP; }

static void set_turn(double m[3][3], long seed)
{
  double angle = 2 * PI * rng_uniform((uint64_t)seed, 0, 0), c = cos(angle), s = sin(angle);
  double flat[3][3] = {{c, -s, 0}, {s, c, 0}, {0, 0, 1}};
  double none[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  if (seed >= 0 && o.dimension == 3)
    rng_rotation((uint64_t)seed, m);
  else
    memcpy(m, seed < 0 ? none : flat, sizeof none);
}

static void take(void *to, const double at[3])
{
  Fill *f = to;
  double x[3];
  int part = 0;
  for (int a = 0; a < 3; a++)
    x[a] = f->centre[a] +
           f->spacing * (f->turn[a][0] * at[0] + f->turn[a][1] * at[1] + f->turn[a][2] * at[2]);
  if (f->radius == 0 && (part = shape_part(f->shape, x)) < 0) return;
  if (f->n == f->room) {
    f->room = f->room ? 2 * f->room : 4096;
    f->x = realloc(f->x, (size_t)f->room * 3 * sizeof *f->x);
    f->part = realloc(f->part, (size_t)f->room * sizeof *f->part);
    f->body = realloc(f->body, (size_t)f->room * sizeof *f->body);
    if (!f->x || !f->part || !f->body) err_die("no memory for %ld particles", f->room);
  }
  memcpy(f->x + 3 * f->n, x, sizeof x);
  f->part[f->n] = part, f->body[f->n++] = (int)f->number;
}

/* Cells of about the spacing, whole ones along each edge of the box around the shape; a tank's
 * walls go on with them. */
static void fill_grid(Fill *f)
{
  double low[3], high[3], cell[3] = {0}, at[3];
  long from[3] = {0}, to[3] = {1, 1, 1};
  shape_box(f->shape, low, high);
  for (int d = 0; d < f->shape->dimension; d++) {
    double edge = high[d] - low[d], most = fmax(1, round(edge / f->spacing)), wall = 0;
    cell[d] = edge / most;
    if (f->shape->kind == SHAPE_TANK) wall = ceil(f->shape->size[f->shape->dimension] / cell[d]);
    from[d] = -(long)wall, to[d] = (long)(most + wall);
  }
  for (long k = from[2]; k < to[2]; k++)
    for (long j = from[1]; j < to[1]; j++)
      for (long i = from[0]; i < to[0]; i++) {
        const double n[3] = {(double)i + 0.5, (double)j + 0.5, (double)k + 0.5};
        for (int d = 0; d < 3; d++) at[d] = (low[d] + n[d] * cell[d]) / f->spacing;
        take(f, at);
      }
}

static PackOptions read_rubble(void)
{
  PackOptions p = {.slope = 2.5, .fill = o.fill, .most = BOULDERS, .seed = (uint64_t)o.seed};
  char *copy = strdup(o.rubble), *rest, *low, *high, *slope;
  Err err;
  if (!copy) err_die("out of memory");
  low = strtok_r(copy, ":", &rest), high = strtok_r(NULL, ":", &rest);
  slope = strtok_r(NULL, ":", &rest);
  if (!low || !high || strtok_r(NULL, ":", &rest))
    err_usage("--rubble '%s' is not MIN:MAX[:SLOPE]", o.rubble);
  if (unit_parse(low, "m", &p.low, &err) || unit_parse(high, "m", &p.high, &err) ||
      (slope && unit_parse(slope, "1", &p.slope, &err)))
    err_usage("--rubble: %s", err.text);
  if (!(p.low > 0 && p.high >= p.low)) err_usage("--rubble: not 0 < MIN <= MAX");
  if (!(p.slope >= 0)) err_usage("--rubble: the slope, %g, is negative", p.slope);
  free(copy);
  return p;
}

/* Boulders, each with its own lattice, turned at random; *volume is theirs. Returns how many. */
static long fill_rubble(Fill *f, Lattice lattice, double **r, double *volume)
{
  PackOptions p = read_rubble();
  double *x;
  Err err;
  long n = pack_spheres(f->shape, &p, &x, r, &err);
  if (n < 0) err_die("%s", err.text);
  if (n == BOULDERS)
    err_die("more than %d boulders, which are as many as programs tell apart: give larger ones",
            BOULDERS - 1);
  for (long k = 0; k < n; k++) *volume += 4 * PI / 3 * pow((*r)[k], 3);
  f->spacing = cbrt(*volume / (double)o.n / lattice_volume(lattice, 3));
  for (long k = 0; k < n; k++) {
    memcpy(f->centre, x + 3 * k, sizeof f->centre);
    f->radius = (*r)[k], f->number = k;
    set_turn(f->turn, o.rotate < 0 ? -1 : o.rotate * BOULDERS + k);
    lattice_sites(lattice, 3, f->radius / f->spacing, take, f);
  }
  free(x);
  return n;
}

/* Particles, the parts (or boulders) with their exact masses. */
static Parts *particles(const Fill *f, const Shape *s, Layer *layer, const double *r, long boulders)
{
  long parts = boulders ? boulders : s->parts;
  long *number = calloc((size_t)parts, sizeof *number);
  Parts *p = part_new(f->n);
  Err err;
  if (!number || !p || part_add(p, "id x v m rho u h mat body", &err))
    err_die("no memory for %ld particles", f->n);
  p->dimension = (int)o.dimension;
  for (int k = 0; k < o.layers.n; k++)
    if ((layer[k].mat = part_add_material(p, layer[k].name, layer[k].text, &err)) < 0)
      err_die("%s", err.text);
  for (long i = 0; i < f->n; i++) number[boulders ? f->body[i] : f->part[i]]++;
  for (long k = 0; k < parts; k++)
    if (!number[k])
      err_die("%s %ld holds no particle: more are needed (-n)", boulders ? "boulder" : "layer",
              k + 1);
  for (long i = 0; i < f->n; i++) {
    const Layer *l = &layer[f->part[i]];
    long k = boulders ? f->body[i] : f->part[i];
    double volume = boulders ? 4 * PI / 3 * pow(r[k], 3) : shape_volume(s, (int)k);
    memcpy(p->x + 3 * i, f->x + 3 * i, 3 * sizeof *p->x);
    p->id[i] = i, p->mat[i] = l->mat, p->body[i] = boulders ? f->body[i] : 0;
    p->m[i] = l->rho * volume / (double)number[k], p->rho[i] = l->rho, p->u[i] = o.energy;
    p->h[i] = recipe_radius(p->dimension, o.neighbours * pow(f->spacing, p->dimension) *
                                              lattice_volume(lattice_of(), p->dimension));
  }
  free(number);
  return p;
}

/* The field Distention, where anything has pores. */
static void add_pores(Parts *p, const Fill *f, const Layer *layer)
{
  double *d, most = 1;
  Err err;
  for (int k = 0; k < o.layers.n; k++) most = fmax(most, layer[k].distention);
  if (most == 1) return;
  if (!(d = part_add_extra(p, "Distention", "1", "solid over bulk density", &err)))
    err_die("%s", err.text);
  for (long i = 0; i < p->n; i++) d[i] = layer[f->part[i]].distention;
}

static void spin(Parts *p)
{
  double omega = 2 * PI / o.spin;
  for (long i = 0; i < p->n; i++)
    p->v[3 * i] = -omega * p->x[3 * i + 1], p->v[3 * i + 1] = omega * p->x[3 * i];
}

int main(int argc, char **argv)
{
  static const char *const MASS[] = {"", "kg/m^2", "kg/m", "kg"}, *const VOLUME[] = {"", "m", "m^2",
                                                                                     "m^3"};
  static Layer layer[SHAPE_PARTS];
  Shape s = {0};
  Fill f = {.shape = &s};
  Mesh mesh;
  Parts *p;
  Err err;
  Lattice lattice;
  double volume = 0, mass = 0, *r = NULL, reach;
  long boulders = 0;
  char *line = opt_command_line(argc, argv), step[64];
  int n;
  opt_parse(&PROGRAM, argc, argv, &n);
  check_options();
  s.kind = (ShapeKind)unit_choice(o.shape, SHAPE_WORDS, &err), s.dimension = (int)o.dimension;
  for (int k = 0; k < o.layers.n; k++) read_layer(&layer[k], &s, k);
  read_sizes(&s);
  if (o.mesh && mesh_read(&mesh, o.mesh, o.scale, &err)) err_die("%s", err.text);
  if (o.mesh) s.mesh = &mesh;
  if (isnan(o.neighbours)) o.neighbours = o.dimension == 3 ? 57 : o.dimension == 2 ? 19 : 6;
  lattice = lattice_of();
  if (o.rubble) {
    boulders = fill_rubble(&f, lattice, &r, &volume);
  } else {
    for (int k = 0; k < s.parts; k++) volume += shape_volume(&s, k);
    f.spacing = pow(volume / (double)o.n / lattice_volume(lattice, s.dimension), 1. / s.dimension);
    if (!isnan(o.spacing)) f.spacing = o.spacing;
    set_turn(f.turn, o.rotate);
    if (strcmp(o.lattice, "grid")) {
      reach = shape_ball(&s, f.centre);
      lattice_sites(lattice, s.dimension, reach / f.spacing + 1, take, &f);
    } else {
      fill_grid(&f);
    }
  }
  if (!f.n) err_die("the shape holds no particle: more are needed (-n)");
  p = particles(&f, &s, layer, r, boulders);
  add_pores(p, &f, layer);
  if (!isnan(o.spin)) spin(p);
  for (long i = 0; i < p->n; i++) mass += p->m[i];
  if (part_set_number(p, "body", "Radius0", recipe_radius(p->dimension, volume), &err) ||
      part_set_number(p, "body", "Spacing0", f.spacing, &err) || part_history(p, line, &err) ||
      snap_write(p, o.out, 0, &err))
    err_die("%s", err.text);
  fprintf(stderr, "mkshape: %ld particles, mass %.6g %s, volume %.6g %s, spacing %s\n", p->n, mass,
          MASS[s.dimension], volume, VOLUME[s.dimension],
          unit_length_text(f.spacing, step, sizeof step));
  if (boulders)
    fprintf(stderr, "mkshape: %ld boulders, %.3f of the shape\n", boulders,
            volume / (o.mesh ? mesh.volume : shape_volume(&s, 0)));
  for (int k = 0; k < o.layers.n; k++) free(layer[k].text);
  if (o.mesh) mesh_free(&mesh);
  free(f.x), free(f.part), free(f.body), free(r), part_free(p), free(line), free(o.layers.text);
  return 0;
}
