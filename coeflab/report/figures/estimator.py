"""The figure of what single forms would have said, each in growing windows, around the recommended value."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from coeflab.core.table import coefficient, plus_minus
from coeflab.core.types import Array
from coeflab.fits.results.fit_result import Sweep
from coeflab.law.symbols import primed
from coeflab.report.document import Figure, Series
from coeflab.report.figures import series
from coeflab.report.figures.artists import strokes
from coeflab.report.figures.palette import COLOURS, power_of_ten, recoloured
from coeflab.report.figures.panel import BOTTOM, TOP, drawing, legend, panel
from coeflab.report.figures.svg import settings, svg_text
from coeflab.report.notation import as_users_wrote
from coeflab.report.texts import text_of
from coeflab.vehicle.published_values import Comparison

SIDESTEP = 0.011
PLUS_MINUS = "±"
ENDED = series.Style(COLOURS["ink"], "-", "o")


@dataclass(frozen=True, slots=True, eq=False)
class _Drawn:
    """One series: other forms are thin and open, the recommended one is thick and filled."""

    key: str
    name: str
    style: series.Style
    recommended: bool
    window: Array
    value: Array
    half: Array
    notes: tuple[str, ...]


@as_users_wrote
def estimator_figure(sweep: Sweep, published: tuple[Comparison, ...], anchor: str) -> Figure:
    """Every family in every window, and the recommended value had the sweep ended sooner.

    Parameters
    ----------
    sweep : Sweep
    published : tuple of Comparison
        Re-analyses of this coefficient, drawn as lines.
    anchor : str
    """
    frame = frame_of(sweep, published)
    factor, power = power_of_ten(max(abs(f) for f in frame))
    name = primed(sweep.symbol)
    drawn = _drawn(sweep)
    largest = max((float(d.window.max()) for d in drawn), default=0.0) or 1.0
    reach = float(series.on_axis(sweep, np.array([largest]))[0])
    unit = "deg" if series.is_in_degrees(sweep) else "prime"
    across = text_of(f"estimator_figure.across_{unit}", variable=sweep.variable)
    title, description = f"{name}, {sweep.campaign}: what other forms would have said", _description(sweep, published)
    with settings():
        figure = drawing()
        axes = panel(
            figure, BOTTOM, TOP - BOTTOM, across=(0.0, reach * 1.06), up=(frame[0] * factor, frame[1] * factor),
            name_up=f"{name}{power}", name_across=across, most_up=5,
        )  # fmt: skip
        at = draw_forms(axes, sweep, published, factor)
        found = [_inside(sweep, d, x, frame) for d, x in zip(drawn, at, strict=True)]
        panels = (series.numbers(axes, found, across, name, factor, "window"),)
        legend(figure, _handles(sweep, drawn, published))
        svg = svg_text(figure, anchor, title, description)
    return Figure(anchor, svg, title, _caption(sweep, published, frame), description, panels)


def draw_forms(
    axes: Axes,
    sweep: Sweep,
    published: tuple[Comparison, ...] = (),
    factor: float = 1.0,
    palette: Mapping[str, str] = COLOURS,
) -> list[Array]:
    """Every family in every window about the recommended value; where each of them stands along the axis.

    Parameters
    ----------
    axes : Axes
        With its limits up and down.
    sweep : Sweep
    published : tuple of Comparison
    factor : float
        Of the values.
    palette : mapping of str to str
        A colour for each name of `COLOURS`.
    """
    drawn = _drawn(sweep)
    largest = max((float(d.window.max()) for d in drawn), default=0.0) or 1.0
    reach = float(series.on_axis(sweep, np.array([largest]))[0])
    _recommended(axes, sweep, published, factor, palette)
    at = []
    for i, d in enumerate(drawn):
        x = series.on_axis(sweep, d.window) + (0.0 if d.recommended else (i - 1.5) * reach * SIDESTEP)
        _mark(axes, d, x, factor, palette)
        at.append(x)
    return at


def _drawn(sweep: Sweep) -> list[_Drawn]:
    out = []
    for family, style in series.styles(sweep).items():
        mine = [e for e in sweep.forms if e.family.name == family]
        halves = [e.half_hc2 if np.isfinite(e.half_hc2) else 0.0 for e in mine]
        notes = tuple(f"± {coefficient(h)}, {len(e.rows)} points" for e, h in zip(mine, halves, strict=True))
        window, value = (np.array([getattr(e, which) for e in mine]) for which in ("window", "value"))
        key, name = series.family_key(sweep, mine[0]), series.family_name(sweep, mine[0])
        out.append(_Drawn(key, name, style, False, window, value, np.array(halves), notes))
    ended = [(s.cap, s.value, s.u95) for s in sweep.sensitivity if s.value is not None and s.u95 is not None]
    if ended:
        cap, value, half = np.array(ended).T
        notes = tuple(f"{plus_minus(v, h, PLUS_MINUS)} (U95)" for _, v, h in ended)
        out.append(_Drawn("recommended", "recommended, by largest setting", ENDED, True, cap, value, half, notes))
    return out


def _inside(sweep: Sweep, d: _Drawn, x: Array, frame: tuple[float, float]) -> Series:
    """The points inside the frame, in groups of one window."""
    selected = (d.value >= frame[0]) & (d.value <= frame[1])
    groups = [f"{w:.3g}" for w in series.on_axis(sweep, d.window[selected])]
    notes = [note for note, k in zip(d.notes, selected, strict=True) if k]
    return series.points(d.key, d.name, x[selected], d.value[selected], notes, groups)


def frame_of(sweep: Sweep, published: tuple[Comparison, ...] = ()) -> tuple[float, float]:
    """Range of values shown: the recommendation and the published values in full, the rest as it fits."""
    known = [e.value for e in sweep.forms]
    middle = sweep.value if sweep.value is not None else float(np.median(known)) if known else 0.0
    reach = [abs(c.published - middle) * 1.1 for c in published] + [1.6 * (sweep.u95 or 0.0)]
    close = [abs(v - middle) for v in known]
    inner = max(reach)
    wanted = max(inner, min(float(np.quantile(close, 0.9)), 2.5 * inner) if close and inner else 0.0)
    half = 1.12 * wanted or max(close, default=0.0) or abs(middle) or 1.0
    return middle - half, middle + half


def _recommended(
    axes: Axes, sweep: Sweep, published: tuple[Comparison, ...], factor: float, palette: Mapping[str, str]
) -> None:
    if sweep.value is not None and sweep.u95 is not None:
        low, high = ((sweep.value + side * sweep.u95) * factor for side in (-1.0, 1.0))
        axes.axhspan(low, high, color=palette["band"], alpha=0.35, linewidth=0)
        axes.axhline(sweep.value * factor, color=palette["ink"], linewidth=0.9)
    for c in published:
        axes.axhline(c.published * factor, color=palette["ink"], linewidth=1.1, linestyle=(0, (1.0, 2.0)))


def _mark(axes: Axes, d: _Drawn, x: Array, factor: float, palette: Mapping[str, str] = COLOURS) -> None:
    d = replace(d, style=replace(d.style, colour=recoloured(d.style.colour, palette)))
    low, high = axes.get_ylim()
    y, half = d.value * factor, d.half * factor
    seen, inside = (y - half <= high) & (y + half >= low), (y >= low) & (y <= high)
    if np.any(seen):
        ends = np.clip(y - half, low, high)[seen], np.clip(y + half, low, high)[seen]
        series.tagged(strokes(axes, (x[seen], x[seen]), ends, color=d.style.colour, linewidth=_thick(d)), d.key)
    if np.any(inside):
        markers = axes.plot(x[inside], y[inside], linestyle="none", zorder=4 if d.recommended else 3, **_marker(d))
        series.tagged(markers, d.key)


def _thick(d: _Drawn) -> float:
    return 1.6 if d.recommended else 0.7


def _marker(d: _Drawn) -> dict[str, Any]:
    return {
        "marker": d.style.marker, "markersize": 5.0 if d.recommended else 3.2, "markeredgecolor": d.style.colour,
        "markerfacecolor": d.style.colour if d.recommended else "none", "markeredgewidth": 0.9,
    }  # fmt: skip


def _handles(sweep: Sweep, drawn: list[_Drawn], published: tuple[Comparison, ...]) -> list[Any]:
    handles: list[Any] = []
    for d in drawn:
        handles.append(Line2D([], [], color=d.style.colour, linewidth=_thick(d), label=d.name, **_marker(d)))
        series.tagged(handles[-1], d.key)
    if sweep.value is not None:
        handles.append(Patch(facecolor=COLOURS["band"], alpha=0.35, edgecolor="none", label="recommended ± U95"))
    if published:
        handles.append(
            Line2D([], [], color=COLOURS["ink"], linewidth=1.1, linestyle=(0, (1.0, 2.0)), label="published")
        )
    return handles


def _caption(sweep: Sweep, published: tuple[Comparison, ...], frame: tuple[float, float]) -> str:
    name = primed(sweep.symbol)
    text = f"What single forms give for {name} by largest setting, with 95 % intervals (HC2) that trust the form. "
    if sweep.value is not None:
        text += f"Band: the recommended {plus_minus(sweep.value, sweep.u95, PLUS_MINUS)}, which trusts none. "
    if sweep.sensitivity:
        text += "Filled: the recommended value had the sweep ended there. "
    for c in published:
        text += f"Published: {coefficient(c.published)} ({c.reference}, read with {c.reading}). "
    beyond = sum(not frame[0] <= e.value <= frame[1] for e in sweep.forms)
    if beyond:
        text += f"{beyond} of {len(sweep.forms)} estimates lie beyond the frame. "
    return text.strip()


def _description(sweep: Sweep, published: tuple[Comparison, ...]) -> str:
    value = "none" if sweep.value is None else plus_minus(sweep.value, sweep.u95, PLUS_MINUS)
    spread = [e.value for e in sweep.forms]
    forms = f"; single forms from {coefficient(min(spread))} to {coefficient(max(spread))}" if spread else ""
    there = "".join(f"; published {coefficient(c.published)}" for c in published)
    return text_of(
        "estimator_figure.description",
        spread=len(spread),
        symbol=primed(sweep.symbol),
        value=value,
        forms=forms,
        there=there,
    )
