#!/usr/bin/env bats
# SPDX-License-Identifier: GPL-3.0-or-later
# mkshape: shapes with their exact masses and extents, layers, pores, boulders, surfaces from files.

load h5

setup() { cd "$BATS_TEST_TMPDIR"; }

# extent FILE: smallest and largest x, y, z
extent() {
  field "$1" Coordinates 3 | awk 'NR == 1 { for (a = 1; a <= 3; a++) l[a] = h[a] = $a }
    { for (a = 1; a <= 3; a++) { if ($a < l[a]) l[a] = $a; if ($a > h[a]) h[a] = $a } } END { print l[1], h[1], l[2], h[2], l[3], h[3] }'
}
mass() { field "$1" Masses | awk '{ m += $1 } END { printf "%.15g", m }'; }

@test "an ellipsoid: mass, axes, orientation of the lattice, spin" {
  mkshape --size 10km,8km,6km -l basalt -n 4000 --rotate 3 --spin 5h -o a.h5
  true_that 'near(m, 2700*4/3*atan2(0, -1)*480e9, 1e-12)' m="$(mass a.h5)"
  read -r x0 x1 y0 y1 z0 z1 < <(extent a.h5)
  true_that 'abs(x1 - x0 - 2e4) < 1500 && abs(y1 - y0 - 16e3) < 1500 && abs(z1 - z0 - 12e3) < 1500' x0=$x0 x1=$x1 y0=$y0 y1=$y1 z0=$z0 z1=$z1
  paste <(field a.h5 Coordinates 3) <(field a.h5 Velocities 3) | awk 'BEGIN { w = 2*atan2(0, -1)/18000 }
    { d = $4 + w*$2; e = $5 - w*$1; if (d*d + e*e > 1e-16 || $6 != 0) exit 1 }'
  n=$(field a.h5 Masses | wc -l)
  true_that 'n > 3800 && n < 4200' n=$n
}

@test "targets: layers by depth with exact masses, pores as Distention that weibull knows" {
  mkshape --shape hemisphere --size 2km -l ice:200m -l basalt::pores=0.25 -n 3000 -o t.h5
  paste <(field t.h5 MaterialID) <(field t.h5 Masses) <(field t.h5 Coordinates 3) <(field t.h5 Density) <(field t.h5 Distention) | awk '
    function near(a, b) { return a/b - 1 < 1e-9 && 1 - a/b < 1e-9 }
    { m[$1] += $2; if ($5 > 0 || ($1 == 0) != ($5 > -200)) exit 1
      if (!near($6, $1 ? 2025 : 917) || !near($7, $1 ? 1/0.75 : 1)) exit 2 }
    END { v = atan2(0, -1)*(4e6 - 200*200/3)*200; all = 2*atan2(0, -1)/3*8e9
      exit !(near(m[0], 917*v) && near(m[1], 2025*(all - v))) }'
  weibull --verbose -o /dev/null t.h5
  mkshape --shape box --size 4m,2m,1m -l iron -n 2000 --lattice cubic -o b.h5
  true_that 'near(m, 7800*8, 1e-12)' m="$(mass b.h5)"
  mkshape -d 2 --shape box --size 4m,1m -l ice:0.5m -l iron -n 500 -o b2.h5
  true_that 'near(m, 4*0.5*(917 + 7800), 1e-12)' m="$(mass b2.h5)"
}

@test "for the laboratory: rod, ring, cylinder, tank of two materials" {
  mkshape --shape rod --size 1m,5cm -l aluminium -n 1000 -o r.h5
  true_that 'near(m, 2700*atan2(0, -1)*0.0025, 1e-9)' m="$(mass r.h5)"
  mkshape -d 2 --shape ring --size 3cm,4cm -l lucite -n 1000 -o ring.h5
  field ring.h5 Coordinates 3 | awk '{ r = sqrt($1*$1 + $2*$2); if (r < 0.03 || r > 0.04 || $3 != 0) exit 1 }'
  mkshape --shape cylinder --size 1m,2m -l granite -n 1000 -o c.h5
  mkshape --shape tank --size 1m,1m,1m,0.2m -l water -l aluminium -n 3000 -o k.h5
  paste <(field k.h5 MaterialID) <(field k.h5 Coordinates 3) | awk '{ x = $2 < 0 ? -$2 : $2; y = $3 < 0 ? -$3 : $3
      in_it = x <= 0.5 && y <= 0.5 && $4 >= -1; if (($1 == 0) != in_it) exit 1; n[$1]++ } END { exit !(n[0] > 500 && n[1] > 500) }'
}

@test "a rubble pile: boulders of their own body, apart, each with its mass" {
  mkshape --size 100m,80m,70m -l basalt --rubble 15m:40m --fill 0.4 -n 3000 --rotate 1 -o p.h5 2>said
  n=$(sed -n 's/mkshape: \([0-9]*\) boulders.*/\1/p' said)
  [ "$(field p.h5 BodyID | sort -n | uniq | wc -l)" = "$n" ]
  [ "$n" -gt 5 ]
  mkshape --size 100m,80m,70m -l basalt --rubble 15m:40m --fill 0.4 -n 3000 --rotate 1 -o q.h5
  cmp <(field p.h5 Coordinates) <(field q.h5 Coordinates)
  # a boulder's particles lie within the radius of its mass
  paste <(field p.h5 BodyID) <(field p.h5 Masses) <(field p.h5 Coordinates 3) | awk '
    { m[$1] += $2; for (a = 3; a <= 5; a++) c[$1, a] += $2*$a; b[NR] = $1; for (a = 3; a <= 5; a++) x[NR, a] = $a }
    END { for (i = 1; i <= NR; i++) { k = b[i]; r = 0; for (a = 3; a <= 5; a++) r += (x[i, a] - c[k, a]/m[k])^2
      if (sqrt(r) > 1.3*(m[k]/2700/4.18879)^(1/3)) exit 1 } }'
}

