"""What a drawing is made of where Matplotlib's own way costs most of the time: axes without ticks, texts, many strokes."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import Any, Literal

import numpy as np
from matplotlib.axes import Axes
from matplotlib.axis import XAxis, YAxis
from matplotlib.backend_bases import RendererBase
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties
from matplotlib.lines import Line2D
from matplotlib.text import Text
from matplotlib.textpath import text_to_path
from numpy.typing import ArrayLike

Align = Literal["left", "center", "right"]


class _Unmarked:
    """An axis whose ticks are never made: nothing here draws them."""

    def grid(self, *_: object, **__: object) -> None: ...

    def set_tick_params(self, *_: object, **__: object) -> None: ...

    def set_clip_path(self, *_: object, **__: object) -> None: ...


class _Across(_Unmarked, XAxis):
    pass


class _Up(_Unmarked, YAxis):
    pass


class _Bare(Axes):
    def _gen_axes_spines(self) -> dict[str, Any]:
        return {}

    def _init_axis(self) -> None:
        self.xaxis, self.yaxis = _Across(self, clear=False), _Up(self, clear=False)


def bare(figure: Figure, place: tuple[float, float, float, float]) -> Axes:
    """Axes without ticks, spines and labels, ``(left, bottom, width, height)`` in fractions of the figure."""
    axes = _Bare(figure, place)
    axes.set_axis_off()
    return figure.add_axes(axes)


class _Label(Text):
    """One line on its baseline: the renderer of SVG needs no more than the point that it hangs on."""

    def draw(self, renderer: RendererBase) -> None:
        renderer.open_group("text", self.get_gid())
        gc = renderer.new_gc()
        gc.set_foreground(to_rgba(self.get_color()), isRGBA=True)
        x, y = self.get_transform().transform(self.get_position())
        y = renderer.get_canvas_width_height()[1] - y
        font = self.get_fontproperties()
        renderer.draw_text(gc, x, y, self.get_text(), font, self.get_rotation(), ismath=False, mtext=self)
        gc.restore()
        renderer.close_group("text")


def label(
    figure: Figure, x: float, y: float, text: str, align: Align = "center", *, shown: bool = True, **look: Any
) -> Text:
    """A line of text, its baseline at a point in fractions of the figure; not ``shown``: another artist draws it."""
    result = _Label(x, y, text, horizontalalignment=align, rotation_mode="anchor", transform=figure.transFigure, **look)
    if shown:
        figure.add_artist(result)
    else:
        result.set_figure(figure)
    return result


@lru_cache(1 << 12)
def text_width(text: str, size: float) -> float:
    """Width of a line of text, points."""
    wide, _, _ = text_to_path.get_text_width_height_descent(text, FontProperties(size=size), False)
    return float(wide)


def strokes(axes: Axes, x: Sequence[ArrayLike], y: Sequence[ArrayLike], **look: Any) -> Line2D:
    """Straight strokes as one line: ``x`` and ``y`` hold their first and their last ends."""
    gap = np.full(max(np.size(v) for v in (*x, *y)), np.nan)
    along, up = (np.column_stack([*(np.broadcast_to(v, gap.shape) for v in ends), gap]).ravel() for ends in (x, y))
    line = Line2D(along, up, solid_capstyle="butt", dash_capstyle="butt", **look)
    axes.add_artist(line)
    return line
