"""The ratchet: lines of code of a subject only fall, unless the table says why they rose."""

from __future__ import annotations

import importlib.util
import tomllib
from pathlib import Path
from types import ModuleType

import pytest

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def house() -> ModuleType:
    """benchmarks/house.py as a module."""
    spec = importlib.util.spec_from_file_location("house", ROOT / "benchmarks" / "house.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_no_subject_has_more_lines_of_code_than_its_table(house: ModuleType) -> None:
    """A subject that grew is named with both numbers; so is one that the table does not know."""
    table = tomllib.loads(house.LINES.read_text(encoding="utf-8"))
    allowed = {name: row["lines"] for name, row in table.items()}
    grown = {name: (n, allowed.get(name, 0)) for name, n in house.by_subject().items() if n > allowed.get(name, 0)}
    assert grown == {}, "house.py --lines --because REASON"


def test_a_number_falls_by_itself_and_rises_with_a_reason_only(house: ModuleType) -> None:
    """What the table says after a subject fell, and after one rose."""
    table = {"law": {"lines": 10, "reason": "older"}, "core": {"lines": 5}}
    assert "lines = 9" in house.written({"core": 5, "law": 9}, table, "")
    with pytest.raises(SystemExit):
        house.written({"core": 6, "law": 9}, table, "")
    rows = tomllib.loads(house.written({"core": 6, "law": 9}, table, "new field"))
    assert rows == {"core": {"lines": 6, "reason": "new field"}, "law": {"lines": 9, "reason": "older"}}
