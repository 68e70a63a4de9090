"""A solid cut into nearly convex pieces; arrays in, arrays out, with trimesh and V-HACD between."""

from __future__ import annotations

import numpy as np

from coeflab.bodies.mesh.oriented_box import oriented_box
from coeflab.bodies.mesh.solids import Solid, hull_of, pieces, simplified, surface
from coeflab.bodies.simplify.seams import CREASE, dihedral

MOST_PLANES, MOST_CUTS, BENT = 24, 48, 0.03
MOST_PIECES = 200  # more come from a smooth body, which no plane parts


def cut_at_notches(body: Solid) -> list[Solid]:
    """Nearly convex pieces, cut along the planes of faces that meet inward.

    Of the planes of both faces at each inward edge of more than 35 degrees the one is cut that leaves the least convex hulls
    together; where none makes them less, as of a frame, the one along which most inward edges lie (Chazelle's notches).
    Until no piece is more than 3 % below its hull, or has no such plane, or after 48 cuts. The solid as it is where over
    200 pieces come out: a smooth body bent inward.
    """
    out, rest = list[Solid](), [body]
    for _ in range(MOST_CUTS):
        bent = [p for p in rest if p.hull().volume() > (1.0 + BENT) * p.volume()]
        out += [p for p in rest if p.hull().volume() <= (1.0 + BENT) * p.volume()]
        if not bent:
            return out
        if len(out) + len(rest) > MOST_PIECES:
            return [body]
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


def _planes(body: Solid) -> list[tuple[tuple[float, ...], float]]:
    """Planes of faces at inward edges, those of the longest edges first."""
    vertices, faces = surface(body)
    one, other, turn = dihedral(vertices, faces)
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


def convex_pieces(body: Solid, by_notches: bool = False) -> list[Solid]:
    """Pieces that hardly differ from their convex hulls and fill the solid but for slivers, the largest first.

    V-HACD (Mamou, through trimesh) gives up to 16 hulls on 400,000 voxels, which lie along the oriented box. Two are
    joined while the hull of both holds
    at most 3 % of the solid's volume from outside it, the pair that holds least first. The solid is cut along the
    hulls that are left, the largest first, each 3 % larger, since hulls of voxels lie a little within the surface. The
    same solid gives the same pieces. With ``by_notches`` the hulls are those of `cut_at_notches`, which need no package.

    Raises
    ------
    ImportError
        Without the package vhacdx.
    """
    coarse = simplified(body, FACES)[0]
    turn = oriented_box(surface(body)[0], np.eye(3))[0]
    upright = coarse.transform(np.column_stack([turn.T, np.zeros(3)]))
    found = _merged_hulls(
        [p.hull() for p in cut_at_notches(upright)] if by_notches else _hulls(upright), upright, by_notches
    )
    hulls = [h.transform(np.column_stack([turn, np.zeros(3)])) for h in sorted(found, key=lambda h: -h.volume())]
    out, rest = [], body
    for hull in hulls:
        larger = hull if by_notches else _grown(hull)
        out += pieces(rest ^ larger)
        rest = rest - larger
    return sorted((p for p in out if not p.is_empty()), key=lambda p: -p.volume())


def _grown(hull: Solid) -> Solid:
    points = surface(hull)[0]
    middle = (points.min(axis=0) + points.max(axis=0)) / 2.0
    return hull_of(middle + LARGER * (points - middle))


def _hulls(body: Solid) -> list[Solid]:
    from trimesh import Trimesh
    from trimesh.decomposition import convex_decomposition

    mesh = Trimesh(*surface(body), process=False)
    found = convex_decomposition(mesh, maxConvexHulls=MOST_HULLS, resolution=VOXELS, asyncACD=False)
    result = [hull_of(np.asarray(h["vertices"], dtype=np.float64)) for h in found]
    return [h for h in result if h.volume() > 0.0]


def _merged_hulls(hulls: list[Solid], body: Solid, tight: bool = False) -> list[Solid]:
    """Hulls joined in pairs; ``tight``: only to what hardly holds anything from outside, by its own volume."""
    selected = dict(enumerate(hulls))
    pairs = {(i, j): _hull_of_two(selected[i], selected[j], body) for i in selected for j in selected if i < j}
    while pairs:
        i, j = min(pairs, key=lambda pair: (pairs[pair][0], pair))
        hollow, both = pairs[i, j]
        if hollow > HOLLOW * (both.volume() if tight else body.volume()):
            if not tight:
                break
            del pairs[i, j]
            continue
        last = max(selected) + 1
        del selected[i], selected[j]
        pairs = {pair: value for pair, value in pairs.items() if not {i, j} & set(pair)}
        pairs |= {(k, last): _hull_of_two(selected[k], both, body) for k in selected}
        selected[last] = both
    return list(selected.values())


def _hull_of_two(a: Solid, b: Solid, body: Solid) -> tuple[float, Solid]:
    """Volume that the hull of two hulls holds outside the solid, m^3, and that hull."""
    both = hull_of(np.vstack([surface(a)[0], surface(b)[0]]))
    return float((both - body).volume()), both
