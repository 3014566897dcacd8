# SPDX-License-Identifier: GPL-3.0-or-later
# awk -f verdict.awk -f kepler.awk -v n=ORBITS orbit.tsv conserved.tsv: the apsis from v x L - r/r of the relative orbit, after each turn.
/^#/ { if (FILENAME ~ /conserved/) for (k = 1; k <= NF; k++) { name = $k; sub(/^# /, "", name); sub(/\[.*/, "", name); at[name] = k }; next }
FILENAME ~ /conserved/ { e = $at["E_kinetic"] + $at["E_potential"]; if (first == "") first = e; drift = max(drift, abs(e - first))
  L = $at["L_z"]; if (L0 == "") L0 = L; turn = max(turn, abs(L/L0 - 1)); next }
{ x = 2*$1; y = 2*$2; u = 2*$3; v = 2*$4; l = x*v - y*u; r = sqrt(x*x + y*y); a = atan2(-(-u*l - y/r), -(v*l - x/r)); if (rows++ == 0) a0 = a; last = a }
END {
  title("Kepler orbit, eccentricity 0.5, " n " turns")
  claim("change of the energy over it", drift/abs(first), 0, 1e-6*n/10, "0", "")
  claim("turn of the apsis [rad an orbit]", abs(last - a0)/n, 0, 1e-4, "0", "")
  claim("change of the angular momentum", turn, 0, 1e-6*n/10, "0", "")
  fact("energy at the start", first, "-0.125", "-m1 m2/(2 a)")
}
