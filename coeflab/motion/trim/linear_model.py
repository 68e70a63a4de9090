"""The linear model of small motions about a steady one: x_dot = A x + B d, with the error of its derivatives and its modes.

Depth, heading and the lag of actuators are states of it where they are asked for; over several speeds it is a schedule.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from coeflab.core.errors import InputError, shown
from coeflab.core.files import write_atomically
from coeflab.core.missed import suggesting
from coeflab.core.texts import input_error, text_of
from coeflab.core.types import Array, dataclass, in_angles
from coeflab.motion.small_motions import NEUTRAL, STEP, Slopes, modes, participation
from coeflab.motion.trim.linear_files import ENDINGS, mat, npz
from coeflab.motion.trim.steady_motion import PLACES
from coeflab.motion.trim.trim import Trim

if TYPE_CHECKING:
    import pandas as pd

RATES = {"m/s": "m/s^2", "rad/s": "rad/s^2", "rad": "rad/s", "m": "m/s"}
LAGGED = "_lagged"
LEAST_ERROR = 1e-10  # that is stated


@dataclass(frozen=True, slots=True)
class Variable:
    """A state or a command of the model: its name, its SI unit and its value in the steady motion."""

    name: str
    unit: str
    value: float


@dataclass(frozen=True, slots=True)
class Mode:
    """An eigenvalue of A.

    Attributes
    ----------
    eigenvalue : complex
        1/s.
    shares : mapping of str to float
        Participation of every state, their sum one: the product of left and right eigenvectors, which no unit changes.
    neutral : bool
        Neither grows nor dies out, within rounding.
    """

    eigenvalue: complex
    shares: Mapping[str, float]
    neutral: bool

    @property
    def doubles(self) -> float | None:
        """Time to double, s; None of one that does not grow."""
        return math.log(2.0) / self.eigenvalue.real if not self.neutral and self.eigenvalue.real > 0.0 else None

    @property
    def halves(self) -> float | None:
        """Time to halve, s; None of one that does not die out."""
        return -math.log(2.0) / self.eigenvalue.real if not self.neutral and self.eigenvalue.real < 0.0 else None

    @property
    def period(self) -> float | None:
        """Of the oscillation, s; None of a real eigenvalue."""
        return 2.0 * math.pi / abs(self.eigenvalue.imag) if self.eigenvalue.imag else None


@suggesting
@dataclass(frozen=True, slots=True, eq=False, repr=False)
class LinearModel:
    """Small departures x of the states and d of the commands from a steady motion: x_dot = A x + B d.

    Attributes
    ----------
    vehicle : str
    states, commands : tuple of Variable
        Velocities that are free to change, then roll where p is and pitch where q is, then depth, heading and lagged commands that
        were asked for; SI, rad, FRD. All states are outputs.
    a, b : Slopes
        (n, n) and (n, m).
    modes : tuple of Mode
        The least stable first.
    statements : tuple of str
        Of the derivatives.
    remarks : tuple of str
        Of the steady motion: whether it is the only one, what a bound holds, what no data cover, what was assumed.
    state : str
        Of the steady motion: speed, pitch and climb.
    """

    vehicle: str
    states: tuple[Variable, ...]
    commands: tuple[Variable, ...]
    a: Slopes
    b: Slopes
    modes: tuple[Mode, ...]
    statements: tuple[str, ...]
    remarks: tuple[str, ...] = ()
    state: str = ""

    def __repr__(self) -> str:
        names = (", ".join(v.name for v in which) for which in (self.states, self.commands))
        first = f", least stable {self.modes[0].eigenvalue:.3g} 1/s" if self.modes else ""
        return in_angles(self, f"{self.vehicle}: states {next(names)}; commands {next(names)}{first}")

    @property
    def A(self) -> Array:  # noqa: N802 - as every textbook has it
        """(n, n) of the states."""
        return self.a.matrix

    @property
    def B(self) -> Array:  # noqa: N802
        """(n, m) of the commands."""
        return self.b.matrix

    @property
    def eigenvalues(self) -> NDArray[np.complex128]:
        """(n,) of A, 1/s: a real part below zero dies away.

        Examples
        --------
        >>> import coeflab as cf
        >>> linear = cf.read_vehicle("remus100").linear(speed=1.5)
        >>> linear.eigenvalues.shape == (len(linear.states),)
        True
        """
        return np.asarray(np.linalg.eigvals(self.A), dtype=np.complex128)

    @property
    def C(self) -> Array:  # noqa: N802
        """(n, n) of ones: every state is an output."""
        return np.eye(len(self.states))

    @property
    def D(self) -> Array:  # noqa: N802
        """(n, m) of zeros."""
        return np.zeros(self.B.shape)

    @property
    def rate_units(self) -> tuple[str, ...]:
        """Unit of the rate of every state."""
        return tuple(RATES.get(s.unit, f"{s.unit}/s") for s in self.states)

    def save(self, path: str | Path) -> Path:
        """A, B, C, D, names, units and the steady motion as a .mat, .npz or .json file.

        Parameters
        ----------
        path : str or Path

        Raises
        ------
        InputError
            Another ending.

        Examples
        --------
        >>> import tempfile, coeflab as cf
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     cf.read_vehicle("remus100").linear(speed=1.5, plane="horizontal").save(f"{folder}/auv.npz").name
        'auv.npz'
        """
        return _saved((self,), Path(path))


@suggesting
@dataclass(frozen=True, slots=True, eq=False)
class LinearSchedule:
    """Linear models of one vehicle over several speeds, for a gain schedule.

    Attributes
    ----------
    speeds : tuple of float
        u, m/s.
    models : tuple of LinearModel
        Of the same states and commands.
    """

    speeds: tuple[float, ...]
    models: tuple[LinearModel, ...]

    @property
    def A(self) -> Array:  # noqa: N802
        """(k, n, n), one a speed."""
        return np.array([m.A for m in self.models])

    @property
    def B(self) -> Array:  # noqa: N802
        """(k, n, m)."""
        return np.array([m.B for m in self.models])

    def frame(self) -> pd.DataFrame:
        """A row a speed: states and commands of the steady motion, every entry of A and B, real part of the least stable eigenvalue.

        Examples
        --------
        >>> import coeflab as cf
        >>> cf.read_vehicle("remus100").linear(speed=[1.0, 2.0], free="uvr").frame()["A_v_v"].round(3).tolist()
        [-0.521, -1.043]
        """
        import pandas as pd

        rows = []
        for m in self.models:
            row = {f"{v.name} [{v.unit}]": v.value for v in (*m.states, *m.commands)}
            for name, matrix, columns in (("A", m.A, m.states), ("B", m.B, m.commands)):
                for state, values in zip(m.states, matrix.tolist(), strict=True):
                    row |= {f"{name}_{state.name}_{c.name}": x + 0.0 for c, x in zip(columns, values, strict=True)}
            rows.append(row | {"least stable [1/s]": m.modes[0].eigenvalue.real})
        return pd.DataFrame(rows, index=pd.Index(self.speeds, name="speed [m/s]"))

    def save(self, path: str | Path) -> Path:
        """All of them as a .mat, .npz or .json file, speeds along the first axis, or the table as .csv.

        Parameters
        ----------
        path : str or Path

        Raises
        ------
        InputError
            Another ending.
        """
        return _saved(self.models, Path(path), self.speeds)


def _saved(models: Sequence[LinearModel], path: Path, speeds: Sequence[float] | None = None) -> Path:
    write_atomically(path, content(models, path.suffix, speeds))
    return path


def as_json(model: LinearModel) -> dict[str, Any]:
    """One linear model as a JSON object, SI and rad; rows are rates of the states, in their order.

    A to D and the names are as in .mat and .npz; a to d, of earlier versions, are the same.
    """
    names = _names(model)
    return {
        "state_names": names["states"],
        "command_names": names["commands"],
        "A": model.A.tolist(),
        "B": model.B.tolist(),
        "C": model.C.tolist(),
        "D": model.D.tolist(),
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
        "statements": [*model.statements, model.state, *model.remarks],
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
        table: str = LinearSchedule(tuple(speeds or ()), tuple(models)).frame().to_csv(lineterminator="\n")
        return table.encode()
    arrays = _arrays(models, speeds)
    names = (
        _names(models[0])
        | _axes(arrays, speeds is not None)
        | {"remarks": list(dict.fromkeys(r for m in models for r in (*m.statements, m.state, *m.remarks)))}
    )
    return npz(arrays, names) if ending == ".npz" else mat(arrays, names)


def _arrays(models: Sequence[LinearModel], speeds: Sequence[float] | None) -> dict[str, np.ndarray]:
    """Matrices, and states and commands of the steady motion, where x and d are zero; speeds along the first axis."""
    each = [
        {
            "A": m.A, "B": m.B, "C": m.C, "D": m.D, "at_states": np.array([s.value for s in m.states]),
            "at_commands": np.array([c.value for c in m.commands]),
        }
        for m in models
    ]  # fmt: skip
    if speeds is None:
        return each[0]
    return {k: np.stack([one[k] for one in each]) for k in each[0]} | {"speeds": np.array(speeds)}


def _axes(names: Iterable[str], several: bool) -> dict[str, list[str]]:
    """What the axes of each array are, such as A_axes; every state is an output."""
    columns = {"A": "states", "B": "commands", "C": "states", "D": "commands"}
    rows = {"at_states": ["states"], "at_commands": ["commands"]}
    return {
        f"{k}_axes": [*(["speeds"] if several else []), *rows.get(k, ["states", columns.get(k, "")])]
        for k in names if k in columns or k in rows
    }  # fmt: skip


def _names(model: LinearModel) -> dict[str, list[str]]:
    return {
        "states": [s.name for s in model.states], "state_units": [s.unit for s in model.states],
        "commands": [c.name for c in model.commands], "command_units": [c.unit for c in model.commands],
    }  # fmt: skip


def linear_model(found: Trim, also: Sequence[str] = (), lags: Mapping[str, float] | None = None) -> LinearModel:
    """Linearise about the steady motion that trim found.

    Parameters
    ----------
    found : Trim
    also : sequence of str
        Of depth and heading: states beside those that forces depend on.
    lags : mapping of str to float, optional
        Time constant of a command, s: what acts follows it by T x_dot = d - x. Those of the file's thrusters unless given.

    Raises
    ------
    InputError
        No steady motion was found, rates that are not finite, a state that nothing moves, or a lag of no command.
    """
    if not found.point.outcome.solved:
        raise input_error("motion.no_steady_motion", column="--linear")
    steady, x = found.motion, found.point.found.point
    a, b = steady.state_slopes(x), steady.command_slopes(x)
    states = tuple(Variable(n, u, float(v) + 0.0) for (n, u), v in zip(steady.states, steady.departed(x), strict=True))
    commands = tuple(Variable(u.name, u.unit, found.point.values[u.name]) for u in steady.command_unknowns)
    a, b, states = _placed(found, also, a, b, states)
    commanded = {c.name for c in commands}
    stated = {t.name: t.lag for t in found.motion.vehicle.thrusters if t.lag is not None and t.name in commanded}
    a, b, states = _lagging(stated | dict(lags or {}), a, b, states, commands)
    shares = participation(a.matrix)
    values = modes(a.matrix)
    fastest = max(1.0, float(np.max(np.abs(values), initial=0.0)))
    named = [s.name for s in states]
    found_modes = tuple(
        Mode(complex(v), dict(zip(named, part.tolist(), strict=True)), abs(v.real) <= NEUTRAL * fastest)
        for v, part in zip(values, shares, strict=True)
    )
    return LinearModel(
        found.motion.vehicle.name, states, commands, a, b, found_modes, (*_accuracy(a, b), *_kinks(a, b, states, commands)),
        (*found.point.doubts(), *found.point.statements), found.state_in_words,
    )  # fmt: skip


def _placed(
    found: Trim, also: Sequence[str], a: Slopes, b: Slopes, states: tuple[Variable, ...]
) -> tuple[Slopes, Slopes, tuple[Variable, ...]]:
    """With depth and heading, on which no force depends, as further states."""
    if not also:
        return a, b, states
    place = found.motion.place_slopes(found.point.found.point)
    for name in dict.fromkeys(also):
        if name not in PLACES:
            raise InputError(shown(name), f"some of {', '.join(PLACES)}", column="also")
        k, n, m = list(PLACES).index(name), len(states), place.matrix.shape[1]
        if not place.matrix[k].any():
            raise input_error(
                "motion.unmoved_states", column="also", name=name, states=", ".join(s.name for s in states),
                value="r" if name == "heading" else "w or q",
            )  # fmt: skip
        a, b = a.grown(1, 1), b.grown(1, 0)
        a.matrix[n, :m], a.error[n, :m] = place.matrix[k], place.error[k]
        states = (*states, Variable(name, PLACES[name], 0.0))
    return a, b, states


def _lagging(
    lags: Mapping[str, float], a: Slopes, b: Slopes, states: tuple[Variable, ...], commands: tuple[Variable, ...]
) -> tuple[Slopes, Slopes, tuple[Variable, ...]]:
    """With what follows a command late as a further state: the force is of the state, and the state goes to the command."""
    names = [c.name for c in commands]
    for name, lag in lags.items():
        if name not in names:
            raise InputError(f"a lag of {shown(name)}", f"one of {', '.join(names)}", column="lag")
        if not (math.isfinite(lag) and lag > 0.0):
            raise InputError(f"{lag:g} s", "a time constant above zero", column="lag")
        k, n = names.index(name), len(states)
        a, b = a.grown(1, 1), b.grown(1, 0)
        for late, at_once in ((a.matrix, b.matrix), (a.error, b.error), (a.kinks, b.kinks)):
            late[:n, n], at_once[:n, k] = at_once[:n, k], 0.0
        a.matrix[n, n], b.matrix[n, k] = -1.0 / lag, 1.0 / lag
        states = (*states, Variable(name + LAGGED, commands[k].unit, commands[k].value))
    return a, b, states


def _accuracy(a: Slopes, b: Slopes) -> tuple[str, ...]:
    """To a power of ten upwards: the digits of rounding differ from machine to machine."""
    below = [10.0 ** math.ceil(math.log10(max(float(np.max(s.error, initial=0.0)), LEAST_ERROR))) for s in (a, b)]
    return (text_of("motion.central_differences", step=STEP, half=STEP / 2.0, in_a=below[0], in_b=below[1]),)


def _kinks(a: Slopes, b: Slopes, states: tuple[Variable, ...], commands: tuple[Variable, ...]) -> tuple[str, ...]:
    out = []
    for found, variables in ((a, states), (b, commands)):
        for i, variable in enumerate(variables):
            rows = [s.name for s, kink in zip(states, found.kinks[:, i], strict=True) if kink]
            if rows:
                out.append(
                    f"At {variable.name} = {variable.value:.4g} {variable.unit} slopes to either side differ for the rates of "
                    f"{', '.join(rows)}: the mean stands here, and no linear model holds on both sides"
                )
    return tuple(out)
