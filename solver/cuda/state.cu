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

/* Arrays of the state that no pass of this run reads or writes. */
static int idle(const Sim *sim, const char *name)
{
  if (strcmp(name, "frag") == 0 || strcmp(name, "clump") == 0) return 1; /* what only tools know */
  if (strcmp(name, "delta") == 0) return sim->par.density == PARAM_CONTINUITY;
  return strcmp(name, "ds") == 0 && sim->slots == 0;
}

/* The thresholds that this run looks at. */
static size_t flaws_of(const Sim *sim, const Parts *p)
{
  return sim->solid && sim->par.damage ? (size_t)p->flaws : 0;
}

/* All columns, there or not; those that move with their particles first. */
static int columns_of(Sim *sim, CudaColumn *c, int *all)
{
  State *s = &sim->s;
  int n = 0, moved;
#define STATE_COLUMN(TYPE, MEMBER, WIDTH, ...)                                                     \
  c[n++] = {(void **)&s->MEMBER, WIDTH, (int)sizeof(TYPE), #MEMBER};
#define STATE_SLOT(MEMBER, WIDTH)                                                                  \
  c[n++] = {(void **)&s->saved[slot].MEMBER, WIDTH, (int)sizeof(double), #MEMBER};
  ALL_FIELDS(STATE_COLUMN)
  MOVED_FIELDS(STATE_COLUMN)
  for (int slot = 0; slot < sim->slots; slot++) { SAVED_FIELDS(STATE_SLOT) }
  moved = n;
  WORK_FIELDS(STATE_COLUMN)
#undef STATE_COLUMN
#undef STATE_SLOT
  *all = n;
  return moved;
}

int cuda_columns(Sim *sim, CudaColumn column[CUDA_COLUMNS], int *all)
{
  int kept = 0, moved = 0, first, n;
  first = columns_of(sim, column, &n);
  for (int k = 0; k < n; k++) {
    if (!*column[k].array) continue;
    column[kept++] = column[k];
    moved += k < first;
  }
  *all = kept;
  return moved;
}

size_t cuda_state_bytes(Sim *sim, const Parts *p)
{
  CudaColumn column[CUDA_COLUMNS];
  size_t n = (size_t)p->n, sum = 0;
  int all;
  columns_of(sim, column, &all);
  for (int k = 0; k < all; k++)
    if (!idle(sim, column[k].name)) sum += rounded(n * (size_t)(column[k].width * column[k].size));
  return sum + n * 2 * sizeof(float4) + flaws_of(sim, p) * sizeof(double);
}

static int alloc(Sim *sim, const Parts *p, Err *err)
{
  Cuda *c = cuda_of(sim);
  CudaColumn column[CUDA_COLUMNS];
  size_t n = (size_t)p->n;
  int all, bad = 0;
  columns_of(sim, column, &all);
  for (int k = 0; k < all && !bad; k++)
    if (!idle(sim, column[k].name))
      bad = cuda_alloc(sim, column[k].array, n * (size_t)(column[k].width * column[k].size), err);
  return bad || cuda_alloc(sim, (void **)&c->x.hi, n * sizeof(float4), err) ||
         cuda_alloc(sim, (void **)&c->x.lo, n * sizeof(float4), err) ||
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
          cuda_copy(sim, s->flaw0, start, (size_t)p->n * sizeof *start, err);
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
  if (p->nflaw && cuda_copy(sim, s->nflaw, p->nflaw, n * sizeof *p->nflaw, err)) return -1;
  if (cuda_copy(sim, c->flaw, p->flaw, flaws_of(sim, p) * sizeof *p->flaw, err)) return -1;
  s->flaw = c->flaw, s->material = c->material;
  return cuda_copy(sim, c->material, sim->material, (size_t)sim->materials * sizeof(Material), err);
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
  c->run.sigma = kernel_sigma(sim->par.kernel, p->dimension);
  c->run.alpha = sim->par.alpha, c->run.beta = sim->par.beta, c->run.dimension = p->dimension;
  return alloc(sim, p, err) || fill(sim, p, err) ? -1 : 0;
}

void cuda_state_close(Sim *sim)
{
  Cuda *c = cuda_of(sim);
  CudaColumn column[CUDA_COLUMNS];
  int all;
  columns_of(sim, column, &all);
  for (int k = 0; k < all; k++) cuda_free(*column[k].array);
  cuda_free(c->x.hi), cuda_free(c->x.lo);
  cuda_free(c->flaw), cuda_free(c->material);
}
