/* SPDX-License-Identifier: GPL-3.0-or-later */
/* render: pictures and movies of snapshots, without a display. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "colour.h"
#include "lib/opt.h"
#include "lib/pick.h"
#include "lib/unit.h"
#include "movie.h"
#include "picture.h"

static Look look = {.extent = NAN, .perspective = NAN};
static struct {
  OptList field, label, range;
  const char *size, *panels, *plane, *from, *cut, *select, *out;
  double rate;
  int bare;
} arg = {.rate = NAN};

static const Opt opts[] = {
    {"view", 'v', OPT_CHOICE, "cut", "cut|slice|projection|surface",
     "bodies cut open, a slice, along the line of sight, uncut", &look.view},
    {"color", 'c', OPT_LIST, NULL, "WHAT", "what is shown [MaterialID]", &arg.field},
    {"label", 'L', OPT_LIST, NULL, "TEXT", "of a colour bar", &arg.label},
    {"range", 'r', OPT_LIST, NULL, "LO:HI", "of the colours", &arg.range},
    {"log", 'l', OPT_FLAG, NULL, NULL, "logarithmic colours", &look.log},
    {"map", 'm', OPT_CHOICE, "viridis", COLOUR_MAPS, "colours", &look.map},
    {"select", 'S', OPT_TEXT, NULL, "WHAT", "only particles for which this holds", &arg.select},
    {"plane", 'p', OPT_CHOICE, "xy", "xy|xz|yz", "seen from +z, -y, +x", &arg.plane},
    {"from", 'f', OPT_TEXT, NULL, "AZ,EL[,ROLL]", "seen from there, as -90deg,90deg is --plane xy",
     &arg.from},
    {"perspective", 'F', OPT_REAL, NULL, "rad", "of an eye that sees this angle across",
     &look.perspective},
    {"centre", 'C', OPT_TEXT, "com", "POINT", "com, body:K, fragment:K, clump:K, or X,Y,Z",
     &look.centre},
    {"offset", 'O', OPT_REAL, "0", "m", "of the cut from the centre, to the viewer", &look.offset},
    {"cut-away", 'a', OPT_TEXT, NULL, "SIDES", "a wedge or octant: x,-y is x > 0 and y < 0",
     &arg.cut},
    {"extent", 'e', OPT_REAL, NULL, "m", "width of a panel (default: 99 % of the mass)",
     &look.extent},
    {"size", 's', OPT_TEXT, "1280x960", "WxH", "pixels of the whole picture", &arg.size},
    {"panels", 'P', OPT_TEXT, NULL, "COLSxROWS", "how panels are arranged", &arg.panels},
    {"title", 't', OPT_TEXT, NULL, "TEXT", "written at the upper left", &look.title},
    {"no-time", 'T', OPT_FLAG, NULL, NULL, "no time stamp", &arg.bare},
    {"background", 'b', OPT_CHOICE, "black", "black|white", "behind the particles",
     &look.background},
    {"movie", 'M', OPT_REAL, NULL, "Hz", "snapshots are frames, so many a second", &arg.rate},
    {"output", 'o', OPT_TEXT, "-", "FILE", ".png; a movie's .mp4, .webm, .gif", &arg.out},
    {0}};

static const OptProgram program = {
    .name = "render",
    .does = "draw snapshots as PNG, or as a movie",
    .usage = "[options] snapshot.h5 ... -o picture.png",
    .about = "One panel a snapshot and WHAT: a field, ColumnDensity, or an expression "
             "(Velocities.x/SoundSpeed). The k-th --range goes with the k-th --color.",
    .example = "render -c Damage -c 'log10(Density)' -e 2000km -o two.png run/snap_0010.h5\n"
               "render -f 30deg,20deg -a x,y -o open.png run/snap_0000.h5",
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

/* As square as it gets; several fields of several snapshots: one row a snapshot. */
static void arrange(int files)
{
  int panels = files * look.fields;
  if (arg.panels) {
    two("panels", arg.panels, 100, &look.columns, &look.rows);
    if (look.columns * look.rows < panels)
      err_usage("--panels: %s has no room for %d %s", arg.panels, panels,
                look.fields == 1 ? "snapshots" : "panels");
    return;
  }
  look.columns = files > 1 && look.fields > 1 ? look.fields : (int)ceil(sqrt(panels));
  look.rows = (panels + look.columns - 1) / look.columns;
}

