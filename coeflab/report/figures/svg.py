"""Matplotlib figures as SVG text: equal input gives equal bytes, and the page that holds it sets the colours.

What a drawing is made of where Matplotlib's own way costs most of the time: axes without ticks, texts, many strokes.

Figures as one SVG file that needs no page: white ground, colours in place of the page's variables, titles above.
"""

from __future__ import annotations

import io
import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import lru_cache
from html import escape, unescape
from typing import Any, Literal

import matplotlib as mpl
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

from coeflab.report.document import Figure as Drawing
from coeflab.report.figures.palette import COLOURS
from coeflab.report.notation import drawn
from coeflab.report.printable import visible

POINTS = 72.0
_FONT = "DejaVu Sans"
_SETTINGS: dict[Any, object] = {
    "svg.fonttype": "none",
    "svg.hashsalt": "coeflab",
    "font.family": _FONT,
    "font.size": 8.75,
    "text.parse_math": False,
    "text.color": COLOURS["ink"],
    "axes.facecolor": "none",
    "figure.facecolor": "none",
    "legend.frameon": False,
    "legend.fontsize": 8.75,
    "path.simplify": False,
}
_DECIMALS = re.compile(r"-?\d+\.\d{3,}")
_MARKED = re.compile(r' id="data-([a-z]+)=([^"]*)"')
_LABELS = re.compile(r"(<text [^>]*>)([^<]*)(?=</text>)")
_REFERENCES = re.compile(r'(?:xlink:href="#|url\(#)([^")]+)')


_OWN: dict[Any, object] = {}
_COLOURS: dict[str, str] = {}


@contextmanager
def overridden(parameters: Mapping[Any, object], colours: Mapping[str, str]) -> Iterator[None]:
    """Draw with other settings and colours, until left.

    Parameters
    ----------
    parameters : mapping
        Of Matplotlib, in the place of the report's.
    colours : mapping of str to str
        By names of `COLOURS`.
    """
    before = dict(_OWN), dict(_COLOURS)
    _OWN.update(parameters)
    _COLOURS.update(colours)
    try:
        yield
    finally:
        _OWN.clear()
        _OWN.update(before[0])
        _COLOURS.clear()
        _COLOURS.update(before[1])


@contextmanager
def settings() -> Iterator[None]:
    """Matplotlib's defaults with this report's settings, whatever the user's own are; restored afterwards.

    Within itself it does nothing.
    """
    if mpl.rcParams["svg.hashsalt"] == _SETTINGS["svg.hashsalt"]:
        yield
        return
    with mpl.rc_context():
        mpl.rcdefaults()
        mpl.rcParams.update({**_SETTINGS, **_OWN})
        yield


def svg_text(figure: Figure, prefix: str, title: str, description: str) -> str:
    """One responsive ``<svg>`` element.

    Parameters
    ----------
    figure : Figure
        Drawn under `settings` with the colours of `COLOURS`.
    prefix : str
        Put before every id, so that several drawings share a page.
    title, description : str
        Texts for screen readers.
    """
    buffer = io.BytesIO()
    figure.patch.set_visible(False)
    figure.savefig(buffer, format="svg", metadata={"Date": None, "Creator": None, "Format": None, "Type": None})
    text = buffer.getvalue().decode()
    text = text[text.index("<svg") :]
    text = re.sub(r"<!--.*?-->\s*|<metadata>.*?</metadata>\s*|<style.*?</style>\s*", "", text, flags=re.DOTALL)
    text = text.replace("<defs>\n </defs>\n", "").replace("<defs/>\n", "")
    text = _MARKED.sub(r' data-\1="\2"', text)
    short = {name: f"{prefix}-{i}" for i, name in enumerate(dict.fromkeys(_REFERENCES.findall(text)))}
    text = re.sub(r' id="([^"]*)"', lambda m: f' id="{short[m[1]]}"' if m[1] in short else "", text)
    text = re.sub(r'xlink:href="#([^"]+)', lambda m: f'href="#{short[m[1]]}', text)
    text = re.sub(r"url\(#([^)]+)", lambda m: f"url(#{short[m[1]]}", text)
    text = re.sub(r' (?:d|x|y)="[^"]*"', lambda m: _DECIMALS.sub(_rounded, m[0]), text)
    text = text.replace(f" font-family: '{_FONT}';", "")
    text = _LABELS.sub(lambda m: m[1] + drawn(unescape(m[2])), text)
    text = re.sub(r' transform="rotate\(-0 [^)]*\)"', "", text)
    for name, colour in COLOURS.items():
        text = text.replace(colour, f"var(--fig-{name}, {_COLOURS.get(name, colour)})")
    text = _styled_once(_without_bare_groups(re.sub(r"\n\s*", "\n", text)))
    box = re.search(r'viewBox="[^"]*"', text)
    head = (
        f'<svg xmlns="http://www.w3.org/2000/svg" {box[0] if box else ""} role="img" '
        f'aria-labelledby="{prefix}-title {prefix}-desc" font-family="Helvetica, Arial, sans-serif" '
        'stroke-linejoin="round" stroke-linecap="butt">\n'
        f'<title id="{prefix}-title">{escape(visible(title))}</title>\n<desc id="{prefix}-desc">{escape(visible(description))}</desc>\n'
    )
    return head + text[text.index(">") + 1 :].strip() + "\n"


