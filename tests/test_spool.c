/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whole or not at all: what is left in the folder after success, failure and a killed predecessor;
 * streams, devices and pipes. */
#define _XOPEN_SOURCE 700
#include <errno.h>
#include <fcntl.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>
#include <cmocka.h>

#include "folder.h"
#include "lib/spool.h"

static const char *given; /* $TMPDIR as main found it; the tests set it to their folder */

static int setup(void **state)
{
  int failed = given ? setenv("TMPDIR", given, 1) : unsetenv("TMPDIR");
  return failed || folder_setup(state) || setenv("TMPDIR", folder, 1) ? -1 : 0;
}

static void assert_content(const char *path, const char *text)
{
  char block[4096];
  FILE *f = fopen(path, "r");
  assert_non_null(f);
  block[fread(block, 1, sizeof block - 1, f)] = 0;
  fclose(f);
  assert_string_equal(block, text);
}

static void put(const char *path, const char *text)
{
  FILE *f = fopen(path, "w");
  fputs(text, f);
  fclose(f);
}

static void text_appears_whole_and_alone(void **state)
{
  (void)state;
  Err err;
  mode_t mask = umask(027);
  assert_int_equal(spool_text("a.tsv", "1\t2\n", &err), 0);
  umask(mask);
  assert_content("a.tsv", "1\t2\n");
  struct stat st;
  stat("a.tsv", &st);
  assert_int_equal(st.st_mode & 0777, 0640);
  assert_int_equal(spool_text("a.tsv", "3", &err), 0);
  assert_content("a.tsv", "3");
  assert_int_equal(folder_files(), 1);
}

static void target_is_untouched_until_commit(void **state)
{
  (void)state;
  Err err;
  Spool s;
  put("a", "old");
  assert_int_equal(spool_out(&s, "a", 1, &err), 0);
  assert_int_equal(write(s.fd, "new", 3), 3);
  assert_content("a", "old");
  spool_abort(&s);
  spool_abort(&s);
  assert_content("a", "old");
  assert_int_equal(folder_files(), 1);
  assert_int_equal(spool_out(&s, "a", 1, &err), 0);
  assert_int_equal(write(s.fd, "new", 3), 3);
  assert_int_equal(spool_commit(&s, &err), 0);
  assert_content("a", "new");
  assert_int_equal(folder_files(), 1);
}

/* The process number of a child that is gone. */
static long dead(void)
{
  pid_t pid = fork();
  if (!pid) _exit(0);
  waitpid(pid, NULL, 0);
  return (long)pid;
}

static void waste_of_the_dead_is_swept(void **state)
{
  (void)state;
  Err err;
  char waste[32], alive[32], other[32], user[32];
  snprintf(waste, sizeof waste, ".a.%ld~", dead());
  snprintf(alive, sizeof alive, ".a.%ld~", (long)getppid());
  snprintf(other, sizeof other, ".ab.%ld~", dead());
  snprintf(user, sizeof user, ".ax%ld~", dead()); /* some editor's, of another file */
  put(user, "");
  put(waste, ""), put(alive, ""), put(other, "");
  assert_int_equal(spool_text("a", "x", &err), 0);
  assert_int_not_equal(access(waste, F_OK), 0);
  assert_int_equal(access(alive, F_OK) | access(other, F_OK) | access(user, F_OK), 0);
  assert_int_equal(folder_files(), 4);
}

static void links_are_followed(void **state)
{
  (void)state;
  Err err;
  struct stat st;
  put("a", "old");
  assert_int_equal(symlink("a", "l"), 0);
  assert_int_equal(spool_text("l", "new", &err), 0);
  assert_content("a", "new");
  assert_true(!lstat("l", &st) && S_ISLNK(st.st_mode));
}

static void assert_no_text(const char *path, const char *message)
{
  Err err;
  int before = folder_files();
  assert_int_equal(spool_text(path, "x", &err), -1);
  assert_string_equal(err.text, message);
  assert_int_equal(folder_files(), before);
}

static void bad_targets_are_refused(void **state)
{
  (void)state;
  assert_no_text("none/a", "cannot write 'none/a': No such file or directory");
  assert_no_text("", "cannot write '': No such file or directory");
  assert_no_text(".", "cannot write '.': Is a directory");
  assert_no_text("new/", "cannot write 'new/': Is a directory");
  assert_no_text("/dev/full", "cannot write '/dev/full': No space left on device");
  struct stat st;
  assert_true(!stat("/dev/full", &st) && S_ISCHR(st.st_mode));
}

static void full_disk_leaves_nothing(void **state)
{
  (void)state;
  struct rlimit old, few = {5, RLIM_INFINITY};
  signal(SIGXFSZ, SIG_IGN);
  getrlimit(RLIMIT_FSIZE, &old);
  few.rlim_max = old.rlim_max;
  setrlimit(RLIMIT_FSIZE, &few);
  Err err;
  int rc = spool_text("a", "longer than five bytes", &err), n = folder_files();
  setrlimit(RLIMIT_FSIZE, &old);
  assert_int_equal(rc, -1);
  assert_string_equal(err.text, "cannot write 'a': File too large");
  assert_int_equal(n, 0);
}

