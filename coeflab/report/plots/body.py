"""The outline of a body."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from coeflab.bodies.body import Body
from coeflab.bodies.mesh import solids as silhouette
from coeflab.core.errors import InputError, shown
from coeflab.report.figures.three_views import surfaces_of
from coeflab.report.plots.axes import axes_of, palette

VIEWS = {  # across and up in FRD, and how they are called
    "side": (np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0]]), "x [m]", "z [m]"),
    "top": (np.array([[1.0, 0.0, 0.0], [0.0, -1.0, 0.0]]), "x [m]", "y [m]"),
    "front": (np.array([[0.0, -1.0, 0.0], [0.0, 0.0, -1.0]]), "y [m]", "z [m]"),
}


def plot_body(body: Body, view: str = "side", ax: Axes | None = None) -> Axes:
    """Its silhouette with the reference point, m, FRD, from the datum; z points down.

    Parameters
    ----------
    body : Body
    view : {"side", "top", "front"}
    ax : Axes, optional

    Raises
    ------
    InputError
        Another view, or a body without a shape.
    """
    if view not in VIEWS:
        raise InputError(shown(view), f"one of {', '.join(VIEWS)}", column="view")
    frame, across, up = VIEWS[view]
    signs = frame.sum(axis=1)  # of what the axis is called
    axes, colours = axes_of(ax), palette()
    for _, surface in surfaces_of(body):
        for ring in silhouette.polygons(silhouette.mesh_outline(*surface, frame)):
            x, y = (np.append(c, c[0]) * s for c, s in zip(np.asarray(ring).T, signs, strict=True))
            axes.fill(x, y, facecolor=colours["band"], edgecolor=colours["ink"], alpha=0.5)
    point = frame @ np.asarray(body.reference_point) * signs
    axes.plot(*([v] for v in point), "+", color=colours["a"], label="reference point")
    axes.set_xlabel(across)
    axes.set_ylabel(up)
    axes.set_aspect("equal")
    if not axes.yaxis_inverted():
        axes.invert_yaxis()
    if signs[0] < 0.0 and not axes.xaxis_inverted():
        axes.invert_xaxis()
    return axes
