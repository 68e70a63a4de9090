"""A spheroid of two patches in a mesh of blocks, and its tank: what tests of the cases of OpenFOAM run on."""

from __future__ import annotations

import os
import re
import subprocess
from pathlib import Path
from typing import Any, cast

import numpy as np

from coeflab.bodies.closed_forms.ellipsoid import ellipsoid_added_mass
from coeflab.core.axes import Datum
from coeflab.law.scaling import Conditions, Scaling
from coeflab.tank.jobs import Job
from coeflab.tank.tank import Tank
from coeflab.tank.test_matrix import Half, Kind, TowCondition
from coeflab.tank.towed_body import TowedBody

BLOCKS = Path(__file__).parents[1] / "consumers/openfoam_case/system/blockMeshDict"
LENGTH, DIAMETER, DENSITY = 4.0, 1.0, 1000.0
SCALE = "(2 0.5 0.5)"
AFT = "(0 4 7 3)"  # of the blocks' inner faces, the one towards -x
CONTROL = """FoamFile { version 2.0; format ascii; class dictionary; object controlDict; }
application simpleFoam; startFrom startTime; startTime 0; stopAt endTime; endTime 1; deltaT 1; writeControl timeStep;
writeInterval 1; writeFormat binary; writePrecision 12; runTimeModifiable false;
"""
SCHEMES = """FoamFile { version 2.0; format ascii; class dictionary; object NAME; }
ddtSchemes {} gradSchemes {} divSchemes {} laplacianSchemes {} interpolationSchemes {} snGradSchemes {}
"""
HALF = """FoamFile { version 2.0; format ascii; class dictionary; object topoSetDict; }
actions ({ name half; type cellSet; action new; source boxToCell; box (-1e9 -1e9 -1e9) (1e9 %s); });
"""


def run(folder: Path, *command: str) -> None:
    environment = {**os.environ, "WM_PROJECT_DIR": "/usr/share/openfoam", "OMP_NUM_THREADS": "1"}
    done = subprocess.run(
        command, cwd=folder, env=environment, capture_output=True, text=True, timeout=300, check=False
    )
    (folder / f"log.{command[0]}").write_text(done.stdout)
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr


def carried_out(job: Job) -> None:
    """The steps of a job, one after the other."""
    for step in job.steps:
        with (job.folder / f"log.{step.name}").open("w") as log:
            done = subprocess.run(step.command, cwd=job.folder, stdout=log, stderr=log, timeout=600, check=False)
        assert done.returncode == 0, (job.folder / f"log.{step.name}").read_text()[-2000:]


def meshed(folder: Path, half: Half = Half.WHOLE, cells: tuple[int, int] = (8, 14), scale: str = SCALE) -> Path:
    """The shell between a spheroid and one ten times as large, of patches hull, stern and far, and cut of a half."""
    across, out = cells
    text = BLOCKS.read_text().replace("(12 12 20)", f"({across} {across} {out})").replace("body", "hull")
    head, tail = text.split("boundary", 1)
    assert AFT in tail
    tail = tail.replace(AFT, "", 1).replace("(\n", f"(\n    stern {{ type wall; faces ({AFT}); }}\n", 1)
    (folder / "system").mkdir(parents=True)
    (folder / "constant").mkdir()
    (folder / "system/blockMeshDict").write_text(f"{head}boundary{tail}")
    (folder / "system/controlDict").write_text(CONTROL)
    for name in ("fvSchemes", "fvSolution"):
        (folder / "system" / name).write_text(SCHEMES.replace("NAME", name))
    run(folder, "blockMesh")
    run(folder, "transformPoints", "-scale", scale)
    if half:
        (folder / "system/topoSetDict").write_text(HALF % ("0 1e9" if half is Half.PORT else "1e9 0"))
        run(folder, "topoSet", "-constant")
        run(folder, "subsetMesh", "half", "-overwrite")
        boundary = folder / "constant/polyMesh/boundary"
        text = re.sub(r"oldInternalFaces(\s*\{\s*type\s+)\w+", r"cut\1symmetryPlane", boundary.read_text())
        assert "symmetryPlane" in text
        boundary.write_text(text)
    return folder


def surface() -> TowedBody:
    """An octahedron in place of the spheroid; it has no body.toml, which cases do not look at."""
    ends = 0.5 * np.diag([LENGTH, DIAMETER, DIAMETER])
    points = np.concatenate([ends, -ends])
    faces = np.array([[x, y, z] for x in (0, 3) for y in (1, 4) for z in (2, 5)])
    return TowedBody(cast("Any", None), points, faces, ("hull", "stern"), faces[:, 0] // 3, mirrors=(True, True, True))


def with_rudders() -> TowedBody:
    """Two more patches of a triangle each, above and below."""
    plain = surface()
    upper = np.array([[-1.9, 0.0, -0.3], [-1.7, 0.0, -0.6], [-1.5, 0.0, -0.3]])
    points = np.concatenate([plain.vertices, upper, upper * [1, 1, -1]])
    faces = np.concatenate([plain.faces, [[6, 7, 8], [9, 10, 11]]])
    patches = ("hull", "rudder_lower", "rudder_upper", "stern")
    patch = np.concatenate([3 * plain.patch, [2, 1]])
    return TowedBody(plain.body, points, faces, patches, patch, mirrors=(False, True, True))


def condition(name: str, velocity: Any, rates: Any = (0.0, 0.0, 0.0), **more: Any) -> TowCondition:
    return TowCondition(name, Kind.COMBINED, np.array(velocity, float), np.array(rates, float), **more)


def tank(*matrix: TowCondition, viscosity: float = 2e-3, **more: Any) -> Tank:
    """1 m/s at Re 2000, unless the viscosity is another."""
    given = {"turbulence": "laminar", "wall": "none", "simplec": False, "iterations": 400, **more.pop("options", {})}
    return Tank(
        "spheroid", "A spheroid in water", Path("body.toml"), Datum("centre", "the centre"), np.zeros(3),
        Scaling(LENGTH, "LOA"), Conditions(DENSITY, 1.0, viscosity), matrix, options=given, **more,
    )  # fmt: skip


def job_of(folder: Path) -> Job:
    """The job of a mesh that is there."""
    return Job(f"mesh/{folder.name}", folder, "openfoam", (), key=folder.name)


def added_mass() -> np.ndarray:
    """Diagonal of the spheroid's added mass by Lamb, kg and kg m^2."""
    return np.diag(ellipsoid_added_mass(np.array([LENGTH, DIAMETER, DIAMETER]) / 2.0, DENSITY))


def mesh_of(folder: Path, grid: str, half: Half) -> Job:
    """Of the grid and the half."""
    return job_of(folder / f"mesh/{grid}{'_' * bool(half)}{half.name.lower() * bool(half)}")


CELLS = 5376  # of the whole mesh
DRIFT, YAW = (0.99, -0.1, 0.0), (0.0, 0.0, 0.1)
MATRIX = (
    condition("straight", (1, 0, 0)),
    condition("drift", DRIFT),
    condition("drift_upper", DRIFT, half=Half.UPPER),
    condition("attack_port", (0.99, 0.0, 0.1), half=Half.PORT),
    condition("arm", (1, 0, 0), YAW),
    condition("arm_upper", (1, 0, 0), YAW, half=Half.UPPER),
    condition("combined", DRIFT, YAW),
    condition("hardly_turning", DRIFT, (0.0, 0.0, 1e-4)),
)
