"""Members of an ensemble: their own numbers, checked as those of a vehicle."""

from __future__ import annotations

import numpy as np
import pytest

from coeflab.core.errors import InputError
from coeflab.motion.ensemble import Ensemble, alone
from coeflab.motion.marching import march
from tests.motion.fleet import coasting, swimmer, zigzag

COAST = coasting(1.0, [1.0, 0, 0, 0, 0, 0])


def test_a_member_is_the_vehicle_with_its_numbers() -> None:
    v = swimmer()
    rows = np.stack([v.law.coefficient, 2.0 * v.law.coefficient])
    centres = np.stack([v.centre, v.centre + 0.01])
    added = np.stack([v.added, 1.1 * v.added])
    member = Ensemble(v, rows, added=added, centre=centres).member(1)
    np.testing.assert_array_equal(member.law.coefficient, rows[1])
    assert [t.coefficient for t in member.law.terms] == pytest.approx(rows[1])
    np.testing.assert_array_equal(member.centre, centres[1])
    np.testing.assert_array_equal(member.added, added[1])
    assert member.mass == v.mass
    np.testing.assert_array_equal(alone(v).member(0).law.coefficient, v.law.coefficient)


def test_the_arrays_of_a_member_are_those_of_its_vehicle() -> None:
    v = swimmer()
    many = Ensemble(
        v, np.stack([v.law.coefficient] * 2), added=np.stack([v.added, 1.2 * v.added]), mass=np.array([60.0, 65.0])
    )
    whole, own = many.dynamics(np.zeros(3)), alone(many.member(1)).dynamics(np.zeros(3))
    np.testing.assert_allclose(whole.inverse[1], own.inverse)
    np.testing.assert_allclose(whole.quadratics[1], own.quadratics)
    np.testing.assert_allclose(whole.excess[1], own.excess[0])
    np.testing.assert_allclose(whole.lever[:, 1], own.lever[:, 0])


def test_arrays_stay_as_they_are() -> None:
    v = swimmer()
    rows = np.stack([v.law.coefficient] * 2)
    ensemble = Ensemble(v, rows)
    rows[0] = 0.0
    assert ensemble.coefficients[0, 0] != 0.0
    with pytest.raises(ValueError, match="read-only"):
        ensemble.coefficients[0, 0] = 1.0


def test_bad_members_are_named() -> None:
    v = swimmer()
    rows = np.stack([v.law.coefficient] * 3)
    with pytest.raises(InputError, match="one row a member"):
        Ensemble(v, rows[:, 1:])
    with pytest.raises(InputError, match="not finite"):
        Ensemble(v, rows * np.nan)
    with pytest.raises(InputError, match="member 2 with an effective mass"):
        Ensemble(v, rows, added=np.stack([v.added, -10.0 * v.added, v.added]))
    with pytest.raises(InputError, match="found 2 manoeuvres"):
        march(Ensemble(v, rows), [COAST, COAST])
    with pytest.raises(InputError, match="phases differ"):
        march(Ensemble(v, rows[:2]), [COAST, coasting(2.0, [1.0, 0, 0, 0, 0, 0])])
    with pytest.raises(InputError, match="one of auto, numpy, compiled"):
        march(v, zigzag(v), kernel="fortran")
