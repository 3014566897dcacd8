/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include <string.h>
#include "bound.h"
#include "pointmass.h"
#include "sort.h"

int bound_frame(long n, const double *phi, const double *m, const double *v, long *order,
                double out[3], Err *err)
{
  double mass = 0, sum = 0;
  if (sort_reals(n, phi, order)) return err_set(err, "out of memory for %ld particles", n);
  for (long k = 0; k < n; k++) mass += phi[k] < INFINITY ? m[k] : 0;
  out[0] = out[1] = out[2] = 0;
  for (long k = 0; k < n && sum < BOUND_CORE * mass; k++) {
    const long j = order[k];
    for (int a = 0; a < 3; a++) out[a] += m[j] * v[3 * j + a];
    sum += m[j];
  }
  for (int a = 0; a < 3 && sum > 0; a++) out[a] /= sum;
  return 0;
}

long bound_count(const Parts *p, const long *list, long n, const double *own, ClumpLevel level,
                 double *mass, Err *err)
{
  const size_t room = (size_t)n + 1;
  double *m = calloc(4 * room, sizeof *m), *v = m + n, centre[3];
  long *order = malloc(room * sizeof *order), bound = 0;
  if (!m || !order) return free(m), free(order), err_set(err, "out of memory for %ld particles", n);
  for (long k = 0; k < n; k++)
    m[k] = p->m[list[k]], memcpy(v + 3 * k, p->v + 3 * list[k], 3 * sizeof *v);
  int failed = bound_frame(n, own, m, v, order, centre, err);
  *mass = 0;
  for (long k = 0; k < n && !failed; k++)
    if (pointmass_row(p, list[k]) ||
        0.5 * bound_speed2(v + 3 * k, centre) + bound_heat(p, list[k], level) + own[k] < 0)
      *mass += m[k], bound++;
  free(m), free(order);
  return failed ? -1 : bound;
}
