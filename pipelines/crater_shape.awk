# SPDX-License-Identifier: GPL-3.0-or-later
# columns of x, y, z [m] of the target's dense particles (x, y > 0) | awk -v dx=SPACING -v every=T -v sheet=snap_NNNN.h5 -f crater_shape.awk
# One line: time of the snapshot [microseconds, T between two], depth and radius of the crater [mm]. Depth: in each column of one spacing, within
# three spacings of the axis, from the bottom upwards to the first gap of two spacings; their mean (the axis of a lattice is a place of its own).
# Radius: in the first two layers below the surface, from 3 cm inwards to such a gap, mean over the 4 sectors of a quarter.
BEGIN { pi = atan2(0, -1); sectors = 4 }
/^#/ { next }
{ r = sqrt($1^2 + $2^2); a = int($1/dx); b = int($2/dx); c = a "," b }
(a + 0.5)^2 + (b + 0.5)^2 < 9 { z[c, ++n[c]] = $3 }
$3 < 0.3*dx && $3 > -2.2*dx && r < 0.03 { s = int(atan2($2, $1)/(pi/2)*sectors); rim[s, ++many[s]] = r }
function sort(a, s, n,   i, j, x) { for (i = 2; i <= n; i++) { x = a[s, i]; for (j = i - 1; j && a[s, j] > x; j--) a[s, j + 1] = a[s, j]; a[s, j + 1] = x } }
END {
  for (c in n) {
    sort(z, c, n[c])
    for (k = 1; k < n[c] && z[c, k + 1] - z[c, k] < 2*dx; k++);
    depth += -z[c, k] - dx/2; columns++
  }
  depth /= columns
  for (s = 0; s < sectors; s++) {
    sort(rim, s, many[s])
    for (k = many[s]; k > 1 && rim[s, k] - rim[s, k - 1] < 2*dx; k--);
    mean += (rim[s, k] - dx/2)/sectors
  }
  sub(/.*snap_/, "", sheet)
  printf "%g\t%.3f\t%.3f\n", sheet*every, 1e3*(depth > 0 ? depth : 0), 1e3*(depth > dx ? mean : 0)
}
