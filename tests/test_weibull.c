/* SPDX-License-Identifier: GPL-3.0-or-later */
/* lib/weibull: thresholds, numbers and spread of flaws (docs/theory.md 3.5). */
#include <math.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <setjmp.h>
#include <cmocka.h>
#include <gsl/gsl_cdf.h>
#include <gsl/gsl_randist.h>
#include <hdf5.h>
#include "../lib/rng.h"
#include "../lib/weibull.h"

static const Material BASALT = {
    .damage = {.form = DAMAGE_GRADY_KIPP, .grady_kipp = {.k = 5e34, .m = 8.5, .crack = 0.4}}};

/* A sphere of 3 cm radius (001 sect. 4.4) of n particles, ids 10, 13, 16 ... */
static Parts *sphere(long n)
{
  Parts *p = part_new(n);
  Err err;
  assert_non_null(p);
  assert_int_equal(part_add(p, "id m rho mat body", &err), 0);
  for (long i = 0; i < n; i++) {
    p->id[i] = 10 + 3 * i, p->rho[i] = 2700;
    p->m[i] = 2700 * 4 * acos(-1) / 3 * pow(0.03, 3) / (double)n;
  }
  p->materials = 1;
  return p;
}

static void done(Parts *p)
{
  p->materials = 0; /* they have no text here */
  part_free(p);
}

static WeibullGroup assign_by(Parts *p, const Material *material, const WeibullOptions *o)
{
  WeibullGroup *group, first;
  Err err;
  int n;
  if (weibull_assign(p, material, o, &group, &n, &err)) fail_msg("%s", err.text);
  assert_int_equal(n, 1);
  first = group[0];
  free(group);
  return first;
}

static WeibullGroup assign(Parts *p, const Material *material, uint64_t seed, double k, double m)
{
  return assign_by(p, material, &(WeibullOptions){.seed = seed, .k = &k, .m = &m, .minimum = 1});
}

static int by_value(const void *a, const void *b)
{
  double p = *(const double *)a, q = *(const double *)b;
  return (p > q) - (p < q);
}

static double harmonic(long n)
{
  double h = 0;
  for (long k = 1; k <= n; k++) h += 1 / (double)k;
  return h;
}

/* The lowest thresholds of the sphere, (1/(k V))^(1/m) to four digits after the point. */
static void test_lowest(void **state)
{
  const double want[][3] = {
      {5e34, 8, 1.4320e-4}, {5e34, 8.5, 2.4103e-4}, {4e35, 9, 3.0389e-4}, {1e61, 16, 2.7174e-4}};
  (void)state;
  for (int k = 0; k < 4; k++) {
    Parts *p = sphere(50);
    double low = assign(p, &BASALT, 7, want[k][0], want[k][1]).lowest;
    assert_true(fabs(low / want[k][2] - 1) < 5e-5);
    done(p);
  }
}

/* Large k V: Ceres with k = 1e61, and what overflows a double: logarithms, not (j/(k V))^(1/m). */
static void test_large(void **state)
{
  double e = weibull_threshold(1, 1e61, 16, 3.5e17);
  (void)state;
  assert_true(fabs(e / pow(3.5e78, -1. / 16) - 1) < 1e-13);
  e = weibull_threshold(1000, 1e300, 50, 1e20);
  assert_true(fabs(log10(e) * 50 - 3 + 320) < 1e-10);
}

/* Thresholds together are exactly (j/(k V))^(1/m), j = 1..n; ascending in each particle; none
 * without; the number that a strain e activates is k V e^m to one flaw. */
static void test_thresholds(void **state)
{
  Parts *p = sphere(2000);
  WeibullGroup g = assign(p, &BASALT, 1, NAN, NAN);
  double *all = malloc((size_t)p->flaws * sizeof *all), kv = 5e34 * 4 * acos(-1) / 3 * pow(0.03, 3);
  int64_t at = 0;
  (void)state;
  assert_true(p->flaws == g.flaws);
  for (long i = 0; i < p->n; at += p->nflaw[i++]) {
    assert_true(p->nflaw[i] >= 1 && p->damage[i] == 0);
    for (int k = 1; k < p->nflaw[i]; k++) assert_true(p->flaw[at + k] > p->flaw[at + k - 1]);
  }
  assert_true(at == p->flaws);
  memcpy(all, p->flaw, (size_t)p->flaws * sizeof *all);
  qsort(all, (size_t)p->flaws, sizeof *all, by_value);
  for (int64_t j = 1; j <= p->flaws; j++) {
    assert_true(fabs(all[j - 1] / pow((double)j / kv, 1 / 8.5) - 1) < 1e-12);
    assert_true(fabs(kv * pow(all[j - 1], 8.5) - (double)j) < 1e-7);
  }
  assert_true(g.lowest == all[0] && g.highest == all[p->flaws - 1]);
  free(all), done(p);
}

