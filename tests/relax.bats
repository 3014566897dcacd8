#!/usr/bin/env bats
# SPDX-License-Identifier: GPL-3.0-or-later
# relax: the one-dimensional structure, what is laid on the particles, and the body left alone.

bats_require_minimum_version 1.5.0

load h5

setup() {
  cd "$BATS_TEST_TMPDIR"
  cat >rock.cfg <<'CFG'
name = "rock";
eos = { form = "murnaghan"; rho0 = "2700 kg/m^3"; K = "50 GPa"; n = 4.0; source = "test"; };
CFG
  cat >metal.cfg <<'CFG'
name = "metal";
eos = { form = "murnaghan"; rho0 = "7800 kg/m^3"; K = "128 GPa"; n = 4.0; source = "test"; };
CFG
}

# cell RUN COLUMN: of the report r.tsv
cell() { awk -F'\t' -v run="$1" -v name="$2" 'NR == 1 { for (k = 1; k <= NF; k++) if ($k ~ "^" name "\\[") c = k } $1 == run { print $c }' r.tsv; }

@test "profile of a 1e23 kg ball of rock: R to 1e-4, central pressure to 1e-3" {
  mksphere -n 300 --mass 1e23 --layer rock.cfg:1 | relax --profile-only >p.tsv
  true_that 'near(r, 2.044872e6, 1e-4) && near(p, 4.7046e9, 1e-3)' \
    r="$(tail -1 p.tsv | cut -f1)" p="$(grep -v '^#' p.tsv | head -1 | cut -f4)"
}

@test "profile of an Earth of metal and rock, and hydrostatic balance along it" {
  mksphere -n 300 --mass 5.9722e24 --layer metal.cfg:0.3 --layer rock.cfg:0.7 | relax --profile-only >p.tsv
  true_that 'near(r, 6.654223e6, 1e-4) && near(p, 4.11549e11, 1e-3)' \
    r="$(tail -1 p.tsv | cut -f1)" p="$(grep -v '^#' p.tsv | head -1 | cut -f4)"
  # dp = -rho g dr between nodes of one layer, by the trapezoid; p is continuous where the layer changes
  awk '!/^#/ { if (n++ && $11 == layer && r > 1e6) { d = (p - $4) / ((rho * g + $3 * $8) / 2 * ($1 - r)) - 1
                 if (d > 1e-3 || d < -1e-3) exit 1 }
               if (n > 1 && $11 != layer && ($4 / p - 1 > 1e-9 || $4 / p - 1 < -1e-9)) exit 2
               r = $1; rho = $3; p = $4; g = $8; layer = $11 }' p.tsv
}

@test "a layered body left alone stays at rest and keeps its radius and layer masses" {
  mksphere -n 1000 --mass 9.43e20 --layer basalt:0.7 --layer ice:0.3 >b.h5
  relax --profile p.tsv -o r.h5 b.h5 2>said
  grep -q '^relax: damped run' said
  grep -q '^relax: proof run without friction' said
  [ "$(grep -c 'warning' said)" = 0 ]
  true_that 'v < 1e-3' v="$(sed -n 's/.*proof.*rms v \([^,]*\),.*/\1/p' said)"
  true_that 'abs(d) < 1e-3' d="$(sed -n 's/.*radius changed by //p' said)"
  true_that 'near(a, b, 1e-12)' a="$(number r.h5 /Body/Radius0)" b="$(tail -1 p.tsv | cut -f1)"
  paste <(field r.h5 MaterialID) <(field r.h5 Masses) | awk '{ m[$1] += $2 }
    END { exit !(m[0] / 6.601e20 - 1 < 1e-12 && 1 - m[0] / 6.601e20 < 1e-12) }'
  [ "$(h5dump -d /History r.h5 | grep -c relax)" -ge 1 ]
}

@test "what was reached, as a table: with both runs, in the units of the judgement" {
  mksphere -n 300 --mass 1e23 --layer rock.cfg:1 | relax --proof 2tff --report r.tsv -o r.h5 2>said
  [ "$(cut -f1 r.tsv | tr '\n' ' ')" = "# run damped proof " ]
  true_that 'near(f, 2, 1e-3) && v < 0.003 && near(r, 2.044872e6, 1e-4) && near(e, r, 1e-12)' f="$(cell proof falls)" v="$(cell proof v_rms)" \
    r="$(cell damped radius)" e="$(cell damped equator)"
  true_that 'near(a, b, 1e-2)' a="$(cell damped rho_off)" b="$(sed -n 's/.*damped.*off the profile by \([^ ]*\) rms.*/\1/p' said)"
  true_that 'near(a, b, 1e-5)' a="$(cell damped reach)" b="$(number r.h5 /Body/RadiusMax0)"
  # times may be seconds
  relax --again --max-time 100s --proof 50s --report r.tsv -o x.h5 r.h5 2>said
  true_that 't > 99 && t < 101 && near(q, 50, 1e-3)' t="$(cell damped time)" q="$(cell proof time)"
}

