"""A thruster as people know it: a bollard pull at a rate is thrust with the square of the rate."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from coeflab.bodies.thruster_keys import ThrusterKeys
from coeflab.bodies.thrusters import bollard_squares
from coeflab.core.declarations import validated
from coeflab.core.errors import InputError
from coeflab.law.scaling import Conditions
from coeflab.vehicle.own_numbers import typed_file, typed_thruster

NUMBERS = ["Xuu=-10 N/(m/s)^2", "Yv=-40 N/(m/s)", "Nr=-30 N*m/(rad/s)"]
WATER = Conditions(1000.0, 2.0)


def pulling(text: str) -> object:
    return typed_file(
        "auv",
        NUMBERS,
        length="2 m",
        length_name="LOA",
        speed="2 m/s",
        density="1000",
        about="cg",
        mass="50",
        inertia="4,5,5",
        thrusters=[text],
    )


def test_a_bollard_pull_trims_at_the_rate_of_the_square_law() -> None:
    """40 N of resistance at 2 m/s by 60 N at 720 rpm: 720 sqrt(40/60) = 587.9 rpm; a straight line would say 480."""
    thruster = pulling("main; bollard = 60 N; rate = 720").thrusters[0]  # type: ignore[attr-defined]
    commands = np.linspace(0.0, 720.0, 72001)
    thrust = np.array([thruster.curve.at(float(n)) for n in commands])
    assert commands[np.searchsorted(thrust, 40.0)] == pytest.approx(720.0 * np.sqrt(40.0 / 60.0), abs=0.02)


def test_the_command_of_a_run_ahead_is_that_rate() -> None:
    from coeflab.api.trimming import trim

    p = pulling("main; bollard = 60 N; rate = 720")
    found = trim(p, speed=2.0, free=("u", "v", "r"))  # type: ignore[arg-type]
    assert found.point.values["main"] == pytest.approx(720.0 * np.sqrt(40.0 / 60.0), rel=1e-4)


def test_all_keys() -> None:
    t = typed_thruster(
        "main; bollard=60 N; rate=700; bollard_astern=30 N; dead_zone=50; place=-0.9,0,0.01; torque=2 N*m; handedness=-1; tilt_axis=0,2,0; tilt_limit=20 deg", WATER
    )  # fmt: skip
    assert [t.curve.at(n) for n in (-700.0, -49.0, 49.0, 350.0, 700.0)] == pytest.approx([-30.0, 0.0, 0.0, 15.0, 60.0])
    assert t.torque_curve.at(350.0) == pytest.approx(0.5)
    assert (t.handedness, t.tilt_axis, t.position) == (-1, (0.0, 1.0, 0.0), (-0.9, 0.0, 0.01))
    assert t.tilt_high == -t.tilt_low == pytest.approx(np.radians(20.0))


def test_torque_astern_is_in_the_ratio_of_the_pulls() -> None:
    due = {"": -2.0, "; bollard_astern=30 N": -1.0, "; bollard_astern=0 N": 0.0}
    for astern, torque in due.items():
        curve = typed_thruster(f"main; bollard=60 N; rate=700; torque=2 N*m{astern}", WATER).torque_curve
        assert curve.at(-700.0) == pytest.approx(torque), astern
        assert curve.at(700.0) == pytest.approx(2.0)


def test_no_reverse() -> None:
    assert [s.low for s in bollard_squares(60.0, 720.0, astern=0.0)] == [0.0]


def test_no_reverse_beside_a_dead_zone_is_no_thrust_at_rest() -> None:
    curve = typed_thruster("main; bollard=60 N; rate=700; bollard_astern=0 N; dead_zone=350", WATER).curve
    assert [curve.at(n) for n in (-700.0, 0.0, 340.0)] == [0.0, 0.0, 0.0]
    assert curve.at(351.0) == pytest.approx(60.0 * (351.0 / 700.0) ** 2)


@pytest.mark.parametrize(
    "text",
    ["main; bollard=60 N", "main; rate=3", "main; bollard=-1 N; rate=3", "main; bollard=60 N; rate=700; dead_zone=900", "main; thrust=4",
     "main; bollard=60 m; rate=700", "main; bollard=60 N; rate=700; handedness=2", "main; bollard=60 N; rate=700; tilt_limit=20 deg"],
)  # fmt: skip
def test_what_is_refused(text: str) -> None:
    with pytest.raises(InputError):
        typed_thruster(text, WATER)


def test_a_command_may_have_its_unit() -> None:
    plain, stated = (
        typed_thruster(f"main; bollard = 60 N; {rate}", WATER) for rate in ("rate = 12; unit = 1/s", "rate = 12 1/s")
    )
    assert stated == plain
    with pytest.raises(InputError, match="dead_zone"):  # two units of one command
        typed_thruster("main; bollard = 60 N; rate = 12 1/s; dead_zone = 30 rpm", WATER)


def test_a_body_toml_takes_it() -> None:
    made = validated(
        ThrusterKeys,
        {"name": "m", "place": [0, 0, 0], "axis": [2, 0, 0], "bollard": "60 N", "rate": 720},
        Path("body.toml"),
    ).built
    assert made.thrusts(1.0, 1000.0)[-1] == pytest.approx((720.0, 60.0))
