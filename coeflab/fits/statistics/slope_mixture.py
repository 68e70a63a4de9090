"""The mixture of forms behind a calibrated slope at the origin: its members, their weights, slopes by it.

One model for the whole sweep, x divided by its largest size, t = x / max|x|:
``y = a + s t + e t^2 + q t|t| + c t^3 + g(t) + noise``. The slope s is free, and so is a unless the sweep is one-sided.
The sizes of the other terms and of the smooth remainder g are unknown, in units of the noise, on a logarithmic grid
from "nothing" to 1e5. g is one of several Gaussian processes: a power series, in t or in |t|; every power of |t| from
1.5 to 4; integrated white noise (Wahba 1990; Kimeldorf & Wahba 1970) whose curvature grows with |t|^p or starts at an
onset (stall, separation), odd or free to differ between the sides; or scatter that grows with |t| or has an onset.
Given the sizes all is closed form (Student). The slope is the mixture over the sizes, weighted by restricted marginal
likelihood to a power below one, because no member is the truth (Gruenwald & van Ommen 2017). A priori the decade of the
largest curved size is uniform, the others lie below it, v|v| and v^3 most often alike, so that opposed signs count.
No interval adapts to every truth (Low 1997): where noise can hide a cancellation, it is longer. One row may be wrong:
its deletion is a further member, by bordering, without a second fit.

The constants, the ends of the interval included, were chosen on simulated truths: random curves (signed powers, Gaussian
processes, kinks, onsets, saturation, even parts) and the families of ``tests/coverage``; none on a measured body.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import special

from coeflab.core.types import Array, remembered
from coeflab.fits.statistics.least_squares import Index
from coeflab.fits.statistics.many_rows import Strips

# Sizes in units of the noise; pairs and products with them are prior odds.
NOTHING = 0.1
SIZES = (NOTHING, 1.0, 1e1, 1e2, 1e3, 1e4, 1e5)
COARSE = (NOTHING, 1e1, 1e3, 1e5)
NUISANCE = ((NOTHING, 2.6), (3.0, 2.0), (1e2, 1.0), (1e4, 1.0))
REMAINDER = (3.0, 10.0, 30.0, 1e2, 1e3, 1e4, 1e5)
SCATTER, BEYOND, FAR = (3.0, 10.0), (10.0, 100.0, 1000.0), (0.4, 0.6)
NO_REMAINDER, NOTHING_CURVED, QUADRATIC_ODDS, ALIKE = 16.0, 6.0, 0.2, 6.0
ODD = {"series": 0.8, "powers": 1.0, "fractions": 5.0, "p0": 2.0, "p1": 1.5}
ODD |= dict.fromkeys(("on.25", "on.4", "on.55", "on.7", "on.85"), 2.0)
SIDES = {"series": 0.9, "p1": 0.6, "on.25": 0.4, "on.55": 0.4, "on.8": 0.4}
GROWING, SETTING, COMMON, LOOSE = 0.2, 0.2, 0.8, 0.15
# Power of the likelihood; tail left out at each end: at 1 % noise (of the largest force), per decade of noise, bounds.
POWER, TAIL, TAIL_PER_DECADE, TAILS = 0.63, 0.016, -0.0085, (0.01, 0.025)
# Prior probability that a row is wrong.
WRONG = 0.005
# Size, in units of the noise, of the constant of a curve that is odd by declaration: next to nothing.
PINNED = ((1e-4, 1.0),)
# Smallest noise (of the largest force), leverage that is rounding.
ROUNDING, WEIGHTLESS = 3e-8, 1e-10
# What a what-if may take out of the curve: then a term is at most a tenth of the noise, and there is no remainder.
PARTS = ("even", "v|v|", "cubic", "remainder")
DECAY, ORDERS, STATED_FREEDOM, MOST_LIKELY = 0.8, 16, 2.0, 100
NODES, WEIGHTS = np.polynomial.legendre.leggauss(8)
# Members kept for the quantiles of a mixture, steps of bisection, and where its distribution is tabulated.
KEPT = 256
HALVINGS = 22
TABLE = np.sin(0.5 * np.pi * np.linspace(-1.0, 1.0, 2001)[1:-1])


@dataclass(frozen=True, slots=True, eq=False)
class _Member:
    """One remainder, all its sizes (j) by all sizes of the polynomial terms (k); p columns, n rows."""

    name: str
    odd: bool
    sizes: Array
    root: Array  # (j, n, n) inverse Cholesky factor of noise + remainder
    columns: Array  # (j, p, n) whitened columns
    inverse: Array  # (j, k, p, p)
    precision: Array  # (k, p) of the polynomial terms
    log_prior: Array  # (j, k)
    log_det: Array  # (j, k)
    leverage: Array  # (j, k, n) diagonal of the residual projection
    slope_by_row: Array  # (j, k, n)
    checkable: Array  # (j, k, n)


@dataclass(frozen=True, slots=True, eq=False)
class Design:
    """Everything that depends on the settings alone; campaigns that share them share it.

    Attributes
    ----------
    x : (n,) array
        Regressor.
    largest : float
        Largest |x|.
    variance : (n,) array
        Noise variance of each row, relative.
    flat : int
        Columns without a prior.
    strips : Strips or None
        Of what the rows are means.
    """

    x: Array
    largest: float
    variance: Array
    flat: int
    settings: Index
    terms: Array
    members: tuple[_Member, ...]
    strips: Strips | None = None


@dataclass(frozen=True, slots=True, eq=False)
class Slopes:
    """Slopes of many campaigns at the same settings.

    Attributes
    ----------
    value, lower, upper, sd, noise : (b,) array
        Median, ends with the same tail beyond each, standard deviation, standard deviation of one reading.
    u95 : (b,) array
        What is printed: value +- u95 has the probability of [lower, upper], 1 - 2 tail, also where the mixture is skewed.
    mean : (b,) array
        Mean if no row is wrong, the like of ``without``.
    wrong : (b, n) array
        Probability that the row is wrong.
    without : (b, n) array
        Mean slope without the row; NaN where too few rows remain.
    """

    value: Array
    lower: Array
    upper: Array
    u95: Array
    sd: Array
    noise: Array
    mean: Array
    wrong: Array
    without: Array
    weights: Array


def _remainder(name: str, odd: bool, a: Array, b: Array) -> Array:
    """Covariance (len a, len b) of a remainder, one at |t| = 1."""
    u, sides = np.multiply.outer(a, b), np.multiply.outer(np.sign(a), np.sign(b))
    if name == "fractions":  # every power from 1.5 to 4 alike
        left, right = (np.abs(t)[:, None] ** (2.75 + 1.25 * NODES) for t in (a, b))
        return np.asarray(sides * ((0.5 * WEIGHTS * left) @ right.T))
    if name in ("series", "powers"):
        sign, first, step = (sides, 2, 1) if name == "powers" else (1.0, 3, 2 if odd else 1)
        terms = {k: DECAY**k for k in range(first, ORDERS, step)}
        total = sum(w * (np.abs(u) if name == "powers" else u) ** k for k, w in terms.items())
        return np.asarray(sign * total / sum(terms.values()))
    p, onset = (int(name[1:]), 0.0) if name[0] == "p" else (0, float(name[2:]))
    u, v = (np.maximum(np.abs(t) - onset, 0.0) / (1.0 - onset) for t in (a[:, None], b[None, :]))
    m, k = np.minimum(u, v), 2 * p + 1
    size = (u * v / k - (u + v) * m / (k + 1) + m * m / (k + 2)) * m**k / (1.0 / k - 2.0 / (k + 1) + 1.0 / (k + 2))
    return np.asarray(size * (sides if odd else sides > 0.0))


def _terms(t: Array, even: bool) -> Array:
    return np.stack([np.ones(len(t)), t, *([t * t] if even else []), t * np.abs(t), t**3], 1)


def _log_prior(remainder: Array | None, curved: Array, odds: float) -> Array:
    """(j, k): the decade of the largest size is uniform, "nothing" apart; within it v|v| and v^3 are most often alike."""
    sizes = np.broadcast_to(np.log10(curved), (1 if remainder is None else len(remainder), *curved.shape))
    if remainder is not None:
        sizes = np.concatenate([sizes, np.broadcast_to(np.log10(remainder)[:, None, None], (*sizes.shape[:2], 1))], 2)
    decade = np.clip(np.floor(sizes.max(2) + 0.01), -1.0, 5.0)
    weight = np.where(curved[:, 0] > NOTHING, QUADRATIC_ODDS, 1.0) * np.ones(decade.shape)
    weight[:, (curved[:, 0] > NOTHING) & (curved[:, 0] == curved[:, 1])] *= ALIKE
    for d in np.unique(decade):
        weight[decade == d] *= (NOTHING_CURVED if d < 0.0 else 1.0) / weight[decade == d].sum()
    return np.asarray(np.log(odds * weight))


def _covariance(name: str, odd: bool, to: Array | None, t: Array, strips: Strips | None) -> Array:
    """Of a remainder at ``to`` (the rows themselves without it) and at the rows."""
    nodes = t if strips is None else strips.nodes.ravel()
    found = _remainder(name, odd, nodes if to is None else to, nodes)
    if strips is None:
        return found
    return strips.mean(found, 1) if to is not None else strips.mean(strips.mean(found, 1), 0)


def _specifications(t: Array, even: bool, settings: Index, stated: bool, strips: Strips | None) -> list[Any]:
    same = settings[:, None] == settings[None, :]
    out = [("none", True, np.zeros(1), np.zeros((len(t), len(t))), NO_REMAINDER)]
    out += [(name, True, np.array(REMAINDER), _covariance(name, True, None, t, strips), w) for name, w in ODD.items()]
    out += [
        (name, False, np.array(REMAINDER), _covariance(name, False, None, t, strips), w)
        for name, w in SIDES.items()
        if even
    ]
    out += [(f"scatter beyond {c}", True, np.array(BEYOND), np.diag(np.abs(t) > c).astype(float), LOOSE) for c in FAR]
    out.append(("growing scatter", True, np.array(SCATTER), np.diag(t * t), GROWING))
    if same.sum() > len(t):
        out += [("scatter of settings", True, np.array(SCATTER), same.astype(float), SETTING)]
    if stated:
        out += [("common scatter", True, np.array(SCATTER), np.eye(len(t)), COMMON)]
    return out


@remembered(12)  # the components of a sweep share their settings
def prepare(
    x: Array,
    variance: Array | None = None,
    *,
    symmetric: bool = False,
    settings: Array | None = None,
    strips: Strips | None = None,
    odd: bool = False,
    without: tuple[str, ...] = (),
) -> Design:
    """Factorise a sweep.

    Parameters
    ----------
    x : (n,) array
    variance : (n,) array, optional
        Stated variance of each row; only its ratios count here.
    symmetric : bool
        No even part.
    settings : (n,) array, optional
        Rows of one label are replicates of one setting; equal x without it.
    strips : Strips, optional
        Rows are means over several settings.
    odd : bool
        The curve is odd by declaration: no constant, no even part, whichever sides have rows.
    without : tuple of str
        Of `PARTS`, for a what-if: the interval then covers no curve that has them.

    Returns
    -------
    Design
    """
    x = np.asarray(x, float)
    largest = float(np.abs(x).max())
    t, n = x / largest, len(x)
    strips = strips and strips.over(largest)
    ratios = np.ones(n) if variance is None else variance
    labels = np.unique(np.round(t, 9) if settings is None else settings, return_inverse=True)[1].astype(np.int64)
    one_sided = not t.min() < 0.0 < t.max()
    even = not symmetric and not one_sided and not odd and "even" not in without
    terms = _terms(t, even) if strips is None else strips.mean(_terms(strips.nodes.ravel(), even), 0)
    p = terms.shape[1]
    members = []
    specifications = _specifications(t, even, labels, variance is not None, strips)
    if "remainder" in without:
        specifications = [s for s in specifications if s[0] not in ODD and s[0] not in SIDES]
    total = sum(s[4] for s in specifications)
    for name, is_odd, sizes, kernel, odds in specifications:
        polynomial = SIZES if name == "none" else COARSE
        nuisance = PINNED if odd else NUISANCE if even or one_sided else ((np.inf, 1.0),)
        curved = [(NOTHING,) if part in without else polynomial for part in ("v|v|", "cubic")]
        grid = np.array(list(product(range(len(nuisance)), *curved)))
        first = np.array(nuisance)[grid[:, 0].astype(int)]
        precision = np.zeros((len(grid), p))
        if even or one_sided or odd:
            precision[:, 2 if even else 0] = first[:, 0] ** -2.0
        precision[:, -2:] = grid[:, 1:] ** -2.0
        log_prior = _log_prior(None if name == "none" else sizes, grid[:, 1:], odds / total)
        log_prior = log_prior + np.log(first[:, 1] / sum(w for _, w in nuisance))
        factor = np.linalg.cholesky(np.diag(ratios) + sizes[:, None, None] ** 2 * kernel)
        root = np.linalg.solve(factor, np.broadcast_to(np.eye(n), factor.shape))
        a = root @ terms
        prior = precision[:, :, None] * np.eye(p)
        normal = (np.swapaxes(a, 1, 2) @ a)[:, None] + prior
        scales = 1.0 / np.sqrt(np.einsum("jkpp->jkp", normal))
        both = scales[..., :, None] * scales[..., None, :]
        inverse = both * np.linalg.inv(both * normal)
        c = inverse @ (np.swapaxes(a, 1, 2) @ root)[:, None]
        a4 = a[:, None]
        c += inverse @ (np.swapaxes(a4, 2, 3) @ (root[:, None] - a4 @ c) - prior @ c)
        left = root[:, None] - a4 @ c
        leverage = (left * left).sum(2) + np.einsum("jkpn,kp->jkn", c * c, precision)
        scale = np.where(precision > 0.0, -np.log(np.where(precision > 0.0, precision, 1.0)), 0.0).sum(1)
        scale = scale - 2.0 * np.log(scales).sum(2)
        log_det = (
            2.0 * np.log(np.einsum("jii->ji", factor)).sum(1)[:, None] + scale + np.linalg.slogdet(both * normal)[1]
        )
        members.append(
            _Member(
                name, is_odd, sizes, root, np.ascontiguousarray(np.swapaxes(a, 1, 2)), inverse, precision, log_prior,
                log_det, leverage, c[:, :, 1], leverage > WEIGHTLESS * (root * root).sum(1)[:, None],
            )
        )  # fmt: skip
    return Design(x, largest, ratios, 1 if one_sided or odd else 2, labels, terms, tuple(members), strips)


def _log_density(freedom: float) -> float:
    return float(special.gammaln(freedom / 2.0) - freedom / 2.0 * np.log(np.pi))


def _evaluate(
    m: _Member, start: Array, rest: Array, nu: float, floor: Array, least: Array, deletions: bool
) -> tuple[list[Array], list[Array]]:
    """Log weight, slope, its variance, noise variance (jk, b); the first three again without each row (j, b, n)."""
    b = len(start)
    whitened, across = np.swapaxes(m.root @ rest.T, 1, 2)[:, None], np.swapaxes(m.columns, 1, 2)[:, None]
    precision = m.precision[:, None]
    d = (whitened @ across - start * precision) @ m.inverse
    left = whitened - d @ m.columns[:, None]
    d += (left @ across - (start + d) * precision) @ m.inverse  # without this sizes of 1e5 leave six digits
    left, terms = whitened - d @ m.columns[:, None], start + d
    squares = (left * left).sum(-1) + (terms * terms * precision).sum(-1) + floor
    mean, unit_variance = terms[..., 1], m.inverse[:, :, 1, 1]
    likelihood = _log_density(nu) - 0.5 * m.log_det[..., None] - 0.5 * nu * np.log(squares)
    weight, variance = m.log_prior[..., None] + POWER * likelihood, np.maximum(squares / nu, least)
    main = [z.reshape(-1, b) for z in (weight, mean, variance * unit_variance[..., None], variance)]
    if not deletions:
        return main, []
    error = left @ m.root[:, None]
    step = error / m.leverage[:, :, None]
    after = np.maximum(squares[..., None] - error * step, floor[:, None])
    likelihood = _log_density(nu - 1.0) - 0.5 * (m.log_det[..., None] + np.log(m.leverage))[:, :, None]
    weight = m.log_prior[..., None, None] + POWER * (likelihood - 0.5 * (nu - 1.0) * np.log(after))
    weight = np.where(m.checkable[:, :, None], weight, -np.inf)
    slope = mean[..., None] - m.slope_by_row[:, :, None] * step
    ratio = unit_variance[..., None] + m.slope_by_row**2 / m.leverage
    variance = np.maximum(after / (nu - 1.0), least[:, None]) * ratio[:, :, None]
    top = np.maximum(weight.max(1), -1e300)
    w = np.exp(weight - top[:, None])
    total = np.maximum(w.sum(1), 1e-300)
    centre = (w * slope).sum(1) / total
    spread = (w * (variance + (slope - centre[:, None]) ** 2)).sum(1) / total
    return main, [top + np.log(total), centre, spread]


def estimate_many(design: Design, y: Array, stated: float | None = None, *, deletions: bool = True) -> Slopes:
    """Slopes of many campaigns at one design.

    Parameters
    ----------
    design : Design
    y : (b, n) array
        Readings of each campaign.
    stated : float, optional
        Variance of a row of unit relative variance; scatter beyond it widens, scatter below it does not narrow.
    deletions : bool
        Let one row be wrong.

    Returns
    -------
    Slopes
    """
    y = np.atleast_2d(np.asarray(y, float))
    b, n = y.shape
    size = np.abs(y - np.median(y, axis=1, keepdims=True)).max(1)
    size = np.where(size > 0.0, size, 1.0)
    start = y / size[:, None] @ np.linalg.pinv(design.terms).T
    rest = y / size[:, None] - start @ design.terms.T
    nu = n - design.flat + (0.0 if stated is None else STATED_FREEDOM)
    floor = np.full(b, n * ROUNDING**2) + (0.0 if stated is None else STATED_FREEDOM * stated / size**2)
    least = np.zeros(b) if stated is None else stated / size**2
    deletions = deletions and n - design.flat >= 3

    parts = [_evaluate(m, start, rest, nu, floor, least, deletions) for m in design.members]
    main, gone = [p[0] for p in parts], [p[1] for p in parts]
    weight, mean, variance, noise = (np.concatenate(z).T for z in zip(*main))
    evidence = special.logsumexp(weight, axis=1)
    weights = special.softmax(weight, axis=1)
    noise, middle = np.sqrt((weights * noise).sum(1)), (weights * mean).sum(1)
    tail = np.clip(TAIL + TAIL_PER_DECADE * np.log10(100.0 * np.maximum(noise, ROUNDING)), *TAILS)
    scale, freedom = np.sqrt(variance), np.full(mean.shape, float(nu))
    wrong, without = np.zeros((b, n)), np.full((b, n), np.nan)
    if deletions:
        weight_i, mean_i, variance_i = (np.concatenate(z) for z in zip(*gone))
        each = special.logsumexp(weight_i, axis=0)
        odds = np.concatenate(
            [(evidence + n * np.log1p(-WRONG))[:, None], each + POWER * np.log(0.5) + np.log(WRONG)], 1
        )  # a wrong reading lies anywhere within the range
        odds -= special.logsumexp(odds, axis=1, keepdims=True)
        wrong = np.exp(odds[:, 1:])
        without = (np.exp(weight_i - each) * mean_i).sum(0) * (size / design.largest)[:, None]
        flat = [z.transpose(1, 0, 2).reshape(b, -1) for z in (weight_i - each + odds[:, 1:], mean_i, variance_i)]
        weight = np.concatenate([weight - evidence[:, None] + odds[:, :1], flat[0]], 1)
        mean, scale = np.concatenate([mean, flat[1]], 1), np.concatenate([scale, np.sqrt(flat[2])], 1)
        freedom = np.concatenate([freedom, np.full(flat[1].shape, nu - 1.0)], 1)
    ends, half, sd = mixture_quantiles(weight, mean, scale, freedom, tail)
    unit = size / design.largest
    low, value, high = ends.T * unit
    return Slopes(value, low, high, half * unit, sd * unit, noise * size, middle * unit, wrong, without, weights)


def joint(design: Design, y: Array, weights: Array, at: Array) -> tuple[Array, Array, Array]:
    """Mixture mean (1 + m) and covariance of the slope dy/dt and the curve at ``at``, mean polynomial terms (p,)."""
    t, to = design.x / design.largest, np.asarray(at, float) / design.largest
    p, nu = design.terms.shape[1], len(t) - design.flat
    basis = np.vstack([np.eye(p)[1], _terms(to, p == 5)])
    ends = np.cumsum([m.log_prior.size for m in design.members])
    known: dict[int, tuple[Array, Array]] = {}  # covariances of the remainders, alike for all sizes
    best = np.argsort(weights)[::-1][:MOST_LIKELY]
    mean, second, terms = np.zeros(len(basis)), np.zeros((len(basis), len(basis))), np.zeros(p)
    for share, c in zip(weights[best] / weights[best].sum(), best):
        m = design.members[i := int(np.searchsorted(ends, c, "right"))]
        j, k = divmod(int(c - ends[i]) + m.log_prior.size, m.log_prior.shape[1])
        root, columns, precision = m.root[j], m.columns[j].T, m.precision[k]
        cross, own = np.zeros((len(basis), len(t))), np.zeros((len(basis), len(basis)))
        if m.name in ODD or m.name in SIDES:
            if i not in known:
                known[i] = _covariance(m.name, m.odd, to, t, design.strips), _remainder(m.name, m.odd, to, to)
            cross[1:], own[1:, 1:] = (m.sizes[j] ** 2 * z for z in known[i])
        cross = cross @ root.T
        b = np.zeros(p)
        for _ in range(2):
            b = b + m.inverse[j, k] @ (columns.T @ (root @ y - columns @ b) - precision * b)
        left = root @ y - columns @ b
        variance = (left @ left + precision @ b**2) / nu
        rest = basis - cross @ columns
        centre = basis @ b + cross @ left
        spread = variance * (rest @ m.inverse[j, k] @ rest.T + own - cross @ cross.T)
        mean, terms = mean + share * centre, terms + share * b
        second = second + share * (spread + np.outer(centre, centre))
    return mean, second - np.outer(mean, mean), terms


def mixture_quantiles(
    log_weight: Array, mean: Array, scale: Array, freedom: Array, tail: Array
) -> tuple[Array, Array, Array]:
    """Of Student mixtures (b, c), by the tail beyond each end (b,).

    Returns
    -------
    ends : (b, 3) array
        Lower, median, upper.
    half : (b,) array
        median +- half has the probability 1 - 2 tail.
    sd : (b,) array
    """
    keep = np.argpartition(-log_weight, min(KEPT, mean.shape[1]) - 1, axis=1)[:, :KEPT]
    log_weight, mean, scale, freedom = (np.take_along_axis(z, keep, 1) for z in (log_weight, mean, scale, freedom))
    w = special.softmax(log_weight, axis=1)
    middle = (w * mean).sum(1)
    sd = np.sqrt((w * (scale**2 + (mean - middle[:, None]) ** 2)).sum(1))
    goal = np.stack([tail, np.full(len(tail), 0.5), 1.0 - tail], 1)
    reach = 12.0 * np.maximum(1.0, special.stdtrit(freedom.min(), 1.0 - tail) / 4.0) * sd
    most = freedom.max()
    tables = [special.stdtr(nu, TABLE * np.sqrt(nu / (1.0 - TABLE**2))) for nu in (most, most - 1.0)]
    first = (freedom == most)[:, None]

    def below(z: Array) -> Array:
        u = (z[..., None] - mean[:, None]) / scale[:, None]
        u /= np.sqrt(freedom[:, None] + u * u)
        share = np.interp(u, TABLE, tables[0])
        if not first.all():
            share = np.where(first, share, np.interp(u, TABLE, tables[1]))
        return np.asarray((w[:, None] * share).sum(2))

    def bisected(short: Callable[[Array], NDArray[np.bool_]], low: Array, high: Array) -> Array:
        for _ in range(HALVINGS):
            z = 0.5 * (low + high)
            right = short(z)
            low, high = np.where(right, z, low), np.where(right, high, z)
        return 0.5 * (low + high)

    start = (np.repeat((middle + side * reach)[:, None], 3, 1) for side in (-1.0, 1.0))
    ends = bisected(lambda z: below(z) < goal, *start)
    value, sides = ends[:, 1:2], np.sort(np.abs(ends[:, ::2] - ends[:, 1:2]), 1)

    def short_half(z: Array) -> NDArray[np.bool_]:
        both = below(np.concatenate([value - z, value + z], 1))
        return both[:, 1:] - both[:, :1] < 1.0 - 2.0 * tail[:, None]

    return ends, bisected(short_half, sides[:, :1], sides[:, 1:])[:, 0], sd
