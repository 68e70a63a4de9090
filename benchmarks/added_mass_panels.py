"""Panel method beside capytaine and strip theory on a 6:1 prolate spheroid, whose added mass Lamb knows exactly.

Usage: python added_mass_panels.py [PYTHON]
PYTHON is an interpreter that has capytaine (it pins an older pandas, so it lives in an environment of its own); without
one an environment is made in a temporary directory. Every line is a process of its own, for its peak memory. Seconds
exclude imports, compilation and tables kept between runs, which a small body pays for first on either side; ours
include meshing. Errors are the largest of surge, sway and pitch.
"""

from __future__ import annotations

import json
import resource
import subprocess
import sys
import tempfile
import time
import venv
from dataclasses import replace
from pathlib import Path

import numpy as np

from coeflab.bodies.added_mass import panel, strip
from coeflab.bodies.closed_forms.ellipsoid import ellipsoid_added_mass
from coeflab.bodies.mesh.meshing import meshed
from coeflab.bodies.readers import read_body
from coeflab.bodies.shape import Ellipsoid, Part, Parts
from coeflab.core.files import shipped

AXES = np.array([6.0, 1.0, 1.0])
PEER = Path(__file__).with_name("capytaine_added_mass.py")
THEIRS = (2_000, 4_000, 8_000)
OURS = (1_000, 2_000, 4_000, 8_000, 30_000)
SMALL = 1_000


def spheroid() -> Parts:
    return Parts((Part("spheroid", Ellipsoid(*AXES), np.zeros(3), np.eye(3)),))


def errors(matrix: np.ndarray) -> tuple[float, float, float]:
    """Surge, sway and pitch in per cent."""
    exact = np.diag(ellipsoid_added_mass(AXES, 1.0))
    return tuple(float(100.0 * (matrix[k][k] / exact[k] - 1.0)) for k in (0, 1, 4))


def one(panels: str, kernel: str, extrapolate: str) -> None:
    """One line of ours, as JSON."""
    body = read_body(shipped("geometry") / "spheroid_example" / "body.toml")
    body = replace(body, shape=spheroid(), reference_point=np.zeros(3))
    if kernel == "strip":
        start = time.perf_counter()
        found, count = strip.added_mass(body, 1.0, {"end_correction": extrapolate}), 0
    else:
        panel.added_mass(body, 1.0, {"panels": SMALL, "kernel": kernel, "extrapolate": extrapolate})
        start = time.perf_counter()
        chosen = {"panels": int(panels), "kernel": kernel, "extrapolate": extrapolate}
        found = panel.added_mass(body, 1.0, chosen)
        count = int(found.statements[0].split()[0].replace(",", ""))
    seconds = time.perf_counter() - start
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
    print(json.dumps({"matrix": found.matrix.tolist(), "seconds": seconds, "peak": peak, "count": count}))


def run(*command: str) -> dict:
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    return json.loads(done.stdout.splitlines()[-1])


def environment(folder: str) -> str:
    venv.create(folder, with_pip=True)
    python = str(Path(folder) / "bin" / "python")
    subprocess.run([python, "-m", "pip", "install", "-q", "capytaine"], check=True)
    return python


def line(name: str, count: int, found: dict) -> tuple[float, float, float]:
    surge, sway, pitch = errors(found["matrix"])
    worst = max(abs(surge), abs(sway), abs(pitch))
    size = f"{count:7,d}" if count else "      -"
    print(
        f"{name:36s}{size}{surge:+9.3f}{sway:+9.3f}{pitch:+9.3f}{found['seconds']:10.3f}{found['peak'] / 2**20:9.0f}",
        flush=True,
    )
    return worst, found["seconds"], found["peak"]


def compare(python: str) -> None:
    print(
        f"{'6:1 prolate spheroid':36s}{'panels':>7s}{'surge %':>9s}{'sway %':>9s}{'pitch %':>9s}{'s':>10s}{'MiB':>9s}"
    )
    theirs, ours = {}, {}
    with tempfile.TemporaryDirectory() as folder:
        for panels in THEIRS:
            mesh = meshed(spheroid(), panels)
            path = str(Path(folder) / "mesh.npz")
            np.savez(path, vertices=mesh.vertices, faces=mesh.faces)
            for method in ("indirect", "direct"):
                found = run(python, str(PEER), path, method)
                name = f"capytaine {found['capytaine']} {method}" + (" (default)" if method == "indirect" else "")
                theirs[method, panels] = line(name, len(mesh.faces), found)
    for kernel in ("numpy", "numba"):
        for panels in OURS if kernel == "numba" else OURS[:-1]:
            for extrapolate in ("no", "yes"):
                found = run(sys.executable, __file__, "--one", str(panels), kernel, extrapolate)
                name = f"coeflab panel, {kernel}" + (", extrapolated" if extrapolate == "yes" else ", one mesh")
                ours[kernel, extrapolate, panels] = line(name, found["count"], found)
    for correction in ("none", "lamb"):
        found = run(sys.executable, __file__, "--one", "0", "strip", correction)
        line(f"coeflab strip, end correction {correction}", 0, found)
    largest = THEIRS[-1]
    error, seconds, memory = theirs["direct", largest]
    print(f"at the error of capytaine direct on {largest:,} panels, {error:.2f} %, or below:")
    for kernel, target in (("numpy", 2), ("numba", 10)):
        least = min(s for (k, _, _), (e, s, _) in ours.items() if k == kernel and e <= error)
        print(f"  {kernel}: {seconds / least:6.0f} times faster (target: at least {target})")
        same = ours[kernel, "no", largest]
        print(
            f"  {kernel}, one mesh of {largest:,}: {seconds / same[1]:6.1f} times faster, "
            f"{same[2] / memory:.2f} of its memory (target: under 0.5)"
        )


def main() -> None:
    if sys.argv[1:2] == ["--one"]:
        one(*sys.argv[2:])
    elif len(sys.argv) > 1:
        compare(sys.argv[1])
    else:
        with tempfile.TemporaryDirectory() as folder:
            compare(environment(folder))


if __name__ == "__main__":
    main()
