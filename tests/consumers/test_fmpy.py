"""The FMU in a real FMI master, FMPy: its motion is that of our own integration of the same equations, its rates the vectors'."""

from __future__ import annotations

import ctypes
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from coeflab.core.finding import Severity
from coeflab.core.texts import words
from coeflab.formats.flat_law import flat_law
from coeflab.formats.fmi import write as fmi
from coeflab.law.rigid_body import rigid_body_force, rigid_body_inertia
from coeflab.law.symbols import CONTROLS, MOTIONS
from coeflab.motion.ensemble import alone
from coeflab.motion.rates_of_one import rates_of_one
from coeflab.motion.vehicle import vehicle
from coeflab.vehicle.conform import compared, vector_sets
from coeflab.vehicle.force_law import force_law
from coeflab.vehicle.parameter_file import ParameterFile
from tests.formats import files as made
from tests.formats.files import control_force
from tests.formats.massed import CENTRE, INERTIA, MASS, torpedo, with_mass
from tests.formats.of_a_vehicle import driven, floating, quaternion, restoring
from tests.rigid_motion import motion
from tests.vehicle.make_conformance import actual_commands

fmpy = pytest.importorskip("fmpy", reason="FMPy is not installed (dependency group test)")
SECONDS, STEP = 20.0, 0.1  # s
pytestmark = pytest.mark.slow


def unit(folder: Path, file: ParameterFile) -> str:
    ((name, content),) = fmi.built(fmi.render(file)).items()
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
    assert validate_fmu(unit(tmp_path, with_mass(made.named(made.HOSTILE[0])))) == []
    assert validate_fmu(unit(tmp_path, driven())) == []


def test_a_start_and_a_coefficient_are_set(tmp_path: Path) -> None:
    path = unit(tmp_path, torpedo())
    turned = simulated(path, 0.5, start__yaw=1.0, start__roll=0.2, start__pitch=-0.3, start__north=5.0)
    assert [turned[f"attitude.{n}"][0] for n in ("roll", "pitch", "yaw")] == pytest.approx([0.2, -0.3, 1.0], rel=1e-12)
    assert turned["position.north"][0] == 5.0
    plain, blunt = simulated(path, 0.5), simulated(path, 0.5, coefficient__X0=-4e-4)
    assert blunt["hydrodynamic.X"][0] == pytest.approx(2.0 * plain["hydrodynamic.X"][0])


def test_the_rates_are_those_of_the_conformance_vectors(tmp_path: Path) -> None:
    """By model exchange, at the states of the vectors."""
    from fmpy.fmi2 import FMU2Model

    for given in vector_sets():
        file = ParameterFile.model_validate_json(json.dumps(given.parameters)).model_copy(update={"name": given.name})
        if file.mass is None or given.name == "no_diagonal":  # what cannot move is no unit
            continue
        path = unit(tmp_path, file)
        described = fmpy.read_model_description(path)
        at = {v.name: v.valueReference for v in described.modelVariables}
        free = "".join(MOTIONS[k] for k in flat_law(file).free)
        model = FMU2Model(
            guid=described.guid, unzipDirectory=fmpy.extract(path, str(tmp_path / given.name)),
            modelIdentifier=described.modelExchange.modelIdentifier, instanceName="one",
        )  # fmt: skip
        model.instantiate()
        model.enterInitializationMode()
        model.exitInitializationMode()
        answers = []
        for s, v in zip(given.states, given.vectors, strict=True):
            if v["force"] is None or v.get("free", "uvwpqr") != free:
                answers.append({"force": v["force"], "acceleration": v["acceleration"]})
                continue
            delta, commands = s.get("delta", [0.0] * 3), actual_commands(file, s)
            inputs = {f"control.{c}": x for c, x in zip(CONTROLS, delta, strict=True)}
            inputs["external.X"] = commands.get("thrust", 0.0)
            for t in file.thrusters:
                inputs |= {
                    f"thruster.{t.name}": commands.get(t.name, 0.0),
                    f"tilt.{t.name}": commands.get(f"{t.name}.tilt", 0.0),
                }
            model.setReal([at[n] for n in inputs], list(inputs.values()))
            spins = [
                commands.get(t.name, 0.0) for t in file.thrusters if any(t.lag is not None for t in file.thrusters)
            ]
            state = (ctypes.c_double * (16 + len(spins)))(
                0, 0, 0, *s.get("attitude", [1, 0, 0, 0]), *s["nu"], *delta, *spins
            )
            model.setContinuousStates(state, 16 + len(spins))
            force = model.getReal([at[f"hydrodynamic.{c}"] for c in "XYZKMN"])
            answers.append({"force": force, "acceleration": model.getReal([at[f"der(velocity.{m})"] for m in MOTIONS])})
        model.terminate()
        model.freeInstance()
        (found,) = compared(given, answers)
        assert found.severity is Severity.PASS, words(found)


