"""Roots of straight motion against the characteristic polynomial and the criterion of Routh."""

from __future__ import annotations

import numpy as np
import pytest

from coeflab.core.errors import InputError
from coeflab.motion.root_locus import root_locus, roots_at
from coeflab.motion.vehicle import vehicle
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.stability import stability_index
from tests.motion.vehicles import DENSITY, INERTIA, LENGTH, MASS, SPEED, STABLE, UNSTABLE, made

Q = 0.5 * DENSITY * LENGTH**2
NOSE_UP = {**STABLE, "Mw": 6e-2}
HEIGHT = 0.02


def critical_speed(values: dict[str, float], height: float) -> float:
    """From a b = c of the cubic in (w, q, theta), whose terms go with U, U^2 and the restoring moment."""
    m, inertia = MASS, INERTIA[1, 1]
    zw, zq = Q * values["Zw"], Q * LENGTH * values["Zq"]
    mw, mq = Q * LENGTH * values["Mw"], Q * LENGTH**2 * values["Mq"]
    k = MASS * 9.81 * height / inertia
    alpha = -(zw / m + mq / inertia)
    beta = (zw * mq - (zq + m) * mw) / (m * inertia)
    gamma = -zw * k / m
    return float(np.sqrt((gamma / alpha - k) / beta))


def test_the_critical_speed_is_that_of_routh() -> None:
    expected = critical_speed(NOSE_UP, HEIGHT)
    assert 0.1 * SPEED < expected < 2.0 * SPEED
    found = root_locus(made(NOSE_UP, HEIGHT), "G_v")
    assert found.critical == pytest.approx(expected, rel=1e-4)
    assert found.is_restored
    slow, fast = found.speed < 0.99 * expected, found.speed > 1.01 * expected
    assert np.all(found.roots[slow, 0].real < 0.0)
    assert np.all(found.roots[fast, 0].real > 0.0)


def test_a_stable_vehicle_has_no_critical_speed() -> None:
    found = root_locus(made(STABLE, HEIGHT), "G_v")
    assert found.critical is None
    assert np.all(found.roots.real < 0.0)
    assert "No root" in found.statement


@pytest.mark.parametrize(("values", "sign"), [(STABLE, -1.0), (UNSTABLE, 1.0)])
def test_the_roots_agree_with_the_index_and_grow_with_speed(values: dict[str, float], sign: float) -> None:
    mass = MASS / (0.5 * DENSITY * LENGTH**3)
    index = stability_index(*(np.array(values[s]) for s in ("Yv", "Nv", "Yr", "Nr")), mass, 0.0)
    assert np.sign(index) == -sign
    found = root_locus(made(values), "G_h")
    assert np.all(np.sign(found.roots[:, 0].real) == sign)
    assert found.roots[:, 0] / found.speed == pytest.approx(found.at_speed[0] / SPEED, rel=1e-6)
    assert found.critical is None


def test_the_horizontal_roots_are_those_of_the_two_by_two_matrix() -> None:
    body = vehicle(made(), ("v", "r"))
    m, inertia, u = MASS, INERTIA[2, 2], 1.2
    matrix = u * np.array(
        [
            [Q * STABLE["Yv"] / m, (Q * LENGTH * STABLE["Yr"] - m) / m],
            [Q * LENGTH * STABLE["Nv"] / inertia, Q * LENGTH**2 * STABLE["Nr"] / inertia],
        ]
    )
    assert np.sort_complex(roots_at(body, "G_h", u, False)) == pytest.approx(
        np.sort_complex(np.linalg.eigvals(matrix).astype(complex)), rel=1e-6
    )


def test_without_hydrostatics_it_says_that_there_is_no_critical_speed() -> None:
    found = root_locus(made(NOSE_UP).model_copy(update={"hydrostatics": None}), "G_v")
    assert found.critical is None
    assert not found.is_restored
    assert found.roots.shape[1] == 2
    assert "no hydrostatics" in found.statement


def test_a_file_without_mass_is_refused() -> None:
    with pytest.raises(InputError, match="without mass"):
        root_locus(made().model_copy(update={"mass": None}), "G_h")


def with_u95(share: float) -> ParameterFile:
    """NOSE_UP in water, its four derivatives of the vertical plane independent, with such half-widths as shares of their sizes."""
    file = made({**NOSE_UP, "Zwdot": -2e-2, "Mqdot": -1e-3}, HEIGHT)
    symbols = ("Zw'", "Zq'", "Mw'", "Mq'")
    variances = [(share * NOSE_UP[s.removesuffix("'")] / 2.0) ** 2 for s in symbols]
    update = {"symbols": symbols, "matrix": tuple(map(tuple, np.diag(variances).tolist()))}
    return file.model_copy(update={"covariance": file.covariance.model_copy(update=update)})


def test_the_limits_of_the_critical_speed_are_those_of_its_derivatives() -> None:
    """Against first order, by the critical speed of each derivative moved alone."""
    share, file = 0.05, with_u95(0.05)
    found = root_locus(file, "G_v")
    assert found.critical is not None
    moved = []
    for symbol in ("Zw", "Zq", "Mw", "Mq"):
        larger = {**NOSE_UP, "Zwdot": -2e-2, "Mqdot": -1e-3, symbol: NOSE_UP[symbol] * (1.0 + 0.1 * share)}
        moved.append(10.0 * (root_locus(made(larger, HEIGHT), "G_v").critical - found.critical))
    half = float(np.linalg.norm(moved))
    low, high = found.limits
    assert (high - low) / 2.0 == pytest.approx(half, rel=0.1)
    assert (low + high) / 2.0 == pytest.approx(found.critical, abs=0.2 * half)


def test_a_critical_speed_that_some_draws_have_none_of_has_no_limits() -> None:
    found = root_locus(with_u95(3.0), "G_v")
    assert found.critical is not None
    assert 0.025 < np.mean(np.isnan(found.drawn)) < 1.0
    assert found.limits is None


def test_accelerations_without_an_added_mass_are_named() -> None:
    assert root_locus(made(NOSE_UP, HEIGHT), "G_v").lacking == ("Zwdot'", "Mqdot'")
    assert root_locus(made(NOSE_UP, HEIGHT), "G_v").drawn.size == 0
    assert root_locus(with_u95(0.05), "G_v").lacking == ()
