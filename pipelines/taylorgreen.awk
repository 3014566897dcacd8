# SPDX-License-Identifier: GPL-3.0-or-later
# awk -f verdict.awk -f taylorgreen.awk -v errors=FILE end.tsv... conserved.tsv...: the rate from the kinetic energy until t = 0.05, the field at 0.05.
FNR == 1 { if (FILENAME ~ /end.tsv/) runs++; else { logs++; first = "" } }
/^#/ { if (FILENAME ~ /conserved/) for (k = 1; k <= NF; k++) { name = $k; sub(/^# /, "", name); sub(/\[.*/, "", name); at[name] = k }; next }
FILENAME ~ /conserved/ {
  if (first == "") { first = $at["E_total"]; e0 = $at["E_kinetic"] }
  drift = max(drift, abs($at["E_total"] - first)/e0); p = max(p, max(abs($at["p_x"]), abs($at["p_y"])))
  t = $at["time"]; v = log($at["E_kinetic"]/e0)/2; m[logs]++; sx[logs] += t; sy[logs] += v; sxx[logs] += t*t; sxy[logs] += t*v; next
}
{ dx[runs] = 1/$1; U = 0.5*exp(-0.05*rate()); e[runs] += ($4 - U*$2)^2 + ($5 - U*$3)^2; norm[runs] += U*U*($2*$2 + $3*$3) }
function rate() { return 8*atan2(0, -1)^2*0.5 }
END {
  title("Taylor-Green vortices at Re = 1: " runs " resolutions, finest 1/" 1/dx[runs])
  print "# spacing\trate\tvelocities, L2" > errors
  for (j = 1; j <= runs; j++) {
    ours[j] = -(m[j]*sxy[j] - sx[j]*sy[j])/(m[j]*sxx[j] - sx[j]*sx[j])
    off[j] = abs(ours[j]/rate() - 1); E[j] = sqrt(e[j]/norm[j])
    print dx[j] "\t" off[j] "\t" E[j] > errors
    fact("decay rate of the speeds [1/s], 1/" 1/dx[j], ours[j], sprintf("%.4f", rate()), "2 nu k^2")
    fact("relative L2 error of the velocities at t = 0.05, 1/" 1/dx[j], E[j], "0", "exact")
  }
  wide = dx[runs] > 1/128 ? 0.05 : dx[runs] > 1/256 ? 0.03 : 0.02
  claim("decay rate of the speeds [1/s], finest", ours[runs], rate()*(1 - wide), rate()*(1 + wide), sprintf("%.4f", rate()), "Taylor & Green (1937)")
  claim("relative L2 error of the velocities at t = 0.05, finest", E[runs], 0, 2*wide, "0", "exact")
  claim("order of convergence of the velocities", order(dx, E, runs), 0.8, 3, "", "")
  claim("change of the total energy over the kinetic", drift, 0, 1e-3, "0", "")
  claim("momentum", p, 0, 1e-9, "0", "of 1000 kg that move at 0.5 m/s")
}
