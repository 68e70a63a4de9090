"""Reading a tank.toml, and what a body is towed in without one."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from pathlib import Path
from typing import Annotated, Any, cast

import numpy as np

from coeflab.bodies.body import Body
from coeflab.bodies.readers import read_body
from coeflab.core import declarations as takes
from coeflab.core.axes import Datum
from coeflab.core.declarations import Declaration
from coeflab.core.errors import InputError, shown, together
from coeflab.core.registry import Registry
from coeflab.core.text.toml import TomlFile, quoted, read_toml, value
from coeflab.core.units import with_unit
from coeflab.law.scaling import Conditions, Scaling
from coeflab.law.symbols import CONTROL_COLUMNS
from coeflab.tank import test_matrix
from coeflab.tank.runners import RUNNERS
from coeflab.tank.solvers import SOLVERS
from coeflab.tank.tank import Grid, Tank
from coeflab.tank.test_matrix import Study, Sweeps
from coeflab.tank.towed_body import TowedBody

MEDIUM = "medium"
GRIDS = (Grid("coarse", 1.3), Grid(MEDIUM, 1.0), Grid("fine", 1.0 / 1.3))
_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.+-]{0,59}")
FRESH_WATER = Conditions(998.2, 2.0, 1.0034e-6)  # 20 deg C, ITTC 7.5-02-01-03 (2011)


def _no_name(name: str) -> str:
    return "" if _NAME.fullmatch(name) else "letters, digits, _ . + - (it names folders), at most 60"


Name = Annotated[takes.Text, takes.Within(_no_name, schema={"pattern": f"^{_NAME.pattern}$"})]


def _quantities(dimension: str, words: str, largest: float, said: str) -> takes.Takes:
    """A list of different numbers of one dimension, none beyond the largest."""
    schema = {"type": "array", "items": dict(takes.number_in(dimension).schema)}

    def read(given: Any, _file: Path) -> tuple[float, ...]:
        if not isinstance(given, list):
            raise InputError(shown(given), words)
        numbers = tuple(with_unit(one, dimension) for one in given)
        for one, number in zip(given, numbers, strict=True):
            if abs(number) > largest:
                raise InputError(shown(one), said)
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
        int,
        takes.Takes("a whole number of cores", lambda v, _: _whole(v, 4096), {"type": "integer", "minimum": 1}),
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
        return CONTROL_COLUMNS.get(self.name, self.name)


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
    """

    drift: Angles | None = None
    attack: Angles | None = None
    yaw: Rates | None = None
    pitch: Rates = ()
    speeds: Speeds = ()
    combined: tuple[CombinedKeys, ...] = ()
    control: tuple[ControlKeys, ...] = ()


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
        if not self.made.values:
            raise InputError("nothing to vary", "grid, domain, turbulence or iterations")

    @property
    def made(self) -> Study:
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


def declared_body(path: Path) -> Path | None:
    """The body.toml that a tank.toml names, None where it names none.

    Raises
    ------
    InputError
        Everything that is wrong with the file.
    """
    found = takes.declared(TankFile, read_toml(path)).tank.body
    return None if found is None else _body_file(found)


def _body_file(path: Path) -> Path:
    return path / "body.toml" if path.is_dir() else path


def read_tank(
    path: Path, body: TowedBody | None = None, *, body_file: Path | None = None, solver: str = "", runner: str = ""
) -> Tank:
    """The tank of a tank.toml.

    Parameters
    ----------
    path : Path
        Paths inside resolve from its folder.
    body : TowedBody, optional
        Its mirrors and ends make the matrix; without one both sides of the whole body are towed.
    body_file : Path, optional
        The body.toml where the command line says it; required where the file does not.
    solver, runner : str, optional
        In the place of those that the file names.

    Raises
    ------
    InputError
        Everything that is wrong, by file, line and key.
    """
    return _tank(read_toml(path), body, body_file, solver, runner)


def default_tank(body_file: Path, body: TowedBody, *, solver: str = "", runner: str = "") -> Tank:
    """The tank of a body for which nobody wrote a tank.toml: that of `default_text`."""
    text = default_text(body)
    file = TomlFile(body_file.parent / "tank.toml", tomllib.loads(text), text)
    return _tank(file, body, body_file, solver, runner)


