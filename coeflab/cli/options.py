"""Options that several commands have alike, each worded once."""

from __future__ import annotations

import typer

from coeflab.cli import complete

ACCELERATIONS = typer.Option(
    "measured", "--accelerations", metavar="measured|computed", autocompletion=complete.accelerations,
    help="Acceleration derivatives of the file before its computed added mass, where M + M_A stays positive definite; or computed throughout.",
)  # fmt: skip
AXES = typer.Option(
    "", "--axes", metavar="AXES", autocompletion=complete.axes,
    help="Axes of a mesh file: FRD, FLU, CFD, or three directions with commas.",
)  # fmt: skip
BODY = typer.Argument(
    ..., metavar="BODY", autocompletion=complete.bodies,
    help="A body.toml, its folder, a shipped body, or a mesh file with --unit and --axes.",
)  # fmt: skip
CURRENT = typer.Option("", metavar="N,E,D", help="Steady current in m/s, north, east, down.")
FILL = typer.Option(False, "--fill", help="Close holes of a mesh file, of up to 1 % of its surface each.")
FREE = typer.Option("", metavar="u,v,r", help="Motions that may change; default what the file knows enough of.")
HOLD = typer.Option("", metavar="u", help="Motions that are held after all, such as u for a constant speed.")
MANOEUVRE = typer.Option(
    "turning_circle", metavar="NAME", autocompletion=complete.manoeuvres, help="See coeflab formats manoeuvres."
)
OF_IMPORTER = typer.Option([], "--option", metavar="NAME=VALUE", help="Of the importer: sheet=Drift; repeatable.")
PARAMS = typer.Argument(
    ..., metavar="PARAMS", autocompletion=complete.parameters, help="A parameter file, or a shipped vehicle."
)
PATTERN = typer.Option(
    [], "--name", metavar="PATTERN", help="Conditions in names of runs: 'b{beta:deg}_r{r:rad/s}'; repeated: a table each."
)  # fmt: skip
REPAIR = typer.Option(False, "--repair", help="Mend a mesh file that is not sound, and say what was mended.")
RUNS = typer.Option(None, "--runs", metavar="LIST.csv", help="A list of runs with their conditions.")
SHEETS = typer.Option(
    False, "--sheets", help="Open surfaces of a mesh file are walls without thickness, with water on both sides."
)
STRICT = typer.Option(False, "--strict", help="Exit code 1 for a warning, too.")
TABLES = typer.Option(False, "--tables", help="Fitted tables come before derivatives of the same variables.")
UNIT = typer.Option(
    "", "--unit", metavar="UNIT", autocompletion=complete.units, help="Unit of a mesh file: m, mm, in ..."
)
WORDS = typer.Option(
    None, "--words", metavar="FILE.toml", help="Names of columns of your own, beside those of vocabulary.toml."
)
