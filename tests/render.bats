# SPDX-License-Identifier: GPL-3.0-or-later
# render: sizes, determinism, fields, ranges, errors that leave nothing behind.

setup_file() {
  cd "$BATS_FILE_TMPDIR"
  mksphere -n 1500 --mass 9e20 --layer basalt:0.7 --layer ice:0.3 -o a.h5
  mksphere -n 500 --mass 3e20 --layer basalt:1 -o b.h5
  collide a.h5 b.h5 --angle 40deg --speed 1.5vesc --distance 3 -o two.h5
}
setup() { cd "$BATS_FILE_TMPDIR"; }

# size FILE: "width height" of a PNG, from its header.
size() {
  [ "$(head -c 8 "$1" | od -An -tx1)" = " 89 50 4e 47 0d 0a 1a 0a" ] || return 1
  od -An -tu1 -j16 -N8 "$1" | awk '{ print $3 * 256 + $4, $7 * 256 + $8 }'
}

# differ A B: two files that are not the same.
differ() { if cmp -s "$1" "$2"; then return 1; fi; }

@test "every view, plane and map draws a picture of the size asked for" {
  for view in cut slice projection surface; do
    render --size 320x200 --view $view -o $view.png two.h5
    [ "$(size $view.png)" = "320 200" ]
  done
  differ cut.png surface.png
  differ cut.png slice.png
  differ slice.png projection.png
  for plane in xz yz; do
    render --size 320x200 --plane $plane -o $plane.png two.h5
    differ cut.png $plane.png
  done
  for map in viridis magma inferno polar; do
    render --size 320x200 --color Density --map $map -o $map.png two.h5
    [ "$(size $map.png)" = "320 200" ]
  done
  differ viridis.png magma.png
}

@test "the same bytes again, for any number of threads, to a file or a pipe" {
  for view in cut slice projection surface; do
    OMP_NUM_THREADS=1 render --size 320x200 --view $view -c Density -o 1.png two.h5
    OMP_NUM_THREADS=3 render --size 320x200 --view $view -c Density two.h5 >2.png
    render --size 320x200 --view $view -c Density -o - <two.h5 >3.png
    cmp 1.png 2.png
    cmp 1.png 3.png
  done
}

@test "fields, components, lengths, kinds" {
  for field in Velocities '|Velocities|' Velocities.x Velocities.z MaterialID BodyID ParticleIDs InternalEnergy SmoothingLength; do
    render --size 320x200 --color "$field" -o "f.png" two.h5
  done
  render --size 320x200 -c Velocities -o 1.png two.h5
  render --size 320x200 -c Velocities.x -o 2.png two.h5
  differ 1.png 2.png
  render --size 320x200 --view projection -c ColumnDensity --log -o 3.png two.h5
}

@test "ranges: units, open ends, given equals seen" {
  render --size 320x200 -c Density -r 0:3g/cc -o 1.png two.h5
  render --size 320x200 -c Density -r 0:3000 -o 2.png two.h5
  cmp 1.png 2.png
  render --size 320x200 -c Density -r 500: -o 3.png two.h5
  render --size 320x200 -c Density -r :3000 -o 4.png two.h5
  differ 1.png 3.png
  differ 1.png 4.png
}

@test "panels" {
  render --size 600x200 --panels 3x1 -o 1.png a.h5 b.h5 two.h5
  [ "$(size 1.png)" = "600 200" ]
  render --size 600x400 -o 2.png a.h5 b.h5 two.h5 # as square as it gets
}

@test "an expression is the field that it equals" {
  render --size 320x200 -c Velocities.x -L v -o 1.png two.h5
  render --size 320x200 -c '(2*Velocities.x + |Velocities|*0)/2' -L v -o 2.png two.h5
  cmp 1.png 2.png
}

