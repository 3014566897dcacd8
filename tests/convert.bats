#!/usr/bin/env bats
# SPDX-License-Identifier: GPL-3.0-or-later
# convert: round trips field by field, what others read of it (by tools that know nothing of breccia), and every mistake. What comes from
# other programs is tested in test_convert.c.

load h5

# A system of two bodies with flaws, pores and stress, and a short run of it.
setup_file() {
  cd "$BATS_FILE_TMPDIR"
  mksphere -n 60 --radius 30km --layer ice:0.3 --layer basalt:0.7 2>log | weibull -o t.h5 2>log
  mksphere -n 40 --radius 20km --layer jsc1a -o i.h5 2>log
  collide -a 45deg -s 1.5vesc -d 1.1 t.h5 i.h5 -o s.h5 2>log
  solver -o run --end +10s --every 5s s.h5 2>log
}

setup() {
  cd "$BATS_TEST_TMPDIR"
  cp -r "$BATS_FILE_TMPDIR"/{s.h5,run} .
}

# same A B: every particle field, bit by bit.
same() { h5diff -c "$1" "$2" /PartType0 /PartType0; }

# dataset FILE NAME [COLUMNS]: like field, of any dataset.
dataset() {
  { h5dump -d "$2" -y -w 1 -m %.17g -o /dev/fd/3 "$1" >/dev/null; } 3>&1 | tr -d ' ,' | grep . | paste -d' ' $(yes - | head -n "${3:-1}")
}

@test "to miluphcuda's HDF5 and back: every field, the flaws, the materials, the time" {
  convert -t miluph -o m.0002.h5 run/snap_0002.h5 2>said
  [ "$(dataset m.0002.h5 /sml)" = "$(field run/snap_0002.h5 SmoothingLength)" ]
  [ "$(dataset m.0002.h5 /x 3)" = "$(field run/snap_0002.h5 Coordinates 3)" ]
  [ "$(dataset m.0002.h5 /alpha_jutzi)" = "$(field run/snap_0002.h5 Distention)" ]
  [ "$(dataset m.0002.h5 /deviatoric_stress 9 | cut -d' ' -f 1-3,5,6,9)" = "$(field run/snap_0002.h5 DeviatoricStress 6)" ]
  [ "$(dataset m.0002.h5 /deviatoric_stress 9 | cut -d' ' -f 2,3,6)" = "$(dataset m.0002.h5 /deviatoric_stress 9 | cut -d' ' -f 4,7,8)" ]
  most=$(field run/snap_0002.h5 FlawCount | sort -n | tail -1)
  [ "$(dataset m.0002.h5 /maximum_number_of_flaws)" = "$most" ]
  [ "$(dataset m.0002.h5 /activation_thresholds | grep -v -- '^-1$')" = "$(field run/snap_0002.h5 FlawThresholds)" ]
  grep -q 'material_type 2 is jsc1a' said
  grep -q 'not carried over: History, Parameters, Collision, Body' said
  convert -o back.h5 m.0002.h5 2>said
  same run/snap_0002.h5 back.h5
  h5diff run/snap_0002.h5 back.h5 /Materials /Materials
  [ "$(number back.h5 /Header/Time)" = "$(number run/snap_0002.h5 /Header/Time)" ]
  convert -t miluph -o again.h5 back.h5 2>said && cmp m.0002.h5 again.h5
}

