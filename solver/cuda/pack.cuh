/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the pair loops read of particles and images, packed once per loop in code units: part of
 * loops.cuh. Vectors and tensors are turned as mirrors show them. */

/* Records for loop A: y with ha, v with the volume; they have no w. */
static __global__ void pack_flow(Loop a)
{
  long i = self_of();
  const State &s = a.s;
  const double il = 1 / a.unit.length, iv = 1 / a.unit.speed, *y = &s.y[3 * i];
  if (i >= s.all) return;
  const long o = image_owner(&s, i);
  double v[3];
  seen(s, i, &s.v[3 * o], v);
  place_set(a.r.x, i, (y[0] - a.root->origin[0]) * il, (y[1] - a.root->origin[1]) * il,
            (y[2] - a.root->origin[2]) * il, (real)(s.ha[o] * il), 0);
  place_set(a.r.v, i, v[0] * iv, v[1] * iv, v[2] * iv, (real)(passes_volume(&s, o) * a.volume), 0);
}

/* Places for theta: y with ha and the volume. */
static __global__ void pack_volumes(Loop a)
{
  long i = self_of();
  const State &s = a.s;
  const double il = 1 / a.unit.length, *y = &s.y[3 * i];
  if (i >= s.all) return;
  const long o = image_owner(&s, i);
  place_set(a.r.x, i, (y[0] - a.root->origin[0]) * il, (y[1] - a.root->origin[1]) * il,
            (y[2] - a.root->origin[2]) * il, (real)(s.ha[o] * il),
            (real)(s.m[o] / s.rhoa[o] * a.volume));
}

/* Records for loop B: x with h and m; v, rho | cs, signal, p, dxx (fluid 1/rho) | rest of d. */
template <int solid> static __global__ void pack_body(Loop a)
{
  long i = self_of();
  const State &s = a.s;
  const double il = 1 / a.unit.length, iv = 1 / a.unit.speed, it = a.shear;
  const double *x = &s.x[3 * i];
  if (i >= s.all) return;
  const long o = image_owner(&s, i);
  const double *t = &s.t[9 * o];
  double v[3], w[3];
  seen(s, i, &s.vp[3 * o], v);
  image_signs(&s, i, w);
  place_set(a.r.x, i, (x[0] - a.root->origin[0]) * il, (x[1] - a.root->origin[1]) * il,
            (x[2] - a.root->origin[2]) * il, (real)(s.h[o] * il),
            (real)(passes_mass(&s, o) / a.unit.mass));
  quad_set(a.r.q[0], i, v[0] * iv, v[1] * iv, v[2] * iv, s.rho[o] / a.rho);
  quad_set(a.r.q[1], i, s.cs[o] * iv, s.cl[o] * iv, s.push[o] * a.push,
           solid ? t[0] * it : a.rho / s.rho[o]);
  if (!solid) return;
  const double xy = w[0] * w[1] * it, xz = w[0] * w[2] * it, yz = w[1] * w[2] * it;
  quad_set(a.r.q[2], i, t[1] * xy, t[2] * xz, t[3] * xy, t[4] * it);
  quad_set(a.r.q[3], i, t[5] * yz, t[6] * xz, t[7] * yz, t[8] * it);
}

/* The same of runs with more pair terms: stress as `squares` has it, PairExtra. */
static __global__ void pack_rich(Loop a)
{
  long i = self_of();
  const State &s = a.s;
  const double il = 1 / a.unit.length, iv = 1 / a.unit.speed, iz = iv * iv * a.rho;
  const double it = a.shear;
  if (i >= s.all) return;
  const long o = image_owner(&s, i);
  const double *x = &s.x[3 * i], *t = &s.t[9 * o], *e = &s.extra[8 * o];
  double v[3], w[3];
  seen(s, i, &s.vp[3 * o], v);
  image_signs(&s, i, w);
  const double xy = w[0] * w[1], xz = w[0] * w[2], yz = w[1] * w[2];
  place_set(a.r.x, i, (x[0] - a.root->origin[0]) * il, (x[1] - a.root->origin[1]) * il,
            (x[2] - a.root->origin[2]) * il, (real)(s.h[o] * il),
            (real)(passes_mass(&s, o) / a.unit.mass));
  quad_set(a.r.q[0], i, v[0] * iv, v[1] * iv, v[2] * iv, s.rho[o] / a.rho);
  quad_set(a.r.q[1], i, s.cs[o] * iv, s.cl[o] * iv, s.push[o] * a.push, t[0] * it);
  quad_set(a.r.q[2], i, t[1] * xy * it, t[2] * xz * it, t[3] * xy * it, t[4] * it);
  quad_set(a.r.q[3], i, t[5] * yz * it, t[6] * xz * it, t[7] * yz * it, t[8] * it);
  quad_set(a.r.q[4], i, e[0], e[1], e[2] * iz, e[3] * xy * iz);
  quad_set(a.r.q[5], i, e[4] * xz * iz, e[5] * iz, e[6] * yz * iz, e[7] * iz);
}

/* Places for the density sums: x with h and m. */
static __global__ void pack_places(Loop a)
{
  long i = self_of();
  const State &s = a.s;
  const double il = 1 / a.unit.length, *x = &s.x[3 * i];
  if (i >= s.all) return;
  const long o = image_owner(&s, i);
  place_set(a.r.x, i, (x[0] - a.root->origin[0]) * il, (x[1] - a.root->origin[1]) * il,
            (x[2] - a.root->origin[2]) * il, (real)(s.h[o] * il), (real)(s.m[o] / a.unit.mass));
}
