"""A body in three views with its dimensions, datum, reference point, centres, hinges and thrusters."""

from __future__ import annotations

import io
from collections.abc import Iterator
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Drawing

from coeflab.bodies.body import Body
from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.mesh.meshing import meshed
from coeflab.bodies.mesh.solids import Surface
from coeflab.bodies.pieces import Control
from coeflab.bodies.shape import Parts, Plate, Revolution
from coeflab.core.errors import InputError
from coeflab.core.types import Array
from coeflab.report.document import Figure
from coeflab.report.figures.body import FRONT, SIDE, TOP
from coeflab.report.figures.body_view import Sheet
from coeflab.report.figures.outline_overlay import STYLES, drawn, overlay
from coeflab.report.figures.palette import COLOURS
from coeflab.report.figures.part_pictures import part_facets, picture_surface
from coeflab.report.figures.rulers import rulers
from coeflab.report.figures.svg import paper, settings, svg_text
from coeflab.report.figures.svg_file import sheet

WIDTH, MARGIN, GAP = 720.0, 16.0, 26.0
LEFT, BELOW, CAPTION, SIZES, KEY = 36.0, 26.0, 20.0, 24.0, 40.0
TALLEST, NARROWEST = 460.0, 80.0
PANELS, LETTER, INCH = 12_000, 6.8, 160
EDGE_ON = 0.1  # points: a plate seen from its edge
MARKS = {  # marker, colour, words
    "datum": ("+", "ink", "datum"),
    "reference": ("o", "a", "reference point"),
    "buoyancy": ("^", "c", "centre of buoyancy"),
    "gravity": ("v", "b", "centre of gravity"),
}


def three_views(body: Body) -> dict[str, bytes]:
    """Side, front and top view as an SVG and a PNG file, by their endings.

    Parameters
    ----------
    body : Body

    Raises
    ------
    InputError
        A body without a shape.
    """
    title = f"{body.name}: {body.title}" if body.title else body.name
    words = f"Three views of {body.name} with dimensions in metres, FRD, from the datum: {body.datum}."
    with settings():
        drawn = _drawn(body)
        svg = svg_text(drawn, "views", title, words)
        drawn.text(MARGIN / WIDTH, 0.01, title, fontsize=8.5, color=COLOURS["ink"])
        png = io.BytesIO()
        drawn.savefig(png, format="png", dpi=INCH, facecolor="white", metadata={"Software": "coeflab"})
    return {"svg": sheet([[Figure("views", svg, title, words, words)]], words), "png": png.getvalue()}


def surfaces_of(body: Body) -> Iterator[tuple[str, Surface]]:
    """Every piece with its name; plates are facets."""
    shape = body.require_shape()
    if isinstance(shape, Parts):
        for part in shape.parts:
            facets = part_facets(part)
            corners = facets.reshape(-1, 3)
            k = 4 * np.arange(len(facets))[:, None]
            faces = np.concatenate([k + np.array(corner) for corner in ((0, 1, 2), (0, 2, 3))])
            if isinstance(part.form, Plate):
                faces = np.concatenate([faces, faces[:, ::-1]])
            yield part.name, (corners, faces)
        return
    if isinstance(shape, Revolution) or not body.pieces:
        whole = shape if isinstance(shape, TriangleMesh) else meshed(shape, PANELS)
        yield "hull", picture_surface(whole)
        if len(whole.sheets):  # both sides are seen
            yield "sheets", (whole.vertices, np.concatenate([whole.sheets, whole.sheets[:, ::-1]]))
        return
    for piece in body.pieces:
        yield piece.name, picture_surface(piece.surface(PANELS))


def _drawn(body: Body) -> Drawing:
    surfaces = list(surfaces_of(body))
    points = np.concatenate([vertices for _, (vertices, _) in surfaces])
    if not len(points):
        raise InputError(f"{body.name}, which shows nothing", "a shape")
    size = np.maximum(np.ptp(points, axis=0), 1e-3 * float(np.ptp(points, axis=0).max()))
    across = WIDTH - 2.0 * (MARGIN + LEFT) - GAP - LEFT
    scale = min(
        TALLEST / float(size[1] + size[2]), across / float(size[0] + max(size[1], NARROWEST / across * size[0]))
    )
    rows = [scale * float(size[2]) + CAPTION + BELOW + SIZES, scale * float(size[1]) + CAPTION + BELOW + SIZES]
    height = 2.0 * MARGIN + sum(rows) + GAP + KEY
    figure, axes = paper(WIDTH, height)
    tops = height - MARGIN, height - MARGIN - rows[0] - GAP
    first, second = MARGIN + LEFT, MARGIN + 2.0 * LEFT + scale * float(size[0]) + GAP
    for view, left, top in ((SIDE, first, tops[0]), (FRONT, second, tops[0]), (TOP, first, tops[1])):
        flat = points @ view.axes[:2].T * scale
        move = np.array([left - flat[:, 0].min(), top - CAPTION - SIZES - flat[:, 1].max()])
        one = Sheet(axes, view, scale, move, float(np.ptp(points, axis=0).max()))
        axes.text(left - LEFT, top - 8.0, view.title, fontsize=8.5, color=COLOURS["muted"])
        for _, surface in sorted(surfaces, key=lambda s: float(np.mean(s[1][0] @ view.axes[2]))):
            one.outline(surface)
            flat = one.on_paper(surface[0])
            if np.ptp(flat, axis=0).min() < EDGE_ON:
                axes.plot(
                    *flat[[int(flat.sum(axis=1).argmin()), int(flat.sum(axis=1).argmax())]].T,
                    color=COLOURS["ink"],
                    linewidth=1.4,
                )
        if body.outline is not None:
            overlay(one, body.outline, names=view is not FRONT)
        rulers(one, points)
        _size(one, points)
        for control in body.controls:
            _hinge(one, control, surfaces)
        for thruster in body.thrusters:
            _thrust(one, thruster.place, thruster.axis, float(size[0]))
        for name, place in _places(body).items():
            _mark(axes, name, *one.on_paper(place))
    _key(axes, body, MARGIN + 6.0)
    return figure


