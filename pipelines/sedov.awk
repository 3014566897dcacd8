# SPDX-License-Identifier: GPL-3.0-or-later
# awk -f verdict.awk -f sedov.awk -v n=N -v bins=FILE end.tsv conserved.tsv
# The front is where the density in shells falls from its peak to half of it (over the 1 outside); o = 8: all octants.
BEGIN { shells = int(1.2*n); width = 0.5/shells }
/^#/ { if (FILENAME ~ /conserved/) for (k = 1; k <= NF; k++) { name = $k; sub(/^# /, "", name); sub(/\[.*/, "", name); at[name] = k }; next }
FILENAME ~ /conserved/ {
  e = $at["E_total"]; if (first == "") first = e; last = e
  for (k = at["p_x"]; k <= at["p_z"]; k++) p = max(p, abs($k))
  next
}
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
  claim("change of the total energy", abs(last/first - 1), 0, 1e-3, "0", "")
  claim("momentum", p, 0, 1e-13, "0", "of 1 kg that moves at about 1 m/s")
}
