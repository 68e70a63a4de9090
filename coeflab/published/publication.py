"""A publication as a file: what its tables are called, what they are held to, and all words about it (``NAME/publication.toml``).

The code beside it computes, and gives `Row`s: what a number is held against, and what was found. ::

    title, citations, conventions, errata       of the publication
    [texts]                                     by name; any text may quote one: {in_sample}
    [tables.KEY]                                title, source, notes, repeats; of rows that do not say: basis, within, relative, at_most,
                                                digits, the format that they are rounded to
    [rows]                                      the same of all tables
    [figures.ANCHOR]                            title, caption, description

Texts name facts in braces, with a format of Python: ``{speed:.3g}``. A note that is ``{*words}`` stands for several.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import Any, NamedTuple

import numpy as np

from coeflab.core.text.bounded import own_text
from coeflab.core.text.toml import own_toml
from coeflab.core.types import Array
from coeflab.report.acceptance import Acceptance, Basis, Compared, ComparedTable
from coeflab.report.document import Figure
from coeflab.report.figures.laws import Plot, laws_figure

FINEST = 10.0  # parts of the tolerance: a zero is shown no finer than one, so that every machine says the same


class Row(NamedTuple):
    """One number of ours and what it is held against; what is None is as its table says.

    Attributes
    ----------
    case, quantity, unit, against, found
        As of `Compared`.
    within : float, optional
        Its tolerance.
    basis : Basis, optional
    relative, at_most : bool, optional
    is_zero : bool
        Zero by theory.
    """

    case: str
    quantity: str
    unit: str
    against: float
    found: float | None
    within: float | None = None
    basis: Basis | None = None
    relative: bool | None = None
    at_most: bool | None = None
    is_zero: bool = False

    @classmethod
    def none(
        cls,
        case: str,
        quantity: str,
        unit: str,
        found: float | Array,
        within: float | None = None,
        basis: Basis | None = None,
    ) -> Row:
        """Zero by theory; of arrays the largest."""
        return cls(case, quantity, unit, 0.0, float(np.max(np.abs(found))), within, basis, is_zero=True)


@dataclass(frozen=True, slots=True)
class Publication:
    """A publication and the words about it.

    Attributes
    ----------
    name : str
        Its folder.
    content : mapping
        What its file holds.
    """

    name: str
    content: Mapping[str, Any]

    def text(self, key: str, **facts: Any) -> str:
        """One of its texts."""
        return next(self._filled([self.content["texts"][key]], facts))

    def table(self, key: str, rows: Iterable[Row], **facts: Any) -> ComparedTable:
        """Rows of one of its tables or figures, with the words about them.

        Parameters
        ----------
        key : str
        rows : iterable of Row
        **facts
            What its texts name.
        """
        it: Mapping[str, Any] = {**self.content.get("rows", {}), **self.content["tables"][key]}
        title, source, *notes = self._filled([it["title"], it["source"], *it.get("notes", ())], facts)
        return ComparedTable(
            key, title, tuple(_compared(r, it) for r in rows), source, tuple(notes), it.get("repeats", "")
        )

    def figure(self, anchor: str, plots: Sequence[Plot], **facts: Any) -> Figure:
        """Panels from above, with the words about them.

        Parameters
        ----------
        anchor : str
        plots : sequence of Plot
        **facts
            What its texts name.
        """
        named, title, caption, description = self.words(anchor, **facts)
        return laws_figure(named, title, caption, description, plots)

    def words(self, anchor: str, **facts: Any) -> tuple[str, ...]:
        """The anchor of a figure and the texts that the file has of it: title, caption, description."""
        it = self.content["figures"][anchor]
        return (anchor, *self._filled([it[key] for key in ("title", "caption", "description") if key in it], facts))

    def texts(self, key: str, **facts: Any) -> tuple[str, ...]:
        """One of its lists of texts, such as ``statements``."""
        return tuple(self._filled(self.content[key], facts))

    def acceptance(self, tables: Iterable[ComparedTable], statements: Iterable[str], **more: Any) -> Acceptance:
        """The publication reproduced.

        Parameters
        ----------
        tables : iterable of ComparedTable
        statements : iterable of str
        **more
            As of `Acceptance`, where the file has none.
        """
        lists = {key: tuple(self.content.get(key, ())) for key in ("errata", "citations", "conventions")}
        return Acceptance(
            self.name, self.content["title"], tuple(tables), statements=tuple(statements), **{**lists, **more}
        )

    def _filled(self, texts: Iterable[str], facts: Mapping[str, Any]) -> Iterator[str]:
        known = {**self.content.get("texts", {}), **facts}
        for text in texts:
            if text.startswith("{*"):
                yield from known[text[2:-1]]
            else:
                yield text.format(**known)


def _compared(row: Row, of: Mapping[str, Any]) -> Compared:
    """The row with what its table says of all."""

    def own(value: Any, key: str, default: Any) -> Any:
        return of.get(key, default) if value is None else value

    within, digits = own(row.within, "within", 0.0), of.get("digits", "")
    against, found = row.against, row.found
    if row.is_zero and found is not None:
        found = max(found, within / FINEST)
    if digits and found is not None:
        against, found = float(format(against, digits)), float(format(found, digits))
    basis = Basis(own(row.basis, "basis", Basis.CONSISTENCY))
    relative, at_most = own(row.relative, "relative", False), own(row.at_most, "at_most", False)
    return Compared(row.case, row.quantity, row.unit, against, found, within, basis, relative, at_most)


@cache
def publication(name: str) -> Publication:
    """The publication of a folder."""
    return Publication(name, own_toml(own_text(files(f"coeflab.published.{name}") / "publication.toml")))
