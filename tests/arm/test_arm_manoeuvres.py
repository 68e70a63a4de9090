"""Manoeuvres of a vehicle with an arm by name, phases whose vehicle is kept, and the controller of a body.toml."""

from __future__ import annotations

from dataclasses import fields, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from coeflab.arm.arm_file import Arm, read_arm
from coeflab.arm.arm_keys import ControllerKeys
from coeflab.arm.control import Controller, controlled
from coeflab.arm.motion import track_to
from coeflab.arm.simulators import arm
from coeflab.core.errors import InputError
from coeflab.core.files import shipped
from coeflab.motion.manoeuvre import Manoeuvre, Phase
from coeflab.motion.trajectory import Ended, Trajectory
from tests.arm.chains import puma

PUMA = shipped("geometry") / "urv_puma"
COARSE: dict[str, Any] = {"record": 0.1, "tolerance": 1e-6, "method": "RK45"}
THRUST = "aft_port [N]"


def planned(name: str, **options: Any) -> Arm:
    return read_arm(PUMA, name, options)


def moved(found: Arm, **options: Any) -> Trajectory:
    return arm.simulate(found.chain, found.manoeuvre, COARSE | options)


def test_station_keeping_is_the_controlled_run() -> None:
    """The same law, in phases: place, thrusts and what was asked for, row by row; then the vehicle stays."""
    found = planned("station_keeping", joints="20, -0.6 rad, 30", lasts=0.6, stays=0.2)
    chain, aim = found.chain, np.array([np.radians(20.0), -0.6, np.radians(30.0)])
    trajectory = moved(found)
    run = controlled(chain, Controller(), track_to(chain, chain.home, aim, 0.0, 0.6), 0.6, rows=0.1)
    first = trajectory.phase == 0
    assert trajectory.phases == ("joints", "stays")
    assert trajectory.time[-1] == pytest.approx(0.8)
    np.testing.assert_allclose(trajectory.position[first], run.state[:, :3], atol=1e-12)
    for column, values in ((THRUST, run.thrust), ("aft_port.wanted [N]", run.ordered)):
        np.testing.assert_allclose(trajectory.controls[column][first], values[:, 2], atol=1e-12)
    np.testing.assert_allclose(trajectory.controls["shoulder.wanted [rad]"][first], run.wanted[:, 0], atol=1e-12)
    np.testing.assert_allclose(trajectory.controls["end.down.wanted [m]"][first], run.end_wanted[:, 2], atol=1e-12)
    # Propellers and references go on: nothing jumps where the second phase begins.
    last, begins = int(np.flatnonzero(first)[-1]), int(np.flatnonzero(trajectory.phase == 1)[0])
    for column in (THRUST, "shoulder.wanted [rad]", "shoulder [rad]"):
        assert trajectory.controls[column][begins] == pytest.approx(trajectory.controls[column][last], abs=1e-12)
    assert abs(trajectory.controls[THRUST][begins]) > 1e-3


@pytest.mark.slow
def test_the_law_and_thrusters_are_options() -> None:
    found = planned("station_keeping", joints="40, -60, 50", lasts=0.8, stays=0.0)

    def off(**options: Any) -> float:
        return float(np.linalg.norm(moved(found, **options).position, axis=1).max())

    assert off(thrusters="at_once") < 1e-6 < 1e-4 < off() < off(law="station")
    ideal = off(thrusters="at_once", north=0.3)
    assert ideal < 1e-6 < off(thrusters="at_once", north=0.3, knows_current="no")


def test_an_end_effector_track_goes_to_its_place() -> None:
    found = planned("end_effector_track", end="0.75,-0.15,-0.7", lasts=1.0, stays=0.0)
    run = moved(found, thrusters="at_once")
    end = [float(run.controls[f"end.{axis} [m]"][-1]) for axis in ("north", "east", "down")]
    assert end == pytest.approx([0.75, -0.15, -0.7], abs=1e-3)
    assert np.abs(run.position).max() < 1e-6


def test_free_motion_has_no_drives() -> None:
    run = moved(planned("free_motion", lasts=0.5, velocity="0.5,0,0,0,0,0", rates="0.2 rad/s,-0.1 rad/s,10"))
    torques = [values for name, values in run.controls.items() if name.endswith(("torque [N m]", ".vehicle [N]"))]
    assert np.abs(torques).max() == 0.0
    assert run.controls["forearm.rate [rad/s]"][0] == pytest.approx(np.radians(10.0))
    assert run.velocity[0, 0] == 0.5
    assert not any("wanted" in name for name in run.controls)


def test_manoeuvres_take_the_places_of_the_phases() -> None:
    """Each place once, and the table that states it."""
    kept, track = planned("station_keeping"), planned("end_effector_track")
    assert [(p.name, p.longest) for p in kept.manoeuvre.phases] == [("joints", 4.0), ("stays", 4.0)]
    assert kept.places == ("phase[0]", "")
    assert kept.manoeuvre.phases[0].orders["forearm"] == pytest.approx(np.radians(80.0))
    assert track.places == ("phase[2]", "")
    assert track.manoeuvre.phases[0].orders["end.z"] == -0.7
    assert (track.manoeuvre.name, planned("phases").manoeuvre.name) == ("end_effector_track", "arm_motion")


