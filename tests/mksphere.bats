#!/usr/bin/env bats
# SPDX-License-Identifier: GPL-3.0-or-later
# mksphere: lattice bodies as in docs/theory.md 6.1.

bats_require_minimum_version 1.5.0

load h5

setup() { cd "$BATS_TEST_TMPDIR"; }

@test "a layered body: exact layer masses, centre of mass, ids, radius, density" {
  mksphere -n 3000 --mass 9.43e20 --layer basalt:0.7 --layer ice:0.3 --rotate 4 >b.h5
  n=$(field b.h5 ParticleIDs | wc -l)
  true_that 'n > 2940 && n < 3060' n="$n"
  [ "$(field b.h5 ParticleIDs | sort -n | uniq | sed -n '1p;$p' | tr '\n' ' ')" = "0 $((n - 1)) " ]
  paste <(field b.h5 MaterialID) <(field b.h5 Masses) <(field b.h5 Density) <(field b.h5 Coordinates 3) | awk '
    function abs(x) { return x < 0 ? -x : x }
    { m[$1] += $2; v += $2 / $3; r = sqrt($4 * $4 + $5 * $5 + $6 * $6)
      for (a = 1; a <= 3; a++) c[a] += $2 * $(3 + a) / 9.43e20
      if (!$1 && r > core) core = r; if ($1 && (!mantle || r < mantle)) mantle = r; if (r > out) out = r }
    END {
      if (abs(m[0] / 9.43e20 - 0.7) > 1e-13 || abs(m[1] / 9.43e20 - 0.3) > 1e-13) exit 1
      for (a = 1; a <= 3; a++) if (abs(c[a]) > 1e-6) exit 2
      R = (3 * v / (4 * atan2(0, -1))) ^ (1 / 3)      # core and mantle do not mix; the surface is the last shell
      if (abs(R / 509184.955 - 1) > 1e-8 || core >= mantle || out > R * 1.02 || out < R * 0.95) exit 3
    }'
  true_that 'near(r, 509184.955, 1e-8)' r="$(number b.h5 /Body/Radius0)"
}

@test "equal volumes: masses in the ratio of densities, but for the rounding of layers" {
  mksphere -n 20000 --radius 100km --layer iron:0.3 --layer basalt:0.7 >b.h5
  paste <(field b.h5 MaterialID) <(field b.h5 Masses) | sort | uniq | awk '{m[$1] = $2}
    END {q = m[0] / m[1] / (7800 / 2700); exit !(NR == 2 && q > 0.98 && q < 1.02)}'
}

@test "the support holds 57 particles on average, as --neighbours asks" {
  mksphere -n 3000 --radius 100km --layer ice >b.h5
  n=$(field b.h5 ParticleIDs | wc -l) # 4/3 pi h^3 n/V = 57
  true_that 'near((h / 1e5) ^ 3 * n, 57, 1e-12)' h="$(field b.h5 SmoothingLength | uniq)" n="$n"
  mksphere -n 3000 --radius 100km --layer ice --neighbours 100 >c.h5
  true_that 'near((h / 1e5) ^ 3 * n, 100, 1e-12)' h="$(field c.h5 SmoothingLength | uniq)" n="$n"
}

@test "mass from radius and radius from mass agree" {
  mksphere -n 100 --radius 50km --layer iron:0.5 --layer ice:0.5 >a.h5
  m=$(field a.h5 Masses | awk '{m += $1} END {printf "%.17g", m}')
  mksphere -n 100 --mass "$m" --layer iron:0.5 --layer ice:0.5 >b.h5
  true_that 'near(r, 5e4, 1e-12)' r="$(number b.h5 /Body/Radius0)"
}

