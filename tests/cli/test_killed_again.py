"""Commands that are killed at some moment, or meet a full disk, and are given again: they succeed, with the same bytes and no debris."""

from __future__ import annotations

import os
import random
import signal
import subprocess
import time
from pathlib import Path

import pytest

from coeflab.core.files import shipped
from tests.cli.conftest import COEFLAB
from tests.cli.forked import Forks

TABLE = "beta [deg],Y [N],N [N*m]\n-6,33,11\n-3,16,6\n0,0,0\n3,-16,-6\n6,-33,-11\n"
SET = ("axes.frame=FRD", "axes.reference_point=-2 from nose", "scaling.length=4 LOA", "conditions.density=1000", "conditions.speed=2")  # fmt: skip
STUDY = str(Path(__file__).parents[2] / "coeflab" / "cli" / "template" / "plan.toml")
TANK = str(shipped("cfd_data") / "tank" / "spheroid.toml")
COMMANDS = {
    "import": ["import", "t.csv", "--out", "o", "--accept", *(w for one in SET for w in ("--set", one))],
    "tow": ["tow", "tow_spheroid", "--matrix", TANK, "--solver", "external", "--out", "o"],
    "report": ["report", STUDY, "--to", "html", "--out", "o"],
    "export": ["export", "huuv", "--to", "csv", "--to", "fmi", "--accept-loss", "--out", "o"],
}
TIMES = int(os.environ.get("COEFLAB_KILLS", "2"))  # 40 of each were tried once


def content(folder: Path) -> dict[str, bytes]:
    return {str(p.relative_to(folder)): p.read_bytes() for p in folder.rglob("*") if p.is_file() and p.name != ".lock"}


def place(folder: Path) -> Path:
    folder.mkdir()
    (folder / "t.csv").write_text(TABLE)
    return folder


@pytest.mark.slow
@pytest.mark.parametrize("name", COMMANDS)
def test_killed_and_given_again(tmp_path: Path, name: str, forks: Forks) -> None:
    """In processes that need not import coeflab first, so that each moment lies within the work; each moment is tried with both signals."""
    command = COMMANDS[name]
    forks.run(["formats"], tmp_path)
    begin = time.monotonic()
    whole = place(tmp_path / "whole")
    assert forks.run(command, whole).returncode == 0
    seconds = time.monotonic() - begin
    wanted = content(whole / "o")
    assert wanted
    chance, hit = random.Random(34), 0
    for k in range(TIMES):
        folder = place(tmp_path / str(k))
        how = (signal.SIGKILL, signal.SIGTERM)[k % 2]
        hit += forks.run(command, folder, kill=(seconds * chance.uniform(0.05, 0.95), how)).returncode == -how
        again = forks.run(command, folder)
        assert again.returncode == 0, again.stderr
        assert content(folder / "o") == wanted
    assert hit or TIMES < 10
    print(f"{name}: {hit} of {TIMES} were killed within the work")  # noqa: T201


@pytest.mark.slow
@pytest.mark.parametrize("name", COMMANDS)
def test_a_full_disk_and_room_again(tmp_path: Path, name: str, forks: Forks) -> None:
    command = COMMANDS[name]
    whole = place(tmp_path / "whole")
    assert forks.run(command, whole).returncode == 0
    wanted = content(whole / "o")
    for largest in (300, max(map(len, wanted.values())) - 1):
        folder = place(tmp_path / str(largest))
        full = forks.run(command, folder, largest=largest)
        assert full.returncode == 2, full.stderr
        assert "cannot write" in full.stderr
        assert "Traceback" not in full.stderr
        assert [f for f in folder.rglob("*") if f.name.endswith(".coeflab")] == []
        if name != "tow":  # a tow goes on with the conditions that it has
            assert content(folder / "o") == {}
        assert forks.run(command, folder).returncode == 0
        assert content(folder / "o") == wanted


@pytest.mark.slow
def test_a_command_of_its_own_process_killed(tmp_path: Path) -> None:
    """As a shell starts it, killed while it imports or soon after."""
    command = [str(COEFLAB), *COMMANDS["export"]]
    process = subprocess.Popen(command, cwd=tmp_path, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    time.sleep(0.5)
    process.send_signal(signal.SIGTERM)
    process.wait()
    subprocess.run(command, cwd=tmp_path, check=True, capture_output=True)
    assert content(tmp_path / "o")
