"""A table as its file has it, before anybody said what its columns mean; and one run of a solver or a carriage."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from enum import StrEnum
from pathlib import Path
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from coeflab.core.errors import InputError
from coeflab.core.types import Array, brief, locked
from coeflab.tables.columns import DIGIT, UNIFORM, rounded_to

HALF_MODEL = "campaign.half_model"  # key of what a symmetry plane in the domain leaves open
ONE_FLOW = "table.flow"  # velocity of a body that is turned in the mesh: forces may count along the flow
NO_FORCES = "a case without forces"  # what an importer says to have found where a case was never run


@dataclass(frozen=True, slots=True)
class Stated:
    """Something that a file states itself, with its place.

    Attributes
    ----------
    value : str, float, bool or tuple of float
        As campaign.toml would hold it: SI numbers, or a text.
    place : str
        File and line, such as ``constant/transportProperties:21``.
    offered : bool
        Words over a table say it, which may be about something else: to be confirmed.
    contradicted : str
        What contradicts it, so that a person has to say it; empty where nothing does.
    convention : bool
        The format fixes it for every file, this one does not say it: a person may know better.
    """

    value: str | float | bool | tuple[float, ...]
    place: str
    offered: bool = False
    contradicted: str = ""
    convention: bool = False


@brief
@dataclass(frozen=True, slots=True, eq=False)
class RawColumn:
    """One column as the file has it.

    Attributes
    ----------
    name : str
        As the file writes it, without its unit.
    unit : str
        As the file writes it; empty where it states none.
    values : (n,) array
        Numbers, in the file's unit; NaN where a cell is blank, is written NaN or is text.
    texts : tuple of str
        Cells as written; empty where every cell is a number or blank.
    means : str
        Plain name that the format itself fixes (``Y``, ``se_Y``, ``N``, ``r``, ``beta``, ``U``, ``cells``, ``time``);
        empty where a person has to say it.
    digits : (n,) array or None
        Last digit of every number, in the same unit, zero of one with all digits; None where the numbers themselves show it.
    """

    name: str
    unit: str
    values: Array
    texts: tuple[str, ...] = ()
    means: str = ""
    digits: Array | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "values", locked(self.values))

    @property
    def is_text(self) -> bool:
        """Whether a cell is neither a number nor blank."""
        return bool(self.texts)

    @property
    def rounding(self) -> Array:
        """Standard errors by the last digit, in the column's unit, (n,)."""
        return np.full(len(self.values), rounded_to(self.values)) if self.digits is None else self.digits / UNIFORM


class SeveralError(InputError):
    """A file that holds several tables; ``choices`` of the option sheet are their names."""

    choices: tuple[str, ...] = ()


