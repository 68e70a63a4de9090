"""An option stands on a page of the site or in a test: what is on neither is nobody's."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import typer

import coeflab
from coeflab.cli import app

ROOT = Path(str(coeflab.__file__)).parents[1]
GENERATED = "commands.md"


def options(command: Any, names: tuple[str, ...] = ()) -> list[tuple[str, str]]:
    """Command and long option, of all commands."""
    found = [
        (" ".join(names), max(p.opts, key=len))
        for p in command.params
        if p.param_type_name == "option" and not p.hidden
    ]
    if hasattr(command, "list_commands"):
        context = typer.Context(command)
        for name in command.list_commands(context):
            found += options(command.get_command(context, name), (*names, name))
    return found


def test_every_option_is_on_a_page_or_in_a_test() -> None:
    texts = [p.read_text("utf-8") for p in (ROOT / "docs").glob("*.md") if p.name != GENERATED]
    texts += [p.read_text("utf-8") for p in (ROOT / "tests").rglob("*.py") if p != Path(__file__)]
    used = set(re.findall(r"--[a-z][a-z0-9-]*", " ".join(texts)))
    known = options(typer.main.get_command(app))
    assert len(known) > 100
    assert [f"{command} {option}" for command, option in known if command and option not in used | {"--help"}] == []
