/* SPDX-License-Identifier: GPL-3.0-or-later */
/* fof: fragments by friends of friends, what they are made of and where they go (001 sect. 5.2,
 * table 3, eq. 74). */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "lib/choose.h"
#include "lib/fof.h"
#include "lib/group.h"
#include "lib/opt.h"
#include "lib/snap.h"
#include "lib/unit.h"

static struct {
  double link, length, damage, mass, survivors, theta;
  const char *out;
  OptList density, ignore;
  long least;
} arg = {.damage = INFINITY, .length = NAN};

static const Opt opts[] = {
    {"link", 'l', OPT_REAL, "1", "1", "friends when r_ij < link (h_i + h_j)/2, h the full support",
     &arg.link},
    {"length", 'L', OPT_REAL, NULL, "m", "or when r_ij is less than this, the same for all",
     &arg.length},
    {"min-density", 'd', OPT_LIST, NULL, "DENSITY",
     "leave out lighter particles: 700, 0.7g/cc, 0.75rho0 of each material; of one: ice:500",
     &arg.density},
    {"max-damage", 'D', OPT_REAL, NULL, "1",
     "leave out particles with at least this damage (1: fully damaged)", &arg.damage},
    {"ignore", 'i', OPT_LIST, NULL, "MATERIAL", "leave out a material", &arg.ignore},
    {"min-particles", 'n', OPT_INT, "1", "N", "smallest fragment", &arg.least},
    {"min-mass", 'M', OPT_REAL, "0", "kg", "and in mass", &arg.mass},
    {"survivors", 's', OPT_REAL, "0.1", "1", "a survivor has this fraction of the largest mass",
     &arg.survivors},
    {"theta", 't', OPT_REAL, "0.7", "1", "opening angle for the gravity of fragments", &arg.theta},
    {"output", 'o', OPT_TEXT, NULL, "FILE", "write the snapshot with FragmentID", &arg.out},
    {0}};

static const OptProgram program = {
    .name = "fof",
    .does = "find fragments by friends of friends",
    .usage = "[options] snapshot.h5 > fragments.tsv",
    .about =
        "One row a fragment, by descending mass; r and v are relative to the barycentre of "
        "all particles. v_esc = sqrt(2 G M_r/r) with M_r the mass of all fragments nearer to "
        "the barycentre (001 eq. 74); near is the survivor that binds the fragment most, with "
        "the two-body orbit about it. fate: accreted (the orbit hits that survivor), bound (to "
        "it, or slower than the escape speed with the fragment's own mass added to M_r), "
        "escape. Survivors are judged by their orbit about each other alone. water counts "
        "materials with ice, water or h2o in their name.",
    .example = "fof --min-particles 20 run/snap_0100.h5",
    .opts = opts,
    .min_inputs = 0,
    .max_inputs = 1};

typedef struct {
  Group g;
  double r, v, inside, v_esc; /* M_r kg; eq. 74 m/s */
  GroupPair pair;             /* about the survivor `near` */
  long near;                  /* 0: none */
  const char *fate;
} Fragment;

typedef struct {
  double r, mass;
} Shell; /* a fragment of any size, for M_r */

/* Marks the materials left out, [materials]. */
static unsigned char *ignored(const Parts *p, Err *err)
{
  unsigned char *skip = calloc((size_t)p->materials + 1, 1);
  if (!skip) err_die("out of memory");
  for (int k = 0; k < arg.ignore.n; k++) {
    Err why;
    const int c = choose_material(p, arg.ignore.text[k], &why);
    if (c < 0) return free(skip), err_null(err, "--ignore: %s", why.text);
    skip[c] = 1;
  }
  return skip;
}

static unsigned char *choose(const Parts *p, Err *err)
{
  double *limit = choose_densities(p, &arg.density, err);
  unsigned char *skip = limit ? ignored(p, err) : NULL,
                *keep = skip ? malloc((size_t)p->n + 1) : NULL;
  for (long i = 0; i < p->n && keep; i++)
    keep[i] = p->rho[i] >= limit[p->mat[i]] && !skip[p->mat[i]] &&
              (!p->damage || p->damage[i] < arg.damage);
  free(limit), free(skip);
  return keep;
}

static int by_distance(const void *a, const void *b)
{
  double p = ((const Shell *)a)->r, q = ((const Shell *)b)->r;
  return p < q ? -1 : p > q;
}

