# SPDX-License-Identifier: GPL-3.0-or-later
# report: one page that needs nothing else, with what it was given and what it made of a run.

load h5

setup_file() {
  cd "$BATS_FILE_TMPDIR"
  mksphere -n 150 --radius 100km --layer basalt:0.7 --layer ice:0.3 --rotate 1 | weibull > a.h5
  mksphere -n 60 --radius 60km --layer basalt --rotate 2 | weibull > b.h5
  collide a.h5 b.h5 --angle 40deg --speed 2vesc --distance 1.1 -o s.h5
  solver -o run --end +150s --every 50s -s analysis.every=50 s.h5
  report -t 'A <b> & "c"' -o page.html run/
}
setup() { cd "$BATS_FILE_TMPDIR" && echo 'all < good' >r.txt; }

# picture K FILE: the K-th picture of a page, as a file.
picture() { grep -o 'base64,[^"]*' "$3" | sed -n "$1s/base64,//p" | base64 -d >"$2"; }
has() { grep -qF -- "$1" "${2:-page.html}" || { echo "no '$1'"; return 1; }; }

lacks() { if grep -qiE -- "$1" "$2"; then echo "there is '$1'"; return 1; fi; }

@test "the page needs no other file and no network" {
  lacks 'https?://|url\(|<link|<script|@import' page.html
  [ "$(grep -o 'src="[^:]*' page.html | sort -u)" = 'src="data' ]
  has '<meta name="viewport" content="width=device-width'
  has '<title>A &lt;b&gt; &amp; &quot;c&quot;</title>' # escaped
  lacks '<b>' page.html
  [ "$(grep -o '<[a-z0-9]*' page.html | grep -cE '<(div|table|figure|details|dl|ol|pre|h2|h3)$')" = \
    "$(grep -oE '</(div|table|figure|details|dl|ol|pre|h2|h3)>' page.html | wc -l)" ] # all are closed
}

@test "numbers, settings, history, timing, versions of a run" {
  has "<dd>$(field s.h5 ParticleIDs | wc -l) in 3D, 2 bodies</dd>"
  has '<dd>40 degrees at contact, '
  has '-s analysis.every=50 s.h5</code> <small>0.1.0</small>'
  has '<code>mksphere -n 60 --radius 60km --layer basalt --rotate 2</code>'
  has '<dt>analysis.every</dt><dd>50</dd>'
  has '<summary>all settings</summary>'
  has '<dt>gravity.theta</dt><dd>0.7</dd>'
  steps=$(sed -n 's/^done at step \([0-9]*\),.*/\1/p' run/run.log)
  has "<dt>Timing</dt><dd>$steps steps in "
  has 'this page: breccia 0.1.0'
  has '<summary>material ice</summary>'
  has '<summary>log of the run</summary>'
}

@test "tables are those of the programs" {
  fof run/snap_0003.h5 >f.tsv
  n=$(awk -F'\t' '!/^#/ { print $2; exit }' f.tsv)
  has "<tr><td>1</td><td>$n</td><td>"
  has "<h3>Bound bodies (clumps)"
  has "<small>kg</small>"
  has "$(grep '^# these hold' f.tsv | sed 's/^# //')"
  conserved run >c.tsv
  [ "$(grep -c '^[a-z]' c.tsv)" -ge 4 ]
  has '<td class="word">angular_momentum</td>'
  printf '# one\n# id\tx [m]\tword\n1\t1234567\ta<b\n2\t0.000012345\tnan\n3\t-0\t\n' >t.tsv
  report -T t.tsv:Mine -o t.html
  has '<td>1</td><td>1.235 &times; 10<sup>6</sup></td><td class="word">a&lt;b</td>' t.html
  has '<td>2</td><td>1.234 &times; 10<sup>-5</sup></td><td>nan</td>' t.html
  has '<h3>Mine</h3>' t.html
  has '>one</p>' t.html
  report -T t.tsv -r 1 -o t.html
  has '1 of 3 rows.' t.html
}

@test "pictures are in the page, to the byte" {
  [ "$(grep -o '<img' page.html | wc -l)" -ge 3 ]
  render -s 1600x1000 -o want.png run/snap_000[0-3].h5
  picture 1 got.png page.html
  cmp got.png want.png
  for n in 100 101 102; do # all ends of base64
    head -c $n want.png >part.png
    report -p part.png:'Part &' -o t.html
    picture 1 got.png t.html
    cmp got.png part.png
  done
  has 'alt="Part &amp;"' t.html
}

@test "what is given takes the place of what is made; alone, too" {
  render -s 64x64 -o small.png s.h5
  report -g -p small.png -x r.txt:Judged run/ >g.html
  [ "$(grep -o '<img' g.html | wc -l)" = 1 ]
  has 'all &lt; good' g.html
  has '<h3>Judged</h3>' g.html
  lacks 'Fragments .fof' g.html
  report -n 2 -o one.html s.h5 # a snapshot alone
  has ' in 3D, 2 bodies' one.html
  lacks Conservation one.html
}

@test "the same page of a run that was moved; nothing is left behind" {
  mkdir -p moved tmp
  cp -r run moved/run
  (cd moved && TMPDIR=$PWD/../tmp report -t 'A <b> & "c"' run/ >page.html)
  cmp moved/page.html page.html
  [ -z "$(ls -A tmp)" ]
}

@test "without gnuplot the page says so" {
  env PATH="$(dirname "$(readlink -f "$(command -v render)")")" "$(command -v report)" -o p.html run/
  has 'Curves need gnuplot, which was not there' p.html
  has 'angular_momentum' p.html
}

fails() {
  local want=$1 text=$2
  shift 2
  rm -f x.html
  run "$@"
  echo "$status: $output"
  [ "$status" = "$want" ] && [ "${#lines[@]}" = 1 ] && [[ $output == "report: "*"$text"* ]] && [ ! -e x.html ]
}

@test "bad input is one line, and no page" {
  mkdir -p empty broken
  echo text >broken/snap_0000.h5
  fails 1 "cannot open 'none': No such file" report -o x.html none
  fails 1 "holds no snapshots" report -o x.html empty
  fails 1 "not an HDF5 file" report -o x.html broken
  fails 1 "'r.txt' is no PNG" report -p r.txt -o x.html
  fails 1 "cannot read 'none.png': No such file" report -p none.png -o x.html
  fails 1 "r.txt" report -T r.txt -o x.html
  fails 1 "none.txt" report -x none.txt -o x.html
  fails 1 "No space left" bash -c 'report -x r.txt >/dev/full'
  fails 2 "is needed" report -o x.html
  fails 2 "--frames" report -n 0 -o x.html run
  fails 2 "--rows" report -r 0 -o x.html run
}
