# SPDX-License-Identifier: GPL-3.0-or-later
# gnuplot -c ring.gp curves.tsv OUT.png: surface density in rings at the start, half way and at the end, on the solution, for both viscosities.
set terminal pngcairo size 1100,450
set output ARG2
set datafile commentschars '#'
set multiplot layout 1,2
set xlabel 'r'; set ylabel 'surface density'; set xrange [0.3:2]
do for [law in 'constant alpha'] {
  set title law eq 'alpha' ? 'nu = alpha c H' : 'nu constant'
  plot for [k = 0:2] ARG1 using (strcol(1) eq law && $2 == k/2. ? $3 : 1/0):5 with lines lc k + 1 notitle, \
    for [k = 0:2] ARG1 using (strcol(1) eq law && $2 == k/2. ? $3 : 1/0):4 with points pt 7 ps 0.6 lc k + 1 title word('start middle end', k + 1)
}
