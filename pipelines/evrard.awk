# SPDX-License-Identifier: GPL-3.0-or-later
# awk -f verdict.awk -f evrard.awk -v n=N evrard.tsv profile.tsv conserved.tsv: energies against the 1-D calculation at t = 0.8 .. 1.3, and their sum; the
# profile at 0.8 outside the shock, at r = 0.14, and within the edge, by a support of 9000 particles each.
/^#/ { for (k = 1; k <= NF; k++) { name = $k; sub(/^# /, "", name); sub(/\[.*/, "", name); at[name] = k }; next }
FILENAME ~ /evrard.tsv$/ { r[++rows] = $1; for (j = 2; j <= 4; j++) exact[rows, j] = $j; next }
FILENAME ~ /profile.tsv$/ && ($1 < 0.25 || $1 > 0.6) { next }
FILENAME ~ /profile.tsv$/ {
  b = int(($1 - r[1])/(r[2] - r[1])) + 1; f = ($1 - r[b])/(r[b + 1] - r[b])
  for (j = 2; j <= 4; j++) { want = (1 - f)*exact[b, j] + f*exact[b + 1, j]; off[j] += abs($j - want); all[j] += abs(want) }
  next
}
{ t = $at["time"]; k = $at["E_kinetic"]; u = $at["E_internal"]; g = $at["E_potential"]; e = $at["E_total"]
  if (u > top) { top = u; when = t }
  if (first == "") first = e
  drift = max(drift, abs(e - first))
  for (j = 8; j <= 13; j++) if (before < j/10 && t >= j/10) { K[j] = k; U[j] = u; G[j] = g }
  before = t
}
END {
  title("Evrard's collapse, " n " particles")
  low = n < 5e4 ? 1.35 : n < 5e5 ? 1.55 : 1.69; high = n < 5e4 ? 1.80 : n < 5e5 ? 1.75 : 1.79
  claim("largest internal energy", top, low, high, "1.756 at t = 1.065", "1-D Lagrangian calculation")
  fact("its time", when, "1.065", "1-D Lagrangian calculation")
  split("0.411 0.443 0.270 0.123 0.118 0.163", k1, " "); split("0.467 0.912 1.576 1.720 1.420 1.110", u1, " ")
  for (j = 8; j <= 13; j++) { fact("kinetic energy at t = " j/10, K[j], k1[j - 7], "1-D Lagrangian calculation"); fact("internal energy at t = " j/10, U[j], u1[j - 7], "1-D Lagrangian calculation") }
  claim("density at t = 0.8, 0.25 < r < 0.6, relative L1", off[2]/all[2], 0, n < 5e4 ? 0.08 : n < 5e5 ? 0.04 : 0.03, "0", "1-D Lagrangian calculation")
  fact("radial velocity there", off[4]/all[4], "0", "1-D Lagrangian calculation")
  fact("pressure there (heated by viscosity)", off[3]/all[3], "0", "1-D Lagrangian calculation")
  fact("total energy at the start", first, "-0.61667", "-2/3 + 0.05")
  claim("largest change of the total energy over it", drift/abs(first), 0, n < 5e4 ? 3e-3 : n < 5e5 ? 2e-3 : 1e-3, "0", "")
}
