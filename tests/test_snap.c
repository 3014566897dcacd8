/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Snapshots: what is written comes back bit by bit, for every row of the table; the layout that
 * other readers need (ecosystem: yt, pynbody, ParaView), checked through HDF5 itself. */
#include <math.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>
#include <cmocka.h>

#include <hdf5.h>

#include "snaps.h"

enum { N = 300 };
static void add_extra(Parts *p, const char *name, hid_t type, int rank, int a, int b,
                      uint64_t *seed)
{
  p->extra = realloc(p->extra, ((size_t)p->extras + 1) * sizeof *p->extra);
  PartExtra *x = memset(p->extra + p->extras++, 0, sizeof *x);
  strcpy(x->name, name), strcpy(x->unit, "mm"), strcpy(x->meaning, "unknown to the schema");
  x->type = H5Tcopy(type);
  x->rank = rank, x->dim[0] = a, x->dim[1] = b, x->unit_si = 1e-3;
  x->width = (rank > 1 ? a : 1) * (rank > 2 ? b : 1);
  x->size = x->width * (int)H5Tget_size(type);
  x->data = calloc((size_t)p->n, (size_t)x->size);
  snaps_fill(x->data, (size_t)p->n * (size_t)x->size, seed);
}

static void add_extras(Parts *p, uint64_t *seed)
{
  hid_t text = H5Tcopy(H5T_C_S1), pair = H5Tcreate(H5T_COMPOUND, 12);
  H5Tset_size(text, 5), H5Tset_strpad(text, H5T_STR_NULLPAD);
  H5Tinsert(pair, "a", 0, H5T_NATIVE_INT32), H5Tinsert(pair, "b", 4, H5T_NATIVE_DOUBLE);
  add_extra(p, "Byte", H5T_NATIVE_UINT8, 1, 0, 0, seed); /* by name, as they are read */
  add_extra(p, "Colour", H5T_NATIVE_FLOAT, 1, 0, 0, seed);
  add_extra(p, "Spin", H5T_NATIVE_FLOAT, 2, 3, 0, seed);
  add_extra(p, "Tensor", H5T_NATIVE_DOUBLE, 3, 3, 3, seed);
  add_extra(p, "Word", text, 1, 0, 0, seed);
  add_extra(p, "x", H5T_NATIVE_DOUBLE, 1, 0, 0, seed); /* named like a member, and like a view */
  H5Tclose(text);
  H5Tclose(pair);
}

static Parts *sample(void)
{
  Err err;
  uint64_t seed = 1;
  Parts *p = part_new(N);
  for (const PartField *f = part_fields; f < part_fields + part_field_count; f++) {
    part_add(p, f->member, &err);
    snaps_fill(part_array(p, f), (size_t)N * (size_t)f->size, &seed);
  }
  p->nflaw = calloc(N, sizeof *p->nflaw);
  for (long i = 0; i < N; i++) p->flaws += p->nflaw[i] = (int32_t)(i % 5);
  p->flaw = calloc((size_t)p->flaws, sizeof *p->flaw);
  snaps_fill(p->flaw, (size_t)p->flaws * sizeof *p->flaw, &seed);
  add_extras(p, &seed);
  p->dimension = 2, p->time = -12.5;
  part_add_material(p, "ice", "# \xc3\xa4rgerlich\nrho0 = 917.;\n", &err);
  part_add_material(p, "basalt", "", &err);
  part_add_material(p, "ice", "other\ttext", &err);
  part_history(p, "mksphere -n 300 --layer 'ice:1'", &err), part_history(p, "relax", &err);
  p->parameter = calloc(2, sizeof *p->parameter), p->parameters = 2;
  p->parameter[0] = strcpy(malloc(32), "theta\t0.7\tdefault");
  p->parameter[1] = strcpy(malloc(32), "cfl\t0.3\tgiven");
  part_set_number(p, "collision", "EscapeSpeed", 510.25, &err);
  part_set_number(p, "collision", "ContactTime", 0, &err);
  part_set_number(p, "body", "Radius0", 470e3, &err);
  part_set_number(p, "run", "Step", 17, &err);
  p->point = calloc(2, sizeof *p->point), p->points = 2;
#define SAMPLE_POINT(TYPE, MEMBER, ...)                                                            \
  snaps_fill(&p->point[k].MEMBER, sizeof p->point->MEMBER, &seed);
  for (int k = 0; k < 2; k++) { POINTMASS_FIELDS(SAMPLE_POINT) }
#undef SAMPLE_POINT
  return p;
}

static void assert_text(const char *a, const char *b) { assert_string_equal(a, b); }

