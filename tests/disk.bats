# SPDX-License-Identifier: GPL-3.0-or-later
# disk on a planet with a moon of known orbit: classes, satellites, bins, ids, errors.

load h5

setup_file() {
  cd "$BATS_FILE_TMPDIR"
  mksphere -n 3000 --mass 6e24 --layer basalt:0.7 --layer iron:0.3 -o planet.h5
  mksphere -n 100 --mass 7e22 --layer basalt:1 -o moon.h5
  collide planet.h5 moon.h5 --angle 0deg --speed 1vesc -o two.h5
  # a circle at 5e7 m: v^2 = G 6.07e24 kg/5e7 m
  placed circle.h5 5e7 0 0 2846.5
  placed fall.h5 5e7 0 0 500
  placed out.h5 5e7 0 4500 0
}
# placed FILE X Y VX VY: the moon there, relative to the planet [m, m/s], whose surface, beyond 6800 km, is light.
placed() {
  paste -d' ' <(field two.h5 BodyID) <(field two.h5 Coordinates 3) <(field two.h5 Velocities 3) <(field two.h5 Density) >was
  awk -v X="$2" -v Y="$3" -v U="$4" -v V="$5" '
    NR == FNR { n[$1]++; for (k = 2; k <= 7; k++) s[$1, k] += $k; next }
    { for (k = 2; k <= 7; k++) $k -= s[$1, k] / n[$1]
      if ($1) { $2 += X; $3 += Y; $5 += U; $6 += V }
      else if ($2 * $2 + $3 * $3 + $4 * $4 > 6.8e6 ^ 2) $8 /= 2
      printf "%.17g %.17g %.17g %.17g %.17g %.17g %.17g\n", $2, $3, $4, $5, $6, $7, $8 }' was was >is
  without "Coordinates Velocities Density" two.h5 "$1"
  cut -d' ' -f7 is | put "$1" Density 1
  cut -d' ' -f1-3 is | put "$1" Coordinates 3
  cut -d' ' -f4-6 is | put "$1" Velocities 3
}
setup() { cd "$BATS_FILE_TMPDIR"; }

# cell ROW COLUMN [FILE]
cell() {
  awk -F'\t' -v row="$1" -v name="$2" '/^# name/ || /^# r / { for (k = 1; k <= NF; k++) if ($k == name || index($k, name " [") == 1) at = k }
    $1 == row { print at ? $at : "no such column" }' "${3:-table}"
}

@test "a moon on a circle is the disk, and its only satellite" {
  for method in reufer canup; do
    disk --method $method --of body:0 circle.h5 >table
    true_that 'near(m, 7e22, 0.01) && n == moon' m="$(cell disk mass)" n="$(cell disk n)" moon="$(field moon.h5 ParticleIDs | wc -l)"
  done
  disk --method canup circle.h5 >table
  true_that 'near(m, 6e24, 0.01) && near(r, a, 0.01)' m="$(cell body mass)" \
    r="$(sed -n 's/.*equator \([^ ]*\) m.*/\1/p' table)" a="$(cell body radius)"
  [ "$(grep -c '^satellite' table)" = 1 ]
  true_that 'e < 2e-3 && near(a, 5e7, 2e-3) && near(m, 7e22, 0.01)' e="$(cell satellite_1 e_body)" a="$(cell satellite_1 a_body)" \
    m="$(cell satellite_1 mass)"
  true_that 'near(l, m * sqrt(6.6743e-11 * 6e24 * 5e7), 0.02)' l="$(cell disk L_body_z)" m="$(cell disk mass)"
  true_that 'near(m, 7e22, 0.01)' m="$(cell disk from_1)"
}

@test "one that falls re-impacts or is kept, one that is fast enough escapes" {
  moon=$(field moon.h5 ParticleIDs | wc -l) planet=$(field planet.h5 ParticleIDs | wc -l)
  disk -m canup --of body:0 fall.h5 >table # h^2/mu = 1.5e6 m
  [ "$(cell body n)" = $((moon + planet)) ]
  disk --of body:0 fall.h5 >table
  [ "$(cell re-impact n)" -ge "$moon" ]
  [ "$(cell disk n)" = 0 ]
  disk -m canup --of body:0 out.h5 >table
  [ "$(cell escape n)" = "$moon" ] && [ "$(cell body n)" = "$planet" ]
}

@test "the classes are all particles; the bins are the disk" {
  disk -m canup --profile bins.tsv --bins 7 circle.h5 >table
  [ "$(grep -vc '^#' bins.tsv)" = 7 ]
  true_that 'n == all' n="$(awk -F'\t' '/^(body|disk|re-impact|fly-by|escape)\t/ { n += $2 } END { print n }' table)" \
    all="$(field circle.h5 ParticleIDs | wc -l)"
  awk -F'\t' '!/^#/ { m += $3; l += $5 } END { printf "%.17g %.17g\n", m, l }' bins.tsv >sums
  read -r m l <sums
  true_that 'near(m, a, 1e-8) && near(l, b, 1e-3)' m="$m" l="$l" a="$(cell disk mass)" b="$(cell disk L_body_z)"
  true_that 'near(a, b, 1e-8)' a="$(awk -F'\t' '/^# r/ { for (k = 1; k <= NF; k++) if ($k ~ /^basalt_from_1/) at = k } !/^#/ { m += $at } END { print m }' bins.tsv)" \
    b="$(cell disk basalt_from_1)"
}

@test "classes are written; threads do not matter; a clump's body" {
  OMP_NUM_THREADS=1 disk -m canup -o ids.h5 circle.h5 >a
  mv ids.h5 one.h5
  OMP_NUM_THREADS=3 disk -m canup -o ids.h5 circle.h5 >b
  cmp a b
  cmp one.h5 ids.h5
  [ "$(field ids.h5 DiskClass | sort | uniq -c | awk '{ print $2 ":" $1 }' | tr '\n' ' ')" = "1:$(cell body n a) 2:$(field moon.h5 ParticleIDs | wc -l) " ]
  clumps -o clumps.h5 circle.h5 >/dev/null
  disk -m canup clumps.h5 | grep -q 'the body of clump:1 by canup'
}

@test "bad input is one line" {
  echo text >text.h5
  bad 1 "lacks field 'ClumpID' (made by clumps)" disk --of clump:1 circle.h5
  bad 1 "nothing belongs to body:7" disk --of body:7 circle.h5
  bad 1 "the surface is not found" disk --min-density 1 circle.h5
  bad 1 "no material 'basal' in this file (did you mean 'basalt'?)" disk --min-density basal:2000 circle.h5
  bad 1 "'text.h5'" disk text.h5
  bad 1 "" disk -p no/such/folder/a.tsv -m canup circle.h5
  bad 2 "name a file" disk -o - circle.h5
  bad 2 "--bins" disk -b 0 circle.h5
}
