# SPDX-License-Identifier: GPL-3.0-or-later
# awk -f verdict.awk -f sod.awk -v errors=FILE end.tsv...: errors of density, velocity and pressure in |x| < 0.45, coarsest first.
# Bounds: those for 450 and 4500 particles (rel. L1 and, between fan and contact, 2 and 0.7 %).
function exact(xi,   g, c) { # of (1, 1, 0) | (0.125, 0.1, 0): star states to 12 digits by Newton's method
  g = 1.4; ps = 0.303130178050647; us = 0.92745262004895; rs = 0.42631942817852
  if (xi < -sqrt(g)) { R = 1; V = 0; P = 1 }
  else if (xi < us - sqrt(g*ps/rs)) { c = 2/(g + 1)*(sqrt(g) - (g - 1)/2*xi); V = 2/(g + 1)*(sqrt(g) + xi); R = (c/sqrt(g))^(2/(g - 1)); P = R^g }
  else if (xi < us) { R = rs; V = us; P = ps }
  else if (xi < 1.75215573173) { R = 0.265573711705307; V = us; P = ps }
  else { R = 0.125; V = 0; P = 0.1 }
}
FNR == 1 { if (n) finish(); n++; delete e; delete norm }
/^#/ { next }
{ spacing[n] = $6; energy += $6*($5 + $3*$3/2) } # on the left the density was 1
$1 > -0.45 && $1 < 0.45 {
  exact($1/0.2); w = $6/$2
  e[1] += w*abs($2 - R); e[2] += w*abs($3 - V); e[3] += w*abs($4 - P); norm[1] += w*R; norm[2] += w*V; norm[3] += w*P
  if ($1/0.2 > 0.2 && $1/0.2 < 0.75) { star += $4; number++ }
}
function finish(   k) {
  for (k = 1; k <= 3; k++) E[k, n] = e[k]/norm[k]
  plateau[n] = star/number; total[n] = energy/2.75 - 1; star = number = energy = 0
}
END {
  finish()
  title("Sod's shock tube, 1D: " n " resolutions, finest spacing " spacing[n])
  split("density velocity pressure", name, " "); split("0.07 0.16 0.085", coarse, " "); split("0.012 0.03 0.015", fine, " ")
  print "# spacing\tdensity\tvelocity\tpressure" > errors
  for (j = 1; j <= n; j++) print spacing[j] "\t" E[1, j] "\t" E[2, j] "\t" E[3, j] > errors
  wide = spacing[n] <= 1/4000 ? 0.007 : 0.02
  for (k = 1; k <= 3; k++) {
    for (j = 1; j <= n; j++) x[j] = E[k, j]
    claim("relative L1 error of " name[k] ", finest", E[k, n], 0, spacing[n] <= 1/4000 ? fine[k] : coarse[k], "0", "exact Riemann solution")
    claim("order of convergence of " name[k], order(spacing, x, n), 0.8, 1.5, "1 at shocks", "")
  }
  claim("pressure between fan and contact", plateau[n], 0.30313*(1 - wide), 0.30313*(1 + wide), "0.30313", "exact")
  claim("change of the total energy", abs(total[n]), 0, 1e-4, "0", "")
}
