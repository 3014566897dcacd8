/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Particles in memory. Every number of the samples follows from the particle's id, its field and
 * its column, so that after any move each row says by itself where it came from. The loops run over
 * the table: a new field is tested without an edit. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include <hdf5.h>

#include "lib/part.h"

static double number(const PartField *f, int64_t id, int k)
{
  return (double)(1000 * id + 10 * (f - part_fields) + k);
}

static int flaws_of(int64_t id) { return (int)(id % 4); }

static void put(void *array, char kind, long i, double value)
{
  if (kind == 'd')
    ((double *)array)[i] = value;
  else if (kind == 'l')
    ((int64_t *)array)[i] = (int64_t)value;
  else
    ((int32_t *)array)[i] = (int32_t)value;
}

static double get(const void *array, char kind, long i)
{
  if (kind == 'd') return ((const double *)array)[i];
  return kind == 'l' ? (double)((const int64_t *)array)[i] : (double)((const int32_t *)array)[i];
}

static void add_flaws(Parts *p)
{
  p->nflaw = calloc((size_t)p->n, sizeof *p->nflaw);
  for (long i = 0; i < p->n; i++) p->flaws += p->nflaw[i] = flaws_of(p->id[i]);
  p->flaw = calloc((size_t)p->flaws + 1, sizeof *p->flaw);
  for (long i = 0, k = 0; i < p->n; i++)
    for (int j = 0; j < p->nflaw[i]; j++) p->flaw[k++] = (double)p->id[i] + 0.1 * j;
}

/* A field that the schema does not know: two 16-bit numbers a row, id and -id. */
static void add_extra(Parts *p, const char *name)
{
  p->extra = realloc(p->extra, ((size_t)p->extras + 1) * sizeof *p->extra);
  PartExtra *x = memset(p->extra + p->extras++, 0, sizeof *x);
  strcpy(x->name, name);
  strcpy(x->unit, "K");
  x->type = H5Tcopy(H5T_NATIVE_INT16);
  x->rank = 2, x->dim[0] = x->width = 2, x->size = 4, x->unit_si = 1;
  x->data = calloc((size_t)p->n, 4);
  for (long i = 0; i < p->n; i++)
    memcpy(x->data + 4 * i, (int16_t[]){(int16_t)p->id[i], (int16_t)-p->id[i]}, 4);
}

static Parts *sample(long n, int64_t first)
{
  Err err;
  Parts *p = part_new(n);
  assert_non_null(p);
  for (const PartField *f = part_fields; f < part_fields + part_field_count; f++) {
    assert_int_equal(part_add(p, f->member, &err), 0);
    for (long i = 0; i < n * f->width; i++)
      put(part_array(p, f), f->kind, i, number(f, first + i / f->width, (int)(i % f->width)));
  }
  for (long i = 0; i < n; i++) p->id[i] = first + i, p->mat[i] = i % 2;
  assert_int_equal(part_add_material(p, "basalt", "rho0 = 2700", &err), 0);
  assert_int_equal(part_add_material(p, "ice", "rho0 = 917", &err), 1);
  add_flaws(p);
  add_extra(p, "Colour");
  return p;
}

/* Row i holds what belongs to its id, in every field but mat. */
static void assert_row(const Parts *p, long i)
{
  for (const PartField *f = part_fields; f < part_fields + part_field_count; f++)
    for (int k = 0; k < f->width && f->name != part_field("id")->name && strcmp(f->member, "mat");
         k++)
      assert_true(get(part_array(p, f), f->kind, i * f->width + k) == number(f, p->id[i], k));
  int64_t *start = part_flaw_start(p);
  assert_int_equal(start[i + 1] - start[i], flaws_of(p->id[i]));
  for (int64_t k = start[i]; k < start[i + 1]; k++)
    assert_true(p->flaw[k] == (double)p->id[i] + 0.1 * (double)(k - start[i]));
  free(start);
  int16_t x[2];
  memcpy(x, p->extra[0].data + 4 * i, 4);
  assert_int_equal(x[0], p->id[i]);
  assert_int_equal(x[1], -p->id[i]);
}

