# SPDX-License-Identifier: GPL-3.0-or-later
# gnuplot -c rings.gp FOLDER 'TIMES' OUT.png: particles with (above) and without (below) artificial stress, a colour a ring.
n = words(ARG2)
set terminal pngcairo size 400*n,720
set output ARG3
set datafile commentschars '#'
set multiplot layout 2,n margins 0.03,0.99,0.05,0.95 spacing 0.02,0.06
unset key
set size ratio -1
set xrange [-11:11]; set yrange [-9:9]
set palette defined (0 '#3b6fb6', 1 '#d1495b'); unset colorbox
do for [row in 'with without'] { do for [k = 1:n] {
  set title row.' artificial stress, t = '.word(ARG2, k)
  plot ARG1.'/'.row.'/t'.word(ARG2, k).'.tsv' using 1:2:3 with points pt 7 ps 0.35 palette
} }
