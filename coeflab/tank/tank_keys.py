"""The keys of a tank.toml."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Any

import numpy as np

from coeflab.core import declarations as takes
from coeflab.core.declarations import Declaration
from coeflab.core.errors import InputError, shown
from coeflab.core.units import with_unit
from coeflab.law.scaling import Scaling
from coeflab.law.symbols import CONTROL_COLUMNS
from coeflab.tables.vocabulary import one_name
from coeflab.tank.tank import Grid
from coeflab.tank.test_matrix import Study

MEDIUM = "medium"
GRIDS = (Grid("coarse", 1.3), Grid(MEDIUM, 1.0), Grid("fine", 1.0 / 1.3))
_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.+-]{0,59}")


def folder_name(name: str) -> str:
    """A name as `_NAME` takes it: what it does not take becomes an underscore.

    Examples
    --------
    >>> folder_name("Rumpf ä'1")
    'Rumpf___1'
    """
    out = re.sub(r"[^A-Za-z0-9_.+-]", "_", name)[:60]
    return out if _NAME.fullmatch(out) else f"body{out}"[:60]


def _no_name(name: str) -> str:
    return "" if _NAME.fullmatch(name) else "letters, digits, _ . + - (it names folders), at most 60"


Name = Annotated[takes.Text, takes.Within(_no_name, schema={"pattern": f"^{_NAME.pattern}$"})]


def _quantities(dimension: str, words: str, largest: float, expected: str) -> takes.Takes:
    """A list of different numbers of one dimension, none beyond the largest."""
    schema = {"type": "array", "items": dict(takes.number_in(dimension).schema)}

    def read(given: Any, _file: Path) -> tuple[float, ...]:
        if not isinstance(given, list):
            raise InputError(shown(given), words)
        numbers = tuple(with_unit(one, dimension) for one in given)
        for one, number in zip(given, numbers, strict=True):
            if abs(number) > largest:
                raise InputError(shown(one), expected)
            if numbers.count(number) > 1:
                raise InputError(f"{shown(one)} twice", words)
        return numbers

    return takes.Takes(words, read, schema)


def _moving(given: tuple[float, ...]) -> str:
    return "no zero: straight runs are added by themselves" if 0.0 in given else ""


_ANGLE_LIMIT = 'an angle below 60 deg, such as "4 deg"'
Angles = Annotated[
    tuple[float, ...],
    _quantities(
        "angle", 'a list of different angles such as ["2 deg", "4 deg"]', float(np.radians(60.0)), _ANGLE_LIMIT
    ),
    takes.Within(_moving),
]
Rates = Annotated[
    tuple[float, ...],
    _quantities("none", "a list of different rates r' = r L/U such as [0.1, 0.2]", 3.0, "a rate r' = r L/U up to 3"),
    takes.Within(_moving),
]
POSITIVE = takes.Within(lambda given: "" if all(v > 0.0 for v in given) else "numbers above zero")
Speeds = Annotated[tuple[float, ...], _quantities("speed", "a list of different speeds", np.inf, ""), POSITIVE]
Numbers = Annotated[tuple[float, ...], _quantities("none", "a list of different numbers", np.inf, ""), POSITIVE]


@dataclass(frozen=True, slots=True, kw_only=True)
class TankKeys(Declaration):
    """What is towed, and by which solver.

    Attributes
    ----------
    name : str
        Of the campaign that comes out; the body's unless given.
    title : str
        As reports print it; the body's unless given.
    body : Path
        Of its body.toml, or a shipped name; the one of the command line unless given.
    reference_point : (3,) array
        Of velocities and moments, [x, y, z], m, FRD, from the body's datum; the body's unless given.
    solver : str
        Name of the solver; ``coeflab formats tow_solvers`` lists them.
    runner : str
        Who carries out the jobs; ``coeflab formats tow_runners`` lists them.
    cores : int
        That one run takes.
    symmetry : bool
        Tow one side, and half of the domain, of a body that is its own mirror image; false tows the whole body on both sides.
    """

    name: Name | None = None
    title: takes.Words | None = None
    body: Annotated[Path, takes.located_in("geometry")] | None = None
    reference_point: takes.Point | None = None
    solver: takes.Text = "openfoam"
    runner: takes.Text = "local"
    cores: Annotated[
        int, takes.Takes("a whole number of cores", lambda v, _: _whole(v, 4096), {"type": "integer", "minimum": 1})
    ] = 1
    symmetry: takes.Flag = True


def _whole(given: Any, most: int) -> int:
    if isinstance(given, bool) or not isinstance(given, int) or not 1 <= given <= most:
        raise InputError(shown(given), f"a whole number from 1 to {most}")
    return given


@dataclass(frozen=True, slots=True, kw_only=True)
class TankConditions(Declaration):
    """The water and the speed.

    Attributes
    ----------
    density : float
        Of the water.
    speed : float
        Of the reference point.
    viscosity : float
        Kinematic.
    """

    density: Annotated[takes.Density, takes.ABOVE_ZERO]
    speed: Annotated[takes.Speed, takes.ABOVE_ZERO]
    viscosity: Annotated[takes.Viscosity, takes.ABOVE_ZERO]


@dataclass(frozen=True, slots=True, kw_only=True)
class CombinedKeys(Declaration):
    """Drift, attack and turning at once.

    Attributes
    ----------
    drift, attack : float
        v = U sin(drift), w = U sin(attack).
    yaw, pitch : float
        r' = r L/U and q' = q L/U.
    """

    drift: takes.Angle = 0.0
    attack: takes.Angle = 0.0
    yaw: takes.Pure = 0.0
    pitch: takes.Pure = 0.0

    def check(self) -> None:
        """Two motions at least, within their limits."""
        moving = [name for name in ("drift", "attack", "yaw", "pitch") if getattr(self, name)]
        if len(moving) < 2:
            raise InputError(f"{' and '.join(moving) or 'no motion'} alone", "two motions at once at least")
        for name in ("drift", "attack"):
            if abs(getattr(self, name)) > np.radians(60.0):
                raise InputError(f"{getattr(self, name):g} rad", _ANGLE_LIMIT, column=name)


@dataclass(frozen=True, slots=True, kw_only=True)
class ControlKeys(Declaration):
    """Straight runs with a control deflected.

    Attributes
    ----------
    name : str
        As the columns of a campaign: delta_r or dr (rudder), delta_s or ds (stern planes), delta_b or db (bow planes).
    angles : tuple of float
        Of the control.
    """

    name: takes.Text
    angles: Angles

    def check(self) -> None:
        """A control that a campaign has a column for."""
        if self.symbol not in CONTROL_COLUMNS.values():
            known = ", ".join((*CONTROL_COLUMNS, *CONTROL_COLUMNS.values()))
            raise InputError(shown(self.name), f"one of {known}", column="name")

    @property
    def symbol(self) -> str:
        """``dr``, ``ds`` or ``db``."""
        return one_name(self.name)


@dataclass(frozen=True, slots=True, kw_only=True)
class MatrixKeys(Declaration):
    """The test matrix; what is left out is what the six derivatives need of this body, an empty list is none.

    Attributes
    ----------
    drift : tuple of float
        Angles, v = U sin(drift).
    attack : tuple of float
        Angles, w = U sin(attack).
    yaw : tuple of float
        Rates r' = r L/U on a rotating arm.
    pitch : tuple of float
        Rates q' = q L/U; none unless given.
    speeds : tuple of float
        Of further straight runs.
    combined : array of tables
        Motions at once.
    control : array of tables
        Straight runs with a control deflected.
    pairs : tuple of str
        Names of conditions whose mirror image is run as well, such as "drift+2", to see the bias of a mesh that is not its own.
    """

    drift: Angles | None = None
    attack: Angles | None = None
    yaw: Rates | None = None
    pitch: Rates = ()
    speeds: Speeds = ()
    combined: tuple[CombinedKeys, ...] = ()
    control: tuple[ControlKeys, ...] = ()
    pairs: takes.Texts = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class GridKeys(Declaration):
    """One grid of a family in which every cell grows alike.

    Attributes
    ----------
    name : str
        medium is the grid of the matrix.
    size : float
        Edge of every cell over that of the grid medium.
    """

    name: Name
    size: Annotated[takes.Pure, takes.ABOVE_ZERO]


@dataclass(frozen=True, slots=True, kw_only=True)
class StudyKeys(Declaration):
    """What is varied of some conditions, one thing at a time, to see how far a choice moves their forces.

    Attributes
    ----------
    of : tuple of str
        Names of conditions, such as "drift+4"; ``coeflab tow --dry-run`` lists them.
    grid : tuple of str
        Grids besides medium; three in all give a grid uncertainty.
    domain : tuple of float
        Factors of the domain's size.
    turbulence : tuple of str
        Models by the names of the solver.
    iterations : tuple of float
        How many instead of a plateau.
    """

    of: takes.Texts
    grid: takes.Texts = ()
    domain: Numbers = ()
    turbulence: takes.Texts = ()
    iterations: Numbers = ()

    def check(self) -> None:
        """Conditions, and something to vary."""
        if not self.of:
            raise InputError("no condition", 'names of conditions such as ["drift+4"]', column="of")
        if not self.built.values:
            raise InputError("nothing to vary", "grid, domain, turbulence or iterations")

    @property
    def built(self) -> Study:
        """The study."""
        values = {
            "grid": self.grid,
            "domain": tuple(f"{v:g}" for v in self.domain),
            "turbulence": self.turbulence,
            "iterations": tuple(f"{v:g}" for v in self.iterations),
        }
        return Study(self.of, {name: given for name, given in values.items() if given})


@dataclass(frozen=True, slots=True, kw_only=True)
class TankFile(Declaration):
    """A tank.toml: a body, the water, the motions it is towed in, and who computes its forces.

    Attributes
    ----------
    tank : table
        What is towed, and by which solver.
    conditions : table
        The water and the speed.
    scaling : table
        The length of the primes; the body's unless given.
    matrix : table
        The test matrix.
    grid : array of tables
        The family of grids; coarse, medium and fine by a factor of 1.3 unless given.
    study : array of tables
        Grid, domain, turbulence and iteration studies.
    solver : table
        A table of options for each solver, by its name: [solver.openfoam].
    runner : table
        A table of options for each runner, by its name: [runner.local].
    """

    tank: TankKeys = field(default_factory=TankKeys)
    conditions: TankConditions
    scaling: Annotated[Scaling | None, takes.OrEmpty()] = None
    matrix: MatrixKeys = field(default_factory=MatrixKeys)
    grid: tuple[GridKeys, ...] = ()
    study: tuple[StudyKeys, ...] = ()
    solver: Annotated[Mapping[str, Any], takes.TABLE] = field(default_factory=dict)
    runner: Annotated[Mapping[str, Any], takes.TABLE] = field(default_factory=dict)

    def check(self) -> None:
        """Grids of different names, one of them medium and of size 1; studies of grids that there are."""
        names = [g.name for g in self.grids]
        for i, grid in enumerate(self.grid):
            if names.count(grid.name) > 1:
                raise InputError(f"the grid {shown(grid.name)} twice", "a name of its own", column=f"grid[{i}].name")
            if grid.name == MEDIUM and grid.size != 1.0:
                raise InputError(f"{grid.size:g}", "1, as sizes are over that of medium", column=f"grid[{i}].size")
        for i, study in enumerate(self.study):
            for name in study.grid:
                if name not in names or name == MEDIUM:
                    known = ", ".join(n for n in names if n != MEDIUM)
                    raise InputError(shown(name), f"one of {known}", column=f"study[{i}].grid")

    @property
    def grids(self) -> tuple[Grid, ...]:
        """The family, with medium."""
        if not self.grid:
            return GRIDS
        own = tuple(Grid(g.name, g.size) for g in self.grid)
        return own if any(g.name == MEDIUM for g in own) else (Grid(MEDIUM, 1.0), *own)
