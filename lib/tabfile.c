/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Text is read as numbers between blanks, whatever the lines; where each stands is kept for
 * messages. */
#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>
#include "hdf.h"
#include "spool.h"
#include "tabfile.h"

enum { MOST = 100000 }; /* nodes of an axis */

/* ---- text ---- */

typedef struct {
  const char *path;
  char *text;
  const char *at;
  long line;
} Scan;

/* The line at which the scan stands into buf (cut), and on to the next. */
static void take_line(Scan *s, char *buf, size_t size)
{
  size_t n = strcspn(s->at, "\n");
  if (buf) snprintf(buf, size, "%.*s", (int)n, s->at);
  s->at += n;
  if (*s->at) s->at++, s->line++;
}

static void skip_blanks(Scan *s)
{
  for (; isspace((unsigned char)*s->at); s->at++) s->line += *s->at == '\n';
}

static int number(Scan *s, double *x, const char *what, Err *err)
{
  char *end;
  skip_blanks(s);
  if (!*s->at)
    return err_set(err, "%s:%ld: the file ends where %s is wanted", s->path, s->line, what);
  *x = strtod(s->at, &end);
  if (end == s->at || !(isspace((unsigned char)*end) || !*end))
    return err_set(err, "%s:%ld: '%.*s' where %s is wanted", s->path, s->line,
                   (int)strcspn(s->at, " \t\r\n") > 40 ? 40 : (int)strcspn(s->at, " \t\r\n"), s->at,
                   what);
  s->at = end;
  return 0;
}

static int count(Scan *s, int *n, const char *what, Err *err)
{
  double x;
  if (number(s, &x, what, err)) return -1;
  if (!(x >= 4 && x <= MOST && x == floor(x)))
    return err_set(err, "%s:%ld: %s is %g, not 4 to %d", s->path, s->line, what, x, MOST);
  *n = (int)x;
  return 0;
}

static int at_end(Scan *s, Err *err)
{
  skip_blanks(s);
  if (!*s->at) return 0;
  return err_set(err, "%s:%ld: more than the table: '%.*s'", s->path, s->line,
                 (int)strcspn(s->at, "\n") > 40 ? 40 : (int)strcspn(s->at, "\n"), s->at);
}

static void about(Table *t, const char *header)
{
  header += strspn(header, "# \t");
  snprintf(t->about, sizeof t->about, "%.*s", (int)strcspn(header, "\r\n"), header);
}

static int new_rows(Table *t, int nrho, int ny, int heat, Err *err)
{
  if (table_new(t, nrho, ny, heat, err)) return -1;
  t->row = malloc((size_t)nrho * (size_t)ny * sizeof *t->row);
  return t->row ? 0 : err_set(err, "no memory for a table of %d x %d nodes", nrho, ny);
}

static int axis(Scan *s, double *x, int n, const char *what, Err *err)
{
  for (int k = 0; k < n; k++)
    if (number(s, &x[k], what, err)) return -1;
  return 0;
}

static void absent(Table *t, int k)
{
  free(t->field[k]);
  t->field[k] = NULL;
}

/* ---- sesame ---- */

static int read_sesame(Table *t, Scan *s, const char *header, Err *err)
{
  static const int column[] = {TABLE_U, TABLE_P, TABLE_C, TABLE_S};
  double date;
  int nrho = 0, ny = 0;
  if (number(s, &date, "a date", err) || count(s, &nrho, "the number of densities", err) ||
      count(s, &ny, "the number of temperatures", err) || new_rows(t, nrho, ny, 1, err) ||
      axis(s, t->rho, nrho, "a density", err) || axis(s, t->y, ny, "a temperature", err))
    return -1;
  about(t, header), absent(t, TABLE_PHASE);
  for (int j = 0; j < ny; j++)
    for (int i = 0; i < nrho; i++) {
      size_t at = (size_t)i * (size_t)ny + (size_t)j;
      for (int k = 0; k < 4; k++)
        if (number(s, &t->field[column[k]][at], "u, P, c or s", err)) return -1;
      t->row[at] = s->line;
    }
  return at_end(s, err);
}

/* Whether a line may stand in a text format: the first of a pair. */
static int once(const double *x, int k) { return k == 0 || x[k] > x[k - 1]; }

static int distinct(const double *x, int n)
{
  int all = 0;
  for (int k = 0; k < n; k++) all += once(x, k);
  return all;
}

static double value(const Table *t, int k, int i, int j)
{
  return t->field[k] ? t->field[k][(size_t)i * (size_t)t->ny + (size_t)j] : 0;
}

