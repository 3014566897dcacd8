# SPDX-License-Identifier: GPL-3.0-or-later
# awk -f protoearth.awk profile.tsv standard.tsv miscible.tsv: how far the particles' pressure is from the structure's within half a
# support of the core-mantle boundary, on either side, and elsewhere; the jump is what the sides differ by. All over the pressure there.
BEGIN {
  FS = "\t"
  print "# within half a support of the core-mantle boundary: mean of p - p(r) of the structure, over the pressure there; rms of the same elsewhere"
  print "# density\tn_iron\tiron\tn_granite\tgranite\tjump\trms_elsewhere"
}
/^#/ { next }
FILENAME == ARGV[1] { r[++n] = $1; p[n] = $4; if (n > 1 && $11 != layer) { boundary = $1; at = $4 } layer = $11; next }
FNR == 2 && name { report() }
{ if (FNR == 2) { name = FILENAME; sub(/.*\//, "", name); sub(/\.tsv$/, "", name) }
  off = ($3 - pressure($2))/at; d = $2 - boundary
  if (d*d < $5*$5/4) { sum[$1] += off; number[$1]++ }
  else if ($2 > 0.1*r[n] && $2 + $5 < r[n] && d*d > $5*$5) { square += off*off; others++ } }
END {
  report()
  good = jump["standard"] > 0 && jump["miscible"]^2 < (0.25*jump["standard"])^2
  print (good ? "ok" : "FAILED") "\tmiscible leaves less than a quarter of the jump that standard SPH has"
}

function pressure(x,   low, high, mid) {
  low = 1; high = n
  while (high - low > 1) { mid = int((low + high)/2); if (r[mid] <= x) low = mid; else high = mid }
  return r[high] > r[low] ? p[low] + (p[high] - p[low])*(x - r[low])/(r[high] - r[low]) : p[low]
}
function report() {
  if (!number[0] || !number[1]) { print name ": too few particles at the boundary"; exit 1 }
  printf "%s\t%d\t%.4f\t%d\t%.4f\t%.4f\t%.4g\n", name, number[0], sum[0]/number[0], number[1], sum[1]/number[1],
    sum[1]/number[1] - sum[0]/number[0], others ? sqrt(square/others) : "nan"
  jump[name] = sum[1]/number[1] - sum[0]/number[0]
  delete sum; delete number; square = others = 0
}
