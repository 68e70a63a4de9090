"""An added-mass matrix."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from coeflab.law.added_mass import AddedMass
from coeflab.report.plots.axes import axes_of

MOTIONS = ("surge", "sway", "heave", "roll", "pitch", "yaw")


def plot_added_mass(found: AddedMass, ax: Axes | None = None) -> Axes:
    """Entries beside the root of the product of their diagonal ones, so that 1 is the most; their numbers in kg, kg m, kg m^2.

    Parameters
    ----------
    found : AddedMass
    ax : Axes, optional
    """
    axes = axes_of(ax)
    size = np.sqrt(np.abs(np.diag(found.matrix)))
    scale = np.outer(size, size)
    share = np.divide(np.abs(found.matrix), scale, out=np.zeros((6, 6)), where=scale > 0.0)
    axes.imshow(share, vmin=0.0, vmax=1.0, cmap="Greys")
    for (i, j), value in np.ndenumerate(found.matrix):
        if share[i, j] > 1e-3:
            axes.text(j, i, f"{value:.3g}", ha="center", va="center", color="w" if share[i, j] > 0.5 else "k")
    axes.set_xticks(range(6), MOTIONS)
    axes.set_yticks(range(6), MOTIONS)
    axes.set_title(f"{found.body} by {found.method}")
    return axes
