/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A body of K shells of constant density is a sum of K homogeneous spheroids, the k-th with the
 * density of its shell minus that of the next, so its potential is known in closed form. The shells
 * are coarse: what is taken from them is the ratio to the same shells at rest. */
#include <math.h>
#include <stdlib.h>
#include "figure.h"
#include "unit.h"

static const double PI = 3.14159265358979323846;
enum { SHELLS = 96 };

/* A3 of Chandrasekhar's index symbols for x = e^2; 2 A1 + A3 = 2. */
static double index3(double x)
{
  double e = sqrt(x), d = 1, sum = 0, power = 1;
  if (x > 0.1) return 2 / x * (1 - sqrt(1 - x) * asin(e) / e);
  for (int n = 1; n < 30; n++, power *= x) {
    double next = d * 2 * n / (2 * n + 1.);
    sum += 2 * (d - next) * power, d = next;
  }
  return sum;
}

/* (I - A1 w^2 - A3 z^2) pi; outside that of the confocal spheroid through the point, with the same
 * mass. */
double figure_potential(double a, double c, double w, double z)
{
  double mass = 1, a2 = a * a, c2 = c * c, w2 = w * w, z2 = z * z, a3;
  if (w2 / a2 + z2 / c2 > 1) {
    double b = a2 + c2 - w2 - z2, rest = a2 * c2 - w2 * c2 - z2 * a2;
    double more =
        b > 0 ? -2 * rest / (b + sqrt(b * b - 4 * rest)) : 0.5 * (sqrt(b * b - 4 * rest) - b);
    mass = a2 * c / ((a2 + more) * sqrt(c2 + more)), a2 += more, c2 += more;
  }
  a3 = index3(1 - c2 / a2);
  return -PI * mass * ((2 - a3) * (a2 - 0.5 * w2) + a3 * (c2 - z2));
}

typedef struct {
  double m, rho;  /* kg inside the surface; density of the shell below it */
  double r, q, p; /* mean radius, c/a, pressure of the surface */
  double level;   /* potential, centrifugal included */
  int layer;
} Shell;

/* Potential at a point from all shells, for G = 1. */
static double potential(const Shell *s, double w, double z)
{
  double sum = 0;
  for (int k = 1; k <= SHELLS; k++) {
    double step = s[k].rho - (k < SHELLS ? s[k + 1].rho : 0);
    double c = s[k].r * pow(s[k].q, 2. / 3);
    if (step != 0) sum += step * figure_potential(c / s[k].q, c, w, z);
  }
  return sum;
}

/* New axes: the pole and the equator of each surface at the same potential. Returns the largest
 * change of ln(c/a), or NAN when a surface has lost its equator. */
static double reshape(Shell *s, double omega2)
{
  double worst = 0, change[SHELLS + 1] = {0};
  for (int k = 1; k <= SHELLS; k++) {
    double a = s[k].r * pow(s[k].q, -1. / 3), c = a * s[k].q;
    double pole = potential(s, 0, c), out = 0.5 * omega2 / UNIT_G * a * a;
    double equator = potential(s, a, 0) - out;
    change[k] = -(pole - equator) * s[k].r / s[k].m;
    s[k].level = UNIT_G * (pole + 2 * equator) / 3;
  }
  for (int k = 1; k <= SHELLS; k++) {
    s[k].q *= exp(fmax(-0.3, change[k]));
    if (s[k].q > 1) s[k].q = 1;
    if (!(s[k].q > 0.2)) return NAN;
    worst = fmax(worst, fabs(change[k]));
  }
  s[0].q = s[1].q;
  return worst;
}

/* Pressures from the surface inwards, densities of the shells from them, radii from their volumes.
 * Returns the largest relative change of a density, or NAN. */
static double settle(Shell *s, const StructureBody *body, const StructureState *anchor)
{
  double worst = 0, volume = 0, centre = UNIT_G * potential(s, 0, 0);
  s[SHELLS].p = body->outer;
  for (int k = SHELLS; k > 0; k--) {
    double below = k > 1 ? s[k - 1].level : centre;
    StructureState at;
    s[k - 1].p = s[k].p + s[k].rho * (s[k].level - below);
    if (structure_move(&body->layer[s[k].layer], &anchor[s[k].layer], (s[k].p + s[k - 1].p) / 2,
                       &at))
      return NAN;
    worst = fmax(worst, fabs(at.rho / s[k].rho - 1)), s[k].rho = at.rho;
  }
  for (int k = 1; k <= SHELLS; k++) {
    volume += (s[k].m - s[k - 1].m) / s[k].rho;
    s[k].r = cbrt(volume / (4 * PI / 3));
  }
  return worst;
}

