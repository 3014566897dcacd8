# SPDX-License-Identifier: GPL-3.0-or-later
# gnuplot -c mercury.gp axis.tsv OUT.png: pressure against time at three places, and the exact one.
set terminal pngcairo size 900,480
set output ARG2
set datafile commentschars '#'
set xlabel 'time [us]'; set ylabel 'pressure [MPa]'; set yrange [-3:4]
plot for [k = 0:2] ARG1 using 1:(column(2*k+2)) with points pt 7 ps 0.7 lc k+1 title sprintf('SPH, %d mm', 20*k), \
  for [k = 0:2] '' using 1:(column(2*k+3)) with lines lc k+1 title sprintf('exact, %d mm', 20*k)
