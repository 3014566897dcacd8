/* SPDX-License-Identifier: GPL-3.0-or-later */
/* render: pictures of snapshots, without a display. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "colour.h"
#include "lib/opt.h"
#include "lib/snap.h"
#include "lib/unit.h"
#include "picture.h"

static Look look = {.extent = NAN, .lo = NAN, .hi = NAN};
static struct {
  const char *range, *size, *panels, *out;
  int bare;
} arg;

static const Opt opts[] = {
    {"view", 'v', OPT_CHOICE, "cut", "cut|slice|projection|surface",
     "bodies cut open, a slice, along the line of sight, uncut", &look.view},
    {"color", 'c', OPT_TEXT, "MaterialID", "FIELD",
     "what is shown: Damage, Velocities.x, |Velocities|, ColumnDensity ...", &look.field},
    {"range", 'r', OPT_TEXT, NULL, "LO:HI",
     "limits of the colours, either may be left out (default: what is seen)", &arg.range},
    {"log", 'l', OPT_FLAG, NULL, NULL, "logarithmic colours", &look.log},
    {"map", 'm', OPT_CHOICE, "viridis", COLOUR_MAPS, "colours", &look.map},
    {"plane", 'p', OPT_CHOICE, "xy", "xy|xz|yz", "seen from +z, -y, +x", &look.plane},
    {"centre", 'C', OPT_TEXT, "com", "POINT", "com, body:K, fragment:K, clump:K, or X,Y,Z",
     &look.centre},
    {"offset", 'O', OPT_REAL, "0", "m",
     "cutting plane this far from the centre, towards the viewer", &look.offset},
    {"extent", 'e', OPT_REAL, NULL, "m", "width of a panel (default: 99 % of the mass)",
     &look.extent},
    {"size", 's', OPT_TEXT, "1280x960", "WxH", "pixels of the whole picture", &arg.size},
    {"panels", 'P', OPT_TEXT, NULL, "COLSxROWS", "how several snapshots are arranged", &arg.panels},
    {"title", 't', OPT_TEXT, NULL, "TEXT", "written at the upper left", &look.title},
    {"no-time", 'T', OPT_FLAG, NULL, NULL, "no time stamp", &arg.bare},
    {"background", 'b', OPT_CHOICE, "black", "black|white", "behind the particles",
     &look.background},
    {"output", 'o', OPT_TEXT, "-", "FILE.png", "picture (default: stdout)", &arg.out},
    {0}};

static const OptProgram program = {
    .name = "render",
    .does = "draw snapshots as PNG",
    .usage = "[options] snapshot.h5 ... -o picture.png",
    .about = "Several snapshots become panels of one picture with common colours. FIELD is any "
             "dataset of the snapshots; of a "
             "vector or tensor the length, or one component after a dot. Fields that name kinds "
             "(MaterialID, BodyID, FragmentID, "
             "ClumpID ...) get a legend, numbers a colour bar.",
    .example = "render --color Damage --extent 2000km -o damage.png run/snap_0010.h5\n"
               "render --panels 3x2 -o series.png run/snap_00[0-5]0.h5",
    .opts = opts,
    .min_inputs = 0,
    .max_inputs = -1};

/* AxB, both within 1..most. */
static void two(const char *option, const char *text, int most, int *a, int *b)
{
  char more;
  if (sscanf(text, "%dx%d%c", a, b, &more) != 2 || *a < 1 || *b < 1 || *a > most || *b > most)
    err_usage("--%s: '%s' is not two numbers WxH from 1 to %d", option, text, most);
}

static void arrange(int inputs)
{
  if (arg.panels) {
    two("panels", arg.panels, 100, &look.columns, &look.rows);
    if (look.columns * look.rows < inputs)
      err_usage("--panels: %s has no room for %d snapshots", arg.panels, inputs);
    return;
  }
  look.columns = (int)ceil(sqrt(inputs));
  look.rows = (inputs + look.columns - 1) / look.columns;
}

/* One limit in the unit of the field, or nothing. */
static void limit(double *to, const char *text, const char *unit)
{
  Err err;
  if (*text && unit_parse(text, unit, to, &err)) err_usage("--range: %s", err.text);
}

static void read_range(const char *unit)
{
  char low[64];
  size_t n = arg.range ? strcspn(arg.range, ":") : 0;
  if (!arg.range) return;
  if (!arg.range[n] || n >= sizeof low) err_usage("--range: '%s' is not LO:HI", arg.range);
  memcpy(low, arg.range, n), low[n] = 0;
  limit(&look.lo, low, unit), limit(&look.hi, arg.range + n + 1, unit);
  if (look.hi <= look.lo) err_usage("--range: %s is empty", arg.range);
  if (look.log && look.lo <= 0) err_usage("--range: a logarithmic scale starts above 0");
}

static void check_arguments(void)
{
  two("size", arg.size, 16384, &look.w, &look.h);
  if (look.extent <= 0) err_usage("--extent must be positive");
  look.stamp = !arg.bare;
}

static void add(Picture *pic, const char *file)
{
  Err err;
  Parts *p = snap_read(file, &err);
  if (!p || part_need(p, "id x m rho h mat body", file, &err) || part_check(p, file, &err))
    err_die("%s", err.text);
  if (picture_add(pic, p, file, &err)) err_die("%s", err.text);
  part_free(p);
}

int main(int argc, char **argv)
{
  Err err;
  int inputs;
  char **input = opt_parse(&program, argc, argv, &inputs), *standard[] = {"-", NULL};
  if (inputs == 0) input = standard, inputs = 1;
  check_arguments(), arrange(inputs);
  Picture *pic = picture_new(&look, inputs, &err);
  if (!pic) err_die("%s", err.text);
  for (int k = 0; k < inputs; k++) add(pic, input[k]);
  if (pic->kinds && (arg.range || look.log))
    err_usage("--range and --log are for numbers, '%s' names kinds", look.field);
  read_range(pic->unit);
  Image *im = picture_paint(pic, &err);
  if (!im || image_write(im, arg.out, &err)) err_die("%s", err.text);
  image_free(im), picture_free(pic);
  return 0;
}
