#!/usr/bin/env bats
# SPDX-License-Identifier: GPL-3.0-or-later
# pipelines/protoearth.mk, small: standard SPH errs in pressure on both sides of the core-mantle boundary, miscible does not; the
# planet is at rest, and stays.

bats_require_minimum_version 1.5.0

@test "the jump of pressure at the boundary is there with standard SPH and gone with miscible; nothing is made twice" {
  cd "$BATS_TEST_DIRNAME/.."
  out=$BATS_TEST_TMPDIR/out/N1000-s1
  study() { make -s -f pipelines/protoearth.mk BIN="${BIN:-$PWD/bin}" N=1000 OUT="$BATS_TEST_TMPDIR/out" "$out/checked" "$out/report.html" "$@"; }
  study >"$BATS_TEST_TMPDIR/said" 2>&1 || { cat "$BATS_TEST_TMPDIR/said"; false; }
  awk '$1 == "standard" { s = $6 } $1 == "miscible" { m = $6 } END { exit !(s > 0.3 && m < 0.08 && m > -0.08) }' "$out/report.txt"
  [ "$(grep -c '	ok$' "$out/report.txt")" -ge 2 ]
  run ! grep FAILED "$out/report.txt"
  [ -z "$(find "$BATS_TEST_TMPDIR" -name '*.checkpoint')" ]
  study -q
}
