"""The command line as a real process."""

from __future__ import annotations

import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.cli.forked import COEFLAB
from tests.conftest import once

__all__ = ["COEFLAB", "Run", "Validated", "files", "flat"]
Run = Callable[..., subprocess.CompletedProcess[str]]


def flat(printed: str) -> str:
    """What is printed, wherever its lines are folded."""
    return " ".join(printed.split())


def files(folder: Path) -> dict[str, tuple[bytes, int]]:
    """Content and time of change of every file."""
    found = [p for p in sorted(folder.rglob("*")) if p.is_file()]
    return {str(p.relative_to(folder)): (p.read_bytes(), p.stat().st_mtime_ns) for p in found}


Done = subprocess.CompletedProcess[str]
Validated = tuple[Path, Done, dict[str, tuple[bytes, int]], Done]


@pytest.fixture(scope="session")
def validated(tmp_path_factory: pytest.TempPathFactory) -> Validated:
    """`validate suboff` by fresh interpreters, once for all workers: its folder, the first run, the files and their times after that,
    and a second run, as JSON."""

    def made() -> Validated:
        folder = tmp_path_factory.mktemp("validated")

        def run(*more: str) -> Done:
            command = [str(COEFLAB), "validate", "suboff", *more]
            return subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False, timeout=120)

        first = run()
        return folder, first, files(folder), run("--json")

    found: Validated = once(tmp_path_factory, "validated", made)
    return found