@test "rotation: another orientation, the same distances; the same seed, the same bytes" {
  mksphere -n 500 --radius 1km --layer basalt -o a.h5
  mksphere -n 500 --radius 1km --layer basalt --rotate 1 -o b.h5
  radii() { field "$1" Coordinates 3 | awk '{printf "%.6f\n", sqrt($1 * $1 + $2 * $2 + $3 * $3)}'; }
  [ "$(radii a.h5)" = "$(radii b.h5)" ]
  [ "$(field a.h5 Coordinates | head -3)" != "$(field b.h5 Coordinates | head -3)" ]
  mv b.h5 c.h5
  mksphere -n 500 --radius 1km --layer basalt --rotate 1 -o b.h5
  cmp b.h5 c.h5
}

@test "spin: v = omega x r about z" {
  mksphere -n 300 --radius 10km --layer basalt --rotate 2 --spin 2h >b.h5
  paste <(field b.h5 Coordinates 3) <(field b.h5 Velocities 3) | awk '
    function abs(x) { return x < 0 ? -x : x } BEGIN {w = 2 * atan2(0, -1) / 7200}
    abs($4 + w * $2) > 1e-12 || abs($5 - w * $1) > 1e-12 || $6 != 0 {exit 1}'
}

# sqrt(3 pi/(G rho)): 7231.9 s for basalt
@test "spin: what gravity does not hold together is warned of" {
  for spin in 2h -2h; do
    mksphere -n 300 --radius 10km --layer basalt --spin $spin -o b.h5 2>said
    grep -q '^mksphere: warning: gravity alone .* less than 7231\.[0-9]* s (period 7200 s)$' said
  done
  for body in '--layer basalt --spin 2.01h' '--layer basalt' '--layer basalt -d 2 --spin 2h'; do
    mksphere -n 300 --radius 10km $body -o b.h5 2>said
    run ! grep warning said
  done
}

@test "disc and segment: masses per length and per area, z and y held" {
  mksphere -d 2 -n 1000 --radius 100m --layer basalt:0.5 --layer ice:0.5 --rotate 3 --spin 100s >disc.h5
  paste <(field disc.h5 Masses) <(field disc.h5 Density) <(field disc.h5 Coordinates 3) | awk '
    function abs(x) { return x < 0 ? -x : x } {m += $1; v += $1 / $2; if ($5 != 0) exit 1}
    END {pi = atan2(0, -1); exit !(abs(v / (pi * 1e4) - 1) < 1e-12 && abs(m / (pi * 1e4 / (0.5 / 2700 + 0.5 / 917)) - 1) < 1e-12)}'
  mksphere -d 1 -n 100 --radius 50m --layer basalt >rod.h5
  paste <(field rod.h5 Masses) <(field rod.h5 Coordinates 3) | awk '
    function abs(x) { return x < 0 ? -x : x } {if ($3 || $4 || abs($1 - 2700) > 1e-9 || abs($2 - (NR - 50.5)) > 1e-9) exit 1}
    END {exit NR != 100}'
  [ "$(number rod.h5 /Header/Dimension)" = 1 ]
}

@test "the cubic lattice" {
  mksphere -n 1000 --radius 10m --layer ice --lattice cubic >b.h5
  true_that 'near(s ^ 3, 4 / 3 * atan2(0, -1) * 1000 / n, 1e-12)' s="$(number b.h5 /Body/Spacing0)" n="$(field b.h5 ParticleIDs | wc -l)"
}

@test "with energy the density is where the pressure is zero" {
  mksphere -n 50 --radius 1km --layer granite --energy 2e5 >b.h5
  rho=$(field b.h5 Density | uniq)
  true_that 'rho < 2680 && rho > 2500' rho="$rho"
  p=$(eos -m granite -r "$rho" -u 2e5 | awk -F'\t' 'NR == 2 {print $3}')
  true_that 'abs(p) < 1e-7 * 18e9' p="$p"
  [ "$(field b.h5 InternalEnergy | uniq)" = 200000 ]
}

