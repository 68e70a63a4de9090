"""Which coefficients a parameter file holds: those of fits, of literature, and the wanted ones that nothing gives."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from coeflab.core.errors import ScalingMismatchError, shown
from coeflab.core.texts import input_error
from coeflab.core.types import dataclass
from coeflab.fits.results.fit_result import FitResult, covariance_of
from coeflab.law.coefficient import Coefficient, CoefficientSet, Status
from coeflab.law.symbols import derivative, primed

if TYPE_CHECKING:
    from coeflab.vehicle.published_values import Reference


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
