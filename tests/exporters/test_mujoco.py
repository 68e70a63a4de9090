"""The MuJoCo export: the real engine loads it and gives the force that its law says; what it cannot hold is said."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

from coeflab.core.errors import InputError
from coeflab.exporters import mujoco as exporter
from coeflab.model.force_law import force_law
from coeflab.model.parameter_file import ParameterFile
from coeflab.workbench.exports import export
from tests.exporters import files as made
from tests.exporters.massed import CENTRE, MASS, OWN, with_mass

GOLDEN = Path(__file__).parent / "golden" / "mujoco.xml"
FLU = np.array([1.0, -1.0, -1.0, 1.0, -1.0, -1.0])
LIKE_SUBOFF = {"X0": -1e-3, "Yv": -2.8e-2, "Yr": 5.2e-3, "Nv": -1.4e-2, "Nr": -4.4e-3, "Yv|v|": -5e-2}
SLENDER = replace(made.HULL, matrix=np.diag([2.0, 70.0, 68.0, 0.5, 15.0, 16.0]))


def slender(**values: float) -> ParameterFile:
    """A file whose Munk moment and side force put the centre within the hull."""
    return made.parameters({**LIKE_SUBOFF, **values}, SLENDER)


def engine() -> ModuleType:
    return pytest.importorskip("mujoco", reason="MuJoCo is not installed (dependency group test)")


def passive(file: ParameterFile, nu: np.ndarray) -> np.ndarray:
    """MuJoCo's fluid force in body axes, at random places and attitudes, without its balance of weight."""
    mujoco = engine()
    (content,) = exporter.render(file).values()
    model = mujoco.MjModel.from_xml_string(content.decode())
    data, rng, out = mujoco.MjData(model), np.random.default_rng(3), []
    model.body_gravcomp[:] = 0.0
    for velocity in nu * FLU:
        turn, matrix = rng.normal(size=4), np.zeros(9)
        data.qpos[:] = [*rng.normal(size=3), *(turn / np.linalg.norm(turn))]
        mujoco.mju_quat2Mat(matrix, data.qpos[3:])
        axes = matrix.reshape(3, 3)
        data.qvel[:] = [*(axes @ velocity[:3]), *velocity[3:]]
        mujoco.mj_forward(model, data)
        out.append(np.concatenate([axes.T @ data.qfrc_passive[:3], data.qfrc_passive[3:]]) * FLU)
    return np.array(out)


def test_golden() -> None:
    """Regenerate by hand: write exporter.render(plain()) to golden/mujoco.xml and read the difference."""
    assert exporter.render(made.plain()) == {"file.xml": GOLDEN.read_bytes()}


@pytest.mark.parametrize("file", [made.plain(), slender(), with_mass(slender())])
def test_the_real_engine_agrees(file: ParameterFile) -> None:
    nu = np.random.default_rng(4).normal(size=(40, 6))
    said = exporter.force(exporter.render(file), nu)
    np.testing.assert_allclose(passive(file, nu), said, atol=2e-6 * np.abs(said).max())


def test_what_it_takes_it_takes_exactly() -> None:
    """Resistance, side force, total yaw moment (Munk counted once) and the force of turning, near straight motion."""
    file = slender()
    speed, small = 1.5, 1e-6
    for at in ([0, 0], [small, 0], [0, small]):
        nu = np.array([[speed, at[0], 0.0, 0.0, 0.0, at[1]]])
        found, wanted = exporter.force(exporter.render(file), nu)[0], force_law(file).force(nu)[0]
        assert found[0] == pytest.approx(wanted[0], rel=1e-5)
        assert found[1] == pytest.approx(wanted[1], rel=1e-5, abs=1e-12)
        if not at[1]:
            assert found[5] == pytest.approx(wanted[5], rel=1e-5, abs=1e-12)
    rate = 0.25 * speed / 2.0
    moments = [exporter.force(exporter.render(file), np.array([[speed, 0, 0, 0, 0, s * rate]]))[0, 5] for s in (1, -1)]
    assert moments[0] == pytest.approx(-moments[1])
    assert moments[0] == pytest.approx(force_law(file).force(np.array([[speed, 0, 0, 0, 0, rate]]))[0, 5], rel=0.2)
    assert not {"X0", "Yv", "Nv", "Yr"} & set(exporter.not_held(file))


def test_the_loss_is_said() -> None:
    loss = export(made.plain(), "mujoco").loss
    assert loss is not None
    assert not loss.lossless
    assert "added inertia" in loss.not_held[0]
    assert {"Nv", "Nr", "Zw", "Yvvv"} <= set(loss.not_held)
    assert any("Nv is the Munk moment alone" in c for c in loss.changes)


def test_mass_and_inertia_are_those_of_the_file() -> None:
    mujoco = engine()
    (content,) = exporter.render(with_mass(slender())).values()
    model = mujoco.MjModel.from_xml_string(content.decode())
    assert model.body_mass[1] == MASS
    np.testing.assert_allclose(model.body_ipos[1], CENTRE * FLU[:3])
    turn = np.zeros(9)
    mujoco.mju_quat2Mat(turn, model.body_iquat[1])
    axes = turn.reshape(3, 3)
    np.testing.assert_allclose(
        axes @ np.diag(model.body_inertia[1]) @ axes.T * np.outer(FLU[:3], FLU[:3]), OWN, atol=1e-12
    )
    assert model.opt.density == 1000.0


def test_no_shape_without_added_mass() -> None:
    with pytest.raises(InputError, match="no added mass along x, y and z"):
        exporter.render(made.at_rest())


@pytest.mark.parametrize("name", made.HOSTILE)
def test_hostile_names_load(name: str) -> None:
    mujoco = engine()
    ((file, content),) = exporter.render(made.named(name)).items()
    assert "/" not in file
    assert mujoco.MjModel.from_xml_string(content.decode()).ngeom == 1
