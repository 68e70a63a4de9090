"""A glider of a fitted polar and a body: masses from its [[mass]] parts and its added mass, about its centre of buoyancy."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from coeflab.bodies.body import Body
from coeflab.bodies.mass_model import MassPart
from coeflab.core.errors import InputError, shown
from coeflab.core.texts import input_error
from coeflab.core.units import STANDARD_GRAVITY
from coeflab.fits.glide_polar import fit
from coeflab.glider.glider import BuoyancyEngine, Glider, GliderMass, GliderPhase, SlidingMass, StatedPolar
from coeflab.law.added_mass import AddedMass
from coeflab.law.rigid_body import parallel_axis
from coeflab.tables.force_table import ForceTable

NEUTRAL = 0.005  # of the displacement: weight and buoyancy of a glider at rest agree within what its engine trims
SECONDS = 20.0  # in which sliding mass and engine go from one end to the other, where nothing is stated


@dataclass(frozen=True, slots=True)
class Ordered:
    """What no shape and no polar says of a glider.

    Attributes
    ----------
    engine : float
        Largest net mass either way, kg.
    engine_at : float or None
        x of the engine from the body's datum, m; None: at the centre of buoyancy.
    sliding : str
        Which [[mass]] part slides along x; empty: none.
    travel : float
        Of the sliding mass to either side of its place, m.
    net_mass, shift : float
        Of the dive, kg and m from the place of the sliding mass; the climb has the opposite.
    lasts : float
        Of each, s.
    pitch_damping : float
        N m/(m/s rad/s).
    holds_munk : bool
        Whether the polar's moment holds the Munk moment, as one from CFD or a tank does.
    damping_is_estimate : bool
        Whether the pitch damping is that of the shape.
    depth : float or None
        At which the dive ends, m; the climb then ends at the surface.
    """

    engine: float
    engine_at: float | None
    sliding: str
    travel: float
    net_mass: float
    shift: float
    lasts: float
    pitch_damping: float
    holds_munk: bool
    damping_is_estimate: bool = False
    depth: float | None = None


def polar_of(table: ForceTable, body: Body, ordered: Ordered) -> StatedPolar:
    """The polar of a table, about the body's centre of buoyancy.

    Raises
    ------
    InputError
        Another datum than the body's, a force that is not there.
    """
    model = body.mass_model
    if table.datum.id == body.datum.id and model is not None:
        table = table.about(model.centre_of_buoyancy)
    elif table.datum.id == "cb":
        table = table.about(np.zeros(3))
    else:
        raise input_error("glider.moments_counted", column="axes.datum", datum=table.datum, datum_2=body.datum)
    found = fit([table], table.scaling, {"angle_unit": "rad"})
    values: dict[str, float] = {}
    for m in found.models:
        values |= {s.partition(" ")[0]: float(v) for s, v in zip(m.symbols, m.fit.coefficients, strict=True)}
    if absent := [k for k in ("K_L0", "K_L", "K_D0", "K_D", "K_M0", "K_M") if k not in values]:
        raise InputError(f"no {', '.join(absent)}", "X, Z and M over several angles of attack", column="glide_polar")
    alpha = np.arctan2(table.motion["w"], table.motion["u"])
    return StatedPolar(
        "rad", values["K_L0"], values["K_L"], values["K_D0"], max(values["K_D"], 0.0), values["K_M0"], values["K_M"],
        ordered.pitch_damping, ordered.holds_munk, (float(np.min(alpha)), float(np.max(alpha))),
    )  # fmt: skip


def glider_of(name: str, table: ForceTable, body: Body, added: AddedMass, ordered: Ordered) -> Glider:
    """The glider, neutral where its engine stands at zero.

    Parameters
    ----------
    name : str
    table : ForceTable
        Forces over the angle of attack.
    body : Body
        With [[mass]] parts.
    added : AddedMass
    ordered : Ordered

    Raises
    ------
    InputError
        No [[mass]] parts, no part of the sliding mass's name, a weight apart from the buoyancy, or an order beyond the travel.
    """
    model = body.mass_model
    if model is None:
        raise InputError(f"{body.name} without [[mass]]", "its parts with mass and place", column="mass")
    displaced = model.density * model.volume
    if abs(model.mass / displaced - 1.0) > NEUTRAL:
        raise input_error(
            "glider.kg_displaces_kg", column="mass", mass=model.mass, displaced=displaced, value=100.0 * NEUTRAL,
        )  # fmt: skip
    slides = next((p for p in model.parts if p.name == ordered.sliding), None)
    if ordered.sliding and slides is None:
        raise InputError(shown(ordered.sliding), f"one of {', '.join(p.name for p in model.parts)}", column="--sliding")
    for key, value, most, unit in (
        ("--net-mass", ordered.net_mass, ordered.engine, "kg"),
        ("--shift", ordered.shift, ordered.travel, "m"),
    ):
        if not abs(value) <= most:
            raise InputError(f"{value:g} {unit}", f"at most {most:g} {unit}, which it reaches", column=key)
    middle = model.centre_of_buoyancy
    rest = [p for p in model.parts if p is not slides]
    mass = sum(p.mass for p in rest)
    moment = sum((p.mass * (p.centre - middle) for p in rest), np.zeros(3)) * STANDARD_GRAVITY
    turning = sum(p.inertia[1, 1] + parallel_axis(p.mass, p.centre - middle)[1, 1] for p in rest)
    water = added.about(middle).matrix
    place = 0.0 if slides is None else float(slides.centre[0] - middle[0])
    phases = tuple(
        GliderPhase(called, way * ordered.net_mass, place + way * ordered.shift, lasts=ordered.lasts, until_depth=until)
        for called, way, until in (
            ("dive", 1.0, ordered.depth),
            ("climb", -1.0, None if ordered.depth is None else 0.0),
        )
    )
    engine_at = 0.0 if ordered.engine_at is None else ordered.engine_at - float(middle[0])
    return Glider(
        name, f"{body.title}, by the polar of {table.campaign}", table.source.citation, STANDARD_GRAVITY,
        GliderMass(mass + float(water[0, 0]), mass + float(water[2, 2]), float(turning + water[4, 4]), float(moment[0]), float(moment[2])),
        _sliding(slides, place, middle, ordered.travel),
        BuoyancyEngine(engine_at, low=-ordered.engine, high=ordered.engine, rate=max(2.0 * ordered.engine, 1e-9) / SECONDS),
        polar_of(table, body, ordered), phases, _basis(table, body, added, ordered),
    )  # fmt: skip


def _sliding(part: MassPart | None, place: float, middle: np.ndarray, travel: float) -> SlidingMass:
    if part is None:
        return SlidingMass(0.0, 0.0, 0.0, 0.0, 1.0)
    below = float(part.centre[2] - middle[2])
    return SlidingMass(part.mass, below, place - travel, place + travel, max(2.0 * travel, 1e-9) / SECONDS)


def _basis(table: ForceTable, body: Body, added: AddedMass, ordered: Ordered) -> tuple[tuple[str, str], ...]:
    damping = "the estimate of Mq' from the shape" if ordered.damping_is_estimate else "as asked for"
    parts = f"[[mass]] of {body.name} about its centre of buoyancy"
    return (
        ("mass", f"derived: {parts}, added mass by {added.method}"),
        ("sliding_mass", f"derived: {ordered.sliding} of {body.name}; assumed: {SECONDS:g} s from end to end"),
        ("engine", f"assumed: as asked for, {SECONDS:g} s from end to end"),
        ("polar", f"derived: fit glide_polar of {table.campaign}"),
        ("polar.pitch_damping", f"assumed: {damping}"),
        ("phase", "assumed: as asked for"),
    )
