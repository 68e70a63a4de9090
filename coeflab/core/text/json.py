"""Reading JSON that others wrote: every key once, no NaN, bounded depth and count, before any of it is looked at."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from coeflab.core.errors import InputError, shown
from coeflab.core.limits import INTEGER_DIGITS, JSON_DEEPEST, JSON_KEYS, JSON_OBJECTS, JSON_VALUES

NUL = re.compile(r"(?<!\\)(?:\\\\)*+\\(?:u0000|U00000000)")  # as JSON and TOML write it
_STRING = re.compile(r'"(?:[^"\\]|\\.)*+"?', re.DOTALL)
_ENDS = re.compile(r"[\[\]{}]")
_TOKEN = re.compile(r'"(?:[^"\\]|\\.)*+"|[\[\]{},:]|[^\s\[\]{},:"]+', re.DOTALL)
Place = tuple[str | int, ...]


def parse_json(text: str, file: Path | str | None = None, expected: str = "JSON") -> Any:
    """The value that a document holds.

    Parameters
    ----------
    text : str
    file : path, optional
    expected : str
        What the document should be, for the error.

    Raises
    ------
    InputError
        No JSON (with line and column), NaN or Infinity, a key that stands twice, an integer of more than 4,300 digits, or more
        levels, objects, keys or values than `coeflab.core.limits` allows.
    """
    _within_bounds(text, file, expected)
    if nul := NUL.search(text):
        raise InputError("a NUL in a text", "letters", file=file, line=text.count("\n", 0, nul.start()) + 1)

    def refuse(token: str) -> float:
        raise ValueError(f"{token} is no JSON number")

    def whole(digits: str) -> int:
        if len(digits) > INTEGER_DIGITS:
            raise InputError(f"an integer of {len(digits):,} digits", f"at most {INTEGER_DIGITS:,}", file=file)
        return int(digits)

    def once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        found = dict(pairs)
        if len(pairs) > JSON_KEYS:
            raise InputError(f"{len(pairs)} keys in one object", f"at most {JSON_KEYS:,}", file=file)
        if len(found) < len(pairs):
            keys = [k for k, _ in pairs]
            raise ValueError(f"{shown(max(keys, key=keys.count))} twice in one object")
        return found

    try:
        return json.loads(text, parse_constant=refuse, parse_int=whole, object_pairs_hook=once)
    except json.JSONDecodeError as why:
        raise InputError(
            f"no JSON ({why.msg})", "JSON", file=file, line=why.lineno, column=f"character {why.colno}"
        ) from None
    except RecursionError:
        raise InputError("too deep nesting", expected, file=file) from None
    except ValueError as why:
        raise InputError(str(why).partition(";")[0], expected, file=file) from None


def _within_bounds(text: str, file: Path | str | None, expected: str) -> None:
    """Refuse by counting alone what would cost time and memory to parse; marks inside of texts count too."""
    counts = (
        (text.count("{"), JSON_OBJECTS, "objects"),
        (text.count(",") + text.count("[") + text.count("{"), JSON_VALUES, "values"),
    )
    for count, most, what in counts:
        if count > most:
            raise InputError(f"{count:,} {what}", f"at most {most:,}", file=file)
    if text.count("[") + text.count("{") <= JSON_DEEPEST:
        return
    depth = 0
    for mark in _ENDS.finditer(_STRING.sub('""', text)):
        depth += 1 if mark[0] in "[{" else -1
        if depth > JSON_DEEPEST:
            raise InputError("too deep nesting", f"{expected}, at most {JSON_DEEPEST} levels deep", file=file)


def lines_of(text: str, places: Iterable[Place]) -> dict[Place, int]:
    """The line, from 1, on which the value at each place of a document begins; of a key that is missing, what it is missing in.

    Parameters
    ----------
    text : str
        JSON that `parse_json` takes.
    places : iterable of tuple
        Keys and numbers of items from the outermost to the value.
    """
    asked = tuple(places)
    sought = {place[:n] for place in asked for n in range(len(place) + 1)}
    found: dict[Place, int] = {}
    path: list[str | int] = []
    inside: list[str] = []
    is_key, line, at = False, 1, 0
    for token in _TOKEN.finditer(text):
        line += text.count("\n", at, token.start())
        at = token.start()
        mark = token[0]
        if mark in ("]", "}"):
            path.pop()
            inside.pop()
        elif mark == ",":
            is_key = inside[-1] == "{"
            if not is_key:
                path[-1] = int(path[-1]) + 1
        elif is_key and mark != ":":
            path[-1], is_key = json.loads(mark), False
        elif mark != ":":
            here = tuple(path)
            if here in sought:
                found.setdefault(here, line)
            if mark in ("[", "{"):
                inside.append(mark)
                path.append(0 if mark == "[" else "")
                is_key = mark == "{"
    return {
        place: next((found[place[:n]] for n in range(len(place), -1, -1) if place[:n] in found), 1) for place in asked
    }
