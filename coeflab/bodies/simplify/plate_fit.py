"""A thin body as a rectangular plate; arrays in, arrays out."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from coeflab.bodies.mesh.integrals import mesh_integrals
from coeflab.bodies.mesh.oriented_box import smallest_rectangle
from coeflab.bodies.mesh.silhouettes import Outline, convex_outline, mesh_outline
from coeflab.bodies.mesh.solids import Surface
from coeflab.core.types import Array, brief
from coeflab.law.transforms import relabelled

STRIP, ACROSS, PREFERRED = 0.1, 0.3, 0.02


@brief
@dataclass(frozen=True, slots=True, eq=False)
class PlateFit:
    """Chord and span, m; attitude with the normal as third column; centre, m."""

    chord: float
    span: float
    rotation: Array
    centre: Array


def plate_fit(of: Surface, turn: Array) -> PlateFit:
    """The rectangle of the span and of the area, hence of the aspect ratio, that a body projects along its normal.

    The span is that at the middle of the area, so that a root that follows a tapering hull counts with its mean. The
    centre is that of the projected area, at the height of the volume's. The chord lies fore and aft unless another
    attitude covers 2 % more of the area: the principal axes, as of swept struts, or those of the smallest rectangle.

    Parameters
    ----------
    of : (vertices, faces)
        m.
    turn : (3, 3) array
        Its third column is the normal.
    """
    vertices, faces = of
    # Outlines are cut on a grid of fixed pitch, so that a small body is drawn large first.
    unit = float(np.max(np.ptp(vertices, axis=0)))
    found = _fitted((vertices / unit, faces), turn)
    return PlateFit(found.chord * unit, found.span * unit, found.rotation, found.centre * unit)


def _fitted(of: Surface, turn: Array) -> PlateFit:
    vertices, faces = of
    normal = turn[:, 2]
    local = vertices @ turn
    a, b, c = (local[faces[:, k], :2] for k in range(3))
    u, v = b - a, c - a
    weight = np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) / 4.0
    area, total = float(weight.sum()), a + b + c
    middle = weight @ total / (3.0 * area)
    second = sum((p - middle).T @ ((p - middle) * weight[:, None]) for p in (a, b, c))
    second = (second + (total - 3.0 * middle).T @ ((total - 3.0 * middle) * weight[:, None])) / (12.0 * area)
    centre = turn[:, :2] @ middle + normal * float(normal @ mesh_integrals(vertices, faces).centre)
    best, most = PlateFit(0.0, 0.0, turn, centre), -PREFERRED
    for flat in _attitudes(second, turn, vertices):
        axes = relabelled(np.column_stack([turn[:, :2] @ flat, normal]), normal=True)
        outline = mesh_outline(*of, axes[:, :2].T)
        at = centre @ axes[:, :2]
        span = _span(outline, at)
        if not span > 0.0:  # nothing there: a body bent about its own centre
            continue
        chord = area / span
        share = float((outline ^ _rectangle(at, chord, span)).area()) / area
        if share > most + PREFERRED:
            best, most = PlateFit(chord, span, axes, centre), share
    return best


def _rectangle(at: Array, chord: float, span: float) -> Outline:
    corners = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]) * [chord / 2.0, span / 2.0]
    return convex_outline(np.asarray(at) + corners, np.eye(2))


def _span(outline: Outline, at: Array) -> float:
    """Mean span of an outline over a strip of a tenth of its chord about a station, m."""
    low, _, high, top = outline.bounds()
    width = STRIP * (high - low)
    return float((outline ^ _rectangle(at, width, 4.0 * (top - outline.bounds()[1]))).area() / width)


def _attitudes(second: Array, turn: Array, vertices: Array) -> list[Array]:
    """(2, 2) axes within a plate, in the first two columns of ``turn``: fore and aft (athwart on a plate across x), the
    principal axes of its second moments, and the sides of the smallest rectangle.
    """
    ahead = turn[:, :2].T @ np.array([1.0, 0.0, 0.0])
    if np.linalg.norm(ahead) < ACROSS:
        ahead = turn[:, :2].T @ np.array([0.0, 1.0, 0.0])
    ahead /= np.linalg.norm(ahead)
    along = smallest_rectangle(vertices @ turn[:, :2])[0]
    return [np.column_stack([v, [-v[1], v[0]]]) for v in (ahead, np.linalg.eigh(second)[1][:, 1], along)]
