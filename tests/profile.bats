# SPDX-License-Identifier: GPL-3.0-or-later
# profile: shells against sums over particles by awk, a field that is linear in r, velocities of an expansion; centres, kinds, errors.

load h5

setup_file() {
  cd "$BATS_FILE_TMPDIR"
  mksphere -n 2000 --mass 9e20 --layer basalt:0.7 --layer ice:0.3 -o a.h5 2>log
  mksphere -n 500 --mass 3e20 --layer basalt:1 -o b.h5 2>log
  collide a.h5 b.h5 --angle 48deg --speed 1.7vesc --distance 4 -o two.h5
}
setup() { cd "$BATS_FILE_TMPDIR"; }
rows() { grep -v '^#' "$@"; }
# column NAME FILE
column() {
  awk -F'\t' -v name="$1" '/^# kind/ { sub(/^# /, ""); for (k = 1; k <= NF; k++) if ($k == name || index($k, name " [") == 1) at = k; next }
    !/^#/ { print at ? $at : "no such column" }' "$2"
}

@test "shells: counts, masses and means are those of the particles" {
  profile -n 6 -f Density -f InternalEnergy a.h5 >t
  paste -d' ' <(field a.h5 Coordinates 3) <(field a.h5 Masses) <(field a.h5 MaterialID) <(field a.h5 Density) >p
  R=$(column to t | head -6 | tail -1)
  awk -v R="$R" 'NR == FNR { for (a = 1; a < 4; a++) c[a] += $4 * $a; M += $4; next }
    { r = 0; for (a = 1; a < 4; a++) r += ($a - c[a] / M) ^ 2; r = r ^ .5; b = int(6 * r / R * (1 - 1e-9)); if (b > 5) b = 5
      for (k = 0; k < 2; k++) { q = k ? 1 + $5 : 0; n[q, b]++; m[q, b] += $4; s[q, b] += $4 * $6; s2[q, b] += $4 * $6 ^ 2; d[q, b] += $4 * r } }
    END { for (q = 0; q < 3; q++) for (b = 0; b < 6; b++) if (n[q, b])
      printf "%d %.5g %.5g %.5g\n", n[q, b], m[q, b], d[q, b] / m[q, b], s[q, b] / m[q, b] }' p p >expected
  paste -d' ' <(column n t) <(column mass t) <(column r t) <(column Density t) | awk '{ printf "%d %.5g %.5g %.5g\n", $1, $2, $3, $4 }' |
    diff expected -
  [ "$(column kind t | uniq | tr '\n' ' ')" = "all basalt ice " ]
  # what is inside adds up; means lie between the least and the largest
  true_that 'near(a, 9e20, 1e-8)' a="$(awk -F'\t' '$1 == "all" { m = $7 } END { print m }' t)"
  true_that 'near(a, 2.7e20, 1e-8)' a="$(awk -F'\t' '$1 == "ice" { m = $7 } END { print m }' t)"
  rows t | awk -F'\t' '$11 > $9 * (1 + 1e-8) || $12 < $9 * (1 - 1e-8) || $10 < 0 { exit 1 }'
}

@test "a field that is linear in the distance is that in each shell; its spread is that of a shell" {
  r='hypot(hypot(Coordinates.x, Coordinates.y), Coordinates.z)'
  profile -n 10 -b none -c 0,0,0 -f "3*$r + 5km" a.h5 >t
  paste -d' ' <(column r t) <(rows t | cut -f 9,10 | tr '\t' ' ') <(column to t) | awk '
    { want = 3 * $1 + 5000; if (($2 - want) ^ 2 > 1e-12 * want ^ 2) exit 1; if ($3 <= 0 && NR > 1 || $3 > 3 * $4 / NR / 2) exit 1 }'
}

