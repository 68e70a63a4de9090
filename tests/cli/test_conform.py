"""``coeflab params conform``."""

from __future__ import annotations

import json
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


def test_files_states_and_answers_are_written(tmp_path: Path) -> None:
    command = shlex.join([sys.executable, "-c", "print(1)"])
    done = CliRunner().invoke(app, ["params", "conform", command, "--write", str(tmp_path / "out")])
    assert done.exit_code == 1
    names = {p.name.split(".", 1)[1] for p in (tmp_path / "out").iterdir()}
    assert names == {"parameters.json", "states.json", "answers.json"}
    states, answers = (json.loads((tmp_path / "out" / f"torpedo.{n}.json").read_bytes()) for n in ("states", "answers"))
    assert len(states) == len(answers)
    assert set(answers[0]) == {"force", "acceleration"}


@pytest.mark.parametrize("command", ["", "'open"])
def test_no_command_is_refused(command: str) -> None:
    assert CliRunner().invoke(app, ["params", "conform", command]).exit_code != 0
