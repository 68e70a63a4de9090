"""Numbers of one parameter file replaced by those of another, one by one: estimates by computations and measurements."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from coeflab.core.errors import InputError, ScalingMismatchError, shown
from coeflab.core.finding import Finding, Severity
from coeflab.core.texts import input_error, text_of, words
from coeflab.core.types import dataclass
from coeflab.core.version import VERSION
from coeflab.core.wording import listed
from coeflab.fits.joint.moving import LEFT_OUT, left_out
from coeflab.law.added_mass import potential_part
from coeflab.law.coefficient import Coefficient, CoefficientSet, Status, moved_together
from coeflab.law.scaling import Scaling
from coeflab.law.symbols import derivative, primed
from coeflab.vehicle.comparison import coefficient_set
from coeflab.vehicle.force_law import force_at_edges, full_force, points_of, spoken
from coeflab.vehicle.law_at_points import caps, held_ranges, law_at_points
from coeflab.vehicle.matching import by_plain_names, plain_name, spelled_as, sums_in_words
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.parameter_parts import ParameterCovariance
from coeflab.vehicle.schema_versions import SCHEMA_VERSION
from coeflab.vehicle.sources import Moved, acts_in

SAME_LENGTH, ONE_BODY = 1e-3, 0.1  # of the length: one length; two lengths of one body, such as LBP and LOA
SCALED_UNSAID = "parameter_file.scaled"  # SI values of a person who did not say what they do at other speeds


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
        None where the base's term was left out: a law of the other file takes its place, or the same slope under another name.
    """

    symbol: str
    before: Coefficient | None
    after: Coefficient | None


@dataclass(frozen=True, slots=True)
class Merged:
    """A file of which some numbers came from another.

    Attributes
    ----------
    parameters : ParameterFile
    replaced : tuple of Replaced
    lengths : str
        Which lengths the primes of both had, where these differ; else empty.
    tables : tuple of str
        Responses of the fitted tables that came.
    """

    parameters: ParameterFile
    replaced: tuple[Replaced, ...]
    lengths: str = ""
    tables: tuple[str, ...] = ()

    @property
    def estimates(self) -> tuple[Coefficient, ...]:
        """What is still an estimate."""
        return estimates_of(self.parameters)


def estimates_of(parameters: ParameterFile) -> tuple[Coefficient, ...]:
    """The coefficients of a file that are estimates."""
    return tuple(c for c in parameters.coefficients if c.status is Status.ESTIMATE)


