"""The law as arrays beside the law term by term."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from coeflab.law.motion_law import BASE, MotionLaw
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


def law(**more: object) -> MotionLaw:
    """V^2 [0.3 + 2 clip(v/V, 0.1) |alpha|] as drag, V^-1 v|v|v r as N."""
    source = np.array([BASE.index(b) for b in ("v", "alpha", "v", "r")])
    arrays = {
        "source": source, "prime": np.array([1.0, 0, 0, 0]), "low": np.array([-0.1, *[-np.inf] * 3]),
        "high": np.array([0.1, *[np.inf] * 3]), "tabled": np.array([True, False, False, False]),
        "component": np.array([6, 6, 5]), "coefficient": np.array([0.3, 2.0, 0.7]), "speed_power": np.array([2, 2, -1]),
        "signed": np.array([[0, 0, 0, 0], [1, 0, 0, 0], [0, 0, 2, 1]]),
        "absolute": np.array([[0, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]]), "ideal": np.zeros((6, 6, 6)),
    }  # fmt: skip
    return MotionLaw(**(arrays | more))  # type: ignore[arg-type]


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
