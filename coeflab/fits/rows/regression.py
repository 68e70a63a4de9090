"""From tables to the rows of a regression, and from a regression to a fitted model: what all fits of force laws share."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from coeflab.core.errors import InputError, shown
from coeflab.core.texts import input_error
from coeflab.core.types import Array, dataclass
from coeflab.fits.results.fitted_model import FittedModel, in_words
from coeflab.fits.results.lack_of_fit import ROUNDING
from coeflab.fits.results.set_aside import SetAside, joined, readmitted
from coeflab.fits.rows.too_few import TooFewRowsError
from coeflab.fits.statistics import printed_digits
from coeflab.fits.statistics.cross_validation import constrained_space
from coeflab.fits.statistics.linear_model import LinearFit, fit_linear
from coeflab.fits.statistics.remainder import Block, Remainder, judged, left_out
from coeflab.law.domain import Domain, Extrapolation
from coeflab.law.symbols import COMPONENTS, LINEAR, MOMENTS, MOTIONS
from coeflab.law.terms import Term, design
from coeflab.law.transforms import incidence, wind_errors, wind_forces
from coeflab.tables.force_table import ForceTable

ANGLES = ("alpha", "beta")
WIND = ("C_D", "C_S", "C_L")
MOMENT_COEFFICIENTS = {"C_l": "K", "C_m": "M", "C_n": "N"}
RESPONSES = (*COMPONENTS, *WIND, *MOMENT_COEFFICIENTS)


@dataclass(frozen=True, slots=True)
class Area:
    """What a force coefficient is divided by: 1/2 rho V^2 ``area``, moments with ``length`` too.

    Attributes
    ----------
    area : float
        m^2.
    name : str
        Frontal, wetted, projected, volume^(2/3), or L^2 for primes.
    length : float
        m.
    """

    area: float
    name: str
    length: float


@dataclass(frozen=True, slots=True, eq=False)
class Rows:
    """Rows of a regression.

    Attributes
    ----------
    x : mapping of variable to (n,) array
        ``alpha``, ``beta`` and controls in radians, ``v w p q r`` primed.
    y : (n,) array
    errors : (n,) array or None
        Standard errors of y, where every row has one.
    labels : tuple of str
    response : str
    tables : tuple of str
    campaign, body : str
    set_aside : SetAside or None
        Printed rows that are rejected or doubtful.
    rounding : (n,) array or None
        Standard errors of y by its last printed digit, zero where it has all; None where every row has.
    """

    x: Mapping[str, Array]
    y: Array
    errors: Array | None
    labels: tuple[str, ...]
    response: str
    tables: tuple[str, ...]
    campaign: str
    body: str
    set_aside: SetAside | None = None
    rounding: Array | None = None


def variable(table: ForceTable, name: str, length: float) -> Array:
    """A motion variable of a table, shape (n,).

    Raises
    ------
    InputError
        Unknown variable.
    """
    if name in ANGLES:
        u, v, w = (np.asarray(table.motion[m]) for m in LINEAR)
        return incidence(u, v, w)[ANGLES.index(name)]
    if name in table.controls or name in MOTIONS:
        return table.primed_motion(name, length)
    if name in ("dr", "ds", "db"):
        return np.zeros(len(table))
    raise input_error(
        "fits.several_controls", column="variables", name=shown(name), names=", ".join((*ANGLES, *MOTIONS))
    )


def response(table: ForceTable, name: str, area: Area) -> tuple[Array, Array | None, NDArray[np.bool_]]:
    """A response of a table: values, standard errors if known, and which rows may be used.

    ``X .. N`` and ``C_l C_m C_n`` come from their own column; ``C_D C_S C_L`` need X, Y and Z, of which a missing one
    counts as zero only where its direction does not matter (no drift: Y; no attack: Z).

    Raises
    ------
    InputError
        The table lacks a component, or the response is unknown.
    """
    q = 0.5 * table.water_density * table.speed**2 * area.area
    component = MOMENT_COEFFICIENTS.get(name, name)
    if component in COMPONENTS:
        if component not in table.forces:
            raise InputError(f"no {component} in {table.name}", f"a column {component}", column="responses")
        scale = q * area.length if component in MOMENTS else q
        errors = table.errors[component] / scale if component in table.errors else None
        return table.forces[component] / scale, errors, np.array(table.usable[component])
    if name not in WIND:
        raise InputError(f"the response {shown(name)}", f"one of {', '.join(RESPONSES)}", column="responses")
    alpha, beta = (variable(table, a, 1.0) for a in ANGLES)
    needed = {"X": np.ones(len(table), dtype=bool), "Y": beta != 0.0, "Z": alpha != 0.0}
    if name == "C_S":
        needed["Y"] = np.ones(len(table), dtype=bool)
    if name == "C_L":
        needed["Z"], needed["X"], needed["Y"] = needed["X"], alpha != 0.0, np.zeros(len(table), dtype=bool)
    usable = np.ones(len(table), dtype=bool)
    forces, stated = [], []
    for c in ("X", "Y", "Z"):
        stated.append(np.where(needed[c], table.errors.get(c, np.full(len(table), np.nan)), 0.0))
        if c in table.forces:
            usable &= table.usable[c] | ~needed[c]
            forces.append(np.where(table.usable[c], table.forces[c], 0.0))
        elif np.any(needed[c]):
            raise InputError(f"no {c} in {table.name}", f"a column {c}, which {name} needs", column="responses")
        else:
            forces.append(np.zeros(len(table)))
    error = wind_errors(alpha, beta, *stated)[WIND.index(name)] / q
    known = bool(np.all(error[usable] > 0.0))
    return wind_forces(alpha, beta, *forces)[WIND.index(name)] / q, error if known else None, usable


def collect(tables: Sequence[ForceTable], variables: Sequence[str], name: str, area: Area) -> Rows:
    """Rows of all tables that have a response.

    Raises
    ------
    InputError
        No table has it, or no row is usable.
    """
    xs: dict[str, list[Array]] = {v: [] for v in variables}
    ys: list[Array] = []
    errors, rounding = list[Array | None](), list[Array | None]()
    labels: list[str] = []
    names: list[str] = []
    set_aside: list[SetAside] = []
    for table in tables:
        component = MOMENT_COEFFICIENTS.get(name, name)
        if component in COMPONENTS and component not in table.forces:
            continue
        y, error, usable = response(table, name, area)
        for v in variables:
            xs[v].append(variable(table, v, area.length)[usable])
        ys.append(y[usable])
        _, digits, _ = response(replace(table, errors=table.digits), name, area)
        for known, own in ((errors, error), (rounding, digits)):
            known.append(None if own is None else own[usable])
        labels += [t for t, u in zip(table.labels, usable, strict=True) if u]
        names.append(table.name)
        set_aside += [] if not table.exclusions else [_set_aside_rows(table, variables, name, area, usable)]
    if not ys or not sum(map(len, ys)):
        raise InputError(f"no usable rows for {name}", "a table with that component", column="responses")
    return Rows(
        x={v: np.concatenate(parts) for v, parts in xs.items()},
        y=np.concatenate(ys),
        errors=all_known(errors),
        labels=tuple(labels),
        response=name,
        tables=tuple(names),
        campaign=tables[0].campaign,
        body=tables[0].body,
        set_aside=joined(set_aside),
        rounding=all_digits(rounding, ys),
    )


def all_digits(parts: Sequence[Array | None], readings: Sequence[Array]) -> Array | None:
    """Errors by the last digit of the readings of several tables; zero for a table of full precision, None where all are."""
    known = [np.zeros(len(y)) if p is None else p for p, y in zip(parts, readings, strict=True)]
    return np.concatenate(known) if any(p is not None for p in parts) else None


def all_known(parts: Sequence[Array | None]) -> Array | None:
    """Errors of the rows of several tables as one array; None where a table has none."""
    known = [p for p in parts if p is not None]
    return np.concatenate(known) if len(known) == len(parts) else None


def _set_aside_rows(
    table: ForceTable, variables: Sequence[str], name: str, area: Area, used: NDArray[np.bool_]
) -> SetAside:
    """Printed rows of a table that no fit may use."""
    y, _, printed = response(readmitted(table), name, area)
    rows = printed & ~used
    labels = tuple(t for t, k in zip(table.labels, rows, strict=True) if k)
    return SetAside({v: variable(table, v, area.length)[rows] for v in variables}, y[rows], labels)


def model_of(
    rows: Rows,
    terms: tuple[Term, ...],
    symbols: tuple[str, ...],
    form: str,
    *,
    unit: str = "1",
    rule: Extrapolation = Extrapolation.REFUSE,
    constraint: tuple[Array, Array] | None = None,
    weighted: bool = True,
    post_selection: bool = False,
    lines: bool = False,
) -> FittedModel:
    """Fit one response by a list of terms.

    Raises
    ------
    InputError
        More terms than points, a term that is zero on all rows, or a constraint that cannot hold.
    """
    matrix = design(terms, rows.x)
    free = len(terms) - (0 if constraint is None else len(constraint[1]))
    empty = [s for s, column in zip(symbols, matrix.T, strict=True) if not np.any(column)]
    if empty:
        raise input_error("fits.zero_on_every_row_2", column=form, empty=", ".join(empty))
    if len(rows.y) <= free:
        raise TooFewRowsError.for_terms(rows.response, rows.labels, free, form)
    try:
        errors = rows.errors if weighted else None
        fit = fit_linear(matrix, rows.y, errors, constraint)
    except ValueError as why:
        raise InputError(str(why), "a constraint that some coefficients can meet", column=form) from None
    return FittedModel(
        response=rows.response,
        unit=unit,
        form=form,
        symbols=symbols,
        terms=terms,
        fit=fit,
        domain=Domain.of(rows.x, rule, terms),
        table=", ".join(rows.tables),
        campaign=rows.campaign,
        body=rows.body,
        x=rows.x,
        y=rows.y,
        labels=rows.labels,
        statements=in_words(fit, symbols),
        post_selection=post_selection,
        set_aside=rows.set_aside,
        remainder=_remainder(fit, matrix, rows, terms, errors, constraint, lines=lines),
        rounding=rounding_of(matrix, rows, fit, errors, constrained_space(constraint, len(terms))[1]),
    )


def rounding_of(matrix: Array, rows: Rows, fit: LinearFit, errors: Array | None, free: Array) -> Array | None:
    """(p,) 95 % half-widths by the last printed digit, None where that is not known; ``free`` (p, q) spans what a constraint leaves."""
    if rows.rounding is None:
        return None
    root = np.ones(len(rows.y)) if errors is None else 1.0 / errors
    by_row = free @ np.linalg.pinv((matrix @ free) * root[:, None]) * root
    noise = fit.rms * np.sqrt(len(rows.y) / max(len(rows.y) - fit.rank, 1))
    return printed_digits.half_width(by_row, rows.rounding, noise)


def _remainder(
    fit: LinearFit,
    matrix: Array,
    rows: Rows,
    terms: tuple[Term, ...],
    errors: Array | None,
    constraint: tuple[Array, Array] | None,
    *,
    lines: bool,
) -> Remainder | None:
    """What the form leaves out; None where the residuals are rounding."""
    if fit.rms <= ROUNDING * float(np.max(np.abs(rows.y), initial=0.0)):
        return None
    covariance, found = left_out(matrix, fit.residuals, errors, constraint, (Block(slice(None), terms, rows.x, lines),))
    return judged(covariance, *found[0], fit.coefficients, fit.half_width)
