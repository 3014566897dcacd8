# SPDX-License-Identifier: GPL-3.0-or-later
# awk -f verdict.awk -f crater.awk -v dx=MM Y276/shape.tsv Y100/shape.tsv conserved.tsv: the crater as the mean of the last five microseconds.
/^#/ { if (FILENAME ~ /conserved/) for (k = 1; k <= NF; k++) { name = $k; sub(/^# /, "", name); sub(/\[.*/, "", name); at[name] = k }; next }
FILENAME ~ /conserved/ { e = $at["E_total"]; if (first == "") first = e; last = e; next }
FNR == 1 { which = FILENAME; sub(/\/shape.tsv$/, "", which); sub(/.*Y/, "", which); rows = 0 }
{ rows++; t[which, rows] = $1; d[which, rows] = $2; r[which, rows] = $3; all[which] = rows }
function mean(a, y,   k, s, n) { for (k = all[y]; t[y, k] > t[y, all[y]] - 4.9; k--) { s += a[y, k]; n++ } return s/n }
END {
  title("Aluminium into aluminium at 7 km/s, spacing " dx " mm")
  depth = mean(d, 276); radius = mean(r, 276); soft = mean(d, 100)
  low = dx > 1.1 ? 9 : dx > 0.8 ? 12.8*0.75 : 12.8*0.85; high = dx > 1.1 ? 18 : dx > 0.8 ? 12.8*1.25 : 12.8*1.15
  claim("depth, Y = 276 MPa [mm]", depth, low, high, "12.8", "Cour-Palais and Christiansen, 6061-T6")
  fact("depth, Y = 100 MPa [mm]", soft, "18.3", "Cour-Palais and Christiansen, 1100-O")
  claim("depth at 100 MPa over that at 276 MPa", soft/depth, 1.25, 1.5, "1.40", "(276/100)^(1/3)")
  claim("depth over radius, Y = 276 MPa", depth/radius, 0.9, 1.3, "1", "")
  fact("radius in the plane of the surface [mm]", radius, "12.5 to 13", "")
  claim("change of the total energy over it", abs(last/first - 1), 0, 0.01, "0", "")
}
