/* SPDX-License-Identifier: GPL-3.0-or-later */
/* track: what becomes of fragments and bound bodies through the dumps of a run, and where in the
 * bodies at the start their matter was. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "curve.h"
#include "lib/follow.h"
#include "lib/clump.h"
#include "lib/fof.h"
#include "lib/group.h"
#include "lib/opt.h"
#include "lib/snap.h"
#include "lib/spool.h"
#include "origin.h"

static struct {
  const char *by, *curve, *plot, *title, *tracks, *initial, *map, *mark, *shells;
  double link, theta;
  long least, bins;
} arg;

static const Opt opts[] = {
    {"by", 'b', OPT_CHOICE, "clumps", "clumps|grow|fof|stored",
     "bound bodies (two methods), fragments, or the ids in the files", &arg.by},
    {"min-particles", 'n', OPT_INT, "20", "N", "smallest object", &arg.least},
    {"link", 'l', OPT_REAL, "1", "1", "friends when r_ij < link (h_i + h_j)/2", &arg.link},
    {"theta", 't', OPT_REAL, "0.7", "1", "opening angle of the gravity tree", &arg.theta},
    {"tracks", 'T', OPT_TEXT, NULL, "FILE", "write one row a track", &arg.tracks},
    {"curve", 'c', OPT_TEXT, NULL, "FILE", "write the masses of the largest objects against time",
     &arg.curve},
    {"plot", 'p', OPT_TEXT, NULL, "PNG", "and draw them", &arg.plot},
    {"title", 0, OPT_TEXT, NULL, "TEXT", "title of the picture", &arg.title},
    {"initial", 'i', OPT_TEXT, NULL, "FILE",
     "the bodies at the start (default: the first snapshot)", &arg.initial},
    {"map", 'm', OPT_TEXT, NULL, "FILE", "write the start with the ids of the last objects",
     &arg.map},
    {"origin", 'o', OPT_TEXT, NULL, "FILE",
     "write the last snapshot with its ids, InitialRadius, InitialDepth", &arg.mark},
    {"shells", 's', OPT_TEXT, NULL, "FILE",
     "write the mass of the last objects by shells at the start", &arg.shells},
    {"bins", 0, OPT_INT, "10", "N", "shells of each body", &arg.bins},
    {0}};

static const OptProgram program = {
    .name = "track",
    .does = "follow fragments and bound bodies through the dumps of a run",
    .usage = "[options] snap_0000.h5 ... > objects.tsv",
    .about =
        "One row an object and dump. progenitor and descendant are the objects of the dump "
        "before and after that most of its mass was and is in (0: none), inherited and passed "
        "the parts of its mass; two that are each other's have the same track. A track that "
        "ended, as of bodies that touch for a while, goes on with a new object if more than "
        "half of either is the other's. --tracks: parent is the track it came out of, into "
        "that which it ended in. --curve: above it means and deviations over the last tenth; "
        "xi = (M_1 - M_target)/M_impactor; heating is the gain of E_th over the kinetic energy "
        "of both bodies at contact. Colour the file of --map by ClumpID (FragmentID), "
        "that of --origin by InitialDepth: render -c.",
    .example = "track --plot masses.png --map provenance.h5 run/snap_*.h5 > objects.tsv",
    .opts = opts,
    .min_inputs = 1,
    .max_inputs = -1};

/* A dump of which rows are still to be printed: the text behind the columns of the descent. */
typedef struct {
  char *file, **tail; /* [n] */
  double time;        /* s */
  long *count, n;
} Dump;

static Err err;

static const char *member(const Parts *p)
{
  if (strcmp(arg.by, "stored")) return strcmp(arg.by, "fof") ? "clump" : "frag";
  return p->clump ? "clump" : "frag";
}

