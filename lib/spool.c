/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The temporary file's descriptor stays open, so that fsync and the copy to a stream need no name.
 * Its name ends in the process number: two writers never share it, and one that belongs to no
 * living process is known to be waste. */
#define _XOPEN_SOURCE 700 /* realpath is in the XSI part of POSIX */
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "spool.h"

static int is_std(const char *path) { return !path || !strcmp(path, "-"); }

static int fail(Err *err, const char *what, const char *name)
{
  return err_set(err, "cannot %s '%s': %s", what, name, strerror(errno));
}

static int write_all(int fd, const char *data, size_t n)
{
  while (n) {
    ssize_t k = write(fd, data, n);
    if (k < 0 && errno != EINTR) return -1;
    if (k > 0) data += k, n -= (size_t)k;
  }
  return 0;
}

/* Copies from `from` to its end; *total bytes. 0, 1: reading failed, 2: writing failed. */
static int copy(int to, int from, long long *total)
{
  enum { BLOCK = 1 << 20 };
  char *block = malloc(BLOCK);
  int rc = block ? 0 : 1;
  *total = 0;
  while (!rc) {
    ssize_t k = read(from, block, BLOCK);
    if (k < 0 && errno == EINTR) continue;
    if (k == 0) break;
    rc = k < 0 ? 1 : write_all(to, block, (size_t)k) ? 2 : 0;
    *total += k;
  }
  free(block);
  return rc;
}

/* A new file in $TMPDIR. */
static int open_temporary(char *out, int size, Err *err)
{
  const char *folder = getenv("TMPDIR");
  if (!folder || !*folder) folder = "/tmp";
  if (snprintf(out, (size_t)size, "%s/%s.XXXXXX", folder, err_name()) >= size)
    return err_set(err, "path too long: '%s'", folder);
  int fd = mkstemp(out);
  return fd < 0 ? fail(err, "make a temporary file", out) : fd;
}

/* ---- input ---- */

/* Input from what cannot be seeked, all of it into a temporary file. */
static int spool_pipe(int from, const char *name, char *out, int size, Err *err)
{
  long long total;
  int to = open_temporary(out, size, err);
  if (to < 0) return -1;
  int rc = copy(to, from, &total);
  if (rc) fail(err, rc == 1 ? "read" : "write", rc == 1 ? name : out);
  if (close(to) && !rc) rc = fail(err, "write", out);
  if (!rc && !total)
    rc = err_set(err, "cannot read '%s': empty; the command before the pipe failed", name);
  if (rc) unlink(out);
  return rc ? -1 : 0;
}

static int spool_stdin(char *out, int size, int *temporary, Err *err)
{
  struct stat st;
  if (isatty(0)) return err_set(err, "cannot read 'stdin': it is a terminal");
  if (fstat(0, &st)) return fail(err, "read", "stdin");
  if (S_ISDIR(st.st_mode)) return errno = EISDIR, fail(err, "read", "stdin");
  char *name = realpath("/dev/stdin", NULL); /* fails for a file that has lost its name */
  int direct = S_ISREG(st.st_mode) && st.st_size && lseek(0, 0, SEEK_CUR) == 0 && name &&
               !access(name, R_OK) && (int)strlen(name) < size;
  if (direct) strcpy(out, name);
  free(name);
  *temporary = !direct;
  return direct ? 0 : spool_pipe(0, "stdin", out, size, err);
}

int spool_in(const char *path, char *out, int size, int *temporary, Err *err)
{
  struct stat st;
  *temporary = 0;
  if (is_std(path)) return spool_stdin(out, size, temporary, err);
  int fd = open(path, O_RDONLY);
  if (fd < 0 || fstat(fd, &st)) {
    int rc = fail(err, "open", path);
    if (fd >= 0) close(fd);
    return rc;
  }
  int rc = 0;
  if (S_ISDIR(st.st_mode))
    errno = EISDIR, rc = fail(err, "read", path);
  else if (!S_ISREG(st.st_mode))
    *temporary = 1, rc = spool_pipe(fd, path, out, size, err);
  else if (!st.st_size)
    rc = err_set(err, "cannot read '%s': empty file", path);
  else if (snprintf(out, (size_t)size, "%s", path) >= size)
    rc = err_set(err, "path too long: '%s'", path);
  close(fd);
  return rc;
}

/* ---- output ---- */

/* Folder and last part of a path. */
static int split(const char *path, char folder[4096], char name[4096])
{
  const char *slash = strrchr(path, '/');
  size_t n = slash ? (size_t)(slash - path) : 0;
  if (strlen(path) >= 4096 - 32) return -1; /* 32: room for dots and the process number */
  strcpy(name, slash ? slash + 1 : path);
  if (n)
    memcpy(folder, path, n), folder[n] = 0;
  else
    strcpy(folder, slash ? "/" : ".");
  return 0;
}

