"""Commands that are killed at some moment and given again: they succeed, with the same bytes and no debris."""

from __future__ import annotations

import os
import random
import signal
import subprocess
import time
from pathlib import Path

import pytest

from tests.cli.conftest import COEFLAB

TABLE = "beta [deg],Y [N],N [N*m]\n-6,33,11\n-3,16,6\n0,0,0\n3,-16,-6\n6,-33,-11\n"
SET = (
    "axes.frame=FRD",
    "axes.reference_point=-2 from nose",
    "scaling.length=4 LOA",
    "conditions.density=1000",
    "conditions.speed=2",
)
COMMANDS = {
    "import": ["import", "t.csv", "--out", "o", "--accept", *(w for one in SET for w in ("--set", one))],
    "tow": ["tow", "tow_spheroid", "--dry-run", "--solver", "external", "--out", "o"],
    "export": ["export", "huuv", "--to", "csv", "--out", "o"],
}
TIMES = int(os.environ.get("COEFLAB_KILLS", "3"))  # 40 to be thorough


def content(folder: Path) -> dict[str, bytes]:
    return {str(p.relative_to(folder)): p.read_bytes() for p in folder.rglob("*") if p.is_file() and p.name != ".lock"}


@pytest.mark.slow
@pytest.mark.parametrize("name", COMMANDS)
def test_killed_and_given_again(tmp_path: Path, name: str) -> None:
    command = [str(COEFLAB), *COMMANDS[name]]
    whole = tmp_path / "whole"
    whole.mkdir()
    (whole / "t.csv").write_text(TABLE)
    begin = time.monotonic()
    subprocess.run(command, cwd=whole, check=True, capture_output=True)
    seconds = time.monotonic() - begin
    wanted = content(whole / "o")
    chance = random.Random(34)
    for k in range(TIMES):
        folder = tmp_path / str(k)
        folder.mkdir()
        (folder / "t.csv").write_text(TABLE)
        process = subprocess.Popen(command, cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        time.sleep(seconds * chance.uniform(0.3, 1.0))
        process.send_signal(chance.choice((signal.SIGKILL, signal.SIGTERM)))
        process.wait()
        again = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
        assert again.returncode == 0, again.stderr
        assert content(folder / "o") == wanted