def test_a_kept_phase_among_others() -> None:
    """What is wanted is a number under control alone; the vehicle comes back to where the motion began."""
    chain = puma()
    phases = (
        Phase("drift", {"vehicle.held": 0.0}, 0.4),
        Phase("back", {"vehicle.kept": 1.0, "shoulder": 0.35}, 1.2),
        Phase("free", {"vehicle.held": 0.0}, 0.2),
    )
    start = np.array([0.1, 0.0, 0.0, 0.0, 0.0, 0.1])
    run = arm.simulate(chain, Manoeuvre("mixed", phases, start), COARSE | {"vehicle_frequency": 4.0})
    wanted = np.isfinite(run.controls["shoulder.wanted [rad]"])
    assert run.ended is Ended.COMPLETE
    assert (wanted == (run.phase == 1)).all()
    off = np.linalg.norm(run.position, axis=1)
    assert off[run.phase == 1][-1] < 0.5 * off[run.phase == 0][-1]
    assert run.controls[THRUST][run.phase == 2].max() == 0.0


def test_thrusters_at_their_limits_are_said() -> None:
    found = planned("station_keeping", joints="40, -60, 50", lasts=0.5, stays=0.0)
    weak = tuple(replace(t, model=replace(t.model, strongest=0.01)) for t in found.chain.thrusters)
    run = moved(found._replace(chain=replace(found.chain, thrusters=weak)))
    assert any(s.startswith("joints: saturated: thruster aft_port from ") for s in run.statements)
    assert run.ended is Ended.COMPLETE


def test_at_once_takes_no_commands() -> None:
    phases = (Phase("push", {"aft_port": 1.0}, 0.1),)
    with pytest.raises(InputError, match="at_once, with commands in push"):
        arm.simulate(puma(), Manoeuvre("push", phases, np.zeros(6)), {"thrusters": "at_once"})


@pytest.mark.parametrize(
    ("name", "options", "column", "words"),
    [
        ("zigzag", {}, "--manoeuvre", "one of phases, free_motion, station_keeping, end_effector_track"),
        ("station_keeping", {"joints": "1, 2"}, "--joints", "found 2 values; expected 3"),
        ("station_keeping", {"joints": "1, 2, x"}, "--joints", "an angle, bare in deg or with its unit"),
        ("station_keeping", {"rates": "10, 20, 3 kg"}, "--rates", "expected a unit of rate"),
        ("station_keeping", {"rates": "0.4, 20, 30"}, "--rates", "0.4, a rate without a unit"),
        ("station_keeping", {"lasts": -1.0}, "--lasts", "See --help-options"),
        ("free_motion", {"velocity": "1"}, "--velocity", "found 1 value; expected 6"),
        ("end_effector_track", {"end": "1,2"}, "--end", "found 2 values; expected 3"),
    ],
)
@pytest.mark.usefixtures("in_a_shell")
def test_options_that_cannot_be_read(name: str, options: dict[str, Any], column: str, words: str) -> None:
    with pytest.raises(InputError, match=words) as why:
        planned(name, **options)
    assert why.value.column == column


def test_the_controller_of_a_body(tmp_path: Path) -> None:
    text = (PUMA / "body.toml").read_text(encoding="utf-8")
    stated = '\n[controller]\nlaw = "station"\nvehicle_frequency = "90 deg/s"\nknows_current = false\n'
    (tmp_path / "body.toml").write_text(text.replace("\n[basis]", stated + "\n[basis]"), encoding="utf-8")
    assert read_arm(tmp_path).controller == Controller("station", np.pi / 2.0, knows_current=False)
    assert read_arm(PUMA).controller == Controller()
    names = {f.name for f in fields(Controller)}
    assert names == {f.name for f in fields(ControllerKeys)}
    assert names <= {f.name for f in fields(arm.Options)}
    for f in fields(Controller):
        value = getattr(Controller(), f.name)
        assert getattr(arm.Options(), f.name) == ("yes" if value is True else value)


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        ('law = "pid"', '"computed_torque" or "station"'),
        ("damping = 0", "above zero"),
        ('joint_frequency = "2 m"', "rad/s"),
        ("gain = 3", "gain"),
        ("knows_current = 1", "true or false"),
    ],
)
def test_a_controller_that_is_wrong(tmp_path: Path, wrong: str, words: str) -> None:
    text = (PUMA / "body.toml").read_text(encoding="utf-8").replace("\n[basis]", f"\n[controller]\n{wrong}\n\n[basis]")
    (tmp_path / "body.toml").write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=words) as why:
        read_arm(tmp_path)
    assert why.value.line == text.splitlines().index(wrong) + 1


@pytest.mark.parametrize("what", ["commands = [0, 0, 0, 0, 0, 0, 0, 0]", "torque = [0, 0, 0]"])
def test_a_kept_vehicle_takes_neither_commands_nor_torques(tmp_path: Path, what: str) -> None:
    head, _, _ = (PUMA / "body.toml").read_text(encoding="utf-8").partition("[[phase]]")
    text = f'{head}[[phase]]\nname = "x"\nlasts = 1\nvehicle = "kept"\n{what}\n'
    (tmp_path / "body.toml").write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=f"{what.split(maxsplit=1)[0]} of a vehicle that is kept"):
        read_arm(tmp_path)
