"""coeflab simulate on the body.toml of a vehicle with an arm."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pandas as pd

from coeflab.core.files import shipped
from tests.cli.conftest import Run, flat

SHIPPED = shipped("geometry") / "urv_puma" / "body.toml"


def test_phases_of_the_shipped_arm(coeflab: Run, tmp_path: Path) -> None:
    done = coeflab("simulate", "urv_puma", "--record", "0.1", "--out", "moved", "--json")
    assert done.returncode == 0, done.stderr
    said = json.loads(done.stdout)
    assert said["ended"] == "complete"
    rows = pd.read_csv(tmp_path / "moved" / "arm_motion.csv")
    joints = rows[rows["phase [-]"] == 0]
    np.testing.assert_allclose(
        np.degrees(joints.iloc[-1][["shoulder [rad]", "upper_arm [rad]", "forearm [rad]"]]), [40, -60, 80]
    )
    assert said["last"]["end.down [m]"] == rows["end.down [m]"].iloc[-1]


def test_a_joint_that_meets_its_limit_ends_it_with_exit_code_1(coeflab: Run, tmp_path: Path) -> None:
    text = SHIPPED.read_text().partition("[[phase]]")[0]
    phase = '[[phase]]\nname = "fall"\nlasts = 60\nvehicle = "held"\ntorque = [0, 0, -2]\n'
    (tmp_path / "body.toml").write_text(text + phase)
    done = coeflab("simulate", "body.toml", "--out", "fallen")
    assert done.returncode == 1
    assert {f.suffix for f in (tmp_path / "fallen").iterdir()} == {".csv", ".svg", ".html"}
    assert "what was computed until then is written" in flat(coeflab("simulate", "--help").stdout.replace("│", " "))
    assert "out_of_range: in fall, at" in done.stdout
    assert "joint forearm is at its limit of -45 deg" in " ".join(done.stdout.split())


def test_what_an_arm_does_not_take(coeflab: Run) -> None:
    given = (
        "--manoeuvre zigzag",
        "--end 1,2,3",
        "--simulator nonsense",
        "--record 0",
        "--step 0",
        "--hold u",
        "--tables",
        "--stiff 1",
    )
    for option in (words.split() for words in given):
        done = coeflab("simulate", "urv_puma", *option)
        assert done.returncode == 2
        assert option[0].removeprefix("--") in done.stderr


def test_options_of_an_arm_and_keys_of_its_phases(coeflab: Run) -> None:
    said = flat(coeflab("simulate", "urv_puma", "--help-options").stdout)
    for what in (
        "tolerance",
        "station_keeping",
        "Options of end_effector_track",
        "[controller] law",
        "[[phase]] lasts",
        "[[phase]] joints",
        "[start] rates",
        "docs/files.md",
    ):
        assert what in said
    assert "rudder" not in said


def test_a_place_out_of_reach_is_said_from_the_datum_with_its_line(coeflab: Run, tmp_path: Path) -> None:
    text = SHIPPED.read_text().partition("[[phase]]")[0]
    for old, new in (
        ("centre_of_mass = [0.0, 0.0, 0.0]", "centre_of_mass = [0.1, 0.0, 0.0]"),
        ("\ncentre = [0.0, 0.0, 0.0]", "\ncentre = [0.1, 0.0, 0.0]"),
    ):
        assert old in text
        text = text.replace(old, new)
    text += '[[phase]]\nname = "far"\nlasts = 2\nend = [5.0, 0.0, -0.2]\n'
    (tmp_path / "body.toml").write_text(text)
    done = coeflab("simulate", "body.toml", "--out", "moved")
    said = flat(done.stderr)
    assert done.returncode == 2
    assert (
        f'body.toml, line {len(text.splitlines())}, "phase[0].end": found [5, 0, -0.2]: on the straight line from'
        in said
    )
    assert "no joint positions put it there" in said
    assert "from the datum" in said
    assert not (tmp_path / "moved").exists()


def test_the_vehicle_is_kept_while_the_joints_move(coeflab: Run, tmp_path: Path) -> None:
    options = "--manoeuvre station_keeping --joints 20,-40,30 --lasts 0.5 --stays 0 --record 0.1 --tolerance 1e-6"
    done = coeflab("simulate", "urv_puma", *options.split(), "--out", "kept")
    assert done.returncode == 0, done.stderr
    assert "off station, largest" in done.stdout
    assert "thrust, largest" in done.stdout
    names = {f"station_keeping.{end}" for end in ("csv", "svg", "html")}
    assert {f.name for f in (tmp_path / "kept").iterdir()} == names
    drawn = (tmp_path / "kept" / "station_keeping.svg").read_text(encoding="utf-8")
    for what in ("place [mm]", "attitude [", "asked for", "[% of largest]"):
        assert what in drawn.replace("  ", " ")


def test_thrusters_that_lose_directions_are_named_with_their_line(coeflab: Run, tmp_path: Path) -> None:
    text = SHIPPED.read_text()
    head, *thrusters = text.partition("[[phase]]")[0].split("[[thruster]]")
    for kept, words in ((4, "thrusters that make no heave, no roll, no pitch"), (0, "found no thrusters")):
        (tmp_path / "body.toml").write_text("[[thruster]]".join([head, *thrusters[:kept]]))
        done = coeflab("simulate", "body.toml", "--manoeuvre", "station_keeping", "--out", "kept")
        assert done.returncode == 2
        assert done.stderr.count("error:") == 1
        assert words in flat(done.stderr)
        assert "body.toml" in done.stderr
        assert not (tmp_path / "kept").exists()
    assert coeflab("simulate", "body.toml", "--manoeuvre", "free_motion", "--lasts", "0.2").returncode == 0


def test_a_place_of_an_option_or_a_phase_that_is_out_of_reach(coeflab: Run, tmp_path: Path) -> None:
    text = SHIPPED.read_text().replace("end = [0.75, -0.10, -0.70]", "end = [5, 0, 0]")
    (tmp_path / "body.toml").write_text(text)
    said = flat(coeflab("simulate", "body.toml", "--manoeuvre", "end_effector_track").stderr)
    assert f'line {text.splitlines().index("end = [5, 0, 0]") + 1}, "phase[2].end": found [5, 0, 0]' in said
    said = flat(coeflab("simulate", "body.toml", "--manoeuvre", "end_effector_track", "--end", "9,0,0").stderr)
    assert '"--end": found [9, 0, 0]' in said
