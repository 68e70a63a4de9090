"""A motion: its track, or a quantity over time."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from coeflab.core.errors import InputError, shown
from coeflab.law.symbols import ANGULAR, CONTROLS, MOTIONS
from coeflab.motion.trajectory import Trajectory
from coeflab.report.figures.motion import draw_history, draw_track
from coeflab.report.plots.axes import axes_of, palette

IN_DEGREES = ("heading", "roll", "pitch")


def plot_motion(motion: Trajectory, what: str = "track", ax: Axes | None = None) -> Axes:
    """North over east, or a quantity over time; angles in degrees.

    Parameters
    ----------
    motion : Trajectory
    what : str
    ax : Axes, optional

    Raises
    ------
    InputError
        A quantity that the motion has not.
    """
    known = {
        "depth": (motion.position[:, 2], "m"), "north": (motion.position[:, 0], "m"), "east": (motion.position[:, 1], "m"),
        "heading": (np.degrees(motion.heading), "deg"), "speed": (motion.speed, "m/s"),
        "roll": (np.degrees(motion.angles[:, 0]), "deg"), "pitch": (np.degrees(motion.angles[:, 1]), "deg"),
        **{m: (motion.velocity[:, i], "rad/s" if m in ANGULAR else "m/s") for i, m in enumerate(MOTIONS)},
        **{k: (np.degrees(v), "deg") if k in CONTROLS else (np.asarray(v), "") for k, v in motion.controls.items()},
    }  # fmt: skip
    if what != "track" and what not in known:
        raise InputError(shown(what), f"track, or one of {', '.join(known)}", column="what")
    axes = axes_of(ax)
    if what == "track":
        draw_track(axes, motion, palette=palette())
        axes.set_xlabel("east [m]")
        axes.set_ylabel("north [m]")
        axes.set_aspect("equal", adjustable="datalim")
        return axes
    values, unit = known[what]
    draw_history(axes, motion.time, {what: values}, palette())
    axes.set_xlabel("time [s]")
    axes.set_ylabel(f"{what} [{unit}]" if unit else what)
    return axes
