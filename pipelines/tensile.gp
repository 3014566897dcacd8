# SPDX-License-Identifier: GPL-3.0-or-later
# gnuplot -c tensile.gp 'SEEDS' FOLDER OUT.png: stress at |x| = 0.6 and greatest damage over time.
set terminal pngcairo size 1000,400
set output ARG3
set multiplot layout 1,2
set xlabel 't [cm/c]'; set ylabel 'stress at |x| = 0.6 [rho c^2]'
plot for [s in ARG1] ARG2.'/s'.s.'/crack.tsv' using 1:4 with lines title 'seed '.s
set ylabel 'greatest damage'; set key right bottom
plot for [s in ARG1] ARG2.'/s'.s.'/crack.tsv' using 1:2 with lines title 'seed '.s
