"""Quality of the data: forces at rest, rejected and doubtful cells, and how far repeated runs agree."""

from __future__ import annotations

import numpy as np

from coeflab.kernels.diagnostics import replicate_groups
from coeflab.model.fit_result import Sweep
from coeflab.model.force_table import ForceTable
from coeflab.model.study import Study
from coeflab.model.table import ABSENT, Table, coefficient, number
from coeflab.presentation.campaign_sections import filled
from coeflab.presentation.document import Section

TEXT = (
    "A symmetric body has no side force at no angle; what a curve has there is misalignment, an asymmetry of the model, or an "
    "offset of the balance. Beside it stands the angle at which the recommended slope would give as much.",
    "Repeats are usable points of one table at one setting. Their scatter is what the measurement itself gives, and no fit can be "
    "better than it.",
)
AT_REST = (
    "median of the curves: over all members at no angle; of largest: its size over the largest force of the sweep. The check of "
    "symmetry takes one member instead, that with the most points, whose value at rest has an interval: the two may differ.",
)
SAME_SETTING = 1e-6


def quality_sections(study: Study) -> tuple[Section, ...]:
    """One section, or none where the study has no tables."""
    if not study.tables:
        return ()
    shown = filled(_at_rest(study), _repeats(study.tables), _counts(study.tables), _cells(study.tables))
    text = TEXT if len(shown) else ()
    if not any(t.exclusions for t in study.tables):
        text = (*text, "No row and no cell is rejected or doubtful.")
    return (Section("data-quality", "Data quality", text, shown),)


def _at_rest(study: Study) -> Table:
    """Forces at no angle of the odd sweeps, from the recommended members, as force and as angle."""
    rows = []
    for fit in study.fits:
        for s in fit.sweeps:
            if s.parity != "odd" or s.target != "x" or not s.recommendation.members:
                continue
            value = _rest(s)
            slope = s.recommendation.value
            half = s.recommendation.u95
            angle = ABSENT if not slope or not s.is_angle else f"{np.degrees(value / slope):+.2f}"
            largest = float(np.max(np.abs(s.y)))
            measured = [y for x, y in zip(s.x, s.y, strict=True) if abs(x) <= SAME_SETTING]
            at_zero = ABSENT if not measured else coefficient(float(np.mean(measured)))
            rows.append(
                (
                    s.campaign, f"{s.component}'", s.variable + "'", coefficient(value), at_zero,
                    f"{100.0 * abs(value) / largest:.1f} %" if largest > 0.0 else ABSENT, angle, ABSENT if half is None else coefficient(half),
                )
            )  # fmt: skip
    headers = (
        "campaign",
        "force",
        "over",
        "median of the curves",
        "measured",
        "of largest",
        "as angle deg",
        "U95 of the slope",
    )
    return Table("Forces at rest", headers, tuple(rows), AT_REST, frozenset({0, 1, 2}))


def _rest(sweep: Sweep) -> float:
    """Median of the members' values at rest."""
    return float(np.median([float(e.curve(np.zeros(1))[0]) for e in sweep.recommendation.members]))


def _repeats(tables: tuple[ForceTable, ...]) -> Table:
    """Pooled standard deviation of repeated settings, per table and force."""
    rows = []
    for t in tables:
        names = [*t.varies] or ["v"]
        length = t.scaling.length
        settings = np.column_stack([t.primed_motion(v, length) for v in names] + [t.speed / float(np.max(t.speed))])
        for component, usable in t.usable.items():
            kept = np.flatnonzero(usable & np.isfinite(t.forces[component]))
            groups = _groups(settings[kept])
            if not groups:
                continue
            y = t.primed_force(component, length)[kept]
            freedom = sum(len(g) - 1 for g in groups)
            pooled = np.sqrt(sum(float(np.sum((y[g] - y[g].mean()) ** 2)) for g in groups) / freedom)
            largest = float(np.max(np.abs(y)))
            share = f"{100.0 * pooled / largest:.2g} %" if largest else ABSENT
            rows.append((t.name, f"{component}'", str(len(groups)), str(freedom), number(float(pooled), 3), share))
    headers = ("table", "force", "settings repeated", "degrees of freedom", "standard deviation", "of largest")
    return Table("Repeatability", headers, tuple(rows), (), frozenset({0, 1}))


def _groups(settings: np.ndarray) -> list[np.ndarray]:
    """Rows of equal settings, of two and more."""
    if not len(settings):
        return []
    _, key = np.unique(np.round(settings / SAME_SETTING), axis=0, return_inverse=True)
    return replicate_groups(np.asarray(key, dtype=float).ravel(), 0.5)


def _counts(tables: tuple[ForceTable, ...]) -> Table:
    """Rows, cells, and what is not used of them."""
    rows = []
    for t in tables:
        cells = sum(mask.size for mask in t.usable.values())
        used = sum(int(mask.sum()) for mask in t.usable.values())
        whole = sum(not e.component for e in t.exclusions)
        doubtful = sum(e.uncertain for e in t.exclusions)
        rejected = len(t.exclusions) - whole - sum(e.uncertain and bool(e.component) for e in t.exclusions)
        counts = (len(t), cells, used, rejected, doubtful, whole)
        rows.append((t.name, *map(str, counts)))
    headers = ("table", "rows", "force cells", "usable", "rejected cells", "doubtful", "rejected rows")
    return Table("Rows and cells", headers, tuple(rows), (), frozenset({0}))


def _cells(tables: tuple[ForceTable, ...]) -> Table:
    """Cells and rows that are not used, gathered by table and reason."""
    places: dict[tuple[str, str, str], dict[str, list[str]]] = {}
    for t in tables:
        for e in t.exclusions:
            what = places.setdefault((t.name, "doubtful" if e.uncertain else "rejected", e.reason), {})
            what.setdefault(e.component or "whole row", []).append(t.labels[e.row])
    rows = tuple(
        (*key, "; ".join(f"{force}: {', '.join(labels)}" for force, labels in what.items()))
        for key, what in places.items()
    )
    headers = ("table", "what", "reason", "points")
    return Table("Cells that the fits do not use", headers, rows, (), frozenset(range(4)))
