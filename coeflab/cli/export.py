"""``coeflab export``: a parameter file for simulators."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from coeflab.cli import options, show

if TYPE_CHECKING:
    from coeflab.api.exporting import Export, ParameterFile
    from coeflab.core.errors import InputError

EXAMPLE = "coeflab export reports/suboff/suboff_bare_hull.parameters.json --to xdyn --accept-loss"


@options.worded
def command(
    *,
    file: Path,
    to: list[str],
    out: Path | None = None,
    accept_loss: bool = False,
    strict: bool = False,
    accelerations: str = "measured",
    density: float | None = None,
    json: bool = False,
) -> None:
    """Write what simulators load, and say what is lost.

    The loss is measured by each simulator's own force law. Says what `coeflab params check` finds wrong in the file. Exit code 1
    where a finding of it fails, such as a wrong sign; the files are written. Of several targets the others are written where one is
    refused, and the exit code is 1.
    """
    import coeflab as cf
    from coeflab.api.exporting import in_water, require_targets
    from coeflab.api.questions import above_zero
    from coeflab.api.vehicle import Vehicle
    from coeflab.core.errors import together
    from coeflab.core.files import write_all
    from coeflab.report.as_json.findings import findings as findings_json
    from coeflab.report.as_json.studies import export as export_json

    targets = named(to)
    require_targets(targets)
    vehicle = cf.read_vehicle(file)
    if density is not None:
        vehicle = Vehicle(in_water(vehicle.file, above_zero(density, "density", "density")))
    parameters = vehicle.file
    if not json:
        show.not_used(parameters)
    result, refused = _exports(parameters, targets, file, accelerations, accept_loss, strict, json)
    found = vehicle.checks
    if not json and not show.whole() and any(one.loss is not None for one in result):
        show.text("Differences force by force: the .loss.txt beside the files, or --wide.")
    if not json:
        show.file_findings(parameters.name, found)
    gone = {target for target, _ in refused}
    selected = [one for one in result if one.target not in gone]
    files = _placed(selected, file, out, len(targets) > 1)
    if len(targets) == 1 or not selected:
        if refused and json and result:
            show.json_object({"files": [], **export_json(result[0]), "findings": findings_json(found)})
        if refused:
            raise together([why for _, why in refused])
    write_all(Path(), {str(path): content for path, content in files.items()})
    paths = [str(path) for path in files]
    if json and len(targets) == 1:
        show.json_object({"files": paths, **export_json(result[0]), "findings": findings_json(found)})
    elif json:
        exports = [{**export_json(one), "refused": one.target in gone} for one in result]
        show.json_object({"files": paths, "exports": exports, "findings": findings_json(found)})
    else:
        for path in files:
            show.path(path)
    for _, why in refused:
        show.error(f"error: {why}")
    if refused or show.failed(found):
        raise typer.Exit(1)


def named(to: Sequence[str]) -> list[str]:
    """Targets of ``--to``, once each, apart at commas and blanks."""
    return list(dict.fromkeys(word for text in to for word in text.replace(",", " ").split()))


def _exports(
    parameters: ParameterFile, targets: Sequence[str], file: Path, accelerations: str, accept_loss: bool, strict: bool,
    json: bool,
) -> tuple[list[Export], list[tuple[str, InputError]]]:  # fmt: skip
    """Every export that can be made, its loss printed, and what is refused of them with why.

    Raises
    ------
    InputError
        The only target cannot hold the file at all.
    """
    from coeflab.api.exporting import export, loss_refused
    from coeflab.core.errors import InputError
    from coeflab.core.texts import text_of

    result: list[Export] = []
    refused: list[tuple[str, InputError]] = []
    for target in targets:
        try:
            one = export(parameters, target, accelerations=accelerations, accept_loss=accept_loss and not strict)
        except InputError as why:
            if len(targets) == 1:
                raise
            found = f"{target}: {why.found}"
            refused.append(
                (target, InputError(found, why.expected, file=why.file, column=why.column, advice=why.advice))
            )
            continue
        if not json:
            _print_loss(one, parameters)
        result.append(one)
        if not one.lossless and (strict or not accept_loss):
            advice, place = text_of("formats.loss_lacks_mass_of_file"), f"{target}, " if len(targets) > 1 else ""
            refused.append((target, loss_refused(one, parameters, advice, strict=strict, place=place).at(file)))
    return result, refused


def _print_loss(result: Export, parameters: ParameterFile) -> None:
    from coeflab.api.exporting import loss_tables as tables
    from coeflab.api.exporting import without_law

    loss = result.loss
    if loss is None:
        return
    whole = (
        f"{result.target} holds all of {parameters.name}."
        if result.lossless
        else f"{result.target} does not hold all of {parameters.name}:"
    )
    show.text(whole + ("" if result.lossless else f" {tables.in_short(loss)}."))
    for words in without_law(parameters):
        show.sentence(f"The file has {words}.")
    if not show.whole():
        return
    show.text()
    show.table(tables.forces(loss))
    show.table(tables.at_points(loss.at_points, f"Force law of {result.target}", controls=False))
    if not parameters.measured:
        show.text("The parameter file has no measured points to compare the law with.")
    show.table(tables.parts(parameters, loss.water))


def _placed(result: Sequence[Export], file: Path, out: Path | None, several: bool) -> dict[Path, bytes]:
    """Files of every export by path; several in one folder have folders of their own where two want the same name."""
    from coeflab.core.wording import file_stem

    crowded = max(Counter(name for one in result for name in one.files).values(), default=0) > 1
    files: dict[Path, bytes] = {}
    for one in result:
        folder = file.parent / (one.folder or f"{file_stem(one.parameters)}.{one.target}") if out is None else out
        if several and crowded and out is not None:
            folder /= one.target
        files |= {folder / name: one.files[name] for name in sorted(one.files)}
    return files
