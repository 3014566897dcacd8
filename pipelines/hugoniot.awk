# SPDX-License-Identifier: GPL-3.0-or-later
# awk -f verdict.awk -f hugoniot.awk -v n=N -v points=FILE reference.tsv eos.tsv up500/end.tsv ...: the curves of the equation of state, row
# by row; of each run the pressure of the inner half of what is shocked (without the middle, where plates met) and the shock's speed.
/^#/ { next }
FILENAME ~ /hugoniot.tsv$/ { key = $1 " " $2; us[key] = $3; p[key] = $4; rho[key] = $5; next }
FILENAME ~ /eos.tsv$/ { key = $1 " " $2; worst = max(worst, max(abs($3/us[key] - 1), max(abs($4/p[key] - 1), abs($5/rho[key] - 1)))); rows++; next }
FNR == 2 { up = FILENAME; sub(/\/end.tsv$/, "", up); sub(/.*up/, "", up); run[++runs] = up }
{ x[runs, ++count[runs]] = $1; P[runs, count[runs]] = $2/1e9 }
END {
  title("Hugoniot curves; plates of " n " particles")
  claim("equation of state: largest deviation of Us, p, rho in " rows " states", worst, 0, 1e-4, "0 (printed to 4 digits)", "Rankine-Hugoniot equations")
  for (r = 1; r <= runs; r++) {
    up = run[r]; key = "aluminium " up; t = 0.5/(5413 + 0.358*up); far = (us[key] - up)*t; sum = m = edge = 0
    for (k = 1; k <= count[r]; k++) if (abs(x[r, k]) > 0.15*far && abs(x[r, k]) < 0.75*far) { sum += P[r, k]; m++ }
    mean = sum/m
    for (k = 2; k <= count[r]; k++) if (x[r, k] > 0 && P[r, k - 1] >= mean/2 && P[r, k] < mean/2)
      edge = x[r, k - 1] + (x[r, k] - x[r, k - 1])*(P[r, k - 1] - mean/2)/(P[r, k - 1] - P[r, k])
    shock = edge/t + up; wide = n < 1000 ? 0.02 : 0.01
    claim("plates, up = " up " m/s: pressure [GPa]", mean, p[key]*(1 - wide), p[key]*(1 + wide), p[key], "Rankine-Hugoniot equations")
    claim("plates, up = " up " m/s: Us [m/s]", shock, us[key]*0.985, us[key]*1.015, us[key], "Rankine-Hugoniot equations")
    fact("plates, up = " up " m/s: 5350 + 1.34 up", 5350 + 1.34*up, "", "measured for Al 6061")
    print up "\t" shock > points
  }
}
