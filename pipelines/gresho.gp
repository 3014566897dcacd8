# SPDX-License-Identifier: GPL-3.0-or-later
# gnuplot -c gresho.gp coarse.tsv fine.tsv OUT.png: speed of the particles around the centre at t = 1, over the exact one.
set terminal pngcairo size 1100,450
set output ARG3
set datafile commentschars '#'
set xlabel 'r'; set ylabel 'v_{/Symbol f}'; set xrange [0:0.5]; set yrange [-0.1:1.1]; set samples 1000
v(r) = r < 0.2 ? 5*r : r < 0.4 ? 2 - 5*r : 0
set multiplot layout 1,2
do for [k = 1:2] {
  f = k == 1 ? ARG1 : ARG2
  set title system("tail -1 ".f." | cut -f 4")." particles along an edge"
  plot f using 1:($3 == 10 ? $2 : 1/0) with points pt 7 ps 0.3 title 'SPH, t = 1', v(x) with lines lc 'black' title 'exact'
}
