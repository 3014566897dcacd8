/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Curves as PNG, by gnuplot: a program writes a script with its data in it, this module says how
 * curves look, runs gnuplot and puts the picture in its place when it is whole. */
#ifndef PLOT_H
#define PLOT_H

#include <stdio.h>
#include "spool.h"

typedef struct {
  FILE *script; /* to write to between open and close; data as `$name << EOD` */
  char *text;
  size_t size;
  Spool out;
} Plot;

/* plot_open: a picture of width x height pixels at path ("-": stdout). Line types 1 to 8 have
 * colours that can be told apart. plot_close: runs gnuplot. Errors: it is not there, its
 * own message. plot_text: a string as gnuplot shows it, quoted, without its markup. */
int plot_open(Plot *p, const char *path, int width, int height, Err *err);
int plot_close(Plot *p, Err *err);
void plot_text(Plot *p, const char *text);

#endif
