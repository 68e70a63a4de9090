"""The figure of one sweep: points, the recommended curve with its band, tangent at the origin, residuals."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Drawing
from scipy.interpolate import PchipInterpolator

from coeflab.core.table import plus_minus
from coeflab.core.types import Array
from coeflab.fits.results.fit_result import LeftOut, Sweep
from coeflab.law.symbols import primed
from coeflab.report.document import Figure, Series
from coeflab.report.figures.artists import strokes
from coeflab.report.figures.palette import COLOURS, power_of_ten
from coeflab.report.figures.panel import BOTTOM, GAP, TOP, Range, drawing, legend, limits, panel
from coeflab.report.figures.series import axis_name, curve, numbers, on_axis, points, tagged
from coeflab.report.figures.svg import settings, svg_text
from coeflab.report.notation import as_users_wrote
from coeflab.report.texts import text_of

RESIDUALS = 70.0
FINE = 121
Fine = tuple[Array, Array, Array]


def at_rest(sweep: Sweep, x: Array) -> tuple[Array, Array]:
    """The recommendation near the origin and its 95 % half-width, shape (n,) each.

    Odd: the tangent through the curve's value at rest. Even: the parabola through it, or the value at rest. The
    half-width is that of the coefficient alone.
    """
    value, half = (np.nan if v is None else v for v in (sweep.value, sweep.u95))
    if sweep.target == "1":
        return np.full_like(x, value), np.full_like(x, half)
    shape = x if sweep.parity == "odd" else x**2
    return sweep.at_rest[0] + value * shape, half * np.abs(shape)


@as_users_wrote
def sweep_figure(sweep: Sweep, anchor: str) -> Figure:
    """Points of a sweep with the recommended curve, and what it leaves unexplained below."""
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
        fine = fine_curve(sweep) if sweep.value is not None else None
        legend(figure, draw_points(main, sweep, factor) + draw_curves(main, sweep, factor))
        lower, left, below = _residuals(figure, sweep, across)
        panels = (
            numbers(main, _series(sweep, left_out, fine), axis_name(sweep), f"{sweep.component}'", factor),
            numbers(lower, [left], axis_name(sweep), "residual", below),
        )
        svg = svg_text(figure, anchor, title, _description(sweep))
    return Figure(anchor, svg, title, _caption(sweep), _description(sweep), panels)


def _series(sweep: Sweep, left_out: list[LeftOut], fine: Fine | None) -> list[Series]:
    """Points, those left out, and the recommended curve."""
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
    if fine is not None:
        x, y, _ = fine
        out.append(curve("curve", "recommended curve", on_axis(sweep, x), y))
    return out


def fine_curve(sweep: Sweep) -> Fine:
    """Settings, the recommended curve there and the half-width of its band, each of shape (m,)."""
    at, mean, half = sweep.curve
    x = np.linspace(float(np.min(sweep.x, initial=0.0)), float(np.max(sweep.x, initial=0.0)), FINE)
    bent = PchipInterpolator(at, np.stack([mean, half]), axis=1)(x)
    return x, bent[0], bent[1]


def draw_points(axes: Axes, sweep: Sweep, factor: float = 1.0, palette: Mapping[str, str] = COLOURS) -> list[Any]:
    """Points of a sweep, and crosses for those left out; returns what a legend shows.

    Parameters
    ----------
    axes : Axes
    sweep : Sweep
    factor : float
        Of the force.
    palette : mapping of str to str
        A colour for each name of `COLOURS`.
    """
    left_out = [p for p in sweep.left_out if np.isfinite(p.y)]
    x, y = on_axis(sweep, sweep.x), sweep.y * factor
    if sweep.se is not None:
        reach = 2.0 * sweep.se * factor
        bars = strokes(axes, (x, x), (y - reach, y + reach), color=palette["ink"], linewidth=0.8, zorder=3)
        tagged(bars, "points")
    handles: list[Any] = axes.plot(
        x, y, linestyle="none", marker="o", markersize=3.6, markerfacecolor="none", markeredgecolor=palette["ink"],
        markeredgewidth=0.9, zorder=4, label="points" if sweep.se is None else "points, ± 2 standard errors",
    )  # fmt: skip
    tagged(handles, "points")
    if left_out:
        at = on_axis(sweep, np.array([p.x for p in left_out]))
        crosses = axes.plot(
            at, [p.y * factor for p in left_out], linestyle="none", marker="x", markersize=5.0, color=palette["ink"],
            markeredgewidth=1.1, zorder=4, label=f"left out ({len(left_out)})",
        )  # fmt: skip
        handles += tagged(crosses, "left")
    return handles


def draw_curves(axes: Axes, sweep: Sweep, factor: float = 1.0, palette: Mapping[str, str] = COLOURS) -> list[Any]:
    """The recommended curve with its band, and the slope with U95, as `draw_points`; nothing without a value."""
    handles: list[Any] = []
    if sweep.value is None:
        return handles
    x, y, half = fine_curve(sweep)
    at = on_axis(sweep, x)
    handles += tagged(
        axes.plot(at, y * factor, color=palette["b"], linewidth=1.4, label="recommended curve", zorder=2.5), "curve"
    )
    for side in (-1.0, 1.0):
        edge = (y + side * half) * factor
        tagged(axes.plot(at, edge, color=palette["b"], linewidth=0.6, linestyle=(0, (3.0, 2.0)), zorder=2.4), "curve")
    y, half = at_rest(sweep, x)
    kind = {"x": "slope at rest", "x2": "curvature at rest"}.get(sweep.target, "value at rest")
    tagged(axes.plot(at, y * factor, color=palette["ink"], linewidth=0.9, zorder=2), "rest")
    low, high = (y - half) * factor, (y + half) * factor
    band = axes.fill_between(at, low, high, color=palette["band"], alpha=0.35, linewidth=0, zorder=1)
    tagged(band, "rest")
    band.set_label(f"{kind}, band U95")
    return [*handles, band]


def _residuals(figure: Drawing, sweep: Sweep, across: Range) -> tuple[Axes, Series, float]:
    """The lower panel, what is in it, and the factor of its upright axis."""
    left = np.asarray(sweep.y - sweep.fitted)
    largest = float(np.max(np.abs(left), initial=0.0)) if np.all(np.isfinite(left)) else 0.0
    factor, power = power_of_ten(largest)
    reach = largest * factor * 1.15 or 1.0
    axes = panel(
        figure, BOTTOM, RESIDUALS, across=across, up=(-reach, reach), name_up=f"residual{power}",
        name_across=axis_name(sweep), most_up=3,
    )  # fmt: skip
    axes.axhline(0.0, color=COLOURS["muted"], linewidth=0.6)
    x = on_axis(sweep, sweep.x)
    if sweep.value is not None:
        markers = axes.plot(
            x, left * factor, linestyle="none", marker="o", markersize=3.0, markerfacecolor="none",
            markeredgecolor=COLOURS["b"], markeredgewidth=0.8,
        )  # fmt: skip
        tagged(markers, "curve")
    return axes, points("curve", "recommended curve", x, left, [f"point {label}" for label in sweep.labels]), factor


def _caption(sweep: Sweep) -> str:
    name = primed(sweep.symbol)
    text = f"{sweep.component}' against {axis_name(sweep).partition('  ')[0]}. "
    if sweep.value is None:
        text += f"The points do not determine {name}. "
    else:
        kind = {"x": "tangent at rest", "x2": "parabola at rest"}.get(sweep.target, "value at rest")
        text += f"The thin line is the {kind} for {name} = {plus_minus(sweep.value, sweep.u95, '±')} (U95, shaded). "
        text += "The recommended curve has its 95 % band; below, what it leaves unexplained. "
    if len(sweep.wrong):
        text += f"Without point {', '.join(sweep.labels[i] for i in sweep.wrong)}, which does not fit the others. "
    if sweep.offset:
        text += f"{sweep.offset}. "
    return text.strip()


def _description(sweep: Sweep) -> str:
    n, m = len(sweep.x), len(sweep.left_out)
    return text_of(
        "sweep_figure.description", n=n, component=sweep.component, sweep=axis_name(sweep).replace("  ", " "), m=m
    )
