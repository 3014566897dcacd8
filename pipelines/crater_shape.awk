# SPDX-License-Identifier: GPL-3.0-or-later
# columns of x, y, z [m], m [kg] of the target's dense particles | awk -v dx=SPACING -v every=T -v sheet=snap_NNNN.h5 -f crater_shape.awk
# One line: time of the snapshot [microseconds, T between two], depth and radius of the crater [mm], from the volume that is left, m over 2700 kg/m^3:
# it knows no rows of a lattice. Depth: mean within three spacings of the axis, from 22 mm upwards to the first two spacings without a particle.
# Radius: of the hole in the layer from two spacings below the surface up to it, within 20 mm.
BEGIN { pi = atan2(0, -1); rho = 2700; bottom = -0.022; wide = 0.02; near = 3*dx; thick = 2*dx }
/^#/ { next }
{ r = sqrt($1^2 + $2^2) }
r < near && $3 > bottom { z[++n] = $3; m[n] = $4 }
r < wide && $3 <= 0 && $3 > -thick { layer += $4 }
function sort(   i, j, x, y) {
  for (i = 2; i <= n; i++) { x = z[i]; y = m[i]; for (j = i - 1; j && z[j] > x; j--) { z[j + 1] = z[j]; m[j + 1] = m[j] } z[j + 1] = x; m[j + 1] = y }
}
END {
  sort()
  for (k = 1; k <= n && (k == 1 || z[k] - z[k - 1] < 2*dx); k++) core += m[k]
  depth = -bottom - core/(rho*pi*near^2); hole = pi*wide^2 - layer/(rho*thick)
  sub(/.*snap_/, "", sheet)
  printf "%g\t%.3f\t%.3f\n", sheet*every, 1e3*(depth > 0 ? depth : 0), 1e3*(hole > 0 && depth > dx ? sqrt(hole/pi) : 0)
}
