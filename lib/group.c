/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Two passes over the members: centre and composition, then moments about the centre. Principal
 * axes by GSL. */
#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <gsl/gsl_eigen.h>
#include <hdf5.h>
#include "group.h"
#include "pointmass.h"
#include "potential.h"
#include "sort.h"
#include "unit.h"

#define PI 3.14159265358979323846
/* clang-format off */
/* X(name, unit, value) of a Group *g in a system Group *s */
#define COLUMNS(X) \
  X("x", "m", g->x[0] - s->x[0]) X("y", "m", g->x[1] - s->x[1]) X("z", "m", g->x[2] - s->x[2]) \
  X("vx", "m/s", g->v[0] - s->v[0]) X("vy", "m/s", g->v[1] - s->v[1]) X("vz", "m/s", g->v[2] - s->v[2]) \
  X("Px", "kg m/s", g->mass * (g->v[0] - s->v[0])) X("Py", "kg m/s", g->mass * (g->v[1] - s->v[1])) \
  X("Pz", "kg m/s", g->mass * (g->v[2] - s->v[2])) \
  X("radius", "m", g->radius) X("r50", "m", g->r50) X("r90", "m", g->r90) X("r99", "m", g->r99) \
  X("density", "kg/m^3", g->rho) X("density_mean", "kg/m^3", g->rho_mean) X("density_max", "kg/m^3", g->rho_max) \
  X("b/a", "1", axes(g, 1)) X("c/a", "1", axes(g, 2)) \
  X("omega_x", "rad/s", g->omega[0]) X("omega_y", "rad/s", g->omega[1]) X("omega_z", "rad/s", g->omega[2]) \
  X("period", "s", g->period) X("Lx", "kg m^2/s", g->l[0]) X("Ly", "kg m^2/s", g->l[1]) X("Lz", "kg m^2/s", g->l[2]) \
  X("Ixx", "kg m^2", g->inertia[0]) X("Ixy", "kg m^2", g->inertia[1]) X("Ixz", "kg m^2", g->inertia[2]) \
  X("Iyy", "kg m^2", g->inertia[3]) X("Iyz", "kg m^2", g->inertia[4]) X("Izz", "kg m^2", g->inertia[5]) \
  X("I1", "kg m^2", g->moment[0]) X("I2", "kg m^2", g->moment[1]) X("I3", "kg m^2", g->moment[2]) \
  X("axis1_x", "1", g->axis[0][0]) X("axis1_y", "1", g->axis[0][1]) X("axis1_z", "1", g->axis[0][2]) \
  X("axis3_x", "1", g->axis[2][0]) X("axis3_y", "1", g->axis[2][1]) X("axis3_z", "1", g->axis[2][2]) \
  X("E_bulk", "J", 0.5 * g->mass * pow(group_apart(g->v, s->v), 2)) \
  X("E_kin", "J", g->e_kin) X("E_rot", "J", g->e_rot) X("E_th", "J", g->e_th) X("E_pot", "J", g->e_pot) \
  X("T/W", "1", -g->e_rot / g->e_pot) X("k_vir", "1", -2 * g->e_kin / g->e_pot) \
  X("peak_p_mean", "Pa", g->peak_mean) X("peak_p_max", "Pa", g->peak_max) \
  X("T_mean", "K", g->T_mean) X("T_max", "K", g->T_max) \
  X("damage", "1", g->damage) X("damaged", "%", 100 * g->damaged) X("water", "%", 100 * g->water)
/* clang-format on */

typedef struct {
  int64_t first; /* lowest particle id */
  double mass;   /* kg */
  long n, old;
  int kept; /* however small: holds a point mass */
} Rank;

static int by_mass(const void *a, const void *b)
{
  const Rank *p = a, *q = b;
  if (p->mass != q->mass) return p->mass > q->mass ? -1 : 1;
  return p->first < q->first ? -1 : p->first > q->first;
}

