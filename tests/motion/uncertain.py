"""The tests' torpedo with uncertainties; all synthetic."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.parameter_parts import ParameterCovariance
from tests.formats.massed import torpedo

RELATIVE = {"X0'": 0.05, "Yv'": 0.1, "Yr'": 0.1, "Nv'": 0.2, "Nr'": 0.1, "Ydr'": 0.1, "Ndr'": 0.1, "Zw'": 0.1}
CORRELATION = {("Ydr'", "Ndr'"): -0.6, ("Yv'", "Nv'"): 0.3}


def with_uncertainty(
    file: ParameterFile, u95: Mapping[str, float], correlation: Mapping[tuple[str, str], float]
) -> ParameterFile:
    """The file with U95 and a covariance of exactly these; every other coefficient has neither."""
    coefficients = tuple(replace(c, u95=u95.get(c.symbol)) for c in file.coefficients)
    symbols = tuple(c.symbol for c in coefficients)
    matrix = np.full((len(symbols),) * 2, np.nan)
    known = [i for i, s in enumerate(symbols) if s in u95]
    matrix[np.ix_(known, known)] = 0.0
    for i in known:
        matrix[i, i] = (u95[symbols[i]] / 2.0) ** 2
    for (a, b), r in correlation.items():
        i, j = symbols.index(a), symbols.index(b)
        matrix[i, j] = matrix[j, i] = r * np.sqrt(matrix[i, i] * matrix[j, j])
    rows = tuple(tuple(None if np.isnan(v) else float(v) for v in row) for row in matrix)
    covariance = ParameterCovariance(symbols=symbols, matrix=rows)
    return file.model_copy(update={"coefficients": coefficients, "covariance": covariance})


def uncertain_torpedo(
    relative: Mapping[str, float] = RELATIVE, correlation: Mapping[tuple[str, str], float] = CORRELATION
) -> ParameterFile:
    """U95 as parts of the values, two pairs correlated."""
    file = torpedo()
    values = {c.symbol: abs(c.value or 0.0) for c in file.coefficients}
    return with_uncertainty(file, {s: r * values[s] for s, r in relative.items()}, correlation)
