"""From fits and literature to one parameter file."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from coeflab.core.errors import InputError, ScalingMismatchError, shown
from coeflab.core.provenance import InputFile
from coeflab.core.symbols import derivative, primed
from coeflab.core.version import VERSION
from coeflab.model.body import Body, MassProperties
from coeflab.model.coefficient import Coefficient, CoefficientSet, Status
from coeflab.model.fit_result import FitResult
from coeflab.model.force_table import ForceTable
from coeflab.model.model_record import recorded
from coeflab.model.parameter_file import (
    CoveredRange,
    InputRecord,
    ParameterCoefficient,
    ParameterConditions,
    ParameterCovariance,
    ParameterFile,
    ParameterMass,
    ParameterPoint,
    ParameterScaling,
    Provenance,
    UncertaintyParts,
)
from coeflab.model.reference import Reference
from coeflab.model.scaling import Conditions, Scaling
from coeflab.model.study import PlannedParameterFile


def _written(c: Coefficient, scaling: Scaling, conditions: Conditions) -> ParameterCoefficient:
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
    )


def _literature(
    group: PlannedParameterFile, references: Sequence[Reference], scaling: Scaling, point: NDArray[np.float64]
) -> list[Coefficient]:
    """Literature coefficients of a group, rescaled to its length, labelled with method and source."""
    out = []
    known = {r.name: r for r in references}
    for name in group.literature:
        if name not in known:
            raise InputError(
                f"no reference {shown(name)}", f"one of {', '.join(known) or 'none'}",
                column=f"parameter_file.{group.name}.literature",
            )  # fmt: skip
        reference = known[name]
        if reference.reference_point is not None and not np.allclose(reference.reference_point, point, atol=1e-9):
            raise ScalingMismatchError(
                f"{name} is about {tuple(reference.reference_point)}, the parameter file about {tuple(point)}: "
                "literature values are taken only about their own point."
            )
        for kind in reference.literature:
            for v in kind.values:
                value = None if v.value is None else v.value * reference.scaling.ratio(v.symbol, scaling)
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


def _owners(chosen: Sequence[FitResult]) -> tuple[dict[str, str], list[str]]:
    """Which fit gives each force component, and notes on what the other fits give for it.

    Terms of one force law belong together: a linear term of one fit beside a quadratic one of another is the law of
    neither.
    """
    owner: dict[str, str] = {}
    left: dict[tuple[str, str], list[str]] = {}
    for f in chosen:
        for c in f.coefficients.coefficients:
            component = derivative(c.symbol).component
            if c.value is not None and owner.setdefault(component, f.fit) != f.fit:
                left.setdefault((component, f.fit), []).append(primed(c.symbol))
    return owner, [
        f"{component}' is that of {owner[component]}; left out, from {fit}: {', '.join(dict.fromkeys(symbols))}"
        for (component, fit), symbols in left.items()
    ]


def _mass_about(mass: MassProperties, body: Body, among: CoefficientSet) -> tuple[MassProperties | None, list[str]]:
    """Mass properties about the set's reference point; none where only another datum or another axis leads there."""
    shift = among.reference_point - body.reference_point
    if body.datum != among.datum or np.any(np.abs(shift[1:]) > 1e-6):
        return None, ["mass properties left out: the body states them about a point that no shift along x leads from"]
    if abs(shift[0]) <= 1e-6:
        return mass, []
    dx = float(shift[0])
    inertia = None if mass.inertia is None else mass.inertia - 2.0 * mass.mass_moment * dx + mass.mass * dx**2
    moved = MassProperties(mass.mass, mass.mass_moment - mass.mass * dx, inertia)
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
) -> ParameterFile:
    """Build the parameter file of a group of campaigns.

    Every force component comes from one fit, the first in the plan that gives it. Where two campaigns give one value
    the earlier in the plan counts, and a note says so; a fitted value comes before literature, and a symbol that
    neither gives is written with its status.

    Raises
    ------
    ScalingMismatchError
        Campaigns of another body, scaling or reference point.
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
        if s.datum != first.datum or not np.allclose(s.reference_point, first.reference_point, atol=1e-9):
            raise ScalingMismatchError(
                f"{f.campaign} and {chosen[0].campaign} have other reference points; give the study a reference_point."
            )
    owner, notes = _owners(chosen)
    entries: dict[str, tuple[Coefficient, int, int]] = {}
    for k, s in enumerate(sets):
        for i, c in enumerate(s.coefficients):
            if owner.get(derivative(c.symbol).component, chosen[k].fit) != chosen[k].fit:
                continue
            earlier = entries[c.symbol][0] if c.symbol in entries else None
            used, other = (
                (c, earlier) if earlier is None or (earlier.value is None and c.value is not None) else (earlier, c)
            )
            if other is not None:
                given = "no value" if other.value is None else f"{other.value:.6g}"
                notes.append(f"{primed(c.symbol)} from {used.campaign}; {other.campaign} gives {given}")
            if used is c:
                entries[c.symbol] = (c, k, i)
    extra = {c.symbol: c for c in _literature(group, references, first.scaling, first.reference_point)}
    entries = {s: e for s, e in entries.items() if e[0].value is not None or s not in extra or extra[s].value is None}
    absent = [c for c in missing if c.campaign == ", ".join(group.campaigns) and c.body == group.body]
    coefficients = [c for c, _, _ in entries.values()]
    coefficients += [c for s, c in extra.items() if s not in entries]
    coefficients += [c for c in absent if c.symbol not in entries and c.symbol not in extra]
    covariance = np.zeros((len(coefficients), len(coefficients)))
    for i, c in enumerate(coefficients):
        if c.symbol in entries:
            _, k, row = entries[c.symbol]
            for j, d in enumerate(coefficients):
                if d.symbol in entries and entries[d.symbol][1] == k:
                    covariance[i, j] = sets[k].covariance[row, entries[d.symbol][2]]
        elif c.u95 is not None:
            covariance[i, i] = (c.u95 / 2.0) ** 2
    void = np.array([c.u95 is None for c in coefficients], dtype=bool)
    covariance[void, :] = covariance[:, void] = np.nan
    models, repeated = recorded(chosen)
    notes += repeated
    configuration = body.configuration(group.body) if body else None
    mass = configuration.mass if configuration else None
    if mass and body:
        mass, note = _mass_about(mass, body, first)
        notes += note
    prime = mass.primed(first.scaling, conditions.density) if mass else (1.0, 0.0)
    return ParameterFile(
        name=group.name,
        body=group.body,
        scaling=ParameterScaling(length=first.scaling.length, length_name=first.scaling.length_name),
        reference_point=ParameterPoint(point=tuple(map(float, first.reference_point)), datum=first.datum),
        conditions=ParameterConditions(
            density=conditions.density, speed=conditions.speed, viscosity=conditions.viscosity
        ),
        mass=ParameterMass(
            mass=mass.mass,
            mass_moment=mass.mass_moment,
            inertia=mass.inertia,
            mass_prime=prime[0],
            mass_moment_prime=prime[1],
        )
        if mass
        else None,
        coefficients=tuple(_written(c, first.scaling, conditions) for c in coefficients),
        covariance=ParameterCovariance(
            symbols=tuple(primed(c.symbol) for c in coefficients),
            matrix=tuple(tuple(None if np.isnan(v) else float(v) for v in row) for row in covariance),
        ),
        covered=_covered([t for t in tables if t.campaign in group.campaigns], first.scaling.length),
        models=models,
        provenance=Provenance(
            coeflab_version=VERSION,
            study=study,
            inputs=tuple(InputRecord(name=i.name, sha256=i.sha256) for i in inputs),
            citations=tuple(
                dict.fromkeys(
                    [c.citation for c in coefficients if c.citation] + [k for f in chosen for k in f.citations]
                )
            ),
            notes=tuple(notes),
        ),
    )
