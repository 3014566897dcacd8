/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Progress of long work on stderr: percent, a note, time to go. A line rewritten in place on a
 * terminal; otherwise one plain line now and then (at most every `seconds`). */
#ifndef PROGRESS_H
#define PROGRESS_H

typedef struct {
  const char *what;
  double started, shown, seconds; /* wall clock s */
  double first;                   /* fraction that was done at the first call; < 0: none yet */
  int terminal, width;
} Progress;

/* progress_start: what is being done; seconds between plain lines (30 is a good value). */
void progress_start(Progress *p, const char *what, double seconds);

/* progress_show: done in 0..1; note may be "". Cheap enough to call every step. */
void progress_show(Progress *p, double done, const char *note);

/* progress_end: clears the line on a terminal. */
void progress_end(Progress *p);

/* progress_clock: wall-clock seconds, monotonic. */
double progress_clock(void);

#endif