/* Flaws thrown: N H_N on average; n/N - ln N is Gumbel distributed with a standard deviation of
 * pi/sqrt(6): the mean of 200 seeds within 4 of its standard errors, and 1 % of them 4 or more away
 * (9 or more of 200: p = 3e-4). */
static void test_number(void **state)
{
  const long n = 500, seeds = 200;
  double sum = 0, h = harmonic(n);
  int far = 0;
  (void)state;
  for (long seed = 0; seed < seeds; seed++) {
    Parts *p = sphere(n);
    double each = (double)assign(p, &BASALT, (uint64_t)seed, NAN, NAN).flaws / (double)n;
    far += fabs(each - h) >= 4;
    sum += each;
    done(p);
  }
  assert_true(fabs(sum / (double)seeds - h) < 4 * acos(-1) / sqrt(6. * (double)seeds));
  assert_true(far < 9);
}

/* Flaws fall on all particles alike. Conditioned on the last empty particle's end, the counts of
 * the others are those of uniform throws: chi squared of the first n counts, p in 0.001..0.999. */
static void test_uniform(void **state)
{
  const long n = 20000;
  Parts *p = sphere(n);
  WeibullGroup g = assign(p, &BASALT, 3, NAN, NAN);
  double mean = (double)g.flaws / (double)n, chi2 = 0, tail;
  (void)state;
  for (long i = 0; i < n; i++) chi2 += pow(p->nflaw[i] - mean, 2) / mean;
  tail = gsl_cdf_chisq_Q(chi2, (double)(n - 1));
  assert_true(tail > 1e-3 && tail < 1 - 1e-3);
  done(p);
}

/* Counts are distributed like Poisson with the mean n/N: chi squared over the classes that expect
 * 20 particles and more. */
static void test_poisson(void **state)
{
  enum { CLASSES = 64 };
  const long n = 20000;
  Parts *p = sphere(n);
  WeibullGroup g = assign(p, &BASALT, 4, NAN, NAN);
  double mean = (double)g.flaws / (double)n, chi2 = 0;
  int seen[CLASSES] = {0}, classes = 0;
  (void)state;
  for (long i = 0; i < n; i++) seen[p->nflaw[i] < CLASSES ? p->nflaw[i] : CLASSES - 1]++;
  for (unsigned k = 0; k < CLASSES - 1; k++) {
    double want = (double)n * gsl_ran_poisson_pdf(k, mean);
    if (want < 20) continue;
    chi2 += pow(seen[k] - want, 2) / want, classes++;
  }
  assert_true(classes > 10 && gsl_cdf_chisq_Q(chi2, classes - 1) > 1e-3);
  done(p);
}

/* The same flaws for each id, whatever the order of the particles; other seeds, bodies and
 * materials give others. */
static void test_order(void **state)
{
  const long n = 1000;
  Parts *a = sphere(n), *b = sphere(n), *c = sphere(n);
  long *order = malloc((size_t)n * sizeof *order);
  int64_t *sa, *sb;
  Err err;
  (void)state;
  for (long i = 0; i < n; i++) order[i] = (i * 617 + 101) % n;
  assert_int_equal(part_permute(b, order, &err), 0);
  assign(a, &BASALT, 5, NAN, NAN), assign(b, &BASALT, 5, NAN, NAN), assign(c, &BASALT, 6, NAN, NAN);
  assert_true(a->flaws == b->flaws);
  sa = part_flaw_start(a), sb = part_flaw_start(b);
  for (long i = 0; i < n; i++) {
    assert_true(b->id[i] == a->id[order[i]] && b->nflaw[i] == a->nflaw[order[i]]);
    assert_memory_equal(b->flaw + sb[i], a->flaw + sa[order[i]],
                        (size_t)b->nflaw[i] * sizeof(double));
  }
  assert_true(memcmp(a->nflaw, c->nflaw, (size_t)n * sizeof *a->nflaw));
  free(order), free(sa), free(sb), done(a), done(b), done(c);
}

/* Each body and each brittle material by itself, with its own volume; others get no flaws; a second
 * pass starts afresh. */
