"""Columns of a table in SI but in its own axes: what every importer makes of its file before the common turn to FRD."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from hashlib import sha256
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from coeflab.core.errors import InputError, together
from coeflab.core.texts import input_error
from coeflab.core.types import Array, brief

DIGIT = "digit_"  # before the name of a force: a column of the last digits that its source printed
FEWEST = 3  # numbers that show the last digit of their column
MOST_DIGITS, SAME = 9, 1e-12  # behind the point; of the largest number: what a conversion leaves
UNIFORM = 12.0**0.5  # a digit over its standard error


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Columns:
    """Columns in SI, by their plain names, in the axes that the campaign declares.

    Attributes
    ----------
    file : Path
    header_line : int
    lines : tuple of int
        Line number of every row.
    headers : dict of str to str
        Header of a column as written, by its plain name (``Y`` for ``Y' [-]``).
    angles : dict of str to array
        ``alpha``, ``beta`` in radians, in the sign that the table uses.
    velocity : dict of str to array
        u v w p q r, m/s and rad/s.
    controls : dict of str to array
        ``dr``, ``ds``, ``db`` in radians.
    speed : (n,) array
        U, m/s.
    forces, errors : dict of str to array
        X Y Z K M N and their standard errors, N and N m; NaN where blank. Of ``drag``, ``lift`` (up) and ``side`` (to
        starboard), along and across the flow, `in_body_axes` makes X, Y and Z.
    rounding : dict of str to array
        Standard errors of the forces by the last digit that the file prints of them (`rounded_to`); zero of a full-precision column.
    labels : dict of str to list of str
    doubtful : tuple of frozenset of str
        For every row the plain names of columns whose digits are doubtful in the source.
    row_labels : tuple of str
        One short name per row.
    files : tuple of Path
        What was read, where ``file`` is a folder.
    radius : (n,) array or None
        Column R, from the arm point to the centre of the circle, m; in the place of p, q and r.
    density : (n,) array or None
        Of the water of every row, kg/m^3; by default the campaign's.
    propeller : dict of str to array
        ``rps`` in rad/s, ``J``, ``thrust`` in N; NaN where blank.
    """

    file: Path
    header_line: int
    lines: tuple[int, ...]
    headers: Mapping[str, str]
    angles: Mapping[str, Array]
    velocity: Mapping[str, Array]
    controls: Mapping[str, Array]
    speed: Array
    forces: Mapping[str, Array]
    errors: Mapping[str, Array]
    labels: Mapping[str, list[str]]
    doubtful: tuple[frozenset[str], ...]
    row_labels: tuple[str, ...] = field(default=())
    files: tuple[Path, ...] = ()
    radius: Array | None = None
    density: Array | None = None
    propeller: Mapping[str, Array] = field(default_factory=dict)
    rounding: Mapping[str, Array] = field(default_factory=dict)

    def __len__(self) -> int:
        return len(self.lines)

    def fail(self, code: str, *, row: int | None = None, name: str = "", **facts: Any) -> InputError:
        """An error about one cell, a column or the header, to be raised by the caller; of a folder by the name of the run."""
        is_folder = self.file.is_dir()
        line = None if is_folder else self.header_line or None if row is None else self.lines[row]
        where = f" in {self.row_labels[row]}" if is_folder and row is not None and self.row_labels else ""
        return input_error(code, self.file, line, self.headers.get(name, name) or None, where=where, **facts)

    @property
    def digest(self) -> str:
        """Hexadecimal sha256 of the numbers, for columns that no file holds."""
        out = sha256()
        for part in (self.angles, self.velocity, self.controls, {"U": self.speed}, self.forces, self.errors):
            for name in sorted(part):
                out.update(name.encode() + np.ascontiguousarray(part[name], dtype="<f8").tobytes())
        return out.hexdigest()

    @property
    def settings(self) -> dict[str, Array]:
        """What the test was set to: angles, velocities, control angles."""
        return {**self.angles, **self.velocity, **self.controls}

    def check(self) -> None:
        """Refuse settings that are blank, angles beyond a half turn, and standard errors that are none.

        Raises
        ------
        InputError
            By line and column; of every column the first cell.
        """
        if complaints := list(self._complaints()):
            raise together(complaints)

    def _complaints(self) -> Iterator[InputError]:
        if not self.forces:
            yield self.fail("tables.no_force_column")
        if (row := first_row(~(self.speed > 0.0))) is not None:
            found = "a blank cell" if np.isnan(self.speed[row]) else f"a speed of {self.speed[row]:g} m/s"
            yield self.fail("tables.speed_of_row", row=row, name="U", found=found)
        if self.density is not None and (row := first_row(~(self.density > 0.0))) is not None:
            found = "a blank cell" if np.isnan(self.density[row]) else f"a density of {self.density[row]:g} kg/m^3"
            yield self.fail("tables.density_of_row", row=row, name="density", found=found)
        for name, values in self.settings.items():
            if (row := first_row(np.isnan(values))) is not None:
                yield self.fail("tables.blank_cell", row=row, name=name)
                continue
            if name in self.velocity or (row := first_row(np.abs(values) > np.pi)) is None:
                continue
            yield self.fail(
                "tables.angle_beyond_half_turn", row=row, name=name, angle=values[row], plain=self.headers[name].partition(" [")[0],
            )  # fmt: skip
        for name, values in self.errors.items():
            if name not in self.forces:
                yield self.fail("tables.error_without_force", name=f"se_{name}", force=name)
                continue
            unused = np.isnan(self.forces[name]) & np.isnan(values)
            if (row := first_row(~(values > 0.0) & ~unused)) is not None:
                found = "a blank cell" if np.isnan(values[row]) else f"{values[row]:g}"
                yield self.fail("tables.standard_error_of_row", row=row, name=f"se_{name}", found=found)
        for name, values in self.rounding.items():
            if name not in self.forces:
                yield self.fail("tables.digit_without_force", name=f"{DIGIT}{name}", force=name)
            elif (row := first_row(~(values >= 0.0) & ~np.isnan(self.forces[name]))) is not None:
                found = "a blank cell" if np.isnan(values[row]) else f"{values[row] * UNIFORM:g}"
                yield self.fail("tables.digit_of_row", row=row, name=f"{DIGIT}{name}", found=found)


def rounded_to(numbers: Array) -> float:
    """Standard error of numbers (n,) that were rounded to one last digit: that digit over the root of 12, uniform; zero where they show none.

    The digit is the coarsest of 1, 0.1, 0.01 ... whose multiples they all are. Zeros behind a point are lost where numbers are no text: that
    `FEWEST` numbers all end in one by chance is one in a thousand.

    Parameters
    ----------
    numbers : (n,) array
        As printed, NaN where blank.

    Examples
    --------
    >>> round(rounded_to(np.array([0.1, 0.095, -0.012])) * 12.0**0.5, 6), rounded_to(np.array([1.0, 2.0, 1.0 / 3.0]))
    (0.001, 0.0)
    """
    known = numbers[np.isfinite(numbers)]
    size = float(np.max(np.abs(known), initial=0.0))
    if len(known) < FEWEST or size == 0.0:
        return 0.0
    for digits in range(MOST_DIGITS + 1):
        if np.all(np.abs(known - np.round(known, digits)) <= SAME * size):
            return float(10.0**-digits / UNIFORM)
    return 0.0


def first_row(where: NDArray[np.bool_]) -> int | None:
    """The first of some rows, (n,); None where there is none."""
    rows = np.flatnonzero(where)
    return int(rows[0]) if rows.size else None