@test "to miluphcuda's rows of text and back: all that they hold" {
  convert -t miluph-input -o m.0002 run/snap_0002.h5 2>said
  grep -q 'compiled with: INTEGRATE_DENSITY, INTEGRATE_ENERGY, READ_INITIAL_SML_FROM_PARTICLE_FILE, SOLID, FRAGMENTATION, PALPHA_POROSITY' said
  grep -q 'not carried over: ParticleIDs, BodyID' said
  # x v m rho e sml material flaws damage S alpha p
  awk '{ exit !(NF == 24 + $12) }' m.0002
  [ "$(cut -d' ' -f 10 m.0002)" = "$(field run/snap_0002.h5 SmoothingLength)" ]
  [ "$(cut -d' ' -f 24 m.0002)" = "$(field run/snap_0002.h5 Pressure)" ]
  convert -f miluph-input --switches SOLID,FRAGMENTATION,PALPHA_POROSITY -m 0:ice -m 1:basalt -m 2:jsc1a -o back.h5 m.0002 2>said
  for name in Coordinates Velocities Masses Density InternalEnergy SmoothingLength MaterialID Distention Pressure FlawCount FlawThresholds \
    DeviatoricStress; do
    h5diff run/snap_0002.h5 back.h5 "/PartType0/$name"
  done
  h5diff -p 1e-14 run/snap_0002.h5 back.h5 /PartType0/Damage # by its cube root
}

@test "miluphcuda's output rows, which differ from its input; in two dimensions" {
  printf '1 2 3 4 5 6 7 8 9 0 .1 .2 .3 -.2 -.1\n' >o.0001
  # x[2] v[2] m rho e h interactions material p local_strain S[4]: one short
  bad 1 "'o.0001':1: 15 columns, not the 16 of x[2] v[2] m rho e sml interactions material_type p local_strain S[4] (--switches" \
    convert -f miluph-output --dimension 2 --switches SOLID -m 0:ice -o o.h5 o.0001
  printf '1 2 3 4 5 6 7 8 9 0 .1 .2 .3 -.2 -.2 .4\n\n2 2 3 4 5 6 7 8 9 0 .1 .2 .3 -.2 -.2 .4\n' >o.0001
  convert -f miluph-output --dimension 2 --switches SOLID --time 5s -m 0:ice -o o.h5 o.0001 2>said
  grep -q 'not carried over: local_strain' said
  [ "$(field o.h5 Coordinates 3 | tail -1) $(field o.h5 DeviatoricStress 6 | tail -1)" = "2 2 0 0.29999999999999999 -0.20000000000000001 0 0.40000000000000002 0 -0.69999999999999996" ]
  [ "$(field o.h5 NeighbourNumber | tail -1) $(field o.h5 Pressure | tail -1)" = "9 0.10000000000000001" ]
  [ "$(number o.h5 /Header/Time) $(number o.h5 /Header/Dimension)" = "5 2" ]
  bad 1 "16 columns, not the 15" convert -f miluph-output -d 2 --switches SOLID,INTEGRATE_ENERGY=0 -m 0:ice -o o.h5 o.0001
}

@test "CSV: names, units, digits" {
  convert -F Coordinates -F Density -F BodyID -F DeviatoricStress -o a.csv run/snap_0002.h5
  [ "$(head -1 a.csv)" = "Coordinates_x [m],Coordinates_y [m],Coordinates_z [m],Density [kg/m^3],BodyID$(printf ',DeviatoricStress_%s [Pa]' xx xy xz yy yz zz)" ]
  [ "$(tail -n +2 a.csv | cut -d, -f 1-3 | tr , ' ')" = "$(field run/snap_0002.h5 Coordinates 3)" ]
  [ "$(tail -n +2 a.csv | cut -d, -f 6-11 | tr , ' ')" = "$(field run/snap_0002.h5 DeviatoricStress 6)" ]
  convert -t csv -F Damage <s.h5 | head -1 | grep -qx Damage
}

@test "H5Part: a series complete in itself; others' particles too" {
  convert -o all.h5part run/snap_*.h5
  [ "$(h5ls all.h5part | cut -d' ' -f 1 | tr '\n' ' ')" = 'Step#0 Step#1 Step#2 ' ]
  mv run gone
  [ "$(dataset all.h5part '/Step#2/y')" = "$(field gone/snap_0002.h5 Coordinates 3 | cut -d' ' -f 2)" ]
  [ "$(dataset all.h5part '/Step#1/Velocities_2')" = "$(field gone/snap_0001.h5 Velocities 3 | cut -d' ' -f 3)" ]
  [ "$(number all.h5part '/Step#2/TimeValue')" = "$(number gone/snap_0002.h5 /Header/Time)" ]
  convert -q -t miluph -o m.h5 s.h5
  convert -F Density -o m.h5part m.h5 2>said
  [ "$(dataset m.h5part '/Step#0/Density')" = "$(field s.h5 Density)" ]
}