@test "a pressure outside is felt: the body has the volume of its structure, and has another when it is gone" {
  mksphere -n 600 --mass 1e23 --layer rock.cfg --hydrostatic --outer-pressure 5GPa -o b.h5 2>said
  relax --proof 2tff --report r.tsv -o r.h5 b.h5 2>said
  true_that 'near(a, b, 0.01) && v < 0.003' a="$(cell proof r_volume)" b="$(cell proof radius)" v="$(cell proof v_rms)"
  true_that 'near(p, 5e9, 1e-12)' p="$(number r.h5 /Body/OuterPressure0)"
  # with nothing outside it swells to the 2044.872 km of above from 1992.658
  solver -o run --end 1000s --every 1000s --set damping.rate=0.01 r.h5 2>said
  paste <(field run/snap_0001.h5 Masses) <(field run/snap_0001.h5 Density) <(field r.h5 Density) |
    awk '{ a += $1/$2; b += $1/$3 } END { q = a/b/(2044.872/1992.658)^3; exit !(q > 0.99 && q < 1.01) }'
}

@test "a fluid planet: pressure and density follow the profile" {
  mksphere -n 2000 --mass 1e23 --layer rock.cfg:1 | relax --proof 0 -o r.h5 2>said
  true_that 'd < 0.02' d="$(sed -n 's/.*off the profile by \([^ ]*\) rms.*/\1/p' said)"
  # central pressure: the mean over the innermost particles against the profile's
  true_that 'c > 0.9 && c < 1.1' c="$(sed -n 's/.*central pressure \([^ ]*\) of it.*/\1/p' said)"
}

@test "spin survives: the period after the damped run is that of mksphere to 2 %" {
  mksphere -n 500 --mass 9.43e20 --layer basalt:1 --spin 6h >b.h5
  relax --proof 0 -o r.h5 b.h5
  paste <(field r.h5 Masses) <(field r.h5 Coordinates 3) <(field r.h5 Velocities 3) | awk '
    { l += $1 * ($2 * $6 - $3 * $5); i += $1 * ($2 * $2 + $3 * $3) }
    END { q = 2 * atan2(0, -1) / (l / i) / 21600; exit !(q > 0.98 && q < 1.02) }'
}

@test "a body at rest is recognised; one that is only placed, or stirred, is not" {
  mksphere -n 400 --mass 1e23 --layer rock.cfg --hydrostatic -o placed.h5
  relax --proof 0 -o r.h5 placed.h5 2>said
  grep -q '^relax: damped run' said
  relax -o again.h5 r.h5 2>said
  grep -q '^relax: at rest already' said
  run ! grep -q 'damped run\|proof' said
  [ "$(field r.h5 Coordinates | md5sum)" = "$(field again.h5 Coordinates | md5sum)" ] || {
    paste <(field r.h5 Coordinates) <(field again.h5 Coordinates) | awk '{ d = $1 - $2; if (d > 1 || d < -1) exit 1 }'; }
  relax --again --max-time 100s --proof 0 -o x.h5 r.h5 2>said
  grep -q '^relax: damped run' said
}

@test "what flies off is removed and reported; momentum, spin that nobody asked for and damage go" {
  mksphere -n 400 --mass 1e23 --layer rock.cfg --hydrostatic -o b.h5
  # one particle at twice the escape speed, all moving on and turning a little (8e-6 v_esc at the surface)
  without Velocities b.h5 c.h5
  paste <(field b.h5 ParticleIDs) <(field b.h5 Coordinates 3) |
    awk '{ v = $1 == 0 ? 0.02 : 0; print 100 - 1e-8*$3 + v*$2, 50 + 1e-8*$2 + v*$3, v*$4 }' | put c.h5 Velocities 3
  h5copy -i b.h5 -o c.h5 -s /Body -d /Body
  relax --max-time 500s --proof 0 -o r.h5 c.h5 2>said || { cat said; false; }
  grep -q '1 particles, .* kg, were ejected' said
  [ "$(field r.h5 ParticleIDs | wc -l)" = $(($(field b.h5 ParticleIDs | wc -l) - 1)) ]
  paste <(field r.h5 Masses) <(field r.h5 Coordinates 3) <(field r.h5 Velocities 3) | awk '
    { px += $1*$5; py += $1*$6; pz += $1*$7; x += $1*$2; l += $1*($2*$6 - $3*$5); m += $1; i += $1*($2*$2 + $3*$3) }
    END { exit !((px*px + py*py + pz*pz)/(m*m) < 1e-12 && (x/m)^2 < 1 && (l/i)^2 < 1e-24) }'
}

