"""The outline of any shape; of a mesh by its sections across x.

Cores of sections that overlap their neighbours are hulls, what stands out of them and is thin are foils, round walls are
ring wings. Where these hold too little of the volume or of the surface, or no hull is slender, the whole body is bluff. What is
neither is said in ``left_out``.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache
from itertools import pairwise
from typing import Any

import numpy as np

from coeflab.bodies.cuts import (
    SKIN,
    SPECK,
    Bit,
    Cuts,
    Wall,
    centre_of,
    clusters_of,
    cuts_of,
    grown,
    merged,
    overlap,
    tracks_of,
)  # fmt: skip
from coeflab.bodies.joined_foils import joined
from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.mesh.silhouettes import polygons
from coeflab.bodies.mesh_appendages import (
    FEWEST,
    SMALL,
    THICK,
    appendage_of,
    bluff_of,
    branched,
    edges_of,
    protrudes,
    way_of,
)
from coeflab.bodies.mirror_planes import PAIRED, mirror_planes, silhouettes, unpaired
from coeflab.bodies.outline import Bluff, Foil, Outline, RingWing, Sections, Unseen
from coeflab.bodies.outlining import SLENDER, of_parts, of_revolution, with_controls
from coeflab.bodies.pieces import HULL, Control
from coeflab.bodies.shape import Parts, Revolution, Shape
from coeflab.core.types import Array

CACHED = 8
STATIONS, FINE = 96, 64  # along the body; along each group of appendages
INSIDE = 1e-5  # of the length: where the end faces are cut
MAIN, SHARE = 0.25, 0.7  # inscribed radius of a hull over the largest; volume that is recognised
TO_RADIUS = 0.02  # of an inscribed radius: its error, so that bars of just a quarter do not hang on rounding
UNSEEN = 0.2  # of the surface: more that is neither hull nor flat fin, and the flow separates from the body as a whole
ENDS = 0.05  # of the largest section: thinner ends do not count as length
BLUNT, SHORT = 0.5, 3.0  # both end faces over the largest section, with a length under so many diameters: a box
SKID = 0.5  # of the hull: a plate as long as this along it is a skid
MOST_HULLS, MOST_CLUSTERS = 4, 40  # more is a frame
BENT = 0.25  # half the surface over the planform, less one: it is not flat


@lru_cache(CACHED)
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
    return of_parts(shape, controls) if isinstance(shape, Parts) else of_mesh(shape, controls)


def _ends(track: list[Bit], cuts: Cuts) -> tuple[float, float]:
    """Where a hull begins and ends: at the mesh's ends, else halfway to the next station."""
    first, last, x = track[0].step, track[-1].step, cuts.x
    fore = x[0] if first == 0 else (x[first] + x[first - 1]) / 2.0
    aft = x[-1] if last == len(x) - 1 else (x[last] + x[last + 1]) / 2.0
    return float(fore), float(aft)


