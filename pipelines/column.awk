# SPDX-License-Identifier: GPL-3.0-or-later
# awk -f verdict.awk -f column.awk -v n=N end.tsv...: aspect, x, y, speed, heap of the sand at the end. The front: the outer edge of the farthest grain.
# Grains part from the main mass: `joined`, of those in its heap, is a front that does not hang on single ones.
FNR == 1 { runs++ }
/^#/ { next }
{
  a[runs] = $1; number[runs]++; front[runs] = max(front[runs] + 0, $2 + 0.05/n); if ($5 == 1) joined[runs] = max(joined[runs] + 0, $2 + 0.05/n)
  if ($2 < 0.2/n) high[runs] = max(high[runs] + 0, $3); fast[runs] += $4*$4; depth[runs, int($2/0.01)] += 0.01/n/n/0.01
}
# How far the sand is 1 cm deep [m], from the depths of bins of 1 cm.
function deep(j,   k) {
  k = int(front[j]/0.01); while (k && depth[j, k] < 0.01) k--
  return 0.01*(k + 0.5 + (depth[j, k] - 0.01)/(depth[j, k] - depth[j, k + 1]))
}
END {
  title("Collapsing columns of sand, " n " particles across")
  for (j = 1; j <= runs; j++) {
    run = (front[j] - 0.1)/0.1; h = (high[j] + 0.05/n)/0.1; what = ", height/width " a[j]
    claim("run-out over the width" what, run, 1.2*a[j]*0.8, 1.2*a[j]*1.2, 1.2*a[j], "1.2 a, Lube et al. (2005)")
    fact("the same, of grains that touch the main mass" what, (joined[j] - 0.1)/0.1, "", "run-out as in Kumar (2015), thesis, Cambridge, chapter 4")
    fact("the same, to where the sand is 0.1 of the width deep" what, (deep(j) - 0.1)/0.1, "", "")
    claim("height at the wall over the width" what, h, 0.85*a[j], 1.02*a[j], a[j], "Lube et al. (2005)")
    claim("rms speed at the end [m/s]" what, sqrt(fast[j]/number[j]), 0, 0.02, "0: at rest", "")
  }
}
