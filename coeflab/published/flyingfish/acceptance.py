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
from coeflab.motion.marching import idle, integrated_forces
from coeflab.motion.trim.operating_point import OperatingPoint
from coeflab.motion.vehicle import Vehicle, vehicle
from coeflab.published.flyingfish.figures import figures
from coeflab.published.flyingfish.model import (
    CONSTANTS,
    DEGREE,
    MEDIA,
    ROTORS,
    RPM,
    UNKNOWNS,
    FlyingFish,
    calibrated,
    read_flyingfish,
    steady_residuals,
    trim,
)
from coeflab.published.flyingfish.motions import compared, craft
from coeflab.published.parameter_files import flyingfish_file
from coeflab.report.acceptance import Acceptance, Basis, Compared, ComparedTable
from coeflab.tables.importers import PlannedTable
from coeflab.tables.reading import read_tables
from coeflab.vehicle.parameter_file import ParameterFile

FORCES, MOMENTS = 5e-4, 1.5e-4
TAUGHT, TOLD = (0, 1, 8, 9), (2, 3, 4, 5, 6, 7)
LEVEL, ISOLATED = (0, 3, 4), (1, 6, 9)
CORRECTED = (79.869, -75.109, 0.051, 0.146, 2075.18, 2082.07, 624.00, 250.51)
DERIVED = {"net_weight": 5e-5, "mass": 5e-5, "buoyancy_moment": 5e-5, "arm_length": 5e-6, "rotor_height": 5e-6}
UNITS = {"net_weight": "N", "mass": "kg", "buoyancy_moment": "N m", "arm_length": "m", "rotor_height": "m"}
EQUATION_47, EQUATION_48 = (6.0e-4, 2.5604e-7), (1.81713e-7, 5.1233e-9)
EQUATION_50 = ((0.0998, 0.1658, 0.0064, 0.0032, 0.0008, 0.0029), (18.2222, 15.8047, 24.7142, 0.0489, 0.1554, 0.1872))
RPMS, SAME, ROUNDED, AIR = (200.0, 2000.0), 1e-9, 5e-5, 0.005
MARCHED, FINEST, TURNING, SEED = 1e-9, 1e-10, 100, 20260101  # no finer, so that every machine says the same
CONVENTIONS = (
    "Reference point: the centre of gravity. Rotors 1 and 2 stand on arms to starboard and port, 3 and 4 ahead and astern.",
    "Tilts beta turn a rotor about its own arm, right-handed about the arm outward: at none the thrust points down, along z. The "
    "paper calls them beta; they are no sideslip.",
    "Rotor speeds are in rpm; thrust and torque follow their sign-free curves. The force of the water is -(linear + quadratic |u|) u "
    "along each axis; v = p = q = 0 in every motion.",
    "Attitude: roll phi and pitch theta of the equations of steady motion 51-56, in which weight less buoyancy and the righting "
    "moment stand on the other side.",
)
NO_PICTURES = (
    "Figures of the paper: 3 is drawn as tilt, 5 as bench tests, 8 as damping, 9 as straight motions, 10 as circle and helix. Not made: "
    "1 (structure), 2 (tilting mechanism) and 4 (bench) show hardware whose shape the text does not print; 6 and 7 (domain and mesh of "
    "the computation) print no size, grid or setting. Points of 5 and 8 are not printed: ours are synthetic."
)
IN_SAMPLE = (
    "The paper prints neither mass, buoyancy, arm length nor rotor height. They are calibrated: least squares of the "
    "equations over these very rows, so what follows is in-sample."
)


