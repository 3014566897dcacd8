# SPDX-License-Identifier: GPL-3.0-or-later
# awk -f verdict.awk -f poiseuille.awk -v errors=FILE nN/end.tsv...: t nu/L^2, N, y, v_x, v_y of the fluid: its velocity against the series.
BEGIN { pi = atan2(0, -1); times = split("0.05 0.1 0.2 0.5", when, " ") }
# in F L^2/nu: 1/8 (1 - 4 y^2) - sum over odd m of 4/(m pi)^3 (-1)^((m - 1)/2) cos(m pi y) exp(-(m pi)^2 t)
function exact(y, t,   m, v, s) {
  v = (1 - 4*y*y)/8; s = 1
  for (m = 1; m < 40; m += 2) { v -= s*4/(m*pi)^3*cos(m*pi*y)*exp(-(m*pi)^2*t); s = -s }
  return v
}
/^#/ { next }
{
  if (!($2 in seen)) { seen[$2] = 1; dx[++runs] = 1/$2 }
  v = 4*exact($3, $1); e[runs, $1] += ($4 - v)^2; norm[runs, $1] += v*v; across[runs] = max(across[runs] + 0, abs($5))
  if (abs($3) < 0.75/$2) { top[runs, $1] += $4; of[runs, $1] += v }
}
END {
  title("Plane Poiseuille flow: " runs " resolutions, finest 1/" 1/dx[runs])
  printf "# spacing" > errors
  for (k = 1; k <= times; k++) printf "\tt = %s L^2/nu", when[k] > errors
  print "" > errors
  for (j = 1; j <= runs; j++) {
    row = dx[j]
    for (k = 1; k <= times; k++) row = row "\t" (E[j, k] = sqrt(e[j, when[k]]/norm[j, when[k]]))
    print row > errors
  }
  wide = dx[runs] > 1/80 ? 0.05 : dx[runs] > 1/160 ? 0.03 : 0.02
  for (k = 1; k <= times; k++) {
    name = " at t = " when[k] " L^2/nu"
    for (j = 1; j <= runs; j++) x[j] = E[j, k]
    claim("relative L2 error of the velocity" name ", finest", x[runs], 0, wide, "0", "series, Morris et al. (1997)")
    claim("order of convergence" name, order(dx, x, runs), 0.8, 3, "1 at walls, else 2", "")
  }
  claim("velocity in the middle over the exact, t = 0.5 L^2/nu", top[runs, "0.5"]/of[runs, "0.5"], 1 - wide, 1 + wide, "1", "")
  fact("velocity across the channel over that along it, greatest of the finest", across[runs]/0.5, "0", "")
}
