/* SPDX-License-Identifier: GPL-3.0-or-later */
/* disk: where a body ends, and what around it will fall back, stay or leave. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "lib/choose.h"
#include "lib/disk.h"
#include "lib/fof.h"
#include "lib/group.h"
#include "lib/material.h"
#include "lib/opt.h"
#include "lib/pointmass.h"
#include "lib/snap.h"
#include "lib/unit.h"
#include "bins.h"

static struct {
  const char *method, *of, *profile, *out;
  OptList density;
  double link, theta;
  long least, bins;
  int enclosed, bare;
} arg;

static const Opt opts[] = {
    {"method", 'm', OPT_CHOICE, "reufer", "reufer|canup",
     "the body is a sphere through its surface, or a planet with an equator", &arg.method},
    {"of", 'O', OPT_TEXT, NULL, "GROUP",
     "whose body: clump:K, fragment:K, body:K, all (clump:1 where there are clumps, else all)",
     &arg.of},
    {"min-density", 'd', OPT_LIST, NULL, "DENSITY",
     "lighter is surface or vapour: 2000, 2g/cc, of one material ice:500 (0.75rho0 of each)",
     &arg.density},
    {"enclosed", 'e', OPT_FLAG, NULL, NULL, "orbits feel all mass nearer to the centre",
     &arg.enclosed},
    {"no-points", 0, OPT_FLAG, NULL, NULL, "as if the snapshot had no point masses", &arg.bare},
    {"satellites", 'n', OPT_INT, "20", "N", "smallest satellite, in particles", &arg.least},
    {"link", 'l', OPT_REAL, "1", "1", "satellites: friends when r_ij < link (h_i + h_j)/2",
     &arg.link},
    {"profile", 'p', OPT_TEXT, NULL, "FILE", "write the disk in radial bins", &arg.profile},
    {"bins", 'b', OPT_INT, "50", "N", "number of bins", &arg.bins},
    {"theta", 't', OPT_REAL, "0.7", "1", "opening angle of the gravity tree", &arg.theta},
    {"output", 'o', OPT_TEXT, NULL, "FILE", "write the snapshot with DiskClass", &arg.out},
    {0}};

static const OptProgram program = {
    .name = "disk",
    .does = "find the disk around a body",
    .usage = "[options] snapshot.h5 > disk.tsv",
    .about =
        "One row a class, then one a satellite. Each particle goes by its orbit about the body: "
        "body, disk (bound, pericentre outside), re-impact, fly-by (unbound, will pass), escape. "
        "reufer: a sphere at the mean distance of the surface, the light particles met before "
        "they are 1 % when those of the group are taken from its deepest potential on. canup: "
        "what is nearer than the equator or circularises there is body; the equator follows from "
        "mass, mean density and spin. Satellites are fragments of the disk above --min-density. "
        "Point masses count as particles do; of a group if clumps says so. "
        "Columns are relative to the body; L_body is about its centre. a_eq = h^2/(G M) is the "
        "radius of the circle with a particle's angular momentum.",
    .example = "disk --method canup --profile bins.tsv with_ids.h5",
    .opts = opts,
    .min_inputs = 0,
    .max_inputs = 1};

typedef struct {
  double mass, l[3], beyond, outside; /* kg, kg m^2/s; kg with a_eq beyond the equator, Roche */
  double roche, rho; /* m, kg/m^3 of a satellite: what the disk is made of, at rest */
} Totals;

/* The particles that hold the body, by ascending id. */
static long *object(const Parts *p, const char *file, long *n, Err *err)
{
  const int32_t *id = NULL;
  int32_t which = 0;
  if (!arg.of) arg.of = p->clump ? "clump:1" : "all";
  if (strcmp(arg.of, "all") && group_named(p, arg.of, file, &id, &which, err)) return NULL;
  long *list = malloc((size_t)p->n * sizeof *list);
  if (!list) return err_null(err, "out of memory for %ld particles", p->n);
  if (group_order(p, list, err)) return free(list), NULL;
  *n = 0;
  for (long k = 0; k < p->n; k++)
    if (!id || (id[list[k]] == which && (id == p->clump || !pointmass_row(p, list[k]))))
      list[(*n)++] = list[k];
  return list;
}

