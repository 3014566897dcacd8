# SPDX-License-Identifier: GPL-3.0-or-later
"""components.py SNAPSHOT IDS LINK: the fragments of `fof -o IDS --link LINK SNAPSHOT` against the connected components of the graph
of all pairs with r_ij < LINK (h_i + h_j)/2, by scipy. components.py --random SNAPSHOT OUT SEED: other positions and h, clustered."""
import shutil
import sys

import h5py
import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree


def scatter(source, out, seed):
    """Clusters of many densities and h that differ by a factor of four."""
    shutil.copy(source, out)
    rng = np.random.default_rng(seed)
    with h5py.File(out, "r+") as f:
        p = f["PartType0"]
        n = len(p["Masses"])
        cluster = rng.integers(0, 40, n)
        x = rng.normal(size=(n, 3)) * np.exp(rng.normal(size=40))[cluster, None] + 4 * rng.normal(size=(40, 3))[cluster]
        p["Coordinates"][:] = x * 1e5
        p["SmoothingLength"][:] = 6e4 * 4 ** rng.random(n)


def compare(snapshot, ids, link):
    p = h5py.File(snapshot)["PartType0"]
    x, h, m = p["Coordinates"][:], p["SmoothingLength"][:], p["Masses"][:]
    q = h5py.File(ids)["PartType0"]
    assert (q["ParticleIDs"][:] == p["ParticleIDs"][:]).all()
    pair = cKDTree(x).query_pairs(link * h.max(), output_type="ndarray")
    i, j = pair[:, 0], pair[:, 1]
    near = np.linalg.norm(x[i] - x[j], axis=1) < link * (h[i] + h[j]) / 2
    n, label = connected_components(coo_matrix((np.ones(near.sum()), (i[near], j[near])), (len(x), len(x))), directed=False)
    fragment = q["FragmentID"][:]
    assert fragment.min() == 1 and fragment.max() == n, (fragment.max(), n)
    assert len(np.unique(np.stack((fragment, label)), axis=1).T) == n
    mass = np.bincount(fragment - 1, m)
    assert (np.diff(mass) <= 1e-12 * mass[0]).all()
    print(f"{len(x)} particles, {near.sum()} links, {n} fragments")


if sys.argv[1] == "--random":
    scatter(sys.argv[2], sys.argv[3], int(sys.argv[4]))
else:
    compare(sys.argv[1], sys.argv[2], float(sys.argv[3]))
