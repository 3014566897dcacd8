/* SPDX-License-Identifier: GPL-3.0-or-later */
/* clumps: gravitationally bound bodies, how firmly they are bound, and which of them are bound to
 * each other. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "campaign.h"
#include "lib/clump.h"
#include "lib/group.h"
#include "lib/opt.h"
#include "lib/pointmass.h"
#include "lib/snap.h"
#include "lib/unit.h"

static struct {
  const char *method, *level, *campaign, *out;
  double link, theta, mass, virial;
  long least;
  int bare;
} arg = {.virial = INFINITY};

static const Opt opts[] = {
    {"method", 'm', OPT_CHOICE, "potential", "potential|grow",
     "fragments unbound in their own potential, or grown from a point mass", &arg.method},
    {"criterion", 'c', OPT_CHOICE, "kinetic", "kinetic|thermal|enthalpy",
     "bound when v^2/2 + phi, + u, + p/rho is negative", &arg.level},
    {"min-particles", 'n', OPT_INT, "20", "N", "smallest body", &arg.least},
    {"min-mass", 'M', OPT_REAL, "0", "kg", "and in mass", &arg.mass},
    {"max-virial", 'v', OPT_REAL, NULL, "1",
     "search nothing while -2 E_kin/E_pot of the system is above this (say 3)", &arg.virial},
    {"link", 'l', OPT_REAL, "1", "1", "potential: friends when r_ij < link (h_i + h_j)/2",
     &arg.link},
    {"theta", 't', OPT_REAL, "0.7", "1", "opening angle of the gravity tree", &arg.theta},
    {"no-points", 0, OPT_FLAG, NULL, NULL, "as if the snapshot had no point masses", &arg.bare},
    {"campaign", 'C', OPT_TEXT, NULL, "FILE",
     "write one row: remnants, accretion, stripping, v_inf, deflection", &arg.campaign},
    {"output", 'o', OPT_TEXT, NULL, "FILE", "write the snapshot with ClumpID", &arg.out},
    {0}};

static const OptProgram program = {
    .name = "clumps",
    .does = "find gravitationally bound bodies",
    .usage = "[options] snapshot.h5 > clumps.tsv",
    .about = "One row a body, by descending mass; r and v are relative "
             "to the barycentre of all particles. bound, bound_u, "
             "bound_h: its mass with v^2/2 + phi < 0, v^2/2 + phi + u < "
             "0, v^2/2 + phi + u + p/rho < 0 in its own potential. "
             "Bodies are not merged: parent is the heavier body that "
             "binds it most (two-body energy negative; 0: none), "
             "aggregate numbers the sets of bodies that are connected by "
             "such pairs. Each bound pair is listed above the table. "
             "k_vir = -2 E_kin/E_pot, 1 in equilibrium. Point masses are members: each holds a "
             "body, alone if need be (n counts particles). --campaign: body 0 is the target, "
             "body 1 the impactor; xi = (M_LR - M_target)/M_impactor, "
             "stripped_B is the part of body B that is not in the "
             "remnant that holds most of it.",
    .example = "clumps -o with_ids.h5 run/snap_0100.h5",
    .opts = opts,
    .min_inputs = 0,
    .max_inputs = 1};

typedef struct {
  Group g;
  double bound[CLUMP_LEVELS]; /* kg */
  long parent, aggregate; /* 0: none; lowest number of the aggregate's bodies until renumbered */
  GroupPair pair;         /* about the parent */
} Body;

static Body *measure(const Parts *p, long n, const double *phi, int bodies, Err *err)
{
  long *start, *list;
  Body *b = calloc((size_t)n + 1, sizeof *b);
  Group *g = group_all(p, p->clump, n, bodies, arg.theta, phi, err);
  if (!b || !g || group_lists(p, p->clump, n, &start, &list, err)) return NULL;
  for (long k = 0; k < n; k++) {
    b[k].g = g[k], b[k].aggregate = k;
    if (clump_levels(p, list + start[k + 1], start[k + 2] - start[k + 1], phi, b[k].bound, err))
      return NULL;
  }
  free(start), free(list), free(g);
  return b;
}

static GroupPair pair(const Body *a, const Body *b)
{
  return group_pair(a->g.x, a->g.v, a->g.mass, b->g.x, b->g.v, b->g.mass);
}

/* Parents, and aggregates as connected components of bound pairs; returns how many aggregates. */
static long connect(Body *b, long n)
{
  long aggregates = 0;
  for (long k = 0; k < n; k++) {
    for (long j = 0; j < k; j++) {
      GroupPair o = pair(&b[j], &b[k]);
      if (o.orbit.beta <= 0) continue;
      if (!b[k].parent || o.orbit.beta > b[k].pair.orbit.beta) b[k].parent = j + 1, b[k].pair = o;
      long from = b[k].aggregate, to = b[j].aggregate;
      if (from < to) from = b[j].aggregate, to = b[k].aggregate;
      for (long i = 0; i <= k; i++)
        if (b[i].aggregate == from) b[i].aggregate = to;
    }
  }
  long *name = calloc((size_t)n + 1, sizeof *name);
  if (!name) err_die("out of memory");
  for (long k = 0; k < n; k++) {
    long *a = &name[b[k].aggregate];
    b[k].aggregate = *a ? *a : (*a = ++aggregates);
  }
  free(name);
  return aggregates;
}

static double virial(const Group *s) { return -2 * s->e_kin / s->e_pot; }

