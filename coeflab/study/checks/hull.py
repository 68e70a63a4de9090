"""Whether the body whose added mass a parameter file holds can be the vehicle whose forces were measured."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from coeflab.core.finding import Severity
from coeflab.core.table import Check

if TYPE_CHECKING:
    from coeflab.study.study import Study

summary = "length and volume of the added mass's body against the vehicle's"
citations = ("sname1950",)

LENGTH, VOLUME, ABSURD = 0.1, 0.05, 0.5


def check(study: Study) -> Sequence[Check]:
    """The hull's length against that of the primes, its volume against the particulars, and whether both are one body."""
    if not study.hulls:
        return []
    from coeflab.bodies.mesh.particulars import likeness

    out = []
    for name, found in study.hulls.items():
        file, hull = study.parameter_files[name], found.body
        shape = hull.require_shape()
        pairs = [(f"{file.scaling.length_name} of the primes", shape.length, file.scaling.length, "m", LENGTH)]
        stated = study.body.configuration(file.body) if study.body else None
        if stated is not None and stated.volume and shape.volume:
            pairs.append((f"volume of {stated.name}", shape.volume, stated.volume, "m^3", VOLUME))
        for what, ours, theirs, unit, limit in pairs:
            out.append(_held(f"{name}: {hull.name}", what, ours, theirs, unit, limit))
        alike = likeness(hull, file.body, stated, own_file=study.body is not None and study.body.files == hull.files)
        if not alike.same:
            severity = Severity.NOTE if alike.same is None else Severity.WARN
            out.append(Check.of("hull.other_body", f"{name}: {hull.name}", severity, body=file.body, words=alike.words))
    return out


def _held(subject: str, what: str, ours: float, theirs: float, unit: str, limit: float) -> Check:
    apart = abs(ours / theirs - 1.0)
    severity = Severity.PASS if apart <= limit else Severity.FAIL if apart > ABSURD else Severity.WARN
    return Check.of(
        "hull.size", subject, severity, ours=ours, theirs=theirs, unit=unit, what=what, limit=limit, match=str(severity)
    )
