"""A motion as it was computed, and how it ended."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from coeflab.kernels.brief import brief
from coeflab.kernels.vehicle_motion import euler_angles, rotations
from coeflab.model import noun_tables
from coeflab.model.frozen import locked, locked_columns

Array = NDArray[np.float64]
STEEPEST = 1e-6


class Ended(StrEnum):
    """How a computation of a motion ended."""

    COMPLETE = "complete"
    NOT_FINITE = "not_finite"
    OUT_OF_RANGE = "out_of_range"
    STEP_TOO_SMALL = "step_too_small"
    TOO_FAST = "too_fast"


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
        u v w p q r through the water at the reference point, FRD, m/s and rad/s.
    heading : (n,) array
        Turned since the start, rad, not wrapped.
    controls : mapping of name to (n,) array
        Angles dr ds db in rad, commands of thrusters in their units, tilts in rad.
    phase : (n,) int array
        Index into ``phases``.
    phases : tuple of str
    reached : tuple of float or None
        Time at which each phase ended by its condition; None where it ended by time, or was never begun.
    outside : mapping of str to (n,) bool array
        For every covered variable, whether the motion is outside of what the coefficients cover.
    ended : Ended
    why : str
        In words, with time and state, where it is not complete.
    statements : tuple of str
        What was assumed.
    """

    time: Array
    position: Array
    attitude: Array
    velocity: Array
    heading: Array
    controls: Mapping[str, Array]
    phase: NDArray[np.int64]
    phases: tuple[str, ...]
    reached: tuple[float | None, ...]
    outside: Mapping[str, NDArray[np.bool_]]
    ended: Ended
    why: str = ""
    statements: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        for name in ("time", "position", "attitude", "velocity", "heading"):
            object.__setattr__(self, name, locked(getattr(self, name)))
        object.__setattr__(self, "phase", locked(self.phase, int))
        object.__setattr__(self, "controls", locked_columns(self.controls))
        object.__setattr__(self, "outside", locked_columns(self.outside, bool))

    @property
    def angles(self) -> Array:
        """(n, 3) roll, pitch and yaw, rad."""
        return euler_angles(np.asarray(self.attitude))

    @property
    def speed(self) -> Array:
        """(n,) through the water, m/s."""
        return np.asarray(np.linalg.norm(self.velocity[:, :3], axis=1))

    @property
    def heading_rate(self) -> Array:
        """(n,) rate of the heading, rad/s: (q sin(phi) + r cos(phi)) / cos(theta) (Fossen 2011, equation 2.28)."""
        roll, pitch, _ = self.angles.T
        turned = self.velocity[:, 4] * np.sin(roll) + self.velocity[:, 5] * np.cos(roll)
        return np.asarray(turned / np.maximum(np.cos(pitch), STEEPEST))

    @property
    def horizontal_speed(self) -> Array:
        """(n,) horizontal part of the speed through the water, m/s."""
        moved = np.einsum("nij,nj->ni", rotations(np.asarray(self.attitude)), self.velocity[:, :3])
        return np.asarray(np.hypot(moved[:, 0], moved[:, 1]))

    def _repr_html_(self) -> str:
        """Beginning, end and range, for notebooks."""
        return noun_tables.motion(self)._repr_html_()

    def until(self, time: float) -> Trajectory:
        """The rows up to a time."""
        n = max(int(np.searchsorted(self.time, time, side="right")), 1)
        rows = {
            name: getattr(self, name)[:n] for name in ("time", "position", "attitude", "velocity", "heading", "phase")
        }
        return replace(
            self, **rows, controls={k: v[:n] for k, v in self.controls.items()},
            outside={k: v[:n] for k, v in self.outside.items()},
        )  # fmt: skip
