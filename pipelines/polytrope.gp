# SPDX-License-Identifier: GPL-3.0-or-later
# gnuplot -c polytrope.gp settled.tsv pulse.tsv OUT.png: density at rest over the exact one; R_rms over time.
set terminal pngcairo size 1100,450
set output ARG3
set datafile commentschars '#'
set multiplot layout 1,2
set xlabel 'r'; set title 'density at rest'; set xrange [0:1.1]; set samples 500
plot ARG1 using 1:2 every ::::200000 with dots lc 'steelblue' notitle, x < 1 ? pi/4*sin(pi*x + 1e-9)/(pi*x + 1e-9) : 0 with lines lc 'black' title 'exact'
set xlabel 't/3.24254'; set title 'root mean square radius'; set autoscale x
plot ARG2 using ($1/3.24254):2 with linespoints pt 7 ps 0.4 notitle
