#!/usr/bin/env bats
# SPDX-License-Identifier: GPL-3.0-or-later
# bench/ncu: its table from what ncu writes, with an ncu and a bench that only pretend.

setup() {
  cd "$BATS_TEST_DIRNAME/.."
  mock=$BATS_TEST_TMPDIR/bin && mkdir "$mock"
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
  [ "$status" = 0 ] && [ "${#lines[@]}" = 6 ]
  [ "${lines[1]}" = $'DeviceScanKernel\t1\t50.0\t1.0\t2.0\t3.0\t4.0\t5.0\t6.0\t7\t0' ]
  [ "${lines[2]}" = $'each<Gradient<1, 0, 1>>\t2\t40.0\t20.0\t20.0\t30.0\t40.0\t50.0\t50.0\t72\t1024' ]
  [ "${lines[3]}" = $'# all\t3\t90.0' ]
  [ "${lines[5]}" = $'# between kernels\t\t10.0 (10.0 % of the step)' ]
}

@test "ncu: no kernels, no bench, no ncu: one reason, and no table" {
  rows
  run bench/ncu step
  [ "$status" = 1 ] && [[ ${lines[-1]} == "bench/ncu: no kernel was profiled: "* ]]
  rows '"0","void k()","9.0","1","1","1","1","1","1","1","1","1","1"'
  sed -i 's/metrics=\$2/metrics=${2\/dram\/ram}/' "$mock/ncu"
  run bench/ncu step
  [ "$status" = 1 ] && [[ $output == *"no column dram__throughput"* ]]
  printf '#!/bin/bash\necho no card; exit 1\n' >"$mock/step"
  run bench/ncu step
  [ "$status" = 1 ] && [ "$output" = $'no card\nbench/ncu: \'step\' failed' ]
  rm "$mock/ncu"
  CUDA_HOME=$mock PATH=$mock:/usr/bin:/bin run bench/ncu step
  [ "$status" = 1 ] && [[ $output == "bench/ncu: cannot find ncu"* ]]
  run bench/ncu
  [ "$status" = 2 ]
}
