"""A page on which an expert changes what a slope rests on, and sees what follows; one HTML file, no network.

Slopes are those of the Python code; what follows from them is recomputed in the browser: tests/workbench_page holds both to 1e-9.
"""

from __future__ import annotations

from collections.abc import Mapping
from importlib.resources import files

from markupsafe import Markup

from coeflab.core.text.bounded import own_text
from coeflab.core.texts import input_error
from coeflab.report.bench import BenchData
from coeflab.report.document import Document
from coeflab.report.formats import inside_a_page, page_environment
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
        raise input_error("report.without_sweep_gives_slope", column="--to", title=document.title)
    environment = page_environment()
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
    return inside_a_page(bench.content(), ascii_only=True)