int group_named(const Parts *p, const char *text, const char *file, const int32_t **id,
                int32_t *which, Err *err)
{
  static const char *const words[] = {"body:", "fragment:", "clump:"};
  static const char *const members[] = {"body", "frag", "clump"};
  const int32_t *const ids[] = {p->body, p->frag, p->clump};
  char *end;
  int k = 0;
  while (k < 3 && strncmp(text, words[k], strlen(words[k]))) k++;
  if (k == 3) return err_set(err, "'%s' is none of body:N, fragment:N, clump:N", text);
  long number = strtol(text + strlen(words[k]), &end, 10);
  if (end == text + strlen(words[k]) || *end || number < 0 || number > INT32_MAX)
    return err_set(err, "'%s' has no number", text);
  if (part_need(p, members[k], file, err)) return -1;
  *id = ids[k], *which = (int32_t)number;
  for (long i = 0; i < p->n; i++)
    if (ids[k][i] == *which) return 0;
  return err_set(err, "'%s': nothing belongs to %s", file, text);
}

int group_order(const Parts *p, long *order, Err *err)
{
  return sort_ids(p->n, p->id, order) ? err_set(err, "out of memory for %ld particles", p->n) : 0;
}

long group_rank(const Parts *p, int32_t *id, long groups, long least, Err *err)
{
  long found = 0, *order = malloc((size_t)(p->n + 1) * sizeof *order);
  Rank *rank = calloc((size_t)groups + 1, sizeof *rank);
  int32_t *name = calloc((size_t)groups + 1, sizeof *name);
  if (!order || !rank || !name || group_order(p, order, err)) {
    free(order), free(rank), free(name);
    return err_set(err, "out of memory for %ld particles", p->n);
  }
  for (long o = 0; o < p->n; o++) {
    long i = order[o], k = id[i];
    if (k == 0) continue;
    if (rank[k].n++ == 0) rank[k].first = p->id[i], rank[k].old = k;
    rank[k].mass += p->m[i], rank[k].kept |= pointmass_row(p, i);
  }
  qsort(rank, (size_t)groups + 1, sizeof *rank, by_mass);
  for (long k = 0; k <= groups; k++)
    if ((rank[k].n >= least || rank[k].kept) && rank[k].n > 0) name[rank[k].old] = (int32_t)++found;
  for (long i = 0; i < p->n; i++) id[i] = name[id[i]];
  free(order), free(rank), free(name);
  return found;
}

long group_heavy(const Parts *p, int32_t *id, long groups, double mass, Err *err)
{
  double *sum = calloc((size_t)groups + 1, sizeof *sum);
  long left = groups, *order = malloc((size_t)(p->n + 1) * sizeof *order);
  if (!sum || !order || group_order(p, order, err)) {
    free(sum), free(order);
    return err_set(err, "out of memory for %ld particles", p->n);
  }
  for (long o = 0; o < p->n; o++) sum[id[order[o]]] += p->m[order[o]];
  while (left > 0 && sum[left] < mass) left--;
  for (long i = 0; i < p->n; i++)
    if (id[i] > left) id[i] = 0;
  free(sum), free(order);
  return left;
}

int group_lists(const Parts *p, const int32_t *id, long groups, long **start, long **list, Err *err)
{
  long *order = malloc((size_t)(p->n + 1) * sizeof *order);
  *start = calloc((size_t)groups + 2, sizeof **start),
  *list = malloc((size_t)(p->n + 1) * sizeof **list);
  if (!order || !*start || !*list || group_order(p, order, err)) {
    free(order), free(*start), free(*list);
    return err_set(err, "out of memory for %ld particles", p->n);
  }
  for (long i = 0; i < p->n; i++)
    if (id[i] > 0) (*start)[id[i] + 1]++;
  for (long k = 1; k <= groups; k++) (*start)[k + 1] += (*start)[k];
  for (long o = 0; o < p->n; o++) /* start[k] runs on to the end of its list ... */
    if (id[order[o]] > 0) (*list)[(*start)[id[order[o]]]++] = order[o];
  for (long k = groups + 1; k > 0; k--)
    (*start)[k] = (*start)[k - 1]; /* ... which is the start of the next */
  (*start)[0] = 0;
  free(order);
  return 0;
}

int group_bodies(const Parts *p, Err *err)
{
  int bodies = 1;
  for (long i = 0; i < p->n; i++) {
    if (p->body[i] < 0 || p->body[i] >= GROUP_BODIES)
      return err_set(err, "particle %lld: BodyID %d is not in 0..%d", (long long)p->id[i],
                     (int)p->body[i], GROUP_BODIES - 1);
    if (p->body[i] >= bodies) bodies = p->body[i] + 1;
  }
  return bodies;
}

