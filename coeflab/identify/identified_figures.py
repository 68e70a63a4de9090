"""The figure of an identification: values beside those of the parameter file, and how often each term was kept."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Drawing
from matplotlib.lines import Line2D

from coeflab.core.table import coefficient, plus_minus
from coeflab.identify.identified import Identified, IdentifiedTerm, Outcome
from coeflab.identify.thruster import BenchTest
from coeflab.report.document import Figure, Panel
from coeflab.report.figures.laws import Plot, Trace, laws_figure
from coeflab.report.figures.palette import COLOURS
from coeflab.report.figures.panel import tick_texts, ticks
from coeflab.report.figures.series import numbers, points
from coeflab.report.figures.svg import POINTS, settings, svg_text
from coeflab.report.notation import as_users_wrote

WIDTH, LEFT, MIDDLE, RIGHT = 340.0, 46.0, 14.0, 12.0
VALUES = 190.0
BOTTOM, HEAD, ROW = 34.0, 30.0, 15.0
REACH = 2.0
CURVE = 57  # points of a drawn curve
MARKS: dict[Outcome, dict[str, Any]] = {
    Outcome.IDENTIFIED: {"marker": "o", "markersize": 4.4, "color": COLOURS["a"]},
    Outcome.BIASED: {"marker": "x", "markersize": 4.4, "color": COLOURS["a"]},
    Outcome.EXCHANGEABLE: {
        "marker": "o", "markersize": 4.4, "color": COLOURS["a"], "markerfacecolor": "#ffffff", "markeredgewidth": 0.9,
    },
}  # fmt: skip
FROM_FILE: dict[str, Any] = {"marker": "D", "markersize": 3.4, "color": COLOURS["b"]}


@as_users_wrote
def identified_figure(found: Identified, anchor: str) -> Figure:
    """One row a candidate: identified and file's value in units of the larger, and the inclusion frequency."""
    rows = list(found.terms)
    title = f"{found.name}: identified from motions, and the parameter file"
    caption = (
        "Left: each value over the size of the file's, or of the identified one where the file has none, so that the file's "
        "stands at +1 or −1. Bars: 95 % intervals of the identification, which hold scatter alone, and U95 of the file. "
        "Values beyond the frame have an arrow. Right: share of the resamples whose sparse fit keeps the term; n: not "
        "identifiable."
    )
    description = ", ".join(f"{t.symbol} {t.outcome.value}" for t in rows) + "."
    with settings():
        tall = BOTTOM + HEAD + ROW * max(len(rows), 1)
        figure = Drawing(figsize=(WIDTH / POINTS, tall / POINTS))
        panels = (_values(figure, rows, tall), _frequencies(figure, rows, tall))
        marks = [
            Line2D([], [], linestyle="none", label=o.value, **style)
            for o, style in MARKS.items()
            if o is not Outcome.BIASED or o in {t.outcome for t in rows}
        ]
        marks.append(Line2D([], [], linestyle="none", label="parameter file", **FROM_FILE))
        figure.legend(
            handles=marks, loc="upper left", bbox_to_anchor=((LEFT - 8.0) / WIDTH, 1.0), ncols=3, borderpad=0.2,
            borderaxespad=0.0, handletextpad=0.2, columnspacing=1.2,
        )  # fmt: skip
        svg = svg_text(figure, anchor, title, description)
    return Figure(anchor, svg, title, caption, description, panels)


def bench_figure(found: BenchTest, source: str = "") -> Figure:
    """Loads of a rotor over its command: means of the steady stretches, the identified curve, and the file's.

    Parameters
    ----------
    found : BenchTest
    source : str
        What a reader has to know of the series, in words.
    """
    n = np.linspace(min(0.0, float(np.min(found.command))), max(0.0, float(np.max(found.command))), CURVE)
    plots = []
    for law in found.laws:
        traces = [
            Trace("steady stretches", found.command, found.loads[law.load], 0, "hollow"),
            Trace("identified", n, found.at(law, n), 0),
        ]
        if law.file_value is not None:
            traces.append(Trace("parameter file", n, law.file_value[0] * n + law.file_value[1] * n**2, -1))
        last = law is found.laws[-1]
        plots.append(Plot(f"{law.load}  [{law.unit}]", f"speed  [{found.unit}]", tuple(traces), 110.0, is_scaled=last))
    files = ", ".join(found.files)
    return laws_figure(
        f"bench-{found.thruster}", f"Bench test of {found.thruster}: loads over the command",
        f"{source or files + '.'} Means of {len(found.command)} steady stretches, the curves identified from them and those of the "
        "parameter file.",
        f"Loads of {found.thruster} over its command: points, and two curves through them.", plots,
    )  # fmt: skip


