"""Small motions about a straight course with the speed held: their eigenvalues against speed, and where they turn unstable.

Feldman (1979) for the equations; the vertical plane has the pitch angle as a state where weight and buoyancy are known,
as its restoring moment does not grow with speed.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from coeflab.core.types import Array, brief, locked
from coeflab.law.symbols import ANGULAR, MOTIONS
from coeflab.motion.approach import along
from coeflab.motion.dynamics import from_euler, linearised, modes
from coeflab.motion.vehicle import Vehicle, vehicle
from coeflab.vehicle.parameter_file import ParameterFile

PLANES = {"G_h": ("v", "r"), "G_v": ("w", "q")}
SLOWEST, FASTEST, SPEEDS = 0.1, 2.0, 39  # of the file's speed, in steps of 0.05
CLOSE = 1e-6  # bisection of a speed at which stability changes


@brief
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
    """

    index: str
    speed: Array
    roots: NDArray[np.complex128]
    at_speed: NDArray[np.complex128]
    critical: float | None
    is_restored: bool
    statement: str

    def __post_init__(self) -> None:
        object.__setattr__(self, "speed", locked(self.speed))
        object.__setattr__(self, "roots", locked(self.roots, complex))
        object.__setattr__(self, "at_speed", locked(self.at_speed, complex))


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
    body = vehicle(parameters, PLANES[index])
    has_angle = index == "G_v" and parameters.hydrostatics is not None
    speed = parameters.conditions.speed * np.linspace(SLOWEST, FASTEST, SPEEDS)
    roots = np.array([roots_at(body, index, float(u), has_angle) for u in speed])
    critical = _critical(body, index, has_angle, speed, roots[:, 0].real) if has_angle else None
    return RootLocus(
        index, speed, roots, roots_at(body, index, parameters.conditions.speed, has_angle), critical, has_angle,
        _statement(index, has_angle, critical, speed),
    )  # fmt: skip


def roots_at(body: Vehicle, index: str, speed: float, has_angle: bool) -> NDArray[np.complex128]:
    """(k,) eigenvalues at a speed, 1/s; with the pitch angle as a state where asked for."""
    at = [MOTIONS.index(m) for m in PLANES[index]]
    nu, still = along(body, speed), np.zeros(6)

    def rates(state: Array) -> Array:
        moved = nu.copy()
        moved[at] = state[: len(at)]
        attitude = from_euler(0.0, float(state[-1]), 0.0) if has_angle else from_euler(0.0, 0.0, 0.0)
        turned = body.acceleration(moved[None, :], attitude[None, :], np.zeros((1, 3)), still)[0, at]
        return np.append(turned, state[len(at) - 1]) if has_angle else turned

    scale = [speed / body.length if MOTIONS[i] in ANGULAR else speed for i in at] + [1.0] * has_angle
    return modes(linearised(rates, np.zeros(len(scale)), np.array(scale)))


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
        return "Nothing restores the heading, so all roots grow in proportion to speed and there is no critical speed."
    if not has_angle:
        return (
            "The file states no hydrostatics, so the restoring moment of weight and buoyancy (BG) is not in it and no critical "
            "speed can be given: these are the roots of the limit of high speed."
        )
    if critical is None:
        return f"No root changes the sign of its real part between {speed[0]:.3g} and {speed[-1]:.3g} m/s."
    return f"The least stable root changes the sign of its real part at {critical:.4g} m/s."
