"""``coeflab merge``: numbers of a parameter file replaced, one by one, by those of a computation or a measurement."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from coeflab.cli import show

if TYPE_CHECKING:
    from coeflab.core.table import Check
    from coeflab.vehicle.own_numbers import OwnNumber
    from coeflab.vehicle.parameter_file import ParameterFile

EXAMPLE = "coeflab merge reports/hull/hull.parameters.json my_study/campaign --out reports/hull_merged"


def command(
    base: Path = typer.Argument(..., metavar="BASE", help="A parameter file, such as that of coeflab vehicle."),
    other: str = typer.Argument(
        "",
        metavar="OTHER",
        help="A parameter file, or a campaign that is fitted about the base's reference point; not with --set.",
        show_default=False,
    ),
    numbers: list[str] = typer.Option(
        [],
        "--set",
        metavar="SYMBOL=VALUE",
        help='One number of your own, "X0\'=-0.00208 +- 0.00005" or "Yv=-35.5 N/(m/s)"; again for each.',
        show_default=False,
    ),
    name: str = typer.Option("", metavar="NAME", help="Of the merged file; default BASE_merged.", show_default=False),
    out: Path | None = typer.Option(None, metavar="FOLDER", help="Folder for the files; default that of BASE."),
    json: bool = typer.Option(False, "--json", help="Print one JSON object."),
) -> None:
    """Replace the estimates of a vehicle by fitted numbers, or by numbers of your own.

    What the other file does not give stays. Prints what was replaced, and what the estimates that remain contribute to the
    uncertainty of the turn; writes the merged parameter file and a report.
    """
    from coeflab.core.errors import InputError
    from coeflab.formats.model_files import read_vehicle_file
    from coeflab.vehicle.own_numbers import own_numbers

    if bool(other) == bool(numbers):
        raise InputError(
            "OTHER and --set together" if other else "nothing to merge", "a parameter file or a campaign, or numbers by --set",
            column="OTHER", advice="Merge the file first, then set the numbers." if other else "",
        )  # fmt: skip
    chosen = own_numbers(numbers)
    with show.progress(json) as say:
        say("reading both" if other else "reading the file")
        first = read_vehicle_file(base)
        done = carried_out(first, other or chosen, name, out if out is not None else base.parent, say)
    if json:
        show.json_object(done.as_json())
    else:
        done.print()
    if show.failed(done.found):
        raise typer.Exit(1)


@dataclass(frozen=True)
class Done:
    """A merge, what its estimates do to the first manoeuvres, and the files that were written.

    Attributes
    ----------
    made : Merged
    carried : tuple of Carried
    source : str
        Name of what replaced estimates.
    paths : tuple of Path
    found : tuple of Check
        What ``coeflab params check`` finds in the merged file.
    """

    made: Any
    carried: Any
    source: str
    paths: tuple[Path, ...]
    found: tuple[Check, ...]

    def as_json(self) -> dict[str, Any]:
        """What was replaced, what is left, and the files."""
        from coeflab.cli.as_json import findings

        found = findings(self.found)
        return {**as_json(self.made, self.carried), "findings": found, "files": [str(p) for p in self.paths]}

    def print(self) -> None:
        """Print it."""
        from coeflab.report.sections import estimates as tables

        result, carried = self.made, self.carried
        words = tables.interval_in_words(carried, result.parameters.conditions.speed).removesuffix(", estimate")
        many = sum(r.after is not None for r in result.replaced)
        left = len(result.estimates)
        show.sentence(
            f"{result.parameters.name}: {many} number{'s' * (many != 1)} from {self.source}, {left} estimate{'s' * (left != 1)} left"
            f"{f'; {words}' if words else ''}."
        )
        show.text()
        if result.lengths:
            show.marked("warn", f"{result.lengths}.")
            show.text()
        show.table(tables.merged_table(result))
        show.table(tables.estimates_table(result.parameters, carried))
        for path in self.paths:
            show.path(path)
        show.file_findings(result.parameters.name, self.found)


def carried_out(
    first: ParameterFile, other: str | Sequence[OwnNumber], name: str, folder: Path, say: Callable[[str], None]
) -> Done:
    """Merge a file, a campaign or numbers into a parameter file, and write what comes out.

    Parameters
    ----------
    first : ParameterFile
    other : str or sequence of OwnNumber
        A parameter file, a campaign, or numbers one by one.
    name : str
        Of the merged file; empty: that of the first with ``_merged``.
    folder : Path
    say : callable
        Takes what is being done, in words.

    Raises
    ------
    InputError, ScalingMismatchError
        As of `coeflab.study.estimated_vehicle.replaced`.
    """
    from coeflab.core.files import write_all
    from coeflab.report.rendered import replaced_files
    from coeflab.study.estimated_vehicle import given_by, replaced
    from coeflab.study.run import run
    from coeflab.vehicle.own_numbers import stated_beside
    from coeflab.vehicle.plausibility import plausibility

    by_hand = not isinstance(other, str)
    second, own = (
        given_by(other, first, run) if isinstance(other, str) else (stated_beside(first, other), first.scaling)
    )
    say("merging, and moving what came out")
    result, moves, carried = replaced(first, second, name or f"{first.name}_merged", own, alone=by_hand)
    files = replaced_files(result, moves, carried)
    write_all(folder, files)
    # a tow bears the name of its body, as the estimates do
    source = second.name if by_hand or second.name != first.name else str(other)
    return Done(result, carried, source, tuple(folder / n for n in sorted(files)), plausibility(result.parameters))


def as_json(made: Any, carried: Any) -> dict[str, Any]:
    """What was replaced, what is left, and the uncertainty of the first manoeuvre."""
    from coeflab.cli.uncertainty import as_json as carried_json

    def one(c: Any) -> dict[str, Any] | None:
        return None if c is None else {"value": c.value, "u95": c.u95, "status": str(c.status), "campaign": c.campaign}

    return {
        "name": made.parameters.name,
        "replaced": [{"symbol": r.symbol, "before": one(r.before), "after": one(r.after)} for r in made.replaced],
        "estimates": [c.symbol for c in made.estimates],
        "lengths": made.lengths or None,
        "uncertainty": [carried_json(c) for c in carried],
    }
