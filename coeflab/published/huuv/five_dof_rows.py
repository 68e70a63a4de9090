"""HUUV in five degrees of freedom: equations, parameter file, assumed geometry and motions, each by two ways."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from coeflab.bodies.closed_forms.parts import plate_added_mass
from coeflab.bodies.shape import Cylinder, Parts, Plate
from coeflab.core.types import Array, brief, locking
from coeflab.law.rigid_body import momentum_force
from coeflab.motion.dynamics import from_euler
from coeflab.motion.simulation import simulate
from coeflab.motion.steady_turns import steady_turns, turn_figures
from coeflab.motion.vehicle import vehicle
from coeflab.published.huuv import five_dof
from coeflab.published.huuv.model import MATLAB, Turns, commands, thrust
from coeflab.published.publication import Row, publication
from coeflab.report.acceptance import ComparedTable
from coeflab.vehicle.parameter_file import ParameterFile

PAPER = publication("huuv")

FREE = ("u", "v", "w", "q", "r")
ROWS = ("X", "Y", "Z", "M", "N")
MOTIONS, SEED = 1000, 20251217
# Worked out apart from this package: u v w q r, pitch, elevator, commands; X Y Z M N that accelerate, N and N m.
BY_HAND = (
    ((0.8, 0.1, 0.05, 0.2, -0.3), -0.15, 0.12, (30.0, 70.0), (-2.714048, -1.291923, 4.927592, 0.4611365, -0.3840439)),
    ((0.6, -0.12, -0.08, -0.25, 0.4), 0.1, -0.2, (30.0, 70.0), (2.38329, 1.065182, -4.8913, -0.09395622, -0.9791497)),
)
DIVES, COMMAND, DURATION = (-10.0, 0.0, 10.0), 60.0, 300.0
SETTLED = 1e-4  # m/s; two hundred times that in deg
SETS = (
    ("stated masses", "stated"),
    ("those of the assumed geometry", "geometry"),
    ("its m_x, m_y; C_m, C_S moved", "moved"),
)
STRAIGHT = tuple(np.arange(20.0, 101.0, 10.0))


@brief
@dataclass(frozen=True, slots=True, eq=False)
@locking("time depth pitch speed end")
class Dive:
    """A simulated start with the elevators deflected, all (n,): s, m, rad, m/s; and u v w q r at its end."""

    time: Array
    depth: Array
    pitch: Array
    speed: Array
    end: Array


def dived(file: ParameterFile) -> dict[float, Dive]:
    """Simulations from the file's speed with both thrusters at 60 %, by elevator angle in degrees."""
    out = {}
    for angle in DIVES:
        orders = [f"left={COMMAND:g}", f"right={COMMAND:g}", f"db={float(np.radians(angle))!r}"]
        result = simulate(file, "straight_run", {"commands": orders, "duration": DURATION}, free=FREE).trajectory
        end = result.velocity[-1, five_dof.AT]
        out[angle] = Dive(result.time, result.position[:, 2], result.angles[:, 1], result.velocity[:, 0], end)
    return out


def stated_rows(five: five_dof.FiveDof, file: ParameterFile) -> tuple[ComparedTable, ...]:
    """What needs no motion in time."""
    return (_forces(five, file), _geometry(five), _straight(five))


def moving_rows(five: five_dof.FiveDof, dives: Mapping[float, Dive]) -> tuple[ComparedTable, ...]:
    """What has been simulated with the parameter file, beside the equations; and the turns with other masses."""
    return (_dives(five, dives), _turns(five))


def _by_hand(five: five_dof.FiveDof) -> list[Row]:
    rows = []
    for i, (nu, pitch, delta, ordered, forces) in enumerate(BY_HAND, start=1):
        left, right = (np.array([c]) for c in ordered)
        found = five_dof.unbalanced(
            five, np.array([nu]), np.array([pitch]), np.array([delta]), five_dof.thrusts(five, left, right)
        )[0]
        rows += [
            Row(f"state {i}, worked out apart", name, "N" if name in "XYZ" else "N m", against, float(one), 1e-5)
            for name, against, one in zip(ROWS, forces, found, strict=True)
        ]
    return rows


