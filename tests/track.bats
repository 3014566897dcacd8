# SPDX-License-Identifier: GPL-3.0-or-later
# track on a small collision: its objects are those of clumps and fof, descent and provenance against sums over particles by awk.

load h5

setup_file() {
  export OMP_NUM_THREADS=1
  cd "$BATS_FILE_TMPDIR"
  mksphere -n 200 --radius 100km --layer basalt --rotate 1 >t.h5 2>log
  mksphere -n 60 --radius 60km --layer ice --rotate 2 >i.h5 2>log
  collide t.h5 i.h5 --angle 45deg --speed 2vesc --distance 1.5 >s.h5 2>log
  solver -o run --end +2400s --every 400s s.h5
  track --min-particles 5 --tracks tracks --curve curve --plot masses.png --map map.h5 --origin origin.h5 --shells shells --bins 4 \
    run/snap_*.h5 >table
}
setup() { cd "$BATS_FILE_TMPDIR"; }
rows() { grep -v '^#' "$@"; }
# ids FILE: particle id, ClumpID, mass, by id.
ids() { paste -d' ' <(field "$1" ParticleIDs) <(field "$1" ClumpID) <(field "$1" Masses) | sort -n; }

@test "its objects are those of clumps, and of fof" {
  for k in 0 3 6; do
    clumps -n 5 run/snap_000$k.h5 | rows | cut -f 1,2,3 >c
    rows table | awk -F'\t' -v f="run/snap_000$k.h5" '$1 == f { print $4 "\t" $5 "\t" $6 }' | cmp - c
  done
  fof -n 5 run/snap_0006.h5 | rows | cut -f 1,2,3 >f
  track -b fof -n 5 run/snap_000[56].h5 | rows | awk -F'\t' '$1 ~ /6.h5/ { print $4 "\t" $5 "\t" $6 }' | cmp - f
  clumps -n 5 -o ids.h5 run/snap_0006.h5 >/dev/null
  track -b stored -n 2 ids.h5 | rows | cut -f 5,6 | cmp - <(clumps -n 5 run/snap_0006.h5 | rows | cut -f 2,3)
}

@test "progenitors and what they passed on, by sums over particles" {
  for k in 0 1 5; do
    clumps -n 5 -o a.h5 run/snap_000$k.h5 >/dev/null
    clumps -n 5 -o b.h5 run/snap_000$((k + 1)).h5 >/dev/null
    join <(ids a.h5 | sort -k1,1) <(ids b.h5 | sort -k1,1) | awk '{ both[$2 " " $4] += $5; all[$4] += $5 }
      END { for (o in all) if (o > 0) { best = 0; up = 0
        for (p in both) { split(p, q, " "); if (q[1] > 0 && q[2] == o && both[p] > best) { best = both[p]; up = q[1] } }
        printf "%d %d %.6f\n", o, up, best / all[o] } }' | sort -n >expected
    rows table | awk -F'\t' -v f="run/snap_000$((k + 1)).h5" '$1 == f { printf "%d %d %.6f\n", $4, $7, $8 }' >is
    [ -s is ]
    diff expected is
  done
}

@test "tracks: both bodies at the start; each object has one; what ended says where" {
  [ "$(rows tracks | head -2 | cut -f 1,2,5)" = "$(printf '%s\t0\t%s\n' 1 "$(rows table | head -1 | cut -f 2)" 2 "$(rows table | head -1 | cut -f 2)")" ]
  rows table | cut -f 1,3 | sort | uniq -d | wc -l | grep -qx 0
  rows table | cut -f 3 | sort -n | uniq -c | awk '{ print $2 "\t" $1 }' | cmp - <(rows tracks | cut -f 1,4)
  rows tracks | awk -F'\t' '($10 == "merged") != ($3 > 0) { exit 1 }'
}

@test "the curve: masses of the largest; mean and deviation of the last tenth, two dumps at least" {
  [ "$(rows curve | wc -l)" = 7 ]
  rows table | awk -F'\t' '$4 == 1 { print $6 }' | cmp - <(rows curve | cut -f 5)
  rows curve | tail -2 | awk -F'\t' '{ m[NR] = $5 } END { printf "%.9g %.5g\n", (m[1] + m[2]) / 2, ((m[1] - m[2]) ^ 2 / 2) ^ .5 }' >expected
  awk -F'\t' '/^# mean\t/ { m = $5 } /^# deviation/ { d = $5 } END { printf "%.9g %.5g\n", m, d }' curve | cmp - expected
  true_that 'abs(xi) < 1e-9' xi="$(rows curve | head -1 | cut -f 12)" # two whole bodies: nothing accreted
  # heating: gain of internal energy over 1/2 mu v^2 at contact, as the particles have it
  for k in 0 6; do paste <(field run/snap_000$k.h5 Masses) <(field run/snap_000$k.h5 InternalEnergy) | awk '{ u += $1 * $2 } END { printf "%.9g\n", u }'; done >U
  paste -d' ' <(field run/snap_0000.h5 BodyID) <(field run/snap_0000.h5 Masses) |
    awk -v v="$(number run/snap_0000.h5 /Collision/ContactSpeed)" '{ m[$1] += $2 } END { printf "%.9g\n", m[0] * m[1] / (m[0] + m[1]) / 2 * v * v }' >K
  true_that 'near(h, (b - a) / k, 1e-5) && h > 0' h="$(rows curve | tail -1 | cut -f 14)" a="$(head -1 U)" b="$(tail -1 U)" k="$(cat K)"
  [ "$(od -A n -t x1 -N 4 masses.png | tr -d ' ')" = 89504e47 ]
}

