#!/usr/bin/env bats
# SPDX-License-Identifier: GPL-3.0-or-later
# tests/sanitize: every test of CUDA code once with each tool, small; what is found, fails or lasts too long is said. The sanitizer and
# the programs only pretend.

setup() {
  cd "$BATS_TEST_DIRNAME/.."
  mock=$BATS_TEST_TMPDIR/bin
  mkdir -p "$mock" "$BATS_TEST_TMPDIR/tests"
  for t in tests/test_cuda_*.c*; do
    t=${t##*/}
    printf '#!/bin/bash\necho "%s $BRECCIA_TEST_ONLY $BRECCIA_TEST_SMALL" >>"$SAID"\n' "${t%.*}" >"$BATS_TEST_TMPDIR/tests/${t%.*}"
    chmod +x "$BATS_TEST_TMPDIR/tests/${t%.*}"
  done
  cat >"$mock/compute-sanitizer" <<'M'
#!/bin/bash
tool= code=
while [ $# -gt 1 ]; do
  case $1 in --tool) tool=$2 ;; --error-exitcode) code=$2 ;; --port) echo "$2" >>"$SAID.ports" ;; esac
  shift
done
"$1"
[ "$tool $BRECCIA_TEST_ONLY" != 'racecheck passes' ] || { echo '========= Error: Race reported'; exit "$code"; }
[ "$tool $BRECCIA_TEST_ONLY" != 'memcheck bits' ] || exec sleep 60
[ "$tool $BRECCIA_TEST_ONLY" != 'memcheck too_many' ] || echo '[  SKIPPED ] too_many'
M
  chmod +x "$mock/compute-sanitizer"
  PATH=$mock:$PATH
  export SAID=$BATS_TEST_TMPDIR/said B=$BATS_TEST_TMPDIR
}

@test "sanitize: all tests with each tool; what fails, and why" {
  LIMIT=4 JOBS=4 run tests/sanitize
  echo "$output"
  all=$(grep -ohE 'cmocka_unit_test\([a-z_0-9]+' tests/test_cuda_*.c* | wc -l)
  [ "$all" -gt 30 ]
  [ "$status" = 1 ]
  [ "${lines[-1]}" = "$((2 * all - 2)) passed, 2 failed" ]
  grep -qE '^FAIL  racecheck  cuda_backend\.passes +[0-9]+ s, the sanitizer has found something$' <<<"$output"
  grep -qE '^FAIL  memcheck   cuda_backend\.bits +[0-9]+ s, ran past 4 s$' <<<"$output"
  grep -qE '^skip  memcheck   cuda_memory\.too_many' <<<"$output"
  [[ $output == *'Error: Race reported'* ]]
  # Each test twice, alone, small, with a port of its own.
  [ "$(sort "$SAID" | uniq -c | awk '$1 != 2 || NF != 4 || $4 != 1' | wc -l)" = 0 ]
  [ "$(sort -u "$SAID" | wc -l)" = "$all" ] && [ "$(sort -u "$SAID.ports" | wc -l)" = $((2 * all)) ]
}

@test "sanitize: one tool, one test; no such test, no sanitizer" {
  TOOLS=racecheck run tests/sanitize 'cuda_tree.without*'
  [ "$status" = 0 ]
  [ "${lines[-1]}" = '2 passed, 0 failed' ]
  run tests/sanitize nothing
  [ "$status" = 1 ]
  [ "$output" = "tests/sanitize: no test matches 'nothing'" ]
  rm "$mock/compute-sanitizer"
  CUDA_HOME=$mock PATH=$mock:/usr/bin:/bin run tests/sanitize
  [ "$status" = 1 ] && [[ $output == 'tests/sanitize: cannot find compute-sanitizer'* ]]
}
