# SPDX-License-Identifier: GPL-3.0-or-later
# The report of a Ceres collision: awk -v run=DIR -v n=N -v least=N -v gravity=tree -f ceres.awk geometry.tsv before.tsv after.tsv
# fragments.tsv clumps.tsv conserved.tsv. Columns go by their names. The paper's numbers: Schaefer et al. (2016), A&A 590, A19,
# section 5 and table 3 (200 000 particles).

FNR == 1 { part++ }
part == 1 { if (!/^#/) asked[$1] = $2; next } # geometry.tsv: quantity, value
part == 6 { conserved(); next }
/^# id\t/ { name_columns(); next }
/^# .*: [0-9]+ fragments/ { total[part] = $0; sub(/.*: /, "", total[part]); next }
/^#.* mean damage/ { sub(/.* mean damage /, ""); damage[part] = 100 * $0; next }
/^#/ { next }
{
  rows[part]++
  for (c in column) if (split(c, key, SUBSEP) && key[1] == part) value[part, rows[part], key[2]] = $column[c]
}

# The names of the columns without their units: column[part, "mass"].
function name_columns(   i, word, names) {
  sub(/^# /, "")
  for (i = split($0, names, "\t"); i > 0; i--) {
    word = names[i]
    sub(/ ?\[.*/, "", word)
    column[part, word] = i
  }
}

# A line of conserved.tsv: first values, last values, largest deviations.
function conserved(   i, p, l, e) {
  if (/^#/) {
    if (!lines) name_columns()
    return
  }
  if (!lines++) for (i = 1; i <= NF; i++) first[i] = $i
  for (i = 1; i <= NF; i++) last[i] = $i
  p = norm(at("p_x"), at("p_y"), at("p_z"))
  l = norm(at("L_x") - at0("L_x"), at("L_y") - at0("L_y"), at("L_z") - at0("L_z"))
  e = abs(at("E_total") - at0("E_total"))
  if (p > drift["p"]) drift["p"] = p
  if (l > drift["L"]) drift["L"] = l
  if (e > drift["E"]) drift["E"] = e
  if (at("time") < 6e3) impact["L"] = drift["L"]
  time[lines] = at("time")
  heat[lines] = at("E_internal") - at0("E_internal")
  if (heat[lines] > hottest) hottest = heat[lines]
}
function at(what) { return $column[6, what] }
function at0(what) { return first[column[6, what]] }
function end(what) { return last[column[6, what]] }
function f(k, what) { return value[4, k, what] }
function abs(x) { return x < 0 ? -x : x }
function norm(x, y, z) { return sqrt(x * x + y * y + z * z) }

# The contact shows as heat: the time at which 1 % of the run's largest heating is reached [s].
function contact(   k) {
  for (k = 1; k <= lines; k++) if (heat[k] > 0.01 * hottest) return time[k]
}

function title(text) { printf "\n%s\n", text }
function row(label, text, paper) { printf "  %-38s %-34s %s\n", label, text, paper == "" ? "" : "paper: " paper }
function check(what, holds, why_not) {
  printf "%-7s %s%s\n", why_not != "" ? "n/a" : holds ? "ok" : "FAILED", what, why_not == "" ? "" : " (" why_not ")"
}

function fragment(k) {
  printf "  %2d  %9.5f  %7d  %7.0f  %6.1f  %6.1f  %-8s  %5.1f  %5.0f\n", k, f(k, "mass") / 1e20, f(k, "n"), f(k, "r") / 1e3,
    f(k, "v"), f(k, "v_esc"), f(k, "fate"), f(k, "water"), 100 * f(k, "damage")
}

# Speed inside each body before contact over its escape speed, and change of radius: the worst of them.
function rest(   k, v) {
  for (k = 1; k <= rows[2]; k++) {
    v = sqrt(2 * value[2, k, "E_kin"] / value[2, k, "mass"] / (2 * G * value[2, k, "mass"] / value[2, k, "radius"]))
    if (v > stir) stir = v
    v = value[2, k, "radius"] / asked[value[2, k, "from_1"] > 0 ? "RadiusImpactor" : "RadiusTarget"] - 1
    if (abs(v) > abs(swell)) swell = v
  }
}

END {
  G = 6.67430e-11 # m^3/kg/s^2, CODATA 2018
  M = asked["MassTarget"] + asked["MassImpactor"]
  start = asked["InitialTime"]
  hit = contact()
  wet = f(1, "from_0") > f(1, "from_1") ? 1 : 2
  dry = 3 - wet
  two = (f(1, "mass") + f(2, "mass")) / M
  apart = f(2, "near") == 1 ? f(2, "v_rel") / f(2, "v_rel/v_esc") : 0
  ice = value[2, 1, "ice_from_0"] + value[2, 2, "ice_from_0"]
  held = (value[5, 1, "mass"] + value[5, 2, "mass"]) / M # clumps
  rest()

  printf "%s: collision of two bodies of the mass of Ceres, %d particles\n", run, n
  title("Approach and contact")
  row("angle, speed at contact", sprintf("%.1f deg, %.0f m/s = %.2f v_esc", asked["ContactAngle"], asked["ContactSpeed"],
    asked["ContactSpeed"] / asked["EscapeSpeed"]), "48 deg, 1.7 v_esc (its orbit: 46.2 deg, 1.73)")
  row("radii, v_esc", sprintf("%.0f km, %.0f km, %.0f m/s", asked["RadiusTarget"] / 1e3, asked["RadiusImpactor"] / 1e3,
    asked["EscapeSpeed"]), "509 km, 437 km, 516 m/s")
  row("distance, speed at the start", sprintf("%.0f km, %.0f m/s", asked["InitialDistance"] / 1e3, asked["InitialSpeed"]),
    "11369 km, 744 m/s")
  row("contact, after the start", sprintf("%.1f min by the orbit, %.1f by heating", -start / 60, (hit - start) / 60), "234 min")
  row("end, after the start", sprintf("%.0f min, step %d", (end("time") - start) / 60, end("step")), "2000 min")

  title(sprintf("Fragments of %d and more particles (the mass of the paper's 20, but never fewer than 5)", least))
  printf "   k       mass        n        r       v   v_esc  fate      water  damage\n"
  printf "        10^20 kg                km     m/s     m/s              %%       %%\n"
  for (k = 1; k <= rows[4] && k <= 12; k++) fragment(k)
  if (rows[4] > 12) printf "  ... and %d more in fragments.tsv\n", rows[4] - 12
  printf "  paper:   9.55      83636    29801   278                        2     61\n"
  printf "           9.17     117562    31113   289                       27     70\n"
  printf "           0.00252      33    20927   255      5.2  accreted     29    100   (and three more)\n"
  for (k = 1; k <= rows[4]; k++) {
    mass += f(k, "mass")
    water += f(k, "mass") * f(k, "water") / 100
  }
  row("mass in these, their ice", sprintf("%.3g kg, %.3g kg = %.1f %%", mass, water, 100 * water / mass),
    "1.87e21 kg, 2.73e20 kg = 14.6 %")
  row("in all", total[4], "2503 fragments, 6 of them with 20 or more particles")

  title("Survivors")
  row("mass in both", sprintf("%.2f %%, with what is bound: %.2f %%", 100 * two, 100 * held), "99.3 %")
  row("distance, relative speed", sprintf("%.0f km, %.0f m/s", f(2, "distance") / 1e3, f(2, "v_rel")), "> 60000 km, 567 m/s")
  row("mutual escape speed there", sprintf("%.0f m/s: %s", apart, f(2, "v_rel") > apart ? "they escape" : "they are bound"),
    "64 m/s: they escape")
  row("ice on the wet, on the dry one", sprintf("%.1f %%, %.1f %% of their mass", f(wet, "water"), f(dry, "water")), "27 %, 2 %")
  row("ice from the wet one on the dry one", sprintf("%.3g kg of %.3g kg", f(dry, "ice_from_0"), ice))
  row("damage of the wet, of the dry one", sprintf("%.0f %%, %.0f %%", 100 * f(wet, "damage"), 100 * f(dry, "damage")),
    "70 %, 61 %")
  row("mean damage just after the impact", sprintf("%.0f %%", damage[3]), "64.5 %")

  title("Energies [J]                         start             end")
  for (k = split("E_kinetic E_internal E_potential E_total", name, " "); k > 0; k--) order[k] = name[k]
  for (k = 1; k in order; k++) printf "  %-24s %15.6g %15.6g\n", order[k], at0(order[k]), end(order[k])

  title("Largest drift, start to end")
  scale["p"] = M * asked["ContactSpeed"]
  scale["L"] = norm(at0("L_x"), at0("L_y"), at0("L_z"))
  scale["E"] = at0("E_kinetic")
  row("momentum", sprintf("%.2e of M v", drift["p"] / scale["p"]))
  row("angular momentum", sprintf("%.2e of it", drift["L"] / scale["L"]))
  row("  until 100 min after the contact", sprintf("%.2e", impact["L"] / scale["L"]))
  row("total energy", sprintf("%.2e of the kinetic energy", drift["E"] / scale["E"]))
  row("before contact, worst of both bodies", sprintf("rms v %.1e v_esc, radius %+.1e", stir, swell))

  title("Checks")
  early = rows[2] < 2 ? "the run has no dump with both bodies apart before the contact" : ""
  short = end("time") < 15e3 ? sprintf("the run ends %.0f min after the contact, 250 are needed", end("time") / 60) : ""
  other = asked["ContactAngle"] != 48 || abs(asked["ContactSpeed"] / asked["EscapeSpeed"] - 1.7) > 1e-6 ? \
    "only for 48 degrees and 1.7 v_esc" : short
  few = other != "" ? other : n < 1500 ? "from 1500 particles on: one is a large part of a percent" : ""
  bound = gravity == "direct" ? 1e-10 : 1e-4
  check("before contact the bodies are at rest: rms v < 1 % of v_esc", stir < 0.01, early)
  check("before contact they keep their radius to 1 %", abs(swell) < 0.01, early)
  check("two survivors hold 99 % of the mass", held > 0.99 && f(2, "mass") > 0.4 * M, few)
  check("they escape each other", f(2, "v_rel") > apart && apart > 0, other)
  check("the wet one has lost ice, the dry one has some of it", f(wet, "ice_from_0") < 0.99 * ice && f(dry, "ice_from_0") > 0, other)
  check(sprintf("momentum is kept to %g of M v (%s)", bound, gravity), drift["p"] < bound * scale["p"])
  check("angular momentum is kept to 1e-3", drift["L"] < 1e-3 * scale["L"])
  check("total energy is kept to 1 % of the kinetic", drift["E"] < 0.01 * scale["E"])
}
