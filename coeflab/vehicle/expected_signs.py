"""Signs and sizes at the speed of a file, straight ahead, whatever its terms are called: slopes, where forces act, controls.

Yv', Yuv' and Yv|u|' are one slope there. With the ideal fluid's part taken off, the moment of drift over its side force is the
place where flow separates and tails stand, which is on the body; so is a rudder's. A wrong sign moves the place off the body or
to its other end. In the vertical plane Z, -M, w, -q stand for Y, N, v, r.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from coeflab.core.errors import InputError
from coeflab.core.finding import Finding, Severity
from coeflab.core.table import Check, as_check
from coeflab.core.types import Array, dataclass, locking
from coeflab.law.force_law import CONTROLS, ForceTerm
from coeflab.law.rigid_body import ideal_quadratics
from coeflab.law.symbols import COMPONENTS, LINEAR, MOTIONS, primed
from coeflab.vehicle.force_law import motion_law, stated_terms
from coeflab.vehicle.inertia import water_inertia
from coeflab.vehicle.second_order import products_once

if TYPE_CHECKING:
    from coeflab.vehicle.parameter_file import ParameterFile

NAME = "plausibility"
STEP = 1e-4  # of the speed, of the rate U/L, of a radian
REACH = 0.75  # of the length, from the centre of gravity: half a hull, and half as much again for what strips leave out
UNSURE = 0.1  # of a potential part; without an added mass, of m' in the place of the added mass along x
NOTHING = 1e-6  # of the added mass times the speed: no slope
NEAREST = 0.05  # of the length: a rudder so close to the centre does not turn
PER_SLOPE = (0.02, 10.0)  # Ydr over Yv U; vehicles with both have 0.2 to 0.5, per degree 57 times less
ALIKE, UNLIKE = 0.01, 3.0  # added masses of one size; rudder over stern plane of a body with such
PLANES = (("Y", "N", "v", "r", 1.0), ("Z", "M", "w", "q", -1.0))
TURNS = {"N": ("to port", "to starboard"), "M": ("bow down", "bow up")}
PUSHES = {"Y": ("to port", "to starboard"), "Z": ("up", "down"), "K": ("port side down", "starboard side down")}


@dataclass(frozen=True, slots=True, eq=False)
@locking("motion ideal control")
class Slopes:
    """Derivatives of the force of a file at its speed straight ahead, SI, FRD.

    Attributes
    ----------
    motion : (6, 6) array
        By u v w p q r, fitted tables among them.
    ideal : (6, 6) array
        The part that an ideal fluid gives for the file's added mass.
    control : (6, 3) array
        By dr ds db, per radian.
    """

    motion: Array
    ideal: Array
    control: Array


def slopes(p: ParameterFile) -> Slopes:
    """The slopes at no drift, no rate and no deflection."""
    law, speed = motion_law(p, tables=False)[0], p.conditions.speed
    unit = np.array([*np.full(3, speed), *np.full(3, speed / p.scaling.length), *np.ones(3)])
    found = []
    for step in (STEP, STEP / 2.0):
        away = np.vstack([np.diag(step * unit), np.diag(-step * unit)])
        nu = away[:, :6] + np.array([speed, 0.0, 0.0, 0.0, 0.0, 0.0])
        force = law.force(nu, away[:, 6:])
        found.append((force[:9] - force[9:]).T / (2.0 * step * unit))
    exact = 2.0 * found[1] - found[0]  # v|v| bends the line by the first power of the step
    products = products_once(ideal_quadratics(water_inertia(p).matrix))
    return Slopes(exact[:, :6], speed * products[:, 0, :], exact[:, 6:])


def sign_findings(p: ParameterFile) -> list[Check]:
    """What of slopes, places and controls cannot be, and one finding that passes where nothing is wrong."""
    try:
        s = slopes(p)
    except InputError:  # an added mass that no body has, which has its own finding
        return list(_driving(p))
    out = [*_driving(p), *_places(p, s), *_controls(p, s)]
    if out or not (judged := [*_with_speed(p), *(c for c in CONTROLS if np.any(s.control[:, CONTROLS.index(c)]))]):
        return out
    return [Check(NAME, ", ".join(judged), Severity.PASS, "signs and places", "those of a body that moves ahead", "")]


def control_signs(p: ParameterFile) -> tuple[str, ...]:
    """What a control above zero does, in words, by the signs in the file; nothing of controls that the file has no slope of.

    Raises
    ------
    InputError
        Tables of the file contradict each other, or no body has its added mass.
    """
    control, stated = slopes(p).control, {c.symbol for c in p.coefficients if c.value}
    out = []
    for k, name in enumerate(CONTROLS):
        phrases: list[str] = []
        for words in (TURNS, PUSHES):
            column = {c: float(control[COMPONENTS.index(c), k]) for c in words}
            largest = max(map(abs, column.values()))
            for c, value in column.items():
                if largest and abs(value) >= 0.1 * largest and not (phrases and words is PUSHES):
                    symbol = f"{c}{name}" if f"{c}{name}'" in stated else f"{c} by {name}"
                    verb = "turns " if c == "N" else "pushes " if words is PUSHES else ""
                    phrases.append(f"{verb}{words[c][value > 0.0]} ({symbol} {'>' if value > 0.0 else '<'} 0)")
        if phrases:
            out.append(f"{name} > 0: {', '.join(phrases)}")
    return tuple(out)


def _with_speed(p: ParameterFile) -> list[str]:
    return [primed(t.symbol) for t in stated_terms(p) if _moved(t) is not None and "u" in t.variables]


def _moved(t: ForceTerm) -> str | None:
    """The one motion beside u that a term is linear in at u > 0; None of any other term."""
    others = [(v, n, a) for v, n, a in t.term.factors if v != "u"]
    return others[0][0] if len(others) == 1 and others[0][1:] == (1, False) and others[0][0] in MOTIONS else None


def _slope_of(t: ForceTerm, p: ParameterFile) -> float:
    ahead = sum(n for v, n, _ in t.term.factors if v == "u")
    return float(p.conditions.speed ** (t.speed_power + ahead))


def _named(p: ParameterFile, component: str, motion: str) -> list[tuple[ForceTerm, float]]:
    """Terms of a slope, each with its share of it."""
    return [
        (t, t.coefficient * _slope_of(t, p))
        for t in stated_terms(p)
        if t.component == component and t.coefficient and _moved(t) == motion
    ]


def _half_width(p: ParameterFile, component: str, motion: str) -> float:
    """U95 of a slope, the terms taken as independent."""
    wide = {c.symbol: c.u95 or 0.0 for c in p.coefficients}
    parts = [t.per_prime * wide[primed(t.symbol)] * _slope_of(t, p) for t, _ in _named(p, component, motion)]
    return float(np.sqrt(np.sum(np.square(parts))))


def _driving(p: ParameterFile) -> Iterator[Check]:
    """Slopes of a motion on itself, where a product with u is among their terms."""
    for c, m in zip(COMPONENTS[1:], MOTIONS[1:], strict=True):
        terms = _named(p, c, m)
        total = sum(x for _, x in terms)
        if total > 0.0 and any("u" in t.variables for t, _ in terms):
            unit = f"{'N m' if c in 'KMN' else 'N'}/({'m/s' if m in LINEAR else 'rad/s'})"
            yield as_check(NAME, Finding.of(
                "expected_signs.drives", ", ".join(primed(t.symbol) for t, _ in terms), Severity.FAIL, component=c, motion=m, total=total,
                unit=unit, speed=p.conditions.speed,
            ))  # fmt: skip


def _length(p: ParameterFile, added: Array, i: int, j: int) -> float:
    """Of the hull: that of the primes, which may be a unit length, or that of a rod with the radius of gyration of its water."""
    k = np.sqrt(added[j, j] / added[i, i]) if added[i, i] > 0.0 and added[j, j] > 0.0 else 0.0
    return max(p.scaling.length, float(np.sqrt(12.0) * k))


def _centre(p: ParameterFile, added: Array) -> float | None:
    """The x of the centre of gravity, else that of the added mass, m from the reference point; None where neither is known."""
    if p.mass is not None:
        return p.mass.mass_moment / p.mass.mass
    return float(added[1, 5] / added[1, 1]) if added[1, 1] > 0.0 else None


def _places(p: ParameterFile, s: Slopes) -> Iterator[Check]:
    """Where the viscous forces of drift and of turning act, in planes whose added mass and slope are known."""
    added = water_inertia(p).matrix
    for force, moment, v, r, sign in PLANES:
        i, j, across, turn = COMPONENTS.index(force), COMPONENTS.index(moment), MOTIONS.index(v), MOTIONS.index(r)
        centre = _centre(p, added)
        viscous = s.motion[i, across] - s.ideal[i, across]
        if centre is None or added[i, i] <= 0.0 or abs(viscous) <= NOTHING * added[i, i] * p.conditions.speed:
            continue
        length, own, wide = _length(p, added, i, j), abs(viscous), _half_width(p, force, v)
        ahead = False
        for c, m, at in ((moment, v, (j, across)), (force, r, (i, turn))):
            terms = _named(p, c, m)
            if not terms:
                continue
            potential = float(s.ideal[at])
            stated = sum(x for _, x in terms)

            def place(
                total: float, less: float = potential, per: float = own, middle: float = centre, way: float = sign
            ) -> float:
                return -way * (total - less) / per - middle

            total = float(s.motion[at])
            x, other = place(total), place(total - 2.0 * stated)
            doubt = (_half_width(p, c, m) + UNSURE * abs(potential) + abs(x) * wide) / own
            fits, turned = abs(x) - doubt <= REACH * length, abs(other) <= REACH * length
            if m == v:
                ahead = x - doubt > 0.0
                rule = f"on the body, within {REACH:g} L of its centre"
            elif fits and x - doubt > 0.0 and not ahead:
                fits, turned, rule = False, other <= 0.0, "aft of the centre, as that of drift"
            else:
                rule = f"on the body, within {REACH:g} L of its centre"
            if fits:
                continue
            names = ", ".join(primed(t.symbol) for t, _ in terms)
            sure = turned and m == v
            yield as_check(NAME, Finding.of(
                "expected_signs.place", names, Severity.FAIL if sure else Severity.WARN, component=c, motion=m, stated=stated,
                speed=p.conditions.speed, potential=potential, rest=_where(x, length), rule=rule, turned="yes" if turned else "no",
                other=_where(other, length), force="side" if force == "Y" else "normal", of=v,
            ))  # fmt: skip


def _where(x: float, length: float) -> str:
    return f"{abs(x) / length:.2f} L {'ahead' if x > 0.0 else 'aft'}"


def _controls(p: ParameterFile, s: Slopes) -> Iterator[Check]:
    """Levers of rudders and planes, their size beside that of the hull, and beside each other."""
    added = water_inertia(p).matrix
    sizes = []
    for name, planes in (("dr", PLANES[:1]), ("ds", PLANES[1:]), ("db", PLANES[1:])):
        k = CONTROLS.index(name)
        for force, moment, v, _, sign in planes:
            i, j = COMPONENTS.index(force), COMPONENTS.index(moment)
            push, turn = float(s.control[i, k]), float(s.control[j, k])
            if not push:
                continue
            sizes += [abs(push)] if name != "db" else []
            pair, length = f"{force}{name}', {moment}{name}'", _length(p, added, i, j)
            yield from _lever(pair, name, sign * turn / push - (_centre(p, added) or 0.0), length, turn, sign)
            slope = p.conditions.speed * float(s.motion[i, MOTIONS.index(v)] - s.ideal[i, MOTIONS.index(v)])
            share = abs(push / slope) if abs(slope) > NOTHING * added[i, i] * p.conditions.speed**2 else None
            if share is not None and not PER_SLOPE[0] <= share <= PER_SLOPE[1]:
                yield as_check(NAME, Finding.of(
                    "expected_signs.control", f"{force}{name}'", Severity.WARN, push=push, share=share, motion=v, least=PER_SLOPE[0],
                    most=PER_SLOPE[1],
                ))  # fmt: skip
    alike = added[1, 1] > 0.0 and abs(added[1, 1] - added[2, 2]) <= ALIKE * added[1, 1]
    if alike and len(sizes) == 2 and max(sizes) > UNLIKE * min(sizes):
        yield as_check(NAME, Finding.of(
            "expected_signs.controls", "Ydr', Zds'", Severity.WARN, one=sizes[0], other=sizes[1], factor=UNLIKE
        ))  # fmt: skip


def _lever(pair: str, name: str, x: float, length: float, turn: float, sign: float) -> Iterator[Check]:
    if not turn:
        return
    off, close = abs(x) > REACH * length, abs(x) < NEAREST * length
    if name == "db" and not (off or close):
        return
    if off or close or x > 0.0:
        yield as_check(NAME, Finding.of(
            "expected_signs.lever", pair, Severity.WARN, place=_where(x, length), aft="" if name == "db" else "aft, ", nearest=NEAREST,
            reach=REACH, reason="off" if off or close else "rudder" if sign > 0.0 else "plane",
        ))  # fmt: skip
