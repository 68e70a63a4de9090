"""A tuning plan: which numbers of a parameter file are free, and what was measured.

Places of a parameter file by name, so that a fit can read and move what stands there.

``Yv'``, ``C_S beta`` (a term of a fitted table), ``mass``, ``added_mass Yvdot`` (SI), ``thruster left ahead c0`` (coefficient of
the thrust curve, ``ahead`` or ``astern``), ``thruster left y`` (position). A minus in front takes the opposite sign.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray

from coeflab.core import declarations as takes
from coeflab.core.errors import InputError, shown
from coeflab.core.files import named
from coeflab.core.finding import Finding, Severity
from coeflab.core.text.delimited import Cells, read_cells, require_unit
from coeflab.core.text.toml import TomlFile, read_toml
from coeflab.core.texts import input_error
from coeflab.core.types import Array, brief, locking
from coeflab.core.units import factor
from coeflab.law.symbols import COMPONENTS, CONTROLS, MOTIONS, derivative
from coeflab.vehicle.parameter_file import ParameterFile, read_parameter_file
from coeflab.vehicle.parameter_parts import THRUST, CurveSegment, ParameterThruster

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
FilePath = Annotated[Path, takes.located_in("cfd_data")]
ERRORS = f'a standard error for each measured column, or "{FROM_RESIDUALS}"'
REPEATS = 0.1  # of its standard error: a reading that is nearer to what follows from the others is no other reading
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
@locking("controls measured errors")
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
    findings : tuple of Finding
        What of the measured follows from the rest.
    """

    name: str
    file: Path
    parameters_file: Path
    parameters: ParameterFile
    free: tuple[FreeParameter, ...]
    cases: SteadyCases
    from_residuals: bool
    findings: tuple[Finding, ...] = ()


def _no_name(text: str) -> str:
    return "" if text.replace("_", "").replace("-", "").isalnum() else "letters, digits, _ and -"


def _errors_given(value: Any, _file: Path) -> Any:
    if value != FROM_RESIDUALS and not isinstance(value, dict):
        raise InputError(shown(value), ERRORS)
    return value


@dataclass(frozen=True, slots=True)
class TuneKeys(takes.Declaration):
    """What is tuned.

    Attributes
    ----------
    name : str
        Letters, digits, _ and -; of the results.
    parameters : Path
        A parameter file, or a shipped name.
    """

    name: Annotated[takes.Text, takes.Within(_no_name)]
    parameters: FilePath


@dataclass(frozen=True, slots=True, kw_only=True)
class MeasuredKeys(takes.Declaration):
    """Steady turns that were measured.

    Attributes
    ----------
    table : Path
        A CSV, or a shipped name.
    where : mapping of str to str
        Only rows with this text in that column.
    ignore : tuple of str
        Columns to skip.
    magnitudes : tuple of str
        Columns whose sign was not measured: v, r, beta.
    errors : mapping of str to float, or str
        Standard error of each measured column, or "from residuals".
    """

    table: FilePath
    where: Mapping[str, takes.Text] = field(default_factory=dict)
    ignore: takes.Texts = ()
    magnitudes: takes.Texts = ()
    errors: Annotated[
        Any, takes.Takes(ERRORS, _errors_given, {"anyOf": [{"const": FROM_RESIDUALS}, {"type": "object"}]})
    ]


