"""From fits and literature to one parameter file."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Literal

import numpy as np

from coeflab.core.axes import ANYWHERE
from coeflab.core.errors import ScalingMismatchError, shown
from coeflab.core.finding import Finding, Severity
from coeflab.core.texts import input_error, text_of
from coeflab.core.version import VERSION
from coeflab.fits.glide_polar import with_munk
from coeflab.law.added_mass import AddedMass, potential_part
from coeflab.law.coefficient import FILED, Coefficient, CoefficientSet
from coeflab.law.rigid_body import MassProperties
from coeflab.law.symbols import derivative, primed
from coeflab.vehicle.arm_curvatures import less_ideal_products
from coeflab.vehicle.drag_reynolds import drag_elsewhere
from coeflab.vehicle.driving_terms import without_driving_terms
from coeflab.vehicle.force_law import full_force, points_of, spoken
from coeflab.vehicle.gathered import PlannedParameterFile, gathered
from coeflab.vehicle.law_at_points import caps, held_ranges, measured_tables, with_scatter
from coeflab.vehicle.not_in_law import not_in_law
from coeflab.vehicle.parameter_file import CoveredRange, ParameterFile, ParameterPoint, Provenance
from coeflab.vehicle.parameter_parts import ParameterCovariance, added_mass_record
from coeflab.vehicle.recorded import recorded

if TYPE_CHECKING:
    from coeflab.bodies.body import Body
    from coeflab.bodies.triangulation import Triangulation
    from coeflab.core.provenance import InputFile
    from coeflab.fits.results.fit_result import FitResult
    from coeflab.law.scaling import Conditions, Scaling
    from coeflab.tables.force_table import ForceTable
    from coeflab.vehicle.published_values import Reference


def _written(c: Coefficient, scaling: Scaling, conditions: Conditions, hull: AddedMass | None) -> Coefficient:
    """The coefficient as the file holds it: with its prime, its SI value and its potential part."""
    si = None if c.value is None else c.value * scaling.unit(c.symbol, conditions.density, conditions.speed)
    booked = hull is not None and c.value is not None and c.law != "rest"
    potential = potential_part(c.symbol, hull, scaling, hull.density) if booked and hull is not None else None
    return replace(
        c, symbol=primed(c.symbol), value_si=si, unit_si=derivative(c.symbol).unit, potential=potential,
        status=FILED.get(c.status, c.status),
    )  # fmt: skip


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


def _mass_about(mass: MassProperties, body: Body, among: CoefficientSet) -> tuple[MassProperties | None, list[str]]:
    """Mass properties about the set's reference point; none where only another datum or another axis leads there."""
    shift = among.reference_point - body.reference_point
    if body.datum != among.datum:
        return None, [
            f"mass properties left out: {body.name} is measured from {shown(body.datum.id)}, the coefficients from "
            f"{shown(among.datum.id)}"
        ]
    if np.any(np.abs(shift[1:]) > 1e-6):
        return None, ["mass properties left out: the body states them about a point that differs in more than x"]
    if abs(shift[0]) <= 1e-6:
        return mass, []
    return mass.moved(shift), [f"mass properties moved by {shift[0]:+.6g} m along x to the reference point"]


def _from_one_datum(
    chosen: list[FitResult], tables: Sequence[ForceTable], body: Body | None
) -> tuple[CoefficientSet, list[FitResult], list[ForceTable]]:
    """The set whose point counts, fits and tables, where what holds about every point is about that one."""
    first = next((f.coefficients for f in chosen if f.coefficients.datum != ANYWHERE), chosen[0].coefficients)
    if body is not None:
        first = first.counted_from(body.datum, body.reference_point)
    at = (first.datum, first.reference_point)
    fits = [
        f if f.coefficients.datum != ANYWHERE else replace(f, coefficients=f.coefficients.counted_from(*at))
        for f in chosen
    ]
    return first, fits, [t.counted_from(*at) for t in tables]


