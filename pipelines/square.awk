# SPDX-License-Identifier: GPL-3.0-or-later
# awk -f verdict.awk -f square.awk -v n=N (end.tsv conserved.tsv)...: conservation is judged; how round the square becomes is not.
# Lost: particles without another of their own kind within 1.7 of its spacings (cells are that wide; the box is periodic).
FNR == 1 {
  if (FILENAME ~ /end.tsv/) { k = split(FILENAME, part, "/"); names[++runs] = part[k - 1] } else first = ""
}
/^#/ { if (FILENAME ~ /conserved/) for (k = 1; k <= NF; k++) { name = $k; sub(/^# /, "", name); sub(/\[.*/, "", name); at[name] = k }; next }
FILENAME ~ /conserved/ {
  e = $at["E_total"]; if (first == "") first = e
  drift[runs] = max(drift[runs], abs(e/first - 1)); p[runs] = max(p[runs], max(abs($at["p_x"]), abs($at["p_y"]))); next
}
{
  number[runs]++; x[runs, number[runs]] = $1; y[runs, number[runs]] = $2; kind[runs, number[runs]] = $3
  if ($3) far[runs] = max(far[runs], sqrt($1*$1 + $2*$2))
  mean[runs] += $4; square[runs] += $4*$4
}
function wrap(a) { return a > 0.5 ? a - 1 : a < -0.5 ? a + 1 : a }
function lost(run,   i, j, a, b, c, m, reach, side, count, list, head, next_, near) {
  reach = 1.7/n; side = int(1/reach)
  for (i = 1; i <= number[run]; i++) {
    a = int((wrap(x[run, i]) + 0.5)*side) % side; b = int((wrap(y[run, i]) + 0.5)*side) % side
    next_[i] = head[a, b]; head[a, b] = i; A[i] = a; B[i] = b
  }
  for (i = 1; i <= number[run]; i++) {
    near = 0
    for (a = -1; a <= 1 && !near; a++) for (b = -1; b <= 1 && !near; b++)
      for (j = head[(A[i] + a + side) % side, (B[i] + b + side) % side]; j && !near; j = next_[j])
        if (j != i && kind[run, j] == kind[run, i] && wrap(x[run, i] - x[run, j])^2 + wrap(y[run, i] - y[run, j])^2 < reach^2) near = 1
    count += !near
  }
  return count
}
END {
  title("Square in pressure equilibrium at t = 4, " n "^2 particles")
  for (k = 1; k <= runs; k++) {
    name = names[k]; m = mean[k]/number[k]
    claim("change of the total energy, " name, drift[k], 0, 1e-3, "0", "")
    claim("momentum, " name, p[k], 0, 1e-12, "0", "")
    claim("particles lost in the other fluid, " name, lost(k), 0, 0, "0", "")
    fact("farthest of the square from its centre, " name, far[k], "0.3536", "at rest")
    fact("scatter of the pressure, " name, sqrt(max(0, square[k]/number[k] - m*m))/m, "0", "")
  }
}
