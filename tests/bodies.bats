#!/usr/bin/env bats
# SPDX-License-Identifier: GPL-3.0-or-later
# pipelines/bodies.mk and the library that studies share (recipes.mk): names, what is made when, with mock programs that write down
# their calls; then real bodies, small.

setup() {
  cd "$BATS_TEST_DIRNAME/.."
  real=$(dirname "$(command -v relax)")
  mock=$BATS_TEST_TMPDIR/bin OUT=$BATS_TEST_TMPDIR/bodies
  export CALLS=$BATS_TEST_TMPDIR/calls
}

# Programs that note their calls and make the files they are asked for.
mock() {
  mkdir -p "$mock"
  for name in mksphere mkshape relax weibull solver; do
    cat >"$mock/$name" <<'MOCK'
#!/bin/bash
name=${0##*/}
echo "$name $*" >>"$CALLS"
[ "$name" = "$FAILING" ] && { echo "$name: no" >&2; exit 1; }
[ "$name" = relax ] && cat >/dev/null
to=/dev/stdout
while [ $# -gt 0 ]; do
  case $1 in
  -o) to=$2 ;;
  --profile) echo >"$2" ;;
  --report) printf '# run\tn[1]\tfalls[tff]\tv_rms[vesc]\tv_999[vesc]\trho_off[1]\trho_off_inside[1]\tequator[m]\treach[m]\tspacing[m]\nproof\t%s\t2\t%s\t0\t%s\t%s\t100\t%s\t10\n' \
    ${REACHED:-100000 0.001 0.009 0.5 106} >"$2" ;;
  esac
  shift
done
echo "$name" >"$to"
MOCK
    chmod +x "$mock/$name"
  done
}

bodies() { make -s -f pipelines/bodies.mk BIN="$mock" N=100 OUT="$OUT" "$@"; }
called() { [ ! -f "$CALLS" ] || cut -d' ' -f1 "$CALLS" | sort | tr '\n' ' '; rm -f "$CALLS"; }
expect() { [ "$1" = "$2" ] || { echo "expected '$1', got '$2'"; return 1; }; }

@test "one of each recipe, under its name, made once; balls are relaxed, a pile is at rest as it is placed" {
  mock
  bodies
  expect 'mkshape mksphere mksphere mksphere mksphere relax relax relax relax ' "$(called)"
  for b in ceres vesta moon protoearth rubble; do [ -s "$OUT/$b-n100-s1.h5" ]; done
  [ -s "$OUT/moon-n100-s1.relax.tsv" ]
  [ -s "$OUT/moon-n100-s1.profile.tsv" ]
  bodies
  expect '' "$(called)"
  bodies SEED='1 2' BODIES=moon
  expect 'mksphere relax ' "$(called)"
  REACHED='100000 0.001 0.3 0.005 106' bodies FORM=miscible BODIES='moon rubble'
  grep -q 'relax --set density=miscible --proof 2tff' "$CALLS"
  expect 'mksphere relax ' "$(called)" && [ -s "$OUT/moon-n100-s1-miscible.h5" ]
}

@test "by name, with flaws of the same seed; a recipe of one's own" {
  mock
  bodies "$OUT/vesta-n200-s7.flaws.h5"
  grep -q -- '--spin 5.342h --hydrostatic -n 200 --rotate 7$' "$CALLS"
  grep -q '^weibull --seed 7 ' "$CALLS"
  called
  bodies "$OUT/rubble-n200-s7.h5"
  grep -q -- '-n 200 --rotate 7 --seed 7' "$CALLS"
  called
  bodies BODIES=mine RECIPE='mksphere -m 1e20kg -l ice' && grep -q '^mksphere -m 1e20kg -l ice -n 100 --rotate 1$' "$CALLS"
}