def _rounded(number: re.Match[str]) -> str:
    """A coordinate to a hundredth of a point."""
    return f"{float(number[0]) + 0.0:.2f}".rstrip("0").rstrip(".")


def _styled_once(text: str) -> str:
    """The same drawing with the style of a row of equal markers on their group."""

    def moved(group: re.Match[str]) -> str:
        styles = set(re.findall(r' style="[^"]*"', group[2]))
        if len(styles) != 1 or " style=" in group[1]:
            return group[0]
        style = styles.pop()
        return f"{group[1]}{style}>\n{group[2].replace(style, '')}</g>"

    return re.sub(r"(<g clip-path=[^>]*)>\n((?:<use [^>]*/>\n)+)</g>", moved, text)


def _without_bare_groups(text: str) -> str:
    """The same drawing without the groups that carry no attribute."""
    bare: list[bool] = []

    def keep(tag: re.Match[str]) -> str:
        if tag[0].startswith("</"):
            return "" if bare.pop() else tag[0]
        bare.append(tag[0].startswith("<g>"))
        return "" if bare[-1] else tag[0]

    return re.sub(r"<g>\n?|<g [^>]*[^/]>|</g>\n?", keep, text)


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


def paper(width: float, height: float) -> tuple[Figure, Axes]:
    """An empty figure with axes over all of it that count in points."""
    figure = Figure(figsize=(width / POINTS, height / POINTS))
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set_axis_off()
    axes.set(xlim=(0.0, width), ylim=(0.0, height))
    return figure, axes


COLUMNS, GAP, TITLE = 2, 24.0, 18.0
LONGEST = 62


def plain(svg: str) -> str:
    """A drawing with the colours that its variables stand for."""
    return re.sub(r"var\(--fig-\w+, (#[0-9a-f]{6})\)", r"\1", svg)


def size_of(svg: str) -> tuple[float, float]:
    """Width and height of a drawing, points."""
    found = re.search(r'viewBox="0 0 ([\d.]+) ([\d.]+)"', svg)
    if found is None:
        raise ValueError("a drawing without viewBox")
    return float(found[1]), float(found[2])


def sheet(rows: Sequence[Sequence[Drawing]], statement: str = "") -> bytes:
    """Rows of figures, one below the other; equal figures give equal bytes.

    Parameters
    ----------
    rows : sequence of sequence of Figure
        One figure at least. Rows of one figure each are put in two columns.
    statement : str
        What holds for all figures; the file's description.
    """
    if all(len(row) == 1 for row in rows):
        single = [row[0] for row in rows]
        rows = [single[i : i + COLUMNS] for i in range(0, len(single), COLUMNS)]
    wide = max(size_of(f.svg)[0] for row in rows for f in row)
    parts, top = [], GAP
    for row in rows:
        for i, figure in enumerate(row):
            x = GAP + i * (wide + GAP)
            parts += [_title(figure, x, top + 10.0, wide), _placed(figure, x, top + TITLE)]
        top += TITLE + max(size_of(f.svg)[1] for f in row) + GAP
    across = GAP + max(map(len, rows)) * (wide + GAP)
    head = (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {across:g} {top:g}" width="{across:g}pt" '
        f'height="{top:g}pt" style="background:#fff">\n'
    )
    if statement:
        head += f"<desc>{escape(statement)}</desc>\n"
    return (head + "".join(parts) + "</svg>\n").encode()


def _title(figure: Drawing, x: float, y: float, wide: float) -> str:
    fit = f' textLength="{wide:g}" lengthAdjust="spacingAndGlyphs"' if len(figure.title) > LONGEST else ""
    return (
        f'<text x="{x:g}" y="{y:g}" font-family="Helvetica, Arial, sans-serif" font-size="9.5" font-weight="bold"{fit}>'
        f"{escape(figure.title)}</text>\n"
    )


def _placed(figure: Drawing, x: float, y: float) -> str:
    wide, tall = size_of(figure.svg)
    place = f'<svg x="{x:g}" y="{y:g}" width="{wide:g}" height="{tall:g}" '
    return plain(figure.svg).replace("<svg ", place, 1)
