"""Names that people gave, as programs and one-line comments can carry them."""

from __future__ import annotations

import re
from collections.abc import Set as AbstractSet

_LONGEST = 63  # of MATLAB


def identifier(text: str, reserved: AbstractSet[str] = frozenset(), longest: int = _LONGEST) -> str:
    """An ASCII identifier like a name: letters, digits and underscores, a letter first, never a reserved word."""
    name = re.sub(r"[^A-Za-z0-9]+", "_", text).strip("_") or "vehicle"
    if not name[0].isalpha() or name in reserved:
        name = f"vehicle_{name}"
    return name[:longest].rstrip("_")


def one_line(text: str) -> str:
    """The text with every character that does not print, line breaks among them, replaced by a question mark."""
    return "".join(c if c.isprintable() else "?" for c in text)
