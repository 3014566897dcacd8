#!/usr/bin/env bats
# SPDX-License-Identifier: GPL-3.0-or-later
# relax: the one-dimensional structure, what is laid on the particles, and the body left alone.

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
  awk '!/^#/ { if (n++ && $10 == layer && r > 1e6) { d = (p - $4) / ((rho * g + $3 * $8) / 2 * ($1 - r)) - 1
                 if (d > 1e-3 || d < -1e-3) exit 1 }
               if (n > 1 && $10 != layer && ($4 / p - 1 > 1e-9 || $4 / p - 1 < -1e-9)) exit 2
               r = $1; rho = $3; p = $4; g = $8; layer = $10 }' p.tsv
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

@test "bad input: one line each" {
  mksphere -n 100 --mass 1e20 --layer basalt:1 >b.h5
  bad 1 "cannot open 'none.h5'" relax none.h5
  echo text >t.h5
  bad 1 "'t.h5'" relax t.h5
  bad 2 "damping" relax --damping 0s b.h5
  bad 2 "unknown" relax --set gravity.tehta=1 b.h5
  bad 2 "max-time" relax --max-time 3kg b.h5
  relax --proof 0 -o r.h5 b.h5
  bad 1 "not as mksphere makes it" relax -o rr.h5 r.h5
  [ ! -e rr.h5 ]
}
