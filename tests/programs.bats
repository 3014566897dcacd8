# SPDX-License-Identifier: GPL-3.0-or-later
# What all programs have in common, for each of them: STYLE.md 7 and 8, docs/design.md on interfaces.

programs() { find "$BIN" -maxdepth 1 -type f -perm -u+x | sort; }

# each FUNCTION: for every program in turn; names the one that fails.
each() {
  [ -n "$(programs)" ]
  for program in $(programs); do
    name=${program##*/}
    "$1" || { echo "$program: $output"; return 1; }
  done
}

help() {
  run "$program" --help
  [ "$status" = 0 ] && [ "${#lines[@]}" -le 40 ] && [[ ${lines[0]} == "Usage: $name "* ]] &&
    [ "$(awk 'length > 100' <<<"$output")" = "" ] && [[ ${lines[-1]} == "  "* ]]
}
@test "--help fits 40 lines and ends with an example" { each help; }

version() {
  run "$program" --version
  [ "$status" = 0 ] && [[ $output == "$name (breccia "* ]]
}
@test "--version" { each version; }

lost() {
  run bash -c '"$0" --help >/dev/full' "$program"
  [ "$status" = 1 ] && [ "$output" = "$name: cannot write to stdout: No space left on device" ]
}
@test "lost output is an error" { each lost; }

unknown() {
  run "$program" --xyzzy
  [ "$status" = 2 ] && [ "$output" = "$name: unknown option '--xyzzy' (see --help)" ]
}
@test "an unknown option is one line and exit 2" { each unknown; }

manual() {
  run bash -c 'set -o pipefail; "$0" --man | groff -man -Tascii -ww -z 2>&1' "$program"
  [ "$status" = 0 ] && [ -z "$output" ]
}
@test "--man is a man page that groff takes without a warning" {
  each manual
}

markdown() {
  run "$program" --help-md
  [ "$status" = 0 ] && [ "${lines[0]}" = "## $name" ] && [ "${lines[-1]}" = '```' ]
}
@test "--help-md" { each markdown; }

# A mistake that every reader of snapshots must notice, by each that has an input.
not_hdf5() {
  "$program" --help | head -1 | grep -q '\.h5' || return 0
  case $name in mksphere) return 0 ;; esac
  run bash -c '"$0" "$1" </dev/null >"$2"' "$program" "$BATS_TEST_DIRNAME/run" "$BATS_TEST_TMPDIR/out"
  [ "$status" != 0 ] && [ "${#lines[@]}" = 1 ] && [[ $output == "$name: "* ]] && [ ! -s "$BATS_TEST_TMPDIR/out" ]
}
@test "a file that is no snapshot is one line, and no output" { each not_hdf5; }
