"""Figures of the first page, 86 mm wide: the slope itself, every coefficient over the published one, axes and signs."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from typing import Any, Literal

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Drawing
from matplotlib.lines import Line2D
from matplotlib.patches import Circle, Patch, PathPatch, Polygon
from matplotlib.path import Path

from coeflab.core.table import LARGE, LARGEST_SHARE, coefficient, plus_minus
from coeflab.core.types import Array
from coeflab.core.wording import listed
from coeflab.fits.results.fit_result import Sweep
from coeflab.law.symbols import primed
from coeflab.report.acceptance import Acceptance, share
from coeflab.report.document import AnswerRow, Figure, Series
from coeflab.report.figures.artists import bare, label, strokes, text_width
from coeflab.report.figures.palette import COLOURS, power_of_ten
from coeflab.report.figures.panel import SIZE, Range, framed_legend, limits, tick_texts, ticks
from coeflab.report.figures.series import curve, numbers, points, tagged
from coeflab.report.figures.svg import POINTS, settings, svg_text
from coeflab.report.figures.sweep import fine_curve
from coeflab.report.notation import as_users_wrote
from coeflab.report.texts import text_of

WIDTH, HEIGHT = 244.0, 208.0  # points; a column of a journal, 86 mm
LONGEST = 60
ROW, LEGEND, BOTTOM = 12.2, 16.0, 34.0
# As the published columns come: experiment, steady CFD, PMM CFD.
MARKS = (("D", COLOURS["ink"]), ("s", COLOURS["b"]), ("^", COLOURS["c"]), ("v", COLOURS["d"]))
DOTTED = (0, (1.0, 2.0))
NEAR, NEXT = 0.25, 0.06  # of the largest setting: below, a quotient may leave the frame; it is the slope
WIDEST = 2.0  # a forest shows no more than this beside 1


@as_users_wrote
def slope_figure(sweep: Sweep, row: AnswerRow, published: str = "", at: float | None = None) -> Figure:
    """Force over motion against the size of the motion: level where the force is proportional, at rest the slope.

    Parameters
    ----------
    sweep : Sweep
        Of a slope at the origin with a value.
    row : AnswerRow
        Its value and U95, which may hold more than those of the sweep.
    published, at : str, float or None
        A published column and its value, drawn as a line.
    """
    value, u95 = float(row.value or 0.0), row.u95 or 0.0
    name = primed(sweep.symbol)
    quotient = f"({sweep.component}' - {sweep.component}0') / {sweep.variable}'"
    moving = np.abs(sweep.x) > 0.0
    x, y = sweep.x[moving], (sweep.y[moving] - sweep.at_rest[0]) / sweep.x[moving]
    reach = float(np.max(np.abs(x)))
    sides = [(side, _side(sweep, side)) for side in (1.0, -1.0) if np.any(np.sign(x) == side)]
    far = np.abs(x) > NEAR * reach
    shown = np.concatenate([y[far], [value - u95, value + u95], *(line[1] for _, line in sides)])
    shown = shown if at is None else np.append(shown, at)
    frame = limits(shown, 0.08) or (-1.0, 1.0)
    factor, power = power_of_ten(max(abs(f) for f in frame))
    up = (frame[0] * factor, frame[1] * factor)
    left_out = int(np.sum((y < frame[0]) | (y > frame[1])))
    title = f"{name}, {sweep.campaign[:LONGEST]}: the slope at zero {'rate' if sweep.variable in ('p', 'q', 'r') else 'angle'}"
    description = (
        f"{len(x)} points of {quotient} against |{sweep.variable}'|; {name} = {plus_minus(value, row.u95)} is where they end at rest"
        + (f"; {published} {coefficient(at)}." if at is not None else ".")
    )
    across = f"|{sweep.variable}'|  [-]"
    rows = -(-(len(sides) + bool(row.u95) + (at is not None)) // 2)
    with settings():
        figure, axes = _drawing(
            24.0 + max(text_width(text, SIZE) for text in tick_texts(ticks(up, 5))), 8.0, rows, across=(0.0, 1.04 * reach), up=up, name_across=across,
            name_up=f"{quotient}{power}",
        )  # fmt: skip
        handles, series = _sides(axes, sides, x, y, sweep, factor)
        if row.u95:
            low, high = ((value + k * row.u95) * factor for k in (-1.0, 1.0))
            tagged(axes.axhspan(low, high, color=COLOURS["band"], alpha=0.35, linewidth=0), "value")
            handles.append(Patch(facecolor=COLOURS["band"], alpha=0.35, label=f"{name} ± U95"))
        tagged(axes.axhline(value * factor, color=COLOURS["ink"], linewidth=1.2), "value")
        ends = np.array([0.0, 1.04 * reach])
        series.append(curve("value", f"{name} at rest", ends, np.full(2, value)))
        if at is not None:
            line = axes.axhline(at * factor, color=COLOURS["ink"], linewidth=1.2, linestyle=DOTTED)
            handles.append(
                tagged(
                    Line2D([], [], color=COLOURS["ink"], linewidth=1.2, linestyle=DOTTED, label=published), "published"
                )
            )
            tagged(line, "published")
            series.append(curve("published", published, ends, np.full(2, at)))
        framed_legend(figure, handles, 6.0, HEIGHT - 4.0 - rows * ROW)
        panel = numbers(axes, series, across, quotient, factor)
        svg = svg_text(figure, "answer-slope", title, description)
    caption = f"{name} is the value of {quotient} at |{sweep.variable}'| = 0. A linear force gives a horizontal line."
    wrong = ", ".join(sweep.labels[i] for i in sweep.wrong)
    caption += f" Without point {wrong}, which does not fit the others (cross)." if wrong else ""
    caption += f" {left_out} near zero {'lies' if left_out == 1 else 'lie'} outside the frame." if left_out else ""
    return Figure("answer-slope", svg, title, caption, description, (panel,))


def _side(sweep: Sweep, side: float) -> tuple[Array, Array]:
    """The recommended curve on one side, as size and quotient from rest on."""
    x, y, _ = fine_curve(sweep)
    mine = side * x > NEXT * np.max(np.abs(x))
    order = np.argsort(np.abs(x[mine]))
    x, y = x[mine][order], y[mine][order]
    return np.append(0.0, np.abs(x)), np.append(float(sweep.value or 0.0), (y - sweep.at_rest[0]) / x)


def _sides(
    axes: Axes, sides: Sequence[tuple[float, tuple[Array, Array]]], x: Array, y: Array, sweep: Sweep, factor: float
) -> tuple[list[Any], list[Series]]:
    """Points and curve of each side; what the legend shows and the numbers."""
    handles: list[Any] = []
    series: list[Series] = []
    moving = np.flatnonzero(np.abs(sweep.x) > 0.0)
    for side, (size, quotient) in sides:
        key, colour = ("plus", COLOURS["a"]) if side > 0.0 else ("minus", COLOURS["b"])
        mine = (np.sign(x) == side) & ~np.isin(moving, sweep.wrong)
        words = f"{sweep.variable}' {'>' if side > 0.0 else '<'} 0"
        look: dict[str, Any] = {
            "color": colour, "marker": "o" if side > 0.0 else "s", "markersize": 3.8, "markeredgewidth": 0.9,
            "markerfacecolor": colour if side > 0.0 else "none", "linestyle": "-" if side > 0.0 else (0, (4.0, 2.0)),
        }  # fmt: skip
        tagged(axes.plot(size, quotient * factor, color=colour, linewidth=1.0, linestyle=look["linestyle"]), key)
        marks = {k: v for k, v in look.items() if k not in ("linestyle", "color")}
        tagged(axes.plot(np.abs(x[mine]), y[mine] * factor, linestyle="none", color=colour, zorder=3, **marks), key)
        handles.append(tagged(Line2D([], [], linewidth=1.0, label=f"{words}, fitted curve", **look), key))
        notes = [f"point {sweep.labels[i]}" for i, yes in zip(moving, mine, strict=True) if yes]
        series.append(points(key, words, np.abs(x[mine]), y[mine], notes))
        series.append(curve(key, f"{words}, fitted curve", size, quotient))
    wrong = np.isin(moving, sweep.wrong)
    if np.any(wrong):
        look = {"marker": "x", "markersize": 5.0, "markeredgecolor": COLOURS["ink"], "markeredgewidth": 1.1}
        tagged(axes.plot(np.abs(x[wrong]), y[wrong] * factor, linestyle="none", zorder=3, **look), "wrong")
        notes = [f"point {sweep.labels[i]}" for i in moving[wrong]]
        series.append(points("wrong", "left out", np.abs(x[wrong]), y[wrong], notes))
    return handles, series


def forest_figure(rows: Sequence[AnswerRow], columns: Sequence[str], compared: str) -> Figure | None:
    """Ours with U95 and the published values of every row, over one published column; over ours where there is none.

    Parameters
    ----------
    rows : sequence of AnswerRow
    columns : sequence of str
    compared : str
        The column that all are divided by; empty divides each by itself.
    """
    first = columns.index(compared) if compared in columns else None
    selected = [(r, by) for r in rows if (by := r.value if first is None else r.published[first])]
    if not selected:
        return None
    name = f"value / {compared}" if compared else "value ± U95, over the value"
    title = (
        f"Coefficients, divided by those of {compared}"
        if compared
        else "U95 of every coefficient, divided by its value"
    )
    n = len(selected)
    level = np.arange(n, 0.0, -1.0)
    across = _reach(selected)
    legend_rows = -(-(1 + len(columns)) // 2)
    words = "; ".join(f"{primed(r.symbol)}: {_label(r, by, columns)}" for r, by in selected)
    with settings():
        names = [primed(r.symbol) for r, _ in selected]
        beyond = [
            f"± {share_text(r.u95 / r.value)}" if r.u95 and r.value else r.status or "no U95" for r, _ in selected
        ]
        left, right = (max(text_width(text, SIZE) for text in texts) + 10.0 for texts in (names, beyond))
        figure, axes = _drawing(
            left, right, legend_rows, across=across, up=(0.4, n + 0.6), name_across=name, rows=names, beyond=beyond
        )
        handles, series = _ours(axes, selected, level, across)
        if compared:
            axes.axvline(1.0, color=COLOURS["ink"], linewidth=0.9, zorder=1)
        for i, column in enumerate(columns):
            marker, colour = MARKS[i % len(MARKS)]
            look: dict[str, Any] = {
                "marker": marker, "markersize": 4.2, "markerfacecolor": "none", "markeredgecolor": colour,
                "markeredgewidth": 1.0, "linestyle": "none",
            }  # fmt: skip
            pairs = [
                (p / by, k, r) for (r, by), k in zip(selected, level, strict=True) if (p := r.published[i]) is not None
            ]
            at, high = np.array([p[0] for p in pairs]), np.array([p[1] for p in pairs])
            inside = (at >= across[0]) & (at <= across[1])
            tagged(axes.plot(at[inside], high[inside], zorder=2.5, **look), f"column{i}")
            handles.append(tagged(Line2D([], [], label=column, **look), f"column{i}"))
            notes = [f"{primed(r.symbol)}: {r.shown[i]}" for _, _, r in pairs]
            series.append(points(f"column{i}", column, at, high, notes))
        framed_legend(figure, handles, 6.0, HEIGHT - 4.0 - legend_rows * ROW)
        panel = numbers(axes, series, f"{name}  [-]", "row", bars="across")
        svg = svg_text(figure, "answer-forest", title, words)
    outside = [
        primed(r.symbol) for r, by in selected if r.value is not None and not across[0] <= r.value / by <= across[1]
    ]
    caption = "Bars: our U95, at the right in % of ours." + (f" Line: {compared}." if compared else "")
    caption += f" Ours lies outside the frame: {', '.join(outside)}." if outside else ""
    ends = [r.value / by + k * (r.u95 or 0.0) / by for r, by in selected if r.value is not None for k in (-1.0, 1.0)]
    caption += (
        " Arrow: the bar goes on." if min(ends, default=1.0) < across[0] or max(ends, default=1.0) > across[1] else ""
    )
    return Figure("answer-forest", svg, title, caption, words, (panel,))


def _reach(shown: Sequence[tuple[AnswerRow, float]]) -> Range:
    """Range of the quotients, bars included, about 1; beside others a value of open sign over itself, whose bar has an arrow, sets none."""
    ends = [1.0]
    for r, by in [(r, by) for r, by in shown if by != r.value or abs(by) > (r.u95 or 0.0)] or shown:
        ends += [p / by for p in r.published if p is not None]
        if r.value is not None:
            ends += [(r.value + k * (r.u95 or 0.0)) / by for k in (-1.0, 1.0)]
    low, high = max(min(ends), 1.0 - WIDEST), min(max(ends), 1.0 + WIDEST)
    room = 0.06 * (high - low) or 0.1
    return low - room, high + room


def _ours(
    axes: Axes, shown: Sequence[tuple[AnswerRow, float]], level: Array, across: Range
) -> tuple[list[Any], list[Series]]:
    mine = [
        (r.value / by, (r.u95 or 0.0) / abs(by), k, r)
        for (r, by), k in zip(shown, level, strict=True)
        if r.value is not None
    ]
    at, half, high = (np.array([m[i] for m in mine]) for i in range(3))
    handle = draw_intervals(axes, at, half, high, "ours", COLOURS["a"], across)
    handle.set_label("ours, U95")
    notes = [f"{primed(r.symbol)}: {plus_minus(r.value, r.u95, '±')}" for *_, r in mine]
    return [handle], [points("ours", "ours", at, high, notes)]


def draw_intervals(
    axes: Axes, at: Array, half: Array, high: Array, key: str, colour: str, across: Range = (-np.inf, np.inf)
) -> Any:
    """Values with bars, one a level; returns what a legend shows.

    Parameters
    ----------
    axes : Axes
    at, half, high : (n,) array
        Values, half-widths, and the level of each.
    key : str
        Of the series.
    colour : str
    across : (float, float)
        Ends of the axis; a bar that goes on beyond has an arrow there.
    """
    look: dict[str, Any] = {"color": colour, "marker": "o", "markersize": 5.0}
    if len(at):
        low, top = (np.clip(at + k * half, *across) for k in (-1.0, 1.0))
        tagged(strokes(axes, (low, top), (high, high), color=colour, linewidth=2.2, zorder=2), key)
        inside = (at >= across[0]) & (at <= across[1])
        tagged(axes.plot(at[inside], high[inside], linestyle="none", zorder=3, **look), key)
        for cut, end, marker in ((at - half < across[0], across[0], "<"), (at + half > across[1], across[1], ">")):
            if np.any(cut):
                arrow = {**GOES_ON, "marker": marker, "color": colour}
                tagged(axes.plot(np.full(int(cut.sum()), end), high[cut], clip_on=False, **arrow), key)
    return tagged(Line2D([], [], linewidth=2.2, **look), key)


def share_text(share: float) -> str:
    """A part of a value: whole per cent, below ten with one decimal; above the value itself only that."""
    share = 100.0 * abs(share)
    return LARGE if share > LARGEST_SHARE else f"{share:.0f} %" if share >= 9.95 else f"{share:.1f} %"


def _label(r: AnswerRow, by: float, columns: Sequence[str]) -> str:
    ours = r.status or "no value" if r.value is None else f"ours {r.value / by:.2f}"
    if r.value is not None and r.u95:
        ours += f" +- {r.u95 / abs(by):.2f}"
    each = [f"{c} {p / by:.2f}" for c, p in zip(columns, r.published, strict=True) if p is not None]
    return listed([ours, *each])


def _drawing(
    left: float,
    right: float,
    legend_rows: int,
    *,
    across: Range,
    up: Range,
    name_across: str,
    name_up: str = "",
    rows: Sequence[str] = (),
    beyond: Sequence[str] = (),
    steps: int = 5,
    height: float = HEIGHT,
    above: bool = False,
) -> tuple[Drawing, Axes]:
    """A figure of one column's width and its ruled axes; with ``rows`` their names and ``beyond``, beside the frame or ``above`` each row."""
    figure = Drawing(figsize=(WIDTH / POINTS, height / POINTS))
    wide, high = WIDTH - left - right, height - BOTTOM - 8.0 - LEGEND / 4.0 - legend_rows * ROW
    axes = bare(figure, (left / WIDTH, BOTTOM / height, wide / WIDTH, high / height))
    axes.set_xlim(*across)
    axes.set_ylim(*up)
    at_x, at_y = ticks(across, steps), ticks(up, 5)
    x = left + wide * (at_x - across[0]) / (across[1] - across[0])
    if rows:
        strokes(axes, (at_x, at_x), up, color=COLOURS["rule"], linewidth=0.5, zorder=0)
        levels = BOTTOM + high * (np.arange(len(rows), 0.0, -1.0) - up[0]) / (up[1] - up[0])
        place, lift = (left, 5.0) if above else (left - 6.0, -2.9)
        side: Literal["left", "right"] = "left" if above else "right"
        for k, name, words in zip(levels, rows, beyond, strict=True):
            label(figure, place / WIDTH, (k + lift) / height, name, side)
            label(figure, (WIDTH - 3.0) / WIDTH, (k + lift) / height, words, "right", color=COLOURS["muted"])
    else:
        strokes(axes, across, (at_y, at_y), color=COLOURS["rule"], linewidth=0.5, zorder=0)
        levels = BOTTOM + high * (at_y - up[0]) / (up[1] - up[0])
        for k, words in zip(levels, tick_texts(at_y), strict=True):
            label(figure, (left - 5.0) / WIDTH, (k - 2.9) / height, words, "right")
        label(figure, (7.5 + 0.35 * SIZE) / WIDTH, (BOTTOM + high / 2.0) / height, name_up, rotation=90)
    axes.add_artist(
        Line2D([across[0], across[1]], [up[0], up[0]], color=COLOURS["muted"], linewidth=0.9, clip_on=False, zorder=1.5)
    )
    for place, words in zip(x, tick_texts(at_x), strict=True):
        label(figure, place / WIDTH, (BOTTOM - 12.5) / height, words)
    label(figure, (left + wide / 2.0) / WIDTH, (BOTTOM - 26.5) / height, name_across)
    return figure, axes


