"""From fits and literature to one parameter file."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import numpy as np

from coeflab.core.errors import InputError, ScalingMismatchError, shown
from coeflab.core.provenance import InputFile
from coeflab.core.symbols import derivative, primed
from coeflab.core.version import VERSION
from coeflab.kernels.rigid_body import about_another
from coeflab.model.added_mass import AddedMass
from coeflab.model.body import Body, MassProperties, likeness
from coeflab.model.coefficient import Coefficient, CoefficientSet
from coeflab.model.fit_result import FitResult
from coeflab.model.force_table import ForceTable
from coeflab.model.gathered import gathered
from coeflab.model.model_record import recorded
from coeflab.model.parameter_added_mass import added_mass_record
from coeflab.model.parameter_coefficient import ParameterCoefficient, ParameterCovariance, UncertaintyParts
from coeflab.model.parameter_file import (
    CoveredRange,
    InputRecord,
    ParameterConditions,
    ParameterFile,
    ParameterPoint,
    ParameterScaling,
    Provenance,
)
from coeflab.model.parameter_mass import ParameterMass
from coeflab.model.potential import potential_part
from coeflab.model.reference import Reference
from coeflab.model.scaling import Conditions, Scaling
from coeflab.model.study import PlannedParameterFile
from coeflab.model.triangulation import Triangulation


def _written(
    c: Coefficient, scaling: Scaling, conditions: Conditions, hull: AddedMass | None, density: float
) -> ParameterCoefficient:
    factor = scaling.factor(c.symbol, conditions)
    return ParameterCoefficient(
        symbol=primed(c.symbol),
        value=c.value,
        u95=c.u95,
        unit="1",
        value_si=None if c.value is None else c.value * factor,
        unit_si=derivative(c.symbol).unit,
        status=c.status.value,
        origin=c.origin,
        parts=UncertaintyParts(
            random=c.parts.random, model_form=c.parts.model_form, window=c.parts.window, input=c.parts.input
        ),
        table=c.table,
        campaign=c.campaign,
        estimator=c.estimator,
        window=c.window,
        n_points=c.n_points,
        citation=c.citation,
        law=c.law,
        potential=None
        if hull is None or c.value is None or c.law == "rest"
        else potential_part(c.symbol, hull, scaling, density),
    )


def _covered(tables: Sequence[ForceTable], length: float) -> tuple[CoveredRange, ...]:
    out = []
    for t in tables:
        for variable in t.varies:
            x = t.primed_motion(variable, length)
            low, high = float(np.min(x)), float(np.max(x))
            angle = variable in ("v", "w") and max(-low, high) <= 1.0
            if angle:
                low, high = float(np.arcsin(low)), float(np.arcsin(high))
            unit: Literal["rad", "1"] = "rad" if angle or variable in t.controls else "1"
            name = f"asin({variable}/U)" if angle else variable if variable in t.controls else f"{variable}'"
            out.append(CoveredRange(variable=name, low=low, high=high, unit=unit, campaign=t.campaign))
    return tuple(out)


def _triple(values: np.ndarray) -> tuple[float, float, float]:
    x, y, z = map(float, values)
    return x, y, z


def _mass_about(mass: MassProperties, body: Body, among: CoefficientSet) -> tuple[MassProperties | None, list[str]]:
    """Mass properties about the set's reference point; none where only another datum or another axis leads there."""
    shift = among.reference_point - body.reference_point
    if body.datum != among.datum:
        return None, [
            f"mass properties left out: {body.name} counts from {shown(body.datum.id)}, the coefficients from "
            f"{shown(among.datum.id)}"
        ]
    if np.any(np.abs(shift[1:]) > 1e-6):
        return None, ["mass properties left out: the body states them about a point that no shift along x leads from"]
    if abs(shift[0]) <= 1e-6:
        return mass, []
    dx = float(shift[0])
    inertia = None if mass.inertia is None else mass.inertia - 2.0 * mass.mass_moment * dx + mass.mass * dx**2
    centre = None if mass.centre is None else mass.centre - shift
    matrix = None
    if centre is not None and mass.centre is not None and mass.inertia_matrix is not None:
        matrix = about_another(mass.inertia_matrix, mass.mass, mass.centre, centre)
    moved = MassProperties(mass.mass, mass.mass_moment - mass.mass * dx, inertia, centre, matrix)
    return moved, [f"mass properties moved by {dx:+.6g} m along x to the reference point"]


