#!/usr/bin/env bats
# SPDX-License-Identifier: GPL-3.0-or-later
# solver from outside: runs that are killed, stopped, continued; inputs, settings and disks that are bad.

load h5

setup_file() {
  export OMP_NUM_THREADS=1
  cd "$BATS_FILE_TMPDIR"
  mksphere -n 300 --radius 100km --layer basalt --rotate 1 2>log | weibull 2>log >t.h5
  mksphere -n 100 --radius 60km --layer ice --rotate 2 2>log | weibull 2>log >i.h5
  collide t.h5 i.h5 --angle 45deg --speed 3vesc --distance 1.1 >s.h5 2>log
  cat >run.cfg <<<'output = { log_every = 1; checkpoint_every = 0.03; };'
  mkdir whole
  start=$EPOCHREALTIME
  (cd whole && solver -c ../run.cfg -o run --end +3000s --every 300s ../s.h5)
  awk -v a="$start" -v b="$EPOCHREALTIME" 'BEGIN {print b - a}' >seconds
}

setup() { cd "$BATS_TEST_TMPDIR" && ln -s "$BATS_FILE_TMPDIR"/{s,t}.h5 "$BATS_FILE_TMPDIR"/run.cfg . && mkdir here && cd here; }

# go [OPTIONS]: the run of setup_file, here; begin: the same to be put in the background, and killed.
begin() { exec solver -c ../run.cfg -o run --end +3000s --every 300s "$@" ../s.h5; }
go() { solver -c ../run.cfg -o run --end +3000s --every 300s "$@" ../s.h5; }

# like_whole: all files but the log are there, have the bytes of the undisturbed run, and nothing else is left.
like_whole() {
  local whole=$BATS_FILE_TMPDIR/whole/run
  [ "$(ls -A run | grep -v checkpoint_prev)" = "$(ls -A "$whole" | grep -v checkpoint_prev)" ] || { ls -A run; return 1; }
  for f in "$whole"/*; do
    case $f in */run.log | */checkpoint_prev.h5) continue ;; esac
    cmp "$f" "run/${f##*/}" || return 1
  done
}

@test "the files of a run" {
  cd "$BATS_FILE_TMPDIR/whole/run"
  [ "$(ls snap_*.h5 | wc -l)" = 11 ]
  [ "$(head -c 6 conserved.tsv)" = '# step' ]
  awk -F'\t' 'NR > 1 && (NF != 36 || $1 != NR - 2) {exit 1}' conserved.tsv # every step once
  true_that 'near(b - a, 3000, 1e-12)' a="$(number snap_0000.h5 /Header/Time)" b="$(number snap_0010.h5 /Header/Time)"
  h5dump -a /Step#10/TimeValue run.h5part | grep -q '(0)'
  h5dump -d /Parameters/Value snap_0003.h5 >/dev/null || h5ls snap_0003.h5/Parameters >/dev/null
  grep -q '^done at step' run.log
  grep -q 'damage\|cfl' conserved.tsv
}

@test "--parameters prints the table of docs/run.md" {
  solver --parameters | grep '^| `' >printed
  grep '^| `' "$BATS_TEST_DIRNAME/../docs/run.md" | diff printed -
  [ "$(wc -l <printed)" -gt 100 ]
}

@test "--profile: every pass with its share, which add up to the whole; the run is the same" {
  solver -c ../run.cfg -o run --end +300s --every 300s --profile ../s.h5 2>passes
  grep -q "^# pass.* particles, .* steps, " passes
  for pass in 'neighbour search' 'loop A (gradient)' 'loop B (force)' gravity; do cut -f 1 passes | grep -qx "$pass"; done
  # each is printed to a millisecond
  true_that 'sum > 0.5*all && sum < all + 0.0005*(n + 1)' $(awk -F'\t' '$1 == "all" { print "all=" $3 } !/^#/ && $1 != "all" { s += $3; n++ } END { print "sum=" s; print "n=" n }' passes)
  h5diff run/snap_0001.h5 "$BATS_FILE_TMPDIR/whole/run/snap_0001.h5" /PartType0 /PartType0
  grep -q ' on cpu' run/run.log || [ "$BRECCIA_TEST_DEVICE" = cuda ]
}

