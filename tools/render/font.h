/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Text from a built-in stroke font: smooth at every size, no font files. ASCII; `^` raises the
 * digits behind it, `*` is a multiplication sign. Sizes are the height of a capital letter in
 * pixels. */
#ifndef FONT_H
#define FONT_H

#include "image.h"

typedef enum { FONT_LEFT, FONT_CENTRE, FONT_RIGHT } FontAlign;

typedef struct {
  double size;     /* px */
  Rgb ink, halo;   /* the halo keeps text legible on a picture */
  FontAlign align; /* where x, y lies on the baseline */
  int up;          /* 1: written upwards */
} Font;

/* font_width: px. font_draw: baseline at x, y (px, may be fractions). */
double font_width(const char *text, double size);
void font_draw(Image *im, const Font *f, double x, double y, const char *text);

#endif
