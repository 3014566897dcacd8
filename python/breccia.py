# SPDX-License-Identifier: GPL-3.0-or-later
"""Snapshots of breccia as numpy arrays with units, on h5py and numpy alone.

    from breccia import Snapshot, series, conserved

    s = Snapshot("run/snap_0010.h5")
    s.n, s.time, s.dimension              # particles, s, 1 to 3
    s["Density"], s["Density"].unit       # an array [n], 'kg/m^3'; vectors are [n, 3], tensors [n, 6] xx xy xz yy yz zz
    s["Density"][s.is_material("ice")]    # of one material
    s.flaws(i)                            # thresholds of particle i
    s.quantity("Density", "unyt")         # with units that calculate: unyt or astropy
    s.history, s.parameters, s.collision  # what made it
    for s in series("run"): ...           # all snapshots of a run, in order of time
    conserved("run")["E_total"]           # a column of conserved.tsv

Everything is SI. yt opens the same files: yt.load(path, unit_base=breccia.YT_UNITS); pynbody.load(path) needs nothing.
"""
import glob
import os

import h5py
import numpy as np

YT_UNITS = {
    "length": (1.0, "m"),
    "mass": (1.0, "kg"),
    "time": (1.0, "s"),
    "velocity": (1.0, "m/s"),
    "specific_energy": (1.0, "m**2/s**2"),  # else (km/s)^2
}


class Array(np.ndarray):
    """Numbers with `unit` and `meaning`. Parts of it keep them; results of calculations are plain arrays."""

    def __new__(cls, values, unit="", meaning=""):
        array = np.asarray(values).view(cls)
        array.unit, array.meaning = unit, meaning
        return array

    def __array_finalize__(self, source):
        self.unit, self.meaning = getattr(source, "unit", ""), getattr(source, "meaning", "")

    def __array_ufunc__(self, ufunc, method, *inputs, **options):
        plain = [x.view(np.ndarray) if isinstance(x, Array) else x for x in inputs]
        if "out" in options:
            options["out"] = tuple(x.view(np.ndarray) if isinstance(x, Array) else x for x in options["out"])
        return getattr(ufunc, method)(*plain, **options)


def _text(value):
    return value.decode() if isinstance(value, bytes) else str(value)


def _lines(file, name):
    return [_text(x) for x in file[name][()]] if name in file else []


class Snapshot:
    """One file. Fields are read when asked for: s[name], `name in s`, s.fields."""

    def __init__(self, path):
        self.path = str(path)
        with h5py.File(path, "r") as f:
            if "PartType0" not in f or "FormatVersion" not in f["Header"].attrs:
                raise ValueError(f"'{path}' is no snapshot of breccia (convert makes one)")
            header = f["Header"].attrs
            self.time, self.dimension = float(header["Time"]), int(header["Dimension"])
            self.n = int(header["NumPart_ThisFile"][0])
            self.fields = [name for name in f["PartType0"] if name != "FlawThresholds"]
            self.materials = dict(zip(_lines(f, "Materials/Name"), _lines(f, "Materials/Text")))
            self._material_names = _lines(f, "Materials/Name")
            self.history = [tuple(line.split("\t")) for line in _lines(f, "History")]  # (command line, version)
            self.parameters = {line.split("\t")[0]: line.split("\t")[1] for line in _lines(f, "Parameters")}
            groups = ({k: float(v) for k, v in f[g].attrs.items()} if g in f else {} for g in ("Collision", "Body", "Run"))
            self.collision, self.body, self.run = groups
        self._flaws = None

    def __contains__(self, name):
        return name in self.fields

    def __getitem__(self, name):
        with h5py.File(self.path, "r") as f:
            if name not in f["PartType0"]:
                raise KeyError(f"'{self.path}' has no field '{name}', but {', '.join(self.fields)}")
            data = f["PartType0"][name]
            unit, meaning = (_text(data.attrs.get(key, "")) for key in ("unit", "meaning"))
            return Array(data[()] * data.attrs["unitSI"] if data.attrs.get("unitSI", 1) != 1 else data[()], unit, meaning)

    def quantity(self, name, library="unyt"):
        """The field with the units of unyt or astropy."""
        array = self[name]
        unit = "" if array.unit == "1" else array.unit.replace("^", "**")
        if library == "unyt":
            import unyt

            return unyt.unyt_array(array.view(np.ndarray), unit or "dimensionless")
        if library == "astropy":
            from astropy import units

            return units.Quantity(array.view(np.ndarray), unit)
        raise ValueError(f"library is unyt or astropy, not '{library}'")

    def is_material(self, name):
        """Which particles are of that material: an array of truth values."""
        return np.asarray(self["MaterialID"]) == self._material_names.index(name)

    def flaws(self, i):
        """Strains at which the flaws of particle i open, ascending; empty without flaws."""
        if self._flaws is None:
            count = np.asarray(self["FlawCount"]) if "FlawCount" in self else np.zeros(self.n, int)
            start = np.concatenate(([0], np.cumsum(count)))
            self._flaws = start, np.asarray(self["FlawThresholds"]) if start[-1] else np.empty(0)
        start, threshold = self._flaws
        return threshold[start[i] : start[i + 1]]


def series(folder):
    """The snapshots of a run, one after the other."""
    for path in sorted(glob.glob(os.path.join(folder, "snap_*.h5"))):
        yield Snapshot(path)


def conserved(folder):
    """conserved.tsv of a run: its columns by name, as arrays (of text where they are no numbers)."""
    with open(os.path.join(folder, "conserved.tsv"), encoding="utf-8") as f:
        lines = [line.rstrip("\n").split("\t") for line in f]
    names = [name.lstrip("# ").split("[")[0] for name in next(x for x in lines if x[0].startswith("#"))]
    columns = zip(*(x for x in lines if not x[0].startswith("#")))
    return {name: _numbers(column) for name, column in zip(names, columns)}


def _numbers(column):
    try:
        return np.array(column, float)
    except ValueError:
        return np.array(column)
