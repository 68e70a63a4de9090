"""A plain importer for tests: comma tables with ``name (unit)`` in the header, # comments, and what ``#! key = value`` states."""

from __future__ import annotations

import csv as text
import sys
import tomllib
from collections.abc import Mapping
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

from coeflab.tables.importers import IMPORTERS
from coeflab.tables.raw_table import RawColumn, RawTable, Stated

NAME = "plain_stub"


def recognises(path: Path) -> bool:
    """Whether the name ends in .raw."""
    return path.suffix == ".raw"


def raw(path: Path, options: Mapping[str, Any]) -> RawTable:
    """The table as the file has it."""
    stated, kept = {}, []
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        if line.startswith("#!"):
            key, _, said = line[2:].partition("=")
            stated[key.strip()] = Stated(tomllib.loads(f"x ={said}")["x"], f"{path.name}:{number}")
        elif line and not line.startswith("#"):
            kept.append((number, line))
    header, *rows = list(text.reader(line for _, line in kept))
    columns = []
    for i, head in enumerate(header):
        name, _, unit = head.partition("(")
        cells = [row[i].strip() for row in rows]
        values = [number_in(cell) for cell in cells]
        is_text = any(np.isnan(v) and c and c.lower() != "nan" for v, c in zip(values, cells, strict=True))
        columns.append(RawColumn(name.strip(), unit.strip(" )"), np.array(values), tuple(cells) if is_text else ()))
    return RawTable(
        path, tuple(columns), kept[0][0], np.array([n for n, _ in kept[1:]]), files=(path,),
        dialect={"delimiter": "comma"} | {str(k): str(v) for k, v in options.items()}, stated=stated,
    )  # fmt: skip


def number_in(cell: str) -> float:
    """The number, or NaN."""
    try:
        return float(cell)
    except ValueError:
        return float("nan")


@pytest.fixture(scope="module", autouse=True)
def plain_stub() -> Any:
    """The importer among the others, for a module of tests."""
    module = ModuleType(f"coeflab.tables.importers.{NAME}", "A stub of tests.")
    module.__dict__.update(
        summary="A stub of tests", citations=(), reads="tables of tests", raw=raw, recognises=recognises
    )
    patch = pytest.MonkeyPatch()
    patch.setitem(sys.modules, module.__name__, module)
    patch.setitem(IMPORTERS.__dict__, "_shipped", {**IMPORTERS._shipped, NAME: "coeflab.tables.importers"})
    yield module
    patch.undo()
