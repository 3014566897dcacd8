/* SPDX-License-Identifier: GPL-3.0-or-later */
/* relax: brings a body to hydrostatic equilibrium. The one-dimensional structure is solved and laid
 * on the particles; then the solver runs with friction and frozen entropy, first with a friction
 * time that stops sound, then with one that stops gravity modes; a proof run without friction shows
 * what the body does when left alone (docs/theory.md). A body at rest is recognised. */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include "../../lib/snap.h"
#include "../../lib/spool.h"
#include "../../lib/unit.h"
#include "finish.h"
#include "report.h"
#include "run.h"

static Options o;
static Report report;

/* clang-format off */
static const Opt opts[] = {
  {"output",       'o', OPT_TEXT,   "-",    "FILE", "relaxed body", &o.output},
  {"profile-only", 0,   OPT_FLAG,   NULL,   NULL,   "print the one-dimensional structure (TSV) and stop", &o.only},
  {"profile",      'p', OPT_TEXT,   NULL,   "FILE", "write the one-dimensional structure there: TSV, or HDF5 (.h5)", &o.profile},
  {"method",       0,   OPT_CHOICE, "ode",  "ode|shells", "how it is found: integrated outwards, or by falling shells", &o.method},
  {"nodes",        0,   OPT_INT,    NULL,   "N",    "of the structure (4000; 400 shells)", &o.nodes},
  {"damping",      0,   OPT_TEXT,   "0.3tff", "TIME", "friction time of the second stage; tff: free-fall times", &o.damping_text},
  {"radial",       0,   OPT_FLAG,   NULL,   NULL,   "damp the radial velocity only", &o.radial},
  {"freeze",       0,   OPT_CHOICE, "entropy", "entropy|energy|nothing", "of each particle, in the damped run", &o.freeze},
  {"fluid",        0,   OPT_FLAG,   NULL,   NULL,   "without strength: it ends free of deviatoric stress", &o.fluid},
  {"rigid",        0,   OPT_FLAG,   NULL,   NULL,   "end with no motion but the rigid spin", &o.rigid},
  {"max-time",     't', OPT_TEXT,   "12tff", "TIME", "longest damped run", &o.max_time_text},
  {"proof",        0,   OPT_TEXT,   "1tff", "TIME", "length of the proof run without friction; 0: none", &o.proof_text},
  {"report",       'r', OPT_TEXT,   NULL,   "FILE", "write what was reached there, one row a run (TSV)", &o.report},
  {"again",        0,   OPT_FLAG,   NULL,   NULL,   "relax a body that is at rest already, too", &o.again},
  {"checkpoint",   0,   OPT_TEXT,   NULL,   "FILE", "save the damped run there each minute, and go on from it", &o.checkpoint},
  {"device",       0,   OPT_TEXT, "auto", "auto|cpu|cuda[:K]", "where to run; auto: a card if there is one", &o.device},
  {"set",          's', OPT_LIST,   NULL,   "KEY=VALUE", "a setting of the solver, e.g. density=miscible", &o.set},
  {NULL, 0, OPT_FLAG, NULL, NULL, NULL, NULL},
};
/* clang-format on */

static const OptProgram program = {
    "relax",
    "bring a body to hydrostatic equilibrium",
    "[options] body.h5 > relaxed.h5",
    "Keeps the layers and their thermal laws. Prints what was reached on stderr.",
    "mksphere -n 2000 --mass 9.43e20 --layer basalt:0.7 --layer ice:0.3 | relax > target.h5",
    opts,
    0,
    1};

static int measure(const Body *b, Measure *m, Err *err)
{
  return measure_body(b->p, &b->s, b->layer, b->spacing, m, err);
}

/* What the body does when left alone, with all its strength; on a copy. */
static int proof(Body *b, double time, Err *err)
{
  unsigned char *all = malloc((size_t)b->p->n);
  Body copy = *b;
  Measure m;
  double before;
  int rc;
  if (!all) return err_set(err, "not enough memory");
  memset(all, 1, (size_t)b->p->n);
  copy.p = part_select(b->p, all, err);
  free(all);
  if (!copy.p || measure(&copy, &m, err)) return -1;
  before = m.radius;
  rc = run_free(&copy, &o, time, err);
  if (!rc) rc = measure(&copy, &m, err);
  if (!rc) {
    report_run(&report, "proof", "proof run without friction", &copy, &m, time);
    fprintf(stderr, "relax: its radius changed by %.2e\n", m.radius / before - 1);
    if (!(m.rms < 0.01)) err_warn("the body does not stay at rest: rms v is %.2g v_esc", m.rms);
  }
  part_free(copy.p);
  return rc;
}

