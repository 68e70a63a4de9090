"""Parts of the parameter file that are no nouns of the law: covariance, buoyancy, thrusters, control surfaces.

The models refuse unknown keys. What makes a body a vehicle is in the file since version 1.3.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, GetCoreSchemaHandler, model_validator
from pydantic_core import CoreSchema

from coeflab.core.axes import Datum
from coeflab.core.errors import ScalingMismatchError, shown
from coeflab.core.stored import Finite, Means, Name, Positive, RefusedError, Words, fail_fast
from coeflab.core.types import brief
from coeflab.core.units import STANDARD_GRAVITY
from coeflab.law.added_mass import AddedMass, OtherMethod
from coeflab.law.definiteness import definiteness

if TYPE_CHECKING:
    from coeflab.bodies.thrusters import Squares
    from coeflab.bodies.triangulation import Triangulation


@brief
class Strict(BaseModel):
    """A frozen model without unknown keys; of a list the first wrong item is reported, not a million of them."""

    model_config = ConfigDict(extra="forbid", frozen=True, protected_namespaces=())

    @classmethod
    def __get_pydantic_core_schema__(cls, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        schema = handler(source)
        fail_fast(schema)
        return schema

    def __str__(self) -> str:
        return repr(self)


class ParameterCovariance(Strict):
    """Covariance of standard uncertainties (U95 / 2), primed; rows of coefficients without U95 are null."""

    symbols: Annotated[tuple[str, ...], Means("coefficients in the order of rows and columns")]
    matrix: Annotated[tuple[tuple[Finite | None, ...], ...], Means("symmetric; the variance is (u95 / 2)^2", "1")]

    @model_validator(mode="after")
    def _square(self) -> ParameterCovariance:
        k = len(self.symbols)
        if len(self.matrix) != k or any(len(row) != k for row in self.matrix):
            raise ValueError(f"the covariance of {k} coefficients must be {k} x {k}")
        if len(set(self.symbols)) != k:
            raise ValueError("the covariance names a coefficient twice")
        for i, row in enumerate(self.matrix):
            for j, value in enumerate(row):
                other = self.matrix[j][i]
                if (value is None) != (other is None):
                    raise ValueError("the covariance is not symmetric")
                rounding = 1e-12 * max(abs(v) for v in (row[i], self.matrix[j][j], 0.0) if v is not None)
                if (
                    value is not None
                    and other is not None
                    and not math.isclose(value, other, rel_tol=1e-9, abs_tol=rounding)
                ):
                    raise ValueError("the covariance is not symmetric")
            diagonal = row[i]
            if diagonal is not None and diagonal < 0.0:
                raise ValueError(f"the variance of {self.symbols[i]} is negative")
        return self


def added_mass_record(found: Triangulation, point: np.ndarray, datum: Datum, vehicle: str = "") -> AddedMass:
    """The added mass of a file, the recommended method and the others about its reference point.

    Parameters
    ----------
    found : Triangulation
    point : (3,) array
    datum : Datum
        Of the file.
    vehicle : str
        Whose body the shape is; empty: that of its own name.

    Raises
    ------
    ScalingMismatchError
        The body measures points from another datum.
    """
    chosen, *others = found.ordered
    if chosen.datum != datum:
        raise ScalingMismatchError(
            f"the added mass of {chosen.body} is stated from {shown(chosen.datum.id)}, the parameter file from {shown(datum.id)}; "
            "give both the same datum."
        )
    rounded = [OtherMethod(o.method, _rounded(o, point)) for o in others]
    return AddedMass(
        _rounded(chosen, point), point, datum, vehicle or chosen.body, chosen.method, chosen.statements, density=found.density,
        others=tuple(o for o in rounded if definiteness(o.matrix).holds), u95=_half_widths(chosen, point),
    )  # fmt: skip


def _half_widths(found: AddedMass, point: np.ndarray) -> np.ndarray | None:
    """Of a rough guide, to three digits."""
    half = found.about(point).u95
    return None if half is None else np.array([float(f"{v:.3g}") for v in half.ravel()]).reshape(6, 6)


def _rounded(found: AddedMass, point: np.ndarray) -> np.ndarray:
    """Symmetric, to ten digits of the diagonal: what is below differs from one machine to the next.

    A motion that moves no water, such as the roll of a body of revolution, has a row of zeros and not of rounding errors.
    """
    matrix = found.about(point).matrix
    diagonal = np.diag(matrix)
    cut = 1e-10 * np.sqrt(np.abs(np.outer(diagonal, diagonal)))
    selected = [float(f"{v:.10g}") for v in ((matrix + matrix.T) / 2.0).ravel()]
    out = np.where(np.abs((matrix + matrix.T) / 2.0) > cut, np.reshape(selected, (6, 6)), 0.0)
    still = np.abs(diagonal) <= STILL * np.repeat([np.max(np.abs(diagonal[:3])), np.max(np.abs(diagonal[3:]))], 3)
    out[still, :] = out[:, still] = 0.0
    return out


Triple = tuple[Finite, Finite, Finite]


Control = Literal["dr", "ds", "db"]
THRUST = "thrust"  # command of a force along x, N
UNIT_LENGTH = 1e-6
FALL = 1e-9
STILL = 1e-20  # of the largest entry of its kind: the square of what rounding leaves of a lever


class ParameterHydrostatics(Strict):
    """Buoyancy and gravity."""

    volume: Annotated[Positive, Means("displaced volume; the buoyancy is rho g V", "m^3")]
    centre_of_buoyancy: Annotated[Triple, Means("from the reference point, x y z, FRD", "m")]
    gravity: Annotated[Positive, Means("g", "m/s^2")] = STANDARD_GRAVITY


class CurveSegment(Strict):
    """A polynomial between two commands."""

    low: Annotated[Finite, Means("lowest command", "of the command")]
    high: Annotated[Finite, Means("highest command", "of the command")]
    coefficients: Annotated[
        tuple[Finite, ...],
        Field(min_length=1, max_length=12),
        Means("c0 c1 c2 ..: the sum of c_k command^k", "N or N m"),
    ]

    def at(self, command: float) -> float:
        """Value of the polynomial."""
        return math.fsum(c * command**k for k, c in enumerate(self.coefficients))

    @model_validator(mode="after")
    def _ordered(self) -> CurveSegment:
        if not self.low < self.high:
            raise ValueError(f"a segment from {self.low:g} to {self.high:g}")
        return self


class ParameterCurve(Strict):
    """Thrust or torque over the command; zero between segments, which is a dead zone."""

    command: Annotated[Name, Means("what is commanded, for example speed or duty")]
    unit: Annotated[Name, Means("of the command, for example rpm, % or 1")]
    segments: Annotated[tuple[CurveSegment, ...], Field(min_length=1), Means("in rising order, none over another")]

    @model_validator(mode="after")
    def _apart(self) -> ParameterCurve:
        for a, b in zip(self.segments, self.segments[1:], strict=False):
            if b.low < a.high:
                raise ValueError(f"segments up to {a.high:g} and from {b.low:g} {self.unit} lie over each other")
        return self

    @property
    def low(self) -> float:
        """Lowest command."""
        return self.segments[0].low

    @property
    def high(self) -> float:
        """Highest command."""
        return self.segments[-1].high

    def at(self, command: float) -> float:
        """Value at a command; zero in a dead zone. Outside of the segments it is that of the nearest one's end."""
        inside = min(max(command, self.low), self.high)
        for s in self.segments:
            if s.low <= inside <= s.high:
                return s.at(inside)
        return 0.0

    def falls_at(self) -> float | None:
        """A command at which the value falls while the command rises; None where it never does."""
        last = -math.inf
        for s in self.segments:
            for i in range(65):
                command = s.low + (s.high - s.low) * i / 64
                value = s.at(command)
                if value < last - FALL * max(1.0, abs(last)):
                    return command
                last = value
        return None


