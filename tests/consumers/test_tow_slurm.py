"""A real OpenFOAM under a real Slurm: the rows of a tow do not depend on who ran it, and a dead node costs little of a run."""

from __future__ import annotations

import re
import shutil
import time
from dataclasses import dataclass
from pathlib import Path

import pytest

from coeflab.core.files import shipped
from coeflab.tank import tow as room
from coeflab.tank.collected import collected
from coeflab.tank.folder import CAMPAIGN
from coeflab.tank.jobs import JobState, progress
from coeflab.tank.tow import Tow
from tests.consumers.one_node_slurm import MISSING, OneNodeSlurm

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(bool(MISSING), reason=f"{', '.join(MISSING)} not installed: apt-get install slurm-wlm munge"),
    pytest.mark.skipif(
        shutil.which("simpleFoam") is None, reason="OpenFOAM is not installed: apt-get install openfoam"
    ),
]
TANK = """
[tank]
solver = "openfoam"
[conditions]
speed = "1 m/s"
density = 998.0
viscosity = 1e-2
[matrix]
drift = ["4 deg"]
attack = []
yaw = []
[solver.openfoam]
turbulence = "laminar"
wall = "none"
cells_per_length = 36
cells_per_chord = 10
iterations = 250
checkpoint = 10
[runner.slurm]
at_once = 1                          # the straight run has ended before the other one begins
"""


def opened(folder: Path, runner: str) -> Tow:
    folder.mkdir(exist_ok=True)
    matrix = folder / "tank.toml"
    matrix.write_text(TANK)
    tank, body = room.read(shipped("geometry") / "finned_spheroid", matrix, runner=runner)
    return room.laid_out(tank, body, folder, matrix)


def rows(tow: Tow) -> dict[str, dict[str, str]]:
    """Of the drift table, by condition and column."""
    collected(tow, fitted=False)
    lines = (tow.folder / CAMPAIGN / "drift.csv").read_text().splitlines()
    table = [line.split(",") for line in lines if not line.startswith("#")]
    return {row[0]: dict(zip(table[0], row)) for row in table[1:]}


@dataclass
class Death:
    """Of the node, once a run has written fields; it is back after some seconds."""

    cluster: OneNodeSlurm
    run: Path
    at: float = 0.0
    back: bool = False

    def look(self) -> None:
        if not self.at and any(self.run.glob("[1-9]*")):
            self.cluster.kill_node()
            self.at = time.monotonic()
        if self.at and not self.back and time.monotonic() - self.at > 4.5:
            self.cluster.start_node()
            self.back = True


def test_rows_are_the_same_under_slurm_and_a_run_goes_on_when_its_node_is_back(
    cluster: OneNodeSlurm, tmp_path: Path
) -> None:
    local = opened(tmp_path / "local", "local")
    room.carried_out(local, 2, lambda: None)
    shutil.copytree(local.folder, tmp_path / "slurm", symlinks=True)
    for run in ("straight", "drift+4"):
        shutil.rmtree(tmp_path / "slurm" / run)
    tow = opened(tmp_path / "slurm", "slurm")
    assert [kept.state for kept in room.reuse(tow)] == [JobState.FINISHED, JobState.WAITING, JobState.WAITING]

    room.carried_out(tow, 0, Death(cluster, tow.folder / "drift+4").look)
    ours, theirs = rows(tow), rows(local)
    assert ours["straight"] == theirs["straight"]
    run = progress(tow.of["drift+4"])
    assert run.state is JobState.FINISHED
    assert run.resumed_from >= 10.0
    first = re.search(r"^Time = (\d+)", (tow.folder / "drift+4" / "log.simpleFoam").read_text(), re.MULTILINE)
    assert float(first[1]) == run.resumed_from + 1.0
    for name in ("Y", "N"):
        one, other = ours["drift+4"], theirs["drift+4"]
        column = next(key for key in one if key.split()[0] == name)
        error = next(float(value) for key, value in one.items() if key.split()[0] == f"se_{name}")
        assert abs(float(one[column]) - float(other[column])) <= error
