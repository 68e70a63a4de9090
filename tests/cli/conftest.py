"""The command line as a real process."""

from __future__ import annotations

import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.cli.forked import COEFLAB, Forks

__all__ = ["COEFLAB", "Run", "flat"]
Run = Callable[..., subprocess.CompletedProcess[str]]


def flat(printed: str) -> str:
    """What is printed, wherever its lines are folded."""
    return " ".join(printed.split())


@pytest.fixture
def fresh(tmp_path: Path) -> Run:
    """Run ``coeflab`` as a user does: an interpreter of its own, which imports what the command imports and no more."""

    def run(*arguments: str | Path, cwd: Path = tmp_path) -> subprocess.CompletedProcess[str]:
        command = [str(COEFLAB), *map(str, arguments)]
        return subprocess.run(command, cwd=cwd, capture_output=True, text=True, check=False, timeout=120)

    return run


@pytest.fixture
def coeflab(tmp_path: Path, forks: Forks) -> Run:
    """Run ``coeflab`` in an empty folder."""

    def run(*arguments: str | Path, cwd: Path = tmp_path) -> subprocess.CompletedProcess[str]:
        return forks.run(arguments, cwd)

    return run
