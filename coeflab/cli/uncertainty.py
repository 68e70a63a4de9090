"""``coeflab uncertainty``: the uncertainty of a parameter file carried through a manoeuvre."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import typer

from coeflab.cli import options, show

if TYPE_CHECKING:
    from coeflab.api.uncertainty import Carried


EXAMPLE = "coeflab uncertainty reports/suboff/suboff_fully_appended.parameters.json --manoeuvre zigzag --sobol"
CONTEXT = {"allow_extra_args": True, "ignore_unknown_options": True}


@options.worded
def command(
    *,
    ctx: typer.Context,
    file: Path,
    manoeuvre: str = "turning_circle",
    members: int = 1000,
    seed: int = 1,
    sobol: bool = False,
    cores: int = 0,
    scheduler: str = "",
    state: Path | None = None,
    free: str = "",
    hold: str = "",
    current: str = "",
    kernel: str = "auto",
    tables: bool = False,
    accelerations: str = "measured",
    out: Path | None = None,
    help_options: bool = False,
    json: bool = False,
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


def _print(result: Carried, written: list[Path]) -> None:
    from coeflab.report.tables import uncertainty as uncertainty_tables

    if result.undetermined:
        name = f"{result.question.manoeuvre.replace('_', ' ')} of {result.vehicle}"
        show.text(f"No quantity of the {name} has a value, so that none has an interval; no draw was run.")
        show.text(result.undetermined)
        show.text()
    show.table(uncertainty_tables.spread_table(result))
    for found in result.importances:
        show.table(uncertainty_tables.share_table(found))
    show.table(uncertainty_tables.known_table(result))
    show.table(uncertainty_tables.tests_table(result))
    for line in (*uncertainty_tables.ranking(result), *result.statements):
        show.text(f"  {line}")
    for path in written:
        show.path(path)


def _write(result: Carried, folder: Path) -> list[Path]:
    from coeflab.core.files import write_all
    from coeflab.report.figures.svg_file import sheet
    from coeflab.report.figures.uncertainty import uncertainty_figures
    from coeflab.report.tables.uncertainty import members_csv

    name = result.question.manoeuvre
    content = {f"{name}_members.csv": members_csv(result)}
    figures = uncertainty_figures(result)
    if figures:
        content[f"{name}_uncertainty.svg"] = sheet(figures, result.water.source)
    write_all(folder, content)
    return [folder / file for file in content]
