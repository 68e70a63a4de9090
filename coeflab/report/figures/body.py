"""A body of parts in three views and obliquely, with the mesh that it stands for around it."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.legend_handler import HandlerBase
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, PathPatch, Polygon

from coeflab.bodies.mesh import silhouettes
from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.shape import OTHER, Part, Parts
from coeflab.core.types import Array
from coeflab.report.document import Figure
from coeflab.report.figures import part_pictures
from coeflab.report.figures.body_view import BEHIND, HATCH, STRIPE, Sheet, View, oblique, outline_path
from coeflab.report.figures.palette import COLOURS
from coeflab.report.figures.rulers import BELOW, LEFT, rulers
from coeflab.report.figures.svg import paper, settings, svg_text
from coeflab.report.notation import as_users_wrote
from coeflab.report.texts import text_of

WIDTH, MARGIN, GAP, CAPTION, LABELS = 680.0, 14.0, 18.0, 27.0, 20.0
TALLEST_VIEWS, TALLEST_OBLIQUE = 420.0, 300.0
LABELLED, LETTER, TITLED = 14, 4.7, 50.0
SIDE = View("side, from starboard", np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]]))
FRONT = View("front, from ahead", np.array([[0.0, -1.0, 0.0], [0.0, 0.0, -1.0], [1.0, 0.0, 0.0]]))
TOP = View("top, from above", np.array([[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]]))
OBLIQUE = oblique("from ahead, starboard and above", 52.0, 24.0)


@as_users_wrote
def body_figure(name: str, shape: Parts, mesh: TriangleMesh | None, anchor: str) -> Figure:
    """Parts solid, coloured by form; the mesh translucent over them, and as an outline.

    Parameters
    ----------
    name : str
        Of the body.
    shape : Parts
    mesh : TriangleMesh, optional
    anchor : str
        Unique in the document.
    """
    of_parts = [part_pictures.part_facets(p).reshape(-1, 3) for p in shape.parts]
    drawn = None if mesh is None else part_pictures.picture_surface(mesh)
    points = np.concatenate([*of_parts, *([] if drawn is None else [drawn[0]])])
    size = np.maximum(np.ptp(points, axis=0), 1e-3 * float(np.ptp(points, axis=0).max()))
    scale = _scale(size)
    tilted = np.ptp(points @ OBLIQUE.axes[:2].T, axis=0)
    larger = min((WIDTH - 2.0 * MARGIN) / tilted[0], TALLEST_OBLIQUE / tilted[1])
    rows = [
        CAPTION + 2.0 * LABELS + larger * tilted[1],
        CAPTION + scale * size[2] + BELOW,
        CAPTION + scale * size[1] + BELOW,
    ]
    height = sum(rows) + 3.0 * GAP + 2.0 * MARGIN
    tops = height - MARGIN - np.cumsum([0.0, rows[0] + GAP, rows[1] + GAP])
    first = MARGIN + LEFT
    right = first + scale * size[0] + GAP + LEFT
    title = f"{name}: simple parts" + (" over the mesh" if mesh is not None else "")
    with settings():
        figure, axes = paper(WIDTH, height)
        middle = (WIDTH - larger * tilted[0]) / 2.0
        for view, left, top, by in (
            (OBLIQUE, middle, tops[0], larger),
            (SIDE, first, tops[1], scale),
            (FRONT, right, tops[1], scale),
            (TOP, first, tops[2], scale),
        ):
            room = LABELS if view is OBLIQUE else 0.0
            sheet = _placed(axes, view, points, (left, top - CAPTION - room), by)
            axes.text(MARGIN if room else left - LEFT, top - 6.0, view.title, fontsize=8.0, color=COLOURS["muted"])
            sheet.body(shape, drawn)
            if room:
                _labels(sheet, shape, (tops[0] - CAPTION - room, tops[1] + GAP + room))
            else:
                rulers(sheet, points)
        _legend(axes, shape, mesh is not None)
        svg = svg_text(figure, anchor, title, _description(shape, mesh))
    return Figure(anchor, svg, title, _caption(shape, mesh), _description(shape, mesh))


def _scale(size: Array) -> float:
    """Points per metre of the three views, such that side and front view with their titles fit beside each other."""
    across = WIDTH - 2.0 * (MARGIN + LEFT) - GAP
    tall = TALLEST_VIEWS / (size[1] + size[2])
    both = across / (size[0] + size[1])
    return float(min(tall, both if both * size[1] >= TITLED else (across - TITLED) / size[0]))


def _placed(axes: Axes, view: View, points: Array, corner: tuple[float, float], scale: float) -> Sheet:
    """A view whose left upper corner is at ``corner``, points."""
    flat = points @ view.axes[:2].T * scale
    move = np.array([corner[0] - flat[:, 0].min(), corner[1] - flat[:, 1].max()])
    return Sheet(axes, view, scale, move, float(np.ptp(points, axis=0).max()))


def _labels(sheet: Sheet, shape: Parts, between: tuple[float, float]) -> None:
    """Names of the poor stand-ins and of the largest parts over and under the view, in their order from left to right, with lines to the parts."""
    size = [
        float(np.prod(np.sort(np.ptp(part_pictures.part_facets(p).reshape(-1, 3), axis=0))[1:])) for p in shape.parts
    ]
    chosen = sorted(
        sorted(range(len(size)), key=lambda i: (not part_pictures.is_poor(shape.parts[i]), -size[i], i))[:LABELLED]
    )
    names = {i: _marked(shape.parts[i]) for i in chosen}
    at = {i: sheet.on_paper(shape.parts[i].centre) for i in chosen}
    middle = sum(between) / 2.0
    for baseline, foot, row in (
        (between[0] + 7.0, between[0] + 3.0, [i for i in chosen if at[i][1] >= middle]),
        (between[1] - 15.0, between[1] - 7.0, [i for i in chosen if at[i][1] < middle]),
    ):
        row.sort(key=lambda i: (at[i][0], i))
        widths = [LETTER * len(names[i]) + 10.0 for i in row]
        for i, x in zip(row, _spread([float(at[i][0]) for i in row], widths), strict=True):
            sheet.axes.plot([x, at[i][0]], [foot, at[i][1]], color=COLOURS["ink"], linewidth=0.6, zorder=3)
            sheet.axes.plot(*at[i], marker="o", markersize=2.4, color=COLOURS["ink"], zorder=3)
            sheet.axes.text(x, baseline, names[i], ha="center", fontsize=8.5)


def _marked(part: Part) -> str:
    """The name, with what is wrong with a poor stand-in."""
    fit = part.fit
    if fit is None or not fit.poor:
        return part.name
    return f"{part.name}: {OTHER}, {fit.likeness}" if fit.kind == OTHER else f"{part.name}: {fit.worst}"


def _spread(wanted: list[float], widths: list[float]) -> list[float]:
    """Centres of labels near the wanted ones, in order, that do not overlap while the paper has room."""
    out: list[float] = []
    for i, (x, w) in enumerate(zip(wanted, widths, strict=True)):
        least = MARGIN + w / 2.0 if not out else out[-1] + (widths[i - 1] + w) / 2.0
        out.append(max(x, least))
    most = WIDTH - MARGIN
    for i in reversed(range(len(out))):
        out[i] = min(out[i], most - widths[i] / 2.0)
        most = out[i] - widths[i] / 2.0
    return out


class _Poor(Patch):
    """The sample of a poor stand-in."""


class _Stripes(HandlerBase):
    """Draws it: an outline with stripes, as in the views."""

    def create_artists(self, *given: Any) -> list[Any]:
        """Matplotlib gives legend, handle, descents, width, height, size of the letters and the transform."""
        _, handle, across, down, width, height, _, place = given
        corners = np.array([[0.0, 0.0], [width, 0.0], [width, height], [0.0, height]]) - (across, down)
        frame = silhouettes.ring(corners)
        stripes = outline_path(silhouettes.hatched(frame, HATCH, STRIPE))
        edge = Polygon(corners, transform=place)
        edge.update_from(handle)
        edge.set_transform(place)
        return (
            [edge, PathPatch(stripes, facecolor=COLOURS["ink"], edgecolor="none", transform=place)]
            if stripes
            else [edge]
        )


def _legend(axes: Axes, shape: Parts, with_mesh: bool) -> None:
    forms = {part_pictures.form_name(p.form) for p in shape.parts}
    handles: list[Any] = [
        Patch(facecolor=COLOURS[c], edgecolor="none", label=f) for f, c in part_pictures.COLOUR_OF.items() if f in forms
    ]
    if any(part_pictures.is_poor(p) for p in shape.parts):
        handles.append(_Poor(edgecolor=COLOURS["ink"], facecolor="none", linewidth=1.2, label="poor stand-in"))
    if with_mesh:
        handles.append(Line2D([], [], color=COLOURS["ink"], linewidth=0.9, label="outline of the mesh"))
        bare = Patch(facecolor=COLOURS["band"], alpha=BEHIND, edgecolor="none", label="mesh that no part covers")
        handles.append(bare)
    axes.legend(
        handles=handles,
        loc="lower left",
        bbox_to_anchor=(MARGIN, MARGIN - 4.0),
        bbox_transform=axes.transData,
        ncols=len(handles),
        borderpad=0.0,
        borderaxespad=0.0,
        handlelength=1.6,
        columnspacing=1.4,
        handler_map={_Poor: _Stripes()},
    )


def _caption(shape: Parts, mesh: TriangleMesh | None) -> str:
    marked = (
        " Striped: a poor stand-in for its piece of the mesh." if any(map(part_pictures.is_poor, shape.parts)) else ""
    )
    if mesh is None:
        return (
            "The parts of the body, coloured by form, in orthographic views at one scale; the oblique one is larger."
            + marked
        )
    return text_of("body_figure.mesh") + marked


def _description(shape: Parts, mesh: TriangleMesh | None) -> str:
    parts = ", ".join(
        f"{p.name} ({part_pictures.form_name(p.form)}{part_pictures.POOR if part_pictures.is_poor(p) else ''})"
        for p in shape.parts
    )
    return f"Side, front, top and oblique views of {parts}" + (" with the outline of the mesh." if mesh else ".")
