"""THAUV beyond the vertical plane: its masses, the spiral, the cruise, and a dive as a parameter file that simulators can hold.

A dive with pistons and roller at rest is a rigid body of some weight and buoyancy. The polar over alpha becomes the series that
`coeflab.fits.glide_polar` gives, whose first term left out is of the fifth order; drift comes in up to the second order::

    X = series + (K_S + D0/2) v^2        Y = -(D0 + K_S) V v        K = -roll_damping V p
    Z = series                           M = series - damping V q   N = K_Y V v - yaw_damping V r
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from coeflab.core.axes import Datum
from coeflab.core.files import shipped
from coeflab.core.provenance import InputFile, sha256_of
from coeflab.core.types import Array
from coeflab.fits.glide_polar import series
from coeflab.formats.stated_file import Law, Stated, stated_file
from coeflab.glider.glide import GlideRun, steady_glides, steady_spirals
from coeflab.glider.glider import Glider, GliderPhase
from coeflab.glider.space import SpaceBody, Spiral, cruise, out_of_balance, pushed, steady_spiral, unexplained_in_space
from coeflab.law.rigid_body import MassProperties
from coeflab.law.scaling import Conditions, Scaling
from coeflab.motion.simulators import SIMULATORS
from coeflab.motion.vehicle import vehicle
from coeflab.published.publication import Row, publication
from coeflab.report.acceptance import Basis, ComparedTable
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.parameter_parts import CurveSegment, ParameterCurve, ParameterHydrostatics, ParameterThruster

PAPER = publication("thauv")

FlownSpiral = tuple[GlideRun, Spiral | None]
UNIT = Scaling(1.0, "unit length (the paper prints none)")
ROLLED, FLOWN_FOR, CRUISE = np.radians(60.0), 420.0, 0.5
STATES, SEED = 60, 20260102
EXACT, TUMBLING = 1e-9, 0.01


def space_of(glider: Glider) -> tuple[SpaceBody, Array]:
    """What the equations in space need, and the place (3,) of the rest of the masses, of a shipped case.

    Raises
    ------
    ValueError
        The glider file has no motion in space.
    """
    space, rest = glider.space, glider.rest_place
    if space is None or rest is None:
        raise ValueError(f"{glider.name} has no [masses], [lateral] and [thrusters]")
    return space, rest


def rolled(glider: Glider, angle: float = ROLLED) -> GliderPhase:
    """The first dive with the roller turned."""
    return replace(glider.phases[0], roller=float(angle), lasts=FLOWN_FOR)


def flown_spiral(glider: Glider) -> FlownSpiral:
    """That dive in time from rest, and its steady turn."""
    phase = rolled(glider)
    turning = replace(glider, phases=(phase,))
    found = steady_spirals(turning, phase)
    motion = SIMULATORS.load("glider").simulate(turning, turning.manoeuvre(1), {"step": 5.0})
    return GlideRun(turning, motion), found[0] if len(found) == 1 else None


def compared_in_space(glider: Glider, flown: FlownSpiral | None = None) -> tuple[ComparedTable, ...]:
    """Every number of one case that the vertical plane does not hold; ``flown`` where its spiral is known already."""
    turning = flown or flown_spiral(glider)
    return (_masses(glider), _energy(glider), _cruise(glider), *_spiral(glider, *turning), _carried(glider))


def _masses(glider: Glider) -> ComparedTable:
    space, rest = space_of(glider)
    masses, g = space.masses, glider.gravity
    right_angle = g * (masses.moments(0.0, np.pi / 2, rest) - masses.moments(0.0, 0.0, rest))
    rows = [
        Row("section 2", "static mass m_s", "kg", 65.33, masses.static, 0.005, Basis.VERIFICATION),
        Row("stroke 0.03 m", "mass less displaced mass", "kg", glider.phases[0].net_mass, masses.total - masses.displaced(0.03), 1e-5),
    ]  # fmt: skip
    for stage, stroke, ahead in (("1", 0.03, 2.272), ("2", 0.05, 3.898)):
        found = g * masses.moments(stroke, 0.0, rest)
        for name, value, against in (("ahead", found[0], ahead), ("aside", found[1], 0.0), ("below", found[2], 4.712)):
            rows.append(Row(f"stage {stage}", f"moment {name}", "N m", against, float(value)))
    lever = masses.roller * g * masses.roller_arm
    for name, at, against in (("aside", 1, lever), ("below", 2, -lever)):
        rows.append(Row("roller at 90 deg", f"moment {name} gained", "N m", against, float(right_angle[at]), EXACT))
    j = masses.inertia(0.0, 0.0, rest)
    return PAPER.table("masses", rows, j_x=j[0, 0], j_y=j[1, 1], j_z=j[2, 2], inertia=glider.mass.pitch_inertia)


def _energy(glider: Glider) -> ComparedTable:
    space, _ = space_of(glider)
    sizes = (0.5, 0.6, 0.6, 0.2, 0.2, 0.2, 0.2, 0.2)
    draws = np.random.default_rng(SEED).uniform(-1.0, 1.0, (STATES, 8)) * sizes
    setting = rolled(glider).setting._replace(right=1.0, left=2.0)
    power, drift, spun = unexplained_in_space(space, setting, draws)
    moved = f"{STATES} motions"
    rows = (
        Row.none(moved, "power without a force", "W", power),
        Row.none(moved, "velocity without a cause", "m/s", drift),
        Row.none(moved, "rotation without a cause", "rad/s", spun),
    )
    return PAPER.table("power_in_space", rows)


def _cruise(glider: Glider) -> ComparedTable:
    space, _ = space_of(glider)
    found = cruise(space, CRUISE)
    level = Spiral(CRUISE, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    left = out_of_balance(space, found.setting, level)
    pushed = out_of_balance(space, found.setting._replace(right=found.setting.right + 1.0), level) - left
    rows = (
        Row("thrust of the drag", "force ahead left over", "N", 0.0, float(left[0])),
        Row("net mass of the lift", "force down left over", "N", 0.0, float(left[2])),
        Row("1 N more on the right", "force ahead", "N", 1.0, float(pushed[0])),
        Row("1 N more on the right", "yaw moment", "N m", -0.25, float(pushed[5])),
    )
    return PAPER.table(
        "cruise", rows, speed=CRUISE, drag=found.drag, lift=found.lift, each=found.drag / 2,
        grams=1e3 * found.setting.net_mass, elevator=found.elevator,
    )  # fmt: skip


def _spiral(glider: Glider, run: GlideRun, steady: Spiral | None) -> tuple[ComparedTable, ComparedTable]:
    t, phase = run.trajectory, run.glider.phases[0]
    phi, theta, _ = t.angles[-1]
    last = slice(-2, None)
    lasted = float(np.diff(t.time[last])[0])
    chord = float(np.hypot(*np.diff(t.position[last, :2], axis=0)[0]))
    turn = float(np.diff(t.heading[last])[0]) / lasted
    radius = chord / (2.0 * abs(np.sin(turn * lasted / 2.0))) if turn else None
    values = {
        ("V", "m/s"): (steady and steady.speed, float(run.speed[-1])),
        ("alpha", "deg"): (steady and np.degrees(steady.alpha), float(np.degrees(run.alpha[-1]))),
        ("roll", "deg"): (steady and np.degrees(steady.phi), float(np.degrees(phi))),
        ("pitch", "deg"): (steady and np.degrees(steady.theta), float(np.degrees(theta))),
        ("turn", "deg/s"): (steady and np.degrees(steady.turn), float(np.degrees(turn))),
        ("sinking", "m/s"): (steady and steady.sinking, float(np.diff(t.position[last, 2])[0]) / lasted),
        ("radius", "m"): (steady and steady.radius, radius),
    }
    case = f"roller at {np.degrees(ROLLED):.0f} deg"
    same = tuple(
        Row(case, name, unit, float(against or np.nan), found) for (name, unit), (against, found) in values.items()
    )
    settled = PAPER.table("spiral", same, glider=glider.name, lasts=FLOWN_FOR)
    return settled, _senses(glider, steady, phase)


def _senses(glider: Glider, steady: Spiral | None, phase: GliderPhase) -> ComparedTable:
    """Which way the roller turns it, by signs; and the same turn mirrored."""
    space, _ = space_of(glider)
    climb = steady_spirals(glider, replace(glider.phases[1], roller=float(ROLLED)))
    (straight,) = steady_glides(glider, phase) or (None,)
    port = None
    if straight is not None:
        port = steady_spiral(
            space, phase.setting._replace(roller=-ROLLED), straight.speed, straight.alpha, straight.theta
        )
    rows = [
        Row("dive, roller to starboard", "sense of the turn", "1", 1.0, _sign(steady)),
        Row("climb, roller to starboard", "sense of the turn", "1", -1.0, _sign(climb[0] if climb else None)),
        Row("dive, roller to port", "sense of the turn", "1", -1.0, _sign(port)),
    ]  # fmt: skip
    return PAPER.table("senses", rows)


def _sign(turn: Spiral | None) -> float | None:
    return None if turn is None else float(np.sign(turn.turn))


def dive_law(glider: Glider) -> dict[str, float]:
    """Totals, with the Munk moments, of the terms that a dive's polar becomes, SI; see the module."""
    space, _ = space_of(glider)
    p, s, m = space.plane.polar, space.lateral, np.diag(space.inertia)
    munk_pitch, munk_yaw = (0.0, 0.0) if space.plane.holds_munk else (float(m[2] - m[0]), float(m[0] - m[1]))
    return series(np.array([*p.lift, *p.drag, *p.moment]), munk_pitch) | {
        "Xvv": s.K_S + p.drag[0] / 2.0, "Yv": -(p.drag[0] + s.K_S), "Kp": -s.roll_damping, "Mq": -p.damping,
        "Nv": s.K_Y + munk_yaw, "Nr": -s.yaw_damping,
    }  # fmt: skip


