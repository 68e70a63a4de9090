"""Small motions about a straight course with the speed held: their eigenvalues against speed, and where they turn unstable.

Feldman (1979) for the equations; the vertical plane has the pitch angle as a state where weight and buoyancy are known,
as its restoring moment does not grow with speed.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import field

import numpy as np
from numpy.typing import NDArray

from coeflab.core.texts import text_of
from coeflab.core.types import Array, dataclass, locked
from coeflab.law.symbols import ANGULAR, COMPONENTS, MOTIONS, primed
from coeflab.motion.approach import along
from coeflab.motion.dynamics import from_euler
from coeflab.motion.small_motions import STEP, modes
from coeflab.motion.vehicle import Vehicle, vehicle
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.stability import SEED

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
    lacking = lacking_accelerations(body, at)
    drawn = _drawn(parameters, body, at, speed, matrices) if critical is not None and not lacking else np.empty(0)
    return RootLocus(
        index, speed, roots, roots_at(body, index, parameters.conditions.speed, has_angle), critical, has_angle,
        _statement(index, has_angle, critical, speed), lacking, drawn,
    )  # fmt: skip


def lacking_accelerations(body: Vehicle, at: Sequence[int]) -> tuple[str, ...]:
    """Accelerations of the motions at these columns that no added mass is known of."""
    return tuple(f"{COMPONENTS[i]}{MOTIONS[i]}dot'" for i in at if body.water.matrix[i, i] <= 0.0)


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