int group_is_water(const char *material)
{
  static const char *const words[] = {"ice", "water", "h2o"};
  for (const char *s = material; *s; s += strspn(s, "_-. ")) {
    size_t length = strcspn(s, "_-. ");
    for (int k = 0; k < 3; k++)
      if (length == strlen(words[k]) && !strncasecmp(s, words[k], length)) return 1;
    s += length;
  }
  return 0;
}

static void centre(Group *g, const Parts *p, const long *list)
{
  for (long k = 0; k < g->n; k++) {
    long i = list[k];
    for (int a = 0; a < 3; a++)
      g->x[a] += p->m[i] * p->x[3 * i + a], g->v[a] += p->m[i] * p->v[3 * i + a];
    g->mass += p->m[i];
    if (pointmass_row(p, i)) g->points++, g->pointed += p->m[i];
  }
  for (int a = 0; a < 3; a++) g->x[a] /= g->mass, g->v[a] /= g->mass;
}

/* The phases as eos fill writes them, a field outside the schema; NULL: there are none. */
static const double *phases(const Parts *p)
{
  for (int k = 0; k < p->extras; k++) {
    const PartExtra *e = &p->extra[k];
    if (!strcmp(e->name, "PhaseID") && e->width == 1 && e->size == sizeof(double) &&
        H5Tget_class((hid_t)e->type) == H5T_FLOAT)
      return (const double *)(const void *)e->data;
  }
  return NULL;
}

/* Temperatures and masses by phase. */
static void heat(Group *g, const Parts *p, const long *list)
{
  const double *phase = phases(p);
  double sum = 0, most = 0, mass = g->mass - g->pointed;
  for (long k = 0; k < g->n; k++) {
    const long i = list[k];
    if (pointmass_row(p, i)) continue;
    if (p->T) sum += p->m[i] * p->T[i], most = fmax(most, p->T[i]);
    if (phase && phase[i] >= 0 && phase[i] < GROUP_PHASES) g->phase[(int)phase[i]] += p->m[i];
  }
  g->T_mean = p->T ? sum / mass : NAN, g->T_max = p->T ? most : NAN;
}

static void contents(Group *g, const Parts *p, const long *list)
{
  int bodies = g->bodies;
  double damage = 0, damaged = 0, peak = 0, mass = g->mass - g->pointed;
  for (long k = 0; k < g->n; k++) {
    long i = list[k];
    g->volume += p->m[i] / p->rho[i], g->e_th += p->m[i] * p->u[i];
    if (pointmass_row(p, i)) continue;
    g->rho_mean += p->m[i] * p->rho[i], g->rho_max = fmax(g->rho_max, p->rho[i]);
    if (p->pmax) peak += p->m[i] * p->pmax[i], g->peak_max = fmax(g->peak_max, p->pmax[i]);
    g->part[p->mat[i] * bodies + p->body[i]] += p->m[i];
    if (p->damage) damage += p->m[i] * p->damage[i], damaged += p->damage[i] >= 1 ? p->m[i] : 0;
  }
  for (int c = 0; c < p->materials; c++)
    for (int b = 0; b < bodies && group_is_water(p->material[c].name); b++)
      g->water += g->part[c * bodies + b];
  g->water /= g->mass, g->rho = g->mass / g->volume, g->rho_mean /= mass;
  g->peak_mean = p->pmax ? peak / mass : NAN, g->peak_max = p->pmax ? g->peak_max : NAN;
  g->radius = cbrt(3 * g->volume / (4 * PI));
  g->damage = p->damage ? damage / mass : NAN, g->damaged = p->damage ? damaged / mass : NAN;
}

