"""Angle at which the water meets the stations of a body that turns: the figure of a table with rates."""

from __future__ import annotations

from typing import Any

import numpy as np

from coeflab.bodies.body import Body
from coeflab.bodies.shape import Revolution
from coeflab.core.types import Array
from coeflab.report.document import Figure
from coeflab.report.figures import series as plotted
from coeflab.report.figures.panel import BOTTOM, LEGEND_ROW, drawing, legend, limits, panel
from coeflab.report.figures.series import STYLES, numbers, tagged
from coeflab.report.figures.svg import settings, svg_text
from coeflab.report.notation import as_users_wrote
from coeflab.tables.force_table import AT_REST, ForceTable

TALL, STATIONS = 150.0, 61
ACROSS = {"r": ("v", 1.0, "sideslip"), "q": ("w", -1.0, "angle of attack")}
OVERALL = "length_overall"


def local_incidence(table: ForceTable, rate: str, x: Array) -> Array:
    """Angle of the flow at stations, (n, k) in radians: atan2(v + x r, u), in pitch atan2(w - x q, u).

    Parameters
    ----------
    table : ForceTable
    rate : str
        ``r`` or ``q``.
    x : (k,) array
        Stations, m, forward of the datum.
    """
    across, sign, _ = ACROSS[rate]
    ahead = x - table.reference_point[0]
    drift = table.motion[across][:, None] + sign * table.motion[rate][:, None] * ahead
    return np.asarray(np.arctan2(drift, table.motion["u"][:, None]))


def ends(body: Body | None, table: ForceTable) -> tuple[float, float] | None:
    """Stern and nose of the body, m from the table's datum; None where no body says so."""
    if body is None or body.datum != table.datum:
        return None
    if isinstance(body.shape, Revolution):
        middle = 0.5 * float(body.shape.x.min() + body.shape.x.max())
        return middle - 0.5 * body.shape.length, middle + 0.5 * body.shape.length
    if body.datum.id == "nose" and OVERALL in body.lengths:
        return -body.lengths[OVERALL], 0.0
    return None


def _shown(table: ForceTable, rate: str) -> tuple[list[int], int]:
    """Rows of at most as many settings as there are styles, spread over all, and how many settings there are."""
    length = table.scaling.length
    turning = np.flatnonzero(np.abs(table.primed_motion(rate, length)) > AT_REST)
    primes = np.column_stack([table.primed_motion(m, length)[turning] for m in (rate, ACROSS[rate][0])])
    _, first = np.unique(np.round(primes, 4), axis=0, return_index=True)
    order = turning[first]
    picked = np.unique(np.round(np.linspace(0, len(order) - 1, min(len(order), len(STYLES)))).astype(int))
    return [int(order[i]) for i in picked], len(order)


@as_users_wrote
def incidence_figure(table: ForceTable, rate: str, body: Body | None, anchor: str) -> Figure:
    """Local incidence along the body of up to four runs of a table that turns.

    Parameters
    ----------
    table : ForceTable
        With a rate that is not zero.
    rate : str
        ``r`` or ``q``.
    body : Body, optional
        Whose nose and stern end the curves.
    anchor : str
    """
    across, _, angle = ACROSS[rate]
    found = ends(body, table)
    half = 0.5 * table.scaling.length
    stern, nose = found or (float(table.reference_point[0]) - half, float(table.reference_point[0]) + half)
    rows, many = _shown(table, rate)
    x = np.linspace(stern, nose, STATIONS)
    curves = np.degrees(local_incidence(table, rate, x)[rows])
    primes = [(table.primed_motion(m, table.scaling.length)) for m in (across, rate)]
    names = [f"{across}' = {primes[0][i]:.3g}, {rate}' = {primes[1][i]:.3g}" for i in rows]
    title = f"{table.name}: local {angle} along the body"
    name_across, name_up = f"x, forward of {table.datum.id}  [m]", f"local {angle}  [deg]"
    description = f"{len(rows)} of {many} settings that turn, from stern to nose: {'; '.join(names)}."
    with settings():
        figure = drawing(BOTTOM + TALL + 10.0 + LEGEND_ROW * ((len(rows) + 1) // 2))
        axes = panel(
            figure, BOTTOM, TALL, across=limits(x, 0.02) or (0.0, 1.0), up=limits(np.append(curves, 0.0), 0.06) or (-1.0, 1.0),
            name_up=name_up, name_across=name_across,
        )  # fmt: skip
        handles, words = [], []
        for k, (y, name, style) in enumerate(zip(curves, names, STYLES, strict=False)):
            look: dict[str, Any] = {"color": style.colour, "linestyle": style.line, "linewidth": 1.3, "zorder": 2.5}
            handles += tagged(axes.plot(x, y, label=name, **look), f"setting{k}")
            words.append(plotted.curve(f"setting{k}", name, x, y))
        legend(figure, handles, BOTTOM + TALL)
        shown = numbers(axes, words, name_across, name_up)
        svg = svg_text(figure, anchor, title, description)
    where = (
        f"Stern at {stern:.4g} m, nose at {nose:.4g} m."
        if found
        else "No body states where its nose and stern are: half the length of the primes to both sides of the reference point."
    )
    sign = "+ x r" if rate == "r" else "- x q"
    caption = (
        f"atan2({across} {sign}, u), x from the reference point at {table.reference_point[0]:.4g} m; positive where the water "
        f"comes from {'starboard' if rate == 'r' else 'below'}. {where} {len(rows)} of {many} settings are drawn."
    )
    return Figure(anchor, svg, title, caption, description, (shown,))
