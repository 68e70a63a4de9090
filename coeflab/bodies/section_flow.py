"""Added mass of plane sections of any shape in unbounded fluid, by boundary elements for the stream function.

Per unit length, density 1; matrices are (3, 3): sway (along y), heave (along z), roll (y towards z).

The stream function of the flow is known on a moving contour but for a constant: f = z for sway, -y for heave and
-(y^2 + z^2) / 2 for roll. Green's identities for the fluid outside and for f inside add up to one equation of a single
layer, S sigma = f - domain term + C, whose density is the jump of the normal derivative; C, one for each contour, goes
with the condition that no circulation arises. It needs only the integrals of ln r over straight elements, which are
exact, and stays well-behaved for thin fins, where the usual equations for the potential become singular: both sides of
a fin then share their density. The kinetic energy is a boundary integral of f sigma and area integrals of f.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from coeflab.core.types import Array

BATCH = 1_000_000


def section_matrices(points: Array, contour: NDArray[np.int64]) -> Array:
    """Section matrices about the origin of each section's coordinates.

    Parameters
    ----------
    points : (s, n, 2) array
        y, z of s sections of n elements each, m; around each contour with the body to the left.
    contour : (n,) array of int
        Which contour each point belongs to, from 0, rising; alike for all sections.

    Returns
    -------
    (s, 3, 3) array
        m^2, m^3, m^4.
    """
    size = np.ptp(points, axis=1).max(axis=-1)
    scaled = points / size[:, None, None]
    block = max(1, BATCH // points.shape[1] ** 2)
    parts = [_solved(scaled[k : k + block], contour) for k in range(0, len(points), block)]
    units = np.array([1.0, 1.0, 0.0])[None, :] + np.array([0.0, 0.0, 1.0]) * size[:, None]
    return np.asarray(np.concatenate(parts) * size[:, None, None] ** 2 * units[:, :, None] * units[:, None, :])


def _followers(contour: NDArray[np.int64]) -> NDArray[np.int64]:
    """Index of the next point around the same contour."""
    following = np.arange(1, len(contour) + 1)
    first = np.flatnonzero(np.r_[True, np.diff(contour) != 0])
    following[np.r_[first[1:], len(contour)] - 1] = first
    return following


def _solved(start: Array, contour: NDArray[np.int64]) -> Array:
    following = _followers(contour)
    end = start[:, following]
    step = end - start
    length = np.linalg.norm(step, axis=2)
    middle = (start + end) / 2.0
    single, domain = _influence(middle, start, step / length[..., None], length, following)
    s, n = length.shape
    bodies = int(contour.max()) + 1
    own = (contour[:, None] == np.arange(bodies)).astype(float)
    twice = start[..., 0] * end[..., 1] - start[..., 1] * end[..., 0]
    matrix = np.zeros((s, n + bodies, n + bodies))
    matrix[:, :n, :n] = single
    matrix[:, :n, n:] = -own
    matrix[:, n:, :n] = own.T * length[:, None, :]
    known = np.zeros((s, n + bodies, 3))
    known[:, :n, 0], known[:, :n, 1] = middle[..., 1], -middle[..., 0]
    known[:, :n, 2] = domain - np.sum(middle**2, axis=2) / 2.0
    known[:, n:, 2] = twice @ own
    density = np.linalg.solve(matrix, known)[:, :n]
    square = np.sum(start**2 + start * end + end**2, axis=2) / 3.0
    f = np.stack([middle[..., 1], -middle[..., 0], -square / 2.0], axis=2)
    energy = -np.einsum("sni,snj,sn->sij", density, f, length) - _inside(start, end, twice)
    return np.asarray((energy + energy.transpose(0, 2, 1)) / 2.0)


def _influence(
    middle: Array, start: Array, along: Array, length: Array, following: NDArray[np.int64]
) -> tuple[Array, Array]:
    """Single layer (s, n, n) of every element at every middle, and the domain term of roll (s, n).

    Over an element the integral of ln r is b ln r_b - a ln r_a - h + d (angle), with a and b along it from the foot of
    the point, d its distance. The area integral of ln r / 2 pi turns into the same integrals, d (2 L - h) / 8 pi.
    """
    y = middle[:, :, None, 0] - start[:, None, :, 0]
    z = middle[:, :, None, 1] - start[:, None, :, 1]
    ty, tz, h = along[:, None, :, 0], along[:, None, :, 1], length[:, None, :]
    u, d = y * ty + z * tz, y * tz - z * ty
    log = np.log(y * y + z * z) / 2.0
    a, b = -u, h - u
    integral = b * log[:, :, following] - a * log - h + d * np.arctan2(d * h, d * d + a * b)
    domain = -np.sum(d * (2.0 * integral - h), axis=2) / (4.0 * np.pi)
    return integral / (2.0 * np.pi), domain


def _inside(start: Array, end: Array, twice: Array) -> Array:
    """Area integrals of grad f_i grad f_j + f_j laplace f_i, (s, 3, 3)."""
    area = twice.sum(axis=1) / 2.0
    first = np.einsum("sn,snk->sk", twice, start + end) / 6.0
    polar = np.sum(twice * np.sum(start**2 + start * end + end**2, axis=2), axis=1) / 12.0
    out = np.zeros((len(area), 3, 3))
    out[:, 0, 0] = out[:, 1, 1] = area
    out[:, 2, 0], out[:, 0, 2] = -3.0 * first[:, 1], -first[:, 1]
    out[:, 2, 1], out[:, 1, 2] = 3.0 * first[:, 0], first[:, 0]
    out[:, 2, 2] = 2.0 * polar
    return out
