# SPDX-License-Identifier: GPL-3.0-or-later
# gnuplot -c bounce.gp with.tsv without.tsv OUT.png: mean velocity and width of the left ring over time.
set terminal pngcairo size 1000,400
set output ARG3
set datafile commentschars '#'
set multiplot layout 1,2
set xlabel 't [cm/c_s]'; set ylabel 'v/v_0 of the left ring'
plot ARG1 using 1:2 with lines lw 2 title 'with artificial stress', ARG2 using 1:2 with lines lw 2 title 'without'
set ylabel 'width [cm]'
plot ARG1 using 1:3 with lines lw 2 title 'with artificial stress', ARG2 using 1:3 with lines lw 2 title 'without'
