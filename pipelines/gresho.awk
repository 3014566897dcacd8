# SPDX-License-Identifier: GPL-3.0-or-later
# awk -f verdict.awk -f gresho.awk -v errors=FILE end.tsv... conserved.tsv...: sum of |v_phi - exact| within r < 0.5 over that of the exact one, at t = 0.9, 1.
function exact(r) { return r < 0.2 ? 5*r : r < 0.4 ? 2 - 5*r : 0 }
FNR == 1 { if (FILENAME ~ /end.tsv/) runs++; else first = "" }
/^#/ { if (FILENAME ~ /conserved/) for (k = 1; k <= NF; k++) { name = $k; sub(/^# /, "", name); sub(/\[.*/, "", name); at[name] = k }; next }
FILENAME ~ /conserved/ { e = $at["E_total"]; if (first == "") first = e; drift = max(drift, abs(e/first - 1)); p = max(p, max(abs($at["p_x"]), abs($at["p_y"]))); next }
$1 < 0.5 { v = exact($1); dx[runs] = 1/$4; sum[runs, $3] += abs($2 - v); norm[runs, $3] += v; if ($1 > 0.15 && $1 < 0.25) { top[runs, $3] += $2; all[runs, $3] += v } }
END {
  for (j = 1; j <= runs; j++) { E[j] = sum[j, 9]/norm[j, 9]; late[j] = sum[j, 10]/norm[j, 10] }
  title("Gresho-Chan vortex: " runs " resolutions, finest 1/" 1/dx[runs])
  print "# spacing\tt = 0.9\tt = 1" > errors
  for (j = 1; j <= runs; j++) {
    print dx[j] "\t" E[j] "\t" late[j] > errors
    if (dx[j] > 1/64) fact("relative L1 error of v_phi at t = 0.9, 1/" 1/dx[j], E[j], "0", "exact: steady")
    else claim("relative L1 error of v_phi at t = 0.9, 1/" 1/dx[j], E[j], 0, dx[j] == 1/64 ? 0.13 : E[j - 1], dx[j] == 1/64 ? "0" : "less than one coarser", "exact: steady")
    fact("speed at r = 0.15 to 0.25 that is left at t = 1, 1/" 1/dx[j], top[j, 10]/all[j, 10], "1", "")
  }
  claim("order of convergence at t = 0.9", order(dx, E, runs), 0.4, 2, "", "speed with kinks")
  claim("change of the total energy", drift, 0, 1e-4, "0", "")
  claim("momentum", p, 0, 1e-12, "0", "of 1 kg that moves at 1 m/s")
}
