"""Text of users on paper: every character has a glyph, every long word can break, no title fills a page."""

from __future__ import annotations

import unicodedata
from datetime import UTC, datetime
from functools import cache

CLOCK = datetime(2000, 1, 1, tzinfo=UTC)  # of every PDF: equal contents give equal bytes
WORD, STEP = 22, 12
BREAK = "\u200b"
UNBROKEN = "\u00a0\u202f"
AFTER = "/_,;:="


def shortened(text: str, longest: int) -> str:
    """The text, or its beginning with an ellipsis."""
    flat = " ".join(text.split())
    return flat if len(flat) <= longest else flat[: longest - 1].rstrip() + "…"


def breakable(text: str) -> str:
    """The text with places to break in words that are too long for a narrow column; after a separator where there is one."""
    if len(text) <= WORD:
        return text
    return "".join(_broken(part) if len(part) > WORD else part for part in _words(text))


def _words(text: str) -> list[str]:
    import re

    return re.split(r"(\s+)", text)


def _broken(word: str) -> str:
    out, since = [], 0
    for i, ch in enumerate(word):
        out.append(ch)
        since += 1
        if (
            i + 1 < len(word)
            and (since >= STEP or (ch in AFTER and since > 2))
            and not unicodedata.combining(word[i + 1])
        ):
            out.append(BREAK)
            since = 0
    return "".join(out)


def glyphs(text: str) -> str:
    """The text with ``U+XXXX`` in place of every character that the fonts lack or that steers the direction of writing."""
    return text if text.isascii() and text.isprintable() else "".join(_shown(ch) for ch in text)


def visible(text: str) -> str:
    """The text with ``U+XXXX`` in place of every character that has no shape or steers the direction of writing."""
    if text.isprintable():
        return text
    return "".join(ch if ch.isprintable() or ch in UNBROKEN else _without_shape(ch) for ch in text)


def _without_shape(ch: str) -> str:
    return " " if ch.isspace() else f"U+{ord(ch):04X}"


def runs_to_the_left(text: str) -> bool:
    """Whether some of it is written from right to left."""
    return not text.isascii() and any(unicodedata.bidirectional(ch) in ("R", "AL", "AN") for ch in text)


def _shown(ch: str) -> str:
    if ch == BREAK or (" " <= ch <= "~"):
        return ch
    if ch.isspace():
        return ch if ch in UNBROKEN else " "
    if unicodedata.category(ch).startswith("C") or ord(ch) not in _drawn():
        return f"U+{ord(ch):04X}"
    return ch


@cache
def _drawn() -> frozenset[int]:
    """Code points of DejaVu Sans, which is beside every other font."""
    from matplotlib import get_data_path
    from matplotlib.ft2font import FT2Font

    return frozenset(FT2Font(f"{get_data_path()}/fonts/ttf/DejaVuSans.ttf").get_charmap())
