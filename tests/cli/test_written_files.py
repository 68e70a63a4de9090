"""Every command that writes a parameter file says what ``coeflab params check`` fails in it, and ends with 1 where it does."""

from __future__ import annotations

import json
from pathlib import Path
from subprocess import CompletedProcess

import pytest

from coeflab.core.files import shipped
from coeflab.core.finding import Severity
from coeflab.vehicle.parameter_file import read_parameter_file
from coeflab.vehicle.plausibility import plausibility
from coeflab.vehicle.plausible_added_mass import LAW
from tests.cli.conftest import Run, Validated

OWN = ("--length", "2 m", "--speed", "1.5 m/s", "--density", "1025", "--about", "cg")
SOUND = ("--set", "Yv'=-0.03 +- 0.003", "--set", "Nr'=-0.006")
DRIVES = ("--set", "Yv'=-0.03 +- 0.003", "--set", "Nr'=0.006")
REMUS = str(shipped("cfd_data") / "remus100" / "remus100.parameters.json")
WATER = str(shipped("cfd_data") / "flyingfish_water_synthetic" / "plan.toml")
TUNE = str(shipped("cfd_data") / "huuv" / "tune.toml")
FAST = {
    "params new": ("params", "new", "mine", *OWN, *SOUND, "--out", "out"),
    "params new, a wrong sign": ("params", "new", "mine", *OWN, *DRIVES, "--out", "out"),
    "merge": ("merge", REMUS, "--set", "Yv|v|'=-0.1", "--out", "out"),
    "merge, a wrong sign": ("merge", REMUS, "--set", "Yv|v|'=0.5", "--out", "out"),
    "run": ("run", WATER, "--out", "out"),
}
SLOW = {
    "vehicle": ("vehicle", "myring_auv", "--out", "out"),
    "tune": ("tune", TUNE, "--out", "out"),
}


def holds(done: CompletedProcess[str], out: Path, *, fails: bool | None = None) -> None:
    """Each failure of each file that a command wrote is among what it says."""
    assert done.returncode in (0, 1), done.stderr
    printed = json.loads(done.stdout)
    rows = [*printed.get("findings", []), *printed.get("checks", [])]
    failing = {r["found"] for r in rows if r["severity"] == "fail"}
    files = sorted(out.rglob("*.parameters.json"))
    assert files
    failures = [c for f in files for c in plausibility(read_parameter_file(f)) if c.severity is Severity.FAIL]
    assert {c.statistic for c in failures if c.name != LAW} <= failing
    if fails is not None:
        assert bool(failures) is fails
    if failures:
        assert done.returncode == 1


@pytest.mark.parametrize("name", FAST)
def test_what_params_check_fails_is_said_by_the_writer(coeflab: Run, tmp_path: Path, name: str) -> None:
    holds(coeflab(*FAST[name], "--json"), tmp_path / "out", fails="wrong sign" in name)


@pytest.mark.slow
@pytest.mark.parametrize("name", SLOW)
def test_what_params_check_fails_is_said_by_slower_writers(coeflab: Run, tmp_path: Path, name: str) -> None:
    holds(coeflab(*SLOW[name], "--json"), tmp_path / "out", fails=False)


@pytest.mark.slow
def test_what_params_check_fails_is_said_by_the_validation(validated: Validated) -> None:
    folder, _, _, again = validated
    holds(again, folder / "reports", fails=False)


def test_every_command_that_writes_a_parameter_file_is_here() -> None:
    """Places of the source that make its bytes: those of exports and tunings, which run, validate, vehicle, merge and tune share, params new, identify."""
    package = Path(__file__).parents[2] / "coeflab"
    writers = {
        str(f.relative_to(package)) for f in package.rglob("*.py")
        if '.parameters.json"' in (text := f.read_text(encoding="utf-8")) and "to_json()" in text
    }  # fmt: skip
    assert writers == {
        "formats/export.py",
        "identify/tune.py",
        "cli/params.py",
        "identify/commands/identify.py",
        "api/vehicle.py",
    }
