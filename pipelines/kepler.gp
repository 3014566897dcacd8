# SPDX-License-Identifier: GPL-3.0-or-later
# gnuplot -c kepler.gp conserved.tsv orbit.tsv OUT.png: change of the energy over the orbits.
set terminal pngcairo size 700,450
set output ARG3
set datafile commentschars '#'
set xlabel 'orbits'; set ylabel 'change of the energy, over it'; unset key
stats ARG1 using ($6 + $8) every ::0::0 nooutput
plot ARG1 using ($2/(2*pi)):(($6 + $8)/STATS_min - 1) with lines
