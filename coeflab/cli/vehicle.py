"""``coeflab vehicle``: from a shape and a mass to a vehicle that a simulator loads, by estimates."""

from __future__ import annotations

import shlex
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from coeflab.cli import complete, show

if TYPE_CHECKING:
    from coeflab.study.study import Study


LOSS = ".loss.txt"
EXAMPLE = 'coeflab vehicle hull.stl --unit mm --axes FLU --mass "46 kg" --to xdyn --accept-loss'

MERGED = "merged"  # the folder of what a campaign replaces


def command(
    body: str = typer.Argument(
        ...,
        metavar="BODY",
        autocompletion=complete.bodies,
        help="A mesh file with --unit and --axes, a body.toml, its folder, or a shipped body.",
    ),
    mass: str = typer.Option(
        "", metavar="MASS", help='46, "46 kg"; default that of its file, else neutrally buoyant.', show_default=False
    ),
    cg: str = typer.Option(
        "", metavar="X,Y,Z", help="Centre of gravity, m, FRD, from the datum or the mesh's origin.", show_default=False
    ),
    inertia: str = typer.Option(
        "", metavar="IX,IY,IZ", help="About the centre of gravity, kg m^2.", show_default=False
    ),
    unit: str = typer.Option(
        "", metavar="UNIT", autocompletion=complete.units, help="Unit of a mesh file: m, mm, in ..."
    ),
    axes: str = typer.Option(
        "",
        metavar="AXES",
        autocompletion=complete.axes,
        help="Axes of a mesh file: FRD, FLU, CFD, or three directions with commas.",
    ),
    repair: bool = typer.Option(False, "--repair", help="Mend a mesh file that is not sound, and say what was mended."),
    fill: bool = typer.Option(False, "--fill", help="Close holes of a mesh file, of up to 1 % of its surface each."),
    sheets: bool = typer.Option(
        False, "--sheets", help="Open surfaces of a mesh file are walls without thickness, with water on both sides."
    ),
    speed: str = typer.Option("", metavar="SPEED", help='Of reference, "1.5 m/s"; default 2 m/s.', show_default=False),
    density: str = typer.Option(
        "", metavar="DENSITY", help="Of the water; default fresh, 998.2 kg/m^3.", show_default=False
    ),
    length: str = typer.Option(
        "", metavar="LENGTH", help="Of the primes; default that of its file, else over all.", show_default=False
    ),
    method: str = typer.Option(
        "all", metavar="METHOD", autocompletion=complete.methods, help="Of added mass, as in coeflab added-mass."
    ),
    wall: str = typer.Option(
        "", "--wall", metavar="WALL", help="bottom, surface_zero, surface_infinite: added mass near it into the file."
    ),
    distance: str = typer.Option("", "--distance", metavar="M,M,..", help="From the reference point to the wall, m."),
    to: list[str] = typer.Option(
        [],
        "--to",
        metavar="TARGET",
        autocompletion=complete.exporters,
        help="Export to it; several with commas, or repeatable; of a campaign, the merged file.",
    ),
    accept_loss: bool = typer.Option(False, "--accept-loss", help="Export although a target cannot hold everything."),
    campaign: str = typer.Option(
        "",
        metavar="CAMPAIGN",
        autocompletion=complete.campaigns,
        help="Fit it and replace estimates by it, as coeflab merge does, into FOLDER/merged.",
    ),
    out: Path | None = typer.Option(None, metavar="FOLDER", help="Folder for the files; default reports/BODY."),
    json: bool = typer.Option(False, "--json", help="Print one JSON object."),
) -> None:
    """Estimate a vehicle from its shape and mass, and move it.

    Writes a parameter file, exports and a report: added mass, estimates with U95, a first turn and zigzag where its body.toml
    gives [[control]] or [[thruster]], else a coast-down and what is missing. Exit code 1 when an export is refused.
    """
    from coeflab.cli.added_mass import distances_of
    from coeflab.cli.export import named
    from coeflab.cli.merge import carried_out
    from coeflab.core.files import located, write_all
    from coeflab.formats.exporting import exports_of, placed, refuse_unknown
    from coeflab.report.rendered import rendered
    from coeflab.study.checking import checked
    from coeflab.study.estimated_vehicle import asked, completed_by_hand, from_shape, subject

    if campaign:
        located(campaign, "cfd_data")  # before minutes of added mass
    distances = distances_of(wall, distance, "panel") if wall or distance else []
    with show.progress(json) as say:
        say("reading the body")
        found = subject(body, unit, axes, repair, fill, sheets)
        plan, stated = asked(found, mass, cg, inertia, speed, density, length, method, named(to), accept_loss)
        plan = replace(plan, command=typed(body, {
            "unit": unit, "axes": axes, "mass": mass, "cg": cg, "inertia": inertia, "speed": speed, "density": density, "length": length,
            "method": method if method != "all" else "", "wall": wall, "distance": distance,
        }, {"repair": repair, "fill": fill, "sheets": sheets, "accept-loss": accept_loss}, named(to)))  # fmt: skip
        refuse_unknown(plan.exports)
        of_estimates = replace(plan, exports=()) if campaign else plan  # what a campaign replaces goes to no simulator
        study = checked(from_shape(of_estimates, found, stated, say, wall, distances), say)
    folder = out if out is not None else Path("reports") / plan.name
    merged, exported = None, {}
    if campaign:
        with show.progress(json) as say:
            say(f"fitting {campaign}")
            merged = carried_out(next(iter(study.parameter_files.values())), campaign, "", folder / MERGED, say)
            shape = next(iter(study.hulls.values())).body.shape
            seen = {} if shape is None else {merged.made.parameters.name: shape}
            exports, not_made = exports_of(plan.exports, [merged.made.parameters], say, seen)
            exported = {f"{MERGED}/{place}": content for place, content in placed(exports).items()}
    show.step("drawing the report", json)
    draft, selected = completed_by_hand(found, body, folder, unit, axes, repair, fill, sheets)
    files = rendered(study) | exported | draft
    if merged is not None:
        study = replace(study, exports=exports, refused=not_made)
    changed = sum(write_all(folder, files).values())
    paths = [folder / name for name in sorted(files)]
    if json:
        more = {} if merged is None else {"merged": merged.as_json()}
        show.json_object({**as_json(study), **more, "files": [str(p) for p in paths]})
    else:
        _print(study, folder, sorted(files), changed, merged is None, _on_draft(folder, draft, selected))
        if merged is not None:
            merged.print()
            _exported(study, folder / MERGED)
    for refused in study.refused:
        why = (
            str(refused.why)
            .replace('"export.accept_loss": ', "")
            .replace('"export.to": ', "")
            .replace("accept_loss = true", "--accept-loss")
        )
        show.error(f"error: {why}")
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