def default_text(surface: TowedBody, at: Conditions = FRESH_WATER) -> str:
    """A commented tank.toml for a body: what applies unless somebody says otherwise.

    What is commented out are the values that apply, and examples that hold for this body.

    Parameters
    ----------
    surface : TowedBody
        Its mirrors, ends and controls say what is run.
    at : Conditions, optional
        Fresh water of 20 deg C and 2 m/s unless given.
    """
    body = surface.body
    scaling = _scaling(body) or Scaling(surface.length, "LOA")
    sweeps = test_matrix.default_sweeps(surface, scaling.length)
    conditions = test_matrix.conditions(sweeps, surface, at.speed, scaling.length)
    angles = {
        name: f"[{', '.join(quoted(f'{np.degrees(a):.4g} deg') for a in getattr(sweeps, name))}]"
        for name in ("drift", "attack")
    }
    yaw = f"[{', '.join(f'{r:g}' for r in sweeps.yaw)}]"
    drifts, arms = ([c.name for c in conditions if c.kind is kind and min(_sideways(c)) >= 0.0] for kind in _STUDIED)
    controls = ", ".join(
        f'{{ name = {quoted(name)}, angles = ["-10 deg", "-5 deg", "5 deg", "10 deg"] }}'
        for name in dict.fromkeys(c.name for c in body.controls)
    )
    return f"""\
# The virtual tow tank of {body.name}: coeflab tow {body.name} --matrix tank.toml --out runs/{body.name}
[tank]
name = {quoted(body.name)}
solver = "openfoam"                  # external needs nothing installed; coeflab formats tow_solvers
cores = 1                            # that one run takes
# reference_point = {value([float(v) for v in body.reference_point])}   # of velocities and moments; the body's unless given
# symmetry = false                   # tow both sides of the whole body, whatever its mirrors

[conditions]
speed = "{at.speed:g} m/s"
density = "{at.density:g} kg/m^3"               # fresh water of 20 deg C, ITTC 7.5-02-01-03
viscosity = "{at.viscosity:g} m^2/s"

# [scaling]                          # of the primes; the body's unless given
# length = "{scaling.length:.10g} m"
# length_name = {quoted(scaling.length_name)}

[matrix]                             # what is left out is what the six derivatives need of this body, as it stands here
# drift = {angles["drift"]}   # v = U sin(drift); [] for none
# attack = {angles["attack"]}   # w = U sin(attack){"; from drift by fourfold symmetry" * (not sweeps.attack)}
# yaw = {yaw}   # r' = r L/U on a rotating arm
# pitch = []   # q' = q L/U
# combined = [{{ drift = "4 deg", yaw = {sweeps.yaw[-1] / 2.0:g} }}]
# control = [{controls}]{"   # the body has no [[control]] that turns" * (not controls)}

# [[study]]                          # a grid uncertainty for some conditions: three grids with medium
# of = ["{drifts[min(1, len(drifts) - 1)]}", "{arms[min(1, len(arms) - 1)]}"]
# grid = ["coarse", "fine"]          # cells 1.3 and 1/1.3 times the size; [[grid]] with name and size for others
"""


_STUDIED = (test_matrix.Kind.DRIFT, test_matrix.Kind.ARM)


def _sideways(condition: test_matrix.TowCondition) -> tuple[float, float]:
    return float(condition.velocity[1]), float(condition.rates[2])


def _scaling(body: Body) -> Scaling | None:
    """The body's own length of primes, else its length over all."""
    if body.scaling is not None:
        return body.scaling
    return next(
        (Scaling(length, name) for name, length in body.lengths.items() if "overall" in name or name == "LOA"), None
    )


