# SPDX-License-Identifier: GPL-3.0-or-later
# gnuplot -c convergence.gp errors.tsv YLABEL XLABEL OUT.png: errors over the spacing, log-log; the columns are named in the first line.
set terminal pngcairo size 700,520
set output ARG4
set logscale xy
set format xy '10^{%L}'
set xlabel ARG3; set ylabel ARG2; set key left top
set xtics format "10^{%L}"
columns = int(system("awk -F'\t' 'END { print NF }' ".ARG1))
name(k) = system("sed -n '1s/^# //p' ".ARG1." | cut -f ".k)
stats ARG1 using 1:2 nooutput
plot for [k = 2:columns] ARG1 using 1:k with linespoints pt 7 title name(k), \
  STATS_max_y*x/STATS_max_x with lines dt 2 lc 'gray' title 'first order', STATS_max_y*(x/STATS_max_x)**2 with lines dt 3 lc 'gray' title 'second order'
