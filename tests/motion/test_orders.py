"""Angles of control surfaces after an order."""

from __future__ import annotations

import numpy as np
import pytest

from coeflab.motion.orders import ramp

BEGIN, TARGET = np.array([[0.0], [0.1], [0.3]]), np.array([[0.2], [-0.1], [0.3]])


@pytest.mark.parametrize("since", [-1e-16, 0.0, 1.0])
def test_a_surface_that_moves_at_once_stands_at_its_order_even_a_rounding_before_it(since: float) -> None:
    found = ramp(BEGIN, TARGET, np.full(3, np.inf), np.array([since]))
    np.testing.assert_array_equal(found, TARGET)


@pytest.mark.parametrize(("since", "part"), [(-1e-16, 0.0), (0.5, 0.25), (2.0, 1.0), (9.0, 1.0)])
def test_a_rate_takes_its_time(since: float, part: float) -> None:
    found = ramp(BEGIN, TARGET, np.full(3, 0.1), np.array([since]))
    np.testing.assert_allclose(found, BEGIN + part * (TARGET - BEGIN))
