"""Processes that are killed: their workers end too, and what they left is removed by the next run, never a living one's."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from multiprocessing import get_all_start_methods
from pathlib import Path
from threading import Thread

import psutil
import pytest

from coeflab.core import files
from coeflab.core.errors import OutputError
from coeflab.core.files import write_all

pytestmark = pytest.mark.skipif("fork" not in get_all_start_methods(), reason="this system has no fork")
SIGNALS = [signal.SIGTERM, signal.SIGKILL]
Started = Callable[..., subprocess.Popen[str]]

DRAWING = """
import os, time
from functools import partial
from coeflab.report import workers as in_parallel
in_parallel.cores = lambda: 2
def job(i):
    os.write(1, b"%d\\n" % os.getpid())  # in one piece: the other job writes to the same pipe
    time.sleep(60)
with in_parallel.begun([partial(job, 0), partial(job, 1)]) as drawn:
    drawn()
"""
WRITING = """
import sys
from pathlib import Path
from coeflab.core import files
from coeflab.core.errors import OutputError
from coeflab.core.files import write_all
move = Path.replace
def slowly(self, target):
    print("staged", flush=True)
    sys.stdin.readline()
    return move(self, target)
Path.replace = slowly
write_all(Path(sys.argv[1]), {"report.html": b"theirs" * 100_000, "below/b.txt": b"theirs"})
"""


@pytest.fixture
def started() -> Iterator[Started]:
    """Start Python on a text; ended with the test."""
    processes = []

    def start(text: str, *arguments: object) -> subprocess.Popen[str]:
        process = subprocess.Popen(
            [sys.executable, "-c", text, *map(str, arguments)],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        )  # fmt: skip
        processes.append(process)
        return process

    yield start
    for process in processes:
        process.kill()
        process.communicate()


def hidden(folder: Path) -> list[str]:
    return sorted(p.name for p in folder.rglob(".*"))


def gone(pids: list[int], patience: float = 5.0) -> bool:
    """Whether the processes end within some seconds."""
    until = time.monotonic() + patience
    while time.monotonic() < until:
        if not any(psutil.pid_exists(p) and psutil.Process(p).status() != psutil.STATUS_ZOMBIE for p in pids):
            return True
        time.sleep(0.02)
    return False


@pytest.mark.parametrize("how", SIGNALS)
def test_drawing_processes_end_with_the_one_that_started_them(started: Started, how: signal.Signals) -> None:
    parent = started(DRAWING)
    assert parent.stdout
    children = [int(parent.stdout.readline()) for _ in range(2)]
    assert parent.pid not in children
    parent.send_signal(how)
    parent.wait()
    try:
        assert gone(children)
    finally:
        for child in children:
            if psutil.pid_exists(child):
                os.kill(child, signal.SIGKILL)


@pytest.mark.parametrize("how", SIGNALS)
def test_what_a_killed_writer_left_is_removed_by_the_next(
    started: Started, tmp_path: Path, how: signal.Signals
) -> None:
    writer = started(WRITING, tmp_path)
    assert writer.stdout
    assert writer.stdout.readline() == "staged\n"
    writer.send_signal(how)
    writer.wait()
    assert len(hidden(tmp_path)) == 2, "the kill came while the files were staged"
    (tmp_path / ".report.html.somebody").write_text("not ours")
    write_all(tmp_path, {"report.html": b"ours", "below/b.txt": b"ours"})
    assert hidden(tmp_path) == [".report.html.somebody"]
    assert (tmp_path / "report.html").read_bytes() == b"ours"


def test_an_unchanged_run_sweeps_too(started: Started, tmp_path: Path) -> None:
    write_all(tmp_path, {"report.html": b"ours"})
    writer = started(WRITING, tmp_path)
    assert writer.stdout
    writer.stdout.readline()
    writer.kill()
    writer.wait()
    assert write_all(tmp_path, {"report.html": b"ours"}) == {"report.html": False}
    assert [p for p in tmp_path.iterdir() if p.name.startswith(".")] == []


def test_a_living_writers_files_stay(started: Started, tmp_path: Path) -> None:
    writer = started(WRITING, tmp_path)
    assert writer.stdout
    writer.stdout.readline()
    theirs = hidden(tmp_path)
    assert len(theirs) == 2
    ours = Thread(target=write_all, args=(tmp_path, {"report.html": b"ours", "below/b.txt": b"ours"}))
    ours.start()
    ours.join(0.3)
    assert ours.is_alive(), "the second writer waits"
    assert hidden(tmp_path) == theirs
    _, err = writer.communicate("\n\n")
    assert writer.returncode == 0, err
    ours.join(10.0)
    assert (tmp_path / "report.html").read_bytes() == b"ours"
    assert (tmp_path / "below/b.txt").read_bytes() == b"ours"
    assert hidden(tmp_path) == []


def test_who_is_waited_for_is_named(started: Started, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    writer = started(WRITING, tmp_path)
    assert writer.stdout
    writer.stdout.readline()
    monkeypatch.setattr(files, "PATIENCE", 0.3)
    with pytest.raises(OutputError, match=f"process {writer.pid} writes into"):
        write_all(tmp_path, {"report.html": b"ours"})
    monkeypatch.setattr(files, "LOCKS", tmp_path / "none")
    with pytest.raises(OutputError, match="another process writes into"):
        write_all(tmp_path, {"report.html": b"ours"})


def test_links_and_pipes_with_such_a_name_are_left(tmp_path: Path) -> None:
    (tmp_path / "kept").write_text("kept")
    (tmp_path / ".a.abcdefgh.coeflab").symlink_to(tmp_path / "kept")
    os.mkfifo(tmp_path / ".b.abcdefgh.coeflab")
    write_all(tmp_path, {"report.html": b"ours"})
    assert (tmp_path / "kept").read_text() == "kept"
    assert hidden(tmp_path) == [".a.abcdefgh.coeflab", ".b.abcdefgh.coeflab"]


@pytest.mark.slow
def test_the_command_killed_at_several_moments(write_campaign: Callable[..., Path], tmp_path: Path) -> None:
    plan = write_campaign() / "plan.toml"
    plan.write_text('[study]\nname = "killed"\n[[table]]\ncampaign = "."\nfits = ["slope_at_origin"]\n')
    out = tmp_path / "out"
    command = [sys.executable, "-c", "from coeflab.cli import main; main()", "run", plan, "--out", out]
    begun = time.monotonic()
    subprocess.run(command, check=True, capture_output=True)
    whole = time.monotonic() - begun
    wanted = {p.name: p.read_bytes() for p in out.iterdir()}
    for part, how in zip((0.8, 0.95), SIGNALS, strict=True):
        for path in out.iterdir():
            path.unlink()
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        time.sleep(part * whole)
        below = [c.pid for c in psutil.Process(process.pid).children(recursive=True)] if process.poll() is None else []
        process.send_signal(how)
        process.wait()
        assert gone(below)
    subprocess.run(command, check=True, capture_output=True)
    assert {p.name: p.read_bytes() for p in out.iterdir()} == wanted