static void devices_and_pipes_are_written_through(void **state)
{
  (void)state;
  Err err;
  char got[8] = {0};
  assert_int_equal(spool_text("/dev/null", "x", &err), 0);
  assert_int_equal(mkfifo("pipe", 0600), 0);
  int fd = open("pipe", O_RDONLY | O_NONBLOCK);
  assert_int_equal(spool_text("pipe", "through", &err), 0);
  assert_int_equal(read(fd, got, sizeof got), 7);
  assert_string_equal(got, "through");
  close(fd);
  assert_int_equal(folder_files(), 1);
}

/* Runs body with descriptor `std` being fd; what the body asserts it must return. */
static int with(int std, int fd, int (*body)(char *out, Err *err), char *out, Err *err)
{
  fflush(stdout);
  int kept = dup(std);
  dup2(fd, std);
  int rc = body(out, err);
  dup2(kept, std);
  close(kept);
  close(fd);
  return rc;
}

static int text_to_stdout(char *out, Err *err) { return spool_text(out, "through", err); }

static void stdout_is_written_through(void **state)
{
  (void)state;
  Err err;
  char dash[] = "-";
  assert_int_equal(with(1, open("a", O_CREAT | O_WRONLY, 0600), text_to_stdout, dash, &err), 0);
  assert_content("a", "through");
  assert_int_equal(with(1, open("/dev/full", O_WRONLY), text_to_stdout, dash, &err), -1);
  assert_string_equal(err.text, "cannot write 'stdout': No space left on device");
  assert_int_equal(folder_files(), 1);
}

/* spool_in for stdin; 1: *out is temporary, 0: not, -1: error. */
static int in_stdin(char *out, Err *err)
{
  int temporary;
  return spool_in("-", out, 4096, &temporary, err) ? -1 : temporary;
}

static int pipe_with(const char *text)
{
  int end[2];
  assert_int_equal(pipe(end), 0);
  assert_true(write(end[1], text, strlen(text)) == (ssize_t)strlen(text));
  close(end[1]);
  return end[0];
}

static void stdin_can_be_seeked(void **state)
{
  (void)state;
  Err err;
  char out[4096];
  assert_int_equal(with(0, pipe_with("piped"), in_stdin, out, &err), 1);
  assert_content(out, "piped");
  unlink(out);
  put("a", "redirected");
  assert_int_equal(with(0, open("a", O_RDONLY), in_stdin, out, &err), 0);
  assert_content(out, "redirected");
  int fd = open("a", O_RDONLY);
  unlink("a");
  assert_int_equal(with(0, fd, in_stdin, out, &err), 1);
  assert_content(out, "redirected");
  unlink(out);
  put("a", "skip, rest");
  fd = open("a", O_RDONLY);
  lseek(fd, 6, SEEK_SET);
  assert_int_equal(with(0, fd, in_stdin, out, &err), 1);
  assert_content(out, "rest");
}

static void bad_stdin_is_refused(void **state)
{
  (void)state;
  Err err;
  char out[4096];
  assert_int_equal(with(0, pipe_with(""), in_stdin, out, &err), -1);
  assert_string_equal(err.text, "cannot read 'stdin': empty; the command before the pipe failed");
  assert_int_equal(with(0, open("/", O_RDONLY), in_stdin, out, &err), -1);
  assert_string_equal(err.text, "cannot read 'stdin': Is a directory");
  setenv("TMPDIR", "none", 1);
  assert_int_equal(with(0, pipe_with("x"), in_stdin, out, &err), -1);
  assert_non_null(strstr(err.text, "cannot make a temporary file 'none/"));
  assert_int_equal(folder_files(), 0);
}

static void assert_no_input(const char *path, const char *message)
{
  Err err;
  char out[4096];
  int temporary;
  assert_int_equal(spool_in(path, out, sizeof out, &temporary, &err), -1);
  assert_string_equal(err.text, message);
}

static void named_input(void **state)
{
  (void)state;
  Err err;
  char out[4096];
  int temporary;
  put("a", "x"), put("empty", "");
  assert_int_equal(spool_in("a", out, sizeof out, &temporary, &err), 0);
  assert_int_equal(temporary, 0);
  assert_string_equal(out, "a");
  assert_no_input("none", "cannot open 'none': No such file or directory");
  assert_no_input(".", "cannot read '.': Is a directory");
  assert_no_input("empty", "cannot read 'empty': empty file");
  assert_int_equal(spool_in("a", out, 1, &temporary, &err), -1);
  char name[32];
  int fd = pipe_with("piped");
  snprintf(name, sizeof name, "/dev/fd/%d", fd);
  assert_int_equal(spool_in(name, out, sizeof out, &temporary, &err), 0);
  assert_int_equal(temporary, 1);
  assert_content(out, "piped");
  close(fd);
}

int main(void)
{
  char kept[2048];
  if (getenv("TMPDIR")) given = strncat(strcpy(kept, ""), getenv("TMPDIR"), sizeof kept - 1);
#define T(NAME) cmocka_unit_test_setup_teardown(NAME, setup, folder_teardown)
  const struct CMUnitTest tests[] = {
      T(text_appears_whole_and_alone),
      T(target_is_untouched_until_commit),
      T(waste_of_the_dead_is_swept),
      T(links_are_followed),
      T(bad_targets_are_refused),
      T(full_disk_leaves_nothing),
      T(devices_and_pipes_are_written_through),
      T(stdout_is_written_through),
      T(stdin_can_be_seeked),
      T(bad_stdin_is_refused),
      T(named_input),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
