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

from dataclasses import dataclass
from functools import lru_cache
from itertools import groupby, product
from typing import Any

import numpy as np
from scipy import special

from coeflab.core.types import Array, locked, remembered
from coeflab.fits.statistics import one_signed
from coeflab.fits.statistics.least_squares import Index
from coeflab.fits.statistics.many_rows import Strips
from coeflab.fits.statistics.prior_grid import Rotations, rotated
from coeflab.fits.statistics.student_mixture import mixture_quantiles

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
DECAY, ORDERS, STATED_FREEDOM, MOST_LIKELY = 0.8, 16, 2.0, 100
NODES, WEIGHTS = np.polynomial.legendre.leggauss(8)
REMAINDERS = {(name, True) for name in ODD} | {(name, False) for name in SIDES}
# Numbers in one array of a batch: larger ones leave the processor's cache.
AT_ONCE = 30_000


@dataclass(frozen=True, slots=True, eq=False)
class Members:
    """Remainders of one grid of sizes of the polynomial terms: j remainders with their size by k combinations; p columns, n rows.

    Attributes
    ----------
    kinds : tuple of (str, bool)
        Name of each remainder, and whether it is odd.
    sizes : (j,) array
        Of the remainders.
    root : (j, n, n) array
        Inverse Cholesky factor of noise and remainder.
    base : (j, n, min(n, p)) array
        Orthonormal columns that span the whitened terms.
    turned : (p, n, j) array
        ``base`` times ``root``, zeros where n < p.
    remaining : (n, j) array
        Squares of what ``base`` does not span of each column of ``root``.
    weightless : (n, j) array
        Leverage that is rounding.
    rotations : Rotations
        Terms in `Design.order`.
    precision : (k, p) array
        Of the polynomial terms, in their own order.
    log_prior, log_det : (k, j) array
    """

    kinds: tuple[tuple[str, bool], ...]
    sizes: Array
    root: Array
    base: Array
    turned: Array
    remaining: Array
    weightless: Array
    rotations: Rotations
    precision: Array
    log_prior: Array
    log_det: Array


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
    terms : (n, p) array
        1, t, t^2 where there is an even part, t|t|, t^3.
    order : tuple of int
        Of the terms in the factorisations, the slope last.
    members : tuple of Members
    strips : Strips or None
        Of what the rows are means.
    shapes : tuple of Shapes
        One-signed sums, rows weighed by their variance.
    """

    x: Array
    largest: float
    variance: Array
    flat: int
    terms: Array
    order: tuple[int, ...]
    members: tuple[Members, ...]
    strips: Strips | None
    shapes: tuple[one_signed.Shapes, ...]


@dataclass(frozen=True, slots=True, eq=False)
class Slopes:
    """Slopes of many campaigns at the same settings.

    Attributes
    ----------
    value, lower, upper, sd, noise : (b,) array
        Median, ends with the same tail beyond each or as far as one-signed curves reach, standard deviation, that of one reading.
    u95 : (b,) array
        What is printed: value +- u95 has the probability 1 - 2 tail, also where the mixture is skewed, and holds every slope that a
        one-signed curve allows.
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
        size = DECAY * (np.abs(u) if name == "powers" else u)
        power, by, total = size**first, size**step, np.zeros(size.shape)
        for _ in range(first, ORDERS, step):
            total, power = total + power, power * by
        return np.asarray(sign * total / sum(DECAY**k for k in range(first, ORDERS, step)))
    p, onset = (int(name[1:]), 0.0) if name[0] == "p" else (0, float(name[2:]))
    u, v = (np.maximum(np.abs(t) - onset, 0.0) / (1.0 - onset) for t in (a[:, None], b[None, :]))
    m, k = np.minimum(u, v), 2 * p + 1
    size = (u * v / k - (u + v) * m / (k + 1) + m * m / (k + 2)) * m**k / (1.0 / k - 2.0 / (k + 1) + 1.0 / (k + 2))
    return np.asarray(size * (sides if odd else sides > 0.0))


def _terms(t: Array, even: bool) -> Array:
    return np.stack([np.ones(len(t)), t, *([t * t] if even else []), t * np.abs(t), t**3], 1)


