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

# without NAMES FROM TO: a copy that lacks these particle fields. put FILE NAME COLUMNS: adds one, values on stdin.
without() {
  local name
  for name in $(h5ls "$2/PartType0" | awk '{print $1}'); do
    [[ " $1 " == *" $name "* ]] || h5copy -p -i "$2" -o "$3" -s "/PartType0/$name" -d "/PartType0/$name"
  done
  for name in Header Units Materials; do h5copy -i "$2" -o "$3" -s "/$name" -d "/$name"; done
}
put() {
  cat >"$2.txt"
  printf 'PATH PartType0/%s\nINPUT-CLASS TEXTFP\nRANK %d\nDIMENSION-SIZES %d%s\nOUTPUT-CLASS FP\nOUTPUT-SIZE 64\n' \
    "$2" $((1 + ($3 > 1))) "$(wc -l <"$2.txt")" "$([ "$3" = 1 ] || echo " $3")" >"$2.cfg"
  h5import "$2.txt" -c "$2.cfg" -o "$1"
}

# reads MODULES CODE ARGUMENTS...: python3 with these modules runs it; without them the test is skipped, unless $BRECCIA_READERS names
# the module, as CI does.
reads() {
  local module modules=$1 code=$2
  shift 2
  for module in $modules; do
    python3 -c "import $module" 2>log || [[ " $BRECCIA_READERS " == *" $module "* ]] || skip "no python3 with $module"
  done
  PYTHONPATH=$BATS_TEST_DIRNAME/../python PYTHONDONTWRITEBYTECODE=1 python3 -W ignore - "$@" <<<"$code"
}
