/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Aggregates of dust: Sirono (2004), Icarus 167, 431; strengths of Guettler et al. (2009), ApJ 701,
 * 130, and Geretshauser, Speith, Guettler, Krause & Blum (2010), A&A 513, A58. With the filling phi
 * = rho/rho_s, and phi' the filling at which there is no pressure (the state: 1/alpha),
 *
 *   p = K (phi/phi' - 1),   K = K_0 (phi' alpha_0)^power
 *   -T(phi) <= p <= C(phi)
 *   C = p_m ((phi_max - phi_min)/(phi_max - phi) - 1)^(width ln 10),   T = 10^(a + b phi) Pa
 *
 * Beyond a limit phi' moves so that p is the limit. The shear modulus grows as K; the shear
 * strength, yield law `porous`, is sqrt(C T). Nothing crushes beyond phi_max. */
#ifndef POROSITY_SIRONO_H
#define POROSITY_SIRONO_H

/* clang-format off */
#define POROSITY_SIRONO_ROWS(X) \
  X(K_0,     "Pa", NULL,   1e-30, 1e30, "bulk modulus at alpha_0") \
  X(power,   "1",  "4",    0,     20,   "of the bulk modulus with the filling") \
  X(p_m,     "Pa", NULL,   1e-30, 1e30, "mean pressure of crushing") \
  X(width,   "1",  "0.58", 1e-3,  10,   "of the transition, in decades of pressure") \
  X(phi_min, "1",  "0.12", 0,     1,    "filling of the loosest aggregate") \
  X(phi_max, "1",  "0.58", 1e-3,  1,    "filling of the densest aggregate") \
  X(a,       "1",  "2.8",  -30,   30,   "tensile strength: lg(T/Pa) at phi = 0") \
  X(b,       "1",  "1.48", -30,   30,   "tensile strength: growth of lg(T/Pa) with phi")
/* clang-format on */

struct porosity_sirono {
#define POROSITY_ROW(MEMBER, ...) double MEMBER;
  POROSITY_SIRONO_ROWS(POROSITY_ROW)
#undef POROSITY_ROW
};

/* C(phi) and T(phi) [Pa]. */
HD double porosity_sirono_crush(const struct porosity_sirono *q, double phi)
{
  double x = (q->phi_max - q->phi_min) / (q->phi_max - phi) - 1;
  if (phi >= q->phi_max) return INFINITY;
  return x > 0 ? q->p_m * pow(x, q->width * 2.302585092994046) : 0;
}

HD double porosity_sirono_tension(const struct porosity_sirono *q, double phi)
{
  return pow(10., q->a + q->b * phi);
}

/* p at the filling phi when it is free of pressure at phi'; and K. */
HD double porosity_sirono_bulk(const struct porosity_sirono *q, double alpha0, double rest)
{
  return q->K_0 * pow(rest * alpha0, q->power);
}

HD double porosity_sirono_p(const struct porosity_sirono *q, double alpha0, double phi, double rest)
{
  return porosity_sirono_bulk(q, alpha0, rest) * (phi / rest - 1);
}

#endif
