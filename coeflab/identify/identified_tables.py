"""What was identified from motions, as tables and as CSV."""

from __future__ import annotations

from typing import TYPE_CHECKING

from coeflab.core.table import ABSENT, Table, coefficient, number, with_u95
from coeflab.core.text.csv_rows import csv_text

if TYPE_CHECKING:
    from coeflab.identify.identified import Identified, IdentifiedTerm

PER_CENT = 100.0


def terms(found: Identified) -> Table:
    """Every candidate beside the file's value."""
    rows = tuple(
        (
            t.symbol,
            coefficient(t.value),
            _interval(t),
            ABSENT if t.frequency is None else f"{PER_CENT * t.frequency:.0f} %",
            *with_u95(t.file_value, t.file_u95),
            t.file_source,
            t.verdict.value,
            t.outcome.value,
            t.why,
        )
        for t in found.terms
    )
    used = dict.fromkeys(t.outcome for t in found.terms)
    notes = (*(f"{o.value}: {o.meaning}." for o in used), *found.statements)
    headers = (
        "term", "identified", "2.5 .. 97.5 % of resamples", "kept in", "file", "U95 of file", "source", "verdict", "outcome", "why",
    )  # fmt: skip
    return Table(
        f"{found.name}: identified from {', '.join(found.series)}", headers, rows, notes, frozenset({0, 6, 7, 8, 9})
    )


def balances(found: Identified) -> Table:
    """Every component: rows, and what is left unexplained."""
    rows = tuple(
        (
            b.component,
            str(b.stretches),
            number(b.threshold, 2),
            number(None if b.left is None else PER_CENT * b.left, 2),
        )
        for b in found.balances
    )
    title = f"{found.name}: balances, {found.method}, windows of {2.0 * found.half:.3g} s"
    headers = ("component", "stretches", "threshold", "unexplained [%]")
    return Table(title, headers, rows, ("Unexplained: root mean square over that of the force, the noise taken out.",))


def terms_csv(found: Identified) -> bytes:
    """One row a candidate; blank where there is no number."""
    rows = [
        ["term", "identified [-]", "low [-]", "high [-]", "inclusion frequency [-]", "file [-]", "U95 of file [-]",
         "source", "verdict", "outcome", "why"]
    ]  # fmt: skip
    for t in found.terms:
        numbers = (t.value, t.low, t.high, t.frequency, t.file_value, t.file_u95)
        cells = ["" if x is None else f"{x:.9g}" for x in numbers]
        rows.append([t.symbol, *cells, t.file_source, t.verdict.value, t.outcome.value, t.why])
    return csv_text(rows).encode()


def _interval(t: IdentifiedTerm) -> str:
    return ABSENT if t.low is None or t.high is None else f"{coefficient(t.low)} .. {coefficient(t.high)}"
