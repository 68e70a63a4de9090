"""Nothing is imported by a name in a string but where the house says so: import-linter cannot see such an arrow."""

from __future__ import annotations

import ast
import importlib.util
from pathlib import Path

from tests.sources import PACKAGE, nodes, texts

ALLOWED = ("__init__.py", "core/registry.py", "cli/__init__.py")
DYNAMIC = {"import_module", "__import__", "resolve_name", "run_module"}


def by_a_string(file: Path) -> set[int]:
    """Lines that import by a string."""
    within = nodes()[file]
    found = {n.lineno for n in within if isinstance(n, ast.Name) and n.id in DYNAMIC}
    found |= {n.lineno for n in within if isinstance(n, ast.Attribute) and n.attr in DYNAMIC}
    modules = {"importlib", "runpy"}
    for n in within:
        if isinstance(n, ast.ImportFrom) and n.module in modules and {a.name for a in n.names} & DYNAMIC:
            found.add(n.lineno)
    return found


def test_imports_by_a_string_stand_in_registry_command_line_and_front_door_alone() -> None:
    hidden = {}
    for file in texts():
        name = file.relative_to(PACKAGE).as_posix()
        if lines := set() if name in ALLOWED else by_a_string(file):
            hidden[name] = sorted(lines)
    assert hidden == {}


def test_no_modules_form_a_circle() -> None:
    spec = importlib.util.spec_from_file_location("house", PACKAGE.parent / "benchmarks" / "house.py")
    house = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(house)
    known = house.modules()
    graph = {name: house.imports(name, path.read_text("utf-8"), known)[0] for name, path in known.items()}
    assert house.circles(graph) == []
