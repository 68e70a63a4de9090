"""Reading the TOML files that people write: every complaint names file and key, unknown keys are errors.

Writing TOML: tables, arrays of tables and values, all digits, nothing that a parser would take for something else.
"""

from __future__ import annotations

import codecs
import difflib
import math
import re
import tomllib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from coeflab.core.errors import InputError, shown
from coeflab.core.limits import INTEGER_DIGITS, TOML_BYTES, TOML_NAMES_IN_A_KEY, TOML_TABLES, positive_number
from coeflab.core.units import quantity
from coeflab.core.wording import Verbatim

_NAME = r"""(?:[A-Za-z0-9_-]++|"[^"\n]*+"|'[^'\n]*+')"""
_LONG_KEY = re.compile(rf"(?<![A-Za-z0-9_-]){_NAME}(?:[ \t]*+\.[ \t]*+{_NAME}){{{TOML_NAMES_IN_A_KEY},}}")
_LONG_INTEGER = re.compile(rf"[0-9_]{{{INTEGER_DIGITS + 1},}}+")


class Section:
    """One table of a TOML file, read key by key.

    Parameters
    ----------
    content : dict
    file : path
    name : str
        Dotted name of the table, for messages.
    """

    def __init__(self, content: dict[str, Any], file: Path, name: str = "") -> None:
        self.content, self.file, self.name = content, file, name
        self._read: set[str] = set()
        self._known: set[str] = set()

    def key(self, key: str) -> str:
        """Dotted name of a key."""
        return f"{self.name}.{key}" if self.name else key

    def fail(self, key: str, found: str, expected: str, advice: str = "") -> InputError:
        """An error about one key, to be raised by the caller.

        Parameters
        ----------
        key : str
        found, expected : str
        advice : str, optional
        """
        return InputError(found, expected, file=self.file, column=self.key(key), advice=advice)

    def has(self, key: str) -> bool:
        """Whether the key is there."""
        self._known.add(key)
        return key in self.content

    def raw(self, key: str, default: Any = None) -> Any:
        """The value as TOML gives it."""
        self._read.add(key)
        return self.content.get(key, default)

    def _required(self, key: str, kind: str) -> Any:
        if key not in self.content:
            raise self.fail(key, "nothing", kind, f"Add {self.key(key)}.")
        return self.raw(key)

    def text(self, key: str, default: str | None = None, choices: tuple[str, ...] = ()) -> str:
        """A text, optionally one of several; else the user's own words.

        Parameters
        ----------
        key : str
        default : str, optional
            Without it the key is required, and not blank.
        choices : tuple of str, optional
            Words that are allowed; empty: any.
        """
        value = self._required(key, "a text") if default is None else self.raw(key, default)
        if not isinstance(value, str) or (default is None and not value.strip()):
            raise self.fail(key, shown(value), "a text")
        if choices and value not in choices:
            raise self.fail(key, shown(value), " or ".join(f'"{c}"' for c in choices))
        return value if choices or key not in self.content else Verbatim(value)

    def flag(self, key: str, default: bool | None = None) -> bool:
        """True or false."""
        value = self._required(key, "true or false") if default is None else self.raw(key, default)
        if not isinstance(value, bool):
            raise self.fail(key, shown(value), "true or false")
        return value

    def integer(self, key: str, default: int, low: int, high: int) -> int:
        """A whole number within bounds.

        Parameters
        ----------
        key : str
        default, low, high : int
            The bounds are allowed values.
        """
        value = self.raw(key, default)
        if isinstance(value, bool) or not isinstance(value, int) or not low <= value <= high:
            raise self.fail(key, shown(value), f"a whole number from {low} to {high}")
        return value

    def quantity(self, key: str, dimension: str) -> float:
        """A number in SI or a text with its unit; required."""
        value = self._required(key, f"a {dimension}")
        return quantity(value, dimension, file=self.file, key=self.key(key))

    def optional_quantity(self, key: str, dimension: str) -> float | None:
        """A number in SI or a text with its unit, if given."""
        return self.quantity(key, dimension) if self.has(key) else None

    def positive(self, key: str, dimension: str) -> float:
        """A required number above zero."""
        value = self.quantity(key, dimension)
        if expected := positive_number(value):
            raise self.fail(key, f"{shown(self.raw(key))}", expected)
        return value

    def optional_positive(self, key: str, dimension: str) -> float | None:
        """A number above zero, if given."""
        return self.positive(key, dimension) if self.has(key) else None

    def point(self, key: str) -> NDArray[np.float64]:
        """A point or triple of lengths, m."""
        return np.array(self.triple(key, "length", "a point [x, y, z] in metres, FRD, from the datum"))

    def triple(self, key: str, dimension: str, kind: str = "") -> tuple[float, float, float]:
        """Three numbers in SI or texts with units.

        Parameters
        ----------
        key, dimension : str
            The latter of `coeflab.core.units.SI`.
        kind : str, optional
            What the three are, for the error.
        """
        expected = kind or f"three numbers [x, y, z] of {dimension}"
        value = self._required(key, expected)
        if not isinstance(value, list) or len(value) != 3:
            raise self.fail(key, shown(value), expected)
        x, y, z = (quantity(v, dimension, file=self.file, key=self.key(key)) for v in value)
        return x, y, z

    def texts(self, key: str) -> tuple[str, ...]:
        """A list of texts, empty by default."""
        value = self.raw(key, [])
        if not isinstance(value, list) or not all(isinstance(v, str) for v in value):
            raise self.fail(key, shown(value), "a list of texts")
        return tuple(map(Verbatim, value))

    def section(self, key: str, required: bool = True) -> Section:
        """A sub-table; an empty one where it is absent and not required."""
        value = self._required(key, "a table") if required else self.raw(key, {})
        if not isinstance(value, dict):
            raise self.fail(key, shown(value), f"a table [{self.key(key)}]")
        return Section(value, self.file, self.key(key))

    def sections(self, key: str) -> list[Section]:
        """An array of tables, empty by default."""
        value = self.raw(key, [])
        if not isinstance(value, list) or not all(isinstance(v, dict) for v in value):
            raise self.fail(key, shown(value), f"tables [[{self.key(key)}]]")
        return [Section(v, self.file, f"{self.key(key)}[{i}]") for i, v in enumerate(value)]

    def finish(self) -> None:
        """Refuse keys that nobody read."""
        for key in self.content:
            if key not in self._read:
                known = sorted(self._read | self._known)
                near = difflib.get_close_matches(key, known, n=1)
                raise self.fail(
                    key,
                    "an unknown key",
                    "one of " + ", ".join(known),
                    f"Did you mean {self.key(near[0])}?" if near else "",
                )


