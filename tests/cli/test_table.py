"""``coeflab table``: fitted tables evaluated on a grid."""

from __future__ import annotations

import csv
import io
import math
from pathlib import Path

import numpy as np
import pytest

from coeflab.cli.table import wanted
from coeflab.core.errors import InputError
from coeflab.law.symbols import FLOW_ANGLES
from coeflab.vehicle.parameter_file import read_parameter_file
from tests.cli.conftest import Run

PARAMS = Path(__file__).parents[1] / "data" / "parameters_1_1.json"


def rows(text: str) -> tuple[list[str], list[list[str]]]:
    content = list(csv.reader(io.StringIO(text)))
    return content[0], content[1:]


def test_a_grid_with_units_in_its_header(coeflab: Run) -> None:
    done = coeflab("table", PARAMS, "--alpha=-20:20:1", "--beta=0", "--response", "C_D")
    assert done.returncode == 0
    assert done.stderr.splitlines() == [FLOW_ANGLES["alpha"], FLOW_ANGLES["beta"]]
    header, body = rows(done.stdout)
    assert header == ["alpha [deg]", "beta [deg]", "C_D [-]", "C_D U95 [-]", "inside"]
    assert [float(r[0]) for r in body] == list(range(-20, 21))
    model = read_parameter_file(PARAMS).models[0]
    values, half, _ = model.evaluate({"alpha": np.radians(np.arange(-20.0, 21.0)), "beta": np.zeros(41)})
    np.testing.assert_allclose([float(r[2]) for r in body], values, rtol=1e-9)
    np.testing.assert_allclose([float(r[3]) for r in body], half, rtol=1e-9)
    assert {r[4] for r in body} == {"1"}


def test_the_last_variable_runs_fastest_and_all_responses_are_given(coeflab: Run) -> None:
    header, body = rows(coeflab("table", PARAMS, "--beta", "0,30", "--alpha", "-5:5:5").stdout)
    assert header[:2] == ["beta [deg]", "alpha [deg]"]
    assert header[2:] == ["C_D [-]", "C_D U95 [-]", "C_n [-]", "C_n U95 [-]", "inside"]
    assert [(r[0], r[1]) for r in body] == [(b, a) for b in ("0", "30") for a in ("-5", "0", "5")]
    assert [r[-1] for r in body] == ["1"] * 3 + ["0"] * 3


def test_primes_are_read_as_such(coeflab: Run) -> None:
    header, body = rows(coeflab("table", PARAMS, "--v=0.1,0.2", "--response=Y").stdout)
    assert header == ["v' [-]", "Y' [-]", "Y' U95 [-]", "inside"]
    wanted_ = read_parameter_file(PARAMS).models[2].evaluate({"v": np.array([0.1, 0.2])})[0]
    np.testing.assert_allclose([float(r[1]) for r in body], wanted_, rtol=1e-9)


def test_refused_cells_are_blank(coeflab: Run, tmp_path: Path) -> None:
    text = PARAMS.read_text().replace('"extrapolation": "clamp"', '"extrapolation": "refuse"')
    (tmp_path / "p.json").write_text(text)
    _, body = rows(coeflab("table", "p.json", "--alpha=0,26", "--beta=5", "--response=C_D").stdout)
    assert body[0][4] == "1"
    assert body[1] == ["26", "5", "", "", "0"]


