"""The panel method in plain numpy beside capytaine's direct formulation, on the same triangles.

Usage: python panel_capytaine.py PYTHON [PANELS]
PYTHON is an interpreter that has capytaine 3; PANELS are 8,000 unless given. A 6:1 spheroid in unbounded fluid; the same one
diameter and a half below a free surface at infinite frequency, by images; and a body with a fin, which we have as dipole
panels and capytaine must have as a thin box: our panels on both of its sides, and its rim; timed only, as the bodies differ. Every line is a process of its own,
for its peak memory. Seconds by the clock suffer from what else the machine does; those of the processor, over all threads,
do not.
"""

from __future__ import annotations

import json
import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

os.environ["OPENBLAS_NUM_THREADS"] = "1"
import numpy as np

from coeflab.bodies.added_mass.panel import _rectangle
from coeflab.bodies.mesh.meshing import meshed
from coeflab.bodies.panel_solver.panels import bisected
from coeflab.bodies.panel_solver.solve import panel_added_mass
from coeflab.bodies.panel_solver.wall import Wall
from coeflab.bodies.shape import Ellipsoid, Form, Part, Parts, Plate

PEER = Path(__file__).with_name("capytaine_added_mass.py")
AXES, DEPTH = (6.0, 1.0, 1.0), 3.0
FIN, THICK, SHARE = (2.0, 4.0), 0.05, 0.1
FASTER, MEMORY, EQUAL = 20.0, 0.2, 0.002


def triangles(form: Form, panels: int, at: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> np.ndarray:
    mesh = meshed(Parts((Part("p", form, np.array(at), np.eye(3)),)), panels)
    return mesh.vertices[mesh.faces]


def thin_box(plate: np.ndarray) -> np.ndarray:
    """The closed surface that dipole panels in a plane z = const stand for: they on both sides, and a rim of two a side."""
    up, down = plate + np.array([0.0, 0.0, THICK / 2.0]), plate - np.array([0.0, 0.0, THICK / 2.0])
    if np.cross(up[0, 1] - up[0, 0], up[0, 2] - up[0, 0])[2] < 0.0:
        up, down = up[:, ::-1], down[:, ::-1]
    sides = np.stack([up, np.roll(up, -1, axis=1)], axis=2).reshape(-1, 2, 3)
    outer = np.isclose(np.abs(sides[:, :, :2]), [FIN[0] / 2.0, FIN[1] / 2.0]).all(axis=1).any(axis=1)
    a, b = sides[outer].transpose(1, 0, 2)
    below = np.array([0.0, 0.0, THICK])
    rim = [np.stack([b, a, a - below], axis=1), np.stack([b, a - below, b - below], axis=1)]
    return np.concatenate([up, down[:, ::-1], *rim])


def one(path: str, depth: float) -> None:
    """One line of ours, as JSON; a file with sheets has them as dipole panels."""
    given = np.load(path)
    corners, sheets = given["corners"], given.get("sheets")
    wall = None if np.isinf(depth) else Wall(np.array([0.0, 0.0, depth]), np.array([0.0, 0.0, 1.0]), -1.0)
    panel_added_mass(corners[:4], np.zeros(3), False)
    start, before = time.perf_counter(), time.process_time()
    found = panel_added_mass(corners, np.zeros(3), False, sheets, wall)
    seconds, processor = time.perf_counter() - start, time.process_time() - before
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
    print(json.dumps({"matrix": found.matrix.tolist(), "seconds": seconds, "processor": processor, "peak": peak}))


def run(*command: str) -> dict:
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    return json.loads(done.stdout.splitlines()[-1])


def compare(python: str, panels: int) -> None:
    print(f"{'':34s}{'panels':>7s}{'clock s':>9s}{'proc. s':>9s}{'MiB':>7s}")
    body = triangles(Ellipsoid(*AXES), panels)
    hull, fin = triangles(Ellipsoid(*AXES), int((1.0 - SHARE) * panels)), int(SHARE * panels)
    plate = bisected(_rectangle(Part("fin", Plate(*FIN), np.array([0.0, 0.0, 5.0]), np.eye(3))), fin)
    thick = np.concatenate([hull, thin_box(plate)])
    cases = (
        ("unbounded", body, None, np.inf, body),
        ("free surface, infinite frequency", body, None, DEPTH, body),
        ("with dipole panels", hull, plate, np.inf, thick),
    )
    with tempfile.TemporaryDirectory() as folder:
        for name, ours, sheets, depth, theirs in cases:
            mine, peer = str(Path(folder) / "mine.npz"), str(Path(folder) / "peer.npz")
            np.savez(mine, corners=ours, **({} if sheets is None else {"sheets": sheets}))
            vertices, place = np.unique(theirs.reshape(-1, 3), axis=0, return_inverse=True)
            np.savez(peer, vertices=vertices, faces=place.reshape(-1, 3))
            found = run(sys.executable, __file__, "--one", mine, str(depth))
            other = run(python, str(PEER), peer, "direct", *([] if np.isinf(depth) else [str(depth)]))
            for who, count, got in (
                ("coeflab numpy", len(ours) + (0 if sheets is None else len(sheets)), found),
                ("capytaine direct", len(theirs), other),
            ):
                print(
                    f"{name[:16]:17s}{who:17s}{count:7,d}{got['seconds']:9.1f}{got['processor']:9.1f}{got['peak'] / 2**20:7.0f}",
                    flush=True,
                )
            a, b = np.diag(found["matrix"])[[0, 1, 2, 4, 5]], np.diag(other["matrix"])[[0, 1, 2, 4, 5]]
            off = f", equal to {np.max(np.abs(a / b - 1.0)):.3%} (target: {EQUAL:.1%})" if sheets is None else ""
            print(
                f"  {other['seconds'] / found['seconds']:.0f} times faster by the clock, {other['processor'] / found['processor']:.0f} by the "
                f"processor (target: {FASTER:g}), {found['peak'] / other['peak']:.2f} of its memory (target: {MEMORY:g}){off}",
                flush=True,
            )


def main() -> None:
    if sys.argv[1] == "--one":
        one(sys.argv[2], float(sys.argv[3]))
    else:
        compare(sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 8_000)


if __name__ == "__main__":
    main()