@test "hydrostatic bodies: the core's share from mass and radius; temperatures; every placing has the exact masses" {
  for how in hcp cubic stretched shells; do
    mksphere -n 1500 --mass 5e24kg --radius 6200km --layer iron --layer granite -T 300K --hydrostatic --lattice $how -o b.h5 2>said
    true_that 'near(r, 6.2e6, 1e-8) && near(a + b, 5e24, 1e-9) && a > 5e23 && a < 1e24' r="$(number b.h5 /Body/Radius0)" \
      a="$(number b.h5 /Body/Layer1Mass0)" b="$(number b.h5 /Body/Layer2Mass0)"
    paste <(field b.h5 MaterialID) <(field b.h5 Masses) <(field b.h5 Coordinates 3) <(field b.h5 Pressure) |
      awk -v a="$(number b.h5 /Body/Layer1Mass0)" '{ m[$1] += $2; r = sqrt($3^2 + $4^2 + $5^2); if (r < 1.5e6 && $6 < 1e11) exit 2 }
        END { q = m[0]/a - 1; exit !(q < 1e-12 && q > -1e-12) }'
    grep -q 'SPH density off by' said
  done
  mksphere -n 1500 --mass 5e24kg --layer iron:0.4:T=2000K --layer granite:2000km:u=0 2>&1 | grep -q 'give fewer'
}

@test "what the kernel makes of the close packing: sums and forces of pressure" {
  said() { mksphere -n 9000 --radius 1km -l granite --neighbours "$1" 2>&1 >b.h5 | sed -n "s/.*$2 \([^ ]*\)[ ,].*/\1/p"; }
  # lattice sums on their own, -sum r W'(r)/(3 n) - 1 over the sites
  true_that 'near(a, -2.36e-2, 2e-2) && near(b, -6e-4, 0.1)' a="$(said 57 'pressure by')" b="$(said 100 'pressure by')"
  true_that 'near(a, 1.24e-2, 1e-2)' a="$(said 57 'density off by')"
}

@test "porous layers: bulk density and radius, Distention, and no way to compress them" {
  mksphere -n 1000 --radius 10km --layer basalt:0.6 --layer ice:0.4:pores=0.25 -o b.h5
  paste <(field b.h5 MaterialID) <(field b.h5 Density) <(field b.h5 Distention) <(field b.h5 Masses) | awk '
    { if ($1 ? $2 != 917*0.75 || $3 - 4/3 > 1e-12 || 4/3 - $3 > 1e-12 : $2 != 2700 || $3 != 1) exit 1; v += $4/$2 }
    END { q = v/(4/3*atan2(0, -1)*1e12) - 1; exit !(q < 1e-9 && q > -1e-9) }'
  mksphere -n 100 --radius 1km --layer jsc1a -o own.h5 # pores of its own
  paste <(field own.h5 Distention) <(field own.h5 Density) | awk '
    function near(a, b) { return a/b - 1 < 1e-12 && 1 - a/b < 1e-12 }
    { if (!near($1, 1.72) || !near($2, 2700/1.72)) exit 1 }'
  bad 1 "layer 2 has pores" relax b.h5
  bad 1 "layer 1 has pores" mksphere -n 100 --mass 1e20 --layer ice::pores=0.3 --hydrostatic
  bad 2 "pores=1 is not in 0 to 1" mksphere --mass 1 --layer ice::pores=1
}

