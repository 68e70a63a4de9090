"""Sizes of what a vehicle has beside its own: places, trim, fins, thrust and drag over the cube root of its volume, s = (m/rho)^(1/3).

A rod of 20 diameters is 8 s long, a ball 1.2 s. A foot is 3.3 m, an inch 39 to the metre, a degree 57 to the radian: what is
further off than any shape explains is in another unit. So is a primed slope beyond that of a square plate, and a centre of gravity
outside of the body's length.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from coeflab.core.finding import Finding, Severity
from coeflab.core.table import Check, as_check
from coeflab.core.units import STANDARD_GRAVITY
from coeflab.law.scaling import NOBODYS
from coeflab.law.symbols import CONTROLS, primed
from coeflab.vehicle.inertia import centre_of_gravity
from coeflab.vehicle.parameter_file import ParameterFile

NAME = "plausibility"
FURTHEST, INSIDE = 8.0, 1.0  # s, of a thruster, of the centre of buoyancy from the centre of gravity
STEEPEST, LEAST = 45.0, 0.02  # deg of trim at rest; s, of the lever that makes it
LARGEST_FIN = 20.0  # of 1/2 rho s^2, per radian: a wing of ten times the body's own section
THRUST = (1e-4, 30.0)  # of the weight, one thruster at its largest
DRAG = {"X": (5e-3, 25.0), "Y": (0.02, 50.0), "Z": (0.02, 50.0)}  # of 1/2 rho s^2
# Primed, of a square plate of side L: its drag broadside (Hoerner, 1.17), and edge on pi/2 of lift (Jones) with friction and separation.
LARGEST = {"X0": 1.2, **dict.fromkeys(("Yv", "Zw"), 2.0), **dict.fromkeys(("Nv", "Mw", "Yr", "Zq", "Nr", "Mq"), 1.0)}
MIDDLES = {
    **dict.fromkeys(("nose", "bow", "stem", "fp"), -0.5), **dict.fromkeys(("stern", "tail", "ap"), 0.5),
    **dict.fromkeys(("cb", "cob", "cg", "cog", "midship", "midships", "amidships", "mid-length", "midlength", "centre", "center"), 0.0),
}  # fmt: skip
FAR = 0.5  # of the length, of a centre of gravity from the body's middle: beyond its ends


def size_findings(p: ParameterFile) -> list[Check]:
    """Warnings about what is too far, too large or too small for a body in water; of its mass only slopes where that is not known."""
    found = list(_slopes(p))
    if p.mass is None:
        return [as_check(NAME, f) for f in found]
    size = (p.mass.mass / p.conditions.density) ** (1.0 / 3.0)
    found += [
        *far_centre(p),
        *_places(p, size),
        *_trim(p, size),
        *_fins(p, size),
        *_thrusts(p, STANDARD_GRAVITY * p.mass.mass),
        *_drag(p, size),
    ]
    return [as_check(NAME, f) for f in found]


def _slopes(p: ParameterFile) -> Iterator[Finding]:
    """Primes beyond `LARGEST` with their U95 to spare: an SI value typed as a prime, or a length that is not the body's."""
    if any(name in p.scaling.length_name for name in NOBODYS):
        return
    own = {
        primed(c.symbol): (c.value, c.u95 or 0.0) for c in p.coefficients if c.value is not None and c.law == "motion"
    }
    sizes = {s: (own[primed(s)], most) for s, most in LARGEST.items() if primed(s) in own}
    large = {primed(s): (value, most) for s, ((value, u95), most) in sizes.items() if abs(value) - u95 > most}
    if large:
        each = ", ".join(f"{s} = {value:.4g} ({most:g})" for s, (value, most) in large.items())
        yield Finding.of(
            "size.slope", ", ".join(large), Severity.WARN, each=each, name=p.scaling.length_name,
            length=p.scaling.length, speed=p.conditions.speed,
        )  # fmt: skip


