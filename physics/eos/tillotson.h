/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tillotson (1962), GA-3216; Melosh (1989) app. II. With eta = rho/rho0, mu = eta - 1,
 * z = rho0/rho - 1 and w = 1 + u/(E0 eta^2) there are three states:
 *
 *   compressed, also cold expanded (rho >= rho0 or u <= Eiv), 001 eq. 14:
 *     p = (a + b/w) rho u + A mu + B mu^2
 *   expanded (rho < rho0 and u >= Ecv), 001 eq. 15:
 *     p = a rho u + (b rho u/w + A mu exp(-beta z)) exp(-alpha z^2)
 *   partly vaporised (rho < rho0 and Eiv < u < Ecv):
 *     linear in u between the two
 *
 * p is continuous in rho > 0 and u; c jumps at the borders, as the slopes of the law do. 001's
 * "u > Ecv" alone for eq. 15 would put dense hot matter into the expanded state. c is that of the p
 * used, in the partly vaporised state with the slope of the weight. */
#ifndef EOS_TILLOTSON_H
#define EOS_TILLOTSON_H

/* clang-format off */
#define EOS_TILLOTSON_ROWS(X) \
  X(rho0,    "kg/m^3", NULL, 1e-30, 1e30, "density at zero pressure and energy") \
  X(A,       "Pa",     NULL, 1e-30, 1e30, "bulk modulus at zero pressure and energy") \
  X(B,       "Pa",     NULL, -1e30, 1e30, "coefficient of mu^2") \
  X(E0,      "J/kg",   NULL, 1e-30, 1e30, "energy at which b/w falls to b/2") \
  X(Eiv,     "J/kg",   NULL, 1e-30, 1e30, "energy of incipient vaporisation") \
  X(Ecv,     "J/kg",   NULL, 1e-30, 1e30, "energy of complete vaporisation") \
  X(a,       "1",      NULL, 0,     10,   "Grueneisen parameter of the hot gas, gamma - 1") \
  X(b,       "1",      NULL, 0,     10,   "a + b: Grueneisen parameter at rest") \
  X(alpha,   "1",      NULL, 0,     1e3,  "decay with z^2 in the expanded state") \
  X(beta,    "1",      NULL, 0,     1e3,  "decay of the cold pressure with z there") \
  X(rho_min, "1",      "0",  0,     1,    "no tension below rho_min x rho0; 0: never cut") \
  X(c_min,   "m/s",    "0",  0,     1e30, "floor of the sound speed; 0: 1 % of sqrt(A/rho0)")
/* clang-format on */

struct eos_tillotson {
#define EOS_ROW(MEMBER, ...) double MEMBER;
  EOS_TILLOTSON_ROWS(EOS_ROW)
#undef EOS_ROW
};

/* p and its derivatives with rho at constant u, and with u at constant rho. */
typedef struct {
  double p, rho, u;
} EosSlope;

HD double eos_tillotson_rho0(const struct eos_tillotson *e) { return e->rho0; }

/* b rho u/w, the term that the two states share. */
HD EosSlope eos_tillotson_thermal(const struct eos_tillotson *e, double rho, double u)
{
  double eta = rho / e->rho0, w = 1 + u / (e->E0 * eta * eta);
  EosSlope t = {e->b * rho * u / w, e->b * u * (3 * w - 2) / (w * w), e->b * rho / (w * w)};
  return t;
}

HD EosSlope eos_tillotson_compressed(const struct eos_tillotson *e, double rho, double u)
{
  double mu = rho / e->rho0 - 1;
  EosSlope t = eos_tillotson_thermal(e, rho, u);
  t.p += e->a * rho * u + (e->A + e->B * mu) * mu;
  t.rho += e->a * u + (e->A + 2 * e->B * mu) / e->rho0;
  t.u += e->a * rho;
  return t;
}

HD EosSlope eos_tillotson_expanded(const struct eos_tillotson *e, double rho, double u)
{
  double mu = rho / e->rho0 - 1, z = e->rho0 / rho - 1, dz = -e->rho0 / (rho * rho);
  double gauss = exp(-e->alpha * z * z), decay = exp(-e->beta * z);
  EosSlope t = eos_tillotson_thermal(e, rho, u);
  double solid = t.p + e->A * mu * decay;
  double slope = t.rho + e->A * decay * (1 / e->rho0 - e->beta * mu * dz);
  t.p = e->a * rho * u + solid * gauss;
  t.rho = e->a * u + (slope - 2 * e->alpha * z * dz * solid) * gauss;
  t.u = e->a * rho + t.u * gauss;
  return t;
}

/* eos_tillotson: rho > 0. */
HD EosPoint eos_tillotson(const struct eos_tillotson *e, double rho, double u, double r)
{
  double c_min = e->c_min > 0 ? e->c_min : EOS_FLOOR * sqrt(e->A / e->rho0);
  EosSlope t;
  (void)r;
  if (rho >= e->rho0 || u <= e->Eiv)
    t = eos_tillotson_compressed(e, rho, u);
  else if (u >= e->Ecv)
    t = eos_tillotson_expanded(e, rho, u);
  else {
    EosSlope cold = eos_tillotson_compressed(e, rho, u), hot = eos_tillotson_expanded(e, rho, u);
    double range = e->Ecv - e->Eiv, x = (u - e->Eiv) / range;
    t.p = cold.p + x * (hot.p - cold.p);
    t.rho = cold.rho + x * (hot.rho - cold.rho);
    t.u = cold.u + x * (hot.u - cold.u) + (hot.p - cold.p) / range;
  }
  return eos_point(eos_no_tension(t.p, rho / e->rho0, e->rho_min), t.rho + t.p * t.u / (rho * rho),
                   c_min);
}

#endif
