# SPDX-License-Identifier: GPL-3.0-or-later
# Numbers out of snapshots, for the tests of the tools: load with `load h5`.

# field FILE DATASET [COLUMNS]: the values of a particle field, COLUMNS a line.
field() {
  { h5dump -d "/PartType0/$2" -y -w 1 -m %.17g -o /dev/fd/3 "$1" >/dev/null; } 3>&1 | tr -d ' ,' | grep . |
    paste -d' ' $(yes - | head -n "${3:-1}")
}

# number FILE /GROUP/ATTRIBUTE
number() { h5dump -a "$2" -m %.17g "$1" | sed -n 's/.*(0): //p'; }

# true_that EXPRESSION [NAME=VALUE...]: an awk expression on numbers; near(a, b, tolerance) is relative to b.
true_that() {
  local expression=$1 given=()
  shift
  for pair; do given+=(-v "$pair"); done
  awk "${given[@]}" "function abs(x) { return x < 0 ? -x : x }
    function near(a, b, t) { return abs(a - b) <= t * abs(b) }
    BEGIN { exit !($expression) }" || { echo "false: $expression ($*)"; return 1; }
}

# bad CODE MESSAGE COMMAND...: one line on stderr with the program's name and the message, this exit code, nothing on stdout.
bad() {
  local code=$1 message=$2
  shift 2
  run bash -c '"$@" 2>&1 >"$0"' "$BATS_TEST_TMPDIR/stdout" "$@"
  [ "$status" = "$code" ] && [ "${#lines[@]}" = 1 ] && [[ $output == "$1: "*"$message"* ]] &&
    [ ! -s "$BATS_TEST_TMPDIR/stdout" ] || { echo "$* -> $status, $output"; return 1; }
}
