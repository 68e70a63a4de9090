"""Where motions under constant thrust settle: many at once, by steps in pseudo-time that end as Newton's.

Kelley & Keyes, SIAM J. Numerical Analysis 35(2), 1998. Implicit steps follow the motion while they are short and grow as the
forces vanish, so that what is found is what the vehicle would reach from the start, and nothing fails at rest, where forces
that go with the square of the speed lose their slope.

Steady motions of a vehicle on a level course: where it settles under constant commands.

Steady turns of a vehicle in the horizontal plane that is steered by the difference of two thrusts.

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

Small motions about a straight course with the speed held: their eigenvalues against speed, and where they turn unstable.

Feldman (1979) for the equations; the vertical plane has the pitch angle as a state where weight and buoyancy are known,
as its restoring moment does not grow with speed.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import field

import numpy as np
from numpy.typing import NDArray

from coeflab.core.texts import input_error, text_of
from coeflab.core.types import Array, dataclass, locked
from coeflab.law.symbols import ANGULAR, COMPONENTS, MOTIONS, primed
from coeflab.motion.approach import along
from coeflab.motion.dynamics import STEP, from_euler, modes
from coeflab.motion.vehicle import PLANES, Vehicle, vehicle
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.stability import SEED

STEPS = 200
TOLERANCE = 1e-11
ENOUGH = 1e-8
FIRST_STEP, SHORTEST, LONGEST = 0.5, 0.02, 1e12
NUDGE = 1e-6


def settled(
    forces: Callable[[Array], Array],
    inertia: Array,
    start: Array,
    scale: Array,
    slopes: Callable[[Array], Array] | None = None,
) -> tuple[Array, NDArray[np.bool_]]:
    """Velocities at which all forces vanish.

    Parameters
    ----------
    forces : callable
        (n, f) velocities -> (n, f) forces in the directions that are free, thrust and Coriolis forces included.
    inertia : (f, f) array
        Rigid body and added mass.
    start : (n, f) array
    scale : (n,) array
        Force that counts as large, such as the thrust.
    slopes : callable, optional
        (n, f) -> (n, f, f) exact derivatives of the forces; central differences by default.

    Returns
    -------
    velocities : (n, f) array
        NaN where the march came to no rest.
    found : (n,) bool array
    """
    x = np.array(start, dtype=float)
    steep = slopes or (lambda at: differences(forces, at))
    pace, last = np.full(len(x), FIRST_STEP), np.full(len(x), np.nan)
    with np.errstate(invalid="ignore", over="ignore"):
        for _ in range(STEPS):
            wrong = forces(x)
            size = np.linalg.norm(wrong, axis=1) / scale
            moving = np.isfinite(size) & (size > TOLERANCE)
            if not np.any(moving):
                break
            # Longer steps as the forces fall, shorter ones where they rise.
            pace = pace * np.clip(np.nan_to_num(last / np.maximum(size, 1e-300), nan=1.0), 0.5, 10.0)
            pace, last = np.clip(pace, SHORTEST, LONGEST), size
            slope = steep(x)
            # An implicit step longer than a disturbance takes to grow would run back to an unstable rest.
            rise = np.nan_to_num(growth(inertia, slope))
            pace = np.where(rise > 0.0, np.minimum(pace, 0.5 / np.where(rise > 0.0, rise, 1.0)), pace)
            matrix = inertia / pace[moving, None, None] - slope[moving]
            x[moving] += _solved(matrix, wrong[moving])
        size = np.linalg.norm(forces(x), axis=1) / scale
    found = np.isfinite(size) & (size <= ENOUGH)
    return np.where(found[:, None], x, np.nan), np.asarray(found)


def _solved(matrix: Array, wrong: Array) -> Array:
    """Steps; NaN for those of a row whose equations say the same or are not finite."""
    fit = np.asarray(np.isfinite(matrix).all(axis=(1, 2)))
    fit[fit] = np.linalg.cond(matrix[fit]) < 1.0 / np.finfo(float).eps
    out = np.full_like(wrong, np.nan)
    out[fit] = np.linalg.solve(matrix[fit], wrong[fit][..., None])[..., 0]
    return out


def differences(forces: Callable[[Array], Array], x: Array) -> Array:
    """(n, f, f) central differences of the forces by the velocities, in one call."""
    n, f = x.shape
    nudged = x[None] + NUDGE * np.concatenate([np.eye(f), -np.eye(f)])[:, None, :]
    found = forces(nudged.reshape(-1, f)).reshape(2, f, n, -1)
    return np.moveaxis((found[0] - found[1]) / (2.0 * NUDGE), 0, -1)


def growth(inertia: Array, slopes: Array) -> Array:
    """(n,) largest rate at which a small disturbance of each motion grows, 1/s; negative where all die out."""
    sound = np.isfinite(slopes).all(axis=(1, 2))
    out = np.full(len(slopes), np.nan)
    out[sound] = np.linalg.eigvals(np.linalg.solve(inertia, slopes[sound])).real.max(axis=1)
    return out


SLOW = 0.1  # of the file's speed: a course to start from, ahead and not at rest, where damping has no slope
TINY = 1e-9  # N, the size of a force where no thruster pushes


def wrenches(moved: Vehicle, commands: Sequence[Mapping[str, float]]) -> Array:
    """(n, 6) forces of the thrusters for n sets of commands."""
    return np.array([moved.wrench(one) for one in commands]).reshape(-1, 6)


def steady_motions(moved: Vehicle, thrust: Array, controls: Array | None = None) -> tuple[Array, NDArray[np.bool_]]:
    """Velocities at which a level vehicle settles from a slow course ahead.

    Parameters
    ----------
    moved : Vehicle
        Free in some of u, v and r.
    thrust : (n, 6) array
        Of the thrusters.
    controls : (n, 3) array, optional
        dr ds db, rad; zero by default.

    Returns
    -------
    velocities : (n, 6) array
        NaN where it settles nowhere.
    found : (n,) bool array

    Raises
    ------
    InputError
        A motion out of the horizontal plane is free.
    """
    level = PLANES["horizontal"]
    if not set(moved.free) <= set(level):
        raise input_error(
            "motion.steady_turns_sought", column="free", free=", ".join(m for m in moved.free if m not in level),
            level=" ".join(level),
        )  # fmt: skip
    n, at = len(thrust), list(moved.free_columns)
    angles = np.zeros((n, 3)) if controls is None else controls
    size = np.linalg.norm(thrust, axis=1)
    start = np.zeros((n, len(at)))
    if "u" in moved.free:
        start[:, moved.free.index("u")] = np.where(size > 0.0, SLOW * moved.speed, 0.0)

    def forces(x: Array) -> Array:
        return level_forces(moved, x, thrust, angles)

    x, found = settled(forces, moved.effective_mass[np.ix_(at, at)], start, np.maximum(size, TINY))
    out = np.zeros((n, 6))
    out[:, at] = x
    return out, found


def level_forces(moved: Vehicle, velocities: Array, thrust: Array, controls: Array) -> Array:
    """Forces that are left along the free motions of a level vehicle.

    Parameters
    ----------
    moved : Vehicle
    velocities : (k n, f) array
        Of the free motions, k times the same n cases.
    thrust : (n, 6) array
    controls : (n, 3) array

    Returns
    -------
    (k n, f) array
    """
    repeats = len(velocities) // len(thrust)
    at = list(moved.free_columns)
    nu = np.zeros((len(velocities), 6))
    nu[:, at] = velocities
    upright = np.tile((1.0, 0.0, 0.0, 0.0), (len(nu), 1))
    rates = moved.acceleration(nu, upright, np.tile(controls, (repeats, 1)), np.tile(thrust, (repeats, 1)))
    return np.asarray(rates[:, at] @ moved.effective_mass[np.ix_(at, at)].T)


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


PLANE_OF = {"G_h": ("v", "r"), "G_v": ("w", "q")}
SLOWEST_SHARE, FASTEST, SPEEDS = 0.1, 2.0, 39  # of the file's speed, in steps of 0.05
CLOSE = 1e-6  # bisection of a speed at which stability changes
DRAWN, SHARE_WITHOUT = 1000, 0.025


@dataclass(frozen=True, slots=True, eq=False)
class RootLocus:
    """Eigenvalues of one plane over speed.

    Attributes
    ----------
    index : {"G_h", "G_v"}
        The plane.
    speed : (n,) array
        m/s.
    roots : (n, k) complex array
        1/s, the least stable first.
    at_speed : (k,) complex array
        At the speed of the file.
    critical : float or None
        Speed at which the least stable root changes its sign, m/s; None where none does.
    is_restored : bool
        Whether weight and buoyancy are in it.
    statement : str
        What is in it, and what a critical speed would need.
    lacking : tuple of str
        Accelerations of the plane that no added mass is known of: with the rigid body alone the roots are those in air.
    drawn : (n,) array
        The critical speed by draws of the four derivatives, not a number where a draw has none; empty without their covariance.
    """

    index: str
    speed: Array
    roots: NDArray[np.complex128]
    at_speed: NDArray[np.complex128]
    critical: float | None
    is_restored: bool
    statement: str
    lacking: tuple[str, ...] = ()
    drawn: Array = field(default_factory=lambda: np.empty(0))

    def __post_init__(self) -> None:
        object.__setattr__(self, "speed", locked(self.speed))
        object.__setattr__(self, "roots", locked(self.roots, complex))
        object.__setattr__(self, "at_speed", locked(self.at_speed, complex))
        object.__setattr__(self, "drawn", locked(self.drawn))

    @property
    def limits(self) -> tuple[float, float] | None:
        """95 % limits of the critical speed, m/s; None without draws, or where more than the half of 5 % of them have none."""
        found = np.isfinite(self.drawn)
        if not found.size or np.mean(~found) > SHARE_WITHOUT:
            return None
        low, high = np.quantile(self.drawn[found], (SHARE_WITHOUT, 1.0 - SHARE_WITHOUT))
        return float(low), float(high)


def root_locus(parameters: ParameterFile, index: str) -> RootLocus:
    """Roots from a tenth of the file's speed to twice that.

    Parameters
    ----------
    parameters : ParameterFile
        With mass, inertia and the four velocity derivatives of the plane.
    index : {"G_h", "G_v"}

    Raises
    ------
    InputError
        No mass, no inertia, or an effective mass that is not positive.
    """
    body = vehicle(parameters, PLANE_OF[index])
    has_angle = index == "G_v" and parameters.hydrostatics is not None
    speed = parameters.conditions.speed * np.linspace(SLOWEST_SHARE, FASTEST, SPEEDS)
    matrices = np.array([_matrix_at(body, index, float(u), has_angle) for u in speed])
    roots = np.array([modes(one) for one in matrices])
    critical = _critical(body, index, has_angle, speed, roots[:, 0].real) if has_angle else None
    at = [MOTIONS.index(m) for m in PLANE_OF[index]]
    lacking = tuple(f"{COMPONENTS[i]}{MOTIONS[i]}dot'" for i in at if body.water.matrix[i, i] <= 0.0)
    drawn = _drawn(parameters, body, at, speed, matrices) if critical is not None and not lacking else np.empty(0)
    return RootLocus(
        index, speed, roots, roots_at(body, index, parameters.conditions.speed, has_angle), critical, has_angle,
        _statement(index, has_angle, critical, speed), lacking, drawn,
    )  # fmt: skip


def _drawn(parameters: ParameterFile, body: Vehicle, at: Sequence[int], speed: Array, matrices: Array) -> Array:
    """Critical speeds (n,) of draws of Zw', Zq', Mw', Mq' with their covariance; empty where they have none."""
    symbols = [primed(f"{COMPONENTS[i]}{MOTIONS[j]}") for i in at for j in at]
    place = {s: i for i, s in enumerate(parameters.covariance.symbols)}
    rows = [place.get(s) for s in symbols]
    cells = [[None if i is None or j is None else parameters.covariance.matrix[i][j] for j in rows] for i in rows]
    covariance = np.array([[np.nan if v is None else v for v in row] for row in cells])
    if not np.all(np.isfinite(covariance)):
        return np.empty(0)
    draws = np.random.default_rng(SEED).multivariate_normal(np.zeros(4), covariance, DRAWN, method="eigh")
    units = [parameters.scaling.unit(s, parameters.conditions.density, parameters.conditions.speed) for s in symbols]
    forces = (draws * units / parameters.conditions.speed).reshape(-1, 2, 2)  # by speed ahead
    rates = np.linalg.inv(body.effective_mass[np.ix_(at, at)]) @ forces
    rest = ((0, 0), (0, matrices.shape[1] - 2), (0, matrices.shape[2] - 2))
    rates = np.pad(rates, rest)
    growth = [np.linalg.eigvals(m + u * rates).real.max(axis=-1) for m, u in zip(matrices, speed, strict=True)]
    return first_zero(speed, np.stack(growth, axis=1))


def first_zero(at: Array, values: Array) -> Array:
    """Where rows of values (n, k) first change their sign between the places (k,), by straight lines; not a number where none does."""
    turns = np.sign(values[:, 1:]) != np.sign(values[:, :-1])
    i, rows = np.argmax(turns, axis=1), np.arange(len(values))
    low, high = values[rows, i], values[rows, i + 1]
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(turns.any(axis=1), at[i] + (at[i + 1] - at[i]) * low / (low - high), np.nan)


def roots_at(body: Vehicle, index: str, speed: float, has_angle: bool) -> NDArray[np.complex128]:
    """(k,) eigenvalues at a speed, 1/s; with the pitch angle as a state where asked for."""
    return modes(_matrix_at(body, index, speed, has_angle))


def _matrix_at(body: Vehicle, index: str, speed: float, has_angle: bool) -> Array:
    """(k, k) of small motions at a speed."""
    at = [MOTIONS.index(m) for m in PLANE_OF[index]]
    nu, still = along(body, speed), np.zeros(6)

    scale = np.array([speed / body.length if MOTIONS[i] in ANGULAR else speed for i in at] + [1.0] * has_angle)
    states = np.vstack([np.diag(STEP * scale), -np.diag(STEP * scale)])  # central differences, all at once
    moved = np.tile(nu, (len(states), 1))
    moved[:, at] = states[:, : len(at)]
    pitch = states[:, -1] if has_angle else np.zeros(len(states))
    attitude = np.array([from_euler(0.0, float(angle), 0.0) for angle in pitch])
    rates = body.acceleration(moved, attitude, np.zeros((len(states), 3)), still)[:, at]
    if has_angle:
        rates = np.column_stack([rates, states[:, len(at) - 1]])
    ahead, back = np.split(rates, 2)
    return np.asarray(((ahead - back) / (2.0 * STEP * scale)[:, None]).T)


def _critical(body: Vehicle, index: str, has_angle: bool, speed: Array, growth: Array) -> float | None:
    """The lowest speed at which the growth changes its sign, by bisection."""
    turns = np.flatnonzero(np.sign(growth[1:]) != np.sign(growth[:-1]))
    if not len(turns):
        return None
    low, high = float(speed[turns[0]]), float(speed[turns[0] + 1])
    below = growth[turns[0]] > 0.0
    while high - low > CLOSE * high:
        middle = (low + high) / 2.0
        if (roots_at(body, index, middle, has_angle)[0].real > 0.0) == below:
            low = middle
        else:
            high = middle
    return (low + high) / 2.0


def _statement(index: str, has_angle: bool, critical: float | None, speed: Array) -> str:
    if index == "G_h":
        return "No restoring moment acts on the heading: all roots are proportional to speed, so there is no critical speed."
    if not has_angle:
        return text_of("motion.no_hydrostatics")
    if critical is None:
        return f"No root changes the sign of its real part between {speed[0]:.3g} and {speed[-1]:.3g} m/s."
    return f"The least stable root changes the sign of its real part at {critical:.4g} m/s."
