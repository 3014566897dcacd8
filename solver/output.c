/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The files of a run directory. */
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include "../lib/snap.h"
#include "../lib/spool.h"
#include "output.h"

static const char HEADER[] = "# "
                             "step\ttime[s]\tdt[s]\tlimit\tparticle\tE_kinetic[J]\tE_internal[J]"
                             "\tE_potential[J]\tE_total[J]\tp_x[kg*m/s]\tp_y[kg*m/s]\t"
                             "p_z[kg*m/s]\tL_x[kg*m^2/s]\tL_y[kg*m^2/s]\tL_z[kg*m^2/"
                             "s]\tsum_mv[kg*m/s]\tsum_mrv[kg*m^2/s]\tmass[kg]\tx[m]\ty[m]\tz[m]"
                             "\tparticles\tm_gone[kg]\tE_gone[J]\tp_gone_x[kg*m/s]"
                             "\tp_gone_y[kg*m/s]\tp_gone_z[kg*m/s]\tL_gone_x[kg*m^2/s]"
                             "\tL_gone_y[kg*m^2/s]\tL_gone_z[kg*m^2/s]"
                             "\th_at_min\th_at_max"
                             "\tE_floor[J]\tat_energy_floor\tat_density_floor\tat_pressure_floor\n";

static void name_of(const char *dir, const char *name, char *path, size_t size)
{
  snprintf(path, size, "%s/%s", dir, name);
}

int output_claim(Output *o, const char *dir, Err *err)
{
  struct flock lock = {.l_type = F_WRLCK, .l_whence = SEEK_SET}; /* all of it */
  char path[4096];
  memset(o, 0, sizeof *o);
  snprintf(o->dir, sizeof o->dir, "%s", dir);
  if (mkdir(dir, 0777) && errno != EEXIST)
    return err_set(err, "cannot make '%s': %s", dir, strerror(errno));
  name_of(dir, "run.log", path, sizeof path);
  if (!(o->log = fopen(path, "a")))
    return err_set(err, "cannot write '%s': %s", path, strerror(errno));
  if (!fcntl(fileno(o->log), F_SETLK, &lock)) return 0;
  if (errno == EACCES || errno == EAGAIN) {
    output_close(o);
    return err_set(err, "another solver is at work in '%s'", dir);
  }
  err_warn("cannot lock '%s': %s: a second solver would not be kept out", path, strerror(errno));
  return 0;
}

/* Keeps the header and the lines up to `step`. */
static int truncate_table(const char *path, const char *header, long step, Err *err)
{
  FILE *f = fopen(path, "r");
  char *text, *line = NULL;
  size_t room = 0, used = 0, all = 1 << 16;
  ssize_t n;
  int rc;
  if (!f) return spool_text(path, header, err);
  text = malloc(all);
  while (text && (n = getline(&line, &room, f)) > 0) {
    if (line[n - 1] != '\n' || (line[0] != '#' && atol(line) > step)) break;
    while (used + (size_t)n + 1 > all && text) text = realloc(text, all *= 2);
    if (text) memcpy(text + used, line, (size_t)n + 1);
    used += (size_t)n;
  }
  fclose(f);
  free(line);
  if (!text) return err_set(err, "not enough memory");
  rc = spool_text(path, used ? text : header, err);
  free(text);
  return rc;
}

int output_table(const Output *o, const char *name, const char *header, long step, FILE **table,
                 Err *err)
{
  char path[4096];
  name_of(o->dir, name, path, sizeof path);
  if (step < 0 ? spool_text(path, header, err) : truncate_table(path, header, step, err)) return -1;
  if ((*table = fopen(path, "a+"))) return 0;
  return err_set(err, "cannot write '%s': %s", path, strerror(errno));
}

int output_open(Output *o, double start, double every, double end, Err *err)
{
  o->start = start, o->every = every, o->end = end;
  return output_table(o, "conserved.tsv", HEADER, -1, &o->conserved, err);
}

