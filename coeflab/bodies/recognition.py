"""The outline of any shape; of a mesh by its sections across x.

Every section is opened by a disc of half its largest inscribed radius (Serra, Image Analysis and Mathematical Morphology,
1982): what is left is hull, what is cut off and thin is an appendage. Sections that overlap their neighbours are one piece.
A round section with a large hole is a ring wing. Where hulls and foils hold too little of the volume, or are not slender,
the whole body is bluff. What is neither is said in ``left_out``.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache
from itertools import pairwise
from typing import Any

import numpy as np

from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.mesh.solids import mesh_outline, polygons
from coeflab.bodies.outline import Bluff, Foil, Outline, RingWing, Sections
from coeflab.bodies.outlining import SLENDER, of_parts, of_revolution, with_controls
from coeflab.bodies.pieces import HULL, Control
from coeflab.bodies.shape import Parts, Revolution, Shape
from coeflab.bodies.strips import contours
from coeflab.core.errors import InputError
from coeflab.core.types import Array

KEPT = 8
STATIONS, FINE = 96, 64  # along the body; along each group of appendages
INSIDE = 1e-5  # of the length: where the end faces are cut
OPENING, SKIN, ROUND = 0.5, 0.02, 96  # of the inscribed radius; segments of a circle
COMPACT, MAIN, SHARE = (
    0.6,
    0.25,
    0.7,
)  # area over convex hull; inscribed radius over the largest; volume that is recognised
BLUNT, SHORT, ENDS = (
    0.5,
    3.0,
    0.05,
)  # thinner ends are no part of it; both end faces over the largest section, with a length under so many diameters: a box
SMALL, THICK = 0.1, 0.5  # span over the hull's radius; thickness over chord: more is bluff
HOLLOW, RINGLIKE, WALL = 0.25, 0.05, 0.4  # hole over the disc; deviation from a circle; wall over radius
FACETS, SPECK = 0.03, 1e-3  # of the hole's radius and of the disc: what facets of a ring leave within it
LEVELS, FEWEST = 12, 3
MOST_HULLS, MOST_CLUSTERS = 4, 40  # more is a frame
BENT, LOOSE = (
    0.25,
    0.35,
)  # half the surface over the planform; area of the straight trapezoid over the planform, less one

Polygon = Any


@lru_cache(KEPT)
def outline_of(shape: Shape, controls: tuple[Control, ...] = ()) -> Outline:
    """What semi-empirical methods see of a shape.

    Parameters
    ----------
    shape : Shape
    controls : tuple of Control
        What turns of it.
    """
    if isinstance(shape, Revolution):
        return of_revolution(shape)
    if isinstance(shape, Parts):
        return of_parts(shape, controls)
    return of_mesh(shape, controls)


@dataclass(slots=True)
class _Bit:
    """A connected piece of one section: of a hull (``core``) or of what stands out of it."""

    x: float
    polygon: Polygon
    inscribed: float = 0.0
    core: bool = False
    step: int = 0
    next: _Bit | None = None
    owner: int = -1

    @property
    def points(self) -> Array:
        """(n, 2) all its corners."""
        return np.concatenate(polygons(self.polygon))


@dataclass(slots=True)
class _Wall:
    """A round section of a ring wing."""

    x: float
    centre: Array
    radius: float
    thickness: float


@dataclass(slots=True)
class _Cuts:
    """All sections of a mesh at some stations, from the foremost to the aftmost."""

    x: Array
    cores: list[list[_Bit]] = field(default_factory=list)
    rest: list[list[_Bit]] = field(default_factory=list)
    walls: list[_Wall] = field(default_factory=list)
    wholes: list[Polygon] = field(default_factory=list)


def _section(loops: Sequence[Array], size: float) -> Polygon:
    from manifold3d import CrossSection, FillRule

    return CrossSection([np.ascontiguousarray(loop) for loop in loops], FillRule.Positive).simplify(1e-4 * size)


def _grown(polygon: Polygon, by: float) -> Polygon:
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
        if high < 1e-6 * max(high_y - low_y, high_z - low_z):
            break
    return float(low)


def _wall(x: float, polygon: Polygon) -> tuple[_Wall | None, Polygon]:
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
    kept = [p for p in (polygon ^ inner).decompose() if p.area() > SPECK * disc]
    return _Wall(x, centre, (radius + reach) / 2.0, radius - reach), CrossSection.compose(kept)


def _area(ring: Array) -> float:
    y, z = ring.T
    return float((y * np.roll(z, -1) - np.roll(y, -1) * z).sum() / 2.0)


def _cuts(mesh: TriangleMesh, x: Array) -> _Cuts:
    """Sections at falling stations, each as hulls and what stands out of them."""
    size = float(mesh.extents[1:].max())
    out = _Cuts(x)
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
            if whole.area() < 1e-8 * size**2:
                continue
            wall, left = _wall(float(at), whole)
            out.walls += [] if wall is None else [wall]
            for one in [whole] if wall is None else left.decompose():
                if one.area() < 1e-8 * size**2:
                    continue
                inscribed = _inscribed(one)
                cores = _grown(_grown(one, -OPENING * inscribed), OPENING * inscribed)
                if cores.area() < COMPACT * sum(c.hull().area() for c in cores.decompose()):
                    out.rest[-1].append(_Bit(float(at), one, inscribed, step=k))
                    continue
                out.cores[-1] += [_Bit(float(at), c, inscribed, True, k) for c in cores.decompose()]
                rest = (one - _grown(cores, SKIN * inscribed)).decompose()
                out.rest[-1] += [_Bit(float(at), r, inscribed, step=k) for r in rest if r.area() > 1e-6 * one.area()]
    return out


def _overlap(a: _Bit, b: _Bit) -> float:
    (ay, az, by, bz), (cy, cz, dy, dz) = a.polygon.bounds(), b.polygon.bounds()
    if ay > dy or cy > by or az > dz or cz > bz:
        return 0.0
    return float((a.polygon ^ b.polygon).area())


def _tracks(cuts: _Cuts) -> list[list[_Bit]]:
    """Hulls: cores of consecutive stations that overlap each other most."""
    tracks: list[list[_Bit]] = []
    before: list[_Bit] = []
    for here in cuts.cores:
        pairs = sorted(((_overlap(a, b), i, j) for i, a in enumerate(before) for j, b in enumerate(here)), reverse=True)
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


def _clusters(rest: list[list[_Bit]]) -> list[list[_Bit]]:
    """Appendages: bits of consecutive stations that overlap, in the order of their stations."""
    found: list[list[_Bit]] = []
    before: list[_Bit] = []
    for here in rest:
        for bit in here:
            joined = sorted({other.owner for other in before if _overlap(bit, other) > 0.0})
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


def _merged(cluster: list[_Bit]) -> list[_Bit]:
    """One bit for each station, in their order."""
    by_step: dict[int, _Bit] = {}
    for bit in sorted(cluster, key=lambda bit: bit.step):
        had = by_step.get(bit.step)
        by_step[bit.step] = (
            bit
            if had is None
            else _Bit(bit.x, had.polygon + bit.polygon, max(had.inscribed, bit.inscribed), step=bit.step)
        )
    return list(by_step.values())


def _ends(track: list[_Bit], cuts: _Cuts) -> tuple[float, float]:
    """Where a hull begins and ends: at the mesh's ends, else halfway to the next station."""
    first, last, x = track[0].step, track[-1].step, cuts.x
    fore = x[0] if first == 0 else (x[first] + x[first - 1]) / 2.0
    aft = x[-1] if last == len(x) - 1 else (x[last] + x[last + 1]) / 2.0
    return float(fore), float(aft)


