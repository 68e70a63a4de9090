"""`tow` and `Tow`: a body in the virtual tow tank."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from coeflab.api.body import Body
from coeflab.bodies import body as plain
from coeflab.core.errors import InputError
from coeflab.core.files import located, typed
from coeflab.core.missed import suggesting
from coeflab.core.texts import input_error
from coeflab.core.types import in_angles
from coeflab.tank import tow as tank_room
from coeflab.tank.collected import Collected, collected
from coeflab.tank.tank import Tank
from coeflab.tank.towed_body import TowedBody

if TYPE_CHECKING:
    import pandas as pd


@suggesting
@dataclass(frozen=True, slots=True, eq=False)
class Tow:
    """What is to be towed: conditions, solver, water; nothing is written or run before `run`.

    Attributes
    ----------
    tank : Tank
        Matrix, grids, water, solver.
    towed : TowedBody

    Examples
    --------
    >>> import coeflab as cf
    >>> cf.tow("suboff_bare_hull").solver
    'openfoam'
    """

    tank: Tank
    towed: TowedBody
    matrix: Path | None = None

    def __repr__(self) -> str:
        return in_angles(self, f"{self.tank.name}: {len(self.tank.matrix)} conditions by {self.solver}")

    @property
    def solver(self) -> str:
        """Name of the solver."""
        return self.tank.solver

    def frame(self) -> pd.DataFrame:
        """A row a condition: velocity and rates of the reference point, m/s and rad/s, FRD.

        Examples
        --------
        >>> import coeflab as cf
        >>> cf.tow("suboff_bare_hull").frame().columns[0]
        'u [m/s]'
        """
        import pandas as pd

        heads = ("u [m/s]", "v [m/s]", "w [m/s]", "p [rad/s]", "q [rad/s]", "r [rad/s]")
        rows = np.array([[*c.velocity, *c.rates] for c in self.tank.matrix], dtype=float).reshape(-1, 6)
        return pd.DataFrame(
            rows, columns=list(heads), index=pd.Index([c.name for c in self.tank.matrix], name="condition")
        )

    def run(self, folder: str | Path, cores: int = 0) -> Collected:
        """Write the cases below a folder, run them and collect what came out; a killed tow goes on where it was.

        Parameters
        ----------
        folder : str or Path
        cores : int
            That all runs together may take; 0: what the runner takes.

        Returns
        -------
        Collected
            ``study`` with fits and parameter file, ``files`` that were written.
        """
        laid = tank_room.laid_out(self.tank, self.towed, Path(folder), self.matrix)
        tank_room.carried_out(laid, cores, lambda: None)
        return collected(laid)


def tow(body: str | Path | plain.Body, matrix: str | Path | None = None, *, solver: str = "", runner: str = "") -> Tow:
    """Plan a tow of a body through water by CFD. Nothing is written or run.

    Parameters
    ----------
    body : Body, str or Path
        That was read from a body.toml, such a file, its folder or a shipped body.
    matrix : str or Path, optional
        A tank.toml; without it what six derivatives need.
    solver, runner : str
        In the place of those of the file.

    Returns
    -------
    Tow

    Raises
    ------
    InputError
        A body without a body.toml, or what tank.toml says wrong, by line.

    Examples
    --------
    >>> import coeflab as cf
    >>> len(cf.tow("suboff_bare_hull").frame()) > 6
    True
    """
    if isinstance(body, plain.Body):
        place = body.place if isinstance(body, Body) else None
        if place is None:
            raise InputError(f"{body.name}, a body of no file", "one from read_body, of a body.toml", column="body")
    elif isinstance(body, str | Path):
        place = located(body, "geometry")
    else:
        raise InputError(f"a {type(body).__name__}", "a body, a path, or the name of a shipped body", column="body")
    if isinstance(matrix, str) and "\n" in matrix:
        raise input_error("tow.text_matrix", column="matrix")
    file = None if matrix is None else typed(matrix)
    return Tow(*tank_room.read(place, file, solver, runner), file)
