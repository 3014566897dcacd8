# SPDX-License-Identifier: GPL-3.0-or-later
# awk -f verdict.awk -f cloud.awk -v n=N density.tsv arms.tsv conserved.tsv: log10 of the largest density at times between snapshots; the
# two densest condensations at 1.2 free-fall times, on either side of the centre.
/^#/ { if (FILENAME ~ /conserved/) for (k = 1; k <= NF; k++) { name = $k; sub(/^# /, "", name); sub(/\[.*/, "", name); at[name] = k }; next }
FILENAME ~ /density/ { t[++rows] = $1; d[rows] = log($2)/log(10); next }
FILENAME ~ /arms/ {
  parts++; X[parts] = $1; Y[parts] = $2; D[parts] = $3
  if ($3 > top) { top = $3; first = parts }
  next
}
{ L = $at["L_z"]; if (L0 == "") L0 = L; turn = max(turn, abs(L/L0 - 1)) }
function rho(when,   k) { for (k = 2; k < rows && t[k] < when; k++); return d[k - 1] + (d[k] - d[k - 1])*(when - t[k - 1])/(t[k] - t[k - 1]) }
END {
  title("Collapse of a rotating cloud, " n " particles")
  m = split("0.51 0.82 1.01 1.10", when, " "); split("3.64e-14 8.7e-14 3.05e-13 1.09e-12", probe, " ")
  for (k = 1; k <= m; k++) {
    wide = when[k] > 1.05 ? 0.3 : 0.1; r = log(probe[k])/log(10)
    if (n < 2e4) claim("log10 largest density at t/t_ff = " when[k], rho(when[k]), r - wide, r + wide, sprintf("%.3f", r), "another SPH code, 8217 particles, softening with h")
    else fact("log10 largest density at t/t_ff = " when[k], rho(when[k]), sprintf("%.3f", r), "with 8217 particles")
  }
  claim("largest density at 0.998 t_ff over that at the start", 10^(rho(0.998) - d[1]), n < 2e4 ? 10 : 25, 300, "almost 100", "Schaefer et al. (2016), 2e6 particles")
  for (k = 1; k <= parts; k++) if (X[k]*X[first] + Y[k]*Y[first] < 0 && (!other || D[k] > D[other])) other = k
  apart = sqrt((X[first] - X[other])^2 + (Y[first] - Y[other])^2)/3.2e14
  claim("condensations at 1.2 t_ff: distance from the centre, over R", apart/2, 0.05, 0.4, "0.05 to 0.4", "")
  fact("their distance from each other, over R", apart, "", "")
  claim("change of the angular momentum over it", turn, 0, 5e-4, "0", "")
}
