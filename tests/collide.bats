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

# same_orbit A B: two dry runs agree to nine digits in all that is no input.
same_orbit() {
  paste "$1" "$2" | awk -F'\t' '$1 ~ /^(Contact|Initial|Ecc|Anomaly|Angular)/ && ($2 - $6)^2 > 1e-18*($2^2 + 1) {print; bad = 1} END {exit bad}'
}

@test "angle, impact parameter or angular momentum; speed here or far away; distance or time" {
  body 30 9.43e20 t.h5
  body 20 3e20 i.h5
  collide -n -a 40deg -s 1.3vesc -d 6 t.h5 i.h5 >ref
  number_of() { awk -F'\t' -v n="$1" '$1 == n {print $2}' ref; }
  rc=$(number_of ContactDistance)
  b=$(number_of ImpactParameter) long=$(awk -v b="$(number_of ImpactParameter)" -v rc="$rc" 'BEGIN {printf "%.15g", b*rc/1e3}')
  for how in "-b $b -s 1.3vesc -d 6" "-b ${long}km -s $(number_of ContactSpeed)m/s -d $(number_of InitialDistance)m" \
    "-L $(number_of AngularMomentum) -s $(number_of SpeedAtInfinity)vinf -t $(number_of InitialTime | tr -d -)s"; do
    collide -n $how t.h5 i.h5 >other
    same_orbit ref other || { echo "$how"; return 1; }
  done
  collide -n -a 40deg -s 0.5vescvinf -d 6 t.h5 i.h5 >other # sqrt(1 + 0.25)
  collide -n -a 40deg -s 1.118033988749895vesc -d 6 t.h5 i.h5 >ref
  same_orbit ref other
}

@test "what is written comes to contact: --verify, from parabolic to 4 v_esc, bound, head-on to grazing, on any axis" {
  body 30 9.43e20 t.h5
  body 20 3e20 i.h5
  k=0
  for speed in 1vesc 4vesc 0.96vesc 0.75vesc; do
    for angle in 0 1deg 45deg 89.9deg; do
      axes=("" "--contact -z" "--contact 1,2,3" "--contact x --pole=-y")
      start=-d\ 4
      if [ $speed = 0.75vesc ]; then start=-d\ 1.2; fi
      collide -V -n -a $angle -s $speed $start ${axes[$((k++ % 4))]} t.h5 i.h5 >out 2>log || { cat log; return 1; }
      [[ $(cat log) == "collide: integrated to contact: time off by "* ]]
      true_that 'abs(t) < 1e-6 && near(v, w, 1e-9)' t="$(awk '/^VerifiedTime/ {print $2}' out)" \
        v="$(awk '/^VerifiedSpeed/ {print $2}' out)" w="$(awk '/^ContactSpeed\t/ {print $2}' out)"
    done
  done
  collide -V -a 30deg -s 2km/s --no-gravity t.h5 i.h5 >s.h5
  true_that 'near(a, atan2(0, -1) / 6, 1e-9)' a="$(number s.h5 /Collision/VerifiedAngle)"
}

# sums FILE: mass, centre, velocity, angular momentum about the origin of each BodyID, one a line.
sums() {
  paste <(field "$1" BodyID) <(field "$1" Masses) <(field "$1" Coordinates 3) <(field "$1" Velocities 3) | awk '
    { b = $1; m[b] += $2; for (k = 0; k < 6; k++) s[b, k] += $2*$(3 + k)
      l[b, 0] += $2*($4*$8 - $5*$7); l[b, 1] += $2*($5*$6 - $3*$8); l[b, 2] += $2*($3*$7 - $4*$6) }
    END { for (b = 0; b in m; b++) { printf "%.17g", m[b]; for (k = 0; k < 6; k++) printf " %.17g", s[b, k]/m[b]
      printf " %.17g %.17g %.17g\n", l[b, 0], l[b, 1], l[b, 2] } }'
}

