/* SPDX-License-Identifier: GPL-3.0-or-later */
/* weibull: gives the brittle particles of a body their flaws (001 eq. 45; lib/weibull.h). */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "lib/material.h"
#include "lib/opt.h"
#include "lib/snap.h"
#include "lib/weibull.h"

static struct {
  long seed;
  int verbose;
  double k, m;
  const char *out;
} o = {.k = NAN, .m = NAN};

/* clang-format off */
static const Opt OPTS[] = {
  {"seed",      's', OPT_INT,  "1",  "N",     "seed of the random numbers; give each body its own", &o.seed},
  {"weibull-k", 'k', OPT_REAL, NULL, "1/m^3", "Weibull k of all brittle materials instead of their own", &o.k},
  {"weibull-m", 'm', OPT_REAL, NULL, "1",     "Weibull m likewise", &o.m},
  {"verbose",   'v', OPT_FLAG, NULL, NULL,    "print the statistics of each body and material on stderr", &o.verbose},
  {"output",    'o', OPT_TEXT, "-",  "FILE",  "where the body goes", &o.out},
  {NULL, 0, OPT_FLAG, NULL, NULL, NULL, NULL}};

static const OptProgram PROGRAM = {
  "weibull", "give brittle particles their flaws", "[options] [body.h5] > body.h5",
  "In each body, the particles of one brittle material share k V flaws of strains up to 1. Flaws are thrown at random until "
  "every particle has one; the damage starts at zero. The result depends on ids and seed only.",
  "mksphere -n 5000 --radius 15km --layer basalt | weibull --seed 2 --verbose > target.h5", OPTS, 0, 1};
/* clang-format on */

static void statistics(const Parts *p, const WeibullGroup *group, int groups)
{
  fprintf(stderr, "# body\tmaterial\tparticles\tvolume [m^3]\tflaws\texpected\tlowest\thighest\n");
  for (const WeibullGroup *g = group; g < group + groups; g++) {
    double n = (double)g->n,
           expected = n * (log(n) + 0.5772156649) + 0.5; /* N H_N, 1/N neglected */
    fprintf(stderr, "%d\t%s\t%ld\t%.9g\t%lld\t%.9g\t%.9g\t%.9g\n", g->body,
            p->material[g->mat].name, g->n, g->volume, (long long)g->flaws, expected, g->lowest,
            g->highest);
  }
}

static void check_options(void)
{
  if (o.seed < 0) err_usage("seed %ld is negative", o.seed);
  if (!isnan(o.k) && !(o.k > 0)) err_usage("Weibull k %g is not positive", o.k);
  if (!isnan(o.m) && !(o.m >= 1)) err_usage("Weibull m %g is less than 1", o.m);
}

int main(int argc, char **argv)
{
  Err err;
  int n, groups;
  char *line = opt_command_line(argc, argv);
  char **input = opt_parse(&PROGRAM, argc, argv, &n);
  const char *file = n ? input[0] : "-";
  WeibullGroup *group;
  Material *material;
  Parts *p;
  check_options();
  if (!(p = snap_read(file, &err)) || part_need(p, "id m rho mat body", file, &err) ||
      part_check(p, file, &err) || !(material = material_load(p, &err)) ||
      weibull_assign(p, material, (uint64_t)o.seed, o.k, o.m, &group, &groups, &err))
    err_die("%s", err.text);
  if (!groups) err_warn("no particle is of a brittle material: there are no flaws");
  if (part_history(p, line, &err) || snap_write(p, o.out, 0, &err)) err_die("%s", err.text);
  if (o.verbose) statistics(p, group, groups);
  free(group), free(material), free(line), part_free(p);
  return 0;
}
