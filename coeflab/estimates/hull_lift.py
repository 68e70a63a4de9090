"""Force and moment of hulls at an angle and in a turn: ideal fluid, and what separation and the boundary layer take from it.

The ideal fluid gives -C_A(nu) nu: the Munk moment, once, and its rotary parts. A real stern does not give its cross momentum
back: what is shed is a side force there, and what it takes from the moment follows. How much is shed, three works say
differently; fins behind it take part of it up again.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from coeflab.bodies.fin_lift import carrier, fin_groups
from coeflab.bodies.hull_flow import HullFlow, hull_flow, integral, surge
from coeflab.bodies.outline import Outline
from coeflab.core.types import Array, brief, locking
from coeflab.estimates import Contribution, Water
from coeflab.law.rigid_body import ideal_force

summary = "hulls at an angle and in a turn: Munk moment, and shed momentum by Allen & Perkins, Hopkins, displacement"
citations = ("munk1924", "allen1951", "hopkins1951", "pitts1957", "lighthill1960")

IDEAL_SHARE, SHED_SHARE = 0.10, 0.20
HOPKINS = (0.378, 0.527)
BLUNT = 0.02  # base area over the largest section
SLENDER, RANGE = 3.0, "length over diameter {:.2g} is below 3"


def hopkins_station(hull_x: Array, area: Array) -> float:
    """Where the flow ceases to be potential: x0/l = 0.378 + 0.527 x1/l from the nose, x1 where dS/dx is most negative.

    Parameters
    ----------
    hull_x : (m,) array
        Falling stations, m.
    area : (m,) array
        Of the sections, m^2.
    """
    slope = np.diff(area) / -np.diff(hull_x)
    steepest = int(np.argmin(slope))
    length = hull_x[0] - hull_x[-1]
    x1 = hull_x[0] - (hull_x[steepest] + hull_x[steepest + 1]) / 2.0
    return float(hull_x[0] - (HOPKINS[0] * length + HOPKINS[1] * x1))


@brief
@dataclass(frozen=True, slots=True, eq=False)
@locking("sway heave")
class Shed:
    """Cross momentum that a hull leaves in the water.

    Attributes
    ----------
    flow : HullFlow
    start : float
        x from which it is shed, m; the sections' momentum aft of it is not given back.
    sway, heave : (m,) array
        Momentum of each section per cross velocity, kg/m, of what is shed.
    grows : bool
        It grows from the nose with the boundary layer, in the place of being cut off at ``start``.
    taken : tuple of (x, share, (3,) array)
        By foils and rings behind: where, how much of what is shed ahead of them, along which normal.
    """

    flow: HullFlow
    start: float
    sway: NDArray[np.float64]
    heave: NDArray[np.float64]
    grows: bool
    taken: tuple[tuple[float, float, NDArray[np.float64]], ...] = ()

    def __call__(self, nu: Array, angles: dict[str, Array]) -> Array:
        """Forces about the datum, (n, 6); none astern, where the other end would be the stern."""
        flow = self.flow
        x, (y, z) = flow.hull.x, flow.axis
        out = np.zeros((len(nu), 6))
        ahead = np.maximum(surge(flow.axis, nu), 0.0)
        velocity = ((nu[:, 1] - nu[:, 3] * z, nu[:, 5]), (nu[:, 2] + nu[:, 3] * y, -nu[:, 4]))
        for row, turn, sign, mass, (still, rate) in (
            (1, 5, 1.0, self.sway, velocity[0]), (2, 4, -1.0, self.heave, velocity[1])
        ):  # fmt: skip
            weight, lever, end = self._moments(mass)
            force = -ahead * (still * weight[0] + rate * weight[1])
            moment = -ahead * (end * (still * weight[0] + rate * weight[1]) - still * lever[0] - rate * lever[1])
            out[:, row] += force
            out[:, turn] += sign * moment
            out[:, 3] += (y if row == 2 else -z) * force
        for place, share, normal in self.taken:
            for row, mass in ((1, self.sway), (2, self.heave)):
                along = abs(normal[row])
                if along < 1e-9:
                    continue
                still, rate = velocity[row - 1]
                total, turned = self._ahead_of(mass, place)
                force = along**2 * share * ahead * (still * total + rate * turned)
                out[:, row] += force
                out[:, 6 - row] += (1.0 if row == 1 else -1.0) * place * force
                out[:, 3] += (y if row == 2 else -z) * force
        del x, angles
        return out

    def _moments(self, mass: Array) -> tuple[tuple[float, float], tuple[float, float], float]:
        """Momentum shed by unit still velocity and unit rate, integrals that take from its moment, and its end."""
        x = self.flow.hull.x
        if self.grows:
            end = float(x[-1])
            whole = float(mass[-1])
            return (whole, whole * end), (-float(integral(mass, x)), -float(integral(mass * x, x))), end
        begin = self.flow.at(mass, self.start) if self.start > x[-1] else float(mass[-1])
        aft = np.where(x <= self.start, mass, 0.0)
        fine = np.concatenate([[self.start], x[x < self.start]])
        values = np.concatenate([[begin], aft[x < self.start]])
        lever = (float(integral(values, fine)), float(integral(values * fine, fine))) if len(fine) > 1 else (0.0, 0.0)
        return (begin, begin * self.start), lever, self.start

    def _ahead_of(self, mass: Array, place: float) -> tuple[float, float]:
        """What is shed ahead of a station, by unit still velocity and unit rate."""
        x = self.flow.hull.x
        at = float(np.interp(place, x[::-1], mass[::-1]))
        if self.grows:
            return at, at * min(max(place, float(x[-1])), float(x[0]))
        if place >= self.start:
            return 0.0, 0.0
        begin = self.flow.at(mass, self.start) if self.start > x[-1] else float(mass[-1])
        left = at if place >= x[-1] else 0.0
        return begin - left, begin * self.start - left * place


def contributions(outline: Outline, water: Water) -> tuple[Contribution, ...]:
    """The ideal fluid and what is shed, by three works, of every hull.

    Parameters
    ----------
    outline : Outline
    water : Water
    """
    out = []
    for hull in outline.hulls:
        flow = hull_flow(hull, water.density, water.viscosity, water.speed)
        fineness = hull.length / flow.diameter
        outside = "" if fineness >= SLENDER else RANGE.format(fineness)
        ideal: Callable[[Array, dict[str, Array]], Array] = partial(_ideal, flow.added_mass)
        out.append(
            Contribution(
                hull.name, "ideal fluid", "hull_lift", ideal, IDEAL_SHARE, "munk1924, lamb1932",
                "-C_A(nu) nu, k1, k2 and k' of the spheroid of equal volume", outside,
            )
        )  # fmt: skip
        works = (("Allen & Perkins", _base(flow), "allen1951", "no lift of a closed stern; that of a base"),
                 ("Hopkins", _cut(flow), "hopkins1951", "x0/l = 0.378 + 0.527 x1/l"),
                 ("displacement", _displaced(flow), "lighthill1960", "slender body with its displacement area"))  # fmt: skip
        for name, shed, work, place in works:
            taken = _taken(outline, flow)
            ways = {"": ()} if not taken else {", fins as NACA 1307": (), ", taken up by fins": taken}
            for way, by in ways.items():
                force = Shed(shed.flow, shed.start, shed.sway, shed.heave, shed.grows, by)
                method = f"hull_lift, {name}{way}"
                out.append(Contribution(hull.name, "hull lift", method, force, SHED_SHARE, work, place, outside))
    return tuple(out)


def _ideal(matrix: Array, nu: Array, angles: dict[str, Array]) -> Array:  # noqa: ARG001 - as forces are
    return ideal_force(matrix, nu)


def _base(flow: HullFlow) -> Shed:
    """A blunt base sheds its section; a closed stern nothing."""
    blunt = float(flow.hull.area[-1] > BLUNT * flow.hull.area.max())
    end = float(flow.hull.x[-1])
    return Shed(flow, end, blunt * flow.apparent * flow.sway, blunt * flow.apparent * flow.heave, False)


def _cut(flow: HullFlow) -> Shed:
    start = hopkins_station(flow.hull.x, flow.hull.area)
    return Shed(flow, start, flow.apparent * flow.sway, flow.apparent * flow.heave, False)


def _displaced(flow: HullFlow) -> Shed:
    """The boundary layer displaces the stream; its area grows to the tail and is not given back."""
    shape = np.array([flow.shape_factor(float(x)) for x in flow.hull.x])
    mass = flow.density * shape * flow.momentum
    return Shed(flow, float(flow.hull.x[-1]), mass, mass, True)


def _taken(outline: Outline, flow: HullFlow) -> tuple[tuple[float, float, Array], ...]:
    """Of the shed momentum, what fins on the stern and rings about it take up (slender-body theory, NACA 1307).

    The vorticity lies about the hull, half the boundary layer away from it.
    """
    out, left = [], {1: 1.0, 2: 1.0}
    for group in fin_groups(outline):
        x = group.quarter
        if group.radius <= 0.0 or carrier(outline, group.foils[0].stand, x) is not flow.hull:
            continue
        layer = flow.thickness(x, group.radius)
        dynamic = flow.pressure_share(x, group.radius, 0.0, group.reach - group.radius)
        share = group.seen_around(group.radius + layer / 2.0) * group.finite * dynamic
        out.append((x, share, group.normal))
        for row in left:
            left[row] *= 1.0 - share * float(group.normal[row]) ** 2
    for ring in outline.rings:
        if carrier(outline, ring.centre[1:], float(ring.centre[0])) is flow.hull:
            out += [(float(ring.centre[0]), left[row], np.eye(3)[row]) for row in (1, 2)]
    return tuple(out)
