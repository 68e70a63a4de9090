"""``coeflab params``: parameter files, and the model files of simulators."""

from __future__ import annotations

import shlex
from pathlib import Path

import typer

from coeflab.cli import Command, options, show
from coeflab.core.errors import InputError, OutputError
from coeflab.core.files import typed, write_all
from coeflab.core.wording import file_stem

app = typer.Typer(help="Check a parameter file, write one of your own numbers or of a simulator's model; print what its fields mean.", no_args_is_help=True, rich_markup_mode=None, pretty_exceptions_enable=False, add_completion=False)  # fmt: skip


@app.callback()
def _root() -> None:
    pass


@app.command(cls=Command, epilog="Example: coeflab params check reports/suboff/suboff_fully_appended.parameters.json")
@options.worded
def check(*, file: Path, density: float | None = None, json: bool = False) -> None:
    """Check a parameter file or a simulator's model.

    The exit code is 1 where a finding fails, and 2 where the file cannot be read, whatever its format.
    """
    from coeflab.api.parameters import read_model_file
    from coeflab.report.tables import model_file as model_file_tables

    if density is not None and not 0.0 < density < float("inf"):
        raise InputError(f"{density:g}", "a density above zero", column="--density")
    found = read_model_file(file, density)
    p = found.parameters
    if json:
        from coeflab.report.as_json.findings import findings as findings_json

        show.json_object({
            "valid": True, "format": found.format, "name": p.name, "schema_version": p.schema_version,
            "coefficients": [c.symbol for c in p.coefficients], "passed": found.passed,
            "by_added_mass": [row[0] for row in model_file_tables.by_added_mass(p).rows],
            "findings": findings_json(found.findings), "remarks": list(p.remarks),
        })  # fmt: skip
    else:
        show.table(model_file_tables.contents(p, found.format))
        if found.format != "coeflab" or show.whole():
            show.table(model_file_tables.by_added_mass(p))
        show.findings(found.findings, notes=True)
    if not found.passed:
        raise typer.Exit(1)


@app.command(cls=Command, epilog="Example: coeflab params convert model.sdf --density 1025 --out vehicles")
@options.worded
def convert(
    *, file: Path, name: str = "", density: float | None = None, out: Path = Path(), json: bool = False
) -> None:
    """Write somebody's model as a parameter file, and say what of it is left out.

    Added mass, derivatives, mass and inertia, volume and centre of buoyancy, thrusters and fins, as far as the format has them. The exit
    code is 1 where a check fails; the file is written. A file that exists is not written over.
    """
    from coeflab.api.parameters import OWN, read_model_file
    from coeflab.report.tables import model_file as model_file_tables

    if density is not None and not 0.0 < density < float("inf"):
        raise InputError(f"{density:g}", "a density above zero", column="--density")
    if name and file_stem(name) != name:
        raise InputError(f'"{name}"', "a name that a file can have: letters, digits, _ and -", column="--name")
    found = read_model_file(file, density)
    if found.format == OWN:
        raise InputError("a parameter file", "a simulator's model", file=file, advice="It needs no conversion.")
    p = found.parameters if not name else found.parameters.model_copy(update={"name": name})
    path = typed(out) / f"{file_stem(p.name)}.parameters.json"
    if path.exists():
        raise OutputError(f"{path} exists. Give --name or --out.")
    write_all(path.parent, {path.name: p.to_json()})
    if json:
        from coeflab.report.as_json.findings import findings as findings_json

        show.json_object({
            "format": found.format, "name": p.name, "coefficients": [c.symbol for c in p.coefficients],
            "thrusters": [t.name for t in p.thrusters], "surfaces": [s.control for s in p.surfaces], "left_out": found.left_out,
            "passed": found.passed, "findings": findings_json(found.findings), "remarks": list(p.remarks), "files": [str(path)],
        })  # fmt: skip
    else:
        show.table(model_file_tables.contents(p, found.format))
        show.table(model_file_tables.left_out(found.left_out, p.name))
        show.path(path)
        show.command_line("Check it", f"coeflab params check {shlex.quote(str(path))}")
        show.findings(found.findings, notes=True)
    if not found.passed:
        raise typer.Exit(1)


NEW = """Example: coeflab params new my_auv --about cg --length "2.5 m" --speed "1.5 m/s" --density 1025 --mass "46 kg"
--set "Yv'=-0.03 +- 0.003" --set "Nv'=-0.012" --set "Yr'=0.005" --set "Nr'=-0.006\""""


