"""Potential parts of derivatives: the Munk moment and its like, primed, about any point."""

from __future__ import annotations

import numpy as np
import pytest

from coeflab.core.axes import Datum
from coeflab.law.added_mass import AddedMass, potential_part
from coeflab.law.coefficient import Coefficient, CoefficientSet, Status
from coeflab.law.rigid_body import ideal_force
from coeflab.law.scaling import Scaling

LENGTH = Scaling(4.0, "LOA")
DENSITY = 1000.0
HULL = AddedMass(np.diag([20.0, 600.0, 580.0, 1.0, 700.0, 720.0]), np.zeros(3), Datum("nose"), "hull", "ellipsoid")


def of(symbol: str, hull: AddedMass = HULL) -> float:
    found = potential_part(symbol, hull, LENGTH, DENSITY)
    assert found is not None
    return found


def test_in_acceleration_derivatives() -> None:
    """Conventions: Nv = Yvdot - Xudot, Yr = Xudot, Nr = Yrdot, Zq = -Xudot (primed, U = 1)."""
    hull = HULL.about(np.array([0.3, 0.0, 0.0]))
    dot = {s: hull.primed(s, LENGTH, DENSITY) for s in ("Xudot", "Yvdot", "Yrdot", "Zwdot", "Zqdot")}
    assert of("Nv'", hull) == pytest.approx(dot["Yvdot"] - dot["Xudot"])
    assert of("Mw", hull) == pytest.approx(dot["Xudot"] - dot["Zwdot"])
    assert of("Yr", hull) == pytest.approx(dot["Xudot"])
    assert of("Nr", hull) == pytest.approx(dot["Yrdot"])
    assert of("Zq", hull) == pytest.approx(-dot["Xudot"])
    assert of("Mq", hull) == pytest.approx(-dot["Zqdot"])
    assert of("Xvr", hull) == pytest.approx(-dot["Yvdot"])
    assert of("Xrr", hull) == pytest.approx(-dot["Yrdot"])
    assert of("Yv", hull) == pytest.approx(0.0, abs=1e-15)


def test_second_order_terms_sum_up_to_the_force() -> None:
    rng = np.random.default_rng(5)
    root = rng.normal(size=(6, 6))
    hull = AddedMass(root @ root.T, np.zeros(3), Datum("nose"), "hull", "any")
    nu = rng.normal(size=6)
    q, length = 0.5 * DENSITY, LENGTH.length
    for i, component in enumerate("XYZKMN"):
        total = 0.0
        for j, a in enumerate("uvwpqr"):
            for b in "uvwpqr"[j:]:
                k = "uvwpqr".index(b)
                power = (3 if component in "KMN" else 2) + (a in "pqr") + (b in "pqr")
                total += of(f"{component}{a}{b}", hull) * q * length**power * nu[j] * nu[k]
        assert total == pytest.approx(ideal_force(hull.matrix, nu[None])[0, i], rel=1e-9)


def test_moving_the_point_commutes_with_the_derivatives() -> None:
    """Potential parts about a new point are those about the old one, moved as derivatives are."""
    symbols = ("Yv", "Yr", "Nv", "Nr")
    coefficients = tuple(Coefficient(s, of(s), None, Status.SINGLE_ESTIMATOR, "hull") for s in symbols)
    among = CoefficientSet(coefficients, np.full((4, 4), np.nan), LENGTH, np.zeros(3), Datum("nose"), "hull")
    point = np.array([-0.8, 0.0, 0.0])
    for c in among.about(point).coefficients:
        assert c.value == pytest.approx(of(c.symbol, HULL.about(point)), rel=1e-12)


@pytest.mark.parametrize(("symbol", "expected"), [("Yv|v|", 0.0), ("Nvvv", 0.0), ("Ydr", None), ("Yvdot", None)])
def test_what_an_ideal_fluid_does_not_have(symbol: str, expected: float | None) -> None:
    assert potential_part(symbol, HULL, LENGTH, DENSITY) == expected
