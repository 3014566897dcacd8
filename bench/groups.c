/* SPDX-License-Identifier: GPL-3.0-or-later */
/* fof, clumps and disk as programs, on a snapshot of N particles (bench/groups [N]): a planet with
 * a disk, a body that flies by, debris that escapes. Checks that they find what was put there, and
 * prints wall clock, processor time and memory. The programs are those of $PATH; the snapshot goes
 * to $TMPDIR. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>
#include "lib/group.h"
#include "lib/material.h"
#include "lib/rng.h"
#include "lib/snap.h"
#include "lib/unit.h"

static const double R = 6.4e6, M = 6e24; /* of the planet: m, kg */
static Err err;

typedef struct {
  long planet, runner, disk, spray; /* particles */
  char *folder, snap[512], ids[512];
} Case;

typedef struct {
  double wall, core; /* s */
  double memory;     /* bytes */
} Cost;

static void put(Parts *p, const double x[3], const double v[3], double rho, double spacing,
                int body)
{
  const long i = p->n++;
  p->id[i] = i, p->mat[i] = 0, p->body[i] = body;
  p->rho[i] = rho, p->h[i] = 2.4 * spacing, p->u[i] = 1e6, p->p[i] = 1e9;
  p->damage[i] = rng_uniform(4, (uint64_t)i, 0);
  for (int a = 0; a < 3; a++) p->x[3 * i + a] = x[a], p->v[3 * i + a] = v[a];
  for (int a = 0; a < 6; a++) p->s[6 * i + a] = 1e6 * rng_normal(5, (uint64_t)i, (uint32_t)a);
}

/* About n particles on a jittered lattice in a sphere, light at the surface. Returns how many. */
static long sphere(Parts *p, long n, double radius, const double x[3], const double v[3], int body)
{
  const double d = radius * cbrt(4 * acos(-1) / (3 * (double)n));
  const long w = (long)(radius / d) + 1, before = p->n;
  for (long k = 0; k < 8 * w * w * w; k++) {
    const long cell[3] = {k % (2 * w) - w, k / (2 * w) % (2 * w) - w, k / (4 * w * w) - w};
    double y[3], r2 = 0;
    for (uint32_t a = 0; a < 3; a++) {
      y[a] = d * ((double)cell[a] + 0.2 * rng_uniform(1, (uint64_t)k, a));
      r2 += y[a] * y[a];
    }
    if (r2 > radius * radius || p->n - before >= n) continue;
    const double rho = sqrt(r2) > radius - 1.5 * d ? 1500 : 5500;
    for (int a = 0; a < 3; a++) y[a] += x[a];
    put(p, y, v, rho, d, body);
  }
  return p->n - before;
}

static void fill(Case *c, Parts *p, long n)
{
  const double zero[3] = {0}, far[3] = {10 * R, 0, 0};
  const double escape = sqrt(2 * UNIT_G * M / R), by[3] = {escape, escape, 0};
  c->planet = sphere(p, 6 * n / 10, R, zero, zero, 0);
  c->runner = sphere(p, n / 4, 0.7 * R, far, by, 1);
  c->disk = n / 10, c->spray = n - c->planet - c->runner - c->disk;
  for (long k = 0; k < c->disk; k++) {
    const double r = R * (2 + 4 * rng_uniform(2, (uint64_t)k, 0)), z = 0.01 * R;
    const double t = 2 * acos(-1) * rng_uniform(2, (uint64_t)k, 1), v = sqrt(UNIT_G * M / r);
    const double x[3] = {r * cos(t), r * sin(t), z * rng_normal(2, (uint64_t)k, 2)};
    const double w[3] = {-v * sin(t), v * cos(t), 0};
    put(p, x, w, 1, R * sqrt(32 * acos(-1) / (double)c->disk), k % 2);
  }
  for (long k = 0; k < c->spray; k++) {
    double x[3], v[3], length = 0;
    for (uint32_t a = 0; a < 3; a++) x[a] = rng_normal(3, (uint64_t)k, a), length += x[a] * x[a];
    const double r = R * (12 + 30 * rng_uniform(3, (uint64_t)k, 9)) / sqrt(length);
    for (int a = 0; a < 3; a++) x[a] *= r, v[a] = 2 * escape * x[a] / (30 * R);
    put(p, x, v, 1, 60 * R / cbrt((double)c->spray) / 4, 1);
  }
  for (long i = 0; i < p->n; i++) p->m[i] = i < c->planet ? M / (double)c->planet : 1e-8 * M;
  for (long i = c->planet; i < c->planet + c->runner; i++) p->m[i] = 0.1 * M / (double)c->runner;
}

