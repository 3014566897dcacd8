/* SPDX-License-Identifier: GPL-3.0-or-later */
/* convert: files as SPHLATCH, SWIFT/WoMa and miluphcuda write them (made here with HDF5 alone, from
 * what their sources and documents say) come in with the numbers that their units mean. */
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

#include "snaps.h"

enum { N = 7 };

/* The number that row i, column k of the dataset called `name` holds in its file. */
static double number(const char *name, int i, int k)
{
  unsigned seed = 0;
  for (const char *s = name; *s; s++) seed = seed * 31 + (unsigned char)*s;
  return 1 + seed % 97 + 0.125 * i + 0.5 * k;
}

static void put(hid_t loc, const char *name, int width, hid_t type)
{
  const hsize_t dims[2] = {N, (hsize_t)width};
  double row[N * 9];
  for (int i = 0; i < N; i++)
    for (int k = 0; k < width; k++) row[i * width + k] = number(name, i, k);
  hid_t space = H5Screate_simple(width > 1 ? 2 : 1, dims, NULL);
  hid_t set = H5Dcreate2(loc, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  assert_true(H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, row) >= 0);
  H5Dclose(set), H5Sclose(space);
}

static void put_whole(hid_t loc, const char *name, const int *value, int n, int width)
{
  const hsize_t dims[2] = {(hsize_t)n, (hsize_t)width};
  hid_t space = H5Screate_simple(width > 1 ? 2 : 1, dims, NULL);
  hid_t set = H5Dcreate2(loc, name, H5T_STD_I32LE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  assert_true(H5Dwrite(set, H5T_NATIVE_INT, H5S_ALL, H5S_ALL, H5P_DEFAULT, value) >= 0);
  H5Dclose(set), H5Sclose(space);
}

static void put_attribute(hid_t loc, const char *name, double value, int n)
{
  const hsize_t dims = (hsize_t)n;
  double values[6] = {value};
  hid_t space = H5Screate_simple(1, &dims, NULL);
  hid_t a = H5Acreate2(loc, name, H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, H5P_DEFAULT);
  assert_true(H5Awrite(a, H5T_NATIVE_DOUBLE, values) >= 0);
  H5Aclose(a), H5Sclose(space);
}

static hid_t create(const char *path)
{
  return H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
}

static hid_t group(hid_t file, const char *name)
{
  return H5Gcreate2(file, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
}

/* Runs it, and reads what came out. */
static Parts *converted(const char *command)
{
  Err err;
  assert_int_equal(system(command), 0);
  Parts *p = snap_read("out.h5", &err);
  if (!p) fail_msg("%s", err.text);
  return p;
}

static int said(const char *text)
{
  char command[200];
  snprintf(command, sizeof command, "grep -qF '%s' said", text);
  return !system(command);
}

static void same(const double *got, const char *theirs, int width, double unit, int rows)
{
  for (int i = 0; i < rows; i++)
    for (int k = 0; k < width; k++) {
      double want = number(theirs, i, k) * unit;
      if (fabs(got[i * width + k] - want) > 1e-14 * fabs(want))
        fail_msg("%s[%d][%d]: %.17g, not %.17g", theirs, i, k, got[i * width + k], want);
    }
}

static const double *extra(const Parts *p, const char *name)
{
  for (int k = 0; k < p->extras; k++)
    if (!strcmp(p->extra[k].name, name)) return (const double *)(void *)p->extra[k].data;
  fail_msg("no field '%s'", name);
  return NULL;
}

/* ---- SPHLATCH: cgs, eV, h is half the support; what /current names is read ---- */

static void sphlatch_step(hid_t file, const char *name, int old)
{
  static const char *const LIST[] = {"m", "h",   "rho",  "u",   "p",    "cs",
                                     "T", "pot", "pmax", "uav", "Tmax", "dudt"};
  static const int id[N] = {4, 2, 9, 2000001, 2000002, 2000003, 2000004};
  static const int mat[N] = {4, 4, 4, 4, 5, 5, 5}, near[N] = {50, 51, 52, 53, 54, 55, 56};
  hid_t g = group(file, name);
  put(g, "pos", 3, H5T_IEEE_F64LE);
  put(g, "vel", 3, H5T_IEEE_F64LE);
  for (size_t k = 0; k < sizeof LIST / sizeof *LIST; k++) put(g, LIST[k], 1, H5T_IEEE_F64LE);
  put(g, "S", old ? 5 : 1, H5T_IEEE_F64LE);
  put_whole(g, "id", id, N, 1), put_whole(g, "mat", mat, N, 1), put_whole(g, "noneigh", near, N, 1);
  put_attribute(g, "time", old ? 10 : 3600, 1);
  H5Gclose(g);
}

static void test_sphlatch(void **state)
{
  (void)state;
  static const double EV = 11604.51812;
  hid_t file = create("dump.h5part");
  sphlatch_step(file, "Step#40", 1);
  sphlatch_step(file, "Step#123", 0);
  H5Lcreate_soft("/Step#123", file, "/current", H5P_DEFAULT, H5P_DEFAULT);
  H5Fclose(file);
  Parts *p = converted("convert -m 4:dunite -m 5:iron --second-body 2000001 -o out.h5 dump.h5part "
                       "2>said");
  assert_true(p->time == 3600 && p->n == N && p->dimension == 3);
  same(p->x, "pos", 3, 1e-2, N), same(p->v, "vel", 3, 1e-2, N);
  same(p->m, "m", 1, 1e-3, N), same(p->h, "h", 1, 2e-2, N), same(p->rho, "rho", 1, 1e3, N);
  same(p->u, "u", 1, 1e-4, N), same(p->p, "p", 1, 0.1, N), same(p->cs, "cs", 1, 1e-2, N);
  same(p->T, "T", 1, EV, N), same(p->phi, "pot", 1, 1e-4, N), same(p->pmax, "pmax", 1, 0.1, N);
  same(extra(p, "Entropy"), "S", 1, 1e-4 / EV, N);
  same(p->Tmax, "Tmax", 1, EV, N);
  same(p->shock, "uav", 1, 1e-4, N);
  assert_true(p->id[2] == 9 && p->nngb[6] == 56 && p->body[2] == 0 && p->body[3] == 1);
  assert_string_equal(p->material[p->mat[0]].name, "dunite");
  assert_string_equal(p->material[p->mat[6]].name, "iron");
  assert_true(said("not carried over: dudt (computed anew)") && !p->s);
  part_free(p);
  p = converted("convert -m 4:dunite -m 5:iron --step 40 -o out.h5 dump.h5part 2>said");
  assert_true(p->time == 10);
  for (int i = 0; i < N; i++) {
    for (int k = 0; k < 5; k++)
      assert_true(fabs(p->s[i * 6 + k] - 0.1 * number("S", i, k)) < 1e-13 * p->s[i * 6 + k]);
    assert_true(fabs(p->s[i * 6] + p->s[i * 6 + 3] + p->s[i * 6 + 5]) < 1e-13);
  }
  part_free(p);
}

/* ---- SWIFT: units in /Units, h is 1/1.825742 of the support, plurals in its snapshots ---- */

static void swift_file(const char *path, int plural, int ids)
{
  static const char *const NAMES[][2] = {{"Masses", "Masses"},
                                         {"SmoothingLength", "SmoothingLengths"},
                                         {"InternalEnergy", "InternalEnergies"},
                                         {"Density", "Densities"},
                                         {"Pressure", "Pressures"},
                                         {"Potential", "Potentials"}};
  static const int TILL[N] = {103, 103, 100, 103, 100, 103, 103}, ANEOS[N] = {400, 401};
  const hsize_t six = 6;
  const int count[6] = {N, 3};
  hid_t file = create(path), g = group(file, "Header"), space = H5Screate_simple(1, &six, NULL);
  hid_t a = H5Acreate2(g, "NumPart_ThisFile", H5T_NATIVE_INT, space, H5P_DEFAULT, H5P_DEFAULT);
  H5Awrite(a, H5T_NATIVE_INT, count);
  H5Aclose(a), H5Sclose(space);
  put_attribute(g, "Time", 2.5, 1), put_attribute(g, "BoxSize", 400, 1);
  put_attribute(g, "Dimension", 3, 1);
  H5Gclose(g);
  g = group(file, "Units"); /* Earth radii and masses, hours */
  put_attribute(g, "Unit length in cgs (U_L)", 6.371e8, 1);
  put_attribute(g, "Unit mass in cgs (U_M)", 5.972e27, 1);
  put_attribute(g, "Unit time in cgs (U_t)", 3600, 1);
  put_attribute(g, "Unit current in cgs (U_I)", 1, 1);
  put_attribute(g, "Unit temperature in cgs (U_T)", 1, 1);
  H5Gclose(g);
  g = group(file, "PartType0");
  put(g, "Coordinates", 3, H5T_IEEE_F64LE), put(g, "Velocities", 3, H5T_IEEE_F32LE);
  for (size_t k = 0; k < sizeof NAMES / sizeof *NAMES; k++)
    put(g, NAMES[k][plural], 1, H5T_IEEE_F32LE); /* eighths: exact in single precision */
  put(g, "ParticleIDs", 1, H5T_STD_U64LE);
  put(g, "ViscosityParameters", 1, H5T_IEEE_F32LE);
  put_whole(g, "MaterialIDs", ids ? ANEOS : TILL, N, 1);
  H5Gclose(g), H5Fclose(file);
}

static void test_swift(void **state)
{
  (void)state;
  const double L = 6.371e6, M = 5.972e24, t = 3600;
  for (int plural = 0; plural < 2; plural++) {
    swift_file("ic.hdf5", plural, 0);
    /* without ids the rows are numbered */
    hid_t file = H5Fopen("ic.hdf5", H5F_ACC_RDWR, H5P_DEFAULT);
    H5Ldelete(file, "PartType0/ParticleIDs", H5P_DEFAULT), H5Fclose(file);
    Parts *p = converted("convert -o out.h5 ic.hdf5 2>said");
    assert_true(p->time == 2.5 * t && p->id[3] == 3);
    same(p->x, "Coordinates", 3, L, N), same(p->v, "Velocities", 3, L / t, N);
    same(p->m, "Masses", 1, M, N);
    same(p->h, plural ? "SmoothingLengths" : "SmoothingLength", 1, 1.825742 * L, N);
    same(p->u, plural ? "InternalEnergies" : "InternalEnergy", 1, L * L / t / t, N);
    same(p->rho, plural ? "Densities" : "Density", 1, M / L / L / L, N);
    same(p->p, plural ? "Pressures" : "Pressure", 1, M / L / t / t, N);
    same(p->phi, plural ? "Potentials" : "Potential", 1, L * L / t / t, N);
    assert_string_equal(p->material[p->mat[0]].name, "basalt");
    assert_string_equal(p->material[p->mat[2]].name, "iron");
    assert_true(said("not carried over, unknown here: ViscosityParameters"));
    assert_true(said("not carried over: 3 particles of type 1") && said("BoxSize"));
    assert_true(said("all particles are body 0"));
    part_free(p);
  }
  swift_file("aneos.hdf5", 0, 1);
  assert_int_not_equal(system("convert -o out2.h5 aneos.hdf5 2>said"), 0);
  assert_true(said("which material is number 0, 400, 401? say --material NUMBER:NAME"));
}

/* ---- miluphcuda: as its io.cu writes a build with SOLID, FRAGMENTATION, PALPHA_POROSITY ---- */

static hid_t miluph_file(const char *path, int dimension)
{
  static const char *const LIST[] = {
      "m",          "rho",          "e",        "sml",  "sml_initial",
      "p",          "soundspeed",   "dalphadt", "dddt", "total_plastic_strain",
      "tree_depth", "local_strain", "drhodt",   "dedt", "alpha_jutzi"};
  static const int mat[N] = {0, 1, 0, 1, -1, 0, 1}, active[N] = {1, 0, 2, 0, 0, 0, 1}, most = 3;
  hid_t file = create(path);
  put(file, "x", dimension, H5T_NATIVE_DOUBLE), put(file, "v", dimension, H5T_NATIVE_DOUBLE);
  put(file, "a", dimension, H5T_NATIVE_DOUBLE);
  put(file, "deviatoric_stress", dimension * dimension, H5T_NATIVE_DOUBLE);
  for (size_t k = 0; k < sizeof LIST / sizeof *LIST; k++) put(file, LIST[k], 1, H5T_NATIVE_DOUBLE);
  put_whole(file, "material_type", mat, N, 1),
      put_whole(file, "maximum_number_of_flaws", &most, 1, 1);
  put_whole(file, "number_of_activated_flaws", active, N, 1);
  return file;
}

static void put_reals(hid_t file, const char *name, const double *value, int n, int width)
{
  const hsize_t dims[2] = {(hsize_t)n, (hsize_t)width};
  hid_t space = H5Screate_simple(width > 1 ? 2 : 1, dims, NULL);
  hid_t set =
      H5Dcreate2(file, name, H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, value);
  H5Dclose(set), H5Sclose(space);
}

static void test_miluph(void **state)
{
  (void)state;
  static const double flaws[N][3] = {{3e-5, 1e-5, -1}, {-1, -1, -1}, {1e-5, 2e-5, 3e-5},
                                     {4e-5, -1, -1},   {-1, -1, -1}, {-1, -1, -1},
                                     {5e-5, -1, -1}};
  static const double tensile[N] = {0.5, 0, 1, 0.25, 0, 0.1, 0.9},
                      pores[N] = {0.5, 0, 1, 0, 0, 0, 0.9}, time = 12.5;
  hid_t file = miluph_file("impact.0042.h5", 3);
  put_reals(file, "time", &time, 1, 1);
  put_reals(file, "activation_thresholds", *flaws, N, 3);
  put_reals(file, "DIM_root_of_damage_tensile", tensile, N, 1);
  put_reals(file, "DIM_root_of_damage_porjutzi", pores, N, 1);
  H5Fclose(file);
  Parts *p = converted("convert -m 0:basalt -m 1:ice -o out.h5 impact.0042.h5 2>said");
  static const int row[] = {0, 1, 2, 3, 5, 6}; /* 4 was taken out */
  assert_true(p->n == N - 1 && p->time == time && p->flaws == 7);
  for (int i = 0; i < N - 1; i++) {
    int k = row[i];
    const double *s = p->s + i * 6;
    assert_true(p->id[i] == k && p->x[3 * i + 2] == number("x", k, 2));
    assert_true(p->m[i] == number("m", k, 0) && p->h[i] == number("sml", k, 0));
    assert_true(p->u[i] == number("e", k, 0) && p->rho[i] == number("rho", k, 0));
    assert_true(p->p[i] == number("p", k, 0) && p->alpha[i] == number("alpha_jutzi", k, 0));
    assert_true(p->strain[i] == number("total_plastic_strain", k, 0));
    for (int c = 0; c < 6; c++) {
      static const int at[6] = {0, 1, 2, 4, 5, 8};
      assert_true(s[c] == number("deviatoric_stress", k, at[c]));
    }
    assert_true(fabs(p->damage[i] - fmin(1, pow(tensile[k], 3) + pow(pores[k], 3))) < 1e-15);
  }
  assert_true(p->nflaw[0] == 2 && p->flaw[0] == 1e-5 && p->flaw[1] == 3e-5 && p->nflaw[2] == 3);
  assert_true(p->nact[2] == 2);
  assert_true(said("1 particles that had been taken out"));
  assert_true(said("not carried over: local_strain (computed anew)"));
  part_free(p);
}

/* In two dimensions; the total of the damage wins, under its old name, too. */
static void test_miluph_plane(void **state)
{
  (void)state;
  static const double total[N] = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7},
                      root[N] = {1, 1, 1, 1, 1, 1, 1};
  hid_t file = miluph_file("plane.0001.h5", 2);
  put_reals(file, "damage_total", total, N, 1);
  put_reals(file, "DIM_root_of_damage_tensile", root, N, 1);
  H5Ldelete(file, "number_of_activated_flaws", H5P_DEFAULT);
  H5Fclose(file);
  Parts *p = converted("convert --time 3s -m 0:basalt -m 1:ice -o out.h5 plane.0001.h5 2>said");
  assert_true(p->dimension == 2 && p->time == 3);
  for (int i = 0; i < p->n; i++) {
    int k = i + (i > 3);
    const double *s = p->s + i * 6;
    assert_true(p->damage[i] == total[k] && p->x[3 * i + 1] == number("x", k, 1));
    assert_true(p->x[3 * i + 2] == 0 && p->v[3 * i + 2] == 0);
    assert_true(s[0] == number("deviatoric_stress", k, 0) && s[2] == 0 && s[4] == 0);
    assert_true(s[3] == number("deviatoric_stress", k, 3) && s[5] == -(s[0] + s[3]));
  }
  part_free(p);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test_setup_teardown(test_sphlatch, folder_setup, folder_teardown),
      cmocka_unit_test_setup_teardown(test_swift, folder_setup, folder_teardown),
      cmocka_unit_test_setup_teardown(test_miluph, folder_setup, folder_teardown),
      cmocka_unit_test_setup_teardown(test_miluph_plane, folder_setup, folder_teardown),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