int output_resume(Output *o, double start, double every, double end, const Sim *sim, Err *err)
{
  o->start = start, o->every = every, o->end = end;
  while (output_due(o) <= sim->time && output_due(o) < end) o->next++;
  if (sim->time >= end) o->next++;
  if (archive_resume(&o->archive, o->dir, sim->step, err)) return -1;
  return output_table(o, "conserved.tsv", HEADER, sim->step, &o->conserved, err);
}

void output_close(Output *o)
{
  archive_free(&o->archive);
  if (o->conserved) fclose(o->conserved);
  if (o->log) fclose(o->log);
  o->conserved = o->log = NULL;
}

double output_due(const Output *o)
{
  double t = o->start + (double)o->next * o->every;
  return t < o->end ? t : o->end;
}

/* A line in the log when the particles outside their tables are others than at the last look. */
static void note_outside(Output *o, const Sim *sim, const double outside[3])
{
  if (!memcmp(o->outside, outside, sizeof o->outside)) return;
  memcpy(o->outside, outside, sizeof o->outside);
  o->most_outside = fmax(o->most_outside, fmax(outside[0], outside[1] + outside[2]));
  output_log(
      o,
      "step %ld, t = %.9g s: outside their table of the equation of state are %.0f particles "
      "in density, %.0f in energy above, %.0f below",
      sim->step, sim->time, outside[0], outside[1], outside[2]);
}

/* A line in the log when the first particles have the smallest or largest h that is allowed. */
static void note_held(Output *o, const Sim *sim, int end, double held)
{
  if (held > 0 && o->most_held[end] == 0)
    output_log(o, "step %ld, t = %.9g s: %.0f particles have the %s h allowed, smoothing.%s",
               sim->step, sim->time, held, end ? "largest" : "smallest", end ? "max" : "min");
  o->most_held[end] = fmax(o->most_held[end], held);
}

int output_conserved(Output *o, Sim *sim, const SimStep *done, Sums *sums, Err *err)
{
  if (sim_sums(sim, sums, err)) return -1;
  const Sums s = *sums;
  note_outside(o, sim, s.outside);
  fprintf(o->conserved, "%ld\t%.9g\t%.6g\t%s\t%lld\t%.12g\t%.12g\t%.12g\t%.12g", sim->step,
          sim->time, done ? done->dt : 0, done ? sim_limit_name(done->limit) : "start",
          done ? (long long)done->id : -1LL, s.kinetic, s.internal, s.potential,
          s.kinetic + s.internal + s.potential);
  for (int d = 0; d < 3; d++) fprintf(o->conserved, "\t%.9g", s.momentum[d]);
  for (int d = 0; d < 3; d++) fprintf(o->conserved, "\t%.12g", s.angular[d]);
  fprintf(o->conserved, "\t%.9g\t%.9g\t%.15g", s.scale_momentum, s.scale_angular, s.mass);
  for (int d = 0; d < 3; d++) fprintf(o->conserved, "\t%.9g", s.centre[d]);
  fprintf(o->conserved, "\t%ld\t%.15g\t%.12g", sim->s.n, sim->gone.mass, sim->gone.energy);
  for (int d = 0; d < 3; d++) fprintf(o->conserved, "\t%.12g", sim->gone.momentum[d]);
  for (int d = 0; d < 3; d++) fprintf(o->conserved, "\t%.12g", sim->gone.angular[d]);
  fprintf(o->conserved, "\t%.0f\t%.0f\t%.9g", s.held[0], s.held[1], s.lifted);
  for (int d = 0; d < 3; d++) fprintf(o->conserved, "\t%.0f", s.at_floor[d]);
  fputc('\n', o->conserved);
  for (int d = 0; d < 2; d++) note_held(o, sim, d, s.held[d]);
  if (fflush(o->conserved))
    return err_set(err, "cannot write '%s/conserved.tsv': %s", o->dir, strerror(errno));
  return 0;
}

