"""The lowest versions that are installed in CI are those that the package declares."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

ROOT = Path(__file__).parents[1]


def release(version: str) -> tuple[int, ...]:
    """Numbers of a version without zeros at the end."""
    return tuple(int(n) for n in re.sub(r"(\.0)+$", "", version).split("."))


def test_constraints_are_the_declared_floors() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    declared = [*project["dependencies"], *(d for extra in project["optional-dependencies"].values() for d in extra)]
    floors = dict(d.split(">=") for d in declared)
    lines = (ROOT / "constraints-lowest.txt").read_text().splitlines()
    pinned = dict(line.split("==") for line in lines if line and not line.startswith("#"))
    assert {n: release(v) for n, v in pinned.items()} == {n: release(v) for n, v in floors.items()}


def test_no_address_of_a_repository_that_does_not_exist() -> None:
    assert "urls" not in tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    found = [p for p in (ROOT / "coeflab").rglob("*.py") if "github.com/coeflab" in p.read_text()]
    found += [p for p in (ROOT / "README.md", *(ROOT / "docs").rglob("*.md")) if "github.com/coeflab" in p.read_text()]
    assert not found
