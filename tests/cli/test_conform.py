"""``coeflab params conform``."""

from __future__ import annotations

import shlex
import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner

from coeflab.cli import app

READER = Path(__file__).parents[2] / "docs" / "reference" / "reader.py"


def test_the_reader_passes_and_a_wrong_one_fails(tmp_path: Path) -> None:
    good = CliRunner().invoke(app, ["params", "conform", shlex.join([sys.executable, str(READER)])])
    assert good.exit_code == 0, good.output
    text = READER.read_text(encoding="utf-8")
    (tmp_path / "wrong.py").write_text(
        text.replace("0.5 * self.rho * self.length", "0.525 * self.rho * self.length"), encoding="utf-8"
    )
    wrong = CliRunner().invoke(app, ["params", "conform", shlex.join([sys.executable, str(tmp_path / "wrong.py")])])
    assert wrong.exit_code == 1
    assert "torpedo" in wrong.output


@pytest.mark.parametrize("command", ["", "'open"])
def test_no_command_is_refused(command: str) -> None:
    assert CliRunner().invoke(app, ["params", "conform", command]).exit_code != 0