def _hull(name: str, track: list[Bit], cuts: Cuts, gone: set[int]) -> Sections:
    """Sections of a hull, with the corners that the opening rounded, without its appendages (``gone``, ids of bits)."""
    rows = []
    for bit in track:
        polygon = bit.polygon
        for other in cuts.rest[bit.step]:
            around = grown(other.polygon, 1.5 * SKIN * bit.inscribed)
            if id(other) not in gone and (around ^ bit.polygon).area() > 0.0:
                polygon = polygon + (around ^ cuts.wholes[bit.step])
        rings = polygons(polygon)
        girth = sum(float(np.linalg.norm(np.roll(r, -1, axis=0) - r, axis=1).sum()) for r in rings[:1])
        points = np.concatenate(rings)
        rows.append((polygon.area(), *np.ptp(points, axis=0), girth, *centre_of(polygon)))
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
    cuts = cuts_of(mesh, _spaced(fore, aft, STATIONS))
    tracks = tracks_of(cuts)
    largest = max((bit.inscribed for track in tracks for bit in track), default=0.0)
    main = [t for t in tracks if len(t) > 2 and max(bit.inscribed for bit in t) >= (1.0 - TO_RADIUS) * MAIN * largest]
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
    clusters = [(c, merged(c)) for c in clusters_of(cuts.rest)]
    clusters = [(c, merged) for c, merged in clusters if _counts(merged, slender, _of(cuts.cores, slender))]
    if len(clusters) > MOST_CLUSTERS:
        return _all_bluff(mesh, f"{len(clusters)} parts stand out of it, as of a frame")
    gone = {id(bit) for c, _ in clusters for bit in c}
    rough = [merged for _, merged in clusters]
    names = [HULL] if len(slender) == 1 else [f"{HULL}_{i + 1}" for i in range(len(slender))]
    hulls = tuple(_hull(n, t, cuts, gone) for n, t in zip(names, slender, strict=True))
    foils, bluff, volume, left, surfaces, unseen_parts = _appendages(mesh, cuts, rough, slender, hulls)
    if (long := _length_over_width(hulls, foils, bluff)) < SLENDER:
        return _all_bluff(mesh, f"with what stands beside its hull it is {long:.2g} times as long as wide")
    volume += ring_volume + sum(float(-np.trapezoid(h.area, h.x)) for h in hulls)
    if volume < SHARE * mesh.volume:
        return _all_bluff(mesh, f"hulls and foils hold {volume / mesh.volume:.0%} of its volume only")
    if (unseen := _unseen(mesh, hulls, foils, rings, bluff, *surfaces)) > UNSEEN:
        return _all_bluff(mesh, f"{unseen:.0%} of its surface is neither hull nor flat fin")
    turned, more = with_controls(foils, controls)
    return Outline(
        hulls, turned, rings, bluff, mesh.integrals.area, mesh.volume, (*left, *more), unseen=tuple(unseen_parts)
    )


def _unseen(
    mesh: TriangleMesh, hulls: Sequence[Sections], foils: Sequence[Foil], rings: Sequence[RingWing],
    bluff: Sequence[Bluff], across: float, joining: float,
) -> float:  # fmt: skip
    """Share of a surface that its outline does not hold, with foils that a mirror plane of the solid says are none.

    ``across`` is the surface that stands across the planforms of foils, ``joining`` that of what joins hulls, m^2: it counts as
    seen up to as much as the hulls have themselves, as of a deck on two hulls. More is a frame.
    """
    area, size = mesh.integrals.area, float(mesh.extents.max())
    seen = sum(float(-np.trapezoid(h.girth, h.x) + h.area[0] + h.area[-1]) for h in hulls)
    seen += min(joining, seen)
    seen += sum(2.0 * f.area for f in foils) + sum(2.0 * np.pi * r.diameter * r.chord for r in rings)
    seen += sum(2.0 * float(b.areas.sum()) for b in bluff)
    single: dict[str, Foil] = {}
    planes = mirror_planes(mesh) if foils else (False, False, False)
    for axis in (1, 2):
        if planes[axis]:
            middle = float(mesh.centre_of_volume[axis])
            single |= {f.name: f for f in unpaired(foils, axis, middle, PAIRED * size)}
    return float((max(area - seen, across) + sum(2.0 * f.area for f in single.values())) / area)


def _of(cores: list[list[Bit]], tracks: list[list[Bit]]) -> list[list[Bit]]:
    """The cores of these hulls only."""
    known = {id(bit) for track in tracks for bit in track}
    return [[bit for bit in here if id(bit) in known] for here in cores]


def _spaced(fore: float, aft: float, count: int) -> Array:
    """Falling stations just within both ends, dense at these."""
    middle, half = (fore + aft) / 2.0, (fore - aft) / 2.0 * (1.0 - INSIDE)
    return np.asarray(middle + half * np.cos(np.pi * np.arange(count + 1) / count))


