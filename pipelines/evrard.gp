# SPDX-License-Identifier: GPL-3.0-or-later
# gnuplot -c evrard.gp conserved.tsv profile.tsv evrard.tsv OUT.png: energies over time and density at t = 0.8, with those of the 1-D calculation.
set terminal pngcairo size 1100,450
set output ARG4
set datafile commentschars '#'
$reference << EOD
0.8 0.411 0.467 -1.495
0.9 0.443 0.912 -1.970
1.0 0.270 1.576 -2.460
1.1 0.123 1.720 -2.456
1.2 0.118 1.420 -2.151
1.3 0.163 1.110 -1.886
EOD
set multiplot layout 1,2
set xlabel 't'; set title 'energies; points: 1-D calculation'; set key left bottom
plot ARG1 using 2:6 with lines title 'kinetic', '' using 2:7 with lines title 'internal', '' using 2:8 with lines title 'potential', \
  '' using 2:9 with lines lc 'black' title 'total', for [k = 2:4] $reference using 1:k with points pt 6 lc k - 1 notitle
set title 'density at t = 0.8; line: 1-D calculation'; set xlabel 'r'; set logscale xy; set xrange [0.01:1.2]; unset key
plot ARG2 using 1:2 every ::::200000 with dots lc 'steelblue', ARG3 using 1:2 with lines lc 'black'
