/* SPDX-License-Identifier: GPL-3.0-or-later */
/* solver: runs a system of particles and fills a run directory. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "../lib/opt.h"
#include "../lib/snap.h"
#include "../lib/unit.h"
#include "run.h"

static const char *config, *dir, *end, *precision, *device;
static double every = NAN, max_wall = INFINITY;
static int restart, profile, parameters;
static OptList set;

/* clang-format off */
static const Opt opts[] = {
  {"config",     'c', OPT_TEXT, NULL, "RUN.CFG", "settings of the run (see --parameters)", &config},
  {"output",     'o', OPT_TEXT, "run", "DIR", "run directory", &dir},
  {"end",        'e', OPT_TEXT, NULL, "TIME", "simulated time at which to end; +TIME: after the input's own time", &end},
  {"every",      0,   OPT_REAL, NULL, "s", "simulated time between snapshots (default: 50 of them)", &every},
  {"set",        's', OPT_LIST, NULL, "KEY=VALUE", "one setting, over those of the config; may be repeated", &set},
  {"device",     0,   OPT_TEXT, "auto", "auto|cpu|cuda[:K]", "where to run; auto: a card if there is one", &device},
  {"precision",  0,   OPT_CHOICE, NULL, "mixed|double", "short for --set precision=...", &precision},
  {"restart",    'r', OPT_FLAG, NULL, NULL, "continue from DIR/checkpoint.h5 if there is one", &restart},
  {"max-wall",   0,   OPT_REAL, NULL, "s", "stop with a checkpoint after this wall-clock time (exit 3)", &max_wall},
  {"profile",    0,   OPT_FLAG, NULL, NULL, "print the time spent in each pass", &profile},
  {"parameters", 0,   OPT_FLAG, NULL, NULL, "print the table of settings and exit", &parameters},
  {NULL, 0, OPT_FLAG, NULL, NULL, NULL, NULL},
};
/* clang-format on */

static const OptProgram program = {
    "solver",
    "simulate self-gravitating solid, fluid and gaseous bodies with SPH",
    "[options] --end TIME system.h5",
    "Writes DIR/snap_NNNN.h5, conserved.tsv, run.h5part (for ParaView), run.log and checkpoint.h5. "
    "SIGTERM and SIGINT leave a "
    "checkpoint and exit with 3; --restart continues bit for bit.",
    "solver -o run/ --end 2000min --every 20min --set gravity.theta=0.5 impact.h5",
    opts,
    0,
    1};

static double end_time(double start)
{
  Err err;
  double t;
  if (!end) err_usage("--end is needed");
  if (unit_parse(*end == '+' ? end + 1 : end, "s", &t, &err)) err_usage("--end: %s", err.text);
  if (*end == '+') t += start;
  if (!(t > start)) err_usage("--end %s is not after the input's time of %.9g s", end, start);
  return t;
}

static Param settings(void)
{
  Param par;
  Err err;
  param_defaults(&par);
  if (config && param_read(&par, config, &err)) err_die("%s", err.text);
  for (int i = 0; i < set.n; i++)
    if (param_set(&par, set.text[i], &err)) err_usage("--set: %s", err.text);
  if (precision) par.precision = strcmp(precision, "double") == 0 ? PARAM_DOUBLE : PARAM_MIXED;
  return par;
}

/* The command as /History has it: without --restart, so that a run that was killed before its first
 * checkpoint and begun anew makes the bytes of one that was not. */
static char *command_of(int argc, char **argv)
{
  const char **kept = calloc((size_t)argc + 1, sizeof *kept);
  char *line = NULL;
  int n = 0;
  for (int k = 0; k < argc && kept; k++)
    if (k == 0 || (strcmp(argv[k], "-r") != 0 && strncmp(argv[k], "--re", 4) != 0))
      kept[n++] = argv[k];
  if (kept) line = opt_command_line(n, (char **)kept);
  free(kept);
  if (!line) err_die("not enough memory");
  return line;
}

int main(int argc, char **argv)
{
  int n, rc;
  char **inputs = opt_parse(&program, argc, argv, &n);
  const char *file;
  Param par = settings();
  Parts *parts;
  Err err;
  RunOptions o = {0};
  if (parameters) {
    param_markdown(stdout);
    err_close_stdout();
    return 0;
  }
  file = n ? inputs[0] : "stdin";
  if (!(parts = snap_read(n ? file : "-", &err)) || part_need(parts, SIM_FIELDS, file, &err) ||
      part_check(parts, file, &err))
    err_die("%s", err.text);
  o.dir = dir, o.device = device, o.command = command_of(argc, argv);
  o.end = end_time(parts->time);
  o.every = isnan(every) ? (o.end - parts->time) / 50 : every;
  if (!(o.every > 0)) err_usage("--every must be positive");
  o.max_wall = max_wall, o.restart = restart, o.profile = profile;
  if ((rc = run_system(&o, &par, parts, &err)) < 0) err_die("%s", err.text);
  part_free(parts);
  free((char *)o.command);
  return rc;
}
