"""TJ-FlyingFish: ten operating points of a vehicle with four tilting rotors, its motion in both media and through the surface."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from coeflab.core.files import shipped
from coeflab.core.machine import one_thread
from coeflab.core.types import Array
from coeflab.fits import FITS
from coeflab.law.symbols import COMPONENTS, MOTIONS
from coeflab.motion.dynamics import from_euler
from coeflab.motion.ensemble import idle, integrated_forces
from coeflab.motion.trim.operating_point import OperatingPoint
from coeflab.motion.vehicle import Vehicle, vehicle
from coeflab.published.flyingfish.figures import figures
from coeflab.published.flyingfish.model import CONSTANTS, MEDIA, ROTORS, FlyingFish, calibrated, read_flyingfish
from coeflab.published.flyingfish.motions import EQUATION_48, EQUATION_50, compared, craft
from coeflab.published.flyingfish.rotors import steady_residuals
from coeflab.published.flyingfish.trims import DEGREE, RPM, UNKNOWNS, trim
from coeflab.published.parameter_files import flyingfish_file
from coeflab.published.publication import Row, publication
from coeflab.report.acceptance import Acceptance, ComparedTable
from coeflab.tables.importers import PlannedTable
from coeflab.tables.reading import read_tables
from coeflab.vehicle.parameter_file import ParameterFile

PAPER = publication("flyingfish")

FORCES, MOMENTS = 5e-4, 1.5e-4
TAUGHT, PREDICTED = (0, 1, 8, 9), (2, 3, 4, 5, 6, 7)
LEVEL, ISOLATED = (0, 3, 4), (1, 6, 9)
CORRECTED = (79.869, -75.109, 0.051, 0.146, 2075.18, 2082.07, 624.00, 250.51)
DERIVED = {"net_weight": 5e-5, "mass": 5e-5, "buoyancy_moment": 5e-5, "arm_length": 5e-6, "rotor_height": 5e-6}
UNITS = {"net_weight": "N", "mass": "kg", "buoyancy_moment": "N m", "arm_length": "m", "rotor_height": "m"}
EQUATION_47 = (6.0e-4, 2.5604e-7)
RPMS, SAME, ROUNDED = (200.0, 2000.0), 1e-9, 5e-5
TURNING, SEED = 100, 20260101


@one_thread()
def acceptance() -> Acceptance:
    """Everything that the paper's Table 1 lets us judge."""
    fish = read_flyingfish()
    constants = calibrated(fish.rotors, fish.motion, fish.angles, fish.speeds)
    nearest = _nearest(fish, constants)
    result = craft(fish)
    limits = PAPER.text("limits", water=fish.largest_speed, air=fish.largest_speed_air)
    return PAPER.acceptance(
        (
            *implied(fish, constants),
            nearest,
            _families(fish, constants),
            _cold(fish, constants),
            _corrected(fish, constants),
            *carried(fish, flyingfish_file(fish)),
            air(fish),
            *compared(result),
        ),
        (PAPER.text("in_sample"), PAPER.text("sign"), limits, PAPER.text("no_pictures")),
        errata=fish.errata,
        figures=figures(result, nearest),
        parameter_files=tuple(flyingfish_file(fish, medium) for medium in MEDIA),
    )


def implied(fish: FlyingFish, constants: Array) -> tuple[ComparedTable, ...]:
    """What Table 1 implies, what the equations leave at its points, and what four of them predict of the others."""
    return _constants(fish, constants), _residuals(fish, constants), _predicted(fish)


def carried(fish: FlyingFish, file: ParameterFile) -> tuple[ComparedTable, ...]:
    """The parameter file: its laws against the printed ones, and the rates that integrators march against equations 35-56."""
    moved = vehicle(file)
    return _laws(moved), _marched(fish, moved)


