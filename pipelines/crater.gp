# SPDX-License-Identifier: GPL-3.0-or-later
# gnuplot -c crater.gp 'STRENGTH...' FOLDER OUT.png: depth and radius of the craters over time, with the measured depths.
set terminal pngcairo size 800,500
set output ARG3
set datafile commentschars '#'
set xlabel 't [microseconds]'; set ylabel '[mm]'; set key right bottom; set yrange [0:*]
plot for [k = 1:words(ARG1)] ARG2.'/Y'.word(ARG1, k).'/shape.tsv' using 1:2 with linespoints lc k pt 7 ps 0.5 title 'depth, '.word(ARG1, k).' MPa', \
  for [k = 1:words(ARG1)] ARG2.'/Y'.word(ARG1, k).'/shape.tsv' using 1:3 with lines lc k dt 2 title 'radius, '.word(ARG1, k).' MPa', \
  12.8 with lines lc 'gray' title '12.8, 18.3 mm: measured depths', 18.3 with lines lc 'gray' notitle