static void moments(Group *g, const Parts *p, const long *list)
{
  double *i6 = g->inertia;
  for (long k = 0; k < g->n; k++) {
    const double *xi = p->x + 3 * list[k], *vi = p->v + 3 * list[k], m = p->m[list[k]];
    double x = xi[0] - g->x[0], y = xi[1] - g->x[1], z = xi[2] - g->x[2];
    double vx = vi[0] - g->v[0], vy = vi[1] - g->v[1], vz = vi[2] - g->v[2];
    g->l[0] += m * (y * vz - z * vy), g->l[1] += m * (z * vx - x * vz),
        g->l[2] += m * (x * vy - y * vx);
    i6[0] += m * (y * y + z * z), i6[3] += m * (x * x + z * z), i6[5] += m * (x * x + y * y);
    i6[1] -= m * x * y, i6[2] -= m * x * z, i6[4] -= m * y * z;
    g->e_kin += 0.5 * m * (vx * vx + vy * vy + vz * vz);
  }
}

/* omega = I^-1 L in the principal frame; a direction without inertia (a single particle, a rod)
 * does not spin. */
static int spin(Group *g, Err *err)
{
  const double *i = g->inertia;
  double full[9] = {i[0], i[1], i[2], i[1], i[3], i[4], i[2], i[4], i[5]}, omega2 = 0;
  gsl_matrix_view m = gsl_matrix_view_array(full, 3, 3);
  gsl_vector_view value = gsl_vector_view_array(g->moment, 3);
  gsl_matrix *axis = gsl_matrix_alloc(3, 3);
  gsl_eigen_symmv_workspace *w = gsl_eigen_symmv_alloc(3);
  int failed = !axis || !w || gsl_eigen_symmv(&m.matrix, &value.vector, axis, w) ||
               gsl_eigen_symmv_sort(&value.vector, axis, GSL_EIGEN_SORT_VAL_ASC);
  for (int k = 0; k < 3 && !failed; k++) {
    for (int a = 0; a < 3; a++) g->axis[k][a] = gsl_matrix_get(axis, (size_t)a, (size_t)k);
    double *e = g->axis[k], along = e[0] * g->l[0] + e[1] * g->l[1] + e[2] * g->l[2];
    if (g->moment[k] <= 1e-12 * g->moment[2] || g->moment[2] <= 0) continue;
    for (int a = 0; a < 3; a++) g->omega[a] += along / g->moment[k] * e[a];
    g->e_rot += 0.5 * along * along / g->moment[k];
  }
  for (int a = 0; a < 3; a++) omega2 += g->omega[a] * g->omega[a];
  g->period = omega2 > 0 ? 2 * PI / sqrt(omega2) : INFINITY;
  if (axis) gsl_matrix_free(axis);
  if (w) gsl_eigen_symmv_free(w);
  return failed ? err_set(err, "principal axes not found") : 0;
}

/* Radii that hold 50, 90, 99 % of the mass. */
static int radii(Group *g, const Parts *p, const long *list, Err *err)
{
  double *r = malloc((size_t)g->n * sizeof *r), sum = 0;
  long *order = malloc((size_t)g->n * sizeof *order);
  for (long k = 0; k < g->n && r; k++) r[k] = group_apart(p->x + 3 * list[k], g->x);
  int failed = !r || !order || sort_reals(g->n, r, order);
  for (long k = 0; k < g->n && !failed; k++) {
    double before = sum / g->mass, now = (sum += p->m[list[order[k]]]) / g->mass,
           last = k == g->n - 1;
    if (before < 0.50 && (now >= 0.50 || last)) g->r50 = r[order[k]];
    if (before < 0.90 && (now >= 0.90 || last)) g->r90 = r[order[k]];
    if (before < 0.99 && (now >= 0.99 || last)) g->r99 = r[order[k]];
  }
  free(r), free(order);
  return failed ? err_set(err, "out of memory for %ld particles", g->n) : 0;
}

static int own_gravity(Group *g, const Parts *p, const long *list, double theta, const double *phi,
                       Err *err)
{
  double *own = phi ? NULL : malloc((size_t)g->n * sizeof *own);
  if (!phi && !own) return err_set(err, "out of memory for %ld particles", g->n);
  int failed = own ? potential_own(p, list, g->n, theta, own, err) : 0;
  g->e_pot = 0;
  for (long k = 0; k < g->n && !failed; k++)
    g->e_pot += 0.5 * p->m[list[k]] * (phi ? phi[list[k]] : own[k]);
  free(own);
  return failed;
}

