/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The state's memory on the card: made from the field lists, filled from the particles of a file,
 * scaled to code units. */
#include "cuda.h"

static size_t rounded(size_t bytes) { return (bytes + 255) / 256 * 256; }

int cuda_alloc(Sim *sim, void **at, size_t bytes, Err *err)
{
  Cuda *c = cuda_of(sim);
  size_t available = 0, total = 0;
  cudaError_t code = cudaMalloc(at, rounded(bytes ? bytes : 1));
  if (code == cudaSuccess) code = cudaMemsetAsync(*at, 0, bytes, c->stream);
  if (code == cudaSuccess) {
    c->bytes += rounded(bytes ? bytes : 1);
    return 0;
  }
  cudaGetLastError();
  if (code != cudaErrorMemoryAllocation) return err_set(err, "cuda: %s", cudaGetErrorString(code));
  *at = NULL;
  cudaMemGetInfo(&available, &total);
  return err_set(err,
                 "not enough memory on card %d: %.4g GB more are needed, %.4g of %.4g are free",
                 sim->card, 1e-9 * (double)bytes, 1e-9 * (double)available, 1e-9 * (double)total);
}

void cuda_free(void *at)
{
  if (at) cudaFree(at);
}

void cuda_give(Sim *sim, void **at, size_t bytes)
{
  if (*at) cuda_of(sim)->bytes -= rounded(bytes ? bytes : 1);
  cuda_free(*at);
  *at = NULL;
}

/* Whether name is one of the words. */
static int among(const char *words, const char *name)
{
  const size_t length = strlen(name);
  for (const char *at = words; (at = strstr(at, name)) != NULL; at += length)
    if ((at == words || at[-1] == ' ') && (at[length] == ' ' || !at[length])) return 1;
  return 0;
}

enum { IDLE, WORK, MOVED };

/* What an array is for in this run: nothing (no pass reads or writes it), for an evaluation only,
 * or what moves with its particle. Leapfrog makes many anew between a search and the next look at
 * them; other integrators keep all. */
static int role_of(const Sim *sim, const char *name, int role)
{
  const Param *p = &sim->par;
  const int pulls = p->gravity != PARAM_NONE, fresh = p->gravity_every == 1,
            line = sim->s.dimension == 1;
  if (backend_idle(sim, name)) return IDLE;
  if (among("frag clump", name)) return IDLE; /* what only tools know */
  if (!param_summed(p) && among("delta", name)) return IDLE;
  if (!pulls && fresh && among("pull", name)) return IDLE;
  if (sim->slots > 0) return role;
  if (among("ds", name)) return IDLE;
  if (!sim->solid && !line && among("s strain", name)) return IDLE;
  if (!sim->tensor && !line && among("g cm t", name)) return IDLE;
  if (!(sim->solid && p->damage) && among("nact dcrack nflaw flaw0", name)) return IDLE;
  if (among("cs a divv delta signal dcrack nngb", name)) return WORK;
  return pulls && fresh && among("phi pull", name) ? WORK : role;
}

/* The thresholds that this run looks at. */
static size_t flaws_of(const Sim *sim, const Parts *p)
{
  return sim->solid && sim->par.damage ? (size_t)p->flaws : 0;
}

