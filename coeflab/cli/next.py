"""``coeflab next``: which test takes most off the uncertainty, and at which settings to run it."""

from __future__ import annotations

from pathlib import Path

import typer

from coeflab.cli import options, show

EXAMPLE = 'coeflab next suboff_roddy_2 --for "Nv\'" --runs 4 --target 10%'
CONTEXT = {"allow_extra_args": True, "ignore_unknown_options": True}


@options.worded
def command(
    *,
    ctx: typer.Context,
    source: str,
    wanted: str = "",
    table: list[str],
    runs: int = 7,
    target: str = "",
    noise: str = "",
    angle: str = "12 deg",
    control: str = "15 deg",
    rate: float = 0.4,
    manoeuvre: str = "turning_circle",
    to: Path | None = None,
    json: bool = False,
) -> None:
    """Name the test that takes most off an uncertainty, and its best settings.

    Tests are ranked by the share of the variance that goes with them; settings are searched by the estimator itself on
    simulated readings. Any further --option VALUE goes to the manoeuvre: --rudder 20. Exit code 1 where a target is not reached.
    """
    import coeflab as cf
    from coeflab.api.designing import Reached
    from coeflab.cli.simulate import of_manoeuvre
    from coeflab.core.errors import InputError, shown
    from coeflab.core.files import placeable, write_all
    from coeflab.report.as_json.studies import next_tests as as_json

    if to is not None and to.suffix not in (".csv", ".toml"):
        raise InputError(shown(to.name), "a file name that ends in .csv or .toml", column="--to")
    if to is not None:
        placeable(to)
    with show.narrated():
        found = cf.next_tests(
            source, wanted, tables=table or None, runs=runs, target=target or None, noise=noise or None, angle=angle, control=control, rate=rate,
            manoeuvre=manoeuvre, **of_manoeuvre(manoeuvre, ctx.args),
        )  # fmt: skip
    if to is not None:
        text = found.matrix if to.suffix == ".toml" else found.frame().to_csv(index=False)
        write_all(to.parent, {to.name: text.encode()})
    if json:
        show.json_object(as_json(found) | {"files": [] if to is None else [str(to)]})
    else:
        from coeflab.report.tables.next_tests import tables

        for one in tables(found):
            show.table(one)
        if to is not None:
            show.path(to)
    if found.reached is Reached.NO:
        raise typer.Exit(1)