def merged(
    base: ParameterFile, other: ParameterFile, name: str = "", own: Scaling | None = None, *, alone: bool = False
) -> Merged:
    """The base with every number that the other has: converted to the base's length, moved to its reference point.

    A force law is one: where the other gives terms of second or higher degree in some motions of a component, the base's
    terms of second or higher degree in these motions are left out; so are estimates of such terms that take the law away from
    the other's measured points. A slope that the other gives is one number: Yv' and Yuv' of the base go for it, save damping
    about a state of rest. Covariance between both is zero.

    Parameters
    ----------
    base, other : ParameterFile
    name : str
        Of the file; the base's unless given.
    own : Scaling, optional
        What the other's data were primed by, where its file has them by another length already.
    alone : bool
        The other has single numbers and no law: one that the base has is replaced in its place, and no other goes with it but
        the same slope under another name. One that is new takes the place of the base's terms in its motions all the same.

    Raises
    ------
    ScalingMismatchError
        Points measured from other datums.
    InputError
        Nothing to take.
    """
    ours, theirs = coefficient_set(base), _at_conditions(coefficient_set(other), other, base)
    theirs = theirs.counted_from(ours.datum, ours.reference_point)
    if ours.datum != theirs.datum:
        raise ScalingMismatchError(
            f"the vehicle {base.name} counts places from {shown(ours.datum.id)}, the coefficients of {other.name} from "
            f"{shown(theirs.datum.id)}. Where the file of the coefficients is all there is, write in its reference_point where its point lies "
            f'from {shown(ours.datum.id)}: {{"datum": {shown(ours.datum.id)}, "point": [x, y, z]}}, m, FRD. Of tables of your own, give the body.toml '
            "of the shape their datum, and the vehicle again. A file that is a whole vehicle needs no shape: take it as it is, by its own name."
        )
    theirs, first = by_plain_names(theirs.to_length(ours.scaling))
    resting = {c.symbol for c in ours.coefficients if c.law == "rest"}  # no other spelling of a slope
    slopes_of_ours = [
        s for s in ours.symbols if plain_name(s) != "X0" and s not in resting
    ]  # u|u|: another law in drift
    shift = ours.reference_point - theirs.reference_point
    joint = moved_together((theirs, _lender(ours)), _blocks(theirs, ours), ours.reference_point)
    many = len(theirs.coefficients)
    covariance = _blocks(joint.sets[0], ours, joint.covariance[:many, many:])
    theirs = spelled_as(joint.sets[0], first, slopes_of_ours)
    removed = _stay(left_out(joint, (other.name, base.name), (shift, shift), Severity.FAIL)[0], other.findings, ours)
    taken = {
        c.symbol: i
        for i, c in enumerate(theirs.coefficients)
        if c.value is not None and c.status is not Status.ESTIMATE
    }
    if not taken and removed:
        text = words(removed[0])
        raise InputError(text.statement.rstrip("."), "what the move takes, in the same fit", advice=text.advice)
    _refuse_other_tables(other, base)
    if not taken and not other.models:
        has = "estimates only" if any(c.status is Status.ESTIMATE for c in theirs.coefficients) else _nothing(other)
        raise input_error("vehicle.nothing_measured", has=has, name=other.name)
    slopes = {plain_name(s) for s, i in taken.items() if theirs.coefficients[i].law != "rest"} - {"X0"}
    curved = {_place(s) for s in taken if not (alone and s in ours)} - {None}
    spoken_of = [acts_in(m) for m in other.models]
    entries: list[Entry] = []
    replaced = []
    for i, c in enumerate(ours.coefficients):
        if c.symbol in taken:
            j = taken[c.symbol]
            entries.append((theirs.coefficients[j], 1, j))
            replaced.append(Replaced(primed(c.symbol), c, theirs.coefficients[j]))
        elif (
            _place(c.symbol) in curved
            or (c.law != "rest" and plain_name(c.symbol) in slopes)
            or (c.status is Status.ESTIMATE and _in_tables(c.symbol, spoken_of))
        ):
            replaced.append(Replaced(primed(c.symbol), c, None))
        else:
            entries.append((c, 0, i))
    for symbol, j in taken.items():
        if symbol not in ours:
            entries.append((theirs.coefficients[j], 1, j))
            replaced.append(Replaced(primed(symbol), None, theirs.coefficients[j]))
    result = _joined(base, other, covariance, many, entries, replaced, name)
    for symbol in () if alone else _against_points(result):
        entries = [e for e in entries if e[0].symbol != symbol]
        replaced.append(Replaced(primed(symbol), ours[symbol], None))
        result = _joined(base, other, covariance, many, entries, replaced, name)
    result = _held(result)
    lengths = _lengths(base, other, own or other.scaling)
    sums = sums_in_words(coefficient_set(other), other.name, {plain_name(s) for s in taken})
    scaled = _scaled(base, other, own or other.scaling)
    notes = (*result.provenance.notes, *sums, *([lengths] if lengths else []))
    findings = (*(f for f in result.findings if f.code != LEFT_OUT), *removed, *scaled)
    update = {
        "findings": findings,
        "law_at_points": points_of(result),
        "provenance": result.provenance.model_copy(update={"notes": notes}),
    }
    return Merged(result.model_copy(update=update), tuple(replaced), lengths, tuple(m.response for m in other.models))


