"""The uncertainty budget in a report: what U95 holds, what a validation concludes, how it carries on.

The figure of one budget: parts as bars, the largest on top.
"""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Drawing

from coeflab.core.table import Table, coefficient, percent
from coeflab.fits.uncertainty.budget import Budget
from coeflab.law.symbols import primed
from coeflab.report.document import Figure, Section
from coeflab.report.figures.panel import tick_texts, ticks
from coeflab.report.figures.series import numbers, points
from coeflab.report.figures.svg import COLOURS, POINTS, power_of_ten, settings, svg_text
from coeflab.report.tables import budget as budget_tables
from coeflab.study.study import Study
from coeflab.study.validation import validations
from coeflab.vehicle.derived import centre_of_pressure, stability

WIDTH, LEFT, RIGHT, BOTTOM, TOP = 340.0, 112.0, 44.0, 34.0, 8.0
ROW, THICK = 17.0, 0.62
MEASURED = ("random", "model form", "random and model form")


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
        axes = _bars(figure, bars, height, factor, f"change of {name}{power}")
        told = points(
            "bars", "95 % half-width", np.array([h for _, h in bars]), np.arange(len(bars))[::-1] + 0.0,
            [f"{label}, {percent(half, b.value)} of the value" for label, half in bars],
        )  # fmt: skip
        shown = numbers(axes, (told,), f"change of {name}", "", factor_across=factor, bars="across")
        svg = svg_text(figure, anchor, title, description)
    return Figure(anchor, svg, title, _caption(b), description, (shown,))


def _bars(figure: Drawing, bars: list[tuple[str, float]], height: float, factor: float, name: str) -> Axes:
    width, tall = WIDTH - LEFT - RIGHT, height - BOTTOM - TOP
    axes = figure.add_axes((LEFT / WIDTH, BOTTOM / height, width / WIDTH, tall / height))
    axes.set_axis_off()
    reach = 1.08 * factor * max((h for _, h in bars), default=0.0) or 1.0
    across, rows = (-reach, reach), max(len(bars), 1)
    axes.set_xlim(*across)
    axes.set_ylim(-0.5, rows - 0.5)
    at = ticks(across, 6)
    axes.vlines(at, -0.5, rows - 0.5, color=COLOURS["rule"], linewidth=0.5, zorder=0)
    axes.axvline(0.0, color=COLOURS["muted"], linewidth=0.6, zorder=3)
    for row, (label, half) in enumerate(bars):
        y, size = rows - 1.0 - row, half * factor
        colour = COLOURS["ink" if label == "U95" else "a" if label in MEASURED else "b" if label == "grid" else "c"]
        axes.barh(y, 2.0 * size, height=THICK, left=-size, color=colour, zorder=2)
        base = (BOTTOM + (y + 0.5) * ROW - 2.9) / height
        figure.text((LEFT - 5.5) / WIDTH, base, label, ha="right", va="baseline")
        figure.text((WIDTH - RIGHT + 5.5) / WIDTH, base, f"± {size:.3g}", ha="left", va="baseline")
    for x, text in zip(at, tick_texts(at), strict=True):
        place = LEFT + width * (float(x) - across[0]) / (across[1] - across[0])
        figure.text(place / WIDTH, (BOTTOM - 13.5) / height, text, ha="center", va="baseline")
    figure.text((LEFT + width / 2.0) / WIDTH, (BOTTOM - 27.5) / height, name, ha="center", va="baseline")
    return axes


def _caption(b: Budget) -> str:
    text = f"95 % half-widths of the parts of {primed(b.symbol)} = {coefficient(b.value)}"
    text += f", joined to U95 = {coefficient(b.u95)} as a root sum of squares. " if b.u95 is not None else "; no U95. "
    return text + f"Not assessed: {', '.join(b.unassessed) or 'nothing known'}."


def _description(b: Budget, bars: list[tuple[str, float]]) -> str:
    each = ", ".join(f"{label} {coefficient(half)} ({percent(half, b.value)})" for label, half in bars) or "no part"
    return f"Bars of half-widths to both sides of {coefficient(b.value)}: {each}."


def budget_sections(study: Study) -> tuple[Section, ...]:
    """One section, or none where no coefficient has a budget."""
    found = study.budgets
    models = tuple(m for f in study.fits for m in f.models)
    if not found and not any(m.shared for m in models):
        return ()
    derived = [d for f in study.fits for d in centre_of_pressure(f.coefficients, f.campaign)]
    derived += [d for p in study.parameter_files.values() for d in stability(p)]
    tables = (
        budget_tables.overview(found),
        budget_tables.grids(found),
        budget_tables.validation(validations(study, found)),
        budget_tables.derived(derived),
        *(budget_tables.shared(m) for m in models),
    )
    text = (
        "U95 joins every assessed part as a root sum of squares: the scatter of the points, the model form, the grid where "
        "a campaign has a grid study, and the inputs that a campaign declares under [uncertainty] (angle, speed, "
        "calibration, reference point, length). A part that was not assessed is named, never zero.",
    )
    wanted = [b for b in found if b.symbol.removesuffix("'") in study.plan.wanted]
    parts = tuple(
        Section(
            f"budget-{i}",
            f"{primed(b.symbol)} of {b.campaign}",
            tables=(budget_tables.budget(b),),
            figures=(tornado_figure(b, f"tornado-{i}"),),
        )
        for i, b in enumerate(wanted)
    )
    return (Section("budget", "Uncertainty budget", text, _filled(tables), subsections=parts),)


def _filled(tables: tuple[Table, ...]) -> tuple[Table, ...]:
    return tuple(t for t in tables if t.rows)
