# SPDX-License-Identifier: GPL-3.0-or-later
# awk -f verdict.awk -f plate.awk -v dx=MM vSPEED/tip.tsv vSPEED/run/conserved.tsv ...: the period from the first two times at which the tip
# passes its place at rest, half a period apart; the loss from the extremes before, between and after.
FNR == 1 { if (FILENAME ~ /tip/) { finish(); speed = FILENAME; sub(/\/tip.tsv$/, "", speed); sub(/.*v/, "", speed); zeros = 0; last = 0; extreme[1] = extreme[2] = extreme[3] = 0 } lines = 0 }
/^#/ { if (!lines++) for (k = 1; k <= NF; k++) { name = $k; sub(/^# /, "", name); sub(/\[.*/, "", name); at[name] = k }; next }
FILENAME ~ /tip/ {
  if (FNR > 1 && last*$2 < 0) zero[++zeros] = before + ($1 - before)*last/(last - $2)
  extreme[zeros + 1] = max(extreme[zeros + 1], abs($2)); last = $2; before = $1; next
}
{ if (!(speed in E)) E[speed] = $at["E_total"]; drift[speed] = max(drift[speed], abs($at["E_total"]/E[speed] - 1)) }
function finish() { if (speed != "") { of[++runs] = speed; T[runs] = 2*(zero[2] - zero[1]); A[runs] = extreme[1]; B[runs] = extreme[3]/extreme[1] } }
END {
  finish()
  title("A clamped plate, spacing " dx " mm, ten to forty layers")
  source = "thin plate"
  for (r = 1; r <= runs; r++) {
    low = dx > 0.7 ? 0.97 : 0.96; high = dx > 1.5 ? 1.12 : dx > 0.7 ? 1.07 : 1.04
    if (of[r] < 0.02) claim("speed " of[r] ": period [s]", T[r], 0.25403*low, 0.25403*high, "0.25403", source)
    else fact("speed " of[r] ": period [s]", T[r], "0.25403", source ", small bending")
    fact("speed " of[r] ": first amplitude [m]", A[r], 57.03*of[r]/24.734, source)
    claim("speed " of[r] ": amplitude lost in a period", 1 - B[r], -1e300, 0.05, "0", "")
    claim("speed " of[r] ": change of the energy over it", drift[of[r]], 0, 0.01, "0", "")
  }
}
