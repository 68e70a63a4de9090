"""Every figure of a report as files of its own: SVG, PDF, PNG, and its numbers as CSV."""

from __future__ import annotations

from collections.abc import Mapping

from coeflab.report.document import Document, Figure, every
from coeflab.report.figures.files import files_of

summary = "every figure as SVG, PDF and PNG, and its numbers as CSV"
citations: tuple[str, ...] = ()


def render(document: Document) -> Mapping[str, bytes]:
    """The figures as files.

    Parameters
    ----------
    document : Document

    Returns
    -------
    mapping of file name to bytes
        ``figures/ANCHOR.svg`` and the like; equal documents give equal bytes.
    """
    found = [f for section in every(document.sections) for f in section.figures]
    if document.answer is not None:
        found = [f for f in (document.answer.slope, document.answer.forest) if isinstance(f, Figure)] + found
    out: dict[str, bytes] = {}
    for figure in found:
        out.update(files_of(figure))
    return out
