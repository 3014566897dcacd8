/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parts that a page is made of. All text is escaped, everything lies in the one file. */
#ifndef HTML_H
#define HTML_H

#include <stdio.h>
#include "lib/err.h"

/* html_begin: head, style and title. html_end: foot. */
void html_begin(FILE *f, const char *title, const char *subtitle);
void html_end(FILE *f, const char *foot);

/* html_section: a heading; id: for links to it. */
void html_section(FILE *f, const char *id, const char *title);

/* html_text: escaped. html_pre: a whole text as it is, folded away under `fold` unless NULL. */
void html_text(FILE *f, const char *text);
void html_pre(FILE *f, const char *text, const char *fold);

/* html_picture: a PNG, SVG, JPEG, GIF, MP4 or WebM with a caption. Errors: the file cannot be read,
 * or is none of these. */
int html_picture(FILE *f, const char *path, const char *caption, Err *err);

/* html_table: a TSV: its caption, the comments above it, `rows` rows of the first `columns`
 * columns; all of the columns folded away behind it. */
int html_table(FILE *f, const char *path, const char *caption, long rows, int columns, Err *err);

/* html_pair: a row of a two-column list between html_pairs(f, 1) and html_pairs(f, 0). */
void html_pairs(FILE *f, int open);
void html_pair(FILE *f, const char *name, const char *value);

#endif
