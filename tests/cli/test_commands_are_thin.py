"""Commands parse, call the front door, print and end: what they import says so."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

import coeflab

CLI = Path(str(coeflab.__file__)).parent / "cli"
MAY = ("coeflab", "coeflab.api", "coeflab.cli", "coeflab.core", "coeflab.report")  # report: what is printed
# The folder of an application is its command's own.
OWN = {
    "derive": ("coeflab.motion.multibody",),
    "glide": ("coeflab.motion.glider", "coeflab.workbench.glide"),
    "identify": ("coeflab.motion.identify",),
    "tune": ("coeflab.motion.tune", "coeflab.workbench.tune"),
    "tow": ("coeflab.tank", "coeflab.workbench.tow"),
}
# Commands that reach below the front door; this list may only become shorter.
NOT_YET = frozenset(
    {
        "added_mass", "as_json", "complete", "draft", "draw", "fit", "formats", "import_",
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
    may = (*MAY, *OWN.get(file.stem, ()))
    return {n for n in found if n not in may and not n.startswith(tuple(f"{m}." for m in may[1:]))}


@pytest.mark.parametrize("command", sorted(p.stem for p in CLI.glob("*.py")))
def test_a_command_calls_the_front_door(command: str) -> None:
    reached = below(CLI / f"{command}.py")
    assert bool(reached) is (command in NOT_YET), reached
