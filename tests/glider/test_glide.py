"""``coeflab glide`` as a real process."""

from __future__ import annotations

import csv
import json
import math
from collections.abc import Callable
from pathlib import Path
from subprocess import CompletedProcess

import pytest

from coeflab.core.files import shipped
from tests.cli.conftest import flat

Run = Callable[..., CompletedProcess[str]]
SLOCUM = shipped("cfd_data") / "slocum" / "slocum.toml"
FILES = ("slocum_motion.csv", "slocum_steady.csv", "slocum_polar.csv", "slocum_polar.svg", "motion.svg")


@pytest.mark.slow
def test_tables_files_and_a_second_run(coeflab: Run, tmp_path: Path) -> None:
    done = coeflab("glide", "slocum", "--cycles", "2", "--out", "out", "--basis")
    assert (done.returncode, done.stderr) == (0, "")
    for words in (
        "steady glides",
        "phases in time",
        "-25.000",
        "climb",
        "stable",
        "derived: hull 40 kg",
        "motion.svg: written",
    ):
        assert words in flat(done.stdout)
    assert sorted(p.name for p in (tmp_path / "out").iterdir()) == sorted(FILES)
    again = coeflab("glide", "slocum", "--cycles", "2", "--out", "out")
    assert flat(again.stdout).count(": unchanged") == len(FILES)


@pytest.mark.slow
def test_csv_and_json_tell_the_same(coeflab: Run, tmp_path: Path) -> None:
    done = coeflab("glide", SLOCUM, "--record", "5", "--out", "out", "--json")
    content = json.loads(done.stdout)
    (glider,) = content["gliders"]
    rows = list(csv.DictReader((tmp_path / "out" / "slocum_motion.csv").read_text().splitlines()))
    assert float(rows[-1]["depth [m]"]) == pytest.approx(glider["phases"][-1]["depth"], rel=1e-8)
    assert float(rows[-1]["time [s]"]) == pytest.approx(glider["phases"][-1]["ends"], rel=1e-8)
    assert rows[0]["alpha [deg]"] == ""
    assert [round(math.degrees(s["zeta"]), 3) for s in glider["steady_glides"]] == [-25.0, 25.0]
    steady = list(csv.DictReader((tmp_path / "out" / "slocum_steady.csv").read_text().splitlines()))
    assert [float(r["V [m/s]"]) for r in steady] == pytest.approx([s["speed"] for s in glider["steady_glides"]])
    polar = list(csv.DictReader((tmp_path / "out" / "slocum_polar.csv").read_text().splitlines()))
    assert len({r["net_mass [kg]"] for r in polar}) == 2
    for r in polar[::50]:
        assert float(r["theta [deg]"]) == pytest.approx(float(r["alpha [deg]"]) + float(r["zeta [deg]"]), abs=1e-6)


@pytest.mark.slow
def test_without_out_nothing_is_written(fresh: Run, tmp_path: Path) -> None:
    assert fresh("glide", "slocum").returncode == 0
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("no_such_glider",), "no file or folder"),
        (("suboff_roddy_1",), "found a campaign, with [campaign]; expected a file with [glider]"),
        (("slocum", "--record", "0"), "glider.step"),
        (("slocum", "--cycles", "0"), "cycles"),
    ],
)
def test_one_error_and_exit_code_2(coeflab: Run, tmp_path: Path, arguments: tuple[str, ...], words: str) -> None:
    done = coeflab("glide", *arguments, "--out", "out")
    assert done.returncode == 2
    assert words in done.stderr
    assert "Traceback" not in done.stderr
    assert not (tmp_path / "out").exists()


def test_an_angle_without_its_unit_is_refused(coeflab: Run, tmp_path: Path) -> None:
    text = SLOCUM.read_text().replace('angle_unit = "rad"\n', "")
    (tmp_path / "mine.toml").write_text(text)
    done = coeflab("glide", "mine.toml")
    assert done.returncode == 2
    assert done.stderr.startswith('error: mine.toml, line 27, "polar.angle_unit": found nothing')


@pytest.mark.slow
def test_a_motion_that_ends_early_says_so(coeflab: Run, tmp_path: Path) -> None:
    (tmp_path / "mine.toml").write_text(SLOCUM.read_text().replace("K_M = -100.0", "K_M = 1e17"))
    done = coeflab("glide", "mine.toml")
    assert done.returncode == 1
    assert "The motion ended early: in dive, after" in flat(done.stdout)
