"""Slopes that one-signed curves allow: the misfit as a function of the slope, over a finite dictionary of shapes.

The class: ``a + s t + e t^2 + c1 f1 + c2 f2``, each f a power sgn(t) |t|^p, p from 1.7 to 4, or a saturating t|t| / (1 + |t|/k); c1
and c2 of one sign; |t| at most one. Of each pair the least misfit is a parabola of the slope, allowed where both c have one sign. The
interval holds every slope at which some pair is no worse than the best by more than the square of a Student quantile, in variances of
the noise: a profile likelihood in closed form. At a line the shortest intervals test toward the line, on one side, and where a line is
ruled out on both (Pratt 1961; Armstrong & Kolesar 2018): so does the quantile. Where the class does not fit, it allows less, or nothing.

`TAILS` were chosen on simulated curves of the class (seed 1 of ``tests/coverage/one_signed_campaigns.py``); none on a measured body.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from scipy import special

from coeflab.core.types import Array

POWERS = (1.7, 1.85, 2.0, 2.25, 2.5, 3.0, 3.5, 4.0)
SATURATING = (0.5, 0.7, 1.0, 2.0)  # k, of the largest setting
TERMS, SINGULAR = 2, 1e-9
# Tail beyond each end where a line explains the rows, and where it is ruled out; the standard deviations by which it is.
TAILS, RULED_OUT = (0.09, 0.025), (1.0, 5.0)


@dataclass(frozen=True, slots=True, eq=False)
class Shapes:
    """k sums of m curved terms at n rows.

    Attributes
    ----------
    across : (n, f) array
        Orthonormal columns of the terms without a sign.
    basis : (k, n, m + 1) array
        Orthonormal columns beside them, the slope's last.
    size : (k, 1) array
        Of the slope's column beside all others.
    inverse : (k, m, m) array
        From the columns of ``basis`` to the curved terms.
    moves : (k, 1, m) array
        Of these terms with the slope.
    """

    across: Array
    basis: Array
    size: Array
    inverse: Array
    moves: Array


def curved(t: Array) -> Array:
    """The dictionary at ``t``, (n, terms), each one at t = 1."""
    a, k = np.abs(t)[:, None], np.array(SATURATING)
    bends = a * a * (1.0 + 1.0 / k) / (1.0 + a / k)
    return np.asarray(np.sign(t)[:, None] * np.concatenate([a ** np.array(POWERS), bends], 1))


def prepare(free: Array, slope: Array, terms: Array) -> tuple[Shapes, ...]:
    """Factorise every sum that leaves the noise two degrees of freedom; none where a line does not.

    Parameters
    ----------
    free : (n, f) array
        Columns without a sign.
    slope : (n, 1) array
    terms : (n, q) array
        The dictionary at the rows.
    """
    out: list[Shapes] = []
    n, f = free.shape
    across = np.linalg.qr(free)[0]
    for m in range(min(TERMS, n - f - 3) + 1):
        sums = list(combinations(range(terms.shape[1]), m))
        basis, r = np.linalg.qr(np.stack([np.concatenate([free, terms[:, list(s)], slope], 1) for s in sums]))
        own = np.abs(np.einsum("kii->ki", r))
        keep = own.min(1) > SINGULAR * own.max(1)
        if not keep.any():
            break
        basis, r = basis[keep], r[keep]
        inverse = np.linalg.inv(r[:, f:-1, f:-1])
        moves = -np.swapaxes(inverse @ r[:, f:-1, -1:], 1, 2)
        out.append(Shapes(across, basis[:, :, f:], r[:, -1, -1:], inverse, moves))
    return tuple(out)


def ends(
    shapes: Sequence[Shapes], y: Array, more: float, noise: Array, floor: Array, least: Array
) -> tuple[Array, Array]:
    """Smallest and largest slope (b,) that the class allows; infinite with the wrong sign where it allows none.

    Parameters
    ----------
    shapes : sequence of Shapes
    y : (b, n) array
        Readings of equal variance.
    more : float
        Degrees of freedom of the noise beyond those of the rows.
    noise : (b,) array
        Standard deviation of a reading by a model that is not of one sign.
    floor, least : (b,) array
        Added to the squares of the noise; its smallest variance.
    """
    across = shapes[0].across
    freedom = y.shape[1] - across.shape[1] - 1 + more
    y = y - y @ across @ across.T
    squares = (y * y).sum(1)
    found, costs = [], []
    for s in shapes:
        z = np.einsum("knp,bn->kbp", s.basis, y)
        misfit, centre = np.maximum(squares - (z * z).sum(2), 0.0), z[:, :, -1] / s.size
        # Shifts of the slope off the centre at which a term vanishes; beyond some it is positive, beyond the others negative.
        edge = np.einsum("kmq,kbq->kbm", s.inverse, z[:, :, :-1]) / -s.moves - centre[:, :, None]
        for up in (s.moves > 0.0, s.moves < 0.0):
            low = np.where(up, edge, -np.inf).max(2, initial=-np.inf)
            high = np.where(up, np.inf, edge).min(2, initial=np.inf)
            found.append((misfit, centre, np.abs(s.size), low, high))
            nearest = s.size * np.clip(0.0, low, high)
            costs.append(np.where(low <= high, misfit + nearest * nearest, np.inf).min(0))
    best = np.min(costs, axis=0)
    variance = np.maximum((best + floor) / (freedom - 1.0), least)
    bent = np.sqrt(np.maximum(costs[0] - best, 0.0) / np.maximum(variance, np.finfo(float).tiny))
    quantile = special.stdtrit(freedom - 1.0, 1.0 - np.interp(bent, RULED_OUT, TAILS))
    allowed = np.minimum(best, noise**2 * (freedom + 1.0)) + quantile**2 * variance
    lower, upper = np.full(len(y), np.inf), np.full(len(y), -np.inf)
    for misfit, centre, size, low, high in found:
        reach = np.sqrt(np.maximum(allowed - misfit, 0.0)) / size
        left, right = np.maximum(low, -reach), np.minimum(high, reach)
        there = (allowed >= misfit) & (left <= right)
        lower = np.minimum(lower, np.where(there, centre + left, np.inf).min(0))
        upper = np.maximum(upper, np.where(there, centre + right, -np.inf).max(0))
    return lower, upper
