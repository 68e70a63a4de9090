"""Sweeps of very many rows: a curve through each row's neighbours, and rows condensed to as many settings as a slope needs."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray
from scipy import special

from coeflab.core.types import Array

# Rows up to which every row counts by itself: the cost of a calibrated slope grows with their third power.
EACH_ROW = 80
NEIGHBOURS = 41
SETTINGS, NODES = 41, 9
ROUNDS, TUKEY, FREEDOM = 6, 4.685, 60.0
SMALLEST = 1e-100  # spread of equal readings; its square is still a number
ROUNDING, LEVEL = 1e-12, 0.02  # share of clean campaigns in which a row is left out


@dataclass(frozen=True, slots=True, eq=False)
class Neighbours:
    """Every row as its neighbours along x predict it; (n,) arrays in the order of the rows.

    Attributes
    ----------
    expected, scatter : (n,) array
        Of the reading, from a robust parabola through the `NEIGHBOURS` nearest rows; the scatter is theirs.
    probability : (n,) array
        Two-sided, of a reading as far out.
    """

    expected: Array
    scatter: Array
    probability: Array


def by_neighbours(x: Array, y: Array) -> Neighbours:
    """Predict every row from the rows next to it.

    A parabola through the nearest rows by iterated weights (Tukey's biweight of 4.685 robust standard deviations); the
    row itself has no weight.

    Parameters
    ----------
    x, y : (n,) array
        At least `NEIGHBOURS` rows.

    Returns
    -------
    Neighbours
    """
    order = np.argsort(x, kind="stable")
    n = len(x)
    start = np.clip(np.arange(n) - NEIGHBOURS // 2, 0, n - NEIGHBOURS)
    own = np.arange(n) - start
    u = sliding_window_view(x[order], NEIGHBOURS)[start]
    v = sliding_window_view(y[order], NEIGHBOURS)[start]
    width = np.maximum(np.abs(u - x[order][:, None]).max(1), np.finfo(float).tiny)
    t = (u - x[order][:, None]) / width[:, None]
    middle = np.median(v, axis=1, keepdims=True)
    size = np.maximum(np.abs(v - middle).max(1), SMALLEST)
    z = (v - middle) / size[:, None]
    powers = np.stack([np.ones_like(t), t, t * t])  # (3, n, m)
    weight = np.ones_like(t)
    weight[np.arange(n), own] = 0.0
    given = weight.copy()
    c, sd, normal = np.zeros((n, 3)), np.ones(n), np.zeros((n, 3, 3))
    for _ in range(ROUNDS):
        normal = np.einsum("anm,nm,bnm->nab", powers, weight, powers) + ROUNDING * np.eye(3)
        c = np.linalg.solve(normal, np.einsum("anm,nm,nm->na", powers, weight, z)[..., None])[..., 0]
        left = z - np.einsum("na,anm->nm", c, powers)
        sd = np.maximum(1.4826 * np.median(np.abs(left), axis=1), ROUNDING)
        weight = given * np.maximum(1.0 - (left / (TUKEY * sd[:, None])) ** 2, 0.0) ** 2
    lever = np.linalg.inv(normal)[:, 0, 0]
    # One window knows its scatter to a seventh; four together to a twelfth, and scatter changes slowly along a sweep.
    from scipy.ndimage import uniform_filter1d

    around = uniform_filter1d((sd * size) ** 2, 4 * NEIGHBOURS, mode="nearest")
    sd = np.sqrt(np.maximum(around, (ROUNDING * size) ** 2)) / size
    scatter = sd * np.sqrt(1.0 + np.clip(lever, 0.0, 10.0))
    here = left[np.arange(n), own]
    p = 2.0 * special.stdtr(FREEDOM, -np.abs(here) / scatter)
    back = np.argsort(order, kind="stable")
    expected = (c[:, 0] * size + middle[:, 0])[back]
    return Neighbours(expected, (scatter * size)[back], p[back])


@dataclass(frozen=True, slots=True, eq=False)
class Strips:
    """Settings of which each row is the mean.

    Attributes
    ----------
    nodes, shares : (m, q) array
        Settings and their weights; the shares of a row add to one.
    """

    nodes: Array
    shares: Array

    def mean(self, values: Array, axis: int) -> Array:
        """Means over the settings of every row, of values at ``nodes.ravel()`` along an axis."""
        moved = np.moveaxis(values, axis, 0).reshape(*self.shares.shape, -1)
        rest = [n for i, n in enumerate(values.shape) if i != axis]
        found = np.einsum("mq,mqr->mr", self.shares, moved).reshape(len(self.shares), *rest)
        return np.ascontiguousarray(np.moveaxis(found, 0, axis))

    def over(self, size: float) -> Strips:
        """In units of ``size``."""
        return Strips(self.nodes / size, self.shares)

    def of(self, selected: NDArray[np.intp]) -> Strips:
        """Those of some rows."""
        return Strips(self.nodes[selected], self.shares[selected])


@dataclass(frozen=True, slots=True, eq=False)
class Condensed:
    """Very many rows as few.

    Attributes
    ----------
    x, y, variance : (m,) array
        Means of settings and readings, and the relative variance of these.
    strips : Strips
    strip : (n,) integer array
        Where each row went; -1 for one that does not count.
    notes : tuple of str
    stated : float or None
        Variance of a row of unit relative variance, where the table states it.
    mirrored : bool
        Whether one half of the rows is the exact image of the other.
    """

    x: Array
    y: Array
    variance: Array
    strips: Strips
    strip: NDArray[np.intp]
    notes: tuple[str, ...]
    stated: float | None = None
    mirrored: bool = False

    def rows(self, values: Array, otherwise: float) -> Array:
        """What holds of the strips, (m,), for every row, (n,)."""
        return np.where(self.strip >= 0, values[self.strip], otherwise)


def condensed(x: Array, y: Array, used: NDArray[np.bool_], variance: Array | None = None) -> Condensed:
    """Means over `SETTINGS` strips, or over the settings themselves where they are fewer.

    Strips are equally wide, from -max|x| to max|x|.

    Parameters
    ----------
    x, y : (n,) array
    used : (n,) boolean array
        Rows that count; those that are as far from their neighbours as no clean row of so many do not.
    variance : (n,) array, optional
        Of each row, relative.

    Returns
    -------
    Condensed
    """
    selected = np.flatnonzero(used)
    near = by_neighbours(x[selected], y[selected])
    far = near.probability < LEVEL / len(selected)
    order = np.argsort(x[selected[~far]], kind="stable")
    gone, selected = selected[far], selected[~far][order]
    t, largest = x[selected], float(np.abs(x).max())
    w = np.ones(len(selected)) if variance is None else 1.0 / variance[selected]
    distinct, labels = np.unique(np.round(t / largest, 9), return_inverse=True)
    what = f"{len(distinct)} settings"
    if len(distinct) > SETTINGS:
        labels = np.minimum((0.5 * SETTINGS * (t / largest + 1.0)).astype(np.intp), SETTINGS - 1)
        labels = np.unique(labels, return_inverse=True)[1]
        what = f"{labels[-1] + 1} strips of neighbouring settings"
    strip = np.full(len(x), -1, dtype=np.intp)
    strip[selected] = labels
    total = np.bincount(labels, w)
    first = np.searchsorted(labels, np.arange(len(total)))
    place = np.arange(len(t)) - first[labels]
    # Within a strip neighbours share a node: equal numbers of rows, at their mean.
    node = labels * NODES + place * NODES // np.bincount(labels)[labels]
    weight = np.bincount(node, w, NODES * len(total))
    nodes = np.bincount(node, w * t, NODES * len(total)) / np.where(weight > 0.0, weight, 1.0)
    strips = Strips(nodes.reshape(-1, NODES), weight.reshape(-1, NODES) / total[:, None])
    note = f"{len(x)} rows count as means over {what}"
    if len(gone):
        note += f"; {len(gone)} rows do not fit their neighbours and are left out"
    middle, mean = (np.asarray(np.bincount(labels, w * z) / total) for z in (t, y[selected]))
    return Condensed(middle, mean, 1.0 / total, strips, strip, (note,))


def copies(rows: Array) -> tuple[NDArray[np.bool_], bool]:
    """Rows that repeat an earlier one exactly; whether every row off zero has its exact mirror image.

    Parameters
    ----------
    rows : (n, k) array
        Setting, reading, and what else tells rows apart.
    """
    first = np.unique(rows, axis=0, return_index=True)[1]
    again = np.ones(len(rows), bool)
    again[first] = False
    seen = {(float(r[0]), float(r[1])) for r in rows}
    off = rows[rows[:, 0] != 0.0]
    return again, len(off) > 2 and all((-float(r[0]), -float(r[1])) in seen for r in off)


def images(x: Array, y: Array, sign: float) -> NDArray[np.bool_]:
    """Rows, (n,), that are the exact mirror image of another: of each pair the one on the side with fewer rows.

    Parameters
    ----------
    x, y : (n,) array
    sign : float
        Of the image of y: -1 of an odd, 1 of an even force.
    """
    selected = 1.0 if np.count_nonzero(x > 0.0) >= np.count_nonzero(x < 0.0) else -1.0
    there = {(a, b) for a, b in zip(x.tolist(), y.tolist()) if a * selected > 0.0}
    return np.array(
        [a * selected < 0.0 and (-a, sign * b) in there for a, b in zip(x.tolist(), y.tolist())], dtype=bool
    )


@dataclass(frozen=True, slots=True, eq=False)
class Rows:
    """What goes into a slope.

    Attributes
    ----------
    x, y : (n,) array
    variance : (n,) array or None
        Relative.
    stated : float or None
        Variance of a row of unit relative variance, where the table states it.
    used : (n,) boolean array
    mirrored : bool
        Whether one half of the rows is the exact image of the other.
    notes : tuple of str
    strips : Strips or None
        Of what the rows are means.
    """

    x: Array
    y: Array
    variance: Array | None
    stated: float | None
    used: NDArray[np.bool_]
    mirrored: bool
    notes: tuple[str, ...]
    strips: Strips | None = None


def rows_of(x: Array, y: Array, se: Array | None, odd: bool = False) -> Rows:
    """Rows that count, their relative variance, and what is to be said of them.

    Where the curve is odd by declaration a row and its exact mirror image count once, wherever the image came from.

    Raises
    ------
    ValueError
        Lengths differ or a number is not finite.
    """
    x, y = np.asarray(x, float), np.asarray(y, float)
    if x.shape != y.shape or x.ndim != 1 or not np.isfinite([x, y]).all():
        raise ValueError(f"x and y must be finite and of one length, found shapes {x.shape} and {y.shape}")
    variance, stated = None, None
    if se is not None and (usable := np.isfinite(se) & (np.asarray(se) > 0.0)).any():
        middle = float(np.median(np.asarray(se)[usable]))
        variance, stated = np.clip(np.where(usable, se, middle) / middle, 1e-2, 1e2) ** 2, middle**2
    again, mirrored = copies(np.stack([x, y] if variance is None else [x, y, variance], 1))
    if odd:
        again, mirrored = again | images(x, y, -1.0), False
    notes = []
    if again.any():
        image = " or mirror" if odd else ""
        notes.append(f"{int(again.sum())} rows repeat{image} an earlier row exactly and count once")
    if mirrored:
        notes.append("every row has its exact mirror image: the mirrored half is no new data, U95 widened by sqrt 2")
    if odd:
        notes.append("odd by declared symmetry: the mirrored side is no new data and adds no degree of freedom")
    elif not len(x) or not x.min() < 0.0 < x.max():
        notes.append("one-sided sweep: even and odd parts cannot be separated")
    return Rows(x, y, variance, stated, np.logical_not(again), mirrored, tuple(notes))


def condensed_rows(x: Array, y: Array, se: Array | None = None, odd: bool = False) -> Condensed | None:
    """Very many rows as few; None where they are few, or too few settings."""
    if len(x) <= EACH_ROW:
        return None
    r = rows_of(x, y, se, odd)
    if np.count_nonzero(r.used) <= EACH_ROW or len(np.unique(r.x[r.used])) < 3:
        return None
    few = condensed(r.x, r.y, r.used, r.variance)
    return replace(few, stated=r.stated, mirrored=r.mirrored, notes=(*r.notes, *few.notes))
