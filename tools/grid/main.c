/* SPDX-License-Identifier: GPL-3.0-or-later */
/* grid: fields of a snapshot on a regular grid. */
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "fill.h"
#include "lib/expr.h"
#include "lib/opt.h"
#include "lib/pick.h"
#include "lib/sort.h"
#include "lib/unit.h"

enum { FIELDS_MOST = 32 };

static struct {
  OptList field;
  const char *what, *method, *cells, *box, *centre, *plane, *select, *format, *out;
} arg;

static const Opt opts[] = {
    {"field", 'f', OPT_LIST, NULL, "[NAME=]WHAT", "field or expression [Density]", &arg.field},
    {"what", 'w', OPT_CHOICE, "volume", "volume|slice|column",
     "all cells, a plane through the centre, or summed along the line of sight", &arg.what},
    {"method", 'm', OPT_CHOICE, "interpolate", FILL_METHODS,
     "normalised, nan outside; plain SPH sum; masses kept", &arg.method},
    {"cells", 'n', OPT_TEXT, "128", "N or NxNxN", "along the longest edge (cubes), or each",
     &arg.cells},
    {"box", 'B', OPT_TEXT, NULL, "L or LX,LY,LZ", "edges (default: cube with 99 % of the mass)",
     &arg.box},
    {"centre", 'C', OPT_TEXT, "com", "POINT", "com, body:K, fragment:K, clump:K, or X,Y,Z",
     &arg.centre},
    {"plane", 'p', OPT_CHOICE, "xy", "xy|xz|yz", "of slices and columns", &arg.plane},
    {"select", 'S', OPT_TEXT, NULL, "WHAT", "only particles for which this holds", &arg.select},
    {"format", 'F', OPT_CHOICE, NULL, RASTER_FORMATS, "default: by the end of the name",
     &arg.format},
    {"output", 'o', OPT_TEXT, "-", "FILE", "FILE.h5, .vtk or .vti", &arg.out},
    {0}};

static const OptProgram program = {
    .name = "grid",
    .does = "put the fields of a snapshot on a regular grid",
    .usage = "[options] snapshot.h5 -o grid.vti",
    .about = "WHAT is a field (of a vector the length, or one component after a dot) or an "
             "expression of fields, which is given a NAME. Values are those at the centres of "
             "cells; with mass and column the mass itself is there too, as MassDensity or "
             "ColumnDensity. Of snapshots in two dimensions the plane.",
    .example =
        "grid -f Density -f 'mach=|Velocities|/SoundSpeed' -n 256 -o cube.vti run/snap_0010.h5\n"
        "grid -w slice -f Damage -p xz -n 512 -o slice.h5 run/snap_0010.h5",
    .opts = opts,
    .min_inputs = 0,
    .max_inputs = 1};

static char *name[FIELDS_MOST];
static const char *text[FIELDS_MOST];
static int fields;

/* What every reader takes for a name. */
static int is_name(const char *s, size_t n)
{
  for (size_t k = 0; k < n; k++)
    if (!isalnum((unsigned char)s[k]) && s[k] != '_' && s[k] != '.') return 0;
  return n > 0 && n < 100 && !isdigit((unsigned char)s[0]) && s[0] != '.';
}

static void read_field(const char *word)
{
  const char *equals = strchr(word, '=');
  size_t n = equals ? (size_t)(equals - word) : strlen(word);
  int named = equals && equals[1] != '=' && is_name(word, n);
  Err err;
  if (fields == FIELDS_MOST) err_usage("--field: more than %d", FIELDS_MOST);
  if (!named && !is_name(word, strlen(word)))
    err_usage("--field: '%s' needs a name (NAME=%s)", word, word);
  char *copy = malloc(n + 1);
  if (!copy) err_die("out of memory");
  snprintf(copy, n + 1, "%s", word);
  name[fields] = copy, text[fields] = named ? equals + 1 : word;
  for (int k = 0; k < fields; k++)
    if (!strcmp(name[k], copy)) err_usage("--field: '%s' twice", copy);
  Expr *e = expr_parse(text[fields++], &err);
  if (!e) err_usage("--field: %s", err.text);
  expr_free(e);
}

static void check_arguments(void)
{
  static const char *const ends[] = {".h5", ".hdf5", ".vtk", ".vti"}, *const formats[] = {
                                                                          "hdf5", "hdf5", "vtk",
                                                                          "vti"};
  Err err;
  size_t n = strlen(arg.out);
  if (arg.field.n == 0) read_field("Density");
  for (int k = 0; k < arg.field.n; k++) read_field(arg.field.text[k]);
  Expr *e = arg.select ? expr_parse(arg.select, &err) : NULL;
  if (arg.select && !e) err_usage("--select: %s", err.text);
  expr_free(e);
  for (int k = 0; k < 4 && !arg.format; k++)
    if (n > strlen(ends[k]) && !strcmp(arg.out + n - strlen(ends[k]), ends[k]))
      arg.format = formats[k];
  if (!arg.format)
    err_usage("--output: '%s' ends in none of .h5 .vtk .vti (see --format)", arg.out);
  if (!strcmp(arg.what, "column") && opt_given(&program, "method"))
    err_usage("--method: columns always keep masses");
  if (!strcmp(arg.what, "slice") && !strcmp(arg.method, "mass"))
    err_usage("--method: a slice has no volume that would hold a mass");
  if (!strcmp(arg.what, "volume") && opt_given(&program, "plane"))
    err_usage("--plane is for slices and columns");
}

