"""`simulate` and `Motion`: a vehicle in a manoeuvre."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from coeflab.api.parameters import HasParameters, parameters_of
from coeflab.api.questions import three
from coeflab.core.errors import InputError, shown
from coeflab.core.keywords import all_spoken
from coeflab.core.missed import suggesting
from coeflab.core.options import described, parse_options
from coeflab.core.table import Table as Shown
from coeflab.core.types import in_angles
from coeflab.motion.manoeuvre import Figure, Simulation
from coeflab.motion.manoeuvres import MANOEUVRES
from coeflab.motion.simulation import simulate as carried_out
from coeflab.motion.trajectory import Trajectory
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.parameter_parts import THRUST

__all__ = ["Motion", "Simulation", "carried_out", "manoeuvres", "simulate"]

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes

    from coeflab.motion.uncertainty.uncertainty import Carried

NAMES = ("time [s]", "north [m]", "east [m]", "down [m]", "roll [rad]", "pitch [rad]", "heading [rad]",
         "u [m/s]", "v [m/s]", "w [m/s]", "p [rad/s]", "q [rad/s]", "r [rad/s]", "speed [m/s]")  # fmt: skip


@suggesting
@dataclass(frozen=True, slots=True, eq=False)
class Motion(Mapping[str, Figure]):
    """A motion and the figures read off it: ``run["first overshoot"].value``.

    Attributes
    ----------
    simulation : Simulation
        Vehicle, manoeuvre, trajectory, figures.

    Examples
    --------
    >>> import coeflab as cf
    >>> run = cf.simulate("remus100", "zigzag", rudder="20 deg")
    >>> round(run["initial turning time"].value, 2)
    1.47
    """

    simulation: Simulation

    def __repr__(self) -> str:
        figures = ", ".join(
            f"{f.name} {f.value:.4g}{'' if f.u95 is None else f' +- {f.u95:.2g}'} {f.unit}" for f in self.values() if f.value is not None
        )  # fmt: skip
        name = f"{self.simulation.manoeuvre.name} of {self.simulation.vehicle.name}"
        return in_angles(self, f"{name}: {figures or 'no figure determined'}")

    def _repr_html_(self) -> str:
        return self.simulation._repr_html_()

    def __getitem__(self, name: str) -> Figure:
        for f in self.simulation.figures:
            if f.name == name:
                return f
        raise KeyError(f"no {name!r} among {', '.join(self)}")

    def __iter__(self) -> Iterator[str]:
        return iter(f.name for f in self.simulation.figures)

    def __len__(self) -> int:
        return len(self.simulation.figures)

    @property
    def trajectory(self) -> Trajectory:
        """Time, place, attitude, velocity and controls, SI and rad."""
        return self.simulation.trajectory

    @property
    def statements(self) -> tuple[str, ...]:
        """What was assumed, and where the motion leaves what the coefficients cover."""
        return all_spoken(self.simulation.statements)

    @property
    def undetermined(self) -> str:
        """Why the file determines nothing of the motion; empty where it does."""
        return self.simulation.undetermined

    def frame(self) -> pd.DataFrame:
        """A row a time: place (NED), attitude, velocity through the water (FRD), controls in rad, thrusters in their units.

        Examples
        --------
        >>> import coeflab as cf
        >>> cf.simulate("remus100", "straight_run").frame().columns[0]
        'time [s]'
        """
        import pandas as pd

        t = self.trajectory
        angles = np.column_stack([t.angles[:, :2], t.heading])
        values = np.column_stack([t.time, t.position, angles, t.velocity, t.speed])
        units = {thruster.name: thruster.curve.unit for thruster in self.simulation.vehicle.thrusters} | {THRUST: "N"}
        commands = {f"{k} [{units.get(k, 'rad')}]": np.array(v) for k, v in t.controls.items()}
        return pd.DataFrame(dict(zip(NAMES, values.T, strict=True)) | commands)

    def summary(self) -> Shown:
        """The figures, to be printed or shown in a notebook.

        Examples
        --------
        >>> import coeflab as cf
        >>> cf.simulate("remus100", "zigzag", rudder="20 deg").summary().rows[0][0]
        'initial turning time'
        """
        from coeflab.report.tables.motion import figure_table

        s = self.simulation
        return figure_table(s.figures, f"{s.manoeuvre.name.replace('_', ' ')} of {s.vehicle.name}", s.vehicle.length)

    def plot(self, what: str = "track", ax: Axes | None = None) -> Axes:
        """The track, or a quantity over time.

        Parameters
        ----------
        what : str
            ``track`` (north over east), ``depth``, or a column of `frame` without its unit: ``heading``, ``r``, ``dr`` ...; also
            ``rudder``, ``yaw`` (the heading), ``yaw rate``.
        ax : Axes, optional
            To draw into; by default that of a new figure.

        Examples
        --------
        >>> import coeflab as cf
        >>> cf.simulate("remus100", "zigzag", rudder="20 deg").plot().get_xlabel()
        'east [m]'
        """
        from coeflab.report.plots import plot_motion

        return plot_motion(self.trajectory, what, ax)


def manoeuvres(name: str = "") -> Shown:
    """The manoeuvres, or what one of them takes: the options of `coeflab.simulate`, to be printed or shown in a notebook.

    Parameters
    ----------
    name : str
        A manoeuvre.

    Examples
    --------
    >>> import coeflab as cf
    >>> [row[0] for row in cf.manoeuvres("zigzag").rows][:2]
    ['rudder', 'heading']
    """
    if not name:
        rows = [(n, MANOEUVRES.load(n).summary) for n in MANOEUVRES.usable()]
        return Shown("Manoeuvres", ("", "what"), tuple(rows), (), frozenset({0, 1}))
    found = described(MANOEUVRES.load(name).Options)
    return Shown(
        f"Options of {name}", ("", "takes", "default", "meaning"), tuple((o.name, o.takes, o.default, o.meaning) for o in found),
        (), frozenset({0, 1, 2, 3}),
    )  # fmt: skip


def simulate(
    vehicle: HasParameters | ParameterFile | str | Path,
    manoeuvre: str,
    *,
    free: Sequence[str] = (),
    hold: Sequence[str] = (),
    current: Sequence[float] = (),
    step: float | None = None,
    record: float | None = None,
    integrator: str | None = None,
    simulator: str = "rigid_body",
    tables: bool = False,
    accelerations: str = "measured",
    draws: int = 0,
    seed: int = 1,
    **options: Any,
) -> Motion:
    """A manoeuvre of a vehicle.

    Parameters
    ----------
    vehicle : Vehicle, str or Path
        A parameter file, or the name of a shipped one.
    manoeuvre : str
        zigzag, turning_circle, spiral, stop ...: ``cf.plugins("manoeuvres")``.
    free, hold : sequence of str
        Motions that may change, of u v w p q r; those of them that are held.
    current : (3,) sequence of float
        Of the water to north, east and down, m/s.
    step, record : float, optional
        Of rk4, and between rows, s.
    integrator : {"adaptive", "rk4"}, optional
        Adaptive unless given.
    simulator : str
        Name from ``cf.plugins("simulators")``; draws need rigid_body.
    tables : bool
        Fitted tables come before derivatives.
    accelerations : {"measured", "computed"}
    draws, seed : int
        Of the coefficients with their covariance, 40 or more: every figure gets its interval, ``low``, ``high`` and ``u95``.
    **options
        Of the manoeuvre, SI and rad or with a unit: ``rudder="20 deg"``, ``speed=1.5``.

    Returns
    -------
    Motion

    Raises
    ------
    InputError
        An option that the manoeuvre lacks or cannot take, a motion unknown to the file; draws of a file without U95.

    Examples
    --------
    >>> import coeflab as cf
    >>> run = cf.simulate("remus100", "zigzag", rudder="20 deg")
    >>> round(run["reach"].value, 2)
    4.86
    """
    given = {"integrator": integrator, "step": step, "record": record}
    how = {k: v for k, v in given.items() if v is not None}
    if len(current):
        how |= dict(zip(("north", "east", "down"), three(current, "speed", "current").tolist(), strict=True))
    parameters = parameters_of(vehicle)
    found = carried_out(
        parameters,
        manoeuvre,
        options=options,
        integration=how,
        free=free,
        hold=hold,
        simulator=simulator,
        tables=tables,
        accelerations=accelerations,
    )
    if not draws:
        return Motion(found)
    if simulator != "rigid_body":
        raise InputError(f"draws by {shown(simulator)}", "the simulator rigid_body", column="draws")
    from coeflab.motion.uncertainty.uncertainty import Question, uncertainty

    water = three(current, "speed", "current").tolist() if len(current) else (0.0, 0.0, 0.0)
    parsed = asdict(parse_options(MANOEUVRES.load(manoeuvre).Options, options, manoeuvre))
    asked = {k: v for k, v in parsed.items() if k in options}
    question = Question(
        manoeuvre, asked, draws, seed, free=free, hold=hold, tables=tables, accelerations=accelerations, current=tuple(water)
    )  # fmt: skip
    return Motion(_with_intervals(found, uncertainty(parameters, question)))


def _with_intervals(found: Simulation, carried: Carried) -> Simulation:
    known = {s.figure.name: s for s in carried.spreads}
    figures = [
        f if (s := known.get(f.name)) is None else replace(f, low=s.low, high=s.high, why=f.why or ("" if s.low is not None else s.why))
        for f in found.figures
    ]  # fmt: skip
    statements = tuple(dict.fromkeys((*found.statements, *carried.statements)))
    return replace(found, figures=tuple(figures), statements=statements)
