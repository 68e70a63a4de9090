"""A rigid body in water: its inertia about any point, and its motion under a given force law.

Equations of motion about a body point (Fossen 2011, equations 3.42, 6.9 and 2.68)::

    (M_RB + M_A) nu_dot = tau(nu) - C_RB(nu) nu        eta_dot = J(q) nu

with -C_A(nu) nu inside tau. The attitude is a quaternion, body to earth (NED), so that no attitude is singular.

The force that an ideal fluid exerts on a body in steady motion, and the share of it in each velocity derivative.

Kirchhoff's equations (Lamb 1932, article 124; Fossen 2011, property 6.2): with the fluid's momenta p = M11 v + M12 w and
h = M21 v + M22 w, the force is -w x p and the moment -w x h - v x p, which is -C_A(nu) nu.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Annotated

import numpy as np

from coeflab.core.stored import Finite, Positive, Square3, Told, Vector, stored
from coeflab.core.types import Array, brief, locked
from coeflab.law.scaling import Scaling
from coeflab.law.transforms import rigid_body_force, skew

ROUNDING = 1e-9


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Trajectory:
    """A motion, one row a time.

    Attributes
    ----------
    time : (n,) array
        s.
    position : (n, 3) array
        Of the reference point, NED, m.
    attitude : (n, 4) array
        Unit quaternion, scalar first, body to NED.
    velocity : (n, 6) array
        u v w p q r at the reference point, FRD.
    """

    time: Array
    position: Array
    attitude: Array
    velocity: Array


def parallel_axis(mass: float, centre: Array) -> Array:
    """(3, 3) inertia about a point of a mass at ``centre`` from it (Huygens and Steiner)."""
    return np.asarray(mass * (centre @ centre * np.eye(3) - np.outer(centre, centre)))


def about_another(inertia: Array, mass: float, centre: Array, new_centre: Array) -> Array:
    """(3, 3) inertia about another point; ``centre`` and ``new_centre`` are those of gravity from the old and new point."""
    return np.asarray(inertia - parallel_axis(mass, centre) + parallel_axis(mass, new_centre))


def inertia_doubt(mass: float, centre: Array, inertia: Array) -> str:
    """Why no body has this inertia about a point, in words; empty where one can.

    About the centre of gravity it must be symmetric, and no principal moment larger than the sum of the other two.
    """
    scale = float(np.max(np.abs(inertia)))
    if np.max(np.abs(inertia - inertia.T)) > ROUNDING * scale:
        return "the inertia matrix is not symmetric"
    own = about_another(inertia, mass, centre, np.zeros(3))
    low, middle, high = np.linalg.eigvalsh((own + own.T) / 2.0)
    if low <= 0.0:
        return f"a principal moment of inertia about the centre of gravity of {low:g} kg m^2"
    if high > (low + middle) * (1.0 + ROUNDING):
        return f"principal moments of inertia {low:g}, {middle:g}, {high:g} kg m^2, one larger than the others' sum"
    return ""


@stored("mass mass_moment inertia? mass_prime mass_moment_prime centre? inertia_matrix?")
@brief
@dataclass(frozen=True, slots=True, eq=False)
class MassProperties:
    """Mass properties about the reference point.

    Attributes
    ----------
    mass : float
        kg.
    mass_moment : float
        x_G m about the reference point, kg m, positive forward.
    inertia : float or None
        About the transverse axes (Iy = Iz) through the reference point, kg m^2.
    centre : (3,) array, optional
        Centre of gravity from the reference point, m, FRD.
    inertia_matrix : (3, 3) array, optional
        About the reference point, kg m^2.
    mass_prime, mass_moment_prime : float
        m' = m / (1/2 rho L^3) and x_G' m', where they are known.
    """

    mass: Annotated[Positive, Told("mass m of the body", "kg")]
    mass_moment: Annotated[Finite, Told("x_G m, positive forward", "kg m")]
    inertia: Annotated[Positive | None, Told("transverse, Iy = Iz", "kg m^2")] = None
    centre: Annotated[
        Vector | None, Told("centre of gravity from the reference point, x y z, FRD", "m", since="1.2")
    ] = None
    inertia_matrix: Annotated[
        Square3 | None,
        Told("about the reference point, FRD; products with their sign in the matrix", "kg m^2", since="1.2"),
    ] = None
    mass_prime: Annotated[Positive, Told("m / (1/2 rho L^3)", "1")] = math.nan
    mass_moment_prime: Annotated[Finite, Told("x_G m / (1/2 rho L^4)", "1")] = math.nan

    def __post_init__(self) -> None:
        for name in ("mass", "mass_moment", "mass_prime", "mass_moment_prime"):
            object.__setattr__(self, name, float(getattr(self, name)))
        for name in ("centre", "inertia_matrix"):
            if getattr(self, name) is not None:
                object.__setattr__(self, name, locked(getattr(self, name)))

    def primed(self, scaling: Scaling, density: float) -> MassProperties:
        """With m' and x_G' m'."""
        unit = scaling.unit("m", density)
        return replace(self, mass_prime=self.mass / unit, mass_moment_prime=self.mass_moment / (unit * scaling.length))

    @property
    def centre_of_gravity(self) -> Array:
        """(3,) from the reference point, m, FRD; on the x axis where only the moment of the mass is known."""
        return np.array([self.mass_moment / self.mass, 0.0, 0.0]) if self.centre is None else self.centre

    def refuse(self) -> None:
        """Raise ValueError for what is no rigid body's, or does not agree with itself."""
        if self.inertia_matrix is not None and self.centre is None:
            raise ValueError("an inertia matrix without the centre of gravity")
        if self.centre is None:
            return
        moment = self.mass * float(self.centre[0])
        if not math.isclose(moment, self.mass_moment, rel_tol=1e-6, abs_tol=1e-9 * self.mass):
            raise ValueError(f"mass_moment {self.mass_moment:g} is not m x_G, {moment:g}")
        if self.inertia_matrix is not None and (why := inertia_doubt(self.mass, self.centre, self.inertia_matrix)):
            raise ValueError(why)


