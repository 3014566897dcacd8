/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The run loop: steps, snapshots, checkpoints, stopping. What is written is in output.c. */
#include <math.h>
#include <signal.h>
#include <string.h>
#include "../lib/progress.h"
#include "../lib/snap.h"
#include "../lib/unit.h"
#include "analysis.h"
#include "conflict.h"
#include "guard.h"
#include "output.h"
#include "profile.h"
#include "run.h"

static volatile sig_atomic_t stop_signal; /* set by the handler, read by the loop */

static void on_signal(int number) { stop_signal = number; }

static void catch_signals(void)
{
  struct sigaction act;
  memset(&act, 0, sizeof act);
  act.sa_handler = on_signal;
  sigemptyset(&act.sa_mask);
  sigaction(SIGTERM, &act, NULL);
  sigaction(SIGINT, &act, NULL);
}

/* Everything a run keeps in mind. */
typedef struct {
  Sim sim;
  Output out;
  Analysis analysis;
  Parts *parts;
  const RunOptions *o;
  Guard guard;
  double began, saved; /* wall clock: start, last checkpoint */
  long first_step;
  Progress bar;
} Run;

/* Looked at before the work of a start, and again when no other solver can change the answer. */
static int vacant(const RunOptions *o, Err *err)
{
  if (o->restart || !output_in_use(o->dir)) return 0;
  return err_set(err, "'%s' holds a run already: --restart continues it", o->dir);
}

/* A line of bound.tsv when one is due. */
static int analyse(Run *r, Err *err)
{
  if (!analysis_due(&r->analysis, &r->sim)) return 0;
  if (output_wait(&r->out, err) || sim_store(&r->sim, r->parts, err)) return -1;
  return analysis_line(&r->analysis, &r->sim, r->parts, err);
}

static int fresh(Run *r, const Param *par, Err *err)
{
  Sums sums;
  if (part_history(r->parts, r->o->command, err) || param_record(par, r->parts, err)) return -1;
  if (part_set_number(r->parts, "run", "StartTime", r->parts->time, err)) return -1;
  if (sim_open(&r->sim, par, r->parts, r->o->device, err)) return -1;
  if (conflict_unused(par, &r->sim, err)) return -1;
  r->sim.profile = r->o->profile;
  if (output_claim(&r->out, r->o->dir, err) || vacant(r->o, err)) return -1;
  if (output_open(&r->out, r->parts->time, r->o->every, r->o->end, err) ||
      analysis_open(&r->analysis, &r->out, &r->sim, err))
    return -1;
  output_log(&r->out, "%s %ld particles, %dD, %d material(s), %s on %s", r->o->command, r->parts->n,
             r->parts->dimension, r->parts->materials, integrator_of(par->integrator)->about,
             r->sim.about);
  if (output_conserved(&r->out, &r->sim, NULL, &sums, err) ||
      guard_start(&r->guard, &sums, r->parts, err) || analyse(r, err))
    return -1;
  return output_snapshot(&r->out, &r->sim, r->parts, err);
}

/* A checkpoint must come from the same input and the same settings (what is written may differ). */
static int same_run(const Parts *checkpoint, const Param *par, Parts *input, Err *err)
{
  if (param_record(par, input, err)) return -1;
  const double escaped = part_number(checkpoint, "run", "EscapedNumber"),
               accreted = part_number(checkpoint, "run", "AccretedNumber");
  if ((double)checkpoint->n + (isnan(escaped) ? 0 : escaped + accreted) != (double)input->n)
    return err_set(err,
                   "the checkpoint has %ld particles, the input %ld: it belongs to another run",
                   checkpoint->n, input->n);
  for (int i = 0; i < input->parameters; i++) {
    const char *line = input->parameter[i];
    if (strncmp(line, "output.", 7) == 0 || strncmp(line, "analysis.", 9) == 0 ||
        strncmp(line, "guard.", 6) == 0)
      continue;
    if (i >= checkpoint->parameters || strcmp(line, checkpoint->parameter[i]) != 0)
      return err_set(err, "the checkpoint was made with another '%.*s': it belongs to another run",
                     (int)strcspn(line, "\t"), line);
  }
  return 0;
}