/* All fragments, however small, by their distance from the barycentre; mass summed from the inside,
 * each fragment in the order of its particles' ids. */
static Shell *shells(const Parts *p, const int32_t *id, long n, const Group *system, Err *err)
{
  Shell *shell = calloc((size_t)n + 1, sizeof *shell);
  double(*x)[3] = calloc((size_t)n + 1, sizeof *x);
  long *order = malloc((size_t)p->n * sizeof *order);
  int failed = !shell || !x || !order ? err_set(err, "out of memory for %ld fragments", n)
                                      : group_order(p, order, err);
  for (long o = 0; o < p->n && !failed; o++) {
    const long i = order[o], k = id[i] - 1;
    if (k < 0) continue;
    for (int a = 0; a < 3; a++) x[k][a] += p->m[i] * p->x[3 * i + a];
    shell[k].mass += p->m[i];
  }
  for (long k = 0; k < n && !failed; k++) {
    for (int a = 0; a < 3; a++) x[k][a] /= shell[k].mass;
    shell[k].r = group_apart(x[k], system->x);
  }
  free(x), free(order);
  if (failed) return free(shell), NULL;
  qsort(shell, (size_t)n, sizeof *shell, by_distance);
  for (long k = 1; k < n; k++) shell[k].mass += shell[k - 1].mass;
  return shell;
}

/* Mass of the fragments with a distance below r. */
static double inside(const Shell *shell, long n, double r)
{
  long low = 0, high = n;
  while (low < high) {
    long mid = (low + high) / 2;
    if (shell[mid].r < r)
      low = mid + 1;
    else
      high = mid;
  }
  return low ? shell[low - 1].mass : 0;
}

static Fragment *measure(const Parts *p, const int32_t *id, long n, const Group *system,
                         const Shell *shell, long shelln, Err *err)
{
  Fragment *f = calloc((size_t)n + 1, sizeof *f);
  Group *g = group_all(p, id, n, system->bodies, arg.theta, NULL, err);
  if (!f || !g) return NULL;
  for (long k = 0; k < n; k++) {
    f[k].g = g[k];
    f[k].r = group_apart(f[k].g.x, system->x), f[k].v = group_apart(f[k].g.v, system->v);
    f[k].inside = inside(shell, shelln, f[k].r);
    f[k].v_esc = f[k].inside > 0 ? sqrt(2 * UNIT_G * f[k].inside / f[k].r) : 0;
  }
  free(g);
  return f;
}

/* The survivor that binds f[k] most, and what becomes of the fragment. Survivors are judged by
 * their pair alone: seen from the barycentre each is slower than v_esc even when they part for
 * good. */
static void judge(Fragment *f, long n, long k)
{
  Group *g = &f[k].g;
  double least = arg.survivors * f[0].g.mass;
  for (long s = 0; s < n && f[s].g.mass >= least; s++) {
    Group *b = &f[s].g;
    if (s == k) continue;
    GroupPair pair = group_pair(b->x, b->v, b->mass, g->x, g->v, g->mass);
    if (f[k].near && pair.orbit.beta <= f[k].pair.orbit.beta) continue;
    f[k].pair = pair, f[k].near = s + 1;
  }
  const GroupPair *o = &f[k].pair;
  int held = f[k].near && o->orbit.beta > 0, survivor = f[k].near && g->mass >= least;
  double mass = f[k].inside + g->mass;
  if (f[k].near && o->orbit.rp < f[f[k].near - 1].g.radius + g->radius && (held || o->v_r < 0))
    f[k].fate = "accreted";
  else if (held || (!survivor && f[k].v * f[k].v * f[k].r <= 2 * UNIT_G * mass))
    f[k].fate = "bound";
  else
    f[k].fate = "escape";
}

