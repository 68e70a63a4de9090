"""The shipped HUUV: data as printed, thrusters, and its parameter file through the vehicle's own equations."""

from __future__ import annotations

import hashlib

import numpy as np
import pytest

from coeflab.core.errors import InputError
from coeflab.core.files import shipped
from coeflab.motion.steady_state import level_forces, steady_motions, wrenches
from coeflab.motion.steady_turns import features, steady_turns
from coeflab.motion.vehicle import Vehicle, vehicle
from coeflab.published.huuv.model import Huuv, commands, parameter_file, read_huuv, thrust, thrust_rates
from coeflab.vehicle.parameter_file import read_parameter_file

FILE = shipped("cfd_data") / "huuv" / "huuv.parameters.json"
LEFT, RIGHT = np.array([0.0, 14.0, 20.0, 60.0]), np.array([60.0, 100.0, 20.0, 40.0])


@pytest.fixture(scope="module")
def huuv() -> Huuv:
    return read_huuv()


@pytest.fixture(scope="module")
def made(huuv: Huuv) -> Vehicle:
    return vehicle(read_parameter_file(FILE), free=("u", "v", "r"))


def test_figure_17_is_whole(huuv: Huuv) -> None:
    assert {name: len(t.left) for name, t in huuv.turns.items()} == {"tracker": 28, "matlab": 28}
    for t in huuv.turns.values():
        assert np.all(t.left < t.right)
        assert np.isfinite(t.figures).all()
    matlab = huuv.turns["matlab"]
    assert np.degrees(matlab.figures[:, 1]).max() == pytest.approx(21.76)
    assert matlab.figures[:, 2].max() == 2.1
    assert len(huuv.errata) == 10


def test_thrust_of_the_two_sides(huuv: Huuv) -> None:
    x, y, n = thrust(LEFT, RIGHT, 0.1654, -2.338, 0.1, 14.0).T
    force = 0.1654 * np.array([60.0, 100.0, 20.0, 40.0]) - 2.338
    port = np.array([0.0, 0.0, 0.1654 * 20.0 - 2.338, 0.1654 * 60.0 - 2.338])
    assert x == pytest.approx(force + port)
    assert n == pytest.approx(0.1 * (port - force))
    assert not y.any()


def test_two_inputs_give_two_commands_within_their_limits() -> None:
    """Equations 35 and 36: a positive difference turns to port; beyond 100 % a thruster stays there."""
    left, right = commands(np.array([50.0, 80.0, -30.0, 95.0]), np.array([10.0, -20.0, 80.0, 15.0]))
    assert left == pytest.approx([40.0, 100.0, -100.0, 80.0])
    assert right == pytest.approx([60.0, 60.0, 50.0, 100.0])
    assert thrust(left[:1], right[:1], 0.1654, -2.338, 0.1, 14.0)[0, 2] < 0.0


def test_thrust_rates(huuv: Huuv) -> None:
    at = np.array([0.1654, -2.338, 0.1])
    rates = thrust_rates(LEFT, RIGHT, *at, 14.0)
    for k in range(3):
        step = 1e-6 * np.eye(3)[k]
        found = (thrust(LEFT, RIGHT, *(at + step), 14.0) - thrust(LEFT, RIGHT, *(at - step), 14.0)) / 2e-6
        assert rates[:, :, k] == pytest.approx(found, abs=1e-8)


def test_the_shipped_file_is_what_its_maker_writes(huuv: Huuv) -> None:
    assert FILE.read_bytes() == parameter_file(huuv).to_json()
    for record in read_parameter_file(FILE).provenance.inputs:
        assert record.sha256 == hashlib.sha256((FILE.parent / record.name).read_bytes()).hexdigest()


def test_forces_of_the_file_are_those_of_the_equations(huuv: Huuv, made: Vehicle) -> None:
    """Within the ranges of its tables, ahead."""
    rng = np.random.default_rng(2)
    u, r = rng.uniform(0.2, 1.5, 40), rng.uniform(-1.5, 1.5, 40)
    x = np.column_stack([u, u * np.tan(np.radians(rng.uniform(-24.0, 24.0, 40))), r])
    ours = level_forces(made, x, np.zeros((40, 6)), np.zeros((40, 3)))
    assert ours == pytest.approx(features(x)[0] @ huuv.theta, rel=1e-9, abs=1e-9)


def test_turns_through_the_file(huuv: Huuv, made: Vehicle) -> None:
    turns, c = huuv.accepted, huuv.constants
    commands = [{"left": float(a), "right": float(b)} for a, b in zip(turns.left, turns.right, strict=True)]
    push = thrust(turns.left, turns.right, c["slope"], c["intercept"], c["arm"], huuv.dead_zone)
    assert wrenches(made, commands)[:, [0, 1, 5]] == pytest.approx(push, abs=1e-12)
    found, settled = steady_motions(made, wrenches(made, commands))
    assert settled.all()
    assert found[:, [0, 1, 5]] == pytest.approx(steady_turns(huuv.theta, push).velocity, rel=1e-7, abs=1e-9)
    assert not found[:, [2, 3, 4]].any()


def test_commands_in_the_dead_zone_give_no_motion(made: Vehicle) -> None:
    found, settled = steady_motions(made, wrenches(made, [{"left": 10.0, "right": -13.9}, {}]))
    assert settled.all()
    assert not found.any()


def test_a_vehicle_that_may_pitch_has_no_level_turn() -> None:
    p = read_parameter_file(FILE)
    dived = vehicle(p, free=("u", "v", "r"))
    object.__setattr__(dived, "free", ("u", "w", "r"))
    with pytest.raises(InputError, match="w free"):
        steady_motions(dived, np.zeros((1, 6)))


def test_a_broken_file_is_named(tmp_path) -> None:  # type: ignore[no-untyped-def]
    for name in ("vehicle.toml", "turns.csv", "operating_points.csv"):
        (tmp_path / name).write_bytes((FILE.parent / name).read_bytes())
    text = (tmp_path / "vehicle.toml").read_text()
    (tmp_path / "vehicle.toml").write_text(text.replace("slope = 0.1654", 'slope = "steep"'))
    with pytest.raises(InputError, match=r"vehicle\.toml.*thruster\.slope"):
        read_huuv(tmp_path)
