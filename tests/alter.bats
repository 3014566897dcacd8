#!/usr/bin/env bats
# SPDX-License-Identifier: GPL-3.0-or-later
# alter: fields set to expressions, particles taken out and put together; columns: the same expressions as a table.

load h5

setup() {
  cd "$BATS_TEST_TMPDIR"
  mkshape -d 1 --shape rod --size 1m --spacing 5cm --lattice grid -l water -o rod.h5 2>/dev/null
}

@test "fields and components, in the order given; new ones with their unit" {
  alter -s 'Velocities.x=2*Coordinates.x/1s' -s 'Density=1g/cc*(1+Velocities.x/(10m/s))' -s BodyID=7 -s 'Colour=Density^2' -o a.h5 rod.h5
  paste <(field a.h5 Coordinates 3) <(field a.h5 Velocities 3) <(field a.h5 Density) <(field a.h5 BodyID) <(field a.h5 Colour) | tr '\t' ' ' |
    awk 'function near(a, b) { return (a - b)^2 <= 1e-24*b*b }
      { if (!near($4, 2*$1) || $5 || !near($7, 1000*(1 + 0.2*$1)) || $8 != 7 || !near($9, $7*$7)) exit 1 } END { exit NR != 20 }'
  [ "$(h5dump -a /PartType0/Colour/unit a.h5 | sed -n 's/.*(0): "\(.*\)"/\1/p')" = 'kg^2/m^6' ]
  [ "$(alter -s 'phi=2' rod.h5 | columns -f phi | sort -u | tr '\n' ' ')" = '# phi [1] 2 ' ] # not the schema's own short name of Potential
  alter -t 3min -o b.h5 a.h5
  [ "$(columns -f 'Colour' b.h5)" = "$(columns -f 'Colour' a.h5)" ]
}

@test "particles left out, snapshots put together: ids and bodies of their own, nothing lost" {
  alter -k 'Coordinates.x > 0 && Coordinates.x < 30cm' -o part.h5 rod.h5
  [ "$(columns -f Coordinates.x part.h5 | tail -n +2 | tr '\n' ' ')" = '0.025 0.075 0.125 0.175 0.225 0.275 ' ]
  alter -j part.h5 -j part.h5 -s 'Coordinates.x=Coordinates.x + 2m*BodyID' -o all.h5 rod.h5
  [ "$(field all.h5 ParticleIDs | sort -n | uniq | wc -l)" = 32 ]
  [ "$(field all.h5 BodyID | sort -n | uniq -c | awk '{ printf "%s*%s ", $1, $2 }')" = '20*0 6*1 6*2 ' ]
  true_that 'near(x, 4.275, 1e-12)' x="$(columns -f Coordinates.x -w 'BodyID == 2' all.h5 | tail -1)"
}

@test "columns: expressions, conditions, every so many" {
  [ "$(columns -f BodyID -f 'Coordinates.x/1cm' -w 'Coordinates.x > 40cm' rod.h5)" = \
    "$(printf '# BodyID [1]\tCoordinates.x/1cm [1]\n0\t42.5\n0\t47.5')" ]
  [ "$(columns -f ParticleIDs --every 7 < rod.h5 | tr '\n' ' ')" = '# ParticleIDs [1] 0 7 14 ' ]
}

@test "every mistake is one line" {
  bad 2 "nothing to change" alter rod.h5
  bad 1 "is not FIELD=EXPR" alter -s Density rod.h5
  bad 1 "a vector: set its .x" alter -s 'Velocities=0' rod.h5
  bad 1 "a number: it has no components" alter -s 'Density.x=1' rod.h5
  bad 1 "does not go into" alter -s 'Density=3km' rod.h5
  bad 1 "is of whole numbers, not 0.5" alter -s 'BodyID=0.5' rod.h5
  bad 1 "Densty" alter -s 'Density=2*Densty' rod.h5
  bad 1 "Density" alter -s 'Density=-1' rod.h5
  bad 1 "no field 'Foo'" alter -s 'Foo.x=1' rod.h5
  bad 1 "none.h5" alter -j none.h5 rod.h5
  bad 2 "which columns" columns rod.h5
  bad 1 "Densty" columns -f Densty rod.h5
  bad 2 "is not in 1..17" columns -f Density -d 99 rod.h5
}