def _places(body: Body) -> dict[str, Array]:
    """Points that are marked, m, FRD, from the datum."""
    out = {"datum": np.zeros(3), "reference": body.reference_point}
    first = next(iter(body.configurations), None)
    if first is not None and first.centre_of_buoyancy is not None:
        out["buoyancy"] = first.centre_of_buoyancy
    if body.mass_model is not None:
        out["gravity"] = body.mass_model.centre
    return out


def _mark(axes: Axes, name: str, x: float, y: float) -> None:
    marker, colour, _ = MARKS[name]
    axes.plot(
        [x],
        [y],
        marker=marker,
        color=COLOURS[colour],
        markerfacecolor="none",
        markersize=7.0,
        markeredgewidth=1.2,
        zorder=5,
    )


def _size(one: Sheet, points: Array) -> None:
    """The largest extent across the view, over it."""
    flat = one.on_paper(points)
    (left, _), (right, top) = flat.min(axis=0), flat.max(axis=0)
    level = top + 8.0
    style: dict[str, Any] = {"color": COLOURS["ink"], "linewidth": 0.7, "zorder": 3}
    one.axes.plot([left, right], [level, level], marker="|", markersize=6.0, **style)
    one.axes.text(
        (left + right) / 2.0,
        level + 3.0,
        f"{(right - left) / one.scale:.4g} m",
        ha="center",
        fontsize=8.0,
        color=COLOURS["ink"],
    )
    if one.view is FRONT:
        low, side = float(flat[:, 1].min()), right + 8.0
        one.axes.plot([side, side], [low, top], marker="_", markersize=6.0, **style)
        middle = (low + top) / 2.0
        one.axes.text(
            side + 3.0, middle, f"{(top - low) / one.scale:.4g} m", fontsize=8.0, color=COLOURS["ink"], va="center"
        )


def _hinge(one: Sheet, control: Control, surfaces: list[tuple[str, Surface]]) -> None:
    """The hinge as far as its parts reach along it, with the name of the angle."""
    own = [vertices for name, (vertices, _) in surfaces if name in control.parts]
    if not own:
        return
    along = (np.concatenate(own) - control.hinge) @ control.axis
    ends = one.on_paper(control.hinge + np.outer([along.min(), along.max()], control.axis))
    style: dict[str, Any] = {
        "color": COLOURS["d"],
        "linewidth": 1.2,
        "linestyle": (0.0, (4.0, 1.5, 1.0, 1.5)),
        "zorder": 4,
    }
    one.axes.plot(*ends.T, **style)
    if float(np.linalg.norm(ends[1] - ends[0])) > LETTER:
        x, y = ends[int(np.argmax(1e3 * ends[:, 1] - ends[:, 0]))]  # the upper end, of a level hinge the left one
        one.axes.text(x + 3.0, y + 2.0, control.name, fontsize=8.0, color=COLOURS["d"])


def _thrust(one: Sheet, place: Array, axis: Array, length: float) -> None:
    """An arrow along positive thrust; a dot where it points at the viewer."""
    start, end = one.on_paper(np.array([place, place + 0.06 * length * axis]))
    one.axes.plot(*start, marker="s", markersize=4.0, color=COLOURS["b"], zorder=5)
    if float(np.linalg.norm(end - start)) > 1.0:
        one.axes.annotate(
            "", end, start, arrowprops={"arrowstyle": "->", "color": COLOURS["b"], "linewidth": 1.2}, zorder=5
        )


def _key(axes: Axes, body: Body, y: float) -> None:
    """What the marks are."""
    x = MARGIN + 6.0
    for name in _places(body):
        _mark(axes, name, x, y + 3.0)
        words = MARKS[name][2]
        axes.text(x + 8.0, y, words, fontsize=8.5)
        x += 26.0 + 4.7 * len(words)
    kinds = {part.kind for part in drawn(body.outline)} if body.outline is not None else set()
    for kind, (colour, dash, words) in STYLES.items():
        if kind in kinds:
            axes.plot([x - 5.0, x + 5.0], [y + 3.0, y + 3.0], color=COLOURS[colour], linewidth=1.2, linestyle=dash)
            axes.text(x + 8.0, y, words, fontsize=8.5)
            x += 30.0 + 4.7 * len(words)
    for there, colour, words in ((body.controls, "d", "hinge"), (body.thrusters, "b", "thruster")):
        if there:
            axes.plot([x - 5.0, x + 5.0], [y + 3.0, y + 3.0], color=COLOURS[colour], linewidth=1.4)
            axes.text(x + 8.0, y, words, fontsize=8.5)
            x += 30.0 + 4.7 * len(words)