def _at_conditions(theirs: CoefficientSet, other: ParameterFile, base: ParameterFile) -> CoefficientSet:
    """With primes of damping about a state of rest that give the same SI at the base's density and speed."""
    there, here = other.conditions, base.conditions
    ratios = [
        theirs.scaling.unit(c.symbol, there.density, there.speed) / theirs.scaling.unit(c.symbol, here.density, here.speed)
        if c.law == "rest" else 1.0
        for c in theirs.coefficients
    ]  # fmt: skip
    rows = tuple(c.scaled(k, c.unit) for c, k in zip(theirs.coefficients, ratios, strict=True))
    return replace(theirs, coefficients=rows, covariance=theirs.covariance * np.outer(ratios, ratios))


def _lender(ours: CoefficientSet) -> CoefficientSet:
    """The base's fitted numbers under plain names, by which those of another file are moved; a slope of two names lends nothing."""
    names = [plain_name(c.symbol) for c in ours.coefficients]
    lends = [
        c.status is not Status.ESTIMATE and c.law != "rest" and names.count(n) == 1
        for n, c in zip(names, ours.coefficients, strict=True)
    ]
    rows = zip(names, lends, ours.coefficients, strict=True)
    return replace(
        ours,
        coefficients=tuple(replace(c, symbol=n) if can else replace(c, value=None, u95=None) for n, can, c in rows),
    )


def _blocks(theirs: CoefficientSet, ours: CoefficientSet, between: np.ndarray | None = None) -> np.ndarray:
    """Covariance of the coefficients of both, one after the other."""
    cross = np.zeros((len(theirs.coefficients), len(ours.coefficients))) if between is None else np.nan_to_num(between)
    return np.block([[theirs.covariance, cross], [cross.T, ours.covariance]])


def _stay(removed: Sequence[Finding], before: Sequence[Finding], ours: CoefficientSet) -> list[Finding]:
    """What was not moved, by this merge or by the fits before it, and what of the base stays in the place of it."""
    out = []
    for f in (*removed, *(f for f in before if f.code == LEFT_OUT)):
        named = {s.removesuffix("'") for s in f["symbols"]}
        stays = tuple(
            primed(c.symbol) for c in ours.coefficients if plain_name(c.symbol) in named and c.value is not None
        )
        facts: dict[str, Any] = {fact.name: fact.value for fact in f.facts} | ({"stays": stays} if stays else {})
        code = "move.stays" if stays else LEFT_OUT
        out.append(Finding.of(code, f.subject, Severity.FAIL, statistic=f.statistic, **facts))
    return out


def _nothing(other: ParameterFile) -> str:
    """What a file without estimates and without numbers lacks, in words."""
    open_ones = [c.symbol for c in other.coefficients if c.value is None]
    return f"no value of {listed(open_ones)}" if open_ones else "no coefficient"


def _refuse_other_tables(other: ParameterFile, base: ParameterFile) -> None:
    """Fitted tables are taken whole: about their own point, and by their own length."""
    at, own = (np.array(p.reference_point.point) for p in (base, other))
    same = abs(other.scaling.length / base.scaling.length - 1.0) < SAME_LENGTH
    if other.models and not (same and np.allclose(at, own, atol=1e-6)):
        named = [f"{p.name}: {p.scaling}, about {tuple(map(float, p.reference_point.point))} m" for p in (other, base)]
        raise input_error("vehicle.fitted_tables_another", named=named[0], named_2=named[1])


def _lengths(base: ParameterFile, other: ParameterFile, own: Scaling) -> str:
    """That the primes of both have different lengths, in words; empty where they are one."""
    if abs(own.length / base.scaling.length - 1.0) < SAME_LENGTH:
        return ""
    return text_of("vehicle.lengths_differ", name=other.name, own=own, scaling=base.scaling)


def _scaled(base: ParameterFile, other: ParameterFile, own: Scaling) -> tuple[Finding, ...]:
    """That both lengths are hardly of one body."""
    ours = base.scaling.length
    if max(own.length / ours, ours / own.length) <= 1.0 + ONE_BODY:
        return ()
    return (
        Finding.of(
            "merge.scaled", other.name, Severity.WARN, statistic=(own.length / ours) ** 2, threshold=ONE_BODY,
            theirs=own.length, ours=ours,
        ),
    )  # fmt: skip


