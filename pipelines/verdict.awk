# SPDX-License-Identifier: GPL-3.0-or-later
# Verdicts of experiments. As a library (awk -f verdict.awk -f sod.awk ...): title() heads a table, claim() is a row of it. By itself
# with -v show=1 VERDICT.TSV: the table as a person reads it; exit 1 when a claim does not hold.
#   claim(what, ours, low, high, reference, source): holds when low <= ours <= high; reference and source as text ("" for none).
#   fact(what, ours, reference, source): a number to look at, not judged.

function title(text) { print "# " text; print "# quantity\tours\tlow\thigh\tverdict\treference\tsource" }
# What is not a number holds nothing, whatever an awk's comparisons make of it.
function claim(what, ours, low, high, reference, source,   holds) {
  holds = sprintf("%g", ours) !~ /nan/ && ours >= low && ours <= high
  printf "%s\t%.6g\t%.6g\t%.6g\t%s\t%s\t%s\n", what, ours, low, high, (holds ? "ok" : "FAILED"), reference, source
}
function fact(what, ours, reference, source) { printf "%s\t%.6g\t\t\tn/a\t%s\t%s\n", what, ours, reference, source }
function abs(x) { return x < 0 ? -x : x }
function max(a, b) { return a > b ? a : b }
function min(a, b) { return a < b ? a : b }
# The order of convergence: the slope of log(error) over log(spacing), by least squares through n points.
function order(spacing, error, n,   k, x, y, sx, sy, sxx, sxy) {
  for (k = 1; k <= n; k++) { x = log(spacing[k]); y = log(error[k]); sx += x; sy += y; sxx += x*x; sxy += x*y }
  return (n*sxy - sx*sy)/(n*sxx - sx*sx)
}

BEGIN { FS = "\t" }
show && FNR == 1 { sub(/^# /, ""); print; next }
show && /^#/ { printf "%-8s%-52s%14s  %-30s%s\n", "", "", "ours", "asked", "reference"; next }
show {
  asked = $5 == "n/a" ? "" : $3 <= -1e300 ? "<= " $4 : $4 >= 1e300 ? ">= " $3 : $3 " .. " $4
  printf "%-8s%-52s%14s  %-30s%s\n", $5, $1, $2, asked, $6 ($7 == "" ? "" : ($6 == "" ? "" : ", ") $7)
  failed += $5 == "FAILED"
}
END { if (show && failed) { print failed " of the claims do not hold" > "/dev/stderr"; exit 1 } }
