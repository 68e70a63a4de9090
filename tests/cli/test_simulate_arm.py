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
    given = "--manoeuvre zigzag", "--simulator nonsense", "--record 0", "--step 0", "--hold u", "--tables", "--stiff 1"
    for option in (words.split() for words in given):
        done = coeflab("simulate", "urv_puma", *option)
        assert done.returncode == 2
        assert option[0].removeprefix("--") in done.stderr


def test_options_of_an_arm_and_keys_of_its_phases(coeflab: Run) -> None:
    said = flat(coeflab("simulate", "urv_puma", "--help-options").stdout)
    for what in ("tolerance", "[[phase]] lasts", "[[phase]] joints", "[start] rates", "docs/files.md"):
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
