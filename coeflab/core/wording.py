"""Pieces of sentences and records: names in a row, numbers that may be none."""

from __future__ import annotations

from collections import Counter
from collections.abc import Hashable, Iterable, Sequence
from math import isfinite
from typing import TypeVar

Item = TypeVar("Item", bound=Hashable)


def listed(names: Sequence[str]) -> str:
    """One or more names as a sentence lists them: ``a``, ``a and b``, ``a, b and c``."""
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"


def repeated(items: Iterable[Item]) -> list[Item]:
    """What stands more than once, sorted."""
    return sorted((item for item, n in Counter(items).items() if n > 1), key=str)


def finite(value: float) -> float | None:
    """The number, or None for what JSON cannot hold: infinities and NaN."""
    return float(value) if isfinite(value) else None
