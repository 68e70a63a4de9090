"""``coeflab fit``: one table or campaign, printed, nothing written."""

from __future__ import annotations

from typing import TYPE_CHECKING

import typer

from coeflab.cli import show

if TYPE_CHECKING:
    from coeflab.model.study import Study

EXAMPLE = "coeflab fit suboff_roddy_2 --symbol Yv"
CONTEXT = {"allow_extra_args": True, "ignore_unknown_options": True}


def command(
    ctx: typer.Context,
    table: str = typer.Argument(..., help="A campaign folder, one CSV of it, or a shipped campaign's name."),
    fit: str = typer.Option("slope_at_origin", help="Name of the fit (see coeflab formats)."),
    symbol: list[str] = typer.Option([], help="Show estimators and windows of this coefficient; repeatable."),
    length: str = typer.Option("", help='Length of the primes, such as "4.356 m"; default the campaign\'s own.'),
    length_name: str = typer.Option("", help="Name of that length, such as LOA."),
    include_uncertain: bool = typer.Option(False, help="Use cells that the source marks as doubtful."),
    json: bool = typer.Option(False, "--json", help="Print one JSON object."),
) -> None:
    """Fit the coefficients of one table and show how they were made.

    Any further --option VALUE goes to the fit: --seed 2, --degree 4, --terms "Yv Yv|v|".
    """
    from coeflab.core.errors import InputError
    from coeflab.core.files import located
    from coeflab.core.units import quantity
    from coeflab.model.scaling import Scaling
    from coeflab.model.study import Plan, PlannedTable
    from coeflab.workbench import run

    path = located(table, "cfd_data")
    if bool(length) != bool(length_name):
        raise InputError("--length without its name", "--length and --length-name together")
    only = path.name if path.is_file() and path.suffix != ".toml" else None
    plan = Plan(
        name=path.stem,
        title=path.name,
        tables=(PlannedTable(path, (fit,), {fit: further(ctx.args)}, only),),
        scaling=Scaling(quantity(length, "length", key="--length"), length_name) if length else None,
        wanted=("Yv", "Nv", "Zw", "Mw", "Yr", "Nr") if fit == "slope_at_origin" else (),
        include_uncertain=include_uncertain,
    )
    with show.progress(json) as say:
        study = run(plan, say)
    if json:
        from coeflab.cli.as_json import study as study_json

        show.json_object(study_json(study, []))
        return
    _print(study, [s.removesuffix("'") for s in symbol])


def further(arguments: list[str]) -> dict[str, int | float | str]:
    """Options for a plugin from ``--name value`` or ``--name=value``; numbers where they read as such."""
    from coeflab.core.errors import InputError, shown

    out: dict[str, int | float | str] = {}
    rest = list(arguments)
    while rest:
        word = rest.pop(0)
        name, equals, value = word.partition("=")
        if not name.startswith("--") or (not equals and not rest):
            raise InputError(shown(word), "--option VALUE")
        text = value if equals else rest.pop(0)
        for kind in (int, float):
            try:
                out[name[2:].replace("-", "_")] = kind(text)
                break
            except ValueError:
                continue
        else:
            out[name[2:].replace("-", "_")] = text
    return out


def _print(study: Study, symbols: list[str]) -> None:
    from coeflab.cli.carry_out import findings
    from coeflab.core.errors import InputError, shown
    from coeflab.presentation import budget_tables, model_tables, tables

    show.table(tables.coefficients(study))
    models = tuple(m for f in study.fits for m in f.models)
    for model in models:
        show.table(model_tables.terms(model))
        show.table(budget_tables.shared(model))
    show.table(model_tables.quality(models))
    known = {s.symbol: s for f in study.fits for s in f.sweeps}
    for symbol in symbols:
        if symbol not in known:
            raise InputError(f"no sweep for {shown(symbol)}", f"one of {', '.join(known)}")
        sweep = known[symbol]
        for content in (
            tables.members(sweep),
            tables.estimators(sweep),
            tables.sensitivity(sweep),
            tables.left_out(sweep),
        ):
            show.table(content)
    findings(study)
