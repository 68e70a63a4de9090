"""The numbers behind a drawing, and marks in it that tell which artists they belong to."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Drawing
from numpy.typing import NDArray

from coeflab.presentation.document import Panel, Series
from coeflab.presentation.svg import POINTS

Array = NDArray[np.float64]
SERIES, SWATCH, LEGEND = "data-series=", "data-swatch=", "data-legend=legend"
DIGITS = 6
FEWER, MOST = 3, 400


def tagged(artists: Any, key: str) -> Any:
    """The artists, marked as those of a series; one artist or several."""
    for artist in artists if isinstance(artists, Iterable) else (artists,):
        artist.set_gid(f"{SERIES}{key}")
    return artists


def rounded(values: Any) -> tuple[float, ...]:
    """Numbers to six significant digits."""
    return tuple(float(f"{v + 0.0:.{DIGITS}g}") for v in np.asarray(values, dtype=float).ravel())


def points(
    key: str, name: str, x: NDArray[Any], y: NDArray[Any], notes: Sequence[str] = (), groups: Sequence[str] = ()
) -> Series:
    """Points of a drawing; those that are not finite are left out."""
    kept = [int(i) for i in np.flatnonzero(np.isfinite(x) & np.isfinite(y))]
    told, grouped = (tuple(texts[i] for i in kept) if texts else () for texts in (notes, groups))
    return Series(key, name, rounded(np.asarray(x)[kept]), rounded(np.asarray(y)[kept]), told, grouped)


def curve(key: str, name: str, x: Array, y: Array) -> Series:
    """A curve of a drawing; every third of its many values, 400 at most."""
    every = max(FEWER, -(-len(x) // MOST)) if len(x) > 60 else 1
    finite = np.isfinite(y)
    return Series(key, name, rounded(x[finite][::every]), rounded(y[finite][::every]), is_curve=True)


def numbers(
    axes: Axes,
    series: Iterable[Series],
    name_across: str,
    name_up: str,
    factor: float = 1.0,
    grouped_by: str = "",
    factor_across: float = 1.0,
    bars: str = "",
) -> Panel:
    """The panel of some axes.

    Parameters
    ----------
    axes : Axes
        Placed in their figure, with their limits.
    series : iterable of Series
    name_across, name_up : str
        Labels as drawn, ``name  [unit]``.
    factor : float
        Of the upright axis over the values of the series.
    grouped_by : str
    factor_across : float
        The same for the other axis.
    bars : str
    """
    figure: Drawing = axes.figure  # type: ignore[assignment]
    wide, tall = (float(s) * POINTS for s in figure.get_size_inches())
    box = axes.get_position()
    frame = rounded((box.x0 * wide, (1.0 - box.y1) * tall, box.width * wide, box.height * tall))
    low, high = rounded(np.array(axes.get_ylim()) / factor)
    left, right = rounded(np.array(axes.get_xlim()) / factor_across)
    (along, along_unit), (upright, upright_unit) = _apart(name_across), _apart(name_up)
    shown = tuple(s for s in series if s.x)
    place = (frame[0], frame[1], frame[2], frame[3])
    return Panel(
        place, (left, right), (low, high), along, along_unit, upright, upright_unit, shown, grouped_by, bars
    )  # fmt: skip


def _apart(label: str) -> tuple[str, str]:
    """Name and unit of an axis label."""
    name, _, unit = label.partition("  [")
    return name, unit.removesuffix("]") if unit != "-]" else ""
