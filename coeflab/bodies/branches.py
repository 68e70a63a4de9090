"""What stands across a foil: planes on a sail, a bar on a fin, an end plate; parted from it by its own width at each section.

At every station the widths of a section over its height say which are the foil's own: most levels are free of what stands
across. What lies beyond that width, and reaches further than the foil is wide, is a branch.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from coeflab.bodies.cuts import Bit, Polygon, clusters_of, merged, middle_at, width
from coeflab.core.types import Array

LEVELS, OWN, WIDER = (
    24,
    75.0,
    1.5,
)  # over the height; per cent of levels at most as wide as the foil; times that: not the foil
MARGIN = 1.05  # of the foil's width, which a branch begins beyond
FEWEST, PASSES = 3, 2  # stations of a branch; passes of the middle


@dataclass(slots=True)
class Branch:
    """What stands across a foil on one side of it.

    Attributes
    ----------
    bits : list of Bit
    way : (2,) array
        Away from the foil, y and z.
    stand : (2,) array
        The foil's middle there.
    foot : float
        Half of the foil's width there, from its middle, m.
    """

    bits: list[Bit]
    way: Array
    stand: Array
    foot: float


def parted(bits: list[Bit], origin: Array, way: Array) -> tuple[list[Bit], list[Branch]]:
    """A cluster as the foil that it is without its branches, and these; itself and none where it has none.

    Parameters
    ----------
    bits : list of Bit
        One a station.
    origin, way : (2,) array
        A point on the middle of the foil, and where it points; y and z.
    """
    origin, way = _middle(bits, origin, way)
    across = np.array([-way[1], way[0]])
    trunk: list[Bit] = []
    neighbours: list[list[Bit]] = []
    half: dict[float, float] = {}
    for k, bit in enumerate(bits):
        s = (bit.points - origin) @ way
        widths = np.array(
            [width(bit.polygon, origin, way, float(a)) for a in np.linspace(s.min(), s.max(), LEVELS + 2)[1:-1]]
        )
        own = float(np.percentile(widths, OWN, method="lower"))
        half[bit.x] = MARGIN * own / 2.0
        neighbours.append([])
        aside = np.abs((bit.points - origin) @ across)
        if own <= 0.0 or 2.0 * aside.max() <= WIDER * own:
            trunk.append(bit)
            continue
        strip = _strip(origin, way, across, half[bit.x], float(np.abs(s).max()) + own)
        trunk.append(Bit(bit.x, bit.polygon ^ strip, bit.inscribed, step=bit.step))
        for piece in (bit.polygon - strip).decompose():
            one = Bit(bit.x, piece, bit.inscribed, step=k)
            t = np.abs((one.points - origin) @ across)
            if t.max() - half[bit.x] > 2.0 * half[bit.x] / MARGIN:
                neighbours[-1].append(one)
    found = [merged(c) for c in clusters_of(neighbours)]
    branches = [_branch(c, origin, way, across, half) for c in found if len(c) >= FEWEST]
    return (trunk, branches) if branches else (bits, [])


def _middle(bits: list[Bit], origin: Array, way: Array) -> tuple[Array, Array]:
    """A point on the foil's middle and its direction, by the levels that are no wider than half of them are."""
    for _ in range(PASSES):
        across = np.array([-way[1], way[0]])
        found = []
        for bit in bits:
            s = (bit.points - origin) @ way
            levels = np.linspace(s.min(), s.max(), LEVELS + 2)[1:-1]
            widths = np.array([width(bit.polygon, origin, way, float(a)) for a in levels])
            own = widths <= np.median(widths) * (1.0 + 1e-9)
            found += [middle_at(bit.polygon, origin, way, float(a)) for a in levels[own & (widths > 0.0)]]
        if len(found) < LEVELS:
            return origin, way
        points = np.array(found) - origin
        slope, aside = np.polyfit(points @ way, points @ across, 1)
        origin = origin + aside * across
        way = (way + slope * across) / np.hypot(1.0, slope)
    return origin, way


def _branch(bits: list[Bit], origin: Array, way: Array, across: Array, half: dict[float, float]) -> Branch:
    points = np.concatenate([bit.points for bit in bits]) - origin
    side = float(np.sign(np.mean(points @ across)))
    high = float(np.mean(points @ way))
    foot = float(np.mean([half[bit.x] for bit in bits]))
    return Branch(bits, side * across, origin + high * way, foot / MARGIN)


def _strip(origin: Array, way: Array, across: Array, half: float, long: float) -> Polygon:
    from manifold3d import CrossSection, FillRule

    corners = [(-long, -half), (long, -half), (long, half), (-long, half)]
    return CrossSection([[tuple(map(float, origin + a * way + b * across)) for a, b in corners]], FillRule.NonZero)
