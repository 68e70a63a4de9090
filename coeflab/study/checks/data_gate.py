"""Readings that do not belong to their sweep, rows that decide a derivative, and rows that were pasted twice.

A table is cut into sweeps, rows in which one variable alone changes, and every component of every sweep goes through
`coeflab.fits.statistics.data_gate` in the table's own reference point. One finding a row, whatever is wrong with it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from coeflab.core.finding import Severity
from coeflab.core.table import Check, as_check, number
from coeflab.core.wording import listed
from coeflab.fits.rows.straight_runs import straight_runs
from coeflab.fits.rows.sweeps import arm_shift, collect_points, sweep_rows
from coeflab.fits.statistics import data_gate, origin_slope
from coeflab.fits.statistics.data_gate import FEWEST, Gate, Parity, Screened
from coeflab.fits.statistics.slopes import rest_and_curvature
from coeflab.law.symbols import MOMENTS, PORT_STARBOARD, primed
from coeflab.study.rows_elsewhere import Exchanged, Slope, exchanged_rows, grid_rows_elsewhere
from coeflab.study.table_sweeps import Sweep, ahead_counts, setting_in_words, sweeps_of

if TYPE_CHECKING:
    from coeflab.core.types import Array
    from coeflab.study.study import Study
    from coeflab.tables.force_table import ForceTable

summary = "every reading predicted from the others of its sweep; rows that decide a derivative; pasted rows"
citations = ("ittc_uncertainty",)

# Share of clean campaigns in which a reading may fail, and in which a row may fail by all its components together.
LEVEL, SHARED = 0.02, 0.005
AHEAD = 0.02  # of the speed
ZEROS = 1e-9  # of the largest primed force or moment: readings below it are numerical zeros
OPPOSITE = 0.05  # of what is expected: a reading so near to its opposite has the other sign
LARGEST_SWEEP = 200
SLOPES = {"beta": ("v", "YNK"), "alpha": ("w", "ZM"), "r": ("r", "YNK"), "q": ("q", "ZM"), "p": ("p", "K"),
          "dr": ("dr", "YNK"), "ds": ("ds", "ZM"), "db": ("db", "ZM")}  # fmt: skip
EVEN = {"beta": "v", "alpha": "w", "r": "r", "q": "q"}
MOST_LINES, MIRRORED = 12, 2


@dataclass(slots=True)
class _Row:
    """What is said of one row."""

    cells: list[str] = field(default_factory=list)
    components: list[str] = field(default_factory=list)
    values: list[str] = field(default_factory=list)
    comments: list[str] = field(default_factory=list)
    left_out: list[str] = field(default_factory=list)
    used: list[str] = field(default_factory=list)


def _copies(table: ForceTable) -> NDArray[np.bool_]:
    """Rows with forces that repeat an earlier one to the last digit; blank ones, such as runs that wait, repeat nothing."""
    columns = [*table.motion.values(), *table.controls.values(), table.speed, *table.forces.values()]
    matrix = np.nan_to_num(np.column_stack(columns), nan=1e300)
    again = np.ones(len(table), bool)
    again[np.unique(matrix, axis=0, return_index=True)[1]] = False
    measured: NDArray[np.bool_] = np.any([np.isfinite(force) for force in table.forces.values()], axis=0)
    return again & measured


@dataclass(slots=True)
class _Cell:
    """One reading as its best sweep sees it."""

    sweep: Sweep
    at: int
    seen: Screened
    parity: Parity
    gate: Gate | None = None


def _largest(table: ForceTable) -> dict[str, float]:
    """The largest primed size of every component among its usable rows; primes of moments are by one length more."""
    sizes = {c: np.abs(table.primed_force(c, table.scaling.length)[usable]) for c, usable in table.usable.items()}
    return {c: float(size.max(initial=0.0)) for c, size in sizes.items()}


def _screened(table: ForceTable, selected: NDArray[np.bool_], limit: float) -> dict[tuple[int, str], _Cell]:
    """Every reading that a sweep holds, by row and component; of several sweeps the one that predicts it best."""
    cells: dict[tuple[int, str], _Cell] = {}
    length = table.scaling.length
    zero = ZEROS * max(_largest(table).values(), default=0.0)
    for sweep in sweeps_of(table, selected):
        for component, usable in table.usable.items():
            inside = usable[sweep.rows]
            x = np.ascontiguousarray(sweep.x[inside], dtype=float)
            if len(x) < FEWEST or len(np.unique(x)) < 3 or not np.any(x):
                continue
            rows = sweep.rows[inside]
            errors = table.errors.get(component)
            known = errors is not None and bool(np.all(np.isfinite(errors[rows]) & (errors[rows] > 0.0)))
            variance = table.primed_force(component, length, errors)[rows] ** 2 if known else None
            parity = sweep.parity(component)
            y = table.primed_force(component, length)[rows]
            if np.abs(y).max() <= zero:
                continue
            gate = None if len(rows) > LARGEST_SWEEP else data_gate.prepare(x, parity, variance)
            seen = data_gate.screen_many(x, y, limit) if gate is None else data_gate.screen(gate, y, parity, limit)
            for at, row in enumerate(rows):
                best = cells.get((int(row), component))
                if best is None or seen.scatter[at] < best.seen.scatter[best.at]:
                    here = Sweep(sweep.variable, rows, x, sweep.still, sweep.lateral)
                    cells[int(row), component] = _Cell(here, at, seen, parity, gate)
    return cells


def _estimates(
    table: ForceTable, tables: Sequence[ForceTable], length: float
) -> Iterator[tuple[str, str, str, NDArray[np.intp], Array, Array, Array | None, origin_slope.OriginSlope]]:
    """Slopes at the origin that the table gives: variable, component, symbol, rows, x, y, se, estimate."""
    largest = _largest(table)
    zero = ZEROS * max(largest.values(), default=0.0)
    for name, (variable, components) in SLOPES.items():
        if variable not in table.varies:
            continue
        rows = sweep_rows(table, variable, tables, length)
        for component in components:
            if component not in table.forces or largest.get(component, 0.0) <= zero:
                continue
            x, y, se, _, _ = collect_points(rows, component, length, np.zeros(len(table)))
            index = rows.rows[table.usable[component][rows.rows]]
            if len(x) >= FEWEST and np.any(x):
                yield (name, component, component + variable, index, x, y, se, origin_slope.estimate(x, y, se))


def _value(value: float, half: float) -> str:
    return f"{number(value, 3)} ± {number(half, 2)}"


def _where(table: ForceTable, row: int) -> str:
    return f"{table.name} line {table.lines[row]}" if table.lines else f"{table.name} {table.labels[row]}"


def _named(table: ForceTable, row: int) -> str:
    """The row by the name of its point, which the user's own file has, too; else plainly."""
    named = table.lines and table.labels[row] != f"line {table.lines[row]}"
    return f"point {table.labels[row]}" if named else "the row"