def _commanded(five: five_dof.FiveDof) -> list[Row]:
    """Thrusters by their two inputs, and elevators beyond their largest angle, at 1 m/s; numbers by hand."""
    ahead, none = np.array([[1.0, 0.0, 0.0, 0.0, 0.0]]), np.zeros(1)
    tau = five_dof.thrusts(five, *commands(np.array([50.0]), np.array([10.0])))[0]
    held = -five_dof.elevator_damping(five, ahead, np.radians([40.0]))[0]
    still = float(five_dof.elevator_laws(five, none)[0][0])
    moved = replace(five, constants={**five.constants, "C_D0": 2.0 * still})
    apart = five_dof.damping(moved, ahead, np.array([0.3])) - five_dof.damping(five, ahead, np.array([0.3]))
    words, beyond = "inputs 50 % and 10 %", "elevators ordered to 40 deg, held at 30 deg"
    return [
        Row(words, "X", "N", 11.864, float(tau[0]), 1e-5),
        Row(words, "N", "N m", -0.3308, float(tau[4]), 1e-5),
        Row(beyond, "X", "N", -6.031425, float(held[0]), 1e-5),
        Row(beyond, "Z", "N", 20.826314, float(held[2]), 1e-5),
        Row(beyond, "M", "N m", -4.436358, float(held[3]), 1e-5),
        Row("Fig. 15, elevators at 0 deg", "C_D", "1", 0.03, still, 1e-4),
        Row.none("C_D at 0 deg doubled", "force apart", "N", apart),
    ]


def _matrices(five: five_dof.FiveDof) -> tuple[Row, ...]:
    nu = np.random.default_rng(SEED).normal(size=(MOTIONS, 5))
    whole = np.zeros((MOTIONS, 6))
    whole[:, five_dof.AT] = nu
    theory = momentum_force(whole @ (five.rigid + five.added).T, whole)[:, five_dof.AT]
    matrix, m = five_dof.coriolis(five, nu), five_dof.inertia(five)
    held = -np.einsum("nij,nj->ni", matrix, nu)
    case = f"{MOTIONS} random motions"
    return (
        Row.none("M", "apart from its transpose", "kg, kg m", m - m.T),
        Row(case, "C + C^T", "kg m/s", 0.0, float(np.max(np.abs(matrix + np.swapaxes(matrix, 1, 2)))), 0.0),
        Row.none(case, "force apart from Kirchhoff's", "N, N m", held - theory),
    )  # fmt: skip


def _forces(five: five_dof.FiveDof, file: ParameterFile) -> ComparedTable:
    """Forces of the file, elevators at no drift, where its V^2 is that of equations 15-17; power of the hull's forces."""
    rng = np.random.default_rng(SEED)
    c = five.level.chosen
    nu = rng.uniform(-0.4, 0.4, size=(MOTIONS, 5))
    nu[:, 0] = rng.uniform(0.5, 1.2, MOTIONS)
    nu[:, 1:3] *= np.tan(c["largest_drift"]) * nu[:, :1]
    pitch, delta = rng.uniform(-0.5, 0.5, MOTIONS), rng.uniform(-0.5, 0.5, MOTIONS)
    level = nu * (1.0, 0.0, 1.0, 1.0, 1.0)
    cases = (("elevators deflected, no drift", level, delta), ("elevators neutral, drift", nu, np.zeros(MOTIONS)))
    result, none = vehicle(file, free=FREE), np.zeros((MOTIONS, 5))
    rows = [*_by_hand(five), *_commanded(five), *_matrices(five)]
    for case, motion, angle in cases:
        whole, controls = np.zeros((MOTIONS, 6)), np.zeros((MOTIONS, 3))
        whole[:, five_dof.AT], controls[:, 2] = motion, angle
        attitude = np.array([from_euler(0.0, float(p), 0.0) for p in pitch])
        found = result.unbalanced(whole, attitude, controls, np.zeros(6))[:, five_dof.AT]
        apart = found - five_dof.unbalanced(five, motion, pitch, angle, none)
        rows.append(Row.none(case, "parameter file less equations", "N, N m", apart))
    speed, alpha, beta = five_dof.angles(nu)
    power = np.sum(five_dof.hull_damping(five, nu)[:, :3] * nu[:, :3], axis=1)
    drag = speed**3 * five_dof.hull_laws(five, alpha, beta)["C_D"]
    rows.append(Row.none("hull", "power less V F_D", "W", power - drag))
    return PAPER.table("five_dof_forces", rows)


