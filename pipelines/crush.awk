# SPDX-License-Identifier: GPL-3.0-or-later
# awk -f verdict.awk -f crush.awk -v n=N vSPEED/in.tsv vSPEED/out.tsv ...: pressure, greatest so far, distention, density, id of all snapshots.
function curve(p) { return p <= 2e8 ? 1.25 : p >= 2e9 ? 1 : 1 + 0.25*((2e9 - p)/1.8e9)^2 }
FNR == 1 { way = FILENAME ~ /in.tsv$/ ? "in" : "out"; if (way == "in") { speed = FILENAME; sub(/\/in.tsv$/, "", speed); sub(/.*v/, "", speed); speeds[++many] = speed } snapshot = 0; delete last }
/^#/ { snapshot++; next }
way == "in" && snapshot == 1 { rest[speed] = max(rest[speed], max(abs($4*1.25/2700 - 1), abs($1)/26.7e9)) }
{
  if (way == "in" && $1 >= (1 - 1e-9)*$2 && $1 > 2e8 && $1 < 2e9) { points[speed]++; off[speed] = max(off[speed], abs($3 - curve($1))) }
  above[speed] = max(above[speed], $3 - curve($1))
  if ($5 in last) rise[speed] = max(rise[speed], $3 - last[$5])
  last[$5] = $3
  if (way == "in" && snapshot > 30) turn[speed] = max(turn[speed], $3)
}
END {
  title("Porous basalt under a piston, " n " particles: distention")
  source = "crush curve"
  for (k = 1; k <= many; k++) {
    v = speeds[k]
    claim(v " m/s: at rest, density and pressure", rest[v], 0, 1e-12, "0", "density x alpha_0 = that of the solid")
    claim(v " m/s: off the curve while it is loaded", off[v], 0, 1e-8, "0", source)
    fact(v " m/s: points on it", points[v], "", "")
    claim(v " m/s: above the curve, ever", above[v], -1e300, 1e-8, "<= 0", source)
    claim(v " m/s: greatest rise, in and out", rise[v], -1e300, 1e-12, "<= 0", "pores do not open again")
    fact(v " m/s: greatest at the piston's turn", turn[v], "", "")
  }
}