def assemble(
    group: PlannedParameterFile,
    study: str,
    fits: Sequence[FitResult],
    tables: Sequence[ForceTable],
    missing: Sequence[Coefficient],
    references: Sequence[Reference],
    body: Body | None,
    conditions: Conditions,
    inputs: Sequence[InputFile],
    found: Triangulation | None = None,
) -> ParameterFile:
    """Build the parameter file of a group of campaigns.

    Every force component comes from one fit, the first in the plan that gives it. Where two campaigns give one value
    the earlier in the plan counts, and a note says so; a fitted value comes before literature, and a symbol that
    neither gives is written with its status.

    Parameters
    ----------
    group : PlannedParameterFile
    study : str
        Its name, for the provenance.
    fits, tables, missing, references : sequence
        Of the whole study: results, what they were fitted to, coefficients that were asked for and not found, published values.
    body : Body or None
    conditions : Conditions
    inputs : sequence of InputFile
        Files that were read.
    found : Triangulation, optional
        Added mass; the potential part by the recommended method is booked in every coefficient.

    Raises
    ------
    ScalingMismatchError
        Campaigns of another body, scaling or reference point; a shape of another datum.
    """
    chosen = [f for name in group.campaigns for f in fits if f.campaign == name]
    if not chosen:
        raise InputError(
            "no campaign", "campaigns that the study fits", column=f"parameter_file.{group.name}.campaigns"
        )
    sets = [f.coefficients for f in chosen]
    first = sets[0]
    for s, f in zip(sets, chosen, strict=True):
        first.scaling.require(s.scaling)
        if f.body != group.body:
            raise ScalingMismatchError(f"{f.campaign} is about {f.body}, the parameter file {group.name} {group.body}.")
        if s.datum != first.datum:
            raise ScalingMismatchError(
                f"{chosen[0].campaign} measures points from {shown(first.datum.id)}, {f.campaign} from {shown(s.datum.id)}; "
                "nothing says how far apart they are. Give both the same datum; words of explanation go into datum_note."
            )
        if not np.allclose(s.reference_point, first.reference_point, atol=1e-9):
            raise ScalingMismatchError(
                f"{f.campaign} and {chosen[0].campaign} have other reference points; give the study a reference_point."
            )
    coefficients, covariance, notes = gathered(group, chosen, missing, references)
    models, repeated = recorded(chosen)
    notes += repeated
    if first.datum.note:
        notes.append(f"points count from {first.datum}")
    configuration = body.configuration(group.body) if body else None
    mass = configuration.mass if configuration else None
    if mass and body:
        mass, note = _mass_about(mass, body, first)
        notes += note
    prime = mass.primed(first.scaling, conditions.density) if mass else (1.0, 0.0)
    hull, record = None, None
    if found is not None:
        alike = likeness(
            found.body, group.body, configuration, own_file=body is not None and body.files == found.body.files
        )
        shape, label = found.body, ""
        if alike.same is False and shape.name == group.body:
            label = f"{shape.name}, of another shape"
        record = added_mass_record(found, first.reference_point, first.datum, group.body if alike.same else label)
        hull = record.as_noun(first.reference_point.tolist(), first.datum)
        if alike.same is None:
            notes.append(
                f"added mass is that of {shape.name}, the coefficients are those of {group.body}: whether both are one body is "
                f"not known ({alike.words})"
            )
        elif not alike.same:
            notes.append(
                f"added mass is that of {shape.name}, the coefficients are those of {group.body}: their potential parts are "
                f"those of another shape ({alike.words})"
            )
        elif shape.name != group.body:
            notes.append(
                f"added mass of {group.body} computed from the shape {shape.name} ({shape.title}): {alike.words}"
            )
    return ParameterFile(
        name=group.name,
        body=group.body,
        scaling=ParameterScaling(length=first.scaling.length, length_name=first.scaling.length_name),
        reference_point=ParameterPoint(point=tuple(map(float, first.reference_point)), datum=first.datum.id),
        conditions=ParameterConditions(
            density=conditions.density, speed=conditions.speed, viscosity=conditions.viscosity
        ),
        mass=ParameterMass(
            mass=mass.mass,
            mass_moment=mass.mass_moment,
            inertia=mass.inertia,
            mass_prime=prime[0],
            mass_moment_prime=prime[1],
            centre=None if mass.centre is None else _triple(mass.centre),
            inertia_matrix=None
            if mass.inertia_matrix is None
            else (
                _triple(mass.inertia_matrix[0]),
                _triple(mass.inertia_matrix[1]),
                _triple(mass.inertia_matrix[2]),
            ),
        )
        if mass
        else None,
        coefficients=tuple(
            _written(c, first.scaling, conditions, hull, found.density if found else 0.0) for c in coefficients
        ),
        covariance=ParameterCovariance(
            symbols=tuple(primed(c.symbol) for c in coefficients),
            matrix=tuple(tuple(None if np.isnan(v) else float(v) for v in row) for row in covariance),
        ),
        covered=_covered([t for t in tables if any(t.campaign in f.campaigns for f in chosen)], first.scaling.length),
        models=models,
        added_mass=record,
        provenance=Provenance(
            coeflab_version=VERSION,
            study=study,
            inputs=tuple(InputRecord(name=i.name, sha256=i.sha256) for i in inputs),
            citations=tuple(
                dict.fromkeys(
                    [k for c in coefficients if c.citation for k in c.citation.split(", ")]
                    + [k for f in chosen for k in f.citations]
                )
            ),
            notes=tuple(notes),
        ),
    )
