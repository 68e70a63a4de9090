"""Propellers: the open-water series, their in-plane force by blade elements that turn, its signs, and a thruster's keys."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from coeflab.bodies.body import Body
from coeflab.bodies.outlining import with_propellers
from coeflab.bodies.readers import read_body
from coeflab.bodies.thrusters import Screw, Thruster
from coeflab.bodies.wageningen import open_water, thrust_over_speed
from coeflab.core.errors import InputError
from coeflab.core.files import shipped
from coeflab.estimates import estimated, propeller
from coeflab.law.scaling import Conditions, Scaling
from coeflab.vehicle.from_shape import parameter_thruster
from tests.estimates.bodies import RING, SCREW, WATER, body_of, outline, tail

PITCH, AREA, BLADES = 1.0, 0.5, 3


def test_open_water_of_a_b_propeller_as_published() -> None:
    # Fossen's remus100.py prints wageningen(0, 1, 0.718, 3) and wageningen(0.6632, 1, 0.718, 3).
    thrust, torque = open_water(np.array([0.0, 0.6632]), 1.0, 0.718, 3)
    assert thrust.tolist() == pytest.approx([0.4566, 0.1798], abs=5e-5)
    assert torque.tolist() == pytest.approx([0.0700, 0.0312], abs=5e-5)
    with pytest.raises(InputError, match="P/D"):
        open_water(np.zeros(1), 2.0, 0.7, 3)
    assert propeller.contributions(outline(), WATER) == ()


def test_thrust_over_speed_is_the_series_at_one_speed_ahead() -> None:
    curve = thrust_over_speed(0.14, 1.0, 0.718, 3, 25.0, 1.5, 1026.0)
    assert curve[:2, 1].tolist() == [0.0, 0.0]
    assert np.all(np.diff(curve[1:, 1]) > 0.0)
    for turns, thrust in curve[2:]:
        own = open_water(np.array([1.5 / (turns * 0.14)]), 1.0, 0.718, 3)[0][0]
        assert thrust == pytest.approx(own * 1026.0 * turns**2 * 0.14**4)
    bollard = thrust_over_speed(0.14, 1.0, 0.718, 3, 25.0, 0.0, 1026.0)
    assert bollard[-1, 1] == pytest.approx(0.4566 * 1026.0 * 25.0**2 * 0.14**4, rel=2e-4)
    with pytest.raises(InputError, match="brakes"):
        thrust_over_speed(0.14, 1.0, 0.718, 3, 5.0, 1.5, 1026.0)


def test_side_area_is_what_blade_elements_feel_that_turn() -> None:
    """Blades of constant pitch without load, in a stream with a small cross velocity, element by element, round the circle."""
    ahead, aside, radius, steps = 2.0, 1e-4, 0.15, 240
    turning = ahead / (PITCH * 2.0 * radius / (2.0 * np.pi))  # no load at any radius
    r = radius * (0.2 + 0.8 * (np.arange(200) + 0.5) / 200)
    chord = AREA * np.pi * radius**2 / (BLADES * 0.8 * radius)
    slope = 2.0 * np.pi * 8.0 / 10.0
    force = 0.0
    for angle in 2.0 * np.pi * (np.arange(steps) + 0.5) / steps:
        across = turning * r + aside * np.cos(angle)
        flow = np.arctan2(ahead, across)
        pitch = np.arctan2(PITCH * radius / np.pi, r)
        lift = 0.5 * chord * slope * (pitch - flow) * (ahead**2 + across**2)
        drag = -lift * np.sin(flow)  # against the way that the blade goes
        force += BLADES / steps * float(np.mean(drag * np.cos(angle))) * 0.8 * radius
    found = -force / (0.5 * ahead * aside * np.pi * radius**2)
    assert propeller.side_area(PITCH, AREA) == pytest.approx(found, rel=2e-3)


def test_both_works_agree_on_blades_as_narrow_as_those_of_aircraft() -> None:
    for pitch in (0.8, 1.0, 1.4):
        assert propeller.de_young(pitch, 0.25) == pytest.approx(propeller.side_area(pitch, 0.25), rel=0.05)
    assert propeller.de_young(1.0, 0.8) < propeller.side_area(1.0, 0.8)


def test_thrust_raises_the_force_as_ribner_has_it() -> None:
    for loading in (0.0, 0.3, 1.0, 4.0):
        a = (np.sqrt(1.0 + loading) - 1.0) / 2.0
        ribner = (1 + a) * ((1 + a) + (1 + 2 * a) ** 2) / (1 + (1 + 2 * a) ** 2)
        assert propeller.inflow_factor(loading) == pytest.approx(ribner, rel=1e-12)


def test_a_propeller_astern_damps_and_steadies() -> None:
    with_it, bare = (
        estimated(replace(body_of(outline(*tail(), propellers=p)), scaling=Scaling(4.0, "length")), WATER).coefficients
        for p in ((SCREW,), ())
    )

    def change(symbol: str) -> float:
        own, other = with_it[symbol].value, bare[symbol].value
        return float(own or np.nan) - float(other or np.nan)

    assert change("Yv") < 0.0
    assert change("Nv") > 0.0
    assert change("Yr") > 0.0
    assert change("Nr") < 0.0
    assert change("Zw") < 0.0
    assert change("Mw") < 0.0
    assert change("Mq") < 0.0
    # The disc lies 2.05 m aft of the reference point.
    assert change("Nv") == pytest.approx(change("Yv") * (-4.05 + 2.0) / 4.0, rel=1e-3)
    assert change("X0") == pytest.approx(0.0, abs=1e-12)


def test_force_of_a_propeller_by_hand() -> None:
    free = replace(SCREW, centre=np.array([-30.0, 0.0, 0.0]))  # far from hull and fins
    made = propeller.contributions(outline(propellers=(free,)), WATER)
    assert len(made) == 4
    nu = np.array([[2.0, 0.1, 0.0, 0.0, 0.0, 0.0], [-2.0, 0.1, 0.0, 0.0, 0.0, 0.0]])
    for c in made:
        slope = propeller.de_young(1.0, 0.5) if "Young" in c.method else propeller.side_area(1.0, 0.5)
        area = slope * np.pi / 4.0 * 0.3**2 * propeller.inflow_factor(0.5)
        force = c.forces(nu, {})
        assert force[0, 1] == pytest.approx(-0.5 * WATER.density * area * 2.0 * 0.1)
        assert force[0, 5] == pytest.approx(-30.0 * force[0, 1])
        assert not force[1].any()
        assert "broader" in c.outside
    behind = propeller.contributions(
        outline(*tail(), propellers=(replace(SCREW, centre=np.array([-3.8, 0, 0])),)), WATER
    )
    assert abs(behind[0].forces(nu, {})[0, 1]) < abs(made[0].forces(nu, {})[0, 1])


def test_which_thrusters_are_seen() -> None:
    screw = Screw(0.2, 3, 1.0, 0.5)
    astern = Thruster(
        "main", np.array([-4.1, 0, 0]), np.array([1.0, 0, 0]), np.array([[0.0, 0], [1, 1]]), "speed", "rpm"
    )
    seen = with_propellers(outline(), (replace(astern, screw=screw), replace(astern, axis=np.array([0.0, 1, 0]))))
    assert [p.name for p in seen.propellers] == ["main"]
    assert seen.left_out == ()
    assert "without [thruster.propeller]" in with_propellers(outline(), (astern,)).left_out[0]
    ducted = replace(astern, screw=screw, place=RING.centre)
    found = with_propellers(outline(rings=(RING,)), (ducted,))
    assert found.propellers == ()
    assert "duct" in found.left_out[0]
    assert with_propellers(outline(hulls=()), (astern,)).left_out == ()


BODY = """
[body]
name = "small"
title = "Small"
reader = "primitives"
datum = "nose"
reference_point = [-0.5, 0.0, 0.0]
[source]
citation = "none"
kind = "synthetic"
[[part]]
name = "hull"
form = "spheroid"
length = 1.0
diameter = 0.2
centre = [-0.5, 0.0, 0.0]
[[thruster]]
name = "main"
place = [-1.02, 0.0, 0.0]
axis = [1.0, 0.0, 0.0]
propeller = {diameter = "120 mm", blades = 3, pitch_ratio = 1.0, area_ratio = 0.5, highest_rpm = 2000}
"""


def test_a_body_file_with_a_propeller(tmp_path: Path) -> None:
    file = tmp_path / "body.toml"
    file.write_text(BODY)
    (one,) = read_body(file).thrusters
    curve = one.thrusts(1.0, 1000.0)
    assert curve[-1, 0] == pytest.approx(2000.0)
    seen = read_body(file).outline
    assert seen.propellers[0].diameter == pytest.approx(0.12)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("blades = 3", "blades = 3.5", "whole number"),
        ("blades = 3, ", "", "blades"),
        ("pitch_ratio = 1.0", "pitch_ratio = 2.0", "0.5 to 1.4"),
        (", highest_rpm = 2000", "", "no curve"),
        ("[[thruster]]", "[[thruster]]\ncurve = [[0, 0], [100, 1]]", "both curve and highest_rpm"),
        ("axis = [1.0", "axis = [-1.0", "no thrust ahead"),
        ('diameter = "120 mm"', "diameter = 0.0", "above zero"),
    ],
)
def test_a_propeller_that_makes_no_sense_is_refused(tmp_path: Path, old: str, new: str, words: str) -> None:
    file = tmp_path / "body.toml"
    file.write_text(BODY.replace(old, new))
    with pytest.raises(InputError) as caught:
        read_body(file)
    assert words in str(caught.value)


OPEN_WATER = "[[0.0, 0.40, 0.05], [0.5, 0.225, 0.035], [1.0, 0.05, 0.02]]"
KEYS = """[[thruster]]
name = "main"
place = [0.0, 0.0, 0.0]
axis = [1.0, 0.0, 0.0]
handedness = -1
[thruster.propeller]
diameter = "0.2 m"
blades = 3
pitch_ratio = 1.0
area_ratio = 0.6
highest_rpm = 1200
open_water = OPEN
"""


def _with(tmp_path: Path, rows: str) -> Body:
    text = (shipped("geometry") / "finned_spheroid" / "body.toml").read_text(encoding="utf-8")
    head = text.partition("[[thruster]]")[0]
    (tmp_path / "body.toml").write_text(f"{head}\n{KEYS.replace('OPEN', rows)}")
    return read_body(tmp_path / "body.toml")


def test_open_water_of_ones_own_gives_thrust_and_torque(tmp_path: Path) -> None:
    """n 20 /s, D .2 m, 2 m/s: J .5; .225 * 1000 * 400 * .0016 = 144 N, .035 * 1000 * 400 * .00032 = 4.48 N m against +x."""
    (thruster,) = _with(tmp_path, OPEN_WATER).thrusters
    made = parameter_thruster(thruster, np.zeros(3), Conditions(1000.0, 2.0))
    assert made.curve.at(1200.0) == pytest.approx(144.0)
    assert made.torque_curve.at(1200.0) == pytest.approx(4.48)
    assert made.handedness == -1
    assert made.curve.at(599.0) == pytest.approx(0.0, abs=1e-9)  # J 1 at 600 rpm: nothing is known of what is slower
    (short,) = _with(tmp_path, "[[0.0, 0.40], [1.0, 0.05]]").thrusters
    assert parameter_thruster(short, np.zeros(3), Conditions(1000.0, 2.0)).torque_curve is None


@pytest.mark.parametrize(
    "rows",
    ["[[0.0, 0.4]]", "[[0.1, 0.4], [0.5, 0.2]]", "[[0.0, 0.4], [0.5, 0.45]]", "[[0.0, 0.4], [0.5, 0.2, 0.03]]", "[[0.0, 0.4], [0.5, -0.1]]", '"x"'],
)  # fmt: skip
def test_what_is_no_open_water_is_refused(tmp_path: Path, rows: str) -> None:
    with pytest.raises(InputError) as refused:
        _with(tmp_path, rows)
    assert (refused.value.column or "").endswith("open_water")
    assert refused.value.line
