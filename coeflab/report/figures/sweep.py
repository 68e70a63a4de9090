"""The figure of one sweep: points, member curves, tangent at the origin, residuals."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Drawing

from coeflab.core.table import coefficient
from coeflab.core.types import Array
from coeflab.fits.results.fit_result import LeftOut, Sweep
from coeflab.law.symbols import primed
from coeflab.report.document import Figure, Series
from coeflab.report.figures.panel import BOTTOM, GAP, TOP, Range, drawing, legend, limits, panel
from coeflab.report.figures.series import (
    axis_name,
    curve,
    family_key,
    family_name,
    numbers,
    on_axis,
    points,
    styles,
    tagged,
)
from coeflab.report.figures.svg import COLOURS, power_of_ten, settings, strokes, svg_text
from coeflab.report.notation import as_users_wrote

RESIDUALS = 70.0
FINE = 121


def recommended_curve(sweep: Sweep, x: Array) -> tuple[Array, Array]:
    """The recommendation near the origin and its 95 % half-width, shape (n,) each.

    Odd: the tangent through the members' median value at rest. Even: the parabola through it, or the value at rest.
    The half-width is that of the coefficient alone.
    """
    r = sweep.recommendation
    half = np.nan if r.u95 is None else r.u95
    value = np.nan if r.value is None else r.value
    if sweep.target == "1":
        return np.full_like(x, value), np.full_like(x, half)
    at_rest = float(np.median([float(e.curve(np.zeros(1))[0]) for e in r.members])) if r.members else 0.0
    shape = x if sweep.parity == "odd" else x**2
    return at_rest + value * shape, half * np.abs(shape)


@as_users_wrote
def sweep_figure(sweep: Sweep, anchor: str) -> Figure:
    """Points of a sweep with its curves, and the residuals of the members below."""
    left_out = [p for p in sweep.left_out if np.isfinite(p.y)]
    ys = np.concatenate([sweep.y, [p.y for p in left_out]])
    factor, power = power_of_ten(float(np.max(np.abs(ys), initial=0.0)))
    xs = on_axis(sweep, np.concatenate([sweep.x, [p.x for p in left_out], [0.0]]))
    across = limits(xs, 0.04) or (-1.0, 1.0)
    name = primed(sweep.symbol)
    title = f"{name}, {sweep.campaign}: data, curves and residuals"
    with settings():
        figure = drawing()
        main = panel(
            figure, BOTTOM + RESIDUALS + GAP, TOP - BOTTOM - RESIDUALS - GAP, across=across,
            up=limits(ys * factor, 0.08) or (-1.0, 1.0), name_up=f"{sweep.component}'{power}",
        )  # fmt: skip
        legend(figure, _points(main, sweep, left_out, factor) + _curves(main, sweep, factor))
        lower, below = _residuals(figure, sweep, across)
        panels = (
            numbers(main, _series(sweep, left_out), axis_name(sweep), f"{sweep.component}'", factor),
            numbers(lower, _left(sweep), axis_name(sweep), "residual", below),
        )
        svg = svg_text(figure, anchor, title, _description(sweep))
    return Figure(anchor, svg, title, _caption(sweep), _description(sweep), panels)


def _series(sweep: Sweep, left_out: list[LeftOut]) -> list[Series]:
    """Points, those left out, and the curves of the members."""
    half = [""] * len(sweep.x) if sweep.se is None else [f", ± {2.0 * s:.3g}" for s in sweep.se]
    notes = [f"point {label}{h}" for label, h in zip(sweep.labels, half, strict=True)]
    out = [points("points", "points", on_axis(sweep, sweep.x), np.asarray(sweep.y), notes)]
    at = on_axis(sweep, np.array([p.x for p in left_out]))
    out.append(
        points(
            "left",
            "left out",
            at,
            np.array([p.y for p in left_out]),
            [f"point {p.label}: {p.reason}" for p in left_out],
        )
    )
    for e in sweep.recommendation.members:
        x = np.linspace(sweep.x[e.rows].min(), sweep.x[e.rows].max(), FINE)
        out.append(curve(family_key(sweep, e), family_name(sweep, e), on_axis(sweep, x), e.curve(x)))
    return out


def _left(sweep: Sweep) -> list[Series]:
    """What the members leave unexplained."""
    return [
        points(
            family_key(sweep, e), family_name(sweep, e), on_axis(sweep, sweep.x[e.rows]),
            sweep.y[e.rows] - e.curve(sweep.x[e.rows]), [f"point {sweep.labels[i]}" for i in e.rows],
        )
        for e in sweep.recommendation.members
    ]  # fmt: skip


def _points(axes: Axes, sweep: Sweep, left_out: list[Any], factor: float) -> list[Any]:
    x, y = on_axis(sweep, sweep.x), sweep.y * factor
    if sweep.se is not None:
        reach = 2.0 * sweep.se * factor
        bars = strokes(axes, (x, x), (y - reach, y + reach), color=COLOURS["ink"], linewidth=0.8, zorder=3)
        tagged(bars, "points")
    handles: list[Any] = axes.plot(
        x, y, linestyle="none", marker="o", markersize=3.6, markerfacecolor="none", markeredgecolor=COLOURS["ink"],
        markeredgewidth=0.9, zorder=4, label="points" if sweep.se is None else "points, ± 2 standard errors",
    )  # fmt: skip
    tagged(handles, "points")
    if left_out:
        at = on_axis(sweep, np.array([p.x for p in left_out]))
        crosses = axes.plot(
            at, [p.y * factor for p in left_out], linestyle="none", marker="x", markersize=5.0, color=COLOURS["ink"],
            markeredgewidth=1.1, zorder=4, label=f"left out ({len(left_out)})",
        )  # fmt: skip
        handles += tagged(crosses, "left")
    return handles


def _curves(axes: Axes, sweep: Sweep, factor: float) -> list[Any]:
    handles: list[Any] = []
    drawn = styles(sweep)
    for e in sweep.recommendation.members:
        used = sweep.x[e.rows]
        x = np.linspace(used.min(), used.max(), FINE)
        style = drawn[e.family.name]
        drawn_curve = axes.plot(
            on_axis(sweep, x), e.curve(x) * factor, color=style.colour, linestyle=style.line, linewidth=1.4,
            label=family_name(sweep, e), zorder=2.5,
        )  # fmt: skip
        handles += tagged(drawn_curve, family_key(sweep, e))
    if sweep.recommendation.value is not None:
        reach = max(e.window for e in sweep.recommendation.members)
        x = np.linspace(-reach if np.any(sweep.x < 0) else 0.0, reach if np.any(sweep.x > 0) else 0.0, FINE)
        y, half = recommended_curve(sweep, x)
        kind = {"x": "slope at rest", "x2": "curvature at rest"}.get(sweep.target, "value at rest")
        handles += tagged(
            axes.plot(on_axis(sweep, x), y * factor, color=COLOURS["ink"], linewidth=0.9, zorder=2), "rest"
        )
        handles[-1].set_label(kind)
        if sweep.recommendation.u95 is not None:
            band = axes.fill_between(
                on_axis(sweep, x), (y - half) * factor, (y + half) * factor, color=COLOURS["band"], alpha=0.35,
                linewidth=0, zorder=1,
            )  # fmt: skip
            tagged(band, "rest")
            handles[-1].set_label(f"{kind}, band U95")
    return handles


def _residuals(figure: Drawing, sweep: Sweep, across: Range) -> tuple[Axes, float]:
    """The lower panel, and the factor of its upright axis."""
    drawn = styles(sweep)
    found = [(e, sweep.y[e.rows] - e.curve(sweep.x[e.rows])) for e in sweep.recommendation.members]
    largest = max((float(np.max(np.abs(y))) for _, y in found), default=0.0)
    factor, power = power_of_ten(largest)
    reach = largest * factor * 1.15 or 1.0
    axes = panel(
        figure, BOTTOM, RESIDUALS, across=across, up=(-reach, reach), name_up=f"residual{power}",
        name_across=axis_name(sweep), most_up=3,
    )  # fmt: skip
    axes.axhline(0.0, color=COLOURS["muted"], linewidth=0.6)
    for e, y in found:
        style = drawn[e.family.name]
        markers = axes.plot(
            on_axis(sweep, sweep.x[e.rows]), y * factor, linestyle="none", marker=style.marker, markersize=3.0,
            markerfacecolor="none", markeredgecolor=style.colour, markeredgewidth=0.8,
        )  # fmt: skip
        tagged(markers, family_key(sweep, e))
    return axes, factor


def _caption(sweep: Sweep) -> str:
    r, name = sweep.recommendation, primed(sweep.symbol)
    text = f"{sweep.component}' against {axis_name(sweep).partition('  ')[0]}. "
    if r.value is None:
        text += f"The points do not determine {name}. "
    else:
        kind = {"x": "tangent at rest", "x2": "parabola at rest"}.get(sweep.target, "value at rest")
        u95 = "" if r.u95 is None else f" ± {coefficient(r.u95)} (U95, shaded)"
        text += f"The thin line is the {kind} for the recommended {name} = {coefficient(r.value)}{u95}. "
        text += "Each member is drawn over its own window; below, what it leaves unexplained there. "
    if sweep.offset:
        text += f"{sweep.offset}. "
    return text.strip()


def _description(sweep: Sweep) -> str:
    n, m = len(sweep.x), len(sweep.left_out)
    members = ", ".join(family_name(sweep, e) for e in sweep.recommendation.members) or "none"
    return (
        f"Upper panel: {n} points of {sweep.component}' over {axis_name(sweep).replace('  ', ' ')}, {m} left out, "
        f"member curves: {members}. Lower panel: residuals of the members."
    )
