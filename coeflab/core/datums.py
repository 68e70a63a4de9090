"""Whether two texts name one datum."""

from __future__ import annotations

import re

IDLE = frozenset({"the", "a", "an", "of", "its", "at", "in", "on"})


def same_datum(one: str, other: str) -> bool:
    """Whether two datums are the same but for case, articles and what is added after a comma.

    "nose" is "Nose, on the hull's axis"; "nose, on the deck" is not "nose, on the hull's axis".
    """
    first, second = _phrases(one), _phrases(other)
    return all(a == b for a, b in zip(first, second, strict=False))


def _phrases(text: str) -> list[list[str]]:
    return [[w for w in re.findall(r"[\w']+", p) if w not in IDLE] for p in text.casefold().split(",")]