@test "a shape model: text and scale; what is not closed is refused" {
  printf '%s\n' 'v 0 0 0' 'v 2 0 0' 'v 2 2 0' 'v 0 2 0' 'v 0 0 2' 'v 2 0 2' 'v 2 2 2' 'v 0 2 2' \
    'f 4 3 2 1' 'f 5 6 7 8' 'f 1 2 6 5' 'f 2 3 7 6' 'f 3 4 8 7' 'f 5 8 4 1' >box.obj
  mkshape --shape mesh --mesh box.obj --scale 1km -l ice -n 1000 -o m.h5
  true_that 'near(m, 917*8e9, 1e-12)' m="$(mass m.h5)"
  sed -i '$d' box.obj
  bad 1 "not closed: 4 edges" mkshape --shape mesh --mesh box.obj -l ice
}

@test "what is no ball is not laid on a structure of shells" {
  mkshape --size 10km,8km,6km -l basalt -n 300 -o e.h5
  bad 1 "the body is not a ball" relax e.h5
}

@test "every mistake is one line" {
  bad 2 "which material" mkshape --size 1,1,1
  bad 2 "needs --size with 3 lengths, not 1" mkshape --size 1 -l ice
  bad 2 "--size: " mkshape --size 1kg,2,3 -l ice
  bad 2 "is of one layer" mkshape --size 1,2,3 -l ice -l iron
  bad 2 "needs a thickness" mkshape --shape box --size 1,2,3 -l ice -l iron
  bad 2 "no thickness" mkshape --shape box --size 1,2,3 -l ice:1 -l iron:2
  bad 2 "ends 5 m deep" mkshape --shape box --size 1,2,3 -l ice:5 -l iron
  bad 2 "pores are 0 to 1" mkshape --size 1,2,3 -l ice:pores=1
  bad 2 "no cylinder in 2D" mkshape -d 2 --shape cylinder --size 1,2 -l ice
  bad 2 "two layers" mkshape --shape tank --size 1,1,1,1 -l ice
  bad 2 "MIN:MAX" mkshape --size 1,1,1 -l ice --rubble 3
  bad 2 "the slope, -2, is negative" mkshape --size 1,1,1 -l ice --rubble 1cm:2cm:-2
  bad 1 "more than 1023 boulders" mkshape --size 1,1,1 -l ice --rubble 1mm:1mm -n 100
  bad 2 "--neighbours 1000 of 100 particles" mkshape --size 1,1,1 -l ice -n 100 --neighbours 1000
  bad 2 "0 < MIN" mkshape --size 1,1,1 -l ice --rubble 3:2
  bad 1 "no sphere of 3 m fits" mkshape --size 1,1,1 -l ice --rubble 3:4
  bad 2 "--mesh needs --shape mesh" mkshape --mesh a.stl -l ice
  bad 2 "not above the inner" mkshape --shape ring --size 2,1,1 -l ice
  bad 1 "unknown material 'icy'" mkshape --size 1,1,1 -l icy
  bad 2 "either --number or --spacing" mkshape --size 1,1,1 -l ice -n 9 --spacing 1
  bad 2 "a grid is not turned" mkshape --size 1,1,1 -l ice --lattice grid --rotate 1
  bad 2 "density is not positive" mkshape --size 1,1,1 -l ice:rho=-1
  bad 2 "no box in 1D" mkshape -d 1 --shape box --size 1 -l ice
  bad 1 "holds no particle" mkshape --shape box --size 1m,1m,1m -l ice:1mm -l iron -n 100
}

@test "a grid tiles its box: lines, planes and space that periodic edges continue; densities as given" {
  mkshape -d 1 --shape rod --size 1m --spacing 1cm --lattice grid -l water:rho=900 -o r.h5
  field r.h5 Coordinates 3 | awk '{ d = $1 + 0.5 - (NR - 0.5)/100; if (d*d > 1e-24 || $2 != 0) exit 1 } END { exit NR != 100 }'
  true_that 'near(m, 900, 1e-12)' m="$(mass r.h5)"
  mkshape -d 2 --shape box --size 3m,2m --spacing 0.51m --lattice grid -l water -o b.h5 # 6 by 4 cells of 0.5 m
  read -r x0 x1 y0 y1 z0 z1 < <(extent b.h5)
  true_that 'near(x1 - x0, 2.5, 1e-9) && near(y0, -1.75, 1e-9) && near(y1, -0.25, 1e-9) && z1 == 0' x0=$x0 x1=$x1 y0=$y0 y1=$y1 z1=$z1
  mkshape -d 2 --shape tank --size 1m,0.5m,0.1m --spacing 0.05m --lattice grid -l water -l aluminium -o t.h5
  [ "$(field t.h5 MaterialID | sort | uniq -c | awk '{ printf "%s ", $1 }')" = '200 88 ' ]
  mkshape --shape box --size 1m,1m,1m --spacing 0.25m --lattice grid -l water -o c.h5
  [ "$(field c.h5 Masses | wc -l)" = 64 ]
}
