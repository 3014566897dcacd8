/* SPDX-License-Identifier: GPL-3.0-or-later */
/* pressure_form: at one pressure and a jump of density the product exerts no force, the squares do;
 * where density is the same the two are one. */
#include <stdio.h>
#include "lab.h"

static const char GAS[] = "name = \"g\"; eos = { form = \"ideal\"; gamma = 1.4; };";
static const double DX = 0.1, P = 2;

static int in_box(const double *x, void *data)
{
  (void)data;
  return fabs(x[0]) < 1 && fabs(x[1]) < 0.75 && fabs(x[2]) < 0.75;
}

/* The largest acceleration in the middle of a box at pressure P, density 1 left of x = 0 and `rho`
 * right of it, over P/(rho h). */
static double push(double rho, const char *form)
{
  long n = lab_lattice(DX, 10, 3, in_box, NULL, NULL);
  Parts *p = lab_parts(n, 3, GAS);
  Param par = lab_param("gravity.method=none", "precision=double", form, NULL);
  Sim sim;
  double worst = 0;
  lab_lattice(DX, 10, 3, in_box, NULL, p->x);
  for (long i = 0; i < n; i++) {
    p->rho[i] = p->x[3 * i] < 0.01 ? 1 : rho, p->u[i] = P / 0.4 / p->rho[i];
    p->m[i] = p->rho[i] * DX * DX * DX, p->h[i] = 2.5 * DX;
  }
  lab_open(&sim, &par, p);
  lab_store(&sim, p);
  for (long i = 0; i < n; i++) {
    const double *x = &p->x[3 * i], *a = &p->a[3 * i];
    if (fabs(x[0]) > 0.6 || fabs(x[1]) > 0.3 || fabs(x[2]) > 0.3) continue;
    for (int d = 0; d < 3; d++) worst = fmax(worst, fabs(a[d]) * p->rho[i] * p->h[i] / P);
  }
  sim_close(&sim), part_free(p);
  return worst;
}

static void jump(void **state)
{
  double product = push(3, "pressure_form=product"), squares = push(3, "pressure_form=squares");
  (void)state;
  print_message("a rho h/p at a jump of 3: product %.1e, squares %.2f\n", product, squares);
  assert_true(product < 1e-12 && squares > 0.1);
  assert_true(push(1, "pressure_form=product") < 1e-12 && push(1, "pressure_form=squares") < 1e-12);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(jump)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
