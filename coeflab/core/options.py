"""Options of plugins: a frozen dataclass of bounded numbers, filled from a plan or a command line."""

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


def parse_options(kind: type[Options], given: Mapping[str, Any], where: str) -> Options:
    """Fill an options dataclass.

    Raises
    ------
    InputError
        Unknown option, wrong type or out of bounds.
    """
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
        default = fields[name].default
        whole = isinstance(default, int) and not isinstance(default, bool)
        right = isinstance(value, int) if whole else isinstance(value, (int, float))
        meta = fields[name].metadata
        if isinstance(value, bool) or not right or not meta["low"] <= value <= meta["high"]:
            expected = f"a {'whole ' if whole else ''}number from {meta['low']:g} to {meta['high']:g}"
            raise InputError(shown(value), expected, column=f"{where}.{name}")
    return kind(**given)
