"""One HTML file that needs nothing else: no network, light and dark, screen and print.

Its own script marks where a reader is, tells values, hides and shows series and turns bodies and surfaces; without it the page is complete.

Numbers and scenes of figures as JSON that may stand inside an HTML page.
"""

from __future__ import annotations

import base64
import hashlib
import re
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from importlib.resources import files
from itertools import count
from typing import Any

import numpy as np
from markupsafe import Markup
from numpy.typing import NDArray

from coeflab.core.table import ABSENT, coefficient, plus_minus
from coeflab.core.text.bounded import own_text
from coeflab.law.symbols import primed
from coeflab.report.document import Answer, AnswerRow, Axis, Document, Figure, Layer, Panel, Scene, Series, every
from coeflab.report.figures.first_page import share_text
from coeflab.report.figures.svg_file import size_of
from coeflab.report.formats import inside_a_page, page_environment
from coeflab.report.glossary import definitions_html, linked_html
from coeflab.report.markup import cell_html, html, label, unit_html, unit_label
from coeflab.report.notation import keeping
from coeflab.report.printable import shortened, visible

STEPS = 65535
KINDS = {1: "points", 2: "lines", 3: "triangles"}


def panels_json(figure: Figure) -> str:
    """What a page needs to tell the values of a drawing; empty where there is nothing to tell."""
    words = [p for p in figure.panels if p.series]
    return inside_a_page({"title": visible(figure.title), "panels": [_panel(p) for p in words]}) if words else ""


def scene_json(scene: Scene) -> str:
    """What a page needs to draw a scene.

    Places are whole numbers of two bytes between the ends of the axes, little-endian, in base64.
    """
    content = {
        "body": scene.is_body,
        "axes": [_axis(a) for a in scene.axes],
        "layers": [_layer(layer, scene.axes) for layer in scene.layers],
    }
    return inside_a_page(content)


def _panel(panel: Panel) -> dict[str, Any]:
    out: dict[str, Any] = {
        "frame": panel.frame,
        "across": panel.across,
        "up": panel.up,
        "names": [label(panel.name_across), label(panel.name_up)],
        "units": [unit_label(panel.unit_across), unit_label(panel.unit_up)],
        "grouped": panel.grouped_by,
        "series": [_series(s) for s in panel.series],
    }
    if panel.bars:
        out["bars"] = panel.bars
    return out


def _series(series: Series) -> dict[str, Any]:
    out: dict[str, Any] = {"key": series.key, "name": label(series.name), "x": series.x, "y": series.y}
    if series.notes:
        out["notes"] = [label(n) for n in series.notes]
    if series.groups:
        out["groups"] = series.groups
    if series.is_curve:
        out["curve"] = True
    return out


def _axis(axis: Axis) -> dict[str, Any]:
    return {
        "name": label(axis.name),
        "unit": unit_label(axis.unit),
        "ends": axis.ends,
        "marks": axis.marks,
        "texts": [label(t) for t in axis.texts],
    }


def _layer(layer: Layer, axes: tuple[Axis, ...]) -> dict[str, Any]:
    low, high = np.array([a.ends for a in axes]).T
    share = np.clip((np.asarray(layer.places) - low) / (high - low), 0.0, 1.0)
    wide = "<u2" if len(layer.places) <= STEPS else "<u4"
    corners = layer.index.shape[1] if layer.index.ndim == 2 else 1
    return {
        "name": label(layer.name),
        "kind": KINDS[corners],
        "colour": layer.colour,
        "opacity": layer.opacity,
        "label": label(layer.label),
        "notes": [label(n) for n in layer.notes],
        "wide": wide[-1],
        "places": _packed(np.rint(share * STEPS).astype("<u2")),
        "index": _packed(layer.index.astype(wide)),
    }


def _packed(values: NDArray[Any]) -> str:
    return base64.b64encode(values.tobytes()).decode()


summary = "one HTML file with tables and figures, for browser and printer"
suffix = ".html"
STYLES = ("style.css", "symbols.css", "contents.css", "answer.css")
SCRIPTS = ("contents.js", "zooming.js", "figures.js", "painting.js", "scenes.js", "copying.js", "pdf.js", "saving.js")
THREE = "three/three.min.js"
citations: tuple[str, ...] = ()


def render(document: Document) -> Mapping[str, bytes]:
    """The report as a file.

    Parameters
    ----------
    document : Document

    Returns
    -------
    mapping of file name to bytes
        ``report.html``; equal documents give equal bytes.
    """
    folder = files("coeflab.report.formats") / "_html"
    environment = page_environment()
    environment.globals |= {
        "panels_json": panels_json,
        "scene_json": scene_json,
        "row_of": row_of,
        "bar_of": bar_of,
        "published": published,
        "rows_json": rows_json,
        "anchors": anchors,
        "is_broad": is_broad,
    }
    seen: set[str] = set()
    whole = any(s.appendix for s in document.sections)
    environment.globals["definitions"] = lambda: Markup(definitions_html(seen) if whole else "")
    environment.filters |= {
        "linked": lambda text: Markup(linked_html(text, seen, listed=whole)),
        "spelled": spelled,
        "spelled_cell": spelled_cell,
        "visible": visible,
        "shortened": shortened,
        "filename": filename,
    }
    template = environment.from_string(own_text(folder / "report.html.j2"))
    style = "\n".join(own_text(folder / name) for name in STYLES)
    scripts = ["\n" + "\n".join(own_text(folder / name) for name in SCRIPTS)]
    if has_scene(document):
        scripts.insert(0, own_text(folder / THREE))
    digests = " ".join(f"'sha256-{base64.b64encode(hashlib.sha256(s.encode()).digest()).decode()}'" for s in scripts)
    with keeping(document.verbatim):
        page = template.render(document=document, style=style, scripts=scripts, digests=digests)
    return {"report.html": lighter(page).encode()}