SKETCH, LEVEL = 92.0, 56.0


def axes_figure() -> Figure:
    """Axes and signs in three views; a turn goes the shorter way from one axis to the next: y to z, z to x, x to y."""
    title = "Axes and signs"
    description = text_of("axes_figure.description")
    with settings():
        figure = Drawing(figsize=(WIDTH / POINTS, SKETCH / POINTS))
        axes = bare(figure, (0.0, 0.0, 1.0, 1.0))
        axes.set_xlim(0.0, WIDTH)
        axes.set_ylim(0.0, SKETCH)
        for left, name in ((1.0, "from above"), (90.0, "from starboard"), (180.0, "from astern")):
            label(figure, left / WIDTH, (SKETCH - 9.0) / SKETCH, name, "left", color=COLOURS["muted"])
        _body(axes, 30.0)
        _body(axes, 119.0)
        axes.add_patch(Circle((198.0, LEVEL), 8.0, facecolor=COLOURS["band"], alpha=0.35, linewidth=0))
        axes.add_patch(Circle((198.0, LEVEL), 8.0, facecolor="none", edgecolor=COLOURS["muted"], linewidth=0.8))
        _axes_pair(figure, axes, 30.0, 40.0, ("x, u, X", "y, v, Y", "r, N"), towards_down=True)
        _axes_pair(figure, axes, 119.0, 40.0, ("x, u, X", "z, w, Z", "q, M"), towards_down=False)
        _axes_pair(figure, axes, 198.0, 28.0, ("y, v, Y", "z, w, Z", "p, K"), towards_down=True)
        svg = svg_text(figure, "answer-axes", title, description)
    return Figure(
        "answer-axes", svg, title, "Arrows: positive directions. Forces act from the fluid on the body.", description
    )


