# SPDX-License-Identifier: GPL-3.0-or-later
# awk -f verdict.awk -f treegravity.awk -v errors=FILE direct/pull.tsv tree0.3/pull.tsv ... *.profile: relative errors |a - a_direct| over
# the larger of |a_direct| and its mean (at the centre it vanishes); sorted errors of each angle go to FILE.
FILENAME ~ /profile$/ { name = FILENAME; sub(/.*\//, "", name); sub(/\.profile$/, "", name); if ($1 == "gravity") time[name] = $3; next }
FNR == 1 { runs++; name = FILENAME; sub(/\/pull.tsv$/, "", name); sub(/.*\//, "", name); way[runs] = name; n = 0 }
{ n++; size = sqrt($2^2 + $3^2 + $4^2); x += $2; y += $3; z += $4; scale += size }
runs == 1 { ax[n] = $2; ay[n] = $3; az[n] = $4; mean += (size - mean)/n; next }
{ a = max(sqrt(ax[n]^2 + ay[n]^2 + az[n]^2), mean); e[runs, n] = sqrt(($2 - ax[n])^2 + ($3 - ay[n])^2 + ($4 - az[n])^2)/a
  px[runs] += $2; py[runs] += $3; pz[runs] += $4; ps[runs] += size }
function sorted(r,   k, command) { # quantiles q[1..999] in thousandths
  command = "sort -g > " errors ".part"
  for (k = 1; k <= n; k++) print e[r, k] > (errors ".part.raw")
  close(errors ".part.raw"); system("sort -g " errors ".part.raw > " errors ".part")
  k = 0
  while ((getline line < (errors ".part")) > 0) { k++; v[k] = line }
  close(errors ".part"); system("rm " errors ".part " errors ".part.raw")
  for (k = 1; k <= 999; k++) q[r, k] = v[int(k*n/1000) + 1]
}
END {
  title("Gravity of the tree, " n " particles")
  print "# fraction, then the error below which it lies for each angle" > errors
  for (r = 2; r <= runs; r++) sorted(r)
  for (k = 1; k <= 999; k++) { row = k/1000; for (r = 2; r <= runs; r++) row = row "\t" q[r, k]; print row > errors }
  split("7e-5 8e-4 3e-3", half, " "); split("2e-4 2e-3 8e-3", most, " ")
  for (r = 2; r <= runs; r++) {
    theta[r - 1] = substr(way[r], 5); median[r - 1] = q[r, 500]
    if (theta[r - 1] == 0.5) { a = 8e-4; b = 2e-3 } else if (theta[r - 1] == 0.7) { a = 3e-3; b = 8e-3 } else a = b = 0
    if (a) {
      claim("theta " theta[r - 1] ": median error", q[r, 500], 0, a, "", "validation of quadrupoles at this angle")
      claim("theta " theta[r - 1] ": error of 90 %", q[r, 900], 0, b, "", "")
    } else fact("theta " theta[r - 1] ": median error", q[r, 500], "", "")
    c = 0; for (k = 1; k <= n; k++) c += e[r, k] < 1e-3
    fact("theta " theta[r - 1] ": part with errors below 1e-3", c/n, "0.9 at 0.7", "Reufer (2011), figure 2.10")
    claim("theta " theta[r - 1] ": net force over the sum of forces", sqrt(px[r]^2 + py[r]^2 + pz[r]^2)/ps[r], 0, 1e-3, "0", "")
    if (time["direct"] && time[way[r]]) fact("theta " theta[r - 1] ": times as fast as direct sums", time["direct"]/time[way[r]], "", "")
  }
  claim("order of the error in theta", order(theta, median, runs - 1), 3.4, 4.8, "4", "quadrupoles")
}
