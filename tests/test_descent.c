/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Objects through dumps: shares against all pairs of labels; tracks through histories made by hand:
 * splitting, merging, touching for a while, dispersal, loss of particles; any order of rows. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>
#include "lib/follow.h"
#include "lib/rng.h"

static Err err;

/* n particles with ids 5, 8, 11 ... in an order of their own; mass 1 + id/1000. */
static Parts *dump(long n, int seed, double time)
{
  Parts *p = part_new(n);
  assert_return_code(part_add(p, "id m", &err), 0);
  long *order = malloc((size_t)n * sizeof *order);
  for (long i = 0; i < n; i++) order[i] = i;
  for (long i = n - 1; i > 0 && seed; i--) {
    const long j = (long)(rng_uniform((uint64_t)seed, (uint64_t)i, 0) * (double)(i + 1)),
               k = order[i];
    order[i] = order[j], order[j] = k;
  }
  for (long i = 0; i < n; i++) p->id[i] = 5 + 3 * order[i], p->m[i] = 1 + 1e-3 * (double)p->id[i];
  p->time = time, free(order);
  return p;
}

static int32_t random_label(int seed, int64_t id, int objects)
{
  return (int32_t)(rng_uniform((uint64_t)seed, (uint64_t)id, 1) * (objects + 1));
}

/* Another 300 particles are only in the second. */
static void shares_of_all_pairs(void **state)
{
  enum { A = 5, B = 7 };
  (void)state;
  for (int seed = 1; seed < 5; seed++) {
    Parts *p = dump(2000, seed, 0), *q = dump(2300, seed + 100, 1);
    int32_t *a = calloc(2000, sizeof *a), *b = calloc(2300, sizeof *b);
    double mass[A + 1][B + 1] = {{0}};
    for (long i = 0; i < p->n; i++) a[i] = random_label(1, p->id[i], A);
    for (long i = 0; i < q->n; i++) b[i] = random_label(2, q->id[i], B);
    for (long k = 0; k < 2000; k++) {
      const int64_t id = 5 + 3 * k;
      mass[random_label(1, id, A)][random_label(2, id, B)] += 1 + 1e-3 * (double)id;
    }
    Descent before, after;
    long n = 0, up[B + 1], down[A + 1];
    assert_return_code(descent_open(&before, p, a, A, &err), 0);
    assert_return_code(descent_open(&after, q, b, B, &err), 0);
    DescentShare *s = descent_shares(&before, &after, &n, &err);
    assert_non_null(s);
    assert_int_equal(n, (A + 1) * (B + 1));
    for (long k = 0; k < n; k++) {
      assert_int_equal(s[k].from, k / (B + 1));
      assert_int_equal(s[k].to, k % (B + 1));
      assert_true(s[k].mass == mass[s[k].from][s[k].to]); /* summed in the order of ids as here */
    }
    descent_main(s, n, A, B, up, down);
    for (int j = 1; j <= B; j++)
      for (int i = 1; i <= A; i++) {
        assert_true(s[up[j]].mass >= mass[i][j] && s[up[j]].to == j);
        assert_true(s[down[i]].mass >= mass[i][j] && s[down[i]].from == i);
      }
    free(s), free(a), free(b), part_free(p), part_free(q);
    descent_close(&before), descent_close(&after);
  }
}

/* A dump of which text says the objects, a digit a particle, by ascending id, '.' where there is no
 * particle; returns the tracks of its objects 1 .. as a string. */
static const char *step(Follow *f, const char *text, int seed)
{
  static char tracks[64];
  static double time;
  const long n = (long)strlen(text);
  Parts *p = dump(n, seed, time += 1);
  int32_t *object = calloc((size_t)n, sizeof *object);
  long objects = 0, kept = 0;
  FollowObject *before;
  for (long i = 0; i < n; i++) {
    const char c = text[(p->id[i] - 5) / 3];
    if (c == '.') continue;
    p->id[kept] = p->id[i], p->m[kept] = 1, object[kept] = c - '0';
    if (object[kept] > objects) objects = object[kept];
    kept++;
  }
  p->n = kept;
  assert_return_code(follow_step(f, p, object, objects, &before, &err), 0);
  for (long k = 1; k <= objects; k++) tracks[k - 1] = (char)('0' + f->object[k].track);
  tracks[objects] = 0;
  free(before), free(object), part_free(p);
  return tracks;
}

static void histories(void **state)
{
  (void)state;
  for (int seed = 0; seed < 3; seed++) {
    Follow f = {0};
    assert_string_equal(step(&f, "1111111112222000", seed), "12");  /* two bodies */
    assert_string_equal(step(&f, "1111112223333000", seed), "132"); /* one loses a third */
    assert_int_equal(f.track[3].parent, 1);
    assert_string_equal(step(&f, "2222221111111111", seed), "21"); /* it joins the other */
    assert_int_equal(f.track[3].into, 2);
    assert_int_equal(f.object[1].progenitor, 3);
    assert_true(fabs(f.object[1].inherited - 0.4) < 1e-12);
    assert_string_equal(step(&f, "0000001111111111", seed), "2"); /* the first disperses */
    assert_true(f.track[1].into == 0 && f.track[1].object == 0 && f.track[1].last > 0);
    assert_string_equal(step(&f, "2222.01111111111", seed), "21");  /* and gathers again */
    assert_string_equal(step(&f, "33..021111111111", seed), "241"); /* one out of nothing */
    assert_true(f.track[4].parent == 0 && f.object[2].progenitor == 0);
    follow_close(&f);
  }
}

/* More than half of a body that ended must be in what goes on as it, and half of that be it. */
static void half_is_not_enough(void **state)
{
  (void)state;
  for (int more = 0; more < 2; more++) {
    Follow f = {0};
    assert_string_equal(step(&f, "1111111122220000", 1), "12");
    assert_string_equal(step(&f, "0000000011110000", 2), "2");
    assert_string_equal(step(&f, more ? "2222200011110000" : "2222000011110000", 3),
                        more ? "21" : "23");
    follow_close(&f);
    assert_string_equal(step(&f, "1110222222220000", 1), "12");
    assert_string_equal(step(&f, "0000111111110000", 2), "2");
    assert_string_equal(step(&f, more ? "2220111111110022" : "2220111111110222", 3),
                        more ? "21" : "23");
    follow_close(&f);
  }
}

static void bodies_that_touch(void **state)
{
  (void)state;
  Follow f = {0};
  assert_string_equal(step(&f, "111111222220", 1), "12");
  assert_string_equal(step(&f, "111111111110", 2), "1");
  assert_int_equal(f.track[2].into, 1);
  assert_string_equal(step(&f, "111111111101", 3), "1");
  assert_string_equal(step(&f, "222222011110", 4), "21"); /* the second is itself again */
  assert_true(f.track[2].into == 0 && f.track[2].parent == 0 && f.track[2].dumps == 2);
  assert_string_equal(step(&f, "222211011110", 5), "21");
  assert_string_equal(step(&f, "222211111110", 6), "21");
  follow_close(&f);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(shares_of_all_pairs),
      cmocka_unit_test(histories),
      cmocka_unit_test(half_is_not_enough),
      cmocka_unit_test(bodies_that_touch),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