def read_text(path: Path, largest: int = TOML_BYTES) -> str:
    """A small text file.

    Raises
    ------
    InputError
        Missing, a folder or device, empty, too large, or not UTF-8.
    """
    try:
        if path.is_dir():
            raise InputError("a folder", "a file", file=path)
        if not path.exists():
            found = "a link that leads to no file" if path.is_symlink() else "no such file"
            raise InputError(found, "a file that exists", file=path)
        if not path.is_file():
            raise InputError("a device or pipe", "a file", file=path)
        if path.stat().st_size > largest:
            raise InputError(f"{path.stat().st_size} bytes", f"at most {largest} bytes", file=path)
        content = path.read_bytes()
    except OSError as why:
        raise InputError(str(why.strerror or why), "a readable file", file=path) from None
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError as why:
        line = content.count(b"\n", 0, why.start) + 1
        wide = " of UTF-16" if content.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)) else ""
        raise InputError(
            f"the byte 0x{content[why.start]:02x}{wide}",
            "UTF-8 text",
            file=path,
            line=line,
            advice="Save the file as UTF-8.",
        ) from None
    if not text.strip():
        raise InputError("an empty file", "content", file=path)
    return text


def read_toml(path: Path) -> Section:
    """Parse a TOML file.

    Raises
    ------
    InputError
        Not readable, or not TOML; the parser's line and column are passed on.
    """
    text = read_text(path)
    _within_bounds(text, path)
    try:
        return Section(tomllib.loads(text), path)
    except tomllib.TOMLDecodeError as why:
        raise InputError(f"a TOML error ({why})", "valid TOML", file=path) from None
    except RecursionError:
        raise InputError("too deep nesting", "valid TOML", file=path) from None
    except ValueError:
        match = _LONG_INTEGER.search(text)
        line = text.count("\n", 0, match.start()) + 1 if match else None
        expected = f"at most {INTEGER_DIGITS:,} digits"
        raise InputError("an integer of thousands of digits", expected, file=path, line=line) from None


