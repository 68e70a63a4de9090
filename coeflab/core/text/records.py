"""Records: JSON files of our own that somebody may have edited, cut or swapped, read by what each place of theirs has to hold."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from enum import EnumType
from pathlib import Path
from typing import Any, NamedTuple

from coeflab.core.errors import InputError, shown
from coeflab.core.limits import LARGEST_STORED, RECORD_BYTES
from coeflab.core.text.json import Place, lines_of, parse_json
from coeflab.core.text.toml import read_text

# What a place holds: str, bool, int or float (finite); an enumeration; [shape], a list; {str: shape}, any names, or {function: shape}; a record
# {"key": shape, "may be missing?": shape}; `OrNone`; a function that says what is expected in place of a wrong text, else "".
Shape = Any
_WORDS = {str: "a text", bool: "true or false", int: "a whole number", float: "a finite number"}


class OrNone(NamedTuple):
    """A shape, or null."""

    shape: Shape


def read_record(
    path: Path, shape: Mapping[Any, Shape], expected: str, *, kind: str = "", advice: str = "", largest: int = RECORD_BYTES
) -> dict[str, Any]:  # fmt: skip
    """The content of a record, every place of which holds what it should; other keys are left as they stand.

    Parameters
    ----------
    path : Path
    shape : mapping
        Of the record.
    expected : str
        What the file should be, for the error.
    kind : str
        What its key ``kind`` has to be; empty where it has none.
    advice : str
        What to do about a file that is not.
    largest : int
        Bytes.

    Raises
    ------
    InputError
        By line and key.
    """
    try:
        text = read_text(path, largest)
        content = parse_json(text, path, expected)
    except InputError as why:
        raise InputError(
            why.found, why.expected, file=path, line=why.line, column=why.column, advice=why.advice or advice
        ) from None
    if kind and isinstance(content, dict) and content.get("kind") != kind:
        raise InputError(_found(content.get("kind")), kind, file=path, key="kind", advice=advice)
    for place, found, wanted in _wrong(content, shape, ()):
        key = ".".join(map(str, place)) or None
        line = lines_of(text, [place])[place]
        raise InputError(found, wanted if place else expected, file=path, line=line, key=key, advice=advice)
    return dict(content)


def plain_name(text: str) -> str:
    """What is expected in place of a name that leads out of a folder, or that no file bears; empty where it does neither."""
    parts = text.split("/")
    bad = not text or text.startswith("/") or any(p in ("", ".", "..") for p in parts) or not text.isprintable()
    return "a name below this folder" if bad or len(text) > 400 else ""


def _wrong(value: Any, shape: Shape, place: Place) -> Iterator[tuple[Place, str, str]]:
    """What does not hold: place, found, expected."""
    if isinstance(shape, OrNone):
        if value is not None:
            yield from _wrong(value, shape.shape, place)
    elif isinstance(shape, list):
        if not isinstance(value, list):
            yield place, _found(value), "a list"
        else:
            for i, item in enumerate(value):
                yield from _wrong(item, shape[0], (*place, i))
    elif isinstance(shape, tuple):
        if not isinstance(value, list) or len(value) != len(shape):
            yield place, _found(value), f"{len(shape)} values"
        else:
            for i, (item, one) in enumerate(zip(value, shape, strict=True)):
                yield from _wrong(item, one, (*place, i))
    elif isinstance(shape, dict):
        if not isinstance(value, dict):
            yield place, _found(value), "keys and values"
        elif not isinstance(named := next(iter(shape), ""), str):
            for key, item in value.items():
                if named is not str and (wanted := named(key)):
                    yield (*place, key), shown(key), wanted
                yield from _wrong(item, shape[named], (*place, key))
        else:
            for key, one in shape.items():
                name = key.removesuffix("?")
                if name in value:
                    yield from _wrong(value[name], one, (*place, name))
                elif name == key:
                    yield (*place, name), "nothing", _words(one)
    elif isinstance(shape, EnumType):
        known = [str(member.value) for member in shape]  # type: ignore[var-annotated]
        if value not in known:
            yield place, _found(value), f"one of {', '.join(known)}"
    elif shape in _WORDS:
        if not _is(value, shape):
            yield place, _found(value), _WORDS[shape]
    elif wanted := (shape(value) if isinstance(value, str) else "a text"):
        yield place, _found(value), wanted


def _is(value: Any, kind: type) -> bool:
    if kind is float:
        return isinstance(value, (int, float)) and not isinstance(value, bool) and abs(value) <= LARGEST_STORED
    if kind is int:
        return isinstance(value, int) and not isinstance(value, bool) and abs(value) <= LARGEST_STORED
    return isinstance(value, kind)


def _words(shape: Shape) -> str:
    if isinstance(shape, OrNone):
        return f"{_words(shape.shape)} or null"
    return (
        "a list"
        if isinstance(shape, (list, tuple))
        else "keys and values"
        if isinstance(shape, dict)
        else _WORDS.get(shape, "a text")
    )


def _found(value: Any) -> str:
    if isinstance(value, float) and not math.isfinite(value):
        return str(value)
    return {dict: "keys and values", list: "a list", type(None): "null"}.get(type(value)) or shown(value)
