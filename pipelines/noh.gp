# SPDX-License-Identifier: GPL-3.0-or-later
# gnuplot -c noh.gp end.tsv OUT.png: density and pressure of the particles over Noh's solution at t = 0.6.
set terminal pngcairo size 1100,450
set output ARG2
set datafile commentschars '#'
set multiplot layout 1,2
set xrange [0:0.4]; set xlabel 'r'; set samples 1000
set title 'density'
plot ARG1 using 1:2 every ::::200000 with dots lc 'steelblue' notitle, x < 0.2 ? 64 : (1 + 0.6/x)**2 with lines lc 'black' title 'exact'
set title 'pressure'
plot ARG1 using 1:4 every ::::200000 with dots lc 'steelblue' notitle, x < 0.2 ? 64/3. : 0 with lines lc 'black' notitle
