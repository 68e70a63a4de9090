"""Matplotlib figures as SVG text: equal input gives equal bytes, and the page that holds it sets the colours."""

from __future__ import annotations

import io
import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from html import escape, unescape
from typing import Any

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from coeflab.report.figures.palette import COLOURS
from coeflab.report.markup import drawn
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


def paper(width: float, height: float) -> tuple[Figure, Axes]:
    """An empty figure with axes over all of it that count in points."""
    figure = Figure(figsize=(width / POINTS, height / POINTS))
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set_axis_off()
    axes.set(xlim=(0.0, width), ylim=(0.0, height))
    return figure, axes
