"""Sections of a closed mesh across x, each as hulls and what stands out of them, and what of them hangs together along x.

Every section is opened by a disc of half its largest inscribed radius (Serra, Image Analysis and Mathematical Morphology,
1982): what is left is a core of a hull, what is cut off may be an appendage. A round section with a large hole is a wall.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.mesh.silhouettes import polygons
from coeflab.bodies.mesh_sections import contours
from coeflab.core.errors import InputError
from coeflab.core.types import Array

OPENING, SKIN, ROUND = 0.5, 0.02, 96  # of the inscribed radius; segments of a circle
COMPACT = 0.6  # area over convex hull
HOLLOW, RINGLIKE, WALL = 0.25, 0.05, 0.4  # hole over the disc; deviation from a circle; wall over radius
FACETS, SPECK = 0.03, 1e-3  # of the hole's radius and of the disc: what facets of a ring leave within it

Polygon = Any
FINEST = 1e-4  # of the size of a section: finer corners of it go
GRAIN = 1e-8  # of the square of that size: an area that is rounding
THIN = 1e-6  # of the width of a polygon: no disc lies within
CRUMB = 1e-6  # of the area of a section: what is less is not kept beside its cores


@dataclass(slots=True)
class Bit:
    """A connected piece of one section: of a hull (``core``) or of what stands out of it."""

    x: float
    polygon: Polygon
    inscribed: float = 0.0
    core: bool = False
    step: int = 0
    next: Bit | None = None
    owner: int = -1

    @property
    def points(self) -> Array:
        """(n, 2) all its corners."""
        return np.concatenate(polygons(self.polygon))


@dataclass(slots=True)
class Wall:
    """A round section of a ring wing."""

    x: float
    centre: Array
    radius: float
    thickness: float


@dataclass(slots=True)
class Cuts:
    """All sections of a mesh at some stations, from the foremost to the aftmost."""

    x: Array
    cores: list[list[Bit]] = field(default_factory=list)
    rest: list[list[Bit]] = field(default_factory=list)
    walls: list[Wall] = field(default_factory=list)
    wholes: list[Polygon] = field(default_factory=list)


def _section(loops: Sequence[Array], size: float) -> Polygon:
    from manifold3d import CrossSection, FillRule

    return CrossSection([np.ascontiguousarray(loop) for loop in loops], FillRule.Positive).simplify(FINEST * size)


def grown(polygon: Polygon, by: float) -> Polygon:
    """All points within a distance; with a negative one, all that have the polygon about them so far."""
    return polygon.offset(by, circular_segments=ROUND)


def _inscribed(polygon: Polygon) -> float:
    """Radius of the largest disc within, to 2 %."""
    low_y, low_z, high_y, high_z = polygon.bounds()
    low, high = 0.0, min(high_y - low_y, high_z - low_z) / 2.0
    if not polygon.offset(-0.98 * high).is_empty():
        return float(high)
    while high - low > 0.02 * high and high > 0.0:
        middle = (low + high) / 2.0
        low, high = (low, middle) if polygon.offset(-middle).is_empty() else (middle, high)
        if high < THIN * max(high_y - low_y, high_z - low_z):
            break
    return float(low)


def _wall(x: float, polygon: Polygon) -> tuple[Wall | None, Polygon]:
    """The ring that a section shows, and the section without it."""
    from manifold3d import CrossSection

    rings = polygons(polygon)
    outer = max(rings, key=lambda ring: float(np.ptp(ring, axis=0).prod()))
    holes = [ring for ring in rings if _area(ring) < 0.0]
    low, high = outer.min(axis=0), outer.max(axis=0)
    centre, radius = (low + high) / 2.0, float((high - low).mean() / 2.0)
    disc = np.pi * radius**2
    if not holes or -sum(map(_area, holes)) < HOLLOW * disc or abs(_area(outer) / disc - 1.0) > RINGLIKE:
        return None, polygon
    if np.abs((high - low) / (2.0 * radius) - 1.0).max() > RINGLIKE:
        return None, polygon
    reach = max(float(np.linalg.norm(hole - centre, axis=1).max()) for hole in holes)
    if radius - reach > WALL * radius:
        return None, polygon
    inner = CrossSection.circle((1.0 - FACETS) * reach, ROUND).translate((float(centre[0]), float(centre[1])))
    selected = [p for p in (polygon ^ inner).decompose() if p.area() > SPECK * disc]
    return Wall(x, centre, (radius + reach) / 2.0, radius - reach), CrossSection.compose(selected)


def _area(ring: Array) -> float:
    y, z = ring.T
    return float((y * np.roll(z, -1) - np.roll(y, -1) * z).sum() / 2.0)


def cuts_of(mesh: TriangleMesh, x: Array) -> Cuts:
    """Sections at falling stations, each as hulls and what stands out of them."""
    size = float(mesh.extents[1:].max())
    out = Cuts(x)
    try:
        sections = contours(mesh.vertices, mesh.faces, x)
    except ValueError:
        raise InputError("a mesh that is open", "a closed surface, whose sections are closed contours") from None
    for k, (at, loops) in enumerate(zip(x, sections, strict=True)):
        out.cores.append([])
        out.rest.append([])
        section = _section(loops, size)
        out.wholes.append(section)
        for whole in section.decompose():
            if whole.area() < GRAIN * size**2:
                continue
            wall, left = _wall(float(at), whole)
            out.walls += [] if wall is None else [wall]
            for one in [whole] if wall is None else left.decompose():
                if one.area() < GRAIN * size**2:
                    continue
                inscribed = _inscribed(one)
                cores = grown(grown(one, -OPENING * inscribed), OPENING * inscribed)
                if cores.area() < COMPACT * sum(c.hull().area() for c in cores.decompose()):
                    out.rest[-1].append(Bit(float(at), one, inscribed, step=k))
                    continue
                out.cores[-1] += [Bit(float(at), c, inscribed, True, k) for c in cores.decompose()]
                rest = (one - grown(cores, SKIN * inscribed)).decompose()
                out.rest[-1] += [Bit(float(at), r, inscribed, step=k) for r in rest if r.area() > CRUMB * one.area()]
    return out


def overlap(a: Bit, b: Bit) -> float:
    """Area that two pieces share, seen along x, m^2."""
    (ay, az, by, bz), (cy, cz, dy, dz) = a.polygon.bounds(), b.polygon.bounds()
    if ay > dy or cy > by or az > dz or cz > bz:
        return 0.0
    return float((a.polygon ^ b.polygon).area())


def tracks_of(cuts: Cuts) -> list[list[Bit]]:
    """Hulls: cores of consecutive stations that overlap each other most."""
    tracks: list[list[Bit]] = []
    before: list[Bit] = []
    for here in cuts.cores:
        pairs = sorted(((overlap(a, b), i, j) for i, a in enumerate(before) for j, b in enumerate(here)), reverse=True)
        taken: set[int] = set()
        for share, i, j in pairs:
            if share > 0.0 and before[i].next is None and j not in taken:
                before[i].next = here[j]
                here[j].owner = before[i].owner
                tracks[before[i].owner].append(here[j])
                taken.add(j)
        for bit in here:
            if bit.owner < 0:
                bit.owner = len(tracks)
                tracks.append([bit])
        before = here
    return tracks


def clusters_of(rest: list[list[Bit]]) -> list[list[Bit]]:
    """Appendages: bits of consecutive stations that overlap, in the order of their stations."""
    found: list[list[Bit]] = []
    before: list[Bit] = []
    for here in rest:
        for bit in here:
            joined = sorted({other.owner for other in before if overlap(bit, other) > 0.0})
            if not joined:
                joined = [len(found)]
                found.append([])
            first = joined[0]
            for other in joined[1:]:
                for moved in found[other]:
                    moved.owner = first
                found[first] += found[other]
                found[other] = []
            bit.owner = first
            found[first].append(bit)
        before = here
    return [cluster for cluster in found if cluster]


def merged(cluster: list[Bit]) -> list[Bit]:
    """One bit for each station, in their order."""
    by_step: dict[int, Bit] = {}
    for bit in sorted(cluster, key=lambda bit: bit.step):
        had = by_step.get(bit.step)
        by_step[bit.step] = (
            bit
            if had is None
            else Bit(bit.x, had.polygon + bit.polygon, max(had.inscribed, bit.inscribed), step=bit.step)
        )
    return list(by_step.values())


def centre_of(polygon: Polygon) -> Array:
    """Centre of area: y and z, m."""
    total, moment = 0.0, np.zeros(2)
    for ring in polygons(polygon):
        after = np.roll(ring, -1, axis=0)
        cross = ring[:, 0] * after[:, 1] - after[:, 0] * ring[:, 1]
        total += float(cross.sum()) / 2.0
        moment += ((ring + after) * cross[:, None]).sum(axis=0) / 6.0
    return moment / total


def reach(polygon: Polygon, origin: Array, way: Array) -> float:
    """How far a section reaches from a point along a direction, 0 where it does not meet the ray."""
    across, most = np.array([-way[1], way[0]]), 0.0
    for ring in polygons(polygon):
        offset = ring - origin
        s, t = offset @ way, offset @ across
        s1, t1 = np.concatenate((s[1:], s[:1])), np.concatenate((t[1:], t[:1]))  # many times faster than roll
        hit = (t <= 0.0) != (t1 <= 0.0)
        at = s[hit] + (s1 - s)[hit] * t[hit] / (t - t1)[hit]
        most = max(most, float(at.max(initial=0.0)))
    return most


def _crossed(polygon: Polygon, origin: Array, way: Array, level: float) -> Array:
    """Where the line across a direction, at a distance along it, crosses the edge of a section: distances aside."""
    across, found = np.array([-way[1], way[0]]), []
    for ring in polygons(polygon):
        offset = ring - origin
        s, t = offset @ way - level, offset @ across
        s1, t1 = np.concatenate((s[1:], s[:1])), np.concatenate((t[1:], t[:1]))  # many times faster than roll
        hit = (s <= 0.0) != (s1 <= 0.0)
        found.append(t[hit] + (t1 - t)[hit] * s[hit] / (s - s1)[hit])
    return np.concatenate(found)


def width(polygon: Polygon, origin: Array, way: Array, level: float) -> float:
    """How wide a section is at a distance along a direction."""
    found = _crossed(polygon, origin, way, level)
    return float(np.ptp(found)) if len(found) else 0.0


def middle_at(polygon: Polygon, origin: Array, way: Array, level: float) -> Array:
    """The middle of a section at a distance along a direction."""
    found = _crossed(polygon, origin, way, level)
    aside = (found.min() + found.max()) / 2.0 if len(found) else 0.0
    return np.asarray(origin + level * way + aside * np.array([-way[1], way[0]]))
