/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A unit is a factor and the powers of metre, kilogram, second, kelvin and radian. Suffix and
 * wanted kind are read by the same grammar and must agree in the powers: factors joined by `*`, `/`
 * or blanks, each a name with an optional ^power. */
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "unit.h"

enum { BASES = UNIT_BASES, LONGEST = 64 };

#define PI 3.14159265358979323846264338327950288L

/* long double, so that g/cm^3 is 1000 kg/m^3 to the last bit */
typedef struct {
  long double factor;
  int power[BASES];
} Unit;

/* X(name, factor to SI, powers of m kg s K rad) */
/* clang-format off */
#define UNITS(X) \
  X("%", 0.01L,                  0, 0, 0, 0, 0) \
  X("m", 1,                     1, 0, 0, 0, 0) \
  X("um", 1e-6L,                 1, 0, 0, 0, 0) \
  X("mm", 1e-3L,                 1, 0, 0, 0, 0) \
  X("cm", 1e-2L,                 1, 0, 0, 0, 0) \
  X("km", 1e3,                  1, 0, 0, 0, 0) \
  X("au", 149597870700.,        1, 0, 0, 0, 0) /* IAU 2012 resolution B2 */ \
  X("Rearth", 6.3781e6,         1, 0, 0, 0, 0) /* equatorial, IAU 2015 resolution B3 */ \
  X("Rmoon", 1.7374e6,          1, 0, 0, 0, 0) /* mean, IAU WGCCRE 2015 (Archinal et al. 2018) */ \
  X("Rsun", 6.957e8,            1, 0, 0, 0, 0) /* IAU 2015 resolution B3 */ \
  X("cc", 1e-6L,                 3, 0, 0, 0, 0) \
  X("kg", 1,                    0, 1, 0, 0, 0) \
  X("g", 1e-3L,                  0, 1, 0, 0, 0) \
  X("t", 1e3,                   0, 1, 0, 0, 0) \
  X("Mearth", 5.9722e24,        0, 1, 0, 0, 0) /* IAU 2009 (Luzum et al. 2011), as the next two */ \
  X("Mmoon", 5.9722e24L * 1.23000371e-2L, 0, 1, 0, 0, 0) \
  X("Msun", 1.9884e30,          0, 1, 0, 0, 0) \
  X("s", 1,                     0, 0, 1, 0, 0) \
  X("us", 1e-6L,                 0, 0, 1, 0, 0) \
  X("ms", 1e-3L,                 0, 0, 1, 0, 0) \
  X("min", 60,                  0, 0, 1, 0, 0) \
  X("h", 3600,                  0, 0, 1, 0, 0) \
  X("d", 86400,                 0, 0, 1, 0, 0) \
  X("yr", 365.25 * 86400,       0, 0, 1, 0, 0) /* Julian year, IAU */ \
  X("Hz", 1,                    0, 0, -1, 0, 0) \
  X("K", 1,                     0, 0, 0, 1, 0) \
  X("eV", 1.602176634e-19L / 1.380649e-23L, 0, 0, 0, 1, 0) /* a temperature: e/k, CODATA 2018 */ \
  X("rad", 1,                   0, 0, 0, 0, 1) \
  X("deg", PI / 180,            0, 0, 0, 0, 1) \
  X("arcmin", PI / 10800,       0, 0, 0, 0, 1) \
  X("arcsec", PI / 648000,      0, 0, 0, 0, 1) \
  X("N", 1,                     1, 1, -2, 0, 0) \
  X("J", 1,                     2, 1, -2, 0, 0) \
  X("kJ", 1e3,                  2, 1, -2, 0, 0) \
  X("MJ", 1e6,                  2, 1, -2, 0, 0) \
  X("GJ", 1e9,                  2, 1, -2, 0, 0) \
  X("erg", 1e-7L,                2, 1, -2, 0, 0) \
  X("W", 1,                     2, 1, -3, 0, 0) \
  X("Pa", 1,                    -1, 1, -2, 0, 0) \
  X("kPa", 1e3,                 -1, 1, -2, 0, 0) \
  X("MPa", 1e6,                 -1, 1, -2, 0, 0) \
  X("GPa", 1e9,                 -1, 1, -2, 0, 0) \
  X("bar", 1e5,                 -1, 1, -2, 0, 0) \
  X("kbar", 1e8,                -1, 1, -2, 0, 0) \
  X("Mbar", 1e11,               -1, 1, -2, 0, 0)
/* clang-format on */

