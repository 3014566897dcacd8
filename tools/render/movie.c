/* SPDX-License-Identifier: GPL-3.0-or-later */
/* ffmpeg reads raw pixels from a pipe and writes to the temporary file; the odd row or column that
 * its coders do not take is left out. */
#include <errno.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>
#include "movie.h"

/* clang-format off */
static const struct {
  const char *end, *format;
  const char *coder[9]; /* options that choose and tune it */
} kinds[] = {
  {".mp4", "mp4", {"-c:v", "libx264", "-pix_fmt", "yuv420p", "-crf", "18", "-movflags", "+faststart"}},
  {".webm", "webm", {"-c:v", "libvpx-vp9", "-pix_fmt", "yuv420p", "-crf", "24", "-b:v", "0"}},
  {".gif", "gif", {"-filter_complex", "[0:v]split[a][b];[a]palettegen[p];[b][p]paletteuse"}}};
/* clang-format on */

static int kind_of(const char *path)
{
  size_t n = strlen(path);
  for (int k = 0; k < 3; k++) {
    size_t m = strlen(kinds[k].end);
    if (n > m && !strcmp(path + n - m, kinds[k].end)) return k;
  }
  return -1;
}

int movie_kind(const char *path) { return kind_of(path) >= 0; }

/* In the child. */
static _Noreturn void run(int input, const char *path, int kind, int w, int h, double rate)
{
  char size[32], per_second[32];
  const char *line[32] = {"ffmpeg",   "-v",    "error",    "-y", "-f",         "rawvideo",
                          "-pix_fmt", "rgb24", "-s",       size, "-framerate", per_second,
                          "-i",       "-",     "-threads", "2"};
  int n = 16;
  snprintf(size, sizeof size, "%dx%d", w, h);
  snprintf(per_second, sizeof per_second, "%.6g", rate);
  for (int k = 0; kinds[kind].coder[k]; k++) line[n++] = kinds[kind].coder[k];
  line[n++] = "-f", line[n++] = kinds[kind].format, line[n++] = path, line[n] = NULL;
  signal(SIGPIPE, SIG_DFL);
  dup2(input, 0), close(input);
  execvp(line[0], (char *const *)line);
  _exit(errno == ENOENT ? 127 : 126);
}

int movie_open(Movie *m, const char *path, int w, int h, double rate, Err *err)
{
  int ends[2], kind = kind_of(path);
  *m = (Movie){.w = w & ~1, .h = h & ~1};
  if (spool_out(&m->spool, path, 1, err)) return -1;
  fflush(NULL);
  pid_t pid = pipe(ends) ? -1 : fork();
  if (pid < 0) {
    spool_abort(&m->spool);
    return err_set(err, "cannot start ffmpeg: %s", strerror(errno));
  }
  if (pid == 0) close(ends[1]), run(ends[0], m->spool.path, kind, m->w, m->h, rate);
  close(ends[0]);
  signal(SIGPIPE, SIG_IGN);
  m->pid = pid, m->pipe = fdopen(ends[1], "wb");
  return 0;
}

/* What ffmpeg ended with; it has printed its own reason. */
static int ended(Movie *m, Err *err)
{
  int status = 0;
  if (m->pipe) fclose(m->pipe);
  m->pipe = NULL;
  if (m->pid > 0) waitpid((pid_t)m->pid, &status, 0);
  m->pid = 0;
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return 0;
  if (WIFEXITED(status) && WEXITSTATUS(status) == 127)
    return err_set(err,
                   "a movie needs ffmpeg, which is not there (Debian: apt-get install ffmpeg)");
  return err_set(err, "ffmpeg could not write '%s'", m->spool.final);
}

int movie_frame(Movie *m, const Image *im, Err *err)
{
  size_t row = (size_t)m->w * sizeof *im->px;
  int failed = !m->pipe;
  for (int y = 0; y < m->h && !failed; y++)
    failed = fwrite(im->px + (long)y * im->w, 1, row, m->pipe) != row;
  if (!failed && !fflush(m->pipe)) return 0;
  if (!ended(m, err)) err_set(err, "ffmpeg stopped reading");
  spool_abort(&m->spool);
  return -1;
}

int movie_close(Movie *m, Err *err)
{
  if (!ended(m, err)) return spool_commit(&m->spool, err);
  spool_abort(&m->spool);
  return -1;
}

void movie_abort(Movie *m)
{
  ended(m, NULL);
  spool_abort(&m->spool);
}
