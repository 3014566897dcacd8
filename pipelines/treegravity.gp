# SPDX-License-Identifier: GPL-3.0-or-later
# gnuplot -c treegravity.gp errors.tsv 'THETA...' OUT.png: cumulative distribution of the errors (Reufer 2011, figure 2.10).
set terminal pngcairo size 700,500
set output ARG3
set datafile commentschars '#'
set logscale x; set format x '10^{%L}'
set xlabel 'relative error of the acceleration'; set ylabel 'part of the particles with less'; set key left top
plot for [k = 1:words(ARG2)] ARG1 using (column(k + 1)):1 with lines title 'theta = '.word(ARG2, k)