static void write_axis(FILE *f, const double *x, int n)
{
  for (int k = 0; k < n; k++)
    if (once(x, k)) fprintf(f, "%.16e ", x[k]);
  putc('\n', f);
}

static void write_sesame(const Table *t, FILE *f)
{
  fprintf(f,
          "# %s\n#\n"
          "# version_date                                             (YYYYMMDD)\n"
          "# num_rho  num_T\n"
          "# rho[0]   rho[1]  ...  rho[num_rho-1]                     (kg/m^3)\n"
          "# T[0]     T[1]    ...  T[num_T-1]                         (K)\n"
          "# u[0, 0]              P[0, 0]   c[0, 0]   s[0, 0]         (J/kg, Pa, m/s, J/K/kg)\n"
          "# u[1, 0]              ...       ...       ...\n"
          "# ...                  ...       ...       ...\n"
          "# u[num_rho-1, 0]      ...       ...       ...\n"
          "# u[0, 1]              ...       ...       ...\n"
          "# u[num_rho-1, num_T-1]  ...     ...       s[num_rho-1, num_T-1]\n"
          "20000101\n%d %d\n",
          t->about, distinct(t->rho, t->nrho), distinct(t->y, t->ny));
  write_axis(f, t->rho, t->nrho), write_axis(f, t->y, t->ny);
  for (int j = 0; j < t->ny; j++)
    for (int i = 0; i < t->nrho; i++)
      if (once(t->rho, i) && once(t->y, j))
        fprintf(f, "%.16e %.16e %.16e %.16e\n", value(t, TABLE_U, i, j), value(t, TABLE_P, i, j),
                value(t, TABLE_C, i, j), value(t, TABLE_S, i, j));
}

/* ---- miluph ---- */

enum { COLUMNS = 7 };

/* All rows of seven numbers, [*n][8]: the last is the line. */
static double *read_rows(Scan *s, long *n, Err *err)
{
  double *row = NULL, *more;
  long room = 0;
  for (*n = 0; skip_blanks(s), *s->at; ++*n) {
    if (*n == room) {
      room = room ? 2 * room : 4096;
      if (!(more = realloc(row, (size_t)room * (COLUMNS + 1) * sizeof *row))) {
        free(row);
        return err_null(err, "%s: no memory for %ld rows", s->path, room);
      }
      row = more;
    }
    row[*n * (COLUMNS + 1) + COLUMNS] = (double)s->line;
    for (int k = 0; k < COLUMNS; k++)
      if (number(s, &row[*n * (COLUMNS + 1) + k], "one of rho, e, p, T, cs, s, phase", err)) {
        free(row);
        return NULL;
      }
  }
  return row ? row : err_null(err, "%s:%ld: no rows", s->path, s->line);
}

/* Rows into a table; the energies may differ from those of the first density by 1e-6 (they are
 * printed with few digits). */
static int place_rows(Table *t, const char *path, const double *row, long n, Err *err)
{
  static const int column[COLUMNS] = {-1, -1, TABLE_P, TABLE_T, TABLE_C, TABLE_S, TABLE_PHASE};
  long ny = 1;
  while (ny < n && row[ny * (COLUMNS + 1)] == row[0]) ny++;
  if (n % ny || ny < 4 || ny > MOST || n / ny > MOST)
    return err_set(err, "%s: %ld rows are not whole lines of %ld energies", path, n, ny);
  if (new_rows(t, (int)(n / ny), (int)ny, 0, err)) return -1;
  for (long k = 0; k < n; k++) {
    const double *r = row + k * (COLUMNS + 1);
    long i = k / ny, j = k % ny;
    if (j == 0) t->rho[i] = r[0];
    if (i == 0) t->y[j] = r[1];
    if (r[0] != t->rho[i])
      return err_set(err, "%s:%.0f: density %g in the line of %g", path, r[COLUMNS], r[0],
                     t->rho[i]);
    if (!(fabs(r[1] - t->y[j]) <= 1e-6 * fabs(t->y[j])))
      return err_set(err, "%s:%.0f: energy %g where the first density has %g", path, r[COLUMNS],
                     r[1], t->y[j]);
    t->row[k] = (long)r[COLUMNS];
    for (int c = 2; c < COLUMNS; c++) t->field[column[c]][k] = r[c];
  }
  return 0;
}

static int read_miluph(Table *t, Scan *s, Err *err)
{
  char header[256];
  double *row;
  long n;
  int bad;
  take_line(s, header, sizeof header), take_line(s, NULL, 0), take_line(s, NULL, 0);
  if (!(row = read_rows(s, &n, err))) return -1;
  bad = place_rows(t, s->path, row, n, err);
  about(t, header);
  free(row);
  return bad;
}

