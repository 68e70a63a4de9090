"""Masses of a twin-hull glider and its motion in space: the paper's equations 1 to 13, corrected, energy, and the spiral."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from coeflab.core.errors import InputError
from coeflab.core.files import shipped
from coeflab.glider.glide import GlideRun, steady_glides, steady_spirals
from coeflab.glider.glider import Glider
from coeflab.glider.glider_file import read_glider
from coeflab.glider.motion import Leg, Setting, momentum, rates
from coeflab.glider.simulators.glider import simulate
from coeflab.glider.space import (
    SpaceBody,
    Spiral,
    cruise,
    out_of_balance,
    rates_in_space,
    rotation,
    state_of,
    steady_spiral,
    unexplained_in_space,
    velocity_in_space,
)
from coeflab.glider.steady_glide import Polar
from coeflab.motion.manoeuvre import Manoeuvre

FILE = Path(str(shipped("cfd_data"))) / "thauv" / "case_02.toml"
GLIDER = read_glider(FILE)
STILL = Setting(0.0, 0.0)


def _space(glider: Glider = GLIDER) -> SpaceBody:
    assert glider.space is not None
    return glider.space


SPACE = _space()
MASSES = SPACE.masses
REST = MASSES.rest_place(0.3, 0.5)


def _euler(phi: float, theta: float, psi: float) -> np.ndarray:
    """The quaternion of roll, pitch and yaw."""
    (a, b), (c, d), (e, f) = ((np.cos(x / 2), np.sin(x / 2)) for x in (phi, theta, psi))
    return np.array([a * c * e + b * d * f, b * c * e - a * d * f, a * d * e + b * c * f, a * c * f - b * d * e])


def test_masses_as_printed() -> None:
    """Equation 1 with the numbers of section 2."""
    assert 2.0 * MASSES.piston == pytest.approx(1.022)
    assert MASSES.static == pytest.approx(65.33)
    assert MASSES.total == pytest.approx(66.352)


def test_centres_of_the_masses() -> None:
    """Equations 2 and 3 written out mass by mass."""
    d, gamma = 0.03, 0.6
    right, left = np.array([0.451252 + d, 0.25, 0.0]), np.array([0.451252 + d, -0.25, 0.0])
    roller = np.array([0.0, 0.25 + 0.05 * np.sin(gamma), 0.05 - (0.05 - 0.05 * np.cos(gamma))])
    by_hand = (0.511 * right + 0.511 * left + 1.04 * roller + 64.29 * REST) / 66.352
    assert MASSES.centre_of_gravity(d, gamma, REST) == pytest.approx(by_hand, abs=1e-15)
    assert MASSES.roller_place(gamma) == pytest.approx(roller, abs=1e-15)
    assert MASSES.static_centre(gamma, REST) == pytest.approx((1.04 * roller + 64.29 * REST) / 65.33, abs=1e-15)


def test_at_no_stroke_the_sums_of_the_masses_are_those_given() -> None:
    assert MASSES.moments(0.0, 0.0, REST) == pytest.approx([0.3, 0.0, 0.5], abs=1e-14)


def test_ballast_and_buoyancy() -> None:
    """Equations 5 to 7: 483 g of both engines at 0.03 m; weight and buoyancy differ by it, at the engines."""
    water = 1025.0 * np.pi * 0.05**2 * 0.03
    assert 2.0 * MASSES.ballast(0.03) == pytest.approx(2.0 * water)
    assert 2.0 * MASSES.ballast(0.03) == pytest.approx(0.483, abs=5e-4)
    assert MASSES.stroke(2.0 * water) == pytest.approx(0.03)
    assert MASSES.total - MASSES.displaced(0.03) == pytest.approx(2.0 * water)
    lost = -MASSES.displaced(0.03) * MASSES.centre_of_buoyancy(0.03)
    assert lost == pytest.approx([2.0 * water * 0.451252, 0.0, 0.0])


@pytest.mark.parametrize("phase", GLIDER.phases[::2], ids=lambda p: p.name)
def test_moments_of_the_mass_model_are_those_that_move_the_glider(phase) -> None:
    rest = GLIDER.rest_place
    assert rest is not None
    setting = phase.setting._replace(roller=0.7)
    found = GLIDER.gravity * MASSES.moments(phase.position, 0.7, rest)
    assert found == pytest.approx(SPACE.moments(setting), abs=1e-4)


def test_inertia_of_the_masses() -> None:
    found = MASSES.inertia(0.0, 0.0, np.zeros(3))
    points = 1.022 * (0.451252**2 + 0.25**2) + 1.04 * 0.25**2
    assert found[2, 2] == pytest.approx(64.29 * 0.5**2 + points)
    assert found[1, 2] == pytest.approx(-1.04 * 0.25 * 0.05)
    assert np.all(np.linalg.eigvalsh(found) > 0.0)


def test_equation_8() -> None:
    phi, theta, psi = 0.3, -0.5, 1.1
    c, s = np.cos, np.sin
    printed = [
        [
            c(psi) * c(theta),
            -s(psi) * c(phi) + c(psi) * s(theta) * s(phi),
            s(psi) * s(phi) + c(psi) * c(phi) * s(theta),
        ],
        [
            s(psi) * c(theta),
            c(psi) * c(phi) + s(phi) * s(theta) * s(psi),
            -c(psi) * s(phi) + s(theta) * s(psi) * c(phi),
        ],
        [-s(theta), c(theta) * s(phi), c(theta) * c(phi)],
    ]
    assert rotation(2.5 * _euler(phi, theta, psi)) == pytest.approx(np.array(printed), abs=1e-15)


STATES = np.random.default_rng(20260108).uniform(-1.0, 1.0, (4, 9))


@pytest.mark.parametrize("state", STATES)
def test_equations_9_to_13_corrected(state: np.ndarray) -> None:
    """The forces u_p on the pistons by differences of their momentum, then every rate by the printed equations."""
    phi, theta, psi, *moving = state * np.array([0.5, 0.5, 3.0, 0.6, 0.3, 0.3, 0.4, 0.4, 0.4])
    body = SPACE
    setting, slide = Setting(0.3, 0.04, 0.8, 1.0, 2.5), 0.01
    leg = Leg(0.0, 1.0, setting, Setting(0.0, slide))
    nu, arm, m = np.array(moving), np.array([0.04, 0.0, 0.0]), body.plane.sliding
    momenta = body.matrix(0.04) @ nu + body.sliding_momentum(0.04, slide)
    y = np.array([0.0, 0.0, 0.0, *_euler(phi, theta, psi), *momenta])
    change, dt = np.array(rates_in_space(body, leg)(0.0, y)), 1e-6

    def after(sign: float) -> tuple[np.ndarray, np.ndarray]:
        x = 0.04 + sign * slide * dt
        found = velocity_in_space(body, (y + sign * dt * change)[7:], x, slide)
        p = m * (found[:3] + np.cross(found[3:], [x, 0.0, 0.0]) + [slide, 0.0, 0.0])
        return found, p

    (later, p_later), (before, p_before) = after(1.0), after(-1.0)
    nu_dot, u_p = (later - before) / (2 * dt), (p_later - p_before) / (2 * dt)
    v, w = nu[:3], nu[3:]
    p = m * (v + np.cross(w, arm) + [slide, 0.0, 0.0])
    turned = rotation(y[3:7])
    down, g = turned.T @ [0.0, 0.0, 1.0], body.plane.gravity
    outer = body.water(nu) + body.thrust(setting)
    mass, inertia = np.diag(body.inertia)[:3], np.diag(body.inertia)[3:]
    force = np.cross(mass * v + p, w) + 0.3 * g * down + outer[:3] - u_p
    # Both pistons as one in the middle; what they add to both sides of x is in J.
    torque = np.cross(inertia * w + np.cross(arm, p), w) + np.cross(mass * v, v) + np.cross(np.cross(w, arm), p)
    torque += np.cross(body.moments(setting), down) + outer[3:] - np.cross(arm, u_p)
    assert nu_dot[:3] == pytest.approx(force / mass, abs=1e-6)
    assert nu_dot[3:] == pytest.approx(torque / inertia, abs=1e-6)
    assert change[[0, 2, 1]] == pytest.approx(turned @ v, abs=1e-12)
    half = 1e-6 * np.array(change[3:7])
    spin = np.array([[0.0, -w[2], w[1]], [w[2], 0.0, -w[0]], [-w[1], w[0], 0.0]])
    r_dot = (rotation(y[3:7] + half) - rotation(y[3:7] - half)) / 2e-6
    assert r_dot == pytest.approx(turned @ spin, abs=1e-9)


def test_forces_of_the_water_by_hand() -> None:
    """At 0.5 m/s, 5 degrees of attack, 3 of sideslip, along and across the velocity."""
    a, b, speed = np.radians(5.0), np.radians(3.0), 0.5
    p, q, r = 0.1, 0.2, -0.3
    v = speed * np.array([np.cos(a) * np.cos(b), np.sin(b), np.sin(a) * np.cos(b)])
    found = SPACE.water(np.array([*v, p, q, r]))
    drag, lift = 0.25 * (11.5594 + 0.2445 * 25.0), 0.25 * (-1.8461 + 9.8351 * 5.0)
    assert found[:3] @ v / speed == pytest.approx(-drag)
    assert found[:3] @ [np.sin(a), 0.0, -np.cos(a)] == pytest.approx(lift)
    across = np.array([-np.cos(a) * np.sin(b), np.cos(b), -np.sin(a) * np.sin(b)])
    assert found[:3] @ across == pytest.approx(-120.0 * b * 0.25)
    assert found[3] == pytest.approx(-40.0 * 0.5 * p)
    assert found[4] == pytest.approx(0.25 * (0.3720 - 2.4335 * 5.0) - 55.0 * 0.5 * q)
    assert found[5] == pytest.approx(0.25 * 100.0 * b - 40.0 * 0.5 * r)
    assert SPACE.water(np.zeros(6)) == pytest.approx(np.zeros(6))


def test_thrusters_push_ahead_and_the_right_one_turns_to_port() -> None:
    body = replace(SPACE, thrusters=replace(SPACE.thrusters, below=0.1))
    assert body.thrust(STILL._replace(right=3.0, left=1.0)) == pytest.approx([4.0, 0.0, 0.0, 0.0, 0.4, -0.5])


def test_energy_in_space() -> None:
    draws = np.random.default_rng(20260109).uniform(-0.5, 0.5, (20, 8))
    for holds in (True, False):
        body = replace(SPACE, plane=replace(SPACE.plane, holds_munk=holds, sliding_below=0.03))
        assert max(unexplained_in_space(body, Setting(0.4, 0.05, 0.6, 1.0, 2.0), draws)) < 1e-10


def test_in_the_vertical_plane_nothing_is_added() -> None:
    setting = GLIDER.phases[0].setting
    leg, moving = Leg(0.0, 1.0, setting, STILL._replace(position=0.001)), (0.4, 0.1, 0.05)
    body = SPACE.plane
    flat = np.array(rates(body, leg)(0.0, np.array([0.0, 0.0, -0.3, *momentum(body, moving, setting.position, 0.001)])))
    nu = np.array([0.4, 0.0, 0.1, 0.0, 0.05, 0.0])
    y = state_of(SPACE, setting, nu, 0.0, -0.3)
    y[7:] += SPACE.sliding_momentum(setting.position, 0.001)
    found = np.array(rates_in_space(SPACE, leg)(0.0, y))
    assert found[[0, 1, 7, 9, 11]] == pytest.approx(flat[[0, 1, 3, 4, 5]], abs=1e-12)
    assert found[[2, 8, 10, 12]] == pytest.approx(np.zeros(4), abs=1e-12)


@pytest.fixture(scope="module")
def spiral():
    """A dive with the roller at 60 degrees: the motion, its steady turn, and the phase."""
    phase = replace(GLIDER.phases[0], roller=np.radians(60.0), lasts=420.0)
    glider = replace(GLIDER, phases=(phase,))
    (steady,) = steady_spirals(glider, phase)
    return GlideRun(glider, simulate(glider, glider.manoeuvre(1), {"step": 20.0})), steady


def test_a_spiral_in_time_is_the_steady_one(spiral) -> None:
    run, steady = spiral
    t = run.trajectory
    phi, theta, _ = t.angles[-1]
    assert run.speed[-1] == pytest.approx(steady.speed, rel=1e-6)
    assert [phi, theta] == pytest.approx([steady.phi, steady.theta], abs=1e-6)
    assert run.alpha[-1] == pytest.approx(steady.alpha, abs=1e-6)
    assert t.heading_rate[-1] == pytest.approx(steady.turn, rel=1e-5)
    assert np.diff(t.position[-2:, 2])[0] / 20.0 == pytest.approx(steady.sinking, rel=1e-5)
    chord = np.hypot(*np.diff(t.position[-2:, :2], axis=0)[0])
    assert chord == pytest.approx(2.0 * steady.radius * np.sin(steady.turn * 10.0), rel=1e-4)
    assert np.diff(t.heading[-2:])[0] == pytest.approx(steady.turn * 20.0, rel=1e-5)
    assert run.settled(0)


def test_lift_leans_a_dive_to_the_roller_s_side_and_a_climb_to_the_other(spiral) -> None:
    _, down = spiral
    (up,) = steady_spirals(GLIDER, replace(GLIDER.phases[1], roller=np.radians(60.0)))
    (port,) = steady_spirals(GLIDER, replace(GLIDER.phases[0], roller=np.radians(-60.0)))
    assert down.turn > 0.0 > up.turn
    assert down.phi > 0.0
    assert up.phi > 0.0
    moved = 1.04 * 9.81 * 0.05 * np.array([np.sin(np.pi / 3), np.cos(np.pi / 3) - 1.0])
    _, v, w, p, _, _ = down.velocity
    damped = 40.0 * down.speed * p - (132.7 - 306.7) * v * w  # and the Munk moment
    upright = moved[0] * np.cos(down.phi) - (4.712 + moved[1]) * np.sin(down.phi)
    assert upright * np.cos(down.theta) == pytest.approx(damped, rel=0.03)
    assert [port.turn, port.phi, port.speed] == pytest.approx([-down.turn, -down.phi, down.speed], rel=1e-9)


def test_without_roller_and_thrust_a_spiral_is_the_glide() -> None:
    (straight,) = steady_glides(GLIDER, GLIDER.phases[0])
    found = steady_spiral(SPACE, GLIDER.phases[0].setting, straight.speed, straight.alpha, straight.theta)
    assert [found.speed, found.zeta] == pytest.approx([straight.speed, straight.zeta], abs=1e-9)
    assert found.turn == pytest.approx(0.0, abs=1e-12)


def test_a_cruise_is_level_and_in_balance_but_for_the_elevator() -> None:
    found = cruise(SPACE, 0.5)
    assert [found.drag, found.lift] == pytest.approx([11.5594 * 0.25, -1.8461 * 0.25])
    level = Spiral(0.5, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    left = out_of_balance(SPACE, found.setting, level)
    assert left[[0, 1, 2, 3, 5]] == pytest.approx(np.zeros(5), abs=1e-12)
    assert left[4] == pytest.approx(-found.elevator)
    ahead, _ = SPACE.plane.moments(*found.setting[:2])
    assert found.elevator == pytest.approx(ahead - 0.25 * 0.3720)


def test_where_no_turn_is_steady_there_is_none() -> None:
    wild = replace(SPACE, plane=replace(SPACE.plane, polar=Polar((0.0, 1.0), (0.0, 0.0), (0.0, 0.0))))
    assert steady_spiral(wild, Setting(0.4, 0.03, 1.5), 0.3, 0.1, -0.3) is None


def test_a_glider_file_with_masses_comes_back(tmp_path: Path) -> None:
    path = tmp_path / "glider.toml"
    glider = replace(GLIDER, phases=(replace(GLIDER.phases[0], roller=0.5, thrust_right=2.0),))
    path.write_bytes(glider.file())
    assert read_glider(path) == glider


@pytest.mark.parametrize(
    ("cut", "key", "found"),
    [
        ("lateral", "roller = '20 deg'", r"no \[lateral\]"),
        ("", "thrust_left = '11 N'", "11 N"),
        ("thrusters", "thrust_left = '1 N'", r"no \[thrusters\]"),
    ],
)
def test_orders_that_the_file_cannot_follow(tmp_path: Path, cut: str, key: str, found: str) -> None:
    text = FILE.read_text(encoding="utf-8").replace('name = "dive, stage 1"', f'name = "dive, stage 1"\n{key}')
    if cut:
        begins = text.index(f"[{cut}]")
        text = text[:begins] + text[text.index("\n[", begins + 1) :]
        text = "\n".join(line for line in text.splitlines() if not line.lstrip('"').startswith(cut))
    path = tmp_path / "glider.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=found):
        read_glider(path)


def test_a_glider_of_the_vertical_plane_takes_no_roller() -> None:
    flat = replace(GLIDER, lateral=None)
    phase = replace(flat.phases[0], roller=0.3).ordered
    with pytest.raises(InputError, match="roller"):
        simulate(flat, Manoeuvre("one", (phase,), np.zeros(6)), {})


def test_net_mass_follows_the_stroke() -> None:
    """Equations 20 and 25: the engine's rate is u0 times the pistons', u0 = 2 rho pi r^2."""
    assert GLIDER.engine.rate == pytest.approx(2.0 * MASSES.ballast(1.0) * GLIDER.sliding_mass.rate, rel=1e-4)
    for phase in GLIDER.phases:
        assert MASSES.stroke(phase.net_mass) == pytest.approx(phase.position, rel=1e-4)
