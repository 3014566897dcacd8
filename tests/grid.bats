# SPDX-License-Identifier: GPL-3.0-or-later
# grid: constants and lines are kept, masses add up, slices are planes of volumes, the formats agree; errors leave nothing behind.

load h5

setup_file() {
  cd "$BATS_FILE_TMPDIR"
  mksphere -n 3000 --mass 9e20 --layer basalt:0.7 --layer ice:0.3 -o a.h5
  mksphere -n 1000 --mass 3e20 --layer basalt:1 -o b.h5
  collide a.h5 b.h5 --angle 40deg --speed 1.5vesc --distance 3 -o two.h5
}
setup() { cd "$BATS_FILE_TMPDIR"; }

# values FILE DATASET: one a line.
values() { { h5dump -d "/$2" -y -w 1 -m %.9g -o /dev/fd/3 "$1" >/dev/null; } 3>&1 | tr -d ' ,' | grep .; }
shape() { h5ls "$1/$2" | sed 's/.*{\(.*\)}.*/\1/'; }

@test "constants are exact, lines are lines, outside is nan" {
  grid -n 24 --box 1200km -f two=2+0*Density -f line=Coordinates.x -f Density -o g.h5 a.h5
  [ "$(shape g.h5 two)" = "24, 24, 24" ]
  values g.h5 two | awk '$1 != "nan" && $1 != "-nan" { n++; if ($1 < 2 - 1e-6 || $1 > 2 + 1e-6) exit 1 } END { exit !(n > 2000 && n < 6000) }'
  # within 350 km of the centre, to a twentieth of a particle's spacing of 60 km
  paste <(values g.h5 line) | awk '{ i = (NR - 1) % 24; j = int((NR - 1)/24) % 24; k = int((NR - 1)/576)
      x = -600e3 + (i + 0.5)*50e3; y = -600e3 + (j + 0.5)*50e3; z = -600e3 + (k + 0.5)*50e3
      if (x*x + y*y + z*z < 350e3^2) { n++; d = $1 - x; if (d*d > 9e6) bad++ } }
    END { print n, bad; exit !(n > 1000 && bad == 0) }'
}

@test "masses add up, in volumes and columns, however coarse" {
  want=$(field a.h5 Masses | awk '{ m += $1 } END { printf "%.9g", m }')
  for n in 5 40 120; do
    grid -m mass -n $n --box 1600km -o m.h5 a.h5
    true_that 'near(s*1600e3^3/n^3, m, 1e-5)' n=$n m="$want" s="$(values m.h5 MassDensity | awk '{ s += $1 } END { printf "%.9g", s }')"
    for plane in xy xz yz; do
      grid -w column -p $plane -n ${n}x$((2 * n)) --box 1600km -o c.h5 a.h5
      true_that 'near(s*1600e3^2/n^2/2, m, 1e-5)' n=$n m="$want" s="$(values c.h5 ColumnDensity | awk '{ s += $1 } END { printf "%.9g", s }')"
    done
  done
  grid -m mass -n 40 --box 1600km -S "MaterialID == 'ice'" -o i.h5 a.h5
  true_that 'near(s*27, 0.3*t, 1e-3)' s="$(values i.h5 MassDensity | awk '{ s += $1 } END { print s }')" t="$(values m.h5 MassDensity | awk '{ s += $1 } END { print s }')"
}

@test "the plain sum is the SPH density; kinds are not mixed" {
  grid -m sum -n 12 --box 400km -f Density -f one=1 -f MaterialID -o s.h5 a.h5
  values s.h5 Density | awk '{ s += $1 } END { exit !(s/NR > 2450 && s/NR < 2800) }'
  values s.h5 one | awk '{ s += $1 } END { exit !(s/NR > 0.97 && s/NR < 1.03) }'
  grid -n 30 --box 1200km -f MaterialID -f Density -o k.h5 a.h5
  [ "$(values k.h5 MaterialID | grep -v nan | sort -u | tr '\n' ' ')" = "0 1 " ]
}

@test "a slice is the middle plane of a volume" {
  grid -n 21 --box 1200km -o v.h5 a.h5
  for plane in xy xz yz; do
    grid -w slice -p $plane -n 21 --box 1200km -o s.h5 a.h5
    case $plane in
    xy) want='1, 21, 21' pick='int(n/441) == 10' ;;
    xz) want='21, 1, 21' pick='int(n/21) % 21 == 10' ;;
    yz) want='21, 21, 1' pick='n % 21 == 10' ;;
    esac
    [ "$(shape s.h5 Density)" = "$want" ]
    paste <(values s.h5 Density) <(values v.h5 Density | awk "{ n = NR - 1 } $pick") |
      awk '{ d = $1 - $2; if (($1 ~ /nan/) != ($2 ~ /nan/) || d*d > 1e-4) bad++; n++ } END { exit !(n == 441 && !bad) }'
  done
}

