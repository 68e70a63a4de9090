"""start.py: what it says after a command that ended well, gates of which the first that fails ends all, and the order of tests."""

from __future__ import annotations

import importlib.util
import subprocess
from pathlib import Path
from types import ModuleType, SimpleNamespace

import pytest

from tests.conftest import dealt, longest

FILE = Path(__file__).parents[1] / "start.py"
GATE = """#!/bin/sh
echo "$@" >> {ran}
case "$*" in
  *ruff*) exit {ruff} ;;
  *mypy*) until grep -q pytest {ran}; do sleep 0.1; done; echo found by mypy; exit {mypy} ;;
  *pytest*) trap 'exit 2' INT; for i in $(seq {waits}); do sleep 0.1; done; exit {tests} ;;
esac
"""


@pytest.fixture
def start() -> ModuleType:
    spec = importlib.util.spec_from_file_location("start", FILE)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize(("code", "said"), [(0, True), (1, False), (2, False)])
def test_a_command_that_ended_well_is_followed_by_what_comes_next(
    start: ModuleType, code: int, said: bool, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(start, "set_up", lambda groups: None)
    monkeypatch.setattr(subprocess, "run", lambda *a, **k: SimpleNamespace(returncode=code))
    monkeypatch.setattr("sys.argv", ["start.py", "validate", "suboff"])
    assert start.main() == code
    out, err = capsys.readouterr()
    assert out == ""
    assert ("Set up in .venv" in err) is said
    assert ("activate, then coeflab" in err) is said


@pytest.mark.parametrize(
    ("codes", "arguments", "expected", "last"),
    [
        ({}, [], 0, "pytest -n 4 --dist worksteal --durations=20"),
        ({}, ["--fast"], 0, "pytest -n 4 --dist worksteal --durations=20 -m not slow"),
        ({"tests": 5}, ["tests/law"], 5, "pytest tests/law"),
        ({"mypy": 3, "waits": 600}, [], 3, "pytest -n 4 --dist worksteal --durations=20"),
        ({"ruff": 1}, [], 1, "ruff check"),
    ],
)
def test_the_first_gate_that_fails_ends_all(
    start: ModuleType, codes: dict[str, int], arguments: list[str], expected: int, last: str,
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    ran = tmp_path / "ran"
    for name in ("python", "lint-imports"):
        gate = tmp_path / name
        gate.write_text(GATE.format(**({"ruff": 0, "mypy": 0, "tests": 0, "waits": 1} | codes), ran=ran))
        gate.chmod(0o755)
    monkeypatch.setattr(start, "PYTHON", tmp_path / "python")
    monkeypatch.setattr(start, "BIN", tmp_path)
    assert start.test(arguments) == expected
    assert ("found by mypy" in capsys.readouterr().out) is ("mypy" in codes)
    lines = ran.read_text().splitlines()
    assert sum(last in line for line in lines) == 1
    assert ("-m mypy" in lines) is ("ruff" not in codes)


def test_every_worker_begins_with_some_of_the_longest() -> None:
    """As `worksteal` of xdist hands tests out: to each worker the next of equal shares."""
    names = [f"a.py::{k}" for k in range(6)] + ["b.py::slow[1]", "b.py::slow[2]", "c.py::x", "d.py::y"]
    order = dealt(
        names,
        [(50.0, ("c.py",)), (60.0, ("d.py",)), (90.0, ("b.py::slow[2]", "b.py::slow[1]")), (99.0, ("gone.py",))],
        2,
    )
    assert [names[k] for k in order] == [
        "b.py::slow[2]", "b.py::slow[1]", "a.py::0", "a.py::1", "a.py::2",
        "d.py::y", "c.py::x", "a.py::3", "a.py::4", "a.py::5",
    ]  # fmt: skip
    assert sorted(dealt(names, [(1.0, ("a.py",))], 4)) == list(range(10))


def test_the_longest_are_there_and_once() -> None:
    begins = [begin for _, group in longest() for begin in group]
    for begin in begins:
        file, _, name = begin.partition("::")
        assert f"def {name}" in (FILE.parent / file).read_text(encoding="utf-8"), begin
        assert [b for b in begins if begin.startswith(b)] == [begin]
