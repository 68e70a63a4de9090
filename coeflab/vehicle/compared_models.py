"""Fitted tables of two parameter files side by side, on a grid inside the data of both."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from coeflab.core.axes import ANYWHERE
from coeflab.core.types import Array, dataclass
from coeflab.law.domain import clamped, inside
from coeflab.law.symbols import ANGULAR
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.parameter_model import ParameterModel
from coeflab.vehicle.shared_tables import Verdict, shared_tables

MOST = 2000  # points of the grid: a share to half a per cent
SHARE = 0.95  # of them, as the half-widths are of 95 %
MOMENTS = frozenset("KMNlmn")
SAME = 1e-9


@dataclass(frozen=True, slots=True)
class ComparedModel:
    """One response over the same variables in two files, in the units, area and length of the first.

    Attributes
    ----------
    response : str
    variables : tuple of str
    n_points : int
        Points of the grid inside both domains at which both models have a value.
    rms, largest : float or None
        Of the difference, second minus first.
    at : mapping of variable to float
        Where the largest difference is; angles in radians.
    combined : float or None
        Root mean square over the grid of the root sum of squares of both 95 % half-widths, taken as independent.
    share : float or None
        Of the points with both half-widths, those whose difference is within the combined one.
    verdict : Verdict
        ``within`` where that share is at least `SHARE`. The half-widths hold point by point, not for a whole curve.
    reason : str
        Why not comparable, or what to keep in mind.
    shared : tuple of str
        Tables behind both.
    """

    response: str
    variables: tuple[str, ...]
    n_points: int = 0
    rms: float | None = None
    largest: float | None = None
    at: Mapping[str, float] | None = None
    combined: float | None = None
    share: float | None = None
    verdict: Verdict = Verdict.NOT_COMPARABLE
    reason: str = ""
    shared: tuple[str, ...] = ()

    @property
    def name(self) -> str:
        """Response and variables."""
        return f"{self.response} over {', '.join(self.variables)}"


def compare_models(a: ParameterFile, b: ParameterFile) -> tuple[ComparedModel, ...]:
    """Every fitted table of either file: compared where both have the response over the same variables."""
    ours, theirs = ({(m.response, frozenset(m.names)): m for m in f.models} for f in (a, b))
    out = []
    for key in dict.fromkeys((*ours, *theirs)):
        first, second = ours.get(key), theirs.get(key)
        if first is None or second is None:
            only = second if first is None else first
            which = "first" if first is None else "second"
            if only is not None:
                out.append(ComparedModel(only.response, only.names, reason=f"not in the {which} file"))
        else:
            out.append(_compared(first, second, a, b))
    return tuple(out)


def _compared(first: ParameterModel, second: ParameterModel, a: ParameterFile, b: ParameterFile) -> ComparedModel:
    blank = ComparedModel(first.response, first.names)
    if why := _obstacle(first, second, a, b):
        return replace(blank, reason=why)
    blank = replace(blank, shared=shared_tables(first, second, a.provenance, b.provenance))
    factor, rates = _factors(first, second, a.scaling.length, b.scaling.length)
    columns = _common_grid(first, second, rates)
    if not len(columns[first.names[0]]):
        return replace(blank, reason="the domains have no point of the grid in common")
    value_a, half_a, _ = first.evaluate(columns)
    value_b, half_b, _ = second.evaluate({v: x * rates.get(v, 1.0) for v, x in columns.items()})
    difference, combined = factor * value_b - value_a, np.hypot(half_a, factor * half_b)
    known = np.isfinite(difference)
    sure = known & np.isfinite(combined)
    if not np.any(known):
        return replace(blank, reason="no common point at which both have a value")
    worst = int(np.nanargmax(np.abs(difference)))
    found = replace(
        blank,
        n_points=int(np.sum(known)),
        rms=_rms(difference[known]),
        largest=float(difference[worst]),
        at={v: float(x[worst]) for v, x in columns.items()},
    )
    words = []
    if factor != 1.0 or rates:
        words.append("second converted to the area and length of the first")
    words += [f"terms of the {n} chosen on its data" for n, m in (("first", first), ("second", second))
             if m.post_selection]  # fmt: skip
    if not np.any(sure):
        return replace(found, reason="; ".join(["no interval on one side", *words]))
    share = float(np.mean(np.abs(difference[sure]) <= combined[sure]))
    if found.shared:
        words.append("same data, intervals not independent")
    return replace(
        found,
        combined=_rms(combined[sure]),
        share=share,
        verdict=Verdict.WITHIN if share >= SHARE else Verdict.APART,
        reason="; ".join(words),
    )


def _rms(x: Array) -> float:
    return float(np.sqrt(np.mean(x**2)))


def _moment(response: str) -> bool:
    return response.removeprefix("C_").split("/")[0].removesuffix("'").split(" ")[0] in MOMENTS


def _obstacle(first: ParameterModel, second: ParameterModel, a: ParameterFile, b: ParameterFile) -> str:
    """Why two models cannot be compared; empty if they can."""
    units_a, units_b = ({v.name: v.unit for v in m.variables} for m in (first, second))
    if first.unit != second.unit or units_a != units_b:
        return "in other units"
    if first.unit != "1" and abs(a.conditions.density / b.conditions.density - 1.0) > SAME:
        return "dimensional, at other densities"
    if (first.area is None) != (second.area is None):
        return "only one states its area"
    longer = abs(a.scaling.length / b.scaling.length - 1.0) > SAME
    if first.unit == "1" and first.area is None and longer:
        return "no area stated, and other lengths"
    if _moment(first.response) or set(first.names) & set(ANGULAR):
        here, there = a.reference_point, b.reference_point
        if here.origin != there.origin and ANYWHERE not in (here.origin, there.origin):
            return "the reference points are measured from other datums"
        if here.origin == there.origin and not np.allclose(here.point, there.point, rtol=0.0, atol=SAME):
            return "about other reference points: moments and rates of a table are not transferred"
    return ""


def _factors(
    first: ParameterModel, second: ParameterModel, length_a: float, length_b: float
) -> tuple[float, dict[str, float]]:
    """What turns values of the second into the first's, and rates of the first into the second's, r' = r L/U."""
    if first.unit != "1":
        return 1.0, {}
    area = second.area.value / first.area.value if first.area and second.area else 1.0
    longer = length_b / length_a
    rates = {v: longer for v in first.names if v in ANGULAR and longer != 1.0}
    return area * (longer if _moment(first.response) else 1.0), rates


