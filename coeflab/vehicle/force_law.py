"""The hydrodynamic force that a parameter file states, as a law of terms.

Measured terms are taken as measured, potential part and all. Where an added-mass matrix is known, those products of two
velocities that no measured term speaks of get their share of -C_A(nu) nu of the added mass that the vehicle moves with
(`coeflab.vehicle.inertia`), so that nothing is counted twice and nothing known is left out.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from coeflab.core.errors import InputError
from coeflab.core.types import Array, brief
from coeflab.fits.rows.regression import MOMENT_COEFFICIENTS
from coeflab.law.force_law import AHEAD, CONTROLS, WIND, ForceLaw, ForceTerm, Reading
from coeflab.law.rigid_body import ideal_quadratics
from coeflab.law.scaling import powers_of
from coeflab.law.symbols import ANGULAR, COMPONENTS, LINEAR, MOTIONS, derivative
from coeflab.law.terms import Factor, Term, parse_suffix
from coeflab.vehicle.inertia import water_inertia
from coeflab.vehicle.law_at_points import LawAtPoints, law_at_points
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.parameter_model import ANGLE_OF, ParameterModel

SLOWEST = 1e-9
LONG = 9  # a table is more than slopes


def stated_terms(parameters: ParameterFile) -> tuple[ForceTerm, ...]:
    """Every coefficient of a file with a value, controls included, but those of accelerations; at the file's density.

    Literature values stand in where nothing was fitted, as in the file.
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
        out.append(
            ForceTerm(
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
        )
    return tuple(out)


def steered_terms(parameters: ParameterFile) -> tuple[ForceTerm, ...]:
    """The coefficients of controls."""
    return tuple(t for t in stated_terms(parameters) if _steered(t) and t.coefficient)


def _accelerates(factors: tuple[str, ...]) -> bool:
    return any(f.endswith("dot") for f in factors)


def _steered(term: ForceTerm) -> bool:
    return any(v in CONTROLS for v in term.variables)


def force_law(parameters: ParameterFile) -> ForceLaw:
    """The steady law of a parameter file, no control deflected."""
    terms = tuple(t for t in stated_terms(parameters) if not _steered(t))
    texts = [derivative(c.symbol) for c in parameters.coefficients if c.value is not None]
    left_out = tuple(d.text for d in texts if _accelerates(d.factors) or any(f in CONTROLS for f in d.factors))
    ideal = np.zeros((6, 6, 6))
    if parameters.added_mass is not None:
        ideal = np.where(_open(terms), ideal_quadratics(water_inertia(parameters).matrix), 0.0)
    return ForceLaw(terms, ideal, left_out)


def ideal_terms(parameters: ParameterFile) -> tuple[ForceTerm, ...]:
    """The products of the ideal fluid in `force_law`, each once."""
    ideal, density, out = force_law(parameters).ideal, parameters.conditions.density, []
    for i, j, k in np.argwhere(np.triu(ideal)):
        value, name = float(ideal[i, j, k] * (1.0 if j == k else 2.0)), COMPONENTS[i] + MOTIONS[j] + MOTIONS[k]
        unit = parameters.scaling.unit(name, density)
        term = parse_suffix(name[1:])
        out.append(ForceTerm(name, COMPONENTS[i], term, value, 0, unit, "potential", float(value / unit)))
    return tuple(out)


def _open(terms: Iterable[ForceTerm]) -> NDArray[np.bool_]:
    """(6, 6, 6), by force and two velocities: the products that no term speaks of."""
    out = np.ones((6, 6, 6), dtype=bool)
    for t in terms:
        if t.pair is not None:
            i, (j, k) = COMPONENTS.index(t.component), t.pair
            out[i, j, k] = out[i, k, j] = False
    return out


def motion_law(parameters: ParameterFile, tables: bool) -> tuple[ForceLaw, tuple[str, ...]]:
    """The law that a motion follows, controls and fitted tables in it, and what has to be said of it.

    A fitted table speaks for the components that no derivative speaks for; with ``tables`` it is the other way round. Of the
    products of the ideal fluid those are left that neither a measured derivative nor a table of measured forces speaks of.

    Parameters
    ----------
    parameters : ParameterFile
    tables : bool
        Whether fitted tables come first.
    """
    derivatives = _derivatives(parameters)
    used = _used(parameters, derivatives, tables)
    fitted, statements = _fitted(used, parameters)
    if tables:
        by_table = {c for m in used for c in _components(m)}
        derivatives = tuple(t for t in derivatives if t.component not in by_table or not _of_motion(t))
    ideal = np.where(open_places(parameters, tables), force_law(parameters).ideal, 0.0)
    return ForceLaw((*derivatives, *fitted), ideal), statements


def open_places(parameters: ParameterFile, tables: bool) -> NDArray[np.bool_]:
    """(6, 6, 6), by force and two velocities: whether `motion_law` has a place for a product of the ideal fluid.

    A table over alpha or beta speaks of all products of u with w or v in its component, one over a rate of those with it,
    unless it says that the potential part is not in its values.
    """
    derivatives = _derivatives(parameters)
    out = _open(t for t in stated_terms(parameters) if not _steered(t))
    for m in _used(parameters, derivatives, tables):
        if not m.contains_potential:
            continue
        moved = sorted({MOTIONS.index(v) for name in m.names for v in _moves(name)} | {0})
        for c in _components(m):
            out[np.ix_([COMPONENTS.index(c)], moved, moved)] = False
    return out


def _moves(variable: str) -> tuple[str, ...]:
    name = ANGLE_OF.get(variable, variable)
    return (name,) if name in MOTIONS else ()


def _used(parameters: ParameterFile, derivatives: tuple[ForceTerm, ...], tables: bool) -> tuple[ParameterModel, ...]:
    """Tables that speak: all that are forces, or those of components without a derivative.

    Raises
    ------
    InputError
        Two of one component that both have a force at no angle and no rate.
    """
    spoken = set() if tables else {t.component for t in derivatives if _of_motion(t)}
    used = [m for m in parameters.models if _components(m) and not _components(m) & spoken]
    for c in COMPONENTS:
        based = [m for m in used if c in _components(m) and any(t.value and not t.factors for t in m.terms)]
        if len({"wind" if _place_of(m) in WIND else m.names for m in based}) > 1:
            names = " and ".join(f"{m.response} over {', '.join(m.names)}" for m in based)
            raise InputError(
                f"{names}, each with a force at rest of its own", f"one table of {c} with a constant", column="models",
                advice="Fit one table over all of its variables, or give derivatives.",
            )  # fmt: skip
    return tuple(used)


def by_coefficients(model: ParameterModel, parameters: ParameterFile) -> bool:
    """Whether coefficients of the file state the force components of a table; lift and drag are X and Z."""
    name = model.response.removesuffix("/V^2").removesuffix("'")
    needed = set("XZ") if name in ("L", "D") else {name}
    stated = {derivative(c.symbol).component for c in parameters.coefficients if c.value is not None}
    return needed <= stated


def _of_motion(term: ForceTerm) -> bool:
    return not term.variables or any(v not in CONTROLS for v in term.variables)


def _place_of(model: ParameterModel) -> str:
    """X Y Z K M N, or D S L; empty where the response is no force."""
    name = model.response.removesuffix("'")
    found = MOMENT_COEFFICIENTS.get(name) or (name[2:] if name.startswith("C_") and name[2:] in WIND else name)
    return found if found in (*COMPONENTS, *WIND) else ""


def _components(model: ParameterModel) -> set[str]:
    place = _place_of(model)
    return {"X", "Y", "Z"} if place in WIND else {place} if place else set()


def _derivatives(parameters: ParameterFile) -> tuple[ForceTerm, ...]:
    """Derivatives, then controls. A force that has only V in it, such as X0, turns with the direction of motion."""
    out = sorted(stated_terms(parameters), key=_steered)
    return tuple(
        replace(t, term=Term((Factor("u", 1),)), readings=(("u", AHEAD),))
        if not t.variables and t.component == "X" and t.speed_power == 2
        else t
        for t in out
    )


def _fitted(
    used: tuple[ParameterModel, ...], parameters: ParameterFile
) -> tuple[tuple[ForceTerm, ...], tuple[str, ...]]:
    out: list[ForceTerm] = []
    statements = [
        f"the table of {m.response} is not a force that a motion needs; left out"
        for m in parameters.models
        if not _components(m) and not by_coefficients(m, parameters)
    ]
    for m in used:
        component, scale, power = _place(m, parameters)
        readings = _readings(m, parameters.scaling.length)
        for t in m.terms:
            if t.value is None:
                statements.append(f"{m.response}: {t.symbol} is not determined by the data and counts as zero")
                continue
            name, si = f"{m.response} {t.symbol}", scale * t.value
            term = Term(t.factors)
            out.append(ForceTerm(name, component, term, si, power, scale, "table", t.value, readings=readings))
    if used:
        names = ", ".join(dict.fromkeys(m.response for m in used))
        statements.append(f"tables of {names}: outside the range of their data the value at the edge is used")
    return tuple(out), tuple(statements)


def _place(model: ParameterModel, parameters: ParameterFile) -> tuple[str, float, int]:
    """Component, SI force of one unit of the response, power of the speed."""
    pressure, length = 0.5 * parameters.conditions.density, parameters.scaling.length
    component = _place_of(model)
    arm = length if component in "KMN" else 1.0
    if model.unit != "1":
        return component, 1.0, 0
    return component, pressure * (model.area.value if model.area else length**2) * arm, 2


def _readings(model: ParameterModel, length: float) -> tuple[tuple[str, Reading], ...]:
    out = []
    for v, low, high in zip(model.variables, model.domain.low, model.domain.high, strict=True):
        prime = 0.0
        if v.unit == "1":
            prime = 1.0 if v.name in LINEAR else length if v.name in ANGULAR else 0.0
        out.append((v.name, Reading(prime, low, high, True)))
    return tuple(out)


def full_force(parameters: ParameterFile) -> Callable[[Array, Array], Array]:
    """Velocities (n, 6) and controls (n, 3) -> forces (n, 6): the law that a simulation of the file moves by."""
    return motion_law(parameters, tables=False)[0].force


def points_of(parameters: ParameterFile) -> tuple[LawAtPoints, ...]:
    """How far the law of a file, as it is now, is from the points in it."""
    length = parameters.scaling.length
    return law_at_points(parameters.measured, parameters.law_holds, full_force(parameters), length)


@brief
@dataclass(frozen=True, slots=True)
class Spoken:
    """What the law of a file was fitted to.

    Attributes
    ----------
    by_table : mapping of (component, table) to set of variables
        Motions and controls that the component's terms from that table speak of.
    together : mapping of component to sets of variables
        Motions that one term combines.
    constants : frozenset of str
        Components with a force at rest in the law.
    beyond_slopes : mapping of component to set of variables
        In which the law has more than slopes and curvatures.
    """

    by_table: Mapping[tuple[str, str], frozenset[str]]
    together: Mapping[str, tuple[frozenset[str], ...]]
    constants: frozenset[str]
    beyond_slopes: Mapping[str, frozenset[str]]


def spoken(parameters: ParameterFile) -> Spoken:
    """The motions that the fitted terms of a file speak of; of acceleration derivatives and literature none."""
    none: frozenset[str] = frozenset()
    by_table: dict[tuple[str, str], frozenset[str]] = {}
    together: dict[str, tuple[frozenset[str], ...]] = {}
    higher: dict[str, frozenset[str]] = {}
    constants = set()
    parts: list[tuple[str, str, frozenset[str], int]] = []
    for c in parameters.coefficients:
        d = derivative(c.symbol)
        if c.value is None or c.law == "rest" or any(f.endswith("dot") for f in d.factors):
            continue
        moved = frozenset(d.factors) - {"u"}
        constants |= {d.component} if not moved else set()
        parts.append((d.component, c.table or "", moved, len(d.factors)))
    for m in _used(parameters, _derivatives(parameters), tables=False):
        moved = frozenset(v for name in m.names for v in (_moves(name) or (name,))) & {*MOTIONS[1:], *CONTROLS}
        for component in _components(m):
            constants.add(component)
            parts.append((component, m.table, moved, LONG))
    for component, tables, moved, degree in parts:
        for table in filter(None, tables.split(", ")):
            by_table[component, table] = by_table.get((component, table), none) | moved
        if len(moved) > 1:
            together[component] = (*together.get(component, ()), moved)
        if degree > (2 if component == "X" else 1):
            higher[component] = higher.get(component, none) | moved
    return Spoken(by_table, together, frozenset(constants), higher)


def force_of_tables(parameters: ParameterFile, nu: Array) -> Array | None:
    """(n, 6) what the fitted tables change in the force of the derivatives and of the ideal fluid; None where there is none."""
    law, _ = motion_law(parameters, tables=False)
    tabled = tuple(t for t in law.terms if t.kind == "table")
    if not tabled:
        return None
    return ForceLaw(tabled, law.ideal - force_law(parameters).ideal).force(nu)


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
        law = full_force(parameters)
    except InputError:  # a manoeuvre says why nothing moves by it
        return None
    ahead = law(parameters.conditions.speed * motions, np.zeros((len(drift), 3)))[:, 0] > 0.0
    return int(np.argmax(ahead)) if ahead.any() else None
