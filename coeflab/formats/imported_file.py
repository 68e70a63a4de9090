"""A parameter file of somebody else's numbers: stated, without uncertainty.

Coefficients of somebody's model of second order: what its numbers mean as totals under SNAME names.

A link with hydrodynamics as a parameter file: what SDF and URDF models share once their numbers are in FRD.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Literal

import numpy as np
from pydantic import ValidationError

from coeflab.core.axes import Datum
from coeflab.core.errors import InputError
from coeflab.core.finding import Finding, Severity
from coeflab.core.limits import positive_number
from coeflab.core.provenance import InputFile, sha256_of
from coeflab.core.texts import input_error
from coeflab.core.types import Array, brief, locking
from coeflab.core.version import VERSION
from coeflab.core.wording import one_line
from coeflab.law.added_mass import AddedMass, definiteness, potential_part
from coeflab.law.coefficient import Coefficient, Status
from coeflab.law.rigid_body import MassProperties, ideal_quadratics, inertia_doubt
from coeflab.law.scaling import Conditions, Scaling
from coeflab.law.symbols import COMPONENTS, MOTIONS, derivative, primed
from coeflab.law.transforms import skew
from coeflab.vehicle.parameter_file import ParameterFile, ParameterPoint, Provenance
from coeflab.vehicle.parameter_parts import (
    ParameterCovariance,
    ParameterHydrostatics,
    ParameterSurface,
    ParameterThruster,
)
from coeflab.vehicle.second_order import ACROSS, ROUNDING, SURGE, SecondOrder, products_once

Law = Literal["motion", "rest"]
MODEL_ORIGIN = Datum("origin of the model")
Term = tuple[tuple[tuple[str, int, bool], ...], float]


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


def imported_file(stated: Stated, sources: Sequence[InputFile], citations: tuple[str, ...]) -> ParameterFile:
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


ROUNDED = 1e-3  # of the diagonal: numbers of four digits that mean one


def but_for_rounding(matrix: Array) -> Array:
    """The mean of a matrix and its mirror image where both are equal to the digits that people write; else as it is."""
    root = np.sqrt(np.abs(np.diag(matrix)))
    scale = np.maximum(np.outer(root, root), np.maximum(np.abs(matrix), np.abs(matrix.T)))
    alike = np.abs(matrix - matrix.T) <= ROUNDED * scale
    return np.asarray((matrix + matrix.T) / 2.0 if np.all(alike) else matrix)


def matrix_doubts(matrix: Array) -> tuple[str, ...]:
    """What is wrong with an added mass (6, 6) about one point, in words; empty where it can be a kinetic energy."""
    matrix = but_for_rounding(matrix)
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


Coefficients = dict[str, tuple[float, Law]]


def valid_matrix(matrix: Array) -> Array | None:
    """The matrix where it can be an added mass; None where it is zero or no kinetic energy."""
    return but_for_rounding(matrix) if np.any(matrix) and not matrix_doubts(matrix) else None


def stated_coefficients(
    form: SecondOrder, added: Array, matrix: Array, scaling: Scaling, conditions: Conditions
) -> Coefficients:
    """Primed values of a model in FRD.

    Parameters
    ----------
    form : SecondOrder
        What the file writes.
    added : (6, 6, 6) array
        Quadratics that its simulator adds itself, symmetric in the last two axes.
    matrix : (6, 6) array
        Its added mass. Where that is asymmetric or not positive its entries become acceleration derivatives.
    scaling : Scaling
    conditions : Conditions
        What the values are primed by.

    Notes
    -----
    |u| v is read as the first-order derivative Yv, total with what the simulator adds, unless the file has damping at rest of
    the same name too; then it keeps its bars. What the form calls its resistance is read as X0, taken
    from u|u|, v^2 and w^2. A product that is just the ideal fluid's is left to the added
    mass.
    """
    selected = valid_matrix(matrix)
    ideal = np.zeros((6, 6, 6)) if selected is None else products_once(ideal_quadratics(selected))
    own = products_once(added)
    out: Coefficients = {}
    signed, absolute = form.signed.copy(), form.absolute.copy()

    def motion(symbol: str, value: float) -> None:
        out[symbol] = (float(value / scaling.unit(symbol, conditions.density)), "motion")

    for i, j in np.argwhere(form.linear):
        symbol = COMPONENTS[i] + MOTIONS[j]
        out[symbol] = (float(form.linear[i, j] / scaling.unit(symbol, conditions.density, conditions.speed)), "rest")
    if form.resistance:
        motion("X0", form.resistance)
        _take(absolute[SURGE, SURGE, SURGE:], form.resistance)
        for across in ACROSS:
            _take(signed[SURGE, across, across:], form.resistance)
    for i, j, k in np.argwhere(absolute):
        name = COMPONENTS[i] + MOTIONS[j]
        if k == SURGE and j != SURGE and name not in out:
            motion(name, absolute[i, j, k] + own[i, SURGE, j])
            own[i, SURGE, j] = ideal[i, SURGE, j] = 0.0
        else:
            motion(f"{name}|{MOTIONS[k]}|", absolute[i, j, k])
    total = signed + own
    apart = np.abs(total - ideal) > ROUNDING * np.maximum(np.abs(total), np.abs(ideal))
    for i, j, k in np.argwhere(apart):
        motion(COMPONENTS[i] + MOTIONS[j] + MOTIONS[k], total[i, j, k])
    if selected is None:
        for i, j in np.argwhere((matrix != 0.0) | (matrix.T != 0.0)):
            motion(f"{COMPONENTS[i]}{MOTIONS[j]}dot", 0.0 - matrix[i, j])
    return out


def _take(row: Array, part: float) -> None:
    """Take a part from the first entry of a row; what rounding leaves is zero."""
    left = row[0] - part
    row[0] = 0.0 if abs(left) <= ROUNDING * abs(part) else left


def stated_mass(
    mass: float | None, centre: Array, inertia: Array | None, findings: list[Finding], subject: str
) -> MassProperties | None:
    """Mass properties about the link's origin, FRD.

    Parameters
    ----------
    mass : float or None
    centre : (3,) array
        From the link's origin.
    inertia : (3, 3) array or None
        About the centre of gravity; left out, with a finding, where no body has it.
    findings : list of Finding
        Is added to.
    subject : str
        Whom it is about.
    """
    if mass is None or mass <= 0.0:
        return None
    about = None
    if inertia is not None:
        arm = skew(centre)
        about = inertia - mass * arm @ arm
        doubt = inertia_doubt(mass, centre, about)
        if doubt:
            findings.append(Finding.of("model.no_inertia", subject, Severity.FAIL, why=doubt))
            about = None
    equal = about is not None and abs(about[1, 1] - about[2, 2]) <= 1e-9 * abs(about[1, 1])
    transverse = float(about[1, 1]) if about is not None and equal else None
    return MassProperties(mass, mass * float(centre[0]), transverse, centre, about)


@brief
@dataclass(frozen=True, slots=True, eq=False)
@locking("added matrix centre")
class LinkModel:
    """SI and FRD, about the link's origin.

    Attributes
    ----------
    model, link : str
        Names; the file's name stands in for an empty one.
    density : float
        kg/m^3.
    form : SecondOrder
        What the file writes.
    added : (6, 6, 6) array
        Quadratics that its simulator adds itself.
    matrix : (6, 6) array
        Added mass.
    mass : float or None
        kg.
    centre : (3,) array
        Centre of gravity, m.
    inertia : (3, 3) array or None
        About the centre of gravity, kg m^2.
    length : float or None
        m, where the file states one.
    length_name : str
    notes : tuple of str
    findings : tuple of Finding
        What the file holds and this does not.
    hydrostatics, thrusters, surfaces
        As of `Stated`.
    controls : mapping of symbol to float
        Such as Ydr, of U^2, SI.
    """

    model: str
    link: str
    density: float
    form: SecondOrder
    added: Array
    matrix: Array
    mass: float | None
    centre: Array
    inertia: Array | None
    length: float | None = None
    length_name: str = ""
    notes: tuple[str, ...] = ()
    findings: tuple[Finding, ...] = ()
    hydrostatics: ParameterHydrostatics | None = None
    thrusters: tuple[ParameterThruster, ...] = ()
    surfaces: tuple[ParameterSurface, ...] = ()
    controls: Mapping[str, float] = field(default_factory=dict)


def link_file(
    link: LinkModel, path: Path, citations: tuple[str, ...], length: float | None = None, speed: float | None = None
) -> ParameterFile:
    """The parameter file of a link.

    Parameters
    ----------
    link : LinkModel
    path : path
        Of the model file.
    citations : tuple of str
    length, speed : float, optional
        Of the primes, m and m/s; else the file's own length, or 1 m, and 1 m/s, which the file says.

    Raises
    ------
    InputError
        A density or length that is not above zero; the numbers make no parameter file.
    """
    for what, value in (("density", link.density), (link.length_name, link.length)):
        if value is not None and (expected := positive_number(value)):
            raise InputError(f"{what} {value:g}", expected, file=path)
    notes = list(link.notes)
    if length:
        scaling = Scaling(length, "given length")
    elif link.length:
        scaling = Scaling(link.length, link.length_name)
    else:
        scaling = Scaling(1.0, "1 m")
        notes.append("lengths made dimensionless by 1 m: the file states none")
    at = Conditions(link.density, speed or 1.0)
    doubts = matrix_doubts(link.matrix)
    notes += doubts
    if doubts and np.any(link.added):
        notes.append("so the C_A(nu) nu of the simulator is written product by product, not as an added mass")
    name = one_line(link.model or path.stem)[:200]
    findings = list(link.findings)
    stated = Stated(
        name=name,
        body=name,
        scaling=scaling,
        conditions=at,
        coefficients=stated_coefficients(link.form, link.added, link.matrix, scaling, at)
        | {
            symbol: (value / scaling.unit(symbol, at.density), "motion")
            for symbol, value in link.controls.items()
            if value
        },
        datum=Datum(f"origin of the link {one_line(link.link)}"[:200]),
        matrix=valid_matrix(link.matrix),
        mass=stated_mass(link.mass, link.centre, link.inertia, findings, name),
        hydrostatics=link.hydrostatics,
        thrusters=link.thrusters,
        surfaces=link.surfaces,
        notes=tuple(notes),
        findings=(),
    )
    stated = replace(stated, findings=tuple(findings))
    return imported_file(stated, [InputFile(path.name, sha256_of(path))], citations)
