"""The axes, velocities, angles and control angles that every sign of a report refers to, drawn."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Arc, FancyArrowPatch, Polygon

from coeflab.core.types import Array
from coeflab.report.document import Figure
from coeflab.report.figures.palette import COLOURS
from coeflab.report.figures.svg import paper, settings, svg_text
from coeflab.report.texts import texts_of

WIDTH, HEIGHT = 340.0, 248.0
LONG, WIDE = 84.0, 11.0
DRIFT = 24.0
MIDDLES = {"plan": np.array([160.0, 118.0]), "profile": np.array([168.0, 136.0])}
AHEAD = {"plan": np.array([0.0, 1.0]), "profile": np.array([1.0, 0.0])}
# Unit vectors along x, y, z on paper: an orthographic view from 35 degrees above, starboard and abaft.
AXES = np.array([[0.820, 0.328], [0.572, -0.470], [0.0, -0.819]])
VIEWS = ("plan", "profile", "triad")


def axes_figures(anchor: str, *, controls: bool = True) -> tuple[Figure, ...]:
    """From above, from starboard, and obliquely.

    Parameters
    ----------
    anchor : str
        Beginning of the figures' anchors.
    controls : bool
        Whether rudder and stern plane are drawn.
    """
    draw = {"plan": _plan, "profile": _profile, "triad": _oblique}
    out = []
    for key in VIEWS:
        view, title, *texts = texts_of(f"conventions.{key}")
        # No source at hand states the sense of a control angle; the signs of measured derivatives do.
        turned = texts_of(f"conventions.{key}_turned") if controls and key != "triad" else ()
        caption, words = (" ".join(both) for both in zip(texts, turned or ("", ""), strict=True))
        with settings():
            figure, axes = paper(WIDTH, HEIGHT)
            draw[key](axes)
            if turned:
                _control(axes, key)
            axes.text(14.0, HEIGHT - 14.0, view, color=COLOURS["muted"], fontsize=8.75)
            svg = svg_text(figure, f"{anchor}-{key}", title, words.strip())
        out.append(Figure(f"{anchor}-{key}", svg, title, caption.strip(), words.strip()))
    return tuple(out)


def _hull(axes: Axes, middle: Array, along: Array, across: Array) -> None:
    """A body of revolution: blunt bow, fine stern."""
    t = np.linspace(-1.0, 1.0, 81)
    half = WIDE * np.where(t > 0.3, np.sqrt(np.clip(1.0 - ((t - 0.3) / 0.7) ** 2, 0.0, None)), 1.0)
    half = np.where(t < -0.2, WIDE * (1.0 - ((-0.2 - t) / 0.8) ** 2), half)
    upper = middle + np.outer(t * LONG, along) + np.outer(half, across)
    lower = middle + np.outer(t * LONG, along) - np.outer(half, across)
    outline = np.vstack([upper, lower[::-1]])
    axes.add_patch(Polygon(outline, closed=True, facecolor=COLOURS["band"], alpha=0.3, edgecolor="none", zorder=1))
    axes.add_patch(Polygon(outline, closed=True, fill=False, edgecolor=COLOURS["ink"], linewidth=0.9, zorder=2))


def _arrow(axes: Axes, start: Array, end: Array, colour: str = "ink", width: float = 1.1) -> None:
    axes.add_patch(
        FancyArrowPatch(
            (start[0], start[1]), (end[0], end[1]), arrowstyle="-|>,head_length=4.2,head_width=1.9", shrinkA=0.0, shrinkB=0.0,
            color=COLOURS[colour], linewidth=width, zorder=4, mutation_scale=1.0,
        )
    )  # fmt: skip


def _text(axes: Axes, place: Any, words: str, colour: str = "ink", ha: str = "center") -> None:
    axes.text(place[0], place[1], words, color=COLOURS[colour], ha=ha, va="center", fontsize=9.5, zorder=5)


def _turn(axes: Axes, middle: Array, radius: float, start: float, end: float, colour: str = "b") -> None:
    """An arc with an arrow at its end, degrees from the right, counter-clockwise where end > start."""
    low, high = min(start, end), max(start, end)
    axes.add_patch(
        Arc(
            (middle[0], middle[1]),
            2 * radius,
            2 * radius,
            theta1=low,
            theta2=high,
            color=COLOURS[colour],
            linewidth=1.1,
        )
    )
    at, sense = np.radians(end), 1.0 if end > start else -1.0
    tip = middle + radius * np.array([np.cos(at), np.sin(at)])
    back = np.radians(end - sense * 400.0 / radius)
    _arrow(axes, middle + radius * np.array([np.cos(back), np.sin(back)]), tip, colour)


def _flap(axes: Axes, root: Array, along: Array, angle: float) -> None:
    """A control surface at the stern that is turned, degrees counter-clockwise, with its chord at rest."""
    turn = np.radians(angle)
    ahead = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]]) @ (-along)
    axes.plot(*np.array([root, root - 26.0 * along]).T, color=COLOURS["muted"], linewidth=0.7, linestyle=(0, (2, 2)))
    axes.plot(*np.array([root + 4.0 * along, root + 22.0 * ahead]).T, color=COLOURS["c"], linewidth=2.6, zorder=3)


def _drift(axes: Axes, middle: Array, ahead: Array, aside: Array, names: tuple[str, str, str]) -> None:
    """Velocity and its parts from the reference point, with the angle between."""
    v = np.radians(DRIFT)
    reach = 118.0
    end = middle + reach * (np.cos(v) * ahead + np.sin(v) * aside)
    _arrow(axes, middle, end, "a", 1.6)
    _text(axes, end + 11.0 * (np.cos(v) * ahead + np.sin(v) * aside), "V", "a")
    foot = middle + reach * np.cos(v) * ahead
    axes.plot(*np.array([foot, end]).T, color=COLOURS["a"], linewidth=0.9, linestyle=(0, (3, 2)), zorder=3)
    side = reach * np.sin(v)
    _text(axes, foot + 0.5 * side * aside + 11.0 * ahead, names[1], "a")
    turned = float(np.degrees(np.arctan2(ahead[1], ahead[0])))
    sense = float(np.sign(ahead[0] * aside[1] - ahead[1] * aside[0]))
    _turn(axes, middle, 62.0, turned, turned + sense * DRIFT, "a")
    half = np.radians(turned + sense * DRIFT / 2.0)
    _text(axes, middle + 76.0 * np.array([np.cos(half), np.sin(half)]), names[2], "a")


def _control(axes: Axes, view: str) -> None:
    """The rudder from above, or the stern plane from starboard."""
    middle, ahead = MIDDLES[view], AHEAD[view]
    _flap(axes, middle - 86.0 * ahead, ahead, -25.0 if view == "plan" else 25.0)
    aside = np.array([-24.0, -106.0] if view == "plan" else [-104.0, -24.0])
    _text(axes, middle + aside, "δr" if view == "plan" else "δs", "c")


def _plan(axes: Axes) -> None:
    """Bow up, starboard to the right."""
    middle = MIDDLES["plan"]
    ahead, aside = np.array([0.0, 1.0]), np.array([1.0, 0.0])
    _hull(axes, middle, ahead, aside)
    _arrow(axes, middle, middle + 112.0 * ahead)
    _text(axes, middle + 112.0 * ahead + np.array([-14.0, 0.0]), "x, u")
    _arrow(axes, middle, middle + 62.0 * aside)
    _text(axes, middle + 62.0 * aside + np.array([14.0, -1.0]), "y, v")
    _drift(axes, middle, ahead, aside, ("u", "v", "β"))
    _turn(axes, middle, 44.0, 245.0, 130.0)
    _text(axes, middle + np.array([-54.0, 12.0]), "r", "b")
    _text(axes, middle + np.array([-46.0, 66.0]), "port", "muted")
    _text(axes, middle + np.array([62.0, -40.0]), "starboard", "muted")


def _profile(axes: Axes) -> None:
    """Bow to the right, z down."""
    middle = MIDDLES["profile"]
    ahead, aside = np.array([1.0, 0.0]), np.array([0.0, -1.0])
    _hull(axes, middle, ahead, aside)
    _arrow(axes, middle, middle + 112.0 * ahead)
    _text(axes, middle + 112.0 * ahead + np.array([2.0, 12.0]), "x, u")
    _arrow(axes, middle, middle + 62.0 * aside)
    _text(axes, middle + 62.0 * aside + np.array([18.0, 0.0]), "z, w")
    _drift(axes, middle, ahead, aside, ("u", "w", "α"))
    _turn(axes, middle, 44.0, 50.0, 150.0)
    _text(axes, middle + np.array([-8.0, 56.0]), "q", "b")


def _oblique(axes: Axes) -> None:
    """The triad with forces and moments."""
    origin = np.array([150.0, 150.0])
    named = (("x, X, u", "K, p", (0.0, 24.0)), ("y, Y, v", "M, q", (33.0, 6.0)), ("z, Z, w", "N, r", (-36.0, 2.0)))
    for i, (force, moment, aside) in enumerate(named):
        end, middle = origin + 120.0 * AXES[i], origin + 76.0 * AXES[i]
        _arrow(axes, origin, end, "ink", 1.3)
        _text(axes, end + 17.0 * AXES[i] / np.linalg.norm(AXES[i]), force)
        _ring(axes, middle, AXES[(i + 1) % 3], AXES[(i + 2) % 3])
        _text(axes, middle + np.array(aside), moment, "b")
    axes.plot(*origin, marker="o", markersize=3.2, color=COLOURS["ink"], zorder=5)
    _text(axes, origin + np.array([-8.0, 12.0]), "reference point", "muted", "right")


def _ring(axes: Axes, middle: Array, first: Array, second: Array) -> None:
    """A turn from one axis to the next: right-handed about the third."""
    t = np.radians(np.linspace(-60.0, 210.0, 60))
    path = middle + 15.0 * (np.outer(np.cos(t), first) + np.outer(np.sin(t), second))
    axes.plot(path[:, 0], path[:, 1], color=COLOURS["b"], linewidth=1.1, zorder=4)
    _arrow(axes, path[-6], path[-1], "b")