def dive_file(glider: Glider, phase: GliderPhase, name: str) -> ParameterFile:
    """A dive with pistons and roller at rest where the phase has them: derivatives, masses, buoyancy and thrusters.

    Parameters
    ----------
    glider : Glider
        A shipped case.
    phase : GliderPhase
    name : str
    """
    space, rest = space_of(glider)
    masses, at = space.masses, Conditions(space.masses.density, 0.3)
    weight = masses.total * glider.gravity
    centre = space.moments(phase.setting) / weight
    rigid = masses.inertia(phase.position, phase.roller, rest)
    added = np.diag(np.diag(space.inertia) - [*([masses.total] * 3), *np.diag(rigid)])
    law: Law = "motion"
    coefficients = {symbol: (value / UNIT.unit(symbol, at.density), law) for symbol, value in dive_law(glider).items()}
    stated = Stated(
        name, glider.title, UNIT, at, coefficients, datum=Datum("cb"), matrix=added,
        mass=MassProperties(masses.total, masses.total * float(centre[0]), None, centre, rigid),
        notes=PAPER.texts(
            "notes_dive", glider=glider.name, phase=phase.name, net=phase.net_mass, stroke=phase.position, roller=np.degrees(phase.roller),
        ),
    )  # fmt: skip
    folder = Path(str(shipped("cfd_data") / "thauv"))
    source = f"{glider.name.removeprefix('thauv_')}.toml"
    file = stated_file(stated, [InputFile(f"thauv/{source}", sha256_of(folder / source))], ("thauv",))
    rest_state = ParameterHydrostatics(
        volume=(masses.total - phase.net_mass) / at.density, centre_of_buoyancy=(0.0, 0.0, 0.0), gravity=glider.gravity
    )
    t = space.thrusters
    curve = ParameterCurve(
        command="thrust", unit="N", segments=(CurveSegment(low=-t.largest, high=t.largest, coefficients=(0.0, 1.0)),)
    )
    thrusters = tuple(
        ParameterThruster(name=side, position=(0.0, y, t.below), direction=(1.0, 0.0, 0.0), curve=curve)
        for side, y in (("right", t.aside), ("left", -t.aside))
    )
    provenance = file.provenance.model_copy(update={"study": "thauv"})
    return file.model_copy(update={"hydrostatics": rest_state, "thrusters": thrusters, "provenance": provenance})


