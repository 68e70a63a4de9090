"""The hydrodynamic force that a parameter file states, as a law of terms: the sum over its sources.

Coefficients, fitted tables, controls and the ideal fluid each speak of products of variables (`coeflab.vehicle.sources`), and
their forces add up. Measured terms are taken as measured, potential part and all. Where an added-mass matrix is known, those
products of two velocities that no source speaks of get their share of -C_A(nu) nu of the added mass that the vehicle moves
with (`coeflab.vehicle.inertia`), so that nothing is counted twice and nothing known is left out.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from coeflab.core.errors import InputError
from coeflab.core.finding import Finding, Severity
from coeflab.core.types import Array, dataclass
from coeflab.law.force_law import AHEAD, ForceLaw, ForceTerm, Reading
from coeflab.law.rigid_body import ideal_quadratics
from coeflab.law.scaling import powers_of
from coeflab.law.symbols import ANGULAR, COMPONENTS, CONTROLS, LINEAR, MOTIONS, derivative
from coeflab.law.terms import Factor, Term, parse_suffix
from coeflab.vehicle.inertia import water_inertia
from coeflab.vehicle.law_at_points import LawAtPoints, law_at_points
from coeflab.vehicle.sources import Sources, acts_in, moved_by, name_of, steered, still_known, summed

if TYPE_CHECKING:
    from coeflab.vehicle.parameter_file import ParameterFile
    from coeflab.vehicle.parameter_model import ParameterModel

EDGE = "law.edge"  # the one finding of a law that is not about what it leaves out
LONG = 9  # a table is more than slopes


def stated_terms(parameters: ParameterFile) -> tuple[ForceTerm, ...]:
    """Every coefficient of a file with a value, controls included, but those of accelerations; at the file's density.

    Literature values stand in where nothing was fitted, as in the file. An X that has only V in it, such as X0', turns with the
    course: drag astern too.
    """
    at, out = parameters.conditions, []
    for c in parameters.coefficients:
        d = derivative(c.symbol)
        if c.value is None or _accelerates(d.factors):
            continue
        rest = c.law == "rest" and c.value_si is not None
        unit = parameters.scaling.unit(d.text, at.density, at.speed if c.law == "rest" and not c.value else 1.0)
        value = c.value_si if rest and c.value_si is not None else unit * c.value
        per_prime = value / c.value if rest and c.value else unit
        result = ForceTerm(
            d.text,
            d.component,
            parse_suffix(d.text[1:]),
            value,
            0 if rest else powers_of(d.text)[0],
            per_prime,
            "rest" if rest else "prime",
            c.value,
            None if c.potential is None else c.potential * per_prime,
            note=c.origin if c.u95 is None else f"U95 {c.u95:.2g}, {c.origin}",
        )
        resists = result.component == "X" and not result.variables and result.speed_power == 2
        out.append(replace(result, term=Term((Factor("u", 1),)), readings=(("u", AHEAD),)) if resists else result)
    return tuple(out)


def _accelerates(factors: tuple[str, ...]) -> bool:
    return any(f.endswith("dot") for f in factors)


def sources_of(parameters: ParameterFile, tables: bool = False) -> Sources:
    """The sources that add up to the force of a file.

    Parameters
    ----------
    parameters : ParameterFile
    tables : bool
        Whether fitted tables come first, see `coeflab.vehicle.sources.summed`.

    Raises
    ------
    InputError
        Two tables speak of the same products.
    """
    return summed(stated_terms(parameters), parameters.models, tables, parameters.schema_version)


def steered_terms(parameters: ParameterFile) -> tuple[ForceTerm, ...]:
    """The coefficients of controls in the law."""
    return tuple(t for t in sources_of(parameters).terms if steered(t) and t.coefficient)


def force_law(parameters: ParameterFile) -> ForceLaw:
    """The part of the law that coefficients and the ideal fluid hold, no control deflected: what targets without tables take.

    Products that a fitted table of the law speaks of are in neither.
    """
    sources = sources_of(parameters)
    terms = tuple(t for t in sources.terms if not steered(t))
    texts = [derivative(c.symbol) for c in parameters.coefficients if c.value is not None]
    left_out = tuple(d.text for d in texts if _accelerates(d.factors) or any(f in CONTROLS for f in d.factors))
    return ForceLaw(terms, _ideal(parameters, sources), left_out)


def _ideal(parameters: ParameterFile, sources: Sources) -> Array:
    """(6, 6, 6) products of the ideal fluid that no source speaks of."""
    if parameters.added_mass is None:
        return np.zeros((6, 6, 6))
    return np.where(sources.open_products(), ideal_quadratics(water_inertia(parameters).matrix), 0.0)


def ideal_terms(parameters: ParameterFile) -> tuple[ForceTerm, ...]:
    """The products of the ideal fluid in the law, each once."""
    ideal, density, out = force_law(parameters).ideal, parameters.conditions.density, []
    for i, j, k in np.argwhere(np.triu(ideal)):
        value, name = float(ideal[i, j, k] * (1.0 if j == k else 2.0)), COMPONENTS[i] + MOTIONS[j] + MOTIONS[k]
        unit = parameters.scaling.unit(name, density)
        term = parse_suffix(name[1:])
        out.append(ForceTerm(name, COMPONENTS[i], term, value, 0, unit, "potential", float(value / unit)))
    return tuple(out)


def motion_law(parameters: ParameterFile, tables: bool = False) -> tuple[ForceLaw, tuple[Finding, ...]]:
    """The law of a file, controls and fitted tables in it, and what was found: what it does not use, where its tables end.

    Simulation, trim, tuning, checks, exports and their losses move by this one law.

    Parameters
    ----------
    parameters : ParameterFile
    tables : bool
        Whether a table stands before the coefficients of its variables, even where these cover all of them.

    Raises
    ------
    InputError
        Two tables speak of the same products.
    """
    sources = sources_of(parameters, tables)
    fitted, found = _fitted(sources, parameters)
    terms = (*sorted(sources.terms, key=steered), *fitted)
    return ForceLaw(terms, _ideal(parameters, sources)), (*sources.findings, *found)


def known_with_terms(
    parameters: ParameterFile, terms: Sequence[tuple[str, str, Term]]
) -> tuple[ForceLaw, tuple[Finding, ...]]:
    """The fitted tables of a file that stay known where terms of its force are found from data, and those that do not.

    Parameters
    ----------
    parameters : ParameterFile
    terms : sequence of (symbol, component, Term)
        To be found.
    """
    sources = still_known(parameters.models, [(s, c, moved_by(v for v, _, _ in t.factors)) for s, c, t in terms])
    fitted, found = _fitted(sources, parameters)
    return ForceLaw(fitted, np.zeros((6, 6, 6))), (*sources.findings, *found)


def not_used(parameters: ParameterFile, tables: bool = False) -> tuple[Finding, ...]:
    """What of a file its law leaves out, or takes otherwise than the file was written for."""
    return tuple(f for f in motion_law(parameters, tables)[1] if f.code != EDGE)


def _fitted(sources: Sources, parameters: ParameterFile) -> tuple[tuple[ForceTerm, ...], tuple[Finding, ...]]:
    out: list[ForceTerm] = []
    found = [
        Finding.of("law.no_force", name_of(m), Severity.NOTE)
        for m in parameters.models
        if not m.place and not _by_coefficients(m, parameters)
    ]
    ends: dict[str, list[str]] = {}
    for s in sources.tables:
        m = s.model
        component, scale, power = _place(m, parameters)
        hull, length = m.hull, parameters.scaling.length
        together = "" if hull.is_box and hull.rule != "taper" else name_of(m)
        readings = _readings(m, length, together)
        void = all(t.value is None for t in m.terms)  # its first term keeps its domain in the law
        for k, t in enumerate(m.terms):
            name, value = f"{m.response} {t.symbol}", t.value or 0.0
            if t.value is None:
                found.append(Finding.of("law.undetermined", name, Severity.NOTE))
                if k or not void:
                    continue
            out.append(
                ForceTerm(
                    name, component, Term(t.factors), scale * value, power, scale, "table", value, readings=readings, hull=hull, into=s.into
                )
            )  # fmt: skip
        ends.setdefault(hull.rule, []).append(m.response)
    found += [
        Finding.of(EDGE, ", ".join(dict.fromkeys(names)), Severity.NOTE, rule=rule) for rule, names in ends.items()
    ]
    return tuple(out), tuple(found)


def _by_coefficients(model: ParameterModel, parameters: ParameterFile) -> bool:
    """Whether coefficients of the file state what a table of a polar or a slope does; lift and drag are X and Z."""
    name = model.response.removesuffix("/V^2").removesuffix("'")
    needed = set("XZ") if name in ("L", "D") else {name}
    stated = {derivative(c.symbol).component for c in parameters.coefficients if c.value is not None}
    return needed <= stated


def _place(model: ParameterModel, parameters: ParameterFile) -> tuple[str, float, int]:
    """Component, SI force of one unit of the response, power of the speed."""
    pressure, length = 0.5 * parameters.conditions.density, parameters.scaling.length
    component = model.place
    arm = length if component in "KMN" else 1.0
    if model.unit != "1":
        return component, 1.0, 0
    return component, pressure * (model.area.value if model.area else length**2) * arm, 2


def _readings(model: ParameterModel, length: float, together: str) -> tuple[tuple[str, Reading], ...]:
    """How the variables are read: each within its range where the hull is a box, else all of a table together."""
    out = []
    for v, low, high in zip(model.variables, model.domain.low, model.domain.high, strict=True):
        prime = 0.0
        if v.unit == "1":
            prime = 1.0 if v.name in LINEAR else length if v.name in ANGULAR else 0.0
        out.append((v.name, Reading(prime, table=together) if together else Reading(prime, low, high, True)))
    return tuple(out)


def force_at_edges(parameters: ParameterFile) -> Callable[[Array, Array], Array]:
    """As `full_force`, with the value at the edge where a table refuses to be read: what a motion goes by until it ends there."""
    return motion_law(parameters)[0].force


def full_force(parameters: ParameterFile) -> Callable[[Array, Array], Array]:
    """Velocities (n, 6) and controls (n, 3) -> forces (n, 6): the law that a simulation of the file moves by.

    NaN where a table refuses to be read beyond its data.
    """
    return replace(motion_law(parameters)[0], strict=True).force


def points_of(parameters: ParameterFile) -> tuple[LawAtPoints, ...]:
    """How far the law of a file, as it is now, is from the points in it."""
    length = parameters.scaling.length
    return law_at_points(parameters.measured, parameters.law_holds, force_at_edges(parameters), length)


@dataclass(frozen=True, slots=True)
class Spoken:
    """What the law of a file was fitted to.

    Attributes
    ----------
    by_table : mapping of (component, table) to set of variables
        Motions and controls that the component's terms from that table speak of.
    by_component : mapping of component to set of variables
        The same of all tables and of none.
    together : mapping of component to sets of variables
        Motions that one term combines.
    constants : frozenset of str
        Components with a force at rest in the law.
    beyond_slopes : mapping of component to set of variables
        In which the law has more than slopes and curvatures.
    """

    by_table: Mapping[tuple[str, str], frozenset[str]]
    by_component: Mapping[str, frozenset[str]]
    together: Mapping[str, tuple[frozenset[str], ...]]
    constants: frozenset[str]
    beyond_slopes: Mapping[str, frozenset[str]]


def spoken(parameters: ParameterFile) -> Spoken:
    """The motions that the fitted terms of a file speak of; of acceleration derivatives and literature none."""
    none: frozenset[str] = frozenset()
    by_table: dict[tuple[str, str], frozenset[str]] = {}
    together: dict[str, tuple[frozenset[str], ...]] = {}
    higher: dict[str, frozenset[str]] = {}
    constants, unused = set(), {t.symbol for t in sources_of(parameters).unused_terms}
    parts: list[tuple[str, str, frozenset[str], int]] = []
    for c in parameters.coefficients:
        d = derivative(c.symbol)
        if c.value is None or c.law == "rest" or _accelerates(d.factors) or d.text in unused:
            continue
        moved = frozenset(d.factors) - {"u"}
        constants |= {d.component} if not moved else set()
        parts.append((d.component, c.table or "", moved, len(d.factors)))
    sources = sources_of(parameters)
    for s in sources.tables:
        for component in s.components:
            constants.add(component)
            parts.append((component, s.model.table, acts_in(s.model)[component], LONG))
    by_component: dict[str, frozenset[str]] = {}
    for component, tables, moved, degree in parts:
        by_component[component] = by_component.get(component, none) | moved
        for table in filter(None, tables.split(", ")):
            by_table[component, table] = by_table.get((component, table), none) | moved
        if len(moved) > 1:
            together[component] = (*together.get(component, ()), moved)
        if degree > (2 if component == "X" else 1):
            higher[component] = higher.get(component, none) | moved
    return Spoken(by_table, by_component, together, frozenset(constants), higher)


def force_of_tables(parameters: ParameterFile, nu: Array) -> Array | None:
    """(n, 6) of the fitted tables in the law alone; None where there is none."""
    law, _ = motion_law(parameters)
    tabled = tuple(t for t in law.terms if t.kind == "table")
    return ForceLaw(tabled, np.zeros((6, 6, 6))).force(nu) if tabled else None


def ahead_from(parameters: ParameterFile) -> int | None:
    """Drift from which the law of a file gives an X that points ahead, whole deg; None where it never does up to 90 deg.

    Parameters
    ----------
    parameters : ParameterFile
    """
    drift = np.radians(np.arange(91.0))
    motions = np.zeros((len(drift), 6))
    motions[:, 0], motions[:, 1] = np.cos(drift), np.sin(drift)
    try:
        law = force_at_edges(parameters)
    except InputError:  # a manoeuvre says why nothing moves by it
        return None
    ahead = law(parameters.conditions.speed * motions, np.zeros((len(drift), 3)))[:, 0] > 0.0
    return int(np.argmax(ahead)) if ahead.any() else None