@lru_cache(64)
def _log_prior(
    kinds: tuple[tuple[str, float, float], ...], nuisance: tuple[tuple[float, float], ...], curved: tuple[tuple[float, ...], ...]
) -> Array:  # fmt: skip
    """(k, j): the decade of the largest size is uniform, "nothing" apart; within it v|v| and v^3 are most often alike.

    ``kinds`` are name, size and odds of each remainder.
    """
    pairs = np.array(list(product(*curved)))
    odds = np.log([w / sum(w for _, w in nuisance) for _, w in nuisance])
    out = []
    for name, own in groupby(kinds, key=lambda kind: kind[0]):
        some = list(own)
        sizes = np.broadcast_to(np.log10(pairs), (len(some), *pairs.shape))
        if name != "none":
            also = np.log10([size for _, size, _ in some])[:, None, None]
            sizes = np.concatenate([sizes, np.broadcast_to(also, (*sizes.shape[:2], 1))], 2)
        decade = np.clip(np.floor(sizes.max(2) + 0.01), -1.0, 5.0)
        weight = np.where(pairs[:, 0] > NOTHING, QUADRATIC_ODDS, 1.0) * np.ones(decade.shape)
        weight[:, (pairs[:, 0] > NOTHING) & (pairs[:, 0] == pairs[:, 1])] *= ALIKE
        for d in np.unique(decade):
            weight[decade == d] *= (NOTHING_CURVED if d < 0.0 else 1.0) / weight[decade == d].sum()
        log = np.log(some[0][2] * weight)
        out.append((log[:, None] + odds[:, None]).reshape(len(some), -1))
    return locked(np.concatenate(out).T)


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
def prepare(x: Array, variance: Array | None = None, *, strips: Strips | None = None, odd: bool = False) -> Design:
    """Factorise a sweep.

    Parameters
    ----------
    x : (n,) array
    variance : (n,) array, optional
        Stated variance of each row; only its ratios count here.
    strips : Strips, optional
        Rows are means over several settings.
    odd : bool
        The curve is odd by declaration: no constant, no even part, whichever sides have rows.

    Returns
    -------
    Design
    """
    x = np.asarray(x, float)
    largest = float(np.abs(x).max())
    t, n = x / largest, len(x)
    strips = strips and strips.over(largest)
    ratios = np.ones(n) if variance is None else variance
    labels = np.unique(np.round(t, 9), return_inverse=True)[1].astype(np.int64)
    one_sided = not t.min() < 0.0 < t.max()
    even = not one_sided and not odd
    nodes = t if strips is None else strips.nodes.ravel()
    terms, bent = _terms(nodes, even), one_signed.curved(nodes)
    if strips is not None:
        terms, bent = strips.mean(terms, 0), strips.mean(bent, 0)
    p, root_weights = terms.shape[1], 1.0 / np.sqrt(ratios)[:, None]
    free = terms[:, [] if odd else [0, 2] if even else [0]]
    shapes = one_signed.prepare(*(root_weights * z for z in (free, terms[:, 1:2], bent)))
    specifications = _specifications(t, even, labels, variance is not None, strips)
    total = sum(s[4] for s in specifications)
    nuisance = PINNED if odd else NUISANCE if even or one_sided else ((np.inf, 1.0),)
    order = (0, *range(2, p), 1)
    members = []
    for alone in (True, False):
        some = [s for s in specifications if (s[0] == "none") is alone]
        kinds = tuple((s[0], float(size), s[4] / total) for s in some for size in s[2])
        curved = (SIZES if alone else COARSE,) * 2
        kernel = np.concatenate([s[2][:, None, None] ** 2 * s[3] for s in some])
        factor = np.linalg.cholesky(np.diag(ratios) + kernel)
        root = np.linalg.solve(factor, np.broadcast_to(np.eye(n), factor.shape))
        base, upper = np.linalg.qr(root @ terms[:, order])
        triangle, turned = np.zeros((len(kinds), p, p)), np.zeros((p, n, len(kinds)))
        spanned = np.swapaxes(base, 1, 2) @ root
        triangle[:, : upper.shape[1]], turned[: upper.shape[1]] = upper, spanned.transpose(1, 2, 0)
        priors = [(1 if even else 0, [size for size, _ in nuisance]), (p - 3, curved[0]), (p - 2, curved[1])]
        rotations = rotated(triangle, priors)
        precision = np.zeros((len(nuisance) * len(curved[0]) * len(curved[1]), p))
        precision[:, [2 if even else 0, -2, -1]] = np.array(list(product(priors[0][1], *curved))) ** -2.0
        scale = np.where(precision > 0.0, -np.log(np.where(precision > 0.0, precision, 1.0)), 0.0).sum(1)
        log_det = 2.0 * np.log(np.einsum("jii->ji", factor)).sum(1) + scale[:, None]
        members.append(
            Members(
                tuple((s[0], s[1]) for s in some for _ in s[2]), np.concatenate([s[2] for s in some]), root, base, turned,
                ((root - base @ spanned) ** 2).sum(1).T.copy(), WEIGHTLESS * (root * root).sum(1).T, rotations,
                precision, _log_prior(kinds, nuisance, curved), log_det + rotations.log_det().reshape(log_det.shape),
            )
        )  # fmt: skip
    return Design(x, largest, ratios, 1 if one_sided or odd else 2, terms, order, tuple(members), strips, shapes)