@test "contact on a chosen axis: the direction comes out, and the pole" {
  body 200 9.43e20 t.h5
  body 100 3e20 i.h5
  collide -a 30deg -s 1.2vesc -d 1.000001 --contact -x --pole 0,3,4 t.h5 i.h5 >s.h5
  sums s.h5 | awk '{ for (k = 1; k <= 10; k++) q[NR, k] = $k } END {
    d = 0; for (k = 2; k <= 4; k++) { r[k] = q[2, k] - q[1, k]; d += r[k]^2 }
    lx = q[1, 8] + q[2, 8]; ly = q[1, 9] + q[2, 9]; lz = q[1, 10] + q[2, 10]; l = sqrt(lx^2 + ly^2 + lz^2)
    exit !(r[2] < -0.999999*sqrt(d) && ly > 0.599999*l && ly < 0.600001*l && lz > 0.799999*l) }'
  collide -n -a 30deg -s 1.2vesc --contact z t.h5 i.h5 | awk -F'\t' '$1 ~ /^(ContactZ|PoleX)$/ && $2 == 1 {n++} END {exit n != 2}'
}

@test "state vectors: the same orbit from a state as from angle and speed; nothing moves" {
  body 200 9.43e20 t.h5
  body 100 3e20 i.h5
  collide -n -a 40deg -s 1.3vesc -d 6 --contact 1,2,3 t.h5 i.h5 >ref
  state=$(awk -F'\t' '$1 ~ /^Initial(X|Y|Z|Vx|Vy|Vz)$/ {printf "%s%s", n++ ? "," : "", $2}' ref)
  collide -n -V --state "$state" t.h5 i.h5 >other 2>log
  for name in ContactSpeed ContactAngle InitialX InitialVz InitialTime ContactX ContactZ PoleX PoleY AngularMomentum; do
    true_that 'near(a, b, 1e-8)' a="$(awk -F'\t' -v n=$name '$1 == n {print $2}' ref)" b="$(awk -F'\t' -v n=$name '$1 == n {print $2}' other)"
  done
  collide -n --state "$state" -d 2 t.h5 i.h5 >other # later on the same orbit
  collide -n -a 40deg -s 1.3vesc -d 2 --contact 1,2,3 t.h5 i.h5 >ref
  true_that 'near(a, b, 1e-8)' a="$(awk '/^InitialX/ {print $2}' ref)" b="$(awk '/^InitialX/ {print $2}' other)"
}

@test "a dump as both bodies: they go on as they were, with their ids and numbers" {
  mksphere -n 200 --radius 10km --layer basalt --rotate 1 --spin 3h 2>log | weibull >t.h5
  mksphere -n 100 --radius 6km --layer ice:0.5 --layer basalt:0.5 2>log | weibull -s 2 >i.h5
  collide -a 30deg -s 0.9vesc -d 2 t.h5 i.h5 >s.h5
  collide --state files --select-target body:0 --select-impactor body:1 --radius-target body --radius-impactor body -V s.h5 s.h5 >again.h5 2>log
  for name in ParticleIDs BodyID MaterialID FlawThresholds Density; do [ "$(field s.h5 $name)" = "$(field again.h5 $name)" ]; done
  paste <(field s.h5 Coordinates 3) <(field again.h5 Coordinates 3) | awk '{ for (k = 1; k <= 3; k++) if (($k - $(k + 3))^2 > 1e-10) exit 1 }'
  paste <(field s.h5 Velocities 3) <(field again.h5 Velocities 3) | awk '{ for (k = 1; k <= 3; k++) if (($k - $(k + 3))^2 > 1e-22) exit 1 }'
  for name in ContactAngle ContactSpeed InitialTime; do
    true_that 'near(a, b, 1e-9)' a="$(number s.h5 /Collision/$name)" b="$(number again.h5 /Collision/$name)"
  done
  [ "$(number again.h5 /Body/Radius1)" = "$(number s.h5 /Body/Radius1)" ]
}