def _hull(name: str, track: list[_Bit], cuts: _Cuts, gone: set[int]) -> Sections:
    """Sections of a hull, with the corners that the opening rounded, without its appendages (``gone``, ids of bits)."""
    rows = []
    for bit in track:
        polygon = bit.polygon
        for other in cuts.rest[bit.step]:
            grown = _grown(other.polygon, 1.5 * SKIN * bit.inscribed)
            if id(other) not in gone and (grown ^ bit.polygon).area() > 0.0:
                polygon = polygon + (grown ^ cuts.wholes[bit.step])
        rings = polygons(polygon)
        girth = sum(float(np.linalg.norm(np.roll(r, -1, axis=0) - r, axis=1).sum()) for r in rings[:1])
        points = np.concatenate(rings)
        rows.append((polygon.area(), *np.ptp(points, axis=0), girth, *_centre(polygon)))
    table = np.array(rows)
    x = np.array([bit.x for bit in track])
    fore, aft = _ends(track, cuts)
    if fore > x[0]:
        x, table = np.r_[fore, x], np.vstack([table[:1], table])
    if aft < x[-1]:
        x, table = np.r_[x, aft], np.vstack([table, table[-1:]])
    area, breadth, depth = table[:, 0], table[:, 1], table[:, 2]
    like = np.abs(breadth - depth) + np.abs(np.sqrt(4.0 * area / np.pi) - (breadth + depth) / 2.0)
    straight = np.ptp(table[:, 4:6][area > 0.1 * area.max()], axis=0).max()
    is_round = bool(np.median(like / breadth.max()) < 0.02 and straight < 0.02 * breadth.max())
    return Sections(name, x, area, breadth, depth, table[:, 3], table[:, 4:6], is_round)


