"""The figure of all estimators of one coefficient against the window that each one uses."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from coeflab.core.table import coefficient
from coeflab.fits.results.fit_result import Sweep
from coeflab.fits.statistics.slopes import MEMBER, Estimate
from coeflab.law.symbols import primed
from coeflab.report.document import Figure, Series
from coeflab.report.figures.panel import BOTTOM, GAP, TOP, drawing, heading, legend, panel
from coeflab.report.figures.series import (
    Style,
    family_key,
    family_name,
    is_in_degrees,
    numbers,
    on_axis,
    points,
    styles,
    tagged,
)
from coeflab.report.figures.svg import COLOURS, power_of_ten, settings, strokes, svg_text
from coeflab.report.notation import as_users_wrote
from coeflab.vehicle.reference import Comparison

SIDESTEP, HEADING = 0.011, 12.0


@as_users_wrote
def estimator_figure(sweep: Sweep, published: tuple[Comparison, ...], anchor: str) -> Figure:
    """Every family in every window, twice: as the rule fits it, and without nuisance terms.

    Parameters
    ----------
    sweep : Sweep
    published : tuple of Comparison
        Re-analyses of this coefficient, drawn as lines.
    anchor : str
    """
    frame = _frame(sweep, published)
    factor, power = power_of_ten(max(abs(f) for f in frame))
    name = primed(sweep.symbol)
    reach = float(on_axis(sweep, np.array([max((e.window for e in sweep.plain), default=0.0) or 1.0]))[0])
    across = "largest angle used  [deg]" if is_in_degrees(sweep) else f"largest |{sweep.variable}'| used  [-]"
    title, description = f"{name}, {sweep.campaign}: estimators against window", _description(sweep, published)
    height = (TOP - BOTTOM - GAP - HEADING) / 2.0
    panels = []
    with settings():
        figure = drawing()
        for bottom, estimates, text, below in (
            (BOTTOM + height + GAP, sweep.recommendation.panel, "as the rule fits them", ""),
            (BOTTOM, sweep.plain, "without terms of the other parity", across),
        ):
            axes = panel(
                figure, bottom, height, across=(0.0, reach * 1.06), up=(frame[0] * factor, frame[1] * factor),
                name_up=f"{name}{power}", name_across=below, most_up=5,
            )  # fmt: skip
            heading(figure, bottom + height, text)
            _recommended(axes, sweep, published, factor)
            _estimates(axes, sweep, estimates, factor, reach * SIDESTEP)
            found = _series(sweep, estimates, frame, reach * SIDESTEP)
            panels.append(numbers(axes, found, across, f"{name}, {text}", factor, "window"))
        legend(figure, _handles(sweep, published))
        svg = svg_text(figure, anchor, title, description)
    return Figure(anchor, svg, title, _caption(sweep, published, frame), description, tuple(panels))


def _series(sweep: Sweep, estimates: tuple[Estimate, ...], frame: tuple[float, float], sidestep: float) -> list[Series]:
    """The estimates inside the frame, a series a form, in groups of one window."""
    out = []
    for i, family in enumerate(styles(sweep)):
        mine = [e for e in estimates if e.family.name == family and frame[0] <= e.value <= frame[1]]
        if mine:
            windows = on_axis(sweep, np.array([e.window for e in mine]))
            notes = [f"± {coefficient(_half(e))}, {len(e.rows)} points{', member' * (e.role == MEMBER)}" for e in mine]
            x, y = windows + (i - 1.5) * sidestep, np.array([e.value for e in mine])
            out.append(
                points(
                    family_key(sweep, mine[0]), family_name(sweep, mine[0]), x, y, notes, [f"{w:.3g}" for w in windows]
                )
            )
    return out


def _frame(sweep: Sweep, published: tuple[Comparison, ...]) -> tuple[float, float]:
    """Range of values shown: the members, the recommendation and the published values in full, the rest as it fits."""
    r = sweep.recommendation
    known = [e.value for e in (*r.panel, *sweep.plain)]
    middle = r.value if r.value is not None else float(np.median(known)) if known else 0.0
    reach = [abs(e.value - middle) + _half(e) for e in r.members]
    reach += [abs(c.published - middle) * 1.1 for c in published] + [1.6 * (r.u95 or 0.0)]
    close = [abs(v - middle) for v in known]
    inner = max(reach)
    wanted = max(inner, min(float(np.quantile(close, 0.9)), 2.5 * inner) if close and inner else 0.0)
    half = 1.12 * wanted or max(close, default=0.0) or abs(middle) or 1.0
    return middle - half, middle + half


def _half(e: Estimate) -> float:
    return e.half_hc2 if np.isfinite(e.half_hc2) else 0.0


def _recommended(axes: Axes, sweep: Sweep, published: tuple[Comparison, ...], factor: float) -> None:
    r = sweep.recommendation
    if r.value is not None:
        if r.u95 is not None:
            axes.axhspan(
                (r.value - r.u95) * factor, (r.value + r.u95) * factor, color=COLOURS["band"], alpha=0.35, linewidth=0
            )
        axes.axhline(r.value * factor, color=COLOURS["ink"], linewidth=0.9)
    for c in published:
        axes.axhline(c.published * factor, color=COLOURS["ink"], linewidth=1.1, linestyle=(0, (1.0, 2.0)))


def _estimates(axes: Axes, sweep: Sweep, estimates: tuple[Estimate, ...], factor: float, sidestep: float) -> None:
    low, high = axes.get_ylim()
    for i, (family, style) in enumerate(styles(sweep).items()):
        mine = [e for e in estimates if e.family.name == family]
        if not mine:
            continue
        x = on_axis(sweep, np.array([e.window for e in mine])) + (i - 1.5) * sidestep
        y = np.array([e.value for e in mine]) * factor
        half = np.array([_half(e) for e in mine]) * factor
        kept = np.array([e.role == MEMBER for e in mine])
        inside = (y >= low) & (y <= high)
        seen = (y - half <= high) & (y + half >= low)
        bottom, top = np.clip(y - half, low, high), np.clip(y + half, low, high)
        for chosen, thick in ((seen & ~kept, 0.7), (seen & kept, 1.6)):
            if np.any(chosen):
                at = x[chosen]
                bars = strokes(axes, (at, at), (bottom[chosen], top[chosen]), color=style.colour, linewidth=thick)
                tagged(bars, family_key(sweep, mine[0]))
        for chosen, filled in ((inside & ~kept, False), (inside & kept, True)):
            if np.any(chosen):
                tagged(_markers(axes, x[chosen], y[chosen], style, filled=filled), family_key(sweep, mine[0]))


def _markers(axes: Axes, x: Any, y: Any, style: Style, *, filled: bool) -> list[Line2D]:
    return axes.plot(
        x, y, linestyle="none", marker=style.marker, markersize=6.0 if filled else 3.2, markeredgecolor=style.colour,
        markerfacecolor=style.colour if filled else "none", markeredgewidth=0.9, zorder=4 if filled else 3,
    )  # fmt: skip


def _handles(sweep: Sweep, published: tuple[Comparison, ...]) -> list[Any]:
    handles: list[Any] = []
    kept = {e.family.name for e in sweep.recommendation.members}
    names = {e.family.name: family_name(sweep, e) for e in (*sweep.recommendation.panel, *sweep.plain)}
    for family, style in styles(sweep).items():
        is_kept = family in kept
        handles.append(
            Line2D(
                [], [], color=style.colour, linewidth=1.6 if is_kept else 0.7, marker=style.marker,
                markersize=5.0 if is_kept else 3.2, markerfacecolor=style.colour if is_kept else "none",
                markeredgecolor=style.colour, label=names[family] + (", member" if is_kept else ""),
            )
        )  # fmt: skip
        tagged(handles[-1], f"form{list(styles(sweep)).index(family)}")
    if sweep.recommendation.value is not None:
        handles.append(
            Patch(
                facecolor=COLOURS["band"], alpha=0.35, edgecolor="none",
                label="recommended" + (" ± U95" if sweep.recommendation.u95 is not None else ""),
            )
        )  # fmt: skip
    if published:
        handles.append(
            Line2D([], [], color=COLOURS["ink"], linewidth=1.1, linestyle=(0, (1.0, 2.0)), label="published")
        )
    return handles


def _caption(sweep: Sweep, published: tuple[Comparison, ...], frame: tuple[float, float]) -> str:
    name = primed(sweep.symbol)
    text = (
        f"Estimates of {name} by form and window, with 95 % intervals (HC2). Filled: the member that the rule keeps. "
    )
    for c in published:
        text += f"Published: {coefficient(c.published)} ({c.reference}, read with {c.reading}). "
    everything = (*sweep.recommendation.panel, *sweep.plain)
    beyond = sum(not frame[0] <= e.value <= frame[1] for e in everything)
    if beyond:
        text += f"{beyond} of {len(everything)} estimates lie beyond the frame. "
    return text.strip()


def _description(sweep: Sweep, published: tuple[Comparison, ...]) -> str:
    r = sweep.recommendation
    value = "none" if r.value is None else coefficient(r.value)
    spread = [e.value for e in r.members]
    members = f"; {len(spread)} members from {coefficient(min(spread))} to {coefficient(max(spread))}" if spread else ""
    there = "; ".join(f"published {coefficient(c.published)}" for c in published)
    return (
        f"Estimates of {primed(sweep.symbol)} against the largest motion used, {len(r.panel)} by the rule in the upper "
        f"panel and {len(sweep.plain)} plain ones in the lower. Recommended: {value}{members}{'; ' + there if there else ''}."
    )
