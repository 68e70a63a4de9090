"""Outlines of bodies seen from one side; arrays in, arrays out, with manifold3d's polygons between."""

from __future__ import annotations

from typing import Any

import numpy as np

from coeflab.core.types import Array, Faces

Outline = Any
RESOLUTION = 1e-4


def mesh_outline(vertices: Array, faces: Faces, view: Array) -> Outline:
    """The silhouette of a surface.

    Parameters
    ----------
    vertices, faces : arrays
    view : (2, 3) array
        The picture's axes, across and up, in the outer ones.

    Notes
    -----
    The union of the projected faces; of a closed surface the faces that look toward the viewer are enough.
    """
    from manifold3d import CrossSection, FillRule

    flat = vertices @ view.T
    a, b, c = (flat[faces[:, k]] for k in range(3))
    turn = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
    seen = np.stack([a, b, c], axis=1)[turn > 1e-12 * float(np.prod(np.ptp(flat, axis=0)))]
    whole = CrossSection(list(seen), FillRule.Positive)
    return whole.simplify(RESOLUTION * float(np.ptp(flat, axis=0).max()))


def convex_outline(points: Array, view: Array) -> Outline:
    """The silhouette of a convex body from (n, 3) points on it."""
    from manifold3d import CrossSection

    return CrossSection.hull_points(points @ view.T)


def polygons(outline: Outline) -> list[Array]:
    """Closed (n, 2) rings, outer ones counter-clockwise and holes clockwise."""
    return [np.asarray(ring, dtype=float) for ring in outline.to_polygons()]


def facets_outline(flat: Array) -> Outline:
    """What (n, 4, 2) projected facets that turn counter-clockwise cover together."""
    from manifold3d import CrossSection, FillRule

    return CrossSection(list(flat), FillRule.Positive)


def ring(points: Array) -> Outline:
    """The outline along (n, 2) points, counter-clockwise."""
    from manifold3d import CrossSection

    return CrossSection([points])


def hatched(outline: Outline, apart: float, wide: float) -> Outline:
    """Stripes within an outline, rising to the right.

    Parameters
    ----------
    outline : Outline
    apart, wide : float
        From one stripe to the next along x, and their width along it, in units of the outline.
    """
    from manifold3d import CrossSection

    low_x, low_y, high_x, high_y = outline.bounds()
    tall = high_y - low_y
    first, last = int(np.floor((low_x - tall) / apart)), int(np.ceil(high_x / apart))
    stripe = np.array([[0.0, low_y], [wide, low_y], [wide + tall, high_y], [tall, high_y]])
    stripes = [stripe + np.array([k * apart, 0.0]) for k in range(first, last + 1)]
    return outline ^ CrossSection(stripes)
