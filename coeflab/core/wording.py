"""Pieces of sentences and records: names in a row, numbers that may be none, and the words of users.

Names that people gave, as programs and one-line comments can carry them.

Names that a file, a function or a class must not bear, because it would hide what bears them already.
"""

from __future__ import annotations

import builtins
import hashlib
import keyword
import re
import sys
from collections import Counter
from collections.abc import Callable, Hashable, Iterable, Sequence
from collections.abc import Set as AbstractSet
from functools import cache
from math import isfinite
from pathlib import Path
from typing import TypeVar

from coeflab.core.text.bounded import own_text

Item = TypeVar("Item", bound=Hashable)
Key = TypeVar("Key", bound=Hashable)
Value = TypeVar("Value")


class Verbatim(str):
    """A text that a user wrote, such as a title or a name: it is shown as it stands and never searched for symbols.

    Readers of files make it; nouns carry it. A text put together from it is a plain one again, in which the renderers
    find what they were handed of these.
    """

    __slots__ = ()


def listed(names: Sequence[str]) -> str:
    """One or more names as a sentence lists them: ``a``, ``a and b``, ``a, b and c``."""
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"


COUNTS = ("no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten")
THREE_LINES = 240  # letters of a paragraph in a report


def spelled_out(count: int) -> str:
    """A small number as a word: ``three``; a larger one in digits."""
    return COUNTS[count] if count < len(COUNTS) else str(count)


def in_sentences(
    start: str, parts: Sequence[str], end: str = ".", join: Callable[[Sequence[str]], str] = "; ".join
) -> str:
    """A listing as sentences: one where it fits three lines, else several with the same beginning.

    Parameters
    ----------
    start : str
        What every sentence begins with: ``No value: ``.
    parts : sequence of str
        One that is too long alone stays whole.
    end : str
    join : callable
        Of the parts of one sentence: with semicolons, or `listed`.
    """
    room = THREE_LINES - len(start) - len(end)
    return " ".join(f"{start}{join(group)}{end}" for group in grouped(parts, room, join))


def grouped(parts: Sequence[str], room: int, join: Callable[[Sequence[str]], str] = "; ".join) -> list[list[str]]:
    """Parts of a listing in groups that are at most so long when they are joined; a longer part is alone.

    Parameters
    ----------
    parts : sequence of str
    room : int
        Letters of a group.
    join : callable, optional
        How the parts of a group are joined.
    """
    groups: list[list[str]] = []
    for part in parts:
        if groups and len(join((*groups[-1], part))) <= room:
            groups[-1].append(part)
        else:
            groups.append([part])
    return groups


def collected(pairs: Iterable[tuple[Key, Value]]) -> dict[Key, list[Value]]:
    """The values of each key, keys and values in the order in which they come."""
    out: dict[Key, list[Value]] = {}
    for key, value in pairs:
        out.setdefault(key, []).append(value)
    return out


def counted(n: int, one: str, several: str = "") -> str:
    """``1 row``, ``2 rows``.

    Parameters
    ----------
    n : int
    one, several : str
        The noun, and its plural where that is not made by an s.
    """
    return f"{n} {one if n == 1 else several or f'{one}s'}"


def repeated(items: Iterable[Item]) -> list[Item]:
    """What stands more than once, sorted."""
    return sorted((item for item, n in Counter(items).items() if n > 1), key=str)


def natural(name: str) -> tuple[tuple[int, float, str], ...]:
    """A key that sorts b2 before b10."""
    return tuple((0, float(p), p) if p.isdigit() else (1, 0.0, p) for p in re.split(r"(\d{1,15})", name) if p)


def finite(value: float) -> float | None:
    """The number, or None for what JSON cannot hold: infinities and NaN."""
    return float(value) if isfinite(value) else None


DEVICES = frozenset({"con", "prn", "aux", "nul", *(f"{port}{n}" for port in ("com", "lpt") for n in range(1, 10))})


@cache
def matlab() -> frozenset[str]:
    """Keywords and functions of GNU Octave 7.3, some of MATLAB's and of MSS: ``matlab_names.txt``."""
    return frozenset(own_text(Path(__file__).with_name("matlab_names.txt")).split())


def python() -> frozenset[str]:
    """Keywords, builtins, modules of the standard library, and numpy."""
    words = {*keyword.kwlist, *keyword.softkwlist, *dir(builtins), "np", "numpy", "self"}
    return frozenset(words | sys.stdlib_module_names)


PREFIX = "vehicle_"
_LONGEST = 63  # of MATLAB
_PLAIN = re.compile(r"\w[\w .+-]{0,79}")
_MOST_BYTES = 120


def identifier(text: str, reserved: AbstractSet[str] = frozenset(), longest: int = _LONGEST) -> str:
    """An ASCII identifier like a name: letters, digits and underscores, a letter first.

    ``vehicle_`` stands before what begins with a digit, is a reserved word, in whatever letters, or a device of Windows.

    Parameters
    ----------
    text : str
    reserved : set of str, optional
        Words of the language that it goes into.
    longest : int
        Characters; those of MATLAB by default.
    """
    name = re.sub(r"[^A-Za-z0-9]+", "_", text).strip("_") or "vehicle"
    if not name[0].isalpha() or {name, name.lower()} & {*reserved, *DEVICES}:
        name = PREFIX + name
    return name[:longest].rstrip("_")


def file_stem(text: str) -> str:
    """What files of a name begin with: the name itself where any file system takes it, else an identifier and a mark of its own.

    The mark, eight digits of the name's SHA-256, keeps names apart that read alike without their other characters.
    """
    plain = _PLAIN.fullmatch(text) and text.strip(". ") == text and len(text.encode()) <= _MOST_BYTES
    if plain and text.partition(".")[0].lower() not in DEVICES:
        return text
    return f"{identifier(text, longest=54)}_{hashlib.sha256(text.encode('utf-8', 'surrogatepass')).hexdigest()[:8]}"


def one_line(text: str) -> str:
    """The text with every character that does not print, line breaks among them, replaced by a question mark."""
    return "".join(c if c.isprintable() else "?" for c in text)
