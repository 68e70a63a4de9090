"""Points of a force table."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from coeflab.core.errors import InputError, shown
from coeflab.law.symbols import ANGULAR, CONTROLS
from coeflab.report.figures.laws import draw_trace
from coeflab.report.figures.nouns import MOVED_BY, traces
from coeflab.report.plots.axes import axes_of, palette
from coeflab.tables.force_table import ForceTable


def plot_table(table: ForceTable, component: str = "", over: str = "", ax: Axes | None = None) -> Axes:
    """A component over a motion, SI; controls in degrees; what no fit uses is hollow.

    Parameters
    ----------
    table : ForceTable
    component, over : str
        Empty: what is measured and varies first.
    ax : Axes, optional

    Raises
    ------
    InputError
        What the table has not.
    """
    known = {**table.motion, **table.controls}
    over = over or next(iter(table.varies), "u")
    if over not in known:
        raise InputError(shown(over), f"one of {', '.join(known)}", column="over")
    component = component or next((c for c in MOVED_BY.get(over, "") if c in table.forces), next(iter(table.forces)))
    if component not in table.forces:
        raise InputError(shown(component), f"one of {', '.join(table.forces)}", column="component")
    axes = axes_of(ax)
    x = np.degrees(known[over]) if over in CONTROLS else np.asarray(known[over])
    y, used = np.asarray(table.forces[component]), np.asarray(table.usable[component])
    for trace in traces(x, y, used):
        drawn = draw_trace(axes, trace, trace.form, palette())
        drawn[0].set_label(f"{table.name}, {component}" if trace.form == "filled" else trace.name)
    axes.set_xlabel(f"{over} [{'deg' if over in CONTROLS else 'rad/s' if over in ANGULAR else 'm/s'}]")
    axes.set_ylabel(f"{component} [{'N' if component in 'XYZ' else 'N m'}]")
    axes.legend()
    return axes
