"""The outline of a body."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from coeflab.bodies.body import Body
from coeflab.core.errors import InputError, shown
from coeflab.report.figures.body import FRONT, SIDE, TOP, draw_outline
from coeflab.report.figures.three_views import surfaces_of
from coeflab.report.plots.axes import axes_of, palette

FINE = 9  # digits of a metre
VIEWS = {"side": (SIDE, "x [m]", "z [m]"), "top": (TOP, "x [m]", "y [m]"), "front": (FRONT, "y [m]", "z [m]")}


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
    seen, across, up = VIEWS[view]
    frame = seen.axes[:2]
    signs = frame.sum(axis=1)  # of what the axis is called
    axes, colours = axes_of(ax), palette()
    for _, surface in surfaces_of(body):
        draw_outline(axes, surface, frame, palette=colours, digits=FINE, sense=signs)
    point = frame @ np.asarray(body.reference_point) * signs
    axes.plot(*([v] for v in point), "+", color=colours["a"], label="reference point")
    axes.set_xlabel(across)
    axes.set_ylabel(up)
    axes.autoscale_view()
    axes.set_aspect("equal")
    if not axes.yaxis_inverted():
        axes.invert_yaxis()
    if signs[0] < 0.0 and not axes.xaxis_inverted():
        axes.invert_xaxis()
    return axes
