"""The gallery's own pages: the index with its search, and files side by side. They carry no script."""

from __future__ import annotations

import base64
import hashlib
from collections.abc import Mapping, Sequence
from functools import cache
from importlib.resources import files
from typing import Any

from coeflab.model.table import Table
from coeflab.presentation.printable import shortened
from coeflab.studies.gallery.listing import Listing, ParameterEntry

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
    """A page that says why there is nothing."""
    return _page("refusal", title=f"{code} {phrase}", why=why)


def policy() -> str:
    """Content-Security-Policy of these pages: their own style, no script, nothing from anywhere."""
    digest = base64.b64encode(hashlib.sha256(_style().encode()).digest()).decode()
    return (
        f"default-src 'none'; img-src data:; style-src 'sha256-{digest}'; form-action 'self'; base-uri 'none'; "
        "frame-ancestors 'none'"
    )


def symbols(entry: ParameterEntry) -> str:
    """The first symbols of a file, and how many more there are."""
    left = len(entry.symbols) - SYMBOLS
    return " ".join(entry.symbols[:SYMBOLS]) + (f" and {left} more" if left > 0 else "")


def named(path: str) -> str:
    """A path to be shown: cut, and without bytes that are no text."""
    return shortened(path.encode("utf-8", "replace").decode(), LONGEST)


@cache
def _style() -> str:
    """The report's style and what the gallery adds."""
    report = (files("coeflab.reporting") / "_html" / "style.css").read_text(encoding="utf-8")
    return "\n" + report + (files("coeflab.studies") / "gallery" / "gallery.css").read_text(encoding="utf-8")


@cache
def _templates() -> Any:
    from jinja2 import DictLoader, Environment, StrictUndefined

    folder = files("coeflab.studies") / "gallery"
    texts: Mapping[str, str] = {
        name: (folder / f"{name}.html.j2").read_text(encoding="utf-8")
        for name in ("frame", "index", "comparison", "refusal")
    }
    made = Environment(
        loader=DictLoader(texts), autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    made.filters |= {"symbols": symbols, "named": named, "shortened": shortened}
    return made


def _page(template: str, **content: Any) -> bytes:
    text = _templates().get_template(template).render(style=_style(), **content)
    return text.encode("utf-8", "replace")  # type: ignore[no-any-return]
