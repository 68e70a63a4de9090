"""A table of steady forces: SI, FRD, one reference point, every excluded cell with its reason."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from coeflab.core.axes import ANYWHERE, Datum
from coeflab.core.cards import html_by
from coeflab.core.finding import Finding
from coeflab.core.provenance import InputFile, Source
from coeflab.core.types import Array, brief, in_angles, locked, locked_columns
from coeflab.law.scaling import Conditions, Scaling
from coeflab.law.symbols import COMPONENTS, MOTIONS
from coeflab.law.transforms import force_transfer, velocity_transfer
from coeflab.tables.input_uncertainty import InputUncertainty

if TYPE_CHECKING:
    import pandas as pd


AT_REST = float(np.sin(np.radians(0.05)))
ROUNDING = 1e-12
FEWEST_SPEEDS = 3  # of straight runs that give X0'
COARSER, FINER = "coarser grid", "finer grid: for the grid study only"
ONE_GRID = 1.15  # ratio of cells: those of one grid at other angles lie closer
# What each part is called.
STUDIES = {"domain": "domain size", "turbulence": "turbulence model", "iterations": "iterations"}
DRIVEN = "propeller running: X holds its thrust"
RUNS_AT_U = 0.05  # of U: rows whose velocity is as long, not those of damping about a state of rest
SAME_SIZE = 0.02  # of the largest |x|: one radius, or one setting of a sweep, as measured


def _range(values: Array) -> str:
    low, high = (f"{float(f(values)):.5g}" for f in (np.min, np.max))
    return low if low == high else f"{low} to {high}"


COUNTED_THERE = "by symmetry a row of {}: it counts there"


@dataclass(frozen=True, slots=True)
class Exclusion:
    """A cell (or a whole row) that no fit uses.

    Attributes
    ----------
    row : int
        Index in the table.
    line : int
        Line in the file.
    component : str
        Force component, or empty for the whole row.
    reason : str
    uncertain : bool
        True when the source marks the value as doubtful, so that a reader may choose to use it after all.
    status : str
        What a label column ``status`` says of the row, such as ``too short``; empty without one.
    of_source : bool
        The source marks it or has no number there, or the campaign does not select the row.
    """

    row: int
    line: int
    component: str
    reason: str
    uncertain: bool = False
    status: str = ""
    of_source: bool = False


@brief
@dataclass(frozen=True, slots=True)
class Declared:
    """What campaign.toml says of a table, before it is turned to FRD and moved.

    Attributes
    ----------
    frame : str
        Axes of its columns.
    signs : tuple of (str, str)
        Angle and formula of its sign.
    reference_point : tuple of float
        Of its moments, m, FRD, from the datum.
    notes : str
        Of the campaign, for people.
    source_sha256 : str
        Of the file that the table was made from.
    constant : tuple of (str, float)
        What the source held at one number throughout, such as a propeller rate.
    """

    frame: str
    signs: tuple[tuple[str, str], ...]
    reference_point: tuple[float, ...]
    notes: str = ""
    source_sha256: str = ""
    constant: tuple[tuple[str, float], ...] = ()


@dataclass(frozen=True, slots=True, eq=False)
class ForceTable:
    """Forces that the fluid exerts on a body in steady motion.

    Attributes
    ----------
    name : str
        Campaign and table, for example ``suboff_roddy_2/table``.
    campaign, title, body : str
        Names; ``body`` says which hull with which appendages.
    motion : mapping of str to (n,) array
        u v w p q r in m/s and rad/s, FRD, at the reference point.
    controls : mapping of str to (n,) array
        Angles of control surfaces in radians, keys ``dr`` ``ds`` ``db``.
    speed : (n,) array
        U at the reference point, m/s, by which primes go; of rows without way the one that the campaign states.
    forces : mapping of str to (n,) array
        The measured ones of X Y Z K M N, N and N m, FRD; NaN where blank.
    errors : mapping of str to (n,) array
        Standard errors of forces, where the table has them.
    usable : mapping of str to (n,) boolean array
        Whether fits may use a cell.
    exclusions : tuple of Exclusion
    labels : tuple of str
        One text per row for figures and messages (run or point number).
    reference_point : (3,) array
        m, FRD, from the datum.
    datum : Datum
        The body point that reference points are measured from.
    conditions : Conditions
    scaling : Scaling
        Length that the campaign itself uses.
    source : Source
    files : tuple of InputFile
    notes : tuple of str
        What the importer did: inertia taken out, half model doubled, axes turned.
    cells : (n,) array or None
        Cells of the grid that computed each row, NaN where blank; None where the table does not say.
    variants : tuple of str
        What a study changed in each row, as ``domain = large``, empty for a row of the matrix itself; empty without studies.
    uncertainty : InputUncertainty or None
        Of the inputs, as the campaign declares it; None where it does not.
    lines : tuple of int
        Line of every row in its file; empty where there is none.
    measured_about : (3,) array or None
        Where the file's moments are about, once they have been moved.
    density : (n,) array or None
        Of the water of every row, kg/m^3; None where that of the conditions holds for all.
    arm_point : (3,) array or None
        Point of the body that runs on the circle of an arm with the speed U, m, FRD, from the datum; None where the file's
        motions are at the point of its moments.
    symmetry : tuple of str
        What the body is declared to be exactly: port-starboard, up-down, fourfold.
    by_symmetry : str
        Name of the table whose rows these are, turned by that symmetry; empty for rows that were run.
    inertia_subtracted : bool
        Whether the inertia of a turning model was taken out of its forces.
    halved : str
        What of half of a body was doubled, in words; empty for a whole body.
    primed : frozenset of str
        Components that the file has as primes by ``scaling``.
    assumed : tuple of str
        Angles whose sign was inferred from the sign of the slope, alpha or beta.
    declared : Declared or None
        What its campaign.toml says of it, before it was turned and moved; None for a table made by a program.
    findings : tuple of Finding
        What is assumed of it or left out; they travel with every number that comes of it.
    propeller : dict of str to (n,) array
        ``rps`` in rad/s, ``J``, ``thrust`` in N, where the table has them.
    rounding : mapping of str to (2, n) array
        Forces, and their standard errors by the last printed digit of their column; see `digits`.
    model_mass : float or None
        Of the model, kg, where its campaign states an inertia to be subtracted.
    """

    name: str
    campaign: str
    title: str
    body: str
    motion: Mapping[str, Array]
    controls: Mapping[str, Array]
    speed: Array
    forces: Mapping[str, Array]
    errors: Mapping[str, Array]
    usable: Mapping[str, NDArray[np.bool_]]
    exclusions: tuple[Exclusion, ...]
    labels: tuple[str, ...]
    reference_point: Array
    datum: Datum
    conditions: Conditions
    scaling: Scaling
    source: Source
    files: tuple[InputFile, ...] = ()
    notes: tuple[str, ...] = field(default=())
    cells: Array | None = None
    uncertainty: InputUncertainty | None = None
    lines: tuple[int, ...] = ()
    measured_about: Array | None = None
    density: Array | None = None
    arm_point: Array | None = None
    variants: tuple[str, ...] = ()
    symmetry: tuple[str, ...] = ()
    by_symmetry: str = ""
    inertia_subtracted: bool = False
    halved: str = ""
    primed: frozenset[str] = frozenset()
    assumed: tuple[str, ...] = ()
    declared: Declared | None = None
    findings: tuple[Finding, ...] = ()
    propeller: Mapping[str, Array] = field(default_factory=dict)
    model_mass: float | None = None
    rounding: Mapping[str, Array] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for name in ("motion", "controls", "forces", "errors", "propeller", "rounding"):
            object.__setattr__(self, name, locked_columns(getattr(self, name)))
        object.__setattr__(self, "usable", locked_columns(self.usable, bool))
        object.__setattr__(self, "speed", locked(self.speed))
        object.__setattr__(self, "reference_point", locked(self.reference_point))
        for name in ("cells", "measured_about", "density", "arm_point"):
            if getattr(self, name) is not None:
                object.__setattr__(self, name, locked(getattr(self, name)))

    def __len__(self) -> int:
        return len(self.speed)

    def __repr__(self) -> str:
        over = f" over {' '.join(self.varies)}" if self.varies else ""
        aside = f", {len(self.exclusions)} exclusions" if self.exclusions else ""
        return in_angles(self, f"{self.name}: {len(self)} rows of {' '.join(self.forces)}{over}{aside}")

    def _repr_html_(self) -> str:
        """Its points and ranges, for notebooks."""
        return html_by("force_table", self)

    @property
    def varies(self) -> tuple[str, ...]:
        """Motion variables and control angles that a row of the table holds, beyond rounding (surge does not count)."""
        names = [m for m in MOTIONS if m != "u"] + list(self.controls)
        length = self.scaling.length
        return tuple(m for m in names if np.any(np.abs(self.primed_motion(m, length)) > AT_REST))

    @property
    def water_density(self) -> float | Array:
        """Of each row where the table has it, (n,), else of the conditions; kg/m^3."""
        return self.conditions.density if self.density is None else self.density

    @property
    def digits(self) -> dict[str, Array]:
        """Standard errors of forces by their last printed digit, (n,) each; zero of other numbers than those that were read."""
        same = {
            c: np.array_equal(r[0], self.forces[c], equal_nan=True)
            for c, r in self.rounding.items()
            if c in self.forces
        }
        return {c: self.rounding[c][1] if same.get(c) else np.zeros(len(self)) for c in self.forces}

    @property
    def run_at(self) -> str:
        """Speed and density of the rows in words, a range where they differ."""
        speed, density = (_range(np.atleast_1d(v)) for v in (self.speed, self.water_density))
        return f"speed {speed} m/s, density {density} kg/m^3"

    def reynolds(self, length: float) -> Array | None:
        """U L / nu of every row, (n,); the one that the source states where the viscosity is not known, None without either."""
        at = self.conditions
        if at.viscosity is None:
            return None if at.reynolds is None else np.full(len(self), at.reynolds)
        return np.asarray(self.speed * length / at.viscosity)

    def at_one_density(self) -> ForceTable:
        """The table with forces in proportion to those that water of the conditions' density would exert."""
        if self.density is None:
            return self
        ratio = self.conditions.density / self.density
        own = (self.forces, self.errors, self.rounding)
        forces, errors, rounding = ({c: v * ratio for c, v in x.items()} for x in own)
        return replace(self, forces=forces, errors=errors, rounding=rounding, density=None)

    @property
    def setting(self) -> NDArray[np.intp]:
        """A number for every row, (n,), that rows at one setting share: motions, controls, speed and density to 1e-9."""
        own = [*(self.motion[m] for m in MOTIONS), *self.controls.values(), self.speed]
        settings = np.column_stack([*own, *([] if self.density is None else [self.density])])
        scale = np.maximum(np.max(np.abs(settings), axis=0, initial=0.0), 1e-300)
        return np.asarray(np.unique(np.round(settings / scale, 9), axis=0, return_inverse=True)[1]).ravel()

    def on_one_grid(self) -> ForceTable:
        """Of usable rows at one setting that of the grid which most settings share stays in use, else the finest; the others are left to the grid study."""
        if self.cells is None:
            return self
        setting, counted, nothing = self.setting, np.isfinite(self.cells), np.zeros(len(self), dtype=bool)
        level = grids(np.where(counted, self.cells, np.inf))
        some = counted & np.logical_or.reduce([*self.usable.values(), nothing])
        shared = [np.unique(setting[some & (level == k)]).size for k in range(int(level.max(initial=0)) + 1)]
        common = level == len(shared) - 1 - int(np.argmax(shared[::-1]))
        rank = np.where(counted, self.cells, 0.0) + common * 2.0 * np.max(self.cells[counted], initial=1.0)
        usable, left, selected = {}, {}, np.zeros(len(self))
        for c, mask in self.usable.items():
            best = np.zeros(len(self))
            np.maximum.at(best, setting[mask & counted], rank[mask & counted])
            left[c] = mask & counted & (rank < best[setting])
            usable[c] = mask & ~left[c]
            in_use = usable[c] & counted
            np.maximum.at(selected, setting[in_use], self.cells[in_use])
        used = np.logical_or.reduce([*usable.values(), nothing])
        found = [
            Exclusion(int(row), self.lines[row] if self.lines else 0, c, FINER if self.cells[row] > selected[setting[row]] else COARSER)
            for row in np.flatnonzero(np.logical_or.reduce([*left.values(), nothing]))
            for c in ([c for c in left if left[c][row]] if used[row] else [""])
        ]  # fmt: skip
        return replace(self, usable=usable, exclusions=(*self.exclusions, *found))

    def at_speed(self, speed: float) -> ForceTable:
        """The rows of one speed in use, m/s, as measured and where it was stated; the others are left out."""
        points = (self.arm_point, self.measured_about, self.reference_point)
        stated = self.about(next(p for p in points if p is not None)).speed
        away = np.abs(stated - speed) > SAME_SIZE * abs(speed)
        return self._without(away, lambda _: f"another speed than {speed:g} m/s")

    def without_studies(self) -> ForceTable:
        """Rows in which a study changed something are left to that study."""
        if not any(self.variants):
            return self
        return self._without(np.array(list(map(bool, self.variants))), lambda i: f"study only: {self.variants[i]}")

    def _without(self, rows: NDArray[np.bool_], why: Callable[[int], str]) -> ForceTable:
        """The table with whole rows, (n,), left out of all fits; each that was in use with its reason."""
        used = [int(i) for i in np.flatnonzero(rows) if any(mask[i] for mask in self.usable.values())]
        usable = {c: mask & ~rows for c, mask in self.usable.items()}
        found = (Exclusion(i, self.lines[i] if self.lines else 0, "", why(i)) for i in used)
        return replace(self, usable=usable, exclusions=(*self.exclusions, *found))

    def sound(self, component: str) -> NDArray[np.bool_]:
        """Rows, (n,), whose force has a number that its source or the state of its run does not call doubtful."""
        out = np.isfinite(self.forces[component])
        out[[e.row for e in self.exclusions if e.component in ("", component) and (e.uncertain or e.status)]] = False
        return np.asarray(out)

    def primed_motion(self, variable: str, length: float) -> Array:
        """v/U, r L/U or a control angle, shape (n,); what rounding leaves of a zero is zero."""
        if variable in self.controls:
            return np.asarray(self.controls[variable])
        scale = length if variable in "pqr" else 1.0
        primes = np.asarray(self.motion[variable] * scale / self.speed)
        return np.where(np.abs(primes) > ROUNDING, primes, 0.0)

    def primed_force(self, component: str, length: float, values: Array | None = None) -> Array:
        """Y' = Y / (1/2 rho U^2 L^2), moments with L^3, shape (n,)."""
        unit = replace(self.scaling, length=length).unit(component, self.water_density, self.speed)
        return np.asarray((self.forces[component] if values is None else values) / unit)

    def frame(self) -> pd.DataFrame:
        """The table as a pandas DataFrame for notebooks: SI, FRD, cells that no fit may use are NaN."""
        import pandas as pd

        columns: dict[str, Array] = {f"{m} [{'m/s' if m in 'uvw' else 'rad/s'}]": a for m, a in self.motion.items()}
        columns |= {f"{c} [rad]": a for c, a in self.controls.items()}
        for c, values in self.forces.items():
            columns[f"{c} [{'N*m' if c in 'KMN' else 'N'}]"] = np.where(self.usable[c], values, np.nan)
        return pd.DataFrame(columns, index=pd.Index(self.labels, name="point"))

    def counted_from(self, datum: Datum, point: Array) -> ForceTable:
        """The table about a point, where its numbers hold about every point; else as it is."""
        return replace(self, datum=datum, reference_point=point) if self.datum == ANYWHERE else self

    def about(self, point: Array) -> ForceTable:
        """The same runs with velocities, U and moments about another point (m, FRD, from the same datum).

        Standard errors of moments become the bound |se_N| + |shift| |se_Y|, which holds for any correlation of force
        and moment errors, as tables do not state it.
        """
        shift = np.asarray(point, dtype=float) - self.reference_point
        if not np.any(shift):
            return self
        here = np.column_stack([self.motion[m] for m in MOTIONS])
        nu = here @ velocity_transfer(shift).T
        transfer = force_transfer(shift)
        forces, errors, usable = dict(self.forces), dict(self.errors), dict(self.usable)
        rounding, digits = dict(self.rounding), self.digits
        exclusions, notes = list(self.exclusions), [f"moments moved by ({', '.join(f'{s:+.6g}' for s in shift)}) m"]
        for i, component in enumerate(COMPONENTS):
            needed = [(c, transfer[i, j]) for j, c in enumerate(COMPONENTS) if transfer[i, j] != 0.0]
            if len(needed) == 1 or component not in forces:
                continue
            if lacking := [c for c, _ in needed if c not in forces]:
                notes.append(
                    f"{component} left out: to move it needs {' and '.join(lacking)}, which the table does not have"
                )
                del forces[component], usable[component]
                errors.pop(component, None)
                rounding.pop(component, None)
                exclusions = [e for e in exclusions if e.component != component]
                continue
            forces[component] = np.asarray(sum(self.forces[c] * k for c, k in needed))
            usable[component] = np.logical_and.reduce([self.usable[c] for c, _ in needed])
            exclusions += self._passed_on(component, [c for c, _ in needed if c != component])
            errors.pop(component, None)
            rounding.pop(component, None)
            if all(c in self.errors for c, _ in needed):
                errors[component] = np.asarray(sum(self.errors[c] * abs(k) for c, k in needed))
            if printed := [digits[c] * abs(k) for c, k in needed if c in digits]:  # the others have all digits
                rounding[component] = np.stack([forces[component], sum(printed)])
        return replace(
            self,
            motion=dict(zip(MOTIONS, nu.T, strict=True)),
            speed=speed_at(self.speed, here[:, :3], nu[:, :3]),
            forces=forces,
            errors=errors,
            rounding=rounding,
            usable=usable,
            exclusions=tuple(exclusions),
            reference_point=np.asarray(point, dtype=float),
            measured_about=self.reference_point if self.measured_about is None else self.measured_about,
            notes=(*self.notes, *notes),
        )

    def _passed_on(self, component: str, needed: list[str]) -> list[Exclusion]:
        """Exclusions of a moment that it inherits from the forces in its transfer."""
        own = {e.row for e in self.exclusions if e.component == component}
        return [
            replace(e, component=component, reason=f"{e.component}: {e.reason}")
            for e in self.exclusions
            if e.component in needed and e.row not in own
        ]

    def with_uncertain_cells(self) -> ForceTable:
        """The table with the cells in use that its source marks as doubtful but prints."""
        selected = [e for e in self.exclusions if not (e.uncertain and np.isfinite(self.forces[e.component][e.row]))]
        usable = {c: np.ones(len(self), dtype=bool) for c in self.usable}
        for e in selected:
            for component in [e.component] if e.component else usable:
                usable[component][e.row] = False
        return replace(self, usable=usable, exclusions=tuple(selected), notes=(*self.notes, "doubtful cells in use"))


