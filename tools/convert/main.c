/* SPDX-License-Identifier: GPL-3.0-or-later */
/* convert: particle files from and to other programs; each format has a file of its own here. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "adopt.h"
#include "columns.h"
#include "lib/hdf.h"
#include "lib/opt.h"
#include "lib/snap.h"
#include "lib/unit.h"
#include "miluph.h"
#include "notes.h"
#include "show.h"
#include "sphlatch.h"
#include "swift.h"

#define FROM "auto|snapshot|miluph|miluph-input|miluph-output|sphlatch|swift"
#define TO   "snapshot|miluph|miluph-input|xdmf|h5part|vtu|csv"
enum { AUTO, SNAPSHOT, MILUPH, MILUPH_INPUT, MILUPH_OUTPUT, SPHLATCH, SWIFT };
enum { TO_SNAPSHOT, TO_MILUPH, TO_MILUPH_INPUT, TO_XDMF, TO_H5PART, TO_VTU, TO_CSV };

static struct {
  const char *from, *to, *out, *switches;
  OptList material, field;
  long second_body, step, dimension;
  double support, time;
  int quiet;
} o = {.second_body = -1, .step = -1, .support = NAN, .time = NAN};

/* clang-format off */
static const Opt OPTS[] = {
  {"from",        'f', OPT_CHOICE, "auto", FROM, "what the input is", &o.from},
  {"to",          't', OPT_CHOICE, NULL, TO, "what the output is (default: by the name of --output)", &o.to},
  {"output",      'o', OPT_TEXT, "-",  "FILE", "where it goes: .h5 .xdmf .h5part .vtu .csv", &o.out},
  {"field",       'F', OPT_LIST, NULL, "NAME", "only this field (xdmf h5part vtu csv)", &o.field},
  {"material",    'm', OPT_LIST, NULL, "NUMBER:NAME", "which material a number of the other code means", &o.material},
  {"second-body", 0,   OPT_INT,  NULL, "ID", "particles from this id on are body 1", &o.second_body},
  {"support",     0,   OPT_REAL, NULL, "1",  "radius at which the kernel vanishes, over the other code's h", &o.support},
  {"step",        0,   OPT_INT,  NULL, "N",  "step of a file with several (default: the last)", &o.step},
  {"dimension",   'd', OPT_INT,  "3",  "N",  "of rows of text", &o.dimension},
  {"switches",    0,   OPT_TEXT, NULL, "A,B=0", "miluphcuda's parameter.h, for rows of text", &o.switches},
  {"time",        0,   OPT_REAL, NULL, "s",  "time of a file that does not say it", &o.time},
  {"quiet",       'q', OPT_FLAG, NULL, NULL, "do not say what could not be carried over", &o.quiet},
  {NULL, 0, OPT_FLAG, NULL, NULL, NULL, NULL}};

static const OptProgram PROGRAM = {
  "convert", "particle files from and to other programs", "[options] -o OUTPUT FILE.h5 ...",
  "Reads snapshots, miluphcuda (HDF5, text), SPHLATCH (cgs, eV), SWIFT and WoMa; writes snapshots, miluphcuda (HDF5, text), and for "
  "others to look at XDMF, H5Part (both of a series), VTK and CSV. Everything is in SI afterwards, h is the radius at which the kernel "
  "vanishes. What could not be carried over is said on stderr.",
  "convert -m 0:basalt -m 1:ice -o impact.h5 impact.0042.h5\nconvert -o impact.xdmf run/snap_*.h5", OPTS, 0, -1};
/* clang-format on */

static int output_format(void)
{
  static const struct {
    const char *suffix;
    int format;
  } BY_NAME[] = {{".h5", TO_SNAPSHOT}, {".hdf5", TO_SNAPSHOT}, {".xdmf", TO_XDMF},
                 {".xmf", TO_XDMF},    {".h5part", TO_H5PART}, {".vtu", TO_VTU},
                 {".csv", TO_CSV}};
  Err err;
  if (o.to) return unit_choice(o.to, TO, &err);
  const char *dot = strrchr(o.out, '.');
  for (size_t k = 0; dot && k < sizeof BY_NAME / sizeof *BY_NAME; k++)
    if (!strcmp(dot, BY_NAME[k].suffix)) return BY_NAME[k].format;
  if (strcmp(o.out, "-")) err_usage("what should '%s' be? say --to", o.out);
  return TO_SNAPSHOT;
}

/* Which format an open file is; one of ours says its FormatVersion. */
static int detect(hid_t file)
{
  if (swift_is(file))
    return hdf_has(file, "Header") > 0 &&
                   H5Aexists_by_name(file, "Header", "FormatVersion", H5P_DEFAULT) > 0
               ? SNAPSHOT
               : SWIFT;
  return miluph_is(file) ? MILUPH : sphlatch_is(file) ? SPHLATCH : AUTO;
}

static Parts *read_hdf(const char *path, int *format, Err *err)
{
  Err why;
  Parts *p = NULL;
  hid_t file = hdf_open(path, &why);
  if (file < 0)
    return err_null(err, "cannot read '%s': %s%s", path, why.text,
                    *format == AUTO ? " (of text say --from)" : "");
  if (*format == AUTO) *format = detect(file);
  if (*format == MILUPH) p = miluph_read(file, &why);
  if (*format == SPHLATCH) p = sphlatch_read(file, o.step, &why);
  if (*format == SWIFT) p = swift_read(file, &why);
  H5Fclose(file);
  if (*format == SNAPSHOT) return snap_read(path, err);
  if (*format == AUTO)
    return err_null(err, "cannot read '%s': no format that is known here (%s)", path, FROM);
  return p ? p : err_null(err, "cannot read '%s': %s", path, why.text);
}

