#!/usr/bin/env bats
# SPDX-License-Identifier: GPL-3.0-or-later
# weibull: the tool around lib/weibull (whose statistics test_weibull checks).

load h5

setup() {
  cd "$BATS_TEST_TMPDIR"
  mksphere -n 800 --radius 3cm --layer basalt -o b.h5 2>log
}

# column NAME [ROW]: of the table in the file `table`; NAME+ is the next column of that name.
column() {
  awk -F'\t' -v name="${1%+}" -v skip="$([[ $1 == *+ ]] && echo 1)" -v row="${2:-1}" '
    sub(/^# /, "") { for (k = 1; k <= NF; k++) { sub(/ \[.*/, "", $k); if ($k == name && skip-- < 1) { c = k; break } } next }
    c && ++n == row { print $c; exit }' table
}

@test "a basalt sphere of 3 cm: lowest threshold, statistics beside what is expected, a flaw for everyone" {
  weibull -k 5e34 -m 8.5 --seed 3 --verbose b.h5 >w.h5 2>table
  n=$(field b.h5 ParticleIDs | wc -l)
  field w.h5 FlawThresholds | sort -g >flaws
  field w.h5 FlawCount | sort -n >counts
  [ "$(head -1 counts)" -ge 1 ]
  true_that 'near(low, 2.4103e-4, 5e-5)' low="$(head -1 flaws)" # (1/(k V))^(1/m)
  [ "$(field w.h5 Damage | uniq)" = 0 ]
  [ "$(column body) $(column material) $(column particles) $(column seed) $(column flaws)" = "0 basalt $n 3 $(wc -l <flaws)" ]
  [ "$(column least) $(column most)" = "$(head -1 counts) $(tail -1 counts)" ]
  true_that 'near(low, a, 1e-8) && near(high, b, 1e-8) && near(each, flaws/n, 1e-5) && memory == 8*flaws + 4*n' n="$n" flaws="$(wc -l <flaws)" \
    low="$(column lowest)" high="$(column highest)" a="$(head -1 flaws)" b="$(tail -1 flaws)" each="$(column "per particle")" memory="$(column memory)"
  true_that 'near(want, n*(log(n) + 0.5772156649) + 0.5, 1e-6) && abs(flaws - want) < 4*sd && near(sd, 1.28*n, 0.05)' sd="$(column scatter)" n="$n" flaws="$(wc -l <flaws)" want="$(column expected)"
  # (N/(k V))^(1/m) Gamma(1 + 1/8.5)
  true_that 'near(got, want, 0.02) && near(want, low*n^(1/8.5)*0.945, 0.001)' n="$n" got="$(column weakest)" want="$(column expected+)" low="$(column lowest)"
  [ "$(awk '{n += $1} END {print n}' counts)" = "$(wc -l <flaws)" ]
  [[ $(tail -1 table) == "weibull: $(wc -l <flaws) flaws ("*" expected) for $n particles, "*" each, lowest threshold 0.000241"*" MB" ]]
}

@test "one line is said; reproducible; another seed differs; flaws are replaced, not added to" {
  run weibull b.h5 -o 1.h5
  [ "${#lines[@]}" = 1 ]
  weibull -o 2.h5 <b.h5
  weibull --seed 2 b.h5 -o 3.h5
  weibull 3.h5 -o 4.h5
  [ "$(field 1.h5 FlawThresholds)" = "$(field 2.h5 FlawThresholds)" ]
  [ "$(field 1.h5 FlawThresholds)" != "$(field 3.h5 FlawThresholds)" ]
  [ "$(field 1.h5 FlawThresholds)" = "$(field 4.h5 FlawThresholds)" ]
}

@test "a seed for each body, k and m for each material" {
  mksphere -n 60 --radius 1km --layer ice:0.3 --layer basalt:0.7 -o l.h5 2>log
  collide -a 0 -s 1vesc l.h5 l.h5 -o s.h5
  weibull -v --seed 5 --seed 1:9 -k basalt:4e35 -m basalt:9 -m 10 s.h5 >w.h5 2>table
  [ "$(for r in 1 2 3 4; do echo "$(column body $r) $(column material $r) $(column seed $r) $(column k $r) $(column m $r)"; done)" = \
    "0 ice 5 1.4e+38 10
0 basalt 5 4e+35 9
1 ice 9 1.4e+38 10
1 basalt 9 4e+35 9" ]
  weibull --seed 5 s.h5 -o a.h5
  weibull --seed 5 --seed 1:9 s.h5 -o b1.h5
  n=$(field l.h5 ParticleIDs | wc -l)
  [ "$(field a.h5 FlawCount | head -n "$n")" = "$(field b1.h5 FlawCount | head -n "$n")" ]
  [ "$(field a.h5 FlawCount | tail -n "$n")" != "$(field b1.h5 FlawCount | tail -n "$n")" ]
}

@test "a number of flaws instead of one for everyone; more than one for everyone" {
  n=$(field b.h5 ParticleIDs | wc -l)
  weibull --flaws 2 --minimum 0 -v b.h5 2>table >w.h5
  [ "$(column flaws) $(column expected) $(column least)" = "$((2*n)) $((2*n)) 0" ]
  weibull --minimum 3 -v b.h5 2>table >w.h5
  [ "$(field w.h5 FlawCount | sort -n | head -1)" = 3 ]
  weibull --flaws 40 -v b.h5 2>table >w.h5
  [ "$(column flaws)" = $((40*n)) ]
}

@test "pores do not break: half the volume when the distention is 2" {
  n=$(field b.h5 ParticleIDs | wc -l)
  cp b.h5 porous.h5
  yes 2 | head -n "$n" | put porous.h5 Distention 1
  weibull -v b.h5 2>table >w.h5
  v=$(column volume) low=$(column lowest)
  weibull -v porous.h5 2>table >w.h5
  true_that 'near(v, 2*half, 1e-8) && near(stronger, low*2^(1/16), 1e-8)' v="$v" half="$(column volume)" low="$low" stronger="$(column lowest)"
  cp b.h5 bad.h5
  yes 0.5 | head -n "$n" | put bad.h5 Distention 1
  bad 1 "'bad.h5': particle 0: Distention is 0.5, must be at least 1" weibull bad.h5
}

@test "only brittle materials get flaws, with their own k and m" {
  mksphere -n 500 --radius 1km --layer water:0.5 --layer basalt:0.5 -o l.h5 2>log
  weibull -v l.h5 >w.h5 2>table
  paste <(field w.h5 MaterialID) <(field w.h5 FlawCount) | awk '($1 == 0) != ($2 == 0) {exit 1}'
  k=1e61 m=16 # basalt.cfg
  true_that 'near(log(low), -(log(k) + log(v)) / m, 1e-8)' low="$(column lowest)" v="$(column volume)" k=$k m=$m
}

@test "nothing brittle: a warning, and the body as it was" {
  mksphere -n 50 --radius 1km --layer water -o l.h5 2>log
  run weibull l.h5 -o w.h5
  [ "$status" = 0 ]
  [[ $output == "weibull: warning: no particle is of a brittle material"* ]]
  [ "$(field w.h5 FlawCount | sort -u)" = 0 ]
}

@test "every mistake is one line" {
  bad 2 "not positive" weibull -k -1 b.h5
  bad 2 "less than 1" weibull -m 0.5 b.h5
  bad 2 "wanted a unit like '1/m^3'" weibull -k 3km b.h5
  bad 1 "no material 'basal' in 'b.h5' (did you mean 'basalt'?)" weibull -k basal:1e34 b.h5
  mksphere -n 50 --radius 1km --layer water:0.5 --layer basalt:0.5 -o l.h5 2>log
  bad 1 "water does not break" weibull -m water:9 l.h5
  bad 1 "'b.h5' has no body 3" weibull --seed 3:1 b.h5
  bad 2 "body 0 twice" weibull --seed 0:1 --seed 0:2 b.h5
  bad 2 "is not a number" weibull --seed x:1 b.h5
  bad 2 "--flaws: -1 is not in" weibull --flaws -1 b.h5
  bad 2 "--minimum: -1 is not in" weibull --minimum -1 b.h5
  bad 2 "then say how many" weibull --minimum 0 b.h5
  bad 2 "negative" weibull --seed -1 b.h5
  bad 2 "'--sed'" weibull --sed 1 b.h5
  bad 1 "'none.h5'" weibull none.h5
  bad 1 "empty" weibull </dev/null
  echo text >text.h5
  bad 1 "'text.h5'" weibull text.h5
  head -c 3000 b.h5 >cut.h5
  bad 1 "'cut.h5'" weibull cut.h5
  bad 1 "No space left on device" weibull b.h5 -o /dev/full
}
