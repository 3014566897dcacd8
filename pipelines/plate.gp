# SPDX-License-Identifier: GPL-3.0-or-later
# gnuplot -c plate.gp 'SPEEDS' FOLDER OUT.png: the tip over time, and as a thin plate has it.
set terminal pngcairo size 900,450
set output ARG3
set xlabel 't [s]'; set ylabel 'tip [cm]'; set samples 500; set key outside top
plot for [v in ARG1] ARG2.'/v'.v.'/tip.tsv' using 1:($2*100) with points pt 7 ps 0.6 title 'speed '.v, \
  for [v in ARG1] [0:0.36] 5703*v/24.734*sin(24.734*x) with lines lc 'gray' title ''
