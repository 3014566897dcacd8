#!/usr/bin/env bats
# SPDX-License-Identifier: GPL-3.0-or-later
# bench/ncu: its table from what ncu writes, with an ncu and a bench that only pretend. bench/cost, bench/step: small runs of each row.

setup() {
  cd "$BATS_TEST_DIRNAME/.."
  mock=$BATS_TEST_TMPDIR/bin
  mkdir "$mock"
  step=${B:-$PWD/build} step=${step%/gpu}/bench/step
  PATH=$mock:$PATH
  printf '#!/bin/bash\nprintf "# check\\nstep\\t0.100 ms\\t1 ns a particle\\n"\n' >"$mock/step"
  # rows ROW...: an ncu that knows these kernels: name, ns, then the other metrics.
  rows() {
    { echo '#!/bin/bash'
      echo 'while [ "$1" != --log-file ]; do [ "$1" = --metrics ] && metrics=$2; shift; done'
      echo 'to=$2; shift 2; "$@" >&2'
      echo '{ echo "==PROF== Connected to process 7"; printf "\"ID\",\"Kernel Name\",\"CC\",\"%s\"\n" "${metrics//,/\",\"}"'
      echo 'printf "\"\",\"\",\"\",\"ns\",\"%%\",\"%%\",\"%%\",\"%%\",\"%%\",\"%%\",\"register/thread\",\"inst\",\"inst\"\n"; cat <<"R"; } >"$to"'
      printf '%s\n' "$@" R; } >"$mock/ncu"
    chmod +x "$mock"/*
  }
}

@test "ncu: launches are added up, percentages are means by time, names are short" {
  rows '"0","void each<Gradient<(int)1, (int)0, (int)1>>(Loop)","9.0","30,000","10","20","30","40","50","60","64","0","0"' \
    '"1","void each<Gradient<(int)1, (int)0, (int)1>>(Loop)","9.0","10,000","50","20","30","40","50","20","72","1,000","24"' \
    '"2","void cub::CUB_1::DeviceScanKernel<cub::X<int>, int *>(int *, T2)","9.0","50000","1","2","3","4","5","6","7","0","0"'
  run bench/ncu step 1000 solid cuda
  echo "$output"
  [ "$status" = 0 ]
  [ "${#lines[@]}" = 6 ]
  [ "${lines[1]}" = $'DeviceScanKernel\t1\t50.0\t1.0\t2.0\t3.0\t4.0\t5.0\t6.0\t7\t0' ]
  [ "${lines[2]}" = $'each<Gradient<1, 0, 1>>\t2\t40.0\t20.0\t20.0\t30.0\t40.0\t50.0\t50.0\t72\t1024' ]
  [ "${lines[3]}" = $'# all\t3\t90.0' ]
  [ "${lines[5]}" = $'# between kernels\t\t10.0 (10.0 % of the step)' ]
}

@test "ncu: no kernels, no bench, no ncu: one reason, and no table" {
  rows
  run bench/ncu step
  [ "$status" = 1 ]
  [[ ${lines[-1]} == "bench/ncu: no kernel was profiled: "* ]]
  rows '"0","void k()","9.0","1","1","1","1","1","1","1","1","1","1"'
  sed -i 's/metrics=\$2/metrics=${2\/dram\/ram}/' "$mock/ncu"
  run bench/ncu step
  [ "$status" = 1 ]
  [[ $output == *"no column dram__throughput"* ]]
  printf '#!/bin/bash\necho no card; exit 1\n' >"$mock/step"
  run bench/ncu step
  [ "$status" = 1 ]
  [ "$output" = $'no card\nbench/ncu: \'step\' failed' ]
  rm "$mock/ncu"
  CUDA_HOME=$mock PATH=$mock:/usr/bin:/bin run bench/ncu step
  [ "$status" = 1 ] && [[ $output == "bench/ncu: cannot find ncu"* ]]
  run bench/ncu
  [ "$status" = 2 ]
}

# What bench/cost runs: settings, bases and commands.
rows_of_cost() { bench/cost -l -d cpu "$@" step; }

@test "cost: each law and each choice of a setting has its row" {
  rows_of_cost -n 1000 >"$BATS_TEST_TMPDIR/rows"
  missing() { # missing LIST: settings, `key=word` or `group.form = law`, that are neither a row nor a base
    while read -r setting; do
      cut -f 1,3 "$BATS_TEST_TMPDIR/rows" | grep -qE "(^|[[:space:]])${setting//./\\.}([,[:space:]]|$)" || echo "$setting"
    done
  }
  # All laws; the equation of state of the bodies is Tillotson's.
  awk -F'"' '/^### (eos|strength|damage|porosity): `form/ { split($1, w, /[ :]/); print w[2] ".form = " $2 }' docs/materials.md >"$BATS_TEST_TMPDIR/laws"
  [ "$(wc -l <"$BATS_TEST_TMPDIR/laws")" -ge 25 ]
  run missing < <(grep -v 'eos.form = tillotson' "$BATS_TEST_TMPDIR/laws")
  echo "no row: $output"
  [ -z "$output" ]
  # All words of these keys but their defaults; all keys of form, whatever their value.
  awk -F' \\| ' '/^\| `/ {
    key = substr($1, 4, length($1) - 4); default = substr($2, 2, length($2) - 2); n = split($3, word, /, /)
    if (key ~ /^(integrator|kernel|precision|density|pressure_form|stress_form|energy|(gravity|viscosity|form|smoothing|watch)\..*)$/ && n > 1)
      for (k = 1; k <= n; k++) if (word[k] != default && word[k] != "false") print key "=" word[k]
    if (key ~ /^form\./ && n == 1) print key "=[^ ]*"
  }' docs/run.md >"$BATS_TEST_TMPDIR/words"
  [ "$(wc -l <"$BATS_TEST_TMPDIR/words")" -ge 20 ]
  run missing <"$BATS_TEST_TMPDIR/words"
  echo "no row: $output"
  [ -z "$output" ]
}

@test "cost: every row gives a number" {
  OMP_NUM_THREADS=1 bench/cost -n 400 -j 2 -o '--steps 1 --warm 0' "$step" >"$BATS_TEST_TMPDIR/table" 2>"$BATS_TEST_TMPDIR/log" || {
    grep '^bench/cost: ' "$BATS_TEST_TMPDIR/log"
    false
  }
  rows=$(rows_of_cost -n 400 | cut -f 1 | sort -u | wc -l)
  run awk -F'\t' '!/^#/ { if ($3 > 0 && ($2 == "" || $4 != "")) good++; else print } END { print good }' "$BATS_TEST_TMPDIR/table"
  echo "$output"
  [ "${#lines[@]}" = 1 ] && [ "$output" -ge 100 ] && [ "$output" -ge "$rows" ]
}

@test "cost: differences are those of medians; a row without a number fails; the page" {
  printf '%s\n' '#!/bin/bash' '[[ $* != *diffusion* ]] || { echo "step: it does not work" >&2; exit 1; }' \
    'n=$(cat "$0.n" 2>/dev/null || echo 0); [[ $* == *xsph* ]] || echo $((n + 1)) >"$0.n"; [[ $* == *xsph* ]] && t=12.5 || t=$((10 + n % 3))' \
    'printf "# hydro, 400 particles, 0 flaws each, on a card\nstep\t1 ms\t2 ns a particle\t%s mean\t3 microseconds*core\n" $t' >"$mock/step"
  chmod +x "$mock/step"
  run bench/cost -n 400 -j 1 -k 'form.[xd]*' "$mock/step"
  echo "$output"
  [ "$status" = 1 ]
  [[ $output == *$'hydro\t\t11.000\t\nform.xsph=0.5\thydro\t12.500\t+1.500\nform.diffusion=0.05\thydro\tfailed\t\n'* ]]
  [[ $output == *'bench/cost: form.diffusion=0.05: step: it does not work'* && ${lines[-1]} == "bench/cost: 1 of "*" rows gave no number" ]]
  mkdir "$BATS_TEST_TMPDIR/bench"
  cp bench/cost "$BATS_TEST_TMPDIR/bench"
  printf 'above\n<!-- costs -->\nold\n<!-- /costs -->\nbelow\n' >"$BATS_TEST_TMPDIR/bench/compare.md"
  printf '# on a card\n# setting\tbase\tns a particle\tminus base\nhydro\t\t1.0\t\nx=1\thydro\t1.5\t+0.500\n# hydro: median of 2\n' >"$BATS_TEST_TMPDIR/t"
  "$BATS_TEST_TMPDIR/bench/cost" -p "$BATS_TEST_TMPDIR/t"
  cat "$BATS_TEST_TMPDIR/bench/compare.md"
  diff "$BATS_TEST_TMPDIR/bench/compare.md" - <<'R'
above
<!-- costs -->
on a card
hydro: median of 2

| setting | base | ns a particle | minus base |
|---|---|---|---|
| hydro |  | 1.0 |  |
| x=1 | hydro | 1.5 | +0.500 |

<!-- /costs -->
below
R
}

@test "cost, step: what cannot be run is one line" {
  run bench/cost -k nonsense "$step"
  [ "$status" = 1 ]
  [ "$output" = "bench/cost: no setting matches 'nonsense'" ]
  run bench/cost -n x "$step"
  [ "$status" = 2 ]
  [ "${#lines[@]}" = 1 ]
  run bench/cost nowhere/step
  [ "$status" = 1 ]
  [ "$output" = "bench/cost: cannot run 'nowhere/step'" ]
  run "$step" many hydro
  [ "$status" = 2 ]
  [[ ${lines[0]} == "step: 'many' is no number of particles"* ]]
  run "$step" 400 hydro cpu smoothing.width=3
  [ "$status" = 1 ] && [[ $output == *"smoothing.width = 3 has no effect: smoothing.mode = density"* ]]
}