def _centre(polygon: Polygon) -> Array:
    total, moment = 0.0, np.zeros(2)
    for ring in polygons(polygon):
        after = np.roll(ring, -1, axis=0)
        cross = ring[:, 0] * after[:, 1] - after[:, 0] * ring[:, 1]
        total += float(cross.sum()) / 2.0
        moment += ((ring + after) * cross[:, None]).sum(axis=0) / 6.0
    return moment / total


def _reach(polygon: Polygon, origin: Array, way: Array) -> float:
    """How far a section reaches from a point along a direction, 0 where it does not meet the ray."""
    across, most = np.array([-way[1], way[0]]), 0.0
    for ring in polygons(polygon):
        offset = ring - origin
        s, t = offset @ way, offset @ across
        s1, t1 = np.roll(s, -1), np.roll(t, -1)
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
        s1, t1 = np.roll(s, -1), np.roll(t, -1)
        hit = (s <= 0.0) != (s1 <= 0.0)
        found.append(t[hit] + (t1 - t)[hit] * s[hit] / (s - s1)[hit])
    return np.concatenate(found)


def _widths(polygon: Polygon, origin: Array, way: Array, level: float) -> float:
    """How wide a section is at a distance along a direction."""
    found = _crossed(polygon, origin, way, level)
    return float(np.ptp(found)) if len(found) else 0.0


def _middle(polygon: Polygon, origin: Array, way: Array, level: float) -> Array:
    """The middle of a section at a distance along a direction."""
    found = _crossed(polygon, origin, way, level)
    aside = (found.min() + found.max()) / 2.0 if len(found) else 0.0
    return np.asarray(origin + level * way + aside * np.array([-way[1], way[0]]))


@dataclass(slots=True)
class _Appendage:
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
        for word, said in (
            (("upper", "lower")[int(way[1] > 0.0)], tall),
            (("port", "starboard")[int(way[0] > 0.0)], wide),
        )
        if said
    )


def _way(bits: list[_Bit], stand: Array) -> tuple[Array, Array]:
    """From where a cluster begins towards where it ends, and the point that its distances count from.

    The direction runs through the middles of its sections at a quarter and three quarters of their height.
    """
    areas = np.array([bit.polygon.area() for bit in bits])
    middle = np.average([_centre(bit.polygon) for bit in bits], axis=0, weights=areas) - stand
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
            ends = [_middle(bit.polygon, stand, way, float(s.min() + share * np.ptp(s))) for share in (0.25, 0.75)]
            total += ends[1] - ends[0]
        way = total if np.any(total) else way
    way = way / np.linalg.norm(way)
    return way, stand + middle - (middle @ way) * way


