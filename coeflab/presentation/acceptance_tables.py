"""Numbers beside what they are held against, as tables."""

from __future__ import annotations

from coeflab.model.acceptance import BASES, Acceptance, Compared, ComparedTable
from coeflab.model.table import ABSENT, Table


def tables(acceptance: Acceptance) -> tuple[Table, ...]:
    """One table for each of the publication."""
    return tuple(_table(t) for t in acceptance.tables)


def _table(t: ComparedTable) -> Table:
    bases = dict.fromkeys(r.basis for r in t.rows)
    notes = (f"{t.source}. {'; '.join(f'{b}: {BASES[b]}' for b in bases)}.", *t.statements)
    return Table(t.title, HEADERS, tuple(_row(r) for r in t.rows), notes, frozenset({0, 1, 3, 5, 8}))


HEADERS = ("case", "quantity", "held against", "basis", "found", "unit", "difference", "allowed", "verdict")


def _row(r: Compared) -> tuple[str, ...]:
    percent = r.relative
    factor = 100.0 if percent else 1.0
    sign = " %" if percent else ""
    difference = ABSENT if r.difference is None else f"{factor * r.difference:+.2g}{sign}"
    return (
        r.case,
        r.quantity,
        f"{'at most ' if r.at_most else ''}{r.against:.6g}",
        r.basis,
        ABSENT if r.found is None else f"{r.found:.6g}",
        "" if r.unit == "1" else r.unit,
        difference,
        f"{factor * r.tolerance:.2g}{sign}",
        "pass" if r.holds else "fail",
    )


def errata(acceptance: Acceptance) -> Table:
    """Errors of the publication and what stands in their place."""
    rows = tuple((str(i), text) for i, text in enumerate(acceptance.errata, start=1))
    return Table(
        "Errata of the publication",
        ("no.", "what is wrong, and what stands in its place"),
        rows,
        left=frozenset({0, 1}),
    )


def acceptance_csv(acceptance: Acceptance) -> bytes:
    """All rows of all tables."""
    import csv
    import io

    buffer = io.StringIO()
    out = csv.writer(buffer, lineterminator="\n")
    out.writerow(
        (
            "table",
            "case",
            "quantity",
            "unit",
            "held_against",
            "found",
            "difference",
            "relative",
            "tolerance",
            "basis",
            "passed",
        )
    )
    for t in acceptance.tables:
        for r in t.rows:
            numbers = (r.against, r.found, r.difference)
            shown = ["" if n is None else repr(float(n)) for n in numbers]
            out.writerow((t.key, r.case, r.quantity, r.unit, *shown, r.relative, r.tolerance, r.basis, r.holds))
    return buffer.getvalue().encode()
