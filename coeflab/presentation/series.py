"""How a sweep is drawn: axes in degrees where the variable is an angle, one line style and marker per family."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from coeflab.kernels.brief import brief
from coeflab.kernels.slopes import Estimate
from coeflab.model.fit_result import Sweep
from coeflab.presentation.svg import COLOURS

Array = NDArray[np.float64]

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


@brief
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
    families = dict.fromkeys(e.family.name for e in (*sweep.recommendation.panel, *sweep.plain))
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
