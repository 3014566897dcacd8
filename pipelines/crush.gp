# SPDX-License-Identifier: GPL-3.0-or-later
# gnuplot -c crush.gp slow/in.tsv slow/out.tsv fast/in.tsv fast/out.tsv OUT.png: distention over pressure, and the crush curve.
set terminal pngcairo size 1000,450
set output ARG5
set datafile commentschars '#'
set multiplot layout 1,2
set xlabel 'p [GPa]'; set ylabel 'distention'; set xrange [-0.2:4]; set yrange [0.98:1.27]; set samples 400
curve(x) = x <= 0.2 ? 1.25 : x >= 2 ? 1 : 1 + 0.25*((2 - x)/1.8)**2
do for [k = 0:1] {
  set title k ? 'fast' : 'slow'
  plot value('ARG'.(1 + 2*k)) using ($1/1e9):3 with points pt 7 ps 0.4 title 'in', value('ARG'.(2 + 2*k)) using ($1/1e9):3 with points pt 6 ps 0.4 title 'out', curve(x) with lines lc 'black' title 'curve'
}
