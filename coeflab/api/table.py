"""`Table`: forces over settings, with what a person does with them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from coeflab.core.missed import suggesting
from coeflab.tables.force_table import ForceTable
from coeflab.tables.planar_motion import PlanarMotionTable

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes


@suggesting
@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Table(ForceTable):
    """Forces that the fluid exerts on a body in steady motion, SI, FRD, about one point; see `coeflab.read_table`.

    Attributes
    ----------
    motion : mapping of str to (n,) array
        u v w p q r, m/s and rad/s.
    forces : mapping of str to (n,) array
        The measured ones of X Y Z K M N, N and N m; NaN where blank.
    usable : mapping of str to (n,) boolean array
        Whether fits may use a cell.
    exclusions : tuple
        Cells that no fit uses, with the reason.
    reference_point : (3,) array
        m, FRD, from `datum`.
    notes : tuple of str
        What was done to the file's numbers.

    Examples
    --------
    >>> import coeflab as cf
    >>> table = cf.read_table("suboff_roddy_2")
    >>> table.varies
    ('v', 'dr')
    """

    def frame(self) -> pd.DataFrame:
        """A row a condition: motions, controls (rad), U, forces, SI; NaN where the source has no number.

        Examples
        --------
        >>> import coeflab as cf
        >>> cf.read_table("suboff_roddy_2").frame().columns[:2].tolist()
        ['u [m/s]', 'v [m/s]']
        """
        import pandas as pd

        units = dict.fromkeys("uvw", "m/s") | dict.fromkeys("pqr", "rad/s")
        out = {f"{m} [{units[m]}]": np.array(x) for m, x in self.motion.items()}
        out |= {f"{c} [rad]": np.array(x) for c, x in self.controls.items()}
        out["U [m/s]"] = np.array(self.speed)
        out |= {f"{c} [{'N' if c in 'XYZ' else 'N m'}]": np.array(x) for c, x in self.forces.items()}
        out |= {f"se_{c} [{'N' if c in 'XYZ' else 'N m'}]": np.array(x) for c, x in self.errors.items()}
        return pd.DataFrame(out, index=pd.Index(self.labels, name="row"))

    def plot(self, component: str = "", over: str = "", ax: Axes | None = None) -> Axes:
        """A force component over a motion; cells that no fit uses are crosses.

        Parameters
        ----------
        component : str
            Of X Y Z K M N; by default the first that the motion moves.
        over : str
            Of v w p q r dr ds db; by default what varies first.
        ax : Axes, optional
            To draw into; by default that of a new figure.

        Examples
        --------
        >>> import coeflab as cf
        >>> cf.read_table("suboff_roddy_2").plot("Y").get_ylabel()
        'Y [N]'
        """
        from coeflab.report.plots import plot_table

        return plot_table(self, component, over, ax)


@dataclass(frozen=True, slots=True, eq=False, repr=False, kw_only=True)
class OscillatingTable(Table, PlanarMotionTable):
    """Oscillating runs, whose rows are means over the record; ``runs`` has the records."""