@test "only the particles that are selected" {
  render --size 320x200 -e 8000km -C body:0 -o 1.png two.h5
  render --size 320x200 -e 8000km -C body:0 -S 'BodyID == 0' -o 2.png two.h5
  differ 1.png 2.png
  render --size 320x200 -e 8000km -C body:0 -S "MaterialID == 'ice' || MaterialID == \"basalt\"" -o 2.png two.h5
  cmp 1.png 2.png
  render --size 320x200 -e 8000km -C body:0 -S 'Density > 0 && Coordinates.x < 1au' -o 2.png two.h5
  cmp 1.png 2.png
}

@test "the camera: planes are directions; sides are cut away; perspective" {
  for same in xy:-90deg,90deg xz:-90deg,0 yz:0,0deg,0; do
    render --size 320x200 --plane ${same%:*} -o 1.png two.h5
    render --size 320x200 --from=${same#*:} -o 2.png two.h5
    cmp 1.png 2.png
  done
  render --size 320x200 -f 30deg,20deg -o 1.png two.h5
  render --size 320x200 -f 30deg,20deg,10deg -o 2.png two.h5
  render --size 320x200 -f 30deg,20deg -a x,y -o 3.png two.h5
  render --size 320x200 -f 30deg,20deg -a x,y,z -F 30deg -o 4.png two.h5
  render --size 320x200 -f 30deg,20deg -v projection -F 30deg -o 5.png two.h5
  for k in 2 3 4 5; do differ 1.png $k.png; done
}

@test "several fields, each with colours of its own" {
  render --size 800x600 -c MaterialID -c Density -c '|Velocities|' -r : -r 0:3g/cc -L '' -L rho -o 1.png two.h5
  [ "$(size 1.png)" = "800 600" ]
  render --size 800x600 -c Density -c MaterialID -o 2.png two.h5 a.h5 b.h5 # a row for each
  render --size 800x600 -c Density -c MaterialID --panels 3x2 -o 3.png two.h5 a.h5 b.h5
  differ 2.png 3.png
}

# An ffmpeg that writes down what it is asked for, and how much it reads.
mock_ffmpeg() {
  mkdir -p mock
  printf '#!/bin/bash\necho "$@" >said\nwc -c >count\nfor last; do :; done\ncp count "$last"\nexit ${BAD:-0}\n' >mock/ffmpeg
  chmod +x mock/ffmpeg
}

@test "a movie: every snapshot a frame, with common colours" {
  mock_ffmpeg
  PATH=$PWD/mock:$PATH render --size 321x200 --movie 25 -c Density -o m.mp4 a.h5 b.h5 two.h5
  [ "$(<count)" = $((320 * 200 * 3 * 3)) ]
  [ "$(<m.mp4)" = "$(<count)" ]
  grep -q -- '-s 320x200 -framerate 25 -i - .*-c:v libx264 .*-f mp4 ' said
  PATH=$PWD/mock:$PATH render --size 320x200 --movie 5 -o m.gif a.h5
  grep -q -- 'paletteuse .*-f gif ' said
}

@test "a movie by ffmpeg itself" {
  command -v ffprobe >/dev/null || skip "no ffmpeg"
  render --size 320x200 --movie 10 -c Density -o real.mp4 a.h5 b.h5 two.h5
  [ "$(ffprobe -v error -count_frames -show_entries stream=width,height,nb_read_frames -of csv=p=0 real.mp4)" = 320,200,3 ]
}

@test "a movie that fails leaves nothing" {
  mock_ffmpeg
  export PATH="$PWD/mock:$PATH"
  BAD=3 fails 1 "ffmpeg could not write" render --movie 5 -o x.mp4 a.h5
  fails 1 "'none.h5'" render --movie 5 -o x.mp4 a.h5 none.h5
  only=$(dirname "$(command -v render)")
  rm -r mock
  [ ! -x "$only/ffmpeg" ]
  fails 1 "needs ffmpeg, which is not there" env PATH="$only" render --movie 5 -o x.mp4 a.h5
  [ -z "$(find . -name '.x.mp4*')" ]
}

fails() {
  local want=$1 text=$2
  shift 2
  rm -f x.png
  run "$@"
  echo "$status: $output"
  [ "$status" = "$want" ] && [ "${#lines[@]}" = 1 ] && [[ $output == "render: "*"$text"* ]] && [ ! -e x.png ] &&
    [ -z "$(find . -name '*x.png*' -o -name '*x.mp4*')" ]
}

@test "bad input is one line, and no picture" {
  echo text >text.h5
  fails 1 "'two.h5' has no field 'Densty' (did you mean 'Density'?)" render -c Densty -o x.png two.h5
  fails 1 "lacks field 'Damage' (made by weibull)" render -c Damage -o x.png two.h5
  fails 1 "field 'Velocities' has no component 'w'" render -c Velocities.w -o x.png two.h5
  fails 1 "field 'Density' has no component 'x'" render -c Density.x -o x.png two.h5
  fails 1 "needs --view projection" render -c ColumnDensity -o x.png two.h5
  fails 1 "'none.h5'" render -o x.png none.h5
  fails 1 "'text.h5'" render -o x.png two.h5 text.h5
  fails 1 "" bash -c 'render -o x.png </dev/null'
  fails 1 "" render -o no/such/folder/x.png two.h5
  fails 1 "No space left" bash -c 'render two.h5 >/dev/full'
  fails 1 "File too large" bash -c 'trap "" XFSZ; ulimit -f 1; render -o x.png two.h5'
  fails 1 "nothing belongs to body:7" render -C body:7 -o x.png two.h5
  fails 1 "too small" render -s 64x64 --panels 4x4 -o x.png two.h5
  fails 1 "1,2" render -C 1,2 -o x.png two.h5
  fails 2 "--size" render -s 0x10 -o x.png two.h5
  fails 2 "--size" render -s 10 -o x.png two.h5
  fails 2 "no room for 2 snapshots" render -P 1x1 -o x.png a.h5 b.h5
  fails 2 "--range: 5:1 is empty" render -c Density -r 5:1 -o x.png two.h5
  fails 2 "--range" render -c Density -r 5 -o x.png two.h5
  fails 2 "3km" render -c Density -r 0:3km -o x.png two.h5
  fails 2 "names kinds" render -r 0:1 -o x.png two.h5
  fails 2 "starts above 0" render -c Density -l -r 0:1 -o x.png two.h5
  fails 2 "--extent" render -e 0 -o x.png two.h5
  fails 2 "--color: '2*(Density': a ')' is missing at the end" render -c '2*(Density' -o x.png two.h5
  fails 1 "'kg/m^3' and 'm/s' do not go together" render -c 'Density + |Velocities|' -o x.png two.h5
  fails 1 "'BodyID > 3' holds for no particle" render -S 'BodyID > 3' -o x.png two.h5
  fails 2 "--select" render -S 'BodyID >' -o x.png two.h5
  fails 2 "exclude each other" render -p xy -f 0,0 -o x.png two.h5
  fails 2 "--from" render -f 30deg -o x.png two.h5
  fails 2 "a slice is flat" render -v slice -F 30deg -o x.png two.h5
  fails 2 "--perspective" render -F 170deg -o x.png two.h5
  fails 2 "side 'x' faces away" render -a x -f 180deg,10deg -o x.png two.h5
  fails 2 "'q' is not up to three of" render -a q -o x.png two.h5
  fails 2 "--cut-away is for --view cut" render -a z -v surface -o x.png two.h5
  fails 2 "--offset is for" render -O 1km -v surface -o x.png two.h5
  fails 2 "--range: more than there are of --color" render -c Density -r : -r : -o x.png two.h5
  fails 2 "no room for 4 panels" render -c Density -c BodyID -P 3x1 -o x.png a.h5 b.h5
  fails 2 "must end in .mp4" render --movie 5 -o x.avi two.h5
  fails 2 "'x.mp4' needs --movie" render -o x.mp4 two.h5
  fails 2 "must be positive" render --movie 0 -o x.mp4 two.h5
}