def _si(table: ForceTable, component: str, row: int, primed_value: float) -> float:
    unit = 1.0 / table.primed_force(component, table.scaling.length, np.ones(len(table)))[row]
    return float(primed_value * unit)


def _cell_text(table: ForceTable, component: str, row: int, cell: _Cell) -> str:
    expected = _si(table, component, row, float(cell.seen.expected[cell.at]))
    scatter = _si(table, component, row, float(cell.seen.scatter[cell.at]))
    if component in table.primed:
        own = float(table.primed_force(component, table.scaling.length)[row])
        at, around = float(cell.seen.expected[cell.at]), float(cell.seen.scatter[cell.at])
        return f"{component}' = {number(own, 4)}, expected {number(at, 4)} ± {number(around, 2)}"
    unit = "N m" if component in MOMENTS else "N"
    value = float(table.forces[component][row])
    text = f"{component} = {number(value, 4)} {unit}, expected {number(expected, 4)} ± {number(scatter, 2)} {unit}"
    opposite = abs(value + expected) <= max(scatter, OPPOSITE * abs(expected)) < abs(expected)
    return text + ": sign?" if opposite else text


def _without(x: Array, y: Array, se: Array | None, at: NDArray[np.bool_]) -> origin_slope.OriginSlope:
    return origin_slope.estimate(x[~at], y[~at], None if se is None else se[~at])