static void assert_extras_equal(const Parts *a, const Parts *b)
{
  assert_int_equal(a->extras, b->extras);
  for (int k = 0; k < a->extras; k++) {
    const PartExtra *x = a->extra + k, *y = b->extra + k;
    assert_text(x->name, y->name), assert_text(x->unit, y->unit);
    assert_text(x->meaning, y->meaning);
    assert_true(x->rank == y->rank && x->width == y->width && x->size == y->size);
    assert_true(x->unit_si == y->unit_si && H5Tequal((hid_t)x->type, (hid_t)y->type) > 0);
    assert_memory_equal(x->data, y->data, (size_t)a->n * (size_t)x->size);
  }
}

static void assert_names_equal(const Parts *a, const Parts *b)
{
  assert_int_equal(a->materials, b->materials);
  for (int i = 0; i < a->materials; i++)
    assert_text(a->material[i].name, b->material[i].name),
        assert_text(a->material[i].text, b->material[i].text);
  assert_int_equal(a->histories, b->histories);
  for (int i = 0; i < a->histories; i++) assert_text(a->history[i], b->history[i]);
  assert_int_equal(a->parameters, b->parameters);
  for (int i = 0; i < a->parameters; i++) assert_text(a->parameter[i], b->parameter[i]);
  assert_true(a->collisions == b->collisions && a->body_infos == b->body_infos);
  for (int i = 0; i < a->collisions; i++) {
    assert_text(a->collision[i].name, b->collision[i].name);
    assert_true(a->collision[i].value == b->collision[i].value);
  }
  assert_true(a->body_info[0].value == b->body_info[0].value);
  assert_true(a->runs == b->runs && a->run[0].value == b->run[0].value);
  assert_int_equal(a->points, b->points);
#define SAME_POINT(TYPE, MEMBER, ...)                                                              \
  assert_memory_equal(&a->point[k].MEMBER, &b->point[k].MEMBER, sizeof a->point->MEMBER);
  for (int k = 0; k < a->points; k++) { POINTMASS_FIELDS(SAME_POINT) }
#undef SAME_POINT
}

static void all_comes_back(void **state)
{
  (void)state;
  Err err = {""};
  Parts *p = sample();
  assert_int_equal(snap_write(p, "a.h5", 1, &err), 0);
  Parts *q = snap_read("a.h5", &err);
  assert_text(err.text, "");
  assert_true(q->n == N && q->dimension == 2 && q->time == -12.5);
  for (const PartField *f = part_fields; f < part_fields + part_field_count; f++)
    assert_memory_equal(part_array(q, f), part_array(p, f), (size_t)N * (size_t)f->size);
  assert_int_equal(q->flaws, p->flaws);
  assert_memory_equal(q->nflaw, p->nflaw, N * sizeof *p->nflaw);
  assert_memory_equal(q->flaw, p->flaw, (size_t)p->flaws * sizeof *p->flaw);
  assert_extras_equal(q, p);
  assert_names_equal(q, p);
  assert_int_equal(folder_files(), 1);
  part_free(p);
  part_free(q);
}

static void what_is_absent_stays_absent(void **state)
{
  (void)state;
  Err err;
  Parts *p = snaps_bare(3);
  part_add(p, "a delta", &err);
  assert_int_equal(snap_write(p, "a.h5", 0, &err), 0);
  Parts *q = snap_read("a.h5", &err);
  for (const PartField *f = part_fields; f < part_fields + part_field_count; f++)
    assert_true(!part_array(q, f) == (!part_array(p, f) || f->checkpoint));
  assert_true(!q->nflaw && !q->extras && !q->materials && !q->histories && !q->collisions);
  part_free(p);
  part_free(q);
}

static void some_fields(void **state)
{
  (void)state;
  Err err = {""};
  Parts *p = sample();
  assert_int_equal(snap_write(p, "a.h5", 1, &err), 0);
  Parts *q = snap_read_some("a.h5", "id x damage no_such_field", &err);
  assert_text(err.text, "");
  for (const PartField *f = part_fields; f < part_fields + part_field_count; f++)
    assert_int_equal(part_array(q, f) != NULL, !strcmp(f->member, "id") ||
                                                   !strcmp(f->member, "x") ||
                                                   !strcmp(f->member, "damage"));
  assert_memory_equal(q->x, p->x, (size_t)N * 3 * sizeof *p->x);
  assert_true(!q->nflaw && !q->flaws && !q->extras && q->n == N && q->time == -12.5);
  assert_names_equal(q, p);
  part_free(q);
  const char *name = p->extra[0].name;
  q = snap_read_some("a.h5", name, &err);
  assert_int_equal(q->extras, 1);
  assert_string_equal(q->extra[0].name, name);
  assert_memory_equal(q->extra[0].data, p->extra[0].data, (size_t)N * (size_t)p->extra[0].size);
  part_free(p);
  part_free(q);
}