int cuda_columns(Sim *sim, CudaColumn column[CUDA_COLUMNS], int *all)
{
  State *s = &sim->s;
  int n = 0, moved = 0;
  for (int role = MOVED; role >= WORK; role--) {
#define STATE_COLUMN(TYPE, MEMBER, WIDTH, OWN)                                                     \
  if (role_of(sim, #MEMBER, OWN) == role)                                                          \
    column[n++] = {(void **)&s->MEMBER, WIDTH, (int)sizeof(TYPE)};
#define STATE_MOVED(TYPE, MEMBER, WIDTH, ...) STATE_COLUMN(TYPE, MEMBER, WIDTH, MOVED)
#define STATE_WORK(TYPE, MEMBER, WIDTH, ...)  STATE_COLUMN(TYPE, MEMBER, WIDTH, WORK)
#define STATE_SLOT(MEMBER, WIDTH)                                                                  \
  if (role == MOVED && !backend_idle(sim, #MEMBER))                                                \
    column[n++] = {(void **)&s->saved[slot].MEMBER, WIDTH, (int)sizeof(double)};
    ALL_FIELDS(STATE_MOVED)
    MOVED_FIELDS(STATE_MOVED)
    WORK_FIELDS(STATE_WORK)
    for (int slot = 0; slot < sim->slots; slot++) { SAVED_FIELDS(STATE_SLOT) }
#undef STATE_COLUMN
#undef STATE_MOVED
#undef STATE_WORK
#undef STATE_SLOT
    if (role == MOVED) moved = n;
  }
  *all = n;
  return moved;
}

/* Only gravity reads points. */
static size_t points_of(const Sim *sim)
{
  return sim->par.gravity == PARAM_NONE ? 0 : (size_t)sim->s.n;
}

/* What the table of material k takes: only what eos_table reads goes to the card. */
static size_t table_bytes(const Sim *sim, int k)
{
  const Eos *e = &sim->material[k].eos;
  return e->form == EOS_TABLE ? eos_table_words(&e->table) * sizeof(double) : 0;
}

size_t cuda_state_bytes(Sim *sim, const Parts *p)
{
  CudaColumn column[CUDA_COLUMNS];
  size_t n = (size_t)sim->s.room, sum = 0;
  int all;
  cuda_columns(sim, column, &all);
  for (int k = 0; k < sim->materials; k++) sum += rounded(table_bytes(sim, k));
  for (int k = 0; k < all; k++) sum += rounded(n * (size_t)(column[k].width * column[k].size));
  return sum + points_of(sim) * 2 * sizeof(float4) + flaws_of(sim, p) * sizeof(double);
}

/* Materials, with their tables. */
static int fill_materials(Sim *sim, Err *err)
{
  Cuda *c = cuda_of(sim);
  size_t bytes = (size_t)sim->materials * sizeof(Material);
  Material *copy = (Material *)malloc(bytes ? bytes : 1);
  int bad;
  c->table = (double **)calloc((size_t)sim->materials + 1, sizeof *c->table);
  bad = copy && c->table ? 0 : err_set(err, "no memory for %d materials", sim->materials);
  for (int k = 0; k < sim->materials && !bad; k++) {
    copy[k] = sim->material[k];
    if (!table_bytes(sim, k)) continue;
    bad = cuda_alloc(sim, (void **)&c->table[k], table_bytes(sim, k), err) ||
          cuda_copy(sim, c->table[k], copy[k].eos.table.data, table_bytes(sim, k), err);
    copy[k].eos.table.data = c->table[k];
  }
  if (!bad) bad = cuda_copy(sim, c->material, copy, bytes, err);
  free(copy);
  return bad;
}

static int alloc(Sim *sim, const Parts *p, Err *err)
{
  Cuda *c = cuda_of(sim);
  CudaColumn column[CUDA_COLUMNS];
  size_t n = (size_t)sim->s.room;
  int all, bad = 0;
  cuda_columns(sim, column, &all);
  for (int k = 0; k < all && !bad; k++)
    bad = cuda_alloc(sim, column[k].array, n * (size_t)(column[k].width * column[k].size), err);
  n = points_of(sim);
  return bad ||
         (n && (cuda_alloc(sim, (void **)&c->x.hi, n * sizeof(float4), err) ||
                cuda_alloc(sim, (void **)&c->x.lo, n * sizeof(float4), err))) ||
         cuda_alloc(sim, (void **)&c->flaw, flaws_of(sim, p) * sizeof(double), err) ||
         cuda_alloc(sim, (void **)&c->material, (size_t)sim->materials * sizeof(Material), err);
}

/* Where each particle's thresholds begin, and its row. */
static int fill_rows(Sim *sim, const Parts *p, Err *err)
{
  State *s = &sim->s;
  int64_t *row = (int64_t *)malloc(((size_t)p->n + 1) * sizeof *row), *start = part_flaw_start(p);
  int bad = !row || !start;
  for (long i = 0; i < p->n && !bad; i++) row[i] = i;
  if (bad)
    err_set(err, "not enough memory for %ld particles", p->n);
  else
    bad = cuda_copy(sim, s->row, row, (size_t)p->n * sizeof *row, err) ||
          (s->flaw0 && cuda_copy(sim, s->flaw0, start, (size_t)p->n * sizeof *start, err));
  free(row), free(start);
  return bad;
}

static int fill(Sim *sim, const Parts *p, Err *err)
{
  Cuda *c = cuda_of(sim);
  State *s = &sim->s;
  size_t n = (size_t)p->n;
#define STATE_FILL(TYPE, MEMBER, WIDTH, ...)                                                       \
  if (p->MEMBER && s->MEMBER &&                                                                    \
      cuda_copy(sim, s->MEMBER, p->MEMBER, n * (WIDTH) * sizeof(TYPE), err))                       \
    return -1;
  ALL_FIELDS(STATE_FILL)
#undef STATE_FILL
  if (fill_rows(sim, p, err)) return -1;
  if (p->nflaw && s->nflaw && cuda_copy(sim, s->nflaw, p->nflaw, n * sizeof *p->nflaw, err))
    return -1;
  if (cuda_copy(sim, c->flaw, p->flaw, flaws_of(sim, p) * sizeof *p->flaw, err)) return -1;
  s->flaw = c->flaw, s->material = c->material;
  return fill_materials(sim, err);
}

/* The power of two below x; 1 when there is nothing to go by. */
static double power(double x)
{
  int e;
  if (!(x > 0) || !isfinite(x)) return 1;
  frexp(x, &e);
  return ldexp(1, e - 1);
}

/* From at most a million particles: an order of magnitude is enough. */
static Units units_of(const Sim *sim, const Parts *p)
{
  const long stride = p->n / 1000000 + 1;
  double h = 0, m = 0, speed = 0, n = 0;
  for (long i = 0; i < p->n; i += stride) {
    const double *x = &p->x[3 * i], *v = &p->v[3 * i];
    const Eos *eos = &sim->material[p->mat[i]].eos;
    EosPoint e = eos_eval(eos, p->rho[i], p->u[i], sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]));
    speed = fmax(speed, fmax(e.cs, sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2])));
    h += p->h[i], m += p->m[i], n++;
  }
  return {power(h / n), power(m / n), power(speed)};
}

int cuda_state_open(Sim *sim, const Parts *p, Err *err)
{
  Cuda *c = cuda_of(sim);
  c->unit = units_of(sim, p);
  c->run = backend_pair(sim, p->dimension);
  return alloc(sim, p, err) || fill(sim, p, err) ? -1 : 0;
}

void cuda_state_close(Sim *sim)
{
  Cuda *c = cuda_of(sim);
  CudaColumn column[CUDA_COLUMNS];
  int all;
  cuda_columns(sim, column, &all);
  for (int k = 0; k < all; k++) cuda_free(*column[k].array);
  cuda_free(c->x.hi), cuda_free(c->x.lo);
  cuda_free(c->flaw), cuda_free(c->material);
  for (int k = 0; c->table && k < sim->materials; k++) cuda_free(c->table[k]);
  free(c->table);
}
