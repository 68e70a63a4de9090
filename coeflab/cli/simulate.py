"""``coeflab simulate``: a parameter file through a manoeuvre."""

from __future__ import annotations

import shlex
from dataclasses import fields
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from coeflab.cli import options, show
from coeflab.core.applications import declared
from coeflab.core.errors import InputError, shown
from coeflab.core.registry import of_application
from coeflab.core.texts import input_error

if TYPE_CHECKING:
    from coeflab.api.motion import Simulation


EXAMPLE = "coeflab simulate reports/suboff/suboff_fully_appended.parameters.json --manoeuvre zigzag"
CONTEXT = {"allow_extra_args": True, "ignore_unknown_options": True}
PLUGIN = {"registry": "manoeuvres", "parameter": "manoeuvre"}  # whose options it takes as well
TABLES = ("csv", "parquet")


@options.worded
def command(
    *,
    ctx: typer.Context,
    file: Path,
    manoeuvre: str = "turning_circle",
    free: str = "",
    hold: str = "",
    current: str = "",
    simulator: str = "rigid_body",
    integrator: str = "adaptive",
    step: float = 0.0,
    record: float = 0.0,
    tables: bool = False,
    accelerations: str = "measured",
    to: str = "csv",
    out: Path | None = None,
    help_options: bool = False,
    json: bool = False,
) -> None:
    """Simulate a manoeuvre, such as a zigzag or a turning circle.

    Any further --option VALUE goes to the manoeuvre: --rudder 20, --speed "3 kn". An angle without a unit is in degrees, a rate in deg/s.
    See --help-options. A vehicle with an arm makes the phases of its body.toml, or --manoeuvre free_motion, station_keeping or
    end_effector_track. Exit code 1 where the motion could not be computed to its end, as where a joint of an arm meets its stop: what
    was computed until then is written. Exit code 1 too where the file determines nothing of it; then nothing is written. Exit code 1
    too where not one figure was reached, and where a finding of `coeflab params check` on the file fails, such as a wrong sign.
    """
    from coeflab.api.motion import carried_out
    from coeflab.api.parameters import plausibility, read_parameters
    from coeflab.cli.fit import further

    theirs = next(((one, place) for one in _others() if (place := one.place(file)) is not None), None)
    if help_options:
        from coeflab.cli.formats import explain

        if theirs is None:
            explain("manoeuvres", manoeuvre)
        else:
            theirs[0].explain_options()
        return
    if to not in TABLES:
        raise InputError(shown(to), f"one of {', '.join(TABLES)}", column="--to")
    if theirs is not None:
        asked = {name: ctx.params[name] for name in _typed(ctx)}
        theirs[0].simulate(theirs[1], asked, current_of(current) | dict(further(ctx.args)), to, out, json)
        return
    parameters = read_parameters(file)
    if not json:
        show.not_used(parameters, tables)
    given = {"integrator": integrator, "step": step, "record": record}
    how: dict[str, Any] = {k: v for k, v in given.items() if v not in ("adaptive", 0.0)} | current_of(current)
    result = carried_out(
        parameters, manoeuvre, of_manoeuvre(manoeuvre, ctx.args), how, listed(free), listed(hold),
        simulator=simulator, tables=tables, accelerations=accelerations,
    )  # fmt: skip
    written = [] if out is None or result.undetermined else _write(result, out, to)
    found = plausibility(parameters)
    if json:
        from coeflab.report.as_json.findings import findings
        from coeflab.report.as_json.motions import simulation

        show.json_object({**simulation(result), "findings": findings(found), "files": [str(p) for p in written]})
    elif result.undetermined:
        name = result.manoeuvre.name.replace("_", " ")
        show.text(
            f"The file determines nothing of the {name} of {result.vehicle.name}, so that nothing is drawn or written."
        )
        show.text(result.undetermined)
    else:
        _print(result, written)
        if any(c.u95 for c in parameters.coefficients):
            frozen = ["--free", free] * bool(free) + ["--hold", hold] * bool(hold)
            words = [str(file), "--manoeuvre", manoeuvre, *frozen, *ctx.args]
            show.command_line("How sure, and why", f"coeflab uncertainty {shlex.join(words)}")
        show.text()
    if not json:
        show.file_findings(parameters.name, found)
    if (
        show.failed(found)
        or result.trajectory.why
        or result.undetermined
        or all(f.value is None for f in result.figures)
    ):
        raise typer.Exit(1)