/* The objects of a dump, id [p->n] = 1, 2, ... by descending mass. */
static long find(const Parts *p, const char *file, int32_t *id, double *phi)
{
  const ClumpOptions o = {!strcmp(arg.by, "grow"), CLUMP_KINETIC, arg.link, arg.theta, arg.least};
  if (!strcmp(arg.by, "fof")) return fof_find(p, arg.link, NULL, arg.least, id, &err);
  if (strcmp(arg.by, "stored")) return clump_find(p, &o, id, phi, &err);
  const int32_t *stored = p->clump ? p->clump : p->frag;
  long most = 0;
  if (!stored) return err_set(&err, "'%s' has neither ClumpID nor FragmentID: see --by", file);
  for (long i = 0; i < p->n; i++) {
    if (stored[i] < 0 || stored[i] > p->n)
      return err_set(&err, "'%s': particle %lld has the id %d of an object", file,
                     (long long)p->id[i], (int)stored[i]);
    id[i] = stored[i], most = stored[i] > most ? stored[i] : most;
  }
  return group_rank(p, id, most, arg.least, &err);
}

/* The rest of the row of each object: as fof and clumps have it. */
static int tails(Dump *d, const Parts *p, const Group *g, const Group *system)
{
  d->tail = calloc((size_t)d->n + 1, sizeof *d->tail);
  d->count = calloc((size_t)d->n + 1, sizeof *d->count);
  for (long k = 0; k < d->n && d->tail && d->count; k++) {
    size_t size;
    FILE *f = open_memstream(&d->tail[k], &size);
    if (!f) return err_set(&err, "out of memory");
    group_row(f, &g[k], system, p), d->count[k] = g[k].n;
    if (fclose(f)) return err_set(&err, "out of memory");
  }
  return d->tail && d->count ? 0 : err_set(&err, "out of memory");
}

static void print(const Dump *d, const FollowObject *o, int last)
{
  for (long k = 1; k <= d->n; k++) {
    printf("%s\t%.9g\t%ld\t%ld\t%ld\t%.9g\t%ld\t%.6g", d->file, d->time, o[k].track, k,
           d->count[k - 1], o[k].mass, o[k].progenitor, o[k].inherited);
    if (last)
      printf("\tnan\tnan%s\n", d->tail[k - 1]);
    else
      printf("\t%ld\t%.6g%s\n", o[k].descendant, o[k].passed, d->tail[k - 1]);
  }
}

static void dump_free(Dump *d)
{
  for (long k = 0; k < d->n && d->tail; k++) free(d->tail[k]);
  free(d->tail), free(d->count);
  *d = (Dump){0};
}

/* What all dumps must have in common: columns. */
static void check(const Parts *p, const char *file, double before, int bodies, int materials)
{
  if (!(p->time > before)) err_die("'%s' is not later than the dump before it", file);
  if (group_bodies(p, &err) > bodies || p->materials != materials)
    err_die("'%s' has other bodies or materials than the first dump", file);
}

/* One dump: its objects, their descent; prints those of the dump before. */
static void look(const Parts *p, char *file, int bodies, Follow *follow, Curve *curve, Dump *before)
{
  Dump d = {.file = file, .time = p->time};
  int32_t *id = calloc((size_t)p->n + 1, sizeof *id);
  double *phi = malloc(((size_t)p->n + 1) * sizeof *phi);
  Group system;
  FollowObject *old;
  if (!id || !phi) err_die("'%s': out of memory", file);
  if ((d.n = find(p, file, id, phi)) < 0) err_die("%s", err.text);
  Group *g = group_all(p, id, d.n, bodies, arg.theta,
                       strcmp(arg.by, "clumps") && strcmp(arg.by, "grow") ? NULL : phi, &err);
  if (!g || group_system(&system, p, -1, &err) || tails(&d, p, g, &system) ||
      curve_add(curve, p->time, &system, g, d.n, p, &err) ||
      follow_step(follow, p, id, d.n, &old, &err))
    err_die("'%s': %s", file, err.text);
  if (old) print(before, old, 0);
  free(old), free(id), free(phi), group_all_free(g, d.n), group_free(&system), dump_free(before);
  *before = d;
}

static void write_tracks(const Follow *f)
{
  char *text = NULL;
  size_t size;
  FILE *to = open_memstream(&text, &size);
  if (!to) err_die("out of memory");
  fputs("# track\tparent\tinto\tdumps\tfirst [s]\tlast [s]\tmass_first [kg]\tmass_last "
        "[kg]\tmass_max "
        "[kg]\tfate\n",
        to);
  for (long k = 1; k <= f->tracks; k++) {
    const FollowTrack *t = &f->track[k];
    fprintf(to, "%ld\t%ld\t%ld\t%ld\t%.9g\t%.9g\t%.9g\t%.9g\t%.9g\t%s\n", k, t->parent, t->into,
            t->dumps, t->first, t->last, t->mass_first, t->mass_last, t->mass_max,
            t->object ? "there"
            : t->into ? "merged"
                      : "dispersed");
  }
  if (fclose(to)) err_die("out of memory");
  if (spool_text(arg.tracks, text, &err)) err_die("%s", err.text);
  free(text);
}

