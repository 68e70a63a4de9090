"""``coeflab table``: values of a fitted table, as CSV."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from coeflab.cli import options, show
from coeflab.core.errors import InputError, shown
from coeflab.core.limits import TABLE_POINTS
from coeflab.core.texts import input_error

if TYPE_CHECKING:
    from collections.abc import Iterator

    import numpy as np
    from numpy.typing import NDArray

    from coeflab.api.tabulating import ParameterModel


EXAMPLE = "coeflab table reports/huuv/huuv.parameters.json --alpha=-20:20:1 --beta=0"
CONTEXT = {"allow_extra_args": True, "ignore_unknown_options": True}
VALUES = "low:high:step, a number, or numbers with commas"


@options.worded
def command(*, ctx: typer.Context, params: Path, response: str = "", out: Path | None = None) -> None:
    """Evaluate a fitted table of a parameter file as CSV.

    Give every variable as --NAME=LOW:HIGH:STEP, a number or a comma list: angles in degrees, primes as such. --beta and
    --alpha also serve tables over v' = sin(beta) and w' = sin(alpha) cos(beta). The column "inside" is 1 within the
    convex hull of the data; cells that the file's rule refuses stay blank.
    """
    from coeflab.api.names import FLOW_ANGLES
    from coeflab.api.parameters import read_parameters
    from coeflab.api.tabulating import chosen
    from coeflab.core.files import write_atomically

    if str(params).startswith("--"):
        raise InputError(shown(params), "the parameter file first, then --NAME=VALUES")
    given = wanted(ctx.args)
    models = chosen(read_parameters(params).models, response, tuple(given))
    tally = Tally()
    lines = _lines(models, given, tally)
    if out is not None:
        changed = write_atomically(out, "".join(lines).encode())
        show.error(f"{out}: {'written' if changed else 'unchanged'}")
    else:
        for chunk in lines:
            typer.echo(chunk, nl=False)
    for line in [FLOW_ANGLES[v] for v in given if v in FLOW_ANGLES] + outside_in_words(models, tally):
        show.error(line)


@dataclass(slots=True)
class Tally:
    """How many points a table has and how many of them lie outside, counted while it is written."""

    points: int = 0
    outside: int = 0


def outside_in_words(models: tuple[ParameterModel, ...], tally: Tally) -> list[str]:
    """What standard error says of points outside the data; with the limits of the data where no point is inside."""
    if not tally.outside:
        return []
    what = "every domain" if len(models) > 1 else "the domain"
    if tally.outside < tally.points:
        return [f"{tally.outside:,} of {tally.points:,} points lie outside {what} (inside = 0)"]
    domains: dict[str, list[str]] = {}
    for m in models:
        limits = zip(m.variables, m.domain.low, m.domain.high, strict=True)
        text = ", ".join(_limits(v.name, v.unit, low, high) for v, low, high in limits)
        domains.setdefault(text, []).append(m.response)
    all_points = f"all {tally.points:,} points lie" if tally.points > 1 else "the point lies"
    return [f"{all_points} outside {what}, the convex hull of the data within these limits:"] + [
        f"  {', '.join(names)}: {text}" for text, names in domains.items()
    ]


def _limits(name: str, unit: str, low: float, high: float) -> str:
    """Limits as the command line reads them: angles in degrees; v' and w' also as angles."""
    if unit == "rad":
        return f"{name} {math.degrees(low) + 0.0:.6g} to {math.degrees(high) + 0.0:.6g} deg"
    if unit != "1":
        return f"{name} {low:.6g} to {high:.6g} {unit}"
    text = f"{name}' {low:.6g} to {high:.6g}"
    angle = {"v": "beta", "w": "alpha at beta = 0:"}.get(name)
    if angle is None or max(abs(low), abs(high)) > 1.0:
        return text
    ends = [math.degrees(math.asin(x)) + 0.0 for x in (low, high)]
    return f"{text} ({angle} {ends[0]:.6g} to {ends[1]:.6g} deg)"


def wanted(arguments: list[str]) -> dict[str, NDArray[np.float64]]:
    """Values of every variable, as typed.

    Raises
    ------
    InputError
        Something that is no --NAME=VALUES, a variable given twice, values that cannot be read, or too many points.
    """
    out: dict[str, NDArray[np.float64]] = {}
    points = 1
    rest = list(arguments)
    while rest:
        word = rest.pop(0)
        name, equals, text = word.partition("=")
        if not name.startswith("--") or len(name) < 3 or (not equals and not rest):
            raise InputError(shown(word), f"--NAME=VALUES with {VALUES}")
        text = text if equals else rest.pop(0)
        name = name[2:]
        if name in out:
            raise InputError(f"{shown('--' + name)} twice", "every variable once")
        out[name] = _values(name, text, TABLE_POINTS // points)
        points *= len(out[name])
    return out


def _values(name: str, text: str, most: int) -> NDArray[np.float64]:
    import numpy as np

    try:
        numbers = [float(x) for x in text.split(":" if ":" in text else ",")]
    except ValueError:
        numbers = []
    ranged = ":" in text
    if not numbers or not all(map(math.isfinite, numbers)) or (ranged and len(numbers) != 3):
        raise InputError(shown(text), VALUES, column=f"--{name}")
    count = float(len(numbers))
    if ranged:
        low, high, step = numbers
        if step <= 0.0 or high < low:
            raise InputError(shown(text), "a low below the high and a step above zero", column=f"--{name}")
        count = (high - low) / step + 1.0
    if not count <= most + 1e-6:
        raise input_error("commands.grid_more_than", column=f"--{name}", table_points=TABLE_POINTS)
    if not ranged:
        return np.array(numbers)
    return np.asarray(low + step * np.arange(int(count + 1e-9)))


def _header(name: str, unit: str) -> str:
    angle = {"rad": "deg", "1": "-"}.get(unit, unit)
    return f"{name}' [-]" if unit == "1" and len(name) == 1 else f"{name} [{angle}]"


def _lines(models: tuple[ParameterModel, ...], given: dict[str, NDArray[np.float64]], tally: Tally) -> Iterator[str]:
    """The CSV in pieces: header, then rows, the last variable fastest."""
    from coeflab.api.tabulating import tabulated, units_of
    from coeflab.core.text.csv_rows import csv_text

    units = units_of(models)
    heads = [f"{m.response}{what} [{'-' if m.unit == '1' else m.unit}]" for m in models for what in ("", " U95")]
    yield csv_text([[*(_header(v, units[v]) for v in given), *heads, "inside"]])
    for points in tabulated(models, given):
        tally.points += len(points.inside)
        tally.outside += len(points.inside) - int(points.inside.sum())
        columns = [*points.settings.values(), *(one for pair in points.values for one in pair)]
        yield csv_text(zip(*map(_text, columns), ["1" if w else "0" for w in points.inside], strict=True))


def _text(values: NDArray[np.float64]) -> list[str]:
    """Ten significant digits; blank where there is no value."""
    return ["" if math.isnan(x) else f"{x + 0.0:.10g}" for x in values.tolist()]
