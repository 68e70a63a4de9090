"""One writer of CSV: no text becomes a formula of a spreadsheet, and what is written is read back as it was."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from coeflab.core.text.csv_rows import csv_text, escaped, plain
from coeflab.core.text.delimited import read_cells
from tests.sources import PACKAGE, texts

HOSTILE = (
    "=cmd|' /C calc'!A0",
    "+1+1",
    "-beta",
    "@SUM(A1)",
    "'=x",
    "''-y",
    "'quoted'",
    "- 3 deg",
    "=",
    "-",
    "plain",
    "-1.5e3",
    "+.5",
)


@pytest.mark.parametrize("text", HOSTILE)
def test_a_text_comes_back_as_it_was(text: str) -> None:
    assert plain(str(escaped(text))) == text


def test_what_a_spreadsheet_would_calculate_begins_with_an_apostrophe(tmp_path: Path) -> None:
    file = tmp_path / "t.csv"
    file.write_text(
        csv_text([["point", "=head", "Y [N]"], *([t, t, "-1.25"] for t in HOSTILE)], ["made"]), encoding="utf-8"
    )
    for line in file.read_text(encoding="utf-8").splitlines()[1:]:
        assert not re.match(r'"?[=@][^,]|"?[+-](?!\.?\d)[^,]', line)
    cells = read_cells(file)
    assert cells.texts("point") == cells.texts("=head") == list(HOSTILE)
    assert cells.numbers("Y [N]".partition(" ")[0]).tolist() == [-1.25] * len(HOSTILE)


def test_no_other_file_of_the_package_writes_csv() -> None:
    """One writer: whoever makes a CSV of its own would forget the apostrophe."""
    writer = re.compile(r"csv\.(?:writer|DictWriter)")
    own = [f.relative_to(PACKAGE).as_posix() for f, text in texts().items() if writer.search(text)]
    assert own == ["core/text/csv_rows.py"]