def _print(study: Study, folder: Path, names: list[str], changed: int, alone: bool, on_draft: str) -> None:
    from coeflab.core.wording import file_stem

    summarise(study, folder)
    if on_draft:
        show.marked("draft", on_draft)
    show.findings(study.checks)
    place = "" if alone else f"{MERGED}/"
    show.written(folder, names, changed, [f"{place}{name}" for name in for_simulators(study)])
    if not alone:
        return
    name = next(iter(study.parameter_files))
    place = shlex.quote(str(folder / f"{file_stem(name)}.parameters.json"))
    if not study.exports:
        show.command_line("For a simulator", f"coeflab export {place} --to TARGET")
    show.command_line("Next", f"coeflab merge {place} CAMPAIGN")


def _on_draft(folder: Path, draft: Mapping[str, bytes], kept: bool) -> str:
    """What became of the body.toml of a bare mesh."""
    if kept:
        return f"{folder / 'body.toml'} was edited and is kept, with the unit and axes that it states; coeflab vehicle {folder} takes it"
    held = "the fins that were found, rudder and thruster to complete"
    return f"{folder / next(iter(draft))}: {held}; then coeflab vehicle {folder}" if draft else ""


def summarise(study: Study, folder: Path) -> None:
    """The answer first, then estimates, motions, what is missing and what is assumed."""
    from coeflab.report.sections import estimates as tables
    from coeflab.report.tables.added_mass import near_walls_kept

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
        show.table(near_walls_kept(parameters.added_mass))
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
    from coeflab.core.wording import file_stem
    from coeflab.formats.loss_tables import in_short

    for result in study.exports:
        if result.loss is None:
            continue
        if result.lossless:
            show.text(f"{result.target} holds all of {result.parameters}.")
            continue
        report = folder / result.folder / f"{file_stem(result.parameters)}.{result.target}{LOSS}"
        show.text(
            f"{result.target} does not hold all of {result.parameters}: {in_short(result.loss)}. All of it: {report}"
        )
    if study.exports:
        show.text()


