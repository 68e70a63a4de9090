"""A parameter file of numbers that somebody else states, without uncertainty."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from pydantic import ValidationError

from coeflab.core.axes import Datum
from coeflab.core.finding import Finding
from coeflab.core.provenance import InputFile
from coeflab.core.texts import input_error
from coeflab.core.types import Array, brief
from coeflab.core.version import VERSION
from coeflab.law.added_mass import AddedMass, potential_part
from coeflab.law.coefficient import Coefficient, Status
from coeflab.law.rigid_body import MassProperties
from coeflab.law.scaling import Conditions, Scaling
from coeflab.law.symbols import derivative, primed
from coeflab.vehicle.parameter_file import ParameterFile, ParameterPoint, Provenance
from coeflab.vehicle.parameter_parts import (
    ParameterCovariance,
    ParameterHydrostatics,
    ParameterSurface,
    ParameterThruster,
)

Law = Literal["motion", "rest"]
MODEL_ORIGIN = Datum("origin of the model")


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
    mass : MassProperties or None
    hydrostatics : ParameterHydrostatics or None
    thrusters : tuple of ParameterThruster
    surfaces : tuple of ParameterSurface
    notes : tuple of str
    findings : tuple of Finding
        What the file holds and this does not.
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
    mass: MassProperties | None = None
    hydrostatics: ParameterHydrostatics | None = None
    thrusters: tuple[ParameterThruster, ...] = ()
    surfaces: tuple[ParameterSurface, ...] = ()
    notes: tuple[str, ...] = field(default=())
    findings: tuple[Finding, ...] = ()


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
        raise input_error("formats.no_parameter_file", column=place, first=first["msg"]) from None


def _built(stated: Stated, sources: Sequence[InputFile], citations: tuple[str, ...]) -> ParameterFile:
    s = stated
    hull = None
    if s.matrix is not None:
        body = s.matrix_body or s.body
        hull = AddedMass(s.matrix, np.array(s.point), s.datum, body, s.matrix_method, density=s.conditions.density)
    return ParameterFile(
        name=s.name,
        body=s.body,
        scaling=s.scaling,
        reference_point=ParameterPoint(point=s.point, datum=s.datum.id),
        conditions=s.conditions,
        mass=None if s.mass is None else s.mass.primed(s.scaling, s.conditions.density),
        coefficients=tuple(_coefficient(symbol, *value, s, hull) for symbol, value in s.coefficients.items()),
        covariance=ParameterCovariance(symbols=(), matrix=()),
        covered=(),
        added_mass=hull,
        hydrostatics=s.hydrostatics,
        thrusters=s.thrusters,
        surfaces=s.surfaces,
        findings=s.findings,
        provenance=Provenance(
            coeflab_version=VERSION,
            study=sources[0].name if sources else s.name,
            inputs=tuple(sources),
            citations=citations,
            notes=s.notes,
        ),
    )


def _coefficient(symbol: str, value: float, law: Law, s: Stated, hull: AddedMass | None) -> Coefficient:
    potential = None
    if hull is not None and law == "motion":
        potential = potential_part(symbol, hull, s.scaling, s.conditions.density)
    return Coefficient(
        primed(symbol),
        value,
        None,
        Status.STATED,
        origin="literature",
        law=law,
        value_si=value * s.scaling.unit(symbol, s.conditions.density, s.conditions.speed),
        unit_si=derivative(symbol).unit,
        potential=potential,
    )
