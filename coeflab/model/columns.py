"""Columns of a table in SI but in its own axes: what every importer makes of its file before the common turn to FRD."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from coeflab.core.errors import InputError
from coeflab.kernels.brief import brief

Array = NDArray[np.float64]


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
        X Y Z K M N and their standard errors, N and N m; NaN where blank.
    labels : dict of str to list of str
    doubtful : tuple of frozenset of str
        For every row the plain names of columns whose digits are doubtful in the source.
    row_labels : tuple of str
        One short name per row.
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

    def __len__(self) -> int:
        return len(self.lines)

    def fail(
        self, found: str, expected: str, *, row: int | None = None, name: str = "", advice: str = ""
    ) -> InputError:
        """An error about one cell, a column or the header, to be raised by the caller."""
        return InputError(
            found,
            expected,
            file=self.file,
            line=self.header_line if row is None else self.lines[row],
            column=self.headers.get(name, name) or None,
            advice=advice,
        )

    @property
    def settings(self) -> dict[str, Array]:
        """What the test was set to: angles, velocities, control angles."""
        return {**self.angles, **self.velocity, **self.controls}

    def check(self) -> None:
        """Refuse settings that are blank, angles beyond a half turn, and standard errors that are none.

        Raises
        ------
        InputError
            By line and column.
        """
        if not self.forces:
            raise self.fail("no force column", "at least one of X Y Z K M N")
        if (row := _first(~(self.speed > 0.0))) is not None:
            found = "a blank cell" if np.isnan(self.speed[row]) else f"a speed of {self.speed[row]:g} m/s"
            raise self.fail(found, "a speed above zero", row=row, name="U")
        for name, values in self.settings.items():
            if (row := _first(np.isnan(values))) is not None:
                raise self.fail("a blank cell", "a number", row=row, name=name)
            if name in self.velocity or (row := _first(np.abs(values) > np.pi)) is None:
                continue
            raise self.fail(
                f"an angle of {values[row]:.4g} rad",
                "an angle within half a turn",
                row=row,
                name=name,
                advice=f"If the column is in degrees, write {self.headers[name].partition(' [')[0]} [deg].",
            )
        for name, values in self.errors.items():
            if name not in self.forces:
                raise self.fail(f"se_{name} without {name}", f"a column {name}", name=f"se_{name}")
            unused = np.isnan(self.forces[name]) & np.isnan(values)
            if (row := _first(~(values > 0.0) & ~unused)) is not None:
                found = "a blank cell" if np.isnan(values[row]) else f"{values[row]:g}"
                raise self.fail(found, "a standard error above zero", row=row, name=f"se_{name}")


def _first(where: NDArray[np.bool_]) -> int | None:
    rows = np.flatnonzero(where)
    return int(rows[0]) if rows.size else None