static void fields_are_found_by_both_names(void **state)
{
  (void)state;
  for (const PartField *f = part_fields; f < part_fields + part_field_count; f++) {
    assert_ptr_equal(part_field(f->member), f);
    assert_ptr_equal(part_field(f->name), f);
    assert_true(*f->unit && *f->maker && *f->meaning);
  }
  assert_null(part_field("rh"));
  assert_null(part_field(""));
}

static void new_fields_are_zero_and_kept(void **state)
{
  (void)state;
  Err err;
  Parts *p = part_new(5);
  assert_int_equal(p->dimension, 3);
  assert_int_equal(part_add(p, "  m  x ", &err), 0);
  for (int i = 0; i < 15; i++) assert_true(p->x[i] == 0);
  p->m[3] = 7;
  assert_int_equal(part_add(p, "m v", &err), 0);
  assert_true(p->m[3] == 7 && p->v);
  assert_int_equal(part_add(p, "m mass", &err), -1);
  assert_string_equal(err.text, "no such field: 'mass'");
  part_free(p);
}

static void need_names_the_field_and_its_maker(void **state)
{
  (void)state;
  Err err;
  Parts *p = part_new(2);
  part_add(p, "id x", &err);
  assert_int_equal(part_need(p, "id x", "a.h5", &err), 0);
  assert_int_equal(part_need(p, "id damage x", "a.h5", &err), -1);
  assert_string_equal(err.text, "'a.h5' lacks field 'Damage' (made by weibull)");
  assert_int_equal(part_need(p, "nflaw", "a.h5", &err), -1);
  assert_string_equal(err.text, "'a.h5' lacks field 'FlawCount' (made by weibull)");
  part_free(p);
}

/* A valid particle set for part_check. */
static Parts *valid(void)
{
  Err err;
  Parts *p = part_new(4);
  part_add(p, "id x v m rho u h mat body damage nact s", &err);
  part_add_material(p, "ice", "", &err);
  for (int i = 0; i < 4; i++) p->id[i] = 10 * (4 - i), p->m[i] = p->rho[i] = p->h[i] = 1;
  add_flaws(p); /* 0 2 0 2 */
  assert_int_equal(part_check(p, "a.h5", &err), 0);
  return p;
}

static void assert_refused(Parts *p, const char *message)
{
  Err err;
  assert_int_equal(part_check(p, "a.h5", &err), -1);
  assert_string_equal(err.text, message);
  part_free(p);
}

#define REFUSED(CHANGE, MESSAGE)                                                                   \
  do {                                                                                             \
    Parts *p = valid();                                                                            \
    CHANGE;                                                                                        \
    assert_refused(p, "'a.h5': " MESSAGE);                                                         \
  } while (0)

static void check_names_field_and_particle(void **state)
{
  (void)state;
  REFUSED(p->x[7] = NAN, "particle 20: Coordinates is nan, must be finite");
  REFUSED(p->v[0] = INFINITY, "particle 40: Velocities is inf, must be finite");
  REFUSED(p->s[23] = NAN, "particle 10: DeviatoricStress is nan, must be finite");
  REFUSED(p->u[1] = NAN, "particle 30: InternalEnergy is nan, must be finite");
  REFUSED(p->m[1] = -1, "particle 30: Masses is -1, must be positive");
  REFUSED(p->m[1] = 0, "particle 30: Masses is 0, must be positive");
  REFUSED(p->h[2] = 0, "particle 20: SmoothingLength is 0, must be positive");
  REFUSED(p->rho[2] = -3, "particle 20: Density is -3, must be positive");
  REFUSED(p->damage[0] = 1.5, "particle 40: Damage is 1.5, must be in 0..1");
  REFUSED(p->damage[0] = -0.5, "particle 40: Damage is -0.5, must be in 0..1");
  REFUSED(p->body[3] = -1, "particle 10: BodyID is -1, must be zero or positive");
  REFUSED(p->mat[3] = 1, "particle 10: MaterialID is 1, but /Materials holds 1");
  REFUSED(p->mat[3] = -1, "particle 10: MaterialID is -1, but /Materials holds 1");
  REFUSED(p->id[0] = 20, "ParticleIDs: 20 occurs twice");
  REFUSED(p->dimension = 4, "Dimension is 4, must be 1, 2 or 3");
  REFUSED(p->time = NAN, "Time is nan");
}

