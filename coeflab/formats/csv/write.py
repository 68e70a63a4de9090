"""Coefficients, and every fitted model on a grid, as CSV tables with units in the header."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from coeflab.core.provenance import work
from coeflab.core.text.csv_rows import csv_text
from coeflab.core.wording import file_stem, identifier
from coeflab.formats.look_up import LookUp, look_up
from coeflab.law.coefficient import Coefficient
from coeflab.law.symbols import derivative
from coeflab.vehicle.parameter_file import ParameterFile

summary = "coefficients.csv: primed and SI values, U95, status, origin; a table_N.csv for each fitted model"
citations = ("sname1950",)

# Over which a window is one of angles.
ANGLES = {"v": "asin(v/U)", "w": "asin(w/U)", "dr": "dr", "ds": "ds", "db": "db"}
HEADER = (
    "symbol", "value [-]", "u95 [-]", "random [-]", "model_form [-]", "input [-]", "value_si", "unit_si", "status", "origin",
    "table", "estimator", "window_low", "window_high", "n_points", "citation",
    "window_over", "window_unit", "length [m]", "length_name", "reference_point_x [m]", "reference_point_y [m]", "reference_point_z [m]",
    "datum", "density [kg/m^3]", "speed [m/s]", "body", "campaign", "source",
)  # fmt: skip


def _cell(value: object) -> str:
    if value is None or value != value:  # noqa: PLR0124 - NaN alone differs from itself
        return ""
    return str(value).lower() if isinstance(value, bool) else repr(value) if isinstance(value, float) else str(value)


def _table(rows: Iterable[Sequence[object]]) -> bytes:
    return csv_text([_cell(v) for v in row] for row in rows).encode()


def render(parameters: ParameterFile) -> Mapping[str, bytes]:
    """The coefficients of a parameter file and the look-up tables of its models, numbers with all their digits.

    Every row of a coefficient stands by itself: it says its length, reference point, density, speed and source in full.

    Text that a spreadsheet would take for a formula is set behind an apostrophe. A value is empty where the model may not
    be read.
    """
    files = {
        f"{file_stem(parameters.name)}.coefficients.csv": _table(
            [HEADER, *((*_coefficient(c), *_meant(c, parameters)) for c in parameters.coefficients)]
        )
    }
    for k, model in enumerate(parameters.models, 1):
        response = identifier(model.response)
        files[f"{file_stem(parameters.name)}.table_{k}_{response}.csv"] = _table(_look_up(look_up(model)))
    return files


def _coefficient(c: Coefficient) -> tuple[object, ...]:
    low, high = c.window or (None, None)
    return (
        c.symbol, c.value, c.u95, c.parts.random, c.parts.model_form, c.parts.input, c.value_si, c.unit_si, c.status, c.origin,
        c.table, c.estimator, low, high, c.n_points, c.citation,
    )  # fmt: skip


def _meant(c: Coefficient, parameters: ParameterFile) -> tuple[object, ...]:
    """What the numbers of a row are about, and where they come from."""
    over, unit = _window_over(c, parameters) if c.window is not None else ("", "")
    at, scaling = parameters.conditions, parameters.scaling
    sources = ", ".join(work(key.strip()) for key in c.citation.split(",")) if c.citation else ""
    return (
        over, unit, scaling.length, scaling.length_name, *map(float, parameters.reference_point.point), str(parameters.reference_point.datum),
        at.density, at.speed, parameters.body, c.campaign, sources,
    )  # fmt: skip


def _window_over(c: Coefficient, parameters: ParameterFile) -> tuple[str, str]:
    """Motion and unit of a window; of a force at rest, whose symbol names none, the one whose covered range it is."""
    named = c.window_over or next(iter(derivative(c.symbol).factors), "")
    if named:
        return ANGLES.get(named) or f"{named}'", "rad" if named in ANGLES else "1"
    same = {
        (r.variable, r.unit) for r in parameters.covered if r.campaign == c.campaign and (r.low, r.high) == c.window
    }
    return same.pop() if len(same) == 1 else ("", "")


def _look_up(of: LookUp) -> list[Sequence[object]]:
    unit = "-" if of.model.unit == "1" else of.model.unit
    variables = [f"{v.name} [{'-' if v.unit == '1' else v.unit}]" for v in of.model.variables]
    return [[*variables, f"{of.model.response} [{unit}]", f"u95 [{unit}]", "inside the data [-]"], *of.rows]
