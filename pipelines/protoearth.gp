# SPDX-License-Identifier: GPL-3.0-or-later
# gnuplot -c protoearth.gp profile.tsv standard.tsv miscible.tsv OUT.png: pressure and density of particles over the 1-D structure.
set terminal pngcairo size 1100,900
set output ARG4
set datafile commentschars '#'
set multiplot layout 2,2
set xlabel 'r [1000 km]'
set key top right
do for [how = 2:3] {
  set title word('- standard miscible', how)
  set ylabel 'pressure [GPa]'
  plot value('ARG'.how) using ($2/1e6):($1 == 0 ? $3/1e9 : 1/0) with points pt 7 ps 0.3 title 'iron', \
       '' using ($2/1e6):($1 == 1 ? $3/1e9 : 1/0) with points pt 7 ps 0.3 title 'granite', \
       ARG1 using ($1/1e6):($4/1e9) with lines lc 'black' title '1-D'
}
unset title
do for [how = 2:3] {
  set ylabel 'density [g/cm^3]'
  plot value('ARG'.how) using ($2/1e6):($1 == 0 ? $4/1e3 : 1/0) with points pt 7 ps 0.3 title 'iron', \
       '' using ($2/1e6):($1 == 1 ? $4/1e3 : 1/0) with points pt 7 ps 0.3 title 'granite', \
       ARG1 using ($1/1e6):($3/1e3) with lines lc 'black' title '1-D'
}