static void check_counts_flaws(void **state)
{
  (void)state;
  REFUSED(p->flaw[1] = 1, "particle 30: FlawThresholds is 1, must be ascending");
  REFUSED(p->flaw[3] = 0, "particle 10: FlawThresholds is 0, must be positive and finite");
  REFUSED(p->nflaw[1] = -1, "particle 30: FlawCount is -1, must be zero or positive");
  REFUSED(p->nflaw[1] = 3, "FlawCount does not add up to the 4 rows of FlawThresholds");
  REFUSED(free(p->nact); p->nact = NULL;
          p->nflaw[3] = 1, "FlawCount does not add up to the 4 rows of FlawThresholds");
  REFUSED(p->nact[1] = 3, "particle 30: ActiveFlaws is 3, must be in 0..FlawCount");
  REFUSED(p->nact[0] = -1, "particle 40: ActiveFlaws is -1, must be in 0..FlawCount");
}

static void select_keeps_rows_whole(void **state)
{
  (void)state;
  Err err;
  Parts *p = sample(50, 100);
  unsigned char keep[50];
  for (int i = 0; i < 50; i++) keep[i] = i % 3 == 1 || i > 45;
  p->time = 3, p->dimension = 2;
  part_history(p, "a", &err);
  Parts *q = part_select(p, keep, &err);
  assert_non_null(q);
  long k = 0;
  for (int i = 0; i < 50; i++) {
    if (!keep[i]) continue;
    assert_int_equal(q->id[k], p->id[i]);
    assert_int_equal(q->mat[k], p->mat[i]);
    assert_row(q, k++);
  }
  assert_int_equal(q->n, k);
  assert_true(q->time == 3 && q->dimension == 2 && q->materials == 2 && q->histories == 1);
  assert_string_equal(q->extra[0].unit, "K");
  part_free(p);
  part_free(q);
}

static void select_nothing_is_no_error(void **state)
{
  (void)state;
  Err err;
  Parts *p = sample(3, 0), *q = part_select(p, (unsigned char[3]){0}, &err);
  assert_non_null(q);
  assert_true(q->n == 0 && q->flaws == 0);
  part_free(p);
  part_free(q);
}

/* A permutation and its inverse are the identity; in between each row is whole and where order
 * says. */
static void permute_moves_rows_whole(void **state)
{
  (void)state;
  Err err;
  enum { N = 64 };
  long order[N], back[N];
  Parts *p = sample(N, 7);
  const double *x = p->x;
  for (long i = 0; i < N; i++) order[i] = (i * 27 + 5) % N, back[order[i]] = i;
  assert_int_equal(part_permute(p, order, &err), 0);
  assert_ptr_equal(p->x, x);
  for (long i = 0; i < N; i++) {
    assert_int_equal(p->id[i], 7 + order[i]);
    assert_int_equal(p->mat[i], order[i] % 2);
    assert_row(p, i);
  }
  assert_int_equal(part_permute(p, back, &err), 0);
  for (long i = 0; i < N; i++) assert_int_equal(p->id[i], 7 + i), assert_row(p, i);
  part_free(p);
}

static void join_is_a_then_b(void **state)
{
  (void)state;
  Err err;
  Parts *a = sample(10, 0), *b = sample(20, 100);
  Parts *q = part_join(a, b, &err);
  assert_non_null(q);
  assert_int_equal(q->n, 30);
  for (long i = 0; i < 30; i++) {
    assert_int_equal(q->id[i], i < 10 ? i : 90 + i);
    assert_row(q, i);
  }
  part_free(a);
  part_free(b);
  part_free(q);
}