static int write_series(const Output *o, Err *err)
{
  long n = o->index + 1;
  char *names = malloc((size_t)n * 32);
  const char **files = malloc((size_t)n * sizeof *files);
  double *times = malloc((size_t)n * sizeof *times);
  int rc = -1;
  if (names && files && times) {
    for (long k = 0; k < n; k++) {
      snprintf(names + 32 * k, 32, "snap_%04ld.h5", k);
      files[k] = names + 32 * k;
      times[k] = k == o->index ? o->time : o->start + (double)k * o->every;
    }
    rc = snap_series(o->dir, files, times, (int)n, err);
  } else
    err_set(err, "not enough memory");
  free(names), free(files), free(times);
  return rc;
}

/* The writer's part of a snapshot. */
static int write_snapshot(void *data, Err *err)
{
  Output *o = data;
  char path[4096], name[32];
  snprintf(name, sizeof name, "snap_%04ld.h5", o->index);
  name_of(o->dir, name, path, sizeof path);
  if (o->sim->b->fetch(o->sim, o->parts, err) ||
      archive_write(&o->archive, o->dir, o->parts, err) || snap_write(o->parts, path, 0, err) ||
      write_series(o, err))
    return -1;
  output_log(o, "%s at step %ld, t = %.9g s", name, o->step, o->time);
  return 0;
}

/* And of a checkpoint. */
static int write_checkpoint(void *data, Err *err)
{
  Output *o = data;
  char path[4096], before[4096], fresh[4096];
  name_of(o->dir, "checkpoint.h5", path, sizeof path);
  name_of(o->dir, "checkpoint_prev.h5", before, sizeof before);
  name_of(o->dir, "checkpoint_new.h5", fresh, sizeof fresh);
  if (o->sim->b->fetch(o->sim, o->parts, err) ||
      archive_write(&o->archive, o->dir, o->parts, err) || snap_write(o->parts, fresh, 1, err))
    return -1;
  if (rename(path, before) && errno != ENOENT)
    return err_set(err, "cannot rename '%s': %s", path, strerror(errno));
  if (rename(fresh, path)) return err_set(err, "cannot rename '%s': %s", fresh, strerror(errno));
  return 0;
}

/* Hands the present state to the writer. */
static int begin(Output *o, Sim *sim, Parts *parts, int (*job)(void *data, Err *err), Err *err)
{
  if (writer_wait(&o->writer, err) || sim_send(sim, parts, err)) return -1;
  o->sim = sim, o->parts = parts, o->index = o->next, o->step = sim->step, o->time = sim->time;
  return writer_start(&o->writer, job, o, err);
}

int output_snapshot(Output *o, Sim *sim, Parts *parts, Err *err)
{
  if (begin(o, sim, parts, write_snapshot, err)) return -1;
  o->next++;
  return 0;
}

int output_checkpoint(Output *o, Sim *sim, Parts *parts, Err *err)
{
  return begin(o, sim, parts, write_checkpoint, err);
}

int output_look(Output *o, Err *err) { return writer_look(&o->writer, err); }
int output_wait(Output *o, Err *err) { return writer_wait(&o->writer, err); }

int output_find_checkpoint(const char *dir, Parts **found, Err *err)
{
  static const char *const names[] = {"checkpoint.h5", "checkpoint_prev.h5"};
  char path[4096];
  int there = 0;
  *found = NULL;
  for (int k = 0; k < 2; k++) {
    name_of(dir, names[k], path, sizeof path);
    if (access(path, F_OK)) continue;
    there = 1;
    if ((*found = snap_read(path, err))) return 0;
    err_warn("%s", err->text);
  }
  return there ? -1 : 0;
}

int output_has_checkpoint(const char *dir)
{
  char path[4096];
  name_of(dir, "checkpoint.h5", path, sizeof path);
  return access(path, F_OK) == 0;
}

int output_in_use(const char *dir)
{
  char path[4096];
  name_of(dir, "snap_0000.h5", path, sizeof path);
  return output_has_checkpoint(dir) || access(path, F_OK) == 0;
}

void output_log(Output *o, const char *format, ...)
{
  va_list args;
  if (!o->log) return;
  va_start(args, format);
  vfprintf(o->log, format, args);
  va_end(args);
  fputc('\n', o->log);
  fflush(o->log);
}
