/* SPDX-License-Identifier: GPL-3.0-or-later */
/* gnuplot reads the script from an unlinked file, and its messages are caught in another. */
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>
#include "plot.h"

/* Colours: Okabe & Ito (2008), told apart by the colour-blind. */
static const char STYLE[] =
    "set encoding utf8\n"
    "set linetype 1 lc rgb '#0072b2' lw 2 pt 7\nset linetype 2 lc rgb '#d55e00' lw 2 pt 5\n"
    "set linetype 3 lc rgb '#009e73' lw 2 pt 9\nset linetype 4 lc rgb '#000000' lw 2 pt 13\n"
    "set linetype 5 lc rgb '#cc79a7' lw 2 pt 11\nset linetype 6 lc rgb '#e69f00' lw 2 pt 6\n"
    "set linetype 7 lc rgb '#56b4e9' lw 2 pt 4\nset linetype 8 lc rgb '#999999' lw 2 pt 8\n"
    "set linetype cycle 8\n"
    "set grid lc rgb '#dddddd' lw 1 lt 1\nset border lc rgb '#444444'\n"
    "set tics textcolor rgb '#222222' nomirror\nset key outside right top samplen 2 noenhanced\n";

int plot_open(Plot *p, const char *path, int width, int height, Err *err)
{
  *p = (Plot){0};
  if (spool_out(&p->out, path, 1, err)) return -1;
  if (!(p->script = open_memstream(&p->text, &p->size))) {
    spool_abort(&p->out);
    return err_set(err, "out of memory for a picture");
  }
  fprintf(p->script, "set terminal pngcairo size %d,%d font 'Sans,11'\nset output ", width, height);
  plot_text(p, p->out.path);
  fprintf(p->script, "\n%s", STYLE);
  return 0;
}

void plot_text(Plot *p, const char *text)
{
  fputc('\'', p->script);
  for (; *text; text++) {
    if (*text == '\'') fputc('\'', p->script); /* '' is one */
    if (*text != '\n') fputc(*text, p->script);
  }
  fputc('\'', p->script);
}

static int run(FILE *in, FILE *messages)
{
  int status = 0;
  const pid_t child = fork();
  if (child < 0) return -1;
  if (!child) {
    const int said = fileno(messages);
    if (dup2(fileno(in), 0) < 0 || dup2(said, 1) < 0 || dup2(said, 2) < 0) _exit(126);
    execlp("gnuplot", "gnuplot", "-", (char *)NULL);
    _exit(127);
  }
  while (waitpid(child, &status, 0) < 0) continue;
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/* The last line that says something. */
static void last_words(FILE *messages, char *text, int size)
{
  char line[512];
  snprintf(text, (size_t)size, "no message");
  rewind(messages);
  while (fgets(line, sizeof line, messages)) {
    char *end = line + strcspn(line, "\n"), *begin = line + strspn(line, " \t^");
    *end = 0;
    if (*begin) snprintf(text, (size_t)size, "%s", begin);
  }
}

int plot_close(Plot *p, Err *err)
{
  char said[512];
  FILE *in = tmpfile(), *messages = tmpfile();
  int failed = fclose(p->script) || !in || !messages || fputs(p->text, in) == EOF || fflush(in);
  if (failed)
    err_set(err, "cannot make a picture: no temporary file");
  else {
    rewind(in); /* the child shares the position */
    const int status = lseek(fileno(in), 0, SEEK_SET) ? -1 : run(in, messages);
    failed = status != 0;
    if (status == 127)
      err_set(err, "cannot make a picture: gnuplot is not there (make deps)");
    else if (failed) {
      last_words(messages, said, sizeof said);
      err_set(err, "cannot make a picture: gnuplot: %s", said);
    }
  }
  if (in) fclose(in);
  if (messages) fclose(messages);
  free(p->text);
  if (failed) return spool_abort(&p->out), -1;
  return spool_commit(&p->out, err);
}