static void join_fills_what_one_lacks_with_zeros(void **state)
{
  (void)state;
  Err err;
  for (int swap = 0; swap < 2; swap++) {
    Parts *full = sample(6, 1), *bare = part_new(3);
    part_add(bare, "id x", &err);
    for (int i = 0; i < 3; i++) bare->id[i] = 50 + i;
    Parts *q = swap ? part_join(bare, full, &err) : part_join(full, bare, &err);
    assert_non_null(q);
    long zero = swap ? 0 : 6, rows = swap ? 3 : 0;
    for (long i = 0; i < 6; i++) assert_row(q, rows + i);
    for (long i = zero; i < zero + 3; i++)
      assert_true(q->rho[i] == 0 && q->s[6 * i + 5] == 0 && q->nflaw[i] == 0 &&
                  !memcmp(q->extra[0].data + 4 * i, "\0\0\0", 4));
    assert_int_equal(q->flaws, full->flaws);
    part_free(full);
    part_free(bare);
    part_free(q);
  }
}

/* Matter without the field has no pores: its distention is 1, whichever of the two lacks it. */
static void join_knows_what_has_no_pores(void **state)
{
  (void)state;
  Err err;
  for (int swap = 0; swap < 2; swap++) {
    Parts *porous = part_new(2), *solid = part_new(3);
    part_add(porous, "id x", &err), part_add(solid, "id x", &err);
    for (int i = 0; i < 3; i++) solid->id[i] = 50 + i, porous->id[i % 2] = i % 2;
    porous->extra = calloc(1, sizeof *porous->extra), porous->extras = 1;
    *porous->extra = (PartExtra){.name = "Distention", .rank = 1, .width = 1, .size = 4};
    porous->extra->type = H5Tcopy(H5T_NATIVE_FLOAT);
    porous->extra->data = calloc(2, 4);
    memcpy(porous->extra->data, (float[2]){1.5f, 2}, 8);
    Parts *q = swap ? part_join(solid, porous, &err) : part_join(porous, solid, &err);
    assert_non_null(q);
    const float want[2][5] = {{1.5f, 2, 1, 1, 1}, {1, 1, 1, 1.5f, 2}};
    assert_memory_equal(q->extra->data, want[swap], sizeof want[swap]);
    part_free(porous), part_free(solid), part_free(q);
  }
}

/* The material a particle is made of does not change, whatever its index becomes. */
static void join_keeps_each_particle_its_material(void **state)
{
  (void)state;
  Err err;
  Parts *a = part_new(2), *b = part_new(3);
  part_add(a, "id mat", &err), part_add(b, "id mat", &err);
  part_add_material(a, "ice", "v1", &err), part_add_material(a, "basalt", "v1", &err);
  part_add_material(b, "basalt", "v1", &err), part_add_material(b, "ice", "v2", &err);
  part_add_material(b, "ice", "v1", &err);
  a->id[0] = 1, a->id[1] = 2, a->mat[1] = 1;
  for (int i = 0; i < 3; i++) b->id[i] = 10 + i, b->mat[i] = i;
  Parts *q = part_join(a, b, &err);
  assert_non_null(q);
  assert_int_equal(q->materials, 3);
  for (long i = 0; i < 5; i++) {
    const PartMaterial *was = i < 2 ? a->material + a->mat[i] : b->material + b->mat[i - 2];
    assert_string_equal(q->material[q->mat[i]].name, was->name);
    assert_string_equal(q->material[q->mat[i]].text, was->text);
  }
  part_free(a);
  part_free(b);
  part_free(q);
}

