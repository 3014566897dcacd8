# SPDX-License-Identifier: GPL-3.0-or-later
# awk -f verdict.awk -f gradykipp.awk -v length_=M -v across=N -v k=K -v m=M -v curves=FILE count.tsv flaws.tsv rRATE/states.tsv...: time, x,
# damage, stress, h of each particle. Those that waves from the ends have not reached are compared with an integration of their own flaws:
# strain e = (K + 4/3 mu) r t/E, dD^(1/3)/dt = n c_g/h, D <= n/n_total (001 eq. 24, 46, 47).
BEGIN { bulk = 26.7e9; mu = 22.7e9; rho = 2700; young = 9*bulk*mu/(3*bulk + mu); stiff = bulk + 4/3*mu; cl = sqrt(stiff/rho) }
FILENAME ~ /count.tsv$/ { count[++n] = $1; begin[n] = all; all += $1; next }
FILENAME ~ /flaws.tsv$/ { flaw[++f] = $1; next }
FNR == 1 { finish(); rate = FILENAME; sub(/\/states.tsv$/, "", rate); sub(/.*\/r/, "", rate); t = -1; i = steps = 0; delete D; delete act; delete x0; worst = mean_off = top = model = 0 }
{
  if ($1 != t) { close_row(); before = t < 0 ? 0 : t; t = $1; i = 0; s = w = ours = other = number = 0 }
  i++
  if (!(i in x0)) x0[i] = $2
  h = $5
  if (length_/2 - abs(x0[i]) < cl*t*1.1 + 2*h) next
  grow(i, before, t)
  s += $4; ours += $3; other += D[i]^3; w += (1 - D[i]^3)*stiff*rate*t; number++; worst = max(worst, abs(D[i]^3 - $3))
}
function grow(i, from, to,   j, dt, e, a, limit) {
  dt = (to - from)/20
  for (j = 0; j < 20; j++) {
    e = stiff*rate*(from + (j + 0.5)*dt)/young; a = act[i]
    if (D[i] >= 1) return
    while (a < count[i] && flaw[begin[i] + a + 1] < e) a++
    act[i] = a; limit = (a/count[i])^(1/3)
    D[i] = max(D[i], min(limit, D[i] + a*0.4*sqrt((bulk + 4/3*mu*(1 - D[i]^3))/rho)/h*dt))
  }
}
function close_row() { if (number) { mean_off = max(mean_off, abs(ours - other)/number); top = max(top, s/number); model = max(model, w/number); print rate "\t" t "\t" s/number "\t" w/number > curves; fewest = number } }
function finish() { if (rate != "") { close_row(); R[++many] = rate; S[many] = top; W[many] = model; off[many] = worst; mean[many] = mean_off; left[many] = fewest; number = 0 } }
END {
  finish(); V = length_*across^2*1e-4; N = n
  title("Basalt stretched, " n " particles with " all " flaws")
  for (j = 1; j <= many; j++) {
    claim("rate " R[j] " 1/s: greatest mean stress [MPa]", S[j]/1e6, 0.97*W[j]/1e6, 1.03*W[j]/1e6, sprintf("%.4g", W[j]/1e6), "flaws integrated one by one")
    claim("rate " R[j] " 1/s: mean damage, largest difference", mean[j], 0, 0.03, "0", "the same")
    fact("rate " R[j] " 1/s: damage of one particle, largest difference", off[j], "0", "the same; they pull at each other")
    fact("rate " R[j] " 1/s: particles that waves have not reached", left[j], "", "")
    A = 8*3.14159265*(0.4*cl)^3*k/((m + 1)*(m + 2)*(m + 3)); tM = (A*R[j]^m*(m + 4))^(-1/(m + 3))
    fact("rate " R[j] " 1/s: homogeneous matter, sigma_max [MPa]", young*R[j]*tM*(m + 3)/(m + 4)/1e6, "other law: cracks that overlap", "Grady & Kipp (1980)")
  }
  fact("plateau at low rates, E e_max (m+1)^(-1/m) m/(m+1) [MPa]", young*(N*(log(N) + 0.577)/(k*V))^(1/m)*(m + 1)^(-1/m)*m/(m + 1)/1e6, "", "strongest flaw, depends on resolution")
}