def _unequipped(body: Body | None, name: str) -> Iterator[Finding]:
    """That masses, thrusters and controls of a body are left out, as the file is of none of its configurations."""
    if body is None or body.configuration(name) is not None:
        return
    what = [
        f"{len(found)} {word}{'s' * (len(found) > 1)}"
        for word, found in (("thruster", body.thrusters), ("control", body.controls))
        if found
    ]
    if what := ["mass"] * any(c.mass is not None for c in body.configurations) + what:
        known = tuple(
            dict.fromkeys(
                (*([body.name] if body.mass_model is not None else []), *(c.name for c in body.configurations))
            )
        )
        yield Finding.of(
            "parameter_file.unequipped", name, Severity.WARN, advice=f'campaign.body = "{known[0]}"', body=body.name, lacks=tuple(what),
            configurations=known,
        )  # fmt: skip


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

    A body that states both centres of the configuration gives buoyancy, thrusters and limits of controls, too. Every force component comes from one fit, the first in the plan that gives it. Where two campaigns give one value
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
        raise input_error("vehicle.no_campaign", column=f"parameter_file.{group.name}.campaigns")
    first, chosen, tables = _from_one_datum(chosen, tables, body)
    sets = [f.coefficients for f in chosen]
    for s, f in zip(sets, chosen, strict=True):
        first.scaling.require(s.scaling)
        if f.body != group.body:
            raise ScalingMismatchError(f"{f.campaign} is about {f.body}, the parameter file {group.name} {group.body}.")
        if s.datum != first.datum:
            raise ScalingMismatchError(
                f"{chosen[0].campaign} measures points from {shown(first.datum.id)}, {f.campaign} from {shown(s.datum.id)}; "
                "their distance is not stated. Give both the same datum; explain it in datum_note."
            )
        if not np.allclose(s.reference_point, first.reference_point, atol=1e-9):
            raise ScalingMismatchError(
                f"{f.campaign} and {chosen[0].campaign} have other reference points; give the study a reference_point."
            )
    coefficients, covariance, notes = gathered(group, chosen, missing, references)
    models, repeated = recorded(chosen)
    notes += repeated
    notes += [
        f"Mw and Mwww, and M of the points: {f.campaign} holds no Munk moment, {float(f.settings['munk']):g} kg u w is added"
        for f in chosen
        if "munk" in f.settings
    ]
    if first.datum.note:
        notes.append(f"points are measured from {first.datum}")
    configuration = body.configuration(group.body) if body else None
    mass = configuration.mass if configuration else None
    if mass and body:
        mass, note = _mass_about(mass, body, first)
        notes += note
    hull = None
    if found is not None:
        from coeflab.bodies.mesh.particulars import likeness

        alike = likeness(
            found.body, group.body, configuration, own_file=body is not None and body.files == found.body.files
        )
        shape, label = found.body, ""
        if alike.same is False and shape.name == group.body:
            label = f"{shape.name}, of another shape"
        hull = added_mass_record(found, first.reference_point, first.datum, group.body if alike.same else label)
        if alike.same is None:
            notes.append(text_of("vehicle.bodies_not_known_alike", name=shape.name, body=group.body, words=alike.words))
        elif not alike.same:
            notes.append(
                text_of("vehicle.added_mass_of_another_shape", name=shape.name, body=group.body, words=alike.words)
            )
        elif shape.name != group.body:
            notes.append(
                f"added mass of {group.body} computed from the shape {shape.name} ({shape.title}): {alike.words}"
            )
    found_by_fits = list(dict.fromkeys(f for fit in chosen for f in fit.findings))
    coefficients, found_by_fits = less_ideal_products(coefficients, found_by_fits, hull, first.scaling)
    result = ParameterFile(
        name=group.name,
        body=group.body,
        scaling=first.scaling,
        reference_point=ParameterPoint(point=tuple(map(float, first.reference_point)), datum=first.datum.id),
        conditions=conditions,
        mass=mass.primed(first.scaling, conditions.density) if mass else None,
        coefficients=tuple(_written(c, first.scaling, conditions, hull) for c in coefficients),
        covariance=ParameterCovariance(
            symbols=tuple(primed(c.symbol) for c in coefficients),
            matrix=tuple(tuple(None if np.isnan(v) else float(v) for v in row) for row in covariance),
        ),
        covered=_covered([t for t in tables if any(t.campaign in f.campaigns for f in chosen)], first.scaling.length),
        models=models,
        added_mass=hull,
        findings=tuple(
            dict.fromkeys(
                [
                    *found_by_fits,
                    *(() if found is None else found.findings),
                    *(() if configuration is None or mass is None else configuration.findings),
                    *drag_elsewhere(coefficients, tables, conditions, first.scaling.length),
                    *_unequipped(body, group.body),
                ]
            )
        ),
        provenance=Provenance(
            coeflab_version=VERSION,
            study=study,
            inputs=tuple(inputs),
            citations=tuple(
                dict.fromkeys(
                    [k for c in coefficients if c.citation for k in c.citation.split(", ")]
                    + [k for f in chosen for k in f.citations]
                )
            ),
            notes=tuple(notes),
        ),
    )
    if (
        body is not None
        and configuration is not None
        and configuration.mass is not None
        and configuration.mass.centre is not None
    ):
        from coeflab.vehicle.from_shape import equipped

        result = equipped(result, body, configuration)
    munk = {f.campaign: float(f.settings["munk"]) for f in chosen if "munk" in f.settings}
    about = [
        with_munk(t.about(first.reference_point), munk.get(t.campaign, 0.0)) for t in tables if t.datum == first.datum
    ]
    mine = [t for t in about if any(t.campaign in f.campaigns for f in chosen)]
    result = without_driving_terms(with_points(result, mine, chosen), lambda p: with_points(p, mine, chosen))
    left = tuple(not_in_law(mine, spoken(result).by_component, result.scaling.length))
    return result.model_copy(update={"findings": (*result.findings, *left)})


def with_points(parameters: ParameterFile, tables: Sequence[ForceTable], fits: Sequence[FitResult]) -> ParameterFile:
    """The file with the points behind its law, where the law holds and how far it is from them.

    Parameters
    ----------
    parameters : ParameterFile
    tables : sequence of ForceTable
        About the file's reference point.
    fits : sequence of FitResult
        Which took off what forces at rest.
    """
    length, law, force = parameters.scaling.length, spoken(parameters), full_force(parameters)
    measured = measured_tables(
        tables, fits, law.by_table, law.together, law.constants, length, parameters.conditions.density
    )
    measured = with_scatter(measured, force, length)
    held = held_ranges(measured, caps(measured, force, length, law.beyond_slopes), length)
    result = parameters.model_copy(update={"measured": measured, "law_holds": held})
    return result.model_copy(update={"law_at_points": points_of(result)})
