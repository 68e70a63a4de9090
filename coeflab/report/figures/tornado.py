"""The figure of one budget: parts as bars, the largest on top."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Drawing

from coeflab.core.table import coefficient, percent
from coeflab.fits.uncertainty.budget import Budget
from coeflab.law.symbols import primed
from coeflab.report.document import Figure
from coeflab.report.figures.palette import COLOURS, power_of_ten
from coeflab.report.figures.panel import row_panel
from coeflab.report.figures.series import numbers, points
from coeflab.report.figures.svg import POINTS, settings, svg_text
from coeflab.tables.force_table import STUDIES

WIDTH, LEFT, RIGHT, BOTTOM, TOP = 340.0, 112.0, 44.0, 34.0, 8.0
ROW, THICK = 17.0, 0.62
MEASURED = ("random", "model form", "random and model form")
STUDIED = ("grid", *STUDIES.values())


def tornado_figure(b: Budget, anchor: str) -> Figure:
    """Half-widths of all assessed parts to both sides of the value, and U95 below them.

    Parameters
    ----------
    b : Budget
    anchor : str
    """
    bars = sorted(((p.name, p.half_width) for p in b.parts), key=lambda p: -p[1])
    if b.u95 is not None:
        bars.append(("U95", b.u95))
    factor, power = power_of_ten(max((h for _, h in bars), default=0.0))
    name = primed(b.symbol)
    title = f"{name}, {b.campaign}: uncertainty budget"
    description = _description(b, bars)
    with settings():
        height = BOTTOM + TOP + ROW * max(len(bars), 1)
        figure = Drawing(figsize=(WIDTH / POINTS, height / POINTS))
        axes = _bars(figure, bars, factor, f"change of {name}{power}")
        words = points(
            "bars", "95 % half-width", np.array([h for _, h in bars]), np.arange(len(bars))[::-1] + 0.0,
            [f"{label}, {percent(half, b.value)} of the value" for label, half in bars],
        )  # fmt: skip
        shown = numbers(axes, (words,), f"change of {name}", "", factor_across=factor, bars="across")
        svg = svg_text(figure, anchor, title, description)
    return Figure(anchor, svg, title, _caption(b), description, (shown,))


def _bars(figure: Drawing, bars: list[tuple[str, float]], factor: float, name: str) -> Axes:
    reach = 1.08 * factor * max((h for _, h in bars), default=0.0) or 1.0
    rows = [(label, f"± {half * factor:.3g}") for label, half in bars]
    count = max(len(bars), 1)
    axes = row_panel(figure, (LEFT, RIGHT, BOTTOM, TOP), (-reach, reach), rows, count, name)
    for row, (label, half) in enumerate(bars):
        colour = COLOURS["ink" if label == "U95" else "a" if label in MEASURED else "b" if label in STUDIED else "c"]
        size = half * factor
        axes.barh(count - 1.0 - row, 2.0 * size, height=THICK, left=-size, color=colour, zorder=2)
    return axes


def _caption(b: Budget) -> str:
    text = f"95 % half-widths of the parts of {primed(b.symbol)} = {coefficient(b.value)}"
    text += f", joined to U95 = {coefficient(b.u95)} as a root sum of squares. " if b.u95 is not None else "; no U95. "
    return text + f"Not assessed: {', '.join(b.unassessed) or 'nothing known'}."


def _description(b: Budget, bars: list[tuple[str, float]]) -> str:
    each = ", ".join(f"{label} {coefficient(half)} ({percent(half, b.value)})" for label, half in bars) or "no part"
    return f"Bars of half-widths to both sides of {coefficient(b.value)}: {each}."
