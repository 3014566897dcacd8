#!/usr/bin/env bats
# SPDX-License-Identifier: GPL-3.0-or-later
# pipelines/protoearth.mk, small: standard SPH errs in pressure on both sides of the core-mantle boundary, miscible does not.

@test "the jump of pressure at the boundary is there with standard SPH and gone with miscible; nothing is made twice" {
  cd "$BATS_TEST_DIRNAME/.."
  out=$BATS_TEST_TMPDIR/out
  make -s -f pipelines/protoearth.mk BIN="${BIN:-$PWD/bin}" N=1000 OUT="$out" >"$BATS_TEST_TMPDIR/said" 2>&1 ||
    { cat "$BATS_TEST_TMPDIR/said"; false; }
  awk '$1 == "standard" { s = $6 } $1 == "miscible" { m = $6 } END { exit !(s > 0.3 && m < 0.08 && m > -0.08) }' "$out/report.txt"
  [ ! -e "$out/standard.checkpoint" ]
  make -q -f pipelines/protoearth.mk BIN="${BIN:-$PWD/bin}" N=1000 OUT="$out" "$out/report.txt"
}
