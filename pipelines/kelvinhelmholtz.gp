# SPDX-License-Identifier: GPL-3.0-or-later
# gnuplot -c kelvinhelmholtz.gp growth.tsv OUT.png: amplitude of the disturbance against time, and Rayleigh's growth rate.
set terminal pngcairo size 700,480
set output ARG2
set datafile commentschars '#'
U = 0.5; d = 0.0317; kd = 4*pi*d; s = U/(2*d)*sqrt(exp(-4*kd) - (1 - 2*kd)**2)
set logscale y; set xlabel 'time'; set ylabel 'amplitude of v_y'; set key left top
stats ARG1 using 2 every ::2 nooutput
plot ARG1 using 1:2 with linespoints pt 7 title 'SPH', STATS_min*exp(s*x) with lines dt 2 lc 'black' title sprintf('exp(%.3g t)', s)