def _log_density(freedom: float) -> float:
    return float(special.gammaln(freedom / 2.0) - freedom / 2.0 * np.log(np.pi))


def _evaluate(
    m: Members, order: tuple[int, ...], start: Array, rest: Array, nu: float, floor: Array, least: Array, deletions: bool
) -> tuple[list[Array], list[Array]]:  # fmt: skip
    """Log weight, slope, its variance, noise variance (b, kj); the first three again without each row (b, n, j)."""
    (k, j), (b, n), rotations = m.log_prior.shape, rest.shape, m.rotations
    grid = (*(rotations.triangle[-1][0].shape[:-1]), j)

    def flat(values: Array, many: int) -> Array:
        return np.broadcast_to(values, (many, *grid)).reshape(many, k, j)

    whitened = m.root @ rest.T
    spanned = np.swapaxes(m.base, 1, 2) @ whitened
    remaining = whitened - m.base @ spanned
    top = np.zeros((len(order), b, j))
    top[: spanned.shape[1]] = spanned.transpose(1, 2, 0)
    below = [-inverse * start[:, order[column]].reshape(b, 1, 1, 1, 1) for column, inverse in rotations.sizes]
    last, own = rotations.turned(top, below)
    end = rotations.triangle[-1][0]
    squares = (remaining * remaining).sum(1).T[:, None] + floor[:, None, None] + flat(_sum([e * e for e in own]), b)
    mean, unit_variance = flat(last / end, b) + start[:, 1, None, None], flat(end**-2.0, 1)
    likelihood = _log_density(nu) - 0.5 * m.log_det - 0.5 * nu * np.log(squares)
    weight, variance = m.log_prior + POWER * likelihood, np.maximum(squares / nu, least[:, None, None])
    main = [z.reshape(b, -1) for z in (weight, mean, variance * unit_variance, variance)]
    if not deletions:
        return main, []
    ahead = np.ascontiguousarray((np.swapaxes(m.root, 1, 2) @ remaining).transpose(2, 1, 0))
    prior = m.log_prior + POWER * (_log_density(nu - 1.0) - 0.5 * m.log_det)
    found = []
    some = max(1, AT_ONCE // (k * j * b))
    for rows in (slice(i, i + some) for i in range(0, n, some)):
        last, each = rotations.turned(m.turned[:, rows], [0.0] * len(own))
        many = len(last)
        leverage = m.remaining[rows, None] + flat(_sum([e * e for e in each]), many)
        error = _sum([z[:, None] * e for z, e in zip(own, each)])
        error = ahead[:, rows, None] + error.reshape(b, many, k, j)
        step = error / leverage
        after = np.maximum(squares[:, None] - error * step, floor[:, None, None, None])
        weight = prior - (0.5 * POWER) * np.log(leverage)
        weight = np.where(leverage > m.weightless[rows, None], weight, -np.inf)
        weight = weight - (0.5 * POWER * (nu - 1.0)) * np.log(after)
        by_row = flat(last / end, many)
        slope = mean[:, None] - by_row * step
        variance = np.maximum(after / (nu - 1.0), least[:, None, None, None])
        variance *= unit_variance + by_row * by_row / leverage
        highest = np.maximum(weight.max(2), -1e300)
        w = np.exp(weight - highest[:, :, None])
        total = np.maximum(w.sum(2), 1e-300)
        centre = (w * slope).sum(2) / total
        slope -= centre[:, :, None]
        slope *= slope
        slope += variance
        found.append([highest + np.log(total), centre, (w * slope).sum(2) / total])
    return main, [np.concatenate(z, 1) for z in zip(*found)]


def _sum(values: list[Array]) -> Array:
    """The coarsest first."""
    total = values[0]
    for v in values[1:]:
        total = total + v
    return total


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

    parts = [_evaluate(m, design.order, start, rest, nu, floor, least, deletions) for m in design.members]
    main, gone = [p[0] for p in parts], [p[1] for p in parts]
    weight, mean, variance, noise = (np.concatenate(z, 1) for z in zip(*main))
    evidence = special.logsumexp(weight, axis=1)
    weights = special.softmax(weight, axis=1)
    noise, middle = np.sqrt((weights * noise).sum(1)), (weights * mean).sum(1)
    tail = np.clip(TAIL + TAIL_PER_DECADE * np.log10(100.0 * np.maximum(noise, ROUNDING)), *TAILS)
    scale, freedom = np.sqrt(variance), np.full(mean.shape, float(nu))
    wrong, without = np.zeros((b, n)), np.full((b, n), np.nan)
    if deletions:
        weight_i, mean_i, variance_i = (np.concatenate(z, 2) for z in zip(*gone))
        each = special.logsumexp(weight_i, axis=2)
        odds = np.concatenate(
            [(evidence + n * np.log1p(-WRONG))[:, None], each + POWER * np.log(0.5) + np.log(WRONG)], 1
        )  # a wrong reading lies anywhere within the range
        odds -= special.logsumexp(odds, axis=1, keepdims=True)
        wrong = np.exp(odds[:, 1:])
        share = weight_i - each[:, :, None]
        without = (np.exp(share) * mean_i).sum(2) * (size / design.largest)[:, None]
        flat = [z.reshape(b, -1) for z in (share + odds[:, 1:, None], mean_i, variance_i)]
        weight = np.concatenate([weight - evidence[:, None] + odds[:, :1], flat[0]], 1)
        mean, scale = np.concatenate([mean, flat[1]], 1), np.concatenate([scale, np.sqrt(flat[2])], 1)
        freedom = np.concatenate([freedom, np.full(flat[1].shape, nu - 1.0)], 1)
    ends, half, sd = mixture_quantiles(weight, mean, scale, freedom, tail)
    unit = size / design.largest
    if design.shapes:
        weighed = y / size[:, None] / np.sqrt(design.variance)
        low, high = one_signed.ends(
            design.shapes, weighed, 0.0 if stated is None else STATED_FREEDOM, noise, floor, least
        )
        half = np.max([half, high - ends[:, 1], ends[:, 1] - low], axis=0)
        ends[:, 0], ends[:, 2] = np.minimum(ends[:, 0], low), np.maximum(ends[:, 2], high)
    low, value, high = ends.T * unit
    return Slopes(value, low, high, half * unit, sd * unit, noise * size, middle * unit, wrong, without, weights)


def joint(design: Design, y: Array, weights: Array, at: Array) -> tuple[Array, Array]:
    """Mixture mean (1 + m) and covariance of the slope dy/dt and the curve at ``at``."""
    t, to = design.x / design.largest, np.asarray(at, float) / design.largest
    p, nu = design.terms.shape[1], len(t) - design.flat
    basis = np.vstack([np.eye(p)[1], _terms(to, p == 5)])
    best = np.argsort(weights)[::-1][:MOST_LIKELY]
    shares = weights[best] / weights[best].sum()
    mean, second = np.zeros(len(basis)), np.zeros((len(basis), len(basis)))
    first = 0
    for m in design.members:
        many = m.log_prior.shape[1]  # remainders and their sizes
        here = (best >= first) & (best < first + m.log_prior.size)
        (k, j), share = np.divmod(best[here] - first, many), shares[here]
        first += m.log_prior.size
        used, place = np.unique(j, return_inverse=True)
        cross = np.zeros((len(used), len(basis), len(t)))
        own = np.zeros((len(used), len(basis), len(basis)))
        for name, odd in sorted({m.kinds[i] for i in used} & REMAINDERS):
            of = np.array([m.kinds[i] == (name, odd) for i in used])
            size = m.sizes[used[of]][:, None, None] ** 2
            cross[of, 1:] = size * _covariance(name, odd, to, t, design.strips)
            own[of, 1:, 1:] = size * _remainder(name, odd, to, to)
        root = m.root[used]
        cross, columns, z = cross @ np.swapaxes(root, 1, 2), root @ design.terms, root @ y
        # Rows of the priors below the whitened terms: least squares without normal equations.
        prior = np.sqrt(m.precision[k])
        full = np.concatenate([columns[place], prior[:, :, None] * np.eye(p)], 1)
        q, r = np.linalg.qr(full)
        right = np.concatenate([z[place], np.zeros((len(k), p))], 1)[..., None]
        b = np.linalg.solve(r, np.swapaxes(q, 1, 2) @ right)[..., 0]
        left = z[place] - (columns[place] @ b[..., None])[..., 0]
        variance = share * ((left * left).sum(1) + (m.precision[k] * b * b).sum(1)) / nu
        rest = basis - cross @ columns
        centre = b @ basis.T + (cross[place] @ left[..., None])[..., 0]
        half = np.linalg.solve(np.swapaxes(r, 1, 2), np.swapaxes(rest, 1, 2)[place]) * np.sqrt(variance)[:, None, None]
        half = half.reshape(-1, len(basis))
        of_size = np.bincount(place, variance, len(used))
        known = np.swapaxes(cross, 1, 2) * np.sqrt(of_size)[:, None, None]
        known = known.reshape(-1, len(basis))
        second += half.T @ half - known.T @ known + np.einsum("j,jab->ab", of_size, own)
        second += (centre * share[:, None]).T @ centre
        mean = mean + share @ centre
    return mean, second - np.outer(mean, mean)
