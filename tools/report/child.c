/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>
#include "child.h"

/* The path of a program in the folder of this one. */
static void beside(const char *name, char *path, size_t size)
{
  ssize_t n = readlink("/proc/self/exe", path, size - 1);
  char *slash;
  path[n > 0 ? n : 0] = 0;
  slash = strrchr(path, '/');
  if (slash) snprintf(slash + 1, size - (size_t)(slash + 1 - path), "%s", name);
}

static _Noreturn void become(const char *const *argv, const char *out, int errors)
{
  char path[4096];
  int to = open(out ? out : "/dev/null", O_WRONLY | O_CREAT | O_TRUNC, 0666),
      from = open("/dev/null", O_RDONLY);
  beside(argv[0], path, sizeof path);
  if (to < 0 || from < 0)
    dprintf(errors, "%s: %s\n", out ? out : "/dev/null", strerror(errno)), _exit(126);
  dup2(from, 0), dup2(to, 1), dup2(errors, 2);
  execv(path, (char *const *)argv);
  execvp(argv[0], (char *const *)argv);
  dprintf(2, "%s: %s\n", argv[0], strerror(errno));
  _exit(127);
}

/* The last line of what came on stderr. */
static void last_line(FILE *f, char *line, int size)
{
  char next[1024];
  line[0] = 0;
  rewind(f);
  while (fgets(next, sizeof next, f)) {
    next[strcspn(next, "\n")] = 0;
    if (*next) snprintf(line, (size_t)size, "%s", next);
  }
}

int child_run(const char *const *argv, const char *out, Err *err)
{
  char line[1024] = "";
  int status = 0;
  FILE *errors = tmpfile();
  if (!errors) return err_set(err, "no temporary file: %s", strerror(errno));
  fflush(NULL);
  pid_t pid = fork();
  if (pid == 0) become(argv, out, fileno(errors));
  if (pid < 0 || waitpid(pid, &status, 0) < 0) {
    fclose(errors);
    return err_set(err, "cannot run '%s': %s", argv[0], strerror(errno));
  }
  last_line(errors, line, sizeof line);
  fclose(errors);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return 0;
  return err_set(err, "'%s' failed: %s", argv[0], *line ? line : "without a word");
}

int child_there(const char *name)
{
  const char *path = getenv("PATH");
  char file[4096];
  while (path && *path) {
    size_t n = strcspn(path, ":");
    if (snprintf(file, sizeof file, "%.*s/%s", (int)n, path, name) < (int)sizeof file &&
        !access(file, X_OK))
      return 1;
    path += n + (path[n] == ':');
  }
  return 0;
}
