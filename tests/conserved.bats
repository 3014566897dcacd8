# SPDX-License-Identifier: GPL-3.0-or-later
# conserved: drifts of a table whose numbers are known, what they are relative to, the picture, errors.

load h5

setup() { cd "$BATS_TEST_TMPDIR"; }

# table ROW...: "t E_kin E_total p_x L_z sum_mv sum_mrv mass" each.
table() {
  printf '# step\ttime[s]\tdt[s]\tlimit\tE_kinetic[J]\tE_internal[J]\tE_potential[J]\tE_total[J]\tp_x[]\tp_y[]\tp_z[]'
  printf '\tL_x[]\tL_y[]\tL_z[]\tsum_mv[]\tsum_mrv[]\tmass[kg]\n'
  for row; do
    awk '{ OFS = "\t"; print NR, $1, 1, "cfl", $2, 0, $3 - $2, $3, $4, 0, 0, 0, 0, $5, $6, $7, $8 }' <<<"$row"
  done
}
# value QUANTITY COLUMN
value() { awk -F'\t' -v q="$1" -v c="$2" '$1 == q { print $c }' drifts; }

@test "drifts at the end and at most, relative to what the man page says" {
  mkdir run
  table '0 8 -4 0 5 10 50 2' '1 10 -3 1 5.5 20 60 2' '2 4 -3.9 0.5 5.2 10 40 1.5' >run/conserved.tsv
  conserved run >drifts
  [ "$(grep -vc '^#' drifts)" = 4 ]
  true_that 'near(e, .01, 1e-9) && near(m, .1, 1e-9) && t == 1' e="$(value energy 5)" m="$(value energy 6)" t="$(value energy 7)"
  true_that 'near(e, .025, 1e-9) && near(m, .05, 1e-9)' e="$(value momentum 5)" m="$(value momentum 6)"
  true_that 'near(e, .04, 1e-9) && near(m, .1, 1e-9)' e="$(value angular_momentum 5)" m="$(value angular_momentum 6)"
  true_that 'near(e, .25, 1e-9) && t == 2' e="$(value mass 5)" t="$(value mass 7)"
  conserved <run/conserved.tsv | grep -v '^#' | cmp - <(grep -v '^#' drifts)
}

@test "nothing moves, nothing turns: the scales of the man page" {
  table '0 0 -4 0 0.01 0 50 2' '1 0 -3 0 0.02 0 100 2' >t.tsv
  conserved t.tsv >drifts
  true_that 'near(e, .25, 1e-9) && near(l, 1e-4, 1e-9) && p == 0' e="$(value energy 6)" l="$(value angular_momentum 6)" \
    p="$(value momentum 6)"
}

@test "the picture" {
  table '0 8 -4 0 5 10 50 2' '7200 10 -3 1 5.5 20 60 2' '72000 4 -3.9 0.5 5.2 10 40 1.5' >t.tsv
  conserved -o p.png -t "a'b_c \"d\"" t.tsv >drifts 2>messages
  [ ! -s messages ]
  [ "$(od -A n -t x1 -N 4 p.png | tr -d ' ')" = 89504e47 ]
  [ "$(wc -c <p.png)" -gt 10000 ]
  table '3 8 -4 0 5 10 50 2' >one.tsv # a single line
  conserved -o q.png one.tsv >drifts 2>messages
  [ ! -s messages ]
  [ -s q.png ]
}

@test "bad input is one line" {
  table '0 8 -4 0 5 10 50 2' >t.tsv
  mkdir empty
  bad 1 "cannot open 'empty/conserved.tsv': No such file" conserved empty
  cut -f 1-7 t.tsv >short.tsv
  bad 1 "'short.tsv' has no column 'E_total'" conserved short.tsv
  sed '2s/\t1\t/\tone\t/' t.tsv >word.tsv
  bad 1 "word.tsv:2: dt 'one' is not a number" conserved word.tsv
  head -1 t.tsv >head.tsv
  bad 1 "'head.tsv' has no rows" conserved head.tsv
  sed 1d t.tsv >bare.tsv
  bad 1 "bare.tsv:1: no line '# name...' before the rows" conserved bare.tsv
  cat t.tsv >cut.tsv
  echo 1 >>cut.tsv
  bad 1 "cut.tsv:3: 1 columns, not 17" conserved cut.tsv
  mkdir path
  ln -s "$(command -v conserved)" "$(command -v bash)" path
  PATH=path bad 1 "cannot make a picture: gnuplot is not there (make deps)" conserved -o p.png t.tsv
  [ -z "$(ls -A | grep png)" ]
}
