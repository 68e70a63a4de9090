"""``coeflab glider``: a glider file of a polar and a body."""

from __future__ import annotations

from pathlib import Path

import typer

from coeflab.cli import complete, show

EXAMPLE = "coeflab glider polar --body body.toml --engine 0.5 --net-mass 0.3 --out mine"


def command(
    campaign: str = typer.Argument(
        ..., metavar="TABLE", help="Forces X, Z, M over the angle of attack: a table, a campaign or its folder."
    ),
    body: str = typer.Option(
        ...,
        "--body",
        metavar="BODY",
        autocompletion=complete.bodies,
        help="A body.toml with [[mass]] parts, or a shipped body.",
    ),
    engine: str = typer.Option(..., "--engine", metavar="MASS", help="Largest net mass either way; bare in kg."),
    net_mass: str = typer.Option(
        ..., "--net-mass", metavar="MASS", help="Of the dive, the climb is the opposite; bare in kg."
    ),
    engine_at: str = typer.Option(
        "",
        "--engine-at",
        metavar="LENGTH",
        help="x of the engine from the body's datum; the centre of buoyancy unless given.",
    ),
    sliding: str = typer.Option("", "--sliding", metavar="NAME", help="The [[mass]] part that slides along x."),
    travel: str = typer.Option("0", "--travel", metavar="LENGTH", help="Of it to either side of its place; bare in m."),
    shift: str = typer.Option(
        "0", "--shift", metavar="LENGTH", help="Of it in the dive, ahead; the climb is the opposite."
    ),
    lasts: str = typer.Option(
        "600", "--lasts", metavar="TIME", help="Of dive and climb each, with --depth the longest; bare in s."
    ),
    depth: str = typer.Option(
        "", "--depth", metavar="LENGTH", help="At which the dive ends; the climb ends at the surface. Bare in m."
    ),
    pitch_damping: str = typer.Option(
        "", "--pitch-damping", metavar="VALUE", help="N m/(m/s rad/s); estimated from the shape unless given."
    ),
    method: str = typer.Option("all", metavar="METHOD", autocompletion=complete.methods, help="Of added mass."),
    munk: bool = typer.Option(
        False, "--without-munk", help="The table's M does not hold the Munk moment; that of CFD or a tank does."
    ),
    out: Path | None = typer.Option(
        None, metavar="FOLDER", help="Folder for NAME.glider.toml; without it nothing is written."
    ),
    json: bool = typer.Option(False, "--json", help="Print one JSON object."),
) -> None:
    """Make a glider file of a polar and a body, for coeflab glide.

    Masses, moments and inertia come from the [[mass]] parts of the body and its added mass; lift, drag and moment from the table.
    """
    import math

    import coeflab as cf
    from coeflab.core.errors import InputError, shown
    from coeflab.core.files import stem, write_all
    from coeflab.core.texts import remark
    from coeflab.core.units import quantity
    from coeflab.glider import tables as glide_tables
    from coeflab.glider.from_body import Ordered, glider_of
    from coeflab.glider.glide import steady_glides

    def value(text: str, dimension: str, option: str) -> float:
        try:
            number = float(text)
        except ValueError:
            return quantity(text, dimension, key=option)
        if not math.isfinite(number):
            raise InputError(shown(text), "a finite number", column=option)
        return number

    numbers = {
        option: value(text, dimension, option)
        for option, text, dimension in (
            ("--engine", engine, "mass"), ("--net-mass", net_mass, "mass"), ("--travel", travel, "length"), ("--shift", shift, "length"),
            ("--lasts", lasts, "time"), ("--engine-at", engine_at or "0", "length"), ("--pitch-damping", pitch_damping or "0", "none"),
            ("--depth", depth or "0", "length"),
        )
    }  # fmt: skip
    hull = cf.read_body(body)
    density = hull.mass_model.density if hull.mass_model is not None else show.FRESH_WATER
    ordered = Ordered(
        numbers["--engine"], numbers["--engine-at"] if engine_at else None, sliding, numbers["--travel"], numbers["--net-mass"],
        numbers["--shift"], numbers["--lasts"], numbers["--pitch-damping"] if pitch_damping else _estimated(hull, density), not munk,
        not pitch_damping, numbers["--depth"] if depth else None,
    )  # fmt: skip
    made = glider_of(stem(hull.name), cf.read_table(campaign), hull, hull.added_mass(method, density), ordered)
    written = {} if out is None else write_all(out, {f"{made.name}.glider.toml": made.file()})
    paths = [str((out or Path()) / name) for name in written]
    if json:
        from coeflab.report.as_json.findings import finding_as_data

        show.json_object(
            {
                "name": made.name,
                "mass": {k: getattr(made.mass, k) for k in made.mass.__slots__},
                "files": paths,
                "findings": [finding_as_data(f) for f in made.findings],
            }
        )
        return
    show.table(glide_tables.steady(made, tuple(s for p in made.phases for s in steady_glides(made, p))))
    show.table(glide_tables.basis(made))
    for found in made.findings:
        show.marked(str(found.severity), remark(found))
    for path in paths:
        show.path(path)
    if paths:
        show.command_line("Fly it", f"coeflab glide {paths[0]}")


def _estimated(hull: object, density: float) -> float:
    """Pitch damping by the estimate of Mq', zero where there is none."""
    from typing import cast

    import coeflab as cf

    found = cf.vehicle(cast("cf.Body", hull), density=density)
    if "Mq'" not in found:
        return 0.0
    return max(-float(found["Mq'"].value or 0.0) * found.file.scaling.unit("Mq", density, 1.0), 0.0)