def _shared_errors(table: ForceTable, cells: dict[tuple[int, str], _Cell], rows: dict[int, _Row], limit: float) -> None:
    """Rows whose components depart together as a wrong setting makes them, and which setting would suit all of them."""
    sweeps: dict[tuple[str, bytes], dict[str, _Cell]] = {}
    for (_, component), cell in cells.items():
        if len(cell.sweep.rows) <= LARGEST_SWEEP:
            sweeps.setdefault((cell.sweep.variable, cell.sweep.rows.tobytes()), {})[component] = cell
    for (name, _), by_component in sweeps.items():
        if len(by_component) < 2:
            continue
        first = next(iter(by_component.values())).sweep
        y = np.array([table.primed_force(c, table.scaling.length)[first.rows] for c in by_component])
        expected = np.array([c.seen.expected for c in by_component.values()])
        scatter = np.array([c.seen.scatter for c in by_component.values()])
        probability = np.array([c.seen.probability for c in by_component.values()])
        signs = np.array(
            [{Parity.ODD: -1.0, Parity.EVEN: 1.0, Parity.ANY: 0.0}[k.parity] for k in by_component.values()]
        )
        strange = data_gate.strange_settings(first.x, y, scatter, signs)
        for at, other in strange.items():
            given = rows.setdefault(int(first.rows[at]), _Row())
            given.cells.append(f"{setting_in_words(name, first.x[at])} is isolated")
            given.components += [c for c in by_component if c not in given.components]
            if other is not None:
                partner, mirror = setting_in_words(name, first.x[other]), setting_in_words(name, -first.x[other])
                given.comments.append(
                    f"{mirror} instead of {setting_in_words(name, first.x[at])} makes it the image of {partner}."
                )
        p = data_gate.wrong_setting(first.x, y - expected, expected, scatter, probability)
        for at, row in enumerate(first.rows):
            if not any(cells[int(row), c].sweep.rows is by_component[c].sweep.rows for c in by_component):
                continue
            if p[at] < limit and int(row) not in rows:
                given = rows.setdefault(int(row), _Row())
                given.components += list(by_component)
                given.cells += [
                    _cell_text(table, c, int(row), _Cell(first, at, k.seen, k.parity)) for c, k in by_component.items()
                ]
                given.comments.append("No single component is off; together they are.")
            if int(row) in rows and len(rows[int(row)].components) > 1 and at not in strange:
                suits = data_gate.setting_that_suits(first.x, y[:, at], expected, scatter)
                if suits is not None:
                    rows[int(row)].comments.append(
                        f"{setting_in_words(name, suits)} instead of {setting_in_words(name, first.x[at])} would fit all components."
                    )


def _exchanged(
    table: ForceTable,
    about: ForceTable,
    tables: Sequence[ForceTable],
    length: float,
    cells: Mapping[tuple[int, str], _Cell],
) -> list[Exchanged]:
    """Pairs of rows in each other's place, sweep by sweep; slopes as they stand and exchanged."""
    by_sweep: dict[tuple[str, bytes], tuple[Sweep, dict[str, Gate]]] = {}
    for (_, component), cell in cells.items():
        if cell.gate is not None:
            key = cell.sweep.variable, cell.sweep.rows.tobytes()
            by_sweep.setdefault(key, (cell.sweep, {}))[1][component] = cell.gate
    estimates: list[Slope] | None = None
    out: list[Exchanged] = []
    for sweep, gates in by_sweep.values():
        for rows, gain, threshold in exchanged_rows(table, sweep, gates):
            if estimates is None:
                estimates = [
                    Slope(e[2], e[3], *e[4:7], e[7].value, e[7].u95) for e in _estimates(about, tables, length)
                ]
            out.append(Exchanged.of(table, sweep, tuple(gates), rows, (gain, threshold), estimates))
    return out