def far_centre(p: ParameterFile) -> Iterator[Finding]:
    """A centre of gravity beyond the ends of the body, from its middle where the datum tells that, else a length from the datum."""
    at, length = p.reference_point, p.scaling.length
    if p.mass is None or any(name in p.scaling.length_name for name in (*NOBODYS, "^(1/3)", "volume")):
        return
    middle = MIDDLES.get(at.origin.id)
    most = length * (2.0 * FAR if middle is None else FAR)
    apart = centre_of_gravity(p) + np.array(at.point) - np.array([(middle or 0.0) * length, 0.0, 0.0])
    if (far := float(np.linalg.norm(apart))) > most:
        start = f"the {at.datum}" if not middle else f"the middle of {p.scaling.length_name} = {length:g} m"
        yield Finding.of("size.centre", p.name, Severity.WARN, statistic=far, threshold=most, start=start)


def _places(p: ParameterFile, size: float) -> Iterator[Finding]:
    """Thrusters and the centre of buoyancy, from the centre of gravity."""
    centre, afloat = centre_of_gravity(p), p.hydrostatics
    places = [(t.name, t.position, FURTHEST * size) for t in p.thrusters]
    places += [] if afloat is None else [("centre of buoyancy", afloat.centre_of_buoyancy, INSIDE * size)]
    for name, at, most in places:
        if (far := float(np.linalg.norm(np.array(at) - centre))) > most:
            yield Finding.of("size.place", name, Severity.WARN, statistic=far, threshold=most)


def _trim(p: ParameterFile, size: float) -> Iterator[Finding]:
    """The lever of the two centres across their height, where they right the vehicle."""
    if p.hydrostatics is None:
        return
    x, y, z = (float(v) for v in centre_of_gravity(p) - np.array(p.hydrostatics.centre_of_buoyancy))
    lever = math.hypot(x, y)
    angle = math.degrees(math.atan2(lever, z))
    if z > 0.0 and angle > STEEPEST and lever > LEAST * size:
        yield Finding.of(
            "size.trim", p.name, Severity.WARN, statistic=angle, threshold=STEEPEST, along=x, across=y, below=z
        )


def _si(p: ParameterFile, symbol: str) -> float | None:
    """A coefficient of U^2 or of a square, kg/m or kg/m per radian."""
    found = p.coefficient(symbol)
    if found is None or found.value is None or found.law == "rest":
        return None
    return float(found.value) * p.scaling.unit(symbol, p.conditions.density)


def _fins(p: ParameterFile, size: float) -> Iterator[Finding]:
    unit = 0.5 * p.conditions.density * size**2
    shares = {f"{c}{d}": abs(x) / unit for d in CONTROLS for c in "YZ" if (x := _si(p, f"{c}{d}"))}
    wrong = {name: x for name, x in shares.items() if x > LARGEST_FIN}
    if wrong:
        yield Finding.of(
            "size.fin", ", ".join(f"{n}'" for n in wrong), Severity.WARN, statistic=max(wrong.values()), threshold=LARGEST_FIN
        )  # fmt: skip


def _thrusts(p: ParameterFile, weight: float) -> Iterator[Finding]:
    shares = {t.name: max(abs(t.curve.at(t.curve.low)), abs(t.curve.at(t.curve.high))) / weight for t in p.thrusters}
    wrong = {name: x for name, x in shares.items() if not THRUST[0] <= x <= THRUST[1]}
    if wrong:
        yield Finding.of(
            "size.thrust", ", ".join(wrong), Severity.WARN, statistic=next(iter(wrong.values())), threshold=THRUST[1],
            least=THRUST[0],
        )  # fmt: skip


def _drag(p: ParameterFile, size: float) -> Iterator[Finding]:
    """X0', Xu|u|', Yv|v|', Zw|w|' below zero, each as a coefficient by s^2."""
    unit = 0.5 * p.conditions.density * size**2
    for c, m in ("Xu", "Yv", "Zw"):
        parts = [_si(p, s) for s in (f"{c}{m}|{m}|", *(("X0", "Xuu") if c == "X" else ()))]
        drag = -sum(x for x in parts if x is not None and x < 0.0) / unit
        low, high = DRAG[c]
        if drag > 0.0 and not low <= drag <= high:
            yield Finding.of(
                "size.drag", f"{c}{m}|{m}|'", Severity.WARN, statistic=drag, threshold=high if drag > high else low,
                least=low, most=high,
            )  # fmt: skip
