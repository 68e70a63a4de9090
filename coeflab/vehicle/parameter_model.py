"""A fitted table or force law as the parameter file holds it, since version 1.1, and the way back to its values."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Annotated, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_validator

from coeflab.core.errors import InputError, shown
from coeflab.core.stored import Finite, Means, Name, NotNegative, Positive, RefusedError
from coeflab.core.texts import input_error
from coeflab.core.types import Array
from coeflab.law.domain import Domain, Extrapolation
from coeflab.law.force_law import WIND
from coeflab.law.symbols import COMPONENTS
from coeflab.law.terms import Factor, Term, design
from coeflab.vehicle.parameter_parts import Strict

ANGLE_OF = {"alpha": "w", "beta": "v"}
# Component of the force that a response is, along the body or along the flow; a prime behind it says nothing more.
PLACES = (
    {c: c for c in (*COMPONENTS, *WIND)}
    | {f"C_{c}": c for c in (*COMPONENTS, *WIND)}
    | {"C_l": "K", "C_m": "M", "C_n": "N"}
)
POLARS = ("L/V^2", "D/V^2", "M/V^2")  # no force of the law: coefficients of the file state it


class ModelVariable(Strict):
    """A variable of a fitted model."""

    name: Annotated[Name, Means("alpha beta u v w p q r dr ds db")]
    unit: Annotated[Literal["rad", "1", "m/s", "rad/s"], Means("1: v/U for velocities, r L/U for rates")]


class ModelTerm(Strict):
    """A product of powers with its coefficient; null where the data do not determine it."""

    symbol: Annotated[Name, Means("name of the coefficient")]
    factors: Annotated[tuple[Factor, ...], Means("their product multiplies the value; empty for the constant")]
    value: Annotated[Finite | None, Means("coefficient of the term", "of the response over that of the factors")]
    half_width_95: Annotated[NotNegative | None, Means("95 % half-width of the value", "as the value")]


class ModelDomain(Strict):
    """Where the model may be read, in the order of `variables`."""

    low: Annotated[tuple[Finite, ...], Means("lowest value of each variable", "of the variable")]
    high: Annotated[tuple[Finite, ...], Means("highest value of each variable", "of the variable")]
    half_spaces: Annotated[
        tuple[tuple[Finite, ...], ...], Means("rows [a, b] with a.x + b <= 0 inside the convex hull of the data")
    ]
    extrapolation: Annotated[
        Literal["refuse", "clamp", "taper"],
        Means("outside: no value; that of the nearest point of the hull; a blend into that"),
    ]


class ModelArea(Strict):
    """What the coefficient is divided by beside 1/2 rho V^2; moments also by the length of `scaling`."""

    value: Annotated[Positive, Means("the area", "m^2")]
    name: Annotated[Name, Means("what area it is, for example frontal, or L^2")]


class ParameterModel(Strict):
    """One response as a linear combination of terms."""

    response: Annotated[Name, Means("force component or coefficient, for example Y' or C_D")]
    unit: Annotated[Name, Means("of the response; 1: nondimensional")]
    form: Annotated[str, Means("family of the form, in words")]
    variables: Annotated[tuple[ModelVariable, ...], Field(min_length=1), Means("what the response depends on")]
    terms: Annotated[tuple[ModelTerm, ...], Field(min_length=1), Means("the response is their sum")]
    covariance: Annotated[
        tuple[tuple[Finite | None, ...], ...],
        Means("of standard uncertainties (half_width_95 / 2) of the terms; null where not determined", "of the values"),
    ]
    domain: Annotated[ModelDomain, Means("where it may be read")]
    n_points: Annotated[int, Field(ge=0), Means("points that it was fitted to")]
    rms: Annotated[NotNegative, Means("root mean square of the residuals", "of the response")]
    press_rms: Annotated[
        NotNegative | None, Means("root mean square of every point predicted from the others", "of the response")
    ]
    table: Annotated[str, Means("file of the table")]
    campaign: Annotated[str, Means("campaign of the table")]
    post_selection: Annotated[bool, Means("true: terms chosen on the same data, intervals too narrow")] = False
    statements: Annotated[tuple[str, ...], Means("assumptions and limits, in words")] = ()
    area: Annotated[ModelArea | None, Means("of a coefficient by an area; null where there is none")] = None
    holds: Annotated[
        tuple[Name, ...],
        Means(
            "what half widths and covariance hold: the scatter, what it shows that the form leaves out (model form, since "
            "1.4), the grid, declared inputs",
            since="1.2",
        ),
    ] = ("random",)
    contains_potential: Annotated[
        bool,
        Means(
            "true: the values are whole forces, as measured; false: -C_A(nu) nu of `added_mass` comes on top",
            since="1.3",
        ),
    ] = True

    @model_validator(mode="after")
    def _consistent(self) -> ParameterModel:
        if not self.place and self.response not in POLARS:
            raise RefusedError(
                f"the response {shown(self.response)}", f"one of {', '.join(PLACES)}", "Primed or not: Y' is Y.", ("response",)
            )  # fmt: skip
        names = self.names
        if len(set(names)) != len(names):
            raise ValueError(f"{self.response}: a variable occurs more than once")
        for t in self.terms:
            strange = sorted({f.variable for f in t.factors} - set(names))
            if strange:
                raise ValueError(f"{self.response}: {t.symbol} uses {', '.join(strange)}, which is no variable")
            if t.value is None and t.half_width_95 is not None:
                raise ValueError(f"{t.symbol}: an interval without a value")
        d, k = len(names), len(self.terms)
        edges = (self.domain.low, self.domain.high)
        if any(len(e) != d for e in edges) or any(len(row) != d + 1 for row in self.domain.half_spaces):
            raise ValueError(f"{self.response}: the domain does not have {d} variables")
        if not self.domain.half_spaces:
            raise RefusedError(
                f"{self.response}: no half-spaces", "at least one, for they alone bound the domain",
                "Of a box: [1, -high] and [-1, low] for each variable.", ("domain", "half_spaces"),
            )  # fmt: skip
        if any(a > b for a, b in zip(*edges, strict=True)):
            raise ValueError(f"{self.response}: the domain's low is above its high")
        if beyond := self.hull.beyond_its_box():
            raise RefusedError(
                f"{self.response}: half-spaces beyond low or high of {', '.join(beyond)}", "both of one domain",
                "Of a box: [1, -high] and [-1, low] for each variable.", ("domain", "half_spaces"),
            )  # fmt: skip
        if len(self.covariance) != k or any(len(row) != k for row in self.covariance):
            raise ValueError(f"{self.response}: the covariance of {k} terms must be {k} x {k}")
        for i, row in enumerate(self.covariance):
            diagonal = row[i]
            if diagonal is not None and diagonal < 0.0:
                raise ValueError(f"{self.response}: the variance of {self.terms[i].symbol} is negative")
            if any(not _same(value, self.covariance[j][i]) for j, value in enumerate(row)):
                raise ValueError(f"{self.response}: the covariance is not symmetric")
        return self

    @property
    def names(self) -> tuple[str, ...]:
        """The variables."""
        return tuple(v.name for v in self.variables)

    @property
    def place(self) -> str:
        """X Y Z K M N, or D S L; empty where the response is no force of the law."""
        return PLACES.get(self.response.removesuffix("'"), "")

    @property
    def hull(self) -> Domain:
        """Where it may be read, and what a reader gets outside."""
        d = self.domain
        spaces = np.array(d.half_spaces, dtype=np.float64).reshape(-1, len(self.names) + 1)
        return Domain(self.names, np.array(d.low), np.array(d.high), spaces, Extrapolation(d.extrapolation))

    def evaluate(self, columns: Mapping[str, Array]) -> tuple[Array, Array, NDArray[np.bool_]]:
        """Values, 95 % half-widths of the mean, and whether each point lies inside the convex hull of the data.

        Outside the hull the model's rule decides. ``refuse`` gives NaN. ``clamp`` gives the value at the nearest
        point of the hull, in coordinates divided by the widths of its bounding box
        (`coeflab.law.domain.clamped`). ``taper`` blends the free continuation into that value within a
        tenth of a box width from the hull (`coeflab.law.domain.taper_weight`). A point at which an
        undetermined term counts is NaN, and so are one without a nearest point and a half-width without covariance.

        Parameters
        ----------
        columns : mapping of variable to (n,) array
            In the units of `variables`.

        Raises
        ------
        InputError
            A variable is missing or unknown.
        """
        if set(columns) != set(self.names):
            raise input_error(
                "vehicle.columns_of_model", column=self.response, value=", ".join(columns) or "nothing", names=", ".join(self.names),
            )  # fmt: skip
        points = np.column_stack([np.asarray(columns[v], dtype=np.float64) for v in self.names])
        hull = self.hull
        within = hull.contains(points)
        rows = self._rows(points)
        if hull.rule != "refuse":
            nearest, free = hull.read(points)
            edge, some = self._rows(nearest), free[:, None] > 0.0
            rows = np.where(some, edge + free[:, None] * np.where(some, rows - edge, 0.0), edge)
        values = rows @ np.array([0.0 if t.value is None else t.value for t in self.terms])
        unknown = np.array([t.value is None for t in self.terms])
        covariance = np.array([[np.nan if c is None else c for c in row] for row in self.covariance], dtype=np.float64)
        bare = ~unknown & np.isnan(np.diag(covariance))
        spread = np.sqrt(np.maximum(np.einsum("ij,ij->i", rows @ np.nan_to_num(covariance), rows), 0.0))
        void = np.any(rows[:, unknown] != 0.0, axis=1)
        if hull.rule == "refuse":
            void |= ~within
        half = np.where(void | np.any(rows[:, bare] != 0.0, axis=1), np.nan, 2.0 * spread)
        return np.where(void, np.nan, values), half, within

    def _rows(self, points: Array) -> Array:
        terms = tuple(Term(t.factors) for t in self.terms)
        return design(terms, dict(zip(self.names, points.T, strict=True)))


def _same(a: float | None, b: float | None) -> bool:
    if a is None or b is None:
        return a is b
    return math.isclose(a, b, rel_tol=1e-9, abs_tol=1e-300)


def chosen(models: tuple[ParameterModel, ...], response: str, variables: tuple[str, ...]) -> tuple[ParameterModel, ...]:
    """The models of a response (empty: of all) over exactly these variables.

    Where there is none, alpha may stand for w' and beta for v'; `from_angles` then gives the columns.

    Raises
    ------
    InputError
        No models, no such response, an unknown variable, or one without values.
    """
    if not models:
        raise input_error("vehicle.parameter_file_without_fitted")
    wanted = response.removesuffix("'")
    found = [m for m in models if not response or m.response.removesuffix("'") == wanted]
    if not found:
        known = dict.fromkeys(m.response for m in models)
        raise InputError(f"no fitted table of {shown(response)}", f"one of {', '.join(known)}", column="--response")
    names = dict.fromkeys(v for m in found for v in m.names)
    for v in variables:
        if v not in names and not any(_by_angle(m, v) for m in found):
            raise InputError(f"the unknown variable {shown(v)}", f"one of {', '.join(names)}")
    exact = tuple(m for m in found if set(m.names) == set(variables))
    matching = exact or tuple(m for m in found if {_by_angle(m, v) or v for v in variables} == set(m.names))
    matching = tuple(m for m in matching if len(m.names) == len(variables))
    if not matching:
        forms = ", or for ".join(dict.fromkeys(" and ".join(map(_spoken, m.variables)) for m in found))
        raise InputError(f"values for {' and '.join(variables) or 'no variable'}", f"values for {forms}")
    return matching


def _by_angle(model: ParameterModel, angle: str) -> str:
    """The primed velocity of a model that an angle stands for; empty where none does."""
    velocity = ANGLE_OF.get(angle, "")
    primed = any(v.name == velocity and v.unit == "1" for v in model.variables)
    return velocity if primed and angle not in model.names else ""


def _spoken(variable: ModelVariable) -> str:
    angle = next((a for a, v in ANGLE_OF.items() if v == variable.name), "")
    return f"{variable.name} (or {angle})" if angle and variable.unit == "1" else variable.name


def from_angles(model: ParameterModel, columns: Mapping[str, Array]) -> dict[str, Array]:
    """Columns of a model's variables, where v' = sin(beta) and w' = sin(alpha) cos(beta) may stand as angles.

    Where the model has w' but not v', beta is zero; where v' is given as such, cos(beta) = sqrt(1 - v'^2).

    Parameters
    ----------
    model : ParameterModel
        As `chosen` for the names of `columns`.
    columns : mapping of variable to (n,) array
        Angles in radians.
    """
    out = {v: x for v, x in columns.items() if v in model.names}
    if "v" in model.names and "v" not in out:
        out["v"] = np.sin(columns["beta"])
    if "w" in model.names and "w" not in out:
        v = out.get("v", np.sin(columns["beta"]) if "beta" in columns else np.zeros_like(columns["alpha"]))
        out["w"] = np.sin(columns["alpha"]) * np.sqrt(np.maximum(1.0 - v**2, 0.0))
    return out