def _within_bounds(text: str, path: Path) -> None:
    """Refuse what would cost time and memory to parse."""
    match = _LONG_KEY.search(text)
    if match:
        line = text.count("\n", 0, match.start()) + 1
        expected = f"at most {TOML_NAMES_IN_A_KEY} names between dots"
        raise InputError("a dotted key of many names", expected, file=path, line=line)
    tables = text.count("\n[")
    if tables > TOML_TABLES:
        raise InputError(f"{tables:,} tables", f"at most {TOML_TABLES:,}", file=path)


_ESCAPES = {'"': '\\"', "\\": "\\\\", "\n": "\\n", "\t": "\\t", "\r": "\\r"}


def quoted(text: str) -> str:
    """A basic string; lone surrogates become the replacement character."""
    out = []
    for c in text:
        code = ord(c)
        if c in _ESCAPES:
            out.append(_ESCAPES[c])
        elif code < 0x20 or 0x7F <= code < 0xA0:
            out.append(f"\\u{code:04x}")
        else:
            out.append("\ufffd" if 0xD800 <= code < 0xE000 else c)
    return '"' + "".join(out) + '"'


def value(content: Any) -> str:
    """A value on one line: text, number, flag, or a list of these."""
    if isinstance(content, str):
        return quoted(content)
    if isinstance(content, bool):
        return "true" if content else "false"
    if isinstance(content, float):
        return "nan" if math.isnan(content) else repr(content)
    if isinstance(content, int):
        return str(content)
    if isinstance(content, Mapping):
        return "{" + ", ".join(f"{_key(k)} = {value(v)}" for k, v in content.items() if v is not None) + "}"
    if isinstance(content, Sequence):
        return "[" + ", ".join(value(v) for v in content) + "]"
    raise TypeError(type(content).__name__)


def toml_text(content: Mapping[str, Any]) -> str:
    """A document: plain values first, then a table for every mapping and one for every mapping of a list.

    Keys whose value is None are left out, for TOML has no null.
    """
    lines = [f"{_key(k)} = {value(v)}" for k, v in content.items() if v is not None and not _is_table(v)]
    for key, inner in content.items():
        if isinstance(inner, Mapping):
            lines += ["", f"[{_key(key)}]", *_pairs(inner)]
        elif _is_table(inner):
            for one in inner:
                lines += ["", f"[[{_key(key)}]]", *_pairs(one)]
    return "\n".join(lines).lstrip("\n") + "\n"


def _is_table(content: Any) -> bool:
    listed = isinstance(content, Sequence) and not isinstance(content, str) and len(content) > 0
    return isinstance(content, Mapping) or (listed and all(isinstance(c, Mapping) for c in content))


def _pairs(content: Mapping[str, Any]) -> list[str]:
    return [f"{_key(k)} = {value(v)}" for k, v in content.items() if v is not None]


def _key(name: str) -> str:
    return name if name and all(c.isascii() and (c.isalnum() or c in "_-") for c in name) else quoted(name)
