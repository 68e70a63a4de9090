"""Rings too thin for panels on both of their faces, as sheets of dipoles on the surface midway between these."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.outline import RingWing

AROUND, LEAST = 48, 2


def ring_sheets(rings: Sequence[RingWing]) -> TriangleMesh:
    """The middle surface of rings about x, without thickness and with water on both sides.

    Parameters
    ----------
    rings : sequence of RingWing
    """
    corners, sheets, count = [], [], 0
    turn = 2.0 * np.pi * np.arange(AROUND) / AROUND
    for ring in rings:
        # The facets of a circle enclose less; its radius is that of equal area.
        radius = ring.diameter / 2.0 * np.sqrt(turn[1] / np.sin(turn[1]))
        steps = max(LEAST, round(ring.chord / (np.pi * ring.diameter / AROUND)))
        for x in np.linspace(ring.centre[0] + ring.chord / 4.0, ring.centre[0] - 0.75 * ring.chord, steps + 1):
            y, z = (radius * way(turn) + c for way, c in zip((np.cos, np.sin), ring.centre[1:], strict=True))
            corners.append(np.column_stack([np.full(AROUND, x), y, z]))
        for k in range(steps):
            one = count + k * AROUND + np.arange(AROUND)
            two = count + k * AROUND + (np.arange(AROUND) + 1) % AROUND
            sheets += [np.column_stack([one, two, two + AROUND]), np.column_stack([one, two + AROUND, one + AROUND])]
        count += (steps + 1) * AROUND
    return TriangleMesh(np.concatenate(corners), np.zeros((0, 3), dtype=np.int64), sheets=np.concatenate(sheets))
