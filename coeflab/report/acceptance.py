"""A publication beside what we find: what a number is held against, what comes out, and whether it holds.

Numbers beside what they are held against, as tables.
"""

from __future__ import annotations

from collections.abc import Sequence
from enum import StrEnum
from math import copysign, inf, nan
from typing import TYPE_CHECKING

from coeflab.core.cards import html_by
from coeflab.core.table import ABSENT, Table
from coeflab.core.text.csv_rows import csv_text
from coeflab.core.types import dataclass, in_angles
from coeflab.core.wording import in_sentences, listed
from coeflab.law.symbols import primed
from coeflab.report.texts import table_of, text_of
from coeflab.study.study import Study
from coeflab.study.validation import WIDE, Validation, by_measured_number, printed_indices, validations

if TYPE_CHECKING:
    from coeflab.report.document import Figure
    from coeflab.vehicle.parameter_file import ParameterFile


class Basis(StrEnum):
    """Where the number comes from that ours is compared with, in the terms of ASME V&V 20: only measurements validate."""

    VALIDATION = "validation"
    VERIFICATION = "verification"
    REVISED = "revised"
    CALIBRATION = "calibration"
    CONSISTENCY = "consistency"

    @property
    def validates(self) -> bool:
        """Whether agreement says anything about nature: a measurement that nothing of ours has used."""
        return self is Basis.VALIDATION


@dataclass(frozen=True, slots=True)
class Compared:
    """One number of ours and what it is held against.

    Attributes
    ----------
    case, quantity : str
        Row and column of the table, for example ``0, 60 %`` and ``u``.
    unit : str
        ``1`` for numbers without one.
    against : float
        What it is held against; ``basis`` says where that comes from.
    found : float or None
        None where the computation gave no number.
    tolerance : float
        Largest difference that counts as agreement: of ``unit``, or a ratio where ``relative``.
    basis : Basis
    relative : bool
    at_most : bool
        Whether ``against`` is a limit that ``found`` must not exceed.
    """

    case: str
    quantity: str
    unit: str
    against: float
    found: float | None
    tolerance: float
    basis: Basis
    relative: bool = False
    at_most: bool = False

    @property
    def difference(self) -> float | None:
        """Found less what it is held against; over that where ``relative``."""
        if self.found is None:
            return None
        apart = self.found - self.against
        return apart / abs(self.against) if self.relative and self.against else apart

    @property
    def holds(self) -> bool:
        """Whether the difference is no larger than the tolerance, for a limit to the upper side only."""
        if self.difference is None:
            return False
        return (self.difference if self.at_most else abs(self.difference)) <= self.tolerance


@dataclass(frozen=True, slots=True)
class ComparedTable:
    """Rows of one published table or figure.

    Attributes
    ----------
    key : str
        Short, for JSON: ``steady_turns``.
    title : str
    rows : tuple of Compared
    source : str
        Table, figure or equation of the publication.
    statements : tuple of str
        What a reader has to know, in words.
    repeats : str
        Key of the table whose numbers this one meets another way; they count once.
    """

    key: str
    title: str
    rows: tuple[Compared, ...]
    source: str
    statements: tuple[str, ...] = ()
    repeats: str = ""

    @property
    def holds(self) -> bool:
        """Whether every row does."""
        return all(r.holds for r in self.rows)

    @property
    def within(self) -> str:
        """How many rows hold, of how many."""
        return f"{sum(r.holds for r in self.rows)} of {len(self.rows)}"


@dataclass(frozen=True, slots=True)
class Acceptance:
    """A publication reproduced.

    Attributes
    ----------
    name, title : str
    tables : tuple of ComparedTable
    errata : tuple of str
        Errors of the publication, each with what stands in their place.
    statements : tuple of str
    citations : tuple of str
    figures : tuple of (str, Figure)
        File name without ending, and the drawing.
    conventions : tuple of str
        Axes, signs and units of its own, beside those that hold for every report.
    parameter_files : tuple of ParameterFile
        The system, as far as the format holds it; their notes say what it does not hold.
    shown : tuple of Table
        What a terminal prints whole, in the place of the rows that fail.
    pages : tuple of (str, bytes)
        Further files of the validation, by name: pages that play a motion.
    """

    name: str
    title: str
    tables: tuple[ComparedTable, ...]
    errata: tuple[str, ...]
    statements: tuple[str, ...]
    citations: tuple[str, ...]
    figures: tuple[tuple[str, Figure], ...] = ()
    conventions: tuple[str, ...] = ()
    parameter_files: tuple[ParameterFile, ...] = ()
    shown: tuple[Table, ...] = ()
    pages: tuple[tuple[str, bytes], ...] = ()

    def __repr__(self) -> str:
        good = sum(r.holds for r in self.numbers)
        return in_angles(self, f"{self.name}: {good} of {len(self.numbers)} published numbers within the tolerance")

    def _repr_html_(self) -> str:
        """Its answer with pictures, for notebooks."""
        return html_by("acceptance", self)

    @property
    def holds(self) -> bool:
        """Whether every table does."""
        return all(t.holds for t in self.tables)

    @property
    def file_notes(self) -> tuple[str, ...]:
        """What the parameter files say of themselves, and of what they do not hold; each once."""
        return tuple(dict.fromkeys(note for p in self.parameter_files for note in p.remarks))

    @property
    def numbers(self) -> tuple[Compared, ...]:
        """Rows that count: those of tables that repeat another's numbers do not."""
        return tuple(r for t in self.tables if not t.repeats for r in t.rows)

    @property
    def repeated(self) -> tuple[Compared, ...]:
        """Rows that meet numbers of another table another way."""
        return tuple(r for t in self.tables if t.repeats for r in t.rows)

    @property
    def counts(self) -> dict[Basis, int]:
        """How many numbers there are of each basis, in the order of `Basis`."""
        return {b: sum(r.basis is b for r in self.numbers) for b in Basis}


