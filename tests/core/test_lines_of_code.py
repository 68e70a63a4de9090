"""The ratchet: lines of code and texts outside of templates of a subject only fall, unless the table says why they rose."""

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
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_no_subject_has_more_lines_of_code_or_texts_than_its_table(house: ModuleType) -> None:
    """A subject that grew is named with both numbers; so is one that the table does not know."""
    table = tomllib.loads(house.LINES.read_text(encoding="utf-8"))
    assert house.grown(house.by_subject(), table) == {}, "house.py --lines --because REASON"


def test_a_number_falls_by_itself_and_rises_with_a_reason_only(house: ModuleType) -> None:
    """What the table says after a subject fell, and after one rose."""
    table = {"law": {"lines": 10, "texts": 4, "reason": "older"}, "core": {"lines": 5, "texts": 1}}
    low, high = {"lines": 9, "texts": 4}, {"lines": 6, "texts": 1}
    assert "lines = 9" in house.written({"core": {"lines": 5, "texts": 1}, "law": low}, table, "")
    for more in (high, {"lines": 5, "texts": 2}):
        with pytest.raises(SystemExit):
            house.written({"core": more, "law": low}, table, "")
    rows = tomllib.loads(house.written({"core": high, "law": low}, table, "new field"))
    assert rows == {"core": {**high, "reason": "new field"}, "law": {**low, "reason": "older"}}


@pytest.mark.parametrize(
    ("source", "count"),
    [
        ('x = "no slope here is determined"', 1),
        ('x = "no slope is determined"', 0),
        ('x = f"no {slope} of {table} here is determined"', 1),
        ('x = f"no {slope} of {word}"', 0),
        ('"""A docstring of more than five words."""', 0),
        ('def f():\n    """A docstring of more than five words."""\n    return "and a text of five words"', 1),
        ('x = ("two literals of few words", "words each, both of five words")', 2),
    ],
)
def test_a_text_is_a_literal_of_five_words(house: ModuleType, source: str, count: int) -> None:
    assert house.texts(source) == count