/* One limit in the unit of the field, or nothing. */
static void limit(double *to, const char *text, const char *unit)
{
  Err err;
  double factor;
  int power[UNIT_BASES];
  if (unit_powers(unit, &factor, power, NULL)) unit = "1"; /* no unit that we know */
  if (*text && unit_parse(text, unit, to, &err)) err_usage("--range: %s", err.text);
}

static void read_range(int k, const char *text, const char *unit)
{
  char low[64];
  size_t n = strcspn(text, ":");
  if (!text[n] || n >= sizeof low) err_usage("--range: '%s' is not LO:HI", text);
  memcpy(low, text, n), low[n] = 0;
  limit(&look.lo[k], low, unit), limit(&look.hi[k], text + n + 1, unit);
  if (look.hi[k] <= look.lo[k]) err_usage("--range: %s is empty", text);
  if (look.log && look.lo[k] <= 0) err_usage("--range: a logarithmic scale starts above 0");
}

/* Once the units are known. */
static void read_ranges(const Picture *pic)
{
  int numbers = 0;
  for (int k = 0; k < look.fields; k++) {
    const Layer *layer = &pic->layer[k];
    const char *text = k < arg.range.n ? arg.range.text[k] : ":";
    numbers |= !layer->kinds;
    if (layer->kinds && (strcmp(text, ":") || (look.log && look.fields == 1)))
      err_usage("--range and --log are for numbers, '%s' names kinds", layer->name);
    if (!layer->kinds) read_range(k, text, layer->unit);
  }
  if (look.log && !numbers) err_usage("--log is for numbers, all fields name kinds");
}

static void check_expression(const char *option, const char *text)
{
  Err err;
  Expr *e = expr_parse(text, &err);
  if (!e) err_usage("--%s: %s", option, err.text);
  expr_free(e);
}

static void check_fields(void)
{
  static const char *standard[] = {"MaterialID"};
  if (!arg.field.n) arg.field = (OptList){standard, 1};
  look.fields = arg.field.n;
  if (look.fields > PICTURE_FIELDS) err_usage("--color: more than %d", PICTURE_FIELDS);
  if (arg.range.n > look.fields || arg.label.n > look.fields)
    err_usage("--%s: more than there are of --color",
              arg.range.n > look.fields ? "range" : "label");
  for (int k = 0; k < look.fields; k++) {
    look.field[k] = arg.field.text[k], look.label[k] = k < arg.label.n ? arg.label.text[k] : NULL;
    look.lo[k] = look.hi[k] = NAN;
    check_expression("color", look.field[k]);
  }
  if (arg.select) check_expression("select", arg.select);
}

static void check_camera(void)
{
  Err err;
  Camera c;
  if (arg.from && opt_given(&program, "plane")) err_usage("--plane and --from exclude each other");
  if (arg.from) {
    int commas = 0;
    for (const char *s = arg.from; *s; s++) commas += *s == ',';
    if (unit_list(arg.from, "rad", commas == 2 ? 3 : 2, look.turn, &err))
      err_usage("--from: %s", err.text);
  } else {
    look.turn[0] = strcmp(arg.plane, "yz") ? -acos(0) : 0;
    look.turn[1] = strcmp(arg.plane, "xy") ? 0 : acos(0);
  }
  if (look.perspective <= 0 || look.perspective > 2.5) /* 143 degrees */
    err_usage("--perspective: from 0 to 143 degrees");
  if (!isnan(look.perspective) && !strcmp(look.view, "slice"))
    err_usage("--perspective: a slice is flat");
  if (look.offset != 0 && strcmp(look.view, "slice") && (arg.cut || strcmp(look.view, "cut")))
    err_usage("--offset is for --view slice and the plane of --view cut");
  for (const char *s = arg.cut; s; s = strchr(s, ',') ? strchr(s, ',') + 1 : NULL) {
    int minus = *s == '-', axis = s[minus] - 'x', k = look.cut.planes;
    if (axis < 0 || axis > 2 || (s[minus + 1] && s[minus + 1] != ',') || k == CUT_PLANES)
      err_usage("--cut-away: '%s' is not up to three of x, y, z, -x, -y, -z", arg.cut);
    look.cut.normal[k][axis] = minus ? -1 : 1, look.cut.planes++;
    camera_turn(&c, look.turn[0], look.turn[1], look.turn[2]);
    if (c.axis[2][axis] * (minus ? -1 : 1) < 0.02)
      err_usage("--cut-away: side '%.*s' faces away from the viewer of --from", minus + 1, s);
  }
  if (arg.cut && strcmp(look.view, "cut")) err_usage("--cut-away is for --view cut");
}

