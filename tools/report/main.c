/* SPDX-License-Identifier: GPL-3.0-or-later */
/* report: one page about a run, for a browser without a network. */
#include <stdlib.h>
#include "lib/spool.h"
#include "page.h"

static PageAsk ask;
static const char *out;

static const Opt opts[] = {
    {"title", 't', OPT_TEXT, NULL, "TEXT", "of the page (default: the input)", &ask.title},
    {"picture", 'p', OPT_LIST, NULL, "FILE[:CAPTION]", "this picture or movie, not those of render",
     &ask.picture},
    {"table", 'T', OPT_LIST, NULL, "FILE[:CAPTION]", "this TSV, not those of fof and clumps",
     &ask.table},
    {"text", 'x', OPT_LIST, NULL, "FILE[:CAPTION]", "this text, as it is", &ask.text},
    {"frames", 'n', OPT_INT, "6", "N", "snapshots that are drawn, from the first to the last",
     &ask.frames},
    {"rows", 'r', OPT_INT, "20", "N", "of each table", &ask.rows},
    {"given-only", 'g', OPT_FLAG, NULL, NULL, "draw and search nothing", &ask.only},
    {"output", 'o', OPT_TEXT, "-", "FILE.html", "the page (default: stdout)", &out},
    {0}};

static const OptProgram program = {
    .name = "report",
    .does = "make one HTML page about a run, with everything in it",
    .usage = "[options] [run/ or snapshot.h5] > report.html",
    .about = "Of a run directory (snap_NNNN.h5, conserved.tsv, run.log) or a snapshot: numbers, "
             "pictures, curves, tables of fragments and bound bodies, settings, history, timing. "
             "render, fof, clumps and conserved make what is not given. Without an input the page "
             "has what is given. It needs no network and no other file.",
    .example = "report -o report.html run/\n"
               "report -t 'Ceres, 48 deg' -p cut.png:'The impact' -T fragments.tsv -x report.txt "
               "run/ > ceres.html",
    .opts = opts,
    .min_inputs = 0,
    .max_inputs = 1};

int main(int argc, char **argv)
{
  Err err;
  int inputs;
  char **input = opt_parse(&program, argc, argv, &inputs);
  if (inputs) ask.input = input[0];
  if (!inputs && !ask.picture.n && !ask.table.n && !ask.text.n)
    err_usage("a run directory, a snapshot, or something given is needed");
  if (ask.frames < 1 || ask.frames > 40) err_usage("--frames: from 1 to 40");
  if (ask.rows < 1) err_usage("--rows must be positive");
  char *page = page_write(&ask, &err);
  if (!page || spool_text(out, page, &err)) err_die("%s", err.text);
  free(page);
  return 0;
}
