"""The parameter file: JSON, one body, one scaling, one reference point.

Version 1.1: 1.0 and fitted tables. Version 1.2: what the half-widths of these hold, the status ``form_assumed``, added mass
and the potential part of every coefficient, the centre of gravity and the inertia matrix.

The models below are the schema; ``parameter_file.schema.json`` beside them is generated from them.
"""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Field, ValidationError, model_validator

from coeflab.core.errors import CoeflabError, InputError, shown
from coeflab.core.symbols import derivative
from coeflab.core.toml import read_text
from coeflab.kernels.rigid_body import inertia_doubt
from coeflab.model.parameter_added_mass import ParameterAddedMass
from coeflab.model.parameter_model import ParameterModel
from coeflab.model.scaling import Conditions, Scaling
from coeflab.model.schema_types import Finite, Name, NotNegative, Positive, Strict

SCHEMA_VERSION = "1.2"
FIRST_VERSION = "1.0"
LARGEST = 64 << 20
SCHEMA_FILE = Path(__file__).with_name("parameter_file.schema.json")


class UncertaintyParts(Strict):
    """95 % half-widths that make up U95; null where not assessed."""

    random: NotNegative | None = None
    model_form: NotNegative | None = None
    window: NotNegative | None = None
    input: NotNegative | None = None


class ParameterCoefficient(Strict):
    """One coefficient."""

    symbol: Annotated[str, Field(description="SNAME symbol with prime, for example Yv'")]
    value: Finite | None
    u95: NotNegative | None = Field(description="95 % half-width")
    unit: Literal["1"] = Field(description="1: nondimensional by the prime system of `scaling`")
    value_si: Finite | None = Field(description="At the density and speed of `conditions`")
    unit_si: str
    status: Literal[
        "ok", "no_table", "too_few_points", "single_estimator", "not_determined", "stated", "form_assumed"
    ]  # fmt: skip
    origin: Literal["fit", "literature", "none"]
    parts: UncertaintyParts
    table: str | None = None
    campaign: str | None = None
    estimator: str = ""
    window: tuple[Finite, Finite] | None = Field(default=None, description="radians; r' = r L/U for rates")
    n_points: Annotated[int, Field(ge=0)] = 0
    citation: str = ""
    law: Literal["motion", "rest"] = Field(
        default="motion",
        description="motion: the force goes with 1/2 rho U^(2-n) for n motion variables; rest: value_si times the velocities "
        "whatever U is, damping about a state of rest; since 1.2",
    )
    potential: Finite | None = Field(
        default=None,
        description="part of the value that -C_A(nu) nu gives, by `added_mass`; the rest is viscous; since 1.2",
    )

    @model_validator(mode="after")
    def _honest(self) -> ParameterCoefficient:
        if not self.symbol.endswith("'"):
            raise ValueError(f"{self.symbol}: a symbol without prime; write {self.symbol}'")
        try:
            derivative(self.symbol)
        except InputError as why:
            raise ValueError(str(why)) from None
        if (self.value is None) != (self.status in ("no_table", "too_few_points", "not_determined")):
            raise ValueError(f"{self.symbol}: value {self.value} does not go with status {self.status}")
        if self.u95 is not None and self.value is None:
            raise ValueError(f"{self.symbol}: an interval without a value")
        return self


class ParameterScaling(Strict):
    """Length of the primes."""

    length: Positive = Field(description="m")
    length_name: Name


class ParameterConditions(Strict):
    """Conditions of the dimensional values."""

    density: Positive = Field(description="kg/m^3")
    speed: Positive = Field(description="m/s")
    viscosity: Positive | None = Field(default=None, description="kinematic, m^2/s")


class ParameterPoint(Strict):
    """Point that moments, rates and mass moments refer to."""

    point: tuple[Finite, Finite, Finite] = Field(description="m, from the datum, in `axes`")
    datum: Name
    axes: Literal["FRD"] = "FRD"


Triple = tuple[Finite, Finite, Finite]


class ParameterMass(Strict):
    """Mass properties about the reference point."""

    mass: Positive = Field(description="kg")
    mass_moment: Finite = Field(description="x_G m, kg m, positive forward")
    inertia: Positive | None = Field(default=None, description="transverse (Iy = Iz), kg m^2")
    mass_prime: Positive
    mass_moment_prime: Finite
    centre: Triple | None = Field(
        default=None, description="centre of gravity from the reference point, m, FRD; since 1.2"
    )
    inertia_matrix: tuple[Triple, Triple, Triple] | None = Field(
        default=None, description="about the reference point, kg m^2, products with their sign in the matrix; since 1.2"
    )

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


class ParameterCovariance(Strict):
    """Covariance of standard uncertainties (U95 / 2), primed; rows of coefficients without U95 are null."""

    symbols: tuple[str, ...]
    matrix: tuple[tuple[Finite | None, ...], ...]

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


class CoveredRange(Strict):
    """Range of a motion variable that a campaign covers."""

    variable: Name
    low: Finite
    high: Finite
    unit: Literal["rad", "1"]
    campaign: str


class InputRecord(Strict):
    """A file that went in."""

    name: str
    sha256: Annotated[str, Field(pattern="^[0-9a-f]{64}$")]


class Provenance(Strict):
    """Where it all comes from."""

    coeflab_version: str
    study: str
    inputs: tuple[InputRecord, ...]
    citations: tuple[str, ...]
    notes: tuple[str, ...] = ()


