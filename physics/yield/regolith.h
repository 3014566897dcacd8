/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Soil after Bui, Fukagawa, Sako & Ohno (2008), Int. J. Numer. Anal. Meth. Geomech. 32, 1537: the
 * cone of Drucker & Prager matched to Mohr-Coulomb in plane strain,
 *
 *   sqrt(J2) <= k + 3 a p,   a = tan(phi)/sqrt(9 + 12 tan(phi)^2),   k = 3 c a/tan(phi)
 *
 * with plastic flow along the cone of the angle of dilatancy psi (b as a): what flows gains volume.
 * The trial stress of the elastic step returns by
 *
 *   l = (sqrt(J2) - k - 3 a p)/(G + 9 K a b),   p -> p + 3 b K l,   sqrt(J2) -> sqrt(J2) - G l
 *
 * to the cone, and beyond its apex to that (no tension below -k/3a). They carry p in the stress;
 * here p stays that of the equation of state, of the density without the volume that flow has
 * opened: the field Distention. */
#ifndef YIELD_REGOLITH_H
#define YIELD_REGOLITH_H

/* clang-format off */
#define YIELD_REGOLITH_ROWS(X) \
  X(cohesion,   "Pa",  NULL, 0, 1e300, "cohesion c") \
  X(friction,   "rad", NULL, 0, 1.57,  "angle of internal friction phi") \
  X(dilatancy,  "rad", "0",  0, 1.57,  "angle of dilatancy psi; phi: associated flow")
/* clang-format on */

struct yield_regolith {
#define YIELD_ROW(MEMBER, ...) double MEMBER;
  YIELD_REGOLITH_ROWS(YIELD_ROW)
#undef YIELD_ROW
};

/* a of an angle. */
HD double yield_regolith_slope(double angle)
{
  double t = tan(angle);
  return t / sqrt(9 + 12 * t * t);
}

/* k, with what is left of the cohesion. */
HD double yield_regolith_start(const struct yield_regolith *y, double left)
{
  double t = tan(y->friction);
  return 3 * left * y->cohesion / sqrt(9 + 12 * t * t);
}

HD double yield_regolith(const struct yield_regolith *y, const YieldPoint *at)
{
  double k = yield_regolith_start(y, at->weak);
  return yield_return(sqrt(at->j2), at->soft * (k + 3 * yield_regolith_slope(y->friction) * at->p));
}

/* yield_regolith_pressure: p after the return of a trial stress, K and G the moduli. */
HD double yield_regolith_pressure(const struct yield_regolith *y, const YieldPoint *at, double K,
                                  double G)
{
  double k = at->soft * yield_regolith_start(y, at->weak), stress = sqrt(at->j2), l;
  double a = at->soft * yield_regolith_slope(y->friction), b = yield_regolith_slope(y->dilatancy);
  double p = at->p, apex = a > 0 ? -k / (3 * a) : -INFINITY;
  l = (stress - k - 3 * a * p) / (G + 9 * K * a * b);
  if (l > 0) p += 3 * b * K * (l * G < stress ? l : stress / G);
  return p < apex ? apex : p;
}

#endif
