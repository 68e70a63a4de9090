"""``coeflab compare``: two parameter files, coefficient by coefficient."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from coeflab.cli import show

if TYPE_CHECKING:
    from coeflab.studies.compare import Comparison

EXAMPLE = "coeflab compare a.parameters.json b.parameters.json"


def command(
    first: Path = typer.Argument(..., help="A parameter file; its length and reference point are kept."),
    second: Path = typer.Argument(..., help="The parameter file that is held against it."),
    json: bool = typer.Option(False, "--json", help="Print one JSON object."),
) -> None:
    """Compare two parameter files: differences against the combined U95, lengths and reference points converted."""
    from coeflab.model.parameter_file import read_parameter_file
    from coeflab.studies.compare import compare

    found = compare(read_parameter_file(first), read_parameter_file(second))
    if json:
        show.json_object(as_json(found))
    else:
        _print(found)


def as_json(found: Comparison) -> dict[str, Any]:
    """The comparison as one JSON object."""
    return {
        "first": found.a,
        "second": found.b,
        "same_body": found.same_body,
        "statements": list(found.statements),
        "coefficients": [
            {
                "symbol": r.symbol,
                "first": r.a,
                "second": r.b,
                "first_u95": r.u95_a,
                "second_u95": r.u95_b,
                "difference": r.difference,
                "combined_u95": r.combined,
                "ratio": r.ratio,
                "verdict": r.verdict.value,
                "reason": r.reason,
            }
            for r in found.rows
        ],
    }


def _print(found: Comparison) -> None:
    from coeflab.model.table import Table, coefficient, number
    from coeflab.studies.compare import Verdict

    rows = tuple(
        (
            r.symbol, coefficient(r.a), coefficient(r.u95_a), coefficient(r.b), coefficient(r.u95_b),
            coefficient(r.difference), coefficient(r.combined), number(r.ratio, 3), r.verdict.value, r.reason,
        )
        for r in found.rows
    )  # fmt: skip
    headers = ("", "first", "U95", "second", "U95", "difference", "combined", "ratio", "verdict", "")
    title = f"{found.b} against {found.a}"
    show.table(Table(title, headers, rows, found.statements, frozenset({0, 8, 9})))
    counts = {v: sum(r.verdict is v for r in found.rows) for v in Verdict}
    show.text(", ".join(f"{n} {v.value}" for v, n in counts.items()) + ".")
