#!/usr/bin/env bats
# SPDX-License-Identifier: GPL-3.0-or-later
# eos: values, grids, pairs, and every mistake in one line with its exit code.

bad() { # bad CODE MESSAGE ARGUMENTS...
  local code=$1 message=$2
  shift 2
  run eos "$@"
  [ "$status" = "$code" ]
  [ "${#lines[@]}" = 1 ]
  [[ ${lines[0]} == "eos: "*"$message"* ]]
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
