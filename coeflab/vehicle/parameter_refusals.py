"""What is wrong with a parameter file, in words: every complaint with its line, what stands there and what should."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from functools import cache
from pathlib import Path
from typing import Any

from pydantic import TypeAdapter, ValidationError

from coeflab.core.errors import MOST_LISTED, InputError, shown, together
from coeflab.core.stored import RefusedError
from coeflab.core.text.json import Place, lines_of, parse_json
from coeflab.core.texts import text_of
from coeflab.law.coefficient import Coefficient
from coeflab.law.symbols import derivative

_LISTS = "coefficients"


def complaints(why: ValidationError, text: str, file: Path, schema: bytes, advice: str = "") -> InputError:
    """All that pydantic refuses in a file as one error.

    Parameters
    ----------
    why : ValidationError
    text : str
        The file, JSON.
    file : Path
    schema : bytes
        JSON Schema of the file, which says what a missing key means.
    advice : str
        What to do about each.
    """
    content = parse_json(text, file)
    found = list(_refusals(_sorted(_all_coefficients(why, content)), content, schema))
    lines = lines_of(text, [place for place, _ in found])
    return together([
        InputError(
            r.found, r.expected, file=file, line=lines[place], key=_named(place, content) or "file", advice=r.advice or advice
        )
        for place, r in found
    ])  # fmt: skip


def first_complaint(why: ValidationError, place: str) -> InputError:
    """The first of pydantic's errors, below a key of another file."""
    first = why.errors()[0]
    found, expected, advice, where = _in_words(first)
    return InputError(found, expected, column=".".join(map(str, (place, *first["loc"], *where))), advice=advice)


def _in_words(error: Any) -> tuple[str, str, str, tuple[str | int, ...]]:
    """What pydantic found and expected, advice, and where below the place that it names."""
    kind, message = error["type"], error["msg"]
    if kind == "missing":
        return "nothing", text_of("parameter_file.missing"), "", ()
    if kind == "extra_forbidden":
        return "an unknown key", text_of("parameter_file.unknown_key"), "", ()
    if kind == "value_error":
        if isinstance(own := error["ctx"]["error"], RefusedError):
            return own.found, own.expected, own.advice, own.where
        return message.removeprefix("Value error, "), text_of("parameter_file.agrees"), "", ()
    expected = message.removeprefix("Input should be ").removeprefix("String should ").removeprefix("have ")
    return shown(error["input"]), expected, "", ()


def _all_coefficients(why: ValidationError, content: Any) -> list[Any]:
    """The errors, with those of the coefficients behind the first that is wrong, at which pydantic stops."""
    every: list[Any] = list(why.errors())
    stopped = max((e["loc"][1] for e in every if e["loc"][:1] == (_LISTS,) and len(e["loc"]) > 1), default=None)
    if stopped is None:
        return every
    one = _adapter()
    for k, each in enumerate(content[_LISTS][stopped + 1 :], stopped + 1):
        if len(every) > MOST_LISTED:
            break
        try:
            one.validate_json(json.dumps(each))
        except ValidationError as more:
            every += [{**e, "loc": (_LISTS, k, *e["loc"])} for e in more.errors()]
    return every


@cache
def _adapter() -> TypeAdapter[Coefficient]:
    return TypeAdapter(Coefficient)


def _sorted(every: Sequence[Any]) -> list[Any]:
    """An unknown key before a key that is missing beside it, which may be the same misspelt."""
    unknown = {e["loc"][:-1] for e in every if e["type"] == "extra_forbidden"}
    missing_keys = [e for e in every if e["type"] == "missing" and e["loc"][:-1] in unknown]
    return [e for e in every if e not in missing_keys] + missing_keys


def _refusals(every: Sequence[Any], content: Any, schema: bytes) -> Iterator[tuple[Place, RefusedError]]:
    """Each error with its place."""
    for error in every:
        found, expected, advice, where = _in_words(error)
        if error["type"] == "missing":
            expected, advice = _missing(error["loc"], content, schema)
        yield (*error["loc"], *where), RefusedError(found, expected, advice)
        if error["type"] == "value_error" and isinstance(own := error["ctx"]["error"], RefusedError):
            for other in own.others:
                yield (*error["loc"], *other.where), other


def _missing(where: Place, content: Any, schema: bytes) -> tuple[str, str]:
    """What a missing key should hold, and advice: of a coefficient its own unit, of others what the schema says."""
    match where:
        case ("coefficients", int(k), "unit_si" | "value_si" as key):
            each = content[_LISTS][k]
            try:
                unit = derivative(str(each.get("symbol"))).unit
            except InputError:
                return text_of("parameter_file.missing"), ""
            if key == "unit_si":
                return text_of("parameter_file.missing_unit", unit=unit), ""
            return text_of("parameter_file.missing_si", unit=unit), ""
    words = _meaning(where, parse_json(schema.decode()))
    return (text_of("parameter_file.missing") + f": {words}" * bool(words)), ""


def _meaning(where: Place, schema: Any) -> str:
    """What the schema says of a key; empty where it says nothing."""
    at = schema
    for key in where:
        for choice in (at, *at.get("anyOf", ())):
            if "$ref" in choice:
                at = schema["$defs"][choice["$ref"].rpartition("/")[2]]
        at = at.get("items", {}) if isinstance(key, int) else at.get("properties", {}).get(key, {})
    return str(at.get("description", ""))


def _named(where: Place, content: Any) -> str:
    """Keys to a value; of a coefficient its symbol stands for its number."""
    match where:
        case ("coefficients", int(k), *rest):
            each = content[_LISTS][k]
            named = each.get("symbol") if isinstance(each, dict) else None
            return ".".join(map(str, ("coefficients", named if isinstance(named, str) else k, *rest)))
    return ".".join(map(str, where))
