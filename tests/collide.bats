#!/usr/bin/env bats
# SPDX-License-Identifier: GPL-3.0-or-later
# collide: worked examples of docs/theory.md 7, and what it does to the particles.

load h5

setup() { cd "$BATS_TEST_TMPDIR"; }

body() { mksphere -n "$1" --mass "$2" --layer basalt "${@:4}" -o "$3" 2>log; }

# value NAME: from a --dry-run in $output.
value() { awk -F'\t' -v name="$1" '$1 == name {print $2}' <<<"$output"; }

# expect SCALE NAME=VALUE...: to nine digits of SCALE (0: of the value).
expect() {
  local scale=$1
  shift
  for pair; do
    true_that "abs(got - want) < 1e-9 * (scale ? scale : abs(want))" got="$(value "${pair%=*}")" want="${pair#*=}" scale="$scale" ||
      { echo "$pair"; return 1; }
  done
}

@test "worked example 1, parabolic" {
  body 1 5.374980e24 t.h5
  body 1 5.972200e23 i.h5
  run collide -n --angle 45deg --speed 1vesc --distance 5 --radius-target 6.179870e6 --radius-impactor 3.440340e6 t.h5 i.h5
  expect 0 ContactDistance=9.620210e6 EscapeSpeed=9103.172136 ContactSpeed=9103.172136 Eccentricity=1 Periapsis=4.810105000e6 \
    AnomalyAtContact=-90 AnomalyAtStart=-143.130102354 InitialDistance=4.810105e7 InitialSpeed=4071.062341 InitialX=3.848084000e7 \
    InitialY=2.886063000e7 InitialVx=-3862.148848 InitialVy=-1287.382949 InitialTime=-7970.866274 ContactAngle=45 \
    MassTarget=5.374980e24 MassImpactor=5.972200e23
  expect 9103 SpeedAtInfinity=0 || [ "$(value SpeedAtInfinity)" = nan ] # beta = 0 to rounding
}

@test "worked example 2, hyperbolic; the same from the speed at infinity" {
  body 1 9.43e20 t.h5
  for speed in 1.7vesc 876.9847815m/s 709.2086726vinf 0.7092086726km/svinf; do
    run collide -n --angle 48deg --speed "$speed" --distance 11369km --radius-target 509km --radius-impactor 437km t.h5 t.h5
    expect 0 ContactDistance=9.46e5 EscapeSpeed=515.873401 ContactSpeed=876.984782 SpeedAtInfinity=709.208673 Eccentricity=3.614704668 \
      Periapsis=6.543678879e5 AnomalyAtContact=-52.667749342 AnomalyAtStart=-101.722246859 InitialSpeed=724.652257 \
      InitialX=8.587383794e6 InitialY=7.450570487e6 InitialTime=-14361.323894
    expect 724.652257 InitialVx=-581.357840 InitialVy=-432.601382
  done
}

@test "worked example 3, bound; further out it is refused" {
  body 1 3.583320e24 t.h5
  body 1 2.388880e24 i.h5
  at() { collide -n --angle 30deg --speed 0.95vesc --distance "$1" --radius-target 5.606480e6 --radius-impactor 4.969380e6 t.h5 i.h5; }
  run at 3
  expect 0 ContactDistance=1.057586e7 EscapeSpeed=8682.147999 ContactSpeed=8248.040599 Eccentricity=0.954990183 Periapsis=2.441115493e6 \
    AnomalyAtContact=-125.072551410 AnomalyAtStart=-152.826187493 InitialSpeed=4216.283253 InitialX=1.477460382e7 \
    InitialY=2.807757850e7 InitialVx=-3072.640389 InitialVy=-2887.200289 InitialTime=-4138.406641
  [ "$(value SpeedAtInfinity)" = nan ] # a (1 + e) with a = 5.423517949e7
  expect 0 Apoapsis=1.0602924348e8
  run at 10.1
  [ "$status" = 1 ] && [[ $output == "collide: distance 1.06816e+08 m is beyond the apoapsis"* ]]
}

