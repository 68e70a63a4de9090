"""Vehicles that are estimated from their shape alone, a body.toml and three meshes, in the simulators themselves."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from coeflab.bodies.readers import read_body
from coeflab.bodies.simplify.source import subject
from coeflab.core.files import shipped
from coeflab.formats.export import export
from coeflab.study.estimated_vehicle import asked, from_shape
from coeflab.study.study import Plan
from coeflab.vehicle.parameter_file import ParameterFile
from tests.bodies.twelve import TWELVE
from tests.consumers.lxdyn_environment import PYTHON
from tests.consumers.test_lxdyn import in_xdyn

pytestmark = pytest.mark.slow
SECONDS = 5.0
FINNED, MESHES = "finned_spheroid", ("torpedo", "submarine", "frame_rov")


def of_finned_spheroid() -> ParameterFile:
    body = read_body(shipped("geometry") / FINNED / "body.toml")
    found = from_shape(Plan("finned", "Finned spheroid", (), method="strip:lamb"), body)
    assert [m.manoeuvre.name for m in found.manoeuvres] == ["turning_circle", "zigzag"]
    return next(iter(found.parameter_files.values()))


def of_mesh(name: str, folder: Path) -> ParameterFile:
    """As ``coeflab vehicle NAME.stl --unit m --axes FLU --method strip:lamb`` has it: strips are quick, and enough to load."""
    mesh = TWELVE[name]()
    mesh.merge_vertices()
    mesh.export(folder / f"{name}.stl")
    body = subject(str(folder / f"{name}.stl"), "m", "FLU")
    plan, stated = asked(body, method="strip:lamb")
    found = from_shape(plan, body, stated)
    assert [m.manoeuvre.name for m in found.manoeuvres] == ["stop"]
    return next(iter(found.parameter_files.values()))


@pytest.fixture(scope="module", params=[FINNED, *MESHES])
def estimated(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> ParameterFile:
    folder = tmp_path_factory.mktemp(request.param)
    made = of_finned_spheroid() if request.param == FINNED else of_mesh(request.param, folder)
    return made.model_copy(update={"name": "file"})


def written(estimated: ParameterFile, target: str, folder: Path, suffix: str) -> Path:
    for name, content in export(estimated, target, accept_loss=True).files.items():
        (folder / name).write_bytes(content)
    return next(folder.glob(f"*{suffix}"))


def test_mujoco_loads_it(estimated: ParameterFile, tmp_path: Path) -> None:
    """And it is damped there: slower after some seconds, and ahead of where it began."""
    mujoco = pytest.importorskip("mujoco", reason="MuJoCo is not installed (dependency group test)")
    model = mujoco.MjModel.from_xml_path(str(written(estimated, "mujoco", tmp_path, ".xml")))
    data = mujoco.MjData(model)
    assert np.isclose(model.body_mass.sum(), estimated.mass.mass)
    data.qvel[0] = speed = estimated.conditions.speed
    mujoco.mj_step(model, data, round(SECONDS / model.opt.timestep))
    assert np.all(np.isfinite(data.qpos))
    assert 0.0 < data.qpos[0] < SECONDS * speed
    assert 0.0 < np.linalg.norm(data.qvel[:3]) < speed


def test_fmpy_runs_it(estimated: ParameterFile, tmp_path: Path) -> None:
    fmpy = pytest.importorskip("fmpy", reason="FMPy is not installed (dependency group test)")
    path = str(written(estimated, "fmi", tmp_path, ".fmu"))
    found = fmpy.simulate_fmu(path, stop_time=SECONDS, step_size=0.1, output_interval=0.1)
    first, last = (np.array([found[f"velocity.{n}"][k] for n in "uvw"]) for k in (0, -1))
    assert 0.0 < np.linalg.norm(last) < first[0]
    if not any(c.symbol == "M0'" and c.value for c in estimated.coefficients):  # nothing turns it over
        assert last[0] > 0.0


@pytest.mark.skipif(
    not PYTHON.exists(), reason="lxdyn is not installed; run python3 tests/consumers/lxdyn_environment.py"
)
def test_xdyn_runs_it(estimated: ParameterFile, tmp_path: Path) -> None:
    rows, said = in_xdyn(tmp_path, written(estimated, "xdyn", tmp_path, ".yml").read_text(), SECONDS)
    assert len(rows), said
    assert np.all(np.isfinite(rows))
    assert rows[-1, 0] == pytest.approx(SECONDS)
