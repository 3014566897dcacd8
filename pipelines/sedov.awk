# SPDX-License-Identifier: GPL-3.0-or-later
# awk -f verdict.awk -f sedov.awk -v n=N -v bins=FILE -v errors=FILE nN/end.tsv... conserved.tsv: coarsest first; all but errors is of the finest.
# The front is where the density in shells falls from its peak to half of it (over the 1 outside); o = 8: all octants.
BEGIN { shells = int(1.2*n); width = 0.5/shells; tabulate() }
# The exact density at r/R, R the front's radius (Landau & Lifshitz, Fluid Mechanics, section 106): a table over r/R, gamma 5/3.
function tabulate(   k, V, g, a, b, c, n1) {
  g = 5/3; n1 = -(13*g*g - 7*g + 12)/((3*g - 1)*(2*g + 1))
  for (k = 1; k <= 2000; k++) {
    V = 1/g + (2/(g + 1) - 1/g)*(k/2000)^4
    a = (g + 1)/(7 - g)*(5 - (3*g - 1)*V); b = (g + 1)/(g - 1)*(g*V - 1); c = (g + 1)/(g - 1)*(1 - V)
    X[k] = (((g + 1)/2*V)^-2*a^n1*b^(5*(g - 1)/(2*g + 1)))^0.2; G[k] = (g + 1)/(g - 1)*b^(3/(2*g + 1))*a^(-n1/(2 - g))*c^(-2/(2 - g))
  }
}
function exact(r,   low, high, mid) {
  r /= 0.34747; if (r >= 1) return 1
  if (r < X[1]) return G[1]
  low = 1; high = 2000
  while (high - low > 1) { mid = int((low + high)/2); if (X[mid] <= r) low = mid; else high = mid }
  return G[low] + (G[high] - G[low])*(r - X[low])/(X[high] - X[low])
}
FNR == 1 && FILENAME ~ /end.tsv/ { side = FILENAME; sub(/\/end.tsv$/, "", side); sub(/.*\/n/, "", side); spacing[++runs] = 1/side }
/^#/ { if (FILENAME ~ /conserved/) for (k = 1; k <= NF; k++) { name = $k; sub(/^# /, "", name); sub(/\[.*/, "", name); at[name] = k }; next }
FILENAME ~ /conserved/ {
  e = $at["E_total"]; if (first == "") first = e; last = e
  for (k = at["p_x"]; k <= at["p_z"]; k++) p = max(p, abs($k))
  next
}
$1 < 0.45 { off[runs] += $5/$2*abs($2 - exact($1)); norm[runs] += $5/$2*exact($1) }
side != n { next }
{ k = int($1/width); if (k < shells) { m[8, k] += $5; v[8, k] += $5/$2; m[$6, k] += $5; v[$6, k] += $5/$2 } }
function front(o,   k, top, half) {
  for (k = 0; k < shells; k++) { rho[k] = v[o, k] > 0 ? m[o, k]/v[o, k] : 0; if (rho[k] > rho[top + 0]) top = k }
  peak = rho[top]; half = 1 + (peak - 1)/2
  for (k = top; k < shells - 1; k++)
    if (rho[k + 1] < half) return (k + 0.5 + (rho[k] - half)/(rho[k] - rho[k + 1]))*width
  return 0
}
END {
  R = front(8); top = peak
  print "# r\tdensity" > bins
  for (k = 0; k < shells; k++) print (k + 0.5)*width "\t" rho[k] > bins
  for (o = 0; o < 8; o++) { r = front(o); mean += r/8; square += r*r/8 }
  title("Sedov's blast wave, " n "^3 particles")
  wide = n < 50 ? 0.05 : n < 128 ? 0.03 : 0.01
  claim("radius of the front at t = 0.05", R, 0.34747*(1 - wide), 0.34747*(1 + wide), "0.34747", "Sedov (1959)")
  claim("largest density in shells", top, n < 50 ? 1.9 : n < 128 ? 2.4 : 3.2, 4.2, "4", "strong shock, gamma 5/3")
  claim("scatter of the front over the octants", sqrt(max(0, square - mean*mean))/mean, 0, 0.01, "0", "symmetry")
  print "# spacing\tdensity" > errors
  for (k = 1; k <= runs; k++) { E[k] = off[k]/norm[k]; print spacing[k] "\t" E[k] > errors; fact("relative L1 error of the density, r < 0.45, 1/" 1/spacing[k], E[k], "0", "Sedov (1959)") }
  claim("the same, finest over the next coarser", E[runs]/E[runs - 1], 0, 1, "less than 1", "")
  fact("order of convergence of the density", order(spacing, E, runs), "1 at shocks", "that are resolved")
  claim("change of the total energy", abs(last/first - 1), 0, 1e-3, "0", "")
  claim("momentum", p, 0, 1e-13, "0", "of 1 kg that moves at about 1 m/s")
}