@app.command(cls=Command, epilog=NEW)
@options.worded
def new(
    *,
    name: str,
    numbers: list[str],
    from_: Path | None = None,
    axes: str = "",
    option: list[str],
    length: str = "",
    length_name: str = "LOA",
    speed: str = "",
    density: str = "",
    about: str = "",
    mass: str = "",
    cg: str = "",
    inertia: str = "",
    volume: str = "",
    cb: str = "",
    thruster: list[str],
    rudder: str = "",
    stern_planes: str = "",
    bow_planes: str = "",
    body: str = "",
    out: Path = Path(),
    force: bool = False,
    json: bool = False,
) -> None:
    """Write a parameter file of your own numbers.

    Works out the SI values, m' and the covariance. Nothing is assumed: what is not stated is not in the file. Values are
    totals: Nv' holds the Munk moment. An added mass is an acceleration derivative, "Yvdot'=-0.029". --from reads a sheet of symbols,
    values, units and U95. A file that exists is replaced with --force alone.
    """
    from coeflab.api.importing import options_of
    from coeflab.api.parameters import plausibility, read_coefficient_list, typed_file, with_sheet
    from coeflab.report.tables.model_file import contents

    sheet = None if from_ is None else read_coefficient_list(typed(from_), axes, options_of(option))
    result = typed_file(
        name, [*(sheet.numbers if sheet else ()), *numbers], length=length, length_name=length_name, speed=speed, density=density, about=about, mass=mass, cg=cg,
        inertia=inertia, volume=volume, cb=cb, body=body, thrusters=thruster, rudder=rudder,
        stern_planes=stern_planes, bow_planes=bow_planes,
    )  # fmt: skip
    if sheet is not None and from_ is not None:
        result = with_sheet(result, sheet, from_)
    if file_stem(name) != name:
        raise InputError(f'"{name}"', "a name that a file can have: letters, digits, _ and -", column="NAME")
    path = typed(out) / f"{name}.parameters.json"
    if path.exists() and not force:
        raise OutputError(
            f"{path} exists. Name another, replace it with --force, or change it: coeflab merge {path} --set SYMBOL=VALUE."
        )
    write_all(path.parent, {path.name: result.to_json()})
    found = plausibility(result)
    if json:
        from coeflab.report.as_json.findings import findings

        show.json_object({
            "name": result.name, "coefficients": [c.symbol for c in result.coefficients], "findings": findings(found), "files": [str(path)],
        })  # fmt: skip
    else:
        show.table(contents(result, "coeflab"))
        show.found(result.findings)
        show.path(path)
        show.command_line("Check it", f"coeflab params check {shlex.quote(str(path))}")
        show.file_findings(result.name, found)
    if show.failed(found):
        raise typer.Exit(1)


@app.command(cls=Command, epilog="Example: coeflab params schema > parameter_file.md")
@options.worded
def schema(*, json: bool = False) -> None:
    """Print what every field of a parameter file means."""
    from coeflab.api.schemas import schema as of_kind
    from coeflab.report.tables.schema_page import schema_page

    show.lines((of_kind("parameters") if json else schema_page()).decode().removesuffix("\n"))


@app.command(cls=Command, epilog='Example: coeflab params conform "python3 docs/reference/reader.py"')
@options.worded
def conform(*, program: str, write: Path | None = None, json: bool = False) -> None:
    """Hold an implementation of the force law against its conformance vectors.

    COMMAND FILE.parameters.json gets a JSON list of states on its standard input and prints a list of {"force": X Y Z K M N of the
    water, "acceleration": rates of u v w p q r}, null where the law has none. docs/force_law.md is the law. Exit code 1 where one is
    missed.
    """
    from coeflab.api.parameters import conform as run
    from coeflab.core.files import typed
    from coeflab.core.finding import Severity, worst
    from coeflab.core.table import as_check

    try:
        words = shlex.split(program)
    except ValueError as why:
        raise InputError(program, "a command with closed quotation marks", column="COMMAND") from why
    if not words:
        raise InputError("no command", "a program with its arguments", column="COMMAND")
    found = run(words, folder=None if write is None else typed(write))
    if json:
        from coeflab.report.as_json.findings import findings

        show.json_object({"findings": findings([as_check("conform", f) for f in found])})
    else:
        show.findings([as_check("conform", f) for f in found], notes=True)
    if worst(found) is Severity.FAIL:
        raise typer.Exit(1)
