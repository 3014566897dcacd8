# SPDX-License-Identifier: GPL-3.0-or-later
# gnuplot -c taylorgreen.gp conserved.tsv OUT.png: kinetic energy against time, and the exact one.
set terminal pngcairo size 700,480
set output ARG2
set datafile commentschars '#'
set logscale y; set xlabel 't [s]'; set ylabel 'kinetic energy over that at the start'
e = system("awk -F'\t' '!/^#/ { print $6; exit }' ".ARG1) + 0
plot ARG1 using 2:($6/e) with points pt 7 ps 0.3 title 'SPH', exp(-16*pi**2*0.5*x) with lines lc 'black' title 'exp(-4 nu k^2 t)'
