"""What makes a body a vehicle, as the parameter file holds it since version 1.3: buoyancy, thrusters, control surfaces."""

from __future__ import annotations

import math
from typing import Annotated, Literal

from pydantic import Field, model_validator

from coeflab.core.units import STANDARD_GRAVITY
from coeflab.model.schema_types import Finite, Name, Positive, Strict, Words, told

Triple = tuple[Finite, Finite, Finite]
Control = Literal["dr", "ds", "db"]
UNIT_LENGTH = 1e-6
FALL = 1e-9


class ParameterHydrostatics(Strict):
    """Buoyancy and gravity."""

    volume: Annotated[Positive, told("displaced volume; the buoyancy is rho g V", "m^3")]
    centre_of_buoyancy: Annotated[Triple, told("from the reference point, x y z, FRD", "m")]
    gravity: Annotated[Positive, told("g", "m/s^2")] = STANDARD_GRAVITY


class CurveSegment(Strict):
    """A polynomial between two commands."""

    low: Annotated[Finite, told("lowest command", "of the command")]
    high: Annotated[Finite, told("highest command", "of the command")]
    coefficients: Annotated[
        tuple[Finite, ...],
        Field(min_length=1, max_length=12),
        told("c0 c1 c2 ..: the sum of c_k command^k", "N or N m"),
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

    command: Annotated[Name, told("what is commanded, for example speed or duty")]
    unit: Annotated[Name, told("of the command, for example rpm, % or 1")]
    segments: Annotated[tuple[CurveSegment, ...], Field(min_length=1), told("in rising order, none over another")]

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


class ParameterThruster(Strict):
    """A thruster, fixed or tilting."""

    name: Annotated[Words, told("for commands: `name` and `name.tilt`")]
    position: Annotated[Triple, told("from the reference point, x y z, FRD", "m")]
    direction: Annotated[Triple, told("of positive thrust at no tilt, of length one, FRD", "1")]
    curve: Annotated[ParameterCurve, told("thrust over the command; must not fall", "N")]
    torque_curve: Annotated[ParameterCurve | None, told("torque of the water on the rotor, positive", "N m")] = None
    handedness: Annotated[
        Literal[-1, 1], told("reaction torque on the vehicle: handedness times torque, about `direction`")
    ] = 1
    tilt_axis: Annotated[
        Triple | None, told("axis that the direction turns about, right-handed, of length one; null: fixed", "1")
    ] = None
    tilt_low: Annotated[Finite, told("lowest tilt", "rad")] = 0.0
    tilt_high: Annotated[Finite, told("highest tilt", "rad")] = 0.0

    @model_validator(mode="after")
    def _consistent(self) -> ParameterThruster:
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
    """Limits of a control surface; its forces are the derivatives by ``dr``, ``ds`` or ``db``."""

    control: Annotated[Control, told("dr rudder, ds stern planes, db bow planes")]
    limit: Annotated[Positive, told("largest angle either way", "rad")]
    rate: Annotated[Positive | None, told("rate of the angle; null: at once", "rad/s")] = None
