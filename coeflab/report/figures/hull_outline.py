"""The outline of a body from the side and from above, with its centre of buoyancy and reference point."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from matplotlib.axes import Axes

from coeflab.bodies.body import Body
from coeflab.bodies.forms import Plate
from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.mesh.meshing import meshed
from coeflab.bodies.mesh.solids import Surface
from coeflab.bodies.shape import Parts
from coeflab.core.types import Array
from coeflab.report.document import Figure
from coeflab.report.figures.body import MARGIN, SIDE, TOP
from coeflab.report.figures.body_view import Sheet, View
from coeflab.report.figures.palette import COLOURS
from coeflab.report.figures.part_pictures import picture_surface
from coeflab.report.figures.svg import paper, settings, svg_text
from coeflab.report.notation import as_users_wrote

PANELS = 3000
WIDTH, TALLEST, GAP, CAPTION = 340.0, 90.0, 12.0, 16.0


@as_users_wrote
def hull_figure(body: Body, anchor: str, width: float = WIDTH, gravity: Array | None = None) -> Figure:
    """Side and top views at one scale.

    Parameters
    ----------
    body : Body
        With a closed shape.
    anchor : str
        Unique in the document.
    width : float, optional
        Points.
    gravity : (3,) array, optional
        The centre of gravity, FRD, from the body's datum; marked where it is given.
    """
    shape = body.require_shape()
    if isinstance(shape, Parts):  # a plate without thickness encloses nothing that a mesh could show
        shape = replace(shape, parts=tuple(p for p in shape.parts if not isinstance(p.form, Plate)))
    surface = picture_surface(shape if isinstance(shape, TriangleMesh) else meshed(shape, PANELS))
    size = np.ptp(surface[0], axis=0)
    scale = float(min((width - 2.0 * MARGIN) / size[0], TALLEST / max(size[1], size[2])))
    rows = [CAPTION + scale * size[2], CAPTION + scale * size[1]]
    marks = {
        "centre of buoyancy": (np.asarray(shape.centre_of_volume), "o"),
        "reference point": (body.reference_point, "+"),
    }
    if gravity is not None:
        marks["centre of gravity"] = (gravity, "x")
    lines = -(-len(marks) // 2)
    height = sum(rows) + GAP + 2.0 * MARGIN + CAPTION * lines
    title = f"{body.name}: outline"
    words = f"Outlines of {body.name} from starboard and from above, {size[0]:.3g} by {size[1]:.3g} by {size[2]:.3g} m."
    with settings():
        figure, axes = paper(width, height)
        top = height - MARGIN
        for view, row in zip((SIDE, TOP), rows, strict=True):
            _view(axes, view, surface, scale, width, top, marks)
            top -= row + GAP
        for k, (name, (_, marker)) in enumerate(marks.items()):
            at, low = MARGIN + 6.0 + 0.5 * width * (k % 2), MARGIN + CAPTION * (lines - 1 - k // 2)
            axes.plot(at, low, marker=marker, markersize=6.0, color=COLOURS["ink"], fillstyle="none", linestyle="none")
            axes.text(at + 10.0, low - 3.0, name, fontsize=8.75)
        svg = svg_text(figure, anchor, title, words)
    caption = f"Outlines of {body.name} at one scale; the bow points to the right."
    return Figure(anchor, svg, title, caption, words)


def _view(
    axes: Axes,
    view: View,
    surface: Surface,
    scale: float,
    width: float,
    top: float,
    marks: dict[str, tuple[Array, str]],
) -> None:
    flat = surface[0] @ view.axes[:2].T * scale
    corner = np.array([MARGIN + (width - 2.0 * MARGIN - np.ptp(flat[:, 0])) / 2.0, top - CAPTION])
    move = np.array([corner[0] - flat[:, 0].min(), corner[1] - flat[:, 1].max()])
    sheet = Sheet(axes, view, scale, move, float(np.ptp(surface[0], axis=0).max()))
    axes.text(MARGIN, top - 9.0, view.title, fontsize=8.75, color=COLOURS["muted"])
    sheet.outline(surface)
    for point, marker in marks.values():
        axes.plot(
            *sheet.on_paper(point), marker=marker, markersize=6.0, color=COLOURS["ink"], fillstyle="none", zorder=3
        )
