"""start.py: what it says after a command that ended well, where no output of coeflab itself changes."""

from __future__ import annotations

import importlib.util
import subprocess
from pathlib import Path
from types import SimpleNamespace

import pytest

FILE = Path(__file__).parents[1] / "start.py"


@pytest.mark.parametrize(("code", "said"), [(0, True), (1, False), (2, False)])
def test_a_command_that_ended_well_is_followed_by_what_comes_next(
    code: int, said: bool, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    spec = importlib.util.spec_from_file_location("start", FILE)
    assert spec is not None
    assert spec.loader is not None
    start = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(start)
    monkeypatch.setattr(start, "set_up", lambda groups: None)
    monkeypatch.setattr(subprocess, "run", lambda *a, **k: SimpleNamespace(returncode=code))
    monkeypatch.setattr("sys.argv", ["start.py", "validate", "suboff"])
    assert start.main() == code
    out, err = capsys.readouterr()
    assert out == ""
    assert ("Set up in .venv" in err) is said
    assert ("activate, then coeflab" in err) is said
