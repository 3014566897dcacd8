# SPDX-License-Identifier: GPL-3.0-or-later
# awk -f verdict.awk -f dambreak.awk -v dx=SPACING dambreak.tsv long.tsv front.tsv
BEGIN { g = 9.81; T = sqrt(g) } # t* = t sqrt(g/H), H = 1 m
/^#/ { next }
FILENAME ~ /data.dambreak.tsv/ { n[$1]++; when[$1, n[$1]] = $2; value[$1, n[$1]] = $3; next }
{ what = FILENAME ~ /long.tsv/ ? "long" : "front"; k = ++rows[what]; t[what, k] = $1; x[what, k] = $2; f[what, k] = $3; y[what, k] = $4; p[what, k] = $5 }
{ out[what] += $6; if (k == 1) mass[what] = $8; lost[what] = max(lost[what] + 0, abs($8/mass[what] - 1)) }
what == "long" && !hit && $2 < 5.37 - dx { squeezed = max(squeezed + 0, $7) }
what == "long" && !hit && $2 >= 5.37 - dx { hit = k }
# A column of the table at a time; the first time at which it is value.
function at(table, what, time,   k) {
  for (k = 2; k <= rows[what]; k++) if (t[what, k] >= time)
    return table[what, k - 1] + (table[what, k] - table[what, k - 1])*(time - t[what, k - 1])/(t[what, k] - t[what, k - 1])
  return -1
}
function passes(table, what, value,   k) {
  for (k = 2; k <= rows[what]; k++) if (table[what, k] >= value)
    return t[what, k - 1] + (t[what, k] - t[what, k - 1])*(value - table[what, k - 1])/(table[what, k] - table[what, k - 1])
  return -1
}
# The rms distance of the front from the rows of a reference with times in `unit` s, as if these were earlier by `late`.
function distance(row, unit, late,   k, d, sum) {
  for (k = 1; k <= n[row]; k++) { d = at(f, "front", when[row, k]*unit - late) - value[row, k]; sum += d*d }
  return sqrt(sum/n[row])
}
# The largest deviation of the height at the wall, over height, from the rows of a reference.
function deviation(row, what, unit, height,   k, worst) {
  for (k = 1; k <= n[row]; k++) if (when[row, k]*unit <= t[what, rows[what]])
    worst = max(worst + 0, abs(at(y, what, when[row, k]*unit)/height - value[row, k]/(row == "left" ? 1 : height)))
  return worst
}
END {
  title("Breaking dams, spacing " dx " m")
  exact = "potential flow, boundary elements"; measured = "Martin & Moyce (1952)"; coarse = dx > 0.01 ? 0.15 : 0.08; unit = 1/sqrt(2*g)
  claim("rms distance of the front from the exact [m]", distance("exact_front", 1, 0), 0, coarse, "0", exact)
  for (k = 1; k <= n["front"]; k++) late += (when["front", k]*unit - passes(f, "front", value["front", k]))/n["front"]
  claim("rms distance of the front from the measured, clocks set [m]", distance("front", unit, late), 0, coarse, "0", measured)
  fact("by which the measured front is late [s]", late, "exact: 0.045", measured)
  claim("rms distance of the front from the measured [m]", distance("front", unit, 0), 0, coarse, "exact: 0.26; DualSPHysics at 10 mm: 0.27", measured)
  claim("height at the wall, largest deviation from the measured over 2 m", deviation("left", "front", 1/T, 2), 0, 0.03, "exact: 0.022", measured)
  arrival = passes(x, "long", 5.37 - dx)*T; if (!hit) arrival = 1e99
  name = "arrival at the wall, t sqrt(g/H)"; sharp = sprintf("exact: %.2f", when["exact_arrival", 1]*T); source = exact "; other SPH codes: 2.68 at 20 mm, 2.55 to 2.60 at 10 mm"
  if (dx > 0.02) claim(name, arrival, 1.685, 3.0, sharp, source)
  else claim(name, arrival, dx > 0.005 ? 2.35 : 2.3, dx > 0.005 ? 2.85 : 2.6, sharp, source)
  ahead = -1e99; for (k = 2; k < hit; k++) ahead = max(ahead, x["long", k] - 2 - 2*T*t["long", k])
  claim("front before 2 m + 2 sqrt(g H) t by [m]", ahead, -1e300, dx, "never", "Ritter (1892)")
  claim("height at the left wall, largest deviation [m]", deviation("exact_height", "long", 1, 1), 0, dx > 0.005 ? 0.03 : 0.02, "0", exact)
  claim("largest change of density before the impact", squeezed, 0, 0.016, "0.016", "(v/c)^2")
  for (k = hit; hit && k <= rows["long"]; k++) if (t["long", k]*T > arrival + 0.3 && t["long", k]*T < 5.5) { P += p["long", k]; m++ }
  if (t["long", rows["long"]]*T > 5.4) claim("mean pressure 0.2 m up the right wall over rho g H", P/m/9810, 0.2, 1.2, "0.8 to 1 after the impact", "")
  claim("mass, largest change", max(lost["long"], lost["front"]), 0, 0, "0", "")
  claim("particles outside of the tanks", out["long"] + out["front"], 0, 0, "0", "")
}
