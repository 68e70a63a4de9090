"""A model file as tables: what it holds, and what was found."""

from __future__ import annotations

from collections.abc import Sequence

from coeflab.model.check import Check
from coeflab.model.parameter_file import ParameterFile
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
        f"primed by {p.scaling.length_name} {p.scaling.length:.6g} m; about ({point}) m from: {p.reference_point.datum}",
        f"schema {p.schema_version}, written by coeflab {p.provenance.coeflab_version}; valid"
        if kind == "coeflab"
        else f"read as {kind}; SI values at {p.conditions.density:g} kg/m^3 and {p.conditions.speed:g} m/s",
        *p.provenance.notes,
    )
    headers = ("", "value", "SI", "unit", "U95", "status", "origin", "how")
    return Table(f"{p.name} ({p.body})", headers, rows, notes, frozenset({0, 3, 5, 6, 7}))


def findings(found: Sequence[Check]) -> Table:
    """Findings with their severity."""
    rows = tuple((str(c.severity), c.subject, c.statistic, c.rule, c.comment or ABSENT) for c in found)
    return Table("Findings", ("severity", "what", "found", "expected", "means"), rows, (), frozenset(range(5)))
