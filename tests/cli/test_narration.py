"""What is said of long work on standard error."""

from __future__ import annotations

import io
import logging
import time

import pytest

from coeflab.cli import show
from coeflab.core.machine import stage


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def told(monkeypatch: pytest.MonkeyPatch, stream: io.StringIO, slow: float) -> str:
    monkeypatch.setattr("sys.stderr", stream)
    monkeypatch.setattr(show, "SLOW", slow)
    with show.narrated():
        stage("reading 10 faces")
        time.sleep(0.3)
        logging.getLogger("coeflab.bodies.mesh.file").info("hull.stl: 10 faces")
    return stream.getvalue()


def test_stages_show_on_a_terminal_once_work_lasts(monkeypatch: pytest.MonkeyPatch) -> None:
    assert "reading 10 faces" in told(monkeypatch, Terminal(), 0.05)
    assert "reading 10 faces" not in told(monkeypatch, Terminal(), 60.0)


def test_a_pipe_gets_what_readers_say_and_no_stages(monkeypatch: pytest.MonkeyPatch) -> None:
    assert told(monkeypatch, io.StringIO(), 0.05) == "hull.stl: 10 faces\n"


def test_logging_is_left_as_it_was(monkeypatch: pytest.MonkeyPatch) -> None:
    logger = logging.getLogger("coeflab")
    before = logger.level, list(logger.handlers)
    told(monkeypatch, Terminal(), 0.0)
    assert (logger.level, list(logger.handlers)) == before
