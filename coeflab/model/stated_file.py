"""A parameter file of somebody else's numbers: stated, without uncertainty."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import ValidationError

from coeflab.core.datums import Datum
from coeflab.core.errors import InputError
from coeflab.core.provenance import InputFile
from coeflab.core.symbols import COMPONENTS, MOTIONS, derivative, primed
from coeflab.core.version import VERSION
from coeflab.kernels.brief import brief
from coeflab.kernels.composition import definiteness
from coeflab.model.added_mass import AddedMass
from coeflab.model.parameter_added_mass import ParameterAddedMass
from coeflab.model.parameter_coefficient import ParameterCoefficient, ParameterCovariance, UncertaintyParts
from coeflab.model.parameter_file import (
    InputRecord,
    ParameterConditions,
    ParameterFile,
    ParameterPoint,
    ParameterScaling,
    Provenance,
)
from coeflab.model.parameter_mass import ParameterMass
from coeflab.model.potential import potential_part
from coeflab.model.scaling import Conditions, Scaling

Array = NDArray[np.float64]
Law = Literal["motion", "rest"]
MODEL_ORIGIN = Datum("origin of the model")
Term = tuple[tuple[tuple[str, int, bool], ...], float]


@brief
@dataclass(frozen=True, slots=True, eq=False)
class StatedMass:
    """Mass, kg; x_G m, kg m; where they are known transverse inertia, kg m^2, the centre of gravity (3,) from the
    reference point, m, and the inertia (3, 3) about that point, kg m^2.
    """

    mass: float
    moment: float
    inertia: float | None = None
    centre: Array | None = None
    inertia_matrix: Array | None = None


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Stated:
    """What a model file states, in SI and FRD.

    Attributes
    ----------
    name, body : str
    scaling : Scaling
    conditions : Conditions
    coefficients : mapping of symbol to (primed value, law)
    point : (3,) tuple
    datum : Datum
    matrix : (6, 6) array or None
        Added mass about the point, where the file is to hold it as such: symmetric and positive.
    matrix_body, matrix_method : str
    mass : StatedMass or None
    notes : tuple of str
    """

    name: str
    body: str
    scaling: Scaling
    conditions: Conditions
    coefficients: dict[str, tuple[float, Law]]
    point: tuple[float, float, float] = (0.0, 0.0, 0.0)
    datum: Datum = MODEL_ORIGIN
    matrix: Array | None = None
    matrix_body: str = ""
    matrix_method: str = "stated"
    mass: StatedMass | None = None
    notes: tuple[str, ...] = field(default=())


def stated_file(stated: Stated, sources: Sequence[InputFile], citations: tuple[str, ...]) -> ParameterFile:
    """The parameter file; every coefficient has status ``stated`` and no interval.

    Raises
    ------
    InputError
        The numbers make no parameter file: one is not finite, a name is empty, a mass is no rigid body's.
    """
    try:
        return _built(stated, sources, citations)
    except ValidationError as why:
        first = why.errors()[0]
        place = ".".join(str(p) for p in first["loc"]) or stated.name
        raise InputError(first["msg"], "numbers that make a parameter file", column=place) from None


def _built(stated: Stated, sources: Sequence[InputFile], citations: tuple[str, ...]) -> ParameterFile:
    s, at = stated, stated.conditions
    hull = None
    if s.matrix is not None:
        hull = AddedMass(s.matrix, np.array(s.point), s.datum, s.matrix_body or s.body, s.matrix_method)
    factor = 0.5 * at.density * s.scaling.length**3
    return ParameterFile(
        name=s.name,
        body=s.body,
        scaling=ParameterScaling(length=s.scaling.length, length_name=s.scaling.length_name),
        reference_point=ParameterPoint(point=s.point, datum=s.datum.id),
        conditions=ParameterConditions(density=at.density, speed=at.speed, viscosity=at.viscosity),
        mass=None
        if s.mass is None
        else ParameterMass.model_validate(
            {
                "mass": s.mass.mass,
                "mass_moment": s.mass.moment,
                "inertia": s.mass.inertia,
                "mass_prime": s.mass.mass / factor,
                "mass_moment_prime": s.mass.moment / (factor * s.scaling.length),
                "centre": None if s.mass.centre is None else s.mass.centre.tolist(),
                "inertia_matrix": None if s.mass.inertia_matrix is None else s.mass.inertia_matrix.tolist(),
            }
        ),
        coefficients=tuple(_coefficient(symbol, *value, s, hull) for symbol, value in s.coefficients.items()),
        covariance=ParameterCovariance(symbols=(), matrix=()),
        covered=(),
        added_mass=None
        if hull is None
        else ParameterAddedMass.model_validate(
            {"body": hull.body, "method": hull.method, "density": at.density, "matrix": hull.matrix.tolist()}
        ),
        provenance=Provenance(
            coeflab_version=VERSION,
            study=sources[0].name if sources else s.name,
            inputs=tuple(InputRecord(name=i.name, sha256=i.sha256) for i in sources),
            citations=citations,
            notes=s.notes,
        ),
    )


def _coefficient(symbol: str, value: float, law: Law, s: Stated, hull: AddedMass | None) -> ParameterCoefficient:
    potential = None
    if hull is not None and law == "motion":
        potential = potential_part(symbol, hull, s.scaling, s.conditions.density)
    return ParameterCoefficient(
        symbol=primed(symbol),
        value=value,
        u95=None,
        unit="1",
        value_si=value * s.scaling.factor(symbol, s.conditions),
        unit_si=derivative(symbol).unit,
        status="stated",
        origin="literature",
        parts=UncertaintyParts(),
        law=law,
        potential=potential,
    )


def matrix_doubts(matrix: Array) -> tuple[str, ...]:
    """What is wrong with an added mass (6, 6) about one point, in words; empty where it can be a kinetic energy."""
    found = definiteness(matrix)
    if found.holds:
        return ()
    doubts = []
    pairs = [
        f"{COMPONENTS[i]}{MOTIONS[j]}dot {-matrix[i, j]:g} against {COMPONENTS[j]}{MOTIONS[i]}dot {-matrix[j, i]:g}"
        for i in range(6)
        for j in range(i + 1, 6)
        if abs(matrix[i, j] - matrix[j, i]) > 1e-9 * max(abs(matrix[i, j]), abs(matrix[j, i]))
    ]
    if pairs:
        doubts.append(f"the added mass is not symmetric: {', '.join(pairs)}")
    negative = [f"{COMPONENTS[i]}{MOTIONS[i]}dot {-matrix[i, i]:g}" for i in range(6) if matrix[i, i] < 0.0]
    if negative:
        doubts.append(f"negative added mass: {', '.join(negative)} must not be above zero")
    elif not np.isfinite(found.smallest) or found.smallest < 0.0:
        doubts.append("the added mass is not positive definite: an off-diagonal entry is too large for its diagonals")
    return tuple(doubts)


def stated_table(
    response: str,
    variables: Mapping[str, tuple[str, float, float]],
    terms: Mapping[str, Term],
    per_unit: float,
    *,
    form: str,
    table: str,
    campaign: str,
    statements: tuple[str, ...],
    unit: str = "1",
) -> dict[str, Any]:
    """A law that somebody stated as a fitted table without points, for `ParameterFile.models`.

    Parameters
    ----------
    response : str
        For example ``C_D`` or ``N``.
    variables : mapping of str to (unit, low, high)
    terms : mapping of symbol to (factors, value)
        Factors are (variable, power, absolute); values in the unit of the source.
    per_unit : float
        What a value is divided by to be in ``unit``.
    form, table, campaign : str
        Words for where it comes from.
    statements : tuple of str
    unit : str
    """
    low, high = tuple(v[1] for v in variables.values()), tuple(v[2] for v in variables.values())
    count = len(variables)
    spaces = []
    for i in range(count):
        row = [0.0] * count
        row[i] = -1.0
        spaces.append((*row, low[i]))
        row[i] = 1.0
        spaces.append((*row, -high[i]))
    return {
        "response": response, "unit": unit, "form": form,
        "variables": tuple({"name": name, "unit": of} for name, (of, _, _) in variables.items()),
        "terms": tuple(
            {
                "symbol": symbol,
                "factors": tuple({"variable": v, "power": n, "absolute": a} for v, n, a in factors),
                "value": float(f"{value / per_unit:.12g}"),
                "half_width_95": None,
            }
            for symbol, (factors, value) in terms.items()
        ),
        "covariance": tuple((None,) * len(terms) for _ in terms),
        "domain": {"low": low, "high": high, "half_spaces": tuple(spaces), "extrapolation": "clamp"},
        "n_points": 0, "rms": 0.0, "press_rms": None, "table": table, "campaign": campaign, "statements": statements,
        "holds": (),
        "contains_potential": False,
    }  # fmt: skip
