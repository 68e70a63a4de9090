"""Slope (or curvature) at the origin: families of estimators, a sweep of windows, one recommended value.

The recommendation never sees a reference value. Per family the window grows until the next term of the same parity
becomes significant; the last window before is kept. The members are the families' kept fits; the value is their
median, and their spread is the model-form part of the uncertainty.

Forms of a force curve near the origin, and their design matrices.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from coeflab.core.types import Array, brief
from coeflab.fits.statistics.diagnostics import lack_of_fit, levels
from coeflab.fits.statistics.least_squares import Factorised, Index, aicc, factorise, solve
from coeflab.fits.statistics.linear_model import FULL_LEVERAGE, bell_mccaffrey, hc_variance, t_factor, t_probability

TERMS: dict[str, Callable[[Array], Array]] = {
    "1": np.ones_like,
    "x": lambda x: x,
    "x2": lambda x: x**2,
    "x3": lambda x: x**3,
    "x4": lambda x: x**4,
    "x5": lambda x: x**5,
    "x6": lambda x: x**6,
    "x7": lambda x: x**7,
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
    nuisance : tuple of str
        Terms of the other parity, dropped where the sweep is one-sided and cannot tell them apart.
    next_term : str
        The term whose significance ends the growth of the window.
    must_beat : str
        Name of the family that this one must beat by 2 in AICc, or empty.
    """

    name: str
    terms: tuple[str, ...]
    nuisance: tuple[str, ...]
    next_term: str
    must_beat: str = ""


ODD = (
    Family("line", ("1", "x"), ("x2",), "x3"),
    Family("{x} + {x}^3", ("1", "x", "x3"), ("x2",), "x5"),
    Family("{x} + {x}^3 + {x}^5", ("1", "x", "x3", "x5"), ("x2",), "x7"),
    Family("{x} + {x}|{x}|", ("1", "x", "x|x|"), ("x2",), "x3", must_beat="{x} + {x}^3"),
)
EVEN = (
    Family("{x}^2", ("1", "x2"), ("x",), "x4"),
    Family("{x}^2 + {x}^4", ("1", "x2", "x4"), ("x", "x3"), "x6"),
    Family("{x}^2 + |{x}|^3", ("1", "x2", "|x|3"), ("x",), "x4", must_beat="{x}^2 + {x}^4"),
)


def design(terms: tuple[str, ...], x: Array) -> Array:
    """Design matrix (n, p) of the named terms."""
    return np.column_stack([TERMS[t](x) for t in terms])


SIGNIFICANCE = 0.05
AICC_MARGIN = 2.0
WIDEST = 3.0
SAME_LEVEL = 0.02
ROUNDING = 1e-13
MEMBER = "member"
TOO_WIDE = "interval over three times the narrowest"
NO_INTERVAL = "no interval: a single point carries it"


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Estimate:
    """One family in one window.

    Attributes
    ----------
    family : Family
    terms : tuple of str
        Terms fitted, target and nuisance.
    window : float
        Largest |x| used.
    rows : (n,) integer array
        Rows used.
    coefficients : (p,) array
    value, half_hc2, half_hc3 : float
        Target and its 95 % half-widths: HC2 with Bell-McCaffrey degrees of freedom, HC3 with n - p.
    standard_error, freedom : float
        HC2 standard error and its Bell-McCaffrey degrees of freedom.
    aicc, lack_of_fit, next_term : float
        Criterion; probability of a larger misfit; probability of a larger next term. NaN where not computable.
    role : str
        ``member``, or why not.
    factorised : Factorised
    residuals : (n,) array
        Weighted residuals.
    target : int
        Index of the target among the terms.
    """

    family: Family
    terms: tuple[str, ...]
    window: float
    rows: Index
    coefficients: Array
    value: float
    standard_error: float
    freedom: float
    half_hc2: float
    half_hc3: float
    aicc: float
    lack_of_fit: float
    next_term: float
    role: str
    factorised: Factorised
    residuals: Array
    target: int

    def curve(self, x: Array) -> Array:
        """The fitted curve at ``x``."""
        return design(self.terms, x) @ self.coefficients


