"""The FMU in a real FMI master, FMPy: its motion is that of our own integration of the same equations."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from coeflab.formats.fmi import write as fmi
from coeflab.law.rigid_body import rigid_body_force, rigid_body_inertia
from coeflab.study.study import Study
from coeflab.vehicle.force_law import force_law
from coeflab.vehicle.parameter_file import ParameterFile
from tests.formats import files as made
from tests.formats.files import control_force
from tests.formats.massed import CENTRE, INERTIA, MASS, torpedo
from tests.formats.of_a_vehicle import floating, quaternion, restoring
from tests.rigid_motion import motion

fmpy = pytest.importorskip("fmpy", reason="FMPy is not installed (dependency group test)")
SECONDS, STEP = 20.0, 0.1  # s
pytestmark = pytest.mark.slow


def unit(folder: Path, file: ParameterFile) -> str:
    ((name, content),) = fmi.render(file).items()
    (folder / name).write_bytes(content)
    return str(folder / name)


def simulated(path: str, seconds: float = SECONDS, **start: float) -> Any:
    values = {name.replace("__", "."): value for name, value in start.items()}
    return fmpy.simulate_fmu(path, stop_time=seconds, step_size=STEP, output_interval=STEP, start_values=values)


def columns(result: Any, group: str, names: str | tuple[str, ...]) -> np.ndarray:
    return np.column_stack([result[f"{group}.{n}"] for n in names])


@pytest.mark.parametrize("rudder", [0.0, 0.15])
def test_twenty_seconds_are_our_own_integration(tmp_path: Path, rudder: float) -> None:
    file = torpedo()
    law, delta = force_law(file), np.array([[rudder, 0.0, 0.0]])
    thrust = np.array([0.8, 0.0, 0.0, 0.0, 0.0, 0.0])
    found = simulated(unit(tmp_path, file), control__dr=rudder, external__X=0.8)
    start = np.array([file.conditions.speed, 0, 0, 0, 0, 0])
    added = np.array(file.added_mass.matrix)
    ours = motion(
        MASS, CENTRE, INERTIA, added, lambda _, nu: law.force(nu) + control_force(file, nu, delta) + thrust, start, found["time"]
    )  # fmt: skip
    np.testing.assert_allclose(columns(found, "velocity", "uvwpqr"), ours.velocity, atol=1e-8)
    np.testing.assert_allclose(columns(found, "position", ("north", "east", "down")), ours.position, atol=1e-7)
    q0, q1, q2, q3 = ours.attitude.T
    yaw = np.arctan2(2.0 * (q0 * q3 + q1 * q2), 1.0 - 2.0 * (q2**2 + q3**2))
    np.testing.assert_allclose(found["attitude.yaw"], yaw, atol=1e-8)
    angles = np.repeat(delta, len(ours.velocity), axis=0)
    hydrodynamic = law.force(ours.velocity) + control_force(file, ours.velocity, angles)
    np.testing.assert_allclose(columns(found, "hydrodynamic", "XYZKMN"), hydrodynamic, atol=1e-5)


def test_it_is_a_valid_fmu(tmp_path: Path) -> None:
    from fmpy.validation import validate_fmu

    assert validate_fmu(unit(tmp_path, torpedo())) == []
    assert validate_fmu(unit(tmp_path, made.named(made.HOSTILE[0]))) == []


def test_a_start_and_a_coefficient_are_set(tmp_path: Path) -> None:
    path = unit(tmp_path, torpedo())
    turned = simulated(path, 0.5, start__yaw=1.0, start__roll=0.2, start__pitch=-0.3, start__north=5.0)
    assert [turned[f"attitude.{n}"][0] for n in ("roll", "pitch", "yaw")] == pytest.approx([0.2, -0.3, 1.0], rel=1e-12)
    assert turned["position.north"][0] == 5.0
    plain, blunt = simulated(path, 0.5), simulated(path, 0.5, coefficient__X0=-4e-4)
    assert blunt["hydrodynamic.X"][0] == pytest.approx(2.0 * plain["hydrodynamic.X"][0])


def test_suboff_starts_when_its_roll_inertia_is_given(tmp_path: Path, suboff: Study) -> None:
    path = unit(tmp_path, suboff.parameter_files["suboff_fully_appended"])
    with pytest.raises(fmpy.fmi1.FMICallException):
        simulated(path, 0.5)
    assert simulated(path, 0.5, mass__Ixx=20.0)["velocity.u"][-1] < 3.3439


def test_weight_and_buoyancy_are_those_of_our_own_integration(tmp_path: Path) -> None:
    """Heavy, with the centres apart, from an attitude that is not level: it sinks and swings."""
    file, seconds = floating(), 5.0
    law, inertia = force_law(file), rigid_body_inertia(MASS, CENTRE, INERTIA) + np.array(file.added_mass.matrix)
    found = simulated(unit(tmp_path, file), seconds, start__roll=0.3, start__pitch=-0.2, step=0.0025)

    def rates(_: float, state: np.ndarray) -> np.ndarray:
        q, nu = state[:4] / np.linalg.norm(state[:4]), state[4:]
        force = law.force(nu[None])[0] + restoring(file, q) - rigid_body_force(MASS, CENTRE, INERTIA, nu[None])[0]
        spin = [-q[1:] @ nu[3:], *(q[0] * nu[3:] + np.cross(q[1:], nu[3:]))]
        return np.concatenate([0.5 * np.array(spin), np.linalg.solve(inertia, force)])

    start = [*quaternion(0.3, -0.2), file.conditions.speed, 0.0, 0.0, 0.0, 0.0, 0.0]
    ours = solve_ivp(rates, (0.0, seconds), start, t_eval=found["time"], rtol=1e-10, atol=1e-12, max_step=0.1)
    np.testing.assert_allclose(columns(found, "velocity", "uvwpqr"), ours.y[4:].T, atol=1e-6)
    assert np.ptp(found["attitude.roll"]) > 0.1