static void write_miluph(const Table *t, FILE *f)
{
  fprintf(f, "# %s\n# SI units; phase: number of the phase\n# rho e p T cs entropy phase\n",
          t->about);
  for (int i = 0; i < t->nrho; i++)
    for (int j = 0; j < t->ny; j++)
      if (once(t->rho, i) && once(t->y, j))
        fprintf(f, "%.16e %.16e %.16e %.16e %.16e %.16e %.0f\n", t->rho[i], t->y[j],
                value(t, TABLE_P, i, j), value(t, TABLE_T, i, j), value(t, TABLE_C, i, j),
                value(t, TABLE_S, i, j), value(t, TABLE_PHASE, i, j));
}

/* Which of the two it is: after header lines with # a sesame table has a number alone. */
static int read_text(Table *t, const char *path, Err *err)
{
  Scan s = {path, spool_slurp(path, err), NULL, 1}, begin;
  char header[256] = "", line[256], rest[2];
  double date;
  int bad;
  if (!s.text) return -1;
  s.at = s.text, begin = s;
  if (*s.at == '#') take_line(&s, header, sizeof header);
  while (*s.at == '#') take_line(&s, NULL, 0);
  skip_blanks(&s);
  snprintf(line, sizeof line, "%.*s", (int)strcspn(s.at, "\n"), s.at);
  bad = sscanf(line, "%lf %1s", &date, rest) == 1 ? read_sesame(t, &s, header, err)
                                                  : read_miluph(t, &begin, err);
  free(s.text);
  return bad;
}

/* ---- hdf5 ---- */

/* The fields with the density in front, as the file has them. */
static const struct {
  const char *name, *unit, *meaning;
} ROWS[] = {{"Density", "kg/m^3", "density"},
#define TABFILE_ROW(CAPITAL, NAME, UNIT, MEANING) {#NAME, UNIT, MEANING},
            TABLE_FIELDS(TABFILE_ROW)
#undef TABFILE_ROW
};

static int put(hid_t file, int k, const double *x, int rank, const hsize_t *dims, Err *err)
{
  hid_t set = hdf_put_rows(file, ROWS[k].name, H5T_NATIVE_DOUBLE, rank, dims, x, err);
  double one = 1;
  int bad = set < 0 || hdf_put_text(set, "unit", ROWS[k].unit, err) ||
            hdf_put(set, "unitSI", H5T_NATIVE_DOUBLE, 0, &one, err) ||
            hdf_put_text(set, "meaning", ROWS[k].meaning, err);
  if (set >= 0) H5Dclose(set);
  return bad;
}

static int write_hdf5(const Table *t, const char *path, Err *err)
{
  hid_t file = hdf_create(path, err);
  hsize_t dims[2] = {(hsize_t)t->nrho, (hsize_t)t->ny};
  int bad = file < 0 || hdf_put_text(file, "Source", t->about, err) ||
            put(file, 0, t->rho, 1, dims, err) ||
            put(file, 1 + (t->heat ? TABLE_T : TABLE_U), t->y, 1, dims + 1, err);
  for (int k = 0; k < TABLE_FIELD_COUNT && !bad; k++)
    if (t->field[k]) bad = put(file, 1 + k, t->field[k], 2, dims, err);
  if (file >= 0 && hdf_close(file, bad ? NULL : err)) bad = 1;
  return bad ? -1 : 0;
}

/* Rank and shape of a dataset; 0: absent, -1: error. */
static int shape(hid_t file, const char *path, const char *name, hsize_t dims[2], Err *err)
{
  hid_t set;
  int rank;
  if (hdf_has(file, name) == 0) return 0;
  if ((set = H5Dopen2(file, name, H5P_DEFAULT)) < 0)
    return hdf_fail(err, "%s: cannot read '%s'", path, name);
  rank = hdf_shape(set, 2, dims);
  H5Dclose(set);
  if (rank < 1 || dims[0] < 1 || dims[0] > MOST || (rank == 2 && dims[1] > MOST))
    return err_set(err, "%s: '%s' is neither an axis nor a table", path, name);
  return rank;
}

static int get(hid_t file, const char *path, const char *name, double *x, Err *err)
{
  hid_t set = H5Dopen2(file, name, H5P_DEFAULT);
  Err why = {""};
  int bad = set < 0 || hdf_get_rows(set, H5T_NATIVE_DOUBLE, x, &why);
  if (set >= 0) H5Dclose(set);
  return bad ? err_set(err, "%s: cannot read '%s'%s", path, name, why.text) : 0;
}