Held = dict[Basis, tuple[int, int]]


def held(acceptance: Acceptance) -> Held:
    """How many numbers of each basis hold, and how many there are."""
    rows = acceptance.numbers
    return {b: (sum(r.holds for r in rows if r.basis is b), count) for b, count in acceptance.counts.items()}


def held_of_study(study: Study) -> Held:
    """The same of a plan: computed against measured coefficients are predicted, published evaluations of its data recomputed.

    A measured number that several computations meet counts once. The numbers of other bodies have no verdict and do not count.
    """
    predicted = _predicted(study)
    printed = [c.passed for c in study.comparisons if c.passed is not None]
    printed += [i.holds for i in printed_indices(study)]
    found = {Basis.VALIDATION: predicted, Basis.VERIFICATION: printed}
    return {b: (sum(found.get(b, ())), len(found.get(b, ()))) for b in Basis}


def _predicted(study: Study) -> list[bool]:
    """Of every measured number that CFD predicts with a verdict, whether all computations of it lie within U_V."""
    return [all(v.within for v in one) for one in by_measured_number(validations(study, study.budgets))]


def on_predictions(study: Study) -> tuple[str, ...]:
    """How many comparisons stand behind the predicted numbers, which are weak, and which have no verdict; sentences."""
    found = validations(study, study.budgets)
    judged = [v for v in found if v.within is not None]
    numbers = by_measured_number(found)
    out = []
    if len(judged) > len(numbers):
        out.append(
            f"{len(judged)} comparisons judge them; a coefficient of several campaigns passes if all of its comparisons do."
        )
    if weak := [f"{primed(v.symbol)} of {v.simulation} ({v.share})" for v in judged if v.weak]:
        out.append(
            in_sentences(
                f"Weak predictions (U_V above {100.0 * WIDE:.0f} % of the measured value): ", weak, join=listed
            )
        )
    if none := [v for v in found if v.within is None]:
        out += [_without_verdict(none), *_beyond(none)]
    return tuple(out)


def _without_verdict(found: Sequence[Validation]) -> str:
    """Coefficients that are computed and measured but not judged, with what all computations of them share first."""
    by: dict[str, list[str]] = {}
    for symbol in dict.fromkeys(v.symbol for v in found):
        mine = [v for v in found if v.symbol == symbol]
        shared = [why for why in mine[0].reasons if all(why in v.reasons for v in mine)]
        own = [f"{why} in {v.simulation}" for v in mine for why in v.reasons if why not in shared]
        by.setdefault("; ".join((*shared, *own)), []).append(primed(symbol))
    each = [f"{listed(symbols)} ({why})" for why, symbols in by.items()]
    return in_sentences("No verdict on ", each, join=", ".join)


def _beyond(found: Sequence[Validation]) -> list[str]:
    """Which of them differ by more than U_V, and how much of the measured value."""
    far: dict[str, list[str]] = {}
    for v in (v for v in found if v.beyond):
        apart = "" if v.zero or not v.measured else f" ({100.0 * v.error / v.measured:+.0f} %)"
        far.setdefault(v.simulation, []).append(f"{primed(v.symbol)}{apart}")
    each = [f"{listed(symbols)} of {campaign}" for campaign, symbols in far.items()]
    return [in_sentences("Of these, beyond U_V (difference in % of the measured value): ", each)] if each else []


KINDS = ("coefficients predicted by CFD", "re-analyses of the authors' data", "recomputed stability indices")


def headline_of_study(study: Study) -> tuple[str, ...]:
    """How many numbers of a plan hold, kind by kind, and what stands behind the predicted ones; empty without any."""
    predicted = _predicted(study)
    again = [bool(c.passed) for c in study.comparisons if c.passed is not None]
    recomputed = [i.holds for i in printed_indices(study)]
    kinds = [(name, found) for name, found in zip(KINDS, (predicted, again, recomputed), strict=True) if found]
    if not kinds:
        return ()
    good, count = (sum(map(f, (found for _, found in kinds))) for f in (sum, len))
    each = ", ".join(f"{sum(found)} of {len(found)} {name}" for name, found in kinds)
    lie = f"All {count} judged numbers lie" if good == count > 1 else f"{good} of the {count} judged numbers lie"
    return (f"{lie} within their tolerance: {each}.", *on_predictions(study))


