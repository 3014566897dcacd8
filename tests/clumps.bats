# SPDX-License-Identifier: GPL-3.0-or-later
# clumps on two spheres just below and just above their escape speed, and what goes wrong.

load h5

setup_file() {
  cd "$BATS_FILE_TMPDIR"
  mksphere -n 1500 --mass 9e20 --layer basalt:0.7 --layer ice:0.3 -o a.h5
  mksphere -n 500 --mass 3e20 --layer basalt:1 -o b.h5
  collide a.h5 b.h5 --angle 40deg --speed 0.99vesc --distance 3 -o slow.h5
  collide a.h5 b.h5 --angle 40deg --speed 1.01vesc --distance 3 -o fast.h5
}
setup() { cd "$BATS_FILE_TMPDIR"; }

column() {
  awk -F'\t' -v name="$1" '/^# id/ { for (k = 1; k <= NF; k++) if ($k == name || index($k, name " [") == 1) at = k }
    !/^#/ { print at ? $at : "no such column" }' table
}

@test "two bodies, one aggregate below the escape speed, two above" {
  clumps slow.h5 >table
  [ "$(column n | awk '{ n += $1 } END { print n }')" -gt 1900 ]
  [ "$(column aggregate | tr '\n' ' ')" = "1 1 " ]
  [ "$(column parent | tr '\n' ' ')" = "0 1 " ]
  grep -q '^# bound pair 1 2: ' table
  clumps fast.h5 >table
  [ "$(column aggregate | tr '\n' ' ')" = "1 2 " ]
  [ "$(column parent | tr '\n' ' ')" = "0 0 " ]
  run grep 'bound pair' table
  [ "$status" = 1 ]
}

@test "masses of the bodies and what is bound at each level" {
  clumps fast.h5 >table
  paste <(column mass) <(column bound) | awk '{ if ($1 != $2) exit 1; m += $1 } END { exit !(m > 0.999999 * 1.2e21 && m < 1.000001 * 1.2e21) }'
}

@test "both methods agree on two cold spheres" {
  clumps fast.h5 >a
  clumps --method grow fast.h5 >b
  cmp <(grep -v '^#' a) <(grep -v '^#' b)
}

@test "ids are written, and do not depend on the number of threads" {
  OMP_NUM_THREADS=1 clumps -o ids.h5 fast.h5 >a
  mv ids.h5 one.h5
  OMP_NUM_THREADS=3 clumps -o ids.h5 fast.h5 >b
  cmp a b
  cmp one.h5 ids.h5
  render --color ClumpID --centre clump:2 -o x.png ids.h5
  fof ids.h5 >/dev/null # the field is carried along
}

@test "a campaign's row: two bodies that pass" {
  clumps --campaign row fast.h5 >table
  value() { awk -F'\t' -v name="$1" '/^#/ { for (k = 1; k <= NF; k++) if (index($k, name " [") == 1) at = k } !/^#/ { print $at }' row; }
  [ "$(wc -l <row)" = 2 ]
  true_that 'near(a, 9e20, 1e-8) && near(b, 3e20, 1e-8) && near(c, 0.75, 1e-8)' a="$(value M_LR)" b="$(value M_SLR)" c="$(value M_LR/M)"
  true_that 'abs(xi) < 1e-9 && abs(s) < 1e-9 && abs(m) < 1e10' xi="$(value xi)" s="$(value stripped_1)" m="$(value M_unbound)"
  [ "$(value xi_ice)" = nan ] # the impactor has none
  # 1.01 v_esc at 40 degrees: e = hypot((k - 1) sin, cos), k = 2 1.01^2; the deflection of the hyperbola
  true_that 'near(e, sqrt(((2*1.01^2 - 1)*sin(a))^2 + cos(a)^2), 1e-3)' e="$(value e)" a=0.6981317
  true_that 'near(sin(d * 3.14159265 / 360), 1 / e, 1e-6)' d="$(value deflection)" e="$(value e)"
  clumps --campaign row slow.h5 >table
  [ "$(value deflection)" = nan ]
}

@test "the gate of the virial, the smallest mass" {
  clumps --max-virial 0.1 fast.h5 >table
  [ "$(grep -vc '^#' table)" = 0 ]
  grep -q 'above --max-virial: not searched' table
  k=$(sed -n 's/.*k_vir of the system \([^ ,]*\).*/\1/p' table)
  clumps --max-virial "$(awk -v k="$k" 'BEGIN { print 1.01 * k }')" fast.h5 >table
  [ "$(grep -vc '^#' table)" = 2 ]
  clumps --min-mass 4e20 -o ids.h5 fast.h5 >table
  [ "$(grep -vc '^#' table)" = 1 ] && [ "$(field ids.h5 ClumpID | sort -u | tr '\n' ' ')" = "0 1 " ]
}

@test "nothing bound: a table without rows" {
  run clumps --min-particles 5000 fast.h5
  [ "$status" = 0 ]
  [[ $output == *"0 bound bodies in 0 aggregates"* ]]
  [[ ${lines[-1]} == "# id"* ]]
}

fails() {
  local want=$1 text=$2
  shift 2
  run "$@"
  echo "$status: $output"
  [ "$status" = "$want" ] && [ "${#lines[@]}" = 1 ] && [[ $output == "clumps: "*"$text"* ]]
}

@test "bad input is one line" {
  echo text >text.h5
  fails 1 "lacks field 'Pressure' (made by relax)" clumps --criterion enthalpy fast.h5
  fails 1 "'none.h5'" clumps none.h5
  fails 1 "'text.h5'" clumps text.h5
  fails 1 "" bash -c 'clumps </dev/null'
  fails 1 "No space left" bash -c 'clumps fast.h5 >/dev/full'
  fails 2 "name a file" clumps -o - fast.h5
  fails 2 "--min-particles" clumps -n 1 fast.h5
  fails 2 "--max-virial" clumps --max-virial 0 fast.h5
  fails 2 "name a file" clumps -C - fast.h5
  fails 1 "" clumps -C no/such/folder/row fast.h5
  fails 2 "--theta" clumps --theta 2 fast.h5
  fails 2 "kick" clumps --method kick fast.h5
}
