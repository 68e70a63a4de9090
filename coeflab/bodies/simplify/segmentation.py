"""Cutting a closed surface into its bodies: shells, a round hull, and what is attached to it.

The round hull inside a fused surface: its axis and its radius at every station, whatever is attached to it.

From the axis 72 rays look outward at each station; the median of the first surface they meet is the hull's radius as
long as appendages take up less than half the girth.

A solid cut into nearly convex pieces; arrays in, arrays out, with trimesh and V-HACD between.

A solid parted into what was united, along the sharp inward edges that seams leave.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from coeflab.bodies.mesh.mesh import mesh_integrals
from coeflab.bodies.mesh.solids import Solid, hull_of, oriented_box, pieces, revolved, simplified, solid, surface
from coeflab.core.types import Array, Faces, brief

RAYS = 72
ROUGH, FINE = 41, 161
ROUND_WITHIN = 0.05
NEAR_ROUND = 0.2
TURNS = 6


@brief
@dataclass(frozen=True, slots=True)
class RoundHull:
    """A body of revolution that fits inside a surface.

    Attributes
    ----------
    point : (3,) array
        On the axis, m.
    rotation : (3, 3) array
        Its first column is the axis.
    x, radius : (n,) arrays
        Stations from the point and radii, m; the longest run of stations with a radius above zero.
    roundness : float
        Share of the rays within 5 % of the median, weighted by section area; 1 for a body of revolution.
    """

    point: Array
    rotation: Array
    x: Array
    radius: Array
    roundness: float

    @property
    def volume(self) -> float:
        """m^3, by trapezia."""
        return float(np.pi * np.trapezoid(self.radius**2, self.x))

    def distance(self, points: Array) -> tuple[Array, Array]:
        """Station and distance from the axis of (n, 3) points, m."""
        local = (points - self.point) @ self.rotation
        return local[:, 0], np.hypot(local[:, 1], local[:, 2])


def frame(axis: Array) -> Array:
    """(3, 3) rotation whose first column is a unit axis."""
    other = np.eye(3)[int(np.argmin(np.abs(axis)))]
    second = other - axis * (other @ axis)
    second /= np.linalg.norm(second)
    return np.column_stack([axis, second, np.cross(axis, second)])


def _rays(local: Array, faces: Faces, station: float) -> Array:
    """(72,) distance from the axis to the first surface, m; zero where the ray starts outside."""
    above = local[:, 0] > station
    corner = above[faces]
    cut = faces[corner.any(axis=1) & ~corner.all(axis=1)]
    if not len(cut):
        return np.zeros(RAYS)
    side = above[cut]
    alone = np.where(side.sum(axis=1) == 1, np.argmax(side, axis=1), np.argmin(side, axis=1))
    rows = np.arange(len(cut))
    apex = local[cut[rows, alone]]
    ends = []
    for k in (1, 2):
        other = local[cut[rows, (alone + k) % 3]]
        share = (station - apex[:, 0]) / (other[:, 0] - apex[:, 0])
        ends.append(apex[:, 1:] + share[:, None] * (other[:, 1:] - apex[:, 1:]))
    angle = 2.0 * np.pi * (np.arange(RAYS) + 0.5) / RAYS
    along = np.column_stack([np.cos(angle), np.sin(angle)])
    across = np.column_stack([-along[:, 1], along[:, 0]])
    p, q = across @ ends[0].T, across @ ends[1].T
    with np.errstate(divide="ignore", invalid="ignore"):
        share = p / (p - q)
        reach = (1.0 - share) * (along @ ends[0].T) + share * (along @ ends[1].T)
    met = ((p > 0.0) != (q > 0.0)) & (reach > 0.0)
    first = np.min(np.where(met, reach, np.inf), axis=1)
    return np.where(met.sum(axis=1) % 2 == 1, first, 0.0)


def _circle(reach: Array) -> tuple[Array, float] | None:
    """Centre and radius of the circle through most ends of the rays; None where the section is not round."""
    angle = 2.0 * np.pi * (np.arange(RAYS) + 0.5) / RAYS
    middle = float(np.median(reach))
    for _ in range(4):
        near = (reach > 0.0) & (np.abs(reach - middle) < NEAR_ROUND * middle)
        if 2 * near.sum() <= RAYS:
            return None
        y, z = reach[near] * np.cos(angle[near]), reach[near] * np.sin(angle[near])
        design = np.column_stack([y, z, np.ones_like(y)])
        a, b, c = np.linalg.lstsq(design, y**2 + z**2, rcond=None)[0]
        centre = np.array([a, b]) / 2.0
        radius = float(np.sqrt(c + centre @ centre))
        middle = radius
        expected = centre[0] * np.cos(angle) + centre[1] * np.sin(angle) + radius
        near_circle = np.abs(reach - expected) < 0.05 * radius
        if 2 * near_circle.sum() > RAYS:
            reach = np.where(near_circle, reach, 0.0)
    return centre, radius


def _line(x: Array, y: Array, weight: Array) -> tuple[float, float]:
    """Offset and slope by least absolute distance, through reweighting."""
    scale: Array = weight
    fit: Array = np.zeros(2)
    for _ in range(12):
        design = np.column_stack([np.ones_like(x), x]) * scale[:, None]
        fit = np.asarray(np.linalg.lstsq(design, y * scale, rcond=None)[0], dtype=np.float64)
        distance = np.abs(y - fit[0] - fit[1] * x)
        scale = np.asarray(weight / np.sqrt(np.maximum(distance, 1e-6 * np.ptp(x))))
    return float(fit[0]), float(fit[1])


def _settled(vertices: Array, faces: Faces, axis: Array, point: Array) -> tuple[Array, Array]:
    """Axis and point moved into the middle of the sections."""
    for _ in range(TURNS):
        turn = frame(axis)
        local = (vertices - point) @ turn
        low, high = local[:, 0].min(), local[:, 0].max()
        found = []
        for x in low + (high - low) * (np.arange(ROUGH) + 0.5) / ROUGH:
            circle = _circle(_rays(local, faces, x))
            if circle is not None:
                found.append((x, *circle[0], circle[1]))
        if len(found) < 4:
            return axis, point
        x, y, z, radius = np.array(found).T
        (y0, dy), (z0, dz) = _line(x, y, radius), _line(x, z, radius)
        point = point + turn @ np.array([0.0, y0, z0])
        moved = turn @ np.array([1.0, dy, dz])
        axis = moved / np.linalg.norm(moved)
        if np.hypot(dy, dz) < 1e-6 and np.hypot(y0, z0) < 1e-6 * (high - low):
            break
    return axis, point


def _profile(vertices: Array, faces: Faces, axis: Array, point: Array) -> RoundHull | None:
    turn = frame(axis)
    local = (vertices - point) @ turn
    low, high = local[:, 0].min(), local[:, 0].max()
    x = (low + high) / 2.0 - (high - low) / 2.0 * np.cos(np.pi * (np.arange(FINE) + 0.5) / FINE)
    reach = np.array([_rays(local, faces, s) for s in x])
    radius = np.median(reach, axis=1)
    inside = np.r_[False, radius > 0.0, False].astype(int)
    starts, ends = np.flatnonzero(np.diff(inside) == 1), np.flatnonzero(np.diff(inside) == -1)
    if not len(starts):
        return None
    run = int(np.argmax(x[ends - 1] - x[starts]))
    here = slice(starts[run], ends[run])
    x, radius, reach = x[here], radius[here], reach[here]
    if len(x) < 4:
        return None
    round_share = np.mean(np.abs(reach - radius[:, None]) <= ROUND_WITHIN * radius[:, None], axis=1)
    return RoundHull(point, turn, x, radius, float(np.sum(round_share * radius**2) / np.sum(radius**2)))


def round_hull(vertices: Array, faces: Faces) -> RoundHull | None:
    """The best of the bodies of revolution about the three principal axes; None where no section is cut.

    Best means the largest roundness times the share of the volume that the body of revolution holds.
    """
    whole = mesh_integrals(vertices, faces)
    directions = np.linalg.eigh(whole.second_moments)[1][:, ::-1].T
    best, score = None, 0.0
    for axis in directions:
        leading = axis[int(np.argmax(np.abs(axis)))]
        found = _profile(vertices, faces, *_settled(vertices, faces, axis * np.sign(leading), whole.centre))
        if found is None:
            continue
        fitness = found.roundness * min(1.0, found.volume / whole.volume)
        if fitness > score + 1e-6:
            best, score = found, fitness
    return best


MARGIN = 1.02
ROUND_ENOUGH = 0.6
SMALLEST = 2e-4
INWARD, OUTWARD = 0.94, 1.01


@brief
@dataclass(frozen=True, slots=True)
class Segments:
    """Bodies that together fill a solid but for ``unassigned``, m^3, slivers too small to be bodies.

    ``cut`` says of each body whether it was cut from a hull.
    """

    bodies: tuple[Solid, ...]
    cut: tuple[bool, ...]
    unassigned: float


def without_overlap(shells: list[Solid]) -> list[Solid]:
    """The shells, each without what larger ones already hold."""
    out: list[Solid] = []
    held: Solid = None
    for shell in shells:
        if held is None:
            out, held = [shell], shell
            continue
        left = shell - held
        out.append(left)
        held = held + shell
    return out


def segments(of: Solid, smallest: float = SMALLEST) -> Segments:
    """Cut one shell into its round hull and its appendages.

    The hull's radius is found at stations along its axis (`round_hull`); the body of revolution 2 % wider is taken away
    and what is left falls into connected pieces. Each piece is extended inward through those 2 % to the hull's surface,
    within the convex hull of its footprint. Pieces below ``smallest`` of the volume stay with the hull. A shell without
    a round hull stays whole.

    Parameters
    ----------
    of : Solid
    smallest : float
        Share of the volume below which a piece is a sliver.
    """
    hull = round_hull(*surface(of))
    if hull is None or hull.roundness < ROUND_ENOUGH:
        return Segments((of,), (False,), 0.0)
    envelope = _revolved(hull, MARGIN)
    least = smallest * of.volume()
    outside = [p for p in pieces(of - envelope) if p.volume() > least]
    if not outside:
        return Segments((of,), (False,), 0.0)
    within = of ^ envelope
    beyond = of - _revolved(hull, 1.0)
    attached = []
    for piece in outside:
        root = _root(piece, beyond, hull)
        attached.append(pieces(piece + root)[0])
        within = within - root
    hulls = [p for p in pieces(within) if p.volume() > least]
    bodies = (*hulls, *attached)
    cut = (*(False for _ in hulls), *(True for _ in attached))
    return Segments(bodies, cut, float(of.volume() - sum(b.volume() for b in bodies)))


def _revolved(hull: RoundHull, margin: float) -> Solid:
    """The body of revolution; with a margin each station takes the largest radius of its neighbours."""
    x, radius = hull.x, hull.radius
    if margin > 1.0:
        padded = np.r_[radius[0], radius, radius[-1]]
        radius = margin * np.maximum(np.maximum(padded[:-2], padded[1:-1]), padded[2:])
        past = (margin - 1.0) * float(hull.radius.max())
        x, radius = np.r_[x[0] - past, x, x[-1] + past], np.r_[radius[0], radius, radius[-1]]
    return revolved(x, radius, hull.rotation, hull.point)


def _root(piece: Solid, beyond: Solid, hull: RoundHull) -> Solid:
    """What lies beyond the hull's surface under a piece's footprint, from that surface to just inside the piece."""
    points = surface(piece)[0]
    x, distance = hull.distance(points)
    foot = points[distance < 1.01 * MARGIN * np.interp(x, hull.x, hull.radius)]
    return beyond ^ hull_of(np.vstack([_scaled(foot, hull, INWARD), _scaled(foot, hull, OUTWARD)]))


def _scaled(points: Array, hull: RoundHull, share: float) -> Array:
    """Points moved to a share of their distance from the axis."""
    local = (points - hull.point) @ hull.rotation
    return np.asarray(hull.point + (local * [1.0, share, share]) @ hull.rotation.T)


CREASE = np.radians(35.0)


def patches(of: Solid) -> list[Solid]:
    """The bodies that were united into a solid, where sharp inward edges still show all of their seams.

    The surface is parted along edges whose faces meet inward by more than 35 degrees. Each part of it that loops of such
    edges bound is closed by fans from the middles of its loops, so that neighbours share them and the bodies fill the
    solid. The solid itself where it has no such part or one cannot be closed.

    Notes
    -----
    Seams of bodies united without fillet are such edges (the minima rule: Hoffman & Richards, Cognition 18, 1984).
    """
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    vertices, faces = surface(of)
    one, other, turn = _dihedral(vertices, faces)
    joined = turn > -CREASE
    count = len(faces)
    links = coo_array((np.ones(joined.sum()), (one[joined] // 3, other[joined] // 3)), shape=(count, count))
    parts, which = connected_components(links, directed=False)
    if parts == 1:
        return [of]
    out = []
    seam = which[one // 3] != which[other // 3]
    rim = np.concatenate([one[seam], other[seam]])
    start, end = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    for k in range(parts):
        own = rim[which[rim // 3] == k]
        points, corners = _capped(vertices, faces[which == k], start[own], end[own])
        try:
            result = solid(points, corners)
        except ValueError:
            return [of]
        if not result.volume() > 0.0:
            return [of]
        out.append(result)
    return sorted(out, key=lambda p: -p.volume())


def _dihedral(vertices: Array, faces: Faces) -> tuple[Faces, Faces, Array]:
    """Both half-edges of every edge, and the angle by which the surface turns there, rad; negative inward."""
    start, end = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    order = np.lexsort([start > end, np.maximum(start, end), np.minimum(start, end)])
    one, other = order[0::2], order[1::2]
    corner = vertices[faces]
    normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    along = vertices[end[one]] - vertices[start[one]]
    n, m = normal[one // 3], normal[other // 3]
    sine = np.einsum("ij,ij->i", np.cross(n, m), along)
    return one, other, np.arctan2(sine, np.linalg.norm(along, axis=1) * np.einsum("ij,ij->i", n, m))


def _capped(vertices: Array, faces: Faces, start: Faces, end: Faces) -> tuple[Array, Faces]:
    """A patch with a fan over each loop of its rim."""
    after: dict[int, list[int]] = {}
    for a, b in zip(start.tolist(), end.tolist(), strict=True):
        after.setdefault(a, []).append(b)
    points, fans = [vertices], [faces]
    while after:
        first = next(iter(after))
        loop, here = [first], first
        while here in after:
            there = after[here].pop()
            if not after[here]:
                del after[here]
            here = there
            if here == first:
                break
            loop.append(here)
        middle = sum(len(p) for p in points)
        ring = np.array(loop)
        points.append(vertices[ring].mean(axis=0)[None])
        fans.append(np.column_stack([np.roll(ring, -1), ring, np.full(len(ring), middle)]))
    return np.concatenate(points), np.concatenate(fans)


MOST_PLANES, MOST_CUTS, BENT = 24, 48, 0.03
MOST_PIECES = 200  # more come from a smooth body, which no plane parts


def notched(of: Solid) -> list[Solid]:
    """Nearly convex pieces, cut along the planes of faces that meet inward.

    Of the planes of both faces at each inward edge of more than 35 degrees the one is cut that leaves the least convex hulls
    together; where none makes them less, as of a frame, the one along which most inward edges lie (Chazelle's notches).
    Until no piece is more than 3 % below its hull, or has no such plane, or after 48 cuts. The solid as it is where over
    200 pieces come out: a smooth body bent inward.
    """
    out, rest = list[Solid](), [of]
    for _ in range(MOST_CUTS):
        bent = [p for p in rest if p.hull().volume() > (1.0 + BENT) * p.volume()]
        out += [p for p in rest if p.hull().volume() <= (1.0 + BENT) * p.volume()]
        if not bent:
            return out
        if len(out) + len(rest) > MOST_PIECES:
            return [of]
        worst = max(bent, key=lambda p: p.hull().volume() - p.volume())
        rest = [p for p in bent if p is not worst]
        tries = [
            [p for half in worst.split_by_plane(normal, offset) for p in pieces(half) if p.volume() > 0.0]
            for normal, offset in _planes(worst)
        ]
        tries = [parts for parts in tries if len(parts) > 1]
        if not tries:
            out.append(worst)
            continue
        sizes = [sum(p.hull().volume() for p in parts) for parts in tries]
        best = int(np.argmin(np.round(np.array(sizes) / sizes[0], 6)))
        rest += tries[best if sizes[best] < (1.0 - BENT / 10.0) * worst.hull().volume() else 0]
    return out + rest


def _planes(of: Solid) -> list[tuple[tuple[float, ...], float]]:
    """Planes of faces at inward edges, those of the longest edges first."""
    vertices, faces = surface(of)
    one, other, turn = _dihedral(vertices, faces)
    inward = turn < -CREASE
    start, end = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    long = np.linalg.norm(vertices[end[one]] - vertices[start[one]], axis=1)
    corner = vertices[faces]
    normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    size_of = np.linalg.norm(normal, axis=1)
    inward &= (size_of[one // 3] > 0.0) & (size_of[other // 3] > 0.0)
    normal /= np.where(size_of > 0.0, size_of, 1.0)[:, None]
    scale = float(np.ptp(vertices, axis=0).max())
    size: dict[tuple[float, ...], float] = {}
    for edges in (one[inward], other[inward]):
        for edge, length in zip(edges, long[inward], strict=True):
            n = normal[edge // 3]
            n = n * np.sign(n[int(np.argmax(np.abs(n)))])
            key = (*np.round(n, 4), round(float(n @ vertices[start[edge]]) / scale, 4))
            size[key] = size.get(key, 0.0) + float(length)
    ranked = sorted(size, key=lambda k: (-round(size[k], 9), k))[:MOST_PLANES]
    return [(tuple(map(float, key[:3])), float(key[3]) * scale) for key in ranked]


MOST_HULLS, VOXELS = 16, 400_000
HOLLOW = 0.03
FACES = 5_000
# Hulls of voxels lie up to a voxel inside on either side: 2.7 % of the size of a cube of VOXELS.
LARGER = 1.03


def convex_pieces(of: Solid, by_notches: bool = False) -> list[Solid]:
    """Pieces that hardly differ from their convex hulls and fill the solid but for slivers, the largest first.

    V-HACD (Mamou, through trimesh) gives up to 16 hulls on 400,000 voxels, which lie along the oriented box. Two are
    joined while the hull of both holds
    at most 3 % of the solid's volume from outside it, the pair that holds least first. The solid is cut along the
    hulls that are left, the largest first, each 3 % larger, since hulls of voxels lie a little within the surface. The
    same solid gives the same pieces. With ``by_notches`` the hulls are those of `notched`, which need no package.

    Raises
    ------
    ImportError
        Without the package vhacdx.
    """
    coarse = simplified(of, FACES)[0]
    turn = oriented_box(surface(of)[0], np.eye(3))[0]
    upright = coarse.transform(np.column_stack([turn.T, np.zeros(3)]))
    found = _joined([p.hull() for p in notched(upright)] if by_notches else _hulls(upright), upright, by_notches)
    hulls = [h.transform(np.column_stack([turn, np.zeros(3)])) for h in sorted(found, key=lambda h: -h.volume())]
    out, rest = [], of
    for hull in hulls:
        larger = hull if by_notches else _grown(hull)
        out += pieces(rest ^ larger)
        rest = rest - larger
    return sorted((p for p in out if not p.is_empty()), key=lambda p: -p.volume())


def _grown(hull: Solid) -> Solid:
    points = surface(hull)[0]
    middle = (points.min(axis=0) + points.max(axis=0)) / 2.0
    return hull_of(middle + LARGER * (points - middle))


def _hulls(of: Solid) -> list[Solid]:
    from trimesh import Trimesh
    from trimesh.decomposition import convex_decomposition

    mesh = Trimesh(*surface(of), process=False)
    found = convex_decomposition(mesh, maxConvexHulls=MOST_HULLS, resolution=VOXELS, asyncACD=False)
    result = [hull_of(np.asarray(h["vertices"], dtype=np.float64)) for h in found]
    return [h for h in result if h.volume() > 0.0]


def _joined(hulls: list[Solid], of: Solid, tight: bool = False) -> list[Solid]:
    """Hulls joined in pairs; ``tight``: only to what hardly holds anything from outside, by its own volume."""
    selected = dict(enumerate(hulls))
    pairs = {(i, j): _both(selected[i], selected[j], of) for i in selected for j in selected if i < j}
    while pairs:
        i, j = min(pairs, key=lambda pair: (pairs[pair][0], pair))
        hollow, both = pairs[i, j]
        if hollow > HOLLOW * (both.volume() if tight else of.volume()):
            if not tight:
                break
            del pairs[i, j]
            continue
        last = max(selected) + 1
        del selected[i], selected[j]
        pairs = {pair: value for pair, value in pairs.items() if not {i, j} & set(pair)}
        pairs |= {(k, last): _both(selected[k], both, of) for k in selected}
        selected[last] = both
    return list(selected.values())


def _both(a: Solid, b: Solid, of: Solid) -> tuple[float, Solid]:
    """Volume that the hull of two hulls holds outside the solid, m^3, and that hull."""
    both = hull_of(np.vstack([surface(a)[0], surface(b)[0]]))
    return float((both - of).volume()), both