def headline(numbers: Held) -> tuple[str, ...]:
    """How many numbers hold by basis, and how many of them validate anything where not all do: one or two sentences."""
    every = [sum(pair[k] for pair in numbers.values()) for k in (0, 1)]
    by_basis = "; ".join(f"{b} {good} of {count}" for b, (good, count) in numbers.items() if count)
    first = f"{every[0]} of the {every[1]} compared numbers lie within their tolerance{f': {by_basis}' if by_basis else ''}."
    good, count = (sum(pair[k] for b, pair in numbers.items() if b.validates) for k in (0, 1))
    if not count:
        return (first, "Nothing here is validation: nothing is compared with a measurement that was not used.")
    if count == every[1]:
        return (first,)
    return (first, f"Only measurements that were not used validate: {good} of {count} lie within.")


def tables(acceptance: Acceptance) -> tuple[Table, ...]:
    """One table for each of the publication."""
    return tuple(_table(t) for t in acceptance.tables)


def _table(t: ComparedTable) -> Table:
    notes = (f"In the publication: {t.source}.", *t.statements)
    return Table(t.title, HEADERS, tuple(_row(r) for r in t.rows), notes, frozenset({0, 1, 3, 5, 8}))


HEADERS = ("case", "quantity", "reference", "basis", "found", "unit", "difference", "tolerance", "verdict")


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


def share(r: Compared) -> float:
    """Difference over what is allowed, of a limit the share that is used; NaN where nothing was found."""
    if r.found is None or r.difference is None:
        return nan
    if r.at_most:
        limit = r.against + r.tolerance * (abs(r.against) if r.relative else 1.0)
        return max(r.found, 0.0) / limit if limit > 0.0 else (0.0 if r.holds else inf)
    if r.tolerance == 0.0:
        return 0.0 if r.holds else copysign(inf, r.difference)
    return r.difference / r.tolerance


WORST, MEANING = "worst / tolerance", "what our number is compared with"
WORST_NOTE = f"{WORST}: the largest difference in % of its tolerance; of a limit, the share that is reached."


def overview(found: Acceptance) -> Table:
    """One row a table of the publication."""
    rows = tuple((t.title, t.source, t.within, _closest(t.rows), _verdict(t.rows)) for t in found.tables)
    notes = (WORST_NOTE,)
    headers = ("what", "in the publication", "within", WORST, "verdict")
    return Table("Tables of the publication", headers, rows, notes, frozenset({0, 1, 4}))


def by_basis(found: Acceptance) -> Table:
    """One row a basis: how many numbers have it, how many are within the tolerance, and the worst of them."""
    rows = []
    for b, (good, count) in held(found).items():
        mine = [r for r in found.numbers if r.basis is b]
        if mine:
            rows.append((b.value, text_of(f"acceptance.{b}"), f"{good} of {count}", _closest(mine), _verdict(mine)))
    again = found.repeated
    once = f"{len(again)} more comparisons repeat these numbers in another way: {sum(r.holds for r in again)} within the tolerance."
    headers = ("basis", MEANING, "within", WORST, "verdict")
    return Table(
        "Numbers of the publication by basis", headers, tuple(rows), (once,) if again else (), frozenset({0, 1, 4})
    )


def _closest(rows: Sequence[Compared]) -> str:
    shares = [abs(share(r)) for r in rows if r.found is not None and (r.tolerance > 0.0 or r.at_most)]
    return f"{100.0 * max(shares):.0f} %" if shares else "-"


def _verdict(rows: Sequence[Compared]) -> str:
    return "pass" if all(r.holds for r in rows) else "fail"


def errata(acceptance: Acceptance) -> Table:
    """Errors of the publication and what stands in their place."""
    rows = tuple((str(i), text) for i, text in enumerate(acceptance.errata, start=1))
    return table_of("acceptance.errata", rows)


CSV = ("table", "case", "quantity", "unit", "held_against", "found", "difference", "relative", "tolerance", "basis", "passed")  # fmt: skip


def acceptance_csv(acceptance: Acceptance) -> bytes:
    """All rows of all tables."""
    rows: list[tuple[object, ...]] = [CSV]
    for t in acceptance.tables:
        for r in t.rows:
            numbers = (r.against, r.found, r.difference)
            shown = ["" if n is None else repr(float(n)) for n in numbers]
            rows.append((t.key, r.case, r.quantity, r.unit, *shown, r.relative, r.tolerance, r.basis, r.holds))
    return csv_text(rows).encode()