static int same_bytes(const char *a, const char *b)
{
  FILE *f = fopen(a, "rb"), *g = fopen(b, "rb");
  int x, y;
  do x = getc(f), y = getc(g);
  while (x == y && x != EOF);
  fclose(f);
  fclose(g);
  return x == y;
}

static void same_content_gives_the_same_bytes(void **state)
{
  (void)state;
  Err err;
  Parts *p = sample();
  assert_int_equal(snap_write(p, "a.h5", 1, &err), 0);
  Parts *q = snap_read("a.h5", &err);
  nanosleep(&(struct timespec){1, 100000000}, NULL); /* dates in HDF5 have seconds */
  assert_int_equal(snap_write(p, "b.h5", 1, &err), 0);
  assert_int_equal(snap_write(q, "c.h5", 1, &err), 0);
  assert_true(same_bytes("a.h5", "b.h5") && same_bytes("a.h5", "c.h5"));
  p->x[5] += 1;
  assert_int_equal(snap_write(p, "b.h5", 1, &err), 0);
  assert_false(same_bytes("a.h5", "b.h5"));
  part_free(p);
  part_free(q);
}

/* More than one chunk, and a last one that is not full. */
static void many_chunks_give_the_same_bytes(void **state)
{
  (void)state;
  Err err;
  Parts *p = snaps_bare(150000);
  uint64_t seed = 3;
  snaps_fill(p->x, (size_t)p->n * 24, &seed);
  assert_int_equal(snap_write(p, "a.h5", 0, &err), 0);
  Parts *q = snap_read("a.h5", &err);
  assert_memory_equal(q->x, p->x, (size_t)p->n * 24);
  assert_int_equal(snap_write(q, "b.h5", 0, &err), 0);
  assert_true(same_bytes("a.h5", "b.h5"));
  part_free(p);
  part_free(q);
}

/* ---- the layout that others read ---- */

static double attribute(hid_t file, const char *object, const char *name)
{
  double x[8] = {NAN};
  hid_t a = H5Aopen_by_name(file, object, name, H5P_DEFAULT, H5P_DEFAULT);
  assert_true(a >= 0 && H5Aread(a, H5T_NATIVE_DOUBLE, x) >= 0);
  H5Aclose(a);
  return x[0];
}

static void header_is_gadgets_without_cosmology(void **state)
{
  (void)state;
  Err err;
  Parts *p = sample();
  assert_int_equal(snap_write(p, "a.h5", 0, &err), 0);
  hid_t f = H5Fopen("a.h5", H5F_ACC_RDONLY, H5P_DEFAULT);
  assert_true(attribute(f, "Header", "NumPart_ThisFile") == N);
  assert_true(attribute(f, "Header", "NumPart_Total") == N);
  assert_true(attribute(f, "Header", "NumFilesPerSnapshot") == 1);
  assert_true(attribute(f, "Header", "MassTable") == 0);
  assert_true(attribute(f, "Header", "BoxSize") == 0);
  assert_true(attribute(f, "Header", "Time") == -12.5);
  assert_true(attribute(f, "Header", "Dimension") == 2);
  assert_true(attribute(f, "Header", "FormatVersion") == 1);
  assert_int_equal(H5Aexists_by_name(f, "Header", "HubbleParam", H5P_DEFAULT), 0);
  assert_int_equal(H5Aexists_by_name(f, "Header", "Redshift", H5P_DEFAULT), 0);
  assert_true(attribute(f, "Units", "UnitLength_in_cm") == 100);
  assert_true(attribute(f, "Units", "UnitMass_in_g") == 1000);
  assert_true(attribute(f, "Units", "UnitVelocity_in_cm_per_s") == 100);
  H5Fclose(f);
  part_free(p);
}

static void assert_label(hid_t file, const char *name, const char *attr, const char *text)
{
  char path[256], got[512] = {0};
  snprintf(path, sizeof path, "PartType0/%s", name);
  hid_t a = H5Aopen_by_name(file, path, attr, H5P_DEFAULT, H5P_DEFAULT), t = H5Aget_type(a);
  assert_true(a >= 0 && H5Tget_size(t) < sizeof got && H5Aread(a, t, got) >= 0);
  assert_text(got, text);
  H5Tclose(t);
  H5Aclose(a);
}