static void test_groups(void **state)
{
  Material material[3] = {BASALT, {.mu = 1}, BASALT};
  Parts *p = sphere(900);
  const WeibullOptions o = {.seed = 1, .minimum = 1};
  WeibullGroup *g;
  Err err;
  int n;
  (void)state;
  p->materials = 3;
  for (long i = 0; i < 900; i++)
    p->body[i] = i >= 300, p->mat[i] = i < 750 ? (int32_t)(i / 150 % 3) : 1,
    p->rho[i] *= 1 + p->body[i];
  material[2].damage.grady_kipp.m = 9;
  for (int pass = 0; pass < 2; pass++) {
    assert_int_equal(weibull_assign(p, material, &o, &g, &n, &err), 0);
    assert_int_equal(n, 3); /* body 0: materials 0 and 1; body 1: 2, 0, 1, 1 */
    assert_true(g[0].body == 0 && g[0].mat == 0 && g[0].n == 150 && g[0].m == 8.5);
    assert_true(g[1].body == 1 && g[1].mat == 0 && g[1].n == 150);
    assert_true(g[2].body == 1 && g[2].mat == 2 && g[2].n == 150 && g[2].m == 9);
    assert_true(fabs(g[0].volume / g[1].volume - 2) < 1e-12);
    assert_true(p->flaws == g[0].flaws + g[1].flaws + g[2].flaws);
    for (long i = 0; i < 900; i++) assert_true((p->nflaw[i] > 0) == (p->mat[i] != 1));
    for (int a = 0; a < 450; a += 300) /* not the same throws */
      assert_true(memcmp(p->nflaw + a, p->nflaw + 450, 150 * sizeof *p->nflaw));
    free(g);
  }
  p->materials = 1;
  done(p);
}

/* Each body by its own seed: another seed for one leaves the other as it is. */
static void test_seeds(void **state)
{
  enum { N = 600 };
  const WeibullSeed own = {1, 7};
  int32_t counts[2][N];
  WeibullGroup *g;
  Err err;
  int n;
  (void)state;
  for (int k = 0; k < 2; k++) {
    Parts *p = sphere(N);
    const WeibullOptions o = {.seed = 3, .minimum = 1, .seeds = &own, .bodies = k};
    for (long i = N / 2; i < N; i++) p->body[i] = 1;
    assert_int_equal(weibull_assign(p, &BASALT, &o, &g, &n, &err), 0);
    assert_true(n == 2 && g[0].seed == 3 && g[1].seed == (k ? 7 : 3));
    memcpy(counts[k], p->nflaw, sizeof counts[k]);
    free(g), done(p);
  }
  assert_memory_equal(counts[0], counts[1], N / 2 * sizeof **counts);
  assert_true(memcmp(counts[0] + N / 2, counts[1] + N / 2, N / 2 * sizeof **counts));
}

/* k and m of one material only. */
static void test_parameters(void **state)
{
  Material material[2] = {BASALT, BASALT};
  const double k[2] = {NAN, 4e35}, m[2] = {NAN, 9};
  const WeibullOptions o = {.seed = 1, .k = k, .m = m, .minimum = 1};
  Parts *p = sphere(200);
  WeibullGroup *g;
  Err err;
  int n;
  (void)state;
  p->materials = 2;
  for (long i = 0; i < 100; i++) p->mat[i] = 1;
  assert_int_equal(weibull_assign(p, material, &o, &g, &n, &err), 0);
  assert_true(n == 2 && g[0].k == 5e34 && g[0].m == 8.5 && g[1].k == 4e35 && g[1].m == 9);
  free(g), done(p);
}

static void add_distention(Parts *p, double alpha)
{
  p->extra = calloc(1, sizeof *p->extra), p->extras = 1;
  *p->extra = (PartExtra){.name = "Distention", .rank = 1, .width = 1, .size = 4, .unit_si = 1};
  p->extra->type = H5Tcopy(H5T_NATIVE_FLOAT);
  p->extra->data = malloc((size_t)p->n * 4);
  for (long i = 0; i < p->n; i++) memcpy(p->extra->data + 4 * i, &(float){(float)alpha}, 4);
}

