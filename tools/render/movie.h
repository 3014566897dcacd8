/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Frames to a movie, by ffmpeg. */
#ifndef MOVIE_H
#define MOVIE_H

#include <stdio.h>
#include "image.h"
#include "lib/spool.h"

#define MOVIE_KINDS ".mp4 (H.264), .webm (VP9) or .gif"

typedef struct {
  Spool spool;
  FILE *pipe;
  long pid;
  int w, h; /* even: what the coders take */
} Movie;

/* movie_kind: whether the name of a file ends as one of MOVIE_KINDS. */
int movie_kind(const char *path);

/* movie_open: starts ffmpeg for frames of w x h pixels, so many a second; errors: it is not there,
 * the folder cannot be written. movie_frame adds one; movie_close waits until the movie is whole,
 * and only then it appears under its name. A failure leaves nothing behind; movie_abort, too. */
int movie_open(Movie *m, const char *path, int w, int h, double rate, Err *err);
int movie_frame(Movie *m, const Image *im, Err *err);
int movie_close(Movie *m, Err *err);
void movie_abort(Movie *m);

#endif
