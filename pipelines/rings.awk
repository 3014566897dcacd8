# SPDX-License-Identifier: GPL-3.0-or-later
# awk -f verdict.awk -f rings.awk -v dx=SPACING, then of both runs motion.tsv pairs.tsv pieces.tsv run/conserved.tsv.
FNR == 1 { path = FILENAME; which = path ~ /without\// ? "without" : "with"; lines = 0; sub(/.*\//, "", path) }
path == "conserved.tsv" && /^#/ { if (!lines++) for (k = 1; k <= NF; k++) { name = $k; sub(/^# /, "", name); sub(/\[.*/, "", name); at[name] = k }; next }
/^#/ { next }
path == "motion.tsv" { velocity[which] = $2; if (!(which in width) || $3 < width[which]) { width[which] = $3; when[which] = $1 } next }
path == "pairs.tsv" { if (!(which in close_to) || $1 < close_to[which]) close_to[which] = $1; next }
path == "pieces.tsv" { pieces[which]++; next }
{
  if (!(which in energy)) energy[which] = $at["E_total"]
  drift[which] = max(drift[which], abs($at["E_total"]/energy[which] - 1)); momentum[which] = max(momentum[which], abs($at["p_x"])); spin[which] = max(spin[which], abs($at["L_z"]))
}
END {
  title("Rings of rubber, spacing " dx " of the ring's thickness")
  reference = "-0.735"; source = "other code, spacing 0.1; no published value"
  claim("with artificial stress: v/v0 of a ring at the end", velocity["with"], -0.85, dx > 0.09 ? -0.6 : -0.65, reference, source)
  claim("with: pieces at the end", pieces["with"], 2, 2, "2", "they bounce: Monaghan (2000)")
  claim("with: closest pair, in spacings", close_to["with"], 0.5, 1e300, "0.70", source)
  fact("with: least width of a ring", width["with"], "4.68 at t = 58.7", source)
  fact("with: at t", when["with"], "", "")
  claim("without: v/v0 at the end", velocity["without"], -0.35, 1e300, "-0.01", source)
  claim("without: closest pair, in spacings", close_to["without"], 0, 0.4, "0.25", source)
  fact("without: pieces at the end", pieces["without"], "", "they break: Schaefer et al. (2016), figure 1")
  m = 3.14159265*7*0.059
  for (k = split("with without", both, " "); k; k--) {
    claim(both[k] ": total momentum over that of a ring", momentum[both[k]]/m, 0, 1e-12, "0", "")
    claim(both[k] ": angular momentum over 4 m v of a ring", spin[both[k]]/(4*m), 0, 1e-9, "0", "")
    claim(both[k] ": change of the total energy over it", drift[both[k]], 0, 1e-3, "0", "")
  }
}
