"""One HTML file that needs nothing else: no network, light and dark, screen and print.

Its own script marks where a reader is, tells values, hides and shows series and turns bodies and surfaces; without it the page is complete.
"""

from __future__ import annotations

import base64
import hashlib
from collections.abc import Mapping
from importlib.resources import files

from jinja2 import BaseLoader, Environment, StrictUndefined
from markupsafe import Markup

from coeflab.presentation.document import Document
from coeflab.presentation.embedded import panels_json, scene_json
from coeflab.presentation.lettering import cell_html, html, unit_html
from coeflab.presentation.notation import keeping
from coeflab.presentation.printable import shortened, visible

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
    folder = files("coeflab.reporting") / "_html"
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