#define UNIT_NAME(NAME, ...)          NAME,
#define UNIT_VALUE(NAME, FACTOR, ...) {FACTOR, {__VA_ARGS__}},
static const char *const NAMES[] = {UNITS(UNIT_NAME)};
static const Unit VALUES[] = {UNITS(UNIT_VALUE)};
static const int COUNT = sizeof NAMES / sizeof NAMES[0];

static int lower(char c) { return tolower((unsigned char)c); }

static int least(int a, int b) { return a < b ? a : b; }

/* Optimal string alignment: insertions, deletions, substitutions and swaps of neighbours,
 * regardless of case. */
static int distance(const char *a, int na, const char *b, int nb)
{
  int row[3][LONGEST + 1] = {{0}};
  for (int j = 0; j <= nb; j++) row[0][j] = j;
  for (int i = 1; i <= na; i++) {
    int *now = row[i % 3], *up = row[(i + 2) % 3], *up2 = row[(i + 1) % 3];
    now[0] = i;
    for (int j = 1; j <= nb; j++) {
      now[j] =
          least(least(up[j], now[j - 1]) + 1, up[j - 1] + (lower(a[i - 1]) != lower(b[j - 1])));
      if (i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) &&
          lower(a[i - 2]) == lower(b[j - 1]))
        now[j] = least(now[j], up2[j - 2] + 1);
    }
  }
  return row[na % 3][nb];
}

const char *unit_nearest(const char *word, const char *const *candidates, int n)
{
  const char *best = NULL;
  size_t length = strlen(word);
  int closest = least((int)(length + 2) / 3, (int)length - 1) + 1;
  if (length > LONGEST) return NULL;
  for (int k = 0; k < n; k++) {
    size_t other = strlen(candidates[k]);
    int d = other > LONGEST ? closest : distance(word, (int)length, candidates[k], (int)other);
    if (d < closest) closest = d, best = candidates[k];
  }
  return best;
}

int unit_choice(const char *word, const char *choices, Err *err)
{
  char copy[1024], *names[64], *save = NULL;
  const char *near;
  int n = 0;
  snprintf(copy, sizeof copy, "%s", choices);
  for (char *w = strtok_r(copy, "|", &save); w && n < 64; w = strtok_r(NULL, "|", &save)) {
    if (!strcmp(w, word)) return n;
    names[n++] = w;
  }
  near = unit_nearest(word, (const char *const *)names, n);
  if (near) return err_set(err, "unknown word '%s' (did you mean '%s'?)", word, near);
  return err_set(err, "'%s' is none of %s", word, choices);
}

static int unknown(const char *name, Err *err)
{
  const char *near = unit_nearest(name, NAMES, COUNT);
  if (!near) return err_set(err, "unknown unit '%s'", name);
  return err_set(err, "unknown unit '%s' (did you mean '%s'?)", name, near);
}

/* One factor, a name with an optional ^power, multiplied into u (sign -1: divided). */
static int factor(const char **text, int sign, Unit *u, Err *err)
{
  char name[LONGEST];
  size_t length = **text == '%' ? 1 : strcspn(*text, "^*/ \t0123456789");
  long power = 1;
  int k = 0;
  if (length == 0 || length >= sizeof name) return err_set(err, "not a unit: '%.40s'", *text);
  memcpy(name, *text, length);
  name[length] = 0;
  *text += length;
  if (**text == '^') {
    char *end;
    power = strtol(*text + 1, &end, 10);
    if (end == *text + 1 || power < -9 || power > 9 || power == 0)
      return err_set(err, "not a power: '%.40s'", *text);
    *text = end;
  }
  while (k < COUNT && strcmp(name, NAMES[k])) k++;
  if (k == COUNT) return unknown(name, err);
  u->factor *= powl(VALUES[k].factor, (long double)(sign * power));
  for (int b = 0; b < BASES; b++) u->power[b] += sign * (int)power * VALUES[k].power[b];
  return 0;
}

/* A whole unit; `1/s` may be written `/s`, and nothing is no unit. */
static int parse_unit(const char *text, Unit *u, Err *err)
{
  int sign = 1;
  *u = (Unit){1, {0}};
  text += strspn(text, " \t");
  if (!strncmp(text, "1/", 2)) text++;
  while (*text) {
    if (*text == '/')
      sign = -1, text += 1;
    else if (*text == '*')
      sign = 1, text += 1;
    text += strspn(text, " \t");
    if (factor(&text, sign, u, err)) return -1;
    text += strspn(text, " \t");
    sign = 1;
  }
  return 0;
}