def _tank(file: TomlFile, body: TowedBody | None, body_file: Path | None, solver: str, runner: str) -> Tank:
    said = takes.declared(TankFile, file)
    where = _where(file, said.tank.body, body_file)
    own = read_body(where) if body is None else body.body
    scaling = said.scaling or _scaling(own)
    if scaling is None and body is not None:
        scaling = Scaling(body.length, "LOA")
    if scaling is None:
        raise file.fail("scaling.length", "nothing", "a length", "Add [scaling] with length and length_name.")
    towed = body if body is None or said.tank.symmetry else replace(body, mirrors=(False, False, False), fourfold=False)
    speed = said.conditions.speed
    sweeps = _sweeps(said.matrix, towed, scaling.length)
    try:
        matrix = test_matrix.conditions(sweeps, towed, speed, scaling.length)
        matrix = test_matrix.with_studies(matrix, [study.made for study in said.study])
    except InputError as why:
        raise file.fail(why.column or "matrix", why.found, why.expected, why.advice) from None
    chosen, carried_by = solver or said.tank.solver, runner or said.tank.runner
    options = _options(file, "solver", SOLVERS, said.solver, chosen, "tank.solver" if not solver else "")
    carrying = _options(file, "runner", RUNNERS, said.runner, carried_by, "tank.runner" if not runner else "")
    point = own.reference_point if said.tank.reference_point is None else said.tank.reference_point
    return Tank(
        name=said.tank.name or own.name,
        title=own.title or own.name if said.tank.title is None else said.tank.title,
        body=where,
        datum=Datum.named(own.datum.id, own.datum.note),
        reference_point=point,
        scaling=scaling,
        conditions=Conditions(said.conditions.density, speed, said.conditions.viscosity),
        matrix=matrix,
        grids=said.grids,
        solver=chosen,
        options=options,
        cores=said.tank.cores,
        by_symmetry=test_matrix.stated(towed, sweeps),
        symmetry=test_matrix.symmetries(towed),
        runner=carried_by,
        runner_options=carrying,
    )


def _where(file: TomlFile, named: Path | None, given: Path | None) -> Path:
    """The body.toml, which the file and the command line may both name."""
    if named is None and given is None:
        raise file.fail("tank.body", "nothing", "the path of a body.toml, or a shipped name", "Add tank.body.")
    if named is None or given is None:
        return _body_file(cast(Path, given if named is None else named)).resolve()
    one, other = _body_file(named).resolve(), _body_file(given).resolve()
    if one != other:
        raise file.fail("tank.body", shown(named), f"{shown(given)}, the body that is to be towed, or no key at all")
    return one


def _sweeps(said: MatrixKeys, body: TowedBody | None, length: float) -> Sweeps:
    default = test_matrix.default_sweeps(body, length)
    controls: dict[str, tuple[float, ...]] = {}
    for one in said.control:
        controls[one.symbol] = (*controls.get(one.symbol, ()), *one.angles)
    return Sweeps(
        drift=default.drift if said.drift is None else said.drift,
        attack=default.attack if said.attack is None else said.attack,
        yaw=default.yaw if said.yaw is None else said.yaw,
        pitch=said.pitch,
        combined=tuple((c.drift, c.attack, c.yaw, c.pitch) for c in said.combined),
        controls=controls,
        speeds=said.speeds,
    )


def _options(
    file: TomlFile, section: str, plugins: Registry[Any], given: Mapping[str, Any], chosen: str, key: str
) -> dict[str, Any]:
    """What the declaration of the chosen plugin reads from ``[solver.NAME]``; tables of others are checked as well.

    Raises
    ------
    InputError
        A table of no plugin, or wrong keys in one.
    PluginError
        No such plugin.
    """
    known = plugins.names()
    if chosen not in known and key:
        raise file.fail(key, shown(chosen), f"one of {', '.join(known)}")
    complaints, out = [], {}
    for name in dict.fromkeys((*given, chosen)):
        if name not in known and name != chosen:
            complaints.append(file.fail(f"{section}.{name}", shown(name), f"one of {', '.join(known)}"))
            continue
        declaration: type[Declaration] = plugins.load(name).options
        try:
            read = takes.validated(declaration, given.get(name, {}), file.path, file.line, (section, name))
        except InputError as why:
            complaints += [why, *why.others]
            continue
        if name == chosen:
            out = {f.name: getattr(read, f.name) for f in fields(cast(Any, read))}
    if complaints:
        raise together(complaints)
    return out
