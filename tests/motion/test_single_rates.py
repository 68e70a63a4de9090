"""Plain numbers and arrays give the same rates."""

from __future__ import annotations

import numpy as np
import pytest

from coeflab.core.files import shipped
from coeflab.motion.dynamics import rates_of_one, term_force_of_one
from coeflab.motion.marching import alone
from coeflab.motion.vehicle import Vehicle, vehicle
from coeflab.vehicle.parameter_file import read_parameter_file
from tests.formats.massed import torpedo


def of_tables() -> Vehicle:
    """C_D, C_S and C_n over beta, yaw damping over r, held within their tables."""
    file = read_parameter_file(shipped("cfd_data") / "huuv" / "huuv.parameters.json")
    return vehicle(file, ("u", "v", "r"))


@pytest.mark.parametrize("made", [lambda: vehicle(torpedo()), of_tables], ids=["derivatives", "tables"])
def test_random_states(made: object) -> None:
    v: Vehicle = made()  # type: ignore[operator]
    rng = np.random.default_rng(3)
    states = rng.normal(size=(200, 14))
    states[:, 3:7] /= np.linalg.norm(states[:, 3:7], axis=1)[:, None]
    states[0, 7:13] = 0.0
    states[1, 7:10] = 0.0
    states[2, 7] = -2.0
    angles, wrench = rng.normal(0.0, 0.2, size=(200, 3)), rng.normal(0.0, 5.0, size=(200, 6))
    dynamics = alone(v).dynamics(np.array([0.3, -0.2, 0.1]))
    expected = dynamics.rates(states.T, angles.T, wrench.T).T
    one = rates_of_one(dynamics)
    found = np.array([one(s.tolist(), a.tolist(), w.tolist()) for s, a, w in zip(states, angles, wrench, strict=True)])
    assert found == pytest.approx(expected, rel=1e-12, abs=1e-11)
    force = term_force_of_one(v.law)
    plain = np.array([force(s.tolist(), a.tolist()) for s, a in zip(states, angles, strict=True)])
    assert plain == pytest.approx(v.law.term_force(states[:, 7:13].T, angles.T).T, rel=1e-12, abs=1e-10)
