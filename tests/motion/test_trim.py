"""Trims of vehicles whose steady motions are known in closed form, and of the TJ-FlyingFish by another route."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from coeflab.core.errors import InputError
from coeflab.motion.trim.moves import Scaled, restored
from coeflab.motion.trim.operating_point import Outcome
from coeflab.motion.trim.trim import trim
from coeflab.motion.vehicle import Vehicle, vehicle
from coeflab.published.flyingfish.model import CONSTANTS, read_flyingfish
from coeflab.published.flyingfish.rotors import steady_residuals
from tests.motion.trimmed import flyingfish_file, parameter_file

MASS, TURNING = 20.0, (1.0, 4.0, 5.0)
PLANE = {"Xu|u|": -10.0, "Yv|v|": -80.0, "Nr|r|": -6.0}
LEVER, PUSH = 0.3, 0.2


def thruster(name: str, y: float) -> dict[str, object]:
    """0.2 N per percent, none within 5 % of zero."""
    segments = [
        {"low": -100.0, "high": -5.0, "coefficients": [0.0, PUSH]},
        {"low": 5.0, "high": 100.0, "coefficients": [0.0, PUSH]},
    ]
    curve = {"command": "power", "unit": "%", "segments": segments}
    return {"name": name, "position": [0.0, y, 0.0], "direction": [1.0, 0.0, 0.0], "curve": curve}


def twin(si: dict[str, float] | None = None, **more: object) -> Vehicle:
    pair = [thruster("left", -LEVER), thruster("right", LEVER)]
    return vehicle(parameter_file(si or PLANE, MASS, TURNING, thrusters=pair, **more), ("u", "v", "r"))


def test_a_straight_run_takes_its_resistance_in_equal_parts() -> None:
    got = trim(twin(), {"u": 1.5, "yaw_rate": 0.0})
    assert got.point.outcome is Outcome.UNIQUE
    each = 10.0 * 1.5**2 / 2.0 / PUSH
    assert got.point.values["left"] == pytest.approx(each, rel=1e-8)
    assert got.point.values["right"] == pytest.approx(each, rel=1e-8)
    assert got.figures["radius"][0] is None
    assert got.figures["beta"][0] == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("power", [1.5, 3.0])
def test_equal_thrusters_push_alike_whatever_their_curve(power: float) -> None:
    """Least squares of commands favoured one thruster where thrust rises faster than with the square (T = c n^3: all on one)."""
    pair = [thruster("left", -LEVER), thruster("right", LEVER)]
    points = [0.0, 25.0, 50.0, 75.0, 100.0]
    thrust = [20.0 * (n / 100.0) ** power for n in points]
    segments = [
        {"low": a, "high": b, "coefficients": [s - (t - s) / (b - a) * a, (t - s) / (b - a)]}
        for a, b, s, t in zip(points, points[1:], thrust, thrust[1:], strict=False)
    ]
    for one in pair:
        one["curve"] = {"command": "power", "unit": "%", "segments": segments}
    slopes = {"Xu|u|": -10.0, "Yv": -40.0, "Nv": -3.0, "Yr": 1.0, "Nr": -6.0}
    craft = vehicle(parameter_file(slopes, MASS, TURNING, thrusters=pair), ("u", "v", "r"))
    for speed in (1.0, 1.5):
        got = trim(craft, {"u": speed})
        left, right = got.commands.values()
        assert left == pytest.approx(right, rel=1e-7)
        assert np.interp(left, points, thrust) == pytest.approx(10.0 * speed**2 / 2.0, rel=1e-7)


@pytest.mark.slow
def test_equal_commands_give_the_speed_at_which_resistance_is_thrust() -> None:
    got = trim(twin(), {}, {"left": 50.0, "right": 50.0})
    assert got.point.values["u"] == pytest.approx(np.sqrt(2.0 * PUSH * 50.0 / 10.0), rel=1e-8)
    assert got.point.values["yaw_rate"] == pytest.approx(0.0, abs=1e-8)
    assert got.point.outcome is Outcome.SINGULAR  # damping by v|v| and r|r| alone has no slope at rest


def test_opposite_commands_turn_the_vehicle_on_the_spot() -> None:
    got = trim(twin(), {}, {"left": 60.0, "right": -60.0})
    assert got.velocity[5] == pytest.approx(np.sqrt(2.0 * PUSH * 60.0 * LEVER / 6.0), rel=1e-7)
    assert got.velocity[:2] == pytest.approx([0.0, 0.0], abs=1e-6)


def test_a_turn_by_one_thruster_leaves_no_acceleration_and_a_radius() -> None:
    craft = twin()
    got = trim(craft, {}, {"left": 60.0})
    assert got.point.values["right"] == 0.0
    wrench = craft.wrench({"left": 60.0})
    rest = craft.acceleration(got.velocity[None, :], np.array([[1.0, 0, 0, 0]]), np.zeros((1, 3)), wrench)
    assert rest == pytest.approx(np.zeros((1, 6)), abs=1e-8)
    assert got.velocity[5] > 0.0
    radius = got.figures["radius"][0]
    assert radius == pytest.approx(np.hypot(*got.velocity[:2]) / got.velocity[5])


def test_a_speed_that_the_thrusters_cannot_give() -> None:
    got = trim(twin(), {"u": 4.0, "yaw_rate": 0.0}, starts=3)
    assert got.point.outcome is Outcome.INFEASIBLE
    assert got.point.violated[0].name == "surge force X"
    assert got.point.residuals["surge force X"] == pytest.approx(2.0 * PUSH * 100.0 - 160.0, rel=1e-6)
    assert {u.name for u, _ in got.point.saturated} == {"left", "right"}
    assert got.point.modes == ()


def test_a_thrust_inside_the_dead_zone_is_no_thrust() -> None:
    got = trim(twin(), {}, {"left": 4.0, "right": 4.0}, starts=2)
    assert got.point.values["u"] == pytest.approx(0.0, abs=1e-3)


def test_eigenvalues_of_a_straight_course_against_the_matrix_by_hand() -> None:
    """At V = 1 m/s: m v' = Yv v + (Yr - m) r, Iz r' = Nv v + Nr r; the surge mode is -2 a u / m."""
    yv, yr, nv, nr = -40.0, 5.0, 3.0, -12.0
    craft = twin({"Xu|u|": -10.0, "Yv": yv, "Yr": yr, "Nv": nv, "Nr": nr})
    got = trim(craft, {"u": 1.0, "yaw_rate": 0.0}, starts=0)
    by_hand = np.linalg.eigvals([[yv / MASS, (yr - MASS) / MASS], [nv / TURNING[2], nr / TURNING[2]]])
    wanted = sorted([*by_hand, -2.0 * 10.0 / MASS], key=lambda v: (-v.real, -v.imag))
    assert np.array(got.point.modes) == pytest.approx(np.array(wanted), abs=1e-6)
    assert got.point.growth == "stable"
    said = "Small motions by the rigid body alone, as in air: no added mass (Yvdot', Nrdot')."
    assert said in got.point.statements
    assert not [
        s
        for s in trim(replace(craft, density=1.2), {"u": 1.0, "yaw_rate": 0.0}, starts=0).point.statements
        if "in air" in s
    ]


def test_a_vehicle_that_does_not_keep_its_course_has_three_steady_motions() -> None:
    craft = twin({"Xu|u|": -10.0, "Yv": -40.0, "Nv": -30.0, "Nr": -6.0, "Nr|r|": -20.0})
    got = trim(craft, {}, {"left": 50.0, "right": 50.0}, starts=20)
    assert got.point.outcome is Outcome.SEVERAL
    assert got.point.values["yaw_rate"] == pytest.approx(0.0, abs=1e-6)
    assert got.point.growth == "unstable"
    turns = [values["yaw_rate"] for values, state in got.others if state == "stable"]
    assert sorted(np.sign(turns)) == [-1.0, 1.0]
    assert turns[0] == pytest.approx(-turns[1], rel=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("row", [0, 6, 9])
def test_the_flyingfish_as_a_vehicle_trims_as_its_corrected_equations(row: int) -> None:
    """Without linear damping, which a parameter file multiplies with V."""
    fish = read_flyingfish()
    rotors = replace(fish.rotors, linear=np.zeros(6))
    u, w, turn, roll, pitch = fish.motion[row]
    motion = {"u": u, "v": 0.0, "w": w, "yaw_rate": turn, "roll": roll, "pitch": pitch}
    near = {f"rotor{i + 1}": float(s) for i, s in enumerate(fish.speeds[row])}
    near |= {f"rotor{i + 1}.tilt": float(a) for i, a in enumerate(fish.angles[row])}
    got = trim(vehicle(flyingfish_file(fish, fish.constants)), motion, near=near, starts=0)
    assert got.point.outcome is Outcome.FAMILY
    assert got.point.dimension == 2
    angles = np.array([[got.point.values[f"rotor{i}.tilt"] for i in range(1, 5)]])
    speeds = np.array([[got.point.values[f"rotor{i}"] for i in range(1, 5)]])
    constants = np.array([fish.constants[c] for c in CONSTANTS])
    left = steady_residuals(rotors, constants, fish.motion[row : row + 1], angles, speeds, -1.0)
    assert np.max(np.abs(left)) < 1e-7


def test_free_roll_and_pitch_settle_where_buoyancy_holds_them() -> None:
    fish = read_flyingfish()
    got = trim(vehicle(flyingfish_file(fish, fish.constants)), {}, {"rotor1": 1000.0, "rotor2": 1000.0}, starts=2)
    assert got.point.outcome.solved
    assert got.point.values["roll"] == pytest.approx(0.0, abs=1e-6)
    assert got.point.growth in ("stable", "neutral")
    push = 2.0 * (2.5604e-7 * 1000.0**2 + 6.0355e-4 * 1000.0) - 1.6661
    assert got.point.values["w"] == pytest.approx(np.sign(push) * np.sqrt(abs(push) / 24.7142), rel=1e-5)


def test_motions_beyond_the_data_and_limits_that_are_assumed_are_said() -> None:
    covered = [{"variable": "r'", "low": -0.1, "high": 0.1, "unit": "1", "campaign": "arm"}]
    craft = vehicle(parameter_file({**PLANE, "Ndr": -3.0, "Ydr": 5.0}, MASS, TURNING, covered=covered), ("u", "v", "r"))
    said = " ".join(trim(craft, {"u": 1.0, "yaw_rate": 0.3}, starts=0).point.words())
    assert "r' = " in said
    assert "is outside the data, -0.1000 to 0.1000" in said
    assert "dr: no limit in the file, 30.0000 deg either way taken." in said
    assert "data cover" not in " ".join(trim(craft, {"u": 1.0, "yaw_rate": 0.05}, starts=0).point.words())


@pytest.mark.parametrize(
    ("motion", "commands", "near", "said"),
    [
        ({}, {}, {}, "neither a motion nor a command"),
        ({"speed": 1.0}, {}, {}, "speed"),
        ({}, {"middle": 1.0}, {}, "one of left, right"),
        ({}, {"left": 101.0}, {}, "-100.000 % to 100.000 %"),
        ({"u": 1.0}, {}, {"lft": 1.0}, "lft"),
        ({"u": 1.0, "v": 0.0, "yaw_rate": 0.0}, {"left": 1.0, "right": 1.0}, {}, "nothing to find"),
    ],
)
def test_requests_that_make_no_sense(
    motion: dict[str, float], commands: dict[str, float], near: dict[str, float], said: str
) -> None:
    with pytest.raises(InputError, match=said):
        trim(twin(), motion, commands, near)


def test_a_file_without_resistance_takes_no_thrust() -> None:
    """Yaw and sway alone have laws: the thrust of a straight run is zero, and no search for it fails."""
    si = {"Yv": -80.0, "Nr": -6.0, "Nv": -5.0, "Yr": 3.0, "Ndr": -30.0, "Ydr": 50.0}
    found = trim(vehicle(parameter_file(si, MASS, TURNING), ("u", "v", "r")), {"u": 2.0, "yaw_rate": 0.0}, starts=2)
    assert found.point.outcome.solved
    assert found.point.values["thrust"] == pytest.approx(0.0, abs=1e-6)
    assert next(row[1] for row in found.point.table().rows if row[0] == "thrust") == "0"
    assert any("surge has no law in the file" in line for line in found.point.words())
    drag = vehicle(parameter_file({**PLANE, "Ndr": -3.0}, MASS, TURNING), ("u", "v", "r"))
    assert not any(
        "surge has no law" in line for line in trim(drag, {"u": 2.0, "yaw_rate": 0.0}, starts=2).point.words()
    )


def test_a_start_far_away_has_the_steps_that_it_takes() -> None:
    """Newton's steps lessen x^11 by the factor (10/11)^11 each: a hundred from x = 1000 to what counts as zero."""
    problem = Scaled(
        lambda x: x**11, lambda x: 11.0 * x[:, None] ** 10, np.array([-1e4]), np.array([1e4]), np.zeros(1), np.ones(1)
    )
    assert restored(problem, np.array([1e3]))[1]
    assert not restored(problem, np.array([1e3]), 75)[1]