def _geometry(five: five_dof.FiveDof) -> ComparedTable:
    body = five_dof.assumed_body()
    by_hand, matrix = five_dof.simple_masses(body, five.density), five.geometry
    shape = body.require_shape()
    parts = shape.parts if isinstance(shape, Parts) else ()
    mast = [p.form for p in parts if isinstance(p.form, Cylinder)][1]
    plates = [(p.form, float(p.centre[0])) for p in parts if isinstance(p.form, Plate)]
    standing = five.density * np.pi * mast.radius**2 * mast.length
    own = [plate_added_mass(f.chord, f.span, five.density) for f, _ in plates]
    normal = sum(float(m[2, 2]) * ahead for m, (_, ahead) in zip(own, plates, strict=True))
    height = float(parts[1].centre[2])
    j_y = by_hand["J_y"] + sum(float(m[4, 4]) for m in own)
    rows = (
        Row("equation 28", "m_x", "kg", by_hand["m_x"], matrix[0, 0]),
        Row("equation 29", "m_y", "kg", by_hand["m_y"], matrix[1, 1]),
        Row("equation 30", "m_z, and 0.1 of the mast", "kg", by_hand["m_z"] + 0.1 * standing, matrix[2, 2]),
        Row("equation 31", "J_y, and the plates' own", "kg m^2", j_y, matrix[4, 4]),
        Row("equation 32", "J_z", "kg m^2", by_hand["J_z"], matrix[5, 5]),
        Row("equation 33", "m_zq from the elevators", "kg m", -normal, matrix[2, 4]),
        Row("equation 33", "m_yr, all alike fore and aft", "kg m", 0.0, matrix[1, 5]),
        Row("equation 1, row 1, column 4", "m_x z of the mast", "kg m", standing * height, matrix[0, 4]),
        Row("equation 1, C, column 5", "m_y z of the mast", "kg m", standing * height, -matrix[1, 3]),
    )
    ours = {"m_x": matrix[0, 0], "m_y": matrix[1, 1], "m_yr": matrix[1, 5], "m_zq": matrix[2, 4]}
    c = five.level.constants
    return PAPER.table("five_dof_geometry", rows, printed=c["m"] / 20.0, turns=c, **ours)


def _straight(five: five_dof.FiveDof) -> ComparedTable:
    """Nine straight runs in five degrees of freedom, beside the horizontal model's closed form."""
    ordered = np.array(STRAIGHT)
    c = five.level.constants
    push = five_dof.thrusts(five, *commands(ordered, np.zeros(len(ordered))))
    speed = np.sqrt(push[:, 0] / c["d0"])
    start = np.column_stack([speed, np.zeros((len(speed), 4))])
    neutral = replace(five, constants={**five.constants, "displaced": c["m"] / five.density})
    found, growth = five_dof.steady(neutral, np.zeros(len(speed)), push, start)
    floating, _ = five_dof.steady(five, np.zeros(len(speed)), push, start)
    rows = tuple(
        Row(f"{command:g} %", "u, neutrally buoyant", "m/s", float(u), float(ours))
        for command, u, ours in zip(ordered, speed, found[:, 0], strict=True)
    )
    up = floating[:, 2] * np.cos(floating[:, 3]) - floating[:, 0] * np.sin(floating[:, 3])
    light = five.buoyancy - five.weight
    stable = "all are stable" if np.all(growth < 0.0) else "some are not stable"
    return PAPER.table("five_dof_straight", rows, stable=stable, light=light, slow=-up[0], fast=-up[-1])


def _dives(five: five_dof.FiveDof, dives: Mapping[float, Dive]) -> ComparedTable:
    """Where simulations of the parameter file end, and where forces vanish."""
    at = np.radians(list(dives))
    both = np.full(len(at), COMMAND)
    push = five_dof.thrusts(five, both, both)
    speed = np.sqrt(push[:, 0] / five.level.constants["d0"])
    found, _ = five_dof.steady(five, at, push, np.column_stack([speed, np.zeros((len(at), 4))]))
    rows = []
    for (angle, dive), (u, _, w, pitch, _) in zip(dives.items(), found, strict=True):
        pairs = (
            ("u", "m/s", u, dive.end[0]),
            ("w", "m/s", w, dive.end[2]),
            ("pitch", "deg", np.degrees(pitch), np.degrees(dive.pitch[-1])),
        )
        rows += [
            Row(f"elevators {angle:+g} deg", what, unit, float(a), float(b), SETTLED * (200.0 if unit == "deg" else 1.0))
            for what, unit, a, b in pairs
        ]  # fmt: skip
    down = dives[DIVES[-1]]
    sinks = (down.depth[-1] - down.depth[-2]) / (down.time[-1] - down.time[-2])
    return PAPER.table("five_dof_dives", rows, duration=DURATION, sinks=sinks)


