"""What watching a run costs: a job of the tow tank against the bare simpleFoam on the same case.

The job is stopped on its plateau. Its processor time, less what simpleFoam states in the same log, is the overhead; two runs of
one solver differ by more than that on a shared machine. The bare solver then makes as many iterations of a copy of the case:
wall time. About 1.5 s of a job do not grow with the run, so that a run of half a minute pays 5 %, one of minutes 1 %. What a tow
takes besides its jobs (body, cases, campaign, fits, report) is printed by itself.
`python benchmarks/tow_overhead.py [CELLS_PER_LENGTH]`; needs OpenFOAM.
"""

from __future__ import annotations

import os

os.environ["OPENBLAS_NUM_THREADS"] = os.environ["OMP_NUM_THREADS"] = "1"

import json
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

TANK = """
[tank]
name = "overhead"
[conditions]
speed = "1 m/s"
density = 998.0
viscosity = 1e-3
[matrix]
drift = ["4 deg", "8 deg", "12 deg"]
attack = []
yaw = []
[solver.openfoam]
wall = "none"
turbulence = "laminar"
cells_per_length = {cells}
cells_per_chord = 12
iterations = 400
"""
RUN = "drift+8"
TARGET = 0.03


def timed(*command: str, cwd: Path) -> tuple[float, float]:
    """Wall and processor seconds of a command with all its children; its output goes to a file beside."""
    before, began = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
    with (cwd / "log.benchmark").open("ab") as log:
        done = subprocess.run(command, cwd=cwd, stdout=log, stderr=log, check=False)
    wall, after = time.monotonic() - began, resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode > 1:
        sys.exit(f"{' '.join(command)}: exit code {done.returncode}, {cwd / 'log.benchmark'}")
    return wall, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main() -> None:
    """Print both sides and their ratio."""
    cells = float(sys.argv[1]) if len(sys.argv) > 1 else 200.0
    coeflab = str(Path(sys.executable).with_name("coeflab"))
    with tempfile.TemporaryDirectory(prefix="coeflab_overhead_") as made:
        folder = Path(made)
        (folder / "tank.toml").write_text(TANK.format(cells=cells))
        laid_out = timed(
            coeflab, "tow", "finned_spheroid", "--matrix", "tank.toml", "--out", "x", "--dry-run", cwd=folder
        )
        job = (sys.executable, "-m", "coeflab.tank.job")
        (mesh,) = (folder / "x" / "mesh").iterdir()
        timed(*job, str(mesh), cwd=folder)
        count = json.loads((mesh / "mesh.json").read_text())["cells"]
        bare = folder / "bare"
        shutil.copytree(folder / "x" / RUN, bare, symlinks=True)
        wall, own = timed(*job, str(folder / "x" / RUN), cwd=folder)
        said = re.findall(r"ExecutionTime = ([\d.]+) s", (folder / "x" / RUN / "log.simpleFoam").read_text())
        solver = float(said[-1])
        made_iterations = int(json.loads((folder / "x" / RUN / "state.json").read_text())["iteration"])
        for link in (p for p in (bare / "constant").iterdir() if p.is_symlink()):
            target = (folder / "x" / RUN / "constant" / link.name).resolve()
            link.unlink()
            link.symlink_to(target)
        control = bare / "system" / "controlDict"
        control.write_text(re.sub(r"(?m)^endTime\s.*$", f"endTime {made_iterations};", control.read_text()))
        environment = () if os.environ.get("WM_PROJECT_DIR") else ("env", "WM_PROJECT_DIR=/usr/share/openfoam")
        plain_wall, plain = timed(*environment, "simpleFoam", cwd=bare)
        collected = timed(coeflab, "tow", "x", "--collect", cwd=folder)
    print(f"{count} cells, {made_iterations} iterations: job {own:.1f} s of processor, {wall:.1f} s of wall;")
    print(f"bare simpleFoam {plain:.1f} s and {plain_wall:.1f} s")
    share = own / solver - 1.0
    print(f"simpleFoam within the job {solver:.1f} s of processor: overhead {own - solver:.2f} s, {100 * share:.2f} %")
    print(f"wall time of the job against the bare solver {100 * (wall / plain_wall - 1.0):+.1f} %")
    print(f"once a tow: {laid_out[1]:.1f} s of processor to lay it out, {collected[1]:.1f} s to collect")
    print(f"{'within' if share <= TARGET else 'MISSES'} the target of {100 * TARGET:g} %")


if __name__ == "__main__":
    main()
