"""A tuning plan: which numbers of a parameter file are free, and what was measured.

Places of a parameter file by name, so that a fit can read and move what stands there.

``Yv'``, ``C_S beta`` (a term of a fitted table), ``mass``, ``added_mass Yvdot`` (SI), ``thruster left ahead c0`` (coefficient of
the thrust curve, ``ahead`` or ``astern``), ``thruster left y`` (position). A minus in front takes the opposite sign.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from coeflab.core.errors import InputError, shown
from coeflab.core.files import located
from coeflab.core.text.delimited import Cells, read_cells, require_unit
from coeflab.core.text.toml import Section, read_toml
from coeflab.core.types import Array, brief, locked
from coeflab.core.units import factor, quantity
from coeflab.law.symbols import COMPONENTS, CONTROLS, MOTIONS, derivative
from coeflab.motion.vehicle import THRUST
from coeflab.vehicle.parameter_file import ParameterFile, read_parameter_file
from coeflab.vehicle.parameter_parts import CurveSegment, ParameterThruster

EXPECTED = "a coefficient (Yv'), a term of a table (C_S beta), mass, added_mass Yvdot, thruster NAME ahead c0 or thruster NAME y"
AXES = "xyz"


@brief
@dataclass(frozen=True, slots=True)
class Place:
    """One number of a parameter file.

    Attributes
    ----------
    text : str
        As written.
    kind : {"coefficient", "term", "mass", "added_mass", "curve", "position"}
    key : tuple
        Where, in terms of the kind.
    sign : float
    unit : str
    """

    text: str
    kind: str
    key: tuple[Any, ...]
    sign: float
    unit: str


def place(text: str, p: ParameterFile) -> Place:
    """The place of a name.

    Raises
    ------
    InputError
        No such place, or nothing stands there.
    """
    bare = text.strip().removeprefix("-").strip()
    words, sign = bare.split(), -1.0 if text.strip().startswith("-") else 1.0
    found: tuple[str, tuple[Any, ...], str] | None = None
    if bare == "mass" and p.mass is not None:
        found = "mass", (), "kg"
    elif len(words) == 2 and words[0] == "added_mass" and p.added_mass is not None:
        d = derivative(words[1])
        if len(d.factors) == 1 and d.factors[0].endswith("dot"):
            at = COMPONENTS.index(d.component), MOTIONS.index(d.factors[0].removesuffix("dot"))
            found = "added_mass", at, "kg" if max(at) < 3 else "kg m^2" if min(at) >= 3 else "kg m"
    elif len(words) > 2 and words[0] == "thruster":
        found = _of_thruster(words[1:], p)
    elif len(words) == 1 and (c := p.coefficient(bare)) is not None and c.value is not None:
        found = "coefficient", (c.symbol,), "1"
    else:
        for i, m in enumerate(p.models):
            for j, t in enumerate(m.terms):
                if f"{m.response} {t.symbol}" == bare and t.value is not None:
                    found = "term", (i, j), m.unit
    if found is None:
        raise InputError(f"the place {shown(text)}", EXPECTED, advice=f"The file has {_listed(p)}.")
    return Place(text, found[0], found[1], sign, found[2])


def _of_thruster(words: list[str], p: ParameterFile) -> tuple[str, tuple[Any, ...], str] | None:
    at = next((i for i, t in enumerate(p.thrusters) if t.name == words[0]), None)
    if at is None:
        return None
    if len(words) == 2 and words[1] in tuple(AXES):
        return "position", (at, AXES.index(words[1])), "m"
    if len(words) == 3 and words[1] in ("ahead", "astern") and words[2][:1] == "c" and words[2][1:].isdigit():
        segment, power = _segment(p.thrusters[at], words[1] == "ahead"), int(words[2][1:])
        if segment is not None and power < len(p.thrusters[at].curve.segments[segment].coefficients):
            unit = p.thrusters[at].curve.unit
            return "curve", (at, segment, power), "N" if not power else f"N/{unit}" + (f"^{power}" if power > 1 else "")
    return None


def _segment(thruster: ParameterThruster, ahead: bool) -> int | None:
    """The first segment that pushes ahead, or the last one that pushes astern."""
    pushing = [i for i, s in enumerate(thruster.curve.segments) if (s.at(s.high) > 0.0 if ahead else s.at(s.low) < 0.0)]
    return (pushing[0] if ahead else pushing[-1]) if pushing else None


def _listed(p: ParameterFile) -> str:
    names = [c.symbol for c in p.coefficients if c.value is not None]
    names += [f"{m.response} {t.symbol}" for m in p.models for t in m.terms if t.value is not None]
    names += [f"thruster {t.name}" for t in p.thrusters]
    return ", ".join(names) or "no coefficient, table or thruster"


def value_at(p: ParameterFile, where: Place) -> float:
    """What stands at a place, with its sign."""
    key = where.key
    if where.kind == "coefficient":
        c = p.coefficient(key[0])
        found = c.value if c is not None else None
    elif where.kind == "term":
        found = p.models[key[0]].terms[key[1]].value
    elif where.kind == "mass":
        found = p.mass.mass if p.mass is not None else None
    elif where.kind == "added_mass":
        found = -float(p.added_mass.matrix[key]) if p.added_mass is not None else None
    elif where.kind == "position":
        found = p.thrusters[key[0]].position[key[1]]
    else:
        found = p.thrusters[key[0]].curve.segments[key[1]].coefficients[key[2]]
    if found is None:
        raise InputError(f"nothing at {shown(where.text)}", "a value")
    return where.sign * found


def moved(p: ParameterFile, values: Mapping[Place, float]) -> ParameterFile:
    """The file with other values at places; not validated again, so that a fit may pass through what cannot be."""
    for where, value in values.items():
        p = _moved(p, where, where.sign * value)
    return p


def _moved(p: ParameterFile, where: Place, value: float) -> ParameterFile:
    key = where.key
    if where.kind == "coefficient":
        changed = tuple(
            replace(c, value=value, value_si=_si(c.value, c.value_si, value, p, c.symbol)) if c.symbol == key[0] else c
            for c in p.coefficients
        )
        return p.model_copy(update={"coefficients": changed})
    if where.kind == "term":
        m = p.models[key[0]]
        terms = _with(m.terms, key[1], m.terms[key[1]].model_copy(update={"value": value}))
        return p.model_copy(update={"models": _with(p.models, key[0], m.model_copy(update={"terms": terms}))})
    if where.kind == "mass" and p.mass is not None:
        ratio = value / p.mass.mass
        scaled = {n: getattr(p.mass, n) * ratio for n in ("mass_moment", "mass_prime", "mass_moment_prime")}
        return p.model_copy(update={"mass": replace(p.mass, mass=value, **scaled)})
    if where.kind == "added_mass" and p.added_mass is not None:
        matrix = np.array(p.added_mass.matrix)
        matrix[key[0], key[1]] = matrix[key[1], key[0]] = -value
        return p.model_copy(update={"added_mass": replace(p.added_mass, matrix=matrix)})
    t = p.thrusters[key[0]]
    if where.kind == "position":
        t = t.model_copy(update={"position": _with(t.position, key[1], value)})
    else:
        t = t.model_copy(update={"curve": _curve(t, key[1], key[2], value)})
    return p.model_copy(update={"thrusters": _with(p.thrusters, key[0], t)})


def _si(old: float | None, old_si: float | None, value: float, p: ParameterFile, symbol: str) -> float | None:
    if old_si is None:
        return None
    if old:
        return old_si / old * value
    return value * p.scaling.unit(symbol, p.conditions.density, p.conditions.speed)


def _with(values: tuple[Any, ...], at: int, value: Any) -> tuple[Any, ...]:
    return (*values[:at], value, *values[at + 1 :])


def _curve(thruster: ParameterThruster, at: int, power: int, value: float) -> Any:
    """The curve with one coefficient moved, its dead zone ending where the thrust is zero."""
    segments = thruster.curve.segments
    s = segments[at]
    ahead = s.at(s.high) > 0.0
    began_at_zero = abs(s.at(s.low if ahead else s.high)) <= 1e-6 * max(abs(s.at(s.low)), abs(s.at(s.high)))
    coefficients = _with(s.coefficients, power, value)
    update: dict[str, Any] = {"coefficients": coefficients}
    edge = s.low if ahead else s.high
    at_edge = CurveSegment(low=s.low, high=s.high, coefficients=coefficients).at(edge)
    pushes_back = at_edge < 0.0 if ahead else at_edge > 0.0
    zero = _zero(coefficients, edge) if began_at_zero or pushes_back else None
    if zero is not None:
        floor = segments[at - 1].high if at > 0 else -np.inf
        roof = segments[at + 1].low if at + 1 < len(segments) else np.inf
        if ahead and floor <= zero < s.high:
            update["low"] = zero
        elif not ahead and s.low < zero <= roof:
            update["high"] = zero
    changed: CurveSegment = s.model_copy(update=update)
    return thruster.curve.model_copy(update={"segments": _with(segments, at, changed)})


def _zero(coefficients: tuple[float, ...], near: float) -> float | None:
    """The command nearest to another at which a polynomial is zero."""
    roots = np.roots(coefficients[::-1])
    real = roots.real[np.abs(roots.imag) <= 1e-9 * np.maximum(1.0, np.abs(roots.real))]
    return float(real[np.argmin(np.abs(real - near))]) if real.size else None


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
