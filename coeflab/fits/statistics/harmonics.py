"""Harmonics of records whose noise is not white, and what they become at zero amplitude.

The standard error of a harmonic comes from blocks of one cycle (whole number not required): the scores of every block are
what a cycle by itself would have given, so that noise which stays correlated within a cycle counts in full (cluster-robust
variance, Liang & Zeger 1986; batch means). Its Student factor has one degree of freedom less than there are cycles.

Describing functions: a force c x|x| under x = a cos has the fundamental 8/(3 pi) c a |a| cos, c x^3 has 3/4 c a^3 cos: the equivalent
linear damping of ITTC 7.5-02-07-04.5 (2011).
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray
from scipy.special import fdtrc

from coeflab.core.types import Array, dataclass
from coeflab.fits.statistics.robust_errors import t_factor, t_probability

Phasors = NDArray[np.complex128]
QUADRATIC, CUBIC = 8.0 / (3.0 * np.pi), 0.75
STEPS, SETTLED = 20, 1e-12
REJECTED = 0.05  # probability below which runs scatter by more than their cycles say
WHOLE = 0.02  # of a cycle that a whole one may lack, by a rounded frequency or time
ONE = "one amplitude"
NOTHING = (np.nan, np.nan, np.nan)
SAME = 0.01  # relative: amplitudes or frequencies nearer than this are one


@dataclass(frozen=True, slots=True, eq=False)
class Harmonics:
    """Means and harmonics of several signals over one phase: signal = Re sum_k phasor_k exp(i k theta).

    Attributes
    ----------
    phasors : (m, K + 1) complex array
        The mean first.
    covariance : (m, 2, 2) array
        Of the real part and of minus the imaginary part of the fundamental (its cosine and sine parts); NaN from one cycle.
    freedom : int
        Blocks less one.
    cycles : float
    unexplained : (m,) array
        Share of the variance about the mean that no harmonic explains.
    """

    phasors: Phasors
    covariance: Array
    freedom: int
    cycles: float
    unexplained: Array


def _design(theta: Array, orders: int) -> Array:
    k = np.arange(1, orders + 1)
    return np.hstack([np.ones((len(theta), 1)), np.cos(np.outer(theta, k)), np.sin(np.outer(theta, k))])


def cycles_of(theta: Array) -> float:
    """Cycles that samples cover, the last one's own step included."""
    return float((theta[-1] - theta[0]) * len(theta) / (len(theta) - 1) / (2.0 * np.pi))


def regress(theta: Array, values: Array, orders: int = 3) -> Harmonics:
    """Least-squares harmonics.

    Parameters
    ----------
    theta : (n,) array
        Phase, rad, rising.
    values : (n, m) array
    orders : int
        Highest harmonic.
    """
    x = _design(theta, orders)
    inverse = np.linalg.inv(x.T @ x)
    found = inverse @ (x.T @ values)
    rest = values - x @ found
    cycles = cycles_of(theta)
    blocks = int(cycles + WHOLE)
    covariance = np.full((values.shape[1], 2, 2), np.nan)
    if blocks >= 2:
        edge = np.searchsorted(theta, theta[0] + np.arange(blocks) * cycles / blocks * 2.0 * np.pi * (1.0 - 1e-12))
        scores = np.add.reduceat(x[:, :, None] * rest[:, None, :], edge, axis=0)
        pick = inverse[[1, 1 + orders]]
        moved = np.einsum("cp,bpm->mbc", pick, scores)
        covariance = np.einsum("mbc,mbd->mcd", moved, moved) * blocks / (blocks - 1.0)
    spread = np.var(values, axis=0)
    left = np.divide(np.var(rest, axis=0), spread, out=np.zeros_like(spread), where=spread > 0.0)
    phasors = np.hstack([found[:1].T + 0j, (found[1 : orders + 1] - 1j * found[orders + 1 :]).T])
    return Harmonics(phasors, covariance, max(blocks - 1, 0), cycles, left)


def series(phasors: Phasors, theta: Array) -> Array:
    """(n, m) signals of phasors (m, K + 1) at phases (n,)."""
    k = np.arange(phasors.shape[1])
    return np.asarray(np.real(np.exp(1j * np.outer(theta, k)) @ phasors.T))


def derivative(phasors: Phasors, omega: float) -> Phasors:
    """Phasors of the rate of change."""
    return np.asarray(phasors * 1j * omega * np.arange(phasors.shape[1]))


