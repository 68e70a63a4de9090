"""Many vehicles that differ in their numbers alone, marched side by side."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from coeflab.core.errors import InputError
from coeflab.core.texts import input_error
from coeflab.core.types import Array, dataclass, locked
from coeflab.law.rigid_body import momentum_quadratics, rigid_body_inertia
from coeflab.motion.dynamics import VELOCITY, Dynamics, forms_of_pairs
from coeflab.motion.rates_of_one import rates_of_one
from coeflab.motion.vehicle import Vehicle

SHAPES = {"coefficients": (0,), "added": (6, 6), "ideal": (6, 6, 6), "mass": (), "centre": (3,), "inertia": (3, 3)}
STILL = np.zeros(3)


@dataclass(frozen=True, slots=True, eq=False)
class Ensemble:
    """Members of one vehicle.

    Attributes
    ----------
    vehicle : Vehicle
        What they share, and its values where a field is None.
    coefficients : (m, t) array
        SI, of the terms of the vehicle's law, in its order.
    added : (m, 6, 6) array or None
        Added mass.
    ideal : (m, 6, 6, 6) array or None
        Quadratics that the ideal fluid adds to the terms.
    mass : (m,) array or None
    centre : (m, 3) array or None
        Of gravity.
    inertia : (m, 3, 3) array or None
        About the reference point.

    Raises
    ------
    InputError
        Arrays that do not fit each other, numbers that are not finite, a member with an effective mass that is not positive
        definite.
    """

    vehicle: Vehicle
    coefficients: Array
    added: Array | None = None
    ideal: Array | None = None
    mass: Array | None = None
    centre: Array | None = None
    inertia: Array | None = None

    def __post_init__(self) -> None:
        count = len(self.coefficients)
        for name, shape in SHAPES.items():
            given = getattr(self, name)
            if given is None:
                continue
            wanted = (count, len(self.vehicle.law.terms)) if name == "coefficients" else (count, *shape)
            array = locked(given)
            if array.shape != wanted or not count:
                raise InputError(f"an array of shape {array.shape}", f"shape {wanted}, one row a member", column=name)
            if not np.isfinite(array).all():
                raise InputError("a value that is not finite", "finite numbers", column=name)
            object.__setattr__(self, name, array)
        low = np.linalg.eigvalsh((self._free_mass() + self._free_mass().swapaxes(-1, -2)) / 2.0)[:, 0]
        if not np.all(low > 0.0):
            raise input_error(
                "motion.member_mass_not_definite", column="added", member=int(np.argmin(low)) + 1, lowest=low.min()
            )

    @property
    def count(self) -> int:
        """Number of members."""
        return len(self.coefficients)

    def member(self, i: int) -> Vehicle:
        """One of them, as a vehicle."""
        v = self.vehicle
        terms = tuple(replace(t, coefficient=float(c)) for t, c in zip(v.law.terms, self.coefficients[i], strict=True))
        own = np.array([t.coefficient for t in terms])
        law = replace(v.law, terms=terms, coefficient=own, ideal=v.law.ideal if self.ideal is None else self.ideal[i])
        return replace(
            v, law=law,
            added=v.added if self.added is None else self.added[i],
            mass=v.mass if self.mass is None else float(self.mass[i]),
            centre=v.centre if self.centre is None else self.centre[i],
            inertia=v.inertia if self.inertia is None else self.inertia[i],
        )  # fmt: skip

    def dynamics(self, current: Array) -> Dynamics:
        """Arrays that a march needs, in a current (3,) north, east, down."""
        v = self.vehicle
        rigid = np.array([momentum_quadratics(rigid_body_inertia(*body)) for body in self._bodies()])
        weight = np.array([mass for mass, _, _ in self._bodies()]) * v.hydrostatics.gravity
        centres = np.array([centre for _, centre, _ in self._bodies()])
        lever = weight * centres.T - v.buoyancy * np.array(v.hydrostatics.centre_of_buoyancy)[:, None]
        rows, columns = np.ix_(v.free_columns, v.free_columns)
        free = np.linalg.inv(self._free_mass())
        inverse = np.zeros((len(free), 6, 6))
        inverse[:, rows, columns] = free
        quadratics = forms_of_pairs((v.law.ideal if self.ideal is None else self.ideal) + rigid)
        shared = replace(v.law, coefficient=self.coefficients if self.count > 1 else self.coefficients[0])
        alike = len(quadratics) == 1
        return Dynamics(
            law=shared,
            quadratics=quadratics[0] if alike else quadratics,
            inverse=inverse[0] if len(inverse) == 1 else inverse,
            excess=weight - v.buoyancy,
            lever=lever,
            current=np.asarray(current, dtype=np.float64),
        )

    def _bodies(self) -> list[tuple[float, Array, Array]]:
        """Mass, centre and inertia, one entry where all are alike."""
        v = self.vehicle
        count = 1 if self.mass is None and self.centre is None and self.inertia is None else self.count
        return [
            (
                v.mass if self.mass is None else float(self.mass[i]),
                v.centre if self.centre is None else self.centre[i],
                v.inertia if self.inertia is None else self.inertia[i],
            )
            for i in range(count)
        ]

    def _free_mass(self) -> Array:
        """(1 or m, f, f) effective mass of the free motions."""
        rigid = np.array([rigid_body_inertia(*body) for body in self._bodies()])
        whole = rigid + (self.vehicle.added if self.added is None else self.added)
        rows, columns = np.ix_(self.vehicle.free_columns, self.vehicle.free_columns)
        return np.asarray(whole.reshape(-1, 6, 6)[:, rows, columns])


def alone(vehicle: Vehicle) -> Ensemble:
    """An ensemble of one."""
    return Ensemble(vehicle, vehicle.law.coefficient[None, :])


def integrated_forces(vehicle: Vehicle, nu: Array, attitude: Array, wrench: Array) -> Array:
    """Forces along the free motions behind the rates that the integrators march, (2, n, 6): of arrays, and of plain numbers.

    Parameters
    ----------
    vehicle : Vehicle
    nu : (n, 6) array
        Velocities; those held are not accelerated and have no force.
    attitude : (n, 4) array
    wrench : (n, 6) array
        Of the thrusters.
    """
    n, dynamics = len(nu), alone(vehicle).dynamics(STILL)
    state = np.column_stack([np.zeros((n, 3)), attitude, nu, np.zeros(n)])
    one = rates_of_one(dynamics)
    singly = [one(s.tolist(), [0.0, 0.0, 0.0], w.tolist()) for s, w in zip(state, wrench, strict=True)]
    both = np.array([dynamics.rates(state.T, np.zeros((3, n)), wrench.T).T, singly])[..., VELOCITY]
    return np.asarray(both @ vehicle.effective_mass.T)


def idle(vehicle: Vehicle) -> Vehicle:
    """The same body without damping, weight and buoyancy: inertia alone, which does no work."""
    law = replace(vehicle.law, coefficient=np.zeros_like(vehicle.law.coefficient))
    return replace(vehicle, law=law, hydrostatics=vehicle.hydrostatics.model_copy(update={"gravity": 0.0}))