def _slopes(
    table: ForceTable, tables: Sequence[ForceTable], length: float, again: NDArray[np.bool_], rows: dict[int, _Row]
) -> None:
    """Derivatives with and without the rows that fail, and rows that decide a derivative."""
    for _, component, symbol, index, x, y, se, found in _estimates(table, tables, length):
        for at, row in enumerate(map(int, index)):
            if again[row] or not np.isfinite(found.value):
                continue
            left_out = not found.used[at] and found.wrong[at] > 0.0
            decides = (
                found.status is not origin_slope.Status.WRONG_POINT
                and len(x) > FEWEST
                and abs(found.without[at] - found.with_all) > found.u95
            )
            failed = row in rows and component in rows[row].components
            if not (left_out or decides or failed):
                continue
            without = _without(x, y, se, np.arange(len(x)) == at)
            decides = abs(without.value - found.with_all) > found.u95
            if not (left_out or decides or failed):
                continue
            given = rows.setdefault(row, _Row())
            given.values.append(
                f"{primed(symbol)} = {_value(found.with_all, found.u95_with_all)} with the row, "
                f"{_value(without.value, without.u95)} without it"
            )
            (given.used if found.used[at] else given.left_out).append(primed(symbol))
            if decides and not failed and not left_out:
                given.comments.append(f"The row decides {primed(symbol)}: U95 of all rows is {number(found.u95, 2)}.")
            elif left_out and not failed:
                given.components.append(component)


def _curvatures(table: ForceTable, cells: dict[tuple[int, str], _Cell], length: float, rows: dict[int, _Row]) -> None:
    """X0 and Xvv, Xww, Xrr, Xqq with and without the rows whose X fails."""
    for row, given in rows.items():
        cell = cells.get((row, "X"))
        if cell is None or "X" not in given.components or not cell.sweep.still or cell.sweep.variable not in EVEN:
            continue
        name, usual = cell.sweep.variable, table.scaling.length
        x = cell.sweep.x * (length / usual if name in "qr" else 1.0)
        y = table.primed_force("X", length)[cell.sweep.rows]
        both = [rest_and_curvature(x[k], y[k]) for k in (np.ones(len(x), bool), np.arange(len(x)) != cell.at)]
        for symbol, at in ((f"X{EVEN[name] * 2}", 1), ("X0", 0)):
            if both[0][at] is None:
                continue
            given.values.append(
                f"{primed(symbol)} = {number(both[0][at], 3)} with the row, {number(both[1][at], 3)} without it"
            )


def _as_check(table: ForceTable, row: int, given: _Row, readings: int) -> Check:
    words = [*given.comments, *([] if given.values else ["No derivative at the origin uses it."])]
    if given.left_out:
        words.insert(
            0, f"Left out of {listed(given.left_out)}{f', used by {listed(given.used)}' if given.used else ''}."
        )
    advice = (LEFT_OUT if given.left_out and not given.used else ADVICE).replace("the row", _named(table, row))
    return Check(
        "data_gate",
        _where(table, row),
        Severity.WARN,
        "; ".join([*given.cells, *given.values]),
        f"of {readings} right readings one deviates so far with a probability above {LEVEL:g}"
        if given.cells
        else "no row moves a value by its U95",
        " ".join([*words, advice if given.cells or given.left_out else INFLUENTIAL]),
    )


