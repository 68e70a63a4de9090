"""What stands out of the hulls of a mesh: foils by their sections, and bluff parts."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from coeflab.bodies.branches import parted
from coeflab.bodies.cuts import (
    SKIN,
    Bit,
    centre_of,
    grown,
    middle_at,
    reach,
    width,
)  # fmt: skip
from coeflab.bodies.mesh.silhouettes import polygons
from coeflab.bodies.outline import Bluff, Foil, Sections
from coeflab.core.types import Array

SMALL, THICK = 0.1, 0.5  # span over the hull's radius; thickness over chord: more is bluff
LEVELS, FEWEST = 12, 3
LOOSE = 0.35  # area of the straight trapezoid over the planform, less one


@dataclass(slots=True)
class Appendage:
    """What a cluster of bits measures."""

    foil: Foil | None
    bluff: Bluff
    volume: float
    bent: float


def _words(way: Array) -> str:
    """Where a direction points: upper, lower, starboard, port, or two of these."""
    tall, wide = abs(way[1]) > 0.38, abs(way[0]) > 0.38  # sine of 22.5 deg
    return "_".join(
        word
        for word, words in (
            (("upper", "lower")[int(way[1] > 0.0)], tall),
            (("port", "starboard")[int(way[0] > 0.0)], wide),
        )
        if words
    )


def way_of(bits: list[Bit], stand: Array) -> tuple[Array, Array]:
    """From where a cluster begins towards where it ends, and the point that its distances count from.

    The direction runs through the middles of its sections at a quarter and three quarters of their height.
    """
    areas = np.array([bit.polygon.area() for bit in bits])
    middle = np.average([centre_of(bit.polygon) for bit in bits], axis=0, weights=areas) - stand
    way = (
        middle
        + stand
        - np.average(
            [bit.points[np.linalg.norm(bit.points - stand, axis=1).argmin()] for bit in bits], axis=0, weights=areas
        )
    )
    for _ in range(3):
        way = way / np.linalg.norm(way)
        total = np.zeros(2)
        for bit in bits:
            s = (bit.points - stand) @ way
            ends = [middle_at(bit.polygon, stand, way, float(s.min() + share * np.ptp(s))) for share in (0.25, 0.75)]
            total += ends[1] - ends[0]
        way = total if np.any(total) else way
    way = way / np.linalg.norm(way)
    return way, stand + middle - (middle @ way) * way


def protrudes(bit: Bit, cores: list[Bit]) -> bool:
    """It reaches further from its hull than it is wide at its foot; a corner that the opening rounded does not."""
    skin = SKIN * bit.inscribed
    core = max(cores, key=lambda c: float((grown(bit.polygon, 3.0 * skin) ^ c.polygon).area()), default=None)
    foot = 0.0 if core is None else float((grown(bit.polygon, 3.0 * skin) ^ core.polygon).area()) / (2.0 * skin)
    if core is None or foot == 0.0:
        return True
    low, high = 0.0, float(np.ptp(bit.points, axis=0).max()) + 2.0 * skin
    while high - low > 0.1 * high:
        middle = (low + high) / 2.0
        low, high = (low, middle) if (bit.polygon - grown(core.polygon, middle)).is_empty() else (middle, high)
    return low > foot


def appendage_of(bits: list[Bit], hull: Sections, track: list[Bit]) -> Appendage:
    """A cluster as a foil, or as something bluff where it is thick."""
    x = np.array([bit.x for bit in bits])
    at = float(np.clip((x[0] + x[-1]) / 2.0, hull.x[-1], hull.x[0]))
    stand = np.array([np.interp(at, hull.x[::-1], hull.centre[::-1, i]) for i in (0, 1)])
    way, origin = way_of(bits, stand)
    low, high, on_hull = np.empty(len(bits)), np.empty(len(bits)), np.zeros(len(bits), dtype=bool)
    by_step = {bit.x: bit for bit in track}
    for i, bit in enumerate(bits):
        s = (bit.points - origin) @ way
        low[i], high[i] = float(s.min()), float(s.max())
        core = by_step.get(bit.x)
        if core is not None and low[i] - (within := reach(core.polygon, origin, way)) < 0.2 * bit.inscribed:
            low[i] = min(within, high[i])
            on_hull[i] = True
    place = _words(way)
    bluff, volume = bluff_of(f"part_{place}", bits)
    foil = _foil(f"foil_{place}", x, low, high, on_hull, bits, origin, way) if len(x) > 4 else None
    sides = np.array([edges_of(bit) for bit in bits]) / 2.0
    bent = float(np.trapezoid(sides, x) / np.trapezoid(high - low, x)) - 1.0 if foil is not None else 0.0
    return Appendage(foil, bluff, volume, bent)


def bluff_of(name: str, bits: list[Bit]) -> tuple[Bluff, float]:
    """A cluster as a bluff part, and its volume."""
    x = np.array([bit.x for bit in bits])
    areas = np.array([bit.polygon.area() for bit in bits])
    points = np.concatenate([bit.points for bit in bits])
    half = np.array([(x[0] - x[-1]) / 2.0, *np.ptp(points, axis=0) / 2.0])
    middle = np.array([(x[0] + x[-1]) / 2.0, *((points.min(axis=0) + points.max(axis=0)) / 2.0)])
    side = [float(-np.trapezoid([np.ptp(bit.points[:, i]) for bit in bits], x)) for i in (1, 0)]
    volume = float(-np.trapezoid(areas, x)) if len(x) > 1 else 0.0
    return Bluff(name, "mesh", middle, np.eye(3), half, np.array([float(areas.max()), *side])), volume


def branched(bits: list[Bit], hull: Sections, track: list[Bit]) -> list[Appendage]:
    """A cluster as a foil and what stands across it, each a foil on that foil or bluff; empty where it is no such foil."""
    at = float(np.clip((bits[0].x + bits[-1].x) / 2.0, hull.x[-1], hull.x[0]))
    stand = np.array([np.interp(at, hull.x[::-1], hull.centre[::-1, i]) for i in (0, 1)])
    way, origin = way_of(bits, stand)
    trunk, branches = parted(bits, origin, way)
    trunk = [bit for bit in trunk if bit.polygon.area() > 0.0]
    if not branches or not trunk:
        return []
    own = appendage_of(trunk, hull, track)
    if own.foil is None or own.foil.thickness > THICK:
        return []
    out = [own]
    for one in branches:
        bluff, volume = bluff_of(f"part_{_words(one.way)}", one.bits)
        x = np.array([bit.x for bit in one.bits])
        high = np.array([float(((bit.points - one.stand) @ one.way).max()) for bit in one.bits])
        low, rooted = np.minimum(one.foot, high), np.ones(len(x), dtype=bool)
        foil = (
            _foil(f"foil_{_words(one.way)}", x, low, high, rooted, one.bits, one.stand, one.way) if len(x) > 4 else None
        )
        out.append(Appendage(foil, bluff, volume, 0.0))
    return out


def edges_of(bit: Bit) -> float:
    """Length of all edges of a bit, m."""
    return sum(float(np.linalg.norm(np.roll(r, -1, axis=0) - r, axis=1).sum()) for r in polygons(bit.polygon))


def _foil(
    name: str, x: Array, low: Array, high: Array, on_hull: NDArray[np.bool_], bits: list[Bit], origin: Array, way: Array
) -> Foil | None:
    """Straight edges through the planform between the foremost and the aftmost station at each level."""
    tip, foot = float(high.max()), float(low[on_hull].mean() if on_hull.any() else low.min())
    clean = max(foot, min(float(low.max()), foot + 0.5 * (tip - foot)))
    levels = clean + (tip - clean) * (np.arange(LEVELS) + 0.5) / LEVELS * 0.95
    edges = []
    for level in levels:
        inside = np.flatnonzero((low <= level + 1e-12) & (high >= level))
        if not len(inside):
            return None
        edges.append((_edge(x, low, high, int(inside[0]), -1, level), _edge(x, low, high, int(inside[-1]), 1, level)))
    fore, aft = (np.polynomial.Polynomial.fit(levels, np.array(edges)[:, i], 1) for i in (0, 1))
    step = float(x[0] - x[-1]) / (len(x) - 1)
    area = float(-np.trapezoid(high - low, x)) + step / 2.0 * float((high - low)[[0, -1]].sum())
    root_chord, tip_chord = (max(float(fore(at) - aft(at)), 0.0) for at in (foot, tip))
    if tip - foot <= 0.0 or root_chord + tip_chord <= 0.0:
        return None
    fit = 2.0 * area / ((root_chord + tip_chord) * (tip - foot))
    if not 1.0 - LOOSE < fit < 1.0 + LOOSE:
        return None
    level = (foot + tip) / 2.0
    chord = float(fore(level) - aft(level))
    thickness = max(width(bit.polygon, origin, way, level) for bit in bits) / chord if chord > 0.0 else np.inf
    root, end = (
        np.array([float(fore(at)) - c / 4.0, *(origin + at * way)]) for at, c in ((foot, root_chord), (tip, tip_chord))
    )
    return Foil(name, root, end, fit * root_chord, fit * tip_chord, thickness, origin)


def _edge(x: Array, low: Array, high: Array, at: int, step: int, level: float) -> float:
    """Where the tip or the foot line crosses a level beyond a station; past the last station half a step further."""
    other = at + step
    if not 0 <= other < len(x):
        return float(x[at] - step * (x[0] - x[-1]) / (len(x) - 1) / 2.0)
    line = low if low[other] > level else high
    if (high[other] >= level and line is high) or line[at] == line[other]:
        return float(x[at])
    return float(x[at] + (x[other] - x[at]) * (line[at] - level) / (line[at] - line[other]))
