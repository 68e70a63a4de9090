"""Cutting a shell into its round hull and what is attached to it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from coeflab.bodies.mesh.solids import Solid, hull_of, pieces, revolved, surface
from coeflab.bodies.simplify.round_hull import RoundHull, round_hull
from coeflab.core.types import Array, brief

MARGIN = 1.02  # of the radius, cut away so that facets and fillets of the hull stay with it
ROUND_ENOUGH = 0.6  # share of rays on the circle: appendages may take the rest
SMALLEST = 2e-4  # of the volume: less is a sliver of the cut
FOOT = 1.01  # of the margin: points up to there are a piece's footprint
INWARD, OUTWARD = 0.94, 1.01  # of the radius: the footprint's hull reaches from and to there


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


def segments(body: Solid, smallest: float = SMALLEST) -> Segments:
    """Cut one shell into its round hull and its appendages.

    The hull's radius is found at stations along its axis (`round_hull`); the body of revolution 2 % wider is taken away
    and what is left falls into connected pieces. Each piece is extended inward through those 2 % to the hull's surface,
    within the convex hull of its footprint. Pieces below ``smallest`` of the volume stay with the hull. A shell without
    a round hull stays whole.

    Parameters
    ----------
    body : Solid
    smallest : float
        Share of the volume below which a piece is a sliver.
    """
    hull = round_hull(*surface(body))
    if hull is None or hull.roundness < ROUND_ENOUGH:
        return Segments((body,), (False,), 0.0)
    envelope = _revolved(hull, MARGIN)
    least = smallest * body.volume()
    outside = [p for p in pieces(body - envelope) if p.volume() > least]
    if not outside:
        return Segments((body,), (False,), 0.0)
    within = body ^ envelope
    beyond = body - _revolved(hull, 1.0)
    attached = []
    for piece in outside:
        root = _root(piece, beyond, hull)
        attached.append(pieces(piece + root)[0])
        within = within - root
    hulls = [p for p in pieces(within) if p.volume() > least]
    bodies = (*hulls, *attached)
    cut = (*(False for _ in hulls), *(True for _ in attached))
    return Segments(bodies, cut, float(body.volume() - sum(b.volume() for b in bodies)))


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
    foot = points[distance < FOOT * MARGIN * np.interp(x, hull.x, hull.radius)]
    return beyond ^ hull_of(np.vstack([_scaled(foot, hull, INWARD), _scaled(foot, hull, OUTWARD)]))


def _scaled(points: Array, hull: RoundHull, share: float) -> Array:
    """Points moved to a share of their distance from the axis."""
    local = (points - hull.point) @ hull.rotation
    return np.asarray(hull.point + (local * [1.0, share, share]) @ hull.rotation.T)
