"""Published vehicles as parameter files: the TJ-FlyingFish in water and in air, and THAUV gliders as far as the format holds them."""

from __future__ import annotations

from functools import partial
from pathlib import Path

import numpy as np

from coeflab.core.axes import Datum
from coeflab.core.files import shipped
from coeflab.core.provenance import InputFile, sha256_of
from coeflab.core.units import STANDARD_GRAVITY
from coeflab.formats.stated_file import Law, Stated, stated_file
from coeflab.formats.stated_table import stated_table
from coeflab.glider.glider import Glider
from coeflab.law.rigid_body import MassProperties
from coeflab.law.scaling import Conditions, Scaling
from coeflab.law.symbols import COMPONENTS, MOTIONS
from coeflab.published.flyingfish.model import FlyingFish, Medium, thrusters
from coeflab.published.publication import publication
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.parameter_parts import ParameterHydrostatics

UNIT = Scaling(1.0, "unit length (the paper prints none)")
WATER, SEA = Conditions(1000.0, 1.5), Conditions(1025.0, 0.3)
AIR = Conditions(1.2, 10.0)
FLYINGFISH_INERTIA = 0.02  # kg m^2, the mass at a tenth of a metre
FLYINGFISH_AT: dict[Medium, Conditions] = {"water": WATER, "air": AIR}
THAUV_MASS, THAUV_ANGLE, THAUV_RATE = 66.35, float(np.radians(15.0)), 0.1


def flyingfish_file(fish: FlyingFish, medium: Medium = "water") -> ParameterFile:
    """Damping, weight, buoyancy and rotors of the TJ-FlyingFish under water or in air, about its centre of gravity.

    Parameters
    ----------
    fish : FlyingFish
        Its calibrated constants are those of the shipped file.
    medium : {"water", "air"}
    """
    at = FLYINGFISH_AT[medium]
    printed = (fish.rotors.linear, fish.rotors.quadratic) if medium == "water" else fish.air
    damping: dict[str, tuple[float, Law]] = {}
    for c, m, linear, quadratic in zip(COMPONENTS, MOTIONS, *printed, strict=True):
        laws: tuple[tuple[str, float, Law], ...] = ((f"{c}{m}", linear, "rest"), (f"{c}{m}|{m}|", quadratic, "motion"))
        for symbol, value, law in laws:
            if value:
                damping[symbol] = -float(value) / UNIT.unit(symbol, at.density, at.speed), law
    mass, buoyancy = fish.constants["mass"], fish.constants["mass"] * STANDARD_GRAVITY - fish.constants["net_weight"]
    volume = buoyancy / (WATER.density * STANDARD_GRAVITY)
    stated = Stated(
        f"flyingfish_{medium}", f"TJ-FlyingFish in {medium}", UNIT, at, damping, datum=Datum("cg"),
        mass=MassProperties(mass, 0.0, FLYINGFISH_INERTIA, np.zeros(3), FLYINGFISH_INERTIA * np.eye(3)),
        notes=publication("flyingfish").texts(f"notes_{medium}", inertia=FLYINGFISH_INERTIA),
    )  # fmt: skip
    file = stated_file(stated, _sources("flyingfish", "vehicle.toml", "operating_points.csv"), ("tj_flyingfish",))
    rest = ParameterHydrostatics(
        volume=volume,
        centre_of_buoyancy=(0.0, 0.0, fish.constants["buoyancy_moment"] / buoyancy),
        gravity=STANDARD_GRAVITY,
    )
    return _of_study(file, "flyingfish").model_copy(update={"hydrostatics": rest, "thrusters": thrusters(fish, medium)})


def thauv_file(glider: Glider) -> ParameterFile:
    """Polar, masses and trim of a THAUV at neutral buoyancy, the sliding masses in the middle.

    Parameters
    ----------
    glider : Glider
        One wing of THAUV.
    """
    m, polar = glider.mass, glider.polar.per_radian
    force, moment = (UNIT.unit(component, SEA.density) for component in "XM")
    alpha = {"alpha": ("rad", -THAUV_ANGLE, THAUV_ANGLE)}
    turning = {**alpha, "q": ("1", -THAUV_RATE, THAUV_RATE)}
    once, twice, rate = (("alpha", 1, False),), (("alpha", 2, False),), (("q", 1, False),)
    printed = partial(
        stated_table, form="polar of the publication", table="Table 3", campaign=glider.name,
        statements=publication("thauv").texts("statements_polar"),
    )  # fmt: skip
    damping = -glider.polar.pitch_damping / UNIT.length
    models = (
        printed("C_L", alpha, {"1": ((), polar.lift[0]), "alpha": (once, polar.lift[1])}, force),
        printed("C_D", alpha, {"1": ((), polar.drag[0]), "alpha^2": (twice, polar.drag[1])}, force),
        printed(
            "C_m", turning, {"1": ((), polar.moment[0]), "alpha": (once, polar.moment[1]), "q": (rate, damping)}, moment
        ),
    )
    weight = THAUV_MASS * glider.gravity
    added = np.zeros((6, 6))
    added[0, 0], added[2, 2] = m.surge - THAUV_MASS, m.heave - THAUV_MASS
    centre = np.array([m.moment_ahead / weight, 0.0, m.moment_below / weight])
    stated = Stated(
        glider.name, glider.title, UNIT, SEA, {}, datum=Datum("cb"), matrix=added,
        mass=MassProperties(THAUV_MASS, THAUV_MASS * float(centre[0]), m.pitch_inertia, centre),
        notes=publication("thauv").texts("notes"),
    )  # fmt: skip
    file = stated_file(stated, _sources("thauv", f"{glider.name.removeprefix('thauv_')}.toml"), ("thauv",))
    rest = ParameterHydrostatics(
        volume=THAUV_MASS / SEA.density, centre_of_buoyancy=(0.0, 0.0, 0.0), gravity=glider.gravity
    )
    content = {**_of_study(file, "thauv").model_dump(), "models": models, "hydrostatics": rest.model_dump()}
    return ParameterFile.model_validate(content)


def _of_study(file: ParameterFile, study: str) -> ParameterFile:
    return file.model_copy(update={"provenance": file.provenance.model_copy(update={"study": study})})


def _sources(study: str, *names: str) -> list[InputFile]:
    folder = Path(str(shipped("cfd_data") / study))
    return [InputFile(f"{study}/{name}", sha256_of(folder / name)) for name in names]
