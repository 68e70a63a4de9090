"""Coefficients as a CSV table with units in the header, one file per parameter file."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping

from coeflab.model.parameter_file import ParameterFile

summary = "coefficients.csv: primed and SI values, U95 and its parts, status, origin"
citations = ("sname1950",)

HEADER = (
    "symbol", "value [-]", "u95 [-]", "random [-]", "model_form [-]", "input [-]", "value_si", "unit_si", "status", "origin",
    "table", "estimator", "window_low", "window_high", "n_points", "citation",
)  # fmt: skip


def _cell(value: object) -> str:
    return "" if value is None else repr(value) if isinstance(value, float) else str(value)


def render(parameters: ParameterFile) -> Mapping[str, bytes]:
    """The coefficients of a parameter file, numbers with all their digits.

    Text that a spreadsheet would take for a formula is set behind an apostrophe.
    """
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(HEADER)
    for c in parameters.coefficients:
        low, high = c.window or (None, None)
        cells = (
            c.symbol, c.value, c.u95, c.parts.random, c.parts.model_form, c.parts.input, c.value_si, c.unit_si, c.status, c.origin,
            c.table, c.estimator, low, high, c.n_points, c.citation,
        )  # fmt: skip
        writer.writerow(
            ["'" + t if isinstance(v, str) and t[:1] in "=+-@\t\r" and t else t for v in cells for t in [_cell(v)]]
        )
    return {f"{parameters.name}.coefficients.csv": out.getvalue().encode()}
