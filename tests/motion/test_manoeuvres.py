"""Figures of manoeuvres against closed forms, and what they do not depend on."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from coeflab.core.errors import InputError
from coeflab.core.files import shipped
from coeflab.motion.manoeuvre import Figure, Simulation
from coeflab.motion.manoeuvres import MANOEUVRES
from coeflab.motion.simulation import rolls, simulate
from coeflab.vehicle.parameter_file import ParameterFile, read_parameter_file
from coeflab.vehicle.parameter_parts import ParameterHydrostatics
from tests.motion.vehicles import DENSITY, INERTIA, LENGTH, MASS, SPEED, STABLE, UNSTABLE, made, with_limits

Q = 0.5 * DENSITY * LENGTH**2
HORIZONTAL = ("u", "v", "r")


def figures(found: Simulation) -> dict[str, Figure]:
    return {f.name: f for f in found.figures}


def value(found: Simulation, name: str) -> float:
    figure = figures(found)[name]
    assert figure.value is not None, (name, figure.status, figure.why)
    return figure.value


def run(file: ParameterFile, manoeuvre: str, free: tuple[str, ...] = HORIZONTAL, **options: Any) -> Simulation:
    return simulate(file, manoeuvre, options, free=free)


def test_the_approach_thrust_keeps_the_speed() -> None:
    found = run(made(), "straight_run", duration=30.0)
    assert value(found, "steady speed") == pytest.approx(SPEED, rel=1e-9)
    assert value(found, "distance") == pytest.approx(30.0 * SPEED, rel=1e-9)
    assert value(found, "deviation") == 0.0


@pytest.mark.parametrize("astern", [0.5, 1.0, 3.0])
def test_stopping_against_the_closed_form(astern: float) -> None:
    """m du/dt = -T - k u^2: t = m / sqrt(k T) [atan(u sqrt(k/T))], s = m / 2k ln((T + k u0^2) / (T + k u1^2))."""
    k = 4e-3 * Q
    thrust, last = astern * k * SPEED**2, 0.01 * SPEED
    found = run(made(), "stop", astern=astern)
    root = np.sqrt(k / thrust)
    time = MASS / np.sqrt(k * thrust) * (np.arctan(SPEED * root) - np.arctan(last * root))
    reach = MASS / (2.0 * k) * np.log((thrust + k * SPEED**2) / (thrust + k * last**2))
    assert value(found, "stopping time") == pytest.approx(time, rel=1e-6)
    assert value(found, "track reach") == pytest.approx(reach, rel=1e-5)
    assert value(found, "head reach") == pytest.approx(reach, rel=1e-5)


def test_without_thrust_a_quadratic_resistance_never_stops_it() -> None:
    found = figures(run(made(), "stop", astern=0.0, longest=50.0))
    assert {f.status for f in found.values()} == {"not reached"}
    assert "after 50 s" in found["track reach"].why


def test_a_small_steady_turn_is_the_linear_one() -> None:
    """0 = Yv v + (Yr - m') r + Ydr d and 0 = Nv v + Nr r + Ndr d, primed, x_G = 0; from the primes, not the simulator."""
    rudder = np.radians(1.0)
    m = MASS / (0.5 * DENSITY * LENGTH**3)
    a = np.array([[STABLE["Yv"], STABLE["Yr"] - m], [STABLE["Nv"], STABLE["Nr"]]])
    v, r = np.linalg.solve(a, -np.array([STABLE["Ydr"], STABLE["Ndr"]]) * -rudder)
    found = simulate(
        made(), "turning_circle", {"rudder": rudder, "turns": 0.5, "longest": 4000.0}, hold=("u",), free=HORIZONTAL
    )
    assert r > 0.0
    assert value(found, "steady turning diameter") == pytest.approx(2.0 * LENGTH / r, rel=2e-3)
    assert value(found, "steady drift") == pytest.approx(np.arcsin(v), rel=1e-3)
    assert value(found, "tactical diameter") == pytest.approx(2.0 * LENGTH / r, rel=0.1)
    assert value(found, "advance") == pytest.approx(LENGTH / r, rel=0.1)


def test_port_is_the_mirror_image_of_starboard() -> None:
    pair = [figures(run(made(), "turning_circle", rudder=0.2, side=side)) for side in ("starboard", "port")]
    for name, figure in pair[0].items():
        other = pair[1][name].value
        assert other is not None
        mirrored = -other if name in ("steady yaw rate", "steady drift") else other
        assert figure.value == pytest.approx(mirrored, rel=1e-5), name


BRIEF: dict[str, dict[str, Any]] = {"spiral": {"steps": 1, "hold": 10.0}, "pull_out": {"turn": 5.0, "after": 10.0}}


@pytest.mark.parametrize("name", ["turning_circle", "zigzag", "spiral", "pull_out"])
def test_the_sign_that_a_source_gives_its_rudder_does_not_matter(name: str) -> None:
    """Half of the literature calls a rudder to port positive; the same vehicle turns to the same side."""
    other = {s: -v if s.endswith("dr") else v for s, v in STABLE.items()}
    found, mirrored = (run(made(values), name, **BRIEF.get(name, {})) for values in (STABLE, other))
    for a, b in zip(found.figures, mirrored.figures, strict=True):
        assert (a.name, a.status) == (b.name, b.status)
        assert a.value == pytest.approx(b.value, rel=1e-9, abs=1e-12)
    assert found.trajectory.heading[5] > 0.0


def test_the_zigzag_reverses_at_its_angles() -> None:
    found = run(made(), "zigzag", rudder="20 deg", heading="15 deg", executes=5)
    t = found.trajectory
    assert value(found, "first overshoot") > 0.0
    for k, when in enumerate(t.reached[:4]):
        assert when is not None
        psi = np.interp(when, t.time, t.heading)
        assert psi == pytest.approx((-1.0) ** k * np.radians(15.0), abs=1e-4)
    assert value(found, "initial turning time") < value(found, "reach")
    assert np.max(np.abs(t.controls["dr"])) == pytest.approx(np.radians(20.0))


def test_a_slow_rudder_overshoots_more() -> None:
    quick = value(run(with_limits(made(), 0.5, None), "zigzag"), "first overshoot")
    slow = value(run(with_limits(made(), 0.5, np.radians(3.0)), "zigzag"), "first overshoot")
    assert slow > quick + np.radians(0.5)


@pytest.mark.parametrize(
    ("manoeuvre", "control"),
    [
        ("zigzag", "rudder (dr)"), ("turning_circle", "rudder (dr)"), ("pull_out", "rudder (dr)"), ("spiral", "rudder (dr)"),
        ("depth_change", "stern planes (ds)"), ("straight_run", ""),
    ],
)  # fmt: skip
def test_a_surface_of_infinite_rate_is_said(manoeuvre: str, control: str) -> None:
    free = ("u", "w", "q") if "ds" in control else HORIZONTAL
    said = [s for s in run(made(metacentric=0.02), manoeuvre, free).statements if "infinite rate" in s]
    assert len(said) == (1 if control else 0)
    assert all(s.startswith(f"{control} at the ordered angle at once: the file states no rate") for s in said)


def test_a_stated_rate_is_no_assumption_and_a_limit_alone_is_none() -> None:
    rated, limited = (run(with_limits(made(), 0.5, rate), "zigzag").statements for rate in (0.1, None))
    assert not any("infinite rate" in s for s in rated)
    assert any("infinite rate" in s for s in limited)


def test_works_of_manoeuvre_and_simulator_go_with_the_simulation() -> None:
    found = run(made(), "zigzag")
    assert {"imo_msc137", "ittc_free_running", "fossen2011", "hindmarsh1983"} <= set(found.citations)


def test_a_stable_vehicle_has_no_loop_and_no_residual_rate() -> None:
    spiral = run(made(), "spiral", steps=1, hold=25.0)
    assert value(spiral, "loop height") == pytest.approx(0.0, abs=1e-5)
    right, left = value(spiral, "yaw rate at +15 deg, down"), value(spiral, "yaw rate at -15 deg, down")
    assert right > 0.0
    assert left == pytest.approx(-right, rel=1e-4)
    out = run(made(), "pull_out")
    assert value(out, "residual yaw rate, starboard") == pytest.approx(0.0, abs=1e-6)


def test_an_unstable_one_with_a_limit_in_r_has_both() -> None:
    """A term in r|r| ends the growth, so loop and residual rates are determined: 0 = N + steady Y by elimination."""
    limited = made({**UNSTABLE, "Nr|r|": -4e-2})
    spiral = run(limited, "spiral", steps=1, largest="30 deg", hold=25.0)
    assert value(spiral, "loop height") > 0.05
    out = run(limited, "pull_out")
    right, left = value(out, "residual yaw rate, starboard"), value(out, "residual yaw rate, port")
    assert right > 0.0
    assert left == pytest.approx(-right, rel=1e-3)
    assert value(spiral, "loop height") == pytest.approx(2.0 * right, rel=1e-3)


@pytest.mark.parametrize(
    ("name", "lost"),
    [("turning_circle", "steady turning diameter"), ("spiral", "loop height"), ("pull_out", "residual yaw rate, port")],
)
def test_an_unstable_one_without_such_a_term_is_not_determined(name: str, lost: str) -> None:
    found = run(made(UNSTABLE), name, **BRIEF.get(name, {}))
    figure = figures(found)[lost]
    assert (figure.value, figure.status) == (None, "not determined")
    assert "no data on r'" in figure.why


def test_a_dive_mirrors_a_rise() -> None:
    dive = run(made(), "depth_change", ("u", "w", "q"))
    rise = run(made(), "depth_change", ("u", "w", "q"), way="rise")
    for a, b in zip(dive.figures, rise.figures, strict=True):
        assert a.value == pytest.approx(b.value, rel=1e-6), a.name
    assert dive.trajectory.position[-1, 2] > 0.0 > rise.trajectory.position[-1, 2]
    assert value(dive, "depth at the end") == pytest.approx(dive.trajectory.position[-1, 2])
    assert "first passes zero" in next(f.definition for f in dive.figures if f.name == "time to level")


def test_the_period_of_a_free_roll() -> None:
    """Small undamped roll: T = 2 pi sqrt(Ix / (m g BG))."""
    lever = 0.02
    found = run(made(metacentric=lever), "free_decay", ("p",), angle="1 deg", duration=30.0)
    period = 2.0 * np.pi * np.sqrt(INERTIA[0, 0] / (MASS * 9.81 * lever))
    assert value(found, "period") == pytest.approx(period, rel=1e-4)
    assert value(found, "damping ratio") == pytest.approx(0.0, abs=1e-4)


def pitched(ahead: float) -> ParameterFile:
    """The vehicle with a centre of buoyancy ahead of that of gravity and 0.02 m above it: nose up at rest."""
    file = made()
    apart = ParameterHydrostatics(volume=MASS / DENSITY, centre_of_buoyancy=(ahead, 0.0, -0.02), gravity=9.81)
    return file.model_copy(update={"hydrostatics": apart})


def test_a_turn_that_dives_has_the_diameter_of_its_track() -> None:
    found = run(pitched(-0.01), "turning_circle", tuple("uvwpqr"), turns=4.0)
    motion = found.trajectory
    last = motion.heading > motion.heading[-1] - 2.0 * np.pi
    assert np.degrees(motion.angles[-1, 1]) < -15.0
    across = float(np.ptp(motion.position[last, 1]))
    assert value(found, "steady turning diameter") == pytest.approx(across, rel=2e-3)
    turned = float(motion.heading[-1] - motion.heading[last][0]) / float(motion.time[-1] - motion.time[last][0])
    assert value(found, "steady yaw rate") == pytest.approx(turned, rel=2e-3)


def test_spiral_and_circle_speak_of_the_same_rate_where_the_turn_dives() -> None:
    turned = run(pitched(-0.01), "turning_circle", tuple("uvwpqr"), turns=4.0, rudder=0.1)
    swept = run(pitched(-0.01), "spiral", tuple("uvwpqr"), largest=0.1, steps=1)
    (first, *_) = swept.figures
    assert first.value == pytest.approx(value(turned, "steady yaw rate"), rel=2e-3)


def test_a_run_astern_is_beyond_the_data_in_all_its_figures() -> None:
    found = run(made(), "straight_run", commands="thrust=-30", duration=60.0)
    assert found.trajectory.velocity[-1, 0] < 0.0
    assert {f.status for f in found.figures} == {"extrapolated"}


def test_a_zigzag_of_20_deg_of_rudder_is_20_20() -> None:
    """Its heading stayed at 10 deg."""
    motion = run(made(), "zigzag", rudder="20 deg").trajectory
    at = np.array([np.interp(t, motion.time, motion.heading) for t in motion.reached if t is not None])
    np.testing.assert_allclose(np.degrees(at), [20.0, -20.0, 20.0, -20.0, 20.0], rtol=1e-6)
    stated = run(made(), "zigzag", rudder="20 deg", heading="10 deg").trajectory
    assert np.degrees(np.interp(stated.reached[0] or 0.0, stated.time, stated.heading)) == pytest.approx(10.0)


@pytest.mark.parametrize("commands", ["left=30 right=60", "left=60 right=30"])
def test_thrusters_that_mirror_each_other_steer_a_zigzag(commands: str) -> None:
    file = read_parameter_file(shipped("cfd_data") / "huuv" / "huuv.parameters.json")
    found = run(file, "zigzag", commands=commands)
    motion = found.trajectory
    at = np.array([np.interp(t, motion.time, motion.heading) for t in motion.reached if t is not None])
    np.testing.assert_allclose(np.degrees(at), [10.0, -10.0, 10.0, -10.0, 10.0], rtol=1e-6)
    assert motion.controls["left"][0] == 60.0
    assert value(found, "first overshoot") > 0.0
    with pytest.raises(InputError, match="turns to neither side"):
        run(file, "zigzag", commands="left=30 right=30")


@pytest.mark.parametrize("commands", ["left=0 right=60", "left=60 right=0", {"left": 60, "right": 0}])
def test_a_circle_steered_by_thrusters_ends_after_its_turns(commands: object) -> None:
    """It ran until its longest time: 85 turns for the two that were asked for."""
    file = read_parameter_file(shipped("cfd_data") / "huuv" / "huuv.parameters.json")
    motion = run(file, "turning_circle", commands=commands, turns=2.0).trajectory
    assert motion.reached[0] is not None
    assert abs(motion.heading[-1]) == pytest.approx(4.0 * np.pi, rel=1e-9)
    assert np.sign(motion.heading[-1]) == (-1.0 if commands == "left=0 right=60" else 1.0)


def test_what_does_not_turn_is_not_said_to_change() -> None:
    found = figures(run(made(), "turning_circle", commands="thrust=9", longest=400.0))
    assert found["steady turning diameter"].why == "the vehicle does not turn"


def test_rounding_of_a_command_is_no_turn() -> None:
    file = read_parameter_file(shipped("cfd_data") / "huuv" / "huuv.parameters.json")
    found = figures(run(file, "turning_circle", commands="left=59.999999999 right=60", longest=100.0))
    assert found["steady turning diameter"].value is None
    assert found["steady turning diameter"].why == "the vehicle does not turn"


def test_a_free_pitch_decays_about_its_own_angle_of_rest() -> None:
    """Small swings at speed zero have no damping here; T = 2 pi sqrt(Iy / (m g BG))."""
    found = run(pitched(0.01), "free_decay", ("q",), motion="pitch", angle=float(np.arctan(0.5)) + 0.02)
    lever = float(np.hypot(0.01, 0.02))
    assert value(found, "period") == pytest.approx(
        2.0 * np.pi * np.sqrt(INERTIA[1, 1] / (MASS * 9.81 * lever)), rel=1e-3
    )
    assert value(found, "damping ratio") == pytest.approx(0.0, abs=1e-3)


def test_a_current_is_said_beside_the_distances_that_hold_it() -> None:
    still = simulate(made(), "turning_circle", {}, free=HORIZONTAL)
    drifted = simulate(made(), "turning_circle", {}, {"north": 0.25, "east": -0.125}, free=HORIZONTAL)
    assert any("current of 0.25 north, -0.125 east m/s" in s for s in drifted.statements)
    assert not any("current" in s for s in still.statements)
    gained = value(drifted, "advance") - value(still, "advance")
    assert gained == pytest.approx(0.25 * value(still, "time to 90 deg"), rel=1e-6)
    assert value(drifted, "steady turning diameter") == pytest.approx(value(still, "steady turning diameter"), rel=1e-6)


def test_figures_beyond_the_data_say_so() -> None:
    found = figures(run(made(), "turning_circle", rudder=0.2))
    assert found["advance"].status == "extrapolated"
    assert found["advance"].why == "no data on v', r', rudder angle"
    stopped = run(made(), "stop")
    assert {f.status for f in stopped.figures} == {"extrapolated"}
    assert {f.why for f in stopped.figures} == {"no force table stands behind the file"}
    assert all(v[0] for v in stopped.trajectory.outside.values() if v.any())
    assert f"stopped where u is down to 0.01 of the approach speed of {SPEED:g} m/s" in stopped.statements


@pytest.mark.parametrize(
    ("manoeuvre", "values", "options", "says"),
    [
        ("zigzag", {k: v for k, v in STABLE.items() if not k.endswith("dr")}, {}, "no coefficient of dr"),
        ("depth_change", {k: v for k, v in STABLE.items() if not k.endswith("ds")}, {}, "no coefficient of ds"),
        ("zigzag", {k: v for k, v in STABLE.items() if k != "X0"}, {}, "a resistance of -0 N"),
        ("zigzag", STABLE, {"ruder": 0.1}, "unknown option"),
        ("zigzag", STABLE, {"rudder": "200 deg"}, "200 deg"),
        ("turning_circle", STABLE, {"commands": "left=1"}, 'the command "left"'),
        ("turning_circle", STABLE, {"commands": "left"}, 'found "left"; expected NAME=NUMBER'),
        ("turning_circle", STABLE, {"commands": "thrust=1 thrust=2"}, 'found "thrust" twice'),
        ("free_decay", STABLE, {}, "p held"),
        ("glide", STABLE, {}, "does not glide"),
    ],
)
def test_what_cannot_be_done(manoeuvre: str, values: dict[str, float], options: dict[str, Any], says: str) -> None:
    free = ("u", "w", "q") if manoeuvre == "depth_change" else HORIZONTAL
    with pytest.raises(InputError, match=says):
        simulate(made(values), manoeuvre, options, free=free)


def test_a_rudder_beyond_its_limit_is_refused() -> None:
    with pytest.raises(InputError, match="at most 10 deg, the limit of dr"):
        run(with_limits(made(), np.radians(10.0), None), "turning_circle", rudder="15 deg")


def test_every_manoeuvre_is_tried_here() -> None:
    assert set(MANOEUVRES.names()) == {
        "depth_change", "free_decay", "glide", "medium_change", "pull_out", "spiral", "steady_motion", "stern_plane_jam", "stop",
        "straight_run", "turning_circle", "zigzag",
    }  # fmt: skip  # medium_change in test_media.py, stern_plane_jam in a file of its own


def test_a_steady_motion_holds_a_helix() -> None:
    """Radius u / r, and a descent of w in a level attitude; the path of constant velocities is the helix."""
    turn = np.radians(20.0)
    asked = {"speed": 0.5, "heave": 0.06, "yaw_rate": turn, "duration": 18.0, "starts": 0}
    found = simulate(read_parameter_file(Path("flyingfish_water")), "steady_motion", asked)
    held = {f.name: f.value for f in found.figures}
    assert held["radius"] == pytest.approx(0.5 / turn)
    assert held["descent a turn"] == pytest.approx(0.06 * 18.0)
    assert held["departure from the path"] < 1e-6
    half = int(np.argmin(np.abs(found.trajectory.time - 9.0)))
    time = found.trajectory.time[half]
    due = [np.sin(turn * time) * 0.5 / turn, (1.0 - np.cos(turn * time)) * 0.5 / turn, 0.06 * time]
    assert found.trajectory.position[half] == pytest.approx(due, abs=1e-6)


def test_a_steady_motion_that_nothing_keeps_is_refused() -> None:
    with pytest.raises(InputError, match="no such steady motion"):
        simulate(made(), "steady_motion", {"speed": 1.0, "sway": 1.0, "starts": 0}, free=HORIZONTAL)


def test_a_roll_that_oscillates_is_said() -> None:
    """Twenty half periods of 0.65 s with swings of 12 deg/s; swings of 4 deg/s are small."""
    t = np.linspace(0.0, 13.0, 2001)
    straight = simulate(made(), "straight_run", {"duration": 13.0}, free=("u", "v", "r")).trajectory

    def rolling(amplitude: float) -> str:
        velocity = np.zeros((len(t), 6))
        velocity[:, 3] = np.radians(amplitude) * np.cos(2.0 * np.pi * t / 1.3)
        upright = np.tile([1.0, 0.0, 0.0, 0.0], (len(t), 1))
        return rolls(replace(straight, time=t, velocity=velocity, attitude=upright))

    said = [float(word) for word in re.findall(r"[\d.]+", rolling(6.0))]
    assert said == pytest.approx([18, 5, 12, 1.3, 0])
    assert rolling(2.0) == ""


def test_the_roll_of_remus_in_its_zigzag_is_said() -> None:
    said = simulate(read_parameter_file(Path("remus100")), "zigzag", {"executes": 3}).statements
    assert any(line.startswith("roll rate oscillates") for line in said)


def test_a_turn_whose_pitch_swings_says_so_and_what_to_do() -> None:
    """REMUS 100 in six motions: pitch has poles of +0.42 +- 0.21i, and the turn settles in the horizontal plane alone."""
    file = read_parameter_file(Path("remus100"))
    asked = {"rudder": np.radians(5.0)}
    (steady,) = (f for f in simulate(file, "turning_circle", asked).figures if f.name == "steady turning diameter")
    assert steady.value is None
    assert "in the last tenth; pitch swings by +-" in steady.why
    assert steady.why.endswith("In the horizontal plane alone: --free u,v,r")
    flat = simulate(file, "turning_circle", asked, free=HORIZONTAL)
    (settled,) = (f for f in flat.figures if f.name == "steady turning diameter")
    assert settled.value is not None
