"""Options of plugins: a frozen dataclass of bounded numbers and words, filled from a plan or a command line."""

from __future__ import annotations

import dataclasses
import difflib
from collections.abc import Mapping
from typing import Any, TypeVar, cast

from coeflab.core.errors import InputError, shown

Options = TypeVar("Options")


def bounded(default: float, low: float, high: float) -> Any:
    """A dataclass field with bounds; an int default takes whole numbers only."""
    return dataclasses.field(default=default, metadata={"low": low, "high": high})


def one_of(default: str, *choices: str) -> Any:
    """A dataclass field that takes one of some words."""
    return dataclasses.field(default=default, metadata={"choices": choices})


def words(*default: str) -> Any:
    """A dataclass field that takes a list of words; a text is split at commas and blanks."""
    return dataclasses.field(default=default, metadata={"words": True})


def _text(value: Any, meta: Mapping[str, Any], place: str) -> Any:
    """A word out of some, or a tuple of words."""
    if "choices" in meta:
        if value not in meta["choices"]:
            near = difflib.get_close_matches(str(value), meta["choices"], n=1)
            hint = f"Did you mean {near[0]}?" if near else ""
            raise InputError(shown(value), f"one of {', '.join(meta['choices'])}", column=place, advice=hint)
        return value
    items = value.replace(",", " ").split() if isinstance(value, str) else value
    if not isinstance(items, (list, tuple)) or not all(isinstance(i, str) for i in items):
        raise InputError(shown(value), "a list of words", column=place)
    return tuple(items)


def parse_options(kind: type[Options], given: Mapping[str, Any], where: str) -> Options:
    """Fill an options dataclass.

    Raises
    ------
    InputError
        Unknown option, wrong type or out of bounds.
    """
    filled: dict[str, Any] = {}
    fields = {f.name: f for f in dataclasses.fields(cast(Any, kind))}
    for name, value in given.items():
        if name not in fields:
            near = difflib.get_close_matches(name, fields, n=1)
            raise InputError(
                f"the unknown option {shown(name)}",
                f"one of {', '.join(fields)}",
                column=where,
                advice=f"Did you mean {near[0]}?" if near else "",
            )
        meta = fields[name].metadata
        if "choices" in meta or "words" in meta:
            filled[name] = _text(value, meta, f"{where}.{name}")
            continue
        default = fields[name].default
        whole = isinstance(default, int) and not isinstance(default, bool)
        right = isinstance(value, int) if whole else isinstance(value, (int, float))
        if isinstance(value, bool) or not right or not meta["low"] <= value <= meta["high"]:
            expected = f"a {'whole ' if whole else ''}number from {meta['low']:g} to {meta['high']:g}"
            raise InputError(shown(value), expected, column=f"{where}.{name}")
        filled[name] = value
    return kind(**filled)
