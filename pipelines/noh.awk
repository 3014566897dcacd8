# SPDX-License-Identifier: GPL-3.0-or-later
# awk -f verdict.awk -f noh.awk -v n=N end.tsv conserved.tsv: mean densities by volume, of the shell behind the shock and of that before it.
/^#/ { if (FILENAME ~ /conserved/) for (k = 1; k <= NF; k++) { name = $k; sub(/^# /, "", name); sub(/\[.*/, "", name); at[name] = k }; next }
FILENAME ~ /conserved/ { e = $at["E_total"]; if (first == "") first = e; last = e; next }
$1 > 0.05 && $1 < 0.16 { m += $5; v += $5/$2; u += $5*$3 }
$1 < 0.03 { centre += $5; room += $5/$2 }
$1 > 0.26 && $1 < 0.34 { off += $2/(1 + 0.6/$1)^2; number++ }
END {
  title("Noh's implosion, " n " particles")
  wide = n < 4e5 ? 0.08 : n < 5e6 ? 0.04 : 0.02
  claim("mean density, 0.05 < r < 0.16", m/v, n < 4e5 ? 25 : n < 5e6 ? 45 : 55, 66, "64", "Noh (1987)")
  fact("density, r < 0.03 (wall heating)", centre/room, "64", "Noh (1987)")
  fact("mean energy, 0.05 < r < 0.16", u/m, "0.5", "Noh (1987)")
  claim("density over (1 + t/r)^2 before the shock", off/number, 1 - wide, 1 + wide, "1", "Noh (1987)")
  claim("change of the total energy", abs(last/first - 1), 0, 1e-3, "0", "")
}
