"""Motions of arms: energy, power, limits, tracks, thrusters, and the simulator with its files."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from coeflab.arm import kane
from coeflab.arm.arm_file import read_arm
from coeflab.arm.chain import Flow, in_frame_0
from coeflab.arm.motion import (
    Drive,
    Track,
    at_rest,
    driven,
    equations_of,
    march,
    thrust_wrench,
    track_of_end,
    track_to,
)
from coeflab.arm.simulators import arm
from coeflab.arm.tables import arm_phases
from coeflab.arm.thrusters import (
    Thruster,
    TorqueThruster,
    VoltageThruster,
    thrust_allocation,
    thruster_matrix,
    uncontrolled_directions,
)
from coeflab.core.errors import InputError
from coeflab.core.files import shipped
from coeflab.core.types import Array
from coeflab.motion.manoeuvre import Manoeuvre, Phase
from coeflab.motion.trajectory import Ended
from tests.arm.chains import PAPER_SPEEDS, Q, drawn, dry, ideal, puma

START = in_frame_0(puma(), PAPER_SPEEDS)
DUCTED = VoltageThruster(1.0, 50.0, 5.0, 0.1, np.radians(30.0), 1.75, 1.2, 0.2, 0.5)


@pytest.mark.parametrize("wet", [False, True], ids=["in vacuum", "in ideal water"])
def test_free_motion_keeps_its_energy(wet: bool) -> None:
    """5 s without drag, 1e-8."""
    chain = ideal(puma()) if wet else ideal(dry(puma()))
    found = march(
        chain, *driven(chain, Drive()), at_rest(chain, Q, START[:6], START[6:]), 0.0, 5.0, 0.25, tolerance=1e-10
    )
    energy = np.array([kinetic_energy(chain, s[7:10], s[10:]) for s in found.state])
    assert found.ended is Ended.COMPLETE
    assert np.ptp(energy) < 1e-8 * energy[0]


@pytest.mark.slow
def test_power_balance_with_drag_torques_weight_and_buoyancy() -> None:
    """Energy gained is the work of all forces, 1e-6; springs of the joints keep the arm within its limits."""
    chain = replace(puma(), base=replace(puma().base, volume=0.12))
    found, n = equations_of(chain), chain.count
    size = 13 + 2 * n

    def control(time: float, s: Array) -> Array:
        out = np.zeros(6 + n)
        out[:6] = 20.0 * np.sin(time), 5.0, 0.0, 1.0, 0.0, -2.0
        out[6:] = 12.0 * np.cos(time * np.arange(1, n + 1)) - 20.0 * (s[7 : 7 + n] - Q)
        return out

    def rates(time: float, s: Array) -> Array:
        m, force = found(s[:size], Flow())
        speeds = s[7 + n : size]
        pushed = control(time, s)
        work = speeds @ (pushed + kane.external(chain, s[7 : 7 + n], speeds, s[3:7]))
        return np.concatenate([kane.displacement_rates(n, s), np.linalg.solve(m, force + pushed), [work]])

    start = np.concatenate([at_rest(chain, Q, START[:6], START[6:]), [0.0]])
    out = march(chain, rates, control, start, 0.0, 1.5, 0.25, tolerance=1e-9)
    energy = np.array([kinetic_energy(chain, s[7 : 7 + n], s[7 + n : size]) for s in out.state])
    assert out.ended is Ended.COMPLETE
    assert np.max(np.abs(energy - energy[0] - out.state[:, -1])) < 1e-6 * np.max(energy)
    assert np.ptp(out.state[:, -1]) > 0.1 * energy[0]


def kinetic_energy(chain: kane.Chain, q: np.ndarray, speeds: np.ndarray) -> float:
    """Of the bodies and of the water that moves with them, J."""
    return float(0.5 * speeds @ kane.mass_matrix(chain, q) @ speeds)


def test_a_joint_at_its_limit_ends_the_motion() -> None:
    chain = puma()
    limit = chain.joints[2].low
    found = march(chain, *driven(chain, Drive(torque=np.array([0.0, 0.0, -1.0]))), at_rest(chain), 0.0, 60.0, 1.0)
    assert found.ended is Ended.OUT_OF_RANGE
    assert "joint forearm is at its limit of -45 deg" in found.why
    assert found.state[-1, 9] == pytest.approx(limit, abs=1e-9)
    away = march(chain, *driven(chain, Drive(torque=np.array([0.0, 0.0, 1.0]))), found.state[-1], 0.0, 0.02, 0.01)
    assert away.ended is Ended.OUT_OF_RANGE  # it still moves into the stop
    at_rest_there = at_rest(chain, np.array([0.0, 0.0, limit]))
    off = march(chain, *driven(chain, Drive(torque=np.array([0.0, 0.0, 1.0]))), at_rest_there, 0.0, 0.5, 0.1)
    assert off.ended is Ended.COMPLETE


@pytest.mark.parametrize(("torque", "ended"), [(np.nan, Ended.NOT_FINITE), (1e200, Ended.STEP_TOO_SMALL)])
def test_numbers_that_fail_are_a_status(torque: float, ended: Ended) -> None:
    chain = ideal(puma())
    strong = tuple(replace(one, joint=replace(one.joint, strongest=np.inf)) for one in chain.links)
    chain = replace(chain, links=strong)
    found = march(chain, *driven(chain, Drive(torque=np.array([0.0, 0.0, torque]))), at_rest(chain), 0.0, 1.0, 0.1)
    assert found.ended is ended
    assert found.why.startswith("at 0 s: the ")
    assert len(found.time) == 1


def test_held_vehicle_and_tracked_joints_need_the_force_of_the_equations() -> None:
    chain = puma()
    track = track_to(chain, Q, np.array([0.6, -1.0, 1.2]), 0.0, 2.0)
    found = march(chain, *driven(chain, Drive(held=True, track=track)), at_rest(chain), 0.0, 2.0, 0.5)
    q, rates, changed = track.at(1.5)
    row = found.state[3]
    np.testing.assert_allclose(row[7:10], q, atol=1e-8)
    np.testing.assert_allclose(row[13 + 3 :], rates, atol=1e-8)
    assert not row[:3].any()
    m, force = kane.equations(chain, row)
    np.testing.assert_allclose(found.control[3], m[:, 6:] @ changed - force, atol=1e-7)


def test_free_vehicle_recoils_from_its_arm() -> None:
    chain = ideal(puma())
    track = track_to(chain, Q, np.array([0.6, -1.0, 1.2]), 0.0, 2.0)
    found = march(chain, *driven(chain, Drive(track=track)), at_rest(chain), 0.0, 2.0, 1.0)
    assert not found.control[:, :6].any()
    momentum = [kane.mass_matrix(chain, s[7:10]) @ s[10:] for s in found.state]
    assert np.linalg.norm(found.state[1, 10:16]) > 1e-3
    assert np.max(np.abs(np.array(momentum)[:, :6])) < 1e-6


@pytest.mark.parametrize("rates", [np.zeros(2), np.array([0.4, -0.2])], ids=["from rest", "moving"])
def test_tracks_are_smooth_and_end_at_rest(rates: Array) -> None:
    track = Track(1.0, 3.0, np.array([[0.1, 0.2], [0.7, -0.5]]), rates)
    begin, end = track.at(1.0), track.at(3.0)
    np.testing.assert_allclose(begin[0], [0.1, 0.2])
    np.testing.assert_allclose(begin[1], rates)
    np.testing.assert_allclose(end, [[0.7, -0.5], [0.0, 0.0], [0.0, 0.0]], atol=1e-14)
    for time in (1.3, 2.1, 2.9):
        low, high = track.at(time - 1e-5), track.at(time + 1e-5)
        for k in (0, 1):
            np.testing.assert_allclose((high[k] - low[k]) / 2e-5, track.at(time)[k + 1], atol=1e-8)


def test_the_end_effector_goes_straight() -> None:
    chain = puma()
    start = kane.pose(chain, Q).end
    to = start + np.array([0.1, 0.15, 0.1])
    track = track_of_end(chain, Q, to, 0.0, 2.0)
    for time in (0.4, 1.1, 1.7, 2.0):
        way = kane.pose(chain, track.at(time)[0]).end - start
        assert np.linalg.norm(np.cross(way, to - start)) < 1e-5 * np.linalg.norm(to - start)
    np.testing.assert_allclose(way, to - start, atol=1e-6)
    with pytest.raises(InputError, match="does not get as far as"):
        track_of_end(chain, Q, start + np.array([2.0, 0.0, 0.0]), 0.0, 2.0)


def test_torque_thruster() -> None:
    """Omega = Omega_s tanh(sqrt(alpha beta tau) t)."""
    one = TorqueThruster(0.05, 50.0, 0.02, 5.0)
    torque, settled = one.steady(-30.0, 1000.0)
    assert one.force(settled, 1000.0) == pytest.approx(-30.0)
    assert one.rates(settled, torque, 1000.0) == pytest.approx([0.0], abs=1e-9)
    assert one.rates(np.zeros(1), 9.0, 1000.0) == pytest.approx([50.0 * 5.0])
    speed = np.sqrt(50.0 * 2.0 / 0.05)
    time = 0.3
    there = speed * np.tanh(np.sqrt(0.05 * 50.0 * 2.0) * time)
    slope = (speed * np.tanh(np.sqrt(5.0) * (time + 1e-6)) - there) / 1e-6
    assert one.rates(np.array([there]), 2.0, 1000.0)[0] == pytest.approx(slope, rel=1e-4)


@pytest.mark.parametrize("thrust", [25.0, -8.0])
def test_voltage_thruster(thrust: float) -> None:
    volts, settled = DUCTED.steady(thrust, 1000.0)
    assert DUCTED.force(settled, 1000.0) == pytest.approx(thrust)
    np.testing.assert_allclose(DUCTED.rates(settled, volts, 1000.0), 0.0, atol=1e-9)
    # The jet carries the momentum away.
    assert 0.5 * 1000.0 * np.pi * 0.01 * settled[1] * abs(settled[1]) == pytest.approx(thrust)
    # Blades in a faster flow push less, which is what the model of one state lacks.
    assert 0.0 < DUCTED.force(settled * [1.0, 1.1], 1000.0) / thrust < 0.8
    blade = 0.5 * 1000.0 * np.pi * 0.01 * (0.07 * 40.0) ** 2
    assert DUCTED.force(np.array([40.0, 0.0]), 1000.0) == pytest.approx(blade * 1.75 * np.sin(np.pi / 3.0))
    spun = DUCTED.rates(np.array([40.0, 0.0]), 0.0, 1000.0)
    load = blade * 0.07 * 1.2 * (1.0 - np.cos(np.pi / 3.0))
    assert spun[0] == pytest.approx(-1.0 * 40.0 - 5.0 * load)
    assert spun[1] == pytest.approx(blade * 1.75 * np.sin(np.pi / 3.0) / (1000.0 * np.pi * 0.01 * 0.2))


def test_thrusts_reach_the_vehicle_through_their_states() -> None:
    chain = puma()
    n_states = sum(t.order for t in chain.thrusters)
    torque, settled = TorqueThruster(0.05, 50.0, 0.02).steady(10.0, 1000.0)
    commands = np.array([torque] * 4 + [0.0] * 4)
    states = np.concatenate([np.repeat(settled, 4), np.zeros(4)])
    np.testing.assert_allclose(thrust_wrench(chain, states, commands), [40.0 * np.sqrt(0.5), 0, 0, 0, 0, 0], atol=1e-9)
    start = np.concatenate([at_rest(chain), np.zeros(n_states)])
    found = march(chain, *driven(chain, Drive(commands=commands)), start, 0.0, 3.0, 1.0)
    spun_up = np.tanh(3.0 * np.sqrt(0.05 * 50.0 * torque))
    np.testing.assert_allclose(found.state[-1, -n_states:], spun_up * states, rtol=1e-7, atol=1e-9)
    assert found.control[0, 0] == 0.0
    assert found.control[-1, 0] == pytest.approx(40.0 * np.sqrt(0.5) * spun_up**2, rel=1e-7)


def test_thruster_matrix_says_what_it_loses() -> None:
    thrusters = puma().thrusters
    inverse = thrust_allocation(thrusters)
    np.testing.assert_allclose(thruster_matrix(thrusters) @ inverse, np.eye(6), atol=1e-12)
    assert uncontrolled_directions(thruster_matrix(thrusters[:4])) == ("heave", "roll", "pitch")
    with pytest.raises(InputError, match="no surge, no sway, no yaw"):
        thrust_allocation(thrusters[4:])
    aside = [Thruster("aside", np.array([0.5, 0.0, 0.0]), np.array([0.0, 1.0, 0.0]))]
    assert "sway apart from yaw (N = 0.5 m Y)" in uncontrolled_directions(thruster_matrix(aside))
    assert len(uncontrolled_directions(thruster_matrix([]))) == 6


def test_shipped_phases() -> None:
    chain, manoeuvre, *_ = read_arm(shipped("geometry") / "urv_puma")
    found = arm.simulate(chain, manoeuvre, {"record": 0.5, "north": 0.2})
    assert found.ended is Ended.COMPLETE
    last = {name: values[-1] for name, values in found.controls.items()}
    assert last["shoulder.rate [rad/s]"] == pytest.approx(0.0, abs=1e-6)
    assert found.velocity[0, 0] == pytest.approx(-0.2)
    drifted = found.position[-1, 0]
    assert drifted > 0.01  # the water carries it along
    axes = kane.axes_in_earth(*found.attitude[-1])
    seen = (np.array([last[f"end.{a} [m]"] for a in ("north", "east", "down")]) - found.position[-1]) @ np.reshape(
        axes, (3, 3)
    ).T
    np.testing.assert_allclose(seen, [0.75, -0.10, -0.70], atol=1e-5)


def test_a_neutral_vehicle_goes_with_water_that_gains_speed() -> None:
    """Equations 17 and 20 together: nothing of it moves through the water."""
    chain, still = puma(), Manoeuvre("m", (Phase("p", {}, 2.0),), np.zeros(6))
    found = arm.simulate(chain, still, {"gaining_north": 0.3, "gaining_down": -0.2})
    np.testing.assert_allclose(found.position[-1], [0.6, 0.0, -0.4], atol=1e-9)
    assert np.max(np.abs(found.velocity)) < 1e-9
    np.testing.assert_allclose(found.controls["forearm [rad]"], 0.5, atol=1e-9)


def test_without_numba_the_motion_is_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    chain, start = puma(), at_rest(puma(), Q, START[:6], START[6:])
    quick = march(chain, *driven(chain, Drive()), start, 0.0, 0.2, 0.1)
    monkeypatch.setattr("coeflab.arm.motion.compiles", lambda: False)
    plain = march(chain, *driven(chain, Drive()), start, 0.0, 0.2, 0.1)
    np.testing.assert_allclose(plain.state, quick.state, rtol=1e-9, atol=1e-11)


def test_orders_that_an_arm_does_not_know() -> None:
    chain = puma()
    for orders, said in (({"wrist": 0.1}, "wrist"), ({"forearm": 5.0}, "limits of joint forearm")):
        with pytest.raises(InputError, match=said):
            arm.simulate(chain, Manoeuvre("m", (Phase("p", orders, 1.0),), np.zeros(6)), {})


def test_drives_that_are_too_weak_are_named() -> None:
    weak = tuple(replace(one, joint=replace(one.joint, strongest=0.2, fastest=0.05)) for one in puma().links)
    chain = replace(puma(), links=weak)
    moved = arm.simulate(chain, Manoeuvre("m", (Phase("p", {"shoulder": 0.8}, 1.0),), np.zeros(6)), {"record": 0.1})
    assert any("shoulder stronger than its drive" in line for line in moved.statements)
    assert any("shoulder quicker than its drive" in line for line in moved.statements)
    pushed = arm.simulate(chain, Manoeuvre("m", (Phase("p", {"shoulder.torque": 9.0}, 0.1),), np.zeros(6)), {})
    assert np.max(pushed.controls["shoulder.torque [N m]"]) == pytest.approx(0.2)


def test_what_moves_a_slide_is_a_force() -> None:
    chain = drawn(0, 2)
    assert [joint.turns for joint in chain.joints].count(False) == 1
    phases = (Phase("p", {"vehicle.held": 1.0}, 0.01),)
    moved = arm.simulate(chain, Manoeuvre("m", phases, np.zeros(6)), {})
    efforts = [key.partition(".")[2] for key in moved.controls if key.partition(".")[2].startswith(("torque", "force"))]
    assert efforts == ["torque [N m]" if joint.turns else "force [N]" for joint in chain.joints]
    rows = [row[:2] for row in arm_phases(moved, "x").rows]
    for joint in chain.joints:
        assert (f"{joint.name}, largest {'torque' if joint.turns else 'force'}", "N m" if joint.turns else "N") in rows
    assert "of its centre of mass" in arm_phases(moved, "x").notes[0]


def test_a_prismatic_joint_stops_in_metres() -> None:
    chain = ideal(drawn(0, 2))
    one = chain.links[0]
    chain = replace(chain, links=(replace(one, joint=replace(one.joint, high=0.1)), chain.links[1]))
    found = march(chain, *driven(chain, Drive(held=True, torque=np.array([50.0, 0.0]))), at_rest(chain), 0.0, 60.0, 1.0)
    assert found.ended is Ended.OUT_OF_RANGE
    assert "limit of 0.1 m" in found.why