def _stands_out(bit: _Bit, cores: list[_Bit]) -> bool:
    """It reaches further from its hull than it is wide at its foot; a corner that the opening rounded does not."""
    skin = SKIN * bit.inscribed
    core = max(cores, key=lambda c: float((_grown(bit.polygon, 3.0 * skin) ^ c.polygon).area()), default=None)
    foot = 0.0 if core is None else float((_grown(bit.polygon, 3.0 * skin) ^ core.polygon).area()) / (2.0 * skin)
    if core is None or foot == 0.0:
        return True
    low, high = 0.0, float(np.ptp(bit.points, axis=0).max()) + 2.0 * skin
    while high - low > 0.1 * high:
        middle = (low + high) / 2.0
        low, high = (low, middle) if (bit.polygon - _grown(core.polygon, middle)).is_empty() else (middle, high)
    return low > foot


def _appendage(bits: list[_Bit], hull: Sections, track: list[_Bit]) -> _Appendage:
    """A cluster as a foil, or as something bluff where it is thick."""
    x = np.array([bit.x for bit in bits])
    at = float(np.clip((x[0] + x[-1]) / 2.0, hull.x[-1], hull.x[0]))
    stand = np.array([np.interp(at, hull.x[::-1], hull.centre[::-1, i]) for i in (0, 1)])
    areas = np.array([bit.polygon.area() for bit in bits])
    points = np.concatenate([bit.points for bit in bits])
    way, origin = _way(bits, stand)
    low, high = np.empty(len(bits)), np.empty(len(bits))
    by_step = {bit.x: bit for bit in track}
    for i, bit in enumerate(bits):
        s = (bit.points - origin) @ way
        low[i], high[i] = float(s.min()), float(s.max())
        core = by_step.get(bit.x)
        if core is not None and low[i] - (within := _reach(core.polygon, origin, way)) < 0.2 * bit.inscribed:
            low[i] = min(within, high[i])
    volume = float(-np.trapezoid(areas, x)) if len(x) > 1 else 0.0
    whole = np.ptp(points, axis=0)
    half = np.array([(x[0] - x[-1]) / 2.0, *whole / 2.0])
    middle = np.array([(x[0] + x[-1]) / 2.0, *((points.min(axis=0) + points.max(axis=0)) / 2.0)])
    side = [float(-np.trapezoid([np.ptp(bit.points[:, i]) for bit in bits], x)) for i in (1, 0)]
    shadow_x = float(areas.max()) if len(areas) else 0.0
    place = _words(way)
    bluff = Bluff(f"part_{place}", "mesh", middle, np.eye(3), half, np.array([shadow_x, *side]))
    foil = _foil(f"foil_{place}", x, low, high, bits, origin, way) if len(x) > 4 else None
    sides = (
        np.array(
            [
                sum(float(np.linalg.norm(np.roll(r, -1, axis=0) - r, axis=1).sum()) for r in polygons(b.polygon))
                for b in bits
            ]
        )
        / 2.0
    )
    bent = float(np.trapezoid(sides, x) / np.trapezoid(high - low, x)) - 1.0 if foil is not None else 0.0
    return _Appendage(foil, bluff, volume, bent)


def _foil(name: str, x: Array, low: Array, high: Array, bits: list[_Bit], origin: Array, way: Array) -> Foil | None:
    """Straight edges through the planform between the foremost and the aftmost station at each level."""
    tip, foot = float(high.max()), float(low.mean())
    clean = max(foot, min(float(low.max()), foot + 0.5 * (tip - foot)))
    levels = clean + (tip - clean) * (np.arange(LEVELS) + 0.5) / LEVELS * 0.95
    edges = []
    for level in levels:
        inside = np.flatnonzero((low <= level + 1e-12) & (high >= level))
        if not len(inside):
            return None
        edges.append((_edge(x, high, int(inside[0]), -1, level), _edge(x, high, int(inside[-1]), 1, level)))
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
    thickness = max(_widths(bit.polygon, origin, way, level) for bit in bits) / chord if chord > 0.0 else np.inf
    root, end = (
        np.array([float(fore(at)) - c / 4.0, *(origin + at * way)]) for at, c in ((foot, root_chord), (tip, tip_chord))
    )
    return Foil(name, root, end, fit * root_chord, fit * tip_chord, thickness, origin)


