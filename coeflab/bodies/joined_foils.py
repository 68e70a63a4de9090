"""Foils in several pieces: a stub and the blade beyond it, a fin and the flap behind it, with a slit between.

One plane, one direction, and a slit that is small beside the pieces: the flow takes them for one foil. Two foils apart, each with
its own image in the hull, would have the hull's share of lift twice.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from coeflab.bodies.cuts import Bit, merged
from coeflab.core.types import Array

SLIT = 0.1  # of both pieces together, along the slit's normal
FEWEST = 3  # stations
ALIKE, OVERLAP = 0.95, 0.5  # cosine between their directions; of the shorter one, which lies beside the other

Way = Callable[[list[Bit]], tuple[Array, Array]]


def joined(clusters: Sequence[list[Bit]], way_of: Way, one_foil: Callable[[list[Bit]], bool]) -> list[list[Bit]]:
    """Clusters of bits with pieces of one foil put together, one bit a station.

    Parameters
    ----------
    clusters : sequence of list of Bit
        One bit a station each.
    way_of : callable
        Where a cluster points, and a point on its middle; (2,) arrays, y and z.
    one_foil : callable
        Whether a cluster is a foil.
    """
    out = [list(c) for c in clusters]
    known: dict[int, tuple[Array, Array]] = {}

    def way(bits: list[Bit]) -> tuple[Array, Array]:
        if id(bits) not in known:
            known[id(bits)] = way_of(bits)
        return known[id(bits)]

    k = 0
    while k < len(out):
        fits = (j for j in range(len(out)) if j != k and _one_plane(out[k], out[j], way))
        for j in fits:
            whole = merged([*out[k], *out[j]])
            whole.sort(key=lambda bit: bit.step)
            if one_foil(whole):
                out = [c for i, c in enumerate(out) if i not in (j, k)]
                out.append(whole)
                known.clear()  # by id, which a list that went leaves to another
                k = -1
                break
        k += 1
    return out


def _one_plane(a: list[Bit], b: list[Bit], way_of: Way) -> bool:
    """Beside each other with a small slit, in one plane through the hull's axis or beside it."""
    chords = [(c[-1].x, c[0].x) for c in (a, b)]
    if (
        len(a) < FEWEST
        or len(b) < FEWEST
        or not (_adjacent(chords, SLIT, narrow=True) or _adjacent(chords, OVERLAP, narrow=False))
    ):
        return False
    points = [np.concatenate([bit.points for bit in c]) for c in (a, b)]
    (way, origin), (other, _) = way_of(a), way_of(b)
    if way @ other < ALIKE:
        return False
    across = np.array([-way[1], way[0]])
    aside = [(p - origin) @ across for p in points]
    thick = max(float(np.ptp(t)) for t in aside)
    if abs(float(aside[0].mean() - aside[1].mean())) > thick:
        return False
    heights = [(p - origin) @ way for p in points]
    along = [(float(h.min()), float(h.max())) for h in heights]
    return any(
        _adjacent(one, SLIT, narrow=True) and _adjacent(two, OVERLAP, narrow=False)
        for one, two in ((along, chords), (chords, along))
    )


def _adjacent(ranges: Sequence[tuple[float, float]], share: float, narrow: bool) -> bool:
    """``narrow``: one range ends where the other begins, but for a slit; else they share most of the shorter one."""
    (low, high), (first, last) = ranges
    common = min(high, last) - max(low, first)
    lengths = (high - low, last - first)
    if narrow:
        return bool(-share * sum(lengths) <= common <= share * min(lengths))
    return bool(common >= share * min(lengths))
