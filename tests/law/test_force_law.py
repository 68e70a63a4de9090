"""The law as arrays beside the law term by term."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from coeflab.law.force_law import ForceLaw, ForceTerm, Reading
from coeflab.law.terms import Factor, Term
from coeflab.law.transforms import body_forces, incidence
from coeflab.motion.vehicle import vehicle
from coeflab.vehicle.force_law import force_law
from tests.formats.files import control_force, full
from tests.formats.massed import with_mass


def moving(n: int = 12) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(1)
    nu = rng.normal(size=(n, 6)) * np.array([0.2, 0.4, 0.4, 0.3, 0.3, 0.3])
    nu[:, 0] += 2.0
    return nu, 0.2 * rng.normal(size=(n, 3))


def term(component: str, factors: tuple[Factor, ...], coefficient: float, power: int, **readings: Reading) -> ForceTerm:
    return ForceTerm(
        "made", component, Term(factors), coefficient, power, 1.0, "table", readings=tuple(readings.items())
    )


def law(**more: Any) -> ForceLaw:
    """V^2 [0.3 + 2 clip(v/V, 0.1) |alpha|] as drag, V^-1 v|v|v r as N."""
    odd = (Factor("v", 2), Factor("v", 1, absolute=True), Factor("r", 1))
    terms = (
        term("D", (), 0.3, 2),
        term("D", (Factor("v", 1), Factor("alpha", 1, absolute=True)), 2.0, 2, v=Reading(1.0, -0.1, 0.1, True)),
        term("N", odd, 0.7, -1),
    )
    return ForceLaw(**{"terms": terms, "ideal": np.zeros((6, 6, 6)), **more})


@pytest.mark.parametrize("seed", [2, 7])
def test_every_kind_of_term_of_a_parameter_file(seed: int) -> None:
    file, (nu, controls) = with_mass(full(seed)), moving()
    expected = force_law(file).force(nu) + control_force(file, nu, controls)
    np.testing.assert_allclose(vehicle(file).force(nu, controls), expected, rtol=1e-11, atol=1e-11)


def test_held_variables_wind_axes_and_negative_powers() -> None:
    nu, controls = moving()
    speed = np.linalg.norm(nu[:, :3], axis=1)
    alpha, beta = incidence(*nu[:, :3].T)
    drag = speed**2 * (0.3 + 2.0 * np.clip(nu[:, 1] / speed, -0.1, 0.1) * np.abs(alpha))
    expected = np.zeros((len(nu), 6))
    expected[:, :3] = np.column_stack(body_forces(alpha, beta, drag, np.zeros_like(drag), np.zeros_like(drag)))
    expected[:, 5] = 0.7 / speed * nu[:, 1] ** 2 * np.abs(nu[:, 1]) * nu[:, 5]
    np.testing.assert_allclose(law().force(nu, controls), expected, rtol=1e-12, atol=1e-14)
    np.testing.assert_array_equal(law().held(nu, controls), np.abs(nu[:, 1] / speed) > 0.1)


def test_members_have_rows_of_their_own() -> None:
    nu, controls = moving()
    rows = law().coefficient * np.linspace(0.5, 2.0, len(nu))[:, None]
    together = law(coefficient=rows).force(nu, controls)
    for k in range(len(nu)):
        np.testing.assert_allclose(
            together[k], replace(law(), coefficient=rows[k]).force(nu[k : k + 1], controls[k : k + 1])[0]
        )


def test_at_rest_there_is_no_force_and_no_fault() -> None:
    force = law().force(np.zeros((1, 6)), np.zeros((1, 3)))
    np.testing.assert_array_equal(force, 0.0)
