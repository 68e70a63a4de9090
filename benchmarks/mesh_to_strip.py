"""From an STL file to a strip-theory matrix, against the time that trimesh needs to load the file; and the memory.

Work: a binary STL of a SUBOFF hull with a sail and four fins, about 100,000 faces, in mm and FLU. Ours reads it, joins its
vertices, goes through every gate, turns it to m and FRD, integrates it, cuts 96 sections and adds up their added mass;
`trimesh.load_mesh` reads it and joins its vertices. Runs alternate, the median of their ratios counts. The same with
1,000,000 faces runs in a process of its own, whose peak memory is printed.
"""

from __future__ import annotations

import os

os.environ["OPENBLAS_NUM_THREADS"] = "1"

import resource
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import trimesh

from coeflab.bodies.added_mass import strip
from coeflab.bodies.mesh.meshing import meshed
from coeflab.bodies.mesh.solids import box, solid, surface
from coeflab.bodies.profiles import suboff_meridian
from coeflab.bodies.readers import mesh

REPEATS = 9
FACES, MANY = 100_000, 1_000_000
BODY = """[body]
name = "finned_hull"
reader = "mesh"
datum = "nose"
reference_point = [-2.0, 0.0, 0.0]
[mesh]
path = "hull.stl"
unit = "mm"
axes = "FLU"
[source]
citation = "synthetic"
[particulars]
length = "4356 mm"
"""


def write(folder: Path, faces: int) -> int:
    """The body and its STL; returns the number of faces."""
    hull = meshed(suboff_meridian(), faces)
    whole = solid(hull.vertices, hull.faces) + box(np.array([-1.3, -0.03, -0.46]), np.array([-0.95, 0.03, 0.0]))
    for k in range(4):
        whole += box(np.array([-4.2, -0.008, 0.0]), np.array([-4.0, 0.008, 0.25])).rotate((90.0 * k, 0.0, 0.0))
    vertices, triangles = surface(whole)
    trimesh.Trimesh(vertices * [1e3, -1e3, -1e3], triangles, process=False).export(folder / "hull.stl")
    (folder / "body.toml").write_text(BODY)
    return len(triangles)


def ours(folder: Path) -> None:
    strip.added_mass(mesh.read(folder / "body.toml"), 1000.0)


def seconds(work: object, *arguments: object) -> float:
    start = time.perf_counter()
    work(*arguments)
    return time.perf_counter() - start


def main() -> None:
    if len(sys.argv) > 1:
        ours(Path(sys.argv[1]))
        print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6)
        return
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        count = write(folder, FACES)
        ours(folder)
        pairs = [(seconds(ours, folder), seconds(trimesh.load_mesh, folder / "hull.stl")) for _ in range(REPEATS)]
        mine, theirs = (statistics.median(p[k] for p in pairs) for k in range(2))
        ratio = statistics.median(a / b for a, b in pairs)
        print(f"file to strip result {mine:8.3f} s for {count} faces (median of {REPEATS})")
        print(f"trimesh.load_mesh    {theirs:8.3f} s")
        print(f"ratio                {ratio:8.2f} (target: under 3)")
        count = write(folder, MANY)
        peak = float(subprocess.run([sys.executable, __file__, name], capture_output=True, check=True).stdout)
        print(f"peak memory          {peak:8.2f} GB for {count} faces (target: under 2)")


if __name__ == "__main__":
    main()
