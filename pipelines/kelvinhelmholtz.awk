# SPDX-License-Identifier: GPL-3.0-or-later
# awk -f verdict.awk -f kelvinhelmholtz.awk -v n=N growth.tsv conserved.tsv...: the slope of ln(amplitude of v_y) between 3 and 10 times what it was least.
FNR == 1 { first = "" }
/^#/ { for (k = 1; k <= NF; k++) { name = $k; sub(/^# /, "", name); sub(/\[.*/, "", name); at[name] = k }; next }
FILENAME ~ /growth.tsv/ { t[++points] = $1; a[points] = log($2); if (points == 1 || a[points] < low) { low = a[points]; from = points } next }
{
  e = $at["E_total"]; x = $at["p_x"]; y = $at["p_y"]
  if (first == "") { first = e; x0 = x; y0 = y }
  drift = max(drift, abs(e/first - 1)); p = max(p, max(abs(x - x0), abs(y - y0)))
}
END {
  for (k = from; k <= points && a[k] < low + log(10); k++) if (a[k] > low + log(2)) { m++; sx += t[k]; sy += a[k]; sxx += t[k]^2; sxy += t[k]*a[k] }
  U = 0.5; d = 0.0317; kd = 4*atan2(0, -1)*d
  rayleigh = U/(2*d)*sqrt(exp(-4*kd) - (1 - 2*kd)^2)
  title("Kelvin-Helmholtz instability, " n "^2 particles")
  fact("growth rate", m > 1 ? (m*sxy - sx*sy)/(m*sxx - sx*sx) : 0, sprintf("%.4g", rayleigh), "Rayleigh (1880), incompressible")
  claim("amplitude of v_y at the end over the least", exp(a[points] - low), 5, 1e300, "it rolls up", "")
  claim("change of the total energy, all runs", drift, 0, 1e-3, "0", "")
  claim("change of the momentum, all runs", p, 0, 1e-12, "0", "of 1 kg that moves at 1/2 m/s")
}