@test "a secondary impact: one fragment of a dump on a new body, and a new body on all that is left" {
  mksphere -n 200 --radius 10km --layer basalt --rotate 1 2>log | weibull >t.h5
  mksphere -n 100 --radius 6km --layer ice 2>log | weibull -s 2 >i.h5
  collide -a 30deg -s 0.95vesc -d 3 t.h5 i.h5 >s.h5
  fof -o f.h5 s.h5 >fragments
  collide --select-impactor fragment:2 -a 45deg -s 1.5vesc t.h5 f.h5 >second.h5 2>log
  grep -q "^collide: warning: 't.h5' lacks what 'f.h5' has: zeros for FragmentID$" log
  n=$(field t.h5 ParticleIDs | wc -l)
  [ "$(field second.h5 BodyID | uniq -c | tr -s ' \n' ' ')" = " $n 0 $(field i.h5 ParticleIDs | wc -l) 1 " ]
  true_that 'near(r, v, 1e-9)' r="$(number second.h5 /Collision/RadiusImpactor)" v="$(awk -F'\t' 'NR == 3 {for (k = 1; k <= NF; k++) if ($k ~ /^radius/) c = k} $1 == 2 {print $c}' fragments)"
  [ "$(field second.h5 FlawThresholds | tail -20)" = "$(field s.h5 FlawThresholds | tail -20)" ]
  [ "$(field second.h5 ParticleIDs | sort -u | wc -l)" = "$(field second.h5 ParticleIDs | wc -l)" ]
  [ -n "$(number s.h5 /Collision/Apoapsis)" ]
  [ -z "$(number second.h5 /Collision/Apoapsis 2>log)" ]
  collide -a 45deg -s 1.5vesc -d 300km --radius-target volume s.h5 i.h5 >third.h5 2>log
  [ "$(field third.h5 BodyID | uniq | tr '\n' ' ')" = "0 1 2 " ]
  [ "$(number third.h5 /Collision/FirstBodyImpactor)" = 2 ]
  [ "$(number third.h5 /Body/Radius2)" = "$(number i.h5 /Body/Radius0)" ] && [ "$(number third.h5 /Body/Radius1)" = "$(number i.h5 /Body/Radius0)" ]
}

@test "spins: a vector, and period, obliquity, node; both in the total" {
  body 1500 9.43e20 t.h5 --rotate 1
  body 700 3e20 i.h5 --rotate 2 --spin 10h
  collide -a 48deg -s 1.7vesc -d 6 --contact x --spin-target 6h,30deg,60deg --spin-impactor 1e-4rad/s,0,2e-4rad/s t.h5 i.h5 >s.h5
  pi=$(awk 'BEGIN {printf "%.17g", atan2(0, -1)}')
  # the equator rises 60 deg from +x, so the pole leans 30 deg past +x towards -y
  true_that 'near(x, w*cos(pi/6)/2, 1e-9) && near(y, -w/4, 1e-9) && near(z, w*cos(pi/6), 1e-9)' w="$(awk -v p=$pi 'BEGIN {printf "%.17g", p/10800}')" pi=$pi \
    x="$(number s.h5 /Collision/SpinTargetX)" y="$(number s.h5 /Collision/SpinTargetY)" z="$(number s.h5 /Collision/SpinTargetZ)"
  true_that 'near(o, pi/6, 1e-9) && near(p, 21600, 1e-9)' pi=$pi o="$(number s.h5 /Collision/ObliquityTarget)" p="$(number s.h5 /Collision/SpinPeriodTarget)"
  true_that 'near(x, 1e-4, 1e-9) && near(z, 2e-4, 1e-9)' x="$(number s.h5 /Collision/SpinImpactorX)" z="$(number s.h5 /Collision/SpinImpactorZ)"
  sums s.h5 >sums # their sum is the total
  for k in 8:X 9:Y 10:Z; do
    true_that 'abs(a - b) < 1e-10*c' a="$(awk -v k="${k%:*}" '{s += $k} END {printf "%.17g", s}' sums)" \
      b="$(number s.h5 /Collision/TotalAngularMomentum${k#*:})" c="$(number s.h5 /Collision/TotalAngularMomentum)"
  done
  true_that 'near(l, 0.4*m*r^2*2*pi/21600, 0.03)' pi=$pi m="$(number s.h5 /Collision/MassTarget)" r="$(number s.h5 /Collision/RadiusTarget)" \
    l="$(for k in X Y Z; do number s.h5 /Collision/AngularMomentumTarget$k; done | awk '{s += $1^2} END {printf "%.9g", sqrt(s)}')"
  collide -n -a 48deg -s 1.7vesc --spin-impactor none t.h5 i.h5 | grep -q '^SpinPeriodImpactor	\(inf\|[0-9.]*e+\(1[5-9]\|[2-9]\)\)'
  collide -n -a 48deg -s 1.7vesc --spin-impactor=-10h t.h5 i.h5 | grep -q '^ObliquityImpactor	180	'
  run collide -n -a 48deg -s 1.7vesc --spin-target 1h t.h5 i.h5
  [[ ${lines[0]} == "collide: warning: 't.h5' spins faster than its surface can orbit it" ]]
}

