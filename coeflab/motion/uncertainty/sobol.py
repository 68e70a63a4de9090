"""Sobol indices of groups of independent inputs: which of them the variance of a result comes from.

S of a group is the share of the variance that would go, on average, if the group were known exactly; S_T the share that would
stay if everything else were. The design is that of A. Saltelli et al., Computer Physics Communications 181 (2010): two samples
A and B, and for each group A with the columns of the group taken from B, so ``rows * (groups + 2)`` runs. S by their equation
(b), S_T by M. J. W. Jansen, Computer Physics Communications 117 (1999).

`scipy.stats.sobol_indices` has the same two estimators, and tests hold these to it. It knows no groups, so it has no answer for
correlated inputs; it stops at results that are missing; and its bootstrap takes one array a replicate where one product of
matrices does.

The rows that Sobol indices of a parameter file take, and which of them have to be run.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence

import numpy as np
from scipy.special import ndtri

from coeflab.core.types import Array, dataclass
from coeflab.fits.uncertainty.propagation import HIGH, LOW
from coeflab.motion.uncertainty.draws import CORRELATED, Uncertain

REPLICATES = 1000
LEAST_ROWS = 8
EDGE = 2.0**-40
DEGREE = 3
BLOCK = 128
TOGETHER = 8_000_000  # rows times replicates that are held at once, 64 MB an array


@dataclass(frozen=True, slots=True, eq=False)
class SobolIndices:
    """Indices of g groups with the percentiles 2.275 and 97.725 of a bootstrap over the rows of the design.

    Attributes
    ----------
    first, total : (g,) array
        Not a number where the result does not vary, or too few rows are whole.
    first_bounds, total_bounds : (2, g) array
        Low and high. The rows of a Sobol sequence cover the space more evenly than the draws that the bootstrap takes them
        for, so the bounds are rather too wide.
    rows : int
        Rows of the design with all their results.
    """

    first: Array
    total: Array
    first_bounds: Array
    total_bounds: Array
    rows: int


def design(rows: int, inputs: int, seed: int) -> tuple[Array, Array]:
    """Samples A and B of standard normal inputs, each (rows, inputs), from one scrambled Sobol sequence.

    Parameters
    ----------
    rows : int
        A power of two, which the sequence is balanced for.
    inputs : int
    seed : int
        Of the scrambling.

    Raises
    ------
    ValueError
        ``rows`` is no power of two.
    """
    from scipy.stats import qmc

    if rows < 1 or rows & (rows - 1):
        raise ValueError(f"{rows} rows are no power of two")
    points = qmc.Sobol(2 * inputs, scramble=True, seed=np.random.default_rng(seed)).random(rows)
    normal = ndtri(np.clip(points, EDGE, 1.0 - EDGE))
    return normal[:, :inputs], normal[:, inputs:]


def exchanged(a: Array, b: Array, groups: Sequence[Sequence[int]]) -> Array:
    """(g, rows, inputs) sample A with the columns of each group from B."""
    out = np.repeat(a[None], len(groups), axis=0)
    for k, columns in enumerate(groups):
        out[k][:, list(columns)] = b[:, list(columns)]
    return out


def sobol_indices(
    of_a: Array, of_b: Array, of_exchanged: Array, replicates: int = REPLICATES, seed: int = 1
) -> SobolIndices:
    """First-order and total indices.

    A row with a result that is not finite is left out whole.

    Parameters
    ----------
    of_a, of_b : (rows,) array
        Results of the two samples.
    of_exchanged : (g, rows) array
    replicates, seed : int
        Of the bootstrap.
    """
    results = np.vstack([of_a, of_b, of_exchanged])
    whole = results[:, np.isfinite(results).all(axis=0)]
    groups, rows = len(of_exchanged), whole.shape[1]
    empty = np.full(groups, np.nan)
    if rows < LEAST_ROWS or np.ptp(whole[:2]) <= 1e-12 * np.max(np.abs(whole[:2])):
        return SobolIndices(empty, empty, np.vstack([empty] * 2), np.vstack([empty] * 2), rows)
    a, b, mixed = whole[0], whole[1], whole[2:]
    middle = float(np.mean(whole[:2]))
    a, b, mixed = a - middle, b - middle, mixed - middle
    moments = np.vstack([(a + b) / 2.0, (a**2 + b**2) / 2.0, b * (mixed - a), (mixed - a), 0.5 * (mixed - a) ** 2])
    first, total = _of_moments(np.mean(moments, axis=1)[None], groups)
    counted = np.vstack([counts @ moments.T for counts in drawn_counts(rows, replicates, seed)])
    many = _of_moments(counted / rows, groups)
    bounds = [np.nanpercentile(m, [LOW, HIGH], axis=0) for m in many]
    return SobolIndices(first[0], total[0], bounds[0], bounds[1], rows)


def _of_moments(means: Array, groups: int) -> tuple[Array, Array]:
    """Both indices, each (n, g), from means (n, 2 + 3 g) of the rows."""
    mean, square, crossed, changed, jansen = np.split(means, [1, 2, 2 + groups, 2 + 2 * groups], axis=1)
    variance = square - mean**2
    with np.errstate(divide="ignore", invalid="ignore"):
        return (crossed - mean * changed) / variance, jansen / variance


def known_share(inputs: Array, result: Array) -> Array:
    """Share of the variance of a result that a cubic of one input alone explains, (k,): at most its first-order index.

    Inputs may be correlated: this is Var(E[y | x_i]) / Var(y) of A. Saltelli & S. Tarantola, J. American Statistical
    Association 97 (2002), as far as the conditional mean is a cubic; adjusted for the three numbers of the fit and not below
    zero. It takes no runs beside those of the ensemble.

    Parameters
    ----------
    inputs : (n, k) array
    result : (n,) array
        Rows that are not finite are left out.
    """
    selected = np.isfinite(result)
    x, y = inputs[selected], result[selected] - np.mean(result[selected]) if selected.any() else result[selected]
    out = np.full(inputs.shape[1], np.nan)
    whole = float(y @ y)
    if len(y) < 10 * DEGREE or whole <= 0.0:
        return out
    for k, column in enumerate(x.T):
        spread = float(np.std(column))
        if spread == 0.0:
            out[k] = 0.0
            continue
        powers = np.vander((column - np.mean(column)) / spread, DEGREE + 1)
        basis, _ = np.linalg.qr(powers)
        left = max(whole - float(np.sum((basis.T @ y) ** 2)), 0.0) / whole
        out[k] = max(1.0 - left * (len(y) - 1) / (len(y) - 1 - DEGREE), 0.0)
    return out


def share_noise(rows: int) -> float:
    """What `known_share` of so many rows stays below where there is no dependence, by three standard deviations."""
    return float(3.0 * np.sqrt(2.0 * DEGREE) / rows)


@dataclass(frozen=True, slots=True, eq=False)
class SobolDesign:
    """Samples A and B, and A with each group of B.

    Attributes
    ----------
    groups : tuple of tuple of str
        Correlated among themselves, independent of each other.
    sources : tuple of str
        Campaigns or works behind each group.
    felt : tuple of int
        Groups that the motion feels; for the others A need not be run again.
    base : int
        Rows of a sample.
    samples : tuple of (base, k) array
        Deviations: A, B, and one for every group.
    left_out : float
        Largest correlation between groups.
    """

    groups: tuple[tuple[str, ...], ...]
    sources: tuple[str, ...]
    felt: tuple[int, ...]
    base: int
    samples: tuple[Array, ...]
    left_out: float

    @property
    def statement(self) -> str:
        """How it was made, in words."""
        return (
            f"Sobol indices: {self.base} rows of {len(self.felt) + 2} motions. Coefficients that are correlated by more than "
            f"{CORRELATED:g} are one group; the largest correlation between groups, {self.left_out:.2g}, is left out of the design. "
            "Shares of single coefficients keep every correlation"
        )

    @property
    def to_run(self) -> tuple[Array, ...]:
        """A, B and the exchanged samples of felt groups."""
        return (*self.samples[:2], *(self.samples[2 + k] for k in self.felt))

    def spread_out(self, results: Array) -> tuple[Array, ...]:
        """Results of `to_run`, (rows,) one after the other, as one array a sample; a group that is not felt has those of A."""
        a, b, *others = results.reshape(-1, self.base)
        known = dict(zip(self.felt, others, strict=True))
        return (a, b, *(known.get(k, a) for k in range(len(self.groups))))


def sobol_design(varied: Uncertain, members: int, seed: int, still: Collection[str]) -> SobolDesign:
    """As many rows as the largest power of two within ``members``; ``still`` are symbols that the motion does not feel."""
    places = varied.groups()
    groups = tuple(tuple(varied.symbols[i] for i in g) for g in places)
    base = 1 << (members.bit_length() - 1)
    a, b = design(base, len(varied.symbols), seed)
    return SobolDesign(
        groups, tuple(", ".join(dict.fromkeys(varied.sources[i] for i in g)) for g in places),
        tuple(k for k, g in enumerate(groups) if not set(g) <= set(still)), base,
        tuple(varied.designed(z) for z in (a, b, *exchanged(a, b, places))), varied.left_out(),
    )  # fmt: skip


def pieces(n: int, replicates: int) -> list[int]:
    """Sizes of the pieces in which so many replicates of n rows are made: one, unless they would not fit into memory."""
    most = max(1, TOGETHER // max(n, 1))
    return [min(most, replicates - start) for start in range(0, replicates, most)]


def drawn_counts(n: int, replicates: int, seed: int) -> Iterator[Array]:
    """How often each of n rows is drawn in each replicate, (replicates, n) in `pieces`."""
    rng = np.random.default_rng(seed)
    return (_counts(rng, n, size) for size in pieces(n, replicates))


def _counts(rng: np.random.Generator, n: int, replicates: int) -> Array:
    drawn = rng.integers(0, n, size=(replicates, n))
    counts = np.empty((replicates, n))
    for start in range(0, replicates, BLOCK):
        some = drawn[start : start + BLOCK]
        some += n * np.arange(len(some))[:, None]
        counts[start : start + BLOCK] = np.bincount(some.ravel(), minlength=some.size).reshape(some.shape)
    return counts