@dataclass(frozen=True, slots=True)
class Row:
    """A row of the answer in words: ``verdict`` is ``agrees``, ``differs``, ``open`` or ``missing``."""

    symbol: str
    own: str
    share: str
    status: str
    difference: str
    against: str
    verdict: str


def row_of(row: AnswerRow) -> Row:
    """The words of a row; the difference has the digits of its U95."""
    own = plus_minus(row.value, row.u95) if row.u95 is not None else coefficient(row.value)
    difference, against = row.apart
    verdict = "missing" if row.value is None else {True: "agrees", False: "differs", None: "open"}[row.agrees]
    share = share_text(row.u95 / row.value) if row.u95 is not None and row.value else ABSENT
    return Row(
        row.name,
        own,
        share,
        row.status or "no data" * (row.value is None),
        difference,
        against,
        verdict,
    )


def filename(text: str) -> str:
    """A name for files that a page saves: letters, digits, hyphens and underscores of ASCII."""
    return re.sub(r"[^A-Za-z0-9_-]+", "_", text)[:60]


def published(shown: str) -> tuple[str, int]:
    """A published number in the digits of its source, and how many places it is short of six decimals."""
    decimals = len(shown.partition(".")[2])
    return shown, 0 if "e" in shown else max(PRINTED - decimals, 0) + ("." not in shown)


def rows_json(answer: Answer) -> str:
    """The rows for a file of their numbers: ours with all digits, published ones with those that are printed."""
    rows = [
        {
            "symbol": primed(r.symbol),
            "value": r.value,
            "U95": r.u95,
            "status": visible(r.status),
            **{visible(c): p and float(f"{p:.{PRINTED}g}") for c, p in zip(answer.columns, r.published, strict=False)},
            "difference": r.difference,
            "difference over U95": r.share,
            "from": visible(r.source),
        }
        for r in answer.rows
    ]
    return inside_a_page({"rows": rows})


@dataclass(frozen=True, slots=True)
class Ends:
    """A bar between two walls at twice U95, per cent of the way; ``beyond``: it goes on behind a wall."""

    left: float
    wide: float
    beyond: bool


WALL, PRINTED = 2.0, 6


def bar_of(row: AnswerRow) -> Ends | None:
    """The bar of the difference over U95, from the middle."""
    if row.share is None:
        return None
    end = min(max(row.share, -WALL), WALL) / (2.0 * WALL) * 100.0
    return Ends(round(50.0 + min(end, 0.0), 1), round(abs(end), 1), abs(row.share) > WALL)


BROAD = 400.0  # points; in half a page such a drawing's letters are too small to read


def is_broad(figure: Figure) -> bool:
    """Whether a drawing takes the width of the page."""
    return size_of(figure.svg)[0] > BROAD


def anchors(document: Document) -> frozenset[str]:
    """What links inside the page can lead to."""
    return frozenset(a for s in every(document.sections) for a in (s.anchor, *(f.anchor for f in s.figures)))


def has_scene(document: Document) -> bool:
    """Whether a figure of the page turns in space."""
    first = document.answer
    shown = () if first is None else tuple(f for f in (first.slope, first.forest, first.axes) if f is not None)
    return any(f.scene is not None for f in (*shown, *(f for s in every(document.sections) for f in s.figures)))


_DRAWING = re.compile(r"<svg .*?</svg>", re.DOTALL)
_STYLE = re.compile(r' style="([^"]*)"')
_STEPS = re.compile(r' d="([^"]*)"')


def _tight(steps: re.Match[str]) -> str:
    return ' d="' + re.sub(r"\s*([A-Za-z])\s*", r"\1", steps[1]).strip() + '"'


def lighter(page: str) -> str:
    """The same page with the styles that drawings share as classes, shorter marks of their parts and no idle spaces."""
    often = Counter(style for drawing in _DRAWING.findall(page) for style in _STYLE.findall(drawing))
    names = {style: f"s{i}" for i, style in enumerate(s for s, count in often.items() if count > 1)}
    rules = "\n".join(f"figure svg .{name} {{ {style} }}" for style, name in names.items())
    order = count()

    def drawn(found: re.Match[str]) -> str:
        text = _STYLE.sub(lambda m: f' class="{names[m[1]]}"' if m[1] in names else m[0], found[0])
        text = _STEPS.sub(_tight, text)
        prefix = re.search(r'aria-labelledby="([^" ]*)-title ', text)
        if prefix:
            short = f"_{next(order)}-"
            text = re.sub(rf'(?<=["# (]){re.escape(prefix[1])}-(?=\d|title|desc)', short, text)
        return text

    head, end, rest = page.partition("</style>")
    return f"{head}{rules}\n{end}{_DRAWING.sub(drawn, rest)}" if names else page


def spelled(text: str) -> Markup:
    """A text of the document with its symbols, safe to stand in a page."""
    return Markup(html(text))


def spelled_cell(text: str, header: str) -> Markup:
    """A cell under its column's header."""
    return Markup(unit_html(text) if header == "unit" else cell_html(text))
