"""Foils in pairs across a body: which share an axis, their lift with a round body between, and the hull that carries them.

Slender-body theory: R. T. Jones, NACA 835 (1946); Bryson (1954); fins on a round body: W. C. Pitts, J. N. Nielsen, G. E. Kaattari, NACA 1307 (1957).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from coeflab.bodies.outline import Foil, Outline, Sections
from coeflab.core.types import Array, brief

SAME = 1e-3  # of a span
LIFT_LOSS = 0.9  # of 2 pi, by Whicker & Fehlner


@brief
@dataclass(frozen=True, slots=True, eq=False)
class FinGroup:
    """A pair of opposite foils on one axis, or a single foil.

    Attributes
    ----------
    foils : tuple of Foil
        One or two, alike.
    radius, reach : float
        Of the hull at the root and of the tip, from the axis, m.
    direction, normal : (3,) array
        From root to tip of the first; x cross it.
    quarter : float
        x of the centre of lift, m.
    aspect, slope : float
        Of a foil with its mirror image, and its lift slope there, per rad of exposed area.
    """

    foils: tuple[Foil, ...]
    radius: float
    reach: float
    direction: Array
    normal: Array
    quarter: float
    aspect: float
    slope: float

    @property
    def area(self) -> float:
        """Exposed, of all, m^2."""
        return sum(f.area for f in self.foils)

    @property
    def carried(self) -> float:
        """Lift of foils and hull over that of the foils with their mirror image: slender-body theory.

        (1 + r/s)^2 of a pair (NACA 1307, equation 4 with K_W + K_B), ((1 + r/s)^2 + 4 r/s) / 2 of a single one.
        """
        ratio = self.radius / self.reach
        pair = (1.0 + ratio) ** 2
        return pair if len(self.foils) == 2 else (pair + 4.0 * ratio) / 2.0

    @property
    def own(self) -> float:
        """Share of the carried lift that the foils themselves take: K_W / (1 + r/s)^2."""
        ratio = self.radius / self.reach
        return foil_on_body(ratio) / (1.0 + ratio) ** 2

    @property
    def turned(self) -> float:
        """Lift of foils and hull of turned foils over that of the foils with their mirror image: K_W, by reverse flow.

        A single foil alone has half the span of the pair: half, as its lift on incidence without a hull.
        """
        ratio = self.radius / self.reach
        return foil_on_body(ratio) * (self.carried / (1.0 + ratio) ** 2)

    @property
    def finite(self) -> float:
        """Its lift slope over that of slender-body theory, pi a / 2."""
        return self.slope / (np.pi * self.aspect / 2.0)

    def seen(self, height: float) -> float:
        """Share of a trailing vortex's lateral momentum about the bare hull that foils and hull take up.

        1 - psi_foils / psi_hull, of the stream functions of the flow across them at the vortex, at ``height`` along the
        direction of the first foil (negative: on the other side).
        """
        r, z = self.radius, height
        hull = abs(z - r**2 / z)
        past = _past_foils(np.array([complex(z)]), r, self.reach, len(self.foils))
        return float(1.0 - abs(past[0]) / hull)

    def seen_around(self, radius: float) -> float:
        """The same of a vortex sheet about the hull at a radius, of strength as the sine of the angle."""
        angle = (np.arange(32) + 0.5) * np.pi / 32.0 - np.pi / 2.0
        z = np.asarray(radius * np.exp(1j * np.concatenate([angle, angle + np.pi])), dtype=np.complex128)
        weight = np.abs(z.real)
        hull = np.abs((z - self.radius**2 / z).real)
        foils = np.abs(_past_foils(z, self.radius, self.reach, len(self.foils)))
        return float(1.0 - (weight @ foils) / (weight @ hull)) if weight @ hull > 0.0 else 1.0


def _past_foils(z: NDArray[np.complex128], radius: float, reach: float, count: int) -> Array:
    """Stream function of unit flow across a circle with one or two foils along the real axis, at z."""
    mapped = z + radius**2 / z
    tip = reach + radius**2 / reach
    middle, half = (0.0, tip) if count == 2 else ((tip - 2.0 * radius) / 2.0, (tip + 2.0 * radius) / 2.0)
    root = np.sqrt(mapped - middle - half) * np.sqrt(mapped - middle + half)
    return np.asarray(root.real)


def foil_on_body(ratio: float) -> float:
    """K_W of NACA 1307 by slender-body theory: lift of the foils on a round body over that of the foils alone.

    Parameters
    ----------
    ratio : float
        Radius of the body over the reach of the tips.
    """
    if ratio < SAME:
        return 1.0 + ratio
    if ratio > 1.0 - SAME:
        return 2.0
    t, u = ratio, 1.0 / ratio
    first = (1.0 + t**4) * (0.5 * np.arctan(0.5 * (u - t)) + np.pi / 4.0)
    second = t**2 * ((u - t) + 2.0 * np.arctan(t))
    return float(2.0 / np.pi * (first - second) / (1.0 - t) ** 2)


def fin_groups(outline: Outline) -> tuple[FinGroup, ...]:
    """The foils of an outline, opposite ones in pairs."""
    left, out = list(outline.foils), []
    while left:
        one = left.pop(0)
        twin = next((f for f in left if _opposite(one, f)), None)
        if twin is not None:
            left.remove(twin)
        out.append(_group((one,) if twin is None else (one, twin)))
    return tuple(out)


def _opposite(a: Foil, b: Foil) -> bool:
    size = SAME * 10.0 * max(a.span, a.root_chord)
    if abs(a.root[0] - b.root[0]) > size or abs(a.root_chord - b.root_chord) > size:
        return False
    if np.hypot(*(a.stand - b.stand)) > size and not _standing_alone(a, b):
        return False
    middle = a.stand if not _standing_alone(a, b) else (a.root[1:] + b.root[1:]) / 2.0
    return bool(np.hypot(*(a.tip[1:] + b.tip[1:] - 2.0 * middle)) < size)


def _standing_alone(a: Foil, b: Foil) -> bool:
    """Halves of a wing that meet at their roots."""
    return bool(np.hypot(*(a.root[1:] - b.root[1:])) < SAME * (a.span + b.span) and np.allclose(a.root[1:], a.stand))


def _group(foils: tuple[Foil, ...]) -> FinGroup:
    f = foils[0]
    out = f.tip - f.root
    across = out * np.array([0.0, 1.0, 1.0])
    direction = across / np.linalg.norm(across)
    radius = float(np.hypot(*(f.root[1:] - f.stand)))
    aspect = 2.0 * f.span**2 / f.area
    sweep = float(np.arctan2(-out[0], f.span))
    quarter = float(f.root[0] + 4.0 / (3.0 * np.pi) * out[0])
    return FinGroup(
        foils, radius, radius + f.span, direction, np.cross([1.0, 0.0, 0.0], direction), quarter, aspect,
        low_aspect_lift_slope(aspect, sweep),
    )  # fmt: skip


def left_behind_fins(outline: Outline, centre: Array, diameter: float, row: int) -> float:
    """Share of the cross velocity along y (1) or z (2) that is left in a circle behind pairs of fins which reach beyond it.

    Parameters
    ----------
    outline : Outline
    centre : (3,) array
        Of the circle, across x, m.
    diameter : float
        m.
    row : int
    """
    left = 1.0
    for group in fin_groups(outline):
        near = np.hypot(*(group.foils[0].stand - centre[1:])) < diameter / 2.0
        ahead = centre[0] < group.quarter < centre[0] + 2.0 * group.reach
        if len(group.foils) == 2 and near and ahead and group.reach > diameter / 2.0:
            left *= 1.0 - min(group.finite, 1.0) * float(group.normal[row]) ** 2
    return left


def carrier(outline: Outline, stand: Array, x: float) -> Sections | None:
    """The hull that something at a station stands on or follows; None where there is none."""
    for hull in outline.hulls:
        near = np.array([np.interp(x, hull.x[::-1], hull.centre[::-1, i]) for i in range(2)])
        largest = max(hull.breadth.max(), hull.depth.max())
        if np.hypot(*(near - stand)) < 0.5 * largest and hull.x[-1] - 0.1 * hull.length < x <= hull.x[0]:
            return hull
    return None


def low_aspect_lift_slope(aspect: float, sweep: float = 0.0) -> float:
    """Slope of the lift coefficient of a wing of low aspect ratio over the angle of attack, per rad.

    Parameters
    ----------
    aspect : float
        Span squared over area; of a plane on a wall with its mirror image, twice that of the plane alone.
    sweep : float
        Of the quarter-chord line, rad.

    Notes
    -----
    L. F. Whicker, L. F. Fehlner, DTMB Report 933 (1958), equation 1, with a0 = 0.9 (2 pi) per rad:
    a0 a / (cos S sqrt(a^2 / cos^4 S + 4) + a0 / pi).
    """
    c = float(np.cos(sweep))
    a0 = LIFT_LOSS * 2.0 * np.pi
    return float(a0 * aspect / (c * np.sqrt(aspect**2 / c**4 + 4.0) + a0 / np.pi))
