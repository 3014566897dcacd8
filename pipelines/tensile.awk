# SPDX-License-Identifier: GPL-3.0-or-later
# awk -f verdict.awk -f tensile.awk -v dx=SPACING s1/crack.tsv ...: rows of crack.awk, with the time before them.
FNR == 1 { runs++ }
$2 > 0.5 && !(runs in first) { first[runs] = $1; begins[runs] = $3 }
{ stress[runs] = $4; peak[runs] = max(peak[runs], $4); through[runs] = $5; place[runs] = $6; speed[runs] = $7 }
# The parts swing, a free end and one that is pulled: the speed at an instant is that of a phase.
$5 > 0.9 { apart[runs]++; sum[runs] += $7; least = least == "" ? $7 : min(least, $7); most = max(most, $7) }
END {
  title("A rod pulled apart, spacing " dx ", " runs " seeds")
  for (r = 1; r <= runs; r++) {
    early += r in first && first[r] >= 1.3 && first[r] <= 3.5 && abs(begins[r]) < 0.4
    middle += through[r] > 0.9 && abs(place[r]) < 0.6; gone = max(gone, abs(stress[r])); v += speed[r]/runs; if (apart[r]) { mean += sum[r]/apart[r]; broken++ } highest = max(highest, peak[r])
    fact("seed " r ": damage over 0.5 at t", first[r], "1.3 to 3.5", "other code"); fact("seed " r ": there, at x", begins[r], "|x| < 0.4", "")
    fact("seed " r ": mean x of what is broken", place[r], "", "")
  }
  claim("seeds with a crack across, |x| < 0.6, of " runs, middle, 3, runs, "most", "Gray et al. (2001)")
  claim("greatest stress at |x| = 0.6 at the end", gone, 0, 1e-3, "0", "")
  fact("seeds with damage first at |x| < 0.4, t = 1.3 to 3.5", early, runs, "")
  fact("greatest stress at |x| = 0.6 before", highest, "5.9e-3", "rho c v: the wave breaks it")
  claim("mean speed at which the parts leave", v, 3e-3, 5.05e-3, "3e-3 to 5e-3", "the ends move at 5e-3")
  fact("the same, from when a crack is across to the end", broken ? mean/broken : 0, "5e-3", "the ends move at 5e-3")
  fact("least speed in that time", least, "", ""); fact("greatest", most, "1e-2", "a wave at a free end")
}
