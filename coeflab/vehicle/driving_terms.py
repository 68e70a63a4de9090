"""Fitted terms that would drive the motion which they should damp, and that the data do not tell from zero: zero is written.

What counts as driving is `coeflab.vehicle.plausible_damping.driving_terms`, the rule of ``coeflab params check``. The other terms of the
component move along their covariance, as least squares without the term would move them; half-widths stay, and that of the term
reaches as far as its interval did. A driving term that is told from zero stays as it is, and the check fails it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from coeflab.core.finding import Finding, Severity
from coeflab.law.symbols import derivative, primed
from coeflab.vehicle.parameter_parts import ParameterCovariance
from coeflab.vehicle.plausible_damping import driving_terms

if TYPE_CHECKING:
    from coeflab.core.types import Array
    from coeflab.law.coefficient import Coefficient
    from coeflab.vehicle.parameter_file import ParameterFile
    from coeflab.vehicle.parameter_model import ParameterModel


def without_driving_terms(p: ParameterFile, again: Callable[[ParameterFile], ParameterFile]) -> ParameterFile:
    """The file with zero for fitted terms that drive and are not told from zero.

    Parameters
    ----------
    p : ParameterFile
    again : callable
        Makes anew what hangs on the law: ranges, points.
    """
    for _ in p.coefficients:
        mine = [c for t in driving_terms(p) if (c := p.coefficient(t.symbol)) is not None and _is_open(c)]
        if not mine:
            return p
        p = again(_at_zero(p, mine[0]))
    return p


def _is_open(c: Coefficient) -> bool:
    return c.origin == "fit" and c.value is not None and c.u95 is not None and abs(c.value) <= c.u95


def moved_to_zero(values: Array, covariance: Array, at: int) -> Array:
    """(k,) values where one is set to zero, the others moved along their covariance (k, k); NaN in it is none.

    Examples
    --------
    >>> import numpy as np
    >>> moved_to_zero(np.array([0.5, -3.0]), np.array([[1.0, -0.8], [-0.8, 1.0]]), 0).tolist()
    [0.0, -2.6]
    """
    along = np.nan_to_num(covariance[at]) / covariance[at, at] if covariance[at, at] > 0.0 else np.zeros(len(values))
    out = values - along * values[at]
    out[at] = 0.0
    return np.asarray(out)


def _at_zero(p: ParameterFile, c: Coefficient) -> ParameterFile:
    value, u95, component = float(c.value or 0.0), float(c.u95 or 0.0), derivative(c.symbol).component
    alike = [
        k for k in p.coefficients
        if k.value is not None and derivative(k.symbol).component == component and k.campaign == c.campaign and k.origin == "fit"
    ]  # fmt: skip
    rows = [p.covariance.symbols.index(k.symbol) for k in alike]
    cells = np.array(p.covariance.matrix, dtype=float)
    values = moved_to_zero(np.array([k.value for k in alike], dtype=float), cells[np.ix_(rows, rows)], alike.index(c))
    moved = {k.symbol: float(v) for k, v in zip(alike, values, strict=True) if v != k.value}
    reach = u95 + abs(value)
    at = p.covariance.symbols.index(c.symbol)
    matrix = [list(row) for row in p.covariance.matrix]
    matrix[at][at] = (reach / 2.0) ** 2
    found = Finding.of(
        "law.driving_term_at_zero", f"{p.name} {primed(c.symbol)}", Severity.WARN, statistic=value, threshold=u95, u95=reach,
        moved=tuple(s for s in moved if s != c.symbol), moves="some" if len(moved) > 1 else "none", component=component,
    )  # fmt: skip
    return p.model_copy(
        update={
            "coefficients": tuple(_with_value(p, k, moved[k.symbol], reach if k is c else k.u95) if k.symbol in moved else k for k in p.coefficients),
            "covariance": ParameterCovariance(symbols=p.covariance.symbols, matrix=tuple(map(tuple, matrix))),
            "models": tuple(_model_at_zero(m, c.symbol.removesuffix("'")) for m in p.models),
            "findings": (*p.findings, found),
        }
    )  # fmt: skip


def _with_value(p: ParameterFile, c: Coefficient, value: float, u95: float | None) -> Coefficient:
    unit = p.scaling.unit(c.symbol, p.conditions.density, p.conditions.speed)
    return replace(c, value=value, u95=u95, value_si=value * unit)


def _model_at_zero(m: ParameterModel, symbol: str) -> ParameterModel:
    """The fitted table that holds the same term, moved alike."""
    names = [t.symbol.removesuffix("'") for t in m.terms]
    if symbol not in names or any(t.value is None for t in m.terms):
        return m
    at = names.index(symbol)
    own = m.terms[at]
    values = moved_to_zero(np.array([t.value for t in m.terms], dtype=float), np.array(m.covariance, dtype=float), at)
    reach = None if own.half_width_95 is None else own.half_width_95 + abs(float(own.value or 0.0))
    terms = [t.model_copy(update={"value": float(v)}) for t, v in zip(m.terms, values, strict=True)]
    terms[at] = terms[at].model_copy(update={"half_width_95": reach})
    matrix = [list(row) for row in m.covariance]
    matrix[at][at] = None if reach is None else (reach / 2.0) ** 2
    return m.model_copy(update={"terms": tuple(terms), "covariance": tuple(map(tuple, matrix))})