static void datasets_are_labelled(void **state)
{
  (void)state;
  Err err;
  char path[128];
  Parts *p = sample();
  assert_int_equal(snap_write(p, "a.h5", 1, &err), 0);
  hid_t f = H5Fopen("a.h5", H5F_ACC_RDONLY, H5P_DEFAULT);
  for (const PartField *d = part_fields; d < part_fields + part_field_count; d++) {
    assert_label(f, d->name, "unit", d->unit);
    assert_label(f, d->name, "meaning", d->meaning);
    snprintf(path, sizeof path, "PartType0/%s", d->name);
    assert_true(attribute(f, path, "unitSI") == 1);
  }
  assert_label(f, "Spin", "unit", "mm");
  assert_true(attribute(f, "PartType0/Spin", "unitSI") == 1e-3);
  H5Fclose(f);
  part_free(p);
}

/* A view's dataset is one-dimensional, of its source's type, virtual, and reads as the source's
 * column. */
static void assert_column(hid_t f, const char *name, const double *rows, int width, int k)
{
  double got[N];
  char path[160];
  snprintf(path, sizeof path, "Step#0/%s", name);
  hid_t d = H5Dopen2(f, path, H5P_DEFAULT), space = H5Dget_space(d), type = H5Dget_type(d);
  hid_t dcpl = H5Dget_create_plist(d);
  assert_int_equal(H5Sget_simple_extent_ndims(space), 1);
  assert_int_equal(H5Pget_layout(dcpl), H5D_VIRTUAL);
  assert_true(H5Tequal(type, H5T_NATIVE_DOUBLE) > 0);
  assert_true(H5Dread(d, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, got) >= 0);
  for (int i = 0; i < N; i++) assert_memory_equal(got + i, rows + i * width + k, sizeof *got);
  H5Pclose(dcpl), H5Tclose(type), H5Sclose(space), H5Dclose(d);
}

static int same_object(hid_t f, const char *a, const char *b)
{
  H5G_stat_t x, y; /* the one form that HDF5 1.10 and later versions share */
  assert_true(H5Gget_objinfo(f, a, 1, &x) >= 0 && H5Gget_objinfo(f, b, 1, &y) >= 0);
  return x.objno[0] == y.objno[0] && x.objno[1] == y.objno[1];
}

static void step_is_a_view_without_copies(void **state)
{
  (void)state;
  Err err;
  char a[128], b[128];
  Parts *p = sample();
  assert_int_equal(snap_write(p, "a.h5", 1, &err), 0);
  assert_int_equal(rename("a.h5", "b.h5"), 0); /* the view does not depend on the name */
  hid_t f = H5Fopen("b.h5", H5F_ACC_RDONLY, H5P_DEFAULT);
  assert_true(attribute(f, "Step#0", "TimeValue") == -12.5);
  assert_column(f, "x", p->x, 3, 0);
  assert_column(f, "y", p->x, 3, 1);
  assert_column(f, "z", p->x, 3, 2);
  for (const PartField *d = part_fields; d < part_fields + part_field_count; d++)
    for (int k = 0; k < d->width && strcmp(d->member, "x"); k++) {
      snprintf(a, sizeof a, "PartType0/%s", d->name);
      snprintf(b, sizeof b, "Step#0/%s", d->name);
      if (d->width == 1)
        assert_true(same_object(f, a, b));
      else
        snprintf(a, sizeof a, "%s_%d", d->name, k),
            assert_column(f, a, part_array(p, d), d->width, k);
    }
  assert_true(same_object(f, "PartType0/Colour", "Step#0/Colour"));
  assert_true(same_object(f, "PartType0/FlawCount", "Step#0/FlawCount"));
  assert_true(H5Lexists(f, "Step#0/Spin_2", H5P_DEFAULT) > 0);
  assert_true(H5Lexists(f, "Step#0/Word", H5P_DEFAULT) == 0);           /* no numbers */
  assert_true(H5Lexists(f, "Step#0/FlawThresholds", H5P_DEFAULT) == 0); /* other length */
  H5Fclose(f);
  part_free(p);
}

