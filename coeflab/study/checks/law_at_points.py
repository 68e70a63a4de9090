"""The law of every parameter file against the measured points that it was fitted to."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from coeflab.core.wording import listed
from coeflab.law.symbols import primed
from coeflab.vehicle.plausibility import findings_at_points

if TYPE_CHECKING:
    from coeflab.core.table import Check
    from coeflab.study.study import Study
    from coeflab.vehicle.law_at_points import LawAtPoints
    from coeflab.vehicle.parameter_file import ParameterFile

summary = "distance of a parameter file's law from its measured points, and where the law holds"
citations = ("roddy1990",)


def check(study: Study) -> Sequence[Check]:
    """One finding per parameter file, table and component, from the law as the file has it now."""
    return [
        replace(c, subject=f"{name} {c.subject}", comment=_comment(study, parameters, at, c.comment))
        for name, parameters in study.parameter_files.items()
        for at, c in findings_at_points(parameters)
    ]


def _comment(study: Study, parameters: ParameterFile, at: LawAtPoints, comment: str) -> str:
    """The comment; the points that a slope at the origin left out as not belonging come first."""
    out: dict[str, list[str]] = {}
    for f in study.fits:
        for s in f.sweeps:
            if (s.component, s.table) == (at.component, at.table):
                for label in (s.labels[i] for i in s.wrong):
                    out.setdefault(label, []).append(primed(s.symbol))
    if not out:
        return comment
    points = "; ".join(f"{label} is left out of {listed(symbols)} (data gate)" for label, symbols in out.items())
    used = [
        label
        for m in parameters.measured
        for f in m.forces
        if (f.component, m.table) == (at.component, at.table)
        for label, value in zip(m.labels, f.values, strict=True)
        if value is not None and m.labels.count(label) == 1
    ]
    if still := [label for label in out if label in at.missed or label in used]:
        rest = f" {comment}" * bool(set(at.missed) - set(out))
        return (
            f"{points}, while other terms of the law use {listed(still)}. Compare it with its source first, and name the cell "
            f"under uncertain to leave it out of them too.{rest}"
        )
    return f"{points}, and of the law. Compare it with its source. {comment}".strip()