def curve_of(squares: Sequence[Squares], command: str, unit: str) -> ParameterCurve | None:
    """A curve of forces with the square of the command; None of none."""
    if not squares:
        return None
    segments = tuple(CurveSegment(low=s.low, high=s.high, coefficients=(0.0, 0.0, s.per_square)) for s in squares)
    return ParameterCurve(command=command, unit=unit, segments=segments)


class ParameterThruster(Strict):
    """A thruster, fixed or tilting."""

    name: Annotated[Words, Means("for commands: `name` and `name.tilt`")]
    position: Annotated[Triple, Means("from the reference point, x y z, FRD", "m")]
    direction: Annotated[Triple, Means("of positive thrust at no tilt, of length one, FRD", "1")]
    curve: Annotated[ParameterCurve, Means("thrust over the command; must not fall", "N")]
    torque_curve: Annotated[
        ParameterCurve | None, Means("torque of the water on the rotor, below zero where it turns astern", "N m")
    ] = None
    handedness: Annotated[
        Literal[-1, 1], Means("reaction torque on the vehicle: handedness times torque, about `direction`")
    ] = 1
    tilt_axis: Annotated[
        Triple | None, Means("axis that the direction turns about, right-handed, of length one; null: fixed", "1")
    ] = None
    tilt_low: Annotated[Finite, Means("lowest tilt", "rad")] = 0.0
    tilt_high: Annotated[Finite, Means("highest tilt", "rad")] = 0.0
    lag: Annotated[
        Positive | None,
        Means("T of T d(actual)/dt = command - actual; curves read actual; null: at once", "s", since="1.7"),
    ] = None

    @model_validator(mode="after")
    def _consistent(self) -> ParameterThruster:
        if self.name == THRUST:
            raise RefusedError(
                f"a thruster named {THRUST}", f"another name: the command {THRUST} is newtons along x", where=("name",)
            )
        for what, axis in (("direction", self.direction), ("tilt_axis", self.tilt_axis)):
            if axis is not None and abs(math.hypot(*axis) - 1.0) > UNIT_LENGTH:
                raise ValueError(f"{self.name}: {what} is {math.hypot(*axis):g} long, not 1")
        falls = self.curve.falls_at()
        if falls is not None:
            raise ValueError(f"{self.name}: thrust falls at a command of {falls:g} {self.curve.unit}; it must not")
        if self.tilt_low > self.tilt_high or (self.tilt_axis is None and self.tilt_high != self.tilt_low):
            raise ValueError(f"{self.name}: tilt from {self.tilt_low:g} to {self.tilt_high:g} rad without room or axis")
        return self


class ParameterSurface(Strict):
    """Limits of a control surface; its forces are derivatives or tables by ``dr``, ``ds`` or ``db``.

    Their signs say what a positive angle does. Bodies have hinge [0, 1, 0], trailing edges down; notes say what differs.
    """

    control: Annotated[Control, Means("dr rudder, ds stern planes, db bow planes")]
    limit: Annotated[Positive, Means("largest angle either way", "rad")]
    rate: Annotated[Positive | None, Means("rate of the angle; null: at once", "rad/s")] = None