@brief
@dataclass(frozen=True, slots=True, eq=False)
class RawTable:
    """Columns of equal length, not yet in SI, FRD or anybody's names.

    Attributes
    ----------
    path : Path
        File or folder that it was read from.
    columns : tuple of RawColumn
        A column ``digit_Y`` beside one ``Y`` in its unit becomes the ``digits`` of that.
    header_line : int
        Line of the column names in the file; 0 where it has none.
    lines : (n,) integer array
        Line of every row; empty where rows have none.
    row_labels : tuple of str
        Names of the rows (runs, points); empty where they have none.
    files : tuple of Path
        Every file that was read.
    dialect : mapping of str to str
        What was recognised: ``delimiter``, ``decimal mark``, ``encoding``, ``sheet``, ``version`` ..., as people read it.
    stated : mapping of str to Stated
        What the files say of keys of campaign.toml: ``axes.frame``, ``axes.reference_point``, ``conditions.speed``,
        ``conditions.density``, ``scaling.length``, ``table.contains_inertia``, ``source.how_obtained`` ...; under `HALF_MODEL`
        the patches of a symmetry plane, which may be a cut through the body.
    remarks : tuple of str
        What was left out or mended, one sentence each, with file and line.
    """

    path: Path
    columns: tuple[RawColumn, ...]
    header_line: int = 0
    lines: NDArray[np.int64] = field(default_factory=lambda: np.empty(0, dtype=np.int64))
    row_labels: tuple[str, ...] = ()
    files: tuple[Path, ...] = ()
    dialect: Mapping[str, str] = field(default_factory=dict)
    stated: Mapping[str, Stated] = field(default_factory=dict)
    remarks: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "lines", locked(self.lines, np.int64))
        names = {(DIGIT + c.name, c.unit): c.name for c in self.columns}
        digits = {
            names[c.name, c.unit]: c for c in self.columns if (c.name, c.unit) in names and np.all(c.values >= 0.0)
        }
        if digits:
            own = [c for c in self.columns if c not in digits.values()]
            known = (replace(c, digits=digits[c.name].values) if c.name in digits else c for c in own)
            object.__setattr__(self, "columns", tuple(known))
        for name in ("dialect", "stated"):
            object.__setattr__(self, name, MappingProxyType(dict(getattr(self, name))))

    def __len__(self) -> int:
        return len(self.columns[0].values) if self.columns else 0

    def column(self, name: str) -> RawColumn:
        """The first column of that name.

        Raises
        ------
        KeyError
            No column has it.
        """
        for column in self.columns:
            if column.name == name:
                return column
        raise KeyError(name)

    def meaning(self, means: str) -> RawColumn | None:
        """The column whose format fixes that plain name, or None."""
        return next((c for c in self.columns if c.means == means), None)


class Ended(StrEnum):
    """How a run ended, as its files show it."""

    WHOLE = "whole"
    CRASHED = "crashed"
    DIVERGED = "diverged"
    EMPTY = "empty"


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Run:
    """One steady condition: how its forces came about, and what its files say of the condition.

    Attributes
    ----------
    path : Path
        Folder of the case, or file of the monitor.
    name : str
        As the list of runs shows it.
    history : RawTable
        One row an iteration or a time, in order and without overlap: a column that means ``time`` or ``iteration``, and
        the whole forces and moments (columns that mean X Y Z K M N **in the solver's axes**), in N and N m if the unit
        says so, or as coefficients (unit ``-``).
    conditions : mapping of str to Stated
        ``alpha``, ``beta`` (rad), ``U`` (m/s), ``u`` ``v`` ``w`` (m/s), ``p`` ``q`` ``r`` (rad/s), ``dr`` ``ds`` ``db`` (rad),
        ``cells``, ``y_plus`` ... as far as the files state them, in the solver's axes; never guessed.
    patches : mapping of str to RawTable
        History of each patch, group or force share (``hull``, ``sail``, ``pressure``, ``viscous``), where there is one.
    ended : Ended
    why : str
        What shows it, with file and line; empty for a whole run.
    cut : bool
        That its last line is not whole shows it, and nothing else: broken off, or still running.
    length : float
        Of the body, m: the arm that makes a scale of moments of a force; 0 where nobody says.
    is_final : bool
        Its files hold results without a history, such as a report of the last iteration: the last row is the value.
    """

    path: Path
    name: str
    history: RawTable
    conditions: Mapping[str, Stated] = field(default_factory=dict)
    patches: Mapping[str, RawTable] = field(default_factory=dict)
    ended: Ended = Ended.WHOLE
    why: str = ""
    length: float = 0.0
    is_final: bool = False
    cut: bool = False

    @classmethod
    def empty(cls, path: Path, why: str, files: Sequence[Path] = ()) -> Run:
        """A run without a row, and what shows it."""
        return cls(path, path.stem, RawTable(path, (), files=tuple(files) or (path,)), ended=Ended.EMPTY, why=why)

    def __post_init__(self) -> None:
        for name in ("conditions", "patches"):
            object.__setattr__(self, name, MappingProxyType(dict(getattr(self, name))))