def _laws(moved: Vehicle) -> ComparedTable:
    nu = np.concatenate([np.eye(6), 2.0 * np.eye(6)])
    force = moved.force(nu, np.zeros((12, 3)))
    rows = [
        Row(f"{many * nu[row, k]:g} {unit}", f"{component} of {motion}", "N" if k < 3 else "N m", -(linear + quadratic * size) * size, float(force[row, k]), relative=True)
        for row, size in enumerate(np.repeat((1.0, 2.0), 6))
        for k, (component, motion, linear, quadratic) in enumerate(zip(COMPONENTS, MOTIONS, *EQUATION_50, strict=True))
        for many, unit in ((1.0, "m/s" if k < 3 else "rad/s"),)
        if nu[row, k]
    ]  # fmt: skip
    for rotor in moved.thrusters:
        for speed in RPMS:
            torque = 0.0 if rotor.torque_curve is None else rotor.torque_curve.at(speed)
            thrust = float(rotor.curve.at(speed))
            found = (
                ("thrust", "N", EQUATION_47, thrust, ROUNDED * speed),
                ("torque", "N m", EQUATION_48, torque, SAME),
            )
            rows += [
                Row(f"{rotor.name}, {speed:g} rpm", name, unit, linear * speed + quadratic * speed**2, float(value), within)
                for name, unit, (linear, quadratic), value, within in found
            ]  # fmt: skip
    return PAPER.table("laws", rows)


def _marched(fish: FlyingFish, moved: Vehicle) -> ComparedTable:
    """Both planes of every motion of Table 1, upright to 45 deg: weight, buoyancy, rotors, damping and inertia at once."""
    n, motion = len(fish.motion), fish.motion
    nu, attitude = np.zeros((n, 6)), np.array([from_euler(roll, pitch, 0.0) for roll, pitch in motion[:, 3:]])
    nu[:, (0, 2, 5)] = motion[:, :3]
    orders = [
        {f"rotor{name}": float(speed[i]) for i, name in enumerate(ROTORS)}
        | {f"rotor{name}.tilt": float(tilt[i]) for i, name in enumerate(ROTORS)}
        for tilt, speed in zip(fish.angles, fish.speeds, strict=True)
    ]
    constants = np.array([fish.constants[name] for name in CONSTANTS])
    wanted = steady_residuals(fish.rotors, constants, motion, fish.angles, fish.speeds, lever=-1.0)
    found = integrated_forces(moved, nu, attitude, np.array([moved.wrench(o) for o in orders]))
    apart = np.max(np.abs(found - wanted), axis=0)
    rows = [
        Row.none(f"motion {row + 1}", what, unit, apart[row, part])
        for row in range(n)
        for what, unit, part in (("force apart", "N", slice(0, 3)), ("moment apart", "N m", slice(3, 6)))
    ]
    turning = np.random.default_rng(SEED).normal(size=(TURNING, 6))
    level, none = np.tile((1.0, 0.0, 0.0, 0.0), (TURNING, 1)), np.zeros((TURNING, 6))
    power = np.sum(integrated_forces(idle(moved), turning, level, none) * turning, axis=-1)
    rows.append(Row.none(f"{TURNING} random motions", "power of the inertia", "W", power))
    return PAPER.table("marched", rows)


def air(fish: FlyingFish) -> ComparedTable:
    """The printed damping in air against a fit to the table that was made of it."""
    tables = read_tables(PlannedTable(Path(str(shipped("cfd_data") / "flyingfish_air_synthetic")), ()))
    rows = []
    for model in FITS.load("linear_quadratic_damping").fit(tables, tables[0].scaling, {}).models:
        k = COMPONENTS.index(model.response)
        size, unit, of = (10.0, "m/s", "N") if k < 3 else (6.0, "rad/s", "N m")
        motion = MOTIONS[k]
        found = model.named(model.response + motion)[0] * size
        found += model.named(f"{model.response}{motion}|{motion}|")[0] * size**2
        stated = -(fish.air[0, k] + fish.air[1, k] * size) * size
        rows.append(Row(f"{size:g} {unit}", f"{model.response} of {motion}", of, stated, found))
    return PAPER.table("air", rows)


def _constants(fish: FlyingFish, constants: Array) -> ComparedTable:
    rows = tuple(
        Row("calibrated", name.replace("_", " "), UNITS[name], fish.constants[name], float(c), DERIVED[name])
        for name, c in zip(CONSTANTS, constants, strict=True)
    )
    return PAPER.table("constants", rows)


def _residuals(fish: FlyingFish, constants: Array) -> ComparedTable:
    left = steady_residuals(fish.rotors, constants, fish.motion, fish.angles, fish.speeds)
    rows = tuple(
        Row(f"motion {row + 1}", name, "N" if k < 3 else "N m", 0.0, float(left[row, k]), FORCES if k < 3 else MOMENTS)
        for row in range(len(left))
        for k, name in enumerate("XYZKMN")
    )
    return PAPER.table("residuals", rows)


