#!/usr/bin/env bats
# SPDX-License-Identifier: GPL-3.0-or-later
# The solver's bound.tsv: the bodies of clumps, without an effect on the run, the same for any threads and after any restart; the end
# of a run whose masses have come to rest.

load h5

settings=(--end +6000s --every 1500s -s analysis.every=250 -s analysis.min_particles=5)
setup_file() {
  export OMP_NUM_THREADS=1
  cd "$BATS_FILE_TMPDIR"
  mksphere -n 200 --radius 100km --layer basalt --rotate 1 >t.h5 2>log
  mksphere -n 60 --radius 60km --layer ice --rotate 2 >i.h5 2>log
  collide t.h5 i.h5 --angle 45deg --speed 2vesc --distance 1.5 >s.h5 2>log
  solver -o plain --end +6000s --every 1500s s.h5
  start=$EPOCHREALTIME
  solver -o run "${settings[@]}" s.h5
  awk -v a="$start" -v b="$EPOCHREALTIME" 'BEGIN { print (b - a) / 6 }' >slice
}
setup() { cd "$BATS_TEST_TMPDIR" && ln -s "$BATS_FILE_TMPDIR"/{s.h5,run,plain} .; }
rows() { grep -v '^#' "$1/bound.tsv"; }

@test "a line at each multiple of analysis.every; the run is that without" {
  [ "$(rows run | wc -l)" = 25 ]
  t0=$(number run/snap_0000.h5 /Header/Time)
  rows run | awk -F'\t' -v t0="$t0" '{ late = $2 - t0 - 250 * (NR - 1); if (late < -1e-3 || late > 60 || NF != 12) exit 1 }'
  cmp run/conserved.tsv plain/conserved.tsv
  [ "$(field run/snap_0004.h5 Velocities)" = "$(field plain/snap_0004.h5 Velocities)" ]
}

@test "its bodies are those of clumps on the dump of that time" {
  for k in 0 2 4; do
    clumps --min-particles 5 run/snap_000$k.h5 >c
    t=$(number run/snap_000$k.h5 /Header/Time)
    row=$(rows run | awk -F'\t' -v t="$t" '($2 - t) ^ 2 < 1e-6')
    [ -n "$row" ]
    n=$(grep -vc '^#' c || true)
    expected="$n $(grep -v '^#' c | cut -f 2,3 | head -2 | tr '\t\n' '  ')"
    expected+=$(awk '/^# these hold/ { print $4, $7, $13 + 0 }' c)
    [ "$(awk -F'\t' -v n="$n" '{ s = $4 " "; for (k = 1; k <= 2 && k <= n; k++) s = s $(9 + k) " " $(6 + k) " "; print s $6, $5, $3 + 0 }' <<<"$row")" = "$expected" ]
  done
}

@test "the same bytes for any number of threads, and stopped and continued as often as you like" {
  OMP_NUM_THREADS=3 solver -o three "${settings[@]}" s.h5
  cmp run/bound.tsv three/bound.tsv
  stops=0
  for ((try = 0; try < 60; try++)); do
    rc=0
    solver -o cut "${settings[@]}" --max-wall "$(cat "$BATS_FILE_TMPDIR/slice")" $( ((try)) && echo --restart) s.h5 || rc=$?
    [ $rc = 3 ] || break
    stops=$((stops + 1))
    echo "999999	1	1	1	1	1	1	1	1	1	1	1" >>cut/bound.tsv # as a killed run may leave behind the checkpoint
  done
  echo "stopped $stops times"
  [ $rc = 0 ]
  [ $stops -gt 1 ]
  cmp run/bound.tsv cut/bound.tsv
  cmp run/conserved.tsv cut/conserved.tsv
}

