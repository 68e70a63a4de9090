"""The command line as a real process."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

COEFLAB = Path(sys.executable).with_name("coeflab")
Run = Callable[..., subprocess.CompletedProcess[str]]


@pytest.fixture
def coeflab(tmp_path: Path) -> Run:
    """Run ``coeflab`` in an empty folder."""

    def run(*arguments: str | Path, cwd: Path = tmp_path) -> subprocess.CompletedProcess[str]:
        command = [str(COEFLAB), *map(str, arguments)]
        return subprocess.run(command, cwd=cwd, capture_output=True, text=True, check=False, timeout=120)

    return run