@test "an expansion has its v_r, wherever the centre moves" {
  without "Velocities" a.h5 e.h5
  paste -d' ' <(field a.h5 Coordinates 3) | awk '{ printf "%.17g %.17g %.17g\n", $1 * 1e-3 + 700, $2 * 1e-3 - 50, $3 * 1e-3 }' | put e.h5 Velocities 3
  profile -n 5 -b none e.h5 -f Density >t
  paste -d' ' <(column v_r t) <(column r t) | awk '($1 - 1e-3 * $2) ^ 2 > 1e-8 * $1 ^ 2 { exit 1 }'
}

@test "groups, centres, selections" {
  [ "$(profile -g body:1 -n 1 -b none -f Density two.h5 | rows | cut -f 5)" = "$(field b.h5 ParticleIDs | wc -l)" ]
  profile -g body:1 -b body -n 3 -f Density two.h5 >one
  profile -b none -n 3 -f Density b.h5 >alone
  [ "$(column kind one | uniq | tr '\n' ' ')" = "all body:1 " ]
  paste <(awk -F'\t' '$1 == "all"' one | cut -f 4-6) <(rows alone | cut -f 4-6) |
    awk '($1 - $4) ^ 2 > 1e-10 * $4 ^ 2 || $2 != $5 || ($3 - $6) ^ 2 > 1e-10 * $6 ^ 2 { exit 1 }'
  [ "$(profile -w "MaterialID == 'ice'" -n 1 -b none -f Density a.h5 | rows | cut -f 6)" = "$(profile -n 1 -f Density a.h5 | awk -F'\t' '$1 == "ice" { print $6 }')" ]
  # about the other body all particles of this one are as far as the bodies are apart
  d=$(collide a.h5 b.h5 --angle 48deg --speed 1.7vesc --distance 4 --dry-run | awk -F'\t' '$1 == "InitialDistance" { print $2 }')
  true_that 'near(r, d, 0.05)' r="$(profile -g body:1 -c body:0 -n 1 -b none -f Density two.h5 | rows | cut -f 4)" d="$d"
  profile -s number -n 4 -b none -f Density a.h5 | rows | cut -f 5 | awk '{ if (NR == 1) n = $1; if ($1 < n - 9 * n / 10 || $1 > 1.9 * n) exit 1; s += $1 } END { print s }' |
    grep -qx "$(field a.h5 Masses | wc -l)"
  profile -s log -r 100km,400km -n 2 -b none -f Density a.h5 | rows | awk -F'\t' '{ if (($3 / $2 - 2) ^ 2 > 1e-12) exit 1 }'
}

@test "pictures; threads do not matter" {
  profile -f Density -f Masses -f 'Density^2' -f SmoothingLength -b body -n 20 -o p.png two.h5 >t 2>messages
  [ ! -s messages ]
  [ "$(od -A n -t x1 -N 4 p.png | tr -d ' ')" = 89504e47 ]
  profile -f Density -b none -n 3 -s log -o q.png a.h5 >/dev/null 2>messages
  [ ! -s messages ]
  OMP_NUM_THREADS=3 profile -f Density -f Masses -f 'Density^2' -f SmoothingLength -b body -n 20 two.h5 | cmp - t
}

@test "bad input is one line" {
  bad 1 "no field 'Densitie' (did you mean 'Density'?)" profile -f Densitie a.h5
  bad 1 "lacks field 'Pressure' (made by relax)" profile a.h5
  bad 1 "--group: 'a.h5' lacks field 'ClumpID' (made by clumps)" profile -f Density -g clump:1 a.h5
  bad 2 "--range: 0 <= LOW < HIGH must hold" profile -f Density -r 3km,2km a.h5
  bad 2 "--spacing log needs a --range from above 0" profile -f Density -s log -r 0,2km a.h5
  bad 2 "--centre" profile -f Density -c 1,2 a.h5
  bad 2 "--title needs --output" profile -f Density -t x a.h5
  bad 1 "'no.h5': No such file" profile -f Density no.h5
}