def speed_at(speed: Array, before: Array, after: Array) -> Array:
    """U of rows, (n,), whose velocities (n, 3) become those of another point; a U that is not the length of its velocity stays.

    Examples
    --------
    >>> speed_at(np.array([3.0, 1.0]), np.array([[3.0, 0.0, 0.0], [0.0, 0.0, 0.0]]), np.array([[3.0, 4.0, 0.0], [0.0, 4.0, 0.0]]))
    array([5., 1.])
    """
    here, there = np.linalg.norm(before, axis=1), np.linalg.norm(after, axis=1)
    runs = (np.abs(here - speed) <= RUNS_AT_U * speed) & (there > AT_REST * here)
    return np.asarray(speed * np.divide(there, here, out=np.ones(len(speed)), where=runs))


def grids(cells: Array) -> NDArray[np.intp]:
    """A number for every row, (n,), that rows of one grid share, coarsest first: cells within `ONE_GRID` of the next.

    Examples
    --------
    >>> grids(np.array([1.0e6, 1.05e6, 3.0e6])).tolist()
    [0, 0, 1]
    """
    order = np.argsort(cells, kind="stable")
    out = np.empty(len(cells), dtype=np.intp)
    out[order] = np.concatenate([[0], np.cumsum(cells[order][1:] > ONE_GRID * cells[order][:-1])])[: len(cells)]
    return out