def _together(table: ForceTable, tables: Sequence[ForceTable], length: float, rows: dict[int, _Row]) -> Check:
    """One finding on more rows than a person compares one by one."""
    values = []
    for _, component, symbol, index, x, y, se, found in _estimates(table, tables, length):
        failed = np.array([int(row) in rows and component in rows[int(row)].components for row in index])
        if failed.any() and np.isfinite(found.value):
            without = _without(x, y, se, failed)
            values.append(
                f"{primed(symbol)} = {_value(found.with_all, found.u95_with_all)} with these rows, "
                f"{_value(without.value, without.u95)} without them"
            )
    components = listed([c for c in table.forces if any(c in given.components for given in rows.values())])
    where = [str(table.lines[i]) if table.lines else table.labels[i] for i in sorted(rows)]
    return Check.of(
        "data_gate.rows", table.name, Severity.WARN, count=len(rows), components=components, lines=_some(where),
        values="".join(f"; {v}" for v in values),
    )  # fmt: skip


def _some(where: Sequence[str]) -> str:
    return listed(list(where)) if len(where) <= MOST_LINES else f"{', '.join(where[:MOST_LINES])} ..."


ADVICE = "Compare the row with its source; name the cell under uncertain to leave it out."
LEFT_OUT = "Compare the row with its source; the law does without it, other fits use it unless the cell is named under uncertain."
INFLUENTIAL = "Repeat the run."


def _open_ends(table: ForceTable, cells: dict[tuple[int, str], _Cell], rows: dict[int, _Row]) -> list[Check]:
    found: dict[int, list[str]] = {}
    for (row, component), cell in sorted(cells.items()):
        if cell.seen.open_end[cell.at] and row not in rows:
            found.setdefault(row, []).append(_cell_text(table, component, row, cell))
    return [
        Check.of("data_gate.open_end", _where(table, row), Severity.NOTE, readings="; ".join(texts)) for row, texts in found.items()
    ]  # fmt: skip


def _pasted(table: ForceTable, again: NDArray[np.bool_]) -> list[Check]:
    """Exact copies of rows, and a half that mirrors the other."""
    out = []
    if again.any():
        where = [str(table.lines[i]) if table.lines else table.labels[i] for i in np.flatnonzero(again)]
        several = again.sum() > 1 or len(table.forces) > 1
        severity, count = Severity.WARN if several else Severity.NOTE, int(again.sum())
        out.append(
            Check.of("data_gate.copies", table.name, severity, count=count, rows="one" if count == 1 else "many", lines=_some(where))
        )  # fmt: skip
    if _is_mirrored(table, again):
        out.append(Check.of("data_gate.mirrored", table.name, Severity.NOTE))
    return out


def _is_mirrored(table: ForceTable, again: NDArray[np.bool_]) -> bool:
    columns = dict(table.motion) | dict(table.controls) | dict(table.forces)
    read = ~again & np.all([np.isfinite(c) for c in columns.values()], axis=0)
    side = [n for n in columns if n in PORT_STARBOARD]
    matrix = np.column_stack([*columns.values(), table.speed])[read]
    if not len(matrix):
        return False
    sign = np.array([-1.0 if n in PORT_STARBOARD else 1.0 for n in columns] + [1.0])
    size = np.where(np.abs(matrix).max(0) > 0.0, np.abs(matrix).max(0), 1.0)
    digits = np.round(matrix / size, 12) + 0.0
    moved = (
        np.any(np.column_stack([columns[n] for n in side])[read] != 0.0, axis=1)
        if side
        else np.zeros(len(matrix), bool)
    )
    known = {tuple(r) for r in digits}
    return int(moved.sum()) > MIRRORED and all(tuple(r * sign + 0.0) in known for r in digits[moved])


def _astern(table: ForceTable, ahead: NDArray[np.bool_]) -> list[Check]:
    """Rows that run astern in a table that runs ahead."""
    if not 0 < np.count_nonzero(~ahead) <= 0.2 * len(table):
        return []
    where = [str(table.lines[i]) if table.lines else table.labels[i] for i in np.flatnonzero(~ahead)]
    return [Check.of("data_gate.astern", f"{table.name} line {_some(where)}", Severity.WARN)]


def _summary(campaign: str, readings: int, missed: int, found: Sequence[Check]) -> Check:
    grave = sum(c.severity is Severity.WARN for c in found)
    severity = Severity.NOTE if missed or grave else Severity.PASS
    return Check.of(
        "data_gate.readings", campaign, severity, predicted=readings - missed, readings=readings, grave=grave, missed=missed,
        all="no" if missed else "yes",
    )  # fmt: skip