@test "the run ends at the first line that agrees with those before it" {
  end=(-s analysis.converged=0.01 -s analysis.window=4)
  solver -o c "${settings[@]}" "${end[@]}" s.h5
  lines=$(rows c | wc -l)
  rows run | head -n "$lines" | cmp - <(rows c)
  # by awk: all windows of four lines after the contact, by the largest change of M_bound, M_1, M_2
  first=$(rows run | awk -F'\t' '{ t[NR] = $2; M = $5; for (q = 6; q <= 8; q++) v[NR, q] = $q }
    END { for (k = 4; k <= NR; k++) { ok = t[k - 3] >= 0
      for (q = 6; q <= 8; q++) { lo = 1e99; hi = 0
        for (j = k - 3; j <= k; j++) { if (v[j, q] < lo) lo = v[j, q]; if (v[j, q] > hi) hi = v[j, q] }
        if (hi - lo > 0.01 * M) ok = 0 }
      if (ok) { print k; exit } } }')
  echo "ended at line $lines, awk says $first"
  [ "$lines" = "$first" ]
  [ "$lines" -gt 4 ]
  [ "$lines" -lt 25 ]
  grep -q '^the bound masses have converged at step' c/run.log
  last=$(ls c/snap_*.h5 | tail -1)
  true_that 'near(a, b, 1e-8)' a="$(number "$last" /Header/Time)" b="$(rows c | tail -1 | cut -f 2)"
  # there is nothing to continue, unless one wants to
  cp c/bound.tsv before
  solver -o c "${settings[@]}" "${end[@]}" --restart s.h5
  cmp c/bound.tsv before
  [ "$last" = "$(ls c/snap_*.h5 | tail -1)" ]
  solver -o c "${settings[@]}" --restart s.h5
  cmp c/bound.tsv run/bound.tsv
  [ "$(ls c/snap_*.h5 | wc -l)" = 5 ]
}

@test "above max_virial nothing is searched, and nothing converges" {
  solver -o v "${settings[@]}" -s analysis.max_virial=0.01 -s analysis.converged=0.5 -s analysis.window=2 s.h5
  [ "$(rows v | wc -l)" = 25 ]
  [ "$(rows v | cut -f 4,6-9 | sort -u)" = $'0\tnan\tnan\tnan\tnan' ]
}

@test "point masses hold bodies, in bound.tsv, clumps and disk" {
  echo 'point_masses = ( { mass = "1e22kg"; position = ("2000km", 0, 0); radius = "100km"; } );' >run.cfg
  start=(-c run.cfg --end +10s --every 10s -s analysis.every=10 -s analysis.min_particles=5)
  solver -o p "${start[@]}" s.h5
  solver -o q "${start[@]}" -s analysis.points=false s.h5
  clumps --min-particles 5 -o ids.h5 p/snap_0001.h5 >with
  clumps --min-particles 5 --no-points p/snap_0001.h5 >bare
  [ "$(rows p | tail -1 | cut -f 7,10)" = "$(grep -v '^#' with | head -1 | awk -F'\t' '{ print $3 "\t" $2 }')" ]
  [ "$(rows q | tail -1 | cut -f 7,10)" = "$(grep -v '^#' bare | head -1 | awk -F'\t' '{ print $3 "\t" $2 }')" ]
  true_that 'b < 1e20 && a >= 1e22 && near(held, 1e22, 1e-9)' a="$(rows p | tail -1 | cut -f 7)" b="$(rows q | tail -1 | cut -f 7)" \
    held="$(grep -v '^#' with | head -1 | awk -F'\t' '{ print $NF }')"
  h5dump -d /PointMasses/ClumpID ids.h5 | grep -q '(0): 1'
  disk --of clump:1 --method canup -o disk.h5 ids.h5 >d
  true_that 'near(M, 1e22, 1e-9) && near(R, 1e5, 1e-6)' M="$(awk '/^# body: mass/ { print $4 }' d)" R="$(awk '/^# body: mass/ { print $7 }' d)"
  h5dump -d /PointMasses/DiskClass disk.h5 | grep -q '(0): 1'
}

@test "settings without effect are refused" {
  bad 1 "analysis.link = 0.5 has no effect: analysis.every = 0" solver -o x --end +1s -s analysis.link=0.5 s.h5
  bad 1 "analysis.window = 3 has no effect: analysis.converged = 0" solver -o x --end +1s -s analysis.every=1 -s analysis.window=3 s.h5
  bad 2 "outside" solver -o x --end +1s -s analysis.min_particles=1 s.h5
}