/* Whether it is at rest as it is: slow, and with no force left. */
static int at_rest(Body *b, int *rest, Err *err)
{
  Measure m;
  double left;
  *rest = 0;
  if (b->laid || o.again || (o.checkpoint && !access(o.checkpoint, F_OK))) return 0;
  if (measure(b, &m, err) || run_residual(b, &o, &left, err)) return -1;
  *rest = measure_quiet(&m) && left < 0.01;
  if (*rest) report_run(&report, "rest", "at rest already", b, &m, 0);
  return 0;
}

static int relax(Body *b, Err *err)
{
  double took = 0, left = run_time(b, o.proof);
  Measure m;
  int rest, rc;
  if (at_rest(b, &rest, err)) return -1;
  if (!rest && (rc = run_damped(b, &o, &took, err))) return rc;
  if (finish_eject(b, err) || finish_settle(b, o.rigid, err) || measure(b, &m, err)) return -1;
  if (!rest) report_run(&report, "damped", "damped run", b, &m, took);
  if (!measure_quiet(&m))
    err_warn("not at rest after %.3g s: 99.9 %% of the speeds below %.2g v_esc",
             run_time(b, o.max_time), m.high);
  if (finish_reset(b, o.fluid, &m, err)) return -1;
  return left > 0 && (!rest || opt_given(&program, "proof")) ? proof(b, left, err) : 0;
}

static Span span(const char *name, const char *text)
{
  Span t = {0, 0};
  const char *suffix;
  double number;
  Err err;
  if (!unit_suffix(text, &number, &suffix, &err) && !strcmp(suffix, "tff"))
    t.falls = number;
  else if (unit_parse(text, "s", &t.s, &err))
    err_usage("--%s: %s (or free-fall times, as in 2tff)", name, err.text);
  return t;
}

/* Before anything is computed: whether a file can be made there. */
static void check_file(const char *option, const char *path)
{
  char *folder, *slash;
  struct stat there;
  if (!path) return;
  if (!strcmp(path, "-")) err_usage("--%s needs a file", option);
  if (!stat(path, &there) && !S_ISREG(there.st_mode)) return; /* a device, a pipe */
  if (!(folder = strdup(path))) err_die("out of memory");
  slash = strrchr(folder, '/');
  if (slash) slash[slash == folder] = 0;
  if (access(slash ? folder : ".", W_OK)) err_die("cannot write '%s': %s", path, strerror(errno));
  free(folder);
}

/* What has no effect without a run is refused. */
static void check_only(void)
{
  static const char *const runs[] = {"output", "damping", "radial",     "freeze",
                                     "fluid",  "rigid",   "max-time",   "proof",
                                     "report", "again",   "checkpoint", "set"};
  for (size_t k = 0; o.only && k < sizeof runs / sizeof *runs; k++)
    if (opt_given(&program, runs[k]))
      err_usage("--%s has no effect with --profile-only: nothing runs", runs[k]);
}

static void check_options(void)
{
  check_only();
  o.damping = span("damping", o.damping_text), o.max_time = span("max-time", o.max_time_text);
  o.proof = span("proof", o.proof_text);
  if (!opt_given(&program, "nodes")) o.nodes = !strcmp(o.method, "ode") ? 4000 : 400;
  if (o.nodes < 100) err_usage("--nodes must be at least 100");
  if (!(o.damping.s + o.damping.falls > 0)) err_usage("--damping must be positive");
  if (!(o.max_time.s + o.max_time.falls > 0)) err_usage("--max-time must be positive");
  if (o.proof.s + o.proof.falls < 0) err_usage("--proof must not be negative");
  check_file("checkpoint", o.checkpoint), check_file("report", o.report);
  check_file("profile", o.profile);
  if (strcmp(o.output, "-") != 0) check_file("output", o.output);
  run_settings(&o, 1, 0);
}

int main(int argc, char **argv)
{
  int n, rc;
  char **inputs = opt_parse(&program, argc, argv, &n), *command = opt_command_line(argc, argv);
  Body b = {0};
  Err err;
  check_options();
  if (body_read(&b, n ? inputs[0] : NULL, &o, &err)) err_die("%s", err.text);
  if (!o.only) {
    if ((rc = relax(&b, &err)) < 0) err_die("%s", err.text);
    if (rc == ERR_STOPPED) {
      fprintf(stderr, "relax: stopped; the same command goes on from '%s'\n", o.checkpoint);
      return ERR_STOPPED;
    }
    if (o.report && spool_text(o.report, report.text, &err)) err_die("%s", err.text);
    if (part_history(b.p, command, &err) || snap_write(b.p, o.output, 0, &err))
      err_die("%s", err.text);
    if (o.checkpoint) unlink(o.checkpoint);
  }
  body_free(&b), free(command);
  if (o.only || strcmp(o.output, "-") != 0) err_close_stdout();
  return 0;
}
