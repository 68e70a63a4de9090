"""Turning ability and the critical speed of stern planes: against the steady answer of the linear model, and their U95 against draws."""

from __future__ import annotations

import numpy as np
import pytest

import coeflab as cf
from coeflab.vehicle.criteria import PLANES, REVERSAL, RUDDER, TURNING, criteria, reversal_speed, turning_ability
from coeflab.vehicle.parameter_file import ParameterFile
from tests.motion.trimmed import parameter_file

BELOW = 0.01  # m, of the centre of gravity
FINS = {
    "Yv": -80.0,
    "Nv": -20.0,
    "Yr": 25.0,
    "Nr": -45.0,
    "Ydr": 16.0,
    "Ndr": -7.0,
    "Zw": -80.0,
    "Mw": 20.0,
    "Zq": -25.0,
    "Mq": -45.0,
}


def submarine(**more: float) -> ParameterFile:
    si = FINS | {"Zds": -16.0, "Mds": -7.0, "X0": -4.0} | more
    return parameter_file(
        si, 60.0, (2.0, 9.0, 9.0), hydrostatics={"volume": 0.06, "centre_of_buoyancy": [0.0, 0.0, -BELOW]}
    )


def answer(file: ParameterFile, speed: float, free: str, command: str, **at: float) -> dict[str, float]:
    """Change of the steady state by a command, of the linear model without surge."""
    model = cf.read_vehicle(file).linear(speed=speed, free=free, **at)
    k = [c.name for c in model.commands].index(command)
    return dict(zip([s.name for s in model.states], -np.linalg.solve(model.A, model.B[:, k]), strict=True))


def test_turning_ability_is_the_steady_answer_to_the_rudder() -> None:
    file = submarine()
    found = {d.name: d for d in criteria(file)}[TURNING]
    turn = answer(file, 1.0, "vr", "dr", yaw_rate=0.0)["r"]  # length and speed are one, so that r is r'
    assert found.value == pytest.approx(turn, rel=1e-8)
    assert found.value < -0.1


def test_at_the_critical_speed_stern_planes_leave_the_depth_rate_at_zero() -> None:
    file = submarine()
    critical = {d.name: d for d in criteria(file)}[REVERSAL].value
    assert 0.1 < critical < 2.0
    sinking = []
    for speed in (0.8 * critical, critical, 1.2 * critical):
        small = answer(file, speed, "wq", "ds", pitch=0.0)
        sinking.append(small["w"] - speed * small["pitch"])
    assert sinking[1] == pytest.approx(0.0, abs=1e-8)
    assert sinking[0] < -1e-3 < 1e-3 < sinking[2]  # planes to dive (ds > 0 puts the bow down): slower it rises


def test_u95_is_that_of_the_draws() -> None:
    """Independent coefficients of 3 %: both half-widths against draws of another generator."""
    file = submarine()
    symbols = [*RUDDER, *PLANES]
    values = [float(file.coefficient(s).value) for s in symbols]
    matrix = np.diag((0.015 * np.array(values)) ** 2).tolist()
    own = file.model_copy(
        update={"covariance": file.covariance.model_copy(update={"symbols": tuple(symbols), "matrix": matrix})}
    )
    draws = np.array(values) * (1.0 + 0.015 * np.random.default_rng(5).standard_normal((40_000, len(values))))
    prime, moment = file.mass.mass_prime, file.mass.mass_moment_prime
    found = {d.name: d for d in criteria(own)}
    assert found[TURNING].result.monte_carlo == pytest.approx(
        np.ptp(np.percentile(turning_ability(draws[:, :6], prime, moment), [2.5, 97.5])) / 2, rel=0.05
    )
    assert found[TURNING].result.linear == pytest.approx(found[TURNING].result.monte_carlo, rel=0.25)
    spread = reversal_speed(draws[:, 6:], 1.0)
    share = np.ptp(np.percentile(spread, [2.5, 97.5])) / 2 / np.median(spread)
    assert found[REVERSAL].result.monte_carlo / found[REVERSAL].value == pytest.approx(share, rel=0.05)


def test_what_a_file_does_not_know_has_no_criterion() -> None:
    file = submarine()
    without = file.model_copy(update={"hydrostatics": None})
    assert [d.name for d in criteria(without)] == [TURNING]
    heavy = file.model_copy(update={"hydrostatics": file.hydrostatics.model_copy(update={"volume": 0.05})})
    assert [d.name for d in criteria(heavy)] == [TURNING]
    assert criteria(file.model_copy(update={"mass": None})) == ()