def _common_grid(first: ParameterModel, second: ParameterModel, rates: Mapping[str, float]) -> dict[str, Array]:
    """A regular grid of at most `MOST` points over the common box, those inside both convex hulls; first's units.

    Data on an oblique line or plane meet no grid; the grid is then moved to the nearest points of the first hull.
    """
    names = first.names
    order = [second.names.index(v) for v in names]
    scale = np.array([rates.get(v, 1.0) for v in names])
    low = np.maximum(first.domain.low, np.array(second.domain.low)[order] / scale)
    high = np.minimum(first.domain.high, np.array(second.domain.high)[order] / scale)
    if np.any(high < low):
        return {v: np.zeros(0) for v in names}
    each = int(MOST ** (1.0 / max(1, int(np.sum(high > low)))) + 1e-9)
    axes = [np.linspace(p, q, each) if q > p else np.array([p]) for p, q in zip(low, high, strict=True)]
    grid = np.column_stack([x.ravel() for x in np.meshgrid(*axes, indexing="ij")])
    spaces_a, spaces_b = (np.array(m.domain.half_spaces).reshape(-1, len(names) + 1) for m in (first, second))

    def common(points: Array) -> Array:
        at_b = (points * scale)[:, np.argsort(order)]
        return points[np.logical_and(inside(spaces_a, points), inside(spaces_b, at_b))]

    selected = common(grid)
    if not len(selected):
        selected = common(clamped(grid, spaces_a, np.array(first.domain.low), np.array(first.domain.high)))
    return dict(zip(names, selected.T, strict=True))