def dive_files(gliders: Sequence[Glider]) -> tuple[ParameterFile, ...]:
    """Both dives of every case, and the spiral of the case that the report shows."""
    dives = [dive_file(g, g.phases[i], f"{g.name}_dive_{stage}") for g in gliders for i, stage in ((0, 1), (2, 2))]
    return (*dives, *(dive_file(g, rolled(g), f"{g.name}_spiral") for g in gliders if g.name.endswith("02")))


def _carried(glider: Glider) -> ComparedTable:
    """Forces left over by the rigid body of the parameter file on steady glide and spiral, over those that it balances."""
    rows = []
    for name, phase in (("glide", glider.phases[0]), ("spiral", rolled(glider))):
        craft = vehicle(ParameterFile.model_validate_json(dive_file(glider, phase, "dive").to_json()))
        for steady in steady_spirals(glider, phase)[:1]:
            half = np.array([steady.phi, steady.theta]) / 2.0
            (sp, st), (cp, ct) = np.sin(half), np.cos(half)
            attitude = np.array([[cp * ct, sp * ct, cp * st, -sp * st]])
            left = craft.unbalanced(steady.velocity[None, :], attitude, np.zeros((1, 3)), np.zeros(6))[0]
            force, arm = (
                phase.net_mass * glider.gravity,
                float(np.max(np.abs(space_of(glider)[0].moments(phase.setting)))),
            )
            found = max(float(np.max(np.abs(left[:3]))) / force, float(np.max(np.abs(left[3:]))) / arm)
            rows.append(Row(name, "left over", "1", 0.0, found))
    rows.append(_tumbling(glider))
    return PAPER.table("carried", rows)


def _tumbling(glider: Glider) -> Row:
    """Moments of a fast rotation without way: those of inertia and of the masses, where the water gives none."""
    space, _ = space_of(glider)
    phase = rolled(glider)
    craft = vehicle(ParameterFile.model_validate_json(dive_file(glider, phase, "dive").to_json()))
    nu = np.array([0.0, 0.0, 0.0, 0.3, 0.2, -0.4])
    ours = pushed(space, nu, space.matrix(phase.position) @ nu, np.array([0.0, 0.0, 1.0]), phase.setting)[3:]
    upright = np.array([[1.0, 0.0, 0.0, 0.0]])
    theirs = craft.unbalanced(nu[None, :], upright, np.zeros((1, 3)), np.zeros(6))[0, 3:]
    apart = float(np.max(np.abs(ours - theirs)) / np.max(np.abs(ours)))
    return Row("rotation without way", "moment apart", "1", 0.0, apart, TUMBLING)