@test "a spinning body is turned as a whole, stress and all" {
  body 300 9.43e20 t.h5 --spin 8h
  n=$(field t.h5 ParticleIDs | wc -l)
  yes '1 2 3 4 5 6' | head -n "$n" >rows # xx xy xz yy yz zz
  cp t.h5 stressed.h5
  put stressed.h5 DeviatoricStress 6 <rows
  collide -a 0 -s 1vesc --contact x --spin-target 8h,90deg,0deg stressed.h5 t.h5 >s.h5 2>log
  # about x by 90 degrees: y -> z, z -> -y; the pole points to -y
  [ "$(field s.h5 DeviatoricStress 6 | head -1 | awk '{for (k = 1; k <= NF; k++) printf "%d ", $k + ($k > 0 ? 0.5 : -0.5)}')" = "1 -3 2 6 -5 4 " ]
  true_that 'near(y, -2*atan2(0, -1)/28800, 1e-9)' y="$(number s.h5 /Collision/SpinTargetY)"
  paste <(field t.h5 Coordinates 3) <(field s.h5 Coordinates 3 | head -n "$n") | awk -v x="$(sums s.h5 | head -1 | cut -d' ' -f2)" '
    { if (($4 - x - $1)^2 + ($5 + $3)^2 + ($6 - $2)^2 > 1e-3) exit 1 }'
  # towards y as a vector: the shortest way about the node, by 180 degrees and then 90
  collide -a 0 -s 1vesc --contact x --spin-target 0rad/s,2e-4rad/s,0 t.h5 t.h5 >s.h5
  paste <(field t.h5 Coordinates 3) <(field s.h5 Coordinates 3 | head -n "$n") | awk -v x="$(sums s.h5 | head -1 | cut -d' ' -f2)" '
    { if (($4 - x + $1)^2 + ($5 - $3)^2 + ($6 - $2)^2 > 1e-3) exit 1 }'
}

@test "unknown fields of both are kept; one that a turn may concern gets a word" {
  body 40 1e20 t.h5
  body 20 1e20 i.h5
  n=$(field t.h5 ParticleIDs | wc -l) k=$(field i.h5 ParticleIDs | wc -l)
  seq "$n" | put t.h5 Colour 1
  yes '1 0 0' | head -n "$k" | put i.h5 Magnetisation 3
  run collide -a 0 -s 1vesc --spin-impactor none,90deg t.h5 i.h5 -o s.h5
  [[ $output == *"'i.h5' is turned, its unknown field 'Magnetisation' is not"* ]]
  [ "$(field s.h5 Colour)" = "$(seq "$n"; yes 0 | head -n "$k")" ]
  [ "$(field s.h5 Magnetisation 3 | tail -1)" = "1 0 0" ]
}

@test "long bodies side by side do not overlap; into each other they do" {
  body 100 1e20 t.h5
  body 100 1e20 i.h5
  collide -a 0 -s 1vesc -d 8 --contact x t.h5 i.h5 -o long.h5 # a dumbbell along x
  at() { collide -n --no-gravity -a 0 -s 1km/s --radius-target 300km -d "$1" --contact "$2" long.h5 i.h5; }
  at 700km y >out
  collide -n --no-gravity -a 70deg -s 1km/s --radius-target 300km -d 1200km long.h5 i.h5 >out # a plane across the contact parts them
  bad 1 "the bodies overlap: their particles reach" collide -n --no-gravity -a 0 -s 1km/s --radius-target 300km -d 700km --contact x long.h5 i.h5
}

