"""What analysts would have said: forms of a force curve near the origin, each by plain least squares in growing windows.

They show how far single forms disagree; none of them is recommended. That is `coeflab.fits.statistics.origin_slope`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from coeflab.core.types import Array, brief
from coeflab.fits.statistics.diagnostics import lack_of_fit, levels
from coeflab.fits.statistics.least_squares import Index, aicc, factorise, solve
from coeflab.fits.statistics.linear_model import bell_mccaffrey, hc_variance, t_factor

TERMS: dict[str, Callable[[Array], Array]] = {
    "1": np.ones_like,
    "x": lambda x: x,
    "x2": lambda x: x**2,
    "x3": lambda x: x**3,
    "x4": lambda x: x**4,
    "x5": lambda x: x**5,
    "x|x|": lambda x: x * np.abs(x),
    "|x|3": lambda x: np.abs(x) ** 3,
}


@brief
@dataclass(frozen=True, slots=True)
class Family:
    """One form of the curve.

    Attributes
    ----------
    name : str
        As printed; ``{x}`` stands for the motion variable.
    terms : tuple of str
        Keys of `TERMS`.
    """

    name: str
    terms: tuple[str, ...]


ODD = (
    Family("line", ("1", "x")),
    Family("{x} + {x}^3", ("1", "x", "x3")),
    Family("{x} + {x}^3 + {x}^5", ("1", "x", "x3", "x5")),
    Family("{x} + {x}|{x}|", ("1", "x", "x|x|")),
)
EVEN = (
    Family("{x}^2", ("1", "x2")),
    Family("{x}^2 + {x}^4", ("1", "x2", "x4")),
    Family("{x}^2 + |{x}|^3", ("1", "x2", "|x|3")),
)
SAME_LEVEL = 0.02


def design(terms: tuple[str, ...], x: Array) -> Array:
    """Design matrix (n, p) of the named terms."""
    return np.column_stack([TERMS[t](x) for t in terms])


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Estimate:
    """One family in one window.

    Attributes
    ----------
    family : Family
    window : float
        Largest |x| used.
    rows : (n,) integer array
        Rows used.
    value, half_hc2, half_hc3 : float
        Target and its 95 % half-widths: HC2 with Bell-McCaffrey degrees of freedom, HC3 with n - p.
    freedom : float
        Bell-McCaffrey degrees of freedom.
    aicc, lack_of_fit : float
        Criterion; probability of a larger misfit, NaN where not computable.
    """

    family: Family
    window: float
    rows: Index
    value: float
    freedom: float
    half_hc2: float
    half_hc3: float
    aicc: float
    lack_of_fit: float


def estimate(family: Family, target: str, x: Array, y: Array, se: Array | None, rows: Index) -> Estimate | None:
    """Fit one family to some rows; None where they do not determine it with a degree of freedom to spare."""
    terms = family.terms
    xs, scale = x[rows], float(np.max(np.abs(x[rows]), initial=0.0)) or 1.0
    if len(rows) <= len(terms) or len(np.unique(np.round(xs / scale, 6))) < len(terms):
        return None
    f = factorise(design(terms, xs), None if se is None else se[rows] ** -2.0)
    if f.rank < len(terms):
        return None
    coefficients, residuals = solve(f, y[rows])
    at = terms.index(target)
    freedom = float(bell_mccaffrey(f)[at])
    normed = residuals if se is None else residuals / (f.root_weights * se[rows])
    return Estimate(
        family=family,
        window=scale if np.any(xs) else 0.0,
        rows=rows,
        value=float(coefficients[at]),
        freedom=freedom,
        half_hc2=float(np.sqrt(hc_variance(f, residuals, 2)[at]) * t_factor(freedom)),
        half_hc3=float(np.sqrt(hc_variance(f, residuals, 3)[at])) * float(t_factor(f.freedom)),
        aicc=float(aicc(f, residuals)),
        lack_of_fit=lack_of_fit(f, normed, xs, 1e-6 * scale, se is not None),
    )


def is_one_sided(x: Array) -> bool:
    """True when all non-zero settings lie on one side."""
    return not (np.any(x > 0) and np.any(x < 0))


def windows(x: Array, largest: float) -> list[tuple[float, Index]]:
    """Growing windows: (largest |x| of the level, row indices).

    A level belongs to a window when its mean does, within 2 %: nominal 4 degrees means 3.93 to 4.11.
    """
    level, size = levels(x), np.abs(x)
    out = []
    for k in range(int(level.max(initial=-1)) + 1):
        middle = float(size[level == k].mean())
        if middle == 0.0 or middle > largest * (1.0 + SAME_LEVEL):
            continue
        rows = np.flatnonzero(level <= k)
        out.append((float(size[rows].max()), rows))
    return out