int group_measure(Group *g, const Parts *p, const long *list, long n, int bodies, double theta,
                  const double *phi, Err *err)
{
  memset(g, 0, sizeof *g);
  g->n = n, g->bodies = bodies, g->e_pot = NAN;
  g->part = calloc((size_t)(bodies * p->materials + 1), sizeof *g->part);
  if (!g->part) return err_set(err, "out of memory");
  if (n == 0) return 0;
  centre(g, p, list), contents(g, p, list), heat(g, p, list), moments(g, p, list);
  if (!spin(g, err) && !radii(g, p, list, err) &&
      ((theta < 0 && !phi) || !own_gravity(g, p, list, theta, phi, err)))
    return 0;
  group_free(g);
  return -1;
}

/* Large groups one by one, each with all threads; then small ones, each with one. */
Group *group_all(const Parts *p, const int32_t *id, long groups, int bodies, double theta,
                 const double *phi, Err *err)
{
  enum { LARGE = 20000 };
  long *start, *list;
  int failed = 0;
  Group *g = calloc((size_t)groups + 1, sizeof *g);
  if (!g) return err_null(err, "out of memory for %ld groups", groups);
  if (group_lists(p, id, groups, &start, &list, err)) return free(g), NULL;
  for (int small = 0; small < 2; small++) {
#pragma omp parallel for schedule(dynamic, 8) reduction(| : failed) if (small)
    for (long k = 0; k < groups; k++) {
      const long first = start[k + 1], n = start[k + 2] - first;
      Err why;
      if ((n < LARGE) != small || failed) continue;
      if (!group_measure(&g[k], p, list + first, n, bodies, theta, phi, &why)) continue;
      failed = 1;
#pragma omp critical
      if (err) *err = why;
    }
  }
  free(start), free(list);
  if (!failed) return g;
  group_all_free(g, groups);
  return NULL;
}

void group_all_free(Group *g, long groups)
{
  for (long k = 0; k < groups; k++) group_free(&g[k]);
  free(g);
}

int group_system(Group *g, const Parts *p, double theta, Err *err)
{
  int bodies = group_bodies(p, err);
  if (bodies < 0) return -1;
  long *order = malloc((size_t)(p->n + 1) * sizeof *order);
  if (!order) return err_set(err, "out of memory for %ld particles", p->n);
  int failed =
      group_order(p, order, err) || group_measure(g, p, order, p->n, bodies, theta, NULL, err);
  free(order);
  return failed ? -1 : 0;
}

double group_apart(const double a[3], const double b[3])
{
  double x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
  return sqrt(x * x + y * y + z * z);
}

void group_free(Group *g)
{
  free(g->part);
  g->part = NULL;
}

GroupPair group_pair(const double xa[3], const double va[3], double ma, const double xb[3],
                     const double vb[3], double mb)
{
  GroupPair o = {0};
  double r[3], v[3], mu = UNIT_G * (ma + mb);
  for (int a = 0; a < 3; a++) {
    r[a] = xb[a] - xa[a], v[a] = vb[a] - va[a];
    o.r += r[a] * r[a], o.v += v[a] * v[a], o.v_r += r[a] * v[a];
  }
  o.r = sqrt(o.r), o.v = sqrt(o.v), o.v_r /= o.r;
  o.v_esc = sqrt(2 * mu / o.r);
  o.orbit = orbit_of_state(mu, r, v);
  return o;
}

double group_roche(double mass, double rho) { return 2.4554 * cbrt(3 * mass / (4 * PI * rho)); }

GroupCentre group_centre(const Group *g)
{
  GroupCentre c = {.mass = g->mass};
  memcpy(c.x, g->x, sizeof c.x), memcpy(c.v, g->v, sizeof c.v), memcpy(c.axis, g->l, sizeof c.axis);
  return c;
}

GroupCentre group_rest(const Group *s, const Group *g)
{
  GroupCentre c = group_centre(s);
  c.mass = s->mass - g->mass;
  if (c.mass <= 1e-12 * s->mass) c.mass = 0;
  for (int a = 0; a < 3 && c.mass > 0; a++) {
    c.x[a] -= g->mass / c.mass * (g->x[a] - s->x[a]);
    c.v[a] -= g->mass / c.mass * (g->v[a] - s->v[a]);
  }
  return c;
}

