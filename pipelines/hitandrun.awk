# SPDX-License-Identifier: GPL-3.0-or-later
# awk -f verdict.awk -f hitandrun.awk -v n=N geometry.tsv fragments.tsv after.tsv conserved.tsv: columns go by their names.
FNR == 1 { part++; split("", at) }
part == 1 { if (!/^#/) orbit[$1] = $2; next }
part == 3 { if (/mean damage/) { sub(/.*mean damage /, ""); hit = $0 + 0 } next }
/^# (id|step)\t/ { sub(/^# /, ""); for (k = split($0, word, "\t"); k; k--) { sub(/ ?\[.*/, "", word[k]); at[word[k]] = k } next }
/^#/ { next }
part == 2 {
  rows++; m[rows] = $at["mass"]; ice[rows] = $at["water"]; broken[rows] = 100*$at["damage"]; own[rows] = $at["from_0"] > $at["from_1"]
  if (rows == 2) { v = $at["v_rel"]; limit = $at["v_rel/v_esc"] }
  total += m[rows]*ice[rows]/100; next
}
{
  Lx = $at["L_x"]; Ly = $at["L_y"]; Lz = $at["L_z"]; E = $at["E_total"]
  if (!lines++) { ax = Lx; ay = Ly; az = Lz; E0 = E; K0 = $at["E_kinetic"]; L0 = sqrt(Lx^2 + Ly^2 + Lz^2) }
  dL = max(dL, sqrt((Lx - ax)^2 + (Ly - ay)^2 + (Lz - az)^2)/L0); dE = max(dE, abs(E - E0)/K0)
}
END {
  M = orbit["MassTarget"] + orbit["MassImpactor"]; wet = own[1] ? 1 : 2; dry = 3 - wet; fine = n >= 100000
  title("Two bodies of the mass of Ceres, hit and run, " n " particles")
  points = "two point masses"; source = "Schaefer et al. (2016), table 3"
  claim("contact after the start [min]", -orbit["InitialTime"]/60, 231.5, 235.5, "233.5", points)
  claim("speed at contact [m/s]", orbit["ContactSpeed"], 884, 902, "893", points)
  claim("mass of the dry survivor over all", m[dry]/M, 0.4, 1, "0.506", source); claim("mass of the wet survivor over all", m[wet]/M, 0.4, 1, "0.486", source)
  claim("their speed over that of escape", limit, 1, 1e300, "8.9", source)
  claim("ice on the dry one [%]", ice[dry], fine ? 0.5 : 0.5, fine ? 3.5 : 6, "2", source)
  claim("ice on the wet one [%]", ice[wet], fine ? 25 : 20, fine ? 29 : 30, "27", source)
  if (fine) {
    claim("mass of the dry one [1e20 kg]", m[dry]/1e20, 9.55*0.985, 9.55*1.015, "9.55", source)
    claim("mass of the wet one [1e20 kg]", m[wet]/1e20, 9.17*0.985, 9.17*1.015, "9.17", source)
    claim("speed at which they part [m/s]", v, 542, 592, "567", source)
    claim("ice in what is listed [1e20 kg]", total/1e20, 2.73*0.96, 2.73*1.04, "2.73", source)
    claim("damage of the dry one [%]", broken[dry], 49, 73, "61", source); claim("damage of the wet one [%]", broken[wet], 58, 82, "70", source)
  } else {
    fact("speed at which they part [m/s]", v, "567", source); fact("damage of the dry one [%]", broken[dry], "61", source)
    fact("damage of the wet one [%]", broken[wet], "70", source)
  }
  fact("mean damage just after the impact [%]", 100*hit, "64.5", source)
  claim("change of the angular momentum over it", dL, 0, 1e-3, "0", "")
  claim("change of the energy over the kinetic energy", dE, 0, 0.01, "0", "")
}
