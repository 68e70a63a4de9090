"""Writing TOML: tables, arrays of tables and values, all digits, nothing that a parser would take for something else."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

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