static void cell(FILE *f, double value)
{
  if (isnan(value))
    fputs("\tnan", f); /* not -nan */
  else
    fprintf(f, "\t%.9g", value);
}

void group_orbit_header(FILE *f, const char *about)
{
  static const char *const name[] = {"e", "a", "peri", "apo", "incl", "v_inf", "roche"},
                           *const unit[] = {"1", "m", "m", "m", "deg", "m/s", "m"};
  for (int k = 0; k < 7; k++) fprintf(f, "\t%s_%s [%s]", name[k], about, unit[k]);
}

void group_orbit_row(FILE *f, const Group *g, const GroupCentre *c)
{
  if (c->mass <= 0 || group_apart(g->x, c->x) <= 0) {
    for (int k = 0; k < 7; k++) fputs("\tnan", f);
    return;
  }
  const Orbit o = group_pair(c->x, c->v, c->mass, g->x, g->v, g->mass).orbit;
  double r[3], v[3], up = 0, l2 = 0, axis2 = 0;
  for (int a = 0; a < 3; a++) r[a] = g->x[a] - c->x[a], v[a] = g->v[a] - c->v[a];
  for (int a = 0; a < 3; a++) {
    const int b = (a + 1) % 3, d = (a + 2) % 3;
    const double l = r[b] * v[d] - r[d] * v[b];
    up += l * c->axis[a], l2 += l * l, axis2 += c->axis[a] * c->axis[a];
  }
  double lean = up / sqrt(l2 * axis2); /* nan without an axis */
  if (fabs(lean) > 1) lean = lean > 0 ? 1 : -1;
  cell(f, o.e), cell(f, o.mu / o.beta), cell(f, o.rp), cell(f, o.ra);
  cell(f, 180 / PI * acos(lean)), cell(f, o.vinf), cell(f, group_roche(c->mass, g->rho));
}

/* b/a and c/a of the ellipsoid with these principal moments: a_k^2 ~ I_1 + I_2 + I_3 - 2 I_k. */
static double axes(const Group *g, int which)
{
  double sum = g->moment[0] + g->moment[1] + g->moment[2], a2 = sum - 2 * g->moment[0];
  return a2 > 0 ? sqrt(fmax(0, (sum - 2 * g->moment[which]) / a2)) : 1;
}

void group_header(FILE *f, const Parts *p, int bodies)
{
#define HEAD(NAME, UNIT, ...) fputs("\t" NAME " [" UNIT "]", f);
  COLUMNS(HEAD)
#undef HEAD
  for (int k = 0; k < GROUP_PHASES && phases(p); k++) fprintf(f, "\tphase_%d [kg]", k);
  for (int c = 0; c < p->materials; c++) fprintf(f, "\t%s [%%]", p->material[c].name);
  for (int b = 0; b < bodies; b++) fprintf(f, "\tfrom_%d [kg]", b);
  for (int c = 0; c < p->materials; c++)
    for (int b = 0; b < bodies; b++) fprintf(f, "\t%s_from_%d [kg]", p->material[c].name, b);
  if (p->point_rows) fputs("\tpoint_masses [kg]", f);
}

void group_row(FILE *f, const Group *g, const Group *s, const Parts *p)
{
  int bodies = g->bodies;
#define CELL(NAME, UNIT, ...) cell(f, __VA_ARGS__);
  COLUMNS(CELL)
#undef CELL
  for (int k = 0; k < GROUP_PHASES && phases(p); k++) fprintf(f, "\t%.9g", g->phase[k]);
  for (int c = 0; c < p->materials; c++) {
    double sum = 0;
    for (int b = 0; b < bodies; b++) sum += g->part[c * bodies + b];
    cell(f, 100 * sum / g->mass);
  }
  for (int b = 0; b < bodies; b++) {
    double sum = 0;
    for (int c = 0; c < p->materials; c++) sum += g->part[c * bodies + b];
    fprintf(f, "\t%.9g", sum);
  }
  for (int k = 0; k < p->materials * bodies; k++) fprintf(f, "\t%.9g", g->part[k]);
  if (p->point_rows) cell(f, g->pointed);
}