static void join_refuses_what_does_not_fit(void **state)
{
  (void)state;
  Err err;
  Parts *a = sample(4, 0), *b = sample(4, 3);
  assert_null(part_join(a, b, &err));
  assert_string_equal(err.text, "particle id 3 occurs twice");
  for (int i = 0; i < 4; i++) b->id[i] += 100;
  b->dimension = 2;
  assert_null(part_join(a, b, &err));
  assert_string_equal(err.text, "bodies of 3 and 2 dimensions");
  b->dimension = 3, strcpy(b->extra[0].unit, "eV");
  assert_null(part_join(a, b, &err));
  assert_string_equal(err.text,
                      "field 'Colour' has another shape, type or unit in the second body");
  strcpy(b->extra[0].unit, "K"), b->mat[2] = 2;
  assert_null(part_join(a, b, &err));
  assert_string_equal(err.text, "MaterialID 2, but /Materials holds 2");
  part_free(a);
  part_free(b);
}

static void join_keeps_names_of_both(void **state)
{
  (void)state;
  Err err;
  Parts *a = sample(2, 0), *b = sample(2, 10);
  part_history(a, "mksphere a", &err), part_history(b, "mksphere b", &err);
  part_set_number(a, "body", "Radius0", 1, &err), part_set_number(b, "body", "Radius0", 2, &err);
  part_set_number(b, "body", "Radius1", 3, &err), a->time = 5;
  Parts *q = part_join(a, b, &err);
  assert_int_equal(q->histories, 2);
  assert_string_equal(q->history[0], "mksphere a\t" BRECCIA_VERSION);
  assert_string_equal(q->history[1], "mksphere b\t" BRECCIA_VERSION);
  assert_true(part_number(q, "body", "Radius0") == 1 && part_number(q, "body", "Radius1") == 3);
  assert_true(q->time == 5);
  part_free(a);
  part_free(b);
  part_free(q);
}

static void numbers_are_set_and_replaced(void **state)
{
  (void)state;
  Err err;
  Parts *p = part_new(1);
  assert_true(isnan(part_number(p, "collision", "EscapeSpeed")));
  assert_int_equal(part_set_number(p, "collision", "EscapeSpeed", 500, &err), 0);
  assert_int_equal(part_set_number(p, "collision", "EscapeSpeed", 510, &err), 0);
  assert_int_equal(p->collisions, 1);
  assert_true(part_number(p, "collision", "EscapeSpeed") == 510);
  assert_true(isnan(part_number(p, "body", "EscapeSpeed")));
  assert_int_equal(part_set_number(p, "other", "a", 1, &err), -1);
  assert_int_equal(part_set_number(p, "body", "", 1, &err), -1);
  char longest[80] = {0};
  memset(longest, 'a', 64);
  assert_int_equal(part_set_number(p, "body", longest, 1, &err), -1);
  assert_int_equal(part_add_material(p, longest, "", &err), -1);
  part_free(p);
}

static void equal_materials_are_one(void **state)
{
  (void)state;
  Err err;
  Parts *p = part_new(1);
  assert_int_equal(part_add_material(p, "ice", "a", &err), 0);
  assert_int_equal(part_add_material(p, "ice", "b", &err), 1);
  assert_int_equal(part_add_material(p, "ice", "a", &err), 0);
  assert_int_equal(p->materials, 2);
  part_free(p);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(fields_are_found_by_both_names),
      cmocka_unit_test(new_fields_are_zero_and_kept),
      cmocka_unit_test(need_names_the_field_and_its_maker),
      cmocka_unit_test(check_names_field_and_particle),
      cmocka_unit_test(check_counts_flaws),
      cmocka_unit_test(select_keeps_rows_whole),
      cmocka_unit_test(select_nothing_is_no_error),
      cmocka_unit_test(permute_moves_rows_whole),
      cmocka_unit_test(join_is_a_then_b),
      cmocka_unit_test(join_fills_what_one_lacks_with_zeros),
      cmocka_unit_test(join_knows_what_has_no_pores),
      cmocka_unit_test(join_keeps_each_particle_its_material),
      cmocka_unit_test(join_refuses_what_does_not_fit),
      cmocka_unit_test(join_keeps_names_of_both),
      cmocka_unit_test(numbers_are_set_and_replaced),
      cmocka_unit_test(equal_materials_are_one),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