@pytest.mark.parametrize("kind", ["CoSimulation", "ModelExchange"])
def test_a_rudder_doublet_and_a_reversal_are_those_of_simulate(tmp_path: Path, kind: str) -> None:
    """Thrust by a thruster with a lag, rudder by its rate; +1 m/s to -1 m/s and back within 30 s."""
    seconds, lag = 30.0, 0.4
    file = driven()
    file = file.model_copy(update={"thrusters": (file.thrusters[0].model_copy(update={"lag": lag}),)})
    made = unit(tmp_path, file)
    t = np.arange(0.0, seconds + 0.05, 0.1)
    rudder = np.where((t >= 5) & (t < 9), 0.2, np.where((t >= 9) & (t < 13), -0.2, 0.0))
    duty = np.where(t < 5, 0.3, np.where(t < 18, -0.9, 0.9))
    rows = np.zeros(2 * len(t) - 1, dtype=[("time", float), ("control.dr", float), ("thruster.propeller", float)])
    for name, column in (("control.dr", rudder), ("thruster.propeller", duty)):  # both values at a step: a line else
        rows[name][::2], rows[name][1::2] = column, column[:-1]
    rows["time"][::2], rows["time"][1::2] = t, t[1:]
    if kind == "CoSimulation":
        rows = rows[::2]
    found = fmpy.simulate_fmu(
        made, stop_time=seconds, step_size=0.1 if kind == "CoSimulation" else 0.005, output_interval=0.1, fmi_type=kind,
        solver="Euler" if kind == "CoSimulation" else "CVode", input=rows, start_values={"start.u": 1.0},
    )  # fmt: skip
    moved, x, angle, out = vehicle(file), np.array([0, 0, 0, 1.0, 0, 0, 0, 1.0, 0, 0, 0, 0, 0, 0]), 0.0, []
    spin, full = float(duty[0]), moved.wrench({"propeller": 1.0})  # thrust is in proportion to the duty
    rate = rates_of_one(alone(moved).dynamics(np.zeros(3)))
    for k in range(len(t)):
        out.append(x[7:13])
        for _ in range(10):
            start = angle

            def rates(
                state: np.ndarray,
                after: float,
                start: float = start,
                k: int = k,
                spin: float = spin,
            ) -> np.ndarray:
                turned = np.clip(rudder[k], start - 0.2 * after, start + 0.2 * after)
                actual = duty[k] + (spin - duty[k]) * np.exp(-after / lag)
                return np.array(rate(state.tolist(), [float(turned), 0.0, 0.0], (actual * full).tolist()))

            a = rates(x, 0.0)
            b = rates(x + 0.005 * a, 0.005)
            d = rates(x + 0.005 * b, 0.005)
            x = x + 0.01 / 6 * (a + 2 * b + 2 * d + rates(x + 0.01 * d, 0.01))
            x[3:7] /= np.linalg.norm(x[3:7])
            angle = float(np.clip(rudder[k], start - 0.002, start + 0.002))
            spin = float(duty[k] + (spin - duty[k]) * np.exp(-0.01 / lag))
    ours, theirs = np.array(out), columns(found, "velocity", "uvwpqr")
    theirs = theirs[np.unique(np.round(found["time"], 6), return_index=True)[1]]  # at an event there are two
    assert ours[:, 0].min() < -0.5
    peak = np.abs(ours).max(axis=0)
    group = np.repeat([peak[:3].max(), peak[3:].max()], 3)
    limit = 1e-3
    assert np.max(np.abs(theirs - ours) / group) < limit


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