/* Edge of the cube about the centre that has 99 % of the mass, and some. */
static double cube(const Parts *p, const double centre[3])
{
  double *reach = malloc((size_t)(p->n + 1) * sizeof *reach), all = 0, sum = 0, edge = 0;
  long *order = malloc((size_t)(p->n + 1) * sizeof *order);
  if (!reach || !order) err_die("out of memory for %ld particles", p->n);
  for (long i = 0; i < p->n; i++) {
    double most = 0;
    for (int a = 0; a < 3; a++) most = fmax(most, fabs(p->x[3 * i + a] - centre[a]));
    reach[i] = most + p->h[i], all += p->m[i];
  }
  if (sort_reals(p->n, reach, order)) err_die("out of memory for %ld particles", p->n);
  for (long k = 0; k < p->n && sum < 0.99 * all; k++)
    edge = 2 * reach[order[k]], sum += p->m[order[k]];
  free(reach), free(order);
  return edge;
}

/* N: cubes, so many along the longest of the axes; NxN, NxNxN: along each of them. */
static void count_cells(Raster *r, const double box[3], const int *axis, int axes)
{
  int n[3] = {0};
  char more;
  double longest = 0;
  int given = sscanf(arg.cells, "%dx%dx%d%c", &n[0], &n[1], &n[2], &more);
  int crosses = 0;
  for (const char *s = arg.cells; *s; s++) crosses += *s == 'x';
  if (given != crosses + 1 || (given != 1 && given != axes))
    err_usage("--cells: '%s' is neither N nor %s", arg.cells, axes == 2 ? "NxN" : "NxNxN");
  for (int k = 0; k < given; k++)
    if (n[k] < 1 || n[k] > 16384) err_usage("--cells: from 1 to 16384, not %d", n[k]);
  for (int k = 0; k < axes; k++) longest = fmax(longest, box[axis[k]]);
  for (int k = 0; k < 3; k++) {
    int a = axis[k];
    r->n[a] = k >= axes ? 1 : given > 1 ? n[k] : (int)fmax(1, ceil(n[0] * box[a] / longest - 1e-9));
    r->cell[a] = k >= axes ? longest / n[0] : given > 1 ? box[a] / n[k] : longest / n[0];
  }
}

/* Where the cells lie: about the centre; cubes may reach a little over the box. */
static void place(Raster *r, const Parts *p, FillHow *how, const char *file)
{
  Err err;
  double centre[3], box[3];
  int first = strcmp(arg.plane, "yz") ? 0 : 1, second = strcmp(arg.plane, "xy") ? 2 : 1;
  how->method = arg.method, how->column = !strcmp(arg.what, "column");
  how->flat = strcmp(arg.what, "volume") || p->dimension < 3;
  how->axis[0] = how->flat ? first : 0, how->axis[1] = how->flat ? second : 1;
  how->axis[2] = 3 - how->axis[0] - how->axis[1];
  if (p->dimension < 3 && how->axis[2] != 2)
    err_usage("--plane: '%s' has two dimensions, xy", file);
  if (p->dimension < 3 && how->column) err_usage("--what: '%s' has two dimensions", file);
  if (pick_centre(centre, p, arg.centre, file, &err)) err_die("%s", err.text);
  if (!arg.box)
    box[0] = box[1] = box[2] = cube(p, centre);
  else if (unit_list(arg.box, "m", strchr(arg.box, ',') ? 3 : 1, box, &err))
    err_usage("--box: %s", err.text);
  if (arg.box && !strchr(arg.box, ',')) box[1] = box[2] = box[0];
  for (int a = 0; a < 3; a++)
    if (!(box[a] > 0)) err_usage("--box: edges must be positive");
  count_cells(r, box, how->axis, how->flat ? 2 : 3);
  for (int a = 0; a < 3; a++) r->lo[a] = centre[a] - 0.5 * r->n[a] * r->cell[a];
  r->time = p->time;
}

int main(int argc, char **argv)
{
  Err err;
  int inputs;
  char **input = opt_parse(&program, argc, argv, &inputs), *line = opt_command_line(argc, argv);
  const char *file = inputs ? input[0] : "-";
  FillHow how;
  check_arguments();
  Parts *p =
      pick_read(file, text, fields, arg.select, strchr(arg.centre, ':') ? "frag clump" : "", &err);
  if (!p) err_die("%s", err.text);
  Raster r = {.about = line ? line : program.name};
  place(&r, p, &how, file);
  if (fill_raster(&r, p, &how, text, (const char *const *)name, fields, file, &err) ||
      raster_write(&r, arg.out, arg.format, &err))
    err_die("%s", err.text);
  for (int k = 0; k < r.fields; k++) free(r.field[k].value);
  for (int k = 0; k < fields; k++) free(name[k]);
  free(r.field), free(line), part_free(p);
  return 0;
}
