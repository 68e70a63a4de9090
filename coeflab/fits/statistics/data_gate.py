"""Which reading does not belong to its sweep? Every reading is predicted from all the others by a flexible curve.

``y = a + b t + curve(t) + noise``, t = x / max|x|. The curve is a mixture of Gaussian processes: powers, smooth series,
integrated white noise (a slope that may change anywhere; Wahba 1990) and white noise from an onset (stall); sizes of
curve and noise are open. Given the sizes all is closed form: one projection P per member, in which leaving a row out is
bordering, the prediction is Student and members weigh by their restricted likelihood without that row. The reading is
improbable where the mixture leaves less than the limit in one tail. Port-starboard symmetry makes the curve odd or
even, with a small part of the other parity for a model that is not quite symmetric; so the mirror image of a reading
predicts it. Rows that fail are projected out one after the other, and judged again by those that remain.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from itertools import product

import numpy as np
from numpy.typing import NDArray
from scipy import special

from coeflab.core.types import Array, remembered
from coeflab.fits.statistics.least_squares import Index
from coeflab.fits.statistics.many_rows import by_neighbours

SIZES = (1.0, 3.0, 1e1, 3e1, 1e2, 3e2, 1e3, 3e3, 1e4, 3e4, 1e5)
# Part of the other parity, in units of the noise, with its prior share.
OTHER = ((0.0, 0.5), (2.0, 0.25), (20.0, 0.15), (200.0, 0.1))
STRAIGHT, GROWING = 0.3, (3.0, 10.0)
CURVES = {
    "power 2": 1.0,
    "power 3": 1.0,
    "series": 1.0,
    "spline": 1.0,
    "on.4": 0.7,
    "on.6": 0.7,
    "stall.4": 0.3,
    "stall.6": 0.3,
}
DECAY, ORDERS = 0.8, 16
FEWEST = 5
# Smallest noise that is credited, of the largest reading; share of the rows that may fail.
ROUNDING, MOST = 1e-5, 6
# A change of slope beyond the last setting but one: so many times the steepest slope of the sweep. A hinge
# explains a reading when its log likelihood, size and place at their best, comes within this of leaving the reading out.
KINK, AS_LIKELY, PLACES, WELL_BEYOND = 1.5, 3.0, 9, 0.2
# Error of interpolation between the settings, of the largest reading.
BETWEEN = 0.01
# Share of the second component in an error of the setting; median of a normal deviate's size.
SECOND, MEDIAN = 0.2, 0.6745
SAME_SETTING = 0.02
# A setting so many times beyond the next is a slip of the decimal point.
ISOLATED = 3.0


class Parity(StrEnum):
    """What symmetry makes of a component over a variable."""

    ODD = "odd"
    EVEN = "even"
    ANY = "any"


@dataclass(frozen=True, slots=True, eq=False)
class Gate:
    """Members of the mixture for one set of settings.

    Attributes
    ----------
    x : (n,) array
        Settings.
    projection : (k, n, n) array
        Of every member: readings to residuals over the noise variance.
    log_prior : (k,) array
        With the determinants of the likelihood in it.
    freedom : int
    """

    x: Array
    projection: Array
    log_prior: Array
    freedom: int


@dataclass(frozen=True, slots=True, eq=False)
class Prediction:
    """Every reading as the others predict it, (b, n) each.

    Attributes
    ----------
    expected, scatter : (b, n) array
        Mean and standard deviation of a reading there.
    probability : (b, n) array
        Two-sided, of a reading as far out; one where nothing can be said.
    """

    expected: Array
    scatter: Array
    probability: Array


def _shape(name: str, u: Array, v: Array) -> Array:
    """Covariance of a curve over u, v = |t|, one at 1."""
    if name.startswith("power"):
        return np.asarray((u * v) ** int(name[-1]))
    if name == "series":
        z = DECAY * u * v
        powers = range(2, ORDERS)
        return np.asarray(sum(z**k for k in powers) / sum(DECAY**k for k in powers))
    onset = float(name.lstrip("onstal")) if name != "spline" else 0.0
    u, v = (np.maximum(z - onset, 0.0) / (1.0 - onset) for z in (u, v))
    low, high = np.minimum(u, v), np.maximum(u, v)
    return np.asarray(low if name.startswith("stall") else 0.5 * low * low * (3.0 * high - low))


def _curve(name: str, parity: Parity, t: Array) -> Array:
    """Covariance (n, n) of a curve of one parity; of any, with sides that know nothing of each other."""
    u = np.abs(t)
    sides = np.sign(t)[:, None] * np.sign(t)[None, :]
    part = {Parity.ODD: sides, Parity.EVEN: np.abs(sides), Parity.ANY: (sides > 0.0).astype(float)}[parity]
    return np.asarray(_shape(name, u[:, None], u[None, :]) * part)


@remembered(32)
def prepare(x: Array, parity: Parity, variance: Array | None = None) -> Gate:
    """Factorise all members.

    Parameters
    ----------
    x : (n,) array
        Settings, zero where the body is at rest; not all zero.
    parity : Parity
    variance : (n,) array, optional
        Stated variance of each row; only its ratios count.

    Returns
    -------
    Gate
    """
    t = np.asarray(x, float) / np.abs(x).max()
    n = len(t)
    flat = np.stack([np.ones(n), t], 1) if np.ptp(t) > 0.0 else np.ones((n, 1))
    opposite = {Parity.ODD: Parity.EVEN, Parity.EVEN: Parity.ODD, Parity.ANY: None}[parity]
    other = _curve("series", opposite, t) if opposite else np.zeros((n, n))
    others = OTHER if opposite else ((0.0, 1.0),)
    rows = np.eye(n) if variance is None else np.diag(variance / np.median(variance))
    covariance, prior = [], []
    total = sum(CURVES.values())
    curves = {name: _curve(name, parity, t) for name in CURVES}
    for size, share in others:
        noise = rows + size**2 * other
        covariance.append(noise)
        prior.append(STRAIGHT * share)
        for growth in GROWING:
            covariance.append(noise + np.diag(growth**2 * t * t))
            prior.append(0.05 * share)
        for (name, odds), large in product(CURVES.items(), SIZES):
            covariance.append(noise + large**2 * curves[name])
            prior.append((0.9 - STRAIGHT) * share * odds / total / len(SIZES))
    v = np.array(covariance)
    factor = np.linalg.cholesky(v)
    root = np.linalg.solve(factor, np.broadcast_to(np.eye(n), v.shape))
    basis, triangle = np.linalg.qr(root @ flat)
    left = root - basis @ (np.swapaxes(basis, 1, 2) @ root)
    projection = np.swapaxes(root, 1, 2) @ left
    log_det = np.log(np.einsum("kii->ki", factor)).sum(1) + np.log(np.abs(np.einsum("kii->ki", triangle))).sum(1)
    return Gate(np.asarray(x, float), projection, np.log(prior) - log_det, n - flat.shape[1])


def without(gate: Gate, row: int) -> Gate:
    """The gate with one row projected out: it is predicted, and predicts nothing."""
    p = gate.projection
    pivot = np.maximum(p[:, row, row], 1e-300)
    rest = p - p[:, :, row, None] * p[:, None, row, :] / pivot[:, None, None]
    rest[:, row, :] = rest[:, :, row] = 0.0
    return Gate(gate.x, rest, gate.log_prior - 0.5 * np.log(pivot), gate.freedom - 1)


def predict(gate: Gate, y: Array) -> Prediction:
    """Predict every reading from all others.

    Parameters
    ----------
    gate : Gate
    y : (b, n) array

    Returns
    -------
    Prediction
    """
    nu = gate.freedom - 1
    size = np.abs(y).max(1)
    floor = gate.freedom * (ROUNDING * size) ** 2
    across = np.swapaxes(y @ gate.projection, 0, 1)  # (b, k, n)
    pivot = np.einsum("kii->ki", gate.projection)
    known = pivot > 1e-9 * pivot.max(1, keepdims=True)
    room = np.where(known, pivot, 1.0)
    squares = np.einsum("bkn,bn->bk", across, y)[..., None]
    error = across / room
    after = np.maximum(squares - across * error, 0.0) + floor[:, None, None]
    log = gate.log_prior[:, None] - 0.5 * np.log(room) - 0.5 * nu * np.log(after)
    log = np.where(known, log, -np.inf)
    possible = known.any(0)
    log = np.where(possible, log, 0.0)
    weight = special.softmax(log, axis=1)
    scale = np.sqrt(after / (max(nu, 1) * room))
    middle = (weight * error).sum(1)
    student = scale * np.sqrt(nu / (nu - 2.0)) if nu > 2 else 3.0 * scale
    scatter = np.sqrt((weight * (student**2 + (error - middle[:, None]) ** 2)).sum(1))
    low = (weight * special.stdtr(max(nu, 1), error / scale)).sum(1)
    high = (weight * special.stdtr(max(nu, 1), -error / scale)).sum(1)
    probability = np.where(possible, np.minimum(2.0 * np.minimum(low, high), 1.0), 1.0)
    return Prediction(y - middle, np.where(possible, scatter, np.inf), probability)


def _hinges(x: Array, row: int, parity: Parity) -> Array:
    """Columns (m, n) of a slope that changes once beside a row, two settings well beyond it; one side, and both."""
    side = np.sign(x[row]) or 1.0
    u = side * x
    mine = np.unique(np.concatenate([[0.0], u[u >= 0.0]]))
    at = int(np.searchsorted(mine, u[row]))
    near = mine[max(at - 2, 0) : at + 3]
    places = np.interp(np.linspace(0.0, len(near) - 1.0, PLACES * len(near)), np.arange(len(near)), near)
    columns = np.maximum(u - places[:, None], 0.0)
    beyond = np.array([len(np.unique(x[c > WELL_BEYOND * c.max(initial=0.0)])) for c in columns], dtype=int)
    columns = columns[beyond > 1]
    if parity is not Parity.ANY:
        mirrored = np.maximum(-u - places[beyond > 1][:, None], 0.0)
        columns = np.vstack([columns, columns + (mirrored if parity is Parity.EVEN else -mirrored)])
    return np.asarray(columns)


def explained(gate: Gate, y: Array, row: int, parity: Parity) -> bool:
    """Whether one change of slope (separation, stall) explains the readings as well as a wrong row does."""
    columns = _hinges(gate.x, row, parity)
    if not len(columns):
        return False
    p = gate.projection
    nu = gate.freedom - 1
    floor = gate.freedom * (ROUNDING * np.abs(y).max()) ** 2
    across = p @ y
    squares = across @ y
    own = p[:, row, row]
    wrong = gate.log_prior - 0.5 * nu * np.log(np.maximum(squares - across[:, row] ** 2 / own, 0.0) + floor)
    room = np.einsum("mi,kim->km", columns, p @ columns.T)
    taken = np.where(room > 1e-9 * (columns**2).sum(1), (across @ columns.T) ** 2 / np.maximum(room, 1e-300), 0.0)
    hinged = gate.log_prior[:, None] - 0.5 * nu * np.log(np.maximum(squares[:, None] - taken, 0.0) + floor)
    return bool(hinged.max() > wrong.max() - AS_LIKELY)


def _onset_at_end(x: Array, y: Array, expected: Array, row: int, parity: Parity) -> bool:
    """Whether a reading at an end without a mirror image departs no more than a change of slope there would make it.

    The slope may change by `KINK` times the steepest of the sweep.
    """
    side = np.sign(x[row]) or 1.0
    u = side * x
    if u[row] < u.max() or np.count_nonzero(u == u[row]) > 1:
        return False
    if parity is not Parity.ANY and np.any(np.abs(u + u[row]) <= SAME_SETTING * u[row]):
        return False
    settings, (means,), _ = _by_setting(x, expected[None])
    if len(settings) < 2:  # rows of one setting have no slope
        return False
    steepest = float(np.abs(np.diff(means) / np.diff(settings)).max())
    gap = u[row] - np.delete(u, row).max()
    return bool(abs(y[row] - expected[row]) <= KINK * steepest * gap)


@dataclass(frozen=True, slots=True, eq=False)
class Screened:
    """What the gate says of one component over one sweep; (n,) arrays.

    Attributes
    ----------
    expected, scatter, probability : (n,) array
        Of every reading from the others; of those that fail, from those that do not.
    wrong : (n,) boolean array
        Readings that fail.
    open_end : (n,) boolean array
        Readings at an end that a change of slope could explain.
    """

    expected: Array
    scatter: Array
    probability: Array
    wrong: NDArray[np.bool_]
    open_end: NDArray[np.bool_]


def screen(gate: Gate, y: Array, parity: Parity, limit: float) -> Screened:
    """Name the readings that do not belong, one after the other.

    Parameters
    ----------
    gate : Gate
    y : (n,) array
    parity : Parity
    limit : float
        Probability below which a reading fails.
    """
    n = len(y)
    wrong, ends, spared = np.zeros(n, bool), np.zeros(n, bool), np.zeros(n, bool)
    present = gate
    while True:
        found = predict(present, y[None])
        expected, scatter, probability = found.expected[0], found.scatter[0], found.probability[0]
        waiting = np.where(wrong | spared, 1.0, probability)
        row = int(np.argmin(waiting))
        if waiting[row] >= limit or wrong.sum() >= max(1, n // MOST) or present.freedom < 3:
            break
        ends[row] = _onset_at_end(gate.x, y, expected, row, parity)
        spared[row] = ends[row] or explained(present, y, row, parity)
        if not spared[row]:
            wrong[row] = True
            present = without(present, row)
    for row in map(int, np.flatnonzero(wrong)):
        others = gate
        for other in map(int, np.flatnonzero(wrong)):
            others = others if other == row else without(others, other)
        again = predict(others, y[None])
        expected[row], scatter[row], probability[row] = (
            z[0, row] for z in (again.expected, again.scatter, again.probability)
        )
    wrong &= probability < limit
    return Screened(expected, scatter, probability, wrong, ends)


def screen_many(x: Array, y: Array, limit: float) -> Screened:
    """The same of very many rows, each by its neighbours along x alone.

    Parameters
    ----------
    x, y : (n,) array
    limit : float
        Probability below which a reading fails.
    """
    near = by_neighbours(x, y)
    wrong = np.asarray(near.probability < limit)
    return Screened(near.expected, near.scatter, near.probability, wrong, np.zeros_like(wrong))


def _by_setting(x: Array, curves: Array) -> tuple[Array, Array, Index]:
    """Settings, curves (c, m) there, and the setting of every row; rows within 2 % of the range are one setting."""
    order = np.argsort(x, kind="stable")
    steps, first, reach = np.zeros(len(x), dtype=bool), float(x[order[0]]), SAME_SETTING * float(np.ptp(x))
    for i, value in enumerate(
        x[order].tolist()
    ):  # from the first of a setting: neighbours of a dense sweep are no chain
        steps[i] = value - first > reach
        first = value if steps[i] else first
    at = np.empty(len(x), dtype=np.int64)
    at[order] = np.cumsum(steps)
    count = np.bincount(at)
    return np.bincount(at, x) / count, np.array([np.bincount(at, c) / count for c in curves]), at


def wrong_setting(x: Array, errors: Array, expected: Array, scatter: Array, probability: Array) -> Array:
    """Probability of each row's departures, shared by its components as an error of the setting would share them.

    Departures are taken as normal ones of the same probability, and weigh by how fast the component changes there.

    Parameters
    ----------
    x : (n,) array
    errors, expected, scatter, probability : (c, n) array
        Reading less expected, expected, its scatter and its probability of every component.

    Returns
    -------
    (n,) array
        One where fewer than two components change with the setting there, and at an end without a mirror image: what
        curves miss beyond the other settings, all components miss together.
    """
    settings, means, at = _by_setting(x, expected)
    if len(settings) < 3:
        return np.ones(len(x))
    weight = np.gradient(means, settings, axis=1)[:, at] / scatter
    size = np.sqrt((weight**2).sum(0))
    second = np.sort(np.abs(weight), axis=0)[-2] if len(weight) > 1 else np.zeros(len(x))
    normal = -np.sign(errors) * special.ndtri(np.clip(0.5 * probability, 1e-300, 0.5))
    together = np.abs((weight * normal).sum(0)) / np.where(size > 0.0, size, 1.0)
    usual = max(1.0, float(np.median(together)) / MEDIAN)  # settings are never exact: all rows share some of it
    last = (at == 0) | (at == at.max())
    mirrored = np.abs(x[:, None] + x[None, :]).min(1) <= SAME_SETTING * np.ptp(x)
    judged = (second > SECOND * size) & (mirrored | ~last)
    return np.where(judged, 2.0 * special.ndtr(-together / usual), 1.0)


def _between(x: Array, y: Array, at: Array) -> Array:
    """Cubic Hermite interpolation of curves (c, n) with slopes by central differences, (c, len at)."""
    slope = np.gradient(y, x, axis=1)
    i = np.clip(np.searchsorted(x, at, side="right") - 1, 0, len(x) - 2)
    h = x[i + 1] - x[i]
    s = (at - x[i]) / h
    ends = (1.0 + 2.0 * s) * (1.0 - s) ** 2 * y[:, i] + s**2 * (3.0 - 2.0 * s) * y[:, i + 1]
    return np.asarray(ends + h * s * (1.0 - s) * ((1.0 - s) * slope[:, i] - s * slope[:, i + 1]))


def setting_that_suits(x: Array, readings: Array, expected: Array, scatter: Array) -> float | None:
    """The setting at which all components of a row would be as expected, or None.

    Parameters
    ----------
    x : (n,) array
    readings : (c,) array
        Of the row.
    expected, scatter : (c, n) array
    """
    settings, means, _ = _by_setting(x, expected)
    dense = np.linspace(settings[0], settings[-1], 401)
    curves = _between(settings, means, dense)
    room = 3.0 * np.median(scatter, axis=1) + BETWEEN * np.abs(expected).max(1)
    far = (np.abs(curves - readings[:, None]) / room[:, None]).max(0)
    best = int(np.argmin(far))
    return float(dense[best]) if far[best] <= 1.0 else None


def strange_settings(x: Array, readings: Array, scatter: Array, signs: Array) -> dict[int, int | None]:
    """Rows whose setting is likely a slip: far beyond all others, or unmatched while its readings mirror another row's.

    Parameters
    ----------
    x : (n,) array
    readings, scatter : (c, n) array
    signs : (c,) array
        1 and -1 for even and odd components, 0 where there is no mirror.

    Returns
    -------
    dict of int to int or None
        Row, and the row whose readings it mirrors.
    """
    size = np.abs(x)
    far = int(np.argmax(size))
    if len(x) >= FEWEST and size[far] > ISOLATED * np.delete(size, far).max():
        return {far: None}
    if not np.all(signs):
        return {}
    same = SAME_SETTING * np.ptp(x)
    lonely = [i for i in range(len(x)) if size[i] > same and np.abs(x + x[i]).min() > same]
    if len(lonely) != 2 or len(x) < 2 * FEWEST - 2 or x[lonely[0]] * x[lonely[1]] > 0.0:
        return {}
    noise = np.median(scatter, axis=1)
    a, b = lonely
    alike = np.abs(readings[:, a] - signs * readings[:, b]) <= 4.0 * noise
    changing = np.ptp(readings, axis=1) > 20.0 * noise
    if not (alike.all() and changing.sum() > 1):
        return {}
    outer, inner = (a, b) if size[a] > size[b] else (b, a)
    return {outer: inner}