int unit_suffix(const char *text, double *number, const char **suffix, Err *err)
{
  const char *digits = text + strspn(text, " \t+-");
  char *end;
  *number = strtod(text, &end);
  if (end == text || !strchr("0123456789.", *digits) ||
      (digits[0] == '0' && lower(digits[1]) == 'x'))
    return err_set(err, "'%s' is not a number", text);
  if (!isfinite(*number)) return err_set(err, "'%s' is too large", text);
  *suffix = end + strspn(end, " \t");
  return 0;
}

int unit_parse(const char *text, const char *kind, double *si, Err *err)
{
  Unit unit, want;
  Err why;
  const char *suffix;
  double number;
  if (parse_unit(strcmp(kind, "1") ? kind : "", &want, &why))
    return err_set(err, "kind '%s' of '%s': %s", kind, text, why.text);
  if (unit_suffix(text, &number, &suffix, err)) return -1;
  if (!*suffix)
    unit = want;
  else if (parse_unit(suffix, &unit, &why))
    return err_set(err, "'%s': %s", text, why.text);
  if (memcmp(unit.power, want.power, sizeof unit.power)) {
    if (!strcmp(kind, "1"))
      return err_set(err, "'%s': a plain number is wanted, without '%s'", text, suffix);
    return err_set(err, "'%s': wanted a unit like '%s', not '%s'", text, kind, suffix);
  }
  number = (double)(number * unit.factor / want.factor);
  if (!isfinite(number)) return err_set(err, "'%s' is too large", text);
  *si = number;
  return 0;
}

int unit_powers(const char *unit, double *si, int power[UNIT_BASES], Err *err)
{
  Unit u;
  if (parse_unit(strcmp(unit, "1") ? unit : "", &u, err)) return -1;
  *si = (double)u.factor;
  memcpy(power, u.power, sizeof u.power);
  return 0;
}

int unit_list(const char *text, const char *kind, int n, double *si, Err *err)
{
  char part[LONGEST];
  const char *at = text;
  for (int k = 0; k < n; k++) {
    size_t length = strcspn(at, ",");
    if ((at[length] == ',') != (k < n - 1))
      return err_set(err, "'%s': %d numbers between commas are wanted", text, n);
    if (length >= sizeof part) return err_set(err, "'%s' is too long", at);
    snprintf(part, sizeof part, "%.*s", (int)length, at);
    if (unit_parse(part, kind, si + k, err)) return -1;
    at += length + 1;
  }
  return 0;
}

int unit_count(const char *text, long *count, Err *err)
{
  static const struct {
    const char *suffix;
    double factor;
  } SIZES[] = {{"", 1}, {"k", 1e3}, {"M", 1e6}, {"G", 1e9}};
  const char *suffix;
  double x;
  int k = 0;
  if (unit_suffix(text, &x, &suffix, err)) return -1;
  while (k < 4 && strcmp(suffix, SIZES[k].suffix)) k++;
  if (k == 4) return err_set(err, "'%s' is not a whole number (20000, 2e4, 20k)", text);
  x *= SIZES[k].factor;
  if (x != floor(x)) return err_set(err, "'%s' is not a whole number", text);
  if (fabs(x) > 0x1p53) return err_set(err, "'%s' is too large", text);
  *count = (long)x;
  return 0;
}

typedef struct {
  double size;
  const char *name;
} Step;

/* The largest unit of which there are at least `least_number`; three digits, none lost before the
 * point. */
static const char *readable(double value, double least_number, const Step *step, int n, char *buf,
                            int size)
{
  int k = 0;
  double x;
  while (k < n - 1 && fabs(value) < least_number * step[k].size &&
         !(value == 0 && step[k].size == 1))
    k++;
  x = value / step[k].size;
  if (fabs(x) >= 99.95 && fabs(x) < 1e6)
    snprintf(buf, (size_t)size, "%.0f %s", x, step[k].name);
  else
    snprintf(buf, (size_t)size, "%.3g %s", x, step[k].name);
  return buf;
}

const char *unit_time_text(double seconds, char *buf, int size)
{
  static const Step STEPS[] = {
      {365.25 * 86400, "yr"}, {86400, "d"}, {3600, "h"}, {60, "min"}, {1, "s"},
      {1e-3, "ms"},           {1e-6, "us"}};
  return readable(seconds, 2, STEPS, sizeof STEPS / sizeof STEPS[0], buf, size);
}

const char *unit_length_text(double metres, char *buf, int size)
{
  static const Step STEPS[] = {
      {149597870700., "au"}, {1e3, "km"}, {1, "m"}, {1e-2, "cm"}, {1e-3, "mm"}};
  return readable(metres, 1, STEPS, sizeof STEPS / sizeof STEPS[0], buf, size);
}
