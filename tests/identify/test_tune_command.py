"""``coeflab tune`` as a real process."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from subprocess import CompletedProcess

import pytest

from coeflab.core.files import shipped
from tests.cli.conftest import flat

Run = Callable[..., CompletedProcess[str]]
HUUV = shipped("cfd_data") / "huuv"
PLAN = f"""[tune]
name = "mine"
parameters = "{HUUV / "huuv.parameters.json"}"
[measured]
table = "{HUUV / "turns.csv"}"
where = {{ source = "matlab" }}
magnitudes = ["beta"]
errors = {{ u = "0.01 m/s", beta = "0.3 deg", radius = "0.02 m" }}
[[free]]
name = "intercept"
places = ["thruster left ahead c0", "thruster right ahead c0"]
[[free]]
places = ["C_D 1"]
"""


@pytest.fixture
def plan(tmp_path: Path) -> Path:
    (tmp_path / "plan.toml").write_text(PLAN)
    return tmp_path / "plan.toml"


@pytest.mark.slow
def test_tables_and_files(coeflab: Run, plan: Path, tmp_path: Path) -> None:
    done = coeflab("tune", plan)
    assert (done.returncode, done.stderr) == (0, "")
    for words in ("mine: parameters", "intercept", "U95", "rms before", "determined: the data determine it."):
        assert words in flat(done.stdout)
    folder = tmp_path / "reports" / "mine"
    names = ["mine.agreement.svg", "mine.motions.csv", "mine.parameters.json"]
    assert sorted(p.name for p in folder.iterdir()) == names
    checked = coeflab("params", "check", folder / "mine.parameters.json")
    assert checked.returncode == 0


@pytest.mark.slow
def test_json(fresh: Run, plan: Path, tmp_path: Path) -> None:
    done = fresh("tune", plan, "--json", "--out", "here")
    assert (done.returncode, done.stderr) == (0, "")
    found = json.loads(done.stdout)
    assert found["converged"] is True
    assert [p["name"] for p in found["parameters"]] == ["intercept", "C_D 1"]
    first = found["parameters"][0]
    assert first["status"] == "ok"
    assert first["before"] == -2.338
    assert first["after"] == pytest.approx(-2.338, abs=0.01)
    assert first["places"] == ["thruster left ahead c0", "thruster right ahead c0"]
    assert [q["cases"] for q in found["quantities"]] == [28, 28, 28]
    assert found["correlation"][0][0] == pytest.approx(1.0)
    assert all((tmp_path / p).is_file() for p in found["files"])


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("C_D 1", "C_D 2", "C_D 2"),
        ('source = "matlab"', 'source = "other"', "no row"),
        ('name = "mine"', "", "tune.name"),
        ("0.3 deg", "0.3 m", "another dimension"),
    ],
)
def test_a_bad_plan_ends_with_one_error_and_nothing_written(
    coeflab: Run, plan: Path, tmp_path: Path, old: str, new: str, message: str
) -> None:
    plan.write_text(PLAN.replace(old, new))
    done = coeflab("tune", plan)
    assert done.returncode == 2
    assert done.stdout == ""
    assert done.stderr.startswith("error: ")
    assert done.stderr.count("\n") == 1
    assert message in done.stderr
    assert [p.name for p in tmp_path.iterdir()] == ["plan.toml"]


def test_no_plan(coeflab: Run) -> None:
    done = coeflab("tune", "nothing.toml")
    assert done.returncode == 2
    assert "no such file" in done.stderr
