"""Applications: what each folder with an ``application.py`` brings; the core runs with any of them deleted."""

from __future__ import annotations

import ast
from functools import cache
from pathlib import Path
from typing import Any

from coeflab.core.text.bounded import own_text


@cache
def applications() -> tuple[str, ...]:
    """Names of the applications: folders of coeflab with a module ``application``; without any of them the core still runs."""
    return tuple(sorted(p.parent.name for p in Path(__file__).parents[1].glob("*/application.py")))


@cache
def _declarations(name: str) -> dict[str, Any]:
    """What ``application.py`` assigns, read and not run."""
    tree = ast.parse(own_text(Path(__file__).parents[1] / name / "application.py"))
    return {
        n.targets[0].id: ast.literal_eval(n.value)
        for n in tree.body
        if isinstance(n, ast.Assign) and isinstance(n.targets[0], ast.Name)
    }


def declared(member: str) -> dict[str, Any]:
    """What every application that has it declares under a name, by application; nothing is imported.

    Examples
    --------
    >>> declared("COMMANDS")["glider"]
    {'glide': 'Motion'}
    """
    found = {name: _declarations(name) for name in applications()}
    return {name: members[member] for name, members in found.items() if member in members}
