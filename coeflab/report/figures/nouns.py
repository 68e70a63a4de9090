"""Pictures of a force table and of a parameter file: the points over the motion, and the law through them.

What a gallery and a notebook show of them.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from coeflab.core.errors import CoeflabError
from coeflab.core.types import Array
from coeflab.law.symbols import ANGULAR, COMPONENTS, CONTROLS, MOTIONS
from coeflab.report.document import Figure
from coeflab.report.figures.laws import Plot, Trace, laws_figure
from coeflab.report.figures.palette import power_of_ten
from coeflab.report.notation import as_users_wrote
from coeflab.tables.force_table import AT_REST, ForceTable
from coeflab.vehicle.force_law import motion_law
from coeflab.vehicle.law_at_points import MeasuredTable
from coeflab.vehicle.parameter_file import ParameterFile

# What a motion is looked at for: of a sway sweep Y and N, of a heave sweep Z and M.
MOVED_BY = {"v": "YN", "r": "YN", "w": "ZM", "q": "ZM", "p": "KN", "u": "X", "dr": "YN", "ds": "ZM", "db": "ZM"}
FINE, PANELS, HEIGHT = 81, 2, 96.0
NEAR = 1e-3


@as_users_wrote
def table_figure(table: ForceTable, anchor: str) -> Figure | None:
    """Two measured components over the motion that most rows vary alone; cells that no fit uses are hollow.

    Parameters
    ----------
    table : ForceTable
    anchor : str

    Returns
    -------
    Figure or None
        None where nothing varies, or nothing was measured.
    """
    length = table.scaling.length
    columns = {v: table.primed_motion(v, length) for v in table.varies}
    if not columns or not table.forces:
        return None
    variable = max(columns, key=lambda v: int(np.sum(_alone(columns, v))))
    rows = _alone(columns, variable)
    others = [v for v in columns if v != variable]
    if not np.any(rows):
        rows, others = np.ones(len(table), dtype=bool), []
    wanted = [c for c in MOVED_BY[variable] if c in table.forces] or list(table.forces)
    x, plots = _shown(variable, columns[variable][rows]), []
    for c in wanted[:PANELS]:
        values = table.forces[c][rows]
        factor, power = _scale(values)
        notes = tuple(f"point {label}" for label, row in zip(table.labels, rows, strict=True) if row)
        drawn = traces(x, values * factor, table.usable[c][rows], notes)
        plots.append(_plot(c, power, variable, drawn, is_last=c == wanted[:PANELS][-1]))
    rest = f", {' and '.join(f'{v}' for v in others)} at rest" if others else ""
    words = f"{int(np.sum(rows))} of {len(table)} rows{rest}"
    title = f"{table.name}: {' and '.join(wanted[:PANELS])} over {_name(variable)}"
    return laws_figure(anchor, title, f"{words[0].upper()}{words[1:]}.", f"{title}; {words}.", plots)


def traces(x: Array, y: Array, usable: NDArray[np.bool_], notes: tuple[str, ...] = ()) -> list[Trace]:
    """Points of a component: those that fits may use, and beside them those that none does.

    Parameters
    ----------
    x, y : (n,) array
        Blank cells of y are not a number.
    usable : (n,) boolean array
    notes : tuple of str
        One a point, or none.
    """
    used = usable & np.isfinite(y)
    aside = ~used & np.isfinite(y)
    found = [Trace("points", x[used], y[used], -1, "filled", _of(notes, used) if notes else ())]
    hollow = Trace("not used by fits", x[aside], y[aside], -1, "hollow", _of(notes, aside) if notes else ())
    return [*found, hollow] if np.any(aside) else found


@as_users_wrote
def law_figure(parameters: ParameterFile, anchor: str) -> Figure | None:
    """Two force components of the law over the motion that its data cover first, with the points that it was fitted to.

    Parameters
    ----------
    parameters : ParameterFile
    anchor : str

    Returns
    -------
    Figure or None
        None where no range is covered, or the file gives no force there.
    """
    spans = _spans(parameters)
    if not spans:
        return None
    try:
        law, _ = motion_law(parameters, tables=False)
    except CoeflabError:
        return None
    at, length = parameters.conditions, parameters.scaling.length
    for variable, (low, high) in spans.items():
        prime = np.linspace(min(low, 0.0), max(high, 0.0), FINE)
        force = law.force(_motion(variable, prime, at.speed, length))
        wanted = [c for c in MOVED_BY[variable] if np.any(np.abs(force[:, COMPONENTS.index(c)]) > 0.0)][:PANELS]
        plots = []
        for c in wanted:
            y = force[:, COMPONENTS.index(c)]
            x, points, notes = _measured(parameters.measured, variable, c, at.speed, length)
            factor, power = _scale(np.concatenate([y, points]))
            traces = [Trace("law of the file", _shown(variable, prime), y * factor, 1)]
            if len(x):
                traces.append(Trace("points", _shown(variable, x), points * factor, -1, "filled", notes))
            plots.append(_plot(c, power, variable, traces, is_last=c == wanted[-1]))
        if plots:
            title = f"{parameters.name}: {' and '.join(wanted)} over {_name(variable)}"
            words = f"Force law at {at.speed:.4g} m/s over the range that its data cover, all other motions at rest."
            return laws_figure(anchor, title, words, f"{title}. {words}", plots)
    return None


def _alone(columns: Mapping[str, Array], variable: str) -> NDArray[np.bool_]:
    """Rows in which no other variable moves; all rows count that are at rest altogether."""
    out = np.ones(len(columns[variable]), dtype=bool)
    for name, values in columns.items():
        if name != variable:
            out &= np.abs(values) <= AT_REST
    return out


def _spans(parameters: ParameterFile) -> dict[str, tuple[float, float]]:
    """Covered range of every motion, as v/U or r L/U."""
    out: dict[str, tuple[float, float]] = {}
    for c in parameters.offered:
        bare = c.variable.removeprefix("asin(").removesuffix("/U)").removesuffix("'")
        if bare in MOTIONS and bare != "u" and c.high > c.low:
            ends = (np.sin(c.low), np.sin(c.high)) if c.variable.startswith("asin") else (c.low, c.high)
            known = out.get(bare, ends)
            out[bare] = float(min(known[0], ends[0])), float(max(known[1], ends[1]))
    return out


def _motion(variable: str, prime: Array, speed: float, length: float) -> Array:
    """(n, 6) velocities of that size and speed, one motion varied."""
    nu = np.zeros((len(prime), 6))
    nu[:, MOTIONS.index(variable)] = prime * speed / (length if variable in ANGULAR else 1.0)
    nu[:, 0] = speed if variable in ANGULAR else speed * np.sqrt(np.clip(1.0 - prime**2, 0.0, None))
    return nu


def _measured(
    tables: tuple[MeasuredTable, ...], variable: str, component: str, speed: float, length: float
) -> tuple[Array, Array, tuple[str, ...]]:
    """Points of a component with all other motions at rest, less the force at rest, brought to one speed."""
    x, y, notes = [], [], []
    for table in tables:
        force = next((f for f in table.forces if f.component == component), None)
        if force is None:
            continue
        primes, (nu, _) = table.primes(length), table.states
        own = np.linalg.norm(nu[:, :3], axis=1)
        still = np.all([np.abs(v) <= NEAR for name, v in primes.items() if name != variable], axis=0)
        for i, value in enumerate(force.values):
            if value is not None and still[i] and own[i] > 0.0:
                x.append(float(primes[variable][i]))
                y.append((value - force.at_rest[i]) * (speed / own[i]) ** 2)
                notes.append(f"point {table.labels[i]}")
    return np.array(x), np.array(y), tuple(notes)


def _of(notes: tuple[str, ...], rows: NDArray[np.bool_]) -> tuple[str, ...]:
    return tuple(n for n, row in zip(notes, rows, strict=True) if row)


def _scale(values: Array) -> tuple[float, str]:
    finite = values[np.isfinite(values)]
    return power_of_ten(float(np.max(np.abs(finite), initial=0.0)))


def _shown(variable: str, prime: Array) -> Array:
    """Control angles in degrees, all else in primes."""
    return np.degrees(prime) if variable in CONTROLS else prime


def _name(variable: str) -> str:
    return variable if variable in CONTROLS else f"{variable}'"


def _plot(component: str, power: str, variable: str, traces: list[Trace], *, is_last: bool) -> Plot:
    unit = "N" if component in "XYZ" else "N m"
    across = f"{variable}  [deg]" if variable in CONTROLS else f"{variable}'  [-]"
    return Plot(f"{component}{power}  [{unit}]", across, tuple(traces), HEIGHT, is_scaled=is_last)