def check(study: Study) -> Sequence[Check]:
    """One warning per row that does not belong or decides a value, campaign by campaign."""
    out: list[Check] = []
    for campaign in dict.fromkeys(t.campaign for t in study.tables):
        tables = [t for t in study.tables if t.campaign == campaign]
        found = findings(tables, (study.plan.scaling or tables[0].scaling).length)
        out += [replace(c, campaign=campaign) for c in found]
    return out


def findings(tables: Sequence[ForceTable], length: float) -> tuple[Check, ...]:
    """Findings on the tables of one campaign.

    Parameters
    ----------
    tables : sequence of ForceTable
        Of one campaign.
    length : float
        Of the primes in which derivatives are given, m.
    """
    own = [(t if t.measured_about is None else t.about(t.measured_about)) for t in tables]
    shift = arm_shift(tables)
    turned = [t.about(t.reference_point + np.array([shift, 0.0, 0.0])) for t in tables]
    readings = max(sum(int(mask.sum()) for t in own for mask in t.usable.values()), 1)
    out: list[Check] = []
    missed = 0
    for table, about in zip(own, turned, strict=True):
        again = _copies(table)
        ahead = table.motion["u"] > AHEAD * table.speed if ahead_counts(table) else np.ones(len(table), dtype=bool)
        cells = _screened(table, ~again & ahead, LEVEL / readings)
        missed += sum(
            int(np.count_nonzero(mask & ~again)) - sum(c == component for _, c in cells)
            for component, mask in table.usable.items()
        )
        rows: dict[int, _Row] = {}
        for (row, component), cell in cells.items():
            if cell.seen.wrong[cell.at]:
                given = rows.setdefault(row, _Row())
                given.cells.append(_cell_text(table, component, row, cell))
                given.components.append(component)
        _shared_errors(table, cells, rows, SHARED / sum(map(len, tables)))
        on_table: list[Check] = []
        swapped = _exchanged(table, about, turned, length, cells)
        for row in {row for one in swapped for row in one.rows}:
            rows.pop(row, None)
        on_table += [as_check("data_gate", one.finding) for one in swapped]
        on_table += [as_check("data_gate", one) for one in grid_rows_elsewhere(table)]
        if len(rows) > MOST_LINES or (rows and len(table) > LARGEST_SWEEP):
            on_table.append(_together(about, turned, length, rows))
        else:
            _slopes(about, turned, length, again, rows)
            _curvatures(table, cells, length, rows)
            on_table += [_as_check(table, row, given, readings) for row, given in sorted(rows.items())]
        on_table += _open_ends(table, cells, rows)
        on_table += _pasted(table, again)
        on_table += _astern(table, ahead)
        out += [replace(c, table=table.name) for c in on_table]
    out += _at_rest(tables)
    return (*out, _summary(tables[0].campaign, readings, missed, out))


def _at_rest(tables: Sequence[ForceTable]) -> list[Check]:
    """A campaign without a motion or control in any row, from which no slope follows."""
    if any(t.varies or np.ptp(t.propeller.get("rps", np.zeros(1))) > 0.0 for t in tables) or any(
        straight_runs(t, t.scaling.length) for t in tables
    ):
        return []
    speeds = np.concatenate([t.speed for t in tables])
    resistance = float(np.ptp(speeds)) > AHEAD * float(np.max(np.abs(speeds), initial=0.0))
    return [
        Check(
            "data_gate", tables[0].campaign, Severity.WARN if resistance else Severity.FAIL,
            "nothing varies but the speed" if resistance else "nothing varies",
            "an angle, a velocity, a rate, a control or a radius that varies",
            "No slope follows. Map the column that was varied: coeflab inspect shows all columns of the file. Straight runs at three "
            "speeds or more, with X, give X0'.",
        )
    ]  # fmt: skip
