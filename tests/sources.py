"""The package as it is written: each module read and parsed once in a process, for all tests that look at the source."""

from __future__ import annotations

import ast
from functools import cache
from pathlib import Path

PACKAGE = Path(__file__).parents[1] / "coeflab"


@cache
def texts() -> dict[Path, str]:
    """Of every module."""
    return {file: file.read_text(encoding="utf-8") for file in sorted(PACKAGE.rglob("*.py"))}


@cache
def trees() -> dict[Path, ast.Module]:
    """Of every module; nobody changes them. The grammar is that of the oldest Python that coeflab runs on."""
    return {file: ast.parse(text, str(file), feature_version=(3, 11)) for file, text in texts().items()}


@cache
def nodes() -> dict[Path, tuple[ast.AST, ...]]:
    """Every node of every module."""
    return {file: tuple(ast.walk(tree)) for file, tree in trees().items()}
