# SPDX-License-Identifier: GPL-3.0-or-later
# histo: spectra against counts made by awk, fitted slopes against samples of a known law, errors.

load h5

setup() { cd "$BATS_TEST_TMPDIR"; }

# table VALUES on stdin: masses, with radius the cube root and v 1, 2, 3 ...
table() { awk 'BEGIN { print "# a remark\n# id\tmass [kg]\tradius [m]\tv [m/s]" } { printf "%d\t%.17g\t%.17g\t%d\n", NR, $1, $1 ^ (1 / 3), NR }'; }
rows() { grep -v '^#'; }
# sample B LOW HIGH N: drawn from N(>= x) ~ x^-B, cut off at HIGH, by inversion.
sample() {
  awk -v b="$1" -v l="$2" -v h="$3" -v n="$4" 'BEGIN { srand(7)
    for (i = 0; i < n; i++) { u = rand(); print (l ^ -b - u * (l ^ -b - h ^ -b)) ^ (-1 / b) } }'
}

@test "the cumulative spectrum: each value, how many are as large, their share" {
  printf '%s\n' 3 8 1 8 2 1 1 | table >t.tsv
  [ "$(histo t.tsv | rows | cut -f 2,3 | tr '\t\n' ': ')" = '8:2 3:3 2:4 1:7 ' ]
  true_that 'near(a, 16/24, 1e-8) && b == 1' a="$(histo t.tsv | rows | head -1 | cut -f 4)" b="$(histo t.tsv | rows | tail -1 | cut -f 4)"
  [ "$(histo --skip 1 t.tsv | rows | head -1 | cut -f 2,3 | tr '\t' :)" = 8:1 ]
  true_that 'near(a, 8/24, 1e-8)' a="$(histo --relative <t.tsv | rows | head -1 | cut -f 2)"
  [ "$(histo --column v t.tsv t.tsv | rows | cut -f 1 | uniq -c | tr -s ' \n' ' ')" = ' 7 1 7 2 ' ]
  [[ $(histo --column v t.tsv) == *"# series"*"v [m/s]"* ]]
}

@test "bins hold every value once; counts as awk has them" {
  sample 0.9 1 1000 3000 | table >t.tsv
  histo --bins 7 t.tsv | rows >b
  [ "$(awk '{ n += $4; s += $6 } END { print n, (s > 0.999999 && s < 1.000001) }' b)" = '3000 1' ]
  awk 'NR == FNR { x[NR] = $2; n = NR; next }
    { c = 0; for (i = 1; i <= n; i++) c += x[i] >= $2 * (1 - 1e-8) && (x[i] < $3 * (1 - 1e-8) || FNR == 7); if (c != $4) exit 1 }
    { d = log($3 / $2) / log(10); if ((c / d - $5) ^ 2 > 1e-10 * $5 ^ 2) exit 1 }' <(rows <t.tsv) b
  histo --bins 5 --linear --column v t.tsv | rows | awk '$4 != 600 && NR > 1 && NR < 5 { exit 1 } { if (NR > 1 && $2 != to) exit 1; to = $3 }'
}

@test "the slope of a power law, and its error" {
  for b in 0.5 0.9 2; do
    sample $b 1 100 4000 | table >t.tsv
    fit=$(histo --fit 1kg:100kg t.tsv | sed -nE 's/.*b = ([^ ]*) \+- ([^ ]*) of 4000 .*/\1 \2/p')
    true_that 'abs(f - b) < 3 * e && e > 0.5 * b / 65 && e < 0.1' f="${fit% *}" e="${fit#* }" b=$b
  done
  # far from the cut-off it is Hill's estimator, n/sum ln(x/low), with an error of b/sqrt(n)
  hill=$(rows <t.tsv | awk '{ s += log($2) } END { print NR / s }')
  fit=$(histo --fit 1:1e9 t.tsv | sed -nE 's/.*b = ([^ ]*) \+- ([^ ]*) of.*/\1 \2/p')
  true_that 'near(f, h, 1e-5) && near(e, h / sqrt(4000), 0.05)' f="${fit% *}" h="$hill" e="${fit#* }"
}

@test "values that are not positive are counted; nothing at all is an empty table" {
  printf '%s\n' 3 0 nan 2 | table >t.tsv
  [[ $(histo t.tsv) == "# 1: t.tsv: 2 values, 2 not finite or not positive"* ]]
  [ "$(histo --linear t.tsv | rows | tail -1 | cut -f 2,3)" = $'0\t3' ]
  table </dev/null >none.tsv
  [ "$(histo none.tsv | rows | wc -l)" = 0 ]
  histo -o none.png none.tsv >/dev/null 2>messages
  [ ! -s messages ]
  [ -s none.png ]
}

@test "pictures" {
  sample 0.9 1 1000 300 | table >t.tsv
  for options in '' '--bins 10' '--bins 10 --linear -c v' '--fit 1:500 --title x'; do
    histo $options -o p.png t.tsv >/dev/null 2>messages
    [ ! -s messages ]
    [ "$(od -A n -t x1 -N 4 p.png | tr -d ' ')" = 89504e47 ]
    rm p.png
  done
}

@test "bad input is one line" {
  printf '3\n' | table >t.tsv
  bad 1 "'t.tsv' has no column 'radios' (did you mean 'radius'?)" histo -c radios t.tsv
  bad 2 "--fit: '3' is not LOW:HIGH" histo --fit 3 t.tsv
  bad 2 "--fit: 0 < LOW < HIGH must hold" histo --fit 3:2 t.tsv
  bad 2 "--fit: '3km'" histo --fit 3km:4km t.tsv
  bad 2 "--bins must lie in 0..100000" histo --bins -1 t.tsv
  bad 2 "--title needs --output" histo --title x t.tsv
  sed 's/\[kg\]/[g]/' t.tsv >g.tsv
  bad 1 "'t.tsv' has mass in kg, 'g.tsv' in g" histo t.tsv g.tsv
  bad 1 "cannot open 'no.tsv': No such file or directory" histo no.tsv
}
