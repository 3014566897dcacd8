# SPDX-License-Identifier: GPL-3.0-or-later
# awk -f verdict.awk -f cloud.awk -v n=N density.tsv [density_LENGTH.tsv ...] arms.tsv conserved.tsv: log10 of the largest density at times
# between snapshots, also with softer gravity; the two densest condensations at 1.2 free-fall times, on either side of the centre.
/^#/ { if (FILENAME ~ /conserved/) for (k = 1; k <= NF; k++) { name = $k; sub(/^# /, "", name); sub(/\[.*/, "", name); at[name] = k }; next }
FILENAME ~ /density/ {
  if (FNR <= 2) { soft[++runs] = FILENAME; sub(/.*density_?/, "", soft[runs]); sub(/\.tsv/, "", soft[runs]) }
  t[runs, ++rows[runs]] = $1; d[runs, rows[runs]] = log($2)/log(10); next
}
FILENAME ~ /arms/ {
  parts++; X[parts] = $1; Y[parts] = $2; D[parts] = $3
  if ($3 > top) { top = $3; first = parts }
  next
}
{
  L = $at["L_z"]; x = $at["x"]; y = $at["y"]; z = $at["z"]
  if (L0 == "") { L0 = L; x0 = x; y0 = y; z0 = z }
  turn = max(turn, abs(L/L0 - 1)); drift = max(drift, sqrt((x - x0)^2 + (y - y0)^2 + (z - z0)^2)/3.2e14)
}
function rho(when, r,   k) {
  for (k = 2; k < rows[r] && t[r, k] < when; k++);
  return d[r, k - 1] + (d[r, k] - d[r, k - 1])*(when - t[r, k - 1])/(t[r, k] - t[r, k - 1])
}
END {
  title("Collapse of a rotating cloud, " n " particles")
  m = split("0.51 0.82 1.01 1.10", when, " "); split("3.64e-14 8.7e-14 3.05e-13 1.09e-12", probe, " ")
  for (k = 1; k <= m; k++) {
    wide = when[k] > 1.05 ? 0.3 : 0.1; r = log(probe[k])/log(10)
    if (n < 2e4) claim("log10 largest density at t/t_ff = " when[k], rho(when[k], 1), r - wide, r + wide, sprintf("%.3f", r), "another SPH code, 8217 particles, softening with h")
    else fact("log10 largest density at t/t_ff = " when[k], rho(when[k], 1), sprintf("%.3f", r), "with 8217 particles")
  }
  claim("largest density at 0.998 t_ff over that at the start", 10^(rho(0.998, 1) - d[1, 1]), n < 2e4 ? 10 : 25, 300, "almost 100", "Schaefer et al. (2016), 2e6 particles")
  for (k = 2; k <= runs; k++) fact("log10 largest density at t/t_ff = 1.10, softened by " soft[k] " R", rho(1.1, k), "", "")
  for (k = 2; k <= runs; k++)
    claim("largest density at 1.10 t_ff, softened by " (k > 2 ? soft[k - 1] " R" : "h") ", over that by " soft[k] " R", 10^(rho(1.1, k - 1) - rho(1.1, k)),
      k > 2 ? 1.8 : 1.3, 1e300, "falls with the length", "Schaefer et al. (2016), figure 4; another SPH code")
  for (k = 1; k <= parts; k++) if (X[k]*X[first] + Y[k]*Y[first] < 0 && (!other || D[k] > D[other])) other = k
  apart = sqrt((X[first] - X[other])^2 + (Y[first] - Y[other])^2)/3.2e14
  claim("condensations at 1.2 t_ff: distance from the centre, over R", apart/2, 0.05, 0.4, "0.05 to 0.4", "")
  fact("their distance from each other, over R", apart, "", "")
  claim("change of the angular momentum over it", turn, 0, 5e-4, "0", "")
  claim("drift of the centre of mass, over R", drift, 0, 1e-3, "0", "")
}
