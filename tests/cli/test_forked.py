"""What `forked` starts is what the console script does, to the byte; hash seeds differ between the two."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from tests.cli.conftest import Run
from tests.cli.forked import Forks

ROOT = Path(__file__).parents[2]
SAMPLE = ROOT / "tests" / "data" / "parameters_1_3.json"
HUUV = ROOT / "cfd_data" / "huuv" / "huuv.parameters.json"


def written(folder: Path) -> dict[str, bytes]:
    return {str(p.relative_to(folder)): p.read_bytes() for p in sorted(folder.rglob("*")) if p.is_file()}


@pytest.mark.parametrize(
    "words",
    [
        ("--version",),
        ("new", "mine"),
        ("fit", "suboff_roddy_3", "--symbol", "Yv", "--json"),
        ("params", "check", SAMPLE),
        ("export", SAMPLE, "--to", "mss", "--accept-loss", "--out", "out"),
        ("simulate", HUUV, "--commands", "left=40 right=100", "--out", "out"),
        ("trim", HUUV, "--commands", "left=60", "--commands", "right=0", "--json"),
        ("uncertainty", SAMPLE, "--manoeuvre", "zigzag", "--help-options"),
        ("glide", "no_such_glider"),
        ("tow", "no_such_tow", "--status"),
        ("nonsense",),
    ],
    ids=lambda words: words[0],
)
def test_a_command_forked_and_from_a_fresh_interpreter(
    coeflab: Run, fresh: Run, tmp_path: Path, words: tuple[str, ...]
) -> None:
    folders = [tmp_path / "fresh", tmp_path / "forked"]
    for folder in folders:
        folder.mkdir()
    done = [run(*words, cwd=folder) for run, folder in zip((fresh, coeflab), folders, strict=True)]
    assert done[0].stdout + done[0].stderr
    assert vars(done[0]) == vars(done[1])
    assert written(folders[0]) == written(folders[1])


def test_the_environment_is_that_of_the_test(coeflab: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "99")
    assert max(map(len, coeflab("--help").stdout.splitlines())) > 60
    monkeypatch.setenv("COLUMNS", "60")
    assert max(map(len, coeflab("--help").stdout.splitlines())) <= 60


def test_what_an_interpreter_reads_at_its_start_gets_a_fresh_one(coeflab: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    assert "import time" not in coeflab("--version").stderr
    monkeypatch.setenv("PYTHONPROFILEIMPORTTIME", "1")
    assert "import time" in coeflab("--version").stderr


def test_a_process_that_never_ends_is_ended(monkeypatch: pytest.MonkeyPatch, forks: Forks, tmp_path: Path) -> None:
    with monkeypatch.context() as hurried:
        hurried.setattr("tests.cli.forked.PATIENCE", 0.2)
        with pytest.raises(subprocess.TimeoutExpired):
            forks.run(("serve", tmp_path, "--port", "0"), tmp_path)
    assert forks.run(("--version",), tmp_path).returncode == 0


def test_what_one_test_sets_for_an_interpreter_does_not_slow_the_next(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """The interpreter that waits is one of the session, not of the test that asks first."""
    own = Forks()
    with monkeypatch.context() as once:
        once.setenv("PYTHONSAFEPATH", "1")
        assert own.run(("--version",), tmp_path).returncode == 0
        assert own._server is None
    assert own.run(("--version",), tmp_path).returncode == 0
    assert own._server is not None
    own.close()
