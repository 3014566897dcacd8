/* SPDX-License-Identifier: GPL-3.0-or-later */
/* h that follows from the density, h = eta (m/rho)^(1/D), with rho = sum_j m_j W(r_ij, h_i), and
 * the terms that this brings into the forces (form.grad_h): Springel & Hernquist (2002, MNRAS 333,
 * 649), Price (2012, J. Comput. Phys. 231, 759). */
#ifndef GRAD_H
#define GRAD_H

#include "state.h"

/* Sums of a search: all but the last with a step of Newton's method on h after them, of at most a
 * fifth; so h stays within the search's margin of a half. */
enum { GRAD_SUMS = 3 };
#define GRAD_MARGIN 0.5

/* Numbers of a run. */
typedef struct {
  double eta;
  int miscible; /* rho = m sum W */
} Grad;

/* grad_omega: Omega = 1 + h/(D rho) sum m_j dW/dh, from the density and that sum; above 0, as
 * kernels fall with the distance. */
HD double grad_omega(const State *s, long i, double rho, double rate)
{
  return 1 + s->h[i] / (s->dimension * rho) * rate;
}

/* grad_next: h after a step of Newton's method for ln(h (rho/m)^(1/D)/eta) = 0 in ln h, whose
 * derivative is Omega: it goes the right way from wherever it begins. */
HD double grad_next(const State *s, const Grad *k, long i, double rho, double rate)
{
  const double h = s->h[i], off = log(h / k->eta * pow(rho / s->m[i], 1. / s->dimension));
  const double step = -off / fmax(grad_omega(s, i, rho, rate), 1e-3);
  const double next = h * exp(step > 0.18 ? 0.18 : step < -0.18 ? -0.18 : step);
  return next < s->h_min ? s->h_min : next > s->h_max ? s->h_max : next;
}

/* grad_keep: what follows from the sums of i, itself included: delta = sum W, mass = sum m_j W,
 * rate = sum m_j dW/dh (miscible: m_i), W of h_i; newton: h goes on; else rho, delta, rhoa (the
 * mean of rho before and after) and Omega, which is 1 where h is held at its limits. */
HD void grad_keep(const State *s, const Grad *k, long i, double delta, double mass, double rate,
                  int newton)
{
  const double h = s->h[i], rho = k->miscible ? s->m[i] * delta : mass;
  const int held = !(h > s->h_min && h < s->h_max);
  if (newton) {
    s->h[i] = grad_next(s, k, i, rho, rate);
    return;
  }
  s->rhoa[i] = sqrt(s->rho[i] * rho);
  s->rho[i] = rho, s->delta[i] = delta;
  s->omega[i] = held ? 1 : grad_omega(s, i, rho, rate);
}

#endif
