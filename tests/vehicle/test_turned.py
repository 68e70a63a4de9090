"""Drag, side force and lift in axes that are not their own; what a table that is left out, or one without numbers, changes; files that are refused."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from pydantic import ValidationError

from coeflab.law.force_law import ForceLaw
from coeflab.law.transforms import incidence
from coeflab.vehicle.force_law import full_force, motion_law, not_used
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.parameter_model import ParameterModel
from tests.vehicle.hybrid import thruster
from tests.vehicle.make_conformance import model
from tests.vehicle.test_force_law import parameters

RHO, LENGTH = 1000.0, 2.0
U, V, W = 1.5, 0.3, 0.15
SPEED = np.sqrt(U**2 + V**2 + W**2)
Q, A, B = 0.5 * RHO * SPEED**2 * LENGTH**2, np.arctan2(W, U), np.arcsin(V / SPEED)
ANGLED = [("alpha", "rad"), ("beta", "rad")]
DRAG = model("C_D", ANGLED, {(): 0.3, (("beta", 2),): 1.0}, [-0.6] * 2, [0.6] * 2)
SIDE = model("C_S", [("beta", "rad")], {(("beta", 1),): -1.2}, [-0.6], [0.6])
LIFT = model("C_L", [("alpha", "rad")], {(("alpha", 1),): 1.2}, [-0.6], [0.6])
PLANES = model("C_L", [("alpha", "rad"), ("db", "rad")], {(("db", 1),): 0.8}, [-0.6] * 2, [0.6] * 2)
TURNING = model("Y'", [("r", "1")], {(("r", 1),): 0.02}, [-1.0], [1.0])
D = Q * (0.3 + B**2)


def of(values: dict[str, float], *models: ParameterModel) -> ParameterFile:
    return parameters({"Mq": -0.01, **values}).model_copy(update={"models": models})


def force(file: ParameterFile, db: float = 0.0, r: float = 0.0) -> np.ndarray:
    return full_force(file)(np.array([[U, V, W, 0.0, 0.0, r]]), np.array([[0.0, 0.0, db]]))[0]


def test_stern_planes_lift_beside_a_table_of_lift_that_a_slope_leaves_out() -> None:
    for unused in ((), (LIFT,)):
        file = of({"Zw": -0.03}, PLANES, *unused)
        more = force(file, 0.12) - force(file)
        assert more[2] == pytest.approx(-np.cos(A) * Q * 0.8 * 0.12)
        assert more[0] == pytest.approx(np.sin(A) * Q * 0.8 * 0.12)


def test_a_table_that_is_left_out_changes_nothing() -> None:
    plain, both = of({"Yr": 0.01}, SIDE), of({"Yr": 0.01}, SIDE, TURNING)
    np.testing.assert_array_equal(force(both, r=0.2), force(plain, r=0.2))
    assert force(both)[1] == pytest.approx(np.cos(B) * Q * -1.2 * B)


@pytest.mark.parametrize(
    ("symbol", "acts"), [("X0", True), ("Xu|u|", True), ("Xvv", True), ("Xww", False), ("Xwq", True)]
)
def test_lift_ahead_is_within_what_body_axes_state_over_w_alone(symbol: str, acts: bool) -> None:
    bare, file = of({symbol: -1e-3}), of({symbol: -1e-3}, LIFT)
    assert (force(file) - force(bare))[0] == pytest.approx(np.sin(A) * Q * 1.2 * A * acts)
    assert [f["components"] for f in not_used(file) if f.code == "law.wind_partly"] == [("X",)] * (not acts)


def test_drag_is_within_the_slope_of_heave_beside_an_increment_of_lift() -> None:
    file = of({"Zw": -0.03}, DRAG, PLANES)
    slope = -0.03 * 0.5 * RHO * LENGTH**2 * SPEED * W
    assert force(file, 0.1)[2] == pytest.approx(slope - np.cos(A) * Q * 0.8 * 0.1)
    assert force(file, 0.1)[1] == pytest.approx(-np.sin(B) * D)
    assert force(of({}, DRAG))[2] == pytest.approx(-np.sin(A) * np.cos(B) * D)


def test_groups_that_act_apart_are_read_back_from_every_program() -> None:
    from coeflab.formats.coded_tables import coded_tables, law_of_tables

    law = motion_law(of({"Zw": -0.03}, DRAG, SIDE, PLANES))[0]
    assert len(law.wind) == 2
    tabled = ForceLaw(tuple(t for t in law.terms if t.kind == "table"), np.zeros((6, 6, 6)))
    nu, delta = np.array([[U, V, W, 0.0, 0.0, 0.0]]), np.array([[0.0, 0.0, 0.1]])
    found = law_of_tables(*coded_tables(of({"Zw": -0.03}, DRAG, SIDE, PLANES))).force(nu, delta)
    np.testing.assert_allclose(found, tabled.force(nu, delta), rtol=1e-13)


def test_a_table_of_undetermined_terms_keeps_its_domain() -> None:
    void = model("K'", [("v", "1")], {(("v", 1),): None}, [-0.1], [0.1], "refuse")
    assert np.isnan(force(of({}, void))).all()
    assert not np.isnan(full_force(of({}, void))(np.array([[1.0, 0.05, 0, 0, 0, 0]]), np.zeros((1, 3)))).any()


def test_the_signs_of_zeros_turn_nothing() -> None:
    u, v, w = np.array([[-0.0, -0.0, -1.0], [0.0, 0.3, 0.0], [-0.0, 0.0, -0.0]])
    np.testing.assert_allclose(incidence(u, v, w)[0], [0.0, 0.0, np.pi])


@pytest.mark.parametrize("response", ["foo", "y'", "CD", "C_Q", "Y''"])
def test_an_unknown_response_is_no_file(response: str) -> None:
    with pytest.raises(ValidationError, match="one of X, Y, Z"):
        model(response, [("v", "1")], {(("v", 1),): 1.0}, [-1.0], [1.0])


def test_a_component_by_an_area_is_that_component() -> None:
    by_area: dict[str, Any] = {"area": {"value": 0.5, "name": "plan"}}
    file = of({}, model("C_Y", [("beta", "rad")], {(("beta", 1),): -1.0}, [-1.0], [1.0], **by_area))
    assert force(file)[1] == pytest.approx(-0.5 * RHO * SPEED**2 * 0.5 * B)


def test_a_domain_without_half_spaces_and_a_thruster_named_thrust_are_no_file() -> None:
    with pytest.raises(ValidationError, match="no half-spaces"):
        model("Y'", [("v", "1")], {(("v", 1),): 1.0}, [-1.0], [1.0], spaces=[])
    with pytest.raises(ValidationError, match="beyond low or high of v"):
        model("Y'", [("v", "1")], {(("v", 1),): 1.0}, [0.0], [1.0], spaces=[[1.0, -1.0], [-1.0, -1.0]])
    with pytest.raises(ValidationError, match="another name"):
        thruster("thrust", 0.0)
