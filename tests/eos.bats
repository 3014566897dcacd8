#!/usr/bin/env bats
# SPDX-License-Identifier: GPL-3.0-or-later
# eos: values, grids, pairs, and every mistake in one line with its exit code.

load h5

bad() { # bad CODE MESSAGE ARGUMENTS...
  local code=$1 message=$2
  shift 2
  run eos "$@"
  [ "$status" = "$code" ]
  [ "${#lines[@]}" = 1 ]
  [[ ${lines[0]} == eos*": "*"$message"* ]]
}

@test "basalt at a reference point, in SI and with units" {
  run eos --material basalt --rho 4000 --u 1e7
  [ "${lines[0]}" = $'# rho [kg/m^3]\tu [J/kg]\tp [Pa]\tc [m/s]' ]
  awk -F'\t' '{exit !($3 / 9.848912564e10 - 1 < 1e-9 && 1 - $3 / 9.848912564e10 < 1e-9)}' <<<"${lines[1]}"
  awk -F'\t' '{exit !($4 / 9386.748242 - 1 < 1e-8 && 1 - $4 / 9386.748242 < 1e-8)}' <<<"${lines[1]}"
  [ "$(eos -m basalt -r 4g/cc -u 10MJ/kg)" = "$output" ]
}

@test "lists and grids: every density with every energy, ends exact" {
  run eos -m ice -r 900,log:1:1000:4 -u 0:1MJ/kg:3
  [ "${#lines[@]}" = 16 ]
  [ "$(awk 'NR > 1 {print $1}' <<<"$output" | uniq | tr '\n' ' ')" = "900 1 10 100 1000 " ]
  [ "$(awk 'NR > 1 && NR < 5 {print $2}' <<<"$output" | tr '\n' ' ')" = "0 500000 1000000 " ]
}

@test "pairs from stdin give what options give" {
  run eos -m iron - <<<$'# a comment\n7800 0\n\n 8.5g/cc\t0.2MJ/kg'
  [ "$status" = 0 ]
  [ "${#lines[@]}" = 3 ]
  [ "${lines[2]}" = "$(eos -m iron -r 8500 -u 2e5 | tail -1)" ]
}

