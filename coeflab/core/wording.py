"""Pieces of sentences and records: names in a row, numbers that may be none, and the words of users."""

from __future__ import annotations

from collections import Counter
from collections.abc import Hashable, Iterable, Sequence
from math import isfinite
from typing import TypeVar

Item = TypeVar("Item", bound=Hashable)


class Verbatim(str):
    """A text that a user wrote, such as a title or a name: it is shown as it stands and never searched for symbols.

    Readers of files make it; nouns carry it. A text put together from it is a plain one again, in which the renderers
    find what they were handed of these.
    """

    __slots__ = ()


def listed(names: Sequence[str]) -> str:
    """One or more names as a sentence lists them: ``a``, ``a and b``, ``a, b and c``."""
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"


def repeated(items: Iterable[Item]) -> list[Item]:
    """What stands more than once, sorted."""
    return sorted((item for item, n in Counter(items).items() if n > 1), key=str)


def finite(value: float) -> float | None:
    """The number, or None for what JSON cannot hold: infinities and NaN."""
    return float(value) if isfinite(value) else None
