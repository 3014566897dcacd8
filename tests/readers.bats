#!/usr/bin/env bats
# SPDX-License-Identifier: GPL-3.0-or-later
# Snapshots as the programs write them, opened unchanged by what others use: h5py, yt, pynbody, VTK (whose H5Part reader is ParaView's),
# and by python/breccia.py; with units. Each against numbers that h5dump takes out. Skipped where python3 lacks the module (.ci/run
# readers has them all).

load h5

setup_file() {
  cd "$BATS_FILE_TMPDIR"
  mksphere -n 60 --radius 30km --layer ice:0.3 --layer basalt:0.7 2>log | weibull -o t.h5 2>log
  collide -a 45deg -s 1.5vesc -d 1.1 t.h5 t.h5 -o s.h5 2>log
  solver -o run --end +10s --every 5s s.h5 2>log
}

setup() {
  cd "$BATS_FILE_TMPDIR"
  snap=run/snap_0002.h5
  time=$(number $snap /Header/Time)
  row=$(field $snap Coordinates 3 | tail -1) rho=$(field $snap Density | tail -1) v=$(field $snap Velocities 3 | tail -1)
  u=$(field $snap InternalEnergy | tail -1) h=$(field $snap SmoothingLength | tail -1) m=$(field $snap Masses | tail -1)
}

@test "h5py: arrays, units, meanings" {
  reads 'h5py numpy' '
import sys, h5py
path, row, rho, time = sys.argv[1:]
f = h5py.File(path)
p = f["PartType0"]
assert list(p["Coordinates"][-1]) == [float(x) for x in row.split()] and p["Density"][-1] == float(rho)
assert all(p[k].attrs["unit"] and p[k].attrs["unitSI"] == 1 and p[k].attrs["meaning"] for k in p)
assert p["Density"].attrs["unit"] in ("kg/m^3", b"kg/m^3")
assert list(f["Step#0/x"]) == list(p["Coordinates"][:, 0]) and f["Step#0"].attrs["TimeValue"] == float(time) == f["Header"].attrs["Time"]
' $snap "$row" "$rho" "$time"
}

@test "python/breccia.py: fields, materials, flaws, series, conserved quantities" {
  reads 'h5py numpy' '
import sys, numpy as np, breccia
path, row, rho, time, flaws, energy = sys.argv[1:]
s = breccia.Snapshot(path)
assert s.time == float(time) and s.dimension == 3 and s.n == len(s["Masses"])
x, d = s["Coordinates"], s["Density"]
assert list(x[-1]) == [float(y) for y in row.split()] and d[-1] == float(rho)
assert (d.unit, x[3:5].unit, s["Velocities"].unit, d.meaning) == ("kg/m^3", "m", "m/s", "bulk density")
assert type(d * 2) is np.ndarray and type(np.sqrt(d)) is np.ndarray and (d * 2)[-1] == 2 * float(rho)
d2 = d.copy(); d2 *= 2
assert d2[0] == 2 * d[0]
assert list(s.materials) == ["ice", "basalt"] and "tillotson" in s.materials["basalt"]
ice, basalt = s.is_material("ice"), s.is_material("basalt")
assert (ice ^ basalt).all() and np.array_equal(s["MaterialID"][basalt], np.ones(basalt.sum()))
assert [len(s.flaws(i)) for i in range(s.n)] == list(s["FlawCount"]) and list(s.flaws(s.n - 1)) == [float(y) for y in flaws.split()]
assert s.collision["ContactTime"] == 0 and s.parameters["gravity.theta"] and s.history[0][0].startswith("mksphere ")
assert "Density" in s and "Densty" not in s
try: s["Densty"]
except KeyError as e: assert "has no field" in str(e)
assert [t.path for t in breccia.series("run")] == [f"run/snap_000{k}.h5" for k in range(3)]
c = breccia.conserved("run")
assert c["E_total"][-1] == float(energy) and np.allclose(c["E_total"], c["E_kinetic"] + c["E_internal"] + c["E_potential"], rtol=1e-9)
' $snap "$row" "$rho" "$time" \
    "$(field $snap FlawThresholds | tail -n "$(field $snap FlawCount | tail -1)" | tr '\n' ' ')" \
    "$(awk -F'\t' 'NR == 1 { for (k = 1; k <= NF; k++) if ($k ~ /^E_total/) c = k } END { print $c }' run/conserved.tsv)"
}

