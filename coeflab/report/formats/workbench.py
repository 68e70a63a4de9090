"""A page on which an expert changes what a slope rests on, and sees what follows; one HTML file, no network.

Slopes are those of the Python code; what follows from them is recomputed in the browser: tests/workbench_page holds both to 1e-9.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from importlib.resources import files

from jinja2 import BaseLoader, Environment, StrictUndefined
from markupsafe import Markup

from coeflab.core.errors import InputError
from coeflab.core.text.bounded import own_text
from coeflab.report.bench import BenchData
from coeflab.report.document import Document
from coeflab.report.printable import visible

summary = "one HTML file to take points or angles out of a sweep and see slope, U95, G_h and zigzag follow"
citations: tuple[str, ...] = ()
NUMBERS = ("motion.js", "bench.js")


def render(document: Document) -> Mapping[str, bytes]:
    """The workbench as a file.

    Parameters
    ----------
    document : Document

    Returns
    -------
    mapping of file name to bytes
        ``workbench.html``; equal documents give equal bytes.

    Raises
    ------
    InputError
        The document has no sweep with a slope.
    """
    if document.bench is None:
        raise InputError(
            f"{document.title}, without a sweep that gives a slope", "a study with slopes at the origin", column="--to",
            advice="Publications reproduced have no workbench; a plan of your own tables has.",
        )  # fmt: skip
    environment = Environment(
        loader=BaseLoader(), autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    environment.filters["visible"] = visible
    page = environment.from_string(source("workbench.html.j2")).render(
        document=document,
        sweeps=document.bench.sweeps,
        left_out=document.bench.left_out,
        data=Markup(data_json(document.bench)),
        style=Markup(source("page.css")),
        numbers=Markup(numbers()),
        page=Markup(source("page.js")),
    )
    return {"workbench.html": page.encode()}


def source(name: str) -> str:
    """A file of the page."""
    return own_text(files("coeflab.report.formats") / "_workbench" / name)


def numbers() -> str:
    """The scripts that compute, in the order in which they need each other."""
    return "\n".join(source(name) for name in NUMBERS)


def data_json(bench: BenchData) -> str:
    """What the page computes with, without the characters that could end a script element."""
    text = json.dumps(bench.content(), separators=(",", ":"), ensure_ascii=True, allow_nan=False)
    return text.replace("&", "\\u0026").replace("<", "\\u003c").replace(">", "\\u003e")
