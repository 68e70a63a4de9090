"""``coeflab trim`` as a real process."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.cli.conftest import Run, flat
from tests.motion.test_trim import MASS, PLANE, PUSH, TURNING, thruster
from tests.motion.trimmed import parameter_file

FREE = ("--free", "u,v,r")


@pytest.fixture
def twin(tmp_path: Path) -> Path:
    pair = [thruster("left", -0.3), thruster("right", 0.3)]
    file = tmp_path / "twin.json"
    file.write_text(parameter_file(PLANE, MASS, TURNING, thrusters=pair).model_dump_json())
    return file


def test_commands_of_a_speed_as_a_table(coeflab: Run, twin: Path) -> None:
    done = coeflab("trim", twin, "--speed", "1.5", "--yaw-rate", "0", *FREE)
    assert (done.returncode, done.stderr) == (0, "")
    assert "left      56.2500  %      -100.0 .. 100.0 %" in done.stdout
    assert "One solution: 3 unknowns, 3 equations of rank 3" in flat(done.stdout)
    assert "Small motions about it are" in flat(done.stdout)


def test_a_turn_of_given_commands_as_json_twice_the_same(coeflab: Run, twin: Path) -> None:
    words = ("trim", twin, "--commands", "left=60", "--commands", "right=0", *FREE, "--json")
    done = coeflab(*words)
    assert (done.returncode, done.stderr) == (0, "")
    found = json.loads(done.stdout)
    values = {u["name"]: u["value"] for u in found["unknowns"]}
    assert values["left"] == 60.0
    assert values["yaw_rate"] > 0.0
    assert found["outcome"] == "unique"
    assert found["figures"]["radius"]["value"] > 0.0
    assert [e["violated"] for e in found["equations"]] == [False] * 3
    assert len(found["eigenvalues"]) == 3
    assert coeflab(*words).stdout == done.stdout


def test_an_infeasible_speed_names_the_equation_and_exits_1(coeflab: Run, twin: Path) -> None:
    done = coeflab("trim", twin, "--speed", "4", "--yaw-rate", "0", *FREE)
    assert (done.returncode, done.stderr) == (1, "")
    assert f"surge force X is off by {2.0 * PUSH * 100.0 - 160.0:.1f} N" in flat(done.stdout)
    assert "left is held at its bound of 100.000 %." in flat(done.stdout)
    assert "Motion\n" not in done.stdout


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ((), "neither a motion nor a command"),
        (("--commands", "left"), "NAME=NUMBER"),
        (("--commands", "left=x"), "NAME=NUMBER"),
        (("--commands", "left=1", "--commands", "left=2"), "twice"),
        (("--commands", "middle=1"), "one of left, right"),
        (("--speed", "nan"), "--speed"),
        (("--speed", "1", "--near", "lft=3"), "lft"),
        (("--speed", "1", "--plane", "slanted"), "plane"),
    ],
)
def test_wrong_input_is_one_message_and_exit_2(coeflab: Run, twin: Path, words: tuple[str, ...], said: str) -> None:
    done = coeflab("trim", twin, *words)
    assert done.returncode == 2
    assert done.stdout == ""
    assert done.stderr.count("error: ") == 1
    assert said in done.stderr
    assert "Traceback" not in done.stderr


@pytest.mark.parametrize(
    ("speed", "rate"), [("1.5", "3"), ("1.5 m/s", "3 deg/s"), ("150 cm/s", "0.05235987755982988 rad/s")]
)
def test_motions_take_their_units(coeflab: Run, twin: Path, speed: str, rate: str) -> None:
    done = coeflab("trim", twin, "--speed", speed, "--yaw-rate", rate, *FREE)
    assert (done.returncode, done.stderr) == (0, "")
    assert "yaw_rate 3.00000 deg/s given" in " ".join(done.stdout.split())


@pytest.mark.parametrize("words", [("--speed", "2 N"), ("--yaw-rate", "fast"), ("--roll", "2 m")])
def test_a_unit_that_does_not_fit(coeflab: Run, twin: Path, words: tuple[str, str]) -> None:
    done = coeflab("trim", twin, *words, *FREE)
    assert (done.returncode, done.stdout) == (2, "")
    assert f'"{words[0]}"' in done.stderr


def test_a_file_of_three_motions_needs_no_plane(coeflab: Run) -> None:
    huuv = Path(__file__).parents[2] / "cfd_data" / "huuv" / "huuv.parameters.json"
    done = coeflab("trim", huuv, "--commands", "left=40", "--commands", "right=100")
    assert (done.returncode, done.stderr) == (0, "")
    assert "w, p, q fixed at the initial values; the file has too few coefficients for p" in flat(done.stdout)
    assert "radius 1.14374 m" in " ".join(done.stdout.split())


LINEAR = ("trim", "remus100", "--speed", "1.5", "--yaw-rate", "0", *FREE)


def test_a_linear_model_as_tables_files_and_json(coeflab: Run, tmp_path: Path) -> None:
    done = coeflab(*LINEAR, "--linear", "--out", tmp_path / "l")
    assert (done.returncode, done.stderr) == (0, "")
    assert max(len(line) for line in done.stdout.splitlines() if str(tmp_path) not in line) <= 80
    assert "v_dot m/s^2 0 -0.7819 -0.5888" in flat(done.stdout)
    assert "r_dot rad/s^2 0 -1.596" in flat(done.stdout)
    assert "0.9953 - 0.6964 - r 54 %, v 46 %" in flat(done.stdout)
    assert sorted(p.name for p in (tmp_path / "l").iterdir()) == [
        "A.csv", "B.csv", "linear.json", "linear.m", "linear.mat", "linear.npz",
    ]  # fmt: skip
    found = json.loads(coeflab(*LINEAR, "--linear", "--json").stdout)
    model = found["linear"]
    assert [s["name"] for s in model["states"]] == ["u", "v", "r"]
    assert [s["rate_unit"] for s in model["states"]] == ["m/s^2", "m/s^2", "rad/s^2"]
    assert [c["unit"] for c in model["commands"]] == ["N", "rad"]
    assert model["A"][2][1] == pytest.approx(-4.5029, abs=5e-5)
    assert [model[k] for k in "ABCD"] == [model[k] for k in "abcd"]
    assert model["state_names"] == ["u", "v", "r"]
    assert model["command_names"] == [c["name"] for c in model["commands"]]
    assert [m["eigenvalue"] for m in model["modes"]] == found["eigenvalues"]
    assert "linear" not in json.loads(coeflab(*LINEAR, "--json").stdout)


def test_without_a_trim_no_linear_model_is_written(coeflab: Run, twin: Path, tmp_path: Path) -> None:
    done = coeflab("trim", twin, "--speed", "4", "--yaw-rate", "0", *FREE, "--out", tmp_path / "l")
    assert (done.returncode, done.stderr) == (1, "")
    assert not (tmp_path / "l").exists()


def test_six_motions_fit_80_columns(coeflab: Run) -> None:
    done = coeflab("trim", "remus100", "--speed", "1.5", "--yaw-rate", "0", "--pitch", "0", "--linear")
    assert done.returncode == 0
    assert max(map(len, done.stdout.splitlines())) <= 80
    assert "pitch 50 %" in flat(done.stdout)


def test_several_speeds_are_a_schedule_and_one_without_a_solution_is_named(
    coeflab: Run, twin: Path, tmp_path: Path
) -> None:
    words = (
        "trim",
        twin,
        "--speed",
        "1,150 cm/s,4",
        "--yaw-rate",
        "0",
        *FREE,
        "--also",
        "heading",
        "--lag",
        "left=0.2",
    )
    done = coeflab(*words, "--out", tmp_path / "l")
    assert (done.returncode, done.stderr) == (1, "")
    assert [len(line.split()) > 4 and line.split()[0] for line in done.stdout.splitlines()[2:5]] == [
        "1.000",
        "1.500",
        "4.000",
    ]
    rows = (tmp_path / "l" / "over_speed.csv").read_text().splitlines()
    assert [row.partition(",")[0] for row in rows[1:]] == ["1.0", "1.5"]
    assert {"A_heading_r", "A_left_lagged_left_lagged", "B_left_lagged_left"} <= set(rows[0].split(","))
    told = json.loads(coeflab(*words, "--linear", "--json").stdout)["speeds"]
    assert [("linear" in one, one["outcome"]) for one in told] == [
        (True, "unique"),
        (True, "unique"),
        (False, "infeasible"),
    ]
    assert told[0]["linear"]["a"][-1][-1] == -5.0


@pytest.mark.parametrize(
    "words", [("--speed", "1,2"), ("--speed", "1", "--also", "heading"), ("--speed", "1", "--lag", "left=1")]
)
def test_what_only_the_linear_model_takes_asks_for_it(coeflab: Run, twin: Path, words: tuple[str, ...]) -> None:
    done = coeflab("trim", twin, *words, *FREE)
    assert (done.returncode, done.stdout) == (2, "")
    assert "--linear" in done.stderr
