"""One HTML file that needs nothing else: no network, no scripts, light and dark, screen and print."""

from __future__ import annotations

from collections.abc import Mapping
from importlib.resources import files

from jinja2 import BaseLoader, Environment, StrictUndefined

from coeflab.presentation.document import Document

summary = "one HTML file with tables and figures, for browser and printer"
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
    template = environment.from_string((folder / "report.html.j2").read_text(encoding="utf-8"))
    style = (folder / "style.css").read_text(encoding="utf-8")
    return {"report.html": template.render(document=document, style=style).encode()}