@test "the same numbers in all formats; the same bytes again" {
  for f in h5 vtk vti; do
    OMP_NUM_THREADS=1 grid -n 9x8x7 --box 1000km,900km,800km -f Density -f u=InternalEnergy -o 1.$f a.h5
    OMP_NUM_THREADS=3 grid -n 9x8x7 --box 1000km,900km,800km -f Density -f u=InternalEnergy -F "${f/h5/hdf5}" <a.h5 >2.$f
  done
  cmp 1.vti 2.vti
  [ "$(head -1 1.vtk)" = "# vtk DataFile Version 3.0" ]
  grep -aq '^DIMENSIONS 10 9 8$' 1.vtk
  grep -aq '^CELL_DATA 504$' 1.vtk
  values 1.h5 Density >want
  # legacy: big-endian floats behind the first LOOKUP_TABLE line
  at=$(grep -abo 'LOOKUP_TABLE default' 1.vtk | head -1 | cut -d: -f1)
  od -An -v -tf4 --endian=big -w4 -j$((at + 21)) -N2016 1.vtk | tr -d ' ' >got.vtk
  # XML: behind the underscore a time of 8 bytes with its length, then each array behind its length
  at=$(grep -abo '<AppendedData encoding="raw">' 1.vti | cut -d: -f1)
  [ "$(od -An -v -tu8 -j$((at + 31 + 16)) -N8 1.vti | tr -d ' ')" = 2016 ]
  od -An -v -tf4 -w4 -j$((at + 31 + 24)) -N2016 1.vti | tr -d ' ' >got.vti
  for f in vtk vti; do
    paste want got.$f | awk '{ d = $1 - $2; if (($1 ~ /nan/) != ($2 ~ /nan/) || d*d > 1e-2) bad++; n++ } END { exit !(n == 504 && !bad) }'
  done
  cmp <(values 1.h5 u) <(values 2.h5 u)
}

@test "where the cells are" {
  grid -n 10x20x5 --box 1000km,2000km,500km -C 1km,2km,3km -o p.h5 a.h5
  [ "$(values p.h5 x | head -1)" = -449000 ]
  [ "$(values p.h5 z | tail -1)" = 203000 ]
  [ "$(shape p.h5 Density)" = "5, 20, 10" ]
  grid -n 10 --box 1000km,500km,260km -o p.h5 a.h5 # cubes
  [ "$(shape p.h5 Density)" = "3, 5, 10" ]
  grid -n 16 -o p.h5 two.h5 # 99 % of the mass
  values p.h5 Density | grep -qv nan
}

fails() {
  local want=$1 text=$2
  shift 2
  rm -f x.h5 x.vtk
  run "$@"
  echo "$status: $output"
  [ "$status" = "$want" ] && [ "${#lines[@]}" = 1 ] && [[ $output == "grid: "*"$text"* ]] && [ -z "$(find . -name '*x.h5*' -o -name '*x.vtk*')" ]
}

@test "bad input is one line, and no grid" {
  echo text >text.h5
  fails 1 "no field 'Densty' (did you mean 'Density'?)" grid -f Densty -o x.h5 a.h5
  fails 1 "'text.h5'" grid -o x.h5 text.h5
  fails 1 "No space left" bash -c 'grid -F vtk a.h5 >/dev/full'
  fails 1 "File too large" bash -c 'trap "" XFSZ; ulimit -f 1; grid -o x.vtk a.h5'
  fails 1 "File too large" bash -c 'trap "" XFSZ; ulimit -f 1; grid -o x.h5 a.h5'
  fails 1 "holds for no particle" grid -S 'BodyID == 4' -o x.h5 a.h5
  fails 1 "nothing belongs to body:7" grid -C body:7 -o x.h5 a.h5
  fails 2 "'2*Density' needs a name (NAME=2*Density)" grid -f '2*Density' -o x.h5 a.h5
  fails 2 "'Density' twice" grid -f Density -f Density -o x.h5 a.h5
  fails 2 "a value is missing" grid -f 'a=2*' -o x.h5 a.h5
  fails 2 "ends in none of" grid -o x.png a.h5
  fails 2 "--cells" grid -n 0 -o x.h5 a.h5
  fails 2 "neither N nor NxNxN" grid -n 5x5 -o x.h5 a.h5
  fails 2 "neither N nor NxN" grid -w slice -n 5x5x5 -o x.h5 a.h5
  fails 2 "--box" grid --box 1km,2km -o x.h5 a.h5
  fails 2 "must be positive" grid --box 0 -o x.h5 a.h5
  fails 2 "columns always keep masses" grid -w column -m sum -o x.h5 a.h5
  fails 2 "no volume" grid -w slice -m mass -o x.h5 a.h5
  fails 2 "--plane is for slices" grid -p xz -o x.h5 a.h5
}
