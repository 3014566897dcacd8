# SPDX-License-Identifier: GPL-3.0-or-later
# awk -f verdict.awk -f ring.awk -v errors=FILE -v curves=FILE (LAW-DX/end.tsv LAW-DX/run/conserved.tsv)...: time (of the run's), spacing, r, mass.
# With nu = nu_0 r^g, k = 1 - g/2, tau = 12 k^2 nu_0 t: k/(pi tau) r^(-g - 1/4) exp(-(1 + r^2k)/tau) I_(1/4k)(2 r^k/tau). In rings of 0.1.
BEGIN { pi = atan2(0, -1); wide = 0.1; rings = 25 }
function gamma(x,   y) { return x < 9 ? gamma(x + 1)/x : sqrt(2*pi/x)*exp(x*log(x) - x + (1/12 - (1/360 - 1/1260/x^2)/x^2)/x) }
# I_l(z) exp(-z)
function bessel(l, z,   k, t, s) {
  if (z > 30) { for (k = s = t = 1; k < 12; k++) { t *= -(4*l*l - (2*k - 1)^2)/(k*8*z); s += t } return s/sqrt(2*pi*z) }
  t = exp(l*log(z/2))/gamma(l + 1)
  for (k = s = 0; k < 100; k++) { s += t; t *= z*z/4/((k + 1)*(k + 1 + l)) }
  return s*exp(-z)
}
function exact(r, tau, g,   k) { k = 1 - g/2; return k/(pi*tau)*r^(-g - 0.25)*exp(-(1 - r^k)^2/tau)*bessel(0.25/k, 2*r^k/tau) }
function mass(b, tau, g,   j, m, r) { for (j = 0; j < 10; j++) { r = (b + (j + 0.5)/10)*wide; m += exact(r, tau, g)*2*pi*r*wide/10 } return m }
FNR == 1 {
  split(FILENAME, part, "/"); name = FILENAME; sub(/\/(end|run\/conserved).tsv$/, "", name); sub(/.*\//, "", name); law = name; sub(/-.*/, "", law)
  if (FILENAME ~ /end.tsv/) { n = ++runs[law]; if (law != last) { laws[++many] = law; last = law } } else first = ""
}
/^#/ { if (FILENAME ~ /conserved/) for (k = 1; k <= NF; k++) { name = $k; sub(/^# /, "", name); sub(/\[.*/, "", name); at[name] = k }; next }
FILENAME ~ /conserved/ { L = $at["L_z"]; if (first == "") first = L; turn = max(turn, abs(L/first - 1)); next }
{ dx[n] = $2; b = int($3/wide); M[law, n, $1, b] += $4; all[law, n, $1] += $4; far[law, n, $1] += $4*$3 }
END {
  title("A viscous ring: " runs[laws[1]] " resolutions, finest spacing " dx[n])
  print "# law\tt\tr\tsurface density\texact" > curves
  for (l = 1; l <= many; l++) {
    law = laws[l]; g = law == "alpha"; from = g ? 0.0045 : 0.018; to = g ? 0.0125 : 0.05
    for (t = 0; t <= 1; t += 0.5) for (b = 0; b < rings; b++) {
      m = mass(b, from + t*(to - from), g); x = (b + 0.5)*wide
      for (j = 1; j <= n; j++) e[l, j, t] += abs(M[law, j, t, b]/all[law, j, t] - m)
      print law "\t" t "\t" x "\t" M[law, n, t, b]/(2*pi*x*wide) "\t" m/(2*pi*x*wide) > curves
      if (t == 1) mean[l] += m*x
    }
  }
  print "# spacing\tnu constant\talpha c H" > errors
  for (j = 1; j <= n; j++) print dx[j] "\t" e[1, j, 1] "\t" e[2, j, 1] > errors
  wanted = dx[n] > 0.01 ? 0.05 : dx[n] > 0.005 ? 0.03 : 0.02
  for (l = 1; l <= many; l++) {
    name = laws[l] == "alpha" ? "alpha c H" : "nu constant"
    for (j = 1; j <= n; j++) x_[j] = e[l, j, 1]
    fact(name ": relative L1 error of the surface density at the start, finest", e[l, n, 0], "0", "placed on it")
    fact(name ": half way", e[l, n, 0.5], "0", "Lynden-Bell & Pringle (1974)")
    claim(name ": at the end", e[l, n, 1], 0, wanted, "0", "Lynden-Bell & Pringle (1974)")
    fact(name ": what it would be without viscosity", still(l), "", "start against end")
    fact(name ": mean radius at the end over the exact", far[laws[l], n, 1]/all[laws[l], n, 1]/mean[l], "1", "Lynden-Bell & Pringle (1974)")
    fact(name ": order of convergence", order(dx, x_, n), "", "particles leave their order within a turn")
  }
  claim("change of the angular momentum over it", turn, 0, 1e-4, "0", "")
}
function still(l,   b, s, g) { g = laws[l] == "alpha"; for (b = 0; b < rings; b++) s += abs(mass(b, g ? 0.0045 : 0.018, g) - mass(b, g ? 0.0125 : 0.05, g)); return s }
