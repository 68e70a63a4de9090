"""Values that a shell offers."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from coeflab.arm.commands import derive
from coeflab.cli import complete, schema
from coeflab.identify.commands import tune
from coeflab.tank.commands import tow
from tests.cli.conftest import Run


@pytest.mark.parametrize(
    ("offer", "begun", "offered"),
    [
        (complete.exporters, "xd", ["xdyn"]),
        (complete.manoeuvres, "zig", ["zigzag"]),
        (complete.validations, "sub", ["suboff"]),
        (complete.bodies, "remus", ["remus100"]),
        (
            complete.campaigns,
            "suboff_roddy_",
            ["suboff_roddy_1", "suboff_roddy_2", "suboff_roddy_2_dimensional", "suboff_roddy_3"],
        ),
        (complete.fits, "slope", ["slope_at_origin"]),
        (tow.solvers, "open", ["openfoam"]),
        (tow.runners, "slu", ["slurm"]),
        (complete.reports, "html,pd", ["html,pdf"]),
        (complete.methods, "pan", ["panel"]),
        (schema.kinds, "camp", ["campaign"]),
        (complete.accelerations, "comp", ["computed"]),
        (complete.units, "m", ["m", "mm"]),
        (complete.axes, "F", ["FLU", "FRD"]),
        (complete.axes, "forward,p", ["forward,port"]),
        (complete.axes, "forward,port,", ["forward,port,down", "forward,port,up"]),
        (complete.symbols, "Yd", ["Ydb", "Ydr", "Yds"]),
        (derive.languages, "la", ["latex"]),
        (derive.arms, "urv_", ["urv_puma"]),
        (derive.arms, "remus", []),
    ],
)
def test_names_that_begin_so(offer, begun: str, offered: list[str]) -> None:
    assert offer(begun) == offered


def test_paths_come_behind_names(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "suboff_mine").mkdir()
    (tmp_path / "suboff.csv").touch()
    assert complete.studies("suboff") == ["suboff", "suboff.csv", "suboff_mine/"]
    assert complete.inspected(f"{tmp_path}/suboff_") == [f"{tmp_path}/suboff_mine/"]


def test_a_shell_is_answered(coeflab: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("_COEFLAB_COMPLETE", "complete_bash")
    monkeypatch.setenv("COMP_WORDS", "coeflab export a.json --to xd")
    monkeypatch.setenv("COMP_CWORD", "4")
    assert coeflab().stdout.split() == ["xdyn"]


@pytest.mark.parametrize(
    ("line", "offered"),
    [
        ("coeflab simulate a.json --manoeuvre zigzag --rud", ["--rudder"]),
        ("coeflab simulate a.json --integ", ["--integrator"]),
        ("coeflab simulate a.json --manoeuvre nothing --rud", []),
        ("coeflab derive urv_puma --to o", ["octave"]),
        ("coeflab fit suboff_roddy_2 --symbol Yd", ["Ydb", "Ydr", "Yds"]),
    ],
)
def test_a_shell_is_offered_values_and_options(
    coeflab: Run, monkeypatch: pytest.MonkeyPatch, line: str, offered: list[str]
) -> None:
    monkeypatch.setenv("_COEFLAB_COMPLETE", "complete_bash")
    monkeypatch.setenv("COMP_WORDS", line)
    monkeypatch.setenv("COMP_CWORD", str(len(line.split()) - 1))
    assert coeflab().stdout.split() == offered


def test_every_plan_and_parameter_file_is_offered() -> None:
    assert complete.parameters("remus") == ["remus100"]
    assert complete.plans("subo") == ["suboff"]
    assert "huuv" in tune.tunings("hu")


def test_a_shipped_name_is_a_parameter_file(coeflab: Run, tmp_path: Path) -> None:
    """A vehicle of the package was found by its path in a checkout only."""
    by_name = coeflab("simulate", "remus100", "--manoeuvre", "zigzag", "--executes", "2", "--json")
    assert (by_name.returncode, by_name.stderr) == (0, "")
    checked = coeflab("params", "check", "huuv", "--json")
    assert json.loads(checked.stdout)["name"] == "huuv"
    missing = coeflab("simulate", "remus10")
    assert missing.returncode == 2
    assert "remus100" in missing.stderr
    (tmp_path / "remus100").mkdir()
    assert coeflab("params", "check", "remus100").returncode == 0
