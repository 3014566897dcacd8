#!/usr/bin/env bats
# SPDX-License-Identifier: GPL-3.0-or-later
# weibull: the tool around lib/weibull (whose statistics test_weibull checks).

load h5

setup() {
  cd "$BATS_TEST_TMPDIR"
  mksphere -n 800 --radius 3cm --layer basalt -o b.h5 2>log
}

@test "a basalt sphere of 3 cm: lowest threshold, statistics, a flaw for everyone" {
  weibull -k 5e34 -m 8.5 --seed 3 --verbose b.h5 >w.h5 2>table
  n=$(field b.h5 ParticleIDs | wc -l)
  field w.h5 FlawThresholds | sort -g >flaws
  [ "$(field w.h5 FlawCount | sort -n | head -1)" -ge 1 ]
  true_that 'near(low, 2.4103e-4, 5e-5)' low="$(head -1 flaws)" # (1/(k V))^(1/m)
  [ "$(field w.h5 Damage | uniq)" = 0 ]
  awk -F'\t' -v n="$n" -v flaws="$(wc -l <flaws)" -v low="$(head -1 flaws)" -v high="$(tail -1 flaws)" '
    function near(a, b) { return (a - b) ^ 2 < 1e-16 * b * b }
    NR == 2 {found = $2 == "basalt" && $3 == n && $5 == flaws && near($7, low) && near($8, high) &&
      near($6, n * (log(n) + 0.5772156649) + 0.5) && ($5 - $6) ^ 2 < 16 * n * n} END {exit !(NR == 2 && found)}' table
  [ "$(awk '{n += $1} END {print n}' <(field w.h5 FlawCount))" = "$(wc -l <flaws)" ]
}

@test "silent and reproducible; another seed differs; flaws are replaced, not added to" {
  run weibull b.h5 -o 1.h5
  [ -z "$output" ]
  weibull -o 2.h5 <b.h5
  weibull --seed 2 b.h5 -o 3.h5
  weibull 3.h5 -o 4.h5
  [ "$(field 1.h5 FlawThresholds)" = "$(field 2.h5 FlawThresholds)" ]
  [ "$(field 1.h5 FlawThresholds)" != "$(field 3.h5 FlawThresholds)" ]
  [ "$(field 1.h5 FlawThresholds)" = "$(field 4.h5 FlawThresholds)" ]
}

@test "only brittle materials get flaws, with their own k and m" {
  mksphere -n 500 --radius 1km --layer water:0.5 --layer basalt:0.5 -o l.h5 2>log
  weibull -v l.h5 >w.h5 2>table
  paste <(field w.h5 MaterialID) <(field w.h5 FlawCount) | awk '($1 == 0) != ($2 == 0) {exit 1}'
  k=1e61 m=16 # basalt.cfg
  true_that 'near(log(low), -(log(k) + log(v)) / m, 1e-8)' low="$(awk 'NR == 2 {print $7}' table)" v="$(awk 'NR == 2 {print $4}' table)" k=$k m=$m
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
