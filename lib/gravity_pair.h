/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The sums of gravity.c in one precision; included once with REAL = float and once with double, and
 * NAME(x) = x_f, x_d. Lists of sources are structures of arrays relative to an origin, padded by
 * massless sources far away to a multiple of PAD, so that the loops are all vectors. */

typedef struct {
  REAL *x, *y, *z, *m, *h, *q[6]; /* h: half the support, of nodes the trace; q: nodes only */
  REAL *all;
  long n, room;
} NAME(List);

/* Room for n sources and the padding; the contents are lost. */
static int NAME(reserve)(NAME(List) * l, long n)
{
  if (n + PAD <= l->room) return 0;
  free(l->all);
  l->room = (n + n / 4 + 2 * PAD) & ~(PAD - 1L);
  l->all = aligned_alloc(ALIGN, (size_t)l->room * 11 * sizeof(REAL));
  if (!l->all) return l->room = 0, -1;
  REAL **part[] = {&l->x, &l->y, &l->z, &l->m, &l->h};
  for (int k = 0; k < 5; k++) *part[k] = l->all + k * l->room;
  for (int k = 0; k < 6; k++) l->q[k] = l->all + (5 + k) * l->room;
  return 0;
}

static void NAME(pad)(NAME(List) * l)
{
  for (; l->n & (PAD - 1); l->n++) {
    const long k = l->n;
    l->x[k] = l->y[k] = l->z[k] = 4;
    l->m[k] = l->h[k] = 0;
    for (int c = 0; c < 6; c++) l->q[c][k] = 0;
  }
}

static void NAME(pack_nodes)(NAME(List) * l, const Scale *s, const TreeNode *node,
                             const double *trace, const int32_t *list, long n)
{
  const double im = 1 / s->mass, il = 1 / s->length, iq = im * il * il;
  for (long k = 0; k < n; k++) {
    const TreeNode *p = node + list[k];
    l->x[k] = (REAL)((p->com[0] - s->origin[0]) * il);
    l->y[k] = (REAL)((p->com[1] - s->origin[1]) * il);
    l->z[k] = (REAL)((p->com[2] - s->origin[2]) * il);
    l->m[k] = (REAL)(p->mass * im);
    for (int c = 0; c < 6; c++) l->q[c][k] = (REAL)(p->q[c] * iq);
  }
  for (long k = 0; k < n && trace; k++) l->h[k] = (REAL)(trace[list[k]] * iq);
  l->n = n;
  NAME(pad)(l);
}

/* Appends particles b .. e-1. */
static void NAME(pack_particles)(NAME(List) * l, const Scale *s, const Bodies *p, long b, long e)
{
  const double im = 1 / s->mass, il = 1 / s->length, hl = 0.5 * il;
  const double ox = s->origin[0], oy = s->origin[1], oz = s->origin[2];
  const double *restrict px = p->x + 3 * b, *restrict pm = p->m + b,
                         *restrict ph = p->h ? p->h + b : NULL;
  REAL *restrict x = l->x + l->n, *restrict y = l->y + l->n, *restrict z = l->z + l->n;
  REAL *restrict m = l->m + l->n, *restrict h = l->h + l->n;
  const REAL half = (REAL)(s->support * hl);
  for (long i = 0; i < e - b; i++) {
    x[i] = (REAL)((px[3 * i] - ox) * il);
    y[i] = (REAL)((px[3 * i + 1] - oy) * il);
    z[i] = (REAL)((px[3 * i + 2] - oz) * il);
    m[i] = (REAL)(pm[i] * im);
  }
  for (long i = 0; i < e - b; i++) h[i] = ph ? (REAL)(ph[i] * hl) : half;
  l->n += e - b;
}

/* Adds the field of all nodes of the list at (x, y, z) to f: acceleration and potential for G = 1.
 */
INLINE void NAME(from_nodes)(const NAME(List) * l, REAL x, REAL y, REAL z, REAL eps2, int what,
                             REAL f[4])
{
  const REAL *restrict px = l->x, *restrict py = l->y, *restrict pz = l->z, *restrict pm = l->m;
  const REAL *restrict trace = l->h;
  const REAL *restrict q0 = l->q[0], *restrict q1 = l->q[1], *restrict q2 = l->q[2];
  const REAL *restrict q3 = l->q[3], *restrict q4 = l->q[4], *restrict q5 = l->q[5];
  const long n = l->n & ~(PAD - 1L);
  REAL ax = 0, ay = 0, az = 0, phi = 0;
#pragma omp simd reduction(+ : ax, ay, az, phi)
  for (long j = 0; j < n; j++) {
    REAL dx = x - px[j], dy = y - py[j], dz = z - pz[j];
    REAL r2 = dx * dx + dy * dy + dz * dz, d2 = what & PLUMMER ? r2 + eps2 : r2;
    REAL i1 = 1 / NAME(root)(d2), i2 = i1 * i1;
    dx *= i1, dy *= i1, dz *= i1; /* unit vector: its powers neither overflow nor vanish */
    REAL qx = q0[j] * dx + q1[j] * dy + q2[j] * dz;
    REAL qy = q1[j] * dx + q3[j] * dy + q4[j] * dz;
    REAL qz = q2[j] * dx + q4[j] * dy + q5[j] * dz;
    REAL qq = (qx * dx + qy * dy + qz * dz) * i2;
    if (what & PLUMMER) qq -= eps2 * i2 * (trace[j] * i2);
    REAL c = pm[j] + (REAL)2.5 * qq;
    if (what & PULL) {
      ax += (qx * i2 - c * dx) * i2;
      ay += (qy * i2 - c * dy) * i2;
      az += (qz * i2 - c * dz) * i2;
    }
    if (what & POTENTIAL) phi -= (pm[j] + (REAL)0.5 * qq) * i1;
  }
  f[0] += ax, f[1] += ay, f[2] += az, f[3] += phi;
}