@brief
@dataclass(frozen=True, slots=True)
class Recommendation:
    """The rule's answer; ``value`` is None where no family could be fitted, ``u95`` where only one could."""

    value: float | None
    random: float | None
    model_form: float | None
    u95: float | None
    members: tuple[Estimate, ...]
    panel: tuple[Estimate, ...]


def estimate(
    family: Family, terms: tuple[str, ...], target: str, x: Array, y: Array, se: Array | None, rows: Index
) -> Estimate | None:
    """Fit one family to some rows; None where they do not determine it with a degree of freedom to spare."""
    xs, scale = x[rows], float(np.max(np.abs(x[rows]), initial=0.0)) or 1.0
    if len(rows) <= len(terms) or len(np.unique(np.round(xs / scale, 6))) < len(terms):
        return None
    f = factorise(design(terms, xs), None if se is None else se[rows] ** -2.0)
    if f.rank < len(terms):
        return None
    coefficients, residuals = solve(f, y[rows])
    at = terms.index(target)
    error = float(np.sqrt(hc_variance(f, residuals, 2)[at]))
    freedom = float(bell_mccaffrey(f)[at])
    normed = residuals if se is None else residuals / (f.root_weights * se[rows])
    return Estimate(
        family=family,
        terms=terms,
        window=scale if np.any(xs) else 0.0,
        rows=rows,
        coefficients=coefficients,
        value=float(coefficients[at]),
        standard_error=error,
        freedom=freedom,
        half_hc2=error * float(t_factor(freedom)),
        half_hc3=float(np.sqrt(hc_variance(f, residuals, 3)[at])) * float(t_factor(f.freedom)),
        aicc=float(aicc(f, residuals)),
        lack_of_fit=lack_of_fit(f, normed, xs, 1e-6 * scale, se is not None),
        next_term=float("nan"),
        role="",
        factorised=f,
        residuals=residuals,
        target=at,
    )


def next_term_probability(terms: tuple[str, ...], extra: str, x: Array, y: Array, se: Array | None) -> float:
    """Probability, by the HC3 t-test with n - p degrees of freedom, of a larger next term; NaN if not testable.

    One where the narrower form leaves nothing but rounding, which would pass for a significant term by chance.
    """
    wider = (*terms, extra)
    if len(x) < len(wider) + 2:
        return float("nan")
    f = factorise(design(wider, x), None if se is None else se**-2.0)
    if f.rank < len(wider):
        return float("nan")
    coefficients, residuals = solve(f, y)
    unexplained = np.hypot(np.linalg.norm(residuals), coefficients[-1] / np.linalg.norm(f.estimator[-1]))
    if unexplained <= ROUNDING * np.linalg.norm(f.root_weights * y):
        return 1.0
    error = float(np.sqrt(hc_variance(f, residuals, 3)[-1]))
    if error == 0.0:
        return 0.0
    return float(t_probability(coefficients[-1] / error, f.freedom))


def is_one_sided(x: Array) -> bool:
    """True when all non-zero settings lie on one side."""
    return not (np.any(x > 0) and np.any(x < 0))


def windows(x: Array, smallest: float, largest: float) -> list[tuple[float, Index]]:
    """Growing windows: (largest |x| of the level, row indices), from the first level at or beyond ``smallest``.

    A level belongs to a window when its mean does, within 2 % at either end: nominal 4 degrees means 3.93 to 4.11.
    """
    level, size = levels(x), np.abs(x)
    out = []
    for k in range(int(level.max(initial=-1)) + 1):
        middle = float(size[level == k].mean())
        if middle == 0.0 or middle < smallest * (1.0 - SAME_LEVEL) or middle > largest * (1.0 + SAME_LEVEL):
            continue
        rows = np.flatnonzero(level <= k)
        out.append((float(size[rows].max()), rows))
    return out