@test "a profile in a file: text and HDF5 give the particles that the recipe gives" {
  body="-n 1000 --mass 1e23kg --layer iron:0.2 --layer ice:0.8"
  mksphere $body -o raw.h5
  relax --profile p.h5 --profile-only raw.h5 >p.tsv
  mksphere $body --hydrostatic -o a.h5
  for p in p.tsv p.h5; do
    mksphere -n 1000 --profile $p -o b.h5
    paste <(field a.h5 Coordinates) <(field b.h5 Coordinates) <(field a.h5 SmoothingLength 1 | sed 'p;p') |
      awk '{ d = $1 - $2; if (d > 1e-6*$3 || d < -1e-6*$3) exit 1 }'
    true_that 'near(a, b, 1e-10)' a="$(number a.h5 /Body/Layer1Mass0)" b="$(number b.h5 /Body/Layer1Mass0)"
  done
  sed '8s/\t[^\t]*/\tx/2' p.tsv >q.tsv
  bad 1 "q.tsv:8: column 3 is not a number" mksphere -p q.tsv
  sed '9h;10{p;x}' p.tsv >q.tsv
  bad 1 "r and m must rise" mksphere -p q.tsv
  grep -v '^#' p.tsv | sed 5d | head -50 >bare.tsv
  bad 2 "does not name the materials" mksphere -p bare.tsv
}

@test "every mistake is one line" {
  printf 'name = "cold"; eos = { form = "liquid"; rho0 = 1000; c = 1500; };' >cold.cfg
  bad 2 "either --mass or --radius" mksphere --layer ice
  bad 2 "2 of mass, radius and layers' shares given for 1 layer: give fewer" mksphere --layer ice --mass 1 --radius 1
  bad 2 "--equal mass needs --lattice stretched or shells" mksphere --layer ice --mass 1 --equal mass
  bad 2 "'hex'" mksphere --layer ice --mass 1 --lattice hex
  bad 2 "one of --energy, --entropy and --temperature" mksphere --layer ice --mass 1 -u 3 -T 5
  bad 2 "--profile says mass" mksphere -p p.tsv --mass 1
  bad 2 "shells need 3 dimensions" mksphere -d 2 --mass 1 --layer ice --lattice shells
  bad 2 "hydrostatic body has 3 dimensions" mksphere -d 2 --mass 1 --layer ice --hydrostatic
  bad 1 "no body of these layers" mksphere --layer iron --layer ice --mass 1e24 --radius 2e7 --hydrostatic
  bad 1 "cannot open 'no.tsv'" mksphere -p no.tsv
  bad 1 "heat_capacity" mksphere --layer ./cold.cfg --mass 1 -T 5
  bad 2 "which material" mksphere --mass 1
  bad 2 "power=-500 is not in -10 to 10" mksphere --mass 1 --layer basalt::power=-500,T=300
  bad 2 "--neighbours 1e+09 of 100 particles" mksphere --mass 1 --layer basalt -n 100 --neighbours 1e9
  bad 2 "not positive" mksphere --mass -1 --layer ice
  bad 2 "not positive" mksphere --radius 0 --layer ice
  bad 2 "sum to 0.9, not to 1" mksphere --mass 1 --layer ice:0.5 --layer basalt:0.4
  bad 2 "sum to 1.00000001, not to 1" mksphere --mass 1 --layer ice:0.50000001 --layer basalt:0.5
  bad 2 "1 of mass, radius and layers' shares given for 2 layers: give more" mksphere --mass 1 --layer ice --layer basalt
  bad 2 "not positive" mksphere --mass 1 --layer ice:0 --layer basalt:1
  bad 1 "unknown material 'icy' (did you mean 'ice'?)" mksphere --mass 1 --layer icy
  bad 2 "'furlong" mksphere --radius 3furlong --layer ice
  bad 1 "too thin for a particle" mksphere -n 100 --mass 1 --layer ice:1e-6 --layer basalt:0.999999
  bad 1 "not condensed" mksphere --mass 1 --layer ice --energy 1e8
  bad 2 "dimension 4" mksphere --mass 1 --layer ice -d 4
  bad 2 "cannot be turned" mksphere --mass 1 --layer ice -d 1 --spin 3
  bad 1 "No space left on device" mksphere -n 100 --mass 1 --layer ice -o /dev/full
  bad 1 "No such file or directory" mksphere -n 100 --mass 1 --layer ice -o nowhere/a.h5
}