def _others() -> list[Any]:
    """What applications simulate that no parameter file describes."""
    return [of_application(home, module) for home, module in declared("SIMULATES").items()]


def _typed(ctx: typer.Context) -> set[str]:
    """Options that stand on the command line, whatever their value."""
    sources = {name: ctx.get_parameter_source(name) for name in ctx.params}
    return {name for name, source in sources.items() if source is not None and source.name == "COMMANDLINE"}


def of_manoeuvre(name: str, words: list[str]) -> dict[str, Any]:
    """Options of a manoeuvre as they are typed: bare angles are in degrees, bare rates of turn in deg/s.

    Raises
    ------
    InputError
        A bare one that may have been meant in rad.
    """
    from coeflab.cli.fit import further
    from coeflab.core.options import in_degrees
    from coeflab.core.registry import registry_of

    kind = registry_of("manoeuvres").load(name).Options
    given = in_degrees(kind, further(words), name)
    for f in fields(kind):
        if f.metadata.get("orders") and isinstance(given.get(f.name), str):
            typed = given[f.name].replace(",", " ").split()
            given[f.name] = " ".join(_in_radians(word, f"{name}.{f.name}") for word in typed)
    return given


def _in_radians(word: str, column: str) -> str:
    """``rotor1.tilt=90``, ``dr=10deg`` in rad; an order that is no angle as it is."""
    from math import radians

    from coeflab.api.names import CONTROLS
    from coeflab.core.options import RAD_AT_MOST

    name, equals, text = word.partition("=")
    if not equals or not (name in CONTROLS or name.endswith(".tilt")):
        return word
    unit = next((u for u in ("deg", "rad") if text.endswith(u)), "")
    try:
        value = float(text.removesuffix(unit))
    except ValueError:
        return word  # the manoeuvre says what is wrong with it
    if not unit and 0.0 < abs(value) < RAD_AT_MOST:
        raise input_error("commands.angle_without_unit", column=column, word=word, rad_at_most=RAD_AT_MOST)
    return f"{name}={value if unit == 'rad' else radians(value)!r}"


def listed(text: str) -> tuple[str, ...]:
    """Words apart at commas and blanks."""
    return tuple(text.replace(",", " ").split())


def current_of(text: str) -> dict[str, float]:
    """``north,east,down`` as options of the simulator.

    Raises
    ------
    InputError
        Not three numbers.
    """
    if not text:
        return {}
    try:
        north, east, down = (float(v) for v in text.replace(",", " ").split())
    except ValueError:
        raise InputError(shown(text), "three numbers in m/s: north,east,down", column="--current") from None
    return {"north": north, "east": east, "down": down}


def _print(result: Simulation, written: list[Path]) -> None:
    from coeflab.api.parameters import EDGE
    from coeflab.core.texts import remark
    from coeflab.report.tables.motion import figure_table

    name = f"{result.manoeuvre.name.replace('_', ' ')} of {result.vehicle.name}"
    show.table(figure_table(result.figures, name, result.vehicle.length))
    shown_first = {remark(f) for f in result.vehicle.findings if f.code != EDGE}
    for line in (*result.vehicle.afloat, *(s for s in result.statements if s not in shown_first)):
        show.text(f"  {line}")
    if result.trajectory.why:
        show.text(f"  {result.trajectory.ended.value}: {result.trajectory.why}")
    for path in written:
        show.path(path)


def _write(result: Simulation, folder: Path, to: str) -> list[Path]:
    from coeflab.core.files import write_all
    from coeflab.report.figures.motion import motion_figures
    from coeflab.report.figures.svg_file import sheet
    from coeflab.report.tables.motion import motion_csv, motion_parquet

    name = result.manoeuvre.name
    try:
        table = motion_csv(result.trajectory) if to == "csv" else motion_parquet(result.trajectory)
    except ImportError:
        raise input_error("commands.parquet_without_pyarrow", column="--to") from None
    rows = [(f,) for f in motion_figures(result.trajectory.until(result.determined), name, result.vehicle.length)]
    content = {f"{name}.{to}": table, **({f"{name}.svg": sheet(rows, result.vehicle.water.source)} if rows else {})}
    write_all(folder, content)
    return [folder / file for file in content]
