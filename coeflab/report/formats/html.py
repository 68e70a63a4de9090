"""One HTML file that needs nothing else: no network, light and dark, screen and print.

Its own script marks where a reader is, tells values, hides and shows series and turns bodies and surfaces; without it the page is complete.

Numbers and scenes of figures as JSON that may stand inside an HTML page.
"""

from __future__ import annotations

import base64
import hashlib
import json
from collections.abc import Mapping
from importlib.resources import files
from typing import Any

import numpy as np
from jinja2 import BaseLoader, Environment, StrictUndefined
from markupsafe import Markup
from numpy.typing import NDArray

from coeflab.report.document import Axis, Document, Figure, Layer, Panel, Scene, Series
from coeflab.report.notation import cell_html, html, keeping, label, unit_html, unit_label
from coeflab.report.printable import shortened, visible

STEPS = 65535
KINDS = {1: "points", 2: "lines", 3: "triangles"}


def panels_json(figure: Figure) -> str:
    """What a page needs to tell the values of a drawing; empty where there is nothing to tell."""
    told = [p for p in figure.panels if p.series]
    return _inside_a_page({"title": visible(figure.title), "panels": [_panel(p) for p in told]}) if told else ""


def scene_json(scene: Scene) -> str:
    """What a page needs to draw a scene.

    Places are whole numbers of two bytes between the ends of the axes, little-endian, in base64.
    """
    content = {
        "body": scene.is_body,
        "axes": [_axis(a) for a in scene.axes],
        "layers": [_layer(layer, scene.axes) for layer in scene.layers],
    }
    return _inside_a_page(content)


def _inside_a_page(content: dict[str, Any]) -> str:
    """JSON without the characters that could end a script element."""
    text = json.dumps(content, separators=(",", ":"), ensure_ascii=False, allow_nan=False)
    return text.replace("&", "\\u0026").replace("<", "\\u003c").replace(">", "\\u003e")


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
STYLES = ("style.css", "symbols.css", "contents.css")
SCRIPTS = ("contents.js", "figures.js", "painting.js", "scenes.js", "copying.js")
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
    environment = Environment(
        loader=BaseLoader(), autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    environment.globals |= {"panels_json": panels_json, "scene_json": scene_json}
    environment.filters |= {
        "spelled": spelled,
        "spelled_cell": spelled_cell,
        "visible": visible,
        "shortened": shortened,
    }
    template = environment.from_string((folder / "report.html.j2").read_text(encoding="utf-8"))
    style = "\n".join((folder / name).read_text(encoding="utf-8") for name in STYLES)
    script = "\n" + "\n".join((folder / name).read_text(encoding="utf-8") for name in SCRIPTS)
    digest = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
    with keeping(document.verbatim):
        page = template.render(document=document, style=style, script=script, digest=digest)
    return {"report.html": page.encode()}


def spelled(text: str) -> Markup:
    """A text of the document with its symbols, safe to stand in a page."""
    return Markup(html(text))


def spelled_cell(text: str, header: str) -> Markup:
    """A cell under its column's header."""
    return Markup(unit_html(text) if header == "unit" else cell_html(text))
