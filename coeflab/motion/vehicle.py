"""A vehicle as a simulator moves it: inertia, force law, buoyancy, thrusters and control surfaces of a parameter file."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from coeflab.core.errors import InputError, shown
from coeflab.core.finding import Finding
from coeflab.core.texts import input_error, remark
from coeflab.core.types import Array, dataclass, locking
from coeflab.core.units import STANDARD_GRAVITY
from coeflab.law.force_law import ForceLaw
from coeflab.law.rigid_body import rigid_body_force, rigid_body_inertia
from coeflab.law.symbols import COMPONENTS, CONTROLS, MOTIONS
from coeflab.motion.dynamics import restoring
from coeflab.motion.thrusters import levers, wrench
from coeflab.vehicle.force_law import motion_law
from coeflab.vehicle.inertia import MEASURED, WaterInertia, water_inertia, with_accelerations
from coeflab.vehicle.parameter_file import CoveredRange, ParameterFile
from coeflab.vehicle.parameter_parts import ParameterHydrostatics, ParameterSurface, ParameterThruster

PLANES = {"horizontal": ("u", "v", "r"), "vertical": ("u", "w", "q")}
BALANCED, ONE_POINT = 5e-3, 1e-4  # of the weight and of the length: less is trimmed, or one point


@dataclass(frozen=True, slots=True, eq=False)
@locking("centre inertia added")
class Vehicle:
    """What is moved, SI, FRD, about the reference point of its parameter file.

    Attributes
    ----------
    name : str
    mass : float
    centre : (3,) array
        Of gravity.
    inertia : (3, 3) array
        About the reference point.
    added : (6, 6) array
        M_A, that of ``water`` but in draws of it.
    water : WaterInertia
        Which accelerations were chosen, and where they come from.
    law : ForceLaw
    hydrostatics : ParameterHydrostatics
    thrusters : tuple of ParameterThruster
    surfaces : tuple of ParameterSurface
    free : tuple of str
        Those of u v w p q r that may change; the others keep their value whatever force that takes.
    speed, length, density : float
        Of the parameter file.
    covered : tuple of CoveredRange
    statements : tuple of str
        What was assumed, in words.
    findings : tuple of Finding
        Of the law: what of the file it does not use, and where its tables end.
    """

    name: str
    mass: float
    centre: Array
    inertia: Array
    added: Array
    water: WaterInertia
    law: ForceLaw
    hydrostatics: ParameterHydrostatics
    thrusters: tuple[ParameterThruster, ...]
    surfaces: tuple[ParameterSurface, ...]
    free: tuple[str, ...]
    speed: float
    length: float
    density: float
    covered: tuple[CoveredRange, ...]
    statements: tuple[str, ...]
    findings: tuple[Finding, ...] = ()

    @property
    def effective_mass(self) -> Array:
        """(6, 6) M_RB + M_A."""
        return np.asarray(rigid_body_inertia(self.mass, self.centre, self.inertia) + self.added)

    @property
    def free_columns(self) -> tuple[int, ...]:
        """Positions of ``free`` among u v w p q r."""
        return tuple(MOTIONS.index(f) for f in self.free)

    @property
    def weight(self) -> float:
        """M g, N."""
        return self.mass * self.hydrostatics.gravity

    @property
    def buoyancy(self) -> float:
        """Rho g V, N."""
        return self.density * self.hydrostatics.gravity * self.hydrostatics.volume

    def inverse_inertia(self) -> Array:
        """(6, 6) accelerations of unit forces, zero for what is held."""
        at = np.ix_(self.free_columns, self.free_columns)
        out = np.zeros((6, 6))
        out[at] = np.linalg.inv(self.effective_mass[at])
        return out

    def force(self, nu: Array, controls: Array) -> Array:
        """(n, 6) hydrodynamic force at velocities (n, 6) and angles dr ds db (n, 3)."""
        return self.law.force(nu, controls)

    @property
    def afloat(self) -> tuple[str, ...]:
        """What makes a free vehicle rise, sink or tumble in still water, in words; nothing of one that is held in heave and pitch."""
        out, apart = [], self.weight - self.buoyancy
        if "w" in self.free and abs(apart) > BALANCED * self.weight:
            way = ("more", "sinks") if apart > 0.0 else ("less", "rises")
            out.append(
                f"weight {abs(apart):.3g} N {way[0]} than buoyancy ({100.0 * abs(apart) / self.weight:.2g} %): it {way[1]}"
            )
        lever = np.linalg.norm(self.centre - np.array(self.hydrostatics.centre_of_buoyancy))
        if {"p", "q"} & set(self.free) and lever < ONE_POINT * self.length:
            out.append("centre of gravity in the centre of buoyancy: nothing rights it in roll and pitch")
        return tuple(out)

    def restoring(self, attitude: Array) -> Array:
        """(n, 6) of weight and buoyancy."""
        h = self.hydrostatics
        return restoring(attitude, self.weight, self.buoyancy, self.centre, np.array(h.centre_of_buoyancy))

    def acceleration(self, nu: Array, attitude: Array, controls: Array, wrench: Array) -> Array:
        """(n, 6) rates of u v w p q r, through the water.

        Parameters
        ----------
        nu : (n, 6) array
        attitude : (n, 4) array
        controls : (n, 3) array
            dr ds db.
        wrench : (6,) or (n, 6) array
            Of the thrusters.
        """
        return np.asarray(self.unbalanced(nu, attitude, controls, wrench) @ self.inverse_inertia().T)

    def unbalanced(self, nu: Array, attitude: Array, controls: Array, wrench: Array) -> Array:
        """(n, 6) force and moment that accelerate the vehicle; parameters as of `acceleration`."""
        held = rigid_body_force(self.mass, self.centre, self.inertia, nu)
        return np.asarray(self.force(nu, controls) + self.restoring(attitude) + wrench - held)

    def wrench(self, commands: Mapping[str, float]) -> Array:
        """(6,) force and moment of all thrusters about the reference point.

        Parameters
        ----------
        commands : mapping of str to float
            ``name`` to its command, ``name.tilt`` to rad, ``thrust`` to N ahead at the reference point. What is not named
            is zero; what is beyond a limit is held at it.

        Raises
        ------
        InputError
            A name that no thruster has.
        """
        return wrench(self.thrusters, commands)

    def levers(self, k: int, tilt: float) -> Array:
        """(2, 6) force and moment of one newton of thrust, and of one newton metre of torque, of a thruster at a tilt."""
        return levers(self.thrusters[k], tilt)

    def resistance(self, speed: float) -> float:
        """Thrust that a straight course ahead takes, N, at no angle and no control."""
        nu = np.zeros((1, 6))
        nu[0, 0] = speed
        return -float(self.force(nu, np.zeros((1, 3)))[0, 0])


def vehicle(
    parameters: ParameterFile,
    free: Sequence[str] = (),
    plane: str = "",
    tables: bool = False,
    accelerations: str = MEASURED,
) -> Vehicle:
    """The vehicle of a parameter file.

    Parameters
    ----------
    parameters : ParameterFile
    free : sequence of str
        Motions that may change; empty: all six where the file knows enough of each, otherwise those of ``plane``.
    plane : {"horizontal", "vertical", ""}
    tables : bool
        Whether fitted tables come first, see `coeflab.vehicle.sources.summed`.
    accelerations : {"measured", "computed"}
        Whether acceleration derivatives of the file come before its computed added mass; see `coeflab.vehicle.inertia`.

    Raises
    ------
    InputError
        No mass or none above zero, no inertia of a free rotation, an effective mass that is not positive definite, a motion of no such name.
    """
    mass = parameters.mass
    if mass is None:
        raise input_error("motion.no_mass", column="mass")
    if not mass.mass > 0.0:  # a fit may come here with values that no file has
        raise InputError(f"a mass of {mass.mass:g} kg", "above zero", column="mass")
    strange = [f for f in free if f not in MOTIONS]
    if strange or plane not in ("", *PLANES):
        raise input_error(
            "motion.unknown_plane", column="free" if strange else "plane", found=shown(strange[0] if strange else plane),
            motions=" ".join(MOTIONS), planes=", ".join(PLANES),
        )  # fmt: skip
    water = water_inertia(parameters, accelerations)
    parameters = with_accelerations(parameters, accelerations)
    centre = mass.centre_of_gravity
    law, found = motion_law(parameters, tables)
    known = _known(parameters, law)
    moves = tuple(m for m in MOTIONS if m in free) or (MOTIONS if known == MOTIONS or not plane else PLANES[plane])
    words = [remark(f) for f in found]
    if moves != MOTIONS:
        lacking = [m for m in MOTIONS if m not in moves]
        why = (
            "" if free else f"; the file has too few coefficients for {', '.join(m for m in MOTIONS if m not in known)}"
        )
        words.append(f"{', '.join(lacking)} fixed at the initial values{why}")
    inertia = _inertia(parameters, moves)
    words += (*water.statements, *parameters.narrowed)
    hydrostatics = parameters.hydrostatics
    if hydrostatics is None:
        hydrostatics = ParameterHydrostatics(
            volume=mass.mass / parameters.conditions.density,
            centre_of_buoyancy=tuple(map(float, centre)),
            gravity=STANDARD_GRAVITY,
        )
        if set(moves) & set("wpq"):
            words.append(
                "no hydrostatics in the file: assumed neutrally buoyant, centre of buoyancy at the centre of gravity"
            )
    result = Vehicle(
        name=parameters.name, mass=mass.mass, centre=centre, inertia=inertia, added=water.matrix, water=water, law=law, hydrostatics=hydrostatics, thrusters=parameters.thrusters,
        surfaces=parameters.surfaces, free=moves, speed=parameters.conditions.speed, length=parameters.scaling.length,
        density=parameters.conditions.density, covered=parameters.offered, statements=tuple(words), findings=found,
    )  # fmt: skip
    _positive(result)
    return result


def _known(parameters: ParameterFile, law: ForceLaw) -> tuple[str, ...]:
    """Motions with an inertia and with a force of their own along them."""
    mass = parameters.mass
    resisted = {
        m
        for m, c in zip(MOTIONS, COMPONENTS, strict=True)
        for t in law.terms
        if (t.component in (c, "D", "S", "L") and {m, "alpha", "beta"} & set(t.variables))
        or (m == "u" and t.component == "X")
    }
    turning = {"p": False, "q": False, "r": False}
    if mass is not None:
        whole = mass.inertia_matrix is not None
        turning = {"p": whole, "q": whole or mass.inertia is not None, "r": whole or mass.inertia is not None}
    return tuple(m for m in MOTIONS if m in resisted and turning.get(m, True))


def _inertia(parameters: ParameterFile, moves: Sequence[str]) -> Array:
    """(3, 3) about the reference point; of what is held only a place holder."""
    mass = parameters.mass
    if mass is not None and mass.inertia_matrix is not None:
        return np.array(mass.inertia_matrix)
    spinning = set(moves) & set("pqr")
    if mass is not None and mass.inertia is not None and "p" not in spinning:
        return np.diag([0.0, mass.inertia, mass.inertia])
    if spinning:
        raise input_error("motion.no_inertia", column="mass", spinning=", ".join(sorted(spinning)))
    return np.zeros((3, 3))


def _positive(given: Vehicle) -> None:
    at = np.ix_(given.free_columns, given.free_columns)
    block = given.effective_mass[at]
    low = float(np.linalg.eigvalsh((block + block.T) / 2.0)[0])
    if not low > 0.0:
        raise input_error("motion.mass_not_definite", column="added_mass", free=", ".join(given.free), low=low)


def control_rows(controls: Mapping[str, Array], n: int) -> Array:
    """(n, 3) dr ds db out of named columns; zero where a name is absent."""
    return np.column_stack([np.broadcast_to(controls.get(c, np.zeros(1)), (n,)) for c in CONTROLS])
