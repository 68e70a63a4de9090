"""The outline of a body from the side and from above, with its centre of buoyancy and reference point."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Drawing
from numpy.typing import NDArray

from coeflab.kernels.solids import Surface
from coeflab.model.body import Body
from coeflab.model.mesh import TriangleMesh
from coeflab.model.meshing import meshed
from coeflab.presentation.body_figure import MARGIN, SIDE, TOP
from coeflab.presentation.body_view import Sheet, View
from coeflab.presentation.document import Figure
from coeflab.presentation.notation import as_users_wrote
from coeflab.presentation.part_facets import picture_surface
from coeflab.presentation.svg import COLOURS, POINTS, settings, svg_text

Array = NDArray[np.float64]
PANELS = 3000
WIDTH, TALLEST, GAP, CAPTION = 340.0, 90.0, 12.0, 16.0


@as_users_wrote
def hull_figure(body: Body, anchor: str) -> Figure:
    """Side and top views at one scale.

    Parameters
    ----------
    body : Body
        With a closed shape.
    anchor : str
        Unique in the document.
    """
    shape = body.require_shape()
    surface = picture_surface(shape if isinstance(shape, TriangleMesh) else meshed(shape, PANELS))
    size = np.ptp(surface[0], axis=0)
    scale = float(min((WIDTH - 2.0 * MARGIN) / size[0], TALLEST / max(size[1], size[2])))
    rows = [CAPTION + scale * size[2], CAPTION + scale * size[1]]
    height = sum(rows) + GAP + 2.0 * MARGIN + CAPTION
    marks = {"centre of buoyancy": (shape.centre_of_volume, "o"), "reference point": (body.reference_point, "+")}
    title = f"{body.name}: outline"
    said = f"Outlines of {body.name} from starboard and from above, {size[0]:.3g} by {size[1]:.3g} by {size[2]:.3g} m."
    with settings():
        figure = Drawing(figsize=(WIDTH / POINTS, height / POINTS))
        axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
        axes.set_axis_off()
        axes.set_xlim(0.0, WIDTH)
        axes.set_ylim(0.0, height)
        top = height - MARGIN
        for view, row in zip((SIDE, TOP), rows, strict=True):
            _view(axes, view, surface, scale, top, marks)
            top -= row + GAP
        for k, (name, (_, marker)) in enumerate(marks.items()):
            at = MARGIN + 6.0 + 170.0 * k
            axes.plot(
                at, MARGIN, marker=marker, markersize=6.0, color=COLOURS["ink"], fillstyle="none", linestyle="none"
            )
            axes.text(at + 10.0, MARGIN - 3.0, name, fontsize=8.75)
        svg = svg_text(figure, anchor, title, said)
    caption = f"Outlines of {body.name} at one scale; the bow points to the right."
    return Figure(anchor, svg, title, caption, said)


def _view(
    axes: Axes, view: View, surface: Surface, scale: float, top: float, marks: dict[str, tuple[Array, str]]
) -> None:
    flat = surface[0] @ view.axes[:2].T * scale
    corner = np.array([MARGIN + (WIDTH - 2.0 * MARGIN - np.ptp(flat[:, 0])) / 2.0, top - CAPTION])
    move = np.array([corner[0] - flat[:, 0].min(), corner[1] - flat[:, 1].max()])
    sheet = Sheet(axes, view, scale, move, float(np.ptp(surface[0], axis=0).max()))
    axes.text(MARGIN, top - 9.0, view.title, fontsize=8.75, color=COLOURS["muted"])
    sheet.outline(surface)
    for point, marker in marks.values():
        axes.plot(
            *sheet.on_paper(point), marker=marker, markersize=6.0, color=COLOURS["ink"], fillstyle="none", zorder=3
        )
