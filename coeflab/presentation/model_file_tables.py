"""A model file as tables: what it holds, and what was found."""

from __future__ import annotations

from collections.abc import Sequence

from coeflab.model.check import Check
from coeflab.model.parameter_file import ParameterFile
from coeflab.model.parameter_versions import SCHEMA_VERSION, is_later
from coeflab.model.table import ABSENT, Table, coefficient, number


def contents(parameters: ParameterFile, kind: str) -> Table:
    """Every coefficient, primed and in SI."""
    p = parameters
    rows = tuple(
        (c.symbol, coefficient(c.value), number(c.value_si), c.unit_si, coefficient(c.u95), c.status.replace("_", " "),
         c.origin, c.estimator or ABSENT)
        for c in p.coefficients
    )  # fmt: skip
    point = ", ".join(f"{x:g}" for x in p.reference_point.point)
    notes = (
        f"primed by {_length(p)}; about ({point}) m from: {p.reference_point.datum}",
        f"schema {p.schema_version}, written by coeflab {p.provenance.coeflab_version}; valid"
        if kind == "coeflab"
        else f"read as {kind}; SI values at {p.conditions.density:g} kg/m^3 and {p.conditions.speed:g} m/s",
        *(
            (
                f"schema {p.schema_version} is later than {SCHEMA_VERSION}, which this release writes; empty keys passed over",
            )
            if is_later(p.schema_version, SCHEMA_VERSION)
            else ()
        ),
        *p.provenance.notes,
    )
    headers = ("", "value", "SI", "unit", "U95", "status", "origin", "how")
    return Table(f"{p.name} ({p.body})", headers, rows, notes, frozenset({0, 3, 5, 6, 7}))


def _length(p: ParameterFile) -> str:
    size = f"{p.scaling.length:.6g} m"
    return size if p.scaling.length_name == size else f"{p.scaling.length_name} {size}"


def findings(found: Sequence[Check]) -> Table:
    """Findings with their severity."""
    rows = tuple((str(c.severity), c.subject, c.statistic, c.rule, c.comment or ABSENT) for c in found)
    return Table("Findings", ("severity", "what", "found", "expected", "means"), rows, (), frozenset(range(5)))