@test "XDMF: XML that points to what is there, by names beside it" {
  convert -o run/all.xdmf run/snap_*.h5
  [ "$(grep -c '<Time Value' run/all.xdmf)" = 3 ]
  mv run moved
  cd moved
  grep -o 'Dimensions="[^"]*">[^<]*' all.xdmf | sed 's/.*="\(.*\)">\(.*\)/\2 \1/' >items
  [ -s items ]
  while IFS=': ' read -r file dataset rows columns; do
    h5ls "$file$dataset" | grep -q "Dataset {$rows${columns:+, $columns}}$"
  done <items
  grep -q '^snap_0001.h5:/PartType0/DeviatoricStress ' items
  grep -q 'AttributeType="Tensor6"' all.xdmf
  cd .. && convert -o elsewhere.xdmf moved/snap_0000.h5 && grep -q '>moved/snap_0000.h5:/PartType0/Coordinates<' elsewhere.xdmf
}

@test "what h5py and numpy make of it" {
  convert -q -t miluph -o m.h5 run/snap_0002.h5
  convert -o a.csv run/snap_0002.h5
  convert -o a.h5part run/snap_0002.h5
  reads 'h5py numpy' '
import h5py, numpy as np
p = h5py.File("run/snap_0002.h5")["PartType0"]
m, step, csv = h5py.File("m.h5"), h5py.File("a.h5part")["Step#0"], np.genfromtxt("a.csv", delimiter=",", names=True, deletechars="")
for ours, theirs in {"Coordinates": "x", "Velocities": "v", "Masses": "m", "Density": "rho", "InternalEnergy": "e",
                     "SmoothingLength": "sml", "MaterialID": "material_type", "Pressure": "p"}.items():
    assert np.array_equal(p[ours], m[theirs]), ours
assert np.allclose(m["DIM_root_of_damage_tensile"][()] ** 3, p["Damage"], rtol=1e-14)
assert np.array_equal((m["activation_thresholds"][()] > 0).sum(axis=1), p["FlawCount"])
for name in p:
    if name == "FlawThresholds": continue
    x = p[name][()].reshape(len(p["Masses"]), -1)
    for k in range(x.shape[1]):
        part = "xyz"[k] if name == "Coordinates" else name if x.shape[1] == 1 else f"{name}_{k}"
        assert np.array_equal(step[part], x[:, k]), part
assert np.array_equal(csv["Density_[kg/m^3]"], p["Density"])
'
}

@test "what VTK makes of it" {
  convert -o a.vtu run/snap_0002.h5
  convert -o a.h5part run/snap_0002.h5
  convert -o run/a.xdmf run/snap_*.h5
  reads 'vtk h5py numpy' '
import vtk, h5py, numpy as np
p = h5py.File("run/snap_0002.h5")
time, p = p["Header"].attrs["Time"], p["PartType0"]
def rows(a): return np.array([a.GetTuple(i) for i in range(a.GetNumberOfTuples())])
def check(d, stress):
    assert np.array_equal(rows(d.GetPoints().GetData()), p["Coordinates"])
    data = {d.GetPointData().GetArrayName(k).split(" [")[0]: rows(d.GetPointData().GetArray(k)) for k in range(d.GetPointData().GetNumberOfArrays())}
    for name in "Density", "Damage", "MaterialID": assert np.array_equal(data[name][:, 0], p[name]), name
    assert np.array_equal(data["Velocities"], p["Velocities"])
    assert np.array_equal(data["DeviatoricStress"][:, stress], p["DeviatoricStress"])
def last(r):
    r.UpdateInformation()
    t = r.GetOutputInformation(0).Get(vtk.vtkStreamingDemandDrivenPipeline.TIME_STEPS())
    r.UpdateTimeStep(t[-1])
    return t[-1]
r = vtk.vtkXMLUnstructuredGridReader(); r.SetFileName("a.vtu"); r.Update()
check(r.GetOutput(), [0, 3, 5, 1, 4, 2]) # VTK has xx yy zz xy yz xz
assert r.GetOutput().GetFieldData().GetArray("TimeValue").GetValue(0) == time
if hasattr(vtk, "vtkXdmfReader"):
    r = vtk.vtkXdmfReader(); r.SetFileName("run/a.xdmf")
    assert last(r) == time
    check(r.GetOutputDataObject(0), [0, 1, 2, 4, 5, 8])
if hasattr(vtk, "vtkH5PartReader"):
    for name in "a.h5part", "run/run.h5part":
        r = vtk.vtkH5PartReader(); r.SetFileName(name); r.UpdateInformation()
        for k in range(r.GetNumberOfPointArrays()): r.SetPointArrayStatus(r.GetPointArrayName(k), 1)
        last(r)
        check(r.GetOutput(), [0, 1, 2, 3, 4, 5])
'
}

