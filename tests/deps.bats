# SPDX-License-Identifier: GPL-3.0-or-later
# deps: what it asks apt-get for and what it says when that does not do, on a machine made of mock programs that write down their calls.

setup() {
  cd "$BATS_TEST_DIRNAME/.."
  machine=$BATS_TEST_TMPDIR/machine
  export CALLS=$BATS_TEST_TMPDIR/calls LACKS= UNKNOWN= USERID=0
  mkdir "$machine"
  for p in grep env; do ln -s "$(command -v $p)" "$machine/$p"; done
  for p in make g++ bats h5dump gnuplot clang-format groff sleep; do has $p :; done
  has gcc 'while read -r line; do for h in $LACKS; do [[ $line != *"<$h>"* ]] || exit 1; done; done'
  has id 'echo $USERID'
  has sudo 'echo sudo >>"$CALLS"; exec "$@"'
  has apt-get 'echo "$*" >>"$CALLS"; for p in $UNKNOWN; do [[ " $* " != *" $p "* ]] || exit 100; done'
  has apt-cache 'for p in $UNKNOWN; do [ $2 != $p ] || exit 0; done; printf "$2:\n  Candidate: 1.0\n"'
}
has() { printf '#!/bin/bash\n%s\n' "$2" >"$machine/$1" && chmod +x "$machine/$1"; }
deps() { run env PATH="$machine" ./deps; }
# asked PACKAGES: the last thing apt-get was asked for is to install exactly these.
asked() { [[ "$(tail -1 "$CALLS")" == *" install -y --no-install-recommends $1" ]]; }

@test "all there: one line, nothing is called" {
  deps
  [ "$status" = 0 ] && [ "$output" = 'deps: all there' ] && [ ! -e "$CALLS" ]
}

@test "only what is missing, program or header, is installed, after an update" {
  rm "$machine/bats" "$machine/groff"
  LACKS='hdf5.h gsl/gsl_version.h' deps
  [ "$status" = 0 ]
  [ "$output" = 'deps: installing libhdf5-dev libgsl-dev bats groff-base' ]
  [ "$(wc -l <"$CALLS")" = 2 ]
  head -1 "$CALLS" | grep -q ' update$'
  asked 'libhdf5-dev libgsl-dev bats groff-base'
}

@test "not root: through sudo" {
  USERID=1000 LACKS=png.h deps
  [ "$status" = 0 ]
  [ "$(grep -c '^sudo$' "$CALLS")" = 2 ]
  asked libpng-dev
}

@test "not root and no sudo, or no apt-get: what is missing, nothing is called" {
  rm "$machine/sudo"
  USERID=1000 LACKS='png.h zlib.h' deps
  [ "$status" = 1 ]
  [ "$output" = 'deps: not root and no sudo; as root: apt-get install libpng-dev zlib1g-dev' ]
  rm "$machine/apt-get"
  LACKS='png.h zlib.h' deps
  [ "$status" = 1 ]
  [ "$output" = 'deps: no apt-get here; missing (Debian names): libpng-dev zlib1g-dev' ]
  [ ! -e "$CALLS" ]
}

@test "a package that apt-get does not know is named, alone, in the last line" {
  UNKNOWN='libcmocka-dev' LACKS='hdf5.h cmocka.h' deps
  [ "$status" = 1 ]
  [[ ${lines[-1]} == 'deps: apt-get knows no libcmocka-dev: '* ]]
  has apt-get 'exit 100'
  LACKS='hdf5.h cmocka.h' deps
  [ "$status" = 1 ] && [ "${lines[-1]}" = 'deps: could not install libhdf5-dev libcmocka-dev' ]
}