static void series_leads_to_the_snapshots(void **state)
{
  (void)state;
  Err err;
  const char *name[] = {"snap_0000.h5", "snap_0001.h5"};
  const double time[] = {0, 60};
  mkdir("run", 0700);
  Parts *p = snaps_bare(N);
  for (int k = 0; k < 2; k++) {
    char path[64];
    snprintf(path, sizeof path, "run/%s", name[k]);
    p->time = time[k], p->rho[7] = 100 + k;
    assert_int_equal(snap_write(p, path, 0, &err), 0);
  }
  assert_int_equal(snap_series("run", name, time, 2, &err), 0);
  hid_t f = H5Fopen("run/run.h5part", H5F_ACC_RDONLY, H5P_DEFAULT);
  for (int k = 0; k < 2; k++) {
    char step[32], density[64];
    double rho[N];
    snprintf(step, sizeof step, "Step#%d", k),
        snprintf(density, sizeof density, "%s/Density", step);
    assert_true(attribute(f, step, "TimeValue") == time[k]);
    hid_t d = H5Dopen2(f, density, H5P_DEFAULT);
    H5Dread(d, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, rho);
    H5Dclose(d);
    assert_true(rho[7] == 100 + k);
  }
  H5Fclose(f);
  const char *gone[] = {"snap_0000.h5", "snap_0002.h5"};
  assert_int_equal(snap_series("run", gone, time, 2, &err), -1);
  assert_text(err.text, "cannot write 'run/run.h5part': 'snap_0002.h5': No such file or directory");
  assert_int_equal(access("run/run.h5part", R_OK), 0); /* the one before */
  part_free(p);
}

/* ---- what must not be written ---- */

static void bad_output_is_refused(void **state)
{
  (void)state;
  Err err;
  Parts *p = snaps_bare(2), *none = part_new(0);
  assert_int_equal(snap_write(none, "a.h5", 0, &err), -1);
  assert_text(err.text, "cannot write 'a.h5': no particles");
  assert_int_equal(snap_write(p, "none/a.h5", 0, &err), -1);
  assert_text(err.text, "cannot write 'none/a.h5': No such file or directory");
  assert_int_equal(snap_write(p, "/dev/full", 0, &err), -1);
  assert_text(err.text, "cannot write '/dev/full': No space left on device");
  free(p->x), p->x = NULL;
  assert_int_equal(snap_write(p, "a.h5", 0, &err), -1);
  assert_text(err.text, "'a.h5' lacks field 'Coordinates' (made by mksphere)");
  assert_int_equal(folder_files(), 0);
  part_free(p);
  part_free(none);
}

/* In a process of its own: writes with room for only so many bytes, then with room enough. 0 when
 * the first failed with one line that says why, left an empty folder, and the second is whole.
 * _exit: HDF5 1.10 loses memory when it cannot close a file. */
static int write_in(const Parts *p, rlim_t room)
{
  Err err = {""};
  struct rlimit old, few;
  signal(SIGXFSZ, SIG_IGN);
  getrlimit(RLIMIT_FSIZE, &old);
  few = (struct rlimit){room, old.rlim_max};
  setrlimit(RLIMIT_FSIZE, &few);
  if (snap_write(p, "a.h5", 0, &err) != -1) return 1;
  setrlimit(RLIMIT_FSIZE, &old);
  if (strncmp(err.text, "cannot write 'a.h5': ", 21) || !strstr(err.text, "File too large"))
    return 2;
  if (folder_files()) return 3;
  if (snap_write(p, "b.h5", 0, &err)) return 4;
  Parts *q = snap_read("b.h5", &err);
  return q && !memcmp(q->v, p->v, (size_t)p->n * 24) && !remove("b.h5") ? 0 : 5;
}

/* The disk fills up at any point from the first byte to the last flush. */
static void full_disk_leaves_nothing(void **state)
{
  (void)state;
  Err err;
  struct stat st;
  Parts *p = snaps_bare(20000);
  uint64_t seed = 5;
  snaps_fill(p->x, (size_t)p->n * 24, &seed), snaps_fill(p->v, (size_t)p->n * 24, &seed);
  assert_int_equal(snap_write(p, "a.h5", 0, &err), 0);
  stat("a.h5", &st);
  remove("a.h5");
  for (int k = 0; k <= 16; k++) {
    rlim_t size = (rlim_t)st.st_size, room = k < 16 ? size * (rlim_t)k / 16 : size - 1;
    pid_t child = fork();
    if (!child) _exit(write_in(p, room));
    int status;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_int_equal(status, 0);
  }
  part_free(p);
}

int main(void)
{
  H5dont_atexit(); /* as lib/hdf.c does, before anything else initialises HDF5 */
#define T(NAME) cmocka_unit_test_setup_teardown(NAME, folder_setup, folder_teardown)
  const struct CMUnitTest tests[] = {
      T(all_comes_back),
      T(what_is_absent_stays_absent),
      T(some_fields),
      T(same_content_gives_the_same_bytes),
      T(many_chunks_give_the_same_bytes),
      T(header_is_gadgets_without_cosmology),
      T(datasets_are_labelled),
      T(step_is_a_view_without_copies),
      T(series_leads_to_the_snapshots),
      T(bad_output_is_refused),
      T(full_disk_leaves_nothing),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
