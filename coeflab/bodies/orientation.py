"""Whether a mesh lies as its axes say: longest ahead, what stands out of it up, its tail aft; and which axes would make it so.

A frame that is named, FLU or CFD, is a habit of a program, and a mesh that contradicts it stops what depends on it. Three
directions are a statement about this mesh and are taken as they stand.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from coeflab.bodies.body import Body
from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.outline import Outline, Sections
from coeflab.bodies.recognition import outline_of
from coeflab.bodies.shape import Shape
from coeflab.bodies.volume_moments import second_moments
from coeflab.core.axes import Axes, axes_of
from coeflab.core.errors import InputError
from coeflab.core.finding import Finding, Severity
from coeflab.core.texts import words
from coeflab.core.types import Array

LONGER = 1.1  # spread of the volume across over that along x: a disc or a square frame is as long as wide
FAR_LONGER = 3.0  # where slender hulls lie along x: those of a catamaran stand apart
LOPSIDED = (
    0.001  # of the depth: what stands out of a slender hull moves its centre of volume as far, a sail three times that
)
SIDEWAYS = 2.0  # so many times as far aside as up or down: a body with one thruster on one side does not lie on it
HEAVY_SIDE = 0.05  # of the depth: centre of volume of a body without a hull, off the middle
ENDS = 0.3  # of the length: fins there are of the bow, or of the tail
FULLER = 0.005  # of the length: centre of a hull's volume, off the middle
ABOUT_Z = np.diag([-1.0, -1.0, 1.0])
DIRECTIONS = ("x, forward", "y, starboard", "z, down")


def doubt(body: Body) -> Finding | None:
    """What contradicts the axes of a body's mesh, with the axes that do not; None where nothing does.

    Parameters
    ----------
    body : Body
    """
    shape, axes = body.shape, body.axes
    if shape is None or axes is None or not shape.volume > 0.0:
        return None
    spread = np.sqrt(np.diag(second_moments(shape)))
    widest = int(np.argmax(spread))
    outline = body.outline
    hulls = outline is not None and bool(outline.hulls)
    if spread[widest] > (FAR_LONGER if hulls else LONGER) * spread[0]:
        turn, phrases = _laid_along(shape, widest)
        ratio = float(spread[widest] / spread[0])
        return _finding(
            "orientation.across", body, axes, turn, ratio, LONGER, either=not phrases, along=DIRECTIONS[widest]
        )
    if outline is None:
        return None
    off, limit = _aside(shape, outline)
    side = int(np.argmax(np.abs(off)))
    tail = _tail_aft(outline)
    if side == 1 and off[1] > limit:
        return _finding("orientation.upside_down", body, axes, tail @ _upright(off, limit), float(off[1]), limit)
    if side == 0 and abs(off[0]) > max(limit, SIDEWAYS * abs(off[1])):
        way, turn = "starboard" if off[0] > 0.0 else "port", tail @ _upright(off, limit)
        return _finding("orientation.on_its_side", body, axes, turn, float(abs(off[0])), limit, towards=way)
    if tail[0, 0] < 0.0:
        return _finding("orientation.astern", body, axes, tail, None, None)
    return None


def require_orientation(body: Body) -> None:
    """Refuse a mesh whose named axes its shape contradicts.

    Parameters
    ----------
    body : Body

    Raises
    ------
    InputError
        With the axes that the shape suggests; not where three directions were stated.
    """
    if body.axes is None or body.axes.spelled:
        return
    found = doubt(body)
    if found is None:
        return
    text = words(found)
    raise InputError(text.statement, text.rule, column="axes", advice=text.advice)


def _finding(
    code: str, body: Body, axes: Axes, turn: Array, statistic: float | None, threshold: float | None, *,
    either: bool = False, **facts: str,
) -> Finding:  # fmt: skip
    better = axes_of(turn @ axes.rotation)
    other = f" or --axes {axes_of(ABOUT_Z @ turn @ axes.rotation).typed}, bow for stern" if either else ""
    severity = Severity.NOTE if axes.spelled and code != "orientation.across" else Severity.WARN
    return Finding.of(
        code, body.name, severity, statistic=statistic, threshold=threshold,
        advice=f"--axes {better.typed}{other}", stated=axes.name, own=axes.typed, better=better.typed, **facts,
    )  # fmt: skip


def _upright(off: Array, limit: float) -> Array:
    """(3, 3) turn about x that takes what stands out, along y and z, up; none below the limit."""
    turn, side = np.eye(3), int(np.argmax(np.abs(off)))
    if abs(off[side]) > limit:
        y, z = np.sign(off[side]) * np.eye(2)[side]
        turn[1:, 1:] = [[-z, y], [-y, -z]]
    return turn


def _aside(shape: Shape, outline: Outline) -> tuple[NDArray[np.float64], float]:
    """(2,) offset of the centre of volume along y and z, over the size across; and what counts."""
    middle = shape.centre_of_volume[1:]
    if outline.hulls:
        hull = max(outline.hulls, key=_volume)
        if len(outline.hulls) > 1:
            return np.zeros(2), LOPSIDED
        axis = np.average(hull.centre, axis=0, weights=hull.area)
        out = _standing_out(outline, axis)
        off = (middle - axis) / float(np.max(hull.depth))
        return np.where(np.sign(out) == np.sign(off), off, 0.0), LOPSIDED
    if not isinstance(shape, TriangleMesh):
        return np.zeros(2), HEAVY_SIDE
    low, high = shape.vertices.min(axis=0)[1:], shape.vertices.max(axis=0)[1:]
    return (middle - (low + high) / 2.0) / (high - low), HEAVY_SIDE


def _volume(hull: Sections) -> float:
    return float(-np.trapezoid(hull.area, hull.x))


def _standing_out(outline: Outline, axis: Array) -> NDArray[np.float64]:
    """(2,) moment of the areas that stand out of a hull about its axis, m^3; towards where they stand."""
    total = np.zeros(2)
    for foil in outline.foils:
        total += foil.area * ((foil.root + foil.tip)[1:] / 2.0 - axis)
    for part in outline.bluff:
        total += float(part.areas.sum()) * (part.centre[1:] - axis)
    return total


def _ahead(outline: Outline) -> int:
    """1 where the tail of the hull is aft, -1 where it is ahead, 0 where fins and fullness do not agree."""
    hull = max(outline.hulls, key=_volume)
    fore = hull.x[0] - ENDS * hull.length
    aft = hull.x[-1] + ENDS * hull.length
    middles = np.array([(f.root + f.tip)[0] / 2.0 for f in outline.foils])
    areas = np.array([f.area for f in outline.foils])
    ahead, behind = (float(areas[here].sum()) if len(areas) else 0.0 for here in (middles > fore, middles < aft))
    fins = int(np.sign(round(behind - ahead, 12))) if min(ahead, behind) < 0.5 * max(ahead, behind) else 0
    full = (
        float(np.average(hull.x, weights=hull.area * np.abs(np.gradient(hull.x)))) - (hull.x[0] + hull.x[-1]) / 2.0
    ) / hull.length
    fuller = int(np.sign(full)) if abs(full) > FULLER else 0
    return fins if fins == fuller else 0


def _tail_aft(outline: Outline) -> Array:
    """(3, 3) half a turn about z where the tail of a hull is ahead; else none."""
    return ABOUT_Z if outline.hulls and _ahead(outline) < 0 else np.eye(3)


def _laid_along(shape: Shape, long: int) -> tuple[Array, bool]:
    """(3, 3) turn that lays an axis along x: what stands out of it up, else the side that was up, its tail aft; and whether that shows."""
    turn = np.eye(3)[[long, (long + 1) % 3, (long + 2) % 3]]
    if long == 1:  # y, z, x to forward, starboard, down: z, which was down, stays so
        turn = np.array([[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    if not isinstance(shape, TriangleMesh):
        return turn, False
    laid = replace(shape, vertices=shape.vertices @ turn.T)
    outline = outline_of(laid)
    turn = _upright(*_aside(laid, outline)) @ turn
    return _tail_aft(outline) @ turn, bool(outline.hulls) and _ahead(outline) != 0
