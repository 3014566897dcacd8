# SPDX-License-Identifier: GPL-3.0-or-later
# gnuplot -c cloud.gp density.tsv OUT.png: the largest density over time, with that of another code at 8217 particles.
set terminal pngcairo size 700,500
set output ARG2
set datafile commentschars '#'
$probe << EOD
0.51 3.64e-14
0.82 8.7e-14
1.01 3.05e-13
1.10 1.09e-12
1.20 4.2e-12
EOD
set logscale y; set format y '10^{%L}'; set xlabel 't/t_{ff}'; set ylabel 'largest density [kg/m^3]'; set key left top
plot ARG1 using 1:2 with linespoints pt 7 ps 0.5 title 'here', $probe using 1:2 with points pt 6 title 'another code, 8217 particles'