/* From the other code's smoothing length to where its kernel vanishes. */
static double support(int format)
{
  static const double FACTOR[] = {[SPHLATCH] = 2, [SWIFT] = 1.825742};
  if (!isnan(o.support)) return o.support;
  return format >= SPHLATCH ? FACTOR[format] : 1;
}

static Parts *read_input(const char *path, int *format, AdoptOptions *a, Err *err)
{
  int stream = !strcmp(path, "-");
  *format = unit_choice(o.from, FROM, err);
  if (stream && *format > SNAPSHOT) return err_null(err, "%s is read from a file only", o.from);
  if (stream) *format = SNAPSHOT;
  notes_about(path);
  Parts *p;
  if (*format == MILUPH_INPUT || *format == MILUPH_OUTPUT)
    p = columns_read(path, *format == MILUPH_INPUT ? COLUMNS_INPUT : COLUMNS_OUTPUT,
                     (int)o.dimension, o.switches, err);
  else
    p = stream ? snap_read(path, err) : read_hdf(path, format, err);
  if (p && !isnan(o.time)) p->time = o.time;
  if (!p || *format == SNAPSHOT) return p;
  *a = (AdoptOptions){&o.material, o.second_body, support(*format), *format == SWIFT};
  return adopt_rows(p, a, err);
}

static void say_points(const Parts *p)
{
  if (p->points) notes_say("not carried over: %d point masses", p->points);
}

static int write_particles(Parts *p, int to, const char *line, Err *err)
{
  if (to != TO_SNAPSHOT) say_points(p);
  if (to == TO_MILUPH) return miluph_write(p, o.out, err);
  if (to == TO_MILUPH_INPUT) return columns_write(p, o.out, o.switches, err);
  if (to == TO_SNAPSHOT) return part_history(p, line, err) || snap_write(p, o.out, 0, err);
  Sheet *s = sheet_new(p, &o.field, err);
  int rc = !s ? -1 : to == TO_CSV ? show_csv(p, s, o.out, err) : show_vtu(p, s, o.out, err);
  sheet_free(s);
  return rc;
}

/* A file with all inputs, one step each. */
static int write_series(char **input, int n, int to, Err *err)
{
  AdoptOptions a;
  ShowSeries *series = to == TO_XDMF ? show_xdmf_open(o.out, err) : show_h5part_open(o.out, err);
  int rc = series ? 0 : -1, format;
  for (int k = 0; k < n && !rc; k++) {
    Parts *p = read_input(input[k], &format, &a, err);
    Sheet *s = p ? sheet_new(p, &o.field, err) : NULL;
    if (s) say_points(p);
    if (!s)
      rc = -1;
    else if (to == TO_H5PART)
      rc = show_h5part_add(series, p, s, err);
    else if (format == SNAPSHOT && strcmp(input[k], "-"))
      rc = show_xdmf_add(series, p, s, input[k], err);
    else
      rc = err_set(err, "XDMF points into snapshots: make one of '%s' first", input[k]);
    sheet_free(s);
    part_free(p);
  }
  if (!series) return -1;
  int closed =
      to == TO_XDMF ? show_xdmf_close(series, !rc, err) : show_h5part_close(series, !rc, err);
  return rc ? rc : closed;
}

static void check_options(int to, int n)
{
  int shown = to == TO_XDMF || to == TO_H5PART || to == TO_VTU || to == TO_CSV;
  int text = to == TO_MILUPH_INPUT || !strncmp(o.from, "miluph-", 7);
  if (n > 1 && to != TO_XDMF && to != TO_H5PART)
    err_usage("%d inputs for one output: only xdmf and h5part hold a series", n);
  if (o.field.n && !shown) err_usage("--field is for xdmf, h5part, vtu and csv");
  if (o.material.n && to != TO_SNAPSHOT) err_usage("--material is for snapshots");
  if (o.switches && !text) err_usage("--switches is for miluph-input and miluph-output");
  if (o.dimension < 1 || o.dimension > 3)
    err_usage("--dimension: %ld is not 1, 2 or 3", o.dimension);
  if (o.support <= 0) err_usage("--support: %g is not positive", o.support);
  if (to == TO_XDMF && !strcmp(o.out, "-")) err_usage("xdmf needs a file, for --output");
}

int main(int argc, char **argv)
{
  Err err;
  int n, format;
  char *line = opt_command_line(argc, argv), *standard[] = {"-", NULL};
  char **input = opt_parse(&PROGRAM, argc, argv, &n);
  AdoptOptions a;
  if (!n) input = standard, n = 1;
  int to = output_format();
  check_options(to, n);
  if (o.quiet) notes_quiet();
  int rc;
  if (to == TO_XDMF || to == TO_H5PART) {
    rc = write_series(input, n, to, &err);
  } else {
    Parts *p = read_input(*input, &format, &a, &err);
    rc = !p || (to == TO_SNAPSHOT && format != SNAPSHOT && adopt_snapshot(p, &a, *input, &err)) ||
         write_particles(p, to, line, &err);
    part_free(p);
  }
  if (rc) err_die("%s", err.text);
  free(line), free(o.material.text), free(o.field.text);
  err_close_stdout();
  return 0;
}