def _length_over_width(hulls: Sequence[Sections], foils: Sequence[Foil], bluff: Sequence[Bluff]) -> float:
    """Of a single hull with its bluff parts and the plates along it; fins do not count, and several hulls stand apart.

    A plate longer than `SKID` of the hull is no fin in the stream of a hull's stern, but a skid or a frame's side.
    """
    (hull,) = hulls if len(hulls) == 1 else (None,)
    if hull is None:
        return np.inf
    half = np.array([hull.breadth.max(), hull.depth.max()]) / 2.0
    middle = np.average(hull.centre, axis=0, weights=hull.area)
    low, high = [middle - half], [middle + half]
    for part in bluff:
        low.append(part.centre[1:] - part.half_extents[1:])
        high.append(part.centre[1:] + part.half_extents[1:])
    for foil in foils:
        if foil.root_chord > SKID * hull.length:
            low.append(np.minimum(foil.root, foil.tip)[1:])
            high.append(np.maximum(foil.root, foil.tip)[1:])
    return hull.length / float((np.max(high, axis=0) - np.min(low, axis=0)).max())


def _is_slender(track: list[Bit]) -> bool:
    """Long, and no box: a short one with both ends blunt."""
    area = np.array([bit.polygon.area() for bit in track])
    full = np.flatnonzero(area > ENDS * area.max())[[0, -1]]
    length, across = track[full[0]].x - track[full[-1]].x, np.sqrt(4.0 * area.max() / np.pi)
    blunt = min(area[full]) > BLUNT * area.max()
    return bool(length > (SHORT if blunt else SLENDER) * across)


def _all_bluff(mesh: TriangleMesh, why: str) -> Outline:
    """The whole body as one bluff part, with its silhouettes."""
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    whole = Bluff(
        "body", "mesh", (low + high) / 2.0, np.eye(3), (high - low) / 2.0, silhouettes(mesh), mesh.integrals.projected
    )
    return Outline(
        (), (), (), (whole,), mesh.integrals.area, mesh.volume, (f"single parts: {why}, all of it is one bluff part",)
    )


def _nearest(track: list[Bit], x: float) -> Bit | None:
    """The bit of a hull at a place, if it reaches there."""
    spacing = max((a.x - b.x for a, b in pairwise(track)), default=0.0)
    found = min(track, key=lambda bit: abs(bit.x - x))
    return found if abs(found.x - x) <= spacing else None


def _own_track(cluster: list[Bit], tracks: list[list[Bit]]) -> list[Bit]:
    """The hull that a cluster stands on: the nearest over its stations."""
    points = np.concatenate([bit.points for bit in cluster])
    middle = (cluster[0].x + cluster[-1].x) / 2.0

    def distance(track: list[Bit]) -> float:
        bit = min(track, key=lambda b: abs(b.x - middle))
        return float(np.linalg.norm(points - centre_of(bit.polygon), axis=1).min()) - bit.inscribed

    return min(tracks, key=distance)


def _counts(cluster: list[Bit], tracks: list[list[Bit]], cores: list[list[Bit]]) -> bool:
    """Large enough, and it stands out of its hull where it is largest."""
    largest = max(cluster, key=lambda bit: float(bit.polygon.area()))
    track = _own_track(cluster, tracks)
    if not protrudes(largest, cores[largest.step]):
        return False
    size = max(float(np.linalg.norm(np.ptp(b.points, axis=0))) for b in cluster)
    return size > SMALL * max(b.inscribed for b in track)