class ParameterFile(Strict):
    """Hydrodynamic coefficients of one body with uncertainty and provenance."""

    schema_version: Annotated[str, Field(pattern=r"^1\.\d+$")] = SCHEMA_VERSION
    name: Name
    body: Name
    scaling: ParameterScaling
    reference_point: ParameterPoint
    conditions: ParameterConditions
    mass: ParameterMass | None
    coefficients: tuple[ParameterCoefficient, ...]
    covariance: ParameterCovariance
    covered: tuple[CoveredRange, ...]
    models: tuple[ParameterModel, ...] = Field(default=(), description="fitted tables and force laws, since 1.1")
    added_mass: ParameterAddedMass | None = Field(default=None, description="since 1.2")
    provenance: Provenance

    @model_validator(mode="after")
    def _consistent(self) -> ParameterFile:
        symbols = [c.symbol for c in self.coefficients]
        twice = sorted({s for s in symbols if symbols.count(s) > 1})
        if twice:
            raise ValueError(f"{', '.join(twice)} stands more than once")
        primes = Scaling(self.scaling.length, self.scaling.length_name)
        at = Conditions(self.conditions.density, self.conditions.speed)
        for c in self.coefficients:
            if c.value is None or c.value_si is None:
                continue
            si = c.value * primes.factor(c.symbol, at)
            if not math.isclose(c.value_si, si, rel_tol=1e-6, abs_tol=1e-12 * abs(si)):
                raise ValueError(f"{c.symbol}: value_si {c.value_si:g} is not its value at these conditions, {si:g}")
        unknown = sorted(set(self.covariance.symbols) - set(symbols))
        if unknown:
            raise ValueError(f"the covariance names {', '.join(unknown)}, which are no coefficients")
        tables = [(m.response, m.names) for m in self.models]
        for response, names in tables:
            if tables.count((response, names)) > 1:
                raise ValueError(f"{response} over {', '.join(names)} stands more than once")
        if tables and self.schema_version == FIRST_VERSION:
            raise ValueError(f"models came with version 1.1; this file says {FIRST_VERSION}")
        if self.schema_version in (FIRST_VERSION, "1.1"):
            if self.added_mass:
                raise ValueError(f"added mass came with version 1.2; this file says {self.schema_version}")
            if self.mass and self.mass.centre:
                raise ValueError(f"the centre of gravity came with version 1.2; this file says {self.schema_version}")
        return self

    def coefficient(self, symbol: str) -> ParameterCoefficient | None:
        """The coefficient of a symbol, with or without prime."""
        wanted = symbol.removesuffix("'") + "'"
        return next((c for c in self.coefficients if c.symbol == wanted), None)

    def to_json(self) -> bytes:
        """The file's bytes: sorted as declared, two blanks of indent, a closing newline, never NaN.

        A file of an earlier version is written as one, without the keys that came later.
        """
        content = _as_of(self.schema_version, self.model_dump(mode="json"))
        text = json.dumps(content, indent=2, ensure_ascii=False, allow_nan=False)
        return (text + "\n").encode()


def _as_of(version: str, content: dict[str, Any]) -> dict[str, Any]:
    """A file's content without what came after a version."""
    if version in (FIRST_VERSION, "1.1"):
        del content["added_mass"]
        if content["mass"] is not None:
            del content["mass"]["centre"], content["mass"]["inertia_matrix"]
        for coefficient in content["coefficients"]:
            del coefficient["potential"], coefficient["law"]
        for model in content["models"]:
            del model["holds"]
    if version == FIRST_VERSION:
        del content["models"]
    return content


def schema() -> bytes:
    """The JSON Schema, as shipped."""
    content: dict[str, Any] = ParameterFile.model_json_schema()
    content["$schema"] = "https://json-schema.org/draft/2020-12/schema"
    content["$id"] = f"coeflab-parameter-file-{SCHEMA_VERSION}"
    return (json.dumps(content, indent=2) + "\n").encode()


def _in_words(kind: str, message: str, value: object) -> tuple[str, str]:
    """What pydantic found and expected."""
    if kind == "missing":
        return "nothing", "a value"
    if kind == "extra_forbidden":
        return "an unknown key", "only the keys of the schema"
    if kind == "value_error":
        return message.removeprefix("Value error, "), "a parameter file that agrees with itself"
    return shown(value), message.removeprefix("Input should be ").removeprefix("String should ")


def read_parameter_file(path: Path) -> ParameterFile:
    """Read and validate a parameter file.

    Raises
    ------
    InputError
        Not JSON (with line and column), or the first thing that breaks the schema.
    """

    def refuse(token: str) -> float:
        raise ValueError(f"{token} is no JSON number")

    text = read_text(path, LARGEST)
    try:
        content = json.loads(text, parse_constant=refuse)
    except json.JSONDecodeError as why:
        raise InputError(why.msg, "JSON", file=path, line=why.lineno, column=f"character {why.colno}") from None
    except (ValueError, RecursionError) as why:
        raise InputError(str(why), "a parameter file in JSON", file=path) from None
    if isinstance(content, dict) and not str(content.get("schema_version", "")).startswith("1."):
        raise InputError(
            f"schema_version {shown(content.get('schema_version'))}",
            f"1.x (this release writes {SCHEMA_VERSION})",
            file=path,
            column="schema_version",
        )
    try:
        return ParameterFile.model_validate_json(text)
    except ValidationError as why:
        first = why.errors()[0]
        place = ".".join(str(p) for p in first["loc"]) or "file"
        more = f" ({why.error_count() - 1} more)" if why.error_count() > 1 else ""
        found, expected = _in_words(first["type"], first["msg"], first["input"])
        raise InputError(found, expected + more, file=path, column=place) from None
    except CoeflabError as why:
        raise InputError(str(why), "a valid parameter file", file=path) from None
