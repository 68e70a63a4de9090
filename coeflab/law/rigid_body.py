"""A rigid body in water: its mass and inertia about any point, and the rates of its motion.

Equations of motion about a body point (Fossen 2011, equations 3.42, 4.6, 6.9 and 2.68)::

    (M_RB + M_A) nu_dot = tau(nu) - C_RB(nu) nu + g(attitude)        eta_dot = J(q) nu

with -C_A(nu) nu inside tau. The attitude is a unit quaternion, scalar first, body to earth (NED), so that no attitude is singular.

C(nu) nu of the body and of the ideal fluid are one form: Kirchhoff's equations (Lamb 1932, article 124; Fossen 2011, property
6.2), with the momenta p = M11 v + M12 w and h = M21 v + M22 w: the force is -w x p and the moment -w x h - v x p.

`axes_in_earth`, `kinematics` and `weighed` are arithmetic alone: they take numbers, arrays of many states, and what numba compiles.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Annotated, Any

import numpy as np

from coeflab.core.stored import Finite, Means, Positive, Square3, Vector, stored
from coeflab.core.types import Array, brief, locked
from coeflab.law.scaling import Scaling
from coeflab.law.transforms import skew

ROUNDING = 1e-9
ON_AXIS = 1e-6  # m


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
        return f"a principal moment of inertia about the centre of gravity of {low:g} kg m^2, at a mass of {mass:g} kg"
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

    mass: Annotated[Positive, Means("mass m of the body", "kg")]
    mass_moment: Annotated[Finite, Means("x_G m, positive forward", "kg m")]
    inertia: Annotated[Positive | None, Means("transverse, Iy = Iz", "kg m^2")] = None
    centre: Annotated[
        Vector | None, Means("centre of gravity from the reference point, x y z, FRD", "m", since="1.2")
    ] = None
    inertia_matrix: Annotated[
        Square3 | None,
        Means("about the reference point, FRD; products with their sign in the matrix", "kg m^2", since="1.2"),
    ] = None
    mass_prime: Annotated[Positive, Means("m / (1/2 rho L^3)", "1")] = math.nan
    mass_moment_prime: Annotated[Finite, Means("x_G m / (1/2 rho L^4)", "1")] = math.nan

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

    def moved(self, shift: Array) -> MassProperties | None:
        """About a point ``shift`` (3,) m away, without primes; None where what is known does not lead there.

        Off the x axis that takes the centre of gravity and, of an inertia, the matrix: Iy and Iz part there.
        """
        dx, along = float(shift[0]), not np.any(np.abs(shift[1:]) > ON_AXIS)
        if not along and (self.centre is None or (self.inertia is not None and self.inertia_matrix is None)):
            return None
        inertia = None
        if self.inertia is not None and along:
            inertia = self.inertia - 2.0 * self.mass_moment * dx + self.mass * dx**2
        centre = None if self.centre is None else self.centre - shift
        matrix = None
        if centre is not None and self.centre is not None and self.inertia_matrix is not None:
            matrix = about_another(self.inertia_matrix, self.mass, self.centre, centre)
        return MassProperties(self.mass, self.mass_moment - self.mass * dx, inertia, centre, matrix)

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


LEVI_CIVITA = np.zeros((3, 3, 3))
for _i, _j, _k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
    LEVI_CIVITA[_i, _j, _k], LEVI_CIVITA[_i, _k, _j] = 1.0, -1.0


def momentum_force(momentum: Array, nu: Array) -> Array:
    """-C(nu) nu, shape (n, 6): what momenta (n, 6) that move with the body at ``nu`` (n, 6) exert on it (Kirchhoff)."""
    v, w, p, h = nu[:, :3], nu[:, 3:], momentum[:, :3], momentum[:, 3:]
    turned = np.cross(np.stack([w, w, v]), np.stack([p, h, p]))  # one call: many are of a single row
    return np.hstack([-turned[0], -turned[1] - turned[2]])


def rigid_body_force(mass: float, centre: Array, inertia: Array, nu: Array) -> Array:
    """C_RB(nu) nu, the force and moment that hold a body in a steady motion, shape (n, 6) (Fossen 2011, equation 3.42).

    Parameters
    ----------
    mass : float
        kg.
    centre : (3,) array
        Centre of gravity from the reference point, m, FRD.
    inertia : (3, 3) array
        About the reference point, kg m^2.
    nu : (n, 6) array
        Velocities at the reference point.
    """
    return -momentum_force(nu @ rigid_body_inertia(mass, centre, inertia).T, nu)


def ideal_force(matrix: Array, nu: Array) -> Array:
    """-C_A(nu) nu, shape (n, 6).

    Parameters
    ----------
    matrix : (6, 6) array
        Added mass about the point that ``nu`` and the moments are about.
    nu : (n, 6) array
        u v w p q r.
    """
    return momentum_force(nu @ ((matrix + matrix.T) / 2.0), nu)


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


def axes_in_earth(w: Any, x: Any, y: Any, z: Any) -> tuple[Any, ...]:
    """North, east and down of the body's x, then of its y, then of its z axis, at a unit quaternion; numbers or arrays."""
    return (
        1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y),
        2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x),
        2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y),
    )  # fmt: skip


def kinematics(
    axes: tuple[Any, ...], w: Any, x: Any, y: Any, z: Any, u: Any, v: Any, down: Any, p: Any, q: Any, r: Any
) -> tuple[Any, ...]:
    """Rates of position and quaternion, then the rate of heading times, and divided by, the x axis' horizontal length squared.

    Parameters
    ----------
    axes : tuple
        `axes_in_earth` of the quaternion.
    w, x, y, z, u, v, down, p, q, r : numbers or arrays
        Quaternion and velocities.
    """
    ax, ay, az, bx, by, bz, cx, cy, cz = axes
    # The horizontal direction of the x axis moves as r times the y axis less q times the z axis.
    return (
        ax * u + bx * v + cx * down, ay * u + by * v + cy * down, az * u + bz * v + cz * down,
        -0.5 * (x * p + y * q + z * r), 0.5 * (w * p + y * r - z * q), 0.5 * (w * q + z * p - x * r),
        0.5 * (w * r + x * q - y * p), ax * (r * by - q * cy) - ay * (r * bx - q * cx), ax * ax + ay * ay,
    )  # fmt: skip


def weighed(excess: Any, lx: Any, ly: Any, lz: Any, gx: Any, gy: Any, gz: Any) -> tuple[Any, ...]:
    """X Y Z K M N of weight and buoyancy (Fossen 2011, equation 4.6, as a force); numbers or arrays.

    Parameters
    ----------
    excess : number or array
        Weight less buoyancy, N.
    lx, ly, lz : numbers or arrays
        W r_G - B r_B, N m.
    gx, gy, gz : numbers or arrays
        Down, in body axes.
    """
    return excess * gx, excess * gy, excess * gz, ly * gz - lz * gy, lz * gx - lx * gz, lx * gy - ly * gx