def with_masses(five: five_dof.FiveDof, how: str, turns: Turns) -> Array:
    """(n, 3) u, |beta| and R of turns with the masses of the steady turns or of the assumed geometry, heave and pitch left out.

    Parameters
    ----------
    five : FiveDof
    how : {"stated", "geometry", "moved"}
        ``moved``: m_x and m_y of the geometry, C_m(beta) moved by as much as m_y - m_x, C_S scaled as m + m_x.
    turns : Turns
    """
    c = dict(five.level.constants)
    if how != "stated":
        a = five.geometry
        if how == "moved":
            c["n1"] += float(a[1, 1] - a[0, 0]) - (c["my"] - c["mx"])
            heavier = (c["m"] + float(a[0, 0])) / (c["m"] + c["mx"])
            c |= {"s1": heavier * c["s1"], "s3": heavier * c["s3"]}
        else:
            c["myr"] = float(a[1, 5])
        c |= {"mx": float(a[0, 0]), "my": float(a[1, 1])}
        c["inertia"] = five.level.chosen["rigid_inertia"] + float(a[5, 5])
    level = replace(five.level, constants=c)
    push = thrust(turns.left, turns.right, c["slope"], c["intercept"], c["arm"], level.dead_zone)
    return turn_figures(steady_turns(level.theta, push).velocity)[0]


def _turns(five: five_dof.FiveDof) -> ComparedTable:
    """Steady turns with heave and pitch, and with other masses."""
    turns = five.level.accepted
    turning = np.isfinite(turns.figures[:, 2])
    some = Turns(turns.left[turning], turns.right[turning], turns.figures[turning])
    push = five_dof.thrusts(five, some.left, some.right)
    level = steady_turns(five.level.theta, push[:, [0, 1, 4]]).velocity
    none = np.zeros(len(level))
    found, growth = five_dof.steady(five, none, push, np.column_stack([level[:, :2], none, none, level[:, 2]]))
    speed = np.linalg.norm(found[:, :3], axis=1)
    radius = speed * np.cos(found[:, 3]) / np.abs(found[:, 4])
    rows = []
    for i in range(len(level)):
        case = f"{some.left[i]:g}, {some.right[i]:g} %"
        drift = float(np.degrees(np.abs(np.arcsin(found[i, 1] / speed[i]))))
        figures = (
            (some.figures[i, 0], found[i, 0]),
            (np.degrees(some.figures[i, 1]), drift),
            (some.figures[i, 2], radius[i]),
        )
        rows += [
            Row(case, what, unit, float(a), float(b))
            for (what, unit), (a, b) in zip((("u", "m/s"), ("|beta|", "deg"), ("R", "m")), figures, strict=True)
        ]  # fmt: skip
    steep = float(np.degrees(np.max(np.abs(found[:, 3]))))
    all_of = five.level.turns[MATLAB]
    words = [_departure(label, with_masses(five, how, all_of), all_of) for label, how in SETS]
    stable = "all are stable" if np.all(growth < 0.0) else "some are not stable"
    return PAPER.table("five_dof_turns", rows, steep=steep, stable=stable, words=words)


def _departure(label: str, found: Array, turns: Turns) -> str:
    """Root mean square from the printed simulation, in words."""
    reached = np.asarray(np.isfinite(found).all(axis=1))
    u, beta, radius = np.sqrt(np.mean((found[reached] - turns.figures[reached]) ** 2, axis=0))
    return (
        f"Fig. 17 b, d, f with {label}: rms {u:.2g} m/s, {np.degrees(beta):.2g} deg, {radius:.2g} m in {np.sum(reached)} of "
        f"{len(reached)} turns."
    )
