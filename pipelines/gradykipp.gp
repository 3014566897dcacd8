# SPDX-License-Identifier: GPL-3.0-or-later
# gnuplot -c gradykipp.gp curves.tsv OUT.png: mean stress over strain, of the solver and of flaws integrated one by one.
set terminal pngcairo size 900,500
set output ARG2
set xlabel 'strain [10^{-3}]'; set ylabel 'mean stress [MPa]'; set logscale x; set key left top
plot for [r in '1e2 3e2 1e3'] ARG1 using (stringcolumn(1) eq r ? $1*$2*1e3 : 1/0):($3/1e6) with points pt 7 ps 0.6 title 'rate '.r.' 1/s', \
  ARG1 using ($1*$2*1e3):($4/1e6) with points pt 6 ps 0.9 lc 'gray' title 'flaws one by one'