@test "killed ten times at random moments: the bytes of the undisturbed run" {
  killed=0
  for ((try = 0; killed < 10 && try < 40; try++)); do
    begin $( ((try)) && echo --restart) &
    pid=$!
    sleep "$(awk -v r=$RANDOM '{print 0.01 + $1 / 12 * r / 32768}' "$BATS_FILE_TMPDIR/seconds")"
    if kill -9 $pid 2>/dev/null; then killed=$((killed + 1)); else rm -r run; fi # too late: anew
    wait $pid || true
  done
  echo "killed $killed times in $try tries, last at $(tail -1 run/conserved.tsv | cut -f 1,2)"
  [ $killed = 10 ]
  go --restart
  like_whole
}

@test "SIGTERM: a checkpoint, exit 3, and on, even when that checkpoint is broken" {
  begin &
  pid=$!
  while [ ! -s run/snap_0002.h5 ]; do sleep .02; done
  kill -TERM $pid
  rc=0
  wait $pid || rc=$?
  [ $rc = 3 ]
  [ -s run/checkpoint.h5 ]
  [ ! -e run/snap_0010.h5 ]
  grep -q 'stopped at step .*: signal' run/run.log
  [ -s run/checkpoint_prev.h5 ]
  head -c 20000 run/checkpoint.h5 >cut
  mv cut run/checkpoint.h5
  go --restart 2>messages
  [ "$(cat messages)" = "solver: warning: cannot read 'run/checkpoint.h5': truncated file" ]
  like_whole
}

@test "no checkpoint that can be read" {
  mkdir run
  echo nonsense >run/checkpoint.h5
  run go --restart
  [ "$status" = 1 ]
  [ "${lines[1]}" = "solver: cannot read 'run/checkpoint.h5': not an HDF5 file" ]
  [ "$(ls -A run)" = checkpoint.h5 ]
}

# short DIR [OPTIONS]: up to the first touch, in DIR/run; same_files DIR DIR: but for the log, byte by byte.
short() { mkdir "$1" && (cd "$1" && shift && solver -o run --end +100s --every 100s "$@" ../../s.h5); }
same_files() {
  for f in "$1"/run/*.*; do [ "${f##*/}" = run.log ] || cmp "$f" "$2/run/${f##*/}" || return 1; done
}

@test "ten runs: the same bytes" {
  for try in 1 2 3 4 5 6 7 8 9 10; do short $try && same_files 1 $try; done
}

# Mixed precision is held to 1e-5 of the acceleration: of 4 m/s^2 at most in 100 s to 0.2 m.
@test "--precision double: the same bytes twice; mixed comes to the same places" {
  short a --precision double
  short b --precision double
  short c --precision mixed
  same_files a b
  paste <(field a/run/snap_0001.h5 Coordinates) <(field c/run/snap_0001.h5 Coordinates) |
    awk '{ d = $1 - $2; if (d < 0) d = -d; if (d > most) most = d } END { print NR, most " m"; exit !(NR > 1000 && most < 0.2) }'
}

@test "--max-wall: exit 3; rk2-adaptive continues exactly too" {
  rc=0
  solver -o a --end +200s -s integrator=rk2-adaptive -s step.error=1e-2 ../s.h5
  solver -o b --end +200s -s integrator=rk2-adaptive -s step.error=1e-2 --max-wall 0.1 ../s.h5 || rc=$?
  [ $rc = 3 ]
  solver -o b --end +200s -s integrator=rk2-adaptive -s step.error=1e-2 --restart ../s.h5
  cmp a/conserved.tsv b/conserved.tsv
  [ "$(field a/snap_0050.h5 Coordinates 3)" = "$(field b/snap_0050.h5 Coordinates 3)" ]
}

@test "a run in the folder, a checkpoint of another run" {
  cp -r "$BATS_FILE_TMPDIR/whole/run" .
  bad 1 "'run' holds a run already: --restart continues it" solver -o run --end 1s ../s.h5
  bad 1 "made with another 'gravity.theta'" solver -c ../run.cfg -o run --end +3000s -r -s gravity.theta=0.5 ../s.h5
  bad 1 "the input 305: it belongs to another run" solver -c ../run.cfg -o run --end +3000s -r ../t.h5
  like_whole
}

