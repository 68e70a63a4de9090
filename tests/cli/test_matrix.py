"""Every option of every command with a blank, a missing and an impossible value, and a list of hostile lines: exit code 2, nothing written."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
import typer

from coeflab import cli
from coeflab.core.files import shipped

CASES = [
    line.split(" | ") for line in Path(__file__).with_name("matrix.txt").read_text().splitlines() if line[0] != "#"
]
Main = Callable[[list[str]], tuple[int, str]]


@pytest.fixture
def main(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Main:
    """The command line in this process, in an empty folder: exit code and message."""
    (tmp_path / "here").mkdir()
    monkeypatch.chdir(tmp_path / "here")

    def run(words: list[str]) -> tuple[int, str]:
        monkeypatch.setattr(sys, "argv", ["coeflab", *words])
        with pytest.raises(SystemExit) as ended:
            cli.main()
        return int(ended.value.code or 0), capsys.readouterr().err

    return run


def options() -> Iterator[tuple[list[str], Any]]:
    """Every option of every command that takes a value."""

    def within(command: Any, words: list[str]) -> Iterator[tuple[list[str], Any]]:
        below = getattr(command, "commands", None)
        for name, one in (below or {}).items():
            yield from within(one, [*words, name])
        for one in [] if below else command.params:
            if one.opts[0].startswith("--") and not one.is_flag:
                yield words, one

    root: Any = typer.main.get_command(cli.app)
    for name in cli.ORDER:
        yield from within(root.get_command(None, name), [name])


def test_every_option_with_a_value_that_is_none(main: Main) -> None:
    tried = 0
    for words, option in options():
        name = option.opts[0]
        kind = option.type_descriptor.annotation
        number = kind in (int, float)
        for line in (
            [*words, f"{name}="], [*words, name, ""], [*words, name, " "], [*words, name],
            *([*words, f"{name}={text}"] for text in ("x", "1e999", "nan", "-inf") if number),
        ):  # fmt: skip
            code, said = main(line)
            tried += 1
            assert code == 2, line
            assert "Traceback" not in said
            assert name in said.replace("\n", " ") or "Missing argument" in said or not number, (line, said)
    assert tried > 500
    assert list(Path().iterdir()) == []


@pytest.mark.parametrize("case", CASES, ids=lambda c: c[2])
def test_hostile_lines(main: Main, tmp_path: Path, case: list[str]) -> None:
    code, expected, line = case
    os.mkfifo(tmp_path / "FIFO")
    (tmp_path / "LOOP").symlink_to(tmp_path / "LOOP")
    (tmp_path / "EMPTY").write_bytes(b"")
    (tmp_path / "BINARY").write_bytes(bytes(range(256)) * 40)
    (tmp_path / "FOLDER").mkdir()
    (tmp_path / "FULL").mkdir()
    (tmp_path / "FULL" / "mine.txt").write_text("mine")
    text = (shipped("cfd_data") / "huuv" / "huuv.parameters.json").read_text()
    (tmp_path / "NUL").write_text(text.replace('"name": "', '"name": "a\\u0000', 1))
    words = [
        str(tmp_path / word) if (tmp_path / word).is_symlink() or (tmp_path / word).exists() else word
        for word in line.split()
    ]
    found, said = main(words)
    assert found == int(code), said
    assert expected in " ".join(said.split())
    assert "Traceback" not in said
    assert list(Path().iterdir()) == []
