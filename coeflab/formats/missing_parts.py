"""What a simulator loses of a parameter file beside terms of its force law, each with its kind."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from coeflab.law.symbols import derivative, primed
from coeflab.vehicle.force_law import sources_of
from coeflab.vehicle.inertia import COMPUTED, WaterInertia, stated_accelerations, water_inertia
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.parameter_model import ParameterModel

SAME = 1e-6  # a computed and a stated entry, with the digits that files print
ROLL = "it is used instead; write the vehicle's"
WAYS = ("surge", "sway", "heave", "roll", "pitch", "yaw")


class Kind(StrEnum):
    """Why something is lost."""

    NOT_HELD = "not held"
    MISSING = "missing"
    REPLACED = "replaced"
    MISMATCH = "mismatch"
    LEFT_OUT = "left out"


@dataclass(frozen=True, slots=True)
class LossItem:
    """One loss.

    Attributes
    ----------
    kind : Kind
        Not held: the target has no place for it. Missing: the target needs it and the parameter file has none. Replaced: another
        value of the same file stands in its place. Mismatch: two parts of the file are those of two bodies. Left out: the target
        would drive a motion with it that the file damps, or damp one that it drives.
    what : str
    """

    kind: Kind
    what: str

    def __str__(self) -> str:
        return f"{self.kind}: {self.what}"


def common_losses(parameters: ParameterFile, holds: frozenset[str], water: WaterInertia) -> tuple[LossItem, ...]:
    """What every simulator loses: fitted tables, parts of the vehicle that are not among those it ``holds``, accelerations
    that are not in the added mass it is given, and an added mass of another body.
    """
    tables = () if "tables" in holds else tuple(_table(s.model) for s in sources_of(parameters).tables)
    unheld = tuple(LossItem(Kind.NOT_HELD, words) for words in (*tables, *_vehicle(parameters, holds)))
    hull = parameters.added_mass
    out = [*unheld, *(LossItem(Kind.REPLACED, words) for words in _accelerations(parameters, water))]
    if hull is not None and hull.body != parameters.body:
        out.append(
            LossItem(
                Kind.MISMATCH,
                f"the added mass is that of {hull.body}, the coefficients are those of {parameters.body}: the potential parts, and "
                "the viscous remainders, belong to another shape",
            )
        )
    return tuple(out)


def _vehicle(parameters: ParameterFile, holds: frozenset[str]) -> list[str]:
    """Hydrostatics, thrusters and limits of control surfaces that a target is not given."""
    out = []
    h = parameters.hydrostatics
    if h is not None and "hydrostatics" not in holds:
        x, y, z = (f"{v:g}" for v in h.centre_of_buoyancy)
        out.append(
            f"hydrostatics: {h.volume:g} m^3 at ({x}, {y}, {z}) m; the righting moment, and the difference of weight and buoyancy, "
            "are left to the simulator"
        )
    if parameters.thrusters and "thrusters" not in holds:
        names = ", ".join(t.name for t in parameters.thrusters)
        alone = len(parameters.thrusters) == 1
        out.append(
            f"thruster {names}: add its force yourself" if alone else f"thrusters {names}: add their forces yourself"
        )
    elif "lags" not in holds and (late := [t.name for t in parameters.thrusters if t.lag is not None]):
        out.append(f"lag of {', '.join(late)}: commands are taken at once")
    if parameters.surfaces and "surfaces" not in holds:
        out.append(
            f"limits and rates of {', '.join(s.control for s in parameters.surfaces)}: angles are taken as given"
        )
    elif "rates" not in holds and (turning := [s.control for s in parameters.surfaces if s.rate is not None]):
        out.append(f"rates of {', '.join(turning)}: angles are taken at once")
    return out


def _table(model: ParameterModel) -> str:
    over = f"{model.response} over {', '.join(model.names)} ({model.form})"
    return f"{over}: no force stands in its place; the targets csv and toml contain the table"


def _accelerations(parameters: ParameterFile, water: WaterInertia) -> list[str]:
    """Acceleration derivatives that are not in the added mass, not even in a mean with their mirror image."""
    stated, hull = stated_accelerations(parameters), parameters.added_mass
    values = {derivative(c.symbol).text: c for c in parameters.coefficients}
    out = []
    for (i, j), (name, entry) in stated.items():
        mirror = stated.get((j, i), (name, entry))[1]
        if not entry or min(abs(water.matrix[i, j] - x) for x in (entry, (entry + mirror) / 2.0)) <= SAME * abs(entry):
            continue
        given = values[name]
        share = float(water.matrix[i, j] / entry)
        place = (
            f"the added mass of {hull.body} by {hull.method} has {share * (given.value or 0.0):.4g}, {share:.3g} times it"
            if hull is not None and water.used == COMPUTED
            else "zero is written instead"
        )
        out.append(f"{primed(name)} {given.value:.4g} ({given.origin}) is not used: {place}")
    return out


def missing_mass(parameters: ParameterFile, otherwise: str, roll: str = ROLL) -> tuple[str, ...]:
    """Mass and moments of inertia that a target of six degrees of freedom needs and the file does not have.

    Parameters
    ----------
    parameters : ParameterFile
    otherwise : str
        What the target does without them.
    roll : str
        What it does where the file has the transverse moment alone.
    """
    mass = parameters.mass
    if mass is None:
        return (f"mass and moments of inertia: the file has none; {otherwise}",)
    if mass.inertia is None and mass.inertia_matrix is None:
        return (f"moments of inertia: the file has none; {otherwise}",)
    if mass.inertia_matrix is None:
        return (f"roll inertia: the file has the transverse one alone; {roll}",)
    return ()


def missing_water(parameters: ParameterFile) -> tuple[str, ...]:
    """Added mass that a target carries and the file does not have."""
    diagonal = np.diag(water_inertia(parameters).matrix)
    if not np.any(diagonal):
        return ("added mass: the file has none; the vehicle accelerates as if in air",)
    unknown = [way for way, m in zip(WAYS, diagonal, strict=True) if m == 0.0]
    if parameters.added_mass is None and unknown:
        return (f"added mass in {', '.join(unknown)}: not in the file; zero is written",)
    return ()