/* Provenance: maps, marks, shells. */
static void provenance(char **input, int n, const Descent *last, const char *field,
                       const char *command)
{
  Origin o;
  const char *start = arg.initial ? arg.initial : input[0];
  Parts *p = snap_read_some(start, "id x m body", &err);
  if (!p || part_need(p, "id x m body", start, &err)) err_die("%s", err.text);
  if (origin_open(&o, p, &err)) err_die("'%s': %s", start, err.text);
  part_free(p);
  if (arg.map && origin_map(arg.map, start, last, field, command, &err)) err_die("%s", err.text);
  if (arg.mark && origin_mark(arg.mark, input[n - 1], &o, last, field, command, &err))
    err_die("%s", err.text);
  if (arg.shells && origin_shells(arg.shells, &o, last, arg.bins, &err)) err_die("%s", err.text);
  origin_close(&o);
}

static void check_arguments(char **input, int n)
{
  const char *const file[] = {arg.tracks, arg.curve, arg.plot, arg.map, arg.mark, arg.shells};
  for (int k = 0; k < 6; k++)
    if (file[k] && !strcmp(file[k], "-")) err_usage("stdout holds the table: name a file, not '-'");
  for (int k = 0; k < n; k++)
    if (!strcmp(input[k], "-")) err_usage("'-': dumps are read more than once: name files");
  if (!(arg.link > 0)) err_usage("--link must be positive");
  if (!(arg.theta >= 0 && arg.theta <= 1)) err_usage("--theta must lie in 0..1");
  if (arg.least < (strcmp(arg.by, "fof") ? 2 : 1)) err_usage("--min-particles is too small");
  if (arg.bins < 1 || arg.bins > 100000) err_usage("--bins must lie in 1..100000");
  if (opt_given(&program, "bins") && !arg.shells) err_usage("--bins needs --shells");
  if (arg.title && !arg.plot) err_usage("--title needs --plot");
  if (arg.initial && !arg.map && !arg.mark && !arg.shells)
    err_usage("--initial needs --map, --origin or --shells");
}

int main(int argc, char **argv)
{
  int n, bodies = 0, materials = 0;
  char **input = opt_parse(&program, argc, argv, &n), *command = opt_command_line(argc, argv);
  Follow follow = {0};
  Curve curve = {0};
  Dump dump = {0};
  const char *field = NULL;
  check_arguments(input, n);
  for (int k = 0; k < n; k++) {
    Parts *p = snap_read_some(input[k], GROUP_FIELDS GROUP_MORE " frag clump", &err);
    if (!p || part_need(p, GROUP_FIELDS, input[k], &err) || part_check(p, input[k], &err))
      err_die("%s", err.text);
    if (!k && (bodies = group_bodies(p, &err)) < 0) err_die("'%s': %s", input[k], err.text);
    if (!k) materials = p->materials;
    check(p, input[k], dump.file ? dump.time : -INFINITY, bodies, materials);
    if (!k) {
      printf("# file\ttime [s]\ttrack\tid\tn\tmass [kg]\tprogenitor\tinherited [1]\tdescendant\t"
             "passed [1]");
      group_header(stdout, p, bodies), putchar('\n');
    }
    field = member(p);
    look(p, input[k], bodies, &follow, &curve, &dump);
    part_free(p);
  }
  if (arg.map || arg.mark || arg.shells) provenance(input, n, &follow.now, field, command);
  if (arg.curve && curve_write(arg.curve, &curve, &err)) err_die("%s", err.text);
  if (arg.plot && curve_draw(arg.plot, &curve, arg.title, &err)) err_die("%s", err.text);
  if (arg.tracks) write_tracks(&follow);
  print(&dump, follow.object, 1);
  err_close_stdout();
  dump_free(&dump), follow_close(&follow), curve_free(&curve), free(command);
  return 0;
}
