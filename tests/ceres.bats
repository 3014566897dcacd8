# SPDX-License-Identifier: GPL-3.0-or-later
# pipelines/ceres.mk: what is made, what is made again and what is not, with mock programs that write down their calls; then a real
# study, tiny. The claims are those at the head of the file and in docs/design.md, section 6.

bats_require_minimum_version 1.5.0

setup() {
  cd "$BATS_TEST_DIRNAME/.."
  real=$(dirname "$(command -v solver)")
  mock=$BATS_TEST_TMPDIR/bin OUT=$BATS_TEST_TMPDIR/out
  export CALLS=$BATS_TEST_TMPDIR/calls
  run_dir=$OUT/N100-s1/a48-v1.7
}

# A program that notes its call, and writes its arguments to the file after -o, or to stdout.
mock() {
  mkdir -p "$mock"
  for name in mksphere relax weibull collide solver fof clumps render report conserved histo track; do
    { echo '#!/bin/bash'
      echo 'name=${0##*/}; echo "$name $*" >>"$CALLS"'
      echo '[ "$name" = "$FAILING" ] && { echo "$name: no" >&2; exit ${CODE:-1}; }'
      cat; } <<'MOCK' >"$mock/$name"
to=/dev/stdout all="$*"
[[ $name == relax || $name == weibull ]] && all="$all $(cat)"
while [ $# -gt 0 ]; do [[ $1 == -o || ($1 == -p && $name != report) ]] && to=$2; shift; done
case "$name $all" in
solver*)
  printf '# step\ttime[s]\tE_kinetic[J]\tE_internal[J]\tE_potential[J]\tE_total[J]\tp_x[kg*m/s]\tp_y[]\tp_z[]\tL_x[]\tL_y[]\tL_z[]\n' >"$to/conserved.tsv"
  printf '%s\t4\t1\t-1\t4\t0\t0\t0\t0\t0\t%s\n' '0\t-14000' 2 '1\t0' ${SPIN:-2} '2\t100000' ${SPIN:-2} |
    sed 's/\\t/\t/' >>"$to/conserved.tsv"
  echo 'snap_0000.h5 at step 0, t = -14000 s' >"$to/run.log"
  echo 'snap_0001.h5 at step 1, t = 100000 s' >>"$to/run.log"
  echo >"$to/snap_0000.h5"; cp "$to/snap_0000.h5" "$to/snap_0001.h5" ;;
collide*--dry-run*)
  for q in MassTarget MassImpactor RadiusTarget RadiusImpactor EscapeSpeed; do printf '%s\t1\n' $q; done
  printf 'ContactAngle\t48\nContactSpeed\t1.7\nInitialTime\t-14000\n' ;;
fof*|clumps*)
  printf '# x at 0 s: 2 fragments, 2 of them with 5 or more particles\n# these hold 2 kg of 2 kg, mean damage 0.5\n'
  printf '# id\tn\tmass [kg]\tnear\tv_rel [m/s]\tv_rel/v_esc [1]\tradius [m]\tE_kin [J]\tfrom_0 [kg]\tfrom_1 [kg]\tice_from_0 [kg]\n'
  printf '1\t9\t1\t2\t3\t3\t1\t0\t0\t1\t0.1\n2\t9\t1\t1\t3\t3\t1\t0\t1\t0\t0.5\n'
  [ "$to" = /dev/stdout ] || echo >"$to" ;;
*) echo "$name $all" >"$to" ;;
esac
MOCK
    chmod +x "$mock/$name"
  done
}

study() { make -s -f pipelines/ceres.mk BIN="$mock" N=100 OUT="$OUT" LIBRARY="$OUT/bodies" "$@"; }
# The programs called since the last look, each once, in the order of the alphabet.
called() { [ ! -f "$CALLS" ] || cut -d' ' -f1 "$CALLS" | sort -u | tr '\n' ' '; rm -f "$CALLS"; }
expect() { [ "$1" = "$2" ] || { echo "expected '$1', got '$2'"; return 1; }; }
words() { printf '%s\n' "$@" | sort | tr '\n' ' '; }
everything='clumps collide conserved fof histo mksphere relax render report solver track weibull '
analysis='clumps conserved fof histo render report track '

@test "a study is made once, and nothing of it twice" {
  mock
  study
  expect "$everything" "$(called)"
  study -q
  study
  expect '' "$(called)"
  [ -s "$run_dir/report.txt" ]
  run ! grep FAILED "$run_dir/report.txt"
}

@test "a changed variable remakes what depends on it" {
  mock
  study
  called
  study LEAST=9
  expect 'fof histo render report track ' "$(called)"
  study LEAST=9 EVERY=10
  expect "$(words $analysis solver)" "$(called)"
  study LEAST=9 EVERY=10 DISTANCE=9000
  expect "$(words $analysis collide solver)" "$(called)"
  study LEAST=9 EVERY=10 DISTANCE=9000 ICE=ice_lange
  grep -c '^mksphere' "$CALLS" | grep -qx 1 # the body of basalt stays
}

@test "asking with other values makes nothing and spoils nothing" {
  mock
  study
  called
  study -n EVERY=10 >/dev/null
  run ! study -q EVERY=10
  study -q && study && expect '' "$(called)"
}

@test "a sweep shares the bodies; each run has its place" {
  mock
  study ANGLE='15 48' SPEED='1.2 1.7' -j2
  [ "$(grep -c '^mksphere' "$CALLS")" = 2 ]
  [ "$(grep -c '^solver' "$CALLS")" = 4 ]
  grep -q -- '--angle 15deg --speed 1.2vesc .*a15-v1.2/start.h5' "$CALLS"
  [ -f "$OUT/N100-s1/a15-v1.2/report.txt" ]
  rm "$CALLS"
  study ANGLE='15 48 60' SPEED=1.7 && [ "$(grep -c '^solver' "$CALLS")" = 1 ]
}

