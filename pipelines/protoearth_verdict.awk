# SPDX-License-Identifier: GPL-3.0-or-later
# awk -f verdict.awk -f protoearth_verdict.awk -v n=N profile.tsv standard.tsv miscible.tsv NAME.relax.tsv: shells of a tenth of the radius
# that are farther than a support from the surface and from the core-mantle boundary; those nearest to that, the first layer on either side (within 0.6 spacings).
FILENAME ~ /profile.tsv$/ { if (/^#/) next; r[++rows] = $1; p[rows] = $4; if (rows > 1 && $11 != layer) { boundary = $1; at = $4 } layer = $11; next }
FILENAME ~ /relax.tsv$/ && FNR == 1 { for (k = 1; k <= NF; k++) { name = $k; sub(/\[.*/, "", name); sub(/^# /, "", name); column[name] = k }; next }
FILENAME ~ /relax.tsv$/ { v = $column["v_rms"]; reach = $column["reach"]; next }
/^#/ { which = FILENAME ~ /standard/ ? "standard" : "miscible"; next }
{
  off = $3/pressure($2) - 1; d = $2 - boundary; h = $5
  if (d*d < h*h/15) { near[which, $1] += off; jump[which, $1] += off*pressure($2)/at; number[which, $1]++ }
  else if (d*d > h*h && $2 + h < r[rows]) { b = int(10*$2/r[rows]); if (b >= 1 && b < 9) { sum[which, b] += off; count[which, b]++ } }
}
function pressure(x,   low, high, mid) {
  low = 1; high = rows
  while (high - low > 1) { mid = int((low + high)/2); if (r[mid] <= x) low = mid; else high = mid }
  return r[high] > r[low] ? p[low] + (p[high] - p[low])*(x - r[low])/(r[high] - r[low]) : p[low]
}
function close_to(what, ours, reference) { claim(what, ours, reference*0.995, reference*1.005, reference, "own integration, Tillotson isentropes") }
END {
  title("A proto-Earth of iron and granite, " n " particles")
  close_to("structure: pressure at the centre [GPa]", p[1]/1e9, 429.4)
  close_to("structure: radius [km]", r[rows]/1e3, 5996.5)
  close_to("structure: radius of the core [km]", boundary/1e3, 3046.4)
  close_to("structure: pressure at its boundary [GPa]", at/1e9, 164.7)
  fact("speed of escape [km/s]", sqrt(2*6.6743e-11*0.9*5.9722e24/r[rows])/1e3, "10.94", "")
  for (j = split("standard miscible", both, " "); j; j--) {
    w = both[j]; worst = 0; wide = n < 20000 ? 0.08 : 0.05
    for (b = 1; b < 9; b++) if (count[w, b]) worst = max(worst, abs(sum[w, b]/count[w, b]))
    for (m = 0; m < 2; m++) { side[m] = near[w, m]/number[w, m]; J[m] = jump[w, m]/number[w, m] }
    claim(w ": pressure off the structure's, worst shell away from the boundary", worst, 0, wide, "0", "")
    if (w == "miscible") {
      claim(w ": the same at the boundary, worse side", max(abs(side[0]), abs(side[1])), 0, wide, "0", "")
      claim(w ": jump of pressure over that at the boundary", J[1] - J[0], -0.08, 0.08, "0", "")
    } else {
      claim(w ": iron at the boundary, off over the pressure there", J[0], -1e300, -0.15, "-0.25", "planar layers by a kernel sum: standard SPH errs")
      claim(w ": granite at the boundary, likewise", J[1], 0.15, 1e300, "0.32", "planar layers by a kernel sum: standard SPH errs")
      claim(w ": jump of pressure over that at the boundary", J[1] - J[0], 0.3, 1e300, "0.57", "planar layers by a kernel sum")
    }
  }
  claim("by continuity, at rest: rms speed over that of escape", v, 0, 0.01, "0", "")
  claim("by continuity: outermost particle off the radius, in supports", abs(reach - r[rows])/support(), 0, 1, "0", "")
}
function support() { return 2.39*(4.18879*r[rows]^3/n)^(1/3) }
