#!/usr/bin/env bats
# SPDX-License-Identifier: GPL-3.0-or-later
# info: what it says of a snapshot is what h5dump finds in it.

load h5

setup_file() {
  cd "$BATS_FILE_TMPDIR"
  mksphere -n 60 --radius 30km --layer ice:0.3 --layer basalt:0.7 2>log | weibull -o t.h5 2>log
  collide -a 45deg -s 1.5vesc -d 1.1 t.h5 t.h5 -o s.h5 2>log
  solver -o run --end +10s --every 10s --set gravity.theta=0.5 s.h5 2>log
}

setup() {
  cd "$BATS_FILE_TMPDIR"
  snap=run/snap_0001.h5
}

# cell ROW NAME: column NAME of the row that begins with ROW of the table on stdin.
cell() {
  awk -F'\t' -v row="$1" -v name="$2" 'NR == 1 { sub(/^# /, ""); for (k = 1; k <= NF; k++) { sub(/ \[.*/, "", $k); if ($k == name) c = k } }
    NR > 1 && $1 == row { print $c }'
}

@test "every field: name, type, shape, unit, range, mean" {
  info --show fields $snap >fields
  [ "$(tail -n +2 fields | cut -f 1 | sort)" = "$(h5ls $snap/PartType0 | awk '{print $1}' | sort)" ]
  for name in Density MaterialID Velocities FlawThresholds DeviatoricStress; do
    field $snap $name >values
    sort -g values >sorted
    true_that 'a == least && b == greatest && near(m, mean, 1e-9)' least="$(cell $name least <fields)" a="$(head -1 sorted)" \
      greatest="$(cell $name greatest <fields)" b="$(tail -1 sorted)" m="$(cell $name mean <fields)" \
      mean="$(awk '{ s += $1; a += $1 < 0 ? -$1 : $1 } END { printf "%.17g", s/NR }' values)" || { echo $name; false; }
  done
  n=$(field $snap Masses | wc -l)
  [ "$(cell DeviatoricStress type <fields) $(cell DeviatoricStress shape <fields) $(cell Density unit <fields)" = "float64 $n x 6 kg/m^3" ]
  [ "$(cell BodyID type <fields) $(cell ParticleIDs type <fields)" = "int32 int64" ]
  [ "$(cut -f 8 fields | sort -u | tr '\n' ' ')" = "0 not_finite " ]
}

@test "bodies and materials: numbers, masses, laws" {
  info --show bodies $snap >bodies
  info --show materials $snap >materials
  paste -d' ' <(field $snap BodyID) <(field $snap MaterialID) <(field $snap Masses) <(field $snap Coordinates 3) >rows
  for body in 0 1; do
    true_that 'n == count && near(m, mass, 1e-12) && near(x, com, 1e-9)' n="$(cell $body n <bodies)" m="$(cell $body mass <bodies)" \
      x="$(cell $body x <bodies)" $(awk -v b=$body '$1 == b { n++; m += $3; x += $3*$4 } END { printf "count=%d mass=%.17g com=%.17g", n, m, x/m }' rows)
  done
  for k in 0 1; do
    true_that 'n == count && near(m, mass, 1e-12)' n="$(cell $k n <materials)" m="$(cell $k mass <materials)" \
      $(awk -v c=$k '$2 == c { n++; m += $3 } END { printf "count=%d mass=%.17g", n, m }' rows)
  done
  [ "$(cell 1 name <materials) $(cell 1 eos <materials) $(cell 1 strength <materials) $(cell 1 damage <materials) $(cell 1 porosity <materials)" = \
    "basalt tillotson von_mises grady_kipp -" ]
}

@test "collision, settings, history, the materials' text" {
  info --show collision $snap >collision
  [ "$(awk -F'\t' '$2 == "ContactAngle" { print $3 }' collision)" = "$(number $snap /Collision/ContactAngle)" ]
  info --show parameters $snap | grep -qx 'gravity.theta	0.5	given'
  info --show history $snap >history
  [ "$(tail -n +2 history | tail -1 | cut -f 1 | cut -d' ' -f 1)" = solver ]
  [ "$(tail -n +2 history | wc -l)" = "$(h5ls $snap/History | grep -o '[0-9]*' | tail -1)" ]
  info --show text $snap | grep -q '^name = "basalt";'
}

@test "one screen: all of it, in lines that fit" {
  info $snap >screen
  [ "$(wc -l <screen)" -le 48 ]
  [ "$(awk 'length > 100' screen)" = "" ]
  head -1 screen | grep -q "^$snap: .* particles, 3D, t = "
  grep -q '^settings   gravity.theta=0.5$' screen
  grep -q '^basalt\|^1 basalt' screen
  grep -q '^collision ' screen
  for name in $(h5ls $snap/PartType0 | awk '{print $1}'); do grep -q "^$name " screen; done
  info run/checkpoint.h5 | head -1 | grep -q 'a checkpoint$'
  info <$snap | head -1 | grep -q '^-: '
}

@test "what is not finite is said; a field of the user's own is shown" {
  cp $snap bad.h5
  n=$(field $snap Masses | wc -l)
  { echo nan; yes 1 | head -n $((n - 1)); } | put bad.h5 Mine 1
  info --show fields bad.h5 >fields
  [ "$(cell Mine not_finite <fields) $(cell Mine least <fields)" = "1 1" ]
  info bad.h5 | grep -q '^Mine .*1 NOT FINITE$'
}

@test "every mistake is one line" {
  bad 2 "'field'" info --show field $snap
  bad 1 "'none.h5'" info none.h5
  bad 1 "empty" info </dev/null
  bad 2 "surplus" info $snap $snap
  run bash -c "info $snap >/dev/full"
  [ "$status" = 1 ]
}
