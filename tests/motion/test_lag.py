"""Thrusters that follow their commands with a lag: `simulate`, its linear model and what is written to simulators."""

from __future__ import annotations

import ctypes
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
import scipy.linalg

from coeflab.formats.c import write as c
from coeflab.formats.c_program.program import name_of
from coeflab.formats.export import export
from coeflab.formats.python_vehicle_simulator import write as pvs
from coeflab.motion.ensemble import alone
from coeflab.motion.manoeuvre import Manoeuvre, Phase
from coeflab.motion.marching import march, march_by_tolerance
from coeflab.motion.rates_of_one import rates_of_one
from coeflab.motion.trim.linear_model import linear_model
from coeflab.motion.trim.trim import trim
from coeflab.motion.vehicle import vehicle
from coeflab.vehicle.parameter_file import ParameterFile, read_parameter_file
from coeflab.vehicle.parameter_parts import ParameterThruster
from tests.formats.test_coded_thrusters import file

LAG = 0.4


def late() -> ParameterFile:
    p = file()
    left, turning = p.thrusters
    return p.model_copy(update={"thrusters": (left.model_copy(update={"lag": LAG}), turning)})


def plan() -> Manoeuvre:
    """Through the dead zone of the left one."""
    phases = (Phase("ahead", {"left": 50.0, "turning": 2.0}, 1.0), Phase("back", {"left": -60.0}, 1.0))
    return Manoeuvre("reversal", phases, np.array([1.0, 0, 0, 0, 0, 0]), orders={"left": 30.0})


def by_hand(p: ParameterFile) -> np.ndarray:
    """Runge and Kutta's method with the actual command as one state more, small steps."""
    v = vehicle(p)
    one = rates_of_one(alone(v).dynamics(np.zeros(3)))
    y, h = np.zeros(15), 1e-3
    y[3], y[7], y[14] = 1.0, 1.0, 30.0

    def rate(y: np.ndarray, order: float) -> np.ndarray:
        wrench = v.wrench({"left": y[14], "turning": 2.0})
        return np.array([*one(y[:14].tolist(), [0.0] * 3, wrench.tolist()), (order - y[14]) / LAG])

    for k in range(2000):
        order = 50.0 if k < 1000 else -60.0
        k1 = rate(y, order)
        k2 = rate(y + h / 2 * k1, order)
        k3 = rate(y + h / 2 * k2, order)
        y = y + h / 6 * (k1 + 2 * k2 + 2 * k3 + rate(y + h * k3, order))
    return y


def test_simulate_moves_as_with_a_state_more() -> None:
    due, v = by_hand(late()), vehicle(late())
    found = march_by_tolerance(v, plan(), 0.1).trajectory()
    np.testing.assert_allclose(found.velocity[-1], due[7:13], atol=2e-5)
    assert found.controls["left"][-1] == pytest.approx(due[14], rel=1e-9)
    np.testing.assert_allclose(march(v, plan(), 0.0, 0.1, "numpy").trajectory().velocity[-1], due[7:13], atol=1e-4)
    assert abs(march_by_tolerance(vehicle(file()), plan()).trajectory().velocity[-1, 0] - due[7]) > 1e-3


def test_the_class_goes_to_its_command_by_the_lag() -> None:
    held: dict[str, object] = {}
    exec(pvs.render(late())["driven_one.py"], held)
    v = held["driven_one"]()  # type: ignore[operator]
    actual = v.turned(np.array([0, 0, 0, 0, 30.0, 1.0]), np.array([0, 0, 0, 0, 50.0, 2.0]), 0.1)
    assert actual[4:].tolist() == pytest.approx([50.0 - 20.0 * np.exp(-0.1 / LAG), 2.0])


@pytest.mark.skipif(shutil.which("gcc") is None, reason="no gcc")
def test_the_program_goes_to_its_command_by_the_lag(tmp_path: Path) -> None:
    p = late()
    for name, content in c.render(p).items():
        (tmp_path / name).write_bytes(content)
    name = name_of(p)
    subprocess.run(
        ["gcc", "-std=c99", "-shared", "-fPIC", f"{name}.c", "-o", "one.so", "-lm"], cwd=tmp_path, check=True
    )
    actual = (ctypes.c_double * 2)(30.0, 1.0)
    spin = getattr(ctypes.CDLL(str(tmp_path / "one.so")), f"{name}_spin")
    spin((ctypes.c_double * 2)(50.0, 2.0), ctypes.c_double(0.1), actual)
    assert list(actual) == pytest.approx([50.0 - 20.0 * np.exp(-0.1 / LAG), 2.0])


@pytest.mark.parametrize(
    ("target", "lost"), [("mss", 1), ("xdyn", 1), ("gazebo", 1), ("c", 0), ("fmi", 0), ("python_vehicle_simulator", 0)]
)
def test_a_lag_that_a_target_has_no_place_for_is_a_loss(target: str, lost: int) -> None:
    loss = export(late(), target).loss
    assert len([x for x in loss.lost if x.what == "lag of left: commands are taken at once"]) == lost


def test_the_linear_model_moves_as_simulate() -> None:
    """One newton more of a thruster with a lag, ahead of REMUS 100: surge after a second by exp(A t) and by `simulate`."""
    main = {"name": "main", "position": (0, 0, 0), "direction": (1, 0, 0), "lag": LAG, "curve": {
        "command": "thrust", "unit": "N", "segments": [{"low": -99.0, "high": 99.0, "coefficients": [0.0, 1.0]}]}}  # fmt: skip
    remus = read_parameter_file(Path("remus100")).model_copy(
        update={"thrusters": (ParameterThruster.model_validate(main),)}
    )
    v = vehicle(remus, ("u", "v", "r"))
    model = linear_model(trim(v, {"u": 1.5, "yaw_rate": 0.0}, starts=2))
    states, commands = [s.name for s in model.states], [c.name for c in model.commands]
    assert states[-1] == "main_lagged"
    k, step = commands.index("main"), 1e-3
    whole = np.zeros((len(states) + 1, len(states) + 1))
    whole[:-1, :-1], whole[:-1, -1] = model.a.matrix, model.b.matrix[:, k] * step
    due = scipy.linalg.expm(whole)[:-1, -1]
    steady = model.commands[k].value
    start = np.array([1.5, 0, 0, 0, 0, 0])
    moved = march_by_tolerance(
        v, Manoeuvre("step", (Phase("on", {"main": steady + step}, 1.0),), start, orders={"main": steady})
    ).trajectory()
    assert due[0] > 0.0
    assert moved.velocity[-1, 0] - 1.5 == pytest.approx(due[0], rel=2e-3)
    assert moved.controls["main"][-1] - steady == pytest.approx(due[-1], rel=1e-6)
    # What the thruster does already, and not its command: a column of A. Every state is an output, no command is.
    plan = Manoeuvre("spun down", (Phase("off", {"main": steady}, 1.0),), start, orders={"main": steady + step})
    moved = march_by_tolerance(v, plan).trajectory()
    later = scipy.linalg.expm(model.A)[:, -1] * step
    assert moved.velocity[-1, 0] - 1.5 == pytest.approx(later[0], rel=2e-3)
    assert moved.controls["main"][-1] - steady == pytest.approx(later[-1], rel=1e-6)
    assert np.array_equal(model.C, np.eye(len(states)))
    assert not model.D.any()
    assert model.D.shape == model.B.shape