@test "one solver a folder: a second one is refused until the first is gone, however it went" {
  begin &
  pid=$!
  while [ ! -s run/checkpoint.h5 ]; do sleep .02; done
  kill -STOP $pid
  cp run/run.log log
  refused=0
  bad 1 "another solver is at work in 'run'" solver -c ../run.cfg -o run --end +3000s --every 300s --restart ../s.h5 || refused=$?
  bad 1 "holds a run already" solver -o run --end +3000s ../s.h5 || refused=$?
  kill -9 $pid
  wait $pid || true
  [ $refused = 0 ]
  cmp log run/run.log
  go --restart
  like_whole
}

@test "two solvers at once in a new folder: one of them runs" {
  begin 2>first &
  a=0 b=0
  go 2>second || b=$?
  wait $! || a=$?
  [ $((a + b)) = 1 ]
  cat first second
  [ "$(cat first second | grep -cxF -e "solver: another solver is at work in 'run'" \
    -e "solver: 'run' holds a run already: --restart continues it")" = 1 ]
  like_whole
}

@test "a time step that collapses: id, state, last good checkpoint" {
  bad 1 "time step collapsed to" solver -o run --end +3000s -s step.min=2.09 -s output.checkpoint_every=0 ../s.h5
  [[ $output == *": particle "*" of body "*"rho "*"neighbours; the last good checkpoint is 'run/checkpoint.h5'" ]]
  grep -q '^failed: the time step collapsed' run/run.log
  [ "$(number run/checkpoint.h5 /Header/Time)" != "$(number run/snap_0000.h5 /Header/Time)" ]
}

# refused MESSAGE COMMAND: the shell's command ends with 1 and one line on stderr.
refused() {
  run bash -c "$2 2>&1 >/dev/null"
  [ "$status" = 1 ] && [ "${#lines[@]}" = 1 ] && [[ $output == "solver: "*"$1"* ]] || { echo "$output"; return 1; }
}

@test "bad inputs: one line, and no folder" {
  head -c 50000 ../s.h5 >cut.h5
  echo 'not HDF5' >text.h5
  : >empty
  without SmoothingLength ../s.h5 lacks.h5
  without Masses ../s.h5 negative.h5
  field ../s.h5 Masses | sed '7s/^/-/' | put negative.h5 Masses 1
  bad 1 "'cut.h5': truncated" solver -o run --end +1s cut.h5
  bad 1 "'text.h5': not an HDF5 file" solver -o run --end +1s text.h5
  bad 1 "'nowhere.h5': No such file" solver -o run --end +1s nowhere.h5
  refused "'stdin': empty" 'solver -o run --end +1s <empty'
  bad 1 "'lacks.h5' lacks field 'SmoothingLength' (made by mksphere)" solver -o run --end +1s lacks.h5
  refused "'stdin' lacks field 'SmoothingLength'" 'cat lacks.h5 | solver -o run --end +1s'
  bad 1 "'negative.h5': particle 6: Masses is -3.70811e+16, must be positive" solver -o run --end +1s negative.h5
  [ ! -e run ]
}

@test "h at its limits is counted and said" {
  solver -o run --end +300s -s smoothing.max=1 -s smoothing.min=1 ../s.h5 2>said
  awk -F'\t' 'NR == 1 {for (k = 1; k <= NF; k++) {if ($k == "h_at_min") low = k; if ($k == "h_at_max") high = k}}
    NR > 1 {n += $low + $high} END {exit !(low && high && n > 0)}' run/conserved.tsv
  grep -q 'particles have the smallest h allowed, smoothing.min\|particles have the largest h allowed, smoothing.max' run/run.log
  grep -q 'had the smallest h allowed, [0-9]* the largest' said
}

@test "bad settings: one line, and no folder" {
  echo 'gravity = { thetta = 1; };' >typo.cfg
  bad 1 "typo.cfg:1: unknown key 'thetta' (did you mean 'theta'?)" solver -c typo.cfg -o run --end +1s ../s.h5
  bad 1 "nowhere.cfg" solver -c nowhere.cfg -o run --end +1s ../s.h5
  bad 2 "unknown key 'thet' (did you mean 'theta'?)" solver -o run --end +1s -s gravity.thet=1 ../s.h5
  bad 2 "unknown group 'gravty' (did you mean 'gravity'?)" solver -o run --end +1s -s gravty.theta=1 ../s.h5
  bad 1 "gravity.theta = 0.5 has no effect: gravity.method = none" solver -o run --end +1s -s gravity.method=none -s gravity.theta=0.5 ../s.h5
  bad 2 "outside" solver -o run --end +1s -s gravity.theta=-1 ../s.h5
  bad 2 "none of cubic_spline" solver -o run --end +1s -s kernel=gauss ../s.h5
  bad 2 "not of the form key=value" solver -o run --end +1s -s kernel ../s.h5
  bad 2 "unknown unit 'furlong'" solver -o run --end 3furlong ../s.h5
  bad 2 "--end -100s is not after the input's time" solver -o run --end=-100s ../s.h5
  bad 2 "--end is needed" solver -o run ../s.h5
  bad 2 "--every" solver -o run --end +1s --every=-1s ../s.h5
  bad 1 "cannot make 'no/where'" solver -o no/where --end +1s ../s.h5
  [ ! -e run ]
}