def as_json(study: Study) -> dict[str, Any]:
    """Particulars, estimates with what they are made of, manoeuvres, what is assumed and what is missing; SI and radians."""
    from coeflab.bodies.mesh.particulars import mesh_statements
    from coeflab.cli.uncertainty import as_json as carried_json
    from coeflab.formats.loss_tables import in_short

    shape, (name, parameters) = study.shape, next(iter(study.parameter_files.items()))
    if shape is None:
        return {}
    c = shape.weighed.configuration
    hull, rest = parameters.added_mass, shape.weighed.at_rest
    return {
        "name": name,
        "displacement": shape.conditions.density * (c.volume or 0.0),
        "volume": c.volume,
        "mass": None if c.mass is None else c.mass.mass,
        "centre_of_buoyancy": None if c.centre_of_buoyancy is None else c.centre_of_buoyancy.tolist(),
        "centre_of_gravity": None
        if c.mass is None
        else (c.mass.centre_of_gravity + shape.weighed.body.reference_point).tolist(),
        "inertia_matrix": None if c.mass is None or c.mass.inertia_matrix is None else c.mass.inertia_matrix.tolist(),
        "wetted_surface": c.wetted_surface,
        "projected_areas": None if c.projected_areas is None else c.projected_areas.tolist(),
        "reference_point": shape.weighed.body.reference_point.tolist(),
        "added_mass": None if hull is None else {
            "method": hull.method, "matrix": hull.matrix.tolist(),
            "walls": [{"wall": w.wall, "distance": w.distance, "matrix": w.matrix.tolist()} for w in hull.walls],
        },
        "at_rest": None if rest is None else {"pitch": rest[0], "roll": rest[1]},
        "mesh": list(mesh_statements(shape.weighed.body)),
        "assumed": list(shape.weighed.assumed),
        "said": list(shape.said),
        "missing": list(shape.missing),
        "estimates": [
            {
                "symbol": k.symbol, "value": k.value, "u95": k.u95, "value_si": k.value_si, "unit_si": k.unit_si,
                "status": str(k.status), "estimator": k.estimator,
                "made_of": dict(shape.estimates.shares.get(k.symbol.removesuffix("'"), {})),
            }
            for k in parameters.coefficients
        ],
        "contributions": [
            {
                "part": k.part, "kind": k.kind, "method": k.method, "share": k.share, "citation": k.citation,
                "place": k.place, "outside": k.outside or None,
            }
            for k in shape.estimates.contributions
        ],
        "notes": list(shape.estimates.notes),
        "manoeuvres": [
            {
                "name": m.manoeuvre.name,
                "figures": [{"name": f.name, "value": f.value, "unit": f.unit, "status": f.status} for f in m.figures],
                "statements": list(m.statements),
            }
            for m in study.manoeuvres
        ],
        "uncertainty": [carried_json(k) for k in shape.carried],
        "exports": [
            {
                "target": e.target, "parameters": e.parameters, "lossless": e.lossless,
                "loss": None if e.loss is None or e.lossless else in_short(e.loss),
                "worse_than_nothing": [] if e.loss is None else list(e.loss.worse_than_nothing),
            }
            for e in study.exports
        ],
        "refused": [str(r.why) for r in study.refused],
    }  # fmt: skip
