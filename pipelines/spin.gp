# SPDX-License-Identifier: GPL-3.0-or-later
# gnuplot -c spin.gp lattice/conserved.tsv disturbed/conserved.tsv OUT.png: angular momentum over the turn.
set terminal pngcairo size 800,450
set output ARG3
set datafile commentschars '#'
set xlabel 't [one turn is 100]'; set ylabel '|L_z/L_z(0) - 1|'; set logscale y; set format y '10^{%L}'; set key left top
plot ARG1 using 2:(L = ($0 == 0 ? $15 : L), abs($15/L - 1)) with lines lw 2 title 'lattice', \
  ARG2 using 2:(L = ($0 == 0 ? $15 : L), abs($15/L - 1)) with lines lw 2 title 'disturbed by 10 % of the spacing'
