"""Rows of a table in which one motion variable is swept while the others rest.

Rows of a table in which nothing but the wanted variables moves.

Slope at the origin beside the secant over a range, and over which range the secant would meet a value from elsewhere.

A nonlinear force has no single derivative: a slope at the origin, a line through a sweep and an oscillation test each
give another number. The first harmonic of ``b |x|^n sign(x)`` under ``x = A sin(wt)`` is ``b A^(n-1) c_n`` with
``c_n = 2 Gamma(n/2 + 1) / (sqrt(pi) Gamma((n + 3)/2))``: 1, 8/(3 pi), 3/4 for n = 1, 2, 3 (describing function,
Gelb & Vander Velde 1968).
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import gamma, pi, sqrt
from typing import Any

import numpy as np
from numpy.typing import NDArray

from coeflab.core.errors import InputError, shown
from coeflab.core.table import coefficient, plus_minus
from coeflab.core.texts import input_error, text_of
from coeflab.core.types import Array, dataclass
from coeflab.fits.results.fit_result import LeftOut, Sweep
from coeflab.fits.results.fitted_model import FittedModel
from coeflab.fits.rows.regression import WIND, Area, Rows, response
from coeflab.fits.statistics.diagnostics import levels
from coeflab.fits.statistics.slopes import is_one_sided
from coeflab.law.scaling import Scaling
from coeflab.law.symbols import COMPONENTS, FORCES
from coeflab.law.terms import canonical
from coeflab.tables.force_table import AT_REST, SAME_SIZE, Exclusion, ForceTable, counted_once

INCIDENCE = {"dr": "v", "ds": "w", "db": "w"}
ASTERN = "moves astern (u <= 0): an angle beyond 90 degrees, or degrees declared as radians?"
STALLED = "past stall: the force across the flow falls again"
SAME_SETTING = 0.02  # a rate's prime changes with the point at which the speed is taken
SAME_POINT = 1e-6  # of the length: rotating runs that do not drift about one point
FEWEST_SETTINGS = 3  # for an intercept, a slope and an error
NEAR_ZERO = np.sin(np.radians(0.3))  # what is left of a setting of zero when a model is aligned


@dataclass(frozen=True, slots=True, eq=False)
class SweepRows:
    """Rows of one sweep, with rest rows of the same campaign where a one-sided sweep has none of its own.

    ``astern`` rows do not run ahead: sin(beta) is the same at 10 and at 170 degrees, the force is not.
    """

    table: ForceTable
    x: Array
    rows: NDArray[np.intp]
    rest: tuple[ForceTable, NDArray[np.intp]] | None
    astern: NDArray[np.intp]


def _others_at_rest(table: ForceTable, variable: str, length: float) -> NDArray[np.bool_]:
    """Rows in which nothing but surge and ``variable`` moves (control sweeps: within 0.3 degrees of zero incidence)."""
    keep = np.ones(len(table), dtype=bool)
    for name in ("v", "w", "p", "q", "r", *table.controls):
        if name != variable:
            limit = NEAR_ZERO if INCIDENCE.get(variable) == name else AT_REST
            keep &= np.abs(table.primed_motion(name, length)) <= limit
    return keep


def sweep_rows(table: ForceTable, variable: str, tables: Sequence[ForceTable], length: float) -> SweepRows:
    """The rows of ``table`` that sweep a variable.

    A one-sided sweep without a row at rest borrows those of the first other table at the same speed.
    """
    keep = _others_at_rest(table, variable, length)
    ahead = table.motion["u"] > 0.0
    astern = np.flatnonzero(keep & ~ahead)
    keep &= ahead
    x = table.primed_motion(variable, length)
    rest = None
    if is_one_sided(x[keep]) and not np.any(keep & (np.abs(x) <= AT_REST)):
        for other in tables:
            still = _others_at_rest(other, "", length)
            if other is not table and np.any(still) and np.allclose(other.speed[still], table.speed.mean(), rtol=0.01):
                rest = (other, np.flatnonzero(still))
                break
    return SweepRows(table, x, np.flatnonzero(keep), rest, astern)


def collect_points(
    rows: SweepRows, component: str, length: float, taken_out: Array
) -> tuple[Array, Array, Array | None, tuple[str, ...], tuple[LeftOut, ...]]:
    """x, y, se, labels of the usable points, and those left out with their reasons.

    ``taken_out`` is subtracted from the primed force of every row of the sweep's own table.
    """
    table = rows.table
    reasons = {(e.row, e.component): e.reason for e in table.exclusions}
    parts: list[tuple[ForceTable, NDArray[np.intp], Array]] = [(table, rows.rows, rows.x[rows.rows])]
    if rows.rest is not None and component in rows.rest[0].forces:
        parts.append((*rows.rest, np.zeros(len(rows.rest[1]))))
    x, y, se, labels = [], [], [], []
    left: list[LeftOut] = []
    if len(rows.astern):
        away = table.primed_force(component, length)
        left += [LeftOut(float(rows.x[i]), float(away[i]), table.labels[i], ASTERN) for i in rows.astern]
    for source, index, at in parts:
        force = source.primed_force(component, length) - (taken_out if source is table else 0.0)
        error = source.primed_force(component, length, source.errors[component]) if component in source.errors else None
        for i, xi in zip(index, at, strict=True):
            if source.usable[component][i]:
                x.append(xi)
                y.append(force[i])
                se.append(np.nan if error is None else error[i])
                labels.append(source.labels[i] if source is table else f"{source.name} {source.labels[i]}")
            elif source is table:
                why = reasons.get((int(i), component)) or reasons.get((int(i), ""), "excluded")
                left.append(LeftOut(float(xi), float(force[i]), source.labels[i], why))
    errors = np.array(se)
    known = errors if len(errors) and np.all(np.isfinite(errors)) else None
    return np.array(x), np.array(y), known, tuple(labels), tuple(left)


def not_belonging(table: ForceTable, component: str, sweeps: Sequence[Sweep], length: float) -> NDArray[np.bool_]:
    """Rows of a table whose force a sweep over it left out, past stall or because it does not fit the others, shape (n,)."""
    out = np.zeros(len(table), dtype=bool)
    labels = np.array(table.labels, dtype=object)
    for s in (s for s in sweeps if (s.table, s.component) == (table.name, component)):
        x = table.primed_motion(s.variable, length)
        of_sweep = np.array(s.labels, dtype=object)
        for i in map(int, s.wrong):
            here = np.flatnonzero((labels == s.labels[i]) & np.isclose(x, s.x[i], rtol=SAME_SETTING))
            there = np.flatnonzero((of_sweep == s.labels[i]) & np.isclose(s.x, s.x[i], rtol=SAME_SETTING))
            out[here[there == i] if len(here) == len(there) else here] = True
        stalled = [p.x for p in s.left_out if p.reason == STALLED]
        out |= np.isclose(x[:, None], np.array(stalled)[None, :], rtol=SAME_SETTING).any(axis=1)
    return out


def one_size(x: Array, variable: str, speed: Array) -> str:
    """Why settings (n,) of one size determine no slope, in words; empty where they have several.

    Readings at -a, 0 and a give the odd part of the force at a: one number for x and x|x| together. On a rotating arm the
    radius alone makes |r'| = L/R; the speed, shape (n,), does not.
    """
    sizes = np.abs(x[np.abs(x) > AT_REST])
    if not len(sizes) or float(np.ptp(sizes)) > SAME_SIZE * float(sizes.max()):
        return ""
    size = float(np.median(sizes))
    faster = float(np.ptp(speed)) > SAME_SIZE * float(speed.max())
    details = [f"speeds {speed.min():.3g} to {speed.max():.3g} m/s"] if faster else []
    details += ["both signs"] if np.any(x > AT_REST) and np.any(x < -AT_REST) else []
    seen = f" ({', '.join(details)})" if details else ""
    name, how = f"{variable}'", " (L/R: other radii, not speeds)" if variable in "qr" else ""
    return f"one |{name}|, {size:.3g}{seen}: {name} and {name}|{name}| cannot be separated; measure |{name}| near {size / 3.0:.2g} and {2.0 * size / 3.0:.2g}{how}"


def arm_shift(tables: Sequence[ForceTable]) -> float:
    """How far forward the point lies at which rotating runs have no cross flow; 0 if there is no such point.

    About any other point an arm's runs have v = r dx (w = -q dx), and no row turns without drifting. Of runs that combine drift with
    rotation it is the point about which most rates are run without drift, if they are enough for a slope.
    """
    places, rates, drifts = list[Array](), list[Array](), list[Array]()
    for table in tables:
        for rate, drift, sign in (("r", "v", -1.0), ("q", "w", 1.0)):
            turning = table.motion[rate] != 0.0
            places.append(sign * table.motion[drift][turning] / table.motion[rate][turning])
            rates.append(table.primed_motion(rate, 1.0)[turning])
            drifts.append(table.primed_motion(drift, 1.0)[turning])
    shifts, over = np.concatenate(places), np.concatenate(rates)
    away = np.abs(np.concatenate(drifts)) > AT_REST
    if not np.any(away):
        return 0.0
    order = np.flatnonzero(away)[np.argsort(shifts[away], kind="stable")]
    apart = SAME_POINT * float(tables[0].scaling.length)
    about = np.split(order, np.flatnonzero(np.diff(shifts[order]) > apart) + 1)
    # Slow rates of an arm drift little enough to count as pure; their place says that they turn about its point.
    about = [np.flatnonzero((shifts >= shifts[b[0]] - apart) & (shifts <= shifts[b[-1]] + apart)) for b in about]
    if len(about) == 1 and len(about[0]) == len(shifts):
        return float(np.median(shifts))
    best = max(about, key=lambda rows: (_settings(over[rows]), -abs(float(np.median(shifts[rows])))))
    pure = ~away
    pure[best] = False
    enough = max(FEWEST_SETTINGS - 1, _settings(over[pure]))
    return float(np.median(shifts[best])) if _settings(over[best]) > enough else 0.0


def _settings(x: Array) -> int:
    """How many settings differ in size or sign."""
    return len(np.unique(np.sign(x) * (levels(x) + 1)))


MOVED_BY = {"alpha": ("w",), "beta": ("v",)}
PRIMES = "L^2"
AREAS = (PRIMES, "frontal", "wetted", "projected", "planform", "volume^(2/3)")


def area_of(value: float, name: str, scaling: Scaling) -> Area:
    """The area that force coefficients are divided by; 0 is the square of the primes' length.

    Parameters
    ----------
    value : float
        m^2, or 0.
    name : str
        One of `AREAS`.
    scaling : Scaling
        Whose length the primes have.

    Raises
    ------
    InputError
        An area without its name, or a name without its area.
    """
    if value == 0.0 and name == PRIMES:
        return Area(scaling.length**2, PRIMES, scaling.length)
    if value == 0.0 or name == PRIMES:
        raise input_error(
            "fits.area_named", column="area", value=value, name=name, areas=", ".join(AREAS[1:]), primes=PRIMES,
            scaling=scaling,
        )  # fmt: skip
    return Area(value, name, scaling.length)


def area_settings(area: Area) -> dict[str, str]:
    """The area among the settings of a fit, from which the parameter file takes it."""
    return {"area": repr(area.area), "area_name": area.name}


def without_blanks(options: Mapping[str, Any], name: str) -> dict[str, Any]:
    """Options in which one text of ``key=value`` words may have blanks around the equals sign."""
    text = options.get(name)
    return {**options, name: re.sub(r"\s*=\s*", "=", text)} if isinstance(text, str) else dict(options)


def check_varies(rows: Rows) -> None:
    """Raise where a variable of two stands still, within `AT_REST`."""
    for name, x in rows.x.items():
        if np.ptp(x) <= AT_REST:
            others = ", ".join(v for v in rows.x if v != name)
            raise input_error(
                "fits.never_varies_rows", column="variables", name=name, response=rows.response, campaign=rows.campaign,
                others=others,
            )  # fmt: skip


def named_response(name: str, area: Area) -> str:
    """``Y'`` for primes, ``C_Y`` by another area; ``C_D`` and its like stay."""
    if name not in COMPONENTS:
        return name
    return f"{name}'" if area.name == PRIMES else f"C_{name}"