static int resume(Run *r, const Param *par, Parts *checkpoint, Err *err)
{
  double start = part_number(checkpoint, "run", "StartTime");
  if (same_run(checkpoint, par, r->parts, err)) return -1;
  r->parts = checkpoint;
  if (guard_resume(&r->guard, checkpoint, err)) return -1;
  if (sim_restart(&r->sim, par, checkpoint, r->o->device, err)) return -1;
  r->sim.profile = r->o->profile;
  if (output_claim(&r->out, r->o->dir, err)) return -1;
  if (output_resume(&r->out, start, r->o->every, r->o->end, &r->sim, err) ||
      analysis_resume(&r->analysis, &r->out, &r->sim, err))
    return -1;
  output_log(&r->out, "continued from step %ld, t = %.9g s on %s", r->sim.step, r->sim.time,
             r->sim.about);
  return 0;
}

static int save(Run *r, Err *err)
{
  r->saved = progress_clock();
  return output_checkpoint(&r->out, &r->sim, r->parts, err);
}

static void show(Run *r, const SimStep *done)
{
  char t[32], dt[32], note[128];
  snprintf(note, sizeof note, "t %s  dt %s %s", unit_time_text(r->sim.time, t, sizeof t),
           unit_time_text(done->dt, dt, sizeof dt), sim_limit_name(done->limit));
  progress_show(&r->bar, (r->sim.time - r->out.start) / (r->o->end - r->out.start), note);
}

/* What leaves after this step. */
static int let_leave(Run *r, Err *err)
{
  Output *o = &r->out;
  LeaveFound found;
  Parts *gone[ARCHIVES];
  const long step = r->sim.step;
  if (!leave_possible(&r->sim)) return 0;
  if (leave_find(&r->sim, &found, err)) return -1;
  if (!found.where) return 0;
  if (output_wait(o, err) ||
      leave_take(&r->sim, &found, r->parts, &gone[ARCHIVE_ESCAPED], &gone[ARCHIVE_ACCRETED], err))
    return -1;
  output_log(o, "step %ld, t = %.9g s: %ld particles leave (%ld escape), %ld are left", step,
             r->sim.time, found.leaving, gone[ARCHIVE_ESCAPED] ? gone[ARCHIVE_ESCAPED]->n : 0,
             r->sim.s.n);
  for (int k = 0; k < ARCHIVES; k++)
    if (archive_add(&o->archive, k, gone[k], err)) return -1;
  return 0;
}

/* A line of sums; a run that has lost too much ends here, with a checkpoint to look at. */
static int conserve(Run *r, const SimStep *done, Err *err)
{
  Sums sums;
  Err late;
  if (output_conserved(&r->out, &r->sim, done, &sums, err)) return -1;
  if (!guard_check(&r->guard, &sums, &r->sim, err)) return 0;
  if (save(r, &late) || output_wait(&r->out, &late)) err_warn("%s", late.text);
  return -1;
}

/* After each step: lines, snapshots, checkpoints. Returns 1 to go on, 0 when done, 3 to stop, -1 on
 * error. */
static int look_around(Run *r, const SimStep *done, Err *err)
{
  int due = r->sim.time >= output_due(&r->out), converged;
  show(r, done);
  if (output_look(&r->out, err) || let_leave(r, err) || analyse(r, err)) return -1;
  converged = analysis_converged(&r->analysis, &r->sim.par);
  if (due || converged || r->sim.step % r->sim.par.log_every == 0)
    if (conserve(r, done, err)) return -1;
  if ((due || converged) && output_snapshot(&r->out, &r->sim, r->parts, err)) return -1;
  if (converged && r->sim.time < r->o->end)
    output_log(&r->out, "the bound masses have converged at step %ld, t = %.9g s", r->sim.step,
               r->sim.time);
  if (converged || r->sim.time >= r->o->end)
    return save(r, err) || output_wait(&r->out, err) ? -1 : 0;
  if (stop_signal || progress_clock() - r->began > r->o->max_wall) {
    if (save(r, err) || output_wait(&r->out, err)) return -1;
    output_log(&r->out, "stopped at step %ld, t = %.9g s: %s", r->sim.step, r->sim.time,
               stop_signal ? "signal" : "wall clock");
    return 3;
  }
  if (progress_clock() - r->saved > r->sim.par.checkpoint_every && save(r, err)) return -1;
  return 1;
}

