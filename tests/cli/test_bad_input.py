"""Wrong input: one message, exit code 2, nothing written."""

from __future__ import annotations

import shlex
import subprocess
from pathlib import Path

import pytest

from tests.cli.conftest import COEFLAB, Run, flat
from tests.cli.survey import too_long


def spoil(file: Path, old: str, new: str) -> None:
    text = file.read_text()
    assert old in text
    file.write_text(text.replace(old, new, 1))


@pytest.fixture
def study(coeflab: Run, tmp_path: Path) -> Path:
    coeflab("new", "s")
    return tmp_path / "s"


DRIFT, CAMPAIGN, PLAN = "campaign/drift.csv", "campaign/campaign.toml", "plan.toml"


@pytest.mark.parametrize(
    ("file", "old", "new", "said"),
    [
        (DRIFT, "Y [N]", "Y", ["drift.csv", "line 2", 'column "Y"', "without unit"]),
        (DRIFT, "Y [N]", "Y [furlong]", ["unit of another dimension", "unit of force"]),
        (DRIFT, "Y [N]", "Y [smoot]", ["unknown unit", "smoot"]),
        (DRIFT, "Y [N]", "X [N]", ["twice"]),
        (DRIFT, "beta [deg]", "beta [rad]", ["line 3", "half a turn", "beta [deg]"]),
        (DRIFT, "2,-9,", "2,nan,", ["line 4", 'column "beta [deg]"', '"nan"']),
        (DRIFT, "2,-9,", "2,inf,", ["line 4", '"inf"', "finite number"]),
        (DRIFT, "2,-9,", "2,nine,", ["line 4", '"nine"']),
        (CAMPAIGN, 'beta = "v = -U sin(beta)"', "", ["campaign.toml", "axes.beta", "no declared sign"]),
        (CAMPAIGN, 'frame = "FRD"', 'frame = ["forward", "port", "down"]', ["left-handed", "FLU"]),
        (CAMPAIGN, "speed = 2.0", "speed = 0.0", ["conditions.speed", "above zero"]),
        (CAMPAIGN, "contains_inertia = false\n", "", []),
        (PLAN, 'campaign = "campaign"', 'campaign = "nowhere"', ["plan.toml", "nowhere", "table[0].campaign"]),
        (PLAN, 'fits = ["slope_at_origin", "tied_law"]', 'fits = ["slope_at_orgin"]', ["did you mean slope_at_origin"]),
        (PLAN, 'name = "my_study"', 'name = "../up"', ["study.name", "it names files"]),
        (PLAN, "length = 1.60", "lenght = 1.60", ["scaling.length"]),
    ],
)
def test_one_message_exit_two_nothing_written(
    coeflab: Run, study: Path, file: str, old: str, new: str, said: list[str]
) -> None:
    spoil(study / file, old, new)
    if not said:
        spoil(study / file, "contains_inertia = false", "")
        said = ["contains_inertia", "rotating arm"]
    done = coeflab("run", study / PLAN)
    assert done.returncode == 2
    assert done.stdout == ""
    assert done.stderr.count("error: ") == 1
    assert "Traceback" not in done.stderr
    for text in said:
        assert text in done.stderr, done.stderr
    assert not (study.parent / "reports").exists()


def test_output_folder_that_cannot_be_written(coeflab: Run, study: Path) -> None:
    (study / "file").write_text("in the way")
    done = coeflab("run", study / PLAN, "--out", study / "file" / "below")
    assert done.returncode == 2
    assert "cannot write" in done.stderr


@pytest.mark.parametrize("what", ["missing", "folder", "empty", "binary"])
def test_fit_of_something_else(coeflab: Run, tmp_path: Path, what: str) -> None:
    path = tmp_path / "x.csv"
    if what == "folder":
        path.mkdir()
    elif what != "missing":
        path.write_bytes(b"" if what == "empty" else bytes(range(256)) * 100)
    done = coeflab("fit", path)
    assert done.returncode == 2
    assert done.stderr.startswith("error: ")


def test_parameter_file_that_is_none(coeflab: Run, tmp_path: Path) -> None:
    (tmp_path / "p.json").write_text('{"schema_version": "9"}')
    done = coeflab("params", "check", "p.json")
    assert done.returncode == 2
    assert "schema_version" in done.stderr


def test_a_campaign_in_place_of_a_parameter_file_is_told_the_way(coeflab: Run, study: Path) -> None:
    done = coeflab("compare", "s/campaign", "s/campaign")
    assert done.returncode == 2
    assert "s/campaign: found a folder; expected a parameter file" in flat(done.stderr)
    assert "coeflab run s/campaign fits it and writes the file" in flat(done.stderr)
    coeflab("run", "s/plan.toml")
    assert (
        "In it: reports/my_study/my_vehicle.parameters.json."
        in coeflab("compare", "reports/my_study", "reports/my_study").stderr
    )


def test_unknown_validation_names_the_near_one(coeflab: Run) -> None:
    assert "Did you mean suboff?" in coeflab("validate", "SUBOFF").stderr
    done = coeflab("validate", "subof")
    assert done.returncode == 2
    assert "Did you mean suboff?" in done.stderr
    assert 'found no validation "subof"' in done.stderr


def test_failed_check_is_exit_code_one(coeflab: Run, study: Path) -> None:
    spoil(study / CAMPAIGN, "v = -U sin(beta)", "v = +U sin(beta)")
    done = coeflab("run", study / PLAN)
    assert done.returncode == 1
    assert "Yv'" in flat(done.stdout)
    assert "below zero" in flat(done.stdout)