Entry = tuple[Coefficient, int, int]  # a coefficient, from which of both files, and its row there


def _joined(
    base: ParameterFile, other: ParameterFile, both: np.ndarray, many: int, entries: Sequence[Entry],
    replaced: Sequence[Replaced], name: str,
) -> ParameterFile:  # fmt: skip
    rows = [i if source else many + i for _, source, i in entries]
    covariance = both[np.ix_(rows, rows)]
    void = np.isnan(np.diag(covariance))
    covariance[void, :] = covariance[:, void] = np.nan
    return _written(base, other, [e[0] for e in entries], covariance, replaced, name)


def _against_points(file: ParameterFile) -> tuple[str, ...]:
    """Estimated terms of second or higher degree that take the law away from measured points, all of a table, component by component."""
    out: list[str] = []
    now = _rms(file)
    for table in file.measured:
        moves = {m.name for m in table.motion}
        for component in dict.fromkeys(f.component for f in table.forces):
            mine = [
                c for c in estimates_of(file)
                if (place := _place(c.symbol)) is not None and place[0] == component and place[1] <= moves
            ]  # fmt: skip
            if not mine or (component, table.table) not in now:
                continue
            without = file.model_copy(update={"coefficients": tuple(c for c in file.coefficients if c not in mine)})
            then = _rms(without)
            if then[component, table.table] < now[component, table.table]:
                out += [c.symbol.removesuffix("'") for c in mine]
    return tuple(dict.fromkeys(out))


def _held(file: ParameterFile) -> ParameterFile:
    """The file with the ranges in which its law, which is neither file's, meets its points."""
    if not file.law_holds:
        return file
    length = file.scaling.length
    cap = caps(file.measured, full_force(file), length, spoken(file).beyond_slopes)
    return file.model_copy(update={"law_holds": held_ranges(file.measured, cap, length)})


def _rms(file: ParameterFile) -> dict[tuple[str, str], float]:
    """Of what the law misses at every point, also where it is not said to hold, by component and table."""
    found = law_at_points(file.measured, (), force_at_edges(file), file.scaling.length)
    return {(p.component, p.table): p.rms for p in found}


def _place(symbol: str) -> tuple[str, frozenset[str]] | None:
    """Component and motions of a term of second or higher degree; None of others. X0 is a resistance with u^2."""
    d = derivative(symbol)
    if d.text == "X0":
        return "X", frozenset("u")
    return (d.component, frozenset(d.factors)) if len(d.factors) > 1 else None


def _in_tables(symbol: str, tables: Sequence[Mapping[str, Moved]]) -> bool:
    """Whether fitted tables have the force of a term: those of its component over all its motions, ahead at the speed."""
    d = derivative(symbol)
    return any(d.component in t and set(d.factors) <= {"u", *t[d.component]} for t in tables)


