"""What an operating point says of itself."""

from __future__ import annotations

import numpy as np
import pytest

from coeflab.motion.trim.operating_point import Equation, OperatingPoint, Outcome, Unknown, nearest, operating_point

THRUST, TILT = Unknown("thrust", "N", 0.0, 10.0, 1.0), Unknown("tilt", "rad", -1.0, 1.0, 0.1)
SURGE, HEAVE = Equation("surge", "N", 1.0), Equation("heave", "N", 1.0)


def pulled(along: float, across: float, *unknowns: Unknown) -> OperatingPoint:
    """A thruster that tilts: force along and across."""

    def left(x: np.ndarray) -> np.ndarray:
        return np.array([x[0] * np.cos(x[1]) - along, x[0] * np.sin(x[1]) - across])

    return operating_point(unknowns or (THRUST, TILT), (SURGE, HEAVE), left, starts=4)


def test_one_solution_in_closed_form() -> None:
    got = pulled(4.0, 3.0)
    assert got.outcome is Outcome.UNIQUE
    assert got.outcome.solved
    assert got.values["thrust"] == pytest.approx(5.0, abs=1e-8)
    assert got.values["tilt"] == pytest.approx(np.arctan2(3.0, 4.0), abs=1e-8)
    assert max(map(abs, got.residuals.values())) < 1e-9
    assert got.violated == got.saturated == ()
    assert (
        got.words()[0]
        == "One solution: 2 unknowns, 2 equations of rank 2; 5 of 5 starts converged to it, none to another."
    )


def test_an_infeasible_request_names_equation_and_bound() -> None:
    got = pulled(20.0, 0.0)
    assert got.outcome is Outcome.INFEASIBLE
    assert not got.outcome.solved
    assert [e.name for e in got.violated] == ["surge"]
    assert [(u.name, b) for u, b in got.saturated] == [("thrust", 10.0)]
    said = " ".join(got.words())
    assert "surge is off by -10.00 N" in said
    assert "thrust is held at its bound of 10.0000 N." in said
    row = got.table().rows[0]
    assert row == ("thrust", "10.0000", "N", "0 .. 10.00 N", "held")


def test_a_family_says_its_rule_and_where_it_goes_on() -> None:
    two = Unknown("other", "N", 0.0, 10.0, 1.0)
    got = operating_point((THRUST, two), (SURGE,), lambda x: np.array([x[0] + x[1] - 4.0]), starts=2)
    assert got.outcome is Outcome.FAMILY
    assert got.dimension == 1
    assert got.values == pytest.approx({"thrust": 2.0, "other": 2.0}, abs=1e-9)
    said = " ".join(got.words())
    assert "a family of 1 parameter; 2 unknowns, 1 equations of rank 1" in said
    assert "least sum of squares of thrust / 1.000 N, other / 1.000 N" in said
    assert "The family extends along thrust" in said


def test_nearest_to_a_point_weighs_only_what_it_names() -> None:
    two = Unknown("other", "N", 0.0, 10.0, 1.0)
    unknowns = nearest((THRUST, two), {"thrust": 3.0})
    got = operating_point(unknowns, (SURGE,), lambda x: np.array([x[0] + x[1] - 4.0]), starts=0)
    assert got.values == pytest.approx({"thrust": 3.0, "other": 1.0}, abs=1e-7)
    assert got.rule == "the least sum of squares of (thrust - 3.00000 N) / 1.000 N"


def test_a_given_unknown_stays_and_angles_are_shown_in_degrees() -> None:
    got = pulled(4.0, 0.0, THRUST, TILT.at(0.0))
    assert got.table().rows[1] == ("tilt", "0", "deg", "given", "")
    assert TILT.shown(np.radians(30.0)) == "30.0000 deg"
    assert Unknown("rate", "rad/s", 0.0, 1.0, 1.0).shown(np.radians(3.0), 3) == "3.00 deg/s"


def test_several_and_singular_and_not_converged() -> None:
    x = Unknown("x", "1", -5.0, 5.0, 1.0)
    one = Equation("square", "1", 1.0)

    def outcome(left: object) -> Outcome:
        return operating_point((x,), (one,), left, starts=6).outcome  # type: ignore[arg-type]

    assert outcome(lambda v: np.array([v[0] ** 2 - 4.0])) is Outcome.SEVERAL
    assert outcome(lambda v: np.array([v[0] ** 2])) is Outcome.SINGULAR
    assert outcome(lambda v: v * np.nan) is Outcome.NOT_CONVERGED
