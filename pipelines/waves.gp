# SPDX-License-Identifier: GPL-3.0-or-later
# gnuplot -c waves.gp longitudinal.tsv transverse.tsv strip.tsv rod.tsv OUT.png: amplitudes of the standing waves over time.
set terminal pngcairo size 1100,700
set output ARG5
set multiplot layout 2,2
set xlabel 't [periods]'; set ylabel 'amplitude'; set xrange [0:5]; set yrange [-1.2:1.2]; set samples 500; unset key
do for [k = 1:4] {
  set title word('longitudinal transverse strip rod', k)
  plot cos(2*pi*x) with lines lc 'gray', value('ARG'.k) using 1:2 with points pt 7 ps 0.5
}
