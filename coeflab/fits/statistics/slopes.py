"""What analysts would have said: forms of a force curve near the origin, each by plain least squares in growing windows.

They show how far single forms disagree; none of them is recommended. That is `coeflab.fits.statistics.origin_slope`.

The even coefficients of that model, the force at rest and the curvature there, and how much each reading moves them.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from coeflab.core.types import Array, dataclass, remembered
from coeflab.fits.statistics import origin_slope, slope_mixture
from coeflab.fits.statistics.diagnostics import lack_of_fit, levels
from coeflab.fits.statistics.least_squares import Factorised, Index, aicc, factorise, solve
from coeflab.fits.statistics.many_rows import condensed_rows
from coeflab.fits.statistics.origin_slope import OriginSlope
from coeflab.fits.statistics.robust_errors import bell_mccaffrey, hc_variance, t_factor

NEAR_REST = 0.02  # of the largest setting: nearer rows say nothing of a curvature
NO_FLOOR = 1e-6  # relative standard error, so small that only the ratios of the rows count

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
UNSEEN = 0.1  # of the noise: a standard error by the last digit that adds less than 1 % to it
SAME_LEVEL = 0.02
# Of a peak; standard deviations, counted from `DENSE` settings of a side on, as fewer are farther apart than scatter; settings up to it.
FALLEN, SCATTERS, DENSE, FEWEST_BEFORE = 0.1, 7.0, 6, 3
STEEPER = 8.0  # a jump, than any step before
RESOLVED, WIDEST_GAP = (
    5.0,
    3.0,
)  # of a jump over the smallest difference of two readings; of its settings over those before


def design(terms: tuple[str, ...], x: Array) -> Array:
    """Design matrix (n, p) of the named terms."""
    return np.column_stack([TERMS[t](x) for t in terms])


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
    f, freedoms = _factorised(terms, xs, None if se is None else se[rows] ** -2.0)
    if f.rank < len(terms):
        return None
    coefficients, residuals = solve(f, y[rows])
    at = terms.index(target)
    freedom = float(freedoms[at])
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


@remembered(64)  # the components of a sweep share their settings
def _factorised(terms: tuple[str, ...], x: Array, weights: Array | None) -> tuple[Factorised, Array]:
    f = factorise(design(terms, x), weights)
    return f, bell_mccaffrey(f)


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


def before_stall(x: Array, y: Array) -> tuple[float, float]:
    """The settings below and above zero, (low, high), beyond which a force across the flow falls again; infinite where it does not.

    The means of the settings of a side rise to their first peak of a third of the largest; later they fall from it by `FALLEN`, and by
    more than scatter, before any is higher.

    Parameters
    ----------
    x, y : (n,) arrays
        Setting and force.

    Examples
    --------
    >>> before_stall(np.array([-10.0, -5.0, 0.0, 5.0, 10.0, 15.0, 20.0]), np.array([-1.0, -0.5, 0.0, 0.5, 1.0, 1.2, 0.7]))
    (-inf, 15.0)
    """
    if not len(x):
        return -np.inf, np.inf
    ends = []
    middle = float(np.median(y[np.abs(x) <= np.min(np.abs(x)) + 1e-9]))
    for side in (-1.0, 1.0):
        at, group = np.unique(np.round(side * x[side * x > 0.0], 6), return_inverse=True)
        size = np.abs(np.bincount(group, y[side * x > 0.0]) / np.bincount(group) - middle)
        bent = np.diff(size, 2)
        noise = SCATTERS * 1.4826 * float(np.median(np.abs(bent))) / np.sqrt(6.0) if len(size) >= DENSE else 0.0
        highest = np.maximum.accumulate(size)
        fallen = (highest - size > np.maximum(FALLEN * highest, noise)) & (highest > size.max(initial=0.0) / 3.0)
        fallen &= np.append(fallen[1:], True)  # one low setting before higher ones is a bad row, no stall
        peak = int(np.argmax(size[: int(np.argmax(fallen)) + 1])) if np.any(fallen) else 0
        ends.append(side * (float(at[peak]) if peak >= FEWEST_BEFORE - 1 else np.inf))
    return ends[0], ends[1]


def before_jump(x: Array, y: Array) -> tuple[float, float]:
    """The settings below and above zero, (low, high), beyond which a reading is another one and stays so; infinite where there is none.

    From one setting of a side to the next it moves by over half of all that it moved before, `STEEPER` times as steeply as anywhere
    before; of the settings beyond, two or more, none comes back half-way. A move of a few units of the last digit is none, nor is one
    across a gap of the settings.

    Examples
    --------
    >>> before_jump(np.array([0.0, 2.0, 4.0, 6.0, 8.0, 9.0, 10.0]), np.array([0.0, 0.1, 0.2, 0.3, 0.4, 0.0, 0.0]))
    (-inf, inf)
    >>> before_jump(np.array([0.0, 2.0, 4.0, 6.0, 8.0, 8.2, 8.4]), np.array([0.0, 0.1, 0.2, 0.3, 0.4, -0.4, -0.4]))
    (-inf, 8.0)
    """
    ends, unit = [], np.min(np.diff(np.unique(y)), initial=np.inf)
    for side in (-1.0, 1.0):
        at, group = np.unique(np.round(side * x[side * x >= 0.0], 6), return_inverse=True)
        mean = np.bincount(group, y[side * x >= 0.0]) / np.bincount(group)
        end, steps = np.inf, np.diff(at)
        for i in range(FEWEST_BEFORE, len(at) - 2):
            move, before = mean[i + 1] - mean[i], mean[: i + 1]
            if abs(move) < RESOLVED * unit or steps[i] > WIDEST_GAP * np.max(steps[:i]):
                continue
            steepest = np.max(np.abs(np.diff(before) / np.diff(at[: i + 1])))
            beyond = (mean[i + 1 :] - mean[i]) * np.sign(move)
            if (
                abs(move) > max(0.5 * np.ptp(before), STEEPER * steepest * (at[i + 1] - at[i]))
                and np.min(beyond) > abs(move) / 2.0
            ):
                end = float(at[i])
                break
        ends.append(side * end)
    return ends[0], ends[1]


def by_row(slope: OriginSlope, term: int) -> Array:
    """How much each used reading moves a polynomial term of the mixture (0 at rest, 1 slope), at the present weights."""
    design, weights = slope.design, slope.weights
    if design is None:
        return np.zeros(0)
    out, start = np.zeros(len(design.x)), 0
    place = design.order.index(term)
    for m in design.members:
        own = weights[start : start + m.log_prior.size].reshape(m.rotations.triangle[-1][0].shape)
        start += m.log_prior.size
        column = np.stack([(own * v).sum((0, 1, 2)) for v in m.rotations.inverse_column(place)], 1)
        columns = m.root @ design.terms[:, design.order]
        out += np.einsum("jp,jnp,jnr->r", column, columns, m.root, optimize=True)
    return out / (design.largest if term else 1.0)


def determined(
    slope: OriginSlope, target: str, middle: float | None, rest: tuple[float, float], odd: bool = False
) -> tuple[float | None, float | None, Array]:
    """Value, U95 and what each used reading moves the value by.

    ``middle`` is the median stated standard error, ``rest`` the curve at zero with its half-width; ``odd`` says that the part
    over x of an even force is odd by declared symmetry.
    """
    if slope.design is None:
        return None, None, np.zeros(int(slope.used.sum()))
    if target == "x":
        return slope.value, slope.u95, by_row(slope, 1)
    at_rest, half = rest
    moved = by_row(slope, 0)
    if target == "1":
        return at_rest, half, moved
    x, y = slope.design.x, slope.y
    selected = np.flatnonzero(np.abs(x) > NEAR_REST * slope.design.largest)
    floor = middle or NO_FLOOR * float(np.abs(y - at_rest).max())
    error = floor * np.sqrt(slope.design.variance[selected]) / np.abs(x[selected])
    bent = origin_slope.estimate(x[selected], (y[selected] - at_rest) / x[selected], error, odd=odd)
    if bent.design is None:
        return None, None, np.zeros(len(x))
    out, selected = np.zeros(len(x)), selected[bent.used]
    out[selected] = by_row(bent, 1) / x[selected]
    felt = float(out.sum())
    return bent.value, float(np.hypot(bent.u95, felt * half)), out - felt * moved


def of_rows(
    x: Array, y: Array, se: Array | None, target: str, middle: float | None, plane: bool, odd: bool
) -> tuple[float | None, float | None]:
    """Value and U95 of some rows as `determined` has them."""
    o = origin_slope.estimate(x, y, se, odd=odd)
    mean, width = origin_slope.curve(o, np.zeros(1))
    return determined(o, target, middle, (float(mean[0]), float(width[0])), plane)[:2]


def by_digits(
    x: Array, y: Array, se: Array | None, digits: Array, target: str, noise: float, plane: bool, odd: bool, value: float, u95: float
) -> float:  # fmt: skip
    """What the last printed digit adds to a value and its U95, in quadrature.

    Digits that hide all scatter make a staircase, which passes for a curve without noise. So the model is asked again, with the rounding as
    the standard error that a reading has at least: U95 reaches as far as that answer and its own U95 do, in quadrature.

    Parameters
    ----------
    x, y, se : (n,) array
        Settings, readings, and stated standard errors or None.
    digits : (n,) array
        Standard errors by the last digit, that digit over the root of 12; zero of rows with all digits.
    target, plane, odd
        See `determined`.
    noise, value, u95 : float
        Found without it.
    """
    if np.max(digits, initial=0.0) <= UNSEEN * noise:
        return 0.0
    errors = np.hypot(np.maximum(digits, UNSEEN * digits.max()), 0.0 if se is None else se)
    other, own = of_rows(x, y, errors, target, float(np.median(errors)), plane, odd)
    if other is None or own is None:
        return 0.0
    return float(np.sqrt(max((other - value) ** 2 + own**2 - u95**2, 0.0)))


def of_all_rows(slope: OriginSlope, x: Array, y: Array, se: Array | None) -> OriginSlope:
    """The model with every row, wrong or not, as far as `determined` and `curve` ask for it."""
    design = slope_mixture.prepare(x, None if se is None else se**2 / float(np.median(se)) ** 2)
    weights = slope_mixture.estimate_many(design, y, deletions=False).weights[0]
    return replace(slope, design=design, y=y, weights=weights)


def rest_and_curvature(x: Array, y: Array) -> tuple[float | None, float | None]:
    """The force at rest and the curvature there of a sweep (n,), all rows used, of very many the means of their strips; None
    where a row is too few.
    """
    if (few := condensed_rows(x, y)) is not None:
        x, y = few.x, few.y
    origin = origin_slope.estimate(x, y)
    if origin.design is None:
        return None, None
    origin = of_all_rows(origin, x, y, None)
    mean, half = origin_slope.curve(origin, np.zeros(1))
    at_rest = float(mean[0]), float(half[0])
    return at_rest[0], determined(origin, "x2", None, at_rest)[0]


def by_largest(
    x: Array, y: Array, caps: Sequence[float], se: Array | None = None, *, odd: bool = False
) -> tuple[tuple[float, OriginSlope], ...]:
    """The slope had the sweep ended at each of ``caps`` (largest |x|)."""
    inside = [(c, np.abs(x) <= c * (1.0 + 1e-9)) for c in caps]
    return tuple((c, origin_slope.estimate(x[i], y[i], None if se is None else se[i], odd=odd)) for c, i in inside)