@test "--list has the materials of the folder, and each of them works" {
  for f in "$BRECCIA_MATERIALS"/*.cfg; do
    name=$(basename "$f" .cfg)
    eos --list | grep -qx "$name"
    eos -m "$name" -r 1000 -u 1e5 >/dev/null
    [ "$(eos -m "$name" -r 1000 -u 1e5)" = "$(eos -m "$f" -r 1000 -u 1e5)" ]
  done
}

@test "a locally isothermal disk needs --radius, others refuse it" {
  f=$BATS_TEST_TMPDIR/disk.cfg
  echo 'name = "disk"; eos = { form = "local_isothermal"; aspect = 0.05; mass = "1 Msun"; };' >"$f"
  bad 2 "needs --radius" -m "$f" -r 1 -u 0
  bad 2 "--radius means nothing" -m basalt -r 1 -u 0 --radius 1au
  run eos -m "$f" -r 1 -u 0 --radius 1au
  awk 'NR == 2 {exit !($4 > 1488 && $4 < 1490)}' <<<"$output" # 0.05 x 29.78 km/s
}

@test "mistakes" {
  bad 1 "unknown material 'bassalt' (did you mean 'basalt'?)" -m bassalt -r 1 -u 1
  bad 1 "cannot open './x.cfg'" -m ./x.cfg -r 1 -u 1
  bad 1 "density must be above 0" -m basalt -r 1,0 -u 1
  bad 2 "--material is missing" -r 1 -u 1
  bad 2 "--rho and --u are needed" -m basalt -r 1
  bad 2 "is not LOW:HIGH:N" -m basalt -r 1:2 -u 1
  bad 2 "2 to 10000000 points" -m basalt -r 1:2:1 -u 1
  bad 2 "above 0" -m basalt -r log:0:2:3 -u 1
  bad 2 "not 'km'" -m basalt -r 1km -u 1
  bad 2 "not a number" -m basalt -r 1,,2 -u 1
  bad 2 "the only input is -" -m basalt -r 1 -u 1 x
  bad 2 "not both" -m basalt -r 1 -u 1 -
  bad 2 "--list goes alone" --list -m basalt
  bad 1 "stdin:2: a density and an energy" -m basalt - <<<$'1 2\n3'
  bad 1 "stdin:1: " -m basalt - <<<'1 x'
  bad 1 "no pairs" -m basalt - </dev/null
  run bash -c 'eos -m basalt -r 1 -u 1 > /dev/full'
  [ "$status" = 1 ]
}

@test "a mistake in a material file names its line" {
  f=$BATS_TEST_TMPDIR/bad.cfg
  printf 'name = "x";\neos = {\n  form = "liquid"; rho0 = 1000;\n  cc = 5; };\n' >"$f"
  bad 1 "bad.cfg:4: unknown key 'cc' (did you mean 'c'?)" -m "$f" -r 1 -u 1
}

# near TOLERANCE: the two numbers of each line of stdin, one line at least, agree to that.
near() { awk -v d="$1" 'NF != 2 || $1 / $2 - 1 > d || 1 - $1 / $2 > d {bad = 1} END {exit bad || !NR}'; }

@test "temperature, entropy and pressure find the states back" {
  run eos -m iron -r 8000 -u 1MJ/kg -T
  IFS=$'\t' read -r rho u p c t s phase <<<"${lines[1]}"
  for given in "-r 8000 -t $t" "-r 8000 -s $s" "-p $p -u 1e6" "-p $p -t $t" "-p $p -s $s"; do
    eos -m iron $given | awk 'NR > 1 {print $1, 8000; print $2, 1e6}' | near 1e-6
  done
}

@test "an isentrope keeps its entropy, and a shock the jump conditions" {
  [ "$(eos -m basalt -i 3g/cc,1MJ/kg -r 2700:4000:5 -T | awk 'NR > 1 {printf "%.3f\n", $6}' | uniq | wc -l)" = 1 ]
  # p, u and rho behind a shock into basalt at rest: p = rho0 Us up, u = up^2/2, mass
  eos -m basalt -H 500m/s,1km/s,5km/s |
    awk -v OFMT=%.15g 'NR > 1 {print $3, 2700 * $6 * $5; print $2, $5 * $5 / 2; print $1 * ($6 - $5), 2700 * $6}' | near 1e-6
  # five digits from an independent program, as in test_eos
  eos -m basalt -H 1km/s | awk 'NR > 1 {print $6, 4683.9}' | near 1.1e-5
}

@test "eos table: every format, there and back, in every program" {
  cd "$BATS_TEST_TMPDIR"
  run eos table -m iron -r log:5000:30000:150 -t log:20:20000:60 -f sesame -o iron.txt
  [ "$status" = 0 ]
  [[ $output == *"152 x 60 nodes"*"at rest 77"*"within 1e-4 of the law in the middle of 9"* ]]
  eos table --from iron.txt -o iron.h5
  eos table --from iron.h5 -f sesame -o again.txt
  cmp iron.txt again.txt
  eos table --from iron.h5 -f miluph -u 0:4e7:200 -o iron.aneos
  eos table --from iron.aneos -t log:100:10000:50 -f sesame -r log:6000:20000:100 -o third.txt
  for file in iron.txt iron.h5 iron.aneos third.txt; do
    echo "name = \"t\"; eos = { form = \"table\"; file = \"$file\"; };" >t.cfg
    for at in "-r 9000 -t 2000" "-p 100GPa -t 3000" "-r 12g/cc -u 3e6"; do
      paste <(eos -m ./t.cfg $at) <(eos -m iron $at) | awk 'NR > 1 {print $3, $7; print $4, $8}' | near 1e-4
    done
  done
  echo 'name = "t"; eos = { form = "table"; file = "iron.h5"; };' >t.cfg
  mksphere -n 200 --mass 1e23 --layer ./t.cfg --temperature 500 -o body.h5
  mksphere -n 200 --mass 1e23 --layer iron --temperature 500 -o law.h5
  paste <(relax --profile-only body.h5) <(relax --profile-only law.h5) |
    awk '!/#/ {w = NF / 2; if (NR % 100 == 0) print $3, $(3 + w); end = $1 " " $(1 + w)} END {print end}' | near 1e-6
  solver -o run --end 1 --every 1 body.h5
  [ -s run/snap_0001.h5 ]
  eos fill body.h5 -o full.h5 # 500 K and one entropy at the start, of the table as of the law
  eos fill law.h5 | eos fill -o both.h5
  for file in full both; do field $file.h5 Temperature | awk '{print $1, 500}' | near 1e-5; done
  paste <(field full.h5 Entropy) <(field both.h5 Entropy) | near 1e-4
  rm iron.h5
  run solver -o run2 --end 1 --every 1 body.h5
  [ "$status" = 1 ]
  [[ $output == *"/Materials/t:1: no table 'iron.h5'"* ]]
  cp iron.txt iron.h5
  run solver -o run2 --end 1 --every 1 body.h5
  [[ $output == *"has the checksum"* ]]
}

@test "mistakes with tables and curves" {
  local t="-m basalt -r 2e3:3e3:5"
  bad 2 "--material or --from" table -o x
  bad 2 "needs --rho and --u" table -m basalt -o x
  bad 2 "--output is missing" table $t -u 0:1:4
  bad 2 "--u or --temperature, not both" table $t -u 0:1:4 -t 1:2:4 -o x
  bad 2 "'json'" table $t -u 0:1e6:4 -f json -o x
  bad 1 "needs an axis of temperatures" table $t -u 0:1e6:4 -f sesame -o "$BATS_TEST_TMPDIR/x"
  [ ! -e "$BATS_TEST_TMPDIR/x" ]
  bad 1 "energies, at least 4" table $t -u 0,1 -o x
  bad 1 "cannot open 'none'" table --from none
  bad 2 "not both" -m basalt -r 1 -p 1 -u 1
  bad 2 "one of --u" -m basalt -r 1 -t 1 -u 1
  bad 2 "is not RHO,U" -m basalt -r 1 -i 2700
  bad 2 "not both" -m basalt -r 1 -i 2700,0 -H 1
  bad 2 "one density" -m basalt -r 1,2 -u 0 -H 1
  bad 1 "no state at" -m basalt -p -1e12 -u 0
}