def _written(
    base: ParameterFile, other: ParameterFile, chosen: Sequence[Coefficient], covariance: np.ndarray,
    replaced: Sequence[Replaced], name: str,
) -> ParameterFile:  # fmt: skip
    other, removed = _about(other, base)
    at, hull = base.conditions, base.added_mass or other.added_mass
    rows = []
    for c in chosen:
        bare = derivative(c.symbol)
        si = None if c.value is None else c.value * base.scaling.unit(c.symbol, at.density, at.speed)
        booked = hull is not None and c.value is not None and c.law != "rest"
        potential = potential_part(c.symbol, hull, base.scaling, hull.density) if booked and hull is not None else None
        rows.append(replace(c, symbol=primed(c.symbol), value_si=si, unit_si=bare.unit, potential=potential))
    taken = [r.symbol for r in replaced if r.after is not None]
    taken += [f"the table of {m.response}" for m in other.models]
    new = {(m.response, m.names) for m in other.models}
    notes = [f"from {other.name}: {', '.join(taken)}"]
    for what, estimated in (("estimates", True), ("numbers that are no estimates", False)):
        gone = [
            r.symbol
            for r in replaced
            if r.after is None and r.before and (r.before.status is Status.ESTIMATE) is estimated
        ]
        notes += [f"{what} left out beside the law of {other.name}: {', '.join(gone)}"] if gone else []
    notes += [removed] if removed and base.mass is None else []
    same = np.allclose(base.reference_point.point, other.reference_point.point) and np.isclose(
        other.conditions.density, at.density
    )
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
        "models": (*(m for m in base.models if (m.response, m.names) not in new), *other.models),
        "covered": (*base.covered, *other.covered),
        "measured": (*base.measured, *(other.measured if same else ())),
        "law_holds": (*base.law_holds, *(other.law_holds if same else ())),
        "law_at_points": (),
        "findings": findings_of_merged(
            (*(f for one in base.findings for f in _still_scaled(one, replaced)), *other.findings), name or base.name
        ),
        "provenance": mine.model_copy(
            update={
                "coeflab_version": VERSION,
                "inputs": tuple(dict.fromkeys((*mine.inputs, *theirs.inputs))),
                "citations": tuple(dict.fromkeys((*mine.citations, *theirs.citations))),
                "notes": tuple(dict.fromkeys((*mine.notes, *theirs.notes, *notes))),
            }
        ),
    }
    return ParameterFile(**content)


def _about(other: ParameterFile, base: ParameterFile) -> tuple[ParameterFile, str]:
    """What a merge takes whole of a file, about the base's point and primed as the base is; what cannot be moved, in words.

    The file keeps its reference point, by which its measured points are judged.
    """
    shift = np.array(base.reference_point.point) - np.array(other.reference_point.point)
    mass = None if other.mass is None else other.mass.moved(shift) if np.any(shift) else other.mass
    afloat = other.hydrostatics
    if afloat is not None:
        centre = _from(afloat.centre_of_buoyancy, shift)
        afloat = afloat.model_copy(update={"centre_of_buoyancy": centre})
    update = {
        "added_mass": None
        if other.added_mass is None
        else other.added_mass.about(np.array(base.reference_point.point)),
        "mass": None if mass is None else mass.primed(base.scaling, base.conditions.density),
        "hydrostatics": afloat,
        "thrusters": tuple(t.model_copy(update={"position": _from(t.position, shift)}) for t in other.thrusters),
    }
    removed = (
        f"mass properties of {other.name} left out: about a point off its x axis they take cg and the inertia matrix"
        if mass is None and other.mass is not None
        else ""
    )
    return other.model_copy(update=update), removed


def _from(point: Sequence[float], shift: np.ndarray) -> tuple[float, ...]:
    """A point from a reference point that is ``shift`` away."""
    return tuple(float(x) for x in np.array(point) - shift)


def _still_scaled(found: Finding, replaced: Sequence[Replaced]) -> tuple[Finding, ...]:
    """A finding of the base without the SI values that were replaced; none where all were."""
    if found.code != SCALED_UNSAID:
        return (found,)
    gone = {r.symbol.removesuffix("'") for r in replaced}
    names = tuple(s for s in found["symbols"] if s not in gone)
    facts = {fact.name: fact.value for fact in found.facts} | {"symbols": names}
    changed = Finding.of(
        found.code, listed(names), found.severity, statistic=found.statistic, advice=found.advice, **facts
    )
    return (changed,) if names else ()


def findings_of_merged(found: Sequence[Finding], name: str) -> tuple[Finding, ...]:
    """Findings of several files on one whose law is neither's: what was said of a law against its force model no longer is."""
    selected = dict.fromkeys(f for f in found if not f.code.startswith("law.model"))
    left = len(selected) < len(dict.fromkeys(found))
    return (*selected, *((Finding.of("law.model_left", name, Severity.NOTE),) if left else ()))
