# SPDX-License-Identifier: GPL-3.0-or-later
# gnuplot -c cloud.gp OUT.png density.tsv [density_LENGTH.tsv ...]: the largest density over time, softened by h and by Plummer's lengths,
# with that of another code at 8217 particles.
set terminal pngcairo size 700,500
set output ARG1
set datafile commentschars '#'
$probe << EOD
0.51 3.64e-14
0.82 8.7e-14
1.01 3.05e-13
1.10 1.09e-12
1.20 4.2e-12
EOD
set logscale y; set format y '10^{%L}'; set xlabel 't/t_{ff}'; set ylabel 'largest density [kg/m^3]'; set key left top
title_of(file) = file[strstrt(file, 'density') + 8 : strlen(file) - 4].' R'
plot for [k = 2:ARGC] ARGV[k] using 1:2 with linespoints pt 7 ps 0.5 title k > 2 ? title_of(ARGV[k]) : 'softened by h', \
  $probe using 1:2 with points pt 6 title 'another code, 8217 particles'
