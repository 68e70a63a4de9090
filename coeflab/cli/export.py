"""``coeflab export``: a parameter file for a simulator."""

from __future__ import annotations

from pathlib import Path

import typer

from coeflab.cli import complete, show

WITH_MASS = "Mass and added mass: coeflab vehicle BODY --campaign CAMPAIGN, or coeflab merge VEHICLE.json CAMPAIGN."
EXAMPLE = "coeflab export reports/suboff/suboff_bare_hull.parameters.json --to xdyn --accept-loss"


def command(
    file: Path = typer.Argument(
        ..., metavar="PARAMS", autocompletion=complete.parameters, help="A parameter file, or a shipped vehicle."
    ),
    to: str = typer.Option(
        "",
        "--to",
        metavar="TARGET",
        autocompletion=complete.exporters,
        help="Target, such as gazebo, xdyn or mss; coeflab formats exporters lists them. Required.",
        show_default=False,
    ),
    out: Path | None = typer.Option(
        None, metavar="FOLDER", help="Folder for the files; default NAME.TARGET beside the parameter file."
    ),
    accept_loss: bool = typer.Option(False, "--accept-loss", help="Write although the target cannot hold everything."),
    strict: bool = typer.Option(False, "--strict", help="Refuse any loss, whatever else is said."),
    accelerations: str = typer.Option(
        "measured", metavar="measured|computed", autocompletion=complete.accelerations, help=show.ACCELERATIONS
    ),
    json: bool = typer.Option(False, "--json", help="Print one JSON object."),
) -> None:
    """Write what a simulator loads, and say what is lost.

    The loss is measured by the simulator's own force law. Says what `coeflab params check` finds wrong in the file. Exit code 1
    where a finding of it fails, such as a wrong sign; the files are written.
    """
    from coeflab.core.errors import InputError, shown
    from coeflab.core.files import write_all
    from coeflab.core.wording import file_stem
    from coeflab.formats import EXPORTERS
    from coeflab.formats.export import Kind
    from coeflab.formats.unspoken import without_law
    from coeflab.report.tables import formats as loss_tables
    from coeflab.vehicle.parameter_file import read_parameter_file
    from coeflab.vehicle.plausibility import plausibility
    from coeflab.workbench.exports import export

    if not to:
        raise InputError("no target", f"one of {', '.join(EXPORTERS.names())}", column="--to")
    parameters = read_parameter_file(file)
    made = export(parameters, to, accelerations, accept_loss=accept_loss and not strict)
    loss = made.loss
    if loss is not None and not json:
        whole = (
            f"{to} holds all of {parameters.name}."
            if made.lossless
            else f"{to} does not hold all of {parameters.name}:"
        )
        show.text(whole + ("" if made.lossless else f" {loss_tables.in_short(loss)}."))
        for said in without_law(parameters):
            show.sentence(f"The file has {said}.")
        show.text()
        show.table(loss_tables.forces(loss))
        show.table(loss_tables.at_points(loss.at_points, f"Force law of {to}", controls=False))
        if not parameters.measured:
            show.text("The parameter file has no measured points to compare the law with.")
        show.table(loss_tables.parts(parameters, loss.water))
    found = plausibility(parameters)
    if not json:
        show.file_findings(parameters.name, found)
    refused = loss is not None and not made.lossless and (strict or not accept_loss)
    if refused and json:
        from coeflab.cli.as_json import export as export_json
        from coeflab.cli.as_json import findings as findings_json

        show.json_object({"files": [], **export_json(made), "findings": findings_json(found)})
    if loss is not None and refused:
        raise InputError(
            f"a target that loses part of {shown(parameters.name)}: {loss_tables.in_short(loss)}",
            "a target that holds everything" if strict else "--accept-loss, to write the rest",
            file=file,
            advice=WITH_MASS if any(x.kind is Kind.MISSING and "added mass" in x.what for x in loss.lost) else "",
        )
    folder = out if out is not None else file.parent / (made.folder or f"{file_stem(parameters.name)}.{to}")
    paths = [folder / name for name in sorted(made.files)]
    write_all(folder, made.files)
    if json:
        from coeflab.cli.as_json import export as export_json
        from coeflab.cli.as_json import findings as findings_json

        show.json_object({"files": [str(p) for p in paths], **export_json(made), "findings": findings_json(found)})
    else:
        for path in paths:
            show.path(path)
    if show.failed(found):
        raise typer.Exit(1)