static int read_fields(Table *t, hid_t file, const char *path, Err *err)
{
  for (int k = 0; k < TABLE_FIELD_COUNT; k++) {
    hsize_t dims[2] = {0, 0};
    int rank = t->field[k] ? shape(file, path, table_names[k], dims, err) : 0;
    if (rank < 0) return -1;
    if (!t->field[k]) continue;
    if (rank == 0 && k != TABLE_P && k != TABLE_U) {
      absent(t, k);
      continue;
    }
    if (rank == 0) return err_set(err, "%s: '%s' is missing", path, table_names[k]);
    if (rank != 2 || dims[0] != (hsize_t)t->nrho || dims[1] != (hsize_t)t->ny)
      return err_set(err, "%s: '%s' is not %d x %d as the axes are", path, table_names[k], t->nrho,
                     t->ny);
    if (get(file, path, table_names[k], t->field[k], err)) return -1;
  }
  return 0;
}

static int read_hdf5(Table *t, const char *path, Err *err)
{
  hid_t file = hdf_open(path, err);
  hsize_t rho[2], u[2], T[2];
  int bad = -1, nu, nT;
  if (file < 0) return -1;
  if (shape(file, path, "Density", rho, err) != 1)
    bad = err_set(err, "%s: no table: it has no axis 'Density'", path);
  else if ((nu = shape(file, path, "InternalEnergy", u, err)) >= 0 &&
           (nT = shape(file, path, "Temperature", T, err)) >= 0) {
    if ((nu == 1) == (nT == 1))
      bad = err_set(err, "%s: one of 'InternalEnergy' and 'Temperature' must be an axis", path);
    else
      bad = table_new(t, (int)rho[0], (int)(nT == 1 ? T[0] : u[0]), nT == 1, err) ||
            get(file, path, "Density", t->rho, err) ||
            get(file, path, t->heat ? "Temperature" : "InternalEnergy", t->y, err) ||
            read_fields(t, file, path, err) ||
            hdf_get_text(file, "Source", t->about, sizeof t->about, err);
  }
  hdf_close(file, NULL);
  return bad ? -1 : 0;
}

/* ---- all ---- */

int tabfile_read(Table *t, const char *path, Err *err)
{
  unsigned char magic[8] = {0};
  FILE *f = fopen(path, "rb");
  size_t got;
  memset(t, 0, sizeof *t);
  if (!f) return err_set(err, "cannot open '%s': %s", path, strerror(errno));
  got = fread(magic, 1, sizeof magic, f);
  fclose(f);
  if (got == sizeof magic && !memcmp(magic, "\211HDF\r\n\032\n", 8)
          ? read_hdf5(t, path, err) || table_check(t, path, err)
          : read_text(t, path, err) || table_check(t, path, err)) {
    table_free(t);
    return -1;
  }
  return 0;
}

int tabfile_write(const Table *t, const char *path, int format, Err *err)
{
  Spool out;
  FILE *f;
  int bad;
  if (format == TABFILE_SESAME && !t->heat)
    return err_set(err, "the format sesame needs an axis of temperatures");
  if (format == TABFILE_MILUPH && t->heat)
    return err_set(err, "the format miluph needs an axis of energies");
  if (spool_out(&out, path, format == TABFILE_HDF5, err)) return -1;
  if (format == TABFILE_HDF5)
    bad = write_hdf5(t, out.path, err);
  else if (!(f = fopen(out.path, "w")))
    bad = err_set(err, "cannot write '%s': %s", path, strerror(errno));
  else {
    (format == TABFILE_SESAME ? write_sesame : write_miluph)(t, f);
    bad = ferror(f);
    if (fclose(f) || bad) bad = err_set(err, "cannot write '%s'", path);
  }
  if (bad) return spool_abort(&out), -1;
  return spool_commit(&out, err);
}

int tabfile_checksum(const char *path, char sum[9], Err *err)
{
  unsigned char buf[1 << 16];
  uLong crc = crc32(0, NULL, 0);
  FILE *f = fopen(path, "rb");
  size_t n;
  int bad;
  if (!f) return err_set(err, "cannot open '%s': %s", path, strerror(errno));
  while ((n = fread(buf, 1, sizeof buf, f)) > 0) crc = crc32(crc, buf, (uInt)n);
  bad = ferror(f);
  fclose(f);
  if (bad) return err_set(err, "cannot read '%s': %s", path, strerror(errno));
  snprintf(sum, 9, "%08lx", (unsigned long)crc);
  return 0;
}
