"""TJ-FlyingFish in motion: equations 1 to 34 against what is integrated, hovering, both readings of Table 1, tracks, the surface, the bench."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from coeflab.core.files import shipped
from coeflab.core.types import Array
from coeflab.identify.thruster import BenchTest, bench_test
from coeflab.motion.dynamics import from_euler
from coeflab.motion.ensemble import STILL, alone
from coeflab.motion.manoeuvre import Manoeuvre, Phase, Until
from coeflab.motion.manoeuvres.steady_motion import helix
from coeflab.motion.media import through_media
from coeflab.motion.simulators import SIMULATORS
from coeflab.motion.trajectory import Trajectory
from coeflab.motion.trim.operating_point import operating_point
from coeflab.motion.trim.trim import trim as trimmed
from coeflab.motion.vehicle import Vehicle, vehicle
from coeflab.published.flyingfish import model
from coeflab.published.flyingfish.equations import aerial_wrench, body_rates, damping, dash, earth_rates, rise, turned
from coeflab.published.flyingfish.rotors import rotor_wrench, steady_residuals
from coeflab.published.flyingfish.trims import EQUATIONS, UNKNOWNS, unknowns_of
from coeflab.published.parameter_files import flyingfish_file
from coeflab.published.publication import Row, publication
from coeflab.report.acceptance import Basis, ComparedTable

PAPER = publication("flyingfish")

INERTIA = (0.02, 0.03, 0.045)  # kg m^2, unequal: with equal ones the gyroscopic moments of equations 10 to 12 vanish
STATES, SEED, EXACT = 40, 20260102, 1e-9
EQUATION_45, EQUATION_46 = (2.8619e-5, 1.1587e-7), (2.5078e-6, 1.6430e-9)
EQUATION_48 = (1.81713e-7, 5.1233e-9)
EQUATION_49 = ((0.0010, 0.0006, 0.0004, 0.0, 0.0, 0.0), (0.0165, 0.0227, 0.0364, 0.0002, 0.0005, 0.0013))
EQUATION_50 = ((0.0998, 0.1658, 0.0064, 0.0032, 0.0008, 0.0029), (18.2222, 15.8047, 24.7142, 0.0489, 0.1554, 0.1872))
DESCENT = float(np.radians(-5.0))  # pitch of the flight ahead, nose down
PATHS = {9: 72.0, 10: 36.0}  # s: one turn of motion 9, two of motion 10; the others 20 s
STRAIGHT = 20.0
# m below the surface, rotor speeds, and the yaw rate at the start of the hop, rad/s
DEPTH, UNDER, ABOVE, TURNING = 2.0, 2500.0, 5000.0, 0.5
BENCH = "flyingfish_bench_synthetic"
BENCH_AT: dict[model.Medium, float] = {"water": 2000.0, "air": 6000.0}


@dataclass(frozen=True, slots=True, eq=False)
class Craft:
    """The vehicles of both parameter files, and the corrected trims of Table 1.

    Attributes
    ----------
    fish : FlyingFish
    constants : (5,) array
    water, air : Vehicle
    trims : (10, 8) array
        Tilts in rad and rotor speeds in rpm, nearest to the printed rows by equation 40 with its sign corrected.
    """

    fish: model.FlyingFish
    constants: Array
    water: Vehicle
    air: Vehicle
    trims: Array

    def orders(self, row: int) -> dict[str, float]:
        """Commands of one trim."""
        return commands(self.trims[row])


def commands(point: Array) -> dict[str, float]:
    """Tilts and rotor speeds by the names of thrusters."""
    speeds = {f"rotor{name}": float(point[4 + i]) for i, name in enumerate(model.ROTORS)}
    return speeds | {f"rotor{name}.tilt": float(point[i]) for i, name in enumerate(model.ROTORS)}


def craft(fish: model.FlyingFish, rows: int | None = None) -> Craft:
    """Vehicles, and trims of the first rows or of all; the constants are those of the data, as in the parameter files."""
    constants = np.array([fish.constants[name] for name in model.CONSTANTS])
    water, air = (vehicle(flyingfish_file(fish, medium)) for medium in model.MEDIA)

    def by_equations(row: int) -> Array:
        motion = fish.motion[row : row + 1]

        def left(x: Array) -> Array:
            return steady_residuals(fish.rotors, constants, motion, x[None, :4], x[None, 4:], -1.0).ravel()

        return _nearest(fish, row, left)

    count = len(fish.motion) if rows is None else rows
    return Craft(fish, constants, water, air, np.array([by_equations(row) for row in range(count)]).reshape(-1, 8))


def compared(c: Craft) -> tuple[ComparedTable, ...]:
    """Every table of this file."""
    return (
        equations(c, "water"), equations(c, "air"), hovering(c), both_readings(c), third(c.fish), tracks(c), surface(c),
        bench(c.fish),
    )  # fmt: skip


def _nearest(fish: model.FlyingFish, row: int, left: Callable[[Array], Array], first: Array | None = None) -> Array:
    """Nan where there is no trim."""
    start = None if first is None else first.tolist()
    found = operating_point(unknowns_of(fish, row), EQUATIONS, left, start, starts=0)
    return np.asarray(found.found.point) if found.outcome.solved else np.full(8, np.nan)


def equations(c: Craft, medium: model.Medium) -> ComparedTable:
    """Rates of random states: the printed equations, Euler angles and all, and what a march of the parameter file takes."""
    rng = np.random.default_rng(SEED)
    wet = medium == "water"
    body = replace(c.water if wet else c.air, inertia=np.diag(INERTIA))
    nu = rng.normal(size=(STATES, 6)) * ([0.5] * 3 + [0.6] * 3 if wet else [5.0] * 3 + [2.0] * 3)
    angles = rng.uniform(-1.2, 1.2, size=(STATES, 3))
    speeds = rng.uniform(200.0, 2500.0 if wet else 9000.0, size=(STATES, 4))
    tilts = rng.uniform(-1.5, 1.5, size=(STATES, 4)) if wet else np.zeros((STATES, 4))
    points = np.hstack([tilts, speeds])
    known = {t.name for t in body.thrusters} | {f"{t.name}.tilt" for t in body.thrusters if t.tilt_axis is not None}
    wrench = np.array([body.wrench({k: v for k, v in commands(p).items() if k in known}) for p in points])
    attitude = np.array([from_euler(*a) for a in angles])
    state = np.vstack([np.zeros((3, STATES)), attitude.T, nu.T, np.zeros((1, STATES))])
    rates = alone(body).dynamics(STILL).rates(state, np.zeros((3, STATES)), wrench.T)
    moving = earth_rates(nu, angles)
    step = 1e-5
    ahead, behind = (np.array([from_euler(*a) for a in angles + s * step * moving[:, 3:]]) for s in (1.0, -1.0))
    arm, mass = c.fish.constants["arm_length"], c.fish.constants["mass"]
    rotors = c.fish.rotors
    if wet:
        thrust, torque = (a * speeds + b * speeds**2 for a, b in (rotors.thrust, rotors.torque))
        push = rotor_wrench(tilts, thrust, torque, arm, c.fish.constants["rotor_height"], -1.0)
    else:
        thrust, torque = (a * speeds + b * speeds**2 for a, b in (EQUATION_45, EQUATION_46))
        push = aerial_wrench(thrust, torque, arm)
    printed = EQUATION_50 if wet else EQUATION_49
    drag = damping(np.array(printed[0]), np.array(printed[1]), nu)
    lift = body.buoyancy
    righting = lift * body.hydrostatics.centre_of_buoyancy[2]
    due = body_rates(nu, angles[:, :2], push, drag, mass, np.array(INERTIA), body.hydrostatics.gravity, lift, righting)
    apart = rates[7:13].T - due
    numbers = ("1-3", "4-6", "19-21", "22-24") if wet else ("1-3", "4-6", "7-9", "10-12")
    found = (
        (numbers[0], "rate of place apart", "m/s", rates[:3].T - moving[:, :3], EXACT),
        (numbers[1], "rate of attitude apart", "1/s", rates[3:7].T - (ahead - behind) / (2.0 * step), 1e-7),
        (numbers[2], "acceleration apart", "m/s^2", apart[:, :3], EXACT),
        (numbers[3], "rate of turn apart", "rad/s^2", apart[:, 3:], 1e-7),
    )
    rows = [Row.none(f"equations {which}", what, unit, x, within) for which, what, unit, x, within in found]
    if not wet:
        neglected = 0.002 * body.weight
        rows.append(Row("equations 7-12", "buoyancy of air they leave out", "N", neglected, lift, 0.0, at_most=True))
    return PAPER.table(f"equations_{medium}", rows, states_drawn=PAPER.text("states", states=STATES, seed=SEED))


def speed_for(thrust: float) -> float:
    """Rotor speed in air of a thrust, rpm: the root of equation 45."""
    linear, square = EQUATION_45
    return float((-linear + np.sqrt(linear**2 + 4.0 * square * thrust)) / (2.0 * square))


def hovering(c: Craft) -> ComparedTable:
    """Trims of the parameter file in air against closed forms."""
    weight = c.air.weight - c.air.buoyancy
    still = trimmed(c.air, dict.fromkeys(("u", "v", "w", "yaw_rate", "roll", "pitch"), 0.0), starts=0).point.values
    rows = [
        Row("hovering", f"omega{name}", "rpm", speed_for(weight / 4.0), still[f"rotor{name}"], 1e-3)
        for name in model.ROTORS
    ]
    linear, square = EQUATION_49[0][0], EQUATION_49[1][0]
    pull = -weight * np.sin(DESCENT)
    fast = float((-linear + np.sqrt(linear**2 + 4.0 * square * pull)) / (2.0 * square))
    ahead = trimmed(
        c.air, {"v": 0.0, "w": 0.0, "yaw_rate": 0.0, "roll": 0.0, "pitch": DESCENT}, near={"u": fast}, starts=0
    ).point.values
    case = f"pitch {np.degrees(DESCENT):g} deg"
    rows.append(Row(case, "u", "m/s", fast, ahead["u"]))
    thrust = sum(EQUATION_45[0] * n + EQUATION_45[1] * n**2 for n in (ahead[f"rotor{name}"] for name in model.ROTORS))
    rows.append(Row(case, "sum of T", "N", weight * float(np.cos(DESCENT)), thrust))
    return PAPER.table("hovering", rows)


def both_readings(c: Craft) -> ComparedTable:
    """Table 1 with equation 40 corrected: what the printed rows then leave, and trims two ways."""
    fish, rows = c.fish, []
    for row, (u, w, r, roll, pitch) in enumerate(fish.motion):
        nu, attitude = np.array([[u, 0.0, w, 0.0, 0.0, r]]), from_euler(roll, pitch, 0.0)[None, :]
        idle = c.water.unbalanced(nu, attitude, np.zeros((1, 3)), np.zeros(6))[0]

        def left(x: Array, idle: Array = idle) -> Array:
            return np.asarray(idle + c.water.wrench(commands(x)))

        printed = np.concatenate([fish.angles[row], fish.speeds[row]])
        thrust = fish.rotors.thrust[0] * printed[4:] + fish.rotors.thrust[1] * printed[4:] ** 2
        lever = -2.0 * fish.constants["arm_length"] * float(thrust @ np.sin(printed[:4]))
        case = f"motion {row + 1}"
        rows.append(Row(case, "N left by the printed row", "N m", lever, float(left(printed)[5])))
        found = _nearest(fish, row, left, c.trims[row])
        for i, name in enumerate(UNKNOWNS):
            unit, factor, within = ("deg", np.degrees(1.0), 1e-3) if i < 4 else ("rpm", 1.0, 1e-2)
            due, ours = float(factor * c.trims[row, i]), float(factor * found[i])
            rows.append(Row(case, name, unit, due, ours, within, Basis.CONSISTENCY))
    return PAPER.table("both_readings", rows)


def third(fish: model.FlyingFish) -> ComparedTable:
    """Motion 3 read over the ground and in body axes: the velocity that its printed tilts and speeds keep."""
    taught = [0, 1, 8, 9]
    constants = model.calibrated(fish.rotors, fish.motion[taught], fish.angles[taught], fish.speeds[taught])
    angles, speeds = fish.angles[2:3], fish.speeds[2:3]
    pitch = float(fish.motion[2, 4])

    def left(velocity: Array) -> Array:
        motion = np.array([[velocity[0], velocity[1], 0.0, 0.0, pitch]])
        return steady_residuals(fish.rotors, constants, motion, angles, speeds)[0, [0, 2]]

    from scipy.optimize import fsolve

    u, w = fsolve(left, [0.3, 0.3], xtol=1e-13)
    over = float(u * np.cos(pitch) + w * np.sin(pitch))
    climb = float(u * np.sin(pitch) - w * np.cos(pitch))
    body = left(np.array([0.5, 0.0]))
    return PAPER.table(
        "third",
        (Row("motion 3", "speed over the ground", "m/s", 0.5, over), Row("motion 3", "climb", "m/s", 0.0, climb)),
        ahead=body[0],
        down=body[1],
    )


def steady(c: Craft, row: int) -> Trajectory:
    """One motion of Table 1 from its corrected trim, integrated."""
    u, w, r, roll, pitch = c.fish.motion[row]
    phase = Phase("steady", {}, PATHS.get(row + 1, STRAIGHT))
    start = np.array([u, 0.0, w, 0.0, 0.0, r])
    manoeuvre = Manoeuvre(f"motion {row + 1}", (phase,), start, from_euler(roll, pitch, 0.0), c.orders(row))
    return SIMULATORS.load("rigid_body").simulate(c.water, manoeuvre, {"record": 0.5})


def tracks(c: Craft) -> ComparedTable:
    """Figs. 9 and 10: integrated motions against the lines, the circle and the helix of constant velocities."""
    rows = []
    for row in range(len(c.fish.motion)):
        found = steady(c, row)
        due = helix(found.velocity[0, :3], found.attitude[0], float(c.fish.motion[row, 2]), np.asarray(found.time))
        apart = float(np.max(np.linalg.norm(found.position - due, axis=1)))
        rows.append(
            Row.none(f"motion {row + 1}", f"off its path within {found.time[-1]:g} s", "m", apart)
        )  # fmt: skip
    u, w, r = c.fish.motion[9, :3]
    return PAPER.table("tracks", rows, circle=0.5 / np.radians(5.0), helix=u / r, sunk=w * 18.0)


def hop(c: Craft) -> Trajectory:
    """From rest but for a turn about the vertical, under water with rotors turned up, out, up to where it stands, down and to the surface again."""
    wet = {f"rotor{n}": UNDER for n in model.ROTORS} | {f"rotor{n}.tilt": float(np.pi) for n in model.ROTORS}
    dry = {f"rotor{n}": ABOVE for n in model.ROTORS}
    phases = (
        Phase("water", wet, 4.0, Until("depth", False, -DEPTH)),
        Phase("air", dry, 2.0, Until("depth", True, -DEPTH), 1),
    )
    manoeuvre = Manoeuvre("hop", phases, TURNING * np.eye(6)[5], orders=wet, others=(c.air,), surface=-DEPTH)
    mover = SIMULATORS.load("rigid_body")
    return through_media(
        c.water, manoeuvre, lambda body, one: mover.simulate(body, one, {"record": 0.01, "tolerance": 1e-11})
    )


def surface(c: Craft) -> ComparedTable:
    """The hop against closed forms, which know nothing of steps."""
    found = hop(c)
    mass = c.fish.constants["mass"]
    thrust = 4.0 * float(c.fish.rotors.thrust[0] * UNDER + c.fish.rotors.thrust[1] * UNDER**2)
    lift = 4.0 * (EQUATION_45[0] * ABOVE + EQUATION_45[1] * ABOVE**2)

    (wet_a, wet_b), (dry_a, dry_b) = ([law[2] for law in pair] for pair in (EQUATION_50, EQUATION_49))
    heavy = c.air.weight - c.air.buoyancy - lift
    time, speed = dash(thrust - c.fish.constants["net_weight"], wet_a, wet_b, mass, DEPTH)
    up, height = rise(heavy, dry_a, dry_b, mass, speed)
    down, back = dash(heavy, dry_a, dry_b, mass, height)
    yaw_wet, yaw_dry = ([law[5] for law in pair] for pair in (EQUATION_50, EQUATION_49))
    inertia = float(c.water.inertia[2, 2])
    left, rate = turned(TURNING, yaw_wet[0], yaw_wet[1], inertia, time)
    came = left + turned(rate, yaw_dry[0], yaw_dry[1], inertia, up + down)[0]
    out, again = found.reached
    velocity = -np.asarray(found.velocity)[:, 2]
    heading = 2.0 * np.arctan2(np.asarray(found.attitude)[:, 3], np.asarray(found.attitude)[:, 0])

    def at(when: float | None, values: Array = velocity) -> float | None:
        return None if when is None else float(values[np.argmin(np.abs(np.asarray(found.time) - when))])

    rows = (
        Row("out of the water", "time", "s", time, out),
        Row("out of the water", "speed up", "m/s", speed, at(out)),
        Row("out of the water", "heading", "rad", left, at(out, heading)),
        Row("back at the surface", "time after that", "s", up + down, None if out is None or again is None else again - out),
        Row("back at the surface", "speed up", "m/s", -back, at(again)),
        Row("back at the surface", "heading", "rad", came, at(again, heading)),
    )  # fmt: skip
    return PAPER.table("surface", rows, depth=DEPTH, turning=TURNING, under=UNDER, above=ABOVE, height=height)


def benches(fish: model.FlyingFish) -> Mapping[model.Medium, BenchTest]:
    """The synthetic bench tests, identified."""
    folder = Path(str(shipped("cfd_data"))) / BENCH
    return {m: bench_test([folder / f"{m}.csv"], flyingfish_file(fish, m), "rotor1") for m in model.MEDIA}


def bench(fish: model.FlyingFish) -> ComparedTable:
    """Curves identified from synthetic bench tests against the printed ones."""
    printed = {"water": (tuple(fish.rotors.thrust), EQUATION_48), "air": (EQUATION_45, EQUATION_46)}
    rows = [
        Row(f"{medium}, {at:g} rpm", law.load, law.unit, a * at + b * at**2, float(law.value @ [at, at**2]))
        for medium, found in benches(fish).items()
        for at in (BENCH_AT[medium],)
        for law, (a, b) in zip(found.laws, printed[medium], strict=True)
    ]  # fmt: skip
    return PAPER.table("bench", rows)
