"""Reading the TOML files that people write, with the lines of their keys.

Writing TOML: tables, arrays of tables and values, all digits, nothing that a parser would take for something else.
"""

from __future__ import annotations

import codecs
import functools
import math
import re
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from coeflab.core.errors import InputError
from coeflab.core.limits import INTEGER_DIGITS, TOML_BYTES, TOML_NAMES_IN_A_KEY, TOML_TABLES
from coeflab.core.text.bounded import whole_bytes
from coeflab.core.text.json import NUL

_NAME = r"""(?:[A-Za-z0-9_-]++|"[^"\n]*+"|'[^'\n]*+')"""
_LONG_KEY = re.compile(rf"(?<![A-Za-z0-9_-]){_NAME}(?:[ \t]*+\.[ \t]*+{_NAME}){{{TOML_NAMES_IN_A_KEY},}}")
_AT_LINE = re.compile(r"at line (\d+)")
_QUOTED = re.compile(r""""[^"\n]*"|'[^'\n]*'""")
_CAPITALS = re.compile(r"\b[A-Z]{3,}\b")
_LONGEST_STATEMENT = 1 << 14  # the parser goes over it once a line
_LONG_INTEGER = re.compile(rf"[0-9_]{{{INTEGER_DIGITS + 1},}}+")


@dataclass(frozen=True, slots=True)
class TomlFile:
    """A TOML file that was read, with the lines of its keys for messages.

    Attributes
    ----------
    path : Path
    content : mapping
    text : str
    """

    path: Path
    content: Mapping[str, Any]
    text: str

    def line(self, place: Sequence[str | int]) -> int | None:
        """The line of a key, of the table that lacks it, or None; array items count from 0."""
        lines = _lines(self.text)
        known = (lines[tuple(place[:n])] for n in range(len(place), 0, -1) if tuple(place[:n]) in lines)
        return next(known, None)

    def fail(self, key: str, found: str, expected: str, advice: str = "") -> InputError:
        """An error about one key, to be raised by the caller.

        Parameters
        ----------
        key : str
            Dotted, such as ``free[0].places``.
        found, expected : str
        advice : str, optional
        """
        return InputError(found, expected, file=self.path, line=self.line(dotted(key)), key=key, advice=advice)


def dotted(key: str) -> tuple[str | int, ...]:
    """The place of a dotted key: ``free[0].places``."""
    return tuple(int(number) if number else name for number, name in re.findall(r"\[(\d+)\]|([^.\[\]]+)", key))


@functools.lru_cache(maxsize=1)
def _lines(text: str) -> dict[tuple[str | int, ...], int]:
    """Line of every table and key, statement by statement; empty behind a value that goes over too many lines."""
    out: dict[tuple[str | int, ...], int] = {}
    counts: dict[tuple[str | int, ...], int] = {}
    table: tuple[str | int, ...] = ()
    statement, began = "", 1
    for number, line in enumerate(text.split("\n"), 1):
        began = began if statement else number
        statement += line + "\n"
        try:
            read: Any = tomllib.loads(statement)
        except ValueError:
            if len(statement) > _LONGEST_STATEMENT:
                break
            continue
        is_header, statement = statement.lstrip().startswith("["), ""
        place = () if is_header else table
        while isinstance(read, dict) and len(read) == 1:
            ((name, read),) = read.items()
            place = (*place, name)
            out.setdefault(place, began)
            if is_header and isinstance(read, list):
                counts[place] = counts.get(place, 0) + 1
            if is_header and place in counts:
                place = (*place, counts[place] - 1)
                out.setdefault(place, began)
        table = place if is_header else table
    return out


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
        content = whole_bytes(path, largest)
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


def read_toml(path: Path) -> TomlFile:
    """Parse a TOML file.

    Raises
    ------
    InputError
        Not readable, or not TOML; the parser's line and column are passed on.
    """
    text = read_text(path)
    _within_bounds(text, path)
    if nul := NUL.search(text):
        raise InputError("a NUL in a text", "letters", file=path, line=text.count("\n", 0, nul.start()) + 1)
    try:
        return TomlFile(path, tomllib.loads(text), text)
    except tomllib.TOMLDecodeError as why:
        if left := _placeholder(text, str(why)):
            word, row = left
            raise InputError(
                f"{word}, {'placeholders' if ' ' in word else 'a placeholder'}", "a number in its place", file=path, line=row,
                advice="A word stands between quotation marks.",
            ) from None  # fmt: skip
        raise InputError(f"a TOML error ({why})", "valid TOML", file=path) from None
    except RecursionError:
        raise InputError("too deep nesting", "valid TOML", file=path) from None
    except ValueError:
        match = _LONG_INTEGER.search(text)
        line = text.count("\n", 0, match.start()) + 1 if match else None
        expected = f"at most {INTEGER_DIGITS:,} digits"
        raise InputError("an integer of thousands of digits", expected, file=path, line=line) from None


def own_toml(text: str) -> dict[str, Any]:
    """What a text of the package itself holds."""
    return tomllib.loads(text)


def typed_value(text: str) -> Any:
    """What a person typed for a key: a value of TOML, else the very text.

    Raises
    ------
    InputError
        A text that would cost time and memory to parse.
    """
    _within_bounds(text, None)
    try:
        return tomllib.loads(f"x = {text}")["x"]
    except (ValueError, RecursionError):
        return text


def _placeholder(text: str, why: str) -> tuple[str, int] | None:
    """A bare word in capitals on the line that the parser names, such as NEWTON in ``curve = [[0, 0], [RPM, NEWTON]]``."""
    at = _AT_LINE.search(why)
    line = int(at.group(1)) if at else 0
    rows = text.splitlines()
    if not 0 < line <= len(rows):
        return None
    bare = _QUOTED.sub('""', rows[line - 1]).partition("#")[0]
    words = list(dict.fromkeys(_CAPITALS.findall(bare.partition("=")[2])))
    return (" and ".join(words), line) if words else None


def _within_bounds(text: str, path: Path | None) -> None:
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
