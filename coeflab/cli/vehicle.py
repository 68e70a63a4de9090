"""``coeflab vehicle``: from a shape and a mass to a vehicle that a simulator loads, by estimates."""

from __future__ import annotations

import shlex
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from coeflab.cli import options, show

if TYPE_CHECKING:
    from coeflab.api.shaping import Study


LOSS = ".loss.txt"
EXAMPLE = 'coeflab vehicle hull.stl --unit mm --axes FLU --mass "46 kg" --to xdyn --accept-loss'


@options.worded
def command(
    *,
    body: str,
    mass: str = "",
    cg: str = "",
    inertia: str = "",
    unit: str = "",
    axes: str = "",
    repair: bool = False,
    fill: bool = False,
    sheets: bool = False,
    speed: str = "",
    density: str = "",
    length: str = "",
    method: str = "all",
    wall: str = "",
    distance: str = "",
    to: list[str],
    accept_loss: bool = False,
    campaign: str = "",
    out: Path | None = None,
    json: bool = False,
) -> None:
    """Estimate a vehicle from its shape and mass, and move it.

    Writes a parameter file, exports and a report: added mass, estimates with U95, a first turn and zigzag where its body.toml
    gives [[control]] or [[thruster]], else a coast-down and what is missing. Exit code 1 when an export is refused.
    """
    from coeflab.api.body import typed_body
    from coeflab.api.shaping import MERGED, asked, completed_by_hand, shaped
    from coeflab.cli import merge
    from coeflab.cli.added_mass import distances_of
    from coeflab.cli.export import named
    from coeflab.core.files import write_all

    distances = distances_of(wall, distance, "panel") if wall or distance else []
    with show.progress(json) as say:
        say("reading the body")
        found = typed_body(body, unit, axes, repair, fill, sheets, centred=True)
        plan, stated = asked(found, mass, cg, inertia, speed, density, length, method, named(to), accept_loss)
        plan = replace(plan, command=typed(body, {
            "unit": unit, "axes": axes, "mass": mass, "cg": cg, "inertia": inertia, "speed": speed, "density": density, "length": length,
            "method": method if method != "all" else "", "wall": wall, "distance": distance,
        }, {"repair": repair, "fill": fill, "sheets": sheets, "accept-loss": accept_loss}, named(to)))  # fmt: skip
        result = shaped(plan, found, stated, campaign=campaign, wall=wall, distances=distances, progress=say)
    study, merged = result.study, result.merge
    folder = out if out is not None else Path("reports") / plan.name
    show.step("drawing the report", json)
    draft, selected = completed_by_hand(found, body, folder, unit, axes, repair, fill, sheets)
    files = result.files() | draft
    replacing = {} if merged is None else merged.files()
    if replacing:
        write_all(folder / MERGED, replacing)
    changed = sum(write_all(folder, files).values())
    paths, others = [folder / name for name in sorted(files)], [folder / MERGED / name for name in sorted(replacing)]
    if json:
        from coeflab.report.as_json.shapes import from_shape

        more = {} if merged is None else {"merged": merge.as_object(merged, others)}
        show.json_object({**from_shape(study), **more, "files": [str(p) for p in paths]})
    else:
        home = f"{MERGED}/" * (merged is not None)
        _print(study, folder, sorted(files), changed, home, _on_draft(folder, draft, selected))
        if merged is not None:
            merge.summarise(merged, others)
            _exported(study, folder / MERGED)
    for refused in study.refused:
        show.error(f"error: {refused.why}")
    if study.failed:
        raise typer.Exit(1)


def typed(body: str, options: Mapping[str, str], flags: Mapping[str, bool], to: Sequence[str]) -> str:
    """The command by which a vehicle was made, its shape by the last part of its path.

    Parameters
    ----------
    body : str
    options : mapping of str to str
        Empty ones were not given.
    flags : mapping of str to bool
    to : sequence of str
        Targets of exports.
    """
    words = ["coeflab vehicle", shlex.quote(Path(body).name or body)]
    words += [f"--{name}={shlex.quote(text)}" for name, text in options.items() if text]
    words += [f"--{name}" for name, on in flags.items() if on]
    return " ".join([*words, *(f"--to {shlex.quote(target)}" for target in to)])


def _print(study: Study, folder: Path, names: list[str], changed: int, home: str, on_draft: str) -> None:
    from coeflab.core.wording import file_stem

    summarise(study, folder)
    if on_draft:
        show.marked("draft", on_draft)
    show.findings(study.checks)
    show.written(folder, names, changed, [f"{home}{name}" for name in for_simulators(study)])
    if home:
        return
    name = next(iter(study.parameter_files))
    place = shlex.quote(str(folder / f"{file_stem(name)}.parameters.json"))
    if not study.exports:
        show.command_line("For a simulator", f"coeflab export {place} --to TARGET")
    show.command_line("Next", f"coeflab merge {place} CAMPAIGN")


def _on_draft(folder: Path, draft: Mapping[str, bytes], unchanged: bool) -> str:
    """What became of the body.toml of a bare mesh."""
    if unchanged:
        return f"{folder / 'body.toml'} was edited and is kept, with the unit and axes that it states; coeflab vehicle {folder} takes it"
    held = "the fins that were found, rudder and thruster to complete"
    return f"{folder / next(iter(draft))}: {held}; then coeflab vehicle {folder}" if draft else ""


def summarise(study: Study, folder: Path) -> None:
    """The answer first, then estimates, motions, what is missing and what is assumed."""
    from coeflab.report.sections import estimates as tables
    from coeflab.report.tables.added_mass import near_walls_table

    shape, parameters = study.shape, next(iter(study.parameter_files.values()))
    if shape is None:
        return
    show.sentence(tables.sentence(study))
    show.text()
    parts = shape.estimates.shares if show.whole() else None
    show.table(tables.estimates_table(parameters, shape.carried, parts, few=not show.whole()))
    show.table(tables.manoeuvre_table(study.manoeuvres, shape.carried))
    show.table(tables.particulars_table(shape, parameters.added_mass))
    if parameters.added_mass is not None and parameters.added_mass.walls:
        show.table(near_walls_table(parameters.added_mass))
    if all(e.parameters in study.parameter_files for e in study.exports):
        _exported(study, folder)
    for line in shape.missing:
        show.marked("lacks", line)


def for_simulators(study: Study) -> list[str]:
    """Names of the files that simulators load, without the loss reports."""
    return [
        f"{result.folder}/{n}" if result.folder else n
        for result in study.exports
        for n in result.files
        if not n.endswith(LOSS)
    ]


def _exported(study: Study, folder: Path) -> None:
    """What each export does not hold, in short; its loss report has all of it."""
    from coeflab.api.exporting import loss_tables
    from coeflab.core.wording import file_stem

    for result in study.exports:
        if result.loss is None:
            continue
        if result.lossless:
            show.text(f"{result.target} holds all of {result.parameters}.")
            continue
        report = folder / result.folder / f"{file_stem(result.parameters)}.{result.target}{LOSS}"
        show.text(
            f"{result.target} does not hold all of {result.parameters}: {loss_tables.in_short(result.loss)}. All of it: {report}"
        )
    if study.exports:
        show.text()