HALF_A_DIGIT = np.concatenate(
    [np.full(4, np.radians(0.005)), np.full(4, 0.005)]
)  # of the printed tilts and rotor speeds


def _left_by_the_taught(fish: FlyingFish, angles: Array, speeds: Array) -> Array:
    """(10, 6) what the equations leave, with constants of the four taught motions alone."""
    chosen = list(TAUGHT)
    taught = calibrated(fish.rotors, fish.motion[chosen], angles[chosen], speeds[chosen])
    return steady_residuals(fish.rotors, taught, fish.motion, angles, speeds)


def rounding(fish: FlyingFish) -> Array:
    """(10, 6) the most that rounding of the printed tilts and speeds can leave, N and N m: the sum over all 80 entries."""
    exact = _left_by_the_taught(fish, fish.angles, fish.speeds)
    most = np.zeros_like(exact)
    for row in range(len(exact)):
        for k, half in enumerate(HALF_A_DIGIT):
            moved = np.concatenate([fish.angles, fish.speeds], axis=1)
            moved[row, k] += half
            most += np.abs(_left_by_the_taught(fish, moved[:, :4], moved[:, 4:]) - exact)
    return most


def _predicted(fish: FlyingFish) -> ComparedTable:
    left, most = _left_by_the_taught(fish, fish.angles, fish.speeds), rounding(fish)
    rows = tuple(
        Row(f"motion {row + 1}", name, "N" if k < 3 else "N m", 0.0, float(left[row, k]), float(most[row, k]))
        for row in PREDICTED
        for k, name in enumerate("XYZKMN")
    )  # fmt: skip
    return PAPER.table("predicted", rows)


def _rows(case: str, published: Array, found: Array | None, angle: float, speed: float, which: range) -> list[Row]:
    ours = [None] * len(published) if found is None else found.tolist()
    units = [("deg", angle)] * 4 + [("rpm", speed)] * 4
    return [Row(case, UNKNOWNS[i], units[i][0], float(published[i]), ours[i], units[i][1]) for i in which]


def _printed(fish: FlyingFish, row: int) -> Array:
    return np.concatenate([np.degrees(fish.angles[row]), fish.speeds[row]])


def _nearest(fish: FlyingFish, constants: Array) -> ComparedTable:
    rows: list[Row] = []
    for row in range(len(fish.motion)):
        found = trim(fish, constants, row, near=True, starts=0)
        rows += _rows(f"motion {row + 1}", _printed(fish, row), _point(found), 0.01, 0.1, range(8))
    return PAPER.table("nearest", rows, degree=DEGREE, rpm=RPM)


def _families(fish: FlyingFish, constants: Array) -> ComparedTable:
    """With beta3 and beta4 as printed there are six unknowns; where both are zero, equation 52 says nothing."""
    rows = [
        Row(
            f"motion {row + 1}",
            "parameters of the family",
            "1",
            published,
            float(trim(fish, constants, row, near=True, given=(2, 3), starts=0).dimension),
        )
        for cases, published in ((LEVEL, 1.0), (ISOLATED, 0.0))
        for row in cases
    ]
    return PAPER.table("families", rows)


def _cold(fish: FlyingFish, constants: Array) -> ComparedTable:
    rows: list[Row] = []
    words = []
    for row in ISOLATED:
        found = trim(fish, constants, row, given=(2, 3), starts=12)
        published = _printed(fish, row)
        case = f"motion {row + 1}"
        rows += _rows(case, published, _point(found), 0.005, 0.075, range(2))
        rows += _rows(case, published, _point(found), 0.005, 0.075, range(4, 8))
        words.append(f"{case}: {found.words()[0]}")
    return PAPER.table("cold", rows, words=words)


def _corrected(fish: FlyingFish, constants: Array) -> ComparedTable:
    found = trim(fish, constants, 0, near=True, starts=0, lever=-1.0)
    rows = _rows("corrected motion 1", np.array(CORRECTED), _point(found), 0.0015, 0.01, range(8))
    return PAPER.table("corrected", rows, degree=DEGREE, rpm=RPM)


def _point(found: OperatingPoint) -> Array | None:
    """In deg and rpm; None where nothing was found."""
    return np.concatenate([np.degrees(found.found.point[:4]), found.found.point[4:]]) if found.outcome.solved else None
