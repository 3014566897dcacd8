# SPDX-License-Identifier: GPL-3.0-or-later
# gnuplot -c sod.gp end.tsv OUT.png: density, velocity and pressure of the particles over the exact solution.
set terminal pngcairo size 1200,420
set output ARG2
set datafile commentschars '#'
g = 1.4; ps = 0.30313; us = 0.927453; rs = 0.426319; rr = 0.265574; t = 0.2
c(x) = 2/(g + 1)*(sqrt(g) - (g - 1)/2*x)
pick(x, l, f, a, b, r) = x < -sqrt(g) ? l : x < us - sqrt(g*ps/rs) ? f : x < us ? a : x < 1.752156 ? b : r
rho(x) = pick(x, 1, (c(x)/sqrt(g))**(2/(g - 1)), rs, rr, 0.125)
v(x) = pick(x, 0, 2/(g + 1)*(sqrt(g) + x), us, us, 0)
p(x) = pick(x, 1, (c(x)/sqrt(g))**(2*g/(g - 1)), ps, ps, 0.1)
set multiplot layout 1,3
set xrange [-0.5:0.5]; set samples 2000; set xlabel 'x'
set title 'density'; plot ARG1 using 1:2 with points pt 7 ps 0.3 title 'SPH', rho(x/t) with lines lc 'black' title 'exact'
set title 'velocity'; plot ARG1 using 1:3 with points pt 7 ps 0.3 notitle, v(x/t) with lines lc 'black' notitle
set title 'pressure'; plot ARG1 using 1:4 with points pt 7 ps 0.3 notitle, p(x/t) with lines lc 'black' notitle
