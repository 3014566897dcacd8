# SPDX-License-Identifier: GPL-3.0-or-later
# tests/lint on a small tree: clean code passes, and each thing it counts is found where it is.

setup() {
  cd "$BATS_TEST_TMPDIR"
  mkdir -p tests lib physics build/lib
  cp "$BATS_TEST_DIRNAME/lint" tests/lint
  cp "$BATS_TEST_DIRNAME/../.clang-format" .
  cat > lib/a.c <<'C'
/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "a.h"

int a_one(void) { return 1; }
C
  cat > lib/a.h <<'C'
/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef A_H
#define A_H

int a_one(void);

#endif
C
  gcc -c -o build/lib/a.o lib/a.c
}

# found WHAT: lint fails with exactly this one line.
found() {
  run tests/lint build
  [ "$status" = 1 ] || { echo "status $status: $output"; return 1; }
  [ "${lines[0]}" = "$1" ] && [ "${#lines[@]}" = 2 ] || { echo "$output"; return 1; }
}

# lines_of N TEXT: N lines of text.
lines_of() { for ((k = 0; k < $1; k++)); do echo "$2"; done; }

@test "clean sources pass" {
  run tests/lint build
  [ "$status" = 0 ]
}

@test "format" {
  echo 'int  a_two(void);' >> lib/a.h
  found 'lib/a.h:8: not as clang-format has it'
}

@test "line length, more of it in tables, and the excuse" {
  printf '// %0100d\n' 0 >> lib/a.c
  found 'lib/a.c:5: line of 103 columns (100)'
  printf '/* clang-format off */\n#define X %0120d\n#define Y %0140d\n/* clang-format on */\n' 0 0 > tail
  sed -i -e '5d' -e '4r tail' lib/a.c
  found 'lib/a.c:7: line of 150 columns (140)'
  sed -i '7s|$| /* lint: one number */|' lib/a.c
  run tests/lint build
  [ "$status" = 0 ]
}

@test "function length" {
  { echo; echo 'int a_long(int i)'; echo '{'; lines_of 59 '  i++;'; echo '  return i;'; echo '}'; } >> lib/a.c
  run tests/lint build
  [ "$status" = 0 ]
  sed -i '8s|$|\n  i++;|' lib/a.c
  found 'lib/a.c:6: function of 61 lines (60)'
}

@test "file length" {
  lines_of 596 '// x' >> lib/a.c
  run tests/lint build
  [ "$status" = 0 ]
  echo '// x' >> lib/a.c
  found 'lib/a.c:601: file of 601 lines (600)'
}

@test "physics by the preprocessor" {
  printf '#ifdef SOLID\n#endif\n' >> lib/a.c
  found 'lib/a.c:5: choice by the preprocessor'
  sed -i '5s|$| /* lint: not physics */|' lib/a.c
  run tests/lint build
  [ "$status" = 0 ]
}

@test "only hd.h may ask for the compiler" {
  printf '/* SPDX-License-Identifier: GPL-3.0-or-later */\n#ifdef __CUDACC__\n#endif\n' | tee physics/hd.h > physics/b.h
  found 'physics/b.h:2: choice by the preprocessor'
}

@test "licence line" {
  sed -i 1d lib/a.c
  found 'lib/a.c:1: no SPDX line'
}

@test "path of one machine" {
  printf 'const char *a_path = "/%s/me";\n' home >> lib/a.c
  found 'lib/a.c:5: path of one machine'
}

@test "exported names" {
  printf 'static int hidden;\nint b_two(void) { return hidden; }\n' >> lib/a.c
  gcc -c -o build/lib/a.o lib/a.c
  found 'lib/a.c:1: exports b_two, not a_...'
}

@test "nothing built" {
  rm -r build/lib
  found 'build:0: no object files to look at'
}

@test "exported names in a folder of the solver" {
  mkdir -p solver/cpu build/solver/cpu
  printf '/* SPDX-License-Identifier: GPL-3.0-or-later */\nint cpu_one, backend_b, b_two, other_b;\n' > solver/cpu/b.c
  gcc -c -o build/solver/cpu/b.o solver/cpu/b.c
  found 'solver/cpu/b.c:1: exports other_b, not b_...'
}

@test "tests of bats that cannot fail" {
  test_of() { printf '# SPDX-License-Identifier: GPL-3.0-or-later\n@test "x" {\n%s\n  true\n}\n' "$1" >tests/x.bats; }
  for bad in '  [ 1 = 2 ] && true' '  for k in 1; do false && true; done' '  true && ! true' '  { false && true; } >x' '  true && echo ${x}' $'  false &&\n    true'; do
    test_of "$bad"
    run tests/lint build
    [ "$status" = 1 ]
    [[ ${lines[0]} =~ ^'tests/x.bats:3: `'('&&'|'!')'` hides a failure'$ ]]
    [ "${#lines[@]}" = 2 ]
  done
  test_of '  ! true'
  found 'tests/x.bats:3: `!` hides a failure'
  for good in '  false && true || return 1' '  if false && true; then true; fi' '  x="$(false && echo 1)" # a && b' "  awk 'a && b" '  [[ ${lines[-1]} && 2 = 2 ]]' \
    '  f() { false && true; }' $'  cat <<T\na && b\nT'; do
    test_of "$good"
    run tests/lint build
    [ "$status" = 0 ]
  done
  printf '# SPDX-License-Identifier: GPL-3.0-or-later\n@test "x" {\n  true && ! false\n}\n' >tests/x.bats
  run tests/lint build
  [ "$status" = 0 ]
}

@test "docs/coverage.md: what does not exist is found" {
  mkdir repo
  cd repo
  cp -r "$BATS_TEST_DIRNAME/../docs" .
  mkdir tests tools
  cp "$BATS_TEST_DIRNAME/coverage" tests
  (cd "$BATS_TEST_DIRNAME/.." && ls tests/*.c tests/*.cu tests/*.bats) | xargs touch
  for d in "$BATS_TEST_DIRNAME"/../tools/*/; do mkdir "tools/$(basename "$d")"; done
  for d in materials pipelines solver; do cp -r "$BATS_TEST_DIRNAME/../$d" .; done
  [ "$(tests/coverage)" = "" ]
  changed() { sed -i "$1" docs/coverage.md && tests/coverage | cut -d: -f 3- | sort -u; cp "$BATS_TEST_DIRNAME/../docs/coverage.md" docs; }
  [ "$(changed 's/`gravity.theta`/`gravity.thta`/')" = ' no setting, law, option, field or file `gravity.thta`' ]
  [ "$(changed 's/`eos.form = table`/`eos.form = tabel`/')" = ' no setting, law, option, field or file `eos.form = tabel`' ]
  [ "$(changed 's/`integrator = ab2`/`integrator = ab3`/')" = ' no setting, law, option, field or file `integrator = ab3`' ]
  [ "$(changed 's/`weibull --seed`/`weibull --seeds`/')" = ' no setting, law, option, field or file `weibull --seeds`' ]
  [ "$(changed 's|`materials/ice.cfg`|`materials/ic.cfg`|')" = ' no setting, law, option, field or file `materials/ic.cfg`' ]
  [ "$(changed 's/`test_every`/`test_ever`/')" = ' no test `test_ever`' ]
  [ "$(changed '/^| `-a` opening/s/`test_gravity`/-/')" = ' a row without a test' ]
}
