"""What every command prints on the shipped examples fits an 80-column terminal, and is the same in a pipe."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from coeflab.cli import ORDER
from coeflab.study.study import Study
from tests.cli.forked import Forks
from tests.cli.survey import FILE, QUICK, SLOW, arguments_of, colours, seen, too_long

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="no pseudo-terminal there")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("width")


@pytest.fixture(scope="module")
def with_file(folder: Path, suboff: Study) -> Path:
    """A folder with a parameter file of SUBOFF, as ``validate suboff`` writes it."""
    place = folder / FILE
    place.parent.mkdir(parents=True, exist_ok=True)
    place.write_bytes(suboff.parameter_files["suboff_fully_appended"].to_json())
    return folder


@pytest.mark.parametrize("line", QUICK)
def test_no_line_is_longer_than_the_terminal(forks: Forks, folder: Path, line: str) -> None:
    code, text = seen(forks, arguments_of(line), folder)
    assert code in (0, 1, 2)
    assert "Traceback" not in text
    assert too_long(text) == []


@pytest.mark.slow
def test_no_line_of_a_longer_command_is_longer_than_the_terminal(forks: Forks, with_file: Path) -> None:
    """All in one folder, for some take what others wrote."""
    for line in SLOW:
        code, text = seen(forks, arguments_of(line), with_file)
        assert code in (0, 1, 2), line
        assert "Traceback" not in text, line
        assert too_long(text) == [], line


def test_no_line_of_a_help_text_is_longer_than_the_terminal(forks: Forks, folder: Path) -> None:
    """Nor cut, nor in the words of those who build the house."""
    for name in ORDER:
        text = seen(forks, [name, "--help"], folder)[1]
        assert too_long(text) == [], name
        assert not {"room", "floor", "house"} & set(text.lower().replace(".", " ").split()), name
    listed = seen(forks, ["--help"], folder)[1]
    assert "..." not in listed.partition("Commands:")[2]


@pytest.mark.parametrize("columns", [60, 100])
def test_a_narrow_and_a_wide_terminal(
    forks: Forks, folder: Path, columns: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("COLUMNS", raising=False)
    text = seen(forks, arguments_of("compare HUUV HUUV"), folder, columns)[1]
    assert too_long(text, columns) == []
    assert max(map(len, text.split("\n"))) > columns - 25


def test_a_pipe_gets_the_letters_of_a_terminal(forks: Forks, folder: Path) -> None:
    """Colours apart; with --wide every column."""
    asked = arguments_of("params check SAMPLE")
    assert seen(forks, asked, folder)[1] == forks.run(asked, folder).stdout
    assert "\x1b[" in colours(forks, asked, folder)
    wide = forks.run([*asked, "--wide"], folder).stdout
    assert max(map(len, wide.splitlines())) > 80
    assert "Not shown" not in wide
