"""The rigid-body simulator beside the real xdyn, which runs our export of the same file: three manoeuvres of a minute."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from coeflab.law.transforms import velocity_transfer
from coeflab.motion.manoeuvre import Manoeuvre, Phase
from coeflab.motion.simulators import rigid_body
from coeflab.motion.trajectory import Ended
from coeflab.motion.vehicle import vehicle
from tests.consumers.lxdyn_environment import PYTHON
from tests.consumers.test_lxdyn import SECONDS, apart, in_xdyn, rendered
from tests.formats.massed import CENTRE, torpedo

TOLERANCE = 1e-4
STRAIGHT, OBLIQUE = (1.5, 0.0, 0.0, 0.0, 0.0, 0.0), (1.2, 0.3, -0.2, 0.15, 0.1, -0.2)
pytestmark = pytest.mark.skipif(
    not PYTHON.exists(), reason="lxdyn is not installed; run python3 tests/consumers/lxdyn_environment.py"
)


def starting(text: str, velocity: tuple[float, ...]) -> str:
    """The file with velocities of the centre of gravity at the start."""
    for name, value in zip("uvwpqr", velocity, strict=True):
        unit = "m/s" if name in "uvw" else "rad/s"
        old = f"{name}: {{value: {1.5 if name == 'u' else 0.0}, unit: {unit}}}"
        assert text.count(old) == 1
        text = text.replace(old, f"{name}: {{value: {value}, unit: {unit}}}")
    return text


@pytest.mark.slow
@pytest.mark.parametrize(
    ("start", "rudder", "options"),
    [
        pytest.param(STRAIGHT, 0.0, {}, id="straight run"),
        pytest.param(STRAIGHT, 0.2, {"integrator": "rk4", "step": 0.02}, id="turn"),
        pytest.param(OBLIQUE, -0.1, {"integrator": "rk4", "step": 0.02, "kernel": "numpy"}, id="oblique start"),
    ],
)
def test_track_and_speeds_of_xdyn(
    tmp_path: Path, start: tuple[float, ...], rudder: float, options: dict[str, object]
) -> None:
    file = torpedo()
    text = starting(rendered(file), start).replace("values: [0.0]", f"values: [{rudder}]")
    rows, said = in_xdyn(tmp_path, text)
    assert "Warning" not in said
    at_point = velocity_transfer(-CENTRE) @ np.array(start)
    plan = Manoeuvre("minute", (Phase("minute", {"dr": rudder}, SECONDS),), at_point)
    found = rigid_body.simulate(vehicle(file), plan, {"record": 0.2, "tolerance": 1e-10} | options)
    assert found.ended is Ended.COMPLETE
    np.testing.assert_allclose(found.time, rows[::10, 0], atol=1e-9)
    way, velocity = apart(rows[::10], found)
    assert way < TOLERANCE
    assert velocity < TOLERANCE
    assert abs(found.heading[-1]) > 0.5 if rudder else abs(found.heading[-1]) < 0.5
