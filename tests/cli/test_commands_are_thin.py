"""Commands parse, call the front door, print and end: what they import says so."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

import coeflab

HOUSE = Path(str(coeflab.__file__)).parent
COMMANDS = {p.stem: p for p in (*HOUSE.glob("cli/*.py"), *HOUSE.glob("*/commands/*.py")) if p.stem != "__init__"}
MAY = (
    "coeflab",
    "coeflab.api",
    "coeflab.cli",
    "coeflab.core",
    "coeflab.report",
    "coeflab.formats.loss_tables",
)  # the last: what is printed
# Commands that reach below the front door; this list may only become shorter.
NOT_YET = frozenset(
    {
        "added_mass", "as_json", "complete", "draft", "draw", "fit", "import_",
        "inspect", "merge", "params", "run", "schema", "show", "simplify", "simulate", "table",
        "uncertainty", "validate", "vehicle",
    }
)  # fmt: skip


def below(file: Path) -> set[str]:
    """Modules of coeflab that a command imports, hidden in functions too, which are neither front door nor print."""
    found: set[str] = set()
    for node in ast.walk(ast.parse(file.read_text("utf-8"))):
        names = [a.name for a in node.names] if isinstance(node, ast.Import) else []
        names += [node.module] if isinstance(node, ast.ImportFrom) and node.module else []
        found |= {n for n in names if n.split(".")[0] == "coeflab"}
    home = file.parent.parent.name  # the folder of an application is its commands' own
    may = (
        MAY if home == "coeflab" else (*MAY, f"coeflab.{home}", "coeflab.motion.simulators")
    )  # whose plugins it explains
    return {n for n in found if n not in may and not n.startswith(tuple(f"{m}." for m in may[1:]))}


@pytest.mark.parametrize("command", sorted(COMMANDS))
def test_a_command_calls_the_front_door(command: str) -> None:
    reached = below(COMMANDS[command])
    assert bool(reached) is (command in NOT_YET), reached