@test "python/breccia.py: units that calculate, of unyt" {
  reads 'h5py numpy unyt' '
import sys, breccia
s = breccia.Snapshot(sys.argv[1])
assert abs(s.quantity("Density")[-1].to_value("g/cm**3") - float(sys.argv[2]) / 1000) < 1e-12
assert s.quantity("Damage").units.is_dimensionless
assert abs(s.quantity("InternalEnergy")[-1].to_value("erg/g") / (float(sys.argv[3]) * 1e4) - 1) < 1e-12
' $snap "$rho" "$u"
}

# yt 4 does not look at /Units; without unit_base a length is a kpc.
@test "yt: a GADGET file, with units" {
  reads 'yt' '
import sys, numpy as np, yt, breccia
path, row, rho, v, u, m, time = sys.argv[1:]
yt.set_log_level(50)
ds = yt.load(path, unit_base=breccia.YT_UNITS)
near = lambda a, b: abs(float(a) / float(b) - 1) < 1e-12
assert near(ds.current_time.to("s"), time)
ad = ds.all_data()
order = np.argsort(ad["PartType0", "ParticleIDs"].v)
last = order[-1]
assert near(ad["gas", "density"][last].to("kg/m**3"), rho) and near(ad["PartType0", "InternalEnergy"][last].to("J/kg"), u)
for got, want, unit in ("Coordinates", row, "m"), ("Velocities", v, "m/s"):
    assert all(near(a, b) for a, b in zip(ad["PartType0", got][last].to(unit), want.split())), got
assert near(ad["PartType0", "Masses"][last].to("kg"), m)
assert ("PartType0", "DeviatoricStress") in ds.field_list and len(ad["PartType0", "Damage"]) == ad["PartType0", "Masses"].size
assert (ds.domain_left_edge.to("m").v <= ad["PartType0", "Coordinates"].to("m").v.min(axis=0)).all()
' $snap "$row" "$rho" "$v" "$u" "$m" "$time"
}

@test "pynbody: a GADGET file, with units of its own accord" {
  reads 'pynbody' '
import sys, pynbody
path, row, rho, v, u, m, h = sys.argv[1:]
s = pynbody.load(path)
near = lambda a, b: abs(float(a) / float(b) - 1) < 1e-12
last = int(s["iord"].argmax())
for name, want, unit in ("rho", rho, "kg m**-3"), ("u", u, "m**2 s**-2"), ("mass", m, "kg"), ("smooth", h, "m"):
    assert near(s[name].in_units(unit)[last], want), name
for name, want, unit in ("pos", row, "m"), ("vel", v, "m s**-1"):
    assert all(near(a, b) for a, b in zip(s[name].in_units(unit)[last], want.split())), name
assert len(s.gas) == len(s) and s["DeviatoricStress"].shape == (len(s), 6) and s["Damage"].max() <= 1
' $snap "$row" "$rho" "$v" "$u" "$m" "$h"
}

@test "VTK's H5Part reader: run.h5part, three steps, vectors whole" {
  reads 'vtk' '
import sys, vtk
from vtkmodules.vtkIOH5part import vtkH5PartReader
row, rho, v = ([float(x) for x in a.split()] for a in sys.argv[1:])
r = vtkH5PartReader()
r.SetFileName("run/run.h5part")
r.UpdateInformation()
times = r.GetOutputInformation(0).Get(vtk.vtkStreamingDemandDrivenPipeline.TIME_STEPS())
assert len(times) == 3
for k in range(r.GetNumberOfPointArrays()): r.SetPointArrayStatus(r.GetPointArrayName(k), 1)
r.UpdateTimeStep(times[-1])
d = r.GetOutput()
last = d.GetNumberOfPoints() - 1
data = d.GetPointData()
assert list(d.GetPoint(last)) == row and data.GetArray("Density").GetTuple1(last) == rho[0]
assert list(data.GetArray("Velocities").GetTuple(last)) == v and data.GetArray("DeviatoricStress").GetNumberOfComponents() == 6
' "$row" "$rho" "$v"
}