static int equilibrium(Shell *s, const StructureBody *body, const StructureState *anchor,
                       double omega, Err *err)
{
  double off = 1, move = 1;
  for (int round = 0; round < 400 && !(off + move < 1e-11); round++) {
    move = reshape(s, omega * omega);
    off = settle(s, body, anchor);
    if (isnan(off + move)) break;
  }
  if (off + move < 1e-9) return 0;
  return err_set(err, "no figure of equilibrium: it spins too fast (period %g s)",
                 2 * PI / fabs(omega));
}

/* Shells of equal steps of m^(1/3) within the layers, each layer with at least 4. */
static void divide(Shell *s, const Structure *full)
{
  double mass = full->node[full->n - 1].m, inside = 0;
  int n = 0, left = full->layers;
  s[0] = (Shell){.q = 1};
  for (int k = 0; k < full->layers; k++) {
    double end = full->node[full->first[k + 1] - 1].m, a = cbrt(inside), b = cbrt(end);
    int shells = (int)fmax(4, SHELLS * (b - a) / cbrt(mass));
    if (shells > SHELLS - n - 4 * --left || !left) shells = SHELLS - n - 4 * left;
    for (int i = 1; i <= shells; i++) {
      double m = i == shells ? end : pow(a + (b - a) * i / shells, 3);
      StructureNode mid = structure_at_mass(full, k, (m + s[n].m) / 2);
      Shell *shell = &s[++n];
      *shell = (Shell){.m = m, .rho = mid.rho, .q = 1, .layer = k};
      shell->r = structure_at_mass(full, k, m).r;
    }
    inside = end;
  }
}

/* How a quantity of the shells at mass m differs between spin and rest. */
static void apply(Structure *s, const StructureBody *body, const StructureState *anchor,
                  const Shell *rest, const Shell *spun)
{
  int k = 1;
  for (long i = 0; i < s->n; i++) {
    StructureNode *n = &s->node[i];
    double third = cbrt(n->m), t, press[2], q[2], r[2];
    StructureState at;
    while (k < SHELLS && n->m > spun[k].m) k++;
    t = (third - cbrt(spun[k - 1].m)) / (cbrt(spun[k].m) - cbrt(spun[k - 1].m));
    for (int j = 0; j < 2; j++) {
      const Shell *a = &rest[k - 1 + j], *b = &spun[k - 1 + j];
      int top = k - 1 + j == SHELLS && !(a->p > 0), core = k - 1 + j == 0;
      press[j] = top ? b[-1].p / a[-1].p : b->p / a->p;
      q[j] = b->q, r[j] = core ? b[1].r / a[1].r : b->r / a->r;
    }
    n->p *= press[0] + t * (press[1] - press[0]);
    n->r *= r[0] + t * (r[1] - r[0]);
    n->f = 1 - (q[0] + t * (q[1] - q[0]));
    if (structure_move(&body->layer[n->layer], &anchor[n->layer], n->p, &at)) continue;
    n->rho = at.rho, n->u = at.u;
    n->g = n->r > 0 ? UNIT_G * n->m / (n->r * n->r) : 0;
    n->cs = eos_eval(&body->layer[n->layer].material->eos, n->rho, n->u, 0).cs;
  }
}

int figure_spin(Structure *s, const StructureBody *body, double omega, Err *err)
{
  StructureState anchor[STRUCTURE_LAYERS];
  Shell rest[SHELLS + 1], spun[SHELLS + 1];
  if (body->weightless) return err_set(err, "without gravity nothing holds a body that spins");
  if (structure_anchors(body, anchor, err)) return -1;
  divide(rest, s);
  if (equilibrium(rest, body, anchor, 0, err)) return -1;
  for (int k = 0; k <= SHELLS; k++) spun[k] = rest[k];
  if (equilibrium(spun, body, anchor, omega, err)) return -1;
  apply(s, body, anchor, rest, spun);
  structure_heat(s, body);
  return 0;
}

void figure_flatten(const StructureNode *n, double x[3])
{
  double a = pow(1 - n->f, -1. / 3);
  if (n->f == 0) return;
  x[0] *= a, x[1] *= a, x[2] *= a * (1 - n->f);
}

double figure_level(const Structure *s, double w, double z)
{
  double r = sqrt(w * w + z * z), last = s->node[s->n - 1].r;
  if (s->node[s->n - 1].f == 0) return r;
  for (int k = 0; k < 30; k++) {
    double f = structure_at_radius(s, fmin(r, last)).f, a = pow(1 - f, -1. / 3), old = r;
    r = sqrt(pow(w / a, 2) + pow(z / (a * (1 - f)), 2));
    if (fabs(r - old) < 1e-12 * last) break;
  }
  return r;
}
