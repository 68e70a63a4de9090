"""One coefficient of a parameter file, and the covariance of all.

What the parts of the parameter file are made of: numbers within bounds, and models that refuse unknown keys.

Added mass as the parameter file holds it, since version 1.2.

Mass properties as the parameter file holds them.

What makes a body a vehicle, as the parameter file holds it since version 1.3: buoyancy, thrusters, control surfaces.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import AfterValidator, BaseModel, ConfigDict, Field, GetCoreSchemaHandler, model_validator
from pydantic_core import CoreSchema, PydanticCustomError

from coeflab.bodies.triangulation import Triangulation
from coeflab.core.axes import Datum
from coeflab.core.errors import InputError, ScalingMismatchError, shown
from coeflab.core.limits import LARGEST_STORED, positive_number
from coeflab.core.types import brief
from coeflab.core.units import STANDARD_GRAVITY
from coeflab.core.wording import Verbatim
from coeflab.law.added_mass import AddedMass, definiteness
from coeflab.law.rigid_body import inertia_doubt
from coeflab.law.symbols import derivative


def _storable(value: float) -> float:
    if abs(value) > LARGEST_STORED:
        raise PydanticCustomError("bounds", "Input should be a number from {low} to {high}", {
            "low": f"{-LARGEST_STORED:g}", "high": f"{LARGEST_STORED:g}",
        })  # fmt: skip
    return value


def _dividing(value: float) -> float:
    if expected := positive_number(value):
        raise PydanticCustomError("bounds", "Input should be {expected}", {"expected": expected})
    return value


Finite = Annotated[float, Field(allow_inf_nan=False), AfterValidator(_storable)]
Positive = Annotated[float, Field(gt=0.0, allow_inf_nan=False), AfterValidator(_dividing)]
NotNegative = Annotated[float, Field(ge=0.0, allow_inf_nan=False), AfterValidator(_storable)]
Name = Annotated[str, Field(min_length=1, max_length=200)]
Words = Annotated[Name, AfterValidator(Verbatim)]


def _fail_fast(schema: Any) -> None:
    """Let every list of a core schema stop at its first wrong item."""
    if isinstance(schema, dict):
        if schema.get("type") in ("tuple", "list"):
            schema["fail_fast"] = True
        for part in schema.values():
            _fail_fast(part)
    elif isinstance(schema, list):
        for part in schema:
            _fail_fast(part)


@brief
class Strict(BaseModel):
    """A frozen model without unknown keys; of a list the first wrong item is reported, not a million of them."""

    model_config = ConfigDict(extra="forbid", frozen=True, protected_namespaces=())

    @classmethod
    def __get_pydantic_core_schema__(cls, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        schema = handler(source)
        _fail_fast(schema)
        return schema

    def __str__(self) -> str:
        return repr(self)


def told(meaning: str, unit: str = "", since: str = "") -> Any:
    """What a field means, to stand in its ``Annotated``; the schema and its page show it.

    Parameters
    ----------
    meaning : str
    unit : str
        Empty for what has none or states it beside it; ``1`` for primes.
    since : str
        Version of the schema that brought it; empty for that of the table which holds it.
    """
    extra: dict[str, Any] = {name: text for name, text in (("unit", unit), ("since", since)) if text}
    return Field(description=meaning, json_schema_extra=extra or None)


WITHOUT_VALUE = ("no_table", "too_few_points", "not_determined")


class UncertaintyParts(Strict):
    """95 % half-widths that make up U95; null where not assessed."""

    random: Annotated[NotNegative | None, told("scatter of the points", "1")] = None
    model_form: Annotated[NotNegative | None, told("what other forms of the curve would give", "1")] = None
    window: Annotated[NotNegative | None, told("choice of the window, where it is assessed by itself", "1")] = None
    input: Annotated[
        NotNegative | None, told("declared uncertainty of angle, speed, calibration and length; grid error", "1")
    ] = None


class ParameterCoefficient(Strict):
    """One coefficient."""

    symbol: Annotated[
        str, told("SNAME symbol with prime, for example Yv'; |v| is an absolute value, Nrdot' an acceleration")
    ]
    value: Annotated[Finite | None, told("total, potential part included; null where the status gives none", "1")]
    u95: Annotated[NotNegative | None, told("95 % half-width of the value; null where it is not known", "1")]
    unit: Annotated[Literal["1"], told("1: nondimensional by the prime system of `scaling`")]
    value_si: Annotated[Finite | None, told("the value at the density and speed of `conditions`", "see unit_si")]
    unit_si: Annotated[str, told("SI unit of `value_si`, for example N/(m/s)")]
    status: Annotated[
        Literal[
            "ok",
            "no_table",
            "too_few_points",
            "single_estimator",
            "not_determined",
            "stated",
            "form_assumed",
            "form_rejected",
        ],
        told(
            "ok: fitted with U95; single_estimator: fitted, its model-form error unknown; form_assumed (since 1.2): U95 holds "
            "the scatter and what the residuals show that the form leaves out; form_rejected (since 1.3): the residuals show "
            "that the form is wrong, no U95; stated: from the literature; no_table, too_few_points, not_determined: no value"
        ),
    ]
    origin: Annotated[Literal["fit", "literature", "none"], told("where the value comes from")]
    parts: Annotated[UncertaintyParts, told("what makes up U95")]
    table: Annotated[str | None, told("file of the table that it was fitted to")] = None
    campaign: Annotated[str | None, told("campaign of that table")] = None
    estimator: Annotated[str, told("how the value was made, in words")] = ""
    window: Annotated[
        tuple[Finite, Finite] | None,
        told("range of the motion that was used: angles in radians, rates as r' = r L/U", "rad or 1"),
    ] = None
    n_points: Annotated[int, Field(ge=0), told("points in that range")] = 0
    citation: Annotated[str, told("keys of works, separated by commas")] = ""
    law: Annotated[
        Literal["motion", "rest"],
        told(
            "motion: the force goes with 1/2 rho U^(2-n) for n motion variables; rest: value_si times the velocities "
            "whatever U is, damping about a state of rest",
            since="1.2",
        ),
    ] = "motion"
    potential: Annotated[
        Finite | None,
        told("part of the value that -C_A(nu) nu gives, by `added_mass`; the rest is viscous", "1", since="1.2"),
    ] = None

    @model_validator(mode="after")
    def _honest(self) -> ParameterCoefficient:
        if not self.symbol.endswith("'"):
            raise ValueError(f"{self.symbol}: a symbol without prime; write {self.symbol}'")
        try:
            derivative(self.symbol)
        except InputError as why:
            raise ValueError(str(why)) from None
        if (self.value is None) != (self.status in WITHOUT_VALUE):
            raise ValueError(f"{self.symbol}: value {self.value} does not go with status {self.status}")
        if self.u95 is not None and self.value is None:
            raise ValueError(f"{self.symbol}: an interval without a value")
        return self


class ParameterCovariance(Strict):
    """Covariance of standard uncertainties (U95 / 2), primed; rows of coefficients without U95 are null."""

    symbols: Annotated[tuple[str, ...], told("coefficients in the order of rows and columns")]
    matrix: Annotated[tuple[tuple[Finite | None, ...], ...], told("symmetric; the variance is (u95 / 2)^2", "1")]

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


Row = tuple[Finite, Finite, Finite, Finite, Finite, Finite]
Matrix = tuple[Row, Row, Row, Row, Row, Row]


class OtherMethod(Strict):
    """The same matrix by another method, to be compared with."""

    method: Annotated[Name, told("name of the method")]
    matrix: Annotated[Matrix, told("as that of `added_mass`", "kg, kg m, kg m^2")]


class ParameterAddedMass(Strict):
    """M_A, positive, FRD, about the file's reference point; acceleration derivatives are its negatives."""

    body: Annotated[Words, told("whose shape it was computed from")]
    method: Annotated[Name, told("how; stated where it was read from somebody's model")]
    density: Annotated[Positive, told("density of the water that the matrix holds for", "kg/m^3")]
    matrix: Annotated[
        Matrix,
        told(
            "rows X Y Z K M N, columns of the accelerations du dv dw dp dq dr; symmetric, positive", "kg, kg m, kg m^2"
        ),
    ]
    others: Annotated[tuple[OtherMethod, ...], told("the same by other methods, to be compared with")] = ()
    statements: Annotated[tuple[str, ...], told("assumptions and limits of the method, in words")] = ()

    @model_validator(mode="after")
    def _kinetic_energy(self) -> ParameterAddedMass:
        found = definiteness(np.array(self.matrix))
        if not found.holds:
            raise ValueError(
                f"the added mass by {self.method} is no kinetic energy: asymmetric by {found.asymmetry:.1e}, smallest "
                f"scaled eigenvalue {found.smallest:.1e}"
            )
        return self

    def as_noun(self, point: Sequence[float], datum: Datum) -> AddedMass:
        """The matrix in use, about the file's reference point."""
        return AddedMass(np.array(self.matrix), np.array(point), datum, self.body, self.method, self.statements)


