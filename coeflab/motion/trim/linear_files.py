"""Linear models as .mat, .npz and .json files, and over the speed as a table: the same arrays and names in each, always the same bytes."""

from __future__ import annotations

import io
import json
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import scipy.io

from coeflab.core.errors import InputError

if TYPE_CHECKING:
    from coeflab.motion.trim.linear_model import LinearModel

HEADER = 116  # bytes of text at the head of a MAT-file of version 5; scipy writes the time of day there
TEXT = b"MATLAB 5.0 MAT-file, coeflab"
ENDINGS = (".mat", ".npz", ".json", ".csv")


def as_json(model: LinearModel) -> dict[str, Any]:
    """One linear model as a JSON object, SI and rad; rows are rates of the states, in their order."""
    return {
        "states": [
            {"name": s.name, "unit": s.unit, "rate_unit": unit, "value": s.value}
            for s, unit in zip(model.states, model.rate_units, strict=True)
        ],
        "commands": [{"name": c.name, "unit": c.unit, "value": c.value} for c in model.commands],
        "a": model.A.tolist(),
        "b": model.B.tolist(),
        "c": model.C.tolist(),
        "d": model.D.tolist(),
        "a_error": model.a.error.tolist(),
        "b_error": model.b.error.tolist(),
        "modes": [
            {
                "eigenvalue": [m.eigenvalue.real, m.eigenvalue.imag], "unit": "1/s", "participation": dict(m.shares),
                "time_to_double": m.doubles, "time_to_halve": m.halves, "period": m.period,
            }
            for m in model.modes
        ],
        "statements": [*model.statements, *model.remarks],
    }  # fmt: skip


def content(models: Sequence[LinearModel], ending: str, speeds: Sequence[float] | None = None) -> bytes:
    """A file of linear models of the same states and commands.

    Parameters
    ----------
    models : sequence of LinearModel
    ending : {".mat", ".npz", ".json", ".csv"}
        A .csv is of several speeds.
    speeds : sequence of float, optional
        u of each, m/s; without it there is one, and its arrays are plain matrices.

    Raises
    ------
    InputError
        Another ending.
    """
    if ending not in (ENDINGS if speeds is not None else ENDINGS[:-1]):
        raise InputError(f"a file that ends in {ending or 'nothing'}", f"one of {', '.join(ENDINGS)}", column="path")
    if ending == ".json":
        one = [as_json(m) for m in models]
        whole = one[0] if speeds is None else {"speeds": list(speeds), "models": one}
        return (json.dumps({"vehicle": models[0].vehicle, **whole}, indent=1) + "\n").encode()
    if ending == ".csv":
        from coeflab.motion.trim.linear_model import LinearSchedule

        table: str = LinearSchedule(tuple(speeds or ()), tuple(models)).frame().to_csv(lineterminator="\n")
        return table.encode()
    arrays = _arrays(models, speeds, -1 if ending == ".mat" else 0)
    names = _names(models[0]) | {"remarks": list(dict.fromkeys(r for m in models for r in (*m.statements, *m.remarks)))}
    out = io.BytesIO()
    if ending == ".npz":
        np.savez(out, **arrays, **{k: np.array(v, dtype=str) for k, v in names.items()})  # type: ignore[arg-type]
        return out.getvalue()
    scipy.io.savemat(out, arrays | {k: np.array(v, dtype=object) for k, v in names.items()}, oned_as="column")
    return TEXT.ljust(HEADER) + out.getvalue()[HEADER:]


def _arrays(models: Sequence[LinearModel], speeds: Sequence[float] | None, axis: int) -> dict[str, np.ndarray]:
    """Matrices, and states and commands of the steady motion, where x and d are zero; speeds along an axis."""
    each = [
        {
            "A": m.A, "B": m.B, "C": m.C, "D": m.D, "at_states": np.array([s.value for s in m.states]),
            "at_commands": np.array([c.value for c in m.commands]),
        }
        for m in models
    ]  # fmt: skip
    if speeds is None:
        return each[0]
    return {k: np.stack([one[k] for one in each], axis=axis) for k in each[0]} | {"speeds": np.array(speeds)}


def _names(model: LinearModel) -> dict[str, list[str]]:
    return {
        "states": [s.name for s in model.states], "state_units": [s.unit for s in model.states],
        "commands": [c.name for c in model.commands], "command_units": [c.unit for c in model.commands],
    }  # fmt: skip
