"""From fits and literature to one parameter file.

Which coefficients a parameter file holds: those of fits, of literature, and the wanted ones that nothing gives.

From fitted models to those of a parameter file.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import NDArray

from coeflab.core.axes import ANYWHERE
from coeflab.core.errors import ScalingMismatchError, shown
from coeflab.core.finding import Finding, Severity
from coeflab.core.texts import input_error, text_of
from coeflab.core.types import dataclass
from coeflab.core.version import VERSION
from coeflab.core.wording import finite
from coeflab.fits.glide_polar import with_munk
from coeflab.fits.results.fit_result import covariance_of
from coeflab.law.added_mass import potential_part
from coeflab.law.coefficient import FILED, Coefficient, Status
from coeflab.law.rigid_body import MassProperties
from coeflab.law.symbols import ANGULAR, CONTROLS, FLOW_ANGLES, LINEAR, derivative, primed
from coeflab.law.terms import Factor
from coeflab.vehicle.arm_curvatures import less_ideal_products
from coeflab.vehicle.drag_reynolds import drag_elsewhere
from coeflab.vehicle.driving_terms import without_driving_terms
from coeflab.vehicle.force_law import full_force, points_of, spoken
from coeflab.vehicle.law_at_points import caps, held_ranges, measured_tables, with_scatter
from coeflab.vehicle.parameter_file import CoveredRange, ParameterFile, ParameterPoint, Provenance
from coeflab.vehicle.parameter_model import ModelArea, ModelDomain, ModelTerm, ModelVariable, ParameterModel
from coeflab.vehicle.parameter_parts import ParameterCovariance, added_mass_record

if TYPE_CHECKING:
    from coeflab.bodies.body import Body
    from coeflab.bodies.triangulation import Triangulation
    from coeflab.core.provenance import InputFile
    from coeflab.fits.results.fit_result import FitResult
    from coeflab.fits.results.fitted_model import FittedModel
    from coeflab.law.added_mass import AddedMass
    from coeflab.law.coefficient import CoefficientSet
    from coeflab.law.scaling import Conditions, Scaling
    from coeflab.tables.force_table import ForceTable
    from coeflab.vehicle.reference import Reference


def _literature(
    group: PlannedParameterFile, references: Sequence[Reference], among: CoefficientSet
) -> list[Coefficient]:
    """Literature coefficients of a group, rescaled to its length, labelled with method and source."""
    out = []
    known = {r.name: r for r in references}
    for name in group.literature:
        if name not in known:
            raise input_error(
                "vehicle.unknown_reference", column=f"parameter_file.{group.name}.literature", name=shown(name),
                value=", ".join(known) or "none",
            )  # fmt: skip
        reference, point = known[name], among.reference_point
        if reference.literature and reference.reference_point is None:
            raise input_error(
                "vehicle.without_reference_point", column=f"parameter_file.{group.name}.literature", name=shown(name)
            )
        if reference.datum is not None and reference.datum != among.datum:
            raise ScalingMismatchError(
                f"{name} measures points from {shown(reference.datum.id)}, the parameter file from {shown(among.datum.id)}: "
                "literature values are taken only about their own point."
            )
        if reference.reference_point is not None and not np.allclose(reference.reference_point, point, atol=1e-9):
            raise ScalingMismatchError(
                f"{name} is about {tuple(reference.reference_point.tolist())}, the parameter file about {tuple(point.tolist())}: "
                "literature values are taken only about their own point."
            )
        for kind in reference.literature:
            for v in kind.values:
                value = None if v.value is None else v.value * reference.scaling.ratio(v.symbol, among.scaling)
                what = f"{kind.method} {kind.kind}, {reference.place}"
                out.append(
                    Coefficient(
                        symbol=v.symbol,
                        value=value,
                        u95=None if value is None else abs(value) * kind.uncertainty,
                        status=Status.STATED if value is not None else Status.NOT_DETERMINED,
                        body=reference.body,
                        origin="literature",
                        estimator=what if value is not None else f"{what}: printed {v.printed}, a digit is illegible",
                        citation=reference.citation,
                    )
                )
    return out


def _owners(chosen: Sequence[FitResult]) -> tuple[dict[str, str], list[str]]:
    """Which fit gives each force component, and notes on what the other fits give for it.

    Terms of one force law belong together: a linear term of one fit beside a quadratic one of another is the law of
    neither. An acceleration derivative stands by itself: oscillating runs add theirs to a law of steady forces.
    """
    owner: dict[str, str] = {}
    left: dict[tuple[str, str], list[str]] = {}
    for f in chosen:
        for c in f.coefficients.coefficients:
            component = derivative(c.symbol).component
            if _accelerates(c):
                continue
            if c.value is not None and owner.setdefault(component, f.law) != f.law:
                left.setdefault((component, f.fit), []).append(primed(c.symbol))
    return owner, [
        f"{component}' is that of {owner[component]}; left out, from {fit}: {', '.join(dict.fromkeys(symbols))}"
        for (component, fit), symbols in left.items()
    ]


def _accelerates(c: Coefficient) -> bool:
    return any(f.endswith("dot") for f in derivative(c.symbol).factors)


def gathered(
    group: PlannedParameterFile,
    chosen: Sequence[FitResult],
    missing: Sequence[Coefficient],
    references: Sequence[Reference],
) -> tuple[list[Coefficient], NDArray[np.float64], list[str]]:
    """The coefficients of a group, one of each symbol, with their covariance and notes on what was left out."""
    sets = [f.coefficients for f in chosen]
    first = sets[0]
    owner, notes = _owners(chosen)
    entries: dict[str, tuple[Coefficient, int, int]] = {}
    for k, s in enumerate(sets):
        for i, c in enumerate(s.coefficients):
            law = chosen[k].law
            if not _accelerates(c) and owner.get(derivative(c.symbol).component, law) != law:
                continue
            elsewhere = [s for s in _tied_to(chosen[k], i) if s not in entries or entries[s][0].campaign != c.campaign]
            if elsewhere:
                slopes = ", ".join(map(primed, elsewhere))
                notes.append(f"{primed(c.symbol)} of {c.campaign} left out: it is tied to another value of {slopes}")
                continue
            earlier = entries[c.symbol][0] if c.symbol in entries else None
            used, other = (
                (c, earlier) if earlier is None or (earlier.value is None and c.value is not None) else (earlier, c)
            )
            if other is not None and (other.value is not None or other.campaign != used.campaign):
                given = "no value" if other.value is None else f"{other.value:.6g}"
                notes.append(f"{primed(c.symbol)} from {used.campaign}; {other.campaign} gives {given}")
            if used is c:
                entries[c.symbol] = (c, k, i)
    extra = {c.symbol: c for c in _literature(group, references, first)}
    entries = {s: e for s, e in entries.items() if e[0].value is not None or s not in extra or extra[s].value is None}
    absent = [c for c in missing if c.campaign == ", ".join(group.campaigns) and c.body == group.body]
    coefficients = [c for c, _, _ in entries.values()]
    coefficients += [c for s, c in extra.items() if s not in entries]
    coefficients += [c for c in absent if c.symbol not in entries and c.symbol not in extra]
    covariance = np.diag([0.0 if c.u95 is None else (c.u95 / 2.0) ** 2 for c in coefficients])
    fitted = [i for i, c in enumerate(coefficients) if c.symbol in entries]
    starts = np.cumsum([0, *(len(s.coefficients) for s in sets)])
    rows = [int(starts[entries[coefficients[i].symbol][1]]) + entries[coefficients[i].symbol][2] for i in fitted]
    covariance[np.ix_(fitted, fitted)] = covariance_of(chosen)[np.ix_(rows, rows)]
    void = np.array([c.u95 is None for c in coefficients], dtype=bool)
    covariance[void, :] = covariance[:, void] = np.nan
    return coefficients, covariance, notes


def _tied_to(f: FitResult, row: int) -> list[str]:
    """Slopes and curvatures in the same motions that a term was tied to."""
    if f.tied is None:
        return []
    motions = set(derivative(f.coefficients.coefficients[row].symbol).factors)
    held = zip(f.tied.symbols, f.tied.moves[row], strict=True)
    return [s for s, move in held if move and motions & set(derivative(s).factors)]


ANGLES = ("alpha", "beta")


def _variable_unit(name: str, unit: str) -> str:
    """Angles in radians; velocities and rates primed in a nondimensional model, SI in a dimensional one; else 1."""
    if name in LINEAR:
        return "1" if unit == "1" else "m/s"
    if name in ANGULAR:
        return "1" if unit == "1" else "rad/s"
    return "rad" if name in (*ANGLES, *CONTROLS) else "1"


def record(model: FittedModel, area: ModelArea | None = None) -> ParameterModel:
    """A fitted model as the parameter file holds it.

    The covariance is that of standard uncertainties, half_width_95 / 2, as everywhere in the file. A half-width of a
    point is then twice the root of its variance, and for one term alone the term's own.
    """
    names = model.domain.variables
    return ParameterModel.model_validate(
        {
            "response": model.response,
            "unit": model.unit,
            "form": model.form,
            "variables": tuple(
                ModelVariable.model_validate({"name": v, "unit": _variable_unit(v, model.unit)}) for v in names
            ),
            "terms": tuple(
                ModelTerm(
                    symbol=s, factors=tuple(Factor(*f) for f in t.factors), value=finite(c), half_width_95=finite(h)
                )
                for s, t, c, h in zip(model.symbols, model.terms, model.fit.coefficients, model.half_width, strict=True)
            ),
            "holds": ("random", *(("model form",) if model.remainder is not None else ()), *model.shared),
            "covariance": tuple(tuple(finite(x) for x in row) for row in model.covariance),
            "domain": ModelDomain(
                low=tuple(map(float, model.domain.low)),
                high=tuple(map(float, model.domain.high)),
                half_spaces=tuple(tuple(map(float, row)) for row in model.domain.spaces),
                extrapolation=model.domain.rule.value,
            ),
            "n_points": model.n_points,
            "rms": model.fit.rms,
            "press_rms": finite(model.fit.press_rms),
            "table": model.table,
            "campaign": model.campaign,
            "post_selection": model.post_selection,
            "statements": (*model.statements, *(f"{FLOW_ANGLES[v]}." for v in names if v in FLOW_ANGLES)),
            "area": area,
        }
    )


def recorded(fits: Sequence[FitResult]) -> tuple[tuple[ParameterModel, ...], list[str]]:
    """The models of some fits, and notes on those that repeat a response over the same variables.

    Of such models the earliest in the plan counts, as with coefficients. A fit of area coefficients names the area in
    its settings ``area`` (m^2) and ``area_name``.
    """
    out: dict[tuple[str, tuple[str, ...]], ParameterModel] = {}
    notes = []
    for f in fits:
        area = None
        if "area" in f.settings:
            area = ModelArea(value=float(f.settings["area"]), name=f.settings["area_name"])
        for model in f.models:
            key = (model.response, model.domain.variables)
            if key in out:
                selected = out[key]
                notes.append(
                    f"{model.response} over {', '.join(key[1])}: {selected.form} of {selected.campaign} is kept, {model.form} of "
                    f"{model.campaign} is in the report only"
                )
            else:
                out[key] = record(model, area if model.unit == "1" else None)
    return tuple(out.values()), notes


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
    return without_driving_terms(with_points(result, mine, chosen), lambda p: with_points(p, mine, chosen))


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


@dataclass(frozen=True, slots=True)
class PlannedParameterFile:
    """One ``[[parameter_file]]``: which campaigns, which literature and whose added mass it holds.

    Attributes
    ----------
    name, body : str
    campaigns, literature : tuple of str
    hull : Path or None
        The body.toml of the added mass.
    method : str
        ``all`` recommends one by the stated rule, else a method's name.
    base : Path or None
        A parameter file that holds what the campaigns do not give.
    """

    name: str
    body: str
    campaigns: tuple[str, ...]
    literature: tuple[str, ...]
    hull: Path | None = None
    method: str = "all"
    base: Path | None = None
