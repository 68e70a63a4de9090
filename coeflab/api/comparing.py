"""`compare` and `Comparison`: two vehicles, coefficient by coefficient."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from coeflab.api.parameters import HasParameters, parameters_of
from coeflab.api.questions import above_zero
from coeflab.core.keywords import all_spoken
from coeflab.core.missed import suggesting
from coeflab.core.table import Table as Shown
from coeflab.core.types import in_angles
from coeflab.motion.behaviour import Behaviour
from coeflab.motion.behaviour import behaviour as of_both
from coeflab.vehicle import comparison as plain
from coeflab.vehicle.comparison import ROUNDING
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.shared_tables import Verdict

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes

__all__ = ["ROUNDING", "Behaviour", "Comparison", "Verdict", "behaviour", "compare"]


@suggesting
@dataclass(frozen=True, slots=True, repr=False)
class Comparison(plain.Comparison):
    """Two vehicles; ``rows`` has a coefficient each, ``models`` the fitted tables, ``disagrees`` the verdict.

    Examples
    --------
    >>> import coeflab as cf
    >>> cf.compare("remus100", "remus100").disagrees
    False
    """

    def __repr__(self) -> str:
        verdicts = Counter(r.verdict.value for r in self.rows)
        return in_angles(self, f"{self.a}, {self.b}: {', '.join(f'{n} {v}' for v, n in verdicts.items())}")

    def frame(self) -> pd.DataFrame:
        """A row a coefficient: both values and U95, difference, combined U95, verdict; primed by the first one's length.

        Examples
        --------
        >>> import coeflab as cf
        >>> set(cf.compare("remus100", "remus100").frame()["difference"].dropna())
        {0.0}
        """
        import pandas as pd

        def known(value: float | None) -> float:
            return np.nan if value is None else value

        rows = [
            {
                "first": known(r.a), "first_u95": known(r.u95_a), "second": known(r.b), "second_u95": known(r.u95_b),
                "difference": known(r.difference), "combined": known(r.combined), "verdict": r.verdict.value, "reason": r.reason,
            }
            for r in self.rows
        ]  # fmt: skip
        return pd.DataFrame(rows, index=pd.Index([r.symbol for r in self.rows], name="symbol"))

    def summary(self, wide: bool = False) -> Shown:
        """What can be compared of both, with U95, difference and verdict, to be printed or shown in a notebook.

        Parameters
        ----------
        wide : bool
            Every coefficient, with the reason where none can be compared; else their names below.

        Examples
        --------
        >>> import coeflab as cf
        >>> cf.compare("remus100", "remus100").summary().headers[0]
        ''
        """
        from coeflab.report.tables.compared_files import coefficients, comparable, differ

        every = coefficients(self)
        return every if wide else comparable(every, differ(self))

    def plot(self, ax: Axes | None = None) -> Axes:
        """Both values of every coefficient with their intervals, each over the size of the first.

        Parameters
        ----------
        ax : Axes, optional
            To draw into; by default that of a new figure.

        Examples
        --------
        >>> import coeflab as cf
        >>> len(cf.compare("remus100", "remus100").plot().get_yticklabels()) > 1
        True
        """
        from coeflab.report.plots import plot_forest

        both = [r for r in self.rows if r.a is not None and r.b is not None]
        return plot_forest([(r.symbol, [(r.a, r.u95_a), (r.b, r.u95_b)]) for r in both], (self.a, self.b), ax)


def compare(
    first: HasParameters | ParameterFile | str | Path, second: HasParameters | ParameterFile | str | Path
) -> Comparison:
    """Hold a vehicle against another by their combined U95.

    Parameters
    ----------
    first, second : Vehicle, str or Path
        Parameter files, or names of shipped ones. The second is primed by the first one's length about its point.

    Returns
    -------
    Comparison

    Raises
    ------
    InputError
        What is no parameter file.

    Examples
    --------
    >>> import coeflab as cf
    >>> cf.compare("remus100", "huuv").same_body
    False
    """
    a, b = parameters_of(first), parameters_of(second)
    names = (
        (str(first), str(second))
        if a.name == b.name and isinstance(first, str | Path) and isinstance(second, str | Path)
        else None
    )
    found = plain.compare(a, b, names)
    found = replace(found, statements=all_spoken(found.statements))
    return Comparison(**{f.name: getattr(found, f.name) for f in fields(plain.Comparison)})


def behaviour(
    first: HasParameters | ParameterFile | str | Path,
    second: HasParameters | ParameterFile | str | Path,
    speed: float | str,
) -> tuple[Behaviour, ...]:
    """What two vehicles do at a speed: G_h, G_v, eigenvalues, turn, zigzag and forces, each with its difference.

    Parameters
    ----------
    first, second : Vehicle, str or Path
    speed : float or str
        m/s, or with a unit.

    Returns
    -------
    tuple of Behaviour

    Raises
    ------
    InputError

    Examples
    --------
    >>> import coeflab.api.comparing as comparing
    >>> comparing.behaviour("remus100", "remus100", 1.5)[0].difference
    0.0
    """
    return of_both(parameters_of(first), parameters_of(second), above_zero(speed, "speed", "speed"))
