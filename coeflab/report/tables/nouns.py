"""Nouns as tables: the same for terminal, report and notebook."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from coeflab.core.table import ABSENT, Table, number, percent, with_u95
from coeflab.law.coefficient import COVERS, Coefficient, Status
from coeflab.law.symbols import COMPONENTS, primed
from coeflab.report.texts import table_of, text_of, texts_of

if TYPE_CHECKING:
    from coeflab.fits.results.fitted_model import FittedModel
    from coeflab.law.added_mass import AddedMass
    from coeflab.motion.trajectory import Trajectory
    from coeflab.vehicle.parameter_file import ParameterFile


DEFINED = (
    "U95 of a slope at the origin: 95 % half-width; covers {}. random: scatter of the points; form: the curve that "
    "the points leave open, or what a fixed form misses by its residuals; input: declared errors of inputs, the grid, printed digits."
)
STATUS = "status"
ROUNDING = 1e-12
REJECTED, NO_VALUE = "form rejected", "no value"


def window_text(c: Coefficient) -> str:
    """Range of the motion variable that is used."""
    if c.window is None:
        return ABSENT
    low, high = c.window
    unit = "" if c.window_is_rate else " deg"
    if not c.window_is_rate:
        low, high = math.degrees(low), math.degrees(high)
    return f"{number(low, 3)} .. {number(high, 3)}{unit}"


def with_status(c: Coefficient, marked: bool = True) -> tuple[str, str]:
    """Value and U95, or the status that says why one of them is none; an assumed symmetry is marked beside U95 where no column has it."""
    if c.value is None:
        return without_value(c), ABSENT
    if c.status is Status.FORM_REJECTED:
        return with_u95(c.value, None)[0], REJECTED
    value, u95 = with_u95(c.value, c.u95)
    return value, f"{u95}, {_mark(c)}" if marked and c.status is Status.SYMMETRY_ASSUMED else u95


def without_value(c: Coefficient) -> str:
    """What stands in the place of a value: the reason, or that there is none."""
    return NO_VALUE if c.status == "not_determined" else c.status.replace("_", " ")


def coefficients(several: Sequence[Coefficient], title: str = "Coefficients, primed", *, covers: str = COVERS) -> Table:
    """Coefficients with their uncertainty and how they were made.

    Parameters
    ----------
    several : sequence of Coefficient
    title : str
    covers : str
        What U95 of a slope at the origin covers. It is not said of fixed forms, whose rows are marked in a column of their own.
    """
    fixed = [c for c in several if c.value is not None and c.status is Status.FORM_ASSUMED]
    rows = [
        (
            primed(c.symbol),
            *with_status(c, marked=not fixed),
            percent(c.u95, c.value),
            *((_mark(c),) if fixed else ()),
            percent(c.parts.random, c.value),
            percent(c.parts.model_form, c.value),
            percent(c.parts.input, c.value),
            window_text(c),
            str(c.n_points) if c.n_points else ABSENT,
            c.campaign or ABSENT,
            c.estimator or ABSENT,
        )
        for c in several
    ]
    headers = ("", "value", "U95", "U95 %", *((STATUS,) if fixed else ()), "random", "form", "input", "window", "n")
    headers += ("campaign", "estimator")
    fitted = [c for c in several if c.u95 is not None and c.origin == "fit"]
    slopes = [c for c in fitted if c not in fixed]
    notes = ((DEFINED.format(covers),) if slopes or not fixed else ()) + (
        (text_of("nouns.defined_fixed"),) if fixed else ()
    )
    notes += texts_of("nouns.scatter_only") if any(c.parts.model_form is None for c in fitted) else ()
    notes += tuple(
        f"{NO_VALUE if s == 'not_determined' else s.replace('_', ' ')}{_named(several, s)}: {s.advice}"
        for s in sorted({c.status for c in several})
        if s.advice
    )
    flush = ("", STATUS, "window", "campaign", "estimator")
    return Table(title, headers, tuple(rows), notes, frozenset(i for i, h in enumerate(headers) if h in flush))


def _mark(c: Coefficient) -> str:
    """The status of a row, where its value does not say it and there is something to say."""
    return ABSENT if c.value is None or c.status in (Status.OK, Status.FORM_REJECTED) else c.status.replace("_", " ")


def _named(several: Sequence[Coefficient], status: Status) -> str:
    """The rows that a note is about, where no cell of theirs shows it."""
    symbols = list(dict.fromkeys(primed(c.symbol) for c in several if c.status is status))
    return f" ({', '.join(symbols)})" if status is Status.SIGN_OPEN else ""


def _with_half(value: float, half: float, rejected: bool, known: bool) -> tuple[str, str]:
    """In any unit: five digits where no half-width says how many."""
    if not known:
        return NO_VALUE, ABSENT
    if rejected:
        return number(value, 5), REJECTED
    return with_u95(value, half) if math.isfinite(half) and half > 0.0 else (number(value, 5), number(half, 3))


def terms(model: FittedModel) -> Table:
    """Every coefficient with its interval; what the data leave open is said below, not printed as a number."""
    rows, rejected = [], model.rejected
    for symbol, term, value, half in zip(
        model.symbols, model.terms, model.fit.coefficients, model.half_width, strict=True
    ):
        known = math.isfinite(value)
        rows.append(
            (
                symbol,
                str(term),
                *_with_half(float(value), float(half), symbol in rejected, known),
                percent(float(half), float(value)) if known else ABSENT,
            )
        )
    title = f"{model.response} [{model.unit if model.unit != '1' else '-'}], {model.form}: {model.campaign}"
    return table_of("nouns.terms", rows, model.statements, title=title)


def matrix(result: AddedMass) -> Table:
    """One 6 x 6 matrix."""
    cut = ROUNDING * float(np.max(np.abs(result.matrix)))
    rows = [(a, *(number(v if abs(v) > cut else 0.0) for v in row)) for a, row in zip(COMPONENTS, result.matrix)]
    at = ", ".join(f"{x:g}" for x in result.reference_point)
    return table_of("nouns.matrix", rows, method=result.method, at=at, datum=result.datum)


def parameters(file: ParameterFile) -> Table:
    """The coefficients of a parameter file, primed and in SI at its conditions."""
    rows = tuple(
        (
            c.symbol, *(with_u95(c.value, c.u95) if c.value is not None else (without_value(c), ABSENT)),
            number(c.value_si), c.unit_si, c.origin, c.campaign or c.citation or ABSENT,
        )
        for c in file.coefficients
    )  # fmt: skip
    at = f"{file.conditions.speed:.5g} m/s and {file.conditions.density:.5g} kg/m^3"
    notes = (f"primed by {file.scaling.length_name} {file.scaling.length:.5g} m; SI at {at}", *file.remarks)
    headers = ("", "value", "U95", f"at {file.conditions.speed:.4g} m/s", "unit", "origin", "from")
    return Table(f"{file.name}: {file.body}", headers, rows, notes, frozenset({0, 4, 5, 6}))


def motion(trajectory: Trajectory) -> Table:
    """Beginning, end and range of what a motion is described by."""
    degrees = 180.0 / np.pi
    columns = {f"{n} [m/s]": trajectory.velocity[:, i] for i, n in enumerate("uvw")}
    columns |= {f"{n} [deg/s]": trajectory.velocity[:, 3 + i] * degrees for i, n in enumerate("pqr")}
    columns |= {f"{n} [m]": trajectory.position[:, i] for i, n in enumerate(("north", "east", "depth"))}
    columns["heading turned [deg]"] = trajectory.heading * degrees
    rows = tuple(
        (name, *(number(float(v) + 0.0) for v in (x[0], x[-1], x.min(), x.max()))) for name, x in columns.items()
    )
    beyond = [name for name, flags in trajectory.outside.items() if flags.any()]
    notes: tuple[str, ...] = (
        f"ended: {trajectory.ended.value.replace('_', ' ')}{': ' * bool(trajectory.why)}{trajectory.why}",
    )
    notes += (f"beyond the data: {', '.join(beyond)}",) if beyond else ()
    return table_of(
        "nouns.motion", rows, notes, time=trajectory.time[-1] - trajectory.time[0], time_2=len(trajectory.time)
    )
