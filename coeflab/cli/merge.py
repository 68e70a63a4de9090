"""``coeflab merge``: numbers of a parameter file replaced, one by one, by those of a computation or a measurement."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from coeflab.cli import options, show
from coeflab.core.texts import input_error

if TYPE_CHECKING:
    from coeflab.api.merging import Merge

EXAMPLE = "coeflab merge reports/hull/hull.parameters.json my_study/campaign --out reports/hull_merged"


@options.worded
def command(
    *, base: Path, other: str = "", numbers: list[str], name: str = "", out: Path | None = None, json: bool = False
) -> None:
    """Replace the estimates of a vehicle by fitted numbers, or by numbers of your own.

    What the other file does not give stays. Prints what was replaced, and what the estimates that remain contribute to the
    uncertainty of the turn; writes the merged parameter file and a report.
    """
    from coeflab.api.merging import merge, own_numbers
    from coeflab.api.parameters import read_parameters
    from coeflab.core.files import write_all

    if bool(other) == bool(numbers):
        raise input_error(
            "commands.parameter_file_campaign", column="OTHER",
            found="OTHER and --set together" if other else "nothing to merge",
            advice="Merge the file first, then set the numbers." if other else "",
        )  # fmt: skip
    chosen = own_numbers(numbers)
    with show.progress(json) as say:
        say("reading both" if other else "reading the file")
        first = read_parameters(base)
        done = merge(first, other or chosen, name, say)
        folder, files = out if out is not None else base.parent, done.files()
        write_all(folder, files)
    paths = [folder / one for one in sorted(files)]
    if json:
        show.json_object(as_object(done, paths))
    else:
        summarise(done, paths)
        show.found([f for f in done.merged.parameters.findings if f not in first.findings])
    if show.failed(done.checks):
        raise typer.Exit(1)


def as_object(done: Merge, paths: Sequence[Path]) -> dict[str, Any]:
    """What was replaced, what is left, and the files, for machines."""
    from coeflab.report.as_json.findings import findings
    from coeflab.report.as_json.motions import merged

    return {
        **merged(done.merged, done.carried), "findings": findings(done.checks), "files": [str(p) for p in paths],
    }  # fmt: skip


def summarise(done: Merge, paths: Sequence[Path]) -> None:
    """What was replaced, what is left, and the files."""
    from coeflab.report.sections import estimates as tables

    result, carried = done.merged, done.carried
    words = tables.interval_in_words(carried, result.parameters.conditions.speed).removesuffix(", estimate")
    left = len(result.estimates)
    show.sentence(
        f"{result.parameters.name}: {tables.given(result)} from {done.source}, {left} estimate{'s' * (left != 1)} left"
        f"{f'; {words}' if words else ''}."
    )
    show.text()
    if result.lengths:
        show.marked("warn", f"{result.lengths}.")
        show.text()
    show.table(tables.merged_table(result))
    show.table(tables.estimates_table(result.parameters, carried))
    for path in paths:
        show.path(path)
    show.file_findings(result.parameters.name, done.checks)
