"""A vehicle that is estimated from its shape alone, in the simulators themselves."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from coeflab.bodies.readers import read_body
from coeflab.core.files import shipped
from coeflab.study.study import Plan
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.workbench.exports import export
from coeflab.workbench.vehicle import from_shape
from tests.consumers.lxdyn_environment import PYTHON
from tests.consumers.test_lxdyn import in_xdyn

pytestmark = pytest.mark.slow
SECONDS = 5.0


@pytest.fixture(scope="module")
def estimated() -> ParameterFile:
    body = read_body(shipped("geometry") / "finned_spheroid" / "body.toml")
    found = from_shape(Plan("finned", "Finned spheroid", (), method="strip:lamb"), body)
    assert [m.manoeuvre.name for m in found.manoeuvres] == ["turning_circle", "zigzag"]
    return next(iter(found.parameter_files.values())).model_copy(update={"name": "file"})


def written(estimated: ParameterFile, target: str, folder: Path, suffix: str) -> Path:
    for name, content in export(estimated, target).files.items():
        (folder / name).write_bytes(content)
    return next(folder.glob(f"*{suffix}"))


def test_mujoco_loads_it(estimated: ParameterFile, tmp_path: Path) -> None:
    mujoco = pytest.importorskip("mujoco", reason="MuJoCo is not installed (dependency group test)")
    model = mujoco.MjModel.from_xml_path(str(written(estimated, "mujoco", tmp_path, ".xml")))
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, 100)
    assert np.all(np.isfinite(data.qpos))
    assert estimated.mass is not None
    assert np.isclose(model.body_mass.sum(), estimated.mass.mass)


def test_fmpy_runs_it(estimated: ParameterFile, tmp_path: Path) -> None:
    fmpy = pytest.importorskip("fmpy", reason="FMPy is not installed (dependency group test)")
    path = str(written(estimated, "fmi", tmp_path, ".fmu"))
    found = fmpy.simulate_fmu(path, stop_time=SECONDS, step_size=0.1, output_interval=0.1)
    assert 0.0 < found["velocity.u"][-1] < found["velocity.u"][0]


@pytest.mark.skipif(
    not PYTHON.exists(), reason="lxdyn is not installed; run python3 tests/consumers/lxdyn_environment.py"
)
def test_xdyn_runs_it(estimated: ParameterFile, tmp_path: Path) -> None:
    rows, said = in_xdyn(tmp_path, written(estimated, "xdyn", tmp_path, ".yml").read_text(), SECONDS)
    assert len(rows), said
    assert np.all(np.isfinite(rows))
