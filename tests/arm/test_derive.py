"""``coeflab derive`` as a real process."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from coeflab.core.files import shipped
from tests.cli.conftest import COEFLAB, Run, flat

PUMA = shipped("geometry") / "urv_puma" / "body.toml"
C_FILES = ["urv_puma.c", "urv_puma.h"]


@pytest.fixture
def one_link(tmp_path: Path) -> Path:
    """The shipped arm with its first link alone."""
    head, first, *_ = PUMA.read_text(encoding="utf-8").split("[[link]]\n")
    basis = PUMA.read_text(encoding="utf-8").partition("\n[basis]\n")[2]
    file = tmp_path / "body.toml"
    file.write_text(f"{head}[[link]]\n{first}[basis]\n{basis}", encoding="utf-8")
    return file


def content(folder: Path) -> dict[str, bytes]:
    return {p.name: p.read_bytes() for p in sorted(folder.iterdir())}


@pytest.mark.slow
def test_files_are_written_and_the_same_again(
    coeflab: Run, one_link: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The second run in an interpreter of its own, which hashes in another way."""
    done = coeflab("derive", "body.toml", "--to", "c")
    assert (done.returncode, done.stderr) == (0, "")
    assert "urv_puma: 1 link, 7 generalised speeds" in done.stdout
    assert flat(done.stdout).count(": written") == 2
    assert max(map(len, done.stdout.splitlines())) <= 80
    assert sorted(content(tmp_path / "urv_puma.c")) == C_FILES
    text = content(tmp_path / "urv_puma.c")["urv_puma.c"].decode()
    assert "from body.toml, sha256" in text
    assert str(tmp_path) not in text
    monkeypatch.setenv("PYTHONHASHSEED", "7")
    again = coeflab("derive", "body.toml", "--to", "c")
    assert flat(again.stdout).count(": unchanged") == 2


def test_a_parameter_file_is_no_vehicle_with_an_arm(coeflab: Run, tmp_path: Path) -> None:
    (tmp_path / "one.parameters.json").write_text("{}")
    done = coeflab("derive", "one.parameters.json", "--to", "latex")
    assert done.returncode == 2
    said = flat(done.stderr)
    assert "expected a vehicle with an arm: the name of a shipped one, or its body.toml" in said
    assert "valid TOML" not in said


@pytest.mark.slow
def test_every_language_and_json(coeflab: Run, one_link: Path, tmp_path: Path) -> None:
    for language, ending, symbols in (
        ("python", ".py", "--symbols"),
        ("latex", ".tex", "--numbers"),
        ("octave", ".m", "--symbols"),
    ):
        done = coeflab("derive", tmp_path, "--to", language, "--out", "made", symbols, "--json")
        found = json.loads(done.stdout)
        assert found["functions"]["equations"]["operations"] > found["functions"]["bias"]["operations"] > 0
        assert {Path(file).suffix for file in found["files"]} == {ending}
        assert all((tmp_path / file).is_file() for file in found["files"])


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("urv_puma", "--to", "fortran"), '"--to": found "fortran"; expected c, python, latex, octave'),
        (("remus100", "--to", "c"), 'expected "arm", a vehicle with an arm'),
        (("no_such_arm", "--to", "c"), "no file or folder"),
    ],
)
def test_one_error_and_exit_code_2(coeflab: Run, tmp_path: Path, arguments: tuple[str, ...], words: str) -> None:
    done = coeflab("derive", *arguments, "--out", "out")
    assert done.returncode == 2
    assert words in flat(done.stderr)
    assert done.stderr.count("error:") == 1
    assert not (tmp_path / "out").exists()


@pytest.mark.slow
def test_without_sympy_it_says_what_to_install(coeflab: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    without = tmp_path / "without"
    without.mkdir()
    (without / "sympy.py").write_text("raise ModuleNotFoundError(\"No module named 'sympy'\", name='sympy')\n")
    monkeypatch.setenv("PYTHONPATH", str(without))
    done = coeflab("derive", PUMA, "--to", "c", "--out", "out")
    assert done.returncode == 2
    assert 'expected sympy. Install "coeflab[derive]"' in flat(done.stderr)
    assert not (tmp_path / "out").exists()


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="no pseudo-terminal there")
def test_a_terminal_shows_progress_and_a_killed_run_leaves_nothing(tmp_path: Path) -> None:
    near, far = os.openpty()
    command = [str(COEFLAB), "derive", str(PUMA), "--to", "c", "--out", "out"]
    process = subprocess.Popen(command, cwd=tmp_path, stdout=subprocess.DEVNULL, stderr=far)
    os.close(far)
    heard = b""
    while not any(step in heard for step in (b"mass matrix", b"bias", b"equations")):  # a quick step is never shown
        heard += os.read(near, 4096)
    process.send_signal(signal.SIGKILL)
    process.wait()
    os.close(near)
    assert list(tmp_path.iterdir()) == []