@test "a spinning body: the figure of equilibrium, its flattening kept, the period as asked" {
  mksphere -n 800 --mass 1e23 --layer rock.cfg --hydrostatic --spin 4h -o b.h5 2>said
  f=$(sed -n 's/.*flattening \([^ ]*\) at the surface.*/\1/p' said)
  true_that 'f > 0.05 && f < 0.5' f="$f"
  relax --proof 0 -o r.h5 b.h5 2>said
  true_that 'near(p, 14400, 0.03)' p="$(number r.h5 /Body/MeasuredPeriod0)"
  # second moments: <z^2>/<x^2> = (1 - f)^2 of similar spheroids; those inside are less flat
  paste <(field r.h5 Masses) <(field r.h5 Coordinates 3) | awk -v f="$f" '{ x += $1*($2*$2 + $3*$3)/2; z += $1*$4*$4 }
    END { g = 1 - sqrt(z/x); exit !(g > 0.75*f && g < 1.1*f) }'
}

@test "a run that is stopped goes on from its checkpoint to the same result" {
  mksphere -n 300 --mass 1e23 --layer rock.cfg:1 -o b.h5
  relax --proof 0 --set gravity.method=direct -o whole.h5 b.h5
  for t in 0.3 0.4 0.6 1 2 4 8 16 32; do
    if timeout -s TERM $t relax --proof 0 --set gravity.method=direct --checkpoint c.h5 -o r.h5 b.h5 2>said; then break; fi
    [ -e c.h5 ] || continue # not even begun
    bad 1 "checkpoint of another body or other settings" relax --radial --set gravity.method=direct --checkpoint c.h5 b.h5
    stopped=1
  done
  [ -z "$stopped" ] || grep -q "goes on from 'c.h5'" said
  [ ! -e c.h5 ]
  cmp <(field whole.h5 Coordinates) <(field r.h5 Coordinates)
}

@test "shells and integration find one structure; other densities, energies, frictions; a fluid has no stress" {
  mksphere -n 300 --mass 1e23 --layer rock.cfg:1 -o b.h5
  true_that 'near(a, b, 1e-5)' a="$(relax --profile-only --method shells --nodes 200 b.h5 | tail -1 | cut -f1)" \
    b="$(relax --profile-only b.h5 | tail -1 | cut -f1)"
  for how in "--set density=sum" "--set density=miscible" "--freeze energy" "--freeze nothing" "--radial --rigid"; do
    relax $how --max-time 1000s --proof 0 -o r.h5 b.h5 2>said
    true_that 'd < 0.15' d="$(sed -n 's/.*off the profile by \([^ ]*\) rms.*/\1/p' said)"
  done
  [ -z "$(field r.h5 Velocities | grep -v '^0$\|^-0$')" ]
  mksphere -n 300 --mass 9e20 --layer basalt | relax --fluid --max-time 500s --proof 0 -o r.h5
  [ -z "$(field r.h5 DeviatoricStress | grep -v '^0$')" ]
}

@test "bad input: one line each" {
  mksphere -n 100 --mass 1e20 --layer basalt:1 >b.h5
  bad 1 "cannot open 'none.h5'" relax none.h5
  echo text >t.h5
  bad 1 "'t.h5'" relax t.h5
  bad 2 "damping" relax --damping 0s b.h5
  bad 2 "unknown" relax --set gravity.tehta=1 b.h5
  bad 2 "max-time" relax --max-time 3kg b.h5
  bad 2 "proof" relax --proof -1s b.h5
  bad 2 "'2txf': unknown unit 'txf' (or free-fall times, as in 2tff)" relax --proof 2txf b.h5
  bad 2 "max-time must be positive" relax --max-time -2tff b.h5
  bad 2 "--rigid has no effect with --profile-only" relax --profile-only --rigid b.h5
  bad 2 "it is the body's own" relax --set outer_pressure=1 b.h5
  for where in output profile report checkpoint; do # before anything is computed
    bad 1 "cannot write 'nowhere/x': No such file or directory" relax --$where nowhere/x b.h5
    [ $where = output ] || bad 2 "--$where needs a file" relax --$where - b.h5
  done
  bad 2 "'cold'" relax --freeze cold b.h5
  mksphere -n 100 --mass 1e23 --layer basalt --hydrostatic -o b.h5
  without Nothing b.h5 c.h5 # neither a recipe nor layers that can be seen
  bad 1 "/Body does not say its layers" relax -o rr.h5 c.h5
  [ ! -e rr.h5 ]
}