def refined(time: Array, values: Array, omega: float, orders: int = 3) -> float:
    """The frequency near ``omega`` at which harmonics explain a signal best, by Gauss-Newton, rad/s.

    Parameters
    ----------
    time, values : (n,) array
    omega : float
        Start; where the search leaves its half it is returned as it is.
    orders : int
    """
    middle = time - time.mean()
    k, start = np.arange(1, orders + 1), omega
    for _ in range(STEPS):
        x = _design(omega * middle, orders)
        found = np.linalg.lstsq(x, values, rcond=None)[0]
        cos, sin = x[:, 1 : orders + 1], x[:, orders + 1 :]
        slope = middle * (cos @ (k * found[orders + 1 :]) - sin @ (k * found[1 : orders + 1]))
        step = float(np.linalg.lstsq(np.column_stack([x, slope]), values, rcond=None)[0][-1])
        omega += step
        if not 0.5 * start < omega < 2.0 * start:
            return start
        if abs(step) <= SETTLED * omega:
            break
    return omega


@dataclass(frozen=True, slots=True, eq=False)
class Form:
    """One form of the dependence on amplitude.

    Attributes
    ----------
    name : str
    weight : float
        Share by its likelihood and number of coefficients (Schwarz 1978).
    value, half_width : float
        At zero amplitude, with the 95 % half-width of scatter; NaN where it has none.
    slope, slope_half : float
        Coefficient of the form's column; NaN without one.
    correlation : float
        Of the two.
    """

    name: str
    weight: float
    value: float
    half_width: float
    slope: float = np.nan
    slope_half: float = np.nan
    correlation: float = 0.0


@dataclass(frozen=True, slots=True, eq=False)
class AtZero:
    """What several runs say at zero amplitude.

    Attributes
    ----------
    value : float
        Mean of the forms by their weights.
    random, form : float
        95 % half-widths: scatter, and the spread of the forms.
    forms : tuple of Form
    at_zero : bool
        Whether some form reaches zero amplitude; otherwise the value is that of the one amplitude.
    frequency : (float, float, float)
        Slope over frequency beside the likeliest form, its 95 % half-width, and the probability of it by chance; NaN where
        the runs do not vary it.
    scatter : float
        Probability that runs scatter so much about the likeliest form where their cycles are right; NaN where unknown.
    """

    value: float
    random: float
    form: float
    forms: tuple[Form, ...]
    at_zero: bool
    frequency: tuple[float, float, float]
    scatter: float

    @property
    def half_width(self) -> float:
        """95 %."""
        return float(np.hypot(self.random, self.form))

    @property
    def likeliest(self) -> Form:
        """The form of the largest weight."""
        return max(self.forms, key=lambda f: f.weight)


@dataclass(frozen=True, slots=True, eq=False)
class RunScatter:
    """Scatter of the coefficients of several runs.

    Attributes
    ----------
    own : (n,) array
        Variance of each by its own cycles; NaN from a single cycle.
    freedom : (n,) array
        Of that variance.
    assumed : (n,) array
        Smooth proportions that the runs are weighed by; a variance of few cycles is too uneven for that.
    """

    own: Array
    freedom: Array
    assumed: Array

    @property
    def variance(self) -> Array:
        """(n,) by the cycles; of single cycles as the others have it in proportion; NaN where no run has any."""
        known = np.isfinite(self.own)
        scale = float(np.mean(self.own[known] / self.assumed[known])) if np.any(known) else np.nan
        return np.where(known, self.own, scale * self.assumed)


@dataclass(frozen=True, slots=True)
class _Weighed:
    beta: Array
    half: Array  # 95 %, NaN where unknown
    correlation: Array
    misfit: float  # over what the cycles say, per degree of freedom; unscaled where they say nothing
    spare: int
    chance: float