def allowed(tables: Sequence[ForceTable], name: str, area: Area) -> list[ForceTable]:
    """The tables that have what a response needs."""
    if name in WIND and not any(c in t.forces for t in tables for c in FORCES):
        return []
    out = []
    for table in tables:
        try:
            _, _, usable = response(table, name, area)
        except InputError:
            continue
        if np.any(usable):
            out.append(table)
    return out


def only_moving(
    tables: Sequence[ForceTable], variables: Sequence[str], length: float
) -> tuple[list[ForceTable], tuple[str, ...]]:
    """The tables with the rows out of use in which another variable moves.

    Surge does not count. Another variable is at rest within the sine of 0.05 degrees, in primes.

    Returns
    -------
    tables : list of ForceTable
        Tables without such a row are left out.
    statements : tuple of str
        How many rows were left out, where any.
    """
    free = {"u"} | {m for v in variables for m in MOVED_BY.get(v, (v,))}
    selected, statements = [], []
    for table in counted_once(tables, axial=len(variables) > 1):
        still = np.ones(len(table), dtype=bool)
        for name in ("v", "w", "p", "q", "r", *table.controls):
            if name not in free:
                still &= np.abs(table.primed_motion(name, length)) <= AT_REST
        dropped = int(np.sum(~still))
        if not dropped:
            selected.append(table)
            continue
        statements.append(f"{dropped} of {len(table)} rows of {table.name} are left out: other variables move in them.")
        if dropped < len(table):
            moving = tuple(
                Exclusion(int(i), 0, "", f"moves in more than {', '.join(variables)}") for i in np.flatnonzero(~still)
            )
            usable = {c: mask & still for c, mask in table.usable.items()}
            selected.append(replace(table, usable=usable, exclusions=(*table.exclusions, *moving)))
    if not selected:
        raise input_error("fits.no_row_only_may", column="variable", variables=" and ".join(variables))
    return selected, tuple(statements)


