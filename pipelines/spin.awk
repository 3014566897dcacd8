# SPDX-License-Identifier: GPL-3.0-or-later
# awk -f verdict.awk -f spin.awk -v dx=SPACING lattice/shape.tsv lattice/run/conserved.tsv disturbed/... raw/run/conserved.tsv
FNR == 1 { which = FILENAME ~ /disturbed\// ? "disturbed" : FILENAME ~ /raw\/run/ ? "raw" : "lattice"; lines = 0 }
/^#/ { if (!lines++) for (k = 1; k <= NF; k++) { name = $k; sub(/^# /, "", name); sub(/\[.*/, "", name); at[name] = k }; next }
FILENAME ~ /shape/ {
  if (FNR == 1) { a[which] = $2; b[which] = $3 }
  off[which] = max(off[which], max(abs($2/a[which] - 1), abs($3/b[which] - 1))); stress[which] = max(stress[which], $4); next
}
{
  if (!(which in L)) { L[which] = $at["L_z"]; E[which] = $at["E_total"] }
  dL[which] = max(dL[which], abs($at["L_z"]/L[which] - 1)); dE[which] = max(dE[which], abs($at["E_total"]/E[which] - 1))
}
END {
  title("A rotating elastic sphere, spacing " dx ", one turn")
  source = "other code, spacing 0.2"
  claim("lattice: change of the angular momentum over it", dL["lattice"], 0, 1e-4, "1.3e-5", source)
  claim("disturbed: change of the angular momentum over it", dL["disturbed"], 0, 1e-2, "4.1e-3", source)
  claim("without the corrected gradient: angular momentum lost in a tenth of a turn", dL["raw"], 0.2, 1e300, "0.63", source)
  claim("lattice: change of the ratio of its axes", off["lattice"], 0, 0.005, "< 0.0039", "(omega R/c)^2")
  claim("disturbed: change of the ratio of its axes", off["disturbed"], 0, 0.005, "< 0.0039", "(omega R/c)^2")
  fact("lattice: largest deviatoric stress", stress["lattice"], "1.3e-3", source)
  fact("lattice: change of the energy over it", dE["lattice"], "0", "")
}
