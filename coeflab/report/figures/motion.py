"""Figures of a motion: the track, and speeds, angles, rates and controls over time."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from coeflab.core.types import Array
from coeflab.law.symbols import ANGLE_NAMES, CONTROLS
from coeflab.motion.trajectory import Trajectory
from coeflab.report.document import Figure, Series
from coeflab.report.figures.palette import COLOURS, recoloured
from coeflab.report.figures.panel import BOTTOM, LEFT, LEGEND_ROW, RIGHT, TOP, WIDTH, drawing, legend, limits, panel
from coeflab.report.figures.series import STYLES, curve, numbers, points, tagged
from coeflab.report.figures.svg import settings, svg_text
from coeflab.report.notation import as_users_wrote

FLAT = 1e-9
STILL = 1e-12
MOST_BODIES, CLEAR = 12, 1.6
MOST_POINTS = 150
BEYOND: dict[str, Any] = {"color": COLOURS["muted"], "linewidth": 1.4, "linestyle": (0, (3, 2))}


def track_figures(trajectory: Trajectory, anchor: str, length: float, after: str = "") -> tuple[Figure, ...]:
    """The track in the plane in which it leaves its course the more; in both where the other holds half a length too."""
    aside, down = np.ptp(trajectory.position[:, 1]), np.ptp(trajectory.position[:, 2])
    planes = [v for v, one, other in ((False, aside, down), (True, down, aside)) if one > other or one > 0.5 * length]
    return tuple(
        track_figure(trajectory, f"{anchor}-{'profile' if i else 'track'}", length, vertical, after)
        for i, vertical in enumerate(planes or [False])
    )


def track_figure(trajectory: Trajectory, anchor: str, length: float, vertical: bool, after: str = "") -> Figure:
    """The track in a plane, with the body drawn at equal distances; grey where the motion leaves what data cover."""
    across, up = _in_plane(trajectory, vertical)
    names = ("north  [m]", "depth  [m]") if vertical else ("east  [m]", "north  [m]")
    top = TOP + 24.0
    wide, tall = _equal(across, up, (WIDTH - LEFT - RIGHT) / (top - BOTTOM), length)
    beyond = _outside(trajectory)
    title = f"Track in the {'vertical' if vertical else 'horizontal'} plane{after}"
    description = (
        f"{names[1].split()[0]} against {names[0].split()[0]} of the reference point, {trajectory.time[-1]:g} s."
    )
    with settings():
        figure = drawing()
        axes = panel(
            figure, BOTTOM, top - BOTTOM, across=wide, up=tall[::-1] if vertical else tall, name_up=names[1],
            name_across=names[0],
        )  # fmt: skip
        draw_track(axes, trajectory, vertical, length)
        marks = {}
        if np.any(~beyond[:-1] & ~beyond[1:]) or not np.any(beyond):
            marks["track"] = Line2D([], [], color=COLOURS["a"], linewidth=1.4, label="track within the data")
        if np.any(beyond):
            marks["beyond"] = Line2D([], [], label="track beyond the data", **BEYOND)
        legend(figure, [tagged(mark, key) for key, mark in marks.items()], top)
        shown = numbers(axes, _places(trajectory, across, up, beyond), names[0], names[1])
        svg = svg_text(figure, anchor, title, description)
    return Figure(
        anchor,
        svg,
        title,
        "The dot is the start" + (", the strokes are the body." if length > 0.0 else "."),
        description,
        (shown,),
    )


def _in_plane(trajectory: Trajectory, vertical: bool) -> tuple[Array, Array]:
    """Places across and up: east and north, or north and depth."""
    x = np.asarray(trajectory.position)
    return (x[:, 0], x[:, 2]) if vertical else (x[:, 1], x[:, 0])


def draw_track(
    axes: Axes,
    trajectory: Trajectory,
    vertical: bool = False,
    length: float = 0.0,
    palette: Mapping[str, str] = COLOURS,
) -> None:
    """The track and its start, broken where the motion leaves what data cover; with a length the body at equal distances.

    Parameters
    ----------
    axes : Axes
    trajectory : Trajectory
    vertical : bool
        Depth over north, else north over east.
    length : float
        Of the body, m.
    palette : mapping of str to str
        A colour for each name of `COLOURS`.
    """
    (across, up), beyond = _in_plane(trajectory, vertical), _outside(trajectory)
    tagged(axes.plot(across, np.where(beyond, np.nan, up), color=palette["a"], linewidth=1.4, zorder=3), "track")
    aside = {**BEYOND, "color": palette["muted"]}
    tagged(axes.plot(across, np.where(beyond, up, np.nan), zorder=2.8, **aside), "beyond")
    axes.plot(across[:1], up[:1], linestyle="none", marker="o", markersize=4.0, color=palette["a"], zorder=4)
    if length > 0.0:
        _bodies(axes, trajectory, across, up, vertical, length, palette["b"])


def _places(trajectory: Trajectory, across: Array, up: Array, beyond: NDArray[np.bool_]) -> list[Series]:
    """Points of the track at even steps of its samples, with the time and speed at each."""
    every = np.unique(np.linspace(0, len(across) - 1, min(len(across), MOST_POINTS)).round().astype(int))
    out = []
    for key, name, rows in (
        ("track", "track within the data", every[~beyond[every]]),
        ("beyond", "track beyond the data", every[beyond[every]]),
    ):
        notes = [f"at {trajectory.time[i]:.4g} s, {trajectory.speed[i]:.3g} m/s" for i in rows]
        out.append(points(key, name, across[rows], up[rows], notes))
    return out


def _equal(x: Array, y: Array, ratio: float, length: float) -> tuple[tuple[float, float], tuple[float, float]]:
    """Ranges with one scale on both axes."""
    (x0, x1), (y0, y1) = (
        limits(np.concatenate([v - 0.55 * length, v + 0.55 * length]), 0.02) or (-1.0, 1.0) for v in (x, y)
    )
    wide = max(x1 - x0, ratio * (y1 - y0), 2.0 * length)
    tall = wide / ratio
    cx, cy = (x0 + x1) / 2.0, (y0 + y1) / 2.0
    return (cx - wide / 2.0, cx + wide / 2.0), (cy - tall / 2.0, cy + tall / 2.0)


def _bodies(
    axes: Axes, trajectory: Trajectory, across: Array, up: Array, vertical: bool, length: float, colour: str
) -> None:
    psi, theta = trajectory.angles[:, 2], trajectory.angles[:, 1]
    flat = np.cos(theta)
    ahead = (flat * np.cos(psi), -np.sin(theta)) if vertical else (flat * np.sin(psi), flat * np.cos(psi))
    way = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(across), np.diff(up)))])
    apart = max(way[-1] / MOST_BODIES, CLEAR * length)
    for i in np.unique(np.searchsorted(way, np.arange(0.0, way[-1] + apart / 2.0, apart)).clip(0, len(way) - 1)):
        dx, dy = 0.5 * length * ahead[0][i], 0.5 * length * ahead[1][i]
        axes.plot(
            [across[i] - dx, across[i] + dx], [up[i] - dy, up[i] + dy], color=colour, linewidth=2.2,
            solid_capstyle="round", alpha=0.8, zorder=3.4,
        )  # fmt: skip


def _outside(trajectory: Trajectory) -> NDArray[np.bool_]:
    out = np.zeros(len(trajectory.time), dtype=bool)
    for flags in trajectory.outside.values():
        out |= flags
    return out


def history_figures(trajectory: Trajectory, anchor: str, after: str = "") -> tuple[Figure, ...]:
    """Speeds, angles and rates that change, and the controls, each over time."""
    nu, angles = trajectory.velocity, np.degrees(trajectory.angles)
    speeds = {"u ahead": nu[:, 0], "v to starboard": nu[:, 1], "w down": nu[:, 2], "speed V": trajectory.speed}
    turns = {"roll": angles[:, 0], "pitch": angles[:, 1], "heading": np.degrees(trajectory.heading)}
    rates = {name: np.degrees(nu[:, 3 + i]) for i, name in enumerate(("roll rate p", "pitch rate q", "yaw rate r"))}
    ordered = {
        f"{ANGLE_NAMES[n]} {n}, sign of the file" if n in CONTROLS else n.replace(".tilt", ", tilt"): np.degrees(c)
        for n, c in trajectory.controls.items()
        if n in CONTROLS or n.endswith(".tilt")
    }
    groups: list[tuple[str, str, Mapping[str, Array], str]] = [
        ("speed", "speed  [m/s]", speeds, "Speeds through the water"),
        ("angle", "angle  [deg]", {**turns, **ordered}, "Attitude and control angles"),
        ("rate", "rate  [deg/s]", rates, "Rates"),
    ]
    if np.ptp(trajectory.position[:, 2]) > FLAT:
        groups.append(("depth", "depth  [m]", {"depth": trajectory.position[:, 2]}, "Depth"))
    out = []
    for key, name_up, series, title in groups:
        moving = {n: v for n, v in series.items() if np.ptp(v) > STILL or np.any(np.abs(v) > STILL)}
        if moving:
            out.append(_history(trajectory.time, moving, f"{anchor}-{key}", name_up, f"{title}{after}"))
    return tuple(out)


def _history(time: Array, series: Mapping[str, Array], anchor: str, name_up: str, title: str) -> Figure:
    span = (float(time[0]), float(time[-1]))
    up = limits(np.concatenate(list(series.values())), 0.06) or (-1.0, 1.0)
    up = up[::-1] if "depth" in series else up
    description = f"{title} over {span[1] - span[0]:g} s: {', '.join(series)}."
    with settings():
        top = 240.0 - 4.0 - 2 * LEGEND_ROW - 8.0
        figure = drawing(top + 12.0 + LEGEND_ROW * max(2, (len(series) + 1) // 2))
        axes = panel(figure, BOTTOM, top - BOTTOM, across=span, up=up, name_up=name_up, name_across="time  [s]")
        legend(figure, draw_history(axes, time, series), top)
        found = [curve(f"s{i}", name, time, values) for i, (name, values) in enumerate(series.items())]
        shown = numbers(axes, found, "time  [s]", name_up)
        svg = svg_text(figure, anchor, title, description)
    return Figure(anchor, svg, title, f"{', '.join(series)} over time.", description, (shown,))


def draw_history(
    axes: Axes, time: Array, series: Mapping[str, Array], palette: Mapping[str, str] = COLOURS
) -> list[Any]:
    """Quantities over time, told apart by colour and line; returns what a legend shows.

    Parameters
    ----------
    axes : Axes
    time : (n,) array
    series : mapping of str to (n,) array
    palette : mapping of str to str
        A colour for each name of `COLOURS`.
    """
    handles: list[Any] = []
    for i, (name, values) in enumerate(series.items()):
        style = STYLES[i % len(STYLES)]
        look: dict[str, Any] = {"color": recoloured(style.colour, palette), "linestyle": style.line, "linewidth": 1.3}
        handles += tagged(axes.plot(time, values, zorder=2.5, label=name, **look), f"s{i}")
    return handles


@as_users_wrote
def motion_figures(trajectory: Trajectory, anchor: str, length: float, what: str = "") -> tuple[Figure, ...]:
    """Tracks and all histories; none of a motion that is no longer than an instant.

    Parameters
    ----------
    trajectory : Trajectory
    anchor : str
        Unique in the document.
    length : float
        Of the body, m.
    what : str
        The motion, for the titles of a document that holds several.
    """
    if not np.ptp(trajectory.time) > 0.0:
        return ()
    after = f", {what}" if what else ""
    return *track_figures(trajectory, anchor, length, after), *history_figures(trajectory, anchor, after)
