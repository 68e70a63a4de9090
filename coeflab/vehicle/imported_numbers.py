"""What a file of another tool states: units that its numbers give away, and a Munk moment counted twice.

The moment of an ideal fluid on a body in steady drift is (Yvdot - Xudot) u v in yaw and its like in pitch (Lamb 1932, article
124). A measured derivative contains it; what remains of a hull once it is taken out is the lift of tail and fins, of the
other sign. So a written slope of the same sign and size as the ideal fluid's is the measured total.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from coeflab.core.finding import Finding, Severity
from coeflab.core.table import Check, as_check
from coeflab.core.types import Array
from coeflab.vehicle.second_order import products_once

POUND, SLUG, FOOT, INCH, GRAM, MILLIMETRE = 0.45359237, 14.593902937206, 0.3048, 0.0254, 1e-3, 1e-3
WATER, AIR = (950.0, 1100.0), (1.1, 1.4)  # kg/m^3; of air near the ground from -20 to 45 deg C
SLUGS = (1.9, 2.1)  # slug/ft^3, of water
DENSITIES = {  # from, to, kg/m^3 in one
    "slug/ft^3": (*SLUGS, SLUG / FOOT**3), "lb/ft^3": (60.0, 66.0, POUND / FOOT**3), "t/m^3": (0.95, 1.1, 1000.0),
}  # fmt: skip
DENSITY_OF_WATER = "model.water"
FEET_PER_SECOND = (32.0, 32.4)
GRAVITY = (9.76, 9.84)  # m/s^2, from the equator to the poles (9.780 and 9.832), and 9.8 as people write it
BUOYANCY = (0.8, 1.25)  # rho V / m of what swims under water, with room for flooded spaces that were left out
CLOSE = 0.05  # of a factor of lengths, which lie closer together
NEAR = 0.15  # of a factor between units, for rho V / m is not just one
SLENDER = (0.05, 3.0)  # radius of gyration of the water over the cube root of the volume, from a sphere to a rod
SIZES = "units of mass, Yvdot, Nrdot"
MIXED = {
    SLUG / FOOT**3: "the mass in slug and the volume in cubic feet",
    POUND / FOOT**3: "the mass in pounds and the volume in cubic feet",
    SLUG: "the mass in slug",
    FOOT**-3: "the volume in cubic feet",
    POUND: "the mass in pounds",
    GRAM: "the mass in grams",
}
LENGTHS = {
    unit**-power: f"{count} in {name}"
    for unit, name in ((FOOT, "feet"), (INCH, "inches"), (MILLIMETRE, "mm"))
    for power, count in ((1, "one length"), (2, "two lengths, such as a radius,"), (3, "all lengths"))
}


def water(kind: str, density: float, key: str = "density") -> Check:
    """Whether a density can be that of water in kg/m^3, and which unit it looks like if not."""
    looks = next((unit for unit, (low, high, _) in DENSITIES.items() if low < density < high), "none")
    good = WATER[0] <= density <= WATER[1]
    return as_check(kind, Finding.of(
        DENSITY_OF_WATER, key, Severity.PASS if good else Severity.FAIL, statistic=density, looks="water" if good else looks,
        low=WATER[0], high=WATER[1], si=density * DENSITIES[looks][2] if looks in DENSITIES else density,
    ))  # fmt: skip


def gravity(kind: str, value: float, key: str) -> tuple[Check, ...]:
    """A finding where gravity is in feet."""
    if value == 0.0 or GRAVITY[0] <= abs(value) <= GRAVITY[1]:
        return ()
    feet = FEET_PER_SECOND[0] < abs(value) < FEET_PER_SECOND[1]
    severity = Severity.FAIL if feet else Severity.WARN
    found = Finding.of("model.gravity_unit", key, severity, statistic=value, looks="feet" if feet else "none")
    return (as_check(kind, found),)


def weight(kind: str, force: float, mass: float, key: str) -> tuple[Check, ...]:
    """A finding where weight over mass is that of slug and pound, or of pounds for both."""
    ratio = force / mass if mass else 0.0
    slugs, pounds = FEET_PER_SECOND[0] < ratio < FEET_PER_SECOND[1], abs(ratio - 1.0) < NEAR
    if not (slugs or pounds):
        return ()
    found = Finding.of("model.weight", key, Severity.FAIL, statistic=ratio, looks="slug" if slugs else "pound")
    return (as_check(kind, found),)


def displaced(kind: str, mass: float, volume: float, density: float, key: str) -> tuple[Check, ...]:
    """A finding about rho V / m of a submerged vehicle, with the units that it looks like.

    Parameters
    ----------
    kind : str
        Name of the check.
    mass, volume, density : float
        As in the file, kg, m^3 and kg/m^3.
    key : str
        What the finding is about.
    """
    ratio = density * volume / mass
    good = BUOYANCY[0] <= ratio <= BUOYANCY[1]
    likely = MIXED[min(MIXED, key=lambda factor: abs(ratio / factor - 1.0))]
    looks = "good" if good else "both" if imperial(ratio) else "none"
    if looks == "none":
        nearest = min(LENGTHS, key=lambda factor: abs(ratio / factor - 1.0))
        likely, looks = LENGTHS[nearest], "lengths" if abs(ratio / nearest - 1.0) < CLOSE else "none"
    return (as_check(kind, Finding.of(
        "model.displaced", key, Severity.PASS if good else Severity.FAIL, statistic=ratio, looks=looks, likely=likely, low=BUOYANCY[0],
        high=BUOYANCY[1],
    )),)  # fmt: skip


def imperial(ratio: float) -> bool:
    """Whether rho V / m is that of a mass or a volume in pound, slug and foot."""
    return any(abs(ratio / factor - 1.0) < NEAR for factor in MIXED)


BODY_OVER_WATER = (0.35, 2.9)  # radius of gyration of the body over that of the water; REMUS 100 0.91, a foot is 3.28 m
BODY_OVER_VOLUME = (0.15, 4.5)  # over the cube root of the volume: a ball 0.39, a rod of 20 diameters 1.9


def body_gyration(
    kind: str, mass: float, inertia: Sequence[float], density: float, added: Sequence[float]
) -> tuple[Check, ...]:
    """Whether moments of inertia in kg m^2 can be those of a mass in kg.

    Parameters
    ----------
    kind : str
    mass : float
    inertia : sequence of float
        Ix, Iy, Iz about the centre of gravity.
    density : float
    added : sequence of float
        Diagonal of the added mass; zeros where it is not known.
    """
    out = []
    for axis, i, across in (("Iy", 1, 2), ("Iz", 2, 1)):
        if not (inertia[i] > 0.0 and mass > 0.0 and density > 0.0):
            continue
        own = math.sqrt(inertia[i] / mass)
        by, low, high = own / (mass / density) ** (1.0 / 3.0), *BODY_OVER_VOLUME
        over = "volume"
        if low <= by <= high and added[across] > 0.0 and added[3 + i] > 0.0:
            by, low, high = own / math.sqrt(added[3 + i] / added[across]), *BODY_OVER_WATER
            over = "water"
        if not low <= by <= high:
            out.append(as_check(kind, Finding.of(
                "model.body_gyration", axis, Severity.WARN, statistic=by, own=own, over=over, low=low, high=high
            )))  # fmt: skip
    return tuple(out)


def no_mass(kind: str, mass: float | None, key: str) -> tuple[Check, ...]:
    """A finding where a stated mass is none."""
    if mass is None or mass > 0.0:
        return ()
    return (as_check(kind, Finding.of("model.no_mass", key, Severity.FAIL, statistic=mass)),)


def gyration(kind: str, mass: float, density: float, sway: float, yaw: float) -> tuple[Check, ...]:
    """Whether a mass in kg, an added mass in kg and one in kg m^2 can be those of one body."""
    if not (mass > 0.0 and density > 0.0 and sway > 0.0 and yaw > 0.0):
        return ()
    ratio = math.sqrt(yaw / sway) / (mass / density) ** (1.0 / 3.0)
    good = SLENDER[0] <= ratio <= SLENDER[1]
    return (as_check(kind, Finding.of(
        "model.gyration", SIZES, Severity.PASS if good else Severity.FAIL, statistic=ratio, units="good" if good else "mixed", mass=mass,
        sway=-sway, yaw=-yaw, density=density, low=SLENDER[0], high=SLENDER[1],
    )),)  # fmt: skip


# A product u v over the ideal fluid's; a linear term over it is a speed, m/s.
SIMILAR = (0.5, 2.0)
USUAL_SPEEDS = (0.5, 4.0)
MOMENTS = {"N": (5, 0, 1), "M": (4, 0, 2)}
PRODUCTS = {"N": "u v", "M": "u w"}


@dataclass(frozen=True, slots=True)
class Written:
    """One term of a file that turns a body in drift.

    Attributes
    ----------
    component : str
        ``N`` for what goes with v, ``M`` for what goes with w.
    key : str
        Where it stands in the file.
    value : float
        FRD; of u v or u w in kg, or of v or w in N m/(m/s).
    with_speed : bool
        Whether the force is that of the product with u.
    """

    component: str
    key: str
    value: float
    with_speed: bool


def munk_twice(kind: str, written: Sequence[Written], added: Array, ideal: Array) -> tuple[Check, ...]:
    """Findings about yaw and pitch.

    Parameters
    ----------
    kind : str
        Format of the file.
    written : sequence of Written
    added : (6, 6, 6) array
        Quadratics that the simulator adds itself, FRD.
    ideal : (6, 6, 6) array
        Those of an ideal fluid for the file's added mass.

    Notes
    -----
    A term of the product u v fails from half to twice the ideal fluid's. A linear one does not grow with the speed as the
    Munk moment does; it is pointed at where both are equal at a usual speed of a vehicle, 0.5 to 4 m/s.
    """
    out = []
    for component, at in MOMENTS.items():
        own, potential = products_once(added)[at], products_once(ideal)[at]
        if own == 0.0 or potential == 0.0:
            continue
        for with_speed in (True, False):
            terms = [w for w in written if (w.component, w.with_speed) == (component, with_speed) and w.value != 0.0]
            total = sum(w.value for w in terms)
            share = total / potential
            low, high = SIMILAR if with_speed else USUAL_SPEEDS
            if low <= share <= high:
                keys = ", ".join(w.key for w in terms)
                out.append(_check(kind, component, keys, total, own, share, with_speed, bool(own * potential > 0.0)))
    return tuple(out)


def _check(
    kind: str, component: str, keys: str, total: float, own: float, share: float, with_speed: bool, same: bool
) -> Check:
    return as_check(kind, Finding.of(
        "model.munk_twice", keys, Severity.FAIL if with_speed else Severity.WARN, statistic=total, component=component,
        product=PRODUCTS[component], linear=PRODUCTS[component][-1], own=own, share=share, viscous=total - own,
        sense=f"{'same' if same else 'reverse'}_{'product' if with_speed else 'linear'}",
    ))  # fmt: skip