/* The late stage has begun: what it does to the sound, and whether matter still moves faster. */
static int note_late(Run *r, Err *err)
{
  const Sim *sim = &r->sim;
  Sums s;
  double v2 = 0;
  if (sim_sums(&r->sim, &s, err)) return -1;
  for (int d = 0; d < 3; d++) v2 += s.momentum[d] * s.momentum[d];
  v2 = fmax(0, 2 * s.kinetic - v2 / s.mass) / s.mass;
  output_log(
      &r->out,
      "late stage from step %ld, t = %.9g s: sound speed %.4g m/s or less, rms velocity %.4g "
      "m/s%s",
      sim->step, sim->time, sim->late_speed, sqrt(v2),
      sqrt(v2) > sim->late_speed ? ": faster than sound, so too early or too soft" : "");
  return 0;
}

static int loop(Run *r, Err *err)
{
  SimStep done;
  int go = r->sim.time < r->o->end && !analysis_converged(&r->analysis, &r->sim.par);
  progress_start(&r->bar, "solver", 60);
  while (go == 1) {
    const int early = !r->sim.late;
    if (sim_advance(&r->sim, fmin(output_due(&r->out), r->o->end), &done, err))
      go = -1;
    else
      go = early && r->sim.late && note_late(r, err) ? -1 : look_around(r, &done, err);
  }
  progress_end(&r->bar);
  return go;
}

int run_system(const RunOptions *o, const Param *par, Parts *parts, Err *err)
{
  Run r;
  Parts *checkpoint = NULL;
  Err late;
  int rc, running = 0;
  memset(&r, 0, sizeof r);
  r.o = o, r.parts = parts, r.began = r.saved = progress_clock();
  if (o->restart && output_find_checkpoint(o->dir, &checkpoint, err)) return -1;
  if (vacant(o, err)) return -1;
  catch_signals();
  rc = checkpoint ? resume(&r, par, checkpoint, err) : fresh(&r, par, err);
  r.first_step = r.sim.step;
  if (rc == 0) rc = loop(&r, err), running = 1;
  if (output_wait(&r.out, &late)) {
    if (rc < 0)
      err_warn("%s", late.text);
    else
      *err = late, rc = -1;
  }
  if (r.sim.step > r.first_step)
    output_log(&r.out, "%.4g s of wall clock for %ld steps", progress_clock() - r.began,
               r.sim.step - r.first_step);
  if (rc < 0) output_log(&r.out, "failed: %s", err->text);
  if (rc < 0 && running && output_has_checkpoint(o->dir)) {
    size_t used = strlen(err->text);
    snprintf(err->text + used, sizeof err->text - used,
             "; the last good checkpoint is '%s/checkpoint.h5'", o->dir);
  }
  if (rc == 0) output_log(&r.out, "done at step %ld, t = %.9g s", r.sim.step, r.sim.time);
  if (rc >= 0 && r.out.most_outside > 0)
    err_warn("up to %.0f particles were outside the table of their equation of state: see run.log",
             r.out.most_outside);
  if (rc >= 0 && r.out.most_held[0] + r.out.most_held[1] > 0)
    err_warn(
        "up to %.0f particles had the smallest h allowed, %.0f the largest (smoothing.min, max): "
        "see conserved.tsv",
        r.out.most_held[0], r.out.most_held[1]);
  if (rc >= 0 && o->profile) profile_print(&r.sim, r.sim.step - r.first_step, stderr);
  analysis_close(&r.analysis);
  output_close(&r.out);
  sim_close(&r.sim);
  part_free(checkpoint);
  return rc;
}
