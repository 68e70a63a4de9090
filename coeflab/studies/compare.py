"""Two parameter files side by side: brought to one length and one reference point, then held against their U95."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from coeflab.core.machine import one_thread
from coeflab.core.symbols import primed
from coeflab.kernels.brief import brief
from coeflab.model.coefficient import Coefficient, CoefficientSet, Status, transfer_matrix
from coeflab.model.parameter_file import ParameterFile
from coeflab.model.scaling import Scaling
from coeflab.studies.compare_models import ComparedModel, compare_models
from coeflab.studies.shared_tables import Verdict, shared_tables

SAME_POINT = 1e-9


@brief
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


@brief
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
        """Whether files of one body are apart in anything; different bodies owe each other nothing."""
        return self.same_body and Verdict.APART in (*(r.verdict for r in self.rows), *(m.verdict for m in self.models))


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
            Coefficient(
                c.symbol.removesuffix("'"), c.value, c.u95, Status(c.status), parameters.body, origin=c.origin,
                table=c.table, campaign=c.campaign, citation=c.citation,
            )
            for c in parameters.coefficients
        ),
        covariance,
        Scaling(parameters.scaling.length, parameters.scaling.length_name),
        np.array(parameters.reference_point.point),
        parameters.reference_point.origin,
        parameters.body,
    )  # fmt: skip


@one_thread()
def compare(a: ParameterFile, b: ParameterFile) -> Comparison:
    """Hold the second file against the first.

    The second is primed by the first one's length and moved to its reference point where both are measured from one
    datum. Differences of other bodies are shown, with a statement that they are of other bodies.
    """
    ours, theirs = coefficient_set(a), coefficient_set(b)
    said = []
    if a.body != b.body:
        said.append(f"different bodies, {a.body} and {b.body}: a difference may be the body as well as an error")
    if abs(ours.scaling.length / theirs.scaling.length - 1.0) > 1e-9:
        said.append(f"{b.name} converted from {theirs.scaling} to {ours.scaling}")
    theirs = theirs.to_length(ours.scaling)
    moved = theirs
    same_datum = ours.datum == theirs.datum
    if not same_datum:
        said.append(
            f'reference points are measured from other datums, "{ours.datum.id}" and "{theirs.datum.id}": moments and rates '
            "are not comparable"
        )
    elif not np.allclose(ours.reference_point, theirs.reference_point, rtol=0.0, atol=SAME_POINT):
        at = ", ".join(f"{x:g}" for x in ours.reference_point)
        said.append(f"{b.name} moved to the reference point of {a.name}, ({at}) m")
        moved = theirs.about(ours.reference_point)
    behind = _contributors(theirs, moved)
    rows = []
    for symbol in dict.fromkeys((*ours.symbols, *theirs.symbols)):
        row = _row(symbol, ours, theirs, moved, same_datum)
        if row.difference is not None:
            first = ours[symbol]
            pairs = [shared_tables(first, c, a.provenance, b.provenance) for c in behind[symbol] if c.origin == "fit"]
            shared = tuple(sorted({t for p in pairs for t in p})) if first.origin == "fit" else ()
            row = replace(
                row, shared=shared, reason=row.reason or (f"both rest on {', '.join(shared)}" if shared else "")
            )
        rows.append(row)
    models = compare_models(a, b)
    alike: dict[str, list[str]] = {}
    for name, tables in [(r.symbol, r.shared) for r in rows] + [(m.name, m.shared) for m in models]:
        for table in tables:
            alike.setdefault(table, []).append(name)
    said += [
        f"{table} is behind {'; '.join(names)} of both files: their errors are not independent"
        for table, names in alike.items()
    ]
    return Comparison(a.name, b.name, a.body == b.body, tuple(rows), tuple(said), models)


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
    if not why and combined is None:
        why = "no U95 on one side"
    verdict = Verdict.NOT_COMPARABLE
    if not why and difference is not None and combined is not None:
        verdict = Verdict.WITHIN if abs(difference) <= combined else Verdict.APART
        if a is not None and b is not None and a.origin == b.origin == "literature" and a.citation == b.citation:
            why = f"both quoted from {a.citation}"
    return Compared(primed(symbol), value_a, value_b, u95_a, u95_b, difference, combined, verdict, why)


def _feels_the_point(symbol: str) -> bool:
    """Moments and derivatives by rates change with the reference point; forces by velocities do not."""
    return symbol[0] in "KMN" or any(letter in symbol[1:] for letter in "pqr" if f"d{letter}" not in symbol)
