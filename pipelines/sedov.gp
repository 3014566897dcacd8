# SPDX-License-Identifier: GPL-3.0-or-later
# gnuplot -c sedov.gp end.tsv bins.tsv OUT.png: density and pressure of the particles, the mean in shells, the front of Sedov's solution.
set terminal pngcairo size 1100,450
set output ARG3
set datafile commentschars '#'
set multiplot layout 1,2
set xrange [0:0.5]; set xlabel 'r'
set arrow 1 from 0.34747, graph 0 to 0.34747, graph 1 nohead dt 2 lc 'black'
set title 'density'
plot ARG1 using 1:2 every ::::200000 with dots lc 'steelblue' notitle, ARG2 using 1:2 with lines lc 'dark-orange' lw 2 title 'mean in shells', NaN dt 2 lc 'black' title 'front of the exact solution'
set title 'pressure'
plot ARG1 using 1:4 every ::::200000 with dots lc 'steelblue' notitle