def _body(axes: Axes, x: float) -> None:
    """A hull about a place, the bow to the right."""
    y, long, deep = LEVEL, 28.0, 5.5
    stern, bow = x - long, x + long
    body = Path(
        [(bow, y), (bow, y + deep), (bow - 10.0, y + deep), (bow - 14.0, y + deep), (x - 10.0, y + deep), (stern + 8.0, y + deep),
         (stern, y), (stern + 8.0, y - deep), (x - 10.0, y - deep), (bow - 14.0, y - deep), (bow - 10.0, y - deep), (bow, y - deep),
         (bow, y)],
        [Path.MOVETO, Path.CURVE4, Path.CURVE4, Path.CURVE4, Path.LINETO, Path.CURVE3, Path.CURVE3, Path.CURVE3, Path.CURVE3,
         Path.LINETO, Path.CURVE4, Path.CURVE4, Path.CURVE4],
    )  # fmt: skip
    axes.add_patch(PathPatch(body, facecolor=COLOURS["band"], alpha=0.35, linewidth=0))
    axes.add_patch(PathPatch(body, facecolor="none", edgecolor=COLOURS["muted"], linewidth=0.8))


def _axes_pair(
    figure: Drawing, axes: Axes, x: float, ahead: float, names: tuple[str, str, str], *, towards_down: bool
) -> None:
    """An axis to the right and one down, and between them the turn from one to the other."""
    right, down, turn = names
    y = LEVEL
    _arrow(axes, (x, y), (x + ahead, y))
    _arrow(axes, (x, y), (x, y - 40.0))
    label(figure, (x + ahead + 6.0) / WIDTH, (y + 8.0) / SKETCH, right, "right")
    label(figure, (x + 6.0) / WIDTH, (y - 45.0) / SKETCH, down, "left")
    angle = -np.linspace(np.radians(20.0), np.radians(66.0), 21)[:: 1 if towards_down else -1]
    arc = np.column_stack([x + 20.0 * np.cos(angle), y + 20.0 * np.sin(angle)])
    axes.add_artist(Line2D(*arc.T, color=COLOURS["a"], linewidth=1.2))
    _head(axes, arc[-1], arc[-1] - arc[-2], COLOURS["a"])
    label(figure, (x + 20.0) / WIDTH, (y - 26.0) / SKETCH, turn, "left", color=COLOURS["a"])