def test_an_export_that_is_refused_leaves_the_study_standing(coeflab: Run, study: Path) -> None:
    """The whole study was computed and thrown away, without report and parameter file."""
    plan = study / PLAN
    plan.write_text(plan.read_text() + '\n[[export]]\nto = "gazebo"\n')
    done = coeflab("run", plan)
    assert done.returncode == 1
    assert done.stderr.startswith("error: ")
    assert "export[0].accept_loss" in done.stderr
    assert done.stderr.count("\n") == 1
    written = sorted(p.name for p in (study.parent / "reports" / "my_study").iterdir())
    assert written == ["my_vehicle.coefficients.csv", "my_vehicle.parameters.json", "report.html"]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "files"),
    [
        ("huuv", ["huuv", "huuv_5dof"]),
        ("flyingfish", ["flyingfish_air", "flyingfish_water"]),
        (
            "thauv",
            [
                "thauv_case_01",
                "thauv_case_01_dive_1",
                "thauv_case_01_dive_2",
                "thauv_case_02",
                "thauv_case_02_dive_1",
                "thauv_case_02_dive_2",
                "thauv_case_02_spiral",
                "thauv_case_03",
                "thauv_case_03_dive_1",
                "thauv_case_03_dive_2",
            ],
        ),
    ],
)
def test_a_publication_writes_its_parameter_file_beside_the_report(
    coeflab: Run, tmp_path: Path, name: str, files: list[str]
) -> None:
    done = coeflab("validate", name)
    assert done.returncode == 0
    assert too_long(done.stdout) == []
    folder = tmp_path / "reports" / name
    assert sorted(p.name for p in folder.glob("*.parameters.json")) == [f"{f}.parameters.json" for f in files]
    assert (folder / "report.html").is_file()
    assert all(coeflab("params", "check", p).returncode == 0 for p in folder.glob("*.parameters.json"))


@pytest.mark.parametrize("more", [(), ("--json",)])
def test_fit_with_a_failed_check_is_exit_code_one(coeflab: Run, study: Path, more: tuple[str, ...]) -> None:
    """It printed the failure and exited 0."""
    spoil(study / CAMPAIGN, "v = -U sin(beta)", "v = +U sin(beta)")
    done = coeflab("fit", study / DRIFT, *more)
    assert (done.returncode, done.stderr) == (1, "")
    assert "below zero" in flat(done.stdout)


@pytest.mark.parametrize("command", ["formats", "params schema", "inspect suboff_roddy_2 --json", "--help"])
def test_a_reader_that_has_seen_enough_is_no_failure(command: str, tmp_path: Path) -> None:
    """``coeflab ... | head -1`` under pipefail gave 1."""
    piped = f"set -o pipefail; {shlex.quote(str(COEFLAB))} {command} | true"
    done = subprocess.run(["bash", "-c", piped], cwd=tmp_path, capture_output=True, text=True, check=False, timeout=120)
    assert (done.returncode, done.stderr) == (0, "")


def test_a_table_of_too_few_points_leaves_the_others_their_slopes(coeflab: Run, study: Path) -> None:
    """Two rows of drift ended a plan whose rotating arm and rudder were whole; alone they are still refused."""
    lines = (study / DRIFT).read_text().splitlines()
    (study / DRIFT).write_text("\n".join(lines[:4]) + "\n")
    done = coeflab("run", study / PLAN)
    assert done.returncode in (0, 1), done.stderr
    assert "too few points" in flat(done.stdout)
    assert (study.parent / "reports").exists()
    alone = coeflab("fit", study / DRIFT)
    assert alone.returncode == 2
    assert "2 usable points of the sweep over v'" in flat(alone.stderr)
    assert "at least 3" in flat(alone.stderr)


def test_rows_that_do_not_run_ahead_are_left_out_with_a_reason(coeflab: Run, study: Path) -> None:
    """170 degrees have the sine of 10 degrees; fitted as such they would change Yv' without a word."""
    before = coeflab("fit", study / "campaign" / "drift.csv", "--symbol", "Yv").stdout
    text = (study / DRIFT).read_text()
    (study / DRIFT).write_text(text + "99,170,10.0,5.0,1.0,\n")
    after = coeflab("fit", study / "campaign" / "drift.csv", "--symbol", "Yv").stdout
    assert "moves astern" in after
    value = before.splitlines()[0]
    assert value.startswith("Yv' = ")
    assert value in after


def test_output_to_a_full_device_is_one_message(study: Path) -> None:
    command = f"{COEFLAB} inspect {study / 'campaign'} > /dev/full"
    done = subprocess.run(["sh", "-c", command], capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert "Traceback" not in done.stderr


@pytest.mark.parametrize("name", ["n" * 5000, "~nobody-of-this-name"])
@pytest.mark.parametrize(
    "command", [("report",), ("run",), ("validate",), ("serve",), ("new",), ("inspect",), ("fit",), ("trim",)]
)
def test_a_name_that_no_path_can_have(coeflab: Run, tmp_path: Path, command: tuple[str, ...], name: str) -> None:
    if command == ("new",) and name[0] == "~":
        name += "/deep"
    done = coeflab(*command, name)
    assert done.returncode == 2
    assert done.stdout == ""
    assert done.stderr.count("error: ") == 1
    assert "Traceback" not in done.stderr
    assert "output" not in done.stderr
    assert len(done.stderr) < 1000
    assert list(tmp_path.iterdir()) == []


def test_a_long_name_is_an_unknown_study(coeflab: Run) -> None:
    done = coeflab("report", "n" * 5000)
    assert 'found the study "nnn' in done.stderr
    assert "a shipped validation (estimates, flyingfish, huuv, suboff, tank, thauv, urv)" in done.stderr