/* The same for particles; h: half the target's support; near: the smallest s, pairs below it do not
 * act. */
INLINE void NAME(from_splines)(const NAME(List) * l, REAL x, REAL y, REAL z, REAL h, REAL near,
                               int what, REAL f[4])
{
  const REAL *restrict px = l->x, *restrict py = l->y, *restrict pz = l->z, *restrict pm = l->m,
                       *restrict ph = l->h;
  const long n = l->n & ~(PAD - 1L);
  REAL ax = 0, ay = 0, az = 0, phi = 0;
#pragma omp simd reduction(+ : ax, ay, az, phi)
  for (long j = 0; j < n; j++) {
    REAL dx = x - px[j], dy = y - py[j], dz = z - pz[j], hij = h + ph[j];
    REAL r = NAME(root)(dx * dx + dy * dy + dz * dz), s = r > hij ? r : hij;
    REAL i1 = 1 / (s > near ? s : near), q = r * i1, mi = pm[j] * i1;
    REAL c = mi * (i1 * i1) * SOFTENING_FORCE(q);
    if (what & PULL) ax -= c * dx, ay -= c * dy, az -= c * dz;
    if (what & POTENTIAL) phi -= s > near ? mi * SOFTENING_POTENTIAL(q) : 0;
  }
  f[0] += ax, f[1] += ay, f[2] += az, f[3] += phi;
}

/* The same with Plummer's softening. */
INLINE void NAME(from_plummer)(const NAME(List) * l, REAL x, REAL y, REAL z, REAL eps2, int what,
                               REAL f[4])
{
  const REAL *restrict px = l->x, *restrict py = l->y, *restrict pz = l->z, *restrict pm = l->m;
  const long n = l->n & ~(PAD - 1L);
  REAL ax = 0, ay = 0, az = 0, phi = 0;
#pragma omp simd reduction(+ : ax, ay, az, phi)
  for (long j = 0; j < n; j++) {
    REAL dx = x - px[j], dy = y - py[j], dz = z - pz[j];
    REAL i1 = 1 / NAME(root)(dx * dx + dy * dy + dz * dz + eps2), mi = pm[j] * i1,
         c = mi * (i1 * i1);
    if (what & PULL) ax -= c * dx, ay -= c * dy, az -= c * dz;
    if (what & POTENTIAL) phi -= mi;
  }
  f[0] += ax, f[1] += ay, f[2] += az, f[3] += phi;
}

/* The field at particles b .. e-1 from both lists; self: where particle b stands in the list of
 * particles. */
INLINE void NAME(sums)(const Scale *s, const Bodies *p, long b, long e, const NAME(List) * nodes,
                       NAME(List) * parts, long self, int what)
{
  const double il = 1 / s->length, ga = s->G * s->mass * il * il, gp = s->G * s->mass * il;
  for (long i = b; i < e; i++) {
    if (p->only && !p->only[i]) continue;
    const long k = self + i - b;
    const REAL x = parts->x[k], y = parts->y[k], z = parts->z[k], h = parts->h[k], m = parts->m[k];
    REAL f[4] = {0}, g[4] = {0};
    parts->m[k] = 0; /* not on itself */
    NAME(from_nodes)(nodes, x, y, z, (REAL)s->eps2, what, f);
    if (what & PLUMMER)
      NAME(from_plummer)(parts, x, y, z, (REAL)s->eps2, what, g);
    else
      NAME(from_splines)(parts, x, y, z, h, (REAL)s->near, what, g);
    parts->m[k] = m;
    if (what & POTENTIAL) p->phi[i] = gp * ((double)f[3] + (double)g[3]);
    for (int d = 0; d < 3 && what & PULL; d++) p->a[3 * i + d] = ga * ((double)f[d] + (double)g[d]);
  }
}

static void NAME(evaluate)(const Scale *s, const Bodies *p, long b, long e,
                           const NAME(List) * nodes, NAME(List) * parts, long self)
{
#define SUMS(WHAT)                                                                                 \
  case WHAT: NAME(sums)(s, p, b, e, nodes, parts, self, WHAT); break
  switch ((p->a ? PULL : 0) | (p->phi ? POTENTIAL : 0) | (s->eps2 > 0 ? PLUMMER : 0)) {
    SUMS(PULL);
    SUMS(POTENTIAL);
    SUMS(PULL | POTENTIAL);
    SUMS(PULL | PLUMMER);
    SUMS(POTENTIAL | PLUMMER);
    SUMS(PULL | POTENTIAL | PLUMMER);
  }
#undef SUMS
}

/* One group: lists (in single precision relative to its centre), then the sums. */
static int NAME(group)(const Scale *tree, const Bodies *p, const Tree *t, const TreeGroup *g,
                       const Walk *w, NAME(List) * nodes, NAME(List) * parts)
{
  Scale s = *tree;
  long self = -1;
  for (int d = 0; d < 3 && sizeof(REAL) < sizeof(double); d++)
    s.origin[d] = 0.5 * (g->lo[d] + g->hi[d]);
  if (NAME(reserve)(nodes, w->nodes) || NAME(reserve)(parts, w->particles)) return -1;
  NAME(pack_nodes)(nodes, &s, t->node, p->trace, w->node, w->nodes);
  parts->n = 0;
  for (const Range *r = w->range; r < w->range + w->ranges; r++) {
    if (r->first <= g->first && g->first < r->end) self = parts->n + g->first - r->first;
    NAME(pack_particles)(parts, &s, p, r->first, r->end);
  }
  NAME(pad)(parts);
  NAME(evaluate)(&s, p, g->first, g->first + (long)g->count, nodes, parts, self);
  return 0;
}
