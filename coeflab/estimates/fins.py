"""Fins, sails and control surfaces: lift of low aspect on a hull, its loss behind other foils, cross-flow and induced drag.

Free-stream lift of foil and mirror image by Whicker & Fehlner; carried over to and from the hull by slender-body theory
(Pitts, Nielsen & Kaattari); in the hull's boundary layer; behind the tip vortices of the foils ahead.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from coeflab.bodies.hull_flow import FinGroup, HullFlow, carrier, fin_groups, hull_flow
from coeflab.bodies.outline import Foil, Outline, Sections
from coeflab.core.types import Array, brief, locked
from coeflab.estimates import Contribution, Water

summary = "fins and sails of low aspect on a hull, control surfaces, loss behind other foils and in the boundary layer"
citations = ("whicker1958", "pitts1957", "glauert1926")

LIFT_SHARE, DRAG_SHARE, WASH_SHARE, CONTROL_SHARE = 0.20, 0.50, 0.50, 0.20
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
class FoilForce:
    """The force of one foil.

    Attributes
    ----------
    centre, axis : (3,) array
        Where its own lift acts, and where that which the hull carries does, m.
    normal : (3,) array
        Unit, across foil and x.
    own, carried : float
        Lift per 1/2 rho u^2 and incidence, m^2: of the foil, of the hull beside it.
    turned, turned_carried : float
        The same per angle of its control.
    lifting, induced, cross : float
        Lift area of foil and hull, drag over lift by incidence, and force per 1/2 rho of cross velocity squared, m^2.
    control : str
    density : float
    """

    centre: NDArray[np.float64]
    axis: NDArray[np.float64]
    normal: NDArray[np.float64]
    own: float
    carried: float
    turned: float
    turned_carried: float
    lifting: float
    induced: float
    cross: float
    control: str
    density: float

    def __post_init__(self) -> None:
        for name in ("centre", "axis", "normal"):
            object.__setattr__(self, name, locked(getattr(self, name)))

    def __call__(self, nu: Array, angles: Mapping[str, Array]) -> Array:
        """Forces about the datum, (n, 6)."""
        ahead = nu[:, 0]
        at_axis = local(nu, self.axis) @ self.normal
        rolling = local(nu, self.centre) @ self.normal - at_axis  # the hull carries none of a rolling foil's lift
        angle = angles.get(self.control, np.zeros(len(nu))) if self.control else np.zeros(len(nu))
        pressure, speed = 0.5 * self.density, np.abs(ahead)
        lift = speed * (self.own * (at_axis + rolling) + self.turned * ahead * angle)
        across = at_axis + rolling
        force = -pressure * (lift + self.cross * np.abs(across) * across)
        beside = -pressure * speed * (self.carried * at_axis + self.turned_carried * ahead * angle)
        incidence = across * (self.own + self.carried) + ahead * angle * (self.turned + self.turned_carried)
        along = pressure * np.sign(ahead) * incidence * (across - self.induced * incidence / self.lifting)
        out = acting(force, self.normal, self.centre) + acting(beside, self.normal, self.axis)
        return out + acting(along, np.array([1.0, 0.0, 0.0]), self.axis)


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Wash:
    """Lift that a group of foils loses in the wake of a foil ahead, per cross velocity at that foil.

    Attributes
    ----------
    ahead, place : (3,) array
        Where the velocity is, where the loss acts, m.
    source, normal : (3,) array
        Unit normals of the foil ahead and of the group.
    area : float
        Per 1/2 rho u and cross velocity, m^2.
    control : str
        Of the foil ahead.
    turned : float
        Incidence of the foil ahead per angle of its control.
    density : float
    """

    ahead: NDArray[np.float64]
    place: NDArray[np.float64]
    source: NDArray[np.float64]
    normal: NDArray[np.float64]
    area: float
    control: str
    turned: float
    density: float

    def __post_init__(self) -> None:
        for name in ("ahead", "place", "source", "normal"):
            object.__setattr__(self, name, locked(getattr(self, name)))

    def __call__(self, nu: Array, angles: Mapping[str, Array]) -> Array:
        """Forces about the datum, (n, 6)."""
        across = local(nu, self.ahead) @ self.source
        if self.control:
            across = across + self.turned * nu[:, 0] * angles.get(self.control, np.zeros(len(nu)))
        force = 0.5 * self.density * np.maximum(nu[:, 0], 0.0) * self.area * across
        return acting(force, self.normal, self.place)


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
        hull = carrier(outline, group.foils[0].stand, group.quarter)
        flow = _flow(hull, water, flows)
        share = 1.0 if flow is None else _pressure(flow, group)
        for foil in group.foils:
            out += _of_foil(foil, group, share, water)
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


def _of_foil(foil: Foil, group: FinGroup, pressure: float, water: Water) -> list[Contribution]:
    across = (foil.tip - foil.root) * np.array([0.0, 1.0, 1.0])
    direction = across / np.linalg.norm(across)
    normal = np.cross([1.0, 0.0, 0.0], direction)
    reach = 4.0 / (3.0 * np.pi)  # centre of an elliptic load
    centre = foil.root + reach * (foil.tip - foil.root)
    axis = np.array([centre[0], *foil.stand])
    lift = group.slope * foil.area * pressure
    whole = lift * group.carried
    effect = foil.sign * flap_effect(foil.flap) * lift * group.turned if foil.control else 0.0
    outside = "" if ASPECTS[0] <= group.aspect <= ASPECTS[1] else (
        f"aspect {group.aspect:.2g} with mirror image, outside {ASPECTS[0]:g} to {ASPECTS[1]:g}")  # fmt: skip
    own = group.own
    induced = group.slope / (OSWALD * np.pi * group.aspect)
    place = "equation 1; NACA 1307, slender-body carry-over"
    made = [("fin lift", "fins", 0.0, LIFT_SHARE, False)]
    made += [("control", "fins", 0.0, CONTROL_SHARE, True)] if foil.control else []
    out = [
        Contribution(
            foil.name, kind, method,
            FoilForce(
                centre, axis, normal, 0.0 if control else whole * own, 0.0 if control else whole * (1.0 - own),
                effect * own if control else 0.0, effect * (1.0 - own) if control else 0.0, whole, induced, cross,
                foil.control if control else "", water.density,
            ),
            share, "whicker1958, pitts1957" + (", glauert1926" if control and foil.flap < 1.0 else ""), place, outside,
        )
        for kind, method, cross, share, control in made
    ]  # fmt: skip
    for tips in TIPS:
        cross = cross_flow_drag(foil.tip_chord / foil.root_chord, tips) / group.aspect * foil.area * pressure
        force = FoilForce(centre, axis, normal, 0.0, 0.0, 0.0, 0.0, whole, 0.0, cross, "", water.density)
        out.append(
            Contribution(
                foil.name, "fin cross-flow", f"fins, {tips}", force, DRAG_SHARE, "whicker1958", "C_Dc", outside
            )
        )
    return out


def _washes(
    outline: Outline, ahead: FinGroup, behind: FinGroup, water: Water, flows: dict[int, HullFlow]
) -> list[Contribution]:
    """What the tip vortices of each foil of one group take from another behind it on the same hull and in the same plane."""
    hull = carrier(outline, ahead.foils[0].stand, ahead.quarter)
    chord = max(f.root_chord for f in ahead.foils)
    if hull is None or carrier(outline, behind.foils[0].stand, behind.quarter) is not hull:
        return []
    if behind.quarter > ahead.quarter - chord or abs(float(ahead.normal @ behind.normal)) < 0.9:
        return []
    flow = _flow(hull, water, flows)
    if flow is None or behind.radius <= 0.0:
        return []
    out = []
    for foil in ahead.foils:
        across = (foil.tip - foil.root) * np.array([0.0, 1.0, 1.0])
        direction = across / np.linalg.norm(across)
        height = ahead.radius + np.pi / 4.0 * (ahead.reach - ahead.radius)  # NACA 1307: vortex of an elliptic load
        lift = ahead.slope * foil.area * ahead.carried * _pressure(flow, ahead)
        strength = lift / (height - ahead.radius**2 / height)
        side = float(np.sign(direction @ behind.direction))
        passed = strength * (height - behind.radius**2 / height) * behind.seen(side * height)
        area = passed * behind.finite * _pressure(flow, behind)
        normal = np.cross([1.0, 0.0, 0.0], direction)
        centre = foil.root + 4.0 / (3.0 * np.pi) * (foil.tip - foil.root)
        source = np.array([centre[0], *foil.stand])
        place = np.array([behind.quarter, *behind.foils[0].stand])
        effect = foil.sign * flap_effect(foil.flap) * ahead.turned / ahead.carried if foil.control else 0.0
        force = Wash(source, place, normal, normal, area, foil.control, effect, water.density)
        part = " and ".join(f.name for f in behind.foils)
        out.append(
            Contribution(
                f"{part} behind {foil.name}", "sidewash", "fins", force, WASH_SHARE, "pitts1957",
                "trailing vortex at pi/4 of the exposed span, carried aft along x",
            )
        )  # fmt: skip
    return out