@test "provenance: map, origin and shells say the same" {
  rows table | awk -F'\t' '$1 ~ /6.h5/ { print $4, $6 }' >objects
  ids map.h5 | awk '$2 { m[$2] += $3 } END { for (o in m) printf "%d %.12g\n", o, m[o] }' | sort -n >map
  awk 'NR == FNR { m[$1] = $2; next } { if ((m[$1] - $2) ^ 2 > 1e-12 * $2 ^ 2) bad = 1; n++ } END { exit bad || n < 1 }' map objects
  cmp <(field map.h5 Coordinates) <(field run/snap_0000.h5 Coordinates)
  cmp <(ids map.h5) <(ids origin.h5)
  # shells from the marks of the particles
  paste -d' ' <(field origin.h5 ClumpID) <(field origin.h5 BodyID) <(field origin.h5 InitialRadius) <(field origin.h5 InitialDepth) \
    <(field origin.h5 Masses) | awk '{ R = $3 + $4; s = int(4 * $3 / R); if (s > 3) s = 3; m[$1 " " $2 " " s] += $5 }
      END { for (k in m) printf "%s %.6g\n", k, m[k] }' | sort >expected
  rows shells | awk -F'\t' '$5 > 0 { printf "%d %d %d %.6g\n", $1, $2, n[$1 " " $2] + 0, $5 } { n[$1 " " $2]++ }' | sort | diff expected -
  rows shells | awk -F'\t' '{ s[$2 " " $3] += $7; o[$1] += $6 } END { for (k in s) if ((s[k] - 1) ^ 2 > 1e-12) exit 1
    for (k in o) if ((o[k] - 1) ^ 2 > 1e-12) exit 1 }'
  # the depth is that in the bodies before the collision
  paste -d' ' <(field run/snap_0000.h5 ParticleIDs) <(field run/snap_0000.h5 BodyID) <(field run/snap_0000.h5 Coordinates 3) \
    <(field run/snap_0000.h5 Masses) >start
  awk 'NR == FNR { for (a = 3; a < 6; a++) x[$2, a] += $6 * $a; m[$2] += $6; next }
    { r = 0; for (a = 3; a < 6; a++) r += ($a - x[$2, a] / m[$2]) ^ 2; printf "%d %.4f\n", $1, r ^ .5 / 1e3 }' start start | sort >expected
  paste -d' ' <(field origin.h5 ParticleIDs) <(field origin.h5 InitialRadius) | awk '{ printf "%d %.4f\n", $1, $2 / 1e3 }' | sort | cmp - expected
  render -c InitialDepth -o depth.png origin.h5
}

@test "the bodies at the start may be another file; threads do not matter" {
  track -n 5 --initial s.h5 --map map2.h5 run/snap_000[06].h5 >/dev/null
  cmp <(ids map2.h5) <(ids map.h5)
  OMP_NUM_THREADS=3 track -n 5 run/snap_*.h5 >three
  cmp three table
}

# refused MESSAGE ARGUMENTS...: one line on stderr, exit 1; the table may have begun.
refused() {
  local message=$1
  shift
  run bash -c 'track "$@" 2>&1 >/dev/null' - "$@"
  [ "$status" = 1 ]
  [ "$output" = "track: $message" ]
}

@test "bad input is one line" {
  bad 2 "input" track
  refused "'run/snap_0001.h5' is not later than the dump before it" run/snap_0002.h5 run/snap_0001.h5
  refused "'run/snap_0000.h5' has neither ClumpID nor FragmentID: see --by" -b stored run/snap_0000.h5
  bad 2 "name files" track - run/snap_0000.h5
  bad 2 "--bins needs --shells" track --bins 3 run/snap_0000.h5
  bad 2 "--initial needs --map" track --initial s.h5 run/snap_0000.h5
  bad 1 "'no.h5': No such file" track no.h5
}
