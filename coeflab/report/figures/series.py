"""How a sweep is drawn: axes in degrees where the variable is an angle, one line style and marker per family.

The numbers behind a drawing, and marks in it that tell which artists they belong to.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Drawing
from numpy.typing import NDArray

from coeflab.core.types import Array, dataclass
from coeflab.fits.results.fit_result import Sweep
from coeflab.fits.statistics.slopes import Estimate
from coeflab.report.document import Panel, Series
from coeflab.report.figures.palette import COLOURS
from coeflab.report.figures.svg import POINTS

_AXIS_NAMES = {
    "v": "sideslip asin v'  [deg]",
    "w": "angle of attack asin w'  [deg]",
    "dr": "rudder angle  [deg]",
    "ds": "stern plane angle  [deg]",
    "db": "bow plane angle  [deg]",
    "p": "roll rate p' = p L/U  [-]",
    "q": "pitch rate q' = q L/U  [-]",
    "r": "yaw rate r' = r L/U  [-]",
}


@dataclass(frozen=True, slots=True)
class Style:
    """Colour, line and marker of one family; line and marker alone tell it from the others."""

    colour: str
    line: str | tuple[float, tuple[float, ...]]
    marker: str


STYLES = (
    Style(COLOURS["a"], (0, (5.0, 2.0)), "s"),
    Style(COLOURS["b"], "-", "o"),
    Style(COLOURS["c"], (0, (7.0, 2.0, 1.4, 2.0)), "D"),
    Style(COLOURS["d"], (0, (1.4, 1.6)), "^"),
)


def styles(sweep: Sweep) -> dict[str, Style]:
    """A style for every family of a sweep, by its name."""
    families = dict.fromkeys(e.family.name for e in sweep.forms)
    return {name: STYLES[i % len(STYLES)] for i, name in enumerate(families)}


def family_key(sweep: Sweep, estimate: Estimate) -> str:
    """What marks the family in drawings."""
    return f"form{list(styles(sweep)).index(estimate.family.name)}"


def family_name(sweep: Sweep, estimate: Estimate) -> str:
    """The family as printed, with the sweep's variable."""
    return estimate.family.name.format(x=f"{sweep.variable}'")


def is_in_degrees(sweep: Sweep) -> bool:
    """Whether the axis shows an angle."""
    return sweep.is_angle or sweep.variable in ("dr", "ds", "db")


def axis_name(sweep: Sweep) -> str:
    """Label of the axis of the motion variable."""
    return _AXIS_NAMES.get(sweep.variable, sweep.angle_name)


def on_axis(sweep: Sweep, x: Array) -> Array:
    """The motion variable as the axis shows it."""
    if sweep.is_angle:
        return np.degrees(np.arcsin(np.clip(x, -1.0, 1.0)))
    return np.degrees(x) if is_in_degrees(sweep) else np.asarray(x)


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
    selected = [int(i) for i in np.flatnonzero(np.isfinite(x) & np.isfinite(y))]
    words, grouped = (tuple(texts[i] for i in selected) if texts else () for texts in (notes, groups))
    return Series(key, name, rounded(np.asarray(x)[selected]), rounded(np.asarray(y)[selected]), words, grouped)


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
