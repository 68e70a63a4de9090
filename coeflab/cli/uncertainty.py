"""``coeflab uncertainty``: the uncertainty of a parameter file carried through a manoeuvre."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import typer

from coeflab.cli import complete, options, show

if TYPE_CHECKING:
    from coeflab.api.uncertainty import Carried


EXAMPLE = "coeflab uncertainty reports/suboff/suboff_fully_appended.parameters.json --manoeuvre zigzag --sobol"
CONTEXT = {"allow_extra_args": True, "ignore_unknown_options": True}


def command(
    ctx: typer.Context,
    file: Path = options.PARAMS,
    manoeuvre: str = options.MANOEUVRE,
    members: int = typer.Option(
        1000, metavar="COUNT", help="Draws of the coefficients, each of which makes the manoeuvre."
    ),
    seed: int = typer.Option(1, metavar="NUMBER", help="Of the draws; the same seed gives the same numbers."),
    sobol: bool = typer.Option(
        False, "--sobol", help="Sobol indices of independent groups of coefficients; takes longer."
    ),
    cores: int = typer.Option(0, metavar="COUNT", show_default=False, help="Local processes; one a core without it."),
    scheduler: str = typer.Option("", metavar="ADDRESS", help="Dask scheduler in place of local processes."),
    state: Path | None = typer.Option(
        None,
        metavar="FOLDER",
        help="Folder for finished batches, so that a run that was stopped goes on; default OUT/batches.",
    ),
    free: str = options.FREE,
    hold: str = options.HOLD,
    current: str = options.CURRENT,
    kernel: str = typer.Option(
        "auto",
        metavar="NAME",
        autocompletion=complete.kernels,
        help="auto, compiled (numba) or numpy; the same numbers to 1e-12.",
    ),
    tables: bool = options.TABLES,
    accelerations: str = options.ACCELERATIONS,
    out: Path | None = typer.Option(
        None, metavar="FOLDER", help="Folder for members and figure; nothing is written without it."
    ),
    help_options: bool = typer.Option(False, "--help-options", help="Explain the options of the manoeuvre, and stop."),
    json: bool = typer.Option(False, "--json", help="Print one JSON object."),
) -> None:
    """Give intervals for the quantities of a manoeuvre, such as advance.

    Draws the coefficients of a parameter file and runs the manoeuvre for each draw. Says which test takes most off
    the variance. Any further --option VALUE goes to the manoeuvre: --rudder 20, in degrees without a unit. Numbers do not
    depend on cores, scheduler, or on having been stopped and started again. Exit code 1 where the file
    determines no quantity of the manoeuvre.
    """
    from coeflab.api.parameters import read_parameters
    from coeflab.api.uncertainty import Question, uncertainty
    from coeflab.cli.simulate import current_of, listed, of_manoeuvre

    if help_options:
        from coeflab.cli.formats import explain

        explain("manoeuvres", manoeuvre)
        return
    water = current_of(current)
    question = Question(
        manoeuvre, of_manoeuvre(manoeuvre, ctx.args), members, seed, sobol, listed(free), listed(hold), tables, accelerations,
        (water.get("north", 0.0), water.get("east", 0.0), water.get("down", 0.0)), kernel,
    )  # fmt: skip
    folder = state if state is not None else out / "batches" if out is not None else None
    parameters = read_parameters(file)
    if not json:
        show.not_used(parameters, tables)
    with show.narrated():
        result = uncertainty(parameters, question, cores, scheduler, folder)
    written = [] if out is None or result.undetermined else _write(result, out)
    if json:
        from coeflab.report.as_json.motions import carried

        show.json_object({**carried(result), "files": [str(p) for p in written]})
    else:
        _print(result, written)
    if result.undetermined:
        raise typer.Exit(1)


def _print(made: Carried, written: list[Path]) -> None:
    from coeflab.report.tables import uncertainty as uncertainty_tables

    if made.undetermined:
        name = f"{made.question.manoeuvre.replace('_', ' ')} of {made.vehicle}"
        show.text(f"No quantity of the {name} has a value, so that none has an interval; no draw was run.")
        show.text(made.undetermined)
        show.text()
    show.table(uncertainty_tables.spread_table(made))
    for found in made.importances:
        show.table(uncertainty_tables.share_table(found))
    show.table(uncertainty_tables.known_table(made))
    show.table(uncertainty_tables.tests_table(made))
    for line in (*uncertainty_tables.ranking(made), *made.statements):
        show.text(f"  {line}")
    for path in written:
        show.path(path)


def _write(made: Carried, folder: Path) -> list[Path]:
    from coeflab.core.files import write_all
    from coeflab.report.figures.svg import sheet
    from coeflab.report.figures.uncertainty import uncertainty_figures
    from coeflab.report.tables.uncertainty import members_csv

    name = made.question.manoeuvre
    content = {f"{name}_members.csv": members_csv(made)}
    figures = uncertainty_figures(made)
    if figures:
        content[f"{name}_uncertainty.svg"] = sheet(figures, made.water.source)
    write_all(folder, content)
    return [folder / file for file in content]
