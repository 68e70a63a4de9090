"""``coeflab trim``: steady motions of a parameter file's vehicle."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from coeflab.cli import options, show

if TYPE_CHECKING:
    from coeflab.api.trimming import Trim


AXES = {"speed": "u", "sway": "v", "heave": "w"}
EXAMPLE = "coeflab trim vehicle.parameters.json --speed 1.5 --yaw-rate 3"


@options.worded
def command(
    *,
    file: Path,
    speed: str = "",
    sway: str = "",
    heave: str = "",
    yaw_rate: str = "",
    roll: str = "",
    pitch: str = "",
    climb: str = "",
    commands: list[str],
    near: list[str],
    free: str = "",
    plane: str = "",
    tables: bool = False,
    accelerations: str = "measured",
    starts: int = 8,
    seed: int = 0,
    linear: bool = False,
    also: str = "",
    lag: list[str],
    out: Path | None = None,
    json: bool = False,
) -> None:
    """Find the commands of a steady motion, or the reverse.

    With --linear or --out also the state-space model of small motions about it, x_dot = A x + B d, at several speeds a gain schedule. Roll, pitch and rate of heading are constant. Motions that are not named are found. Commands that are not named are
    found too, or are zero where no motion is named. Says whether the solution is the only one, whether small motions
    about it die out, and where there is none, which equation stays violated (exit code 1).
    """
    import coeflab as cf
    from coeflab.api.trimming import linear_as_json, linear_model, trim
    from coeflab.core.errors import InputError
    from coeflab.core.files import write_all
    from coeflab.core.options import named_numbers
    from coeflab.report.tables.linear_model import files, matrix_tables, mode_table, schedule_files, schedule_table

    speeds = [_measured("speed", text, "--speed") for text in speed.split(",")] if speed else []
    wanted, several = linear or out is not None, len(speeds) > 1
    if not wanted and (several or also or lag):
        raise InputError("several speeds" if several else "--also" if also else "--lag", "--linear", column="--linear")
    given = {"sway": sway, "heave": heave, "yaw_rate": yaw_rate, "roll": roll, "pitch": pitch, "climb": climb}
    motion = {k: _measured(k, v, f"--{k.replace('_', '-')}") for k, v in given.items() if v}
    lags = named_numbers(lag, "--lag")
    vehicle = cf.read_vehicle(file)
    if several and not json:  # of one speed its table says it
        show.not_used(vehicle.file, tables)
    each = [
        trim(
            vehicle, commands=_named(commands, "--commands"), near=_named(near, "--near"), plane=plane,
            free=free.replace(",", " ").split(), starts=starts, seed=seed, tables=tables, accelerations=accelerations,
            **motion, **one,
        )
        for one in ([{"speed": v} for v in speeds] or [{}])
    ]  # fmt: skip
    states = also.replace(",", " ").split()
    models = [linear_model(t, states, lags) if wanted and t.point.outcome.solved else None for t in each]
    solved = [m for m in models if m is not None]
    folder, names = out or Path(), {}
    if out is not None and solved:
        at = [v for v, m in zip(speeds, models, strict=True) if m is not None] if several else []
        names = write_all(folder, schedule_files(at, solved) if several else files(solved[0]))
    if json:
        objects = [
            {**as_json(t), **({} if m is None else {"linear": linear_as_json(m)})}
            for t, m in zip(each, models, strict=True)
        ]
        whole = {"speeds": objects} if several else objects[0]
        show.json_object({**whole, **({"files": [str(folder / n) for n in names]} if solved else {})})
    else:
        if several:
            show.table(schedule_table(speeds, each, models))
        for found, model in zip(each, models, strict=True):
            if not several or not found.point.outcome.solved:
                show.table(found.point.table())
            if not several and found.point.outcome.solved:
                show.table(found.figure_table())
                show.table(found.other_table())
            if model is not None and (linear or not several):
                for one in (*matrix_tables(model), mode_table(model)):
                    show.table(one)
        for name in names:
            show.path(folder / name)
    if any(not t.point.outcome.solved or t.refused for t in each):
        raise typer.Exit(1)


def _measured(name: str, text: str, option: str) -> float:
    """A motion in SI; bare angles and rates are in degrees.

    Raises
    ------
    InputError
        Not a finite number, or a unit that does not fit.
    """
    from coeflab.core.units import quantity

    try:
        bare = float(text)
    except ValueError:
        dimension = "speed" if name in (*AXES, "climb") else "rate" if name == "yaw_rate" else "angle"
        return quantity(text, dimension, key=option)
    return _si(name, bare, option)


def _named(texts: list[str], option: str) -> dict[str, float]:
    """``NAME=VALUE`` in SI.

    Raises
    ------
    InputError
        No name, no finite number, or a name twice.
    """
    from coeflab.core.options import named_numbers

    words = [word for text in texts for word in text.replace(",", " ").split() or [text]]
    return {name: _si(name, number, option) for name, number in named_numbers(words, option).items()}


def _si(name: str, value: float, option: str) -> float:
    """Angles and their rates from degrees.

    Raises
    ------
    InputError
        Not a finite number.
    """
    from math import isfinite, radians

    from coeflab.api.trimming import CONTROLS
    from coeflab.core.errors import InputError, shown

    if not isfinite(value):
        raise InputError(shown(value), "a finite number", column=option)
    angle = name in (*CONTROLS, "yaw_rate", "roll", "pitch") or name.endswith(".tilt")
    return radians(value) if angle else value


def as_json(found: Trim) -> dict[str, Any]:
    """The trim as one JSON object, SI and rad."""
    from coeflab.core.wording import finite
    from coeflab.report.as_json.motions import accelerations

    point, f = found.point, found.point.found
    return {
        "vehicle": found.motion.vehicle.name,
        "accelerations": accelerations(found.motion.vehicle.water),
        "outcome": point.outcome.value,
        "unknowns": [
            {
                "name": u.name, "value": value, "unit": u.unit, "given": u.low == u.high,
                "low": finite(u.low), "high": finite(u.high), "held": bool(held),
            }
            for u, value, held in zip(point.unknowns, point.values.values(), f.held, strict=True)
        ],
        "figures": {name: {"value": value, "unit": unit} for name, (value, unit) in found.figures.items()},
        "equations": [
            {"name": e.name, "residual": point.residuals[e.name], "unit": e.unit, "violated": e in point.violated}
            for e in point.equations
        ],
        "rank": f.rank,
        "family_dimension": point.dimension,
        "family": f.family.T.tolist(),
        "rule": point.rule,
        "starts": f.starts,
        "starts_that_solved": f.reached,
        "others": [{"values": values, "small_motions": state} for values, state in found.others],
        "eigenvalues": [[v.real, v.imag] for v in point.modes],
        "small_motions": point.growth,
        "statements": list(point.words()),
    }  # fmt: skip
