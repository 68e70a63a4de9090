"""One panel of a figure: a ruled frame with few ticks.

Ticks and labels are drawn here rather than by Matplotlib's axes, which takes half the time of a whole report.

The legend of a drawing: samples and names in columns above its panels.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backend_bases import RendererBase
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle
from matplotlib.ticker import MaxNLocator
from matplotlib.transforms import Affine2D

from coeflab.core.types import Array
from coeflab.report.figures.artists import bare, label, strokes, text_width
from coeflab.report.figures.palette import COLOURS
from coeflab.report.figures.series import LEGEND, SERIES, SWATCH
from coeflab.report.figures.svg import POINTS

SIZE, ROW = 8.75, 12.2
SAMPLE, PAD, APART, HIGH, DEEP = 2.5 * SIZE, 0.6 * SIZE, SIZE, 0.7 * SIZE, 2.1
COLUMNS = 2


class _Legend(Artist):
    """Artists in one group."""

    def __init__(self, parts: Sequence[Artist], mark: str | None) -> None:
        super().__init__()
        self.parts = parts
        self.set_zorder(5)
        self.set_gid(mark)

    def draw(self, renderer: RendererBase) -> None:
        renderer.open_group("legend", self.get_gid())
        for part in self.parts:
            part.draw(renderer)
        renderer.close_group("legend")


def framed_legend(figure: Figure, handles: Sequence[Any], left: float, bottom: float) -> None:
    """A legend with its lower left corner at a point, in points.

    Entries of handles that `coeflab.report.figures.series.tagged` marked are marked in the drawing.
    """
    keys = [str(h.get_gid() or "") for h in handles]
    marked = any(k.startswith(SERIES) for k in keys)
    rows = -(-len(handles) // COLUMNS) or 1
    wide, tall = figure.get_size_inches() * POINTS
    points = Affine2D().scale(1.0 / wide, 1.0 / tall) + figure.transFigure
    parts: list[Artist] = []
    for first in range(0, len(handles), rows):
        column = handles[first : first + rows]
        for i, handle in enumerate(column):
            base, name = bottom + DEEP + (rows - 1 - i) * ROW, keys[first + i].removeprefix(SERIES)
            sample = _sample(handle, left, base)
            sample.set_transform(points)
            sample.set_figure(figure)
            text = label(figure, (left + SAMPLE + PAD) / wide, base / tall, handle.get_label(), "left", shown=False)
            if marked:
                sample.set_gid(f"{SWATCH}{name}")
                text.set_gid(f"data-label={name}")
            parts += [sample, text]
        left += SAMPLE + PAD + max(text_width(str(h.get_label()), SIZE) for h in column) + APART
    figure.add_artist(_Legend(parts, LEGEND if marked else None))


def _sample(handle: Any, left: float, base: float) -> Artist:
    """What a handle looks like: a line with its marker in the middle, or a patch."""
    if isinstance(handle, Line2D):
        sample = Line2D([left, left + SAMPLE / 2.0, left + SAMPLE], [base + HIGH / 2.0] * 3)
        sample.update_from(handle)
        sample.set_markevery([1])
        return _unclipped(sample)
    patch = Rectangle((left, base), SAMPLE, HIGH)
    if isinstance(handle, Patch):
        patch.update_from(handle)
    else:
        patch.set(facecolor=handle.get_facecolor()[0], linewidth=0.0, alpha=handle.get_alpha())
    return _unclipped(patch)


def _unclipped(artist: Artist) -> Artist:
    artist.set_clip_path(None)
    artist.set_clip_box(None)
    return artist


WIDTH, HEIGHT = 340.0, 336.0
LEFT, RIGHT, BOTTOM, GAP, TICK = 52.0, 10.0, 34.0, 16.0, 3.0
LEGEND_ROW, LEGEND_ROWS = 12.2, 4
TOP = HEIGHT - 4.0 - LEGEND_ROW * LEGEND_ROWS - 8.0
Range = tuple[float, float]
ROUNDING = 1e-10  # of the largest value: less than this is no change


def drawing(height: float = HEIGHT) -> Figure:
    """An empty figure of the report's width."""
    return Figure(figsize=(WIDTH / POINTS, height / POINTS))


def height_of(figure: Figure) -> float:
    """Height of a figure in points."""
    return float(figure.get_figheight()) * POINTS


def limits(values: Array, margin: float) -> Range | None:
    """Range of the finite values with a margin; None where there are none.

    Values that differ by rounding alone count as one, in the middle of a range of a tenth of it to either side; zero, of 1.
    """
    finite = values[np.isfinite(values)]
    if not len(finite):
        return None
    low, high = float(finite.min()), float(finite.max())
    largest = max(abs(low), abs(high))
    room = margin * (high - low) if high - low > ROUNDING * largest else 0.1 * largest
    if room < np.finfo(float).tiny / ROUNDING:
        room = 1.0
    return low - room, high + room


def ticks(within: Range, most: int) -> Array:
    """Round values inside a range, rising even where the range falls (a depth, which grows downward)."""
    low, high = min(within), max(within)
    at = np.asarray(MaxNLocator(most, steps=[1, 2, 2.5, 5, 10]).tick_values(low, high), dtype=float)
    room = 1e-9 * (high - low)
    return at[(at >= low - room) & (at <= high + room)]


