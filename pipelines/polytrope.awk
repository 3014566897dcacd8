# SPDX-License-Identifier: GPL-3.0-or-later
# awk -f verdict.awk -f polytrope.awk -v profile=1: the polytrope as mksphere --profile reads it.
# awk -f verdict.awk -f polytrope.awk -v n=N settled.tsv pulse.tsv conserved.tsv: density against it; the period from the mean distance
# of upward crossings of R_rms through its mean.
BEGIN { pi = atan2(0, -1); if (profile) { write(2000); exit } }
function density(r) { return r < 1e-9 ? pi/4 : r < 1 ? pi/4*sin(pi*r)/(pi*r) : 0 }
function write(n,   k, r, x, rho, m) {
  OFS = "\t"
  print "# layer 1: polytrope:1kg:u=0J/kg"; print "# outside: 0 Pa"
  print "# r[m]\tm[kg]\trho[kg/m^3]\tp[Pa]\tu[J/kg]\ts[J/K/kg]\tT[K]\tg[m/s^2]\tcs[m/s]\tf\tlayer"
  for (k = 0; k <= n; k++) {
    r = k/n; x = pi*r; rho = k < n ? density(r) : 1e-9; m = (sin(x) - x*cos(x))/pi
    print r, m, rho, 2/pi*rho^2, 2/pi*rho, 0, 0, r ? m/r^2 : 0, sqrt(4/pi*rho), 0, 1
  }
}
/^#/ { if (FILENAME ~ /conserved/) for (k = 1; k <= NF; k++) { name = $k; sub(/^# /, "", name); sub(/\[.*/, "", name); at[name] = k }; next }
FILENAME ~ /settled/ { U += $3*$4/$2; if ($1 < 0.8) { off += ($2/density($1) - 1)^2; inside++ }; next }
FILENAME ~ /pulse/ { t[++rows] = $1; R[rows] = $2; mean += $2; next }
!pull { pull = $at["E_potential"] }
END {
  if (profile) exit
  mean /= rows; big = 0
  for (k = 2; k <= rows; k++) {
    big = max(big, abs(R[k] - mean))
    if (R[k - 1] < mean && R[k] >= mean) { when = t[k - 1] + (t[k] - t[k - 1])*(mean - R[k - 1])/(R[k] - R[k - 1]); if (!turns++) from = when; to = when }
  }
  title("Polytrope of index 1, " n " particles")
  wide = n < 3e4 ? 0.05 : n < 5e5 ? 0.03 : 0.015
  claim("density at rest off the exact one, rms, r < 0.8", sqrt(off/inside), 0, wide, "0", "Lane-Emden, index 1")
  period = turns > 1 ? (to - from)/(turns - 1) : 0; wide = n < 3e4 ? 0.05 : n < 5e5 ? 0.025 : 0.01
  claim("period of the fundamental mode", period, 3.24254*(1 - wide), 3.24254*(1 + wide), "3.24254", "adiabatic wave equation, Gamma 2")
  claim("at rest: E_potential + 3 (Gamma - 1) U, over E_potential", (pull + 3*U)/pull, -0.01, 0.01, "0", "virial theorem")
  fact("largest change of R_rms", big/mean, "", "")
}
