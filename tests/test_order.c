/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Order of convergence in time on smooth motion, space being the same: with q(dt) the state at a
 * fixed time, |q(dt) - q(dt/2)| / |q(dt/2) - q(dt/4)| = 2^order, with the order that each
 * integrator says it has. Cases: a pulsating segment of gas (1D), a stretched and turning elastic
 * ball (3D), a ball of liquid under its own gravity (3D), every density mode. */
#include <omp.h>
#include "lab.h"

static const char GAS[] = "name = \"gas\"; eos = { form = \"ideal\"; gamma = 1.4; };";
static const char RUBBER[] =
    "name = \"r\"; eos = { form = \"murnaghan\"; rho0 = 1.; K = 1.; n = 2.; };"
    "strength = { shear_modulus = 1.; form = \"none\"; };";
static const char LIQUID[] =
    "name = \"l\"; eos = { form = \"murnaghan\"; rho0 = 1.; K = 1.; n = 2.; };";

/* 40 particles at rest spacing 1/40 whose velocity is a standing wave. */
static Parts *segment(void)
{
  long n = 40;
  Parts *p = lab_parts(n, 1, GAS);
  for (long i = 0; i < n; i++) {
    double x = (i + .5) / n;
    p->x[3 * i] = x, p->v[3 * i] = .02 * sin(LAB_PI * x) * cos(2 * LAB_PI * x);
    p->m[i] = 1. / n, p->rho[i] = 1, p->u[i] = 1 + .1 * cos(LAB_PI * x), p->h[i] = 4.13 / n;
  }
  return p;
}

static int in_ball(const double *x, void *data)
{
  (void)data;
  return x[0] * x[0] + x[1] * x[1] + x[2] * x[2] < 1;
}

/* A ball of unit radius, turning, with a smooth velocity on top. */
static Parts *ball(const char *material)
{
  double dx = .31;
  long n = lab_lattice(dx, 5, 3, in_ball, NULL, NULL);
  Parts *p = lab_parts(n, 3, material);
  lab_lattice(dx, 5, 3, in_ball, NULL, p->x);
  for (long i = 0; i < n; i++) {
    double *x = &p->x[3 * i], *v = &p->v[3 * i];
    v[0] = -.1 * x[1] + .03 * x[0], v[1] = .1 * x[0] - .02 * x[1] * x[2], v[2] = .02 * x[0] * x[1];
    p->m[i] = dx * dx * dx, p->rho[i] = 1, p->h[i] = 2.15 * dx;
  }
  return p;
}

static double distance(const Parts *a, const Parts *b)
{
  double sum = 0;
  for (long i = 0; i < 3 * a->n; i++) sum += pow(a->x[i] - b->x[i], 2) + pow(a->v[i] - b->v[i], 2);
  for (long i = 0; i < a->n; i++) sum += pow(a->rho[i] - b->rho[i], 2) + pow(a->h[i] - b->h[i], 2);
  return sqrt(sum / (double)a->n);
}

/* `steps` steps of equal length to t. */
static Parts *run(Parts *p, double t, int steps, const char *integrator, const char *gravity,
                  const char *density)
{
  char max[64];
  Param par;
  Sim sim;
  Err err;
  SimStep done;
  snprintf(max, sizeof max, "step.max=%.17g", t / steps);
  par = lab_param("kernel=quintic_spline", "viscosity.alpha=0", "viscosity.beta=0", "gravity.G=.1",
                  "precision=double", "step.error=1", "step.cfl=2", "step.acceleration=2",
                  "step.density=10", integrator, gravity, density, max, NULL);
  lab_open(&sim, &par, p);
  for (int k = 0; k < steps; k++) {
    if (sim_advance(&sim, INFINITY, &done, &err)) fail_msg("%s", err.text);
    if (strcmp(sim_limit_name(done.limit), "max")) fail_msg("%s", sim_limit_name(done.limit));
  }
  lab_store(&sim, p);
  sim_close(&sim);
  return p;
}

typedef struct {
  const char *what, *gravity, *density;
  double t;
  int steps;
} Case;

static const Case cases[] = {
    {"segment", "gravity.method=none", "density=continuity", .8, 32},
    {"segment", "gravity.method=none", "density=sum", .8, 32},
    {"segment", "gravity.method=none", "density=miscible", .8, 32},
    {"segment", "gravity.method=none", "density=miscible_continuity", .8, 32},
    {"rubber", "gravity.method=none", "density=continuity", 2, 16},
    {"liquid", "gravity.method=direct", "density=continuity", 2, 16},
    {"liquid", "gravity.method=direct", "density=miscible", 2, 32},
};

static Parts *make(const Case *c)
{
  if (strcmp(c->what, "segment") == 0) return segment();
  return ball(strcmp(c->what, "rubber") == 0 ? RUBBER : LIQUID);
}

/* `more` times the steps of the cases. */
static void order_of(const char *integrator, int more, double low, double high)
{
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    const Case *c = &cases[k];
    Parts *p[4];
    double e[3], order[2];
    for (int level = 0; level < 4; level++)
      p[level] = run(make(c), c->t, (more * c->steps) << level, integrator, c->gravity, c->density);
    for (int level = 0; level < 3; level++) e[level] = distance(p[level], p[level + 1]);
    for (int level = 0; level < 4; level++) part_free(p[level]);
    for (int level = 0; level < 2; level++) order[level] = log(e[level] / e[level + 1]) / log(2);
    print_message("%s %s %s: %.1e %.1e %.1e, order %.2f %.2f\n", integrator, c->what, c->density,
                  e[0], e[1], e[2], order[0], order[1]);
    assert_true(order[1] > low && order[1] < high);
  }
}

static void orders(void **state)
{
#define COUNT(...) +1
  const int all = INTEGRATORS(COUNT);
  (void)state;
  for (int k = 0; k < all; k++) {
    char name[64];
    const int order = integrator_of(k)->order;
    snprintf(name, sizeof name, "integrator=%s", integrator_of(k)->name);
    order_of(name, order == 1 ? 8 : 1, order - .25, order + .35);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(orders)};
  omp_set_num_threads(1);
  return cmocka_run_group_tests(tests, NULL, NULL);
}
