"""Steady turns of a vehicle in the horizontal plane that is steered by the difference of two thrusts.

Body axes FRD: u forward, v to starboard, r to starboard, beta = asin(v/V) in rad, V = |(u, v)|. The equations are those of
the HUUV (Talarczyk et al. 2025, equations 1, 5-7 with their errata corrected, 34-38), about the centre of buoyancy::

    (m + mx) u' = X + Fx + (m + my) v r + myr r^2
    (m + my) v' + myr r' = Fy - (m + mx) u r
    myr v' + I r' = N + Fn - (my - mx) u v - myr u r

    Fx = -V u (d0 + d2 beta^2) + s V v (s1 beta + s3 beta^3)
    Fy = -V v (d0 + d2 beta^2) - V |u| (s1 beta + s3 beta^3)
    Fn = s V^2 (n1 beta + n3 beta^3) - nr r - nrr r |r|                  s = sign(u)

Port and starboard mirror each other, so in FLU (y port, z up) the same equations hold with v, r, N and beta reversed. Astern
the hull is taken to be its own mirror image fore and aft, so that drag opposes the motion at every incidence; the paper
covers |beta| <= 25 deg ahead. Every force is linear in the coefficients, which gives exact sensitivities.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from coeflab.core.types import Array, dataclass
from coeflab.motion.steady_state import growth, settled

COEFFICIENTS = ("m", "mx", "my", "myr", "inertia", "d0", "d2", "s1", "s3", "n1", "n3", "nr", "nrr")
COVERED = float(np.radians(25.0))
SLOWEST = 1e-12
STILL = 1e-100


@dataclass(frozen=True, slots=True, eq=False)
class SteadyTurns:
    """Operating points, one row a pair of thrusts.

    Attributes
    ----------
    velocity : (n, 3) array
        u v r, FRD; NaN where none was found.
    converged : (n,) bool array
    stable : (n,) bool array
        No small disturbance of u, v and r grows.
    """

    velocity: Array
    converged: NDArray[np.bool_]
    stable: NDArray[np.bool_]

    @property
    def speed(self) -> Array:
        """V, m/s."""
        return np.hypot(self.velocity[:, 0], self.velocity[:, 1])

    @property
    def drift(self) -> Array:
        """Beta, rad; zero at rest."""
        return drift(self.velocity)

    @property
    def radius(self) -> Array:
        """V/|r|, m; infinite on a straight course, NaN at rest."""
        turning = np.abs(self.velocity[:, 2])
        safe = np.where(turning > SLOWEST, turning, 1.0)
        out = np.where(turning > SLOWEST, self.speed / safe, np.inf)
        return np.where(self.speed > SLOWEST, out, np.nan)

    @property
    def inside(self) -> NDArray[np.bool_]:
        """Whether the incidence is one that the published tables cover: ahead, within 25 deg."""
        return np.asarray((self.velocity[:, 0] >= 0.0) & (np.abs(self.drift) <= COVERED))


def drift(velocity: Array) -> Array:
    """asin(v/V) of velocities (..., 3), exact near 0 and near 90 deg; zero at rest."""
    return np.asarray(np.arctan2(velocity[..., 1], np.abs(velocity[..., 0])))


def inertia(theta: Array) -> Array:
    """(3, 3) inertia, rigid body and added, of the motions u v r."""
    m, mx, my, myr, turning = theta[:5]
    return np.array([[m + mx, 0.0, 0.0], [0.0, m + my, myr], [0.0, myr, turning]])


INERTIAL = slice(0, 5)  # of the coefficients: m, mx, my, myr and inertia, whose forces are products of velocities


def kirchhoff(theta: Array, velocity: Array) -> Array:
    """(n, 3) forces of the inertia in steady motion by Kirchhoff's equations, from its kinetic energy alone (Lamb 1932, 124).

    With the momenta (P, Q, H) = M (u, v, r) they are (r Q, -r P, v P - u Q).
    """
    u, v, r = velocity.T
    p, q, _ = inertia(theta) @ velocity.T
    return np.column_stack([r * q, -r * p, v * p - u * q])


def features(velocity: Array) -> tuple[Array, Array]:
    """Forces for a unit of every coefficient, and their rates.

    Parameters
    ----------
    velocity : (n, 3) array

    Returns
    -------
    force : (n, 3, 13) array
        Rows X Y N; Coriolis forces included, thrust not.
    rates : (n, 3, 13, 3) array
        Derivatives by u, v and r.
    """
    u, v, r = velocity.T
    n = len(velocity)
    s, au, speed = np.where(u < 0.0, -1.0, 1.0), np.abs(u), np.hypot(u, v)
    # Slower than this the incidence has no digits left, and the forces no size.
    moving = speed > STILL
    safe = np.where(moving, speed, 1.0)
    beta = np.arctan2(v, au)
    along, across = np.where(moving, u / safe, 0.0), np.where(moving, v / safe, 0.0)
    turn_u, turn_v = -s * across / safe, np.abs(along) / safe
    force, rates = np.zeros((n, 3, 13)), np.zeros((n, 3, 13, 3))

    def put(row: int, name: str, value: Array, by_u: Array, by_v: Array) -> None:
        k = COEFFICIENTS.index(name)
        force[:, row, k] += value
        rates[:, row, k, 0] += by_u
        rates[:, row, k, 1] += by_v

    for name, power in (("d0", 0), ("d2", 2), ("s1", 1), ("s3", 3), ("n1", 1), ("n3", 3)):
        shape = beta**power
        steep = power * beta ** max(power - 1, 0)
        bent_u, bent_v = steep * turn_u, steep * turn_v
        if name[0] == "d":
            put(0, name, -speed * u * shape, -(along * u + speed) * shape - speed * u * bent_u,
                -across * u * shape - speed * u * bent_v)  # fmt: skip
            put(1, name, -speed * v * shape, -along * v * shape - speed * v * bent_u,
                -(across * v + speed) * shape - speed * v * bent_v)  # fmt: skip
        elif name[0] == "s":
            put(0, name, s * speed * v * shape, s * (along * v * shape + speed * v * bent_u),
                s * ((across * v + speed) * shape + speed * v * bent_v))  # fmt: skip
            put(1, name, -speed * au * shape, -(along * au + speed * s) * shape - speed * au * bent_u,
                -across * au * shape - speed * au * bent_v)  # fmt: skip
        else:
            put(2, name, s * speed**2 * shape, s * (2.0 * u * shape + speed**2 * bent_u),
                s * (2.0 * v * shape + speed**2 * bent_v))  # fmt: skip
    one, none = np.ones(n), np.zeros(n)
    products = (
        (0, ("m", "my"), v * r, (none, r, v)),
        (1, ("m", "mx"), -u * r, (-r, none, -u)),
        (2, ("my",), -u * v, (-v, -u, none)),
        (2, ("mx",), u * v, (v, u, none)),
        (0, ("myr",), r * r, (none, none, 2.0 * r)),
        (2, ("myr",), -u * r, (-r, none, -u)),
        (2, ("nr",), -r, (none, none, -one)),
        (2, ("nrr",), -r * np.abs(r), (none, none, -2.0 * np.abs(r))),
    )
    for row, names, value, by in products:
        for name in names:
            k = COEFFICIENTS.index(name)
            force[:, row, k] += value
            rates[:, row, k] += np.stack(by, axis=-1)
    return force, rates


def steady_turns(theta: Array, thrust: Array, start: Array | None = None) -> SteadyTurns:
    """Steady turns under constant thrusts, those that the vehicle would reach from the start.

    Parameters
    ----------
    theta : (13,) array
        In the order of `COEFFICIENTS`.
    thrust : (n, 3) array
        X, Y and N of the thrusters, N and N m, FRD.
    start : (3,) or (n, 3) array, optional
        Velocities u v r to begin with; a slow straight run by default.
    """
    mass, size = inertia(theta), np.linalg.norm(thrust, axis=1)
    first = np.array(np.broadcast_to((0.3, 0.0, 0.0) if start is None else start, (len(thrust), 3)), dtype=float)
    first[size == 0.0] = 0.0

    def forces(x: Array) -> Array:
        return np.asarray(features(x)[0] @ theta + thrust)

    def slopes(x: Array) -> Array:
        return np.asarray(np.einsum("nikj,k->nij", features(x)[1], theta))

    velocity, converged = settled(forces, mass, first, np.maximum(size, SLOWEST), slopes)
    return SteadyTurns(velocity, converged, converged & (growth(mass, slopes(velocity)) <= 0.0))


def sensitivities(theta: Array, velocity: Array) -> tuple[Array, Array]:
    """How a steady turn moves with the coefficients and with the thrusts (implicit function theorem).

    Returns
    -------
    by_coefficients : (n, 3, 13) array
    by_thrust : (n, 3, 3) array
        Of u v r.
    """
    unit, slopes = features(velocity)
    flow = -np.linalg.inv(np.einsum("nikj,k->nij", slopes, theta))
    return flow @ unit, flow


def turn_figures(velocity: Array) -> tuple[Array, Array]:
    """Forward speed, size of the drift angle and radius, as turns are measured.

    Parameters
    ----------
    velocity : (n, 3) array

    Returns
    -------
    figures : (n, 3) array
        u in m/s, |beta| in rad, V/|r| in m.
    rates : (n, 3, 3) array
        Derivatives of the figures by u, v and r.
    """
    u, v, r = velocity.T
    speed = np.hypot(u, v)
    beta = drift(velocity)
    radius = speed / np.abs(r)
    sign = np.where(beta < 0.0, -1.0, 1.0)
    none = np.zeros_like(u)
    ahead = np.where(u < 0.0, -1.0, 1.0)
    rates = np.stack([
        np.stack([none + 1.0, none, none], axis=-1),
        sign[:, None] * np.stack([-ahead * v / speed**2, np.abs(u) / speed**2, none], axis=-1),
        np.stack([radius * u / speed**2, radius * v / speed**2, -radius / r], axis=-1),
    ], axis=1)  # fmt: skip
    return np.stack([u, np.abs(beta), radius], axis=-1), rates


def run(theta: Array, thrust: Array, times: Array, start: Array | None = None) -> Array:
    """Velocities (len(times), 3) from rest, or from ``start``, under constant thrusts (3,), by LSODA.

    Raises
    ------
    ArithmeticError
        The integrator gave up.
    """
    from scipy.integrate import solve_ivp

    inverse = np.linalg.inv(inertia(theta))
    first = np.zeros(3) if start is None else np.asarray(start, dtype=float)

    def rates(_: float, x: Array) -> Array:
        return np.asarray(inverse @ (features(x[None])[0][0] @ theta + thrust))

    found = solve_ivp(rates, (times[0], times[-1]), first, method="LSODA", t_eval=times, rtol=1e-9, atol=1e-12)
    if not found.success:
        raise ArithmeticError(found.message)
    return np.asarray(found.y.T)