/* Removes what dead processes, or this one, left of the same file. */
static void sweep(const char *folder, const char *name)
{
  char old[8192];
  size_t n = strlen(name);
  DIR *dir = opendir(folder);
  for (struct dirent *e; dir && (e = readdir(dir));) {
    const char *s = e->d_name;
    if (*s != '.' || strncmp(s + 1, name, n) || s[n + 1] != '.') continue;
    char *end;
    long pid = strtol(s + n + 2, &end, 10);
    if (pid <= 0 || strcmp(end, "~")) continue;
    if (pid != (long)getpid() && (!kill((pid_t)pid, 0) || errno != ESRCH)) continue;
    if (snprintf(old, sizeof old, "%s/%s", folder, s) < (int)sizeof old) unlink(old);
  }
  if (dir) closedir(dir);
}

static int open_beside(Spool *s, Err *err)
{
  char folder[4096], name[4096];
  if (split(s->final, folder, name)) return err_set(err, "path too long: '%s'", s->final);
  sweep(folder, name);
  int n = snprintf(s->path, sizeof s->path, "%s/.%s.%ld~", folder, name, (long)getpid());
  if (n >= (int)sizeof s->path) return err_set(err, "path too long: '%s'", s->final);
  s->fd = open(s->path, O_RDWR | O_CREAT | O_EXCL, 0666);
  return s->fd < 0 ? fail(err, "write", s->final) : 0;
}

/* Follows a symbolic link, so that the rename replaces the file and not the link. */
static int resolve(Spool *s, const char *path, Err *err)
{
  char *real = realpath(path, NULL);
  const char *name = real ? real : path;
  size_t n = strlen(name);
  int bad = n >= sizeof s->final;
  if (!bad) strcpy(s->final, name);
  free(real);
  if (bad) return err_set(err, "path too long: '%s'", path);
  if (!n || s->final[n - 1] == '/') return errno = n ? EISDIR : ENOENT, fail(err, "write", path);
  return 0;
}

int spool_out(Spool *s, const char *path, int binary, Err *err)
{
  struct stat st;
  *s = (Spool){.fd = -1, .stream = is_std(path)};
  if (s->stream) {
    if (fstat(1, &st)) return fail(err, "write", "stdout"); /* closed */
    if (binary && isatty(1))
      return err_set(err, "stdout is a terminal: redirect it or name a file with -o");
  } else {
    if (resolve(s, path, err)) return -1;
    int there = !stat(s->final, &st);
    if (there && S_ISDIR(st.st_mode)) return errno = EISDIR, fail(err, "write", path);
    s->stream = there && !S_ISREG(st.st_mode);
    if (there && access(s->final, W_OK)) return fail(err, "write", path);
  }
  if (!s->stream) return open_beside(s, err);
  s->fd = open_temporary(s->path, sizeof s->path, err);
  return s->fd < 0 ? -1 : 0;
}

void spool_opened(Spool *s)
{
  if (!s->stream) return;
  unlink(s->path);
  *s->path = 0;
}

static int commit_stream(Spool *s, Err *err)
{
  const char *name = *s->final ? s->final : "stdout";
  int to = *s->final ? open(s->final, O_WRONLY) : 1;
  if (to < 0) return fail(err, "write", name);
  long long total;
  fflush(stdout);
  int rc = lseek(s->fd, 0, SEEK_SET) ? 1 : copy(to, s->fd, &total);
  if (rc) fail(err, rc == 1 ? "read" : "write", rc == 1 ? "temporary file" : name);
  if (*s->final && close(to) && !rc) rc = fail(err, "write", name);
  return rc ? -1 : 0;
}

/* A rename is on the disk when its folder is. Some file systems cannot sync a folder: not an error.
 */
static void sync_folder(const char *path)
{
  char folder[4096], name[4096];
  if (split(path, folder, name)) return;
  int fd = open(folder, O_RDONLY);
  if (fd >= 0) fsync(fd), close(fd);
}

int spool_commit(Spool *s, Err *err)
{
  int rc = 0;
  if (s->stream)
    rc = commit_stream(s, err);
  else if (fsync(s->fd) || rename(s->path, s->final))
    rc = fail(err, "write", s->final);
  else
    *s->path = 0, sync_folder(s->final);
  spool_abort(s);
  return rc;
}

void spool_abort(Spool *s)
{
  if (s->fd < 0) return;
  close(s->fd);
  s->fd = -1;
  if (*s->path) unlink(s->path);
  *s->path = 0;
}

int spool_text(const char *path, const char *text, Err *err)
{
  Spool s;
  if (spool_out(&s, path, 0, err)) return -1;
  if (!write_all(s.fd, text, strlen(text))) return spool_commit(&s, err);
  fail(err, "write", path ? path : "stdout");
  spool_abort(&s);
  return -1;
}

char *spool_slurp(const char *path, Err *err)
{
  FILE *f = fopen(path, "r");
  size_t room = 1 << 16, n = 0, got;
  char *text = NULL, *more;
  if (!f) return err_null(err, "cannot open '%s': %s", path, strerror(errno));
  do {
    if (n + 1 >= room) room *= 2;
    if (!(more = realloc(text, room))) break;
    text = more;
    got = fread(text + n, 1, room - n - 1, f);
    n += got;
  } while (got > 0);
  if (!more || ferror(f) || memchr(text, '\0', n)) {
    err_set(err, "cannot read '%s': %s", path,
            !more       ? "no memory"
            : ferror(f) ? strerror(errno)
                        : "not a text file");
    free(text);
    text = NULL;
  } else
    text[n] = '\0';
  fclose(f);
  return text;
}