/* Pores do not break: twice the volume of the same mass by pores has the same flaws. */
static void test_pores(void **state)
{
  Parts *solid = sphere(300), *porous = sphere(300), *bad = sphere(3);
  WeibullGroup g, q, *none;
  const WeibullOptions o = {.seed = 1, .minimum = 1};
  Err err = {""};
  int n;
  (void)state;
  for (long i = 0; i < 300; i++) porous->rho[i] /= 2;
  add_distention(porous, 2), add_distention(bad, 0);
  g = assign(solid, &BASALT, 4, NAN, NAN), q = assign(porous, &BASALT, 4, NAN, NAN);
  assert_true(g.volume == q.volume && g.flaws == q.flaws && g.lowest == q.lowest);
  assert_memory_equal(solid->flaw, porous->flaw, (size_t)g.flaws * sizeof(double));
  assert_int_equal(weibull_assign(bad, &BASALT, &o, &none, &n, &err), -1);
  assert_non_null(strstr(err.text, "Distention is 0"));
  done(solid), done(porous), done(bad);
}

/* The number expected: N H_N for one each; for two and five of each against the mean of 60
 * throws (their scatter is pi/sqrt(6) N); from a given number on never less than that. */
static void test_expected(void **state)
{
  (void)state;
  double scatter;
  for (long n = 1; n < 100000; n *= 7) {
    double variance = 0; /* of a sum of geometric numbers: sum (1 - p)/p^2, p = k/n */
    for (long k = 1; k < n; k++) variance += (double)n * (double)(n - k) / ((double)k * (double)k);
    assert_true(fabs(weibull_expected(n, 1, 0, &scatter) / ((double)n * harmonic(n)) - 1) < 1e-9);
    assert_true(fabs(scatter - sqrt(variance)) < 1e-6 * (double)n + 1e-3);
  }
  assert_true(weibull_expected(1, 5, 0, &scatter) - 5 < 1e-8); /* one particle takes exactly five */
  assert_true(scatter < 1e-3);
  for (int minimum = 2; minimum < 6; minimum += 3) {
    const long n = 400, seeds = 60;
    double sum = 0, want = weibull_expected(n, minimum, 0, &scatter) / (double)n;
    for (long seed = 0; seed < seeds; seed++) {
      const WeibullOptions o = {.seed = (uint64_t)seed, .minimum = minimum};
      Parts *p = sphere(n);
      WeibullGroup g = assign_by(p, &BASALT, &o);
      assert_true(g.least == minimum && g.expected == want * (double)n);
      sum += (double)g.flaws / (double)n;
      done(p);
    }
    assert_true(fabs(sum / (double)seeds - want) < 4 * acos(-1) / sqrt(6. * (double)seeds));
  }
  assert_true(weibull_expected(1000, 1, 30, &scatter) >= 30000);
  assert_true(weibull_expected(1000, 1, 30, &scatter) <
              30000 * (1 + 1e-9)); /* 1000 exp(-30) are left */
  assert_true(fabs(weibull_expected(1000, 0, 2.5, &scatter) - 2500) < 1e-9);
}

/* A number of flaws instead of a minimum: exactly that many; exp(-x) of the particles have none,
 * and the weakest flaws of the others are as strong as they should be. With one for everyone the
 * same. */
static void test_weakest(void **state)
{
  const long n = 20000;
  (void)state;
  for (int minimum = 0; minimum < 2; minimum++) {
    const WeibullOptions o = {.seed = 8, .minimum = minimum, .flaws = minimum ? 0 : 1.5};
    Parts *p = sphere(n);
    WeibullGroup g = assign_by(p, &BASALT, &o);
    double sum = 0, share, empty = 0;
    for (long i = 0, at = 0; i < n; at += p->nflaw[i++])
      if (p->nflaw[i])
        sum += p->flaw[at];
      else
        empty++;
    share = minimum ? 0 : exp(-1.5);
    assert_true(fabs(empty / (double)n - share) <= 4 * sqrt(share * (1 - share) / (double)n));
    assert_true(fabs(sum / ((double)n - empty) / g.weakest - 1) < 1e-12);
    /* a Weibull deviate of shape 8.5 scatters by 14 %: 4 standard errors */
    assert_true(fabs(g.weakest / g.weakest_expected - 1) < 4 * 0.14 / sqrt((double)n));
    if (!minimum) assert_true(g.flaws == 30000 && g.least == 0);
    done(p);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_lowest),     cmocka_unit_test(test_large),
      cmocka_unit_test(test_thresholds), cmocka_unit_test(test_number),
      cmocka_unit_test(test_uniform),    cmocka_unit_test(test_poisson),
      cmocka_unit_test(test_order),      cmocka_unit_test(test_groups),
      cmocka_unit_test(test_seeds),      cmocka_unit_test(test_parameters),
      cmocka_unit_test(test_pores),      cmocka_unit_test(test_expected),
      cmocka_unit_test(test_weakest),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