def _edge(x: Array, high: Array, at: int, step: int, level: float) -> float:
    """Where the tip line crosses a level beyond a station; past the last station half a step further."""
    other = at + step
    if not 0 <= other < len(x):
        return float(x[at] - step * (x[0] - x[-1]) / (len(x) - 1) / 2.0)
    if high[other] >= level or high[at] == high[other]:
        return float(x[at])
    return float(x[at] + (x[other] - x[at]) * (high[at] - level) / (high[at] - high[other]))


def of_mesh(mesh: TriangleMesh, controls: tuple[Control, ...] = ()) -> Outline:
    """Hulls, foils, ring wings and bluff parts of a closed mesh.

    Parameters
    ----------
    mesh : TriangleMesh
    controls : tuple of Control

    Raises
    ------
    InputError
        An open mesh.
    """
    fore, aft = float(mesh.vertices[:, 0].max()), float(mesh.vertices[:, 0].min())
    cuts = _cuts(mesh, _spaced(fore, aft, STATIONS))
    tracks = _tracks(cuts)
    largest = max((bit.inscribed for track in tracks for bit in track), default=0.0)
    main = [t for t in tracks if len(t) > 2 and max(bit.inscribed for bit in t) >= MAIN * largest]
    slender = [t for t in main if _is_slender(t)]
    rings, ring_volume = _rings(mesh, cuts)
    if not slender and ring_volume > SHARE * mesh.volume:
        return Outline((), (), rings, (), mesh.integrals.area, mesh.volume)
    if not slender:
        return _all_bluff(mesh, "no part of it is a slender hull")
    if len(slender) > MOST_HULLS:
        return _all_bluff(mesh, f"{len(slender)} long parts, as of a frame")
    demoted = [bit for track in tracks if track not in slender for bit in track]
    for bit in demoted:
        cuts.rest[bit.step].append(bit)
    for bits in cuts.rest:
        for bit in bits:
            bit.owner = -1
    clusters = [(c, _merged(c)) for c in _clusters(cuts.rest)]
    clusters = [(c, merged) for c, merged in clusters if _counts(merged, slender, _of(cuts.cores, slender))]
    if len(clusters) > MOST_CLUSTERS:
        return _all_bluff(mesh, f"{len(clusters)} parts stand out of it, as of a frame")
    gone = {id(bit) for c, _ in clusters for bit in c}
    rough = [merged for _, merged in clusters]
    names = [HULL] if len(slender) == 1 else [f"{HULL}_{i + 1}" for i in range(len(slender))]
    hulls = tuple(_hull(n, t, cuts, gone) for n, t in zip(names, slender, strict=True))
    foils, bluff, volume, left = _appendages(mesh, cuts, rough, slender, hulls)
    volume += ring_volume + sum(float(-np.trapezoid(h.area, h.x)) for h in hulls)
    if volume < SHARE * mesh.volume:
        return _all_bluff(mesh, f"hulls and foils hold {volume / mesh.volume:.0%} of its volume only")
    turned, more = with_controls(foils, controls)
    return Outline(hulls, turned, rings, bluff, mesh.integrals.area, mesh.volume, (*left, *more))


def _of(cores: list[list[_Bit]], tracks: list[list[_Bit]]) -> list[list[_Bit]]:
    """The cores of these hulls only."""
    known = {id(bit) for track in tracks for bit in track}
    return [[bit for bit in here if id(bit) in known] for here in cores]


def _spaced(fore: float, aft: float, count: int) -> Array:
    """Falling stations just within both ends, dense at these."""
    middle, half = (fore + aft) / 2.0, (fore - aft) / 2.0 * (1.0 - INSIDE)
    return np.asarray(middle + half * np.cos(np.pi * np.arange(count + 1) / count))


def _is_slender(track: list[_Bit]) -> bool:
    """Long, and no box: a short one with both ends blunt."""
    area = np.array([bit.polygon.area() for bit in track])
    full = np.flatnonzero(area > ENDS * area.max())[[0, -1]]
    length, across = track[full[0]].x - track[full[-1]].x, np.sqrt(4.0 * area.max() / np.pi)
    blunt = min(area[full]) > BLUNT * area.max()
    return bool(length > (SHORT if blunt else SLENDER) * across)


