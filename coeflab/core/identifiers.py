"""Names that people gave, as programs and one-line comments can carry them."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Set as AbstractSet

from coeflab.core.reserved import DEVICES

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