@one_thread()
def acceptance() -> Acceptance:
    """Everything that the paper's Table 1 lets us judge."""
    fish = read_flyingfish()
    constants = calibrated(fish.rotors, fish.motion, fish.angles, fish.speeds)
    nearest = _nearest(fish, constants)
    result = craft(fish)
    return Acceptance(
        "flyingfish",
        "TJ-FlyingFish, four tilting rotors: ten operating points under water, and air",
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
        fish.errata,
        (
            IN_SAMPLE,
            "Equation 40 with its printed sign, which Table 1 was made with, but for the last table.",
            f"Rotor speeds from 0 to {fish.largest_speed:g} rpm, in air to {fish.largest_speed_air:g} rpm: chosen, the paper prints no limit.",
            NO_PICTURES,
        ),
        ("tj_flyingfish",),
        figures(result, nearest),
        CONVENTIONS,
        tuple(flyingfish_file(fish, medium) for medium in MEDIA),
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
        Compared(f"{many * nu[row, k]:g} {unit}", f"{component} of {motion}", "N" if k < 3 else "N m",
                 -(linear + quadratic * size) * size, float(force[row, k]), SAME, Basis.CONSISTENCY, True)
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
                Compared(f"{rotor.name}, {speed:g} rpm", name, unit, linear * speed + quadratic * speed**2, float(value), within,
                         Basis.CONSISTENCY)
                for name, unit, (linear, quadratic), value, within in found
            ]  # fmt: skip
    return ComparedTable(
        "laws", "Damping and rotors of the parameter file", tuple(rows), "Equations 47, 48 and 50",
        ("The printed numbers typed a second time: they prove the way into the file, not the model.",
         "Thrust: half of the one digit that equation 47 prints of its linear factor, 0.0006, is allowed."),
    )  # fmt: skip


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
        Compared(
            f"motion {row + 1}",
            what,
            unit,
            0.0,
            max(float(np.max(apart[row, part])), FINEST),
            MARCHED,
            Basis.CONSISTENCY,
        )
        for row in range(n)
        for what, unit, part in (("force apart", "N", slice(0, 3)), ("moment apart", "N m", slice(3, 6)))
    ]
    turning = np.random.default_rng(SEED).normal(size=(TURNING, 6))
    level, none = np.tile((1.0, 0.0, 0.0, 0.0), (TURNING, 1)), np.zeros((TURNING, 6))
    power = np.sum(integrated_forces(idle(moved), turning, level, none) * turning, axis=-1)
    largest = max(float(np.max(np.abs(power))), FINEST)
    rows.append(
        Compared(f"{TURNING} random motions", "power of the inertia", "W", 0.0, largest, MARCHED, Basis.CONSISTENCY)
    )
    return ComparedTable(
        "marched", "The rates that are integrated, from the parameter file", tuple(rows), "Table 1, equations 35-40 and 51-56",
        ("Equation 40 with its corrected sign. Accelerations of the parameter file times its inertia, by both ways that a motion "
         "is computed, less what the equations leave.",),
    )  # fmt: skip


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
        rows.append(
            Compared(
                f"{size:g} {unit}", f"{model.response} of {motion}", of, stated, found, AIR, Basis.CONSISTENCY, True
            )
        )
    return ComparedTable(
        "air", "Damping in air, from a fit to the synthetic table", tuple(rows), "Equation 49",
        ("The table was made of the printed numbers and 0.2 % of noise: the fit gives back what went in.",),
    )  # fmt: skip


def _constants(fish: FlyingFish, constants: Array) -> ComparedTable:
    rows = tuple(
        Compared(
            "calibrated",
            name.replace("_", " "),
            UNITS[name],
            fish.constants[name],
            float(c),
            DERIVED[name],
            Basis.CONSISTENCY,
        )
        for name, c in zip(CONSTANTS, constants, strict=True)
    )
    return ComparedTable(
        "constants", "Constants that Table 1 implies", rows, "Table 1, equations 35-40 and 51-56", (IN_SAMPLE,)
    )


def _left(fish: FlyingFish, constants: Array) -> Array:
    return steady_residuals(fish.rotors, constants, fish.motion, fish.angles, fish.speeds)


def _residuals(fish: FlyingFish, constants: Array) -> ComparedTable:
    left = _left(fish, constants)
    rows = tuple(
        Compared(
            f"motion {row + 1}",
            name,
            "N" if k < 3 else "N m",
            0.0,
            float(left[row, k]),
            FORCES if k < 3 else MOMENTS,
            Basis.CALIBRATION,
        )
        for row in range(len(left))
        for k, name in enumerate("XYZKMN")
    )
    return ComparedTable(
        "residuals", "What the equations leave at the printed operating points", rows, "Table 1", (IN_SAMPLE,)
    )


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
        Compared(
            f"motion {row + 1}", name, "N" if k < 3 else "N m", 0.0, float(left[row, k]), float(most[row, k]), Basis.VERIFICATION,
        )
        for row in TOLD
        for k, name in enumerate("XYZKMN")
    )  # fmt: skip
    return ComparedTable(
        "predicted", "Motions 3 to 8 from constants of motions 1, 2, 9 and 10 alone", rows, "Table 1",
        (
            "Out of sample: constants fitted on motions 1, 2, 9 and 10.",
            "Tolerance: what half a digit of every printed tilt and rotor speed can leave, those of the four motions among them.",
        ),
    )  # fmt: skip


