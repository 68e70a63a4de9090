"""A member is the vehicle of a parameter file that states the drawn values."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from coeflab.law.scaling import powers_of
from coeflab.motion.manoeuvre import UPRIGHT
from coeflab.motion.uncertainty.drawn_vehicles import drawn, unfelt
from coeflab.motion.uncertainty.draws import uncertain
from coeflab.motion.vehicle import vehicle
from coeflab.vehicle.parameter_file import ParameterFile
from tests.formats.massed import VALUES, torpedo, with_mass
from tests.motion.uncertain import uncertain_torpedo, with_uncertainty
from tests.vehicle.test_force_law import parameters

ACCELERATIONS = {
    "Xudot": -3e-4,
    "Yvdot": -5e-3,
    "Yrdot": 1e-4,
    "Nrdot": -4e-4,
    "Zwdot": -5e-3,
    "Mqdot": -4e-4,
    "Kpdot": -5e-5,
}


def accelerating(hull: bool) -> ParameterFile:
    """Acceleration derivatives beside a computed added mass, or alone."""
    file = with_mass(parameters({**VALUES, **ACCELERATIONS}))
    if hull:
        file = file.model_copy(update={"added_mass": torpedo().added_mass})
    symbols = {f"{s}'": 0.1 * abs(v) for s, v in {**VALUES, **ACCELERATIONS}.items()}
    return with_uncertainty(file, symbols, {})


def restated(file: ParameterFile, symbols: tuple[str, ...], deviation: np.ndarray) -> ParameterFile:
    by = dict(zip(symbols, deviation, strict=True))
    changed = tuple(
        replace(c, value=(c.value or 0.0) + by.get(c.symbol, 0.0), value_si=None) for c in file.coefficients
    )
    return file.model_copy(update={"coefficients": changed})


@pytest.mark.parametrize("hull", [False, True])
@pytest.mark.parametrize("accelerations", ["measured", "computed"])
def test_a_member_is_the_vehicle_of_the_drawn_file(hull: bool, accelerations: str) -> None:
    file = accelerating(hull)
    body = vehicle(file, accelerations=accelerations)
    varied = uncertain(file, [t.in_file for t in body.law.terms])
    deviations = varied.members(4, 1)
    ensemble = drawn(body, file, varied.symbols, deviations)
    rng = np.random.default_rng(3)
    nu, controls = rng.normal(0.0, 0.5, (20, 6)), rng.normal(0.0, 0.2, (20, 3))
    for i in range(4):
        wanted = vehicle(restated(file, varied.symbols, deviations[i]), accelerations=accelerations)
        np.testing.assert_allclose(ensemble.member(i).effective_mass, wanted.effective_mass, rtol=1e-12, atol=1e-12)
        np.testing.assert_allclose(
            ensemble.member(i).force(nu, controls), wanted.force(nu, controls), rtol=1e-10, atol=1e-10
        )


def test_a_coefficient_of_zero_is_drawn_too() -> None:
    file = with_mass(parameters({**VALUES, "Yvv": 0.0}))
    file = with_uncertainty(file, {"Yvv'": 0.02}, {})
    body = vehicle(file)
    varied = uncertain(file, [t.in_file for t in body.law.terms])
    found = drawn(body, file, varied.symbols, np.array([[0.03]])).member(0)
    nu = np.array([[1.5, 0.4, 0.0, 0.0, 0.0, 0.0]])
    change = (found.force(nu, np.zeros((1, 3))) - body.force(nu, np.zeros((1, 3))))[0]
    scale = 0.5 * body.density * body.length ** powers_of("Yvv'")[1]
    np.testing.assert_allclose(change, [0.0, 0.03 * scale * 0.4**2, 0.0, 0.0, 0.0, 0.0], atol=1e-12)


def test_what_is_unfelt_changes_no_acceleration() -> None:
    file = accelerating(hull=True)
    body = vehicle(file, free=("u", "v", "r"))
    varied = uncertain(file, [t.in_file for t in body.law.terms])
    still = unfelt(body, varied.symbols, {"dr"})
    assert {"Zw'", "Mq'", "Kp'", "Zwdot'", "Kpdot'"} <= still
    assert not {"Yv'", "Nr'", "Ndr'", "X0'", "Yrdot'", "Nrdot'", "Xudot'"} & still
    nu = np.array([[1.4, 0.3, 0.0, 0.0, 0.0, 0.2]])
    here = body.acceleration(nu, np.array([UPRIGHT]), np.array([[0.1, 0.0, 0.0]]), np.zeros(6))
    for k, symbol in enumerate(varied.symbols):
        deviations = np.zeros((1, len(varied.symbols)))
        deviations[0, k] = varied.deviation[k]
        member = drawn(body, file, varied.symbols, deviations).member(0)
        there = member.acceleration(nu, np.array([UPRIGHT]), np.array([[0.1, 0.0, 0.0]]), np.zeros(6))
        assert np.array_equal(here, there) == (symbol in still), symbol
    assert "Ydr'" in unfelt(body, varied.symbols, set())


def test_members_of_an_uncertain_torpedo_differ_only_where_it_is_uncertain() -> None:
    file = uncertain_torpedo()
    body = vehicle(file)
    varied = uncertain(file, [t.in_file for t in body.law.terms])
    ensemble = drawn(body, file, varied.symbols, varied.members(5, 1))
    moved = {
        t.in_file for t, column in zip(body.law.terms, ensemble.coefficients.T, strict=True) if np.ptp(column) > 0.0
    }
    assert moved == set(varied.symbols)
    assert ensemble.added is None