def _arrow(axes: Axes, start: tuple[float, float], end: tuple[float, float]) -> None:
    axes.add_artist(Line2D([start[0], end[0]], [start[1], end[1]], color=COLOURS["ink"], linewidth=1.2))
    _head(axes, np.array(end), np.subtract(end, start), COLOURS["ink"])


def _head(axes: Axes, tip: Array, along: Array, colour: str) -> None:
    """A filled head whose tip lies a little beyond the end of a line."""
    ahead = along / np.hypot(*along)
    side = np.array([-ahead[1], ahead[0]])
    axes.add_patch(
        Polygon([tip + 5.0 * ahead, tip + 2.4 * side, tip - 2.4 * side], closed=True, facecolor=colour, linewidth=0)
    )


LINE, INSET = 19.5, 6.0  # points: a name and its bar below; left of both
GOES_ON: dict[str, Any] = {
    "linestyle": "none", "marker": ">", "markersize": 6.0, "color": COLOURS["b"], "markeredgewidth": 0.0, "zorder": 3,
}  # fmt: skip


def shares_figure(found: Acceptance) -> Figure:
    """Of every table of a publication the largest difference over its tolerance, as a bar."""
    title = "Largest difference over tolerance, by table"
    shares = [[abs(s) for r in t.rows if not np.isnan(s := share(r))] for t in found.tables]
    # Two decimals: further ones differ from one linear algebra to the next, and a page must not.
    found_largest = [round(max(s, default=0.0), 2) for s in shares]
    largest = np.minimum(found_largest, WIDEST)
    n = len(found.tables)
    words = "; ".join(f"{t.title}: {s:.2f}" for t, s in zip(found.tables, found_largest, strict=True))
    across = (0.0, max(1.05, 1.05 * float(largest.max(initial=0.0))))
    with settings():
        counts = [t.within for t in found.tables]
        right = 12.0 + max(text_width(count, SIZE) for count in counts)
        names = [_cut(t.title, 0.93 * (WIDTH - INSET - right)) for t in found.tables]
        figure, axes = _drawing(
            INSET, right, 0, across=across, up=(0.6, n + 0.8), name_across="worst / tolerance  [-]", rows=names, beyond=counts,
            steps=2, height=BOTTOM + 12.0 + LINE * (n + 0.2), above=True,
        )  # fmt: skip
        level = np.arange(n, 0.0, -1.0)
        colours = [COLOURS["a"] if t.holds else COLOURS["b"] for t in found.tables]
        for k, s, colour in zip(level, largest, colours, strict=True):
            tagged(strokes(axes, ([0.0], [s]), ([k], [k]), color=colour, linewidth=4.5, zorder=2), "share")
        cut = np.array([s > WIDEST for s in found_largest])
        if np.any(cut):
            tagged(axes.plot(largest[cut], level[cut], clip_on=False, **GOES_ON), "cut")
        axes.axvline(1.0, color=COLOURS["ink"], linewidth=1.2, linestyle=DOTTED, zorder=3)
        notes = [f"{t.title}: {s:.2f}" for t, s in zip(found.tables, found_largest, strict=True)]
        panel = numbers(
            axes, [points("share", "share", largest, level, notes)], "worst / tolerance  [-]", "table", bars="across"
        )
        svg = svg_text(figure, "answer-shares", title, words)
    caption = "A bar is the worst number of a table, at the right how many are within the tolerance; the dotted line is the tolerance."
    if np.any(cut):
        caption += f" An arrow means that the bar continues beyond {WIDEST:g}; the table has its length."
    return Figure("answer-shares", svg, title, caption, words, (panel,))


def _cut(text: str, room: float) -> str:
    """As many words as fit above a bar."""
    words = text.split()
    selected = next(
        n for n in range(len(words), -1, -1) if text_width(" ".join(words[:n]) + " …", SIZE) <= room or n <= 1
    )
    return text if selected == len(words) else " ".join(words[:selected]).rstrip(",") + " …"


def renamed(drawn: Figure, anchor: str) -> Figure:
    """The same drawing under another anchor, so that a page can hold it twice."""
    svg = re.sub(rf'(?<=["# (]){re.escape(drawn.anchor)}-(?=\d|title|desc)', f"{anchor}-", drawn.svg)
    return replace(drawn, anchor=anchor, svg=svg, scene=None)
