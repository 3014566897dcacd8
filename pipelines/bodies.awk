# SPDX-License-Identifier: GPL-3.0-or-later
# awk -f bodies.awk NAME.relax.tsv...: what each relaxation reached, and whether that is rest: in the damped run and in the proof run
# after it, rms speeds below 0.3 % of the escape speed, the outermost particle within half a spacing of the surface, and density
# within 1 % rms of the structure's. These are of first order in the spacing: below 100 000 particles the limits grow with it.
# Densities summed over neighbours lack some at surfaces: they are judged away from these. Exit 1 when one fails.
# With -v judge=no only the numbers.
BEGIN {
  FS = OFS = "\t"
  print "# body", "run", "particles", "free falls", "rms v/v_esc", "99.9 % v/v_esc", "rho off rms", "inside", "limit", "outermost - R [spacings]", ""
}
FNR == 1 { for (k = 1; k <= NF; k++) { name = $k; sub(/\[.*/, "", name); column[name] = k }
  body = FILENAME; sub(/.*\//, "", body); sub(/\.relax\.tsv$/, "", body); next }
{
  n = get("n"); coarse = n < 1e5 ? (1e5/n)^(1/3) : 1; limit = 0.01*coarse
  off = body ~ /-(sum|miscible)$/ ? get("rho_off_inside") : get("rho_off")
  beyond = (get("reach") - get("equator"))/get("spacing") - 0.5; why = ""
  if (!(get("v_rms") < 0.003*coarse)) why = why " speed"
  if (!(beyond < 0.5 && beyond > -0.5)) why = why " radius"
  if (off == "nan") why = why " too few particles to tell the density"
  else if (!(off < limit)) why = why " density"
  if (why && judge != "no") failed = 1
  print body, $1, n, get("falls"), get("v_rms"), get("v_999"), get("rho_off"), get("rho_off_inside"), sprintf("%.2e", limit),
    sprintf("%.2f", beyond), judge == "no" ? "-" : why ? "FAILED" why : "ok"
}
END { exit failed }
function get(name) { return $column[name] }