def running_rows(propeller: Mapping[str, Array], rows: int) -> NDArray[np.bool_]:
    """Rows, (n,), in which a propeller turns or thrusts, by rps or thrust, else by a number for J."""
    known = [np.nan_to_num(propeller[name]) != 0.0 for name in ("rps", "thrust") if name in propeller]
    known = known or [np.isfinite(propeller[name]) for name in ("J",) if name in propeller]
    return np.asarray(np.logical_or.reduce([*known, np.zeros(rows, dtype=bool)]))


def counted_once(tables: Sequence[ForceTable], *, axial: bool = True) -> list[ForceTable]:
    """The tables without the readings that symmetry only repeats, so that these narrow no fit over several tables.

    Of a table by symmetry whose origin is among the tables, rows at rest go, and X of every row: a turn about x leaves both as
    they are. What it turns into another component stays.

    Parameters
    ----------
    tables : sequence of ForceTable
    axial : bool
        Take X out as well; a fit over the motions of one plane alone meets no X twice.
    """
    names = {t.name for t in tables}
    out = []
    for table in tables:
        if table.by_symmetry not in names:
            out.append(table)
            continue
        moving = np.zeros(len(table), dtype=bool)
        for m in (*MOTIONS[1:], *table.controls):
            moving |= np.abs(table.primed_motion(m, table.scaling.length)) > AT_REST
        usable, more = {}, []
        for c, mask in table.usable.items():
            usable[c] = mask & moving & (not axial or c != "X")
            why = COUNTED_THERE.format(table.by_symmetry)
            lines = table.lines or (0,) * len(table)
            more += [Exclusion(int(i), lines[i], c, why) for i in np.flatnonzero(mask & ~usable[c])]
        out.append(replace(table, usable=usable, exclusions=(*table.exclusions, *more)))
    return out
