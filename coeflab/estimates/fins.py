"""Fins, sails and control surfaces: lift of low aspect on a hull, its loss behind other foils, cross-flow and induced drag.

Free-stream lift of foil and mirror image by Whicker & Fehlner; carried over to and from the hull by slender-body theory
(Pitts, Nielsen & Kaattari), with the dynamic pressure of the hull's boundary layer where they stand; behind the tip vortices
of the foils ahead. A foil that turns with the body has the incidence of its three-quarter chord (Glauert 1926).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from coeflab.bodies.fin_lift import FinGroup, carrier, fin_groups
from coeflab.bodies.hull_flow import HullFlow, hull_flow
from coeflab.bodies.outline import Foil, Outline, Sections
from coeflab.core.types import Array, brief, locking
from coeflab.estimates import Contribution, Water

summary = "fins and sails of low aspect on a hull, control surfaces, loss behind other foils and in the boundary layer"
citations = ("whicker1958", "pitts1957", "glauert1926")

LIFT_SHARE, DRAG_SHARE, WASH_SHARE, CONTROL_SHARE = 0.20, 0.50, 0.50, 0.20
EACH, PLACE = 0.10, 0.02  # NACA 1307: lifts within 10 %, centres of pressure within 0.02 of the body's length
STRIPS = 8
CENTRE = 4.0 / (3.0 * np.pi)  # of an elliptic load
ALONG = 0.9
ASPECTS = (0.5, 4.0)  # tested: 1 to 3
TIPS = {"square tips": (0.1, 1.6), "faired tips": (0.1, 0.7)}  # C_Dc = a + b taper
OSWALD = 0.9


def flap_effect(share: float) -> float:
    """Lift of a turned flap over that of the whole foil turned as much (Glauert 1926): 1 - (t - sin t) / pi, cos t = 2 c_f/c - 1.

    Parameters
    ----------
    share : float
        Chord of the flap over the whole.
    """
    t = float(np.arccos(np.clip(2.0 * share - 1.0, -1.0, 1.0)))
    return float(1.0 - (t - np.sin(t)) / np.pi)


def cross_flow_drag(taper: float, tips: str) -> float:
    """C_Dc of Whicker & Fehlner: C_L = slope alpha + C_Dc / a alpha^2, by taper and form of the tips."""
    base, slope = TIPS[tips]
    return base + slope * taper


@brief
@dataclass(frozen=True, slots=True, eq=False)
@locking("centre axis normal")
class FoilForce:
    """The force of one foil.

    Attributes
    ----------
    centre, axis : (3,) array
        Where its own lift acts, and where that which the hull carries does, m.
    half : float
        Half of its chord, m: its incidence is that of a point so far behind; astern the two change places.
    normal : (3,) array
        Unit, across foil and x.
    own, carried : float
        Lift per 1/2 rho u^2 and incidence, m^2: of the foil, of the hull beside it.
    turned, turned_carried : float
        The same per angle of its control.
    lifting, induced, cross : float
        Lift area of foil and hull, drag over lift by incidence, and force per 1/2 rho of cross velocity squared, m^2.
    turns : tuple of (str, float)
        Controls and the sign of each.
    density : float
    """

    centre: NDArray[np.float64]
    axis: NDArray[np.float64]
    half: float
    normal: NDArray[np.float64]
    own: float
    carried: float
    turned: float
    turned_carried: float
    lifting: float
    induced: float
    cross: float
    turns: tuple[tuple[str, float], ...]
    density: float

    def __call__(self, nu: Array, angles: Mapping[str, Array]) -> Array:
        """Forces about the datum, (n, 6)."""
        ahead = local(nu, self.axis)[:, 0]
        astern = ahead < 0.0
        behind = np.array([self.half, 0.0, 0.0])
        seen = local(nu, self.axis) @ self.normal
        rolling = local(nu, self.centre) @ self.normal - seen  # the hull carries none of a rolling foil's lift
        at_axis = np.where(astern, seen, local(nu, self.axis - behind) @ self.normal)
        angle = np.zeros(len(nu))
        for control, sign in self.turns:
            angle = angle + sign * angles.get(control, np.zeros(len(nu)))
        pressure, speed = 0.5 * self.density, np.abs(ahead)
        lift = speed * (self.own * (at_axis + rolling) + self.turned * ahead * angle)
        across = at_axis + rolling
        force = -pressure * (lift + self.cross * np.abs(across) * across)
        sideways = -pressure * speed * (self.carried * at_axis + self.turned_carried * ahead * angle)
        incidence = across * (self.own + self.carried) + ahead * angle * (self.turned + self.turned_carried)
        along = pressure * np.sign(ahead) * incidence * (across - self.induced * incidence / self.lifting)
        out = acting(force, self.normal, self.centre) + acting(sideways, self.normal, self.axis)
        out[:, 3:] -= np.cross(behind, (astern * (force + sideways))[:, None] * self.normal)
        return out + acting(along, np.array([1.0, 0.0, 0.0]), self.axis)


@brief
@dataclass(frozen=True, slots=True, eq=False)
@locking("ahead place source normal")
class Wash:
    """Lift that a group of foils loses in the wake of a foil ahead, per cross velocity at that foil.

    Attributes
    ----------
    ahead, place : (3,) array
        Where the velocity is, where the loss acts, m.
    source, normal : (3,) array
        Unit normals of the foil ahead and of the group.
    area, roll : float
        Per 1/2 rho u and cross velocity: of the force, m^2, and of the moment about x by which the foils differ, m^3.
    turned : tuple of (str, float)
        Controls of the foil ahead, and its incidence per angle of each.
    density : float
    """

    ahead: NDArray[np.float64]
    place: NDArray[np.float64]
    source: NDArray[np.float64]
    normal: NDArray[np.float64]
    area: float
    roll: float
    turned: tuple[tuple[str, float], ...]
    density: float

    def __call__(self, nu: Array, angles: Mapping[str, Array]) -> Array:
        """Forces about the datum, (n, 6)."""
        across = local(nu, self.ahead) @ self.source
        for control, turned in self.turned:
            across = across + turned * local(nu, self.ahead)[:, 0] * angles.get(control, np.zeros(len(nu)))
        pressure = 0.5 * self.density * np.maximum(local(nu, self.place)[:, 0], 0.0) * across
        out = acting(self.area * pressure, self.normal, self.place)
        out[:, 3] += self.roll * pressure
        return out


def local(nu: Array, place: Array) -> Array:
    """(n, 3) velocity of a point of the body."""
    return np.asarray(nu[:, :3] + np.cross(nu[:, 3:], place))


def acting(force: Array, direction: Array, place: Array) -> Array:
    """(n, 6) of (n,) forces along a direction at a place."""
    vectors = force[:, None] * direction
    return np.hstack([vectors, np.cross(place, vectors)])


def contributions(outline: Outline, water: Water) -> tuple[Contribution, ...]:
    """Lift, cross-flow and wash of every foil.

    Parameters
    ----------
    outline : Outline
    water : Water
    """
    groups = fin_groups(outline)
    flows: dict[int, HullFlow] = {}
    out: list[Contribution] = []
    for group in groups:
        flow = _flow(carrier(outline, group.foils[0].stand, group.quarter), water, flows)
        for foil in group.foils:
            out += _of_foil(foil, group, flow, water)
    for ahead in groups:
        for behind in groups:
            out += _washes(outline, ahead, behind, water, flows)
    return tuple(out)


def _flow(hull: Sections | None, water: Water, known: dict[int, HullFlow]) -> HullFlow | None:
    if hull is None:
        return None
    if id(hull) not in known:
        known[id(hull)] = hull_flow(hull, water.density, water.viscosity, water.speed)
    return known[id(hull)]


def _pressure(flow: HullFlow, group: FinGroup) -> float:
    return flow.pressure_share(group.quarter, group.radius, 0.0, group.reach - group.radius)


def _named(group: FinGroup) -> str:
    return " and ".join(f.name for f in group.foils)


def _of_foil(foil: Foil, group: FinGroup, flow: HullFlow | None, water: Water) -> list[Contribution]:
    across = (foil.tip - foil.root) * np.array([0.0, 1.0, 1.0])
    direction = across / np.linalg.norm(across)
    normal = np.cross([1.0, 0.0, 0.0], direction)
    centre = foil.root + CENTRE * (foil.tip - foil.root)
    axis = np.array([centre[0], *foil.stand])
    half = 0.5 * (foil.root_chord + CENTRE * (foil.tip_chord - foil.root_chord))
    outside = "" if ASPECTS[0] <= group.aspect <= ASPECTS[1] else (
        f"aspect {group.aspect:.2g} with mirror image, outside {ASPECTS[0]:g} to {ASPECTS[1]:g}")  # fmt: skip
    own = group.own
    induced = group.slope / (OSWALD * np.pi * group.aspect)
    place = "equation 1; NACA 1307, slender-body carry-over"
    pressure = 1.0 if flow is None else _pressure(flow, group)
    stream = "free stream" if flow is None else "boundary layer"
    lever = 0.0 if flow is None else PLACE * flow.hull.length
    works = "whicker1958, pitts1957" + (", glauert1926" if foil.control and foil.flap < 1.0 else "")
    out = []
    whole = group.slope * foil.area * pressure * group.carried
    effect = flap_effect(foil.flap) * whole / group.carried * group.turned
    lift = FoilForce(
        centre, axis, half, normal, whole * own, whole * (1.0 - own), 0.0, 0.0, whole, induced, 0.0, (), water.density
    )  # fmt: skip
    turned = FoilForce(
        centre, axis, half, normal, 0.0, 0.0, effect * own, effect * (1.0 - own), whole, induced, 0.0, foil.turns,
        water.density,
    )  # fmt: skip
    kinds = [("fin lift", lift, LIFT_SHARE)] + ([("control", turned, CONTROL_SHARE)] if foil.turns else [])
    out += [
        Contribution(
            foil.name, kind, f"fins, {stream}", force, share, works, place, outside, EACH, lever, _named(group)
        )
        for kind, force, share in kinds
    ]
    for tips in TIPS:
        cross = cross_flow_drag(foil.tip_chord / foil.root_chord, tips) / group.aspect * foil.area * pressure
        force = FoilForce(centre, axis, half, normal, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, cross, (), water.density)
        out.append(
            Contribution(
                foil.name, "fin cross-flow", f"fins, {tips}", force, DRAG_SHARE, "whicker1958", "C_Dc", outside
            )
        )
    return out


def _washes(
    outline: Outline, ahead: FinGroup, behind: FinGroup, water: Water, flows: dict[int, HullFlow]
) -> list[Contribution]:
    """What the tip vortices of each foil of one group do to another group behind it on the same hull."""
    hull = carrier(outline, ahead.foils[0].stand, ahead.quarter)
    chord = max(f.root_chord for f in ahead.foils)
    if hull is None or carrier(outline, behind.foils[0].stand, behind.quarter) is not hull:
        return []
    if behind.quarter > ahead.quarter - chord or behind.radius <= 0.0:
        return []
    flow = _flow(hull, water, flows)
    if flow is None:
        return []
    out = []
    first, second = _pressure(flow, ahead), _pressure(flow, behind)
    for foil in ahead.foils:
        across = (foil.tip - foil.root) * np.array([0.0, 1.0, 1.0])
        direction = across / np.linalg.norm(across)
        height = ahead.radius + np.pi / 4.0 * (ahead.reach - ahead.radius)  # NACA 1307: vortex of an elliptic load
        normal = np.cross([1.0, 0.0, 0.0], direction)
        centre = foil.root + CENTRE * (foil.tip - foil.root)
        half = 0.5 * (foil.root_chord + CENTRE * (foil.tip_chord - foil.root_chord))
        source = np.array([centre[0] - half, *foil.stand])
        place = np.array([behind.quarter, *behind.foils[0].stand])
        effect = flap_effect(foil.flap) * ahead.turned / ahead.carried
        turned = tuple((control, sign * effect) for control, sign in foil.turns)
        lift = ahead.slope * foil.area * ahead.carried * first
        strength = lift / (height - ahead.radius**2 / height)
        force, roll = _strips(behind, direction, height, strength * behind.slope * second)
        if abs(float(ahead.normal @ behind.normal)) > ALONG:
            side = float(np.sign(direction @ behind.direction))
            passed = strength * (height - behind.radius**2 / height) * behind.seen(side * height)
            force = passed * behind.finite * second * normal
        area = float(np.linalg.norm(force))
        towards = force / area if area > 0.0 else normal
        wash = Wash(source, place, normal, towards, area, roll, turned, water.density)
        out.append(
            Contribution(
                f"{_named(behind)} behind {foil.name}", "sidewash", "fins, boundary layer", wash, WASH_SHARE, "pitts1957",
                "trailing vortex at pi/4 of the exposed span, carried aft along x",
            )
        )  # fmt: skip
    return out


def _strips(behind: FinGroup, direction: Array, height: float, strength: float) -> tuple[Array, float]:
    """(3,) force and moment about x of foils by strips, in the flow of a vortex at a height along a direction and its image.

    NACA 1307. Each strip has the incidence of the flow there; the hull has the vortex's image at r^2 / height.
    """
    force, roll = np.zeros(3), 0.0
    for foil in behind.foils:
        out = (foil.tip - foil.root) * np.array([0.0, 1.0, 1.0])
        out /= np.linalg.norm(out)
        normal = np.cross([1.0, 0.0, 0.0], out)
        for step in (np.arange(STRIPS) + 0.5) / STRIPS:
            arm = behind.radius + step * foil.span
            chord = foil.root_chord + step * (foil.tip_chord - foil.root_chord)
            flow = 0.0
            for sign, far in ((-1.0, height), (1.0, behind.radius**2 / height)):
                to = arm * out - far * direction
                flow += sign / (4.0 * np.pi) * float(np.cross([1.0, 0.0, 0.0], to) @ normal) / float(to @ to)
            area = strength * flow * chord * foil.span / STRIPS
            force, roll = force + area * normal, roll + area * arm
    return force, roll