static void print(const Parts *p, const char *file, const Fragment *f, long n, long all,
                  const Group *s)
{
  char time[64];
  double mass = 0, damage = 0;
  for (long k = 0; k < n; k++) mass += f[k].g.mass, damage += f[k].g.mass * f[k].g.damage;
  printf("# %s at %s: %ld fragments, %ld of them with %ld or more particles\n", file,
         unit_time_text(p->time, time, sizeof time), all, n, arg.least);
  printf("# these hold %.9g kg of %.9g kg", mass, s->mass);
  if (n && p->damage) printf(", mean damage %.4g", damage / mass);
  printf("\n# id\tn\tmass [kg]\tr [m]\tv [m/s]\tv_esc [m/s]\tfate\tnear\tdistance [m]\tv_rel "
         "[m/s]\tv_rel/v_esc [1]"
         "\tpericentre [m]");
  group_orbit_header(stdout, "system"), group_orbit_header(stdout, "1");
  group_header(stdout, p, s->bodies);
  printf("\n");
  for (long k = 0; k < n; k++) {
    const GroupPair *o = &f[k].pair;
    printf("%ld\t%ld\t%.9g\t%.9g\t%.9g\t%.9g\t%s\t%ld", k + 1, f[k].g.n, f[k].g.mass, f[k].r,
           f[k].v, f[k].v_esc, f[k].fate, f[k].near);
    if (f[k].near)
      printf("\t%.9g\t%.9g\t%.9g\t%.9g", o->r, o->v, o->v / o->v_esc, o->orbit.rp);
    else
      printf("\tnan\tnan\tnan\tnan");
    const GroupCentre rest = group_rest(s, &f[k].g), first = group_centre(&f[0].g);
    group_orbit_row(stdout, &f[k].g, &rest), group_orbit_row(stdout, &f[k].g, &first);
    group_row(stdout, &f[k].g, s, p);
    printf("\n");
  }
}

/* All fragments by the links asked for, in p->frag. */
static long find(Parts *p, const unsigned char *keep, Err *err)
{
  if (isnan(arg.length)) return fof_find(p, arg.link, keep, 1, p->frag, err);
  double *own = p->h, *same = malloc((size_t)p->n * sizeof *same);
  if (!same) return err_set(err, "out of memory for %ld particles", p->n);
  for (long i = 0; i < p->n; i++) same[i] = arg.length;
  p->h = same;
  long n = fof_find(p, 1, keep, 1, p->frag, err);
  p->h = own, free(same);
  return n;
}

static void check_arguments(void)
{
  if (arg.length <= 0) err_usage("--length must be positive");
  if (!isnan(arg.length) && opt_given(&program, "link"))
    err_usage("--link and --length exclude each other");
  if (arg.mass < 0) err_usage("--min-mass must not be negative");
  if (!(arg.link > 0)) err_usage("--link must be positive");
  if (arg.least < 1) err_usage("--min-particles must be at least 1");
  if (arg.survivors < 0 || arg.survivors > 1) err_usage("--survivors must lie in 0..1");
  if (!(arg.theta >= 0 && arg.theta <= 1)) err_usage("--theta must lie in 0..1");
  if (arg.out && !strcmp(arg.out, "-")) err_usage("--output: stdout holds the table: name a file");
}

int main(int argc, char **argv)
{
  Err err;
  int inputs;
  char **input = opt_parse(&program, argc, argv, &inputs);
  const char *file = inputs ? input[0] : "-";
  check_arguments();
  Parts *p = snap_read_some(file, arg.out ? NULL : GROUP_FIELDS GROUP_MORE, &err);
  if (!p || part_need(p, GROUP_FIELDS, file, &err) || part_check(p, file, &err))
    err_die("%s", err.text);
  if (arg.damage < INFINITY && part_need(p, "damage", file, &err)) err_die("%s", err.text);
  Group system;
  unsigned char *keep = choose(p, &err);
  if (!keep || group_system(&system, p, -1, &err) || part_add(p, "frag", &err))
    err_die("'%s': %s", file, err.text);
  long all = find(p, keep, &err);
  Shell *shell = all < 0 ? NULL : shells(p, p->frag, all, &system, &err);
  long n = shell ? group_rank(p, p->frag, all, arg.least, &err) : -1;
  if (n > 0) n = group_heavy(p, p->frag, n, arg.mass, &err);
  Fragment *f = n < 0 ? NULL : measure(p, p->frag, n, &system, shell, all, &err);
  if (!f) err_die("'%s': %s", file, err.text);
  for (long k = 0; k < n; k++) judge(f, n, k);
  char *command = opt_command_line(argc, argv);
  if (arg.out && (part_history(p, command, &err) || snap_write(p, arg.out, 0, &err)))
    err_die("%s", err.text);
  print(p, file, f, n, all, &system);
  err_close_stdout();
  for (long k = 0; k < n; k++) group_free(&f[k].g);
  free(command), free(f), free(shell), free(keep), group_free(&system), part_free(p);
  return 0;
}
