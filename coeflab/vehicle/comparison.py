"""Two parameter files side by side: brought to one length and one reference point, then held against their U95."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from coeflab.core.machine import one_thread
from coeflab.core.texts import remark, text_of
from coeflab.core.types import dataclass
from coeflab.law.coefficient import Coefficient, CoefficientSet, transfer_matrix
from coeflab.law.symbols import primed
from coeflab.vehicle.compared_models import ComparedModel, compare_models
from coeflab.vehicle.matching import by_plain_names, on_one_datum, sums_in_words, with_matrix
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.shared_tables import Verdict, shared_tables

SAME_POINT = 1e-9
ROUNDING = 1e-9  # of the larger of two values: a move of point and length leaves so much
OTHER_SIZE = 1.5  # of the larger over the smaller of two values without U95


@dataclass(frozen=True, slots=True)
class Compared:
    """One coefficient of two files, primed by the first file's length about its point.

    Attributes
    ----------
    symbol : str
        With prime.
    a, b, u95_a, u95_b : float or None
    difference : float or None
        b - a.
    combined : float or None
        Root sum of squares of both U95, taken as independent.
    verdict : Verdict
    reason : str
        Why not comparable, or what to keep in mind.
    shared : tuple of str
        Tables behind both values.
    """

    symbol: str
    a: float | None
    b: float | None
    u95_a: float | None
    u95_b: float | None
    difference: float | None
    combined: float | None
    verdict: Verdict
    reason: str
    shared: tuple[str, ...] = ()

    @property
    def ratio(self) -> float | None:
        """Absolute difference over the combined uncertainty."""
        return abs(self.difference) / self.combined if self.difference is not None and self.combined else None


@dataclass(frozen=True, slots=True)
class Comparison:
    """Two parameter files.

    Attributes
    ----------
    a, b : str
        Names of the files' contents.
    same_body : bool
    rows : tuple of Compared
    statements : tuple of str
        What was converted, what else differs, and which data are behind both.
    models : tuple of ComparedModel
        Fitted tables.
    """

    a: str
    b: str
    same_body: bool
    rows: tuple[Compared, ...]
    statements: tuple[str, ...]
    models: tuple[ComparedModel, ...] = ()

    @property
    def disagrees(self) -> bool:
        """Whether files of one body are apart or of other signs in anything; different bodies owe each other nothing."""
        found = {*(r.verdict for r in self.rows), *(m.verdict for m in self.models)}
        return self.same_body and bool(found & {Verdict.APART, Verdict.OTHER_SIGN})


def coefficient_set(parameters: ParameterFile) -> CoefficientSet:
    """The coefficients of a parameter file as a set with covariance; those without U95 have NaN rows."""
    listed = {s: i for i, s in enumerate(parameters.covariance.symbols)}
    k = len(parameters.coefficients)
    covariance = np.full((k, k), np.nan)
    for i, c in enumerate(parameters.coefficients):
        for j, d in enumerate(parameters.coefficients):
            if c.symbol in listed and d.symbol in listed:
                cell = parameters.covariance.matrix[listed[c.symbol]][listed[d.symbol]]
                covariance[i, j] = np.nan if cell is None else cell
        if c.symbol not in listed and c.u95 is not None:
            covariance[i, :] = covariance[:, i] = 0.0
            covariance[i, i] = (c.u95 / 2.0) ** 2
    return CoefficientSet(
        tuple(
            replace(c, symbol=c.symbol.removesuffix("'"), body=parameters.body) for c in parameters.coefficients
        ),
        covariance,
        parameters.scaling,
        np.array(parameters.reference_point.point),
        parameters.reference_point.origin,
        parameters.body,
    )  # fmt: skip


@one_thread()
def compare(a: ParameterFile, b: ParameterFile, names: tuple[str, str] | None = None) -> Comparison:
    """Hold the second file against the first.

    The second is primed by the first one's length and moved to its reference point where both are measured from one
    datum, or by the centre of gravity that both state; what holds about every point, of the datum ``anywhere``, holds about this one. Differences of other bodies are shown, with a statement that they are of other bodies.

    Parameters
    ----------
    a, b : ParameterFile
    names : tuple of str, optional
        What the comparison calls them; their own names by default.
    """
    name_a, name_b = names or (a.name, b.name)
    b, placed = on_one_datum(a, b)
    both = (coefficient_set(a), coefficient_set(b))
    (ours, own), (theirs, spelled) = (by_plain_names(s) for s in both)
    stated = list(dict.fromkeys((*ours.symbols, *theirs.symbols)))
    (ours, of_ours), (theirs, of_theirs) = with_matrix(ours, a), with_matrix(theirs, b)
    words = _matched(ours, theirs, (own, spelled), (of_ours, of_theirs), stated, (name_a, name_b))
    words += [] if placed is None else [remark(placed)]
    words += [w for s, name in zip(both, (name_a, name_b), strict=True) for w in sums_in_words(s, name, stated)]
    if a.body != b.body:
        words.append(f"different bodies, {a.body} and {b.body}: a difference may be the body as well as an error")
    if abs(ours.scaling.length / theirs.scaling.length - 1.0) > 1e-9:
        words.append(f"{name_b} converted from {theirs.scaling} to {ours.scaling}")
    theirs = theirs.to_length(ours.scaling).counted_from(ours.datum, ours.reference_point)
    ours = ours.counted_from(theirs.datum, theirs.reference_point)
    moved = theirs
    same_datum = ours.datum == theirs.datum
    if not same_datum:
        words.append(text_of("vehicle.other_datums", ours=ours.datum.id, theirs=theirs.datum.id))
    elif not np.allclose(ours.reference_point, theirs.reference_point, rtol=0.0, atol=SAME_POINT):
        at = ", ".join(f"{x:g}" for x in ours.reference_point)
        words.append(f"{name_b} moved to the reference point of {name_a}, ({at}) m")
        moved = theirs.about(ours.reference_point)
    behind = _contributors(theirs, moved)
    rows = []
    for symbol in stated:
        row = _row(symbol, ours, theirs, moved, same_datum)
        if row.difference is not None:
            mine = ours[symbol]
            pairs = [shared_tables(mine, c, a.provenance, b.provenance) for c in behind[symbol] if c.origin == "fit"]
            shared = tuple(sorted({t for p in pairs for t in p})) if mine.origin == "fit" else ()
            row = replace(
                row, shared=shared, reason=row.reason or (f"both rest on {', '.join(shared)}" if shared else "")
            )
        rows.append(row)
    models = compare_models(a, b)
    alike: dict[str, list[str]] = {}
    for name, tables in [(r.symbol, r.shared) for r in rows] + [(m.name, m.shared) for m in models]:
        for table in tables:
            alike.setdefault(table, []).append(name)
    words += [
        f"{table} is behind {'; '.join(names)} of both files: their errors are not independent"
        for table, names in alike.items()
    ]
    return Comparison(name_a, name_b, a.body == b.body, tuple(rows), tuple(words), models)


def _matched(
    ours: CoefficientSet, theirs: CoefficientSet, first: tuple[dict[str, str], dict[str, str]],
    entries: tuple[frozenset[str], frozenset[str]], stated: Sequence[str], names: tuple[str, str],
) -> list[str]:  # fmt: skip
    """What was held against another name or against an entry of a matrix, in words."""
    pairs = [
        f"{primed(one)} as {primed(other)}"
        for symbol in stated
        if symbol in ours and symbol in theirs
        and (one := first[1].get(symbol, symbol)) != (other := first[0].get(symbol, symbol))
    ]  # fmt: skip
    out = [f"of {names[1]}, equal on a straight course: {', '.join(pairs)}"] if pairs else []
    for k in (0, 1):
        if used := [primed(s) for s in stated if s in entries[k]]:
            out.append(f"of {names[k]} from its added mass matrix: {', '.join(used)}")
    return out


def _contributors(before: CoefficientSet, moved: CoefficientSet) -> dict[str, list[Coefficient]]:
    """The coefficients that each one consists of after a move of the reference point."""
    shift = (moved.reference_point - before.reference_point) / before.scaling.length
    matrix, _ = transfer_matrix(before.symbols, before.available, shift)
    return {
        s: [c for c, weight in zip(before.coefficients, row, strict=True) if weight != 0.0 or c.symbol == s]
        for s, row in zip(before.symbols, matrix, strict=True)
    }


def _row(
    symbol: str, ours: CoefficientSet, theirs: CoefficientSet, moved: CoefficientSet, same_datum: bool
) -> Compared:
    a, b, before = (next((c for c in s.coefficients if c.symbol == symbol), None) for s in (ours, moved, theirs))
    why = ""
    for name, c in (("first", a), ("second", b)):
        if c is None:
            why = why or f"not in the {name} file"
        elif c.value is None and not (name == "second" and before is not None and before.value is not None):
            why = why or f"no value in the {name} file ({c.status.replace('_', ' ')})"
    if not why and b is not None and b.value is None:
        why = "its move to the other reference point needs coefficients that the second file does not give"
    if not why and not same_datum and _feels_the_point(symbol):
        why = "the reference points are measured from other datums"
    value_a, value_b = None if a is None else a.value, None if b is None else b.value
    u95_a, u95_b = None if a is None else a.u95, None if b is None else b.u95
    difference = value_b - value_a if not why and value_a is not None and value_b is not None else None
    combined = float(np.hypot(u95_a, u95_b)) if u95_a is not None and u95_b is not None else None
    verdict = Verdict.NOT_COMPARABLE
    if not why and combined is None:
        why = "no U95 on either side" if u95_a is None and u95_b is None else "no U95 on one side"
        verdict = _by_value(value_a or 0.0, value_b or 0.0)
    if not why and difference is not None and combined is not None:
        verdict = Verdict.WITHIN if abs(difference) <= combined else Verdict.APART
        if a is not None and b is not None and a.origin == b.origin == "literature" and a.citation == b.citation:
            why = f"both quoted from {a.citation}"
    return Compared(primed(symbol), value_a, value_b, u95_a, u95_b, difference, combined, verdict, why)


def _by_value(a: float, b: float) -> Verdict:
    """Of two values of which one has no U95."""
    if abs(a - b) <= ROUNDING * max(abs(a), abs(b)):
        return Verdict.EQUAL
    if a * b < 0.0:
        return Verdict.OTHER_SIGN
    small, large = sorted((abs(a), abs(b)))
    return Verdict.OTHER_SIZE if large > OTHER_SIZE * small else Verdict.NOT_COMPARABLE


def _feels_the_point(symbol: str) -> bool:
    """Moments and derivatives by rates change with the reference point; forces by velocities do not."""
    return symbol[0] in "KMN" or any(letter in symbol[1:] for letter in "pqr" if f"d{letter}" not in symbol)
