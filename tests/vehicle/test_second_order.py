"""The second-order form: which terms have a place, and what remains beside a target that adds its own."""

from __future__ import annotations

import numpy as np
import pytest

from coeflab.core.axes import FLU
from coeflab.law.rigid_body import ideal_force, ideal_quadratics, momentum_quadratics
from coeflab.vehicle.force_law import force_law
from coeflab.vehicle.second_order import SecondOrder, products_once, second_order, slot
from tests.formats import of_second_order as second
from tests.vehicle.test_force_law import parameters


def velocities(n: int = 40) -> np.ndarray:
    return np.random.default_rng(8).normal(size=(n, 6))


def random_form(seed: int) -> SecondOrder:
    r = np.random.default_rng(seed)
    return SecondOrder(r.normal(size=(6, 6)), products_once(r.normal(size=(6, 6, 6))), r.normal(size=(6, 6, 6)))


@pytest.mark.parametrize(
    ("symbol", "place"),
    [
        ("Yv", ("absolute", 1, 0)), ("X0", ("absolute", 0, 0)), ("Z0", ("signed", 0, 0)), ("Xu|u|", ("absolute", 0, 0)),
        ("Xuu", ("signed", 0, 0)), ("Nur", ("signed", 0, 5)), ("Nru", ("signed", 0, 5)), ("Yv|r|", ("absolute", 1, 5)),
        ("Y|v|r", ("absolute", 5, 1)), ("X|v||v|", ("signed", 1, 1)), ("X|v|", ("absolute", 0, 1)), ("Yvvv", None),
        ("Y|v||r|", None),
    ],
)  # fmt: skip
def test_places(symbol: str, place: tuple[str, int, int] | None) -> None:
    (term,) = force_law(parameters({symbol: 1e-3})).terms
    assert slot(term) == place


def test_damping_at_rest_is_linear() -> None:
    law = force_law(parameters({"Yv": -0.03, "Y0": 1e-3}, law="rest"))
    assert [slot(t) for t in law.terms] == [("linear", 1, 0), None]


def test_turning_is_a_rotation() -> None:
    """Half a turn about x of every vector, by the rotation matrix."""
    turn, form, nu = np.kron(np.eye(2), np.diag([1.0, -1.0, -1.0])), random_form(1), velocities()
    assert np.array_equal(np.diag(turn), FLU)
    np.testing.assert_allclose(form.turned().force(nu @ turn.T) @ turn, form.force(nu), atol=1e-12)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_less_what_the_target_adds(seed: int) -> None:
    root = np.random.default_rng(seed).normal(size=(6, 6))
    matrix, form, nu = root @ root.T, random_form(seed), velocities()
    nu[:, 0] = np.abs(nu[:, 0])
    rest = form.less(ideal_quadratics(matrix))
    np.testing.assert_allclose(rest.force(nu) + ideal_force(matrix, nu), form.force(nu), atol=1e-12)


def test_nothing_is_left_of_the_ideal_fluid() -> None:
    """Not even rounding: a target without measured terms gets no term at all."""
    file = parameters({"Yv|v|": 0.0}, None).model_copy(update={"added_mass": second.exact(1).added_mass})
    law = force_law(file)
    left = second_order(law).less(ideal_quadratics(np.array(file.added_mass.matrix) * 1.0))
    assert not np.any(left.signed)


def test_momenta_of_an_asymmetric_matrix() -> None:
    """F = -w x p, K = -w x h - v x p with p and h from the matrix as it is."""
    m, nu = np.random.default_rng(4).normal(size=(6, 6)), velocities()
    p, h = (nu @ m.T)[:, :3], (nu @ m.T)[:, 3:]
    expected = np.hstack([-np.cross(nu[:, 3:], p), -np.cross(nu[:, 3:], h) - np.cross(nu[:, :3], p)])
    np.testing.assert_allclose(np.einsum("ijk,nj,nk->ni", momentum_quadratics(m), nu, nu), expected, atol=1e-12)
