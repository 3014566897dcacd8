# SPDX-License-Identifier: GPL-3.0-or-later
# gnuplot -c dambreak.gp reference.tsv long.tsv front.tsv OUT.png: fronts and heights at the left wall against exact and measured ones, pressure at the right wall.
set terminal pngcairo size 1500,450
set output ARG4
set datafile commentschars '#'
only(what, v) = stringcolumn(1) eq what ? v : 1/0
set multiplot layout 1,3
set key left top
set xlabel 't [s]'; set ylabel 'front [m]'; set xrange [0:0.8]
plot ARG3 using 1:3 with lines title 'SPH, column of 1 m x 2 m', ARG1 using 2:(only('exact_front', $3)) with points pt 2 title 'potential flow', \
  ARG1 using ($2/sqrt(2*9.81)):(only('front', $3)) with points pt 6 title 'Martin \& Moyce (1952)'
set xlabel 't [s]'; set ylabel 'height at the left wall over that at first'; set xrange [0:2]; set yrange [0:1.1]; set key right top
plot ARG2 using 1:4 with lines title 'SPH, 2 m x 1 m', ARG1 using 2:(only('exact_height', $3)) with points pt 2 title 'potential flow', \
  ARG3 using 1:($4/2) with lines title 'SPH, 1 m x 2 m', ARG1 using ($2/sqrt(9.81)):(only('left', $3)) with points pt 6 title 'Martin \& Moyce (1952)'
set xlabel 't sqrt(g/H)'; set ylabel 'pressure 0.2 m up the right wall/(rho g H)'; set xrange [0:*]; set yrange [*:*]; unset key
plot ARG2 using ($1*sqrt(9.81)):($5/9810) with lines