@test "every mistake is one line" {
  bad 2 "what should 'a.xyz' be? say --to" convert -o a.xyz s.h5
  bad 2 "only xdmf and h5part hold a series" convert -o a.h5 s.h5 s.h5
  bad 2 "--field is for" convert -F Density -o a.h5 s.h5
  bad 2 "--material is for snapshots" convert -m 0:ice -o a.csv s.h5
  bad 2 "--switches is for" convert --switches SOLID -o a.h5 s.h5
  bad 2 "--dimension: 4" convert -d 4 -o a.h5 s.h5
  bad 2 "--support: -1 is not positive" convert --support -1 -o a.h5 s.h5
  bad 2 "xdmf needs a file" convert -t xdmf s.h5
  bad 1 "no field 'Densty' (did you mean 'Density'?)" convert -F Densty -o a.csv s.h5
  bad 1 "XDMF points into snapshots" convert -q -f swift -o a.xdmf s.h5
  bad 1 "'none.h5'" convert -o a.h5 none.h5
  echo 1 2 3 >text.0000
  bad 1 "'text.0000': not an HDF5 file (of text say --from)" convert -o a.h5 text.0000
  bad 1 "--switches: no column depends on 'FRAGMENTATIO' (did you mean 'FRAGMENTATION'?)" convert -f miluph-input --switches FRAGMENTATIO -o a.h5 text.0000
  bad 1 "SOLID is 0 or 1, not 'no'" convert -f miluph-input --switches SOLID=no -o a.h5 text.0000
  bad 1 "'text.0000':1: 3 columns, not the 11 of" convert -f miluph-input -o a.h5 text.0000
  echo 1 2 3 4 5 x 7 8 9 10 11 >text.0000
  bad 1 "'text.0000':1: not a number: 'x'" convert -f miluph-input -o a.h5 text.0000
  : >text.0000
  bad 1 "'text.0000': no rows" convert -f miluph-input -o a.h5 text.0000
  bad 1 "SIRONO_POROSITY: its nine columns" convert -t miluph-input --switches SIRONO_POROSITY -o a.txt s.h5
  echo 1 >one.txt
  h5import one.txt -dims 1 -path x -type TEXTFP -o other.h5
  bad 1 "no format that is known here" convert -o a.h5 other.h5
  convert -q -t miluph -o m.h5 s.h5
  bad 1 "--material: 'm.h5' has no material 3" convert -q -m 3:ice -o a.h5 m.h5
  bad 1 "--material: 'ice' is not NUMBER:NAME" convert -q -m ice -o a.h5 m.h5
  bad 1 "No space left on device" convert -q -o /dev/full -t csv s.h5
  bad 1 "No space left on device" convert -q -o /dev/full -t vtu s.h5
  [ "$(ls a.* 2>/dev/null)" = "" ]
}