def _all_bluff(mesh: TriangleMesh, why: str) -> Outline:
    """The whole body as one bluff part, with its silhouettes."""
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    views = [np.eye(3)[[i, j]] for i, j in ((1, 2), (2, 0), (0, 1))]
    areas = np.array([mesh_outline(mesh.vertices, mesh.faces, view).area() for view in views])
    whole = Bluff("body", "mesh", (low + high) / 2.0, np.eye(3), (high - low) / 2.0, areas)
    return Outline(
        (), (), (), (whole,), mesh.integrals.area, mesh.volume, (f"single parts: {why}, all of it is one bluff part",)
    )


def _nearest(track: list[_Bit], x: float) -> _Bit | None:
    """The bit of a hull at a place, if it reaches there."""
    spacing = max((a.x - b.x for a, b in pairwise(track)), default=0.0)
    found = min(track, key=lambda bit: abs(bit.x - x))
    return found if abs(found.x - x) <= spacing else None


def _own_track(cluster: list[_Bit], tracks: list[list[_Bit]]) -> list[_Bit]:
    """The hull that a cluster stands on: the nearest over its stations."""
    points = np.concatenate([bit.points for bit in cluster])
    middle = (cluster[0].x + cluster[-1].x) / 2.0

    def distance(track: list[_Bit]) -> float:
        bit = min(track, key=lambda b: abs(b.x - middle))
        return float(np.linalg.norm(points - _centre(bit.polygon), axis=1).min()) - bit.inscribed

    return min(tracks, key=distance)


def _counts(cluster: list[_Bit], tracks: list[list[_Bit]], cores: list[list[_Bit]]) -> bool:
    """Large enough, and it stands out of its hull where it is largest."""
    largest = max(cluster, key=lambda bit: float(bit.polygon.area()))
    track = _own_track(cluster, tracks)
    if not _stands_out(largest, cores[largest.step]):
        return False
    size = max(float(np.linalg.norm(np.ptp(b.points, axis=0))) for b in cluster)
    return size > SMALL * max(b.inscribed for b in track)