static void print_pairs(const Body *b, long n)
{
  for (long k = 0; k < n; k++)
    for (long j = 0; j < k; j++) {
      GroupPair o = pair(&b[j], &b[k]);
      if (o.orbit.beta > 0)
        printf("# bound pair %ld %ld: %.9g m apart, v_rel %.9g m/s = %.6g v_esc, pericentre %.9g "
               "m, e %.6g\n",
               j + 1, k + 1, o.r, o.v, o.v / o.v_esc, o.orbit.rp, o.orbit.e);
    }
}

static double bound_mass(const Body *b, long n)
{
  double mass = 0;
  for (long k = 0; k < n; k++) mass += b[k].g.mass;
  return mass;
}

static void print(const Parts *p, const char *file, const Body *b, long n, long aggregates,
                  const Group *s)
{
  char time[64];
  printf("# %s at %s: %ld bound bodies in %ld aggregates\n", file,
         unit_time_text(p->time, time, sizeof time), n, aggregates);
  printf("# these hold %.9g kg of %.9g kg; k_vir of the system %.6g%s\n", bound_mass(b, n), s->mass,
         virial(s), virial(s) > arg.virial ? ", above --max-virial: not searched" : "");
  print_pairs(b, n);
  printf("# id\tn\tmass [kg]\tr [m]\tv [m/s]\tbound [kg]\tbound_u [kg]\tbound_h "
         "[kg]\taggregate\tparent\tdistance [m]"
         "\tv_rel [m/s]\tv_rel/v_esc [1]\tpericentre [m]");
  group_orbit_header(stdout, "system"), group_orbit_header(stdout, "1");
  group_header(stdout, p, s->bodies);
  printf("\n");
  for (long k = 0; k < n; k++) {
    const Group *g = &b[k].g;
    const GroupPair *o = &b[k].pair;
    printf("%ld\t%ld\t%.9g\t%.9g\t%.9g", k + 1, g->n - g->points, g->mass, group_apart(g->x, s->x),
           group_apart(g->v, s->v));
    for (int l = 0; l < CLUMP_LEVELS; l++) printf("\t%.9g", b[k].bound[l]);
    printf("\t%ld\t%ld", b[k].aggregate, b[k].parent);
    if (b[k].parent)
      printf("\t%.9g\t%.9g\t%.9g\t%.9g", o->r, o->v, o->v / o->v_esc, o->orbit.rp);
    else
      printf("\tnan\tnan\tnan\tnan");
    const GroupCentre rest = group_rest(s, g), first = group_centre(&b[0].g);
    group_orbit_row(stdout, g, &rest), group_orbit_row(stdout, g, &first);
    group_row(stdout, g, s, p);
    printf("\n");
  }
}

static ClumpLevel level(void)
{
  return !strcmp(arg.level, "kinetic")   ? CLUMP_KINETIC
         : !strcmp(arg.level, "thermal") ? CLUMP_THERMAL
                                         : CLUMP_ENTHALPY;
}

int main(int argc, char **argv)
{
  Err err;
  int inputs;
  char **input = opt_parse(&program, argc, argv, &inputs);
  const char *file = inputs ? input[0] : "-";
  if (!(arg.link > 0)) err_usage("--link must be positive");
  if (arg.least < 2) err_usage("--min-particles must be at least 2");
  if (!(arg.theta >= 0 && arg.theta <= 1)) err_usage("--theta must lie in 0..1");
  if (arg.mass < 0) err_usage("--min-mass must not be negative");
  if (!(arg.virial > 0)) err_usage("--max-virial must be positive");
  if (arg.campaign && !strcmp(arg.campaign, "-"))
    err_usage("--campaign: stdout holds the table: name a file");
  if (arg.out && !strcmp(arg.out, "-")) err_usage("--output: stdout holds the table: name a file");
  Parts *p = snap_read_some(file, arg.out ? NULL : GROUP_FIELDS GROUP_MORE " p", &err);
  if (!p || part_need(p, GROUP_FIELDS, file, &err) || part_check(p, file, &err))
    err_die("%s", err.text);
  if (!arg.bare && pointmass_rows(p, &err)) err_die("'%s': %s", file, err.text);
  ClumpOptions o = {!strcmp(arg.method, "grow"), level(), arg.link, arg.theta, arg.least};
  if (o.level == CLUMP_ENTHALPY && part_need(p, "p", file, &err)) err_die("%s", err.text);
  Group system;
  if (part_add(p, "clump", &err) || group_system(&system, p, arg.theta, &err))
    err_die("'%s': %s", file, err.text);
  double *phi = malloc((size_t)p->n * sizeof *phi);
  if (!phi) err_die("'%s': out of memory", file);
  memset(p->clump, 0, (size_t)p->n * sizeof *p->clump);
  long n = virial(&system) > arg.virial ? 0 : clump_find(p, &o, p->clump, phi, &err);
  if (n > 0) n = group_heavy(p, p->clump, n, arg.mass, &err);
  Body *b = n < 0 ? NULL : measure(p, n, phi, system.bodies, &err);
  if (!b) err_die("'%s': %s", file, err.text);
  long aggregates = connect(b, n);
  char *command = opt_command_line(argc, argv);
  if (arg.campaign) {
    const Group first[2] = {n > 0 ? b[0].g : system, n > 1 ? b[1].g : system};
    if (campaign_write(arg.campaign, file, p, first, n > 2 ? 2 : n, bound_mass(b, n), &system,
                       &err))
      err_die("%s", err.text);
  }
  if (arg.out && part_history(p, command, &err)) err_die("%s", err.text);
  const Parts whole = pointmass_without(p);
  if (arg.out && snap_write(&whole, arg.out, 0, &err)) err_die("%s", err.text);
  print(p, file, b, n, aggregates, &system);
  err_close_stdout();
  for (long k = 0; k < n; k++) group_free(&b[k].g);
  free(command), free(b), free(phi), group_free(&system), part_free(p);
  return 0;
}