def test_a_file_gets_the_same_bytes(coeflab: Run, tmp_path: Path) -> None:
    grid = ("--alpha=-25:25:0.5", "--beta=0:25:0.5")
    done = coeflab("table", PARAMS, *grid, "--out", "deep/t.csv")
    assert (done.returncode, done.stdout) == (0, "")
    assert (tmp_path / "deep" / "t.csv").read_text() == coeflab("table", PARAMS, *grid).stdout
    assert "unchanged" in coeflab("table", PARAMS, *grid, "--out", "deep/t.csv").stderr


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--alpha=0"], "expected values for alpha and beta"),
        (["--alpha=0", "--gamma=0"], 'unknown variable "gamma"'),
        ([], "no variable"),
        (["--alpha=0:1:1e-9", "--beta=0"], "more than 5,000,000 points"),
        (["--alpha=0:3000:1", "--beta=0:3000:1"], "more than 5,000,000 points"),
        (["--alpha=0:1e308:1e-308", "--beta=0"], "more than 5,000,000 points"),
        (["--alpha=0:1:0", "--beta=0"], "step above zero"),
        (["--alpha=1:0:0.1", "--beta=0"], "low below the high"),
        (["--alpha=0:1", "--beta=0"], "low:high:step"),
        (["--alpha=ten", "--beta=0"], '"ten"'),
        (["--alpha=", "--beta=0"], "a blank value"),
        (["--alpha=inf", "--beta=0"], "low:high:step"),
        (["--alpha=0", "--beta=0", "--alpha=1"], "twice"),
        (["--alpha=0", "--beta"], "--NAME=VALUES"),
        (["--alpha=0", "--beta=0", "--response=C_Q"], "one of C_D, C_n, Y'"),
        (["stray"], "stray"),
    ],
)
def test_wrong_input_is_one_message_and_exit_code_two(coeflab: Run, arguments: list[str], said: str) -> None:
    done = coeflab("table", PARAMS, *arguments)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith("error: ")
    assert done.stderr.count("\n") == 1
    assert said in done.stderr


def test_the_file_stands_before_the_values(coeflab: Run) -> None:
    done = coeflab("table", "--alpha=0", PARAMS, "--beta=0")
    assert done.returncode == 2
    assert "parameter file first" in done.stderr


def test_a_range_reaches_its_end_in_spite_of_rounding() -> None:
    assert wanted(["--alpha=0:0.3:0.1"])["alpha"].tolist() == pytest.approx([0.0, 0.1, 0.2, 0.3])
    assert len(wanted(["--alpha=-20:20:0.1"])["alpha"]) == 401
    assert wanted(["--alpha=0:1:0.4"])["alpha"].tolist() == pytest.approx([0.0, 0.4, 0.8])
    assert wanted(["--alpha=3:3:1"])["alpha"].tolist() == [3.0]


def test_the_largest_grid_is_allowed() -> None:
    given = wanted(["--alpha=1:5000000:1"])
    assert math.prod(len(x) for x in given.values()) == 5_000_000
    with pytest.raises(InputError, match="5,000,000"):
        wanted(["--alpha=0:5000000:1"])


def test_a_table_over_sway_takes_the_drift_angle(coeflab: Run) -> None:
    done = coeflab("table", PARAMS, "--beta=0:20:5", "--response=Y")
    assert (done.returncode, done.stderr) == (0, FLOW_ANGLES["beta"] + "\n")
    header, body = rows(done.stdout)
    assert header == ["beta [deg]", "Y' [-]", "Y' U95 [-]", "inside"]
    v = np.sin(np.radians(np.arange(0.0, 21.0, 5.0)))
    wanted_ = read_parameter_file(PARAMS).models[2].evaluate({"v": v})[0]
    np.testing.assert_allclose([float(r[1]) for r in body], wanted_, rtol=1e-8)


def test_standard_error_counts_the_points_outside(coeflab: Run, tmp_path: Path) -> None:
    done = coeflab("table", PARAMS, "--alpha=0,30,40", "--beta=5", "--response=C_D")
    assert done.returncode == 0
    assert done.stderr.endswith("2 of 3 points lie outside the domain (inside = 0)\n")
    done = coeflab("table", PARAMS, "--alpha=0,30,40", "--beta=5", "--out", "t.csv")
    assert "2 of 3 points lie outside every domain (inside = 0)\n" in done.stderr


def test_with_no_point_inside_standard_error_gives_the_limits(coeflab: Run) -> None:
    done = coeflab("table", PARAMS, "--alpha=30:40:5", "--beta=5")
    assert done.returncode == 0
    assert len(rows(done.stdout)[1]) == 3
    assert "all 3 points lie outside every domain" in done.stderr
    assert "C_D, C_n: alpha -25 to 25 deg, beta 0 to 25 deg\n" in done.stderr
    done = coeflab("table", PARAMS, "--v=0.5")
    assert "the point lies outside the domain" in done.stderr
    assert "Y': v' 0 to 0.422618 (beta 0 to 25 deg)\n" in done.stderr
