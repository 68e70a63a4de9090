"""Comparisons of parameter files as tables: pair by pair in full, or several files beside the first."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import degrees
from typing import TYPE_CHECKING

from coeflab.core.table import ABSENT, Table, coefficient, number, with_u95
from coeflab.core.wording import collected
from coeflab.law.symbols import CONTROLS
from coeflab.report.texts import table_of, text_of
from coeflab.vehicle.comparison import ROUNDING, Compared, Comparison
from coeflab.vehicle.shared_tables import Verdict

if TYPE_CHECKING:
    from coeflab.motion.behaviour import Behaviour
    from coeflab.vehicle.compared_models import ComparedModel
    from coeflab.vehicle.parameter_file import ParameterFile


ANGLES = ("alpha", "beta", *CONTROLS)


def coefficients(found: Comparison) -> Table:
    """Every coefficient of a pair, with its verdict and reason; the statements follow where no fitted table does."""
    rows = tuple(
        (
            r.symbol, coefficient(r.a), coefficient(r.u95_a), coefficient(r.b), coefficient(r.u95_b),
            coefficient(r.difference), coefficient(r.combined), number(r.ratio, 3), r.verdict.value, r.reason,
        )
        for r in found.rows
    )  # fmt: skip
    return table_of("models.coefficients", rows, () if found.models else found.statements, a=found.a, b=found.b)


def differ(found: Comparison) -> list[bool]:
    """Whether the values of each row differ by more than rounding."""
    return [bool(r.difference) and abs(r.difference or 0.0) > ROUNDING * abs(r.a or 0.0) for r in found.rows]


def comparable(table: Table, differ: Sequence[bool]) -> Table:
    """The rows that can be compared, or whose values ``differ``; of the others their names in notes, by verdict and reason."""
    column = table.headers.index("verdict")
    named = (Verdict.NOT_COMPARABLE.value, Verdict.EQUAL.value)
    rows = [row for row, other in zip(table.rows, differ, strict=True) if other or row[column] not in named]
    by_reason: dict[str, list[str]] = {}
    for row in table.rows:
        if row not in rows:
            equal = row[column] == Verdict.EQUAL.value
            why = f"{row[column].capitalize()}{';' if equal else ','} {row[-1]}".rstrip(",; ")
            by_reason.setdefault(why, []).append(row[0])
    notes = (*(f"{why}: {', '.join(names)}." for why, names in by_reason.items()), *table.notes)
    return replace(table, rows=tuple(rows), notes=notes)


def models(found: Comparison, *, with_statements: bool = True) -> Table:
    """Every fitted table of a pair."""
    rows = tuple(
        (
            m.name, str(m.n_points) if m.n_points else ABSENT, number(m.rms, 3), number(m.largest, 3), _place(m),
            number(m.combined, 3), number(None if m.share is None else 100.0 * m.share, 3), m.verdict.value, m.reason,
        )
        for m in found.models
    )  # fmt: skip
    return table_of("models.models", rows, found.statements if with_statements else ())


def behaviour(found: Sequence[Behaviour], a: str, b: str) -> Table:
    """What two vehicles do: a row a figure, with the difference over combined U95."""
    rows = (
        (r.name, *(number(x) for x in (r.a, r.b, r.difference, r.combined)), number(r.ratio, 2), r.unit, r.reason)
        for r in found
    )
    return table_of("models.behaviour", rows, a=a, b=b)


def side_by_side(first: ParameterFile, others: Sequence[Comparison], names: Sequence[str]) -> Table:
    """The values of several files in the first one's length and about its point, with U95 and ratio.

    Parameters
    ----------
    first : ParameterFile
    others : sequence of Comparison
        Each of another file against the first; none shows the first alone.
    names : sequence of str
        Heads of the columns, the first file's among them.
    """
    found: list[dict[str, Compared]] = [{r.symbol: r for r in c.rows} for c in others]
    own = {c.symbol: c for c in first.coefficients}
    headers = ["", names[0], f"U95 of {names[0]}"]
    for name in names[1:]:
        headers += [name, f"U95 of {name}", "diff. / combined", "verdict"]
    rows = []
    for symbol in dict.fromkeys((*own, *(s for rows in found for s in rows))):
        here = own.get(symbol)
        row = [symbol, *(with_u95(here.value, here.u95) if here else (ABSENT, ABSENT))]
        for other in found:
            r = other.get(symbol)
            row += _cells(r) if r else [ABSENT, ABSENT, ABSENT, Verdict.NOT_COMPARABLE.value]
        rows.append(tuple(row))
    left = frozenset({0, *(6 + 4 * i for i in range(len(others)))})
    notes = (
        (text_of("models.side_by_side", length_name=first.scaling.length_name, length=first.scaling.length, names=names[0]),) if others else ()
    )  # fmt: skip
    return Table("Coefficients side by side" if others else "Coefficients", tuple(headers), tuple(rows), notes, left)


def reasons(found: Comparison) -> tuple[str, ...]:
    """What a pair's rows have to say, each reason once with its symbols."""
    named = collected((r.reason, r.symbol) for r in found.rows if r.reason)
    return tuple(f"{', '.join(symbols)}: {reason}" for reason, symbols in named.items())


def _cells(r: Compared) -> list[str]:
    return [*with_u95(r.b, r.u95_b), number(r.ratio, 3), r.verdict.value]


def _place(m: ComparedModel) -> str:
    """Where the largest difference is: angles in degrees, primes as such."""
    return ", ".join(
        f"{v} {degrees(x) + 0.0:.3g} deg" if v in ANGLES else f"{v} {x + 0.0:.3g}" for v, x in (m.at or {}).items()
    )
