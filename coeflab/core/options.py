"""Options of plugins: a frozen dataclass of bounded numbers and words, filled from a plan or a command line."""

from __future__ import annotations

import dataclasses
import difflib
import inspect
import math
import re
import textwrap
from collections.abc import Iterable, Mapping
from typing import Any, TypeVar, cast

from coeflab.core.errors import InputError, shown
from coeflab.core.units import SI, quantity

Options = TypeVar("Options")


def bounded(default: float, low: float, high: float) -> Any:
    """A dataclass field with bounds; an int default takes whole numbers only.

    Parameters
    ----------
    default, low, high : float
        The bounds are allowed values.
    """
    return dataclasses.field(default=default, metadata={"low": low, "high": high})


def measured(default: float, low: float, high: float, dimension: str) -> Any:
    """A dataclass field that takes an SI number, or a text with its unit (``"0.05 m^2"``); bounds in SI.

    Parameters
    ----------
    default, low, high : float
        SI; the bounds are allowed values.
    dimension : str
        Key of `coeflab.core.units.SI`.
    """
    return dataclasses.field(default=default, metadata={"low": low, "high": high, "dimension": dimension})


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
            hint = (f"Did you mean {near[0]}? " if near else "") + _explained(place.partition(".")[0])
            known = ", ".join(c or '""' for c in meta["choices"])
            raise InputError(shown(value), f"one of {known}", column=place, advice=hint)
        return value
    items = value.replace(",", " ").split() if isinstance(value, str) else value
    if not isinstance(items, (list, tuple)) or not all(isinstance(i, str) for i in items):
        raise InputError(shown(value), "a list of words", column=place)
    return tuple(items)


def _measured(value: Any, meta: Mapping[str, Any], place: str) -> float:
    """A number in SI within bounds."""
    number = quantity(value, meta["dimension"], key=place)
    if not meta["low"] <= number <= meta["high"]:
        unit = SI[meta["dimension"]]
        raise InputError(shown(value), f"{meta['low']:g} to {meta['high']:g} {unit}".rstrip(), column=place)
    return number


def _explained(plugin: str) -> str:
    return f"`coeflab formats {plugin}` explains every option."


@dataclasses.dataclass(frozen=True, slots=True)
class Described:
    """An option as a reader sees it: name, what it takes, default and meaning."""

    name: str
    takes: str
    default: str
    meaning: str


@dataclasses.dataclass(frozen=True, slots=True)
class NoOptions:
    """What a plugin without options takes."""


def described(kind: type) -> tuple[Described, ...]:
    """Every option of an options dataclass, its meaning from the Attributes of the docstring."""
    meanings = _meanings(inspect.getdoc(kind) or "")
    return tuple(
        Described(f.name, _takes(f), _default(f), meanings.get(f.name, "")) for f in dataclasses.fields(cast(Any, kind))
    )


def _takes(field: dataclasses.Field[Any]) -> str:
    meta = field.metadata
    if "choices" in meta:
        return ", ".join(dict.fromkeys(c or '""' for c in meta["choices"]))
    if "words" in meta:
        return "words"
    if "dimension" in meta:
        return f"{meta['dimension']}, bare in {SI[meta['dimension']]} or with its unit"
    whole = isinstance(field.default, int) and not isinstance(field.default, bool)
    return f"{'whole ' if whole else ''}number, {meta['low']:.10g} to {meta['high']:.10g}"


def _default(field: dataclasses.Field[Any]) -> str:
    value = field.default
    if isinstance(value, tuple):
        return " ".join(value) or "none"
    unit = SI[field.metadata["dimension"]] if "dimension" in field.metadata else ""
    text = value if isinstance(value, str) else f"{value:.10g} {unit}".rstrip()
    return text or '""'


def _meanings(text: str) -> dict[str, str]:
    """Meaning of every attribute of a numpydoc docstring; names that share an entry share its text."""
    body = text.partition("Attributes\n----------\n")[2]
    out: dict[str, str] = {}
    for head, said in re.findall(r"^(\S[^\n]*)\n?((?:[ ]+[^\n]*\n?|\n)*)", body, re.MULTILINE):
        names = head.partition(" : ")[0]
        flat = " ".join(textwrap.dedent(said).split()).replace("``", "")
        out |= dict.fromkeys((n.strip() for n in names.split(",")), flat)
    return out


def parse_options(kind: type[Options], given: Mapping[str, Any], where: str) -> Options:
    """Fill an options dataclass.

    Parameters
    ----------
    kind : type
        The dataclass.
    given : mapping of str to value
    where : str
        Stands before the option's name in an error.

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
                f"one of {', '.join(fields)}" if fields else "none: it has no options",
                column=where,
                advice=(f"Did you mean {near[0]}? " if near else "") + _explained(where),
            )
        meta = fields[name].metadata
        if "choices" in meta or "words" in meta:
            filled[name] = _text(value, meta, f"{where}.{name}")
            continue
        if "dimension" in meta:
            filled[name] = _measured(value, meta, f"{where}.{name}")
            continue
        default = fields[name].default
        whole = isinstance(default, int) and not isinstance(default, bool)
        right = isinstance(value, int) if whole else isinstance(value, (int, float))
        if isinstance(value, bool) or not right or not meta["low"] <= value <= meta["high"]:
            expected = f"a {'whole ' if whole else ''}number from {meta['low']:g} to {meta['high']:g}"
            raise InputError(shown(value), expected, column=f"{where}.{name}", advice=_explained(where))
        filled[name] = value
    return kind(**filled)


def named_numbers(texts: Iterable[str], column: str) -> dict[str, float]:
    """``left=60`` and the like as numbers by name.

    Raises
    ------
    InputError
        No name, no finite number, or a name twice.
    """
    out: dict[str, float] = {}
    for text in texts:
        name, _, value = text.partition("=")
        try:
            number = float(value)
        except ValueError:
            number = math.nan
        if not name or not math.isfinite(number):
            raise InputError(shown(text), "NAME=NUMBER, such as left=60", column=column)
        if name in out:
            raise InputError(f"{shown(name)} twice", "every name once", column=column)
        out[name] = number
    return out
