"""Every reader of a body, with no mirror plane, one or two: its mesh has the surface of every patch."""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from coeflab.bodies.readers import read_body
from coeflab.core.files import shipped
from coeflab.law.scaling import Conditions, Scaling
from coeflab.tank.openfoam.mesh import mesh_job
from coeflab.tank.openfoam.mesh_report import mesh_ended, mesh_report
from coeflab.tank.openfoam.mesh_sizes import MeshKeys
from coeflab.tank.tank import Grid, Tank
from coeflab.tank.test_matrix import Half
from coeflab.tank.towed_body import TowedBody, stl, towed
from tests.tank.towed_bodies import X_FINS

WATER = Conditions(density=998.2, speed=1.5, viscosity=1e-6)

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(shutil.which("snappyHexMesh") is None, reason="OpenFOAM is not installed"),
]


def named(name: str) -> Callable[[Path], TowedBody]:
    return lambda _: towed(read_body(shipped("geometry") / name / "body.toml"), np.zeros(3), panels=20_000)


def written(text: str) -> Callable[[Path], TowedBody]:
    def body(folder: Path) -> TowedBody:
        (folder / "body.toml").write_text(text)
        return towed(read_body(folder / "body.toml"), np.zeros(3), panels=20_000)

    return body


def in_one_patch(folder: Path) -> TowedBody:
    """A mesh file of the body with X fins, which is all hull."""
    body = written(X_FINS)(folder)
    one = replace(body, patches=("hull",), patch=np.zeros(len(body.faces), np.int64))
    (folder / "body.stl").write_bytes(stl(one))
    head = X_FINS.split("[hull]", 1)[0].replace('"finned"', '"mesh"')
    particulars = "[particulars]\nlength = 2.0\n"
    return written(f'{head}{particulars}[mesh]\npath = "body.stl"\nunit = "m"\naxes = "FRD"\n')(folder)


ONE_FIN = X_FINS.rsplit("[[fin]]", 3)[0]


@pytest.mark.parametrize(
    ("made", "half", "length", "chord"),
    [
        pytest.param(named("suboff_aff8"), Half.WHOLE, 52, 20, id="groves, one plane with edges in it"),
        pytest.param(named("suboff_aff8"), Half.PORT, 52, 20, id="groves, its half"),
        pytest.param(named("myring_auv"), Half.WHOLE, 70, 16, id="myring, fins to port and starboard"),
        pytest.param(written(X_FINS), Half.WHOLE, 60, 20, id="finned, mirrored twice"),
        pytest.param(written(X_FINS), Half.UPPER, 60, 20, id="finned, mirrored once"),
        pytest.param(written(ONE_FIN), Half.WHOLE, 60, 20, id="finned, no plane"),
        pytest.param(in_one_patch, Half.WHOLE, 90, 20, id="mesh, one patch with X fins"),
        pytest.param(named("tow_spheroid"), Half.WHOLE, 60, 20, id="primitives"),
    ],
)
def test_any_body_is_meshed_with_every_patch_whole(
    made: Callable[[Path], TowedBody], half: Half, length: float, chord: float, tmp_path: Path
) -> None:
    body = made(tmp_path)
    tank = Tank("t", "t", Path("b"), None, np.zeros(3), Scaling(1.0, "length"), WATER, ())  # type: ignore[arg-type]
    keys = MeshKeys(cells_per_length=length, cells_per_chord=chord, ahead=0.7, behind=0.7, beside=0.7)
    job = mesh_job(tank, body, Grid("medium", 1.0), half, {}, keys, tmp_path, "1912")
    for step in job.steps:
        with (job.folder / f"log.{step.name}").open("w") as log:
            done = subprocess.run(step.command, cwd=job.folder, stdout=log, stderr=log, timeout=300, check=False)
        assert done.returncode == 0, (job.folder / f"log.{step.name}").read_text()[-2000:]
    remarks, why = mesh_ended(job)
    assert why == ""
    found = mesh_report(job.folder)
    assert found.volume == pytest.approx(1.0, abs=0.02)
    for patch, share in found.surface.items():
        assert share == pytest.approx(1.0, abs=0.03), (patch, share, remarks)