def _axes(figure: Drawing, left: float, width: float, tall: float, rows: int, across: tuple[float, float]) -> Axes:
    axes = figure.add_axes((left / WIDTH, BOTTOM / tall, width / WIDTH, ROW * max(rows, 1) / tall))
    axes.set_axis_off()
    axes.set_xlim(*across)
    axes.set_ylim(-0.5, max(rows, 1) - 0.5)
    at = ticks(across, 4)
    axes.vlines(at, -0.5, max(rows, 1) - 0.5, color=COLOURS["rule"], linewidth=0.5, zorder=0)
    for x, text in zip(at, tick_texts(at), strict=True):
        place = left + width * (float(x) - across[0]) / (across[1] - across[0])
        figure.text(place / WIDTH, (BOTTOM - 13.5) / tall, text, ha="center", va="baseline")
    return axes


def _values(figure: Drawing, rows: list[IdentifiedTerm], tall: float) -> Panel:
    axes = _axes(figure, LEFT, VALUES, tall, len(rows), (-REACH, REACH))
    axes.axvline(0.0, color=COLOURS["muted"], linewidth=0.6, zorder=1)
    for k, t in enumerate(rows):
        y = len(rows) - 1.0 - k
        figure.text((LEFT - 5.5) / WIDTH, (BOTTOM + (y + 0.5) * ROW - 2.9) / tall, t.symbol, ha="right", va="baseline")
        size = abs(t.file_value or t.value or 1.0)
        if t.file_value is not None:
            _mark(axes, t.file_value / size, y + 0.14, FROM_FILE)
            if t.file_u95 is not None:
                _bar(
                    axes, (t.file_value - t.file_u95) / size, (t.file_value + t.file_u95) / size, y + 0.14, COLOURS["b"]
                )
        if t.value is not None:
            _mark(axes, t.value / size, y - 0.14, MARKS[t.outcome])
            if t.low is not None and t.high is not None:
                _bar(axes, t.low / size, t.high / size, y - 0.14, COLOURS["a"])
    figure.text((LEFT + VALUES / 2.0) / WIDTH, (BOTTOM - 27.5) / tall, "over the file's size  [-]", ha="center")
    at = np.arange(len(rows))[::-1] + 0.0
    sizes = np.array([abs(t.file_value or t.value or 1.0) for t in rows])
    own, file = (
        np.array([np.nan if v is None else v for v in vs])
        for vs in zip(*((t.value, t.file_value) for t in rows), strict=True)
    )
    words = (
        points(
            "own",
            "identified",
            own / sizes,
            at - 0.14,
            [_interval_text(t.symbol, t.value, t.low, t.high) for t in rows],
        ),
        points("file", "parameter file", file / sizes, at + 0.14, [_of_file(t) for t in rows]),
    )
    return numbers(axes, words, "over the file's size  [-]", "", bars="across")


def _interval_text(symbol: str, value: float | None, low: float | None, high: float | None) -> str:
    """A value with the ends of its interval."""
    ends = "" if low is None or high is None else f", {coefficient(low)} to {coefficient(high)}"
    return f"{symbol} = {coefficient(value)}{ends}"


def _of_file(t: IdentifiedTerm) -> str:
    return f"{t.symbol} = {plus_minus(t.file_value, t.file_u95, '±')}"


def _mark(axes: Axes, x: float, y: float, style: dict[str, Any]) -> None:
    inside = max(-REACH, min(REACH, x))
    arrow = {} if inside == x else {"marker": ">" if x > 0.0 else "<"}
    axes.plot([inside], [y], linestyle="none", zorder=3, clip_on=False, **{**style, **arrow})


def _bar(axes: Axes, low: float, high: float, y: float, colour: str) -> None:
    ends = [max(-REACH, min(REACH, x)) for x in (low, high)]
    axes.plot(ends, [y, y], color=colour, linewidth=1.2, zorder=2)


def _frequencies(figure: Drawing, rows: list[IdentifiedTerm], tall: float) -> Panel:
    left = LEFT + VALUES + MIDDLE
    width = WIDTH - left - RIGHT
    axes = _axes(figure, left, width, tall, len(rows), (0.0, 100.0))
    for k, t in enumerate(rows):
        y = len(rows) - 1.0 - k
        if t.frequency is None:
            figure.text((left + 3.0) / WIDTH, (BOTTOM + (y + 0.5) * ROW - 2.9) / tall, "n", color=COLOURS["muted"])
            continue
        colour = COLOURS["a"] if t.value is not None else COLOURS["band"]
        axes.barh(y, 100.0 * t.frequency, height=0.6, color=colour, zorder=2)
    figure.text((left + width / 2.0) / WIDTH, (BOTTOM - 27.5) / tall, "kept in  [%]", ha="center")
    shares = np.array([np.nan if t.frequency is None else 100.0 * t.frequency for t in rows])
    words = points("kept", "resamples that keep it", shares, np.arange(len(rows))[::-1] + 0.0, [t.symbol for t in rows])
    return numbers(axes, (words,), "kept in  [%]", "", bars="across")
