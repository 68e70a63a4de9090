"""The legend of a drawing: samples and names in columns above its panels."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from matplotlib.artist import Artist
from matplotlib.backend_bases import RendererBase
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle
from matplotlib.transforms import Affine2D

from coeflab.presentation.bare import label, text_width
from coeflab.presentation.plotted import LEGEND, SERIES, SWATCH
from coeflab.presentation.svg import POINTS

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


def legend(figure: Figure, handles: Sequence[Any], left: float, bottom: float) -> None:
    """A legend with its lower left corner at a point, in points.

    Entries of handles that `coeflab.presentation.plotted.tagged` marked are marked in the drawing.
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
