/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tabulated law: p and what goes with it at the nodes of a grid in density and a second axis y, the
 * energy u or the temperature T (ANEOS, SESAME). Between the nodes every quantity is a bicubic
 * Hermite polynomial in rho and y, whose slopes at the nodes lib/table.c makes from the numbers of
 * the table. So p has continuous derivatives, and c is that of this p:
 *
 *   p_u = p_y/u_y,  p_rho|u = p_rho|y - p_u u_rho|y,  c^2 = p_rho|u + p p_u/rho^2
 *
 * kept within a factor 4 of the c in the table: where a table holds p to eight digits, the cold end
 * of its grid has no derivatives in it. An axis may hold a value twice: across that line slopes may
 * jump (Tillotson at rho0, Eiv, Ecv).
 *
 * Outside (miluphcuda's rules, without its steps): u below the line of the density: p of the lowest
 * u; above: an ideal gas with the Grueneisen parameter of the edge; rho above: linear on from the
 * last cell; rho below: p in proportion to rho. eos_table_outside tells. */
#ifndef EOS_TABLE_H
#define EOS_TABLE_H

/* clang-format off */
#define EOS_TABLE_ROWS(X) \
  X(rho0,    "kg/m^3", "0", 0, 1e30, "density at rest; 0: where the table has p = 0 at u = 0") \
  X(rho_min, "1",      "0", 0, 1,    "no tension below rho_min x rho0; 0: never cut") \
  X(c_min,   "m/s",    "0", 0, 1e30, "floor of the sound speed; 0: 1 % of that at rest") \
  X(vapour,  "1",      "2", 0, 1e3,  "number of the phase that has vapour, as ANEOS counts: no strength there; 0: none")
/* clang-format on */

struct eos_table {
#define EOS_ROW(MEMBER, ...) double MEMBER;
  EOS_TABLE_ROWS(EOS_ROW)
#undef EOS_ROW
  double bulk;        /* rho c^2 at rest [Pa] */
  int nrho, ny;       /* nodes */
  int heat;           /* y is T, not u */
  const double *data; /* see eos_table_at; a copy needs eos_table_words numbers of it */
};

/* The parts of data, in this order: axes [nrho], [ny]; then by nodes, rho outer: p and (heat) u,
 * each [4]: value, slopes with rho, y, both; c; phase; and, not needed in a run, s and T [4]. */
enum {
  EOS_TABLE_RHO,
  EOS_TABLE_Y,
  EOS_TABLE_P,
  EOS_TABLE_U,
  EOS_TABLE_C,
  EOS_TABLE_PHASE,
  EOS_TABLE_S,
  EOS_TABLE_T,
  EOS_TABLE_PARTS
};

/* eos_table_start: where a part begins; of EOS_TABLE_PARTS: how many numbers there are in all. */
HD size_t eos_table_start(const struct eos_table *e, int part)
{
  size_t n = (size_t)e->nrho * (size_t)e->ny, at = 0;
  if (part > EOS_TABLE_RHO) at += (size_t)e->nrho;
  if (part > EOS_TABLE_Y) at += (size_t)e->ny;
  if (part > EOS_TABLE_P) at += 4 * n;
  if (part > EOS_TABLE_U && e->heat) at += 4 * n;
  if (part > EOS_TABLE_C) at += n;
  if (part > EOS_TABLE_PHASE) at += n;
  if (part > EOS_TABLE_S) at += 4 * n;
  if (part > EOS_TABLE_T && !e->heat) at += 4 * n;
  return at;
}

/* eos_table_words: how many numbers a run reads. */
HD size_t eos_table_words(const struct eos_table *e) { return eos_table_start(e, EOS_TABLE_S); }

HD const double *eos_table_part(const struct eos_table *e, int part)
{
  return e->data + eos_table_start(e, part);
}

/* A cell of an axis and the weights there of both ends' values and slopes: v for the value, d for
 * the derivative. */
typedef struct {
  int i;
  double t, v[4], d[4]; /* t: 0 to 1 in the cell */
} EosTableCell;

HD void eos_table_weights(EosTableCell *c, double t, double width)
{
  double t2 = t * t, s = 1 - t;
  c->t = t;
  c->v[1] = t2 * (3 - 2 * t), c->v[0] = 1 - c->v[1];
  c->v[2] = width * t * s * s, c->v[3] = -width * t2 * s;
  c->d[1] = 6 * t * s / width, c->d[0] = -c->d[1];
  c->d[2] = s * (1 - 3 * t), c->d[3] = t * (3 * t - 2);
}

/* The cell of [n] ascending nodes that holds x; the first or last when none does, x being moved to
 * its edge. Never one of no width. */
HD EosTableCell eos_table_cell(const double *axis, int n, double x)
{
  int low = 0, high = n - 1;
  EosTableCell c;
  while (high - low > 1) {
    int middle = (low + high) / 2;
    if (axis[middle] <= x)
      low = middle;
    else
      high = middle;
  }
  c.i = low;
  x = x < axis[0] ? axis[0] : x > axis[n - 1] ? axis[n - 1] : x;
  eos_table_weights(&c, (x - axis[low]) / (axis[high] - axis[low]), axis[high] - axis[low]);
  return c;
}

HD double eos_table_sum(const double w[4], double a, double b, double c, double d)
{
  return w[0] * a + w[1] * b + w[2] * c + w[3] * d;
}

/* On row j of nodes, at the density of x: the value (k = 0) or the slope with y (k = 2). */
HD double eos_table_row(const struct eos_table *e, const double *field, const double w[4], int i,
                        int j, int k)
{
  const double *a = field + 4 * ((size_t)i * (size_t)e->ny + (size_t)j), *b = a + 4 * e->ny;
  return eos_table_sum(w, a[k], b[k], a[k + 1], b[k + 1]);
}

/* A field at a point: value, slopes with rho and y, mixed slope. */
typedef struct {
  double f, x, y, xy;
} EosTableValue;

HD EosTableValue eos_table_value(const struct eos_table *e, int part, const EosTableCell *x,
                                 const EosTableCell *y)
{
  const double *field = eos_table_part(e, part);
  double v[4], d[4];
  EosTableValue out;
  for (int k = 0; k < 4; k++) {
    v[k] = eos_table_row(e, field, x->v, x->i, y->i + (k & 1), k & 2);
    d[k] = eos_table_row(e, field, x->d, x->i, y->i + (k & 1), k & 2);
  }
  out.f = eos_table_sum(y->v, v[0], v[1], v[2], v[3]);
  out.y = eos_table_sum(y->d, v[0], v[1], v[2], v[3]);
  out.x = eos_table_sum(y->v, d[0], d[1], d[2], d[3]);
  out.xy = eos_table_sum(y->d, d[0], d[1], d[2], d[3]);
  return out;
}

/* Where in [0, 1] a rising cubic with these ends and slopes (times width) takes the value f. */
HD double eos_table_root(double f, double f0, double f1, double s0, double s1)
{
  double low = 0, high = 1, t = f1 > f0 ? (f - f0) / (f1 - f0) : 0;
  for (int k = 0; k < 60; k++) {
    EosTableCell c;
    double off, slope, step;
    eos_table_weights(&c, t, 1);
    off = eos_table_sum(c.v, f0, f1, s0, s1) - f;
    slope = eos_table_sum(c.d, f0, f1, s0, s1);
    if (off > 0)
      high = t;
    else
      low = t;
    step = slope > 0 ? t - off / slope : -1;
    if (!(step > low && step < high)) step = 0.5 * (low + high);
    if (fabs(step - t) < 1e-15 || off == 0) break;
    t = step;
  }
  return t;
}

/* eos_table_find: the cell in y in which a field (EOS_TABLE_U, _S or _T) that rises with y takes
 * the value f at the density of x. *outside: -1 when it is below everywhere, 1 when above; the cell
 * is then at that edge. */
HD EosTableCell eos_table_find(const struct eos_table *e, int part, const EosTableCell *x, double f,
                               int *outside)
{
  const double *y = eos_table_part(e, EOS_TABLE_Y), *field;
  int low = 0, high = e->ny - 1;
  double f0, f1, width;
  EosTableCell c;
  if ((e->heat && part == EOS_TABLE_T) || (!e->heat && part == EOS_TABLE_U)) {
    *outside = f < y[0] ? -1 : f > y[high] ? 1 : 0;
    return eos_table_cell(y, e->ny, f);
  }
  field = eos_table_part(e, part);
  while (high - low > 1) {
    int middle = (low + high) / 2;
    if (eos_table_row(e, field, x->v, x->i, middle, 0) <= f)
      low = middle;
    else
      high = middle;
  }
  f0 = eos_table_row(e, field, x->v, x->i, low, 0);
  f1 = eos_table_row(e, field, x->v, x->i, high, 0);
  width = y[high] - y[low];
  *outside = f < f0 && low == 0 ? -1 : f > f1 && high == e->ny - 1 ? 1 : 0;
  c.i = low;
  eos_table_weights(
      &c,
      f <= f0   ? 0
      : f >= f1 ? 1
                : eos_table_root(f, f0, f1, width * eos_table_row(e, field, x->v, x->i, low, 2),
                                 width * eos_table_row(e, field, x->v, x->i, high, 2)),
      width);
  return c;
}

/* p and its slopes, as the laws have them, and the bounds of c^2 from the table (0, infinite where
 * it says nothing). */
typedef struct {
  double p, rho, u, low, high;
} EosTableSlope;

/* c^2 in the table, linear in the cell; 0 where a corner has none. */
HD double eos_table_c2(const struct eos_table *e, const EosTableCell *x, const EosTableCell *y)
{
  const double *a = eos_table_part(e, EOS_TABLE_C) + (size_t)x->i * (size_t)e->ny + y->i;
  const double *b = a + e->ny;
  if (!(a[0] > 0 && a[1] > 0 && b[0] > 0 && b[1] > 0)) return 0;
  return (1 - y->t) * ((1 - x->t) * a[0] * a[0] + x->t * b[0] * b[0]) +
         y->t * ((1 - x->t) * a[1] * a[1] + x->t * b[1] * b[1]);
}

/* At a density within the table. */
HD EosTableSlope eos_table_inside(const struct eos_table *e, double rho, double u)
{
  EosTableCell x = eos_table_cell(e->data, e->nrho, rho), y;
  EosTableValue p, w = {u, 0, 1, 0};
  EosTableSlope t;
  double c2, k;
  int outside;
  y = eos_table_find(e, EOS_TABLE_U, &x, u, &outside);
  p = eos_table_value(e, EOS_TABLE_P, &x, &y);
  if (e->heat)
    w = eos_table_value(e, EOS_TABLE_U, &x, &y);
  else if (outside)
    w.f = eos_table_part(e, EOS_TABLE_Y)[outside < 0 ? 0 : e->ny - 1];
  k = w.y > 0 ? p.y / w.y : 0;
  t.p = p.f, t.rho = p.x - k * w.x, t.u = k, t.low = 0, t.high = INFINITY;
  if (outside < 0) t.rho = p.x, t.u = 0;
  if (outside > 0) {
    t.p += k * (u - w.f);
    if (w.y > 0) t.rho += (p.xy - k * w.xy) / w.y * (u - w.f);
  }
  c2 = outside ? 0 : eos_table_c2(e, &x, &y);
  if (c2 > 0) t.low = c2 / 16, t.high = 16 * c2;
  return t;
}

HD double eos_table_rho0(const struct eos_table *e) { return e->rho0; }

HD EosPoint eos_table(const struct eos_table *e, double rho, double u, double r)
{
  const double *axis = e->data;
  int last = e->nrho - 1, beyond = rho > axis[last];
  double c2, from = beyond ? axis[last - 1] : rho < axis[0] ? axis[0] : rho;
  EosTableSlope t = {0, 0, 0, 0, 0}, s = t;
  (void)r;
  for (int k = 0; k <= beyond; k++) /* one copy of the code */
    s = t, t = eos_table_inside(e, k ? axis[last] : from, u);
  if (beyond) {
    double width = axis[last] - axis[last - 1], x = (rho - axis[last]) / width;
    t.rho = (t.p - s.p) / width, t.p += x * (t.p - s.p), t.u += x * (t.u - s.u);
  } else if (rho < axis[0]) { /* p/rho and p_u/rho as at the edge */
    t.rho = t.p / axis[0], t.p *= rho / axis[0], t.u *= rho / axis[0];
  }
  c2 = t.rho + t.p * t.u / (rho * rho);
  if (rho == from) c2 = c2 < t.low ? t.low : c2 > t.high ? t.high : c2;
  return eos_point(t.p < 0 && rho < e->rho_min * e->rho0 ? 0 : t.p, c2, e->c_min);
}

/* eos_table_outside: 0, or why a state is not in the table: 1 for rho, 2 for u above, 4 for u
 * below, added. */
HD int eos_table_outside(const struct eos_table *e, double rho, double u)
{
  EosTableCell x = eos_table_cell(e->data, e->nrho, rho);
  int outside;
  eos_table_find(e, EOS_TABLE_U, &x, u, &outside);
  return (rho < e->data[0] || rho > e->data[e->nrho - 1]) + (outside > 0 ? 2 : outside < 0 ? 4 : 0);
}

/* The table's number of the phase at the node nearest to a point. */
HD int eos_table_phase(const struct eos_table *e, const EosTableCell *x, const EosTableCell *y)
{
  const int i = x->i + (x->v[1] > 0.5), j = y->i + (y->v[1] > 0.5);
  return (int)eos_table_part(e, EOS_TABLE_PHASE)[(size_t)i * (size_t)e->ny + (size_t)j];
}

/* eos_table_vapour: whether the phase at rho, u is the one with vapour. */
HD_CALL int eos_table_vapour(const struct eos_table *e, double rho, double u)
{
  EosTableCell x = eos_table_cell(e->data, e->nrho, rho), y;
  int outside;
  if (e->vapour <= 0) return 0;
  y = eos_table_find(e, EOS_TABLE_U, &x, u, &outside);
  return eos_table_phase(e, &x, &y) == (int)e->vapour;
}

/* What else a table knows of a state. */
typedef struct {
  double u, T, s;    /* J/kg, K, J/kg/K */
  double u_rho, u_T; /* slopes of u: with rho at constant T, with T (the heat capacity) */
  int phase;         /* the table's own number at the nearest node; 0: unknown */
} EosTableState;

/* eos_table_state: at rho [kg/m^3] and a value of u, s or T (part: EOS_TABLE_U, _S, _T). Of u
 * outside the table the nearest edge is taken, above it with the heat capacity of the edge; s or T
 * outside give NAN throughout. Not for a copy of eos_table_words numbers. */
HD EosTableState eos_table_state(const struct eos_table *e, double rho, int part, double value)
{
  EosTableCell x = eos_table_cell(e->data, e->nrho, rho), y;
  EosTableState out = {NAN, NAN, NAN, NAN, NAN, 0};
  EosTableValue u, T, s;
  int outside;
  const double *axis = eos_table_part(e, EOS_TABLE_Y);
  y = eos_table_find(e, part, &x, value, &outside);
  if (outside && part != EOS_TABLE_U) return out;
  T.f = axis[y.i] * y.v[0] + axis[y.i + 1] * y.v[1] + y.v[2] + y.v[3];
  T.y = 1, T.x = T.xy = 0, u = T;
  if (e->heat)
    u = eos_table_value(e, EOS_TABLE_U, &x, &y);
  else
    T = eos_table_value(e, EOS_TABLE_T, &x, &y);
  s = eos_table_value(e, EOS_TABLE_S, &x, &y);
  out.u = u.f, out.T = T.f, out.s = s.f;
  out.u_T = u.y / T.y, out.u_rho = u.x - out.u_T * T.x;
  out.phase = eos_table_phase(e, &x, &y);
  if (outside > 0 && out.u_T > 0 && T.f > 0) {
    out.T = T.f + (value - u.f) / out.u_T;
    out.s += out.u_T * log(out.T / T.f);
  }
  if (outside) out.u = value;
  return out;
}

#endif
