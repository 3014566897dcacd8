# SPDX-License-Identifier: GPL-3.0-or-later
# gnuplot -c poiseuille.gp end.tsv OUT.png: profiles across the channel at four times, on the series.
set terminal pngcairo size 800,520
set output ARG2
set datafile commentschars '#'
set xlabel 'y/L'; set ylabel 'v/v_0'; set xrange [-0.5:0.5]; set yrange [0:1.05]; set key outside right; set samples 300
mode(m, y, t) = 32*(m % 4 == 1 ? 1 : -1)/(m*pi)**3*cos(m*pi*y)*exp(-(m*pi)**2*t)
exact(y, t) = 1 - 4*y*y - (sum [k = 0:19] mode(2*k + 1, y, t))
times = '0.05 0.1 0.2 0.5'
plot for [k = 1:4] exact(x, real(word(times, k))) with lines lc k title 't = '.word(times, k).' L^2/nu', \
  for [k = 1:4] ARG1 using ($1 == real(word(times, k)) ? $3 : 1/0):($4/0.5) with points pt 7 ps 0.4 lc k notitle