FARTHEST = 3.0  # reaches: beyond, a slope from rest speaks of other motions than those measured


@dataclass(frozen=True, slots=True)
class Secant:
    """A slope at the origin and the secant from 0 to ``reach``.

    Attributes
    ----------
    symbol, variable : str
    slope, secant : float
    half_width : float
        95 % of the secant, scatter of the points only.
    reach : float
        Largest motion in the data.
    """

    symbol: str
    variable: str
    slope: float
    secant: float
    half_width: float
    reach: float

    def __str__(self) -> str:
        return (
            f"{self.symbol}' is {coefficient(self.slope)} at the origin and "
            f"{plus_minus(self.secant, self.half_width)} (scatter) as secant over {self.variable}' = 0 .. {self.reach:.3g}."
        )


@dataclass(frozen=True, slots=True)
class Explanation:
    """Whether the range of motion could explain a difference to a value from elsewhere.

    Attributes
    ----------
    secant : Secant
    reference : float
    equal_at : float or None
        Range over which the secant equals the reference, up to three times the data's; None if there is none.
    harmonic_at : float or None
        Amplitude of an oscillation whose first harmonic gives the reference.
    possible : bool
        Whether either lies inside the data.
    sentence : str
    """

    secant: Secant
    reference: float
    equal_at: float | None
    harmonic_at: float | None
    possible: bool
    sentence: str


