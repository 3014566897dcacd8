/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The table of passes for --profile. */
#include <omp.h>
#include "profile.h"

const char *const profile_names[] = {"order and tree", "neighbour search", "loop A (gradient)",
                                     "local passes",   "density sum",      "loop B (force)",
                                     "gravity",        "reductions"};

void profile_print(const Sim *sim, long steps, FILE *to)
{
  const int cpu = sim->b == &backend_cpu;
  double per = (cpu ? 1e6 * omp_get_max_threads() : 1e9) /
               ((double)sim->s.n * (steps > 0 ? (double)steps : 1)),
         total = 0;
  fprintf(to, "# pass\tcalls\tseconds\t%s per particle and step (%ld particles, %ld steps, %s)\n",
          cpu ? "microseconds*core" : "ns", sim->s.n, steps, sim->about);
  for (int t = 0; t < TIMERS; t++) {
    const BackendTimer *b = &sim->timer[t];
    total += b->spent;
    if (b->calls)
      fprintf(to, "%s\t%ld\t%.3f\t%.3f\n", profile_names[t], b->calls, b->spent, b->spent * per);
  }
  fprintf(to, "all\t\t%.3f\t%.3f\n", total, total * per);
}
