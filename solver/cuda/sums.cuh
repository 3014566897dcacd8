/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Kernel sums, of what needs no velocity: part of loops.cuh. */

/* Kernel sums: rho, delta, and rhoa, the mean of rho before and after (cpu/loops.c). */
typedef struct {
  double delta, rho;
} Density;

static __device__ __forceinline__ Density add_two(Density a, Density b)
{
  a.delta += b.delta, a.rho += b.rho;
  return a;
}

static __device__ __forceinline__ void add_from(Density *a, int k)
{
  const Density b = {from_lane(a->delta, k), from_lane(a->rho, k)};
  *a = add_two(*a, b);
}

template <int kern, int line> struct Densities {
  typedef Density Sum;

  static __device__ __forceinline__ Density sum(const Loop &a, long i, int from, int step)
  {
    const int n = a.count[i];
    const uint32_t *list = list_of(a, i);
    real hi, hj, m;
    const Place xi = place_get(a.r.x, i, &hi, &m);
    Density sum = {0, 0};
    for (int k = from; k < n; k += step) {
      const PairVector r = place_between(xi, place_get(a.r.x, neighbour(list, k), &hj, &m));
      const real w =
          pair_weight(line ? a.kern : kern, line, &a.run, pair_dot(r, r), 0.5f * (hi + hj));
      sum.delta += w, sum.rho += m * w;
    }
    return sum;
  }

  static __device__ __forceinline__ void keep(const Loop &a, long i, Density sum)
  {
    const State &s = a.s;
    const double before = s.rho[i];
    real h, m;
    place_get(a.r.x, i, &h, &m);
    const real own = pair_weight(line ? a.kern : kern, line, &a.run, 0, h);
    sum.delta += own, sum.rho += m * own;
    s.delta[i] = sum.delta * a.rho / a.unit.mass;
    s.rho[i] = a.miscible ? s.m[i] * s.delta[i] : sum.rho * a.rho;
    s.rhoa[i] = sqrt(before * s.rho[i]);
  }
};

/* The sums of grad_keep, each with the particle's own h. */
typedef struct {
  double delta, mass, rate;
} Gradual;

static __device__ __forceinline__ Gradual add_two(Gradual a, Gradual b)
{
  a.delta += b.delta, a.mass += b.mass, a.rate += b.rate;
  return a;
}

static __device__ __forceinline__ void add_from(Gradual *a, int k)
{
  const Gradual b = {from_lane(a->delta, k), from_lane(a->mass, k), from_lane(a->rate, k)};
  *a = add_two(*a, b);
}

template <int kern, int line> struct Graduals {
  typedef Gradual Sum;

  static __device__ __forceinline__ Gradual sum(const Loop &a, long i, int from, int step)
  {
    const int n = a.count[i];
    const uint32_t *list = list_of(a, i);
    real h, hj, own, m;
    const Place xi = place_get(a.r.x, i, &h, &own);
    Gradual sum = {0, 0, 0};
    for (int k = from; k < n; k += step) {
      const PairVector r = place_between(xi, place_get(a.r.x, neighbour(list, k), &hj, &m));
      const real r2 = pair_dot(r, r), w = pair_weight(line ? a.kern : kern, line, &a.run, r2, h);
      sum.delta += w, sum.mass += m * w;
      sum.rate +=
          (a.grad.miscible ? own : m) * pair_weight_rate(line ? a.kern : kern, line, &a.run, r2, h);
    }
    return sum;
  }

  static __device__ __forceinline__ void keep(const Loop &a, long i, Gradual sum)
  {
    real h, m;
    place_get(a.r.x, i, &h, &m);
    const real own = pair_weight(line ? a.kern : kern, line, &a.run, 0, h);
    sum.delta += own, sum.mass += m * own;
    sum.rate += m * pair_weight_rate(line ? a.kern : kern, line, &a.run, 0, h);
    grad_keep(&a.s, &a.grad, i, sum.delta * a.rho / a.unit.mass, sum.mass * a.rho,
              sum.rate * a.rho / a.unit.length, a.newton);
  }
};

/* theta: sum V_j W_ij, the particle itself included. */
typedef struct {
  double all;
} Theta;

static __device__ __forceinline__ Theta add_two(Theta a, Theta b)
{
  a.all += b.all;
  return a;
}

static __device__ __forceinline__ void add_from(Theta *a, int k) { a->all += from_lane(a->all, k); }

template <int kern, int line> struct Thetas {
  typedef Theta Sum;

  static __device__ __forceinline__ Theta sum(const Loop &a, long i, int from, int step)
  {
    const int n = a.count[i];
    const uint32_t *list = list_of(a, i);
    real hi, hj, v;
    const Place xi = place_get(a.r.x, i, &hi, &v);
    Theta sum = {0};
    for (int k = from; k < n; k += step) {
      const PairVector r = place_between(xi, place_get(a.r.x, neighbour(list, k), &hj, &v));
      sum.all +=
          v * pair_weight(line ? a.kern : kern, line, &a.run, pair_dot(r, r), 0.5f * (hi + hj));
    }
    return sum;
  }

  static __device__ __forceinline__ void keep(const Loop &a, long i, Theta sum)
  {
    real h, v;
    place_get(a.r.x, i, &h, &v);
    a.s.theta[i] = sum.all + v * pair_weight(line ? a.kern : kern, line, &a.run, 0, h);
  }
};
