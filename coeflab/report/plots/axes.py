"""Where a picture goes and in which colours: the user's."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import matplotlib as mpl
from matplotlib.axes import Axes


def axes_of(ax: Axes | None) -> Axes:
    """The axes that were given, or those of a new figure.

    Parameters
    ----------
    ax : Axes or None
    """
    if ax is not None:
        return ax
    import matplotlib.pyplot as plt

    result: Axes = plt.subplots()[1]
    return result


def palette() -> Mapping[str, str]:
    """Colours of the style that is set, by the names of the report's."""
    cycle: list[Any] = [one.get("color", "C0") for one in mpl.rcParams["axes.prop_cycle"]] or ["C0"]
    ink = mpl.rcParams["text.color"]
    own = {name: cycle[i % len(cycle)] for i, name in enumerate("abcd")}
    return {
        "ink": ink,
        "muted": mpl.rcParams["axes.labelcolor"],
        "rule": mpl.rcParams["grid.color"],
        "band": "0.6",
        **own,
    }