def _powers(model: FittedModel, symbol: str) -> tuple[str, dict[int, int]]:
    """Variable of a slope, and the model's terms odd in that variable alone: power -> index."""
    if symbol not in model.symbols:
        raise InputError(shown(symbol), f"one of {', '.join(model.symbols)}", column="secant")
    key = canonical(model.terms[model.symbols.index(symbol)])
    if len(key) != 1 or key[0][1:] != (1, True):
        raise InputError(shown(symbol), "a slope at the origin such as Yr", column="secant")
    variable = key[0][0]
    found = {}
    for i, term in enumerate(model.terms):
        k = canonical(term)
        if len(k) == 1 and k[0][0] == variable and k[0][2]:
            found[k[0][1]] = i
    return variable, found


def secant(model: FittedModel, symbol: str) -> Secant:
    """Slope and secant of a linear coefficient.

    Parameters
    ----------
    model : FittedModel
    symbol : str
        A slope at the origin of the model, such as ``Yr``.

    Raises
    ------
    InputError
        The model has no such slope.
    """
    variable, powers = _powers(model, symbol)
    reach = float(np.max(np.abs(model.x[variable])))
    weights = np.zeros(len(model.terms))
    for n, i in powers.items():
        weights[i] = reach ** (n - 1)
    value = float(sum(weights[i] * model.fit.coefficients[i] for i in powers.values()))
    deviation = float(np.sqrt(max(float(weights @ model.fit.covariance @ weights), 0.0)))
    own = model.symbols.index(symbol)
    factor = float(model.fit.half_width[own]) / max(float(np.sqrt(model.fit.covariance[own, own])), 1e-300)
    return Secant(symbol, variable, model.named(symbol)[0], value, factor * deviation, reach)


