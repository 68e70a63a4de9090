"""The vehicle class: read without running it, and run alone in a process of its own, it gives the force of the file."""

from __future__ import annotations

import ast
import itertools
import json
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from coeflab.core.wording import one_line
from coeflab.formats.export import export
from coeflab.formats.python_vehicle_simulator import write as pvs
from coeflab.law.rigid_body import ideal_force, rigid_body_inertia
from coeflab.law.transforms import skew
from coeflab.vehicle.force_law import force_law
from tests.formats import files as made
from tests.formats.massed import CENTRE, MASS, torpedo, with_mass
from tests.formats.massed import INERTIA as INERTIA_MATRIX
from tests.formats.of_a_vehicle import floating, quaternion, restoring

GOLDEN = Path(__file__).parent / "golden" / "python_vehicle_simulator.py.txt"
ALONE = """
import importlib.util, json, sys
import numpy as np
asked = json.load(sys.stdin)
found = importlib.util.spec_from_file_location("vehicle", asked["file"])
module = importlib.util.module_from_spec(found)
found.loader.exec_module(module)
strange = sorted({m.partition(".")[0] for m in sys.modules} & {"coeflab", "python_vehicle_simulator"})
vehicle = getattr(module, asked["name"])(**asked["arguments"])
out = {"strange": strange, "name": vehicle.name, "L": vehicle.L, "dimU": vehicle.dimU,
       "controls": vehicle.controls, "MA": vehicle.MA.tolist(), "said": vehicle.controlDescription}
out["force"] = [vehicle.hydrodynamics(np.array(n), d).tolist() for n, d in zip(asked["nu"], asked["delta"])]
eta, nu, u_actual, states = np.zeros(6), vehicle.nu, vehicle.u_actual, []
try:
    for k in range(asked["steps"]):  # the simulator's loop, in its order
        u_control = vehicle.stepInput(k * asked["step"])
        states.append([*nu, *u_control, *u_actual])
        nu, u_actual = vehicle.dynamics(eta, nu, u_actual, u_control, asked["step"])
except ValueError as why:
    out["refused"] = str(why)
out["states"] = np.array(states).tolist()
json.dump(out, sys.stdout)
"""
INERTIA = {"m": 900.0, "Ix": 30.0, "Iy": 260.0, "Iz": 270.0, "r_bg": [0.05, 0.01, 0.06], "r_bb": [0.05, 0.01, 0.0]}