@test "head-on" {
  body 1 5.374980e24 t.h5
  body 1 5.972200e23 i.h5
  for pair in 1vesc=-7172.372160 1.5vesc=-3304.214366 0.95vesc=-8752.045943; do
    run collide -n -a 0 -s "${pair%=*}" --radius-target 6.179870e6 --radius-impactor 3.440340e6 t.h5 i.h5
    expect 0 InitialTime="${pair#*=}"
    expect 4.8e7 InitialX=0 InitialY=4.810105e7
  done
}

@test "the system: centre of mass, momentum, orbital momentum, relative state" {
  body 1500 9.43e20 t.h5 --rotate 1
  body 700 3e20 i.h5 --rotate 2 --spin 10h
  collide --angle 48deg --speed 1.7vesc --distance 6 t.h5 i.h5 >s.h5
  paste <(field s.h5 BodyID) <(field s.h5 Masses) <(field s.h5 Coordinates 3) <(field s.h5 Velocities 3) >rows
  awk -v X="$(number s.h5 /Collision/InitialX)" -v Y="$(number s.h5 /Collision/InitialY)" -v U="$(number s.h5 /Collision/InitialVx)" \
    -v V="$(number s.h5 /Collision/InitialVy)" '
    function abs(x) { return x < 0 ? -x : x }
    function close_to(a, b, scale) { if (abs(a - b) > 1e-11 * abs(scale)) { print a, b; exit 1 } }
    { b = $1; m[b] += $2; for (k = 1; k <= 6; k++) { q[b, k] += $2 * $(2 + k); all[k] += $2 * $(2 + k) } }
    END {
      for (k = 1; k <= 6; k++) { close_to(all[k] / (m[0] + m[1]), 0, k < 4 ? X : U); d[k] = q[1, k] / m[1] - q[0, k] / m[0] }
      close_to(d[1], X, X); close_to(d[2], Y, X); close_to(d[3], 0, X); close_to(d[4], U, U); close_to(d[5], V, U); close_to(d[6], 0, U)
      exit !(d[1] * d[5] - d[2] * d[4] > 0) }' rows
  true_that 't < 0 && t == t0' t="$(number s.h5 /Header/Time)" t0="$(number s.h5 /Collision/InitialTime)"
  true_that 'near(a, 48 * atan2(0, -1) / 180, 1e-14)' a="$(number s.h5 /Collision/ContactAngle)"
  true_that 'near(d, r0 + r1, 1e-14)' d="$(number s.h5 /Collision/ContactDistance)" r0="$(number s.h5 /Body/Radius0)" \
    r1="$(number s.h5 /Body/Radius1)"
}

@test "fields, materials, flaws, ids and both histories are carried" {
  mksphere -n 300 --radius 10km --layer iron:0.5 --layer basalt:0.5 --rotate 1 2>log | weibull >t.h5
  mksphere -n 100 --radius 5km --layer ice:0.5 --layer basalt:0.5 2>log | weibull -s 2 >i.h5
  collide -a 30deg -s 2km/s t.h5 i.h5 >s.h5
  n=$(field t.h5 ParticleIDs | wc -l)
  [ "$(field s.h5 ParticleIDs)" = "$(field t.h5 ParticleIDs; field i.h5 ParticleIDs | awk -v n="$n" '{print $1 + n}')" ]
  for name in Masses Density SmoothingLength FlawCount Damage; do
    [ "$(field s.h5 $name)" = "$(field t.h5 $name; field i.h5 $name)" ]
  done
  [ "$(h5dump -d /Materials/Name s.h5 | grep -o '"[a-z]*"' | tr '\n' ' ')" = '"iron" "basalt" "ice" ' ]
  [ "$(field s.h5 MaterialID | uniq | wc -l)" -gt 3 ]
  [ "$(field s.h5 MaterialID | sort | uniq -c | awk '{print $2}' | tr '\n' ' ')" = "0 1 2 " ]
  [[ $(h5dump -H -d /History s.h5) == *"{ ( 5 ) / ( 5 ) }"* ]]
  collide -a 30deg -s 2km/s t.h5 i.h5 >again.h5
  cmp s.h5 again.h5
}