@test "a changed recipe makes its body again, and only that; asking spoils nothing" {
  mock
  bodies
  called
  bodies -n recipe.moon='mksphere -m 1e22kg -l basalt' >/dev/null
  bodies
  expect '' "$(called)"
  bodies recipe.moon='mksphere -m 1e22kg -l basalt'
  expect 'mksphere relax ' "$(called)"
  bodies BODIES=moon RELAX='--fluid' && grep -q 'relax --set pressure_form=product --proof 2tff --fluid' "$CALLS"
}

@test "a body that fails is not there; what is not at rest fails; unknown names are one line" {
  mock
  FAILING=relax run bodies BODIES=moon
  [ "$status" != 0 ]
  [ ! -e "$OUT/moon-n100-s1.h5" ]
  REACHED='100000 0.001 0.02 0.5 106' run bodies BODIES=moon
  [ "$status" != 0 ]
  [[ $output == *"FAILED density"* ]]
  rm "$OUT"/moon*
  REACHED='100000 0.004 0.009 0.5 112' run bodies BODIES=moon
  [ "$status" != 0 ]
  [[ $output == *"FAILED speed radius"* ]]
  # 1 % at 100 000 particles is 2.2 % at 10 000; sums are judged inside
  rm "$OUT"/moon*
  REACHED='10000 0.001 0.02 0.5 106' bodies BODIES=moon
  rm "$OUT"/moon*
  REACHED='100000 0.001 0.3 0.005 106' bodies BODIES=moon FORM=sum
  run bodies BODIES=pluto
  [ "$status" != 0 ]
  [[ $output == *"no recipe 'pluto'; there are: ceres ceres_rock moon"* ]]
  run bodies "$OUT/moon-100-1.h5"
  [ "$status" != 0 ] && [[ $output == *"'moon-100-1' is not RECIPE-nN-sSEED[-FORM]"* ]]
}

@test "studies at once: one makes the body, the other waits for it" {
  mock
  sed -i 's/^\[ "$name" = relax \] && /&sleep 0.5 \&\& /' "$mock/relax"
  bodies BODIES=moon >"$BATS_TEST_TMPDIR/first" &
  sleep 0.1
  bodies BODIES=moon
  wait
  expect 'mksphere relax ' "$(called)"
}

@test "the studies take their bodies from there, and share them" {
  mock
  make -n -f pipelines/ceres.mk BIN="$mock" N=100 OUT="$BATS_TEST_TMPDIR/ceres" SPEED='1 2' >said
  [ "$(grep -c "echo 'mksphere .*$OUT/ceres" said)" = 2 ]
  make -n -f pipelines/protoearth.mk BIN="$mock" N=100 OUT="$BATS_TEST_TMPDIR/protoearth" >said
  [ "$(grep -c "echo 'mksphere .*$OUT/protoearth-n100-s1" said)" = 3 ]
  rm said
  bodies BODIES=protoearth && make -n -f pipelines/protoearth.mk BIN="$mock" N=100 OUT="$BATS_TEST_TMPDIR/protoearth" |
    grep -c "echo 'mksphere" | grep -qx 2
}

@test "real bodies, small: at rest, and a pile with flaws" {
  mock=$real
  bodies N=600 BODIES='moon rubble' flaws >"$BATS_TEST_TMPDIR/said" 2>&1 || { cat "$BATS_TEST_TMPDIR/said"; false; }
  bodies N=600 BODIES='moon rubble' >said
  [ "$(grep -c '	ok$' said)" = 2 ]
  rm said
  load h5
  cd "$OUT"
  true_that 'near(a, 1737400, 1e-8) && v < 0.003' a="$(number moon-n600-s1.h5 /Body/Radius0)" v="$(number moon-n600-s1.h5 /Body/RelaxedSpeed0)"
  [ "$(field rubble-n600-s1.h5 BodyID | sort -u | wc -l)" -gt 20 ]
  [ "$(field rubble-n600-s1.flaws.h5 FlawCount | sort -n | head -1)" -ge 1 ]
}
