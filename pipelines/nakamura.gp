# SPDX-License-Identifier: GPL-3.0-or-later
# gnuplot -c nakamura.gp 'RUNS' FOLDER OUT.png: cumulative masses of fragments at the end; the core over time.
set terminal pngcairo size 1100,450 noenhanced
set output ARG3
set datafile commentschars '#'
set multiplot layout 1,2
set logscale xy
set xlabel 'mass over that of the basalt'; set ylabel 'fragments at least that massive'; unset key
plot for [r in ARG1] ARG2.'/'.r.'/end.tsv' using ($3/0.305363):1 with linespoints pt 7 ps 0.4 title r
unset logscale
set xlabel 't [us]'; set ylabel 'largest fragment over the basalt'; set yrange [0:1.05]; set key left bottom
plot for [r in ARG1] ARG2.'/'.r.'/core.tsv' using 1:2 with lines title r, 0.31 with lines lc 'gray' dt 2 title 'measured'
