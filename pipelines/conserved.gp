# SPDX-License-Identifier: GPL-3.0-or-later
# gnuplot -c conserved.gp conserved.tsv OUT.png: energies and what the conserved quantities drift.
set terminal pngcairo size 1000,900
set output ARG2
set datafile commentschars '#'
set multiplot layout 2,1
set key outside right
set format x '%.0f'
stats ARG1 using 6 every ::0::0 name 'K' nooutput
stats ARG1 using 9 every ::0::0 name 'E' nooutput
stats ARG1 using 15 every ::0::0 name 'L' nooutput
stats ARG1 using 16 every ::0::0 name 'P' nooutput
set xlabel 'time after contact [h]'
set ylabel 'energy [J]'
plot ARG1 using ($2/3600):6 with lines title 'kinetic', '' using ($2/3600):7 with lines title 'internal', \
     '' using ($2/3600):8 with lines title 'potential', '' using ($2/3600):9 with lines title 'total'
set ylabel 'drift'
set logscale y
set format y '10^{%L}'
plot ARG1 using ($2/3600):(abs($9 - E_min)/K_min) with lines title 'total / kinetic at the start', \
     '' using ($2/3600):(abs($15 - L_min)/abs(L_min)) with lines title 'angular momentum L_z', \
     '' using ($2/3600):(sqrt($10**2 + $11**2 + $12**2)/P_min) with lines title 'momentum / sum m v'
