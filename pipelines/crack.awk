# SPDX-License-Identifier: GPL-3.0-or-later
# columns of x, y, damage, pressure, stress (xx), v_x | awk -v dx=SPACING -f crack.awk: greatest damage, mean |x| of it, mean stress at
# |x| = 0.6, part of the width that a chain of damage over 0.9 takes at its widest, where that is, mean |v_x| of the quarters outside.
/^#/ { next }
{
  if ($3 > most) { most = $3; where = $1 }
  x = $1 < 0 ? -$1 : $1
  if (x > 0.55 && x < 0.65) { s += $5 - $4; n++ }
  if (x > 0.75 && x < 1.1) { v += $1 < 0 ? -$6 : $6; m++ }
  if ($3 > 0.9) { b = int($2/dx); if (!((b) in hit)) rows++; hit[b] = 1; place += $1; broken++ }
}
END { printf "%.6g\t%.6g\t%.6g\t%.6g\t%.6g\t%.6g\n", most, where, s/n, rows*dx, broken ? place/broken : 0, v/m }
