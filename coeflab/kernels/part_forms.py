"""Which simple form a closed surface resembles, and the form's dimensions; arrays in, arrays out."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from coeflab.kernels.attitude import about_axis, relabelled
from coeflab.kernels.least_squares import Array
from coeflab.kernels.oriented_box import oriented_box
from coeflab.kernels.surface_mesh import Faces, MeshIntegrals, mesh_integrals

THIN = 0.2
ROUND = 0.85
FULL_CYLINDER, BOXY = 0.85, 0.87
ELLIPSOID_FILL, ELLIPSOID_SPREAD = (0.42, 0.63), (0.15, 0.25)
ALIKE = 0.02
LONG, SKEWED, ACROSS = 2.0, np.radians(20.0), 0.3


@dataclass(frozen=True, slots=True)
class Likeness:
    """A form and the numbers that chose it.

    Attributes
    ----------
    form : str
        ``cylinder`` (radius, length), ``plate`` (chord, span), ``ellipsoid`` (semi-axes) or ``box`` (sides).
    sizes : tuple of float
        m.
    rotation : (3, 3) array
        From the form's axes to the outer ones.
    centre : (3,) array
        m.
    clear : bool
        False where no test held and the nearest of ellipsoid and box stands in.
    reason : str
        The test that held, in words and numbers.
    """

    form: str
    sizes: tuple[float, ...]
    rotation: Array
    centre: Array
    clear: bool
    reason: str


def likeness(vertices: Array, faces: Faces) -> Likeness:
    """Classify a closed surface and fit the form.

    Notes
    -----
    With sides e1 >= e2 >= e3 of the oriented box: a plate where e3 < 0.2 e2; a cylinder where the sides across its
    axis agree to 0.85, V / (pi/4 side^2 length) > 0.85 and V / box < 0.87; an ellipsoid where V / box lies in
    0.42-0.63 (pi/6 = 0.52) and the mean second moment over the half-sides squared in 0.15-0.25 (1/5); a box where
    V / box > 0.87; else the nearer of ellipsoid and box.

    A cylinder keeps volume and projected area across its axis, hence r = 2 V / (pi A), L = A / (2 r). A plate keeps the
    area and centre of the projection along its normal, and the ratio of its second moments along chord and span. An ellipsoid and a box keep the volume, and the
    second moments up to one factor.
    """
    whole = mesh_integrals(vertices, faces)
    spread, axes = np.linalg.eigh(whole.second_moments / whole.volume)
    turn, sides, _ = oriented_box(vertices, axes)
    if sides[2] < THIN * sides[1]:
        return _plate(vertices, faces, axes[:, ::-1], sides)
    odd = _odd_axis(spread)
    axis = axes[:, odd]
    around = _across(vertices, axis)
    length = float(np.ptp(vertices @ axis))
    fill = whole.volume / float(np.prod(sides))
    full = whole.volume / (np.pi * around[0] * around[1] / 4.0 * length)
    if around[1] > ROUND * around[0] and full > FULL_CYLINDER and fill < BOXY:
        reason = f"sides across {around[1] / around[0]:.2f}, V/(pi r^2 L) {full:.2f}, V/box {fill:.2f}"
        return _cylinder(vertices, faces, about_axis(axis), whole, reason)
    stretch = float(np.mean(np.linalg.eigvalsh(whole.second_moments / whole.volume)[::-1] / (sides / 2.0) ** 2))
    reason = f"V/box {fill:.2f}, second moments {stretch:.2f} of the half-sides squared"
    if ELLIPSOID_FILL[0] < fill < ELLIPSOID_FILL[1] and ELLIPSOID_SPREAD[0] < stretch < ELLIPSOID_SPREAD[1]:
        return _by_moments("ellipsoid", whole, True, reason)
    if fill > BOXY:
        return _by_moments("box", whole, True, reason, turn)
    nearest = "ellipsoid" if fill < (np.pi / 6.0 + 1.0) / 2.0 else "box"
    return _by_moments(nearest, whole, False, reason, turn if nearest == "box" else None)


def _odd_axis(spread: Array) -> int:
    """The axis whose two neighbours are most alike."""
    gaps = [abs(spread[(i + 1) % 3] / spread[(i + 2) % 3] - 1.0) for i in range(3)]
    gaps[1] = abs(spread[2] / spread[0] - 1.0)
    return int(np.argmin(gaps))


def _across(vertices: Array, axis: Array) -> tuple[float, float]:
    """Largest and smallest width of a body across an axis, m, over 36 directions."""
    turn = about_axis(axis)
    angle = np.pi * np.arange(36) / 36.0
    widths = np.ptp(vertices @ (turn[:, 1:] @ np.vstack([np.cos(angle), np.sin(angle)])), axis=0)
    return float(widths.max()), float(widths.min())


def _cylinder(vertices: Array, faces: Faces, turn: Array, whole: MeshIntegrals, reason: str) -> Likeness:
    shadows = mesh_integrals(vertices @ turn, faces).projected
    across = float(shadows[1] + shadows[2]) / 2.0
    radius = 2.0 * whole.volume / (np.pi * across)
    return Likeness("cylinder", (radius, across / (2.0 * radius)), turn, whole.centre, True, reason)


def _plate(vertices: Array, faces: Faces, turn: Array, sides: Array) -> Likeness:
    """Chord and span from the area and second moments of the projection along the normal; the chord is fore and aft."""
    normal = turn[:, 2]
    local = vertices @ turn
    a, b, c = (local[faces[:, k], :2] for k in range(3))
    u, v = b - a, c - a
    weight = np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) / 4.0
    area, total = float(weight.sum()), a + b + c
    middle = weight @ total / (3.0 * area)
    second = sum((p - middle).T @ ((p - middle) * weight[:, None]) for p in (a, b, c))
    second = (second + (total - 3.0 * middle).T @ ((total - 3.0 * middle) * weight[:, None])) / (12.0 * area)
    axes = relabelled(np.column_stack([turn[:, :2] @ _chordwise(second, turn), normal]), normal=True)
    along = axes[:, 0] @ turn[:, :2]
    chord_spread = float(along @ second @ along)
    chord = float(np.sqrt(area * np.sqrt(chord_spread / (float(np.trace(second)) - chord_spread))))
    whole = mesh_integrals(vertices, faces)
    centre = turn[:, :2] @ middle + normal * float(normal @ whole.centre)
    reason = f"thickness {sides[2] / sides[1]:.3f} of the shorter side"
    return Likeness("plate", (chord, area / chord), axes, centre, True, reason)


def _chordwise(second: Array, turn: Array) -> Array:
    """(2, 2) axes within a plate from its second moments in the first two columns of ``turn``.

    One lies fore and aft (athwart on a plate across x), unless the plate is more than twice as long as wide and that
    length is more than 20 deg off both axes, as on swept wings and struts: then the principal axes.
    """
    ahead = turn[:, :2].T @ np.array([1.0, 0.0, 0.0])
    if np.linalg.norm(ahead) < ACROSS:
        ahead = turn[:, :2].T @ np.array([0.0, 1.0, 0.0])
    ahead /= np.linalg.norm(ahead)
    spread, principal = np.linalg.eigh(second)
    off = float(np.arccos(min(1.0, abs(float(principal[:, 1] @ ahead)))))
    if spread[1] > LONG**2 * spread[0] and SKEWED < off < np.pi / 2.0 - SKEWED:
        return np.asarray(principal)
    return np.column_stack([ahead, [-ahead[1], ahead[0]]])


def _by_moments(form: str, whole: MeshIntegrals, clear: bool, reason: str, turn: Array | None = None) -> Likeness:
    """Ellipsoid or box of the surface's volume with second moments in its proportions."""
    spread, axes = np.linalg.eigh(whole.second_moments / whole.volume)
    odd = _odd_axis(spread)
    pair = [i for i in range(3) if i != odd]
    if spread[2] < (1.0 + ALIKE) * spread[0]:
        axes = np.eye(3) if turn is None else relabelled(turn)
    elif abs(spread[pair[0]] / spread[pair[1]] - 1.0) < ALIKE and turn is None:
        axes = about_axis(axes[:, odd])
    else:
        axes = relabelled(axes if turn is None else turn)
    along = np.einsum("ji,jk,ki->i", axes, whole.second_moments / whole.volume, axes)
    half = np.sqrt(along)
    unit = 4.0 * np.pi / 3.0 if form == "ellipsoid" else 1.0
    sizes = half * np.cbrt(whole.volume / (unit * float(np.prod(half))))
    return Likeness(form, tuple(float(s) for s in sizes), axes, whole.centre, clear, reason)