def _appendages(
    mesh: TriangleMesh, cuts: Cuts, rough: list[list[Bit]], tracks: list[list[Bit]], hulls: tuple[Sections, ...]
) -> tuple[list[Foil], tuple[Bluff, ...], float, list[str], tuple[float, float], list[Unseen]]:
    """Each cluster by finer sections of its own; volume of all, what is left out; surface across planforms, and of joints; areas unseen."""
    unseen: list[Unseen] = []
    foils: list[Foil] = []
    bluff: list[Bluff] = []
    left: list[str] = []
    volume = across = joining = 0.0
    for fore, aft in _ranges(cuts.x, [(c[0].step, c[-1].step) for c in rough]):
        fine = cuts_of(mesh, np.linspace(fore, aft, FINE + 1) * 1.0)
        for step, here in enumerate(fine.cores):
            for bit in here:
                of_hull = [
                    n
                    for t in tracks
                    if (n := _nearest(t, bit.x)) is not None and overlap(bit, n) > 0.5 * bit.polygon.area()
                ]
                if not of_hull or bit.inscribed < 0.5 * min(n.inscribed for n in of_hull):
                    fine.rest[step].append(bit)
                    bit.core = False
        selected = [[bit for bit in here if bit.core] for here in fine.cores]
        cores = [bit for here in selected for bit in here]
        found_here = [merged(c) for c in clusters_of(fine.rest)]
        for cluster in _put_together(
            [c for c in found_here if len(c) >= FEWEST and _counts(c, tracks, selected)], tracks, hulls
        ):
            if _joins(cluster, tracks):
                y, z = (round(float(c), 9) + 0.0 for c in centre_of(cluster[len(cluster) // 2].polygon))
                ends = f"x = {cluster[0].x:.3g} to {cluster[-1].x:.3g} m at y = {y:.3g}, z = {z:.3g} m"
                left.append(f"what joins two hulls, {ends}")
                joint, _ = bluff_of("what joins two hulls", cluster)
                unseen.append(Unseen(joint.name, joint.centre, joint.areas))
                volume += float(-np.trapezoid([b.polygon.area() for b in cluster], [b.x for b in cluster]))
                joining += float(-np.trapezoid([edges_of(b) for b in cluster], [b.x for b in cluster]))
                continue
            track = _own_track(cluster, tracks)
            near = [bit for bit in cores if (n := _nearest(track, bit.x)) is not None and overlap(bit, n) > 0.0]
            hull = hulls[tracks.index(track)]
            for found in branched(cluster, hull, near) or [appendage_of(cluster, hull, near)]:
                if found.volume < SPECK * SPECK * mesh.volume or (
                    found.foil is None and found.volume < SPECK * mesh.volume
                ):
                    continue
                volume += found.volume
                if found.foil is not None and found.foil.thickness <= THICK:
                    foils.append(found.foil)
                    if found.bent > BENT:
                        across += 2.0 * found.bent * found.foil.area
                        more = f"its planform leaves out {found.bent:.0%}"
                        unseen.append(_across(found.foil, found.bent))
                        left.append(f"what stands across {found.foil.name} at x = {found.foil.root[0]:.3g} m: {more}")
                else:
                    bluff.append(found.bluff)
    return _numbered(foils), tuple(_numbered(bluff)), volume, left, (across, joining), unseen


def _put_together(clusters: list[list[Bit]], tracks: list[list[Bit]], hulls: tuple[Sections, ...]) -> list[list[Bit]]:
    """Clusters with the pieces of one foil as one: a stub and its blade, a fin and its flap."""

    def stand(bits: list[Bit]) -> tuple[Array, Array]:
        hull = hulls[tracks.index(_own_track(bits, tracks))]
        at = float(np.clip((bits[0].x + bits[-1].x) / 2.0, hull.x[-1], hull.x[0]))
        return way_of(bits, np.array([np.interp(at, hull.x[::-1], hull.centre[::-1, i]) for i in (0, 1)]))

    def one_foil(bits: list[Bit]) -> bool:
        foil = appendage_of(bits, hulls[tracks.index(_own_track(bits, tracks))], []).foil
        return foil is not None and foil.thickness <= THICK

    return joined(clusters, stand, one_foil)


def _across(foil: Foil, bent: float) -> Unseen:
    """What stands across a foil: so much of its area, facing along its span."""
    out = (foil.tip - foil.root) * np.array([0.0, 1.0, 1.0])
    areas = bent * foil.area * np.abs(out) / np.linalg.norm(out)
    return Unseen(f"what stands across {foil.name}", (foil.root + foil.tip) / 2.0, areas)


def _joins(cluster: list[Bit], tracks: list[list[Bit]]) -> bool:
    """At some station it meets two hulls."""
    for bit in cluster:
        around = grown(bit.polygon, 3.0 * SKIN * bit.inscribed)
        near = [n for t in tracks if (n := _nearest(t, bit.x)) is not None]
        if sum((around ^ n.polygon).area() > 0.0 for n in near) > 1:
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


def _rings(mesh: TriangleMesh, cuts: Cuts) -> tuple[tuple[RingWing, ...], float]:
    """Ring wings, each by finer sections of its own, and their volume."""
    groups: list[list[Wall]] = []
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
        fine = [w for w in cuts_of(mesh, np.linspace(fore, aft, FINE + 1)).walls if abs(w.radius - group[0].radius) < 0.4 * w.radius
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