@test "without gravity: straight on at constant speed, also in a plane" {
  body 1 1e20 t.h5
  run collide -n --no-gravity -a 30deg -s 3km/s --radius-target 1km --radius-impactor 1km --distance 10km t.h5 t.h5
  expect 0 InitialSpeed=3000 ContactSpeed=3000
  true_that 'near(t, -(sqrt(100 - 1) - sqrt(3)) / 3, 1e-9)' t="$(value InitialTime)"
  true_that 'near(x, 3000 * sin(atan2(0, -1) / 6) * -t, 1e-9)' x="$(value InitialX)" t="$(value InitialTime)"
  mksphere -d 2 -n 100 --radius 1km --layer basalt -o d.h5 2>log
  run collide -n --no-gravity -a 30deg -s 3km/s d.h5 d.h5
  [ "$(value ContactDistance)" = 2000 ]
}

@test "a body without a known radius gets that of its outermost particle, and is told so" {
  mksphere -n 4000 --radius 10km --layer basalt -o t.h5 2>log
  run collide -n -a 30deg -s 1vesc t.h5 t.h5
  [ "$(awk -F'\t' '/RadiusTarget/ {print $2, $4}' <<<"$output")" = "10000 /Body" ]
  for group in Header Units Materials History PartType0; do h5copy -i t.h5 -o bare.h5 -s "/$group" -d "/$group"; done
  run collide -n -a 30deg -s 1vesc bare.h5 t.h5
  [[ ${lines[0]} == "collide: warning: 'bare.h5' does not tell its radius: "*"outermost particle" ]]
  true_that 'near(r, 1e4, 0.06)' r="$(value RadiusTarget)"
}

@test "every mistake is one line" {
  body 300 9.43e20 t.h5
  bad 2 "which impact angle" collide -s 1vesc t.h5 t.h5
  bad 2 "which speed" collide -a 45deg t.h5 t.h5
  bad 2 "write degrees as 45deg" collide -a 45 -s 1vesc t.h5 t.h5
  bad 2 "not in 0..90 deg" collide -a 91deg -s 1vesc t.h5 t.h5
  bad 2 "speed: " collide -a 45deg -s 3parsec t.h5 t.h5
  bad 1 "not positive" collide -a 45deg -s -1vesc t.h5 t.h5
  bad 2 "distance: " collide -a 45deg -s 1vesc -d 3s t.h5 t.h5
  bad 1 "the bodies overlap" collide -a 45deg -s 1vesc -d 0.99 t.h5 t.h5
  bad 1 "the bodies overlap: their particles" collide -a 45deg -s 1vesc -d 2 --radius-target 1km --radius-impactor 1km t.h5 t.h5
  bad 1 "beyond the apoapsis" collide -a 45deg -s 0.5vesc t.h5 t.h5
  bad 2 "input" collide -a 45deg -s 1vesc t.h5
  bad 1 "'none.h5'" collide -a 45deg -s 1vesc t.h5 none.h5
  echo text >text.h5
  bad 1 "'text.h5'" collide -a 45deg -s 1vesc text.h5 t.h5
  mksphere -d 2 -n 100 --radius 1km --layer basalt -o d.h5 2>log
  bad 1 "only --no-gravity" collide -a 45deg -s 1km/s d.h5 d.h5
  bad 1 "dimensions" collide -a 45deg -s 1km/s --no-gravity d.h5 t.h5
  mksphere -d 1 -n 100 --radius 1km --layer basalt -o r.h5 2>log
  bad 1 "an approach needs a plane" collide -a 0 -s 1km/s --no-gravity r.h5 r.h5
}