@dataclass(frozen=True, slots=True)
class PriorKeys(takes.Declaration):
    """What is known of a parameter beforehand.

    Attributes
    ----------
    mean : float
        What stands in the file unless given.
    error : float
        Standard uncertainty; infinite unless given.
    """

    mean: takes.Pure | None = None
    error: Annotated[takes.Pure, takes.Within(lambda v: "" if v > 0.0 else "a standard uncertainty above zero")] = (
        np.inf
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class FreeKeys(takes.Declaration):
    """A number that is free.

    Attributes
    ----------
    name : str
        The first place unless given.
    places : tuple of str
        Where it stands in the parameter file: Yv', C_D beta^2 (term of a table), mass, added_mass Yvdot, thruster NAME ahead
        c0 or thruster NAME y. A minus in front takes the opposite sign.
    size : float
        What counts as a large change; what stands there unless given.
    prior : table
        What is known of it beforehand.
    low, high : float
        Bounds.
    """

    name: takes.Words | None = None
    places: Annotated[takes.Texts, takes.Within(lambda v: "" if v else "a list of places in the parameter file")]
    size: takes.Pure | None = None
    prior: PriorKeys = PriorKeys()
    low: takes.Pure = -np.inf
    high: takes.Pure = np.inf


@dataclass(frozen=True, slots=True, kw_only=True)
class TuningFile(takes.Declaration):
    """A tuning plan: which numbers of a parameter file are free, and what was measured.

    Attributes
    ----------
    tune : table
        What is tuned.
    measured : table
        Steady turns that were measured.
    free : array of tables
        Numbers that are free, one at least.
    """

    tune: TuneKeys
    measured: MeasuredKeys
    free: tuple[FreeKeys, ...] = ()

    def check(self) -> None:
        """Something is free."""
        if not self.free:
            raise input_error("identify.least_one_free", column="free")


def read_tuning_plan(path: Path) -> TuningPlan:
    """Read and check a plan.

    Raises
    ------
    InputError
        With file, line and key.
    """
    path = named(path, "tune.toml")
    toml = read_toml(path)
    file = takes.declared(TuningFile, toml)
    parameters = read_parameter_file(file.tune.parameters)
    free = tuple(_free(keys, parameters, toml, f"free[{i}]") for i, keys in enumerate(file.free))
    twice = [w.text.strip().removeprefix("-").strip() for f in free for w in f.places]
    if len(set(twice)) < len(twice):
        raise toml.fail("free", f"{max(twice, key=twice.count)} more than once", "every place once")
    if len({f.name for f in free}) < len(free):
        raise toml.fail("free", "a name more than once", "names of their own")
    cases, from_residuals = _cases(file.measured, parameters, toml)
    cases, found = counted_once(cases)
    return TuningPlan(file.tune.name, path, file.tune.parameters, parameters, free, cases, from_residuals, found)


def counted_once(cases: SteadyCases) -> tuple[SteadyCases, tuple[Finding, ...]]:
    """The cases without readings that only repeat others: beta and V of u and v, a radius of V and r.

    A reading that differs from what follows by more than `REPEATS` of its error is one of its own and counts.
    """
    empty = np.full(len(cases.lines), np.nan)
    x = dict.fromkeys(QUANTITIES, empty) | dict(zip(cases.names, np.abs(cases.measured).T, strict=True))
    with np.errstate(divide="ignore", invalid="ignore"):
        along = np.hypot(x["u"], x["v"])
        speeds = (along, x["u"] / np.cos(x["beta"]), x["v"] / np.sin(x["beta"]))
        speed = np.select([np.isfinite(v) for v in speeds], speeds, np.nan)
        known = np.where(np.isfinite(x["V"]), x["V"], speed)
        follows = {"beta": np.arcsin(x["v"] / along), "V": speed, "radius": known / x["r"]}
    measured, found = cases.measured.copy(), list[Finding]()
    for k, name in enumerate(cases.names):
        apart = (x[name] - follows.get(name, empty)) / cases.errors[:, k]
        both = np.isfinite(apart)
        if np.any(both):
            size = float(np.sqrt(np.mean(apart[both] ** 2)))
            measured[both & (size <= REPEATS), k] = np.nan
            case = "left" if size <= REPEATS else "counted"
            found.append(Finding.of("tune.repeats", name, Severity.NOTE, statistic=size, threshold=REPEATS, case=case))
    seen = np.any(np.isfinite(measured), axis=0)
    names = tuple(n for n, own in zip(cases.names, seen, strict=True) if own)
    return replace(cases, names=names, measured=measured[:, seen], errors=cases.errors[:, seen]), tuple(found)


def _free(keys: FreeKeys, p: ParameterFile, toml: TomlFile, at: str) -> FreeParameter:
    try:
        places = tuple(place(t, p) for t in keys.places)
    except InputError as why:
        raise toml.fail(f"{at}.places", why.found, why.expected, why.advice) from None
    values = [value_at(p, w) for w in places]
    if max(values) - min(values) > 1e-9 * max(abs(v) for v in values):
        raise toml.fail(f"{at}.places", f"different values {', '.join(f'{v:g}' for v in values)}",
                        "one value at all places", "A minus before a place takes the opposite sign.")  # fmt: skip
    start = values[0]
    size = abs(start) if keys.size is None else keys.size
    if not size > 0.0:
        advice = "The parameter is zero: say what would be a large value."
        raise toml.fail(f"{at}.size", f"{size:g}", "a size above zero", advice)
    low, high = keys.low, keys.high
    if not low < high or not low <= start <= high:
        found = f"bounds {low:g} and {high:g} about {start:g}"
        raise toml.fail(f"{at}.low", found, "low < high, with the file's value between")
    name, mean = (
        keys.places[0] if keys.name is None else keys.name,
        start if keys.prior.mean is None else keys.prior.mean,
    )
    return FreeParameter(name, places[0].unit, places, start, size, mean, keys.prior.error, low, high)


def _cases(keys: MeasuredKeys, p: ParameterFile, toml: TomlFile) -> tuple[SteadyCases, bool]:
    table = keys.table
    cells = read_cells(table)
    rows = _chosen(cells, keys.where, toml)
    thrusters = {t.name: t.curve.unit for t in p.thrusters}
    known = (*QUANTITIES, *thrusters, *CONTROLS, THRUST)
    names: list[str] = []
    columns: dict[str, Array] = {}
    for h in cells.headers:
        if h.name in keys.where or h.name in keys.ignore:
            continue
        if h.name not in known:
            raise input_error(
                "identify.list_under_ignore", table, cells.first_line - 1, name=shown(h.name), known=", ".join(known),
            )  # fmt: skip
        unit = require_unit(h, table, cells.first_line - 1, "u [m/s]")
        columns[h.name] = _column(cells, h.name, unit, thrusters)[rows]
        names += [h.name] if h.name in QUANTITIES else []
    if not names:
        raise InputError("no measured column", f"one of {', '.join(QUANTITIES)}", file=table)
    strange = [n for n in keys.magnitudes if n not in names or n not in SIGNED]
    if strange:
        raise toml.fail("measured.magnitudes", shown(strange[0]), f"measured ones of {', '.join(SIGNED)}")
    measured = np.column_stack([columns[n] for n in names])
    errors, from_residuals = _errors(keys.errors, toml, names, measured)
    commands = [c for c in columns if c not in QUANTITIES and c not in CONTROLS]
    for name in (*commands, *(c for c in CONTROLS if c in columns)):
        for i in np.flatnonzero(np.isnan(columns[name])):
            raise InputError("a blank cell", "a command", file=table, line=cells.line(int(rows[i])), column=name)
    controls = np.column_stack([columns.get(c, np.zeros(len(rows))) for c in CONTROLS])
    listed = tuple({c: float(columns[c][i]) for c in commands} for i in range(len(rows)))
    lines = tuple(cells.line(int(i)) for i in rows)
    cases = SteadyCases(table, lines, listed, controls, tuple(names), measured, errors, keys.magnitudes)
    return cases, from_residuals


def _chosen(cells: Cells, where: Mapping[str, str], toml: TomlFile) -> NDArray[np.int64]:
    keep = np.ones(len(cells), dtype=bool)
    headers = [h.name for h in cells.headers]
    for key, wanted in where.items():
        if key not in headers:
            raise toml.fail(f"measured.where.{key}", f"no column {shown(key)}", f"one of {', '.join(headers)}")
        keep &= np.array(cells.texts(key)) == wanted
    if not np.any(keep):
        raise toml.fail("measured.where", "no row", "rows of the table that fit all of it")
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


def _errors(given: Any, toml: TomlFile, names: list[str], measured: Array) -> tuple[Array, bool]:
    if given == FROM_RESIDUALS:
        spread = np.nanstd(measured, axis=0)
        return np.broadcast_to(FIRST_GUESS * np.where(spread > 0.0, spread, 1.0), measured.shape), True
    for name in given:
        if name not in names:
            expected = "one of " + ", ".join(sorted(names))
            raise toml.fail(f"measured.errors.{name}", "an unknown key", expected)
    kinds: list[Any] = [Annotated[float, takes.number_in(QUANTITIES[n]), takes.ABOVE_ZERO] for n in names]
    out = np.array(
        [takes.declared_key(toml, f"measured.errors.{n}", kind) for n, kind in zip(names, kinds, strict=True)]
    )
    return np.broadcast_to(out, measured.shape), False
