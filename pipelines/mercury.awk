# SPDX-License-Identifier: GPL-3.0-or-later
# awk -f verdict.awk -f mercury.awk -v errors=FILE -v axis=FILE near.tsv end.tsv... conserved.tsv...: against linear acoustics,
#   p = sum a_m a_n sin(m pi x/L) sin(n pi y/L) cos(c pi/L sqrt(m^2 + n^2) t), odd m and n; even ones vanish, and beyond 61 all is below 1e-9.
BEGIN {
  pi = atan2(0, -1); L = 0.1; c = 1450; s = 4e-3; top = 61
  for (m = 1; m <= top; m += 2) a[m] = (m % 4 == 1 ? 1 : -1)*2/L*s*sqrt(2*pi)*exp(-(m*pi*s/L)^2/2)
  split("10 20 30 40", place, " "); split("5.25 12.25 19.25 26.00", when, " "); split("2.276 1.647 1.354 1.179", high, " ")
}
# The exact pressure [MPa] at every cell of a quarter of the lattice of n by n, at time t.
function field(n, t,   i, j, m, q, half, sum) {
  half = int((n + 1)/2); delete P; delete A; delete S
  for (i = 0; i < half; i++) for (m = 1; m <= top; m += 2) S[i, m] = sin(m*pi*(i + 0.5)/n)
  for (m = 1; m <= top; m += 2) for (q = 1; q <= top; q += 2) A[m, q] = 10*a[m]*a[q]*cos(c*pi/L*sqrt(m*m + q*q)*t)
  for (i = 0; i < half; i++) {
    for (q = 1; q <= top; q += 2) { sum = 0; for (m = 1; m <= top; m += 2) sum += S[i, m]*A[m, q]; B[q] = sum }
    for (j = 0; j <= i; j++) { sum = 0; for (q = 1; q <= top; q += 2) sum += B[q]*S[j, q]; P[i, j] = P[j, i] = sum }
  }
}
function cell(x, n,   i) { i = int((x + L/2)/L*n); i = i < 0 ? 0 : i >= n ? n - 1 : i; return i < n/2 ? i : n - 1 - i }
FNR == 1 {
  if (FILENAME ~ /end.tsv/) runs++
  if (FILENAME ~ /conserved/) first = ""
}
/^#/ { if (FILENAME ~ /conserved/) for (k = 1; k <= NF; k++) { name = $k; sub(/^# /, "", name); sub(/\[.*/, "", name); at[name] = k }; next }
FILENAME ~ /near/ { if ($1 > 30) next; k = int($2*1e3 + 0.5); if (abs($2*1e3 - k) < 0.3) { series[k, $1] += $3; count[k, $1]++; last = max(last, $1) }; next }
FILENAME ~ /conserved/ {
  if (first == "") { first = $at["E_total"]; begun = $at["E_internal"] }
  moving = max(moving, $at["E_kinetic"]); drift = max(drift, abs($at["E_total"] - first)); next
}
FNR > 1 {
  if ($4 != now || runs != of) { now = $4; of = runs; n = int(L/$5 + 0.5); dx[runs] = $5; field(n, now*1e-6) }
  p = P[cell($1, n), cell($2, n)]; e[runs, now] += ($3 - p)^2; norm[runs, now] += p*p
}
# The first maximum of the series at k mm: time and height, by a parabola.
function peak(k,   t, l, m, r, b) {
  for (t = 1; t < last; t++) { m = series[k, t]/count[k, t]; if (t == 1 || m > P0) { P0 = m; b = t } }
  l = series[k, b - 1]/count[k, b - 1]; m = P0; r = series[k, b + 1]/count[k, b + 1]
  T0 = b + (l - r)/(2*(l - 2*m + r)); P0 = m - (l - r)^2/(8*(l - 2*m + r))
}
# The exact pressure [MPa] at (r, 0).
function exact(r, t,   m, q, sum) {
  for (m = 1; m <= top; m += 2) for (q = 1; q <= top; q += 2)
    sum += 10*a[m]*a[q]*sin(m*pi*(r + L/2)/L)*sin(q*pi/2)*cos(c*pi/L*sqrt(m*m + q*q)*t)
  return sum
}
END {
  title("Pressure wave in mercury: " runs " resolutions, finest spacing " dx[runs] " m")
  print "# spacing\t20 us\t40 us\t60 us" > errors
  for (j = 1; j <= runs; j++) {
    for (t = 20; t <= 60; t += 20) E[j, t] = sqrt(e[j, t]/norm[j, t])
    print dx[j] "\t" E[j, 20] "\t" E[j, 40] "\t" E[j, 60] > errors
  }
  for (j = 1; j <= runs; j++) {
    early = dx[j] > 3e-4 ? 0.05 : 0.03; late = dx[j] > 3e-4 ? 0.12 : 0.07 # coarser than 0.5 mm: for the order alone
    for (t = 20; t <= 60; t += 40) {
      name = "relative L2 error of p at " t " us, " dx[j]*1e3 " mm"
      if (dx[j] > 6e-4) fact(name, E[j, t], "0", "linear acoustics")
      else claim(name, E[j, t], 0, t == 20 ? early : late, "0", "linear acoustics")
    }
  }
  for (j = 1; j <= runs; j++) x[j] = E[j, 20]
  claim("order of convergence at 20 us", order(dx, x, runs), 0.9, 3, "1 with viscosity, else 2", "")
  for (j = 1; j <= runs; j++) x[j] = E[j, 60]
  claim("order of convergence at 60 us", order(dx, x, runs), 0.9, 3, "", "")
  for (k = 1; k <= 4; k++) {
    peak(place[k]); arrived[k] = T0
    if (k > 1) claim("time of the first peak at " place[k] " mm [us]", T0, when[k] - 0.4, when[k] + 0.4, when[k], "linear acoustics")
    fact("its height at " place[k] " mm [MPa]", P0, high[k], "linear acoustics")
  }
  speed = 20e3/(arrived[4] - arrived[2])
  if (dx[runs] > 3e-4) fact("speed of the peak from 20 to 40 mm [m/s]", speed, "1454.5", "linear acoustics") # judged from 0.25 mm on
  else claim("speed of the peak from 20 to 40 mm [m/s]", speed, 1454.5*0.99, 1454.5*1.01, "1454.5", "linear acoustics")
  claim("change of the total energy", drift/begun, 0, 1e-5, "0", "")
  fact("the same over the largest kinetic energy", drift/moving, "0", "")
  print "# t\tours and exact [MPa] at 0, 20, 40 mm" > axis
  for (t = 0; t <= last; t++) {
    printf "%d", t > axis
    for (k = 0; k <= 40; k += 20) printf "\t%.6g\t%.6g", count[k, t] ? series[k, t]/count[k, t] : 0, exact(k*1e-3, t*1e-6) > axis
    print "" > axis
  }
}