static void make(Case *c, long n)
{
  Parts *p = part_new(n);
  MaterialName name;
  char *text = material_find("basalt", name, &err);
  if (!p || !text || part_add(p, GROUP_FIELDS " p s damage phi cs", &err) ||
      part_add_material(p, name, text, &err) < 0)
    err_die("%s", err.text);
  p->n = 0;
  fill(c, p, n);
  if (snap_write(p, c->snap, 0, &err)) err_die("%s", err.text);
  part_free(p), free(text);
}

static double now(void)
{
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Runs a command line and gives its output's file; another process waits for it, so that the memory
 * is its own. */
static Cost run(const char *command)
{
  int end[2];
  Cost cost;
  fflush(stdout);
  if (pipe(end)) err_die("no pipe");
  const pid_t child = fork();
  if (child < 0) err_die("no process");
  if (!child) {
    const double start = now();
    struct rusage u;
    if (system(command)) _exit(1);
    getrusage(RUSAGE_CHILDREN, &u);
    cost.wall = now() - start, cost.memory = 1024 * (double)u.ru_maxrss;
    cost.core = (double)(u.ru_utime.tv_sec + u.ru_stime.tv_sec) +
                1e-6 * (double)(u.ru_utime.tv_usec + u.ru_stime.tv_usec);
    _exit(write(end[1], &cost, sizeof cost) != sizeof cost);
  }
  close(end[1]);
  const long got = read(end[0], &cost, sizeof cost);
  close(end[0]);
  int status;
  waitpid(child, &status, 0);
  if (got != sizeof cost || status) err_die("failed: %s", command);
  return cost;
}

/* The number of particles in the row of the table that begins with a word. */
static long count(const Case *c, const char *word)
{
  char path[600], line[65536];
  long n = 0;
  snprintf(path, sizeof path, "%s/table", c->folder);
  FILE *f = fopen(path, "r");
  while (f && fgets(line, sizeof line, f))
    if (!strncmp(line, word, strlen(word)) && line[strlen(word)] == '\t')
      n = atol(line + strlen(word));
  if (f) fclose(f);
  return n;
}

static void time_it(const Case *c, const char *what, const char *program, const char *snap)
{
  char command[2048];
  Cost best = {.wall = 1e9};
  snprintf(command, sizeof command, "%s %s >%s/table", program, snap, c->folder);
  for (int k = 0; k < 3; k++) {
    const Cost cost = run(command);
    if (cost.wall < best.wall) best = cost;
  }
  const double n = (double)(c->planet + c->runner + c->disk + c->spray);
  printf("%-24s %8.2f %8.2f %8.0f\n", what, best.wall, best.core, best.memory / n);
}

static void expect(const char *what, long got, long want, double part)
{
  if (fabs((double)(got - want)) > part * (double)want)
    err_die("%s: %ld particles, not %ld", what, got, want);
}

int main(int argc, char **argv)
{
  err_program(argv[0]);
  Case c = {0};
  const char *tmp = getenv("TMPDIR");
  char folder[400], command[2048];
  snprintf(folder, sizeof folder, "%s/groups-XXXXXX",
           tmp ? tmp : "/tmp"); /* lint: where POSIX has it */
  if (!(c.folder = mkdtemp(folder))) err_die("cannot make a folder '%s'", folder);
  snprintf(c.snap, sizeof c.snap, "%s/snap.h5", c.folder);
  snprintf(c.ids, sizeof c.ids, "%s/ids.h5", c.folder);
  make(&c, argc > 1 ? atol(argv[1]) : 100000);
  printf("# %ld particles\n# program                wall s   core s  bytes a particle\n",
         c.planet + c.runner + c.disk + c.spray);
  time_it(&c, "fof", "fof", c.snap);
  expect("the planet", count(&c, "1"), c.planet, 0),
      expect("the runner", count(&c, "2"), c.runner, 1e-3);
  snprintf(command, sizeof command, "clumps -o %s", c.ids);
  time_it(&c, "clumps", "clumps", c.snap);
  expect("planet and disk", count(&c, "1"), c.planet + c.disk, 1e-3);
  expect("the runner", count(&c, "2"), c.runner, 1e-3);
  time_it(&c, "clumps, grow", "clumps -m grow", c.snap);
  expect("planet and disk", count(&c, "1"), c.planet + c.disk, 1e-3);
  time_it(&c, "clumps, with snapshot", command, c.snap);
  for (int canup = 0; canup < 2; canup++) {
    time_it(&c, canup ? "disk, canup" : "disk, reufer", canup ? "disk -m canup" : "disk", c.ids);
    expect("the body", count(&c, "body"), c.planet, canup ? 0 : 0.2);
    expect("the disk", count(&c, "disk"), c.disk, 1e-3);
    expect("the debris", count(&c, "escape"), c.spray + c.runner, 0);
  }
  snprintf(command, sizeof command, "%s/table", c.folder);

  remove(command), remove(c.snap), remove(c.ids), rmdir(c.folder);
  return 0;
}
