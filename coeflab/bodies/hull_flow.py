"""Flow about a hull that several methods share: added mass of its sections, boundary layer, what shed momentum does to fins.

Slender-body theory: R. T. Jones, NACA 835 (1946); Bryson (1954); fins on a round body: W. C. Pitts, J. N. Nielsen,
G. E. Kaattari, NACA 1307 (1957).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from coeflab.bodies.closed_forms import lamb_end_correction, low_aspect_lift_slope
from coeflab.bodies.outline import Foil, Outline, Sections
from coeflab.core.types import Array, brief, locked
from coeflab.law.transforms import moved

# Shape factors: one-seventh power law; halfway from 1.4, measured on flat plates, to 2.4 at separation.
FLAT, STERN = 9.0 / 7.0, 1.9
FALLING = 0.99  # of the largest section: from there aft the pressure rises
LOWEST_REYNOLDS = 1e3  # the line is not defined at 100
SAME = 1e-3  # of a span


def friction_line(reynolds: float) -> float:
    """C_F of a smooth surface, ITTC 1957: 0.075 / (log10 Re - 2)^2."""
    return float(0.075 / (np.log10(max(reynolds, LOWEST_REYNOLDS)) - 2.0) ** 2)


def integral(values: Array, x: Array) -> Array:
    """Over falling stations x (m,), of values (..., m): from the aftmost to the foremost."""
    step = x[:-1] - x[1:]
    return np.asarray((values[..., :-1] + values[..., 1:]) @ step / 2.0)


@brief
@dataclass(frozen=True, slots=True, eq=False)
class HullFlow:
    """A hull in a stream of speed U.

    Attributes
    ----------
    hull : Sections
    density, friction : float
        kg/m^3; C_F on its length.
    sway, heave : (m,) array
        Added mass of each section, kg/m, of the ellipse of its breadth and depth.
    surface, momentum : (m,) array
        Of what lies ahead of each station: wetted surface, and momentum area of the boundary layer, m^2.
    """

    hull: Sections
    density: float
    friction: float
    sway: Array
    heave: Array
    surface: Array
    momentum: Array

    def __post_init__(self) -> None:
        for name in ("sway", "heave", "surface", "momentum"):
            object.__setattr__(self, name, locked(getattr(self, name)))

    @property
    def volume(self) -> float:
        """m^3."""
        return float(integral(self.hull.area, self.hull.x))

    @property
    def axis(self) -> Array:
        """Centre of volume across x, (y, z), m."""
        return np.asarray(integral(self.hull.area * self.hull.centre.T, self.hull.x) / self.volume)

    @property
    def diameter(self) -> float:
        """Of the circle of the largest section, m."""
        return float(2.0 * np.sqrt(self.hull.area.max() / np.pi))

    @property
    def added_mass(self) -> Array:
        """(6, 6) about the datum, kg, kg m, kg m^2: sections with Lamb's k1, k2 and k' of the spheroid of equal volume."""
        x, k = self.hull.x, lamb_end_correction(self.hull.length, self.volume)
        out = np.zeros((6, 6))
        out[0, 0] = k.axial * self.density * self.volume
        middle = float(integral(self.hull.area * x, x)) / self.volume
        lever = x - middle
        for row, turn, mass, sign in ((1, 5, self.sway, 1.0), (2, 4, self.heave, -1.0)):
            out[row, row] = k.lateral * integral(mass, x)
            out[turn, turn] = k.turning * integral(mass * lever**2, x)
            out[row, turn] = out[turn, row] = sign * k.lateral * integral(mass * lever, x)
        return moved(out, -np.array([middle, *self.axis]))

    @property
    def apparent(self) -> float:
        """k2 - k1 of the spheroid of the same length and volume."""
        k = lamb_end_correction(self.hull.length, self.volume)
        return k.lateral - k.axial

    def at(self, values: Array, x: float) -> float:
        """A value of the sections at a station; zero off the hull."""
        return float(np.interp(x, self.hull.x[::-1], values[::-1], left=0.0, right=0.0))

    def shape_factor(self, x: float) -> float:
        """Displacement over momentum thickness: of a flat plate, or of the stern, where the sections fall off."""
        largest = int(np.argmax(self.hull.area))
        falling = x < self.hull.x[largest] and self.at(self.hull.area, x) < FALLING * self.hull.area.max()
        return STERN if falling else FLAT

    def thickness(self, x: float, radius: float) -> float:
        """Of the boundary layer at a station where the hull has that radius, m, from its momentum area and a power law."""
        stations = np.clip(x, self.hull.x[-1], self.hull.x[0])
        area = float(np.interp(stations, self.hull.x[::-1], self.momentum[::-1]))
        n = 2.0 / (self.shape_factor(x) - 1.0)
        plane, ring = n / ((n + 1.0) * (n + 2.0)), n / (2.0 * n + 1.0) - n / (2.0 * n + 2.0)
        return float((np.sqrt((radius * plane) ** 2 + 2.0 * ring * area / np.pi) - radius * plane) / (2.0 * ring))

    def pressure_share(self, x: float, radius: float, low: float, high: float) -> float:
        """Mean of (u/U)^2 between two heights above the hull, m."""
        n, layer = 2.0 / (self.shape_factor(x) - 1.0), self.thickness(x, radius)
        if layer <= 0.0 or high <= low:
            return 1.0
        power = 2.0 / n + 1.0
        inside = [layer * min(h / layer, 1.0) ** power / power + max(h - layer, 0.0) for h in (low, high)]
        return float((inside[1] - inside[0]) / (high - low))


def hull_flow(hull: Sections, density: float, viscosity: float, speed: float) -> HullFlow:
    """The flow about one hull.

    Parameters
    ----------
    hull : Sections
    density, viscosity, speed : float
        kg/m^3, m^2/s, m/s.
    """
    friction = friction_line(speed * hull.length / viscosity)
    mean = hull.girth / (2.0 * np.pi)
    slant = np.hypot(np.diff(hull.x), np.diff(mean))
    surface = np.concatenate([[0.0], np.cumsum((hull.girth[:-1] + hull.girth[1:]) / 2.0 * slant)])
    return HullFlow(
        hull, density, friction, density * np.pi / 4.0 * hull.depth**2, density * np.pi / 4.0 * hull.breadth**2,
        surface, friction * surface / 2.0,
    )  # fmt: skip


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


def carrier(outline: Outline, stand: Array, x: float) -> Sections | None:
    """The hull that something at a station stands on or follows; None where there is none."""
    for hull in outline.hulls:
        near = np.array([np.interp(x, hull.x[::-1], hull.centre[::-1, i]) for i in range(2)])
        largest = max(hull.breadth.max(), hull.depth.max())
        if np.hypot(*(near - stand)) < 0.5 * largest and hull.x[-1] - 0.1 * hull.length < x <= hull.x[0]:
            return hull
    return None