def alone(folder: Path, file: object, **asked: object) -> dict:
    ((name, content),) = pvs.render(file).items()
    (folder / name).write_bytes(content)
    asked = {"nu": [], "delta": [], "arguments": {}, "steps": 0, "step": 0.01, **asked}
    asked |= {"file": str(folder / name), "name": name.removesuffix(".py")}
    done = subprocess.run(
        [sys.executable, "-I", "-c", ALONE], input=json.dumps(asked), capture_output=True, text=True, timeout=60,
        check=False, cwd=folder,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def test_golden() -> None:
    """Regenerate by hand: write pvs.render(plain()) to golden/python_vehicle_simulator.py.txt and read the difference."""
    assert pvs.render(made.plain()) == {"file.py": GOLDEN.read_bytes()}


@pytest.mark.parametrize("file", [made.full(1), made.full(2), made.plain(), made.at_rest()])
def test_its_force_is_the_files(file: object) -> None:
    nu = np.random.default_rng(5).normal(size=(50, 6))
    np.testing.assert_allclose(
        pvs.force(pvs.render(file), nu), force_law(file).force(nu), rtol=1e-12, atol=1e-9
    )  # fmt: skip


def test_the_munk_moment_is_counted_once() -> None:
    file, speed, beta = made.plain(), 2.0, 0.1
    v = speed * np.sin(beta)
    nu = np.array([[speed * np.cos(beta), v, 0.0, 0.0, 0.0, 0.0]])
    stated = 500.0 * 8.0 * (-1.4e-2 * speed * v - 1e-2 * v * abs(v) + 1e-3 * nu[0, 0] * v)
    assert pvs.force(pvs.render(file), nu)[0, 5] == pytest.approx(stated, rel=1e-12)


def test_nothing_is_lost() -> None:
    loss = export(made.full(3), "python_vehicle_simulator").loss
    assert loss.not_held == ()
    assert loss.relative.max() < 1e-9
    (said,) = loss.lost
    assert str(said).startswith("missing: mass and moments of inertia: the file has none; dynamics() asks for m")
    assert export(with_mass(made.full(3)), "python_vehicle_simulator").lossless


def test_the_class_alone_computes_the_same_force(tmp_path: Path) -> None:
    file, rng = made.full(4), np.random.default_rng(6)
    nu, delta = rng.normal(size=(20, 6)), rng.uniform(-0.4, 0.4, size=(20, 3))
    out = alone(tmp_path, file, nu=nu.tolist(), delta=delta.tolist())
    expected = force_law(file).force(nu) + made.control_force(file, nu, delta)
    np.testing.assert_allclose(out["force"], expected, rtol=1e-9, atol=1e-9 * np.abs(expected).max(axis=0).min())
    np.testing.assert_allclose(out["MA"], file.added_mass.matrix, rtol=1e-13, atol=1e-10)
    assert out["strange"] == []
    assert out["dimU"] == len(out["controls"]) == 4


def test_its_dynamics_are_newton_and_euler(tmp_path: Path) -> None:
    """One run of the simulator's loop against momentum balance written from scratch, step by step."""
    file, step = made.full(5), 0.01
    out = alone(tmp_path, file, arguments=INERTIA, steps=40, step=step)
    m, centre = INERTIA["m"], np.array(INERTIA["r_bg"])
    rigid = np.diag([m, m, m, 30.0, 260.0, 270.0])
    cross = np.array([np.cross(centre, e) for e in np.eye(3)]).T
    rigid[:3, 3:], rigid[3:, :3] = -m * cross, m * cross
    states = np.array(out["states"])
    righting = m * 9.81 * np.cross(centre - np.array(INERTIA["r_bb"]), [0.0, 0.0, 1.0])
    for before, after in itertools.pairwise(states):
        tau = (
            force_law(file).force(before[None, :6])[0]
            + made.control_force(file, before[None, :6], before[None, 10:13])[0]
        )
        tau += ideal_force(rigid, before[None, :6])[0]
        tau[0] += before[13]
        tau[3:] += righting
        rate = np.linalg.solve(rigid + np.array(file.added_mass.matrix), tau)
        np.testing.assert_allclose(after[:6], before[:6] + step * rate, rtol=1e-9, atol=1e-11)


def test_the_inertia_of_the_file_is_used(tmp_path: Path) -> None:
    """One step from U0: Euler's equations with the file's mass, centre and products."""
    file, step = torpedo(), 0.02
    out = alone(tmp_path, file, steps=6, step=step)
    arm, states = skew(CENTRE), np.array(out["states"])
    rigid = np.block([[MASS * np.eye(3), -MASS * arm], [MASS * arm, INERTIA_MATRIX]])
    before, after = states[4], states[5]
    assert np.abs(before[1:6]).max() > 1e-6
    tau = force_law(file).force(before[None, :6])[0] + ideal_force(rigid, before[None, :6])[0]
    tau[0] += before[13]
    rate = np.linalg.solve(rigid + np.array(file.added_mass.matrix), tau)
    np.testing.assert_allclose(after[:6], before[:6] + step * rate, rtol=1e-9, atol=1e-12)


def test_a_mass_that_is_not_known_is_asked_for(tmp_path: Path) -> None:
    out = alone(tmp_path, made.plain(), steps=1)
    assert "does not state m" in out["refused"]


def test_a_rotation_of_unknown_inertia_is_held(tmp_path: Path) -> None:
    out = alone(tmp_path, torpedo(), arguments={"Ix": None}, steps=6, step=0.02)
    states = np.array(out["states"])
    assert not states[:, 3].any()
    assert np.abs(states[-1, 4:6]).min() > 0.0


@pytest.mark.parametrize("name", made.HOSTILE)
def test_hostile_names_stay_names(name: str) -> None:
    (file, content), *others = pvs.render(made.named(name)).items()
    assert not others
    assert re.fullmatch(r"[A-Za-z]\w{0,62}\.py", file, re.ASCII)
    tree = ast.parse(content)
    kinds = [type(n).__name__ for n in tree.body]
    assert kinds == ["Import", "ImportFrom", "Assign", "ClassDef"] or kinds == [
        "Import",
        "Import",
        "Assign",
        "ClassDef",
    ]
    texts = [
        n.value.value for n in ast.walk(tree) if isinstance(n, ast.Assign) and ast.unparse(n.targets[0]) == "self.name"
    ]
    assert texts == [one_line(name)]
    nu = np.array([[1.0, 0.1, 0.0, 0.0, 0.0, 0.0]])
    np.testing.assert_array_equal(pvs.force({file: content}, nu), pvs.force(pvs.render(made.plain()), nu))


@pytest.mark.slow
def test_hostile_names_run(tmp_path: Path) -> None:
    for name in made.HOSTILE:
        assert alone(tmp_path, made.named(name))["name"] == one_line(name)


def test_weight_and_buoyancy_are_those_of_the_file() -> None:
    """dynamics() at two attitudes: its accelerations differ by those of the restoring forces."""
    namespace: dict = {}
    exec(next(iter(pvs.render(floating()).values())), namespace)
    vehicle, still = namespace["file"](), np.zeros(6)
    total = rigid_body_inertia(MASS, CENTRE, INERTIA_MATRIX) + vehicle.MA

    def force(roll: float, pitch: float) -> np.ndarray:
        eta = np.array([0.0, 0.0, 0.0, roll, pitch, 0.0])
        return total @ vehicle.dynamics(eta, still, np.zeros(4), np.zeros(4), 1.0)[0]

    for roll, pitch in ((0.0, 0.0), (0.4, -0.3), (-1.2, 0.8)):
        expected = restoring(floating(), quaternion(roll, pitch))
        np.testing.assert_allclose(force(roll, pitch), expected, rtol=1e-9, atol=1e-9)