/* Density of the disk's materials at rest, by volume; NAN without any that has one. */
static double rest_density(const Parts *p, Err *err)
{
  Material *material = material_load(p, err);
  if (!material) return -1;
  double mass = 0, volume = 0;
  for (long i = 0; i < p->n; i++) {
    const double rho0 =
        p->disk[i] == DISK_DISK && !pointmass_row(p, i) ? eos_rho0(&material[p->mat[i]].eos) : 0;
    if (rho0 > 0) mass += p->m[i], volume += p->m[i] / rho0;
  }
  material_free(material, p->materials);
  return volume > 0 ? mass / volume : NAN;
}

static int totals(Totals *t, const Parts *p, const DiskBody *b, const double *within, Err *err)
{
  *t = (Totals){.rho = rest_density(p, err)};
  if (t->rho < 0) return -1;
  t->roche = group_roche(b->mass, t->rho);
  for (long i = 0; i < p->n; i++) {
    double r[3], v[3];
    if (p->disk[i] == DISK_BODY || p->disk[i] >= DISK_FLYBY) continue;
    const Orbit o = disk_orbit(p, i, b, within);
    if (o.p > b->equator) t->beyond += p->m[i];
    if (o.p > t->roche) t->outside += p->m[i];
    if (p->disk[i] != DISK_DISK) continue;
    for (int a = 0; a < 3; a++) r[a] = p->x[3 * i + a] - b->x[a], v[a] = p->v[3 * i + a] - b->v[a];
    for (int a = 0; a < 3; a++) {
      const int c = (a + 1) % 3, d = (a + 2) % 3;
      t->l[a] += p->m[i] * (r[c] * v[d] - r[d] * v[c]);
    }
    t->mass += p->m[i];
  }
  return 0;
}

static void print_head(const Parts *p, const char *file, const DiskBody *b, const Totals *t)
{
  char time[64];
  const double *w = b->omega, l = sqrt(t->l[0] * t->l[0] + t->l[1] * t->l[1] + t->l[2] * t->l[2]);
  printf("# %s at %s: the body of %s by %s\n", file, unit_time_text(p->time, time, sizeof time),
         arg.of, arg.method);
  printf("# body: mass %.9g kg, radius %.9g m, equator %.9g m, flattening %.6g, density %.9g "
         "kg/m^3, period %.9g s\n",
         b->mass, b->radius, b->equator, b->flattening, b->rho,
         2 * acos(-1) / sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]));
  printf("# disk: mass %.9g kg, angular momentum %.9g kg m^2/s", t->mass, l);
  if (t->mass > 0) {
    printf(", per mass %.6g of the circle at the Roche limit",
           l / t->mass / sqrt(UNIT_G * b->mass * t->roche));
    printf("\n# Roche limit %.9g m for %.9g kg/m^3", t->roche, t->rho);
  }
  printf("\n# disk and re-impact with a_eq beyond the equator %.9g kg, beyond the Roche limit %.9g "
         "kg\n",
         t->beyond, t->outside);
}

static void print_row(const char *name, const Group *g, const Parts *p, const DiskBody *b,
                      const Group *frame, int orbit)
{
  GroupCentre c = {.mass = orbit ? b->mass : 0};
  double l[3];
  memcpy(c.x, b->x, sizeof c.x), memcpy(c.v, b->v, sizeof c.v);
  memcpy(c.axis, b->omega, sizeof c.axis);
  for (int a = 0; a < 3; a++) {
    const int d = (a + 1) % 3, e = (a + 2) % 3;
    l[a] = g->l[a] + g->mass * ((g->x[d] - b->x[d]) * (g->v[e] - b->v[e]) -
                                (g->x[e] - b->x[e]) * (g->v[d] - b->v[d]));
  }
  printf("%s\t%ld\t%.9g\t%.9g\t%.9g\t%.9g", name, g->n - g->points, g->mass, l[0], l[1], l[2]);
  group_orbit_row(stdout, g, &c), group_row(stdout, g, frame, p);
  printf("\n");
}

/* Fragments of the disk, in p->frag (which must be there). */
static long satellites(Parts *p, const double *floor, int32_t *id, Err *err)
{
  unsigned char *keep = malloc((size_t)p->n);
  if (!keep) return err_set(err, "out of memory for %ld particles", p->n);
  for (long i = 0; i < p->n; i++)
    keep[i] = p->disk[i] == DISK_DISK && p->rho[i] >= floor[p->mat[i]];
  long n = fof_find(p, arg.link, keep, arg.least, id, err);
  free(keep);
  return n;
}

