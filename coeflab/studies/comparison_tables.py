"""Comparisons of parameter files as tables: pair by pair in full, or several files beside the first."""

from __future__ import annotations

from collections.abc import Sequence
from math import degrees

from coeflab.core.symbols import CONTROLS
from coeflab.model.parameter_file import ParameterFile
from coeflab.model.table import ABSENT, Table, coefficient, number
from coeflab.studies.compare import Compared, Comparison
from coeflab.studies.compare_models import ComparedModel
from coeflab.studies.shared_tables import Verdict

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
    headers = ("", "first", "U95", "second", "U95", "difference", "combined", "ratio", "verdict", "")
    title = f"{found.b} against {found.a}"
    return Table(title, headers, rows, () if found.models else found.statements, frozenset({0, 8, 9}))


def models(found: Comparison, *, with_statements: bool = True) -> Table:
    """Every fitted table of a pair."""
    rows = tuple(
        (
            m.name, str(m.n_points) if m.n_points else ABSENT, number(m.rms, 3), number(m.largest, 3), _place(m),
            number(m.combined, 3), number(None if m.share is None else 100.0 * m.share, 3), m.verdict.value, m.reason,
        )
        for m in found.models
    )  # fmt: skip
    headers = ("", "points", "rms diff.", "largest", "at", "combined", "% within", "verdict", "")
    left = frozenset({0, 4, 7, 8})
    return Table("Fitted tables", headers, rows, found.statements if with_statements else (), left)


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
    headers = ["", names[0], "U95"]
    for name in names[1:]:
        headers += [name, "U95", "diff. / combined", "verdict"]
    rows = []
    for symbol in dict.fromkeys((*own, *(s for rows in found for s in rows))):
        here = own.get(symbol)
        row = [symbol, *((coefficient(here.value), coefficient(here.u95)) if here else (ABSENT, ABSENT))]
        for other in found:
            r = other.get(symbol)
            row += _cells(r) if r else [ABSENT, ABSENT, ABSENT, Verdict.NOT_COMPARABLE.value]
        rows.append(tuple(row))
    left = frozenset({0, *(6 + 4 * i for i in range(len(others)))})
    notes = (
        (f"Primed by {first.scaling.length_name} {first.scaling.length:g} m of {names[0]}, about its reference point. "
         "A difference is apart where it exceeds the root sum of squares of both U95.",) if others else ()
    )  # fmt: skip
    return Table("Coefficients side by side" if others else "Coefficients", tuple(headers), tuple(rows), notes, left)


def reasons(found: Comparison) -> tuple[str, ...]:
    """What a pair's rows have to say, each reason once with its symbols."""
    said: dict[str, list[str]] = {}
    for r in found.rows:
        if r.reason:
            said.setdefault(r.reason, []).append(r.symbol)
    return tuple(f"{', '.join(symbols)}: {reason}" for reason, symbols in said.items())


def _cells(r: Compared) -> list[str]:
    return [coefficient(r.b), coefficient(r.u95_b), number(r.ratio, 3), r.verdict.value]


def _place(m: ComparedModel) -> str:
    """Where the largest difference is: angles in degrees, primes as such."""
    return ", ".join(
        f"{v} {degrees(x) + 0.0:.3g} deg" if v in ANGLES else f"{v} {x + 0.0:.3g}" for v, x in (m.at or {}).items()
    )
