/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Time to go is extrapolated from the work done since the first call, so a resumed run is not taken
 * for a fast one. */
#include <stdio.h>
#include <sys/ioctl.h>
#include <time.h>
#include <unistd.h>
#include "err.h"
#include "progress.h"
#include "unit.h"

static const double REFRESH = 0.2; /* s, between updates on a terminal */

double progress_clock(void)
{
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

void progress_start(Progress *p, const char *what, double seconds)
{
  struct winsize size;
  *p = (Progress){.what = what, .first = -1, .terminal = isatty(STDERR_FILENO), .width = 80};
  p->started = p->shown = progress_clock();
  p->seconds = p->terminal ? REFRESH : seconds;
  if (p->terminal && !ioctl(STDERR_FILENO, TIOCGWINSZ, &size) && size.ws_col > 0)
    p->width = size.ws_col;
}

void progress_show(Progress *p, double done, const char *note)
{
  char line[512], togo[32];
  double now = progress_clock();
  int n;
  if (p->first < 0) p->first = done;
  if (now - p->shown < p->seconds) return;
  p->shown = now;
  n = snprintf(line, sizeof line, "%s: %s %.1f %%", err_name(), p->what, 100 * done);
  if (note[0] && n < (int)sizeof line)
    n += snprintf(line + n, sizeof line - (size_t)n, ", %s", note);
  if (done > p->first && n < (int)sizeof line) {
    double left = (now - p->started) * (1 - done) / (done - p->first);
    snprintf(line + n, sizeof line - (size_t)n, ", %s to go",
             unit_time_text(left, togo, sizeof togo));
  }
  if (p->terminal)
    fprintf(stderr, "\r%.*s\033[K", p->width - 1, line);
  else
    fprintf(stderr, "%s\n", line);
  fflush(stderr);
}

void progress_end(Progress *p)
{
  if (p->terminal) fputs("\r\033[K", stderr);
}
