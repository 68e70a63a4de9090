"""A tuning plan: which numbers of a parameter file are free, and what was measured."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from coeflab.core.delimited import Cells, read_cells, require_unit
from coeflab.core.errors import InputError, shown
from coeflab.core.files import located
from coeflab.core.symbols import CONTROLS
from coeflab.core.toml import Section, read_toml
from coeflab.core.units import factor, quantity
from coeflab.kernels.brief import brief
from coeflab.model.frozen import locked
from coeflab.model.parameter_file import ParameterFile, read_parameter_file
from coeflab.model.parameter_places import Place, place, value_at
from coeflab.model.vehicle import THRUST

Array = NDArray[np.float64]
QUANTITIES = {"u": "speed", "v": "speed", "V": "speed", "r": "rate", "beta": "angle", "radius": "length"}
SIGNED = ("v", "r", "beta")
FROM_RESIDUALS = "from residuals"
FIRST_GUESS = 0.1  # of the spread of what was measured: the rounds replace it


@brief
@dataclass(frozen=True, slots=True)
class FreeParameter:
    """A number that is free, at one or several places.

    Attributes
    ----------
    name, unit : str
    places : tuple of Place
    start, size : float
        What stands there, and what counts as a large change.
    prior_mean, prior_error : float
        Error infinite without a prior.
    low, high : float
    """

    name: str
    unit: str
    places: tuple[Place, ...]
    start: float
    size: float
    prior_mean: float
    prior_error: float
    low: float
    high: float


@brief
@dataclass(frozen=True, slots=True, eq=False)
class SteadyCases:
    """Steady turns as they were measured.

    Attributes
    ----------
    file : Path
    lines : tuple of int
        Line of each case.
    commands : tuple of mapping
        Of the thrusters, a case.
    controls : (n, 3) array
        dr ds db, rad.
    names : tuple of str
        Measured quantities.
    measured, errors : (n, q) arrays
        SI; NaN where a cell is blank.
    magnitudes : tuple of str
        Quantities whose sign was not measured.
    """

    file: Path
    lines: tuple[int, ...]
    commands: tuple[dict[str, float], ...]
    controls: Array
    names: tuple[str, ...]
    measured: Array
    errors: Array
    magnitudes: tuple[str, ...]

    def __post_init__(self) -> None:
        for name in ("controls", "measured", "errors"):
            object.__setattr__(self, name, locked(getattr(self, name)))


@brief
@dataclass(frozen=True, slots=True, eq=False)
class TuningPlan:
    """What to tune to what.

    Attributes
    ----------
    name : str
    file : Path
        Of the plan.
    parameters_file : Path
    parameters : ParameterFile
    free : tuple of FreeParameter
    cases : SteadyCases
    from_residuals : bool
        Whether standard errors are those of the residuals.
    """

    name: str
    file: Path
    parameters_file: Path
    parameters: ParameterFile
    free: tuple[FreeParameter, ...]
    cases: SteadyCases
    from_residuals: bool


def read_tuning_plan(path: Path) -> TuningPlan:
    """Read and check a plan.

    Raises
    ------
    InputError
        With file, line and key.
    """
    file = read_toml(path)
    head, measured = file.section("tune"), file.section("measured")
    name = head.text("name")
    if not name.replace("_", "").replace("-", "").isalnum():
        raise head.fail("name", shown(name), "letters, digits, _ and -")
    source = located(head.text("parameters"), "cfd_data", path.parent)
    head.finish()
    parameters = read_parameter_file(source)
    free = tuple(_free(s, parameters) for s in file.sections("free"))
    if not free:
        raise file.fail("free", "nothing", "at least one [[free]]", "Name a number of the parameter file.")
    twice = [w.text.strip().removeprefix("-").strip() for f in free for w in f.places]
    if len(set(twice)) < len(twice):
        raise file.fail("free", f"{max(twice, key=twice.count)} more than once", "every place once")
    if len({f.name for f in free}) < len(free):
        raise file.fail("free", "a name more than once", "names of their own")
    cases, from_residuals = _cases(measured, parameters, path.parent)
    measured.finish()
    file.finish()
    return TuningPlan(name, path, source, parameters, free, cases, from_residuals)


def _free(s: Section, p: ParameterFile) -> FreeParameter:
    texts = s.texts("places")
    if not texts:
        raise s.fail("places", "nothing", "a list of places in the parameter file")
    try:
        places = tuple(place(t, p) for t in texts)
    except InputError as why:
        raise s.fail("places", why.found, why.expected, why.advice) from None
    values = [value_at(p, w) for w in places]
    if max(values) - min(values) > 1e-9 * max(abs(v) for v in values):
        raise s.fail("places", f"different values {', '.join(f'{v:g}' for v in values)}", "one value at all places",
                     "A minus before a place takes the opposite sign.")  # fmt: skip
    start = values[0]
    size = _number(s, "size", abs(start))
    if not size > 0.0:
        raise s.fail(
            "size", f"{size:g}", "a size above zero", "The parameter is zero: say what would be a large value."
        )
    prior = s.section("prior", required=False)
    mean, error = _number(prior, "mean", start), _number(prior, "error", np.inf)
    prior.finish()
    low, high = _number(s, "low", -np.inf), _number(s, "high", np.inf)
    if not error > 0.0:
        raise prior.fail("error", f"{error:g}", "a standard uncertainty above zero")
    if not low < high or not low <= start <= high:
        raise s.fail("low", f"bounds {low:g} and {high:g} about {start:g}", "low < high, with the file's value between")
    out = FreeParameter(s.text("name", texts[0]), places[0].unit, places, start, size, mean, error, low, high)
    s.finish()
    return out


def _number(s: Section, key: str, default: float) -> float:
    return quantity(s.raw(key), "none", file=s.file, key=s.key(key)) if s.has(key) else default


def _cases(s: Section, p: ParameterFile, base: Path) -> tuple[SteadyCases, bool]:
    table = located(s.text("table"), "cfd_data", base)
    cells = read_cells(table)
    where, ignored, sizes = s.section("where", required=False), s.texts("ignore"), s.texts("magnitudes")
    rows = _chosen(cells, where)
    thrusters = {t.name: t.curve.unit for t in p.thrusters}
    known = (*QUANTITIES, *thrusters, *CONTROLS, THRUST)
    names: list[str] = []
    columns: dict[str, Array] = {}
    for h in cells.headers:
        if h.name in where.content or h.name in ignored:
            continue
        if h.name not in known:
            raise InputError(
                f"the column {shown(h.name)}", f"one of {', '.join(known)}", file=table, line=cells.first_line - 1,
                advice='List it under "ignore", or choose rows by it under "where".',
            )  # fmt: skip
        unit = require_unit(h, table, cells.first_line - 1, "u [m/s]")
        columns[h.name] = _column(cells, h.name, unit, thrusters)[rows]
        names += [h.name] if h.name in QUANTITIES else []
    if not names:
        raise InputError("no measured column", f"one of {', '.join(QUANTITIES)}", file=table)
    strange = [n for n in sizes if n not in names or n not in SIGNED]
    if strange:
        raise s.fail("magnitudes", shown(strange[0]), f"measured ones of {', '.join(SIGNED)}")
    measured = np.column_stack([columns[n] for n in names])
    errors, from_residuals = _errors(s, names, measured)
    commands = [c for c in columns if c not in QUANTITIES and c not in CONTROLS]
    for name in (*commands, *(c for c in CONTROLS if c in columns)):
        for i in np.flatnonzero(np.isnan(columns[name])):
            raise InputError("a blank cell", "a command", file=table, line=cells.line(int(rows[i])), column=name)
    controls = np.column_stack([columns.get(c, np.zeros(len(rows))) for c in CONTROLS])
    listed = tuple({c: float(columns[c][i]) for c in commands} for i in range(len(rows)))
    lines = tuple(cells.line(int(i)) for i in rows)
    return SteadyCases(table, lines, listed, controls, tuple(names), measured, errors, sizes), from_residuals


def _chosen(cells: Cells, where: Section) -> NDArray[np.int64]:
    keep = np.ones(len(cells), dtype=bool)
    for key in where.content:
        wanted = where.text(key)
        if key not in [h.name for h in cells.headers]:
            raise where.fail(key, f"no column {shown(key)}", f"one of {', '.join(h.name for h in cells.headers)}")
        keep &= np.array(cells.texts(key)) == wanted
    if not np.any(keep):
        raise where.fail("", "no row", "rows of the table that fit all of it")
    return np.flatnonzero(keep)


def _column(cells: Cells, name: str, unit: str, thrusters: dict[str, str]) -> Array:
    """SI numbers; commands of thrusters in the unit of their curve."""
    if name in thrusters:
        if unit != thrusters[name]:
            raise InputError(f"[{unit}]", f"[{thrusters[name]}], the unit of the curve", file=cells.file, column=name)
        return cells.numbers(name)
    dimension = QUANTITIES.get(name, "force" if name == THRUST else "angle")
    try:
        return np.asarray(cells.numbers(name) * factor(unit, dimension))
    except InputError as why:
        raise InputError(
            why.found, why.expected, file=cells.file, line=why.line, column=name, advice=why.advice
        ) from None


def _errors(s: Section, names: list[str], measured: Array) -> tuple[Array, bool]:
    given: Any = s.raw("errors")
    if given == FROM_RESIDUALS:
        spread = np.nanstd(measured, axis=0)
        return np.broadcast_to(FIRST_GUESS * np.where(spread > 0.0, spread, 1.0), measured.shape), True
    if not isinstance(given, dict):
        raise s.fail("errors", shown(given), f'a standard error for each of {", ".join(names)}, or "{FROM_RESIDUALS}"')
    table = s.section("errors")
    out = np.array([table.positive(n, QUANTITIES[n]) for n in names])
    table.finish()
    return np.broadcast_to(out, measured.shape), False