@test "a full disk: one line, no half-written file, and the run goes on when there is room" {
  trap '' XFSZ
  # the first snapshot does not fit; the first does, a checkpoint does not
  refused "cannot write 'run/snap_0000.h5'" 'ulimit -f 60; solver -c ../run.cfg -o run --end +3000s --every 300s ../s.h5'
  [ "$(ls -A run)" = $'conserved.tsv\nrun.log' ]
  refused "File too large" 'ulimit -f 140; solver -c ../run.cfg -o run --end +3000s --every 300s --restart ../s.h5'
  [ -z "$(ls -A run | grep '~')" ]
  go --restart
  like_whole
}

@test "sinks and escapees: files, books, and the bits of the run when it is stopped after each step" {
  rows() { field "$1" ParticleIDs | wc -l; }
  cat >sink.cfg <<'CFG'
output = { log_every = 1; };
escape = { distance = "170km"; unbound = false; every = 2; };
point_masses = ( { mass = 1e18; position = ("-40km", 0, 0); radius = "45km"; } );
CFG
  set -- -c sink.cfg -o run --end +200s --every 60s ../s.h5
  solver "$@"
  mv run whole
  for ((k = 0; k < 200; k++)); do
    status=0
    solver --restart --max-wall 0 "$@" || status=$?
    [ $status = 3 ] || break
  done
  [ $status = 0 ]
  [ $k -gt 3 ]
  mv run part
  ls -A whole >a
  ls -A part | grep -v checkpoint_prev >b
  diff a b
  for f in whole/*; do
    case $f in
      *.tsv) cmp "$f" "part/${f##*/}" ;;
      *.h5) # command lines, in /History, differ
        for g in /PartType0 /PointMasses; do [[ $f$g = */snap* || $g = /Part* ]] || continue; h5diff "$f" "part/${f##*/}" $g $g; done ;;
    esac
  done
  [ "$(rows whole/escaped.h5)" -gt 0 ]
  [ "$(rows whole/accreted.h5)" -gt 0 ]
  [ $(($(rows whole/snap_0004.h5) + $(rows whole/escaped.h5) + $(rows whole/accreted.h5))) = "$(rows ../s.h5)" ]
  awk -F'\t' 'NR == 2 {m = $18} NR > 1 && ($18 + $23 - m) ^ 2 > (1e-12 * m) ^ 2 {exit 1}' whole/conserved.tsv
  run solver -o other --end +200s --set escape.from=origin ../s.h5
  [ "$status" = 1 ] && [[ "$output" = *'escape.from = origin has no effect: escape.distance = 0' ]]
}

@test "a guard stops a run that has drifted, with a checkpoint to go on from" {
  run go --set guard.angular_momentum=1e-13
  [ "$status" = 1 ]
  [[ "$output" == *"angular momentum has drifted by "*"more than guard.angular_momentum = 1e-13, at step "*"checkpoint is 'run/checkpoint.h5'"* ]]
  grep -q '^failed: angular momentum has drifted' run/run.log
  n=$(tail -1 run/conserved.tsv | cut -f 1)
  run go --restart --set guard.angular_momentum=1e-13
  [ "$status" = 1 ]
  go --restart --set guard.angular_momentum=0.1 --set guard.momentum=0.1
  tail -1 run/conserved.tsv | awk -F'\t' -v n="$n" '{ exit !($1 > n && $2 > 2000) }'
  run go -o other --set guard.energy=0.1 --set walls.body1=held
  [ "$status" = 1 ]
  [[ "$output" == *"guard.energy = 0.1 cannot go with walls or a layer: they give and take energy"* ]]
}
