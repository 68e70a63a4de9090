"""The gallery's own pages: the index with its search, and files side by side. They carry no script."""

from __future__ import annotations

import base64
import hashlib
from collections.abc import Mapping, Sequence
from functools import cache
from importlib.resources import files
from typing import Any

from coeflab.core.table import Table
from coeflab.report.gallery.listing import Listing, ParameterEntry
from coeflab.report.lettering import cell_html, html
from coeflab.report.printable import shortened, visible

SHOWN, SYMBOLS = 200, 12
LONGEST, COLUMN = 120, 48


def index(folder: str, whole: Listing, query: str) -> bytes:
    """Reports and parameter files that a query finds.

    Parameters
    ----------
    folder : str
        What the page calls the folder.
    whole : Listing
    query : str
        Empty for everything.
    """
    found = whole.having(query)
    return _page(
        "index",
        title=f"Gallery of {shortened(folder, LONGEST)}",
        query=query,
        reports=found.reports[:SHOWN],
        parameters=found.parameters[:SHOWN],
        n_reports=len(found.reports),
        n_parameters=len(found.parameters),
        more=whole.more,
        empty=not whole.reports and not whole.parameters,
    )


def comparison(tables: Sequence[Table], statements: Sequence[tuple[str, Sequence[str]]], names: Sequence[str]) -> bytes:
    """Tables of files side by side, and what is to be said of each pair.

    Parameters
    ----------
    tables : sequence of Table
    statements : sequence of (str, sequence of str)
        Heading and sentences.
    names : sequence of str
        What is compared.
    """
    several = len(names) > 1
    title = f"Side by side: {', '.join(names)}" if several else names[0]
    return _page("comparison", title=title, tables=tables, statements=statements, alone=not several)


def refusal(code: int, phrase: str, why: str) -> bytes:
    """A page that says why there is nothing.

    Parameters
    ----------
    code, phrase : int, str
        Of HTTP.
    why : str
    """
    return _page("refusal", title=f"{code} {phrase}", why=why)


def policy() -> str:
    """Content-Security-Policy of these pages: their own style, no script, nothing from anywhere."""
    digest = base64.b64encode(hashlib.sha256(_style().encode()).digest()).decode()
    return (
        f"default-src 'none'; img-src data:; style-src 'sha256-{digest}'; form-action 'self'; base-uri 'none'; "
        "frame-ancestors 'none'"
    )


def symbols(entry: ParameterEntry) -> Any:
    """The first symbols of a file, and how many more there are."""
    left = len(entry.symbols) - SYMBOLS
    shown = " ".join(cell_html(s) for s in entry.symbols[:SYMBOLS])
    return _safe(shown + (f" and {left} more" if left > 0 else ""))


def named(path: str) -> str:
    """A path to be shown: cut, and without bytes that are no text."""
    return cut(path.encode("utf-8", "replace").decode(), LONGEST)


def cut(text: str, longest: int) -> str:
    """The beginning of a text, with every character seen."""
    return visible(shortened(text, longest))


def spelled(text: str, longest: int) -> Any:
    """The beginning of a text with its symbols, safe to stand in a page."""
    return _safe(html(shortened(text, longest)))


def spelled_cell(text: str, longest: int) -> Any:
    """The same of a table's cell."""
    return _safe(cell_html(shortened(text, longest)))


def _safe(text: str) -> Any:
    from markupsafe import Markup

    return Markup(text)


@cache
def _style() -> str:
    """The report's style and what the gallery adds."""
    report = files("coeflab.report.formats") / "_html"
    sheets = (report / "style.css", report / "symbols.css", files("coeflab.report") / "gallery" / "gallery.css")
    return "\n" + "".join(sheet.read_text(encoding="utf-8") for sheet in sheets)


@cache
def _templates() -> Any:
    from jinja2 import DictLoader, Environment, StrictUndefined

    folder = files("coeflab.report") / "gallery"
    texts: Mapping[str, str] = {
        name: (folder / f"{name}.html.j2").read_text(encoding="utf-8")
        for name in ("frame", "index", "comparison", "refusal")
    }
    made = Environment(
        loader=DictLoader(texts), autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    made.filters |= {
        "symbols": symbols, "named": named, "shortened": cut, "spelled": spelled, "spelled_cell": spelled_cell
    }  # fmt: skip
    return made


def _page(template: str, **content: Any) -> bytes:
    text = _templates().get_template(template).render(style=_style(), **content)
    return text.encode("utf-8", "replace")  # type: ignore[no-any-return]
