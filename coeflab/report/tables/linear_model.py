"""The linear model about a steady motion as tables, as CSV and as a function of MATLAB and Octave."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from coeflab.core.table import ABSENT, Table, folded, number
from coeflab.core.text.csv_rows import csv_text
from coeflab.core.wording import collected, listed, one_line
from coeflab.law.symbols import CONTROLS
from coeflab.motion.trim.linear_files import ENDINGS
from coeflab.motion.trim.linear_model import LinearModel, Mode, Variable, content
from coeflab.motion.trim.trim import Trim
from coeflab.report.texts import table_of
from coeflab.vehicle.expected_signs import TURNS

PART = 0.1  # a state with a smaller share is not named in a mode
FUNCTION = "linear"
ABOUT = "x_dot = A x + B d for small departures x of the states and d of the commands"
AXES = "SI, angles in rad; x forward, y starboard, z down"
SENSES = {"dr": ("r", "N"), "ds": ("q", "M"), "db": ("q", "M")}


def matrix_tables(model: LinearModel) -> tuple[Table, Table]:
    """A and B with the units of their rows."""
    notes = (
        f"{ABOUT}; {AXES}.",
        f"{model.state[:1].upper()}{model.state[1:]}.",
        *(f"{words}." for words in senses(model)),
        *(f"{words}." for words in model.statements),
    )
    return (
        _matrix("A", model, model.a.matrix, model.states, ()),
        _matrix("B", model, model.b.matrix, model.commands, notes),
    )


def _matrix(
    name: str, model: LinearModel, matrix: np.ndarray, columns: Sequence[Variable], notes: tuple[str, ...]
) -> Table:
    rows = tuple(
        (f"{state.name}_dot", unit, *(number(float(v), 4) for v in row))
        for state, unit, row in zip(model.states, model.rate_units, matrix, strict=True)
    )
    headers = ("", "unit", *(f"per {c.name}" if c.unit == "" else f"{c.name} [{c.unit}]" for c in columns))
    return Table(f"{name}, linear model of {model.vehicle}", headers, rows, notes, frozenset({0, 1}))


def mode_table(model: LinearModel) -> Table:
    """Eigenvalues of A, one row a pair, with the states that take part most."""
    rows = tuple(
        (_eigenvalue(m), number(m.period), number(m.doubles), number(m.halves), _parts(m))
        for m in model.modes
        if m.eigenvalue.imag >= 0.0
    )
    return table_of("linear_model.mode_table", rows)


def _eigenvalue(mode: Mode) -> str:
    real, imag = (number(x, 4) for x in (mode.eigenvalue.real, abs(mode.eigenvalue.imag)))
    return f"{real} +- {imag}i" if mode.eigenvalue.imag else real


def _parts(mode: Mode) -> str:
    named = sorted((item for item in mode.shares.items() if item[1] >= PART), key=lambda item: -round(item[1], 6))
    return ", ".join(f"{name} {100.0 * share:.0f} %" for name, share in named)


def schedule_table(speeds: Sequence[float], trims: Sequence[Trim], models: Sequence[LinearModel | None]) -> Table:
    """A row a speed: the commands of the steady motion, its pitch and climb where they are free, and the eigenvalue of the least stable mode; a speed without one is named."""
    commands = trims[0].motion.command_unknowns
    upright = bool({"w", "q"} & {*trims[0].motion.vehicle.free})
    rows = []
    for speed, found, model in zip(speeds, trims, models, strict=True):
        cells = [u.shown(found.point.values[u.name]).partition(" ")[0] if model else ABSENT for u in commands]
        if upright:
            pitch, (climb, _) = found.point.values["pitch"], found.figures["climb"]
            cells += [
                number(np.degrees(pitch), 4) if model else ABSENT,
                number(0.0 if found.depth_is_kept else climb, 4) if model else ABSENT,
            ]
        mode = (_eigenvalue(model.modes[0]), _parts(model.modes[0])) if model else (ABSENT, found.point.outcome.value)
        rows.append((number(speed), *cells, *mode))
    notes_at = collected(
        (words, number(speed))
        for speed, found in zip(speeds, trims, strict=True)
        for words in (*found.point.doubts(), *found.point.statements)
    )
    if rising := [
        number(s)
        for s, t in zip(speeds, trims, strict=True)
        if t.solved and not t.depth_is_kept and t.motion.climb is None
    ]:
        notes_at["Depth is not kept. climb = 0 (--climb 0) asks for a motion that keeps it."] = rising
    notes = tuple(w if len(at) == len(speeds) else f"At {listed(at)} m/s: {w}" for w, at in notes_at.items())
    headers = (
        "u [m/s]",
        *(f"{u.name} [{u.shown(0.0).partition(' ')[2]}]" for u in commands),
        *(("pitch [deg]", "climb [m/s]") if upright else ()),
        "least stable, 1/s",
        "motion",
    )
    return Table(
        f"Linear models of {trims[0].motion.vehicle.name} over the speed",
        headers,
        tuple(rows),
        notes,
        frozenset({len(headers) - 1}),
    )


def senses(model: LinearModel) -> tuple[str, ...]:
    """What a positive control angle begins to do, by B."""
    names, out = [s.name for s in model.states], []
    for i, command in enumerate(model.commands):
        if command.name not in CONTROLS or SENSES[command.name][0] not in names:
            continue
        row, moment = SENSES[command.name]
        value = float(model.b.matrix[names.index(row), i])
        if value:
            out.append(f"{command.name} > 0: {'turns ' * (moment == 'N')}{TURNS[moment][value > 0.0]}")
    return tuple(out)


def files(model: LinearModel) -> dict[str, bytes]:
    """A.csv, B.csv, linear.m, linear.mat, linear.npz and linear.json by name."""
    return {
        **{f"{FUNCTION}{ending}": content([model], ending) for ending in ENDINGS[:-1]},
        "A.csv": _csv(model, model.a.matrix, model.states),
        "B.csv": _csv(model, model.b.matrix, model.commands),
        f"{FUNCTION}.m": _m_file(model).encode(),
    }


def schedule_files(speeds: Sequence[float], models: Sequence[LinearModel]) -> dict[str, bytes]:
    """Of several speeds linear.mat, linear.npz, linear.json, and the table over the speed."""
    named = {f"{FUNCTION}{ending}": content(models, ending, speeds) for ending in ENDINGS[:-1]}
    return {"over_speed.csv": content(models, ".csv", speeds), **named}


def _csv(model: LinearModel, matrix: np.ndarray, columns: Sequence[Variable]) -> bytes:
    """Rates by row, variables by column, units with both; numbers as they read back."""
    rows = [["rate", *(f"{c.name} [{c.unit}]" for c in columns)]]
    for state, unit, row in zip(model.states, model.rate_units, matrix.tolist(), strict=True):
        rows.append([f"{state.name}_dot [{unit}]", *(repr(v + 0.0) for v in row)])
    return csv_text(rows).encode()


def _m_file(model: LinearModel) -> str:
    call = f"[A, B, names, at] = {FUNCTION}()"
    return "\n".join(
        [
            f"function {call}",
            f"% {call} returns the linear model about a steady motion.",
            "% Plain MATLAB language; runs in GNU Octave.",
            "%",
            f"%   {one_line(model.vehicle)}: {ABOUT}.",
            f"%   {AXES}.",
            *(f"%   {words}." for words in senses(model)),
            "%",
            "%   names = struct of cell rows: states, state_units, commands, command_units",
            "%   at    = struct of columns: states and commands in the steady motion, where x and d are zero",
            *(
                line
                for words in (*model.statements, model.state, *model.remarks)
                for line in folded(one_line(f"{words.rstrip('.')}."), 78, "%   ", "%     ")
            ),
            "",
            f"A = {_rows(model.a.matrix, 'A = [')};",
            f"B = {_rows(model.b.matrix, 'B = [')};",
            f"names.states = {_cells([s.name for s in model.states])};",
            f"names.state_units = {_cells([s.unit for s in model.states])};",
            f"names.commands = {_cells([c.name for c in model.commands])};",
            f"names.command_units = {_cells([c.unit for c in model.commands])};",
            f"at.states = {_column(model.states)};",
            f"at.commands = {_column(model.commands)};",
            "end",
            "",
        ]
    )


def _rows(matrix: np.ndarray, begun: str) -> str:
    if not matrix.size:
        return f"zeros({matrix.shape[0]}, {matrix.shape[1]})"
    rows = [" ".join(repr(v + 0.0) for v in row) for row in matrix.tolist()]
    return "[" + (";\n" + " " * len(begun)).join(rows) + "]"


def _cells(names: Sequence[str]) -> str:
    return "{" + ", ".join("'" + one_line(n).replace("'", "''") + "'" for n in names) + "}"


def _column(variables: Sequence[Variable]) -> str:
    return "[" + "; ".join(repr(v.value + 0.0) for v in variables) + "]"