def _weighed(x: Array, y: Array, scatter: RunScatter) -> _Weighed | None:
    """Weighted least squares; the variance of every coefficient by the cycles of the runs (Satterthwaite 1946).

    Where the runs scatter about the form by more than their cycles say, or these say nothing, that scatter counts instead.
    """
    root = 1.0 / np.sqrt(scatter.assumed)
    a = x * root[:, None]
    if len(y) < a.shape[1] or np.linalg.matrix_rank(a / np.linalg.norm(a, axis=0)) < a.shape[1]:
        return None
    estimator = np.linalg.pinv(a) * root
    beta = estimator @ y
    spare = len(y) - a.shape[1]
    rest = (y - x @ beta) ** 2 / scatter.assumed
    variance = scatter.variance
    known = bool(np.isfinite(variance[0])) and float(scatter.freedom.sum()) > 0.0
    shares = estimator**2 * (variance if known else scatter.assumed)
    half = np.full(len(beta), np.nan)
    misfit, chance = float(rest.sum()) / max(spare, 1), np.nan
    if known:
        expected = float(np.sum(variance / scatter.assumed * (1.0 - np.einsum("ij,ji->i", x, estimator))))
        misfit = float(rest.sum()) / expected if spare and expected > 0.0 else 0.0
        chance = float(fdtrc(spare, float(scatter.freedom.sum()), misfit)) if spare else np.nan
        squares = np.sum(shares**2 / np.maximum(scatter.freedom, 1.0), axis=1)
        whole = np.full(len(beta), float(scatter.freedom.sum()))
        freedom = np.divide(shares.sum(axis=1) ** 2, squares, out=whole, where=squares > 0.0)
        half = np.sqrt(shares.sum(axis=1)) * t_factor(freedom)
    if spare and (not known or chance < REJECTED):
        half = np.sqrt(misfit * shares.sum(axis=1)) * t_factor(float(spare))
    covariance = (estimator * (variance if known else scatter.assumed)) @ estimator.T
    size = np.sqrt(np.diag(covariance))
    pair = np.outer(size, size)
    correlation = np.divide(covariance, pair, out=np.zeros_like(pair), where=pair > 0.0)
    return _Weighed(beta, np.asarray(half), correlation, misfit, spare, chance)


def at_zero_amplitude(
    y: Array, scatter: RunScatter, columns: Mapping[str, Array | None], frequency: Array, to_rest: bool = False
) -> AtZero:
    """Equivalent linear coefficients of several runs, taken to zero amplitude.

    Parameters
    ----------
    y : (n,) array
        Equivalent coefficient of every run.
    scatter : RunScatter
    columns : mapping of name to (n,) array or None
        Describing function of every form, which vanishes at zero amplitude; None for no dependence.
    frequency : (n,) array
    to_rest : bool
        Whether values go with the square of frequency too and are those of zero frequency.
    """
    one, nothing = np.ones((len(y), 1)), np.zeros((len(y), 0))
    aside = frequency[:, None] ** 2 if to_rest else nothing
    designs = {
        n: np.hstack([one, nothing if c is None else c[:, None], aside])
        for n, c in columns.items()
        if c is None or _varies(c)
    }
    models = {n: w for n, x in designs.items() if (w := _weighed(x, y, scatter)) is not None}
    at_zero = bool(models)
    if not models:
        designs = {ONE: np.hstack([one, aside])}
        single = _weighed(designs[ONE], y, scatter)
        if single is None:
            raise ValueError("as many runs as coefficients at the least")
        models = {ONE: single}
    # The scatter that the best form leaves is the unit of likelihood, unless the cycles say more.
    known = not np.isnan(scatter.variance[0])
    unit = max(min(w.misfit for w in models.values()), 1.0 if known else 0.0) or 1.0
    score = np.array([w.misfit * w.spare / unit + len(w.beta) * np.log(len(y)) for w in models.values()])
    weights = np.exp(-0.5 * (score - score.min()))
    weights /= weights.sum()
    forms = tuple(
        Form(n, float(p), float(w.beta[0]), float(w.half[0]))
        if columns.get(n) is None
        else Form(
            n,
            float(p),
            float(w.beta[0]),
            float(w.half[0]),
            float(w.beta[1]),
            float(w.half[1]),
            float(w.correlation[0, 1]),
        )
        for (n, w), p in zip(models.items(), weights, strict=True)
    )
    value = float(sum(f.weight * f.value for f in forms))
    random = float(np.sqrt(sum(f.weight * f.half_width**2 for f in forms)))
    form = 2.0 * float(np.sqrt(sum(f.weight * (f.value - value) ** 2 for f in forms)))
    likeliest = max(forms, key=lambda f: f.weight).name
    slope = NOTHING if to_rest else _over_frequency(designs[likeliest], y, scatter, frequency)
    return AtZero(value, random, form if at_zero else np.nan, forms, at_zero, slope, models[likeliest].chance)


def _varies(x: Array) -> bool:
    return float(np.ptp(x)) > SAME * float(np.max(np.abs(x)))


def _over_frequency(x: Array, y: Array, scatter: RunScatter, frequency: Array) -> tuple[float, float, float]:
    """Slope over frequency beside a form, its half-width, and its probability by chance from the half-width."""
    if not _varies(frequency):
        return NOTHING
    w = _weighed(np.column_stack([x, frequency - frequency.mean()]), y, scatter)
    if w is None:
        return NOTHING
    slope, half = float(w.beta[-1]), float(w.half[-1])
    return slope, half, float(t_probability(2.0 * slope / half, float(max(w.spare, 1)))) if half > 0.0 else np.nan
