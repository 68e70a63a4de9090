"""A manoeuvre through two media: the surface is located within a step, and a change anywhere else is refused."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from coeflab.core.errors import InputError
from coeflab.core.types import Array
from coeflab.motion.dynamics import from_euler
from coeflab.motion.manoeuvre import Manoeuvre, Phase, Until
from coeflab.motion.marching import march, march_by_tolerance
from coeflab.motion.media import through_media
from coeflab.motion.simulation import simulate as planned
from coeflab.motion.simulators import SIMULATORS
from coeflab.motion.trajectory import Ended, Trajectory
from coeflab.motion.vehicle import Vehicle, vehicle
from coeflab.vehicle.parameter_file import read_parameter_file
from tests.motion.trimmed import parameter_file

G, MASS, LIGHT, DEPTH = 9.8, 2.0, 0.0025, 1.5  # kg, m^3 displaced in water, m
UP = (1000.0 * LIGHT - MASS) / MASS * G  # acceleration of a craft without drag, lighter than water
BACK = (1.0 - 1000.0 * 1e-6 / MASS) * G


def frictionless(volume: float, name: str = "") -> Vehicle:
    rest = {"volume": volume, "centre_of_buoyancy": [0.0, 0.0, 0.0], "gravity": G}
    file = parameter_file({}, MASS, (0.02, 0.02, 0.02), hydrostatics=rest)
    return replace(vehicle(file, tuple("uvwpqr")), name=name)


WATER, AIR = frictionless(LIGHT, "water"), frictionless(1e-6, "air")
OUT, IN = Until("depth", False, -DEPTH), Until("depth", True, -DEPTH)


def hop(*phases: Phase, velocity: Array | None = None, **more: Any) -> Manoeuvre:
    known = (Phase("up", {}, 20.0, OUT), Phase("air", {}, 20.0, IN, 1))
    start = np.zeros(6) if velocity is None else velocity
    return Manoeuvre("hop", phases or known, start, **{"others": (AIR,), "surface": -DEPTH, **more})


def through(manoeuvre: Manoeuvre, **how: Any) -> Trajectory:
    return SIMULATORS.load("rigid_body").simulate(WATER, manoeuvre, how)


@pytest.mark.parametrize("how", [{}, {"integrator": "rk4", "step": 0.07, "kernel": "numpy"}], ids=["adaptive", "rk4"])
def test_the_surface_is_located_within_a_step(how: dict[str, Any]) -> None:
    """Parabolas on both sides: out after sqrt(2 d / a), back after 2 v / g more. A step of 0.07 s passes the surface at 3 m/s."""
    found = through(hop(), **how)
    out, speed = np.sqrt(2.0 * DEPTH / UP), np.sqrt(2.0 * DEPTH * UP)
    assert found.ended is Ended.COMPLETE
    assert found.reached == pytest.approx((out, out + 2.0 * speed / BACK), abs=1e-8)
    assert np.all(np.diff(found.time) > 0.0)
    above = -DEPTH - found.position[:, 2]
    assert np.all(above[found.phase == 0] < 0.0)
    assert np.all(above[found.phase == 1] > -1e-8)
    at = int(np.argmax(found.phase == 1))
    assert above[at] == pytest.approx(0.0, abs=1e-8)
    assert found.velocity[at, 2] == pytest.approx(-speed, abs=1e-8)
    assert np.max(above) == pytest.approx(speed**2 / (2.0 * BACK), abs=0.02)


@pytest.mark.parametrize(
    ("phases", "says"),
    [
        ((Phase("up", {}, 0.5), Phase("air", {}, 1.0, None, 1)), "after up, by time"),
        ((Phase("up", {}, 9.0, replace(OUT, value=-0.7)), Phase("air", {}, 1.0, None, 1)), "at a depth of -0.7 m"),
        ((Phase("up", {}, 9.0, replace(OUT, rises=True)), Phase("air", {}, 1.0, None, 1)), "towards the other medium"),
        ((Phase("up", {}, 9.0, Until("pitch", True, 0.1)), Phase("air", {}, 1.0, None, 1)), "up until pitch"),
        ((Phase("up", {}, 9.0, OUT), Phase("space", {}, 1.0, None, 2)), "other media than two"),
    ],
)
def test_a_change_of_medium_elsewhere_is_refused(phases: tuple[Phase, ...], says: str) -> None:
    with pytest.raises(InputError, match=says):
        through(hop(*phases))


def test_what_else_is_no_passage() -> None:
    for manoeuvre, how, says in (
        (hop(surface=0.0), {}, "a start on the surface"),
        (hop(others=(replace(AIR, free=("u", "w")),)), {}, "u w free in the other medium"),
        (hop(), {"down": 0.1}, "down through a surface"),
    ):
        with pytest.raises(InputError, match=says):
            through(manoeuvre, **how)
    for alone in (march, march_by_tolerance):
        with pytest.raises(InputError, match="two media in one march"):
            alone(WATER, hop())


def test_a_motion_beyond_its_surface_has_a_status() -> None:
    """The last stretch is not told to end: the craft falls back through the surface with the forces of air."""
    found = through(hop(Phase("up", {}, 20.0, OUT), Phase("air", {}, 20.0, None, 1)), record=0.05)
    assert found.ended is Ended.OUT_OF_RANGE
    assert "beyond the surface with the forces of air" in found.why
    assert np.max(found.position[found.phase == 1, 2]) <= -DEPTH + 1e-6


def test_a_step_that_passes_the_surface_twice_has_a_status() -> None:
    """Rows half a metre under the surface, 0.4 s apart, thrown up at 12 m/s: between them the craft was out of the water."""
    whole = through(hop(Phase("up", {}, 20.0, OUT), Phase("air", {}, 20.0, IN, 1)))
    two = whole.until(float(whole.time[1]))
    under = replace(
        two, time=np.array([0.0, 0.4]), position=np.array([[0.0, 0.0, 0.0], [0.0, 0.0, -1.0]]), phases=("up",), reached=(None,),
        velocity=np.array([[0.0, 0.0, -12.0, 0.0, 0.0, 0.0], [0.0, 0.0, 12.0, 0.0, 0.0, 0.0]]), outside={},
    )  # fmt: skip
    found = through_media(WATER, hop(), lambda *_: under)
    assert found.ended is Ended.OUT_OF_RANGE
    assert "a step passed it twice" in found.why
    slow = replace(under, velocity=0.2 * under.velocity)
    assert through_media(WATER, hop(), lambda *_: slow).ended is Ended.COMPLETE


def test_a_surface_that_is_not_reached_is_said() -> None:
    found = through(hop(Phase("up", {}, 0.3, OUT), Phase("air", {}, 20.0, IN, 1)))
    assert (found.ended, found.reached, found.phases) == (Ended.COMPLETE, (None, None), ("up", "air"))
    assert any("the surface was not reached within 0.3 s" in s for s in found.statements)


def test_medium_change_of_a_parameter_file() -> None:
    rotors = [f"rotor{i}" for i in range(1, 5)]
    wet = " ".join(f"{r}=2500 {r}.tilt=3.141592653589793" for r in rotors)
    asked = {
        "into": "flyingfish_air",
        "depth": 0.2,
        "commands": wet,
        "then": " ".join(f"{r}=5000" for r in rotors),
        "changes": 2,
    }
    found = planned(read_parameter_file("flyingfish_water"), "medium_change", asked)
    figures = {f.name: f.value for f in found.figures}
    assert found.trajectory.phases == ("water 1", "air 1", "water 2")
    assert figures["changes of medium"] == 2.0
    assert figures["vertical speed there"] == pytest.approx(
        -found.trajectory.velocity[found.trajectory.phase == 1][0, 2]
    )
    assert figures["vertical speed back at the surface"] < 0.0 < figures["farthest beyond"]
    dive = asked | {
        "start": "above",
        "into": "flyingfish_water",
        "commands": "",
        "then": "",
        "changes": 1,
        "longest": 1.0,
    }
    down = planned(read_parameter_file("flyingfish_air"), "medium_change", dive)
    assert down.trajectory.reached[0] == pytest.approx(np.sqrt(0.4 / 9.80665), rel=2e-3)
    assert down.figures[1].value == pytest.approx(-np.sqrt(0.4 * 9.80665), rel=5e-3)
    with pytest.raises(InputError, match="no parameter file of the other medium"):
        planned(read_parameter_file("flyingfish_water"), "medium_change", {})


@pytest.mark.parametrize(
    ("first", "into", "start", "says"),
    [
        ("water", "air", "above", "--start below"), ("air", "water", "below", "--start above"),
        ("water", "water", "below", "one of water, one of air"), ("air", "air", "above", "one of water, one of air"),
    ],
)  # fmt: skip
@pytest.mark.usefixtures("in_a_shell")
def test_water_above_air_and_one_medium_twice_are_refused(first: str, into: str, start: str, says: str) -> None:
    file = read_parameter_file(Path(f"flyingfish_{first}"))
    with pytest.raises(InputError, match="times as dense as that above") as refused:
        planned(file, "medium_change", {"into": f"flyingfish_{into}", "start": start})
    assert says in str(refused.value)


@pytest.mark.parametrize("angles", [(0.0, 0.6, 0.0), (0.4, 0.3, -0.7)], ids=["pitched", "rolled, pitched and yawed"])
def test_a_craft_crosses_the_surface_as_it_lies(angles: tuple[float, float, float]) -> None:
    """Without drag it flies a parabola in earth axes whatever its attitude: an attitude set back at the surface bends it."""
    forward = 4.0
    manoeuvre = hop(velocity=np.array([forward, 0.0, 0.0, 0.0, 0.0, 0.0]), attitude=from_euler(*angles))
    found = through(manoeuvre)
    ahead = forward * np.cos(angles[1]) * np.array([np.cos(angles[2]), np.sin(angles[2])])
    up = forward * np.sin(angles[1])
    out = (np.sqrt(up**2 + 2.0 * UP * DEPTH) - up) / UP
    assert found.reached == pytest.approx((out, out + 2.0 * (up + UP * out) / BACK), abs=1e-7)
    assert found.position[-1, :2] == pytest.approx(ahead * found.reached[-1], abs=1e-6)
    assert np.asarray(found.attitude) == pytest.approx(np.tile(from_euler(*angles), (len(found.time), 1)), abs=1e-9)
