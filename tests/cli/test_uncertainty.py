"""``coeflab uncertainty`` as a real process: killed and started again, files, and input that cannot be."""

from __future__ import annotations

import csv
import json
import os
import signal
import subprocess
import time
from collections.abc import Callable
from pathlib import Path
from subprocess import CompletedProcess

import psutil
import pytest

from tests.cli.conftest import COEFLAB, flat
from tests.motion.uncertain import uncertain_torpedo, with_uncertainty

Run = Callable[..., CompletedProcess[str]]
ASKED = ("--manoeuvre", "zigzag", "--executes", "2", "--longest", "60", "--hold", "w,p,q", "--json")
MANY = ("--members", "300", *ASKED)
BATCHES = 3


@pytest.fixture
def torpedo(tmp_path: Path) -> Path:
    path = tmp_path / "torpedo.parameters.json"
    path.write_bytes(uncertain_torpedo().to_json())
    return path


def finished(store: Path) -> dict[Path, int]:
    return {p: p.stat().st_mtime_ns for p in store.rglob("batch_*.json")}


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory: pytest.TempPathFactory) -> tuple[str, dict[str, bytes]]:
    """What a run on one process prints and keeps when nobody kills it."""
    folder = tmp_path_factory.mktemp("undisturbed")
    (folder / "torpedo.parameters.json").write_bytes(uncertain_torpedo().to_json())
    command = [str(COEFLAB), "uncertainty", "torpedo.parameters.json", *MANY, "--state", "store"]
    done = subprocess.run(command, capture_output=True, text=True, check=True, cwd=folder)
    assert done.stderr == ""
    return done.stdout, {p.name: p.read_bytes() for p in finished(folder / "store")}


@pytest.mark.slow
def test_killed_and_started_again(torpedo: Path, tmp_path: Path, undisturbed: tuple[str, dict[str, bytes]]) -> None:
    command = [str(COEFLAB), "uncertainty", str(torpedo), *MANY, "--cores", "2"]
    store = tmp_path / "store"
    with subprocess.Popen(
        [*command, "--state", str(store)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    ) as process:
        limit = time.monotonic() + 100.0
        while not finished(store):
            assert process.poll() is None, "it came to its end before it could be killed"
            assert time.monotonic() < limit
            time.sleep(0.005)
        children = psutil.Process(process.pid).children(recursive=True)
        os.kill(process.pid, signal.SIGKILL)
    assert process.returncode == -signal.SIGKILL
    _, orphans = psutil.wait_procs(children, timeout=30.0)
    assert not orphans
    before = finished(store)
    assert 1 <= len(before) < BATCHES
    again = subprocess.run([*command, "--state", str(store)], capture_output=True, text=True, check=True)
    printed, fresh = undisturbed
    assert again.stdout == printed
    assert f"{len(before)} of {BATCHES} batches were found" in again.stderr
    after = finished(store)
    assert {p: after[p] for p in before} == before
    assert {p.name: p.read_bytes() for p in after} == fresh
    assert len(fresh) == BATCHES


@pytest.mark.slow
def test_tables_files_and_a_second_run(coeflab: Run, torpedo: Path, tmp_path: Path) -> None:
    done = coeflab("uncertainty", torpedo, "--members", "64", "--sobol", "--out", "out", *ASKED[:-1])
    assert (done.returncode, done.stderr) == (0, "")
    for words in (
        "first overshoot", "95 % interval", "where its variance comes from", "Which test takes most off", "G_h",
        "no uncertainty is stated", "distribution: normal",
    ):  # fmt: skip
        assert words in flat(done.stdout)
    rows = list(csv.DictReader((tmp_path / "out" / "zigzag_members.csv").read_text().splitlines()))
    assert len(rows) == 64
    assert {"d Ndr'", "first overshoot"} <= set(rows[0])
    svg = (tmp_path / "out" / "zigzag_uncertainty.svg").read_bytes()
    assert b"where its variance comes from" in svg
    again = coeflab("uncertainty", torpedo, "--members", "64", "--sobol", "--out", "out", *ASKED[:-1])
    assert again.stdout == done.stdout
    assert "batches were found" in again.stderr
    assert (tmp_path / "out" / "zigzag_uncertainty.svg").read_bytes() == svg


@pytest.mark.slow
def test_json_tells_the_same(coeflab: Run, torpedo: Path, tmp_path: Path) -> None:
    content = json.loads(coeflab("uncertainty", torpedo, "--members", "64", *ASKED).stdout)
    assert not list(tmp_path.glob("*/"))
    figures = {f["name"]: f for f in content["figures"]}
    over = figures["first overshoot"]
    assert over["low"] < over["median"] < over["high"]
    assert (over["interval"], over["members_with_it"]) == ("ok", 1.0)
    assert figures["second overshoot"]["low"] is None
    assert content["shares"]["first overshoot"]["groups"] == []
    assert set(content["varied"]) == {c.symbol for c in uncertain_torpedo().coefficients if c.u95 is not None}


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--members", "0"), "0 members"),
        (("--cores", "-1"), "workers"),
        (("--manoeuvre", "loop"), "loop"),
        (("--rudder", "10 parsec"), "parsec"),
        (("--current", "1,2"), "--current"),
        (("--state", "torpedo.parameters.json"), "cannot write"),
    ],
)
def test_wrong_input_is_one_clear_error(coeflab: Run, torpedo: Path, words: tuple[str, ...], said: str) -> None:
    given = {"--members": "40", "--manoeuvre": "zigzag", "--executes": "2", "--longest": "20", "--hold": "u,w,p,q"}
    given |= dict(zip(words[::2], words[1::2], strict=True))
    done = coeflab("uncertainty", torpedo, *(word for pair in given.items() for word in pair))
    assert (done.returncode, done.stdout) == (2, "")
    assert said in done.stderr
    assert done.stderr.count("\n") == 1


def test_a_covariance_that_is_none(coeflab: Run, tmp_path: Path) -> None:
    pairs = {("Yv'", "Nv'"): 0.9, ("Yv'", "Nr'"): 0.9, ("Nv'", "Nr'"): -0.9}
    file = with_uncertainty(uncertain_torpedo(), {"Yv'": 1e-3, "Nv'": 1e-3, "Nr'": 1e-3}, pairs)
    (tmp_path / "file.json").write_bytes(file.to_json())
    done = coeflab("uncertainty", "file.json", *ASKED)
    assert (done.returncode, done.stdout) == (2, "")
    assert "positive semidefinite" in done.stderr
