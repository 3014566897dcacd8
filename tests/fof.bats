# SPDX-License-Identifier: GPL-3.0-or-later
# fof on two spheres of known mass: table, escape speed (001 eq. 74), filters, ids, errors.

load h5

setup_file() {
  cd "$BATS_FILE_TMPDIR"
  mksphere -n 2000 --mass 9e20 --layer basalt:0.7 --layer ice:0.3 -o a.h5
  mksphere -n 700 --mass 3e20 --layer basalt:1 -o b.h5
  collide a.h5 b.h5 --angle 48deg --speed 1.7vesc --distance 4 -o two.h5
}
setup() { cd "$BATS_FILE_TMPDIR"; }

# column NAME [FILE]: a column of the table by its name, rows one below the other.
column() {
  awk -F'\t' -v name="$1" '/^# id/ { for (k = 1; k <= NF; k++) if ($k == name || index($k, name " [") == 1) at = k }
    !/^#/ { print at ? $at : "no such column" }' "${2:-table}"
}
# near A B: equal to 1e-6.
near() { awk -v a="$1" -v b="$2" 'BEGIN { d = a - b; exit !(d * d <= 1e-12 * b * b) }'; }

@test "two bodies are two fragments of their masses, the larger first" {
  fof two.h5 >table
  [ "$(grep -vc '^#' table)" = 2 ]
  mapfile -t m < <(column mass)
  near "${m[0]}" 9e20
  near "${m[1]}" 3e20
  [ "$(column near | tr '\n' ' ')" = "2 1 " ]
  [ "$(column water | head -1)" = 30 ]
  [ "$(column water | tail -1)" = 0 ]
  near "$(column ice_from_0 | head -1)" 2.7e20
  [ "$(column from_0 | tail -1)" = 0 ]
}

@test "v_esc is eq. 74: the mass of the nearer fragments" {
  fof two.h5 >table
  [ "$(column v_esc | head -1)" = 0 ] # the larger one is nearer to the barycentre: nothing within
  near "$(column v_esc | tail -1)" "$(awk -v m=9e20 -v r="$(column r | tail -1)" 'BEGIN { printf "%.9g", sqrt(2 * 6.6743e-11 * m / r) }')"
}

@test "on its way to the collision the smaller body is accreted, fast or not" {
  fof two.h5 >table
  [ "$(column fate | tail -1)" = accreted ]
  awk -v x="$(column v_rel/v_esc | tail -1)" 'BEGIN { exit !(x > 1) }'
}

# placed FILE "x y vx vy"...: its fragments, by mass, put there [km, m/s]: placed.h5.
placed() {
  rm -f placed.h5
  fof -o ids.h5 "$1" >/dev/null
  shift
  paste -d' ' <(field ids.h5 FragmentID) <(field ids.h5 Coordinates 3) >was
  for where; do echo "to $where"; done | awk '
    BEGIN { b = 1 }
    $1 == "to" { X[b] = $2 * 1e3; Y[b] = $3 * 1e3; v[b++] = $4 " " $5 " 0"; next }
    NR != FNR && FNR == 1 { pass++ }
    pass == 1 { n[$1]++; x[$1] += $2; y[$1] += $3; z[$1] += $4; next }
    { printf "%.17g %.17g %.17g %s\n", $2 - x[$1] / n[$1] + X[$1], $3 - y[$1] / n[$1] + Y[$1], $4 - z[$1] / n[$1], v[$1] }' - was was >is
  without "Coordinates Velocities" ids.h5 placed.h5
  cut -d' ' -f1-3 is | put placed.h5 Coordinates 3
  cut -d' ' -f4-6 is | put placed.h5 Velocities 3
}
# fates FILE PLACE...: what becomes of them.
fates() { placed "$@" && fof placed.h5 >table && column fate | tr '\n' ' '; }

@test "survivors are judged by their pair alone, smaller fragments by eq. 74 too" {
  mksphere -n 300 --mass 9e20 --layer basalt:1 -o big.h5
  mksphere -n 20 --mass 5e19 --layer basalt:1 -o small.h5
  collide big.h5 big.h5 --angle 0deg --speed 2vesc --distance 4 -o pair.h5
  collide pair.h5 small.h5 --angle 0deg --speed 2vesc --distance 6 -o three.h5
  # 3000 km apart: v_esc = sqrt(2 G 1.8e21 kg/3e6 m) = 283 m/s, circular 200 m/s
  [ "$(fates pair.h5 "-1500 0 -145 0" "1500 0 145 0")" = "escape escape " ]
  [ "$(fates pair.h5 "-1500 0 -138 0" "1500 0 138 0")" = "accreted accreted " ] # fall back onto each other
  [ "$(fates pair.h5 "-1500 0 0 -110" "1500 0 0 110")" = "bound bound " ]       # an ellipse, 3000 to 4600 km
  [ "$(fates two.h5 "-750 0 -75 0" "2250 0 225 0")" = "escape escape " ] # 9e20 and 3e20 kg: 231 m/s
  # the small one: at rest between them; around one of them (252 m/s is circular); behind, where 1.8e21 kg
  # are nearer, with 200 m/s to escape, and out of the reach of either
  local parting=("-1500 0 -150 0" "1500 0 150 0")
  [ "$(fates three.h5 "${parting[@]}" "0 0 0 0")" = "escape escape accreted " ]
  [ "$(fates three.h5 "${parting[@]}" "1500 1000 402 0")" = "escape escape bound " ]
  [ "$(fates three.h5 "${parting[@]}" "0 6000 0 150")" = "escape escape bound " ]
  [ "$(fates three.h5 "${parting[@]}" "0 6000 0 300")" = "escape escape escape " ]
}