@test "a step that fails leaves no result and stops the study" {
  mock
  FAILING=relax run study
  [ "$status" != 0 ]
  [ ! -e "$OUT/bodies/ceres-n61-s11-squares.h5" ]
  called
  FAILING=fof run study
  [ "$status" != 0 ]
  [ ! -e "$run_dir/fragments.tsv" ]
  [ -e "$run_dir/run/end" ]
  called
  study && expect "$analysis" "$(called)"
}

@test "a stopped run goes on; one of another start begins anew" {
  mock
  FAILING=solver CODE=3 run study
  [ "$status" != 0 ]
  [ ! -e "$run_dir/run/end" ]
  echo kept >"$run_dir/run/checkpoint.h5"
  called
  study
  [ -e "$run_dir/run/checkpoint.h5" ]
  grep -q '^solver --restart' "$CALLS"
  expect "$(words $analysis solver)" "$(called)"
  study END=3000 # a later end continues
  [ -e "$run_dir/run/checkpoint.h5" ]
  study END=100 # an earlier one cannot
  [ ! -e "$run_dir/run/checkpoint.h5" ]
  echo kept >"$run_dir/run/checkpoint.h5"
  study END=100 DISTANCE=9000 && [ ! -e "$run_dir/run/checkpoint.h5" ]
}

@test "post redoes the analysis on the dumps that are there" {
  mock
  run study post
  [ "$status" != 0 ]
  [[ $output == *"no dumps in "*"/run"* ]]
  study
  called
  study post
  expect "$analysis" "$(called)"
  rm "$run_dir/run/end" # a run that is not over
  study post && expect "$analysis" "$(called)"
}

@test "a check that fails is the study's failure; the report stays" {
  mock
  SPIN=3 run study check
  [ "$status" != 0 ]
  [[ $output == *"FAILED  angular momentum"* ]]
  [ -s "$run_dir/report.txt" ] && [ ! -e "$run_dir/checked" ]
}

@test "many particles where a GPU is, and a solver that can use it" {
  mock
  first() { PATH=$mock:$PATH make -n -f pipelines/ceres.mk BIN="$mock" OUT="$OUT" | grep -o -m1 "N[0-9]*-s1"; }
  [ "$(first)" = N3000-s1 ]
  printf '#!/bin/bash\necho "--device auto|cpu"\n' >"$mock/solver"
  printf '#!/bin/bash\necho "GPU 0: a card"\n' >"$mock/nvidia-smi"
  chmod +x "$mock/nvidia-smi"
  [ "$(first)" = N3000-s1 ] # the solver knows only the CPU
  printf '#!/bin/bash\necho "--device auto|cpu|cuda[:K]"\n' >"$mock/solver"
  [ "$(first)" = N200000-s1 ]
}

@test "an installed copy needs no checkout" {
  mock
  prefix=$BATS_TEST_TMPDIR/prefix
  mkdir -p "$prefix/share/breccia"
  cp -r pipelines "$prefix/share/breccia"
  mv "$mock" "$prefix/bin"
  cd "$BATS_TEST_TMPDIR"
  env -u BIN make -s -f "$prefix/share/breccia/pipelines/ceres.mk" N=100
  [ -s out/ceres/N100-s1/a48-v1.7/report.txt ]
}

@test "a real study, tiny, comes to its report and pictures" {
  mock=$real
  study N=100 END=330
  grep -q '^ok .*at rest' "$run_dir/report.txt"
  grep -q '^ok .*total energy' "$run_dir/report.txt"
  grep -q '^n/a .*escape each other (the run ends' "$run_dir/report.txt"
  run ! grep FAILED "$run_dir/report.txt"
  for picture in cut damage end-1; do [ "$(head -c 4 "$run_dir/$picture.png" | tail -c 3)" = PNG ]; done
  [ "$(grep -o '<img' "$run_dir/report.html" | wc -l)" -ge 4 ] && grep -q 'Beside the numbers of the paper' "$run_dir/report.html"
}

# In another folder, with another BIN: no solver, nothing that makes bodies; of the run only what a person would keep.
@test "old dumps that were moved: post needs no solver and no initial files" {
  mock=$real
  study N=100 END=330 >"$BATS_TEST_TMPDIR/first"
  here=$BATS_TEST_TMPDIR/elsewhere/N100-s1/a48-v1.7 programs=$BATS_TEST_TMPDIR/analysis
  mkdir -p "$here/run" "$programs"
  mv "$run_dir/run/"{snap_*.h5,run.log,conserved.tsv} "$here/run"
  mv "$OUT" "$OUT.gone"
  for p in fof clumps render conserved histo track info disk; do ln -s "$real/$p" "$programs/$p"; done
  for p in solver relax mksphere weibull collide; do printf '#!/bin/sh\necho "$0" >>"%s"\nexit 1\n' "$CALLS" >"$programs/$p"; done
  chmod +x "$programs"/{solver,relax,mksphere,weibull,collide}
  env -u BRECCIA_MATERIALS make -s -f pipelines/ceres.mk BIN="$programs" N=100 OUT="$BATS_TEST_TMPDIR/elsewhere" post
  expect '' "$(called)"
  # the same report, but for where it lies and digits of the orbit
  diff <(tail -n +2 "$OUT.gone/N100-s1/a48-v1.7/report.txt" | sed "s|$OUT|X|") <(tail -n +2 "$here/report.txt" | sed "s|$BATS_TEST_TMPDIR/elsewhere|X|")
  for picture in cut damage end-1; do cmp "$here/$picture.png" "$OUT.gone/N100-s1/a48-v1.7/$picture.png"; done
}