def tick_texts(at: Array) -> list[str]:
    """Ticks with as many decimals as tell them apart."""
    if len(at) < 2:
        return [f"{t:g}".replace("-", "−") for t in at]
    decimals = next((d for d in range(9) if np.allclose(np.round(at, d), at, rtol=0, atol=1e-4 * (at[1] - at[0]))), 9)
    return [f"{t + 0.0:.{decimals}f}".replace("-", "−") for t in np.round(at, decimals)]


def panel(
    figure: Figure,
    bottom: float,
    height: float,
    *,
    across: Range,
    up: Range,
    name_up: str,
    name_across: str = "",
    most_up: int = 5,
) -> Axes:
    """A ruled panel.

    Parameters
    ----------
    figure : Figure
    bottom, height : float
        Points from the lower edge.
    across, up : (float, float)
        Ranges of the two axes.
    name_up, name_across : str
        Labels; without ``name_across`` the axis has ticks only.
    most_up : int
        Largest number of steps of the upright axis.
    """
    width, whole = WIDTH - LEFT - RIGHT, height_of(figure)
    axes = bare(figure, (LEFT / WIDTH, bottom / whole, width / WIDTH, height / whole))
    axes.set_xlim(*across)
    axes.set_ylim(*up)
    at_x, at_y = ticks(across, 7), ticks(up, most_up)
    strokes(axes, across, (at_y, at_y), color=COLOURS["rule"], linewidth=0.5, zorder=0)
    x, y = LEFT + width * _shares(at_x, across), bottom + height * _shares(at_y, up)
    _frame(figure, axes, (LEFT, bottom, LEFT + width, bottom + height), x, y)
    for level, text in zip(y, tick_texts(at_y), strict=True):
        label(figure, (LEFT - 5.5) / WIDTH, (level - 2.9) / whole, text, "right")
    label(figure, (7.5 + 0.35 * SIZE) / WIDTH, (bottom + height / 2.0) / whole, name_up, rotation=90)
    if name_across:
        for place, text in zip(x, tick_texts(at_x), strict=True):
            label(figure, place / WIDTH, (bottom - 13.5) / whole, text)
        label(figure, (LEFT + width / 2.0) / WIDTH, (bottom - 27.5) / whole, name_across)
    return axes


def _shares(at: Array, within: Range) -> Array:
    return (at - within[0]) / (within[1] - within[0])


def _frame(figure: Figure, axes: Axes, box: tuple[float, float, float, float], x: Array, y: Array) -> None:
    """The left and the lower edge with their ticks, points from the lower left corner of the figure."""
    left, bottom, right, top = box
    points = Affine2D().scale(1.0 / WIDTH, 1.0 / height_of(figure)) + figure.transFigure
    look: dict[str, Any] = {"color": COLOURS["muted"], "linewidth": 0.6, "clip_on": False, "zorder": 1.5}
    axes.add_artist(Line2D([left, left, right], [top, bottom, bottom], transform=points, **look))
    first_x, first_y = np.append(x, np.full_like(y, left)), np.append(np.full_like(x, bottom), y)
    last_x, last_y = np.append(x, np.full_like(y, left - TICK)), np.append(np.full_like(x, bottom - TICK), y)
    strokes(axes, (first_x, last_x), (first_y, last_y), transform=points, **look)


def row_panel(
    figure: Figure, sides: Sequence[float], across: Range, rows: Sequence[tuple[str, str]], count: int, name: str
) -> Axes:
    """A panel of lying bars, which the caller draws: names of its rows at the left and numbers at the right, the first row on top.

    Parameters
    ----------
    figure : Figure
    sides : (left, right, bottom, top)
        Room around the frame, points.
    across : (float, float)
    rows : sequence of (str, str)
        Name and number of each, the first ``count - 1`` high.
    count : int
        Rows that have room.
    name : str
        Of the axis.
    """
    left, right, bottom, top = sides
    height = height_of(figure)
    width, tall = WIDTH - left - right, height - bottom - top
    axes = figure.add_axes((left / WIDTH, bottom / height, width / WIDTH, tall / height))
    axes.set_axis_off()
    axes.set(xlim=across, ylim=(-0.5, count - 0.5))
    at = ticks(across, 6)
    axes.vlines(at, -0.5, count - 0.5, color=COLOURS["rule"], linewidth=0.5, zorder=0)
    axes.axvline(0.0, color=COLOURS["muted"], linewidth=0.6, zorder=3)
    for k, (named, value) in enumerate(rows):
        base = (bottom + (count - 0.5 - k) * tall / count - 2.9) / height
        figure.text((left - 5.5) / WIDTH, base, named, ha="right", va="baseline")
        figure.text((WIDTH - right + 5.5) / WIDTH, base, value, ha="left", va="baseline")
    for x, text in zip(left + width * _shares(at, across), tick_texts(at), strict=True):
        figure.text(x / WIDTH, (bottom - 13.5) / height, text, ha="center", va="baseline")
    figure.text((left + width / 2.0) / WIDTH, (bottom - 27.5) / height, name, ha="center", va="baseline")
    return axes


def legend(figure: Figure, handles: list[Any], above: float = TOP) -> None:
    """One legend in two columns above the panels, whose upper edge is ``above`` points from the lower edge."""
    framed_legend(figure, handles, LEFT - 16.0, above + 8.0)
