"""``coeflab merge``: numbers of a parameter file replaced, one by one, by those of a computation or a measurement."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import typer

from coeflab.cli import show

EXAMPLE = "coeflab merge reports/hull/hull.parameters.json my_study/campaign --out reports/hull_merged"


def command(
    base: Path = typer.Argument(..., metavar="BASE", help="A parameter file, such as that of coeflab vehicle."),
    other: str = typer.Argument(
        ..., metavar="OTHER", help="A parameter file, or a campaign that is fitted about the base's reference point."
    ),
    name: str = typer.Option("", metavar="NAME", help="Of the merged file; default BASE_merged.", show_default=False),
    out: Path | None = typer.Option(None, metavar="FOLDER", help="Folder for the files; default that of BASE."),
    json: bool = typer.Option(False, "--json", help="Print one JSON object."),
) -> None:
    """Replace the estimates of a vehicle by fitted numbers.

    What the other file does not give stays. Prints what was replaced, and what the estimates that remain contribute to the
    uncertainty of the turn; writes the merged parameter file and a report.
    """
    from coeflab.core.files import write_all
    from coeflab.report.sections import estimates as tables
    from coeflab.vehicle.parameter_file import read_parameter_file
    from coeflab.workbench import run
    from coeflab.workbench.vehicle import given_by, replaced, replaced_files

    with show.progress(json) as say:
        say("reading both")
        first = read_parameter_file(base)
        second = given_by(other, first, run)
        say("merging, and moving what came out")
        made, moves, carried = replaced(first, second, name or f"{first.name}_merged")
    folder = out if out is not None else base.parent
    files = replaced_files(made, moves, carried)
    write_all(folder, files)
    paths = [folder / n for n in sorted(files)]
    if json:
        show.json_object({**as_json(made, carried), "files": [str(p) for p in paths]})
        return
    words = tables.interval_in_words(carried).removesuffix(", estimate")
    many = sum(r.after is not None for r in made.replaced)
    left = len(made.estimates)
    show.sentence(
        f"{made.parameters.name}: {many} number{'s' * (many != 1)} from {second.name}, {left} estimate{'s' * (left != 1)} left"
        f"{f'; {words}' if words else ''}."
    )
    show.text()
    show.table(tables.merged_table(made))
    show.table(tables.estimates_table(made.parameters, carried))
    for path in paths:
        show.path(path)


def as_json(made: Any, carried: Any) -> dict[str, Any]:
    """What was replaced, what is left, and the uncertainty of the first manoeuvre."""
    from coeflab.cli.uncertainty import as_json as carried_json

    def one(c: Any) -> dict[str, Any] | None:
        return None if c is None else {"value": c.value, "u95": c.u95, "status": str(c.status), "campaign": c.campaign}

    return {
        "name": made.parameters.name,
        "replaced": [{"symbol": r.symbol, "before": one(r.before), "after": one(r.after)} for r in made.replaced],
        "estimates": [c.symbol for c in made.estimates],
        "uncertainty": [carried_json(c) for c in carried],
    }
