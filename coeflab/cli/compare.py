"""``coeflab compare``: two parameter files, coefficient by coefficient and fitted table by fitted table."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from coeflab.cli import options, show

if TYPE_CHECKING:
    from coeflab.api.comparing import Behaviour, Comparison


EXAMPLE = "coeflab compare a.parameters.json b.parameters.json"


@options.worded
def command(*, first: Path, second: Path, speed: str = "", json: bool = False) -> None:
    """Compare two parameter files by their combined U95.

    Lengths and reference points are converted; Yv' and Yuv', single added masses and entries of a matrix are matched. Fitted tables of one response over the same variables are compared on a grid inside the data of both: "within"
    means that at 95 % of its points the difference is inside the combined 95 % half-width. Where one of two values has no U95,
    another sign and a ratio above 1.5 are marked. Exit code 1 where two files of one body are apart or of other signs.
    """
    import coeflab as cf
    from coeflab.api.comparing import behaviour
    from coeflab.core.units import positive_typed

    found = cf.compare(first, second)
    done = behaviour(first, second, positive_typed(speed, "speed", "--speed")) if speed else ()
    if json:
        show.json_object(as_json(found) | ({"behaviour": [behaviour_json(r) for r in done]} if speed else {}))
    else:
        _print(found)
        if done:
            from coeflab.report.tables import compared_files

            show.table(compared_files.behaviour(done, found.a, found.b))
    if found.disagrees:
        raise typer.Exit(1)


def behaviour_json(row: Behaviour) -> dict[str, Any]:
    """One figure of both."""
    return {
        "name": row.name, "unit": row.unit, "first": row.a, "second": row.b, "difference": row.difference,
        "combined_u95": row.combined, "ratio": row.ratio, "reason": row.reason,
    }  # fmt: skip


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
                "shared_tables": list(r.shared),
            }
            for r in found.rows
        ],
        "models": [
            {
                "response": m.response,
                "variables": list(m.variables),
                "n_points": m.n_points,
                "rms_difference": m.rms,
                "largest_difference": m.largest,
                "largest_at": m.at,
                "rms_combined_half_width_95": m.combined,
                "share_within": m.share,
                "verdict": m.verdict.value,
                "reason": m.reason,
                "shared_tables": list(m.shared),
            }
            for m in found.models
        ],
    }


def _print(found: Comparison) -> None:
    from coeflab.api.comparing import Verdict
    from coeflab.report.tables import compared_files

    for table, differ in (
        (compared_files.coefficients(found), compared_files.differ(found)),
        (compared_files.models(found), [False] * len(found.models)),
    ):
        shown = table if show.whole() else compared_files.comparable(table, differ)
        if shown.rows:
            show.table(shown)
        elif table.rows:
            for line in (shown.title, *(f"  {note}" for note in shown.notes)):
                show.sentence(line)
            show.text()
    if not found.rows and not found.models:
        show.text("Neither file has coefficients or fitted tables.")
    for what, verdicts in (("", [r.verdict for r in found.rows]), ("Tables: ", [m.verdict for m in found.models])):
        if verdicts:
            words = [
                v for v in Verdict if v in verdicts or v not in (Verdict.EQUAL, Verdict.OTHER_SIGN, Verdict.OTHER_SIZE)
            ]
            show.text(what + ", ".join(f"{verdicts.count(v)} {v.value}" for v in words) + ".")