def _meets(coefficients: Mapping[int, float], value: float, limit: float) -> float | None:
    """Smallest positive x up to ``limit`` with sum b_n x^(n-1) = value."""
    highest = max(coefficients)
    polynomial = [coefficients.get(n, 0.0) for n in range(highest, 0, -1)]
    polynomial[-1] -= value
    roots = np.asarray(np.roots(polynomial), dtype=np.complex128)
    real = roots.real[np.abs(roots.imag) < 1e-9 * np.maximum(np.abs(roots), 1e-12)]
    real = real[(real > 0.0) & (real <= limit)]
    return float(real.min()) if real.size else None


def explain(model: FittedModel, symbol: str, reference: float, origin: str) -> Explanation:
    """Say over which range the model's secant would equal a value from elsewhere.

    Parameters
    ----------
    model : FittedModel
    symbol : str
        A slope at the origin of the model.
    reference : float
        The primed value from elsewhere, on the same length and reference point.
    origin : str
        What that value is, for example ``Roddy (1990), PMM``.

    Returns
    -------
    Explanation
        The sentence says so when the range does not explain the difference, and that the amplitude of the other test
        is unknown here.
    """
    _, powers = _powers(model, symbol)
    coefficients = {n: float(model.fit.coefficients[i]) for n, i in powers.items()}
    return explained(secant(model, symbol), coefficients, reference, origin)


def explained(here: Secant, coefficients: Mapping[int, float], reference: float, origin: str) -> Explanation:
    """Say over which range the secant of an odd curve would equal a value from elsewhere.

    Parameters
    ----------
    here : Secant
    coefficients : mapping of int to float
        Power n, odd in the motion: its coefficient.
    reference : float
        The primed value from elsewhere, on the same length and reference point.
    origin : str
        What that value is, for example ``Roddy (1990), PMM``.
    """
    variable = here.variable
    harmonic = {n: b * 2.0 * gamma(n / 2 + 1) / (sqrt(pi) * gamma((n + 3) / 2)) for n, b in coefficients.items()}
    limit = FARTHEST * here.reach
    equal_at, harmonic_at = _meets(coefficients, reference, limit), _meets(harmonic, reference, limit)
    found = [x for x in (equal_at, harmonic_at) if x is not None]
    possible = any(x <= here.reach for x in found)
    x = f"{variable}'"
    head = f"{here} {origin} gives {coefficient(reference)}. "
    if not found:
        tail = f"No range up to {x} = {limit:.3g} makes them equal: the range of {x} does not explain the difference."
    else:
        where = "The secant would equal it over 0 .. " + (
            f"{x} = {equal_at:.3g}" if equal_at is not None else f"no {x} up to {limit:.3g}"
        )
        where += ", the first harmonic of an oscillation at " + (
            f"an amplitude of {x} = {harmonic_at:.3g}" if harmonic_at is not None else "no such amplitude"
        )
        if possible:
            tail = text_of("fits.range_may_explain", where=where, x=x)
        else:
            tail = text_of("fits.beyond_data", where=where, x=x, reach=here.reach)
    return Explanation(here, reference, equal_at, harmonic_at, possible, head + tail)