def _rows(case: str, published: Array, found: Array | None, angle: float, speed: float, which: range) -> list[Compared]:
    return [
        Compared(
            case,
            UNKNOWNS[i],
            "deg" if i < 4 else "rpm",
            float(published[i]),
            None if found is None else float(found[i]),
            angle if i < 4 else speed,
            Basis.CONSISTENCY if case.startswith("corrected") else Basis.CALIBRATION,
        )
        for i in which
    ]


def _printed(fish: FlyingFish, row: int) -> Array:
    return np.concatenate([np.degrees(fish.angles[row]), fish.speeds[row]])


def _nearest(fish: FlyingFish, constants: Array) -> ComparedTable:
    rows: list[Compared] = []
    for row in range(len(fish.motion)):
        found = trim(fish, constants, row, near=True, starts=0)
        rows += _rows(f"motion {row + 1}", _printed(fish, row), _point(found), 0.01, 0.1, range(8))
    return ComparedTable(
        "nearest", "The trim nearest to each printed operating point", tuple(rows), "Table 1",
        (
            f"8 unknowns, 6 equations: a family of two parameters; the rule is nearest in scales of {DEGREE:g} deg and "
            f"{RPM:g} rpm. The table is printed to 0.01 deg and 0.01 rpm.",
            IN_SAMPLE,
        ),
    )  # fmt: skip


def _families(fish: FlyingFish, constants: Array) -> ComparedTable:
    """With beta3 and beta4 as printed there are six unknowns; where both are zero, equation 52 says nothing."""
    rows = [
        Compared(
            f"motion {row + 1}",
            "parameters of the family",
            "1",
            published,
            float(trim(fish, constants, row, near=True, given=(2, 3), starts=0).dimension),
            0.0,
            Basis.CONSISTENCY,
        )
        for cases, published in ((LEVEL, 1.0), (ISOLATED, 0.0))
        for row in cases
    ]
    return ComparedTable(
        "families", "Solutions with beta3 and beta4 as printed", tuple(rows), "Table 1",
        ("Motions 1, 4 and 5 have beta3 = beta4 = 0: side force is zero whatever the rotors do, five equations remain.",),
    )  # fmt: skip


def _cold(fish: FlyingFish, constants: Array) -> ComparedTable:
    rows: list[Compared] = []
    words = []
    for row in ISOLATED:
        found = trim(fish, constants, row, given=(2, 3), starts=12)
        published = _printed(fish, row)
        case = f"motion {row + 1}"
        rows += _rows(case, published, _point(found), 0.005, 0.075, range(2))
        rows += _rows(case, published, _point(found), 0.005, 0.075, range(4, 8))
        words.append(f"{case}: {found.words()[0]}")
    return ComparedTable(
        "cold", "Cold starts with beta3 and beta4 as printed", tuple(rows), "Table 1",
        (*words, "The tolerance on rotor speed is 0.07 rpm to its last printed digit."), "nearest",
    )  # fmt: skip


def _corrected(fish: FlyingFish, constants: Array) -> ComparedTable:
    found = trim(fish, constants, 0, near=True, starts=0, lever=-1.0)
    rows = _rows("corrected motion 1", np.array(CORRECTED), _point(found), 0.0015, 0.01, range(8))
    return ComparedTable(
        "corrected", "Motion 1 with the sign of equation 40 corrected, nearest to the printed one", tuple(rows),
        "worked out independently; the paper has no such row",
        (f"Nearest in scales of {DEGREE:g} deg and {RPM:g} rpm; the figures beside it do not say in which.",),
    )  # fmt: skip


def _point(found: OperatingPoint) -> Array | None:
    """In deg and rpm; None where nothing was found."""
    return np.concatenate([np.degrees(found.found.point[:4]), found.found.point[4:]]) if found.outcome.solved else None