@test "every mistake is one line" {
  body 300 9.43e20 t.h5
  bad 2 "which impact angle" collide -s 1vesc t.h5 t.h5
  bad 2 "give one of" collide -a 45deg -b 0.5 -s 1vesc t.h5 t.h5
  bad 2 "either --distance or --time" collide -a 45deg -s 1vesc -d 3 -t 1h t.h5 t.h5
  bad 2 "not positive" collide -a 45deg -s 1vesc -t -1h t.h5 t.h5
  bad 1 "the bound orbit is at its apoapsis" collide -a 45deg -s 0.8vesc -t 10d t.h5 t.h5
  bad 1 "impact parameter 1.1 r1 + r2 is not in 0..1" collide -b 1.1 -s 1vesc t.h5 t.h5
  bad 2 "impact parameter: " collide -b 3kg -s 1vesc t.h5 t.h5
  bad 1 "more than that of a grazing contact" collide -L 1e40 -s 1vesc t.h5 t.h5
  bad 2 "negative" collide -L -1 -s 1vesc t.h5 t.h5
  bad 2 "speed at infinity" collide -a 45deg -s -1km/svinf t.h5 t.h5
  bad 2 "--contact: " collide -a 45deg -s 1vesc --contact w t.h5 t.h5
  bad 2 "no direction" collide -a 45deg -s 1vesc --contact 0,0,0 t.h5 t.h5
  bad 1 "not at right angles" collide -a 45deg -s 1vesc --contact 1,1,0 --pole x t.h5 t.h5
  bad 2 "leave those out" collide -a 45deg --state files t.h5 t.h5
  bad 2 "its own directions" collide --state files --pole x t.h5 t.h5
  bad 2 "X,Y,Z,VX,VY,VZ" collide --state 1,2 t.h5 t.h5
  bad 2 "--state: " collide --state 1e7,0,0,1kg,0,0 t.h5 t.h5
  bad 1 "pass each other" collide --state 1e7,0,0,-1e3,1e4,0 t.h5 t.h5
  bad 1 "move apart" collide --state 1e7,0,0,1e4,0,0 t.h5 t.h5
  bad 1 "overlap" collide --state files t.h5 t.h5
  bad 2 "infinitely fast" collide -a 45deg -s 1vesc --spin-target 0 t.h5 t.h5
  bad 2 "spin: " collide -a 45deg -s 1vesc --spin-target 3kg t.h5 t.h5
  bad 2 "obliquity" collide -a 45deg -s 1vesc --spin-target 6h,200deg t.h5 t.h5
  bad 2 "obliquity, node and meridian" collide -a 45deg -s 1vesc --spin-target 6h,1deg,2deg,3deg,4deg t.h5 t.h5
  bad 2 "no direction" collide -a 45deg -s 1vesc --spin-target 0rad/s,0,0 t.h5 t.h5
  bad 2 "3 numbers" collide -a 45deg -s 1vesc --spin-target 1rad/s,0 t.h5 t.h5
  bad 1 "lacks field 'FragmentID' (made by fof)" collide -a 45deg -s 1vesc --select-target fragment:1 t.h5 t.h5
  bad 1 "nothing belongs to body:7" collide -a 45deg -s 1vesc --select-impactor body:7 t.h5 t.h5
  bad 1 "is none of" collide -a 45deg -s 1vesc --select-impactor moon t.h5 t.h5
  bad 1 "radius: " collide -a 45deg -s 1vesc --radius-target big t.h5 t.h5
  bad 1 "not positive" collide -a 45deg -s 1vesc --radius-impactor -3km t.h5 t.h5
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
  bad 1 "discs meet in the plane" collide -a 45deg -s 1km/s --no-gravity --contact z d.h5 d.h5
  bad 1 "it rotates about z only" collide -a 45deg -s 1km/s --no-gravity --spin-target 1h,30deg d.h5 d.h5
  bad 1 "dimensions" collide -a 45deg -s 1km/s --no-gravity d.h5 t.h5
  mksphere -d 1 -n 100 --radius 1km --layer basalt -o r.h5 2>log
  bad 1 "an approach needs a plane" collide -a 0 -s 1km/s --no-gravity r.h5 r.h5
}