static void check_arguments(int files)
{
  two("size", arg.size, 16384, &look.w, &look.h);
  if (look.extent <= 0) err_usage("--extent must be positive");
  look.stamp = !arg.bare;
  check_fields(), check_camera();
  if (arg.rate <= 0) err_usage("--movie: so many frames a second must be positive");
  if (!isnan(arg.rate) && !movie_kind(arg.out))
    err_usage("--movie: --output must end in " MOVIE_KINDS);
  if (isnan(arg.rate) && movie_kind(arg.out)) err_usage("'%s' needs --movie", arg.out);
  arrange(isnan(arg.rate) ? files : 1);
}

/* Only the fields that are asked for. */
static Parts *get(const char *file)
{
  Err err;
  Parts *p = pick_read(file, look.field, look.fields, arg.select,
                       strchr(look.centre, ':') ? "frag clump" : "", &err);
  if (!p) err_die("%s", err.text);
  return p;
}

static void add(Picture *pic, const char *file)
{
  Err err;
  Parts *p = get(file);
  if (picture_add(pic, p, file, &err)) err_die("%s", err.text);
  part_free(p);
}

static Picture *picture_of(char **file, int files)
{
  Err err;
  Picture *pic = picture_new(&look, files, &err);
  if (!pic) err_die("%s", err.text);
  for (int k = 0; k < files; k++) add(pic, file[k]);
  return pic;
}

/* Colours and extent for all frames: what is not given follows from all that is seen, the extent
 * from the first. */
static void common_look(char **file, int files)
{
  double lo[PICTURE_FIELDS], hi[PICTURE_FIELDS], a, b;
  Err err;
  int open = 0;
  for (int f = 0; f < files && (f == 0 || open); f++) {
    Picture *pic = picture_of(file + f, 1);
    if (f == 0) read_ranges(pic), look.extent = pic->panel[0].extent;
    for (int k = 0; k < look.fields; k++) {
      if (pic->layer[k].kinds) continue;
      if (picture_limits(pic, k, &a, &b, &err)) err_die("'%s': %s", file[f], err.text);
      lo[k] = f ? fmin(lo[k], a) : a, hi[k] = f ? fmax(hi[k], b) : b;
      open |= isnan(look.lo[k]) || isnan(look.hi[k]);
    }
    picture_free(pic);
    for (int k = 0; k < look.fields && (f == files - 1 || !open); k++)
      look.lo[k] = lo[k], look.hi[k] = hi[k];
  }
}

static Movie movie;

/* Whatever ends the program leaves no part of a movie. */
static void stop(void)
{
  if (movie.pid) movie_abort(&movie);
}

static void film(char **file, int files)
{
  Err err;
  atexit(stop);
  if (movie_open(&movie, arg.out, look.w, look.h, arg.rate, &err)) err_die("%s", err.text);
  common_look(file, files);
  for (int f = 0; f < files; f++) {
    Picture *pic = picture_of(file + f, 1);
    Image *im = picture_paint(pic, &err);
    if (!im || movie_frame(&movie, im, &err)) err_die("%s", err.text);
    image_free(im), picture_free(pic);
  }
  if (movie_close(&movie, &err)) err_die("%s", err.text);
}

int main(int argc, char **argv)
{
  Err err;
  int inputs;
  char **input = opt_parse(&program, argc, argv, &inputs), *standard[] = {"-", NULL};
  if (inputs == 0) input = standard, inputs = 1;
  check_arguments(inputs);
  if (!isnan(arg.rate)) {
    film(input, inputs);
    return 0;
  }
  Picture *pic = picture_of(input, inputs);
  read_ranges(pic);
  Image *im = picture_paint(pic, &err);
  if (!im || image_write(im, arg.out, &err)) err_die("%s", err.text);
  image_free(im), picture_free(pic);
  return 0;
}
