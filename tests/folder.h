/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A new, empty folder for each test, in which it runs; what is left there goes with it. */
#ifndef FOLDER_H
#define FOLDER_H

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static char folder[4096];

static inline int folder_setup(void **state)
{
  const char *temporary = getenv("TMPDIR");
  (void)state;
  snprintf(folder, sizeof folder, "%s/breccia.XXXXXX", temporary ? temporary : "/tmp");
  return mkdtemp(folder) && !chdir(folder) ? 0 : -1;
}

static inline int folder_teardown(void **state)
{
  char command[4200];
  (void)state;
  snprintf(command, sizeof command, "rm -rf '%s'", folder);
  return chdir("/") || system(command);
}

/* folder_files: how many there are, hidden ones too. */
static inline int folder_files(void)
{
  int n = 0;
  DIR *dir = opendir(folder);
  for (struct dirent *e; (e = readdir(dir));)
    n += strcmp(e->d_name, ".") && strcmp(e->d_name, "..");
  closedir(dir);
  return n;
}

#endif
