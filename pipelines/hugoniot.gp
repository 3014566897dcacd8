# SPDX-License-Identifier: GPL-3.0-or-later
# gnuplot -c hugoniot.gp reference.tsv points.tsv end.tsv OUT.png: shock over matter speed; pressure in the fastest run.
set terminal pngcairo size 1100,450
set output ARG4
set datafile commentschars '#'
set multiplot layout 1,2
set xlabel 'u_p [km/s]'; set ylabel 'U_s [km/s]'; set key left top
plot ARG1 using ($2/1e3):(stringcolumn(1) eq 'basalt' ? $3/1e3 : 1/0) with linespoints dt 2 title 'basalt', \
  '' using ($2/1e3):(stringcolumn(1) eq 'aluminium' ? $3/1e3 : 1/0) with linespoints dt 2 title 'aluminium', \
  ARG2 using ($1/1e3):($2/1e3) with points pt 7 ps 1.5 title 'plates of aluminium in the solver', 5.35 + 1.34*x with lines lc 'gray' title 'Al 6061, measured'
set xlabel 'x [m]'; set ylabel 'pressure [GPa]'; unset key
plot ARG3 using 1:($2/1e9) with points pt 7 ps 0.3
