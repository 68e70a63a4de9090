"""A publication reproduced, as a report: verdict, figures, every number and what it is held against, errata."""

from __future__ import annotations

from coeflab.core.citations import work
from coeflab.core.provenance import InputFile
from coeflab.model.acceptance import BASES, Acceptance, ComparedTable
from coeflab.model.table import Table
from coeflab.presentation import acceptance_tables
from coeflab.presentation.allowance_figure import allowance_figure, share
from coeflab.presentation.conventions_section import published_conventions
from coeflab.presentation.document import Document, Figure, Section
from coeflab.presentation.reproduction import digest_of, published_reproduction


def document(found: Acceptance, inputs: tuple[InputFile, ...] = ()) -> Document:
    """The report of a publication.

    Parameters
    ----------
    found : Acceptance
    inputs : tuple of InputFile, optional
        The files that it was computed from.
    """
    tables = tuple(
        Section(f"table-{t.key.replace('_', '-')}", t.title, tables=(shown,))
        for t, shown in zip(found.tables, acceptance_tables.tables(found), strict=True)
    )
    sections = (
        verdict(found),
        *_section("figures", "Figures", figures=figures(found)),
        Section("compared", "Every number and what it is held against", (DIFFERENCES,), subsections=tables),
        *_section("statements", "What to know", found.statements),
        *_section("parameter-files", "Parameter files", found.file_notes),
        *_errata(found),
        published_conventions(found.conventions),
        *_provenance(inputs),
        published_reproduction(found, inputs),
    )
    works = tuple((k, work(k)) for k in found.citations)
    return Document(found.title, SUBTITLE, sections, found.name, digest_of(inputs), works)


SUBTITLE = "A publication reproduced: every number and what it is held against"
DIFFERENCES = (
    "Held against: a number that the paper prints only where the basis beside it says so. Difference: found less what it is "
    "held against, as a share of the latter where a per cent sign stands. A number passes when the difference is no larger than "
    "what is allowed."
)
PROVENANCE = "The files below are known by the sha256 of their bytes."


def verdict(found: Acceptance) -> Section:
    """How many numbers hold, and which do not."""
    rows = [*found.numbers, *found.repeated]
    text = [*headline(found)]
    for t in found.tables:
        failed = [f"{r.quantity} of {r.case}" for r in t.rows if not r.holds]
        if failed:
            text.append(f"Outside, {t.title}: {', '.join(failed)}.")
    kinds = [f"{b}: {meaning}" for b, meaning in BASES.items() if found.counts[b]]
    text.append(f"What they are compared with. {'; '.join(kinds)[:1].upper()}{'; '.join(kinds)[1:]}.")
    drawn = (allowance_figure(found, "allowances"),) if rows else ()
    return Section("verdict", "Verdict", tuple(text), (overview(found),), drawn)


def headline(found: Acceptance) -> tuple[str, ...]:
    """How many numbers hold by basis, and how many of them validate anything: two sentences."""
    numbers, again, counts = found.numbers, found.repeated, found.counts
    held = sum(r.holds for r in numbers)
    by_basis = ", ".join(f"{count} {b}" for b, count in counts.items())
    first = f"{held} of {len(numbers)} numbers within what is allowed: {by_basis}."
    if again:
        first += f" {sum(r.holds for r in again)} of {len(again)} comparisons meet numbers among them another way, and do not count."
    validating = sum(count for b, count in counts.items() if b.validates)
    if validating:
        good = sum(r.holds for r in numbers if r.basis.validates)
        return (
            first,
            f"Validation rests on {validating} of them, predicted or printed and recomputed, of which {good} hold.",
        )
    return (
        first,
        "Nothing here is validation: no number of the paper is predicted, and none that it prints is recomputed.",
    )


def overview(found: Acceptance) -> Table:
    """One row a table of the publication."""
    rows = tuple(
        (
            t.title,
            t.source,
            f"{sum(r.holds for r in t.rows)} of {len(t.rows)}",
            _closest(t),
            "pass" if t.holds else "fail",
        )
        for t in found.tables
    )
    notes = (
        "used: the largest difference as a share of what is allowed, where that is not zero; of a limit the share that is reached",
    )
    headers = ("what", "of the publication", "hold", "used", "verdict")
    return Table("Tables of the publication", headers, rows, notes, frozenset({0, 1, 4}))


def _closest(t: ComparedTable) -> str:
    shares = [abs(share(r)) for r in t.rows if r.found is not None and (r.tolerance > 0.0 or r.at_most)]
    return f"{100.0 * max(shares):.0f} %" if shares else "-"


def figures(found: Acceptance) -> tuple[Figure, ...]:
    """Its drawings."""
    return tuple(Figure(d.anchor, d.svg, d.title, d.caption, d.description, d.panels) for _, d in found.figures)


def _section(
    anchor: str, title: str, text: tuple[str, ...] = (), figures: tuple[Figure, ...] = ()
) -> tuple[Section, ...]:
    return (Section(anchor, title, text, figures=figures),) if text or figures else ()


def _errata(found: Acceptance) -> tuple[Section, ...]:
    if not found.errata:
        return ()
    return (Section("errata", "Errata of the publication", tables=(acceptance_tables.errata(found),)),)


def _provenance(inputs: tuple[InputFile, ...]) -> tuple[Section, ...]:
    if not inputs:
        return ()
    rows = tuple((f.name, f.sha256) for f in inputs)
    table = Table("Inputs", ("file", "sha256"), rows, (), frozenset({0, 1}))
    return (Section("provenance", "Provenance", (PROVENANCE,), (table,)),)