def sweep_family(
    family: Family, target: str, x: Array, y: Array, se: Array | None, smallest: float, largest: float
) -> list[Estimate]:
    """All windows of one family, each with its next-term test; roles mark the kept window and why others are not."""
    nuisance = () if is_one_sided(x) else family.nuisance
    terms = family.terms + nuisance
    tried: list[Estimate] = []
    for _, rows in windows(x, smallest, largest):
        fitted = estimate(family, terms, target, x, y, se, rows)
        if fitted is not None:
            p = next_term_probability(terms, family.next_term, x[rows], y[rows], None if se is None else se[rows])
            tried.append(replace(fitted, next_term=p))
    significant = next((i for i, e in enumerate(tried) if e.next_term < SIGNIFICANCE), len(tried))
    tested = [i for i in range(significant) if np.isfinite(tried[i].next_term)]
    kept = max(tested) if tested else (len(tried) - 1 if significant == len(tried) else -1)
    return [
        replace(e, role=MEMBER if i == kept else "beyond the window" if i > kept else "smaller window")
        for i, e in enumerate(tried)
    ]


def recommend(
    x: Array,
    y: Array,
    se: Array | None = None,
    *,
    parity: str = "odd",
    target: str = "x",
    smallest: float = 0.0,
    largest: float = np.inf,
) -> Recommendation:
    """Recommended slope, curvature or intercept.

    U95 = hypot(median of the members' half-widths, 2 a / sqrt 3), with a the distance of the farthest member from the
    value: a rectangular distribution of half-width a about the value has the standard deviation a / sqrt 3. For members
    that lie symmetrically this is their range / sqrt 3. A lone member is compared with the families that were dropped
    only for their width; without any there is no model-form part and no U95.

    Parameters
    ----------
    x, y : (n,) array
        Motion variable and force, dimensionless.
    se : (n,) array, optional
        Standard errors of y; weights are their inverse squares.
    parity : {"odd", "even"}
        Families `ODD` or `EVEN`.
    target : str
        Term whose coefficient is wanted: ``x``, ``x2`` or ``1``.
    smallest, largest : float
        Limits of the windows in |x|.
    """
    panel: list[Estimate] = []
    kept: dict[str, Estimate] = {}
    for family in ODD if parity == "odd" else EVEN:
        for swept in sweep_family(family, target, x, y, se, smallest, largest):
            e = swept
            if e.role == MEMBER:
                if family.must_beat and not _beats(e, target, x, y, se):
                    e = replace(e, role="AICc does not prefer it")
                else:
                    kept[family.name] = e
            panel.append(e)
    finite = [e.half_hc2 for e in kept.values() if np.isfinite(e.half_hc2)]
    narrowest = min(finite) if finite else float("nan")
    members = tuple(e for e in kept.values() if e.half_hc2 <= WIDEST * narrowest)
    shown = tuple(
        replace(e, role=TOO_WIDE if np.isfinite(e.half_hc2) else NO_INTERVAL)
        if e.role == MEMBER and e not in members
        else e
        for e in panel
    )
    if not members:
        return Recommendation(None, None, None, None, (), shown)
    values = np.array([e.value for e in members])
    random = float(np.median([e.half_hc2 for e in members]))
    compared = values if len(members) > 1 else np.array([e.value for e in kept.values() if np.isfinite(e.half_hc2)])
    if len(compared) < 2:
        return Recommendation(float(values[0]), random, None, None, members, shown)
    value = float(np.median(values))
    form = float(2.0 * np.max(np.abs(compared - value)) / np.sqrt(3.0))
    return Recommendation(value, random, form, float(np.hypot(random, form)), members, shown)


def _beats(e: Estimate, target: str, x: Array, y: Array, se: Array | None) -> bool:
    """Whether an estimate has the lower AICc, by the margin, than its family's rival on the same rows."""
    rival = next(f for f in (ODD + EVEN) if f.name == e.family.must_beat)
    other = estimate(rival, rival.terms + e.terms[len(e.family.terms) :], target, x, y, se, e.rows)
    return other is None or e.aicc < other.aicc - AICC_MARGIN


def influence(members: tuple[Estimate, ...], n: int) -> Array:
    """How much every point's noise moves the median of the members, shape (n,).

    The HC2 covariance of two medians over the same rows is the scalar product of their influences.
    """
    order = np.argsort([e.value for e in members], kind="stable")
    out = np.zeros(n)
    for i in (order[(len(order) - 1) // 2], order[len(order) // 2]):
        e = members[int(i)]
        room = np.where(e.factorised.leverage < FULL_LEVERAGE, 1.0 - e.factorised.leverage, np.inf)
        out[e.rows] += 0.5 * e.factorised.estimator[e.target] * e.residuals / np.sqrt(room)
    return out