def _appendages(
    mesh: TriangleMesh, cuts: _Cuts, rough: list[list[_Bit]], tracks: list[list[_Bit]], hulls: tuple[Sections, ...]
) -> tuple[list[Foil], tuple[Bluff, ...], float, list[str]]:
    """Each cluster by finer sections of its own."""
    foils: list[Foil] = []
    bluff: list[Bluff] = []
    left: list[str] = []
    volume = 0.0
    for fore, aft in _ranges(cuts.x, [(c[0].step, c[-1].step) for c in rough]):
        fine = _cuts(mesh, np.linspace(fore, aft, FINE + 1) * 1.0)
        for step, here in enumerate(fine.cores):
            for bit in here:
                of_hull = [
                    n
                    for t in tracks
                    if (n := _nearest(t, bit.x)) is not None and _overlap(bit, n) > 0.5 * bit.polygon.area()
                ]
                if not of_hull or bit.inscribed < 0.5 * min(n.inscribed for n in of_hull):
                    fine.rest[step].append(bit)
                    bit.core = False
        kept = [[bit for bit in here if bit.core] for here in fine.cores]
        cores = [bit for here in kept for bit in here]
        for cluster in map(_merged, _clusters(fine.rest)):
            if len(cluster) < FEWEST or not _counts(cluster, tracks, kept):
                continue
            if _joins(cluster, tracks):
                y, z = _centre(cluster[len(cluster) // 2].polygon)
                ends = f"x = {cluster[0].x:.3g} to {cluster[-1].x:.3g} m at y = {y:.3g}, z = {z:.3g} m"
                left.append(f"what joins two hulls, {ends}")
                volume += float(-np.trapezoid([b.polygon.area() for b in cluster], [b.x for b in cluster]))
                continue
            track = _own_track(cluster, tracks)
            near = [bit for bit in cores if (n := _nearest(track, bit.x)) is not None and _overlap(bit, n) > 0.0]
            found = _appendage(cluster, hulls[tracks.index(track)], near)
            if found.volume < SPECK * SPECK * mesh.volume or (
                found.foil is None and found.volume < SPECK * mesh.volume
            ):
                continue
            volume += found.volume
            if found.foil is not None and found.foil.thickness <= THICK:
                foils.append(found.foil)
                if found.bent > BENT:
                    more = f"its planform leaves out {found.bent:.0%}"
                    left.append(f"what stands across {found.foil.name} at x = {found.foil.root[0]:.3g} m: {more}")
            else:
                bluff.append(found.bluff)
    return _numbered(foils), tuple(_numbered(bluff)), volume, left


def _joins(cluster: list[_Bit], tracks: list[list[_Bit]]) -> bool:
    """At some station it meets two hulls."""
    for bit in cluster:
        grown = _grown(bit.polygon, 3.0 * SKIN * bit.inscribed)
        near = [n for t in tracks if (n := _nearest(t, bit.x)) is not None]
        if sum((grown ^ n.polygon).area() > 0.0 for n in near) > 1:
            return True
    return False


def _ranges(x: Array, steps: list[tuple[int, int]]) -> list[tuple[float, float]]:
    """Ranges of stations, one step wider, that overlap: as one."""
    wide = sorted((max(first - 1, 0), min(last + 1, len(x) - 1)) for first, last in steps)
    out: list[tuple[int, int]] = []
    for first, last in wide:
        if out and first <= out[-1][1] and last - out[-1][0] <= 1.5 * max(last - first, out[-1][1] - out[-1][0]):
            out[-1] = out[-1][0], max(last, out[-1][1])
        else:
            out.append((first, last))
    return [(float(x[a]), float(x[b])) for a, b in out]


def _rings(mesh: TriangleMesh, cuts: _Cuts) -> tuple[tuple[RingWing, ...], float]:
    """Ring wings, each by finer sections of its own, and their volume."""
    groups: list[list[_Wall]] = []
    for wall in cuts.walls:
        for group in groups:
            last = group[-1]
            if (
                abs(last.radius - wall.radius) < 0.2 * wall.radius
                and np.linalg.norm(last.centre - wall.centre) < 0.2 * wall.radius
            ):
                group.append(wall)
                break
        else:
            groups.append([wall])
    found, volume = [], 0.0
    for i, group in enumerate(groups):
        at = [int(np.abs(cuts.x - wall.x).argmin()) for wall in group]
        (fore, aft), *_ = _ranges(cuts.x, [(at[0], at[-1])])
        step = (fore - aft) / FINE
        fine = [w for w in _cuts(mesh, np.linspace(fore, aft, FINE + 1)).walls if abs(w.radius - group[0].radius) < 0.4 * w.radius
                and np.linalg.norm(w.centre - group[0].centre) < 0.4 * w.radius]  # fmt: skip
        if len(fine) < 3:
            continue
        x = np.array([w.x for w in fine])
        chord = float(x[0] - x[-1]) + step
        quarter = float(x[0]) + step / 2.0 - chord / 4.0
        radius = float(np.interp(quarter, x[::-1], [w.radius for w in reversed(fine)]))
        centre = np.array([quarter, *np.mean([w.centre for w in fine], axis=0)])
        thickness = max(w.thickness for w in fine)
        volume += float(sum(2.0 * np.pi * w.radius * w.thickness for w in fine) * step)
        found.append(
            RingWing("ring" if len(groups) == 1 else f"ring_{i + 1}", centre, 2.0 * radius, chord, thickness / chord)
        )
    return tuple(found), volume


def _numbered(parts: list[Any]) -> list[Any]:
    """Names of their own, counted from fore to aft where several are called the same."""
    out = []
    names = [part.name for part in parts]
    for i, part in enumerate(parts):
        many = names.count(part.name) > 1
        out.append(replace(part, name=f"{part.name}_{names[:i].count(part.name) + 1}") if many else part)
    return out