def added_mass_record(found: Triangulation, point: np.ndarray, datum: Datum, vehicle: str = "") -> ParameterAddedMass:
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
    return ParameterAddedMass.model_validate(
        {
            "body": vehicle or chosen.body,
            "method": chosen.method,
            "density": found.density,
            "matrix": _rows(chosen, point),
            "others": tuple({"method": o.method, "matrix": _rows(o, point)} for o in others if o.definiteness.holds),
            "statements": chosen.statements,
        }
    )


def _rows(found: AddedMass, point: np.ndarray) -> tuple[tuple[float, ...], ...]:
    """Symmetric, to ten digits of the diagonal: what is below differs from one machine to the next."""
    matrix = found.about(point).matrix
    diagonal = np.diag(matrix)
    cut = 1e-10 * np.sqrt(np.outer(diagonal, diagonal))
    return tuple(
        tuple(float(f"{v:.10g}") if abs(v) > c else 0.0 for v, c in zip(row, least, strict=True))
        for row, least in zip((matrix + matrix.T) / 2.0, cut, strict=True)
    )


Triple = tuple[Finite, Finite, Finite]


class ParameterMass(Strict):
    """Mass properties about the reference point."""

    mass: Annotated[Positive, told("mass m of the body", "kg")]
    mass_moment: Annotated[Finite, told("x_G m, positive forward", "kg m")]
    inertia: Annotated[Positive | None, told("transverse, Iy = Iz", "kg m^2")] = None
    mass_prime: Annotated[Positive, told("m / (1/2 rho L^3)", "1")]
    mass_moment_prime: Annotated[Finite, told("x_G m / (1/2 rho L^4)", "1")]
    centre: Annotated[
        Triple | None, told("centre of gravity from the reference point, x y z, FRD", "m", since="1.2")
    ] = None
    inertia_matrix: Annotated[
        tuple[Triple, Triple, Triple] | None,
        told("about the reference point, FRD; products with their sign in the matrix", "kg m^2", since="1.2"),
    ] = None

    @model_validator(mode="after")
    def _of_a_body(self) -> ParameterMass:
        if self.inertia_matrix is not None and self.centre is None:
            raise ValueError("an inertia matrix without the centre of gravity")
        if self.centre is not None:
            moment = self.mass * self.centre[0]
            if not math.isclose(moment, self.mass_moment, rel_tol=1e-6, abs_tol=1e-9 * self.mass):
                raise ValueError(f"mass_moment {self.mass_moment:g} is not m x_G, {moment:g}")
        if self.inertia_matrix is not None and self.centre is not None:
            why = inertia_doubt(self.mass, np.array(self.centre), np.array(self.inertia_matrix))
            if why:
                raise ValueError(why)
        return self


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