/* The table; 0, or -1. */
static int print(Parts *p, const DiskBody *b, const double *floor, Err *err)
{
  char name[64];
  const int bodies = group_bodies(p, err), classes = DISK_CLASSES - 1;
  int32_t *id = bodies > 0 ? malloc((size_t)p->n * sizeof *id) : NULL;
  if (!id) return bodies < 0 ? -1 : err_set(err, "out of memory for %ld particles", p->n);
  const long n = satellites(p, floor, id, err);
  Group *class = n < 0 ? NULL : group_all(p, p->disk, classes, bodies, arg.theta, NULL, err);
  Group *moon = class ? group_all(p, id, n, bodies, arg.theta, NULL, err) : NULL;
  if (!moon) return free(id), -1;
  Group frame = {.mass = b->mass};
  memcpy(frame.x, b->x, sizeof frame.x), memcpy(frame.v, b->v, sizeof frame.v);
  printf("# name\tn\tmass [kg]\tL_body_x [kg m^2/s]\tL_body_y [kg m^2/s]\tL_body_z [kg m^2/s]");
  group_orbit_header(stdout, "body"), group_header(stdout, p, bodies);
  printf("\n");
  for (int k = 1; k < DISK_CLASSES; k++) print_row(disk_names[k], &class[k - 1], p, b, &frame, 0);
  for (long k = 0; k < n; k++) {
    snprintf(name, sizeof name, "satellite_%ld", k + 1);
    print_row(name, &moon[k], p, b, &frame, 1);
  }
  group_all_free(class, classes), group_all_free(moon, n), free(id);
  return 0;
}

static void check_arguments(void)
{
  if (!(arg.link > 0)) err_usage("--link must be positive");
  if (arg.least < 1) err_usage("--satellites must be at least 1");
  if (arg.bins < 1 || arg.bins > 1000000) err_usage("--bins must lie in 1..1000000");
  if (!(arg.theta >= 0 && arg.theta <= 1)) err_usage("--theta must lie in 0..1");
  if (arg.out && !strcmp(arg.out, "-")) err_usage("--output: stdout holds the table: name a file");
  if (arg.profile && !strcmp(arg.profile, "-"))
    err_usage("--profile: stdout holds the table: name a file");
}

int main(int argc, char **argv)
{
  Err err;
  int inputs;
  char **input = opt_parse(&program, argc, argv, &inputs);
  const char *file = inputs ? input[0] : "-", *standard[] = {"0.75rho0"};
  check_arguments();
  const char *groups = GROUP_FIELDS GROUP_MORE " frag clump";
  Parts *p = snap_read_some(file, arg.out ? NULL : groups, &err);
  if (!p || part_need(p, GROUP_FIELDS, file, &err) || part_check(p, file, &err))
    err_die("%s", err.text);
  if (!arg.bare && pointmass_rows(p, &err)) err_die("'%s': %s", file, err.text);
  if (!arg.density.n) arg.density = (OptList){standard, 1};
  long n = 0, *list = object(p, file, &n, &err);
  if (!list) err_die("--of: %s", err.text);
  double *floor = choose_densities(p, &arg.density, &err), *within = NULL;
  const DiskOptions o = {!strcmp(arg.method, "canup"), arg.enclosed, floor, arg.theta};
  DiskBody b;
  Totals t;
  if (!floor || part_add(p, "disk", &err) || disk_find(p, list, n, &o, p->disk, &b, &err) ||
      (arg.enclosed && !(within = disk_enclosed(p, b.x, &err))) || totals(&t, p, &b, within, &err))
    err_die("'%s': %s", file, err.text);
  char *command = opt_command_line(argc, argv);
  if (arg.profile && bins_write(arg.profile, p, &b, t.l, arg.bins, &err)) err_die("%s", err.text);
  if (arg.out && part_history(p, command, &err)) err_die("%s", err.text);
  const Parts whole = pointmass_without(p);
  if (arg.out && snap_write(&whole, arg.out, 0, &err)) err_die("%s", err.text);
  print_head(p, file, &b, &t);
  if (print(p, &b, floor, &err)) err_die("'%s': %s", file, err.text);
  err_close_stdout();
  free(command), free(floor), free(within), free(list), part_free(p);
  return 0;
}