def rigid_body_inertia(mass: float, centre: Array, inertia: Array) -> Array:
    """M_RB, (6, 6), about the point that ``centre`` is from and ``inertia`` is about (Fossen 2011, equation 3.44)."""
    out = np.zeros((6, 6))
    out[:3, :3] = mass * np.eye(3)
    out[:3, 3:] = -mass * skew(centre)
    out[3:, :3] = mass * skew(centre)
    out[3:, 3:] = inertia
    return out


def rotation(quaternion: Array) -> Array:
    """(3, 3) rotation, body to earth, of a quaternion (4,), scalar first."""
    q = quaternion / np.linalg.norm(quaternion)
    s = skew(q[1:])
    return np.asarray(np.eye(3) + 2.0 * q[0] * s + 2.0 * s @ s)


def motion(
    mass: float,
    centre: Array,
    inertia: Array,
    added: Array,
    force: Callable[[Array, Array], Array],
    start: Array,
    times: Array,
    tolerance: float = 1e-10,
) -> Trajectory:
    """Integrate from the origin, upright and heading north, by the Dormand-Prince method of order 8.

    No step is longer than the time between two rows: inside a long step of a stiff motion, such as roll that is damped
    fast, interpolation is worse than the tolerance.

    Parameters
    ----------
    mass : float
        kg.
    centre : (3,) array
        Centre of gravity from the reference point, m, FRD.
    inertia : (3, 3) array
        About the reference point, kg m^2.
    added : (6, 6) array
        Added mass about the reference point.
    force : callable
        Time and (n, 6) velocities -> (n, 6) forces about the reference point, everything but inertia.
    start : (6,) array
        Velocities at the first time.
    times : (n,) array
        s, increasing; where the motion is wanted.
    tolerance : float
        Relative, of a step.

    Raises
    ------
    ArithmeticError
        The step became too small, as with an inertia that is not positive definite.
    """
    from scipy.integrate import solve_ivp

    inverse = np.linalg.inv(rigid_body_inertia(mass, centre, inertia) + added)

    def rates(time: float, state: Array) -> Array:
        quaternion, nu = state[3:7], state[None, 7:]
        w = nu[0, 3:]
        out = np.empty(13)
        out[:3] = rotation(quaternion) @ nu[0, :3]
        out[3] = -0.5 * quaternion[1:] @ w
        out[4:7] = 0.5 * (quaternion[0] * w + np.cross(quaternion[1:], w))
        out[7:] = inverse @ (force(np.array([time]), nu) - rigid_body_force(mass, centre, inertia, nu))[0]
        return out

    first = np.concatenate([np.zeros(3), [1.0, 0.0, 0.0, 0.0], start])
    found = solve_ivp(
        rates,
        (times[0], times[-1]),
        first,
        method="DOP853",
        t_eval=times,
        rtol=tolerance,
        atol=tolerance,
        max_step=float(np.min(np.diff(times))),
    )
    if not found.success:
        raise ArithmeticError(found.message)
    states = found.y.T
    attitude = states[:, 3:7] / np.linalg.norm(states[:, 3:7], axis=1)[:, None]
    return Trajectory(found.t, states[:, :3], attitude, states[:, 7:])


LEVI_CIVITA = np.zeros((3, 3, 3))
for _i, _j, _k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
    LEVI_CIVITA[_i, _j, _k], LEVI_CIVITA[_i, _k, _j] = 1.0, -1.0


def ideal_force(matrix: Array, nu: Array) -> Array:
    """-C_A(nu) nu, shape (n, 6).

    Parameters
    ----------
    matrix : (6, 6) array
        Added mass about the point that ``nu`` and the moments are about.
    nu : (n, 6) array
        u v w p q r.
    """
    momentum = nu @ ((matrix + matrix.T) / 2.0)
    v, w, p, h = nu[:, :3], nu[:, 3:], momentum[:, :3], momentum[:, 3:]
    return np.hstack([-np.cross(w, p), -np.cross(w, h) - np.cross(v, p)])


def ideal_quadratics(matrix: Array) -> Array:
    """(6, 6, 6) array Q, symmetric in its last two axes: force i = sum of Q[i, j, k] nu_j nu_k."""
    return momentum_quadratics((matrix + matrix.T) / 2.0)


def momentum_quadratics(m: Array) -> Array:
    """The same for momenta ``m @ nu`` of a matrix that need not be symmetric, as some simulators are given it."""
    out = np.zeros((6, 6, 6))
    out[:3, 3:, :] -= np.einsum("iab,bk->iak", LEVI_CIVITA, m[:3])
    out[3:, 3:, :] -= np.einsum("iab,bk->iak", LEVI_CIVITA, m[3:])
    out[3:, :3, :] -= np.einsum("iab,bk->iak", LEVI_CIVITA, m[:3])
    return np.asarray((out + np.swapaxes(out, 1, 2)) / 2.0)
