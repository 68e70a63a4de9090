"""Sizes of primed slopes that no body has: a wrong unit of force or speed, or a length that is not the body's."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from coeflab.core.finding import Severity
from coeflab.core.table import Check
from coeflab.law.friction_line import friction_line
from coeflab.law.scaling import NOBODYS, Conditions, Scaling
from coeflab.law.symbols import primed
from coeflab.vehicle.sizes import LARGEST

if TYPE_CHECKING:
    from coeflab.bodies.body import Body
    from coeflab.law.coefficient import Coefficient
    from coeflab.study.study import Study
    from coeflab.tables.force_table import ForceTable

summary = (
    "rates, levers of forces, primed slopes and X0' between friction of a slender body and a bluff plate of side L"
)
citations = ("ittc1957", "schlichting1979", "hoerner1965", "jones1946")

SLENDER = 20.0  # lengths of a body over its diameter: torpedoes and gliders have 6 to 15
WATER = 0.8e-6  # m^2/s, at 30 deg C: the thinnest that tests are run in, where the campaign states none
OF_FRICTION = {"X0": 1.0, "Yv": 0.5, "Zw": 0.5}
TIGHTEST = 2.0  # r' = L/R: the centre of the circle lies within the body's own length
LEAST_LEVER = (
    0.002  # largest moment of a sweep over its largest force and the length; shipped campaigns have 0.005 and more
)
UNITS_APART = 100.0  # a thousand from a tonne or a gram to the kilogram, with room for a flooded body
ONE_MASS = 1.2  # of the mass of a model and that of its body: more is another body, or another state of it


def least_friction(conditions: Conditions, scaling: Scaling) -> float:
    """Friction of a bare cylinder of 20 diameters by its side surface, of 1/2 rho U^2 L^2.

    C_F is that of a plate laminar to Re = 3e6, the longest that a smooth model is: ITTC 1957 less 8700/Re (Prandtl and
    Schlichting), at least Blasius' 1.328 / sqrt(Re). Any fin, any roughness, any form drag adds to it.

    Parameters
    ----------
    conditions : Conditions
    scaling : Scaling
    """
    reynolds = conditions.reynolds_on(scaling.length) or conditions.speed * scaling.length / WATER
    turbulent = friction_line(reynolds) - 8700.0 / reynolds
    return float(np.pi / SLENDER * max(1.328 / np.sqrt(reynolds), turbulent))


def check(study: Study) -> Sequence[Check]:
    """Findings on slopes too large or too small for any body; none on the others.

    Too large is beyond what a square plate of side L gives: broadside its drag (Hoerner, 1.17), edge on the lift slope pi/2 of
    aspect ratio 1 (Jones) with friction and separation on top, rounded up to 2; moments and rates have half of L as their
    lever. Too small is less than friction of the most slender body, with U95 to spare: a side velocity turns at least half of
    the drag into a side force. Slopes of moments have no smallest size, as tail fins can balance them; but the point where the force
    acts moves along the body over a sweep, so that the largest moment of all rows has one.
    """
    out = []
    for table, stated, ratio in masses_of_models(study.tables, study.body):
        if max(ratio, 1.0 / ratio) > ONE_MASS:
            out.append(Check.of(
                "sizes.mass", f"{table.campaign} mass", Severity.WARN, model=table.model_mass, stated=stated, ratio=ratio,
                body=table.body, most=ONE_MASS - 1.0,
            ))  # fmt: skip
    for table in study.tables:
        scaling = study.plan.scaling or table.scaling
        on_table = (*_rates(table, scaling), *_levers(table, scaling))
        out += [replace(c, campaign=table.campaign, table=table.name) for c in on_table]
    for campaign, table in {t.campaign: t for t in study.tables}.items():
        scaling = study.plan.scaling or table.scaling
        if any(name in scaling.length_name for name in NOBODYS):
            continue
        fitted = [c for c in study.coefficients if c.campaign == campaign and c.origin == "fit" and c.law == "motion"]
        own = {c.symbol.removesuffix("'"): c for c in reversed(fitted)}
        least = least_friction(table.conditions, scaling)
        large = {c: most for s, most in LARGEST.items() if (c := own.get(s)) and _at_least(c) > most}
        small = {c: p * least for s, p in OF_FRICTION.items() if (c := own.get(s)) and _at_most(c) < p * least}
        at: dict[str, Any] = {"name": scaling.length_name, "length": scaling.length, "speed": table.conditions.speed}
        for code, found in (("sizes.large", large), ("sizes.small", small)):
            if found:
                each = ", ".join(f"{primed(c.symbol)} = {c.value:.2g} ({limit:.2g})" for c, limit in found.items())
                out.append(Check.of(code, campaign, Severity.WARN, each=each, **at))
    return out


def masses_of_models(tables: Iterable[ForceTable], body: Body | None) -> Iterator[tuple[ForceTable, float, float]]:
    """A table of each campaign whose model's mass the body.toml has too, that mass, kg, and the model's over it.

    Parameters
    ----------
    tables : iterable of ForceTable
    body : Body or None
    """
    for table in {t.campaign: t for t in tables}.values():
        named = None if body is None else body.configuration(table.body)
        if table.model_mass is not None and named is not None and named.mass is not None:
            yield table, named.mass.mass, table.model_mass / named.mass.mass


def _rates(table: ForceTable, scaling: Scaling) -> list[Check]:
    """Turns of less than half a length in radius while the body moves ahead at its speed: a rate in another unit, or a wrong speed."""
    along = np.sqrt(np.sum([np.asarray(table.motion[m]) ** 2 for m in "uvw"], axis=0))
    ahead = along > 0.5 * np.asarray(table.speed)
    out = []
    for rate in "qr":
        primes = np.abs(table.primed_motion(rate, scaling.length))[ahead]
        if np.any(primes > TIGHTEST):
            largest = float(np.nanmax(primes))
            out.append(Check.of(
                "sizes.tight", f"{table.name} {rate}'", Severity.WARN, rate=rate, largest=largest, radius=1.0 / largest, most=TIGHTEST,
                speed=table.conditions.speed,
            ))  # fmt: skip
    return out


def _levers(table: ForceTable, scaling: Scaling) -> Iterator[Check]:
    """Moments a thousand times too small for the forces beside them: kN m declared as N m."""
    for force, moment, moves in (("Y", "N", "vr"), ("Z", "M", "wq")):
        if not {force, moment} <= table.forces.keys() or not set(moves) & set(table.varies):
            continue
        rows = table.sound(force) & table.sound(moment)
        f, m = (np.abs(table.primed_force(c, scaling.length))[rows] for c in (force, moment))
        lever = float(m.max() / f.max()) if m.size > 2 and f.max() > 0.0 else np.inf
        if 0.0 < lever < LEAST_LEVER:
            yield Check.of(
                "sizes.lever", f"{table.name} {moment}'", Severity.WARN, moment=f"{moment}'", force=f"{force}'", lever=lever,
                least=LEAST_LEVER, name=scaling.length_name, length=scaling.length,
            )  # fmt: skip


def _at_least(c: Coefficient) -> float:
    """The smallest size that the interval leaves."""
    return 0.0 if c.value is None else abs(c.value) - (c.u95 or 0.0)


def _at_most(c: Coefficient) -> float:
    """The largest size that the interval leaves; without limit where nothing is known of it."""
    return np.inf if c.value is None or c.u95 is None else abs(c.value) + c.u95