@test "momenta of the fragments cancel in the barycentric frame" {
  fof two.h5 >table
  paste <(column mass) <(column vx) | awk '{ p += $1 * $2; q += $1 * ($2 < 0 ? -$2 : $2) } END { exit !(p * p < 1e-12 * q * q) }'
}

@test "filters by density, material and size" {
  [ "$(fof --min-density 0.75rho0 two.h5 | grep -vc '^#')" = 2 ]
  [ "$(fof --min-density 2000 two.h5 | column n /dev/stdin | awk '{ n += $1 } END { print n }')" -lt 2000 ]
  [ "$(fof --min-density 2g/cc two.h5 | grep -v '^#')" = "$(fof --ignore ice two.h5 | grep -v '^#')" ]
  [ "$(fof --min-particles 1000 two.h5 | grep -vc '^#')" = 1 ]
  run fof --min-density 1.5rho0 two.h5
  [ "$status" = 0 ]
  [[ ${lines[2]} == "# id"* ]]
  [ "${#lines[@]}" = 3 ]
}

@test "a density floor per material, a fixed length, a smallest mass" {
  [ "$(fof --min-density ice:2000 two.h5 | grep -v '^#')" = "$(fof --ignore ice two.h5 | grep -v '^#')" ]
  [ "$(fof --min-density 2g/cc --min-density ice:0.5rho0 two.h5 | grep -v '^#')" = "$(fof two.h5 | grep -v '^#')" ]
  # the spacing is 71 km (2000 particles in 501 km, 700 in 299 km: 54 km): both whole, or all single
  [ "$(fof --length 90km two.h5 | grep -v '^#')" = "$(fof two.h5 | grep -v '^#')" ]
  [ "$(fof --length 10km two.h5 | grep -vc '^#')" = "$(field two.h5 ParticleIDs | wc -l)" ]
  [ "$(fof --min-mass 4e20 two.h5 | grep -vc '^#')" = 1 ]
}

@test "ids are written, and the same command gives the same bytes for any number of threads" {
  OMP_NUM_THREADS=1 fof -o ids1.h5 two.h5 >t1
  OMP_NUM_THREADS=3 fof -o ids2.h5 two.h5 >t2
  cmp t1 t2
  OMP_NUM_THREADS=3 fof -o ids1.h5 two.h5 >/dev/null
  mv ids1.h5 again.h5
  OMP_NUM_THREADS=1 fof -o ids1.h5 two.h5 >/dev/null
  cmp ids1.h5 again.h5
  render --centre fragment:2 -o x.png ids1.h5
  run render --centre fragment:3 -o y.png ids1.h5
  [ "$status" = 1 ]
  [ "$output" = "render: --centre: 'ids1.h5': nothing belongs to fragment:3" ]
  [ ! -e y.png ]
}

@test "from a pipe" {
  [ "$(fof <two.h5 | grep -v '^#')" = "$(fof two.h5 | grep -v '^#')" ]
}

# components ARGUMENTS: tests/components.py, where python has what it needs.
components() { reads 'numpy h5py scipy.spatial scipy.sparse' "exec(open('$BATS_TEST_DIRNAME/components.py').read())" "$@"; }

@test "the connected components of scipy, on random particles and on a collision" {
  for seed in 1 2; do
    components --random two.h5 random.h5 $seed
    for link in 0.3 1; do
      fof --link $link -o ids.h5 random.h5 >/dev/null
      components random.h5 ids.h5 $link
    done
  done
  mksphere -n 300 --radius 100km --layer basalt -o t.h5
  mksphere -n 100 --radius 60km --layer ice -o i.h5
  collide t.h5 i.h5 --angle 45deg --speed 3vesc --distance 1.1 -o s.h5
  solver -o run --end +1500s --every 500s s.h5
  for k in 0 3; do
    fof -o ids.h5 run/snap_000$k.h5 >/dev/null
    components run/snap_000$k.h5 ids.h5 1
  done
}

fails() { # fails STATUS TEXT COMMAND...: one line that contains the text
  local want=$1 text=$2
  shift 2
  run "$@"
  echo "$status: $output"
  [ "$status" = "$want" ] && [ "${#lines[@]}" = 1 ] && [[ $output == "fof: "*"$text"* ]]
}

@test "bad input is one line" {
  echo text >text.h5
  head -c 20000 two.h5 >short.h5
  fails 1 "lacks field 'Damage' (made by weibull)" fof --max-damage 1 two.h5
  fails 1 "no material 'icy' in this file (did you mean 'ice'?)" fof --ignore icy two.h5
  fails 1 "'none.h5'" fof none.h5
  fails 1 "'text.h5'" fof text.h5
  fails 1 "'short.h5'" fof short.h5
  fails 1 "" bash -c 'fof </dev/null'
  fails 1 "No space left" bash -c 'fof two.h5 >/dev/full'
  fails 1 "" fof -o no/such/folder/a.h5 two.h5
  fails 1 "2kg" fof --min-density 2kg two.h5
  fails 2 "--link must be positive" fof --link 0 two.h5
  fails 2 "exclude each other" fof --link 1 --length 3km two.h5
  fails 1 "no material 'basal'" fof --min-density basal:3 two.h5
  fails 2 "--min-particles" fof --min-particles 0 two.h5
  fails 2 "name a file" fof -o - two.h5
}
