"""Numbers of one parameter file replaced by those of another, one by one: estimates by computations and measurements."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from coeflab.core.errors import InputError, ScalingMismatchError, shown
from coeflab.core.types import brief
from coeflab.core.version import VERSION
from coeflab.law.added_mass import potential_part
from coeflab.law.coefficient import Coefficient, Status
from coeflab.law.symbols import derivative, primed
from coeflab.vehicle.comparison import coefficient_set
from coeflab.vehicle.parameter_file import SCHEMA_VERSION, ParameterFile
from coeflab.vehicle.parameter_parts import ParameterCovariance


@brief
@dataclass(frozen=True, slots=True)
class Replaced:
    """One coefficient that another file gives.

    Attributes
    ----------
    symbol : str
        With prime.
    before : Coefficient or None
        What the base had.
    after : Coefficient or None
        None where the base's term was left out, as a law of the other file takes its place.
    """

    symbol: str
    before: Coefficient | None
    after: Coefficient | None


@brief
@dataclass(frozen=True, slots=True)
class Merged:
    """A file of which some numbers came from another.

    Attributes
    ----------
    parameters : ParameterFile
    replaced : tuple of Replaced
    """

    parameters: ParameterFile
    replaced: tuple[Replaced, ...]

    @property
    def estimates(self) -> tuple[Coefficient, ...]:
        """What is still an estimate."""
        return estimates_of(self.parameters)


def estimates_of(parameters: ParameterFile) -> tuple[Coefficient, ...]:
    """The coefficients of a file that are estimates."""
    return tuple(c for c in parameters.coefficients if c.status is Status.ESTIMATE)


def merged(base: ParameterFile, other: ParameterFile, name: str = "") -> Merged:
    """The base with every number that the other has: converted to the base's length, moved to its reference point.

    A force law is one: where the other gives terms of second or higher degree in some motions of a component, the base's
    terms of second or higher degree in these motions are left out. Covariance between both is zero.

    Parameters
    ----------
    base, other : ParameterFile
    name : str
        Of the file; the base's unless given.

    Raises
    ------
    ScalingMismatchError
        Points measured from other datums.
    InputError
        Nothing to take.
    """
    ours, theirs = coefficient_set(base), coefficient_set(other)
    if ours.datum != theirs.datum:
        raise ScalingMismatchError(
            f"{base.name} measures points from {shown(ours.datum.id)}, {other.name} from {shown(theirs.datum.id)}; "
            "give the body.toml of the shape the datum of the tables, and the vehicle again."
        )
    theirs = theirs.to_length(ours.scaling).about(ours.reference_point)
    taken = {
        c.symbol: i
        for i, c in enumerate(theirs.coefficients)
        if c.value is not None and c.status is not Status.ESTIMATE
    }
    if not taken:
        raise InputError(f"no number of {other.name} that is none of an estimate", "a fitted or measured coefficient")
    curved = {_place(s) for s in taken} - {None}
    entries: list[tuple[Coefficient, int, int]] = []
    replaced = []
    for i, c in enumerate(ours.coefficients):
        if c.symbol in taken:
            j = taken[c.symbol]
            entries.append((theirs.coefficients[j], 1, j))
            replaced.append(Replaced(primed(c.symbol), c, theirs.coefficients[j]))
        elif _place(c.symbol) in curved:
            replaced.append(Replaced(primed(c.symbol), c, None))
        else:
            entries.append((c, 0, i))
    for symbol, j in taken.items():
        if symbol not in ours:
            entries.append((theirs.coefficients[j], 1, j))
            replaced.append(Replaced(primed(symbol), None, theirs.coefficients[j]))
    covariance = np.zeros((len(entries), len(entries)))
    for a, (_, source, i) in enumerate(entries):
        for b, (_, other_source, j) in enumerate(entries):
            if source == other_source:
                covariance[a, b] = (ours, theirs)[source].covariance[i, j]
    void = np.isnan(np.diag(covariance))
    covariance[void, :] = covariance[:, void] = np.nan
    return Merged(_written(base, other, [e[0] for e in entries], covariance, replaced, name), tuple(replaced))


def _place(symbol: str) -> tuple[str, frozenset[str]] | None:
    """Component and motions of a term of second or higher degree; None of others. X0 is a resistance with u^2."""
    d = derivative(symbol)
    if d.text == "X0":
        return "X", frozenset("u")
    return (d.component, frozenset(d.factors)) if len(d.factors) > 1 else None


def _written(
    base: ParameterFile, other: ParameterFile, chosen: Sequence[Coefficient], covariance: np.ndarray,
    replaced: Sequence[Replaced], name: str,
) -> ParameterFile:  # fmt: skip
    at, hull = base.conditions, base.added_mass or other.added_mass
    rows = []
    for c in chosen:
        bare = derivative(c.symbol)
        si = None if c.value is None else c.value * base.scaling.unit(c.symbol, at.density, at.speed)
        booked = hull is not None and c.value is not None and c.law != "rest"
        potential = potential_part(c.symbol, hull, base.scaling, hull.density) if booked and hull is not None else None
        rows.append(replace(c, symbol=primed(c.symbol), value_si=si, unit_si=bare.unit, potential=potential))
    notes = [f"{r.symbol} from {other.name}" if r.after is not None else f"{r.symbol} left out: {other.name} has another "
             "term of that motion" for r in replaced]  # fmt: skip
    content = {k: getattr(base, k) for k in type(base).model_fields}
    mine, theirs = base.provenance, other.provenance
    content |= {
        "schema_version": SCHEMA_VERSION,
        "name": name or base.name,
        "coefficients": tuple(rows),
        "covariance": ParameterCovariance(
            symbols=tuple(c.symbol for c in rows),
            matrix=tuple(tuple(None if np.isnan(v) else float(v) for v in row) for row in covariance),
        ),
        "added_mass": hull,
        "mass": base.mass or other.mass,
        "hydrostatics": base.hydrostatics or other.hydrostatics,
        "thrusters": base.thrusters or other.thrusters,
        "surfaces": base.surfaces or other.surfaces,
        "models": (*base.models, *other.models),
        "covered": (*base.covered, *other.covered),
        "measured": (*base.measured, *other.measured),
        "law_holds": (*base.law_holds, *other.law_holds),
        "law_at_points": (),
        "provenance": mine.model_copy(
            update={
                "coeflab_version": VERSION,
                "inputs": tuple(dict.fromkeys((*mine.inputs, *theirs.inputs))),
                "citations": tuple(dict.fromkeys((*mine.citations, *theirs.citations))),
                "notes": (*mine.notes, *theirs.notes, *notes),
            }
        ),
    }
    return ParameterFile(**content)
