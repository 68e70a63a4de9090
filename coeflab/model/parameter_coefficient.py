"""One coefficient of a parameter file, and the covariance of all."""

from __future__ import annotations

import math
from typing import Annotated, Literal

from pydantic import Field, model_validator

from coeflab.core.errors import InputError
from coeflab.core.symbols import derivative
from coeflab.model.schema_types import Finite, NotNegative, Strict, told

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
        Literal["ok", "no_table", "too_few_points", "single_estimator", "not_determined", "stated", "form_assumed"],
        told(
            "ok: fitted with U95; single_estimator: fitted, its model-form error unknown; form_assumed (since 1.2): U95 holds "
            "for the form that was asked for; stated: from the literature; no_table, too_few_points, not_determined: no value"
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
